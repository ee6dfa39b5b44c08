// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineCriteria.h"

#include "CriteriaDialog.h"
#include "Recolor.h"
#include "Report.h"

#include "tautline/Quality/Criteria.h"
#include "tautline/Quality/Metrics.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDataRepresentation.h"
#include "pqFileDialog.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"

#include "vtkDataObject.h"
#include "vtkPVDataInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QComboBox>
#include <QFile>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace
{
constexpr const char* None = "none";
constexpr const char* GradeArray = "Grade";
constexpr const char* FileKinds = "Quality criteria (*.json)";

bool isJson(const QString& text)
{
  return text.trimmed().startsWith('{');
}

bool isPreset(const QString& text)
{
  const auto& known = tautline::criteriaPresets();
  return std::find(known.begin(), known.end(), text.toStdString()) != known.end();
}

/// "hypermesh (shells)"
QString labelOf(const std::string& preset)
{
  const auto criteria = tautline::parseCriteria(tautline::presetCriteria(preset));
  return QString("%1 (%2)").arg(
    QString::fromStdString(preset), QString::fromStdString(tautline::gradedCells(criteria)));
}

/// The name of the preset of a label; other texts as they are.
QString presetOf(const QString& label)
{
  for (const std::string& preset : tautline::criteriaPresets())
  {
    if (label == labelOf(preset))
    {
      return QString::fromStdString(preset);
    }
  }
  return label;
}

/// The built-in metrics, and those that are registered on the server now.
QStringList metricNames(vtkSMProxy* proxy)
{
  QStringList names;
  std::string registered;
  if (vtkSMProperty* list = proxy->GetProperty("UserMetrics"))
  {
    proxy->UpdatePropertyInformation(list);
    registered = vtkSMPropertyHelper(list).GetAsString();
    tautline::mirrorUserMetrics(registered);
  }
  for (const tautline::MetricInfo& info : tautline::metricRegistry())
  {
    const std::string number = std::to_string(static_cast<int>(info.metric)) + "\t";
    if (!info.user || ("\n" + registered).find("\n" + number) != std::string::npos)
    {
      names << info.name;
    }
  }
  return names;
}

/// A file on the computer of the client; "" if the user chose none.
QString chosenFile(const char* title, const char* name, pqFileDialog::FileMode mode)
{
  pqServer* const thisComputer = nullptr;
  pqFileDialog dialog(
    thisComputer, pqCoreUtilities::mainWidget(), title, QString(), FileKinds, false);
  dialog.setObjectName(name);
  dialog.setFileMode(mode);
  return dialog.exec() == QDialog::Accepted ? dialog.getSelectedFiles().value(0) : QString();
}
}

//------------------------------------------------------------------------------
pqTautlineCriteria::pqTautlineCriteria(
  vtkSMProxy* smproxy, vtkSMProperty* smproperty, QWidget* parentObject)
  : Superclass(smproxy, parentObject)
  , Choice(new QComboBox(this))
  , Save(new QToolButton(this))
  , Problem(new QLabel(this))
{
  this->Choice->setObjectName("Choice");
  this->Choice->setEditable(true);
  this->Choice->setToolTip(pqPropertyWidget::getTooltip(smproperty));
  this->Choice->addItem(None);
  for (const std::string& preset : tautline::criteriaPresets())
  {
    this->Choice->addItem(labelOf(preset));
  }
  const auto button = [this](const char* name, const char* text, const char* tip)
  {
    auto* made = new QToolButton(this);
    made->setObjectName(name);
    made->setText(text);
    made->setToolTip(tip);
    return made;
  };
  auto* edit = button("Edit", "&Edit...", "Edit the criteria in a table.");
  this->Color = button("Color", "Color by &Grade", "Color the mesh by the grades of its elements.");
  auto* load = button("Load", "&Load...", "Load criteria from a JSON file of this computer.");
  this->Save->setObjectName("Save");
  this->Save->setText("&Save...");
  this->Save->setToolTip("Save the criteria as a JSON file on this computer.");
  this->Problem->setObjectName("Problem");
  this->Problem->setWordWrap(true);
  this->Problem->hide();

  this->Choice->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(this->Color);
  buttons->addStretch();
  buttons->addWidget(edit);
  buttons->addWidget(load);
  buttons->addWidget(this->Save);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Choice);
  layout->addLayout(buttons);
  layout->addWidget(this->Problem);

  QObject::connect(this->Choice, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
    [this] { this->chosen(this->Choice->currentText()); });
  QObject::connect(this->Choice->lineEdit(), &QLineEdit::editingFinished, this,
    [this] { this->chosen(this->Choice->currentText()); });
  QObject::connect(edit, &QToolButton::clicked, this, &pqTautlineCriteria::edit);
  QObject::connect(this->Color, &QToolButton::clicked, this, &pqTautlineCriteria::color);
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::dataUpdated, this, &pqTautlineCriteria::enableColor);
  QObject::connect(load, &QToolButton::clicked, this, &pqTautlineCriteria::load);
  QObject::connect(this->Save, &QToolButton::clicked, this, &pqTautlineCriteria::save);
  this->setCriteria(QString());
  this->enableColor();
  this->addPropertyLink(this, "criteria", SIGNAL(criteriaChanged()), smproperty);
}

