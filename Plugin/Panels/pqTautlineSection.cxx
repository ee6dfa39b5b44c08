// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineSection.h"

#include "SectionHeader.h"

#include "vtkPVXMLElement.h"

#include <QGridLayout>
#include <QLabel>

namespace
{
/// Deletes ParaView's title of the group; each property has one, of which one is shown.
void removeTitles(QWidget* panel, const QString& text)
{
  const QString title = "<b>" + text + "</b>";
  const auto labels = panel->findChildren<QLabel*>();
  for (QLabel* label : labels)
  {
    if (label->text().contains(title) && label->parentWidget()->parentWidget() == panel)
    {
      delete label->parentWidget();
    }
  }
}
}

//------------------------------------------------------------------------------
pqTautlineSection::pqTautlineSection(vtkPVXMLElement* hint, pqPropertyWidget* field)
  : pqPropertyWidgetDecorator(hint, field)
{
  QWidget* panel = field->parentWidget();
  const QString text = QString::fromUtf8(hint->GetAttributeOrEmpty("text"));
  auto* grid = panel ? qobject_cast<QGridLayout*>(panel->layout()) : nullptr;
  if (!grid)
  {
    return; // not in a panel of properties: shown as any other
  }
  const QString name = tautline::SectionHeader::nameOf(text);
  this->Header = panel->findChild<tautline::SectionHeader*>(name, Qt::FindDirectChildrenOnly);
  if (!this->Header)
  {
    // The first property of the section, which is added to the grid below.
    this->Header = new tautline::SectionHeader(text, field->proxy(), panel);
    grid->addWidget(this->Header, grid->rowCount(), 0, 1, -1);
  }
  removeTitles(panel, text);
  this->Header->add(field);
  QObject::connect(this->Header.data(), &tautline::SectionHeader::toggled, this,
    &pqPropertyWidgetDecorator::visibilityChanged);
}

//------------------------------------------------------------------------------
pqTautlineSection::~pqTautlineSection() = default;

//------------------------------------------------------------------------------
bool pqTautlineSection::canShowWidget(bool) const
{
  if (!this->Header)
  {
    return true;
  }
  this->Header->updateLater();
  return this->Header->isChecked() || this->Header->isSearched();
}
