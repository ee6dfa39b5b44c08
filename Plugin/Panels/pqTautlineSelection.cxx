// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineSelection.h"

#include "pqSMProxy.h"
#include "pqSelectionInputWidget.h"

#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QTextEdit>
#include <QToolButton>

#include <map>
#include <string>

namespace
{
constexpr int PointField = 1; // of a selection source

/// How many numbers an element has in the property IDs of these kinds of sources.
const std::map<std::string, unsigned int>& idSizes()
{
  static const std::map<std::string, unsigned int> sizes = { { "GlobalIDSelectionSource", 1 },
    { "IDSelectionSource", 2 }, { "CompositeDataIDSelectionSource", 3 },
    { "HierarchicalDataIDSelectionSource", 3 } };
  return sizes;
}

/// Adds the elements of a source of a selection; false if only its execution counts them.
bool addCount(vtkSMProxy* source, unsigned int counts[2])
{
  const auto size = idSizes().find(source->GetXMLName());
  if (size == idSizes().end() || !source->GetProperty("IDs"))
  {
    return false;
  }
  const char* kind = source->GetProperty("FieldType") ? "FieldType" : "ElementType";
  const bool points =
    source->GetProperty(kind) && vtkSMPropertyHelper(source, kind).GetAsInt() == PointField;
  counts[points] += vtkSMPropertyHelper(source, "IDs").GetNumberOfElements() / size->second;
  return true;
}

QString counted(unsigned int count, const char* element)
{
  return count == 0 ? QString() : QString("%1 %2%3").arg(count).arg(element, count == 1 ? "" : "s");
}
}

//------------------------------------------------------------------------------
pqTautlineSelection::pqTautlineSelection(
  vtkSMProxy* smproxy, vtkSMProperty* smproperty, QWidget* parentObject)
  : Superclass(smproxy, parentObject)
  , Input(new pqSelectionInputWidget(this))
  , Text(new QLabel(this))
  , Clear(new QToolButton(this))
{
  this->Input->setObjectName(smproxy->GetPropertyName(smproperty));
  this->Text->setObjectName("Text");
  this->Clear->setObjectName("Clear");
  this->Clear->setText("Clear");
  this->Clear->setToolTip("Remove the copied selection.");
  auto* copy = this->Input->findChild<QPushButton*>();
  const auto parts = this->Input->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly);
  for (QWidget* part : parts)
  {
    part->setVisible(part == copy);
  }
  delete this->Input->layout();
  auto* line = new QHBoxLayout(this->Input);
  line->setContentsMargins(0, 0, 0, 0);
  if (copy)
  {
    copy->setToolTip(pqPropertyWidget::getTooltip(smproperty));
    line->addWidget(copy);
  }
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Text, 1);
  layout->addWidget(this->Input);
  layout->addWidget(this->Clear);

  this->addPropertyLink(this->Input, "selection", SIGNAL(selectionChanged(pqSMProxy)), smproperty);
  QObject::connect(
    this->Input, &pqSelectionInputWidget::selectionChanged, this, &pqTautlineSelection::refresh);
  QObject::connect(this->Clear, &QToolButton::clicked, this, &pqTautlineSelection::clear);
  this->refresh();
}

//------------------------------------------------------------------------------
pqTautlineSelection::~pqTautlineSelection() = default;

//------------------------------------------------------------------------------
void pqTautlineSelection::apply()
{
  this->Input->preAccept();
  this->Superclass::apply();
  this->Input->postAccept();
}

//------------------------------------------------------------------------------
void pqTautlineSelection::clear()
{
  this->Input->setSelection(nullptr);
}

//------------------------------------------------------------------------------
QString pqTautlineSelection::describe(vtkSMProxy* selection)
{
  if (!selection)
  {
    return "none";
  }
  unsigned int counts[2] = { 0, 0 };
  bool complete = true;
  if (selection->GetProperty("IDs"))
  {
    complete = addCount(selection, counts);
  }
  else if (selection->GetProperty("Input"))
  {
    const vtkSMPropertyHelper sources(selection, "Input");
    for (unsigned int i = 0; i < sources.GetNumberOfElements(); ++i)
    {
      complete = sources.GetAsProxy(i) && addCount(sources.GetAsProxy(i), counts) && complete;
    }
  }
  else
  {
    complete = false;
  }
  const QString cells = counted(counts[0], "cell"), points = counted(counts[1], "point");
  if (!complete)
  {
    return "a query or region";
  }
  vtkSMProperty* inside = selection->GetProperty("InsideOut");
  const QString most = inside && vtkSMPropertyHelper(inside).GetAsInt() ? "all but " : "";
  return cells.isEmpty() ? (points.isEmpty() ? "none" : most + points)
                         : most + cells + (points.isEmpty() ? "" : ", " + points);
}

//------------------------------------------------------------------------------
void pqTautlineSelection::refresh()
{
  vtkSMProxy* selection = this->Input->selection();
  this->Text->setText(pqTautlineSelection::describe(selection));
  this->Clear->setEnabled(selection != nullptr);
  const auto* table = this->Input->findChild<QTextEdit*>();
  this->Text->setToolTip(table ? table->toPlainText() : QString());
}