//------------------------------------------------------------------------------
pqTautlineCriteria::~pqTautlineCriteria() = default;

//------------------------------------------------------------------------------
QString pqTautlineCriteria::json() const
{
  return isJson(this->Criteria) ? this->Criteria
    : isPreset(this->Criteria)
    ? QString::fromStdString(tautline::presetCriteria(this->Criteria.toStdString()))
    : QString();
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::setCriteria(const QString& criteria)
{
  const bool changed = criteria != this->Criteria;
  this->Criteria = criteria;
  QString shown = criteria.isEmpty() ? None
    : isPreset(criteria)             ? labelOf(criteria.toStdString())
                                     : criteria;
  QString problem;
  if (isJson(criteria))
  {
    try
    {
      shown = QString::fromStdString(tautline::parseCriteria(criteria.toStdString()).name);
      shown = "own: " + shown;
    }
    catch (const tautline::Error& error)
    {
      problem = error.what();
    }
  }
  {
    const QSignalBlocker blocker(this->Choice);
    this->Choice->setCurrentText(shown);
  }
  this->showProblem(problem);
  this->Save->setEnabled(!this->json().isEmpty());
  if (changed)
  {
    Q_EMIT this->criteriaChanged();
  }
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::showProblem(const QString& problem)
{
  this->Problem->setText(problem);
  this->Problem->setVisible(!problem.isEmpty());
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::chosen(const QString& text)
{
  // The name of one's own criteria stands for the text that they have.
  if (!text.startsWith("own: "))
  {
    this->setCriteria(text == None ? QString() : presetOf(text.trimmed()));
  }
}

//------------------------------------------------------------------------------
pqOutputPort* pqTautlineCriteria::gradedMesh() const
{
  auto* source =
    pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
      this->proxy());
  pqOutputPort* mesh = source ? source->getOutputPort(0) : nullptr;
  const bool graded = mesh && source->modifiedState() != pqProxy::UNINITIALIZED &&
    mesh->getDataInformation()->GetArrayInformation(GradeArray, vtkDataObject::CELL);
  return graded ? mesh : nullptr;
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::enableColor()
{
  this->Color->setEnabled(this->gradedMesh() != nullptr);
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::color()
{
  pqOutputPort* mesh = this->gradedMesh();
  for (pqView* view : mesh ? mesh->getViews() : QList<pqView*>())
  {
    pqDataRepresentation* shown = mesh->getRepresentation(view);
    if (shown && shown->isVisible() && shown->getProxy()->GetProperty("ColorArrayName"))
    {
      tautline::recolor(shown, GradeArray, vtkDataObject::CELL, true);
      shown->renderViewEventually();
    }
  }
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::edit()
{
  const QString start = this->json().isEmpty()
    ? QString::fromStdString(tautline::presetCriteria(tautline::criteriaPresets().front()))
    : this->json();
  tautline::CriteriaDialog dialog(start, metricNames(this->proxy()), pqCoreUtilities::mainWidget());
  if (dialog.exec() == QDialog::Accepted)
  {
    this->setCriteria(dialog.json());
  }
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::load()
{
  const QString name =
    chosenFile("Load Criteria", "LoadCriteriaDialog", pqFileDialog::ExistingFile);
  if (name.isEmpty())
  {
    return;
  }
  QFile file(name);
  const QString text =
    file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
  if (isJson(text))
  {
    this->setCriteria(text);
  }
  else
  {
    this->showProblem(name + " is no file of criteria: JSON is expected.");
  }
}

//------------------------------------------------------------------------------
void pqTautlineCriteria::save()
{
  const QString name = chosenFile("Save Criteria", "SaveCriteriaDialog", pqFileDialog::AnyFile);
  if (!name.isEmpty())
  {
    this->showProblem(tautline::saveText(name, this->json()));
  }
}
