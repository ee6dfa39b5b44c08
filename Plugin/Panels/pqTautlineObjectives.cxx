// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineObjectives.h"

#include "ObjectiveRules.h"

#include "pqDoubleLineEdit.h"

#include "vtkSMEnumerationDomain.h"
#include "vtkSMIntRangeDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMProxy.h"

#include <QAbstractItemView>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDoubleValidator>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPointer>
#include <QSpinBox>
#include <QStandardItemModel>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace
{
constexpr const char* NumberProperty = "NumberOfObjectives";
constexpr const char* ScalarizationProperty = "Scalarization";

enum Columns
{
  MetricColumn,
  TemplateColumn,
  TargetColumn,
  WeightColumn,
  RemoveColumn
};
/// The shares of the columns in the width of the table.
constexpr int Stretches[] = { 4, 3, 3, 2, 0 };
constexpr const char* Headers[] = { "Metric", "Template", "Target", "Weight" };

QString nameOf(const char* property, int number)
{
  return QString(property) + QString::number(number);
}

int mostObjectives(vtkSMPropertyGroup* group)
{
  int exists = 0;
  auto* range = group->GetProperty(NumberProperty)->FindDomain<vtkSMIntRangeDomain>();
  const int most = range ? range->GetMaximum(0, exists) : 1;
  return exists ? most : 1;
}
}

//------------------------------------------------------------------------------
pqTautlineObjectives::pqTautlineObjectives(
  vtkSMProxy* smproxy, vtkSMPropertyGroup* smgroup, QWidget* parentObject)
  : Superclass(smproxy, smgroup, parentObject)
  , Text(new QLabel(this))
  , Warning(new QLabel(this))
  , Dialog(new QDialog(this))
  , Number(new QSpinBox(this->Dialog))
  , Scalarization(this->makeChoice(ScalarizationProperty))
  , Add(new QToolButton(this->Dialog))
  , Problem(new QLabel(this->Dialog))
{
  this->setShowLabel(false);
  this->Text->setObjectName("Text");
  this->Text->setWordWrap(true);
  this->Warning->setObjectName("Warning");
  this->Warning->setWordWrap(true);
  auto* edit = new QToolButton(this);
  edit->setObjectName("Edit");
  edit->setText("&Edit...");
  edit->setToolTip("Edit the objectives in a table: metric, template, target and weight of each, "
                   "and how they are combined.");
  auto* line = new QHBoxLayout;
  line->addWidget(new QLabel("Objectives", this));
  line->addWidget(this->Text, 1);
  line->addWidget(edit);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addLayout(line);
  layout->addWidget(this->Warning);

  const int most = mostObjectives(smgroup);
  this->Number->setRange(1, most);
  this->addPropertyLink(this->Number, NumberProperty);
  for (int number = 1; number <= most; ++number)
  {
    this->Rows.push_back(this->makeRow(number));
  }
  this->makeDialog();

  QObject::connect(edit, &QToolButton::clicked, this, &pqTautlineObjectives::edit);
  QObject::connect(this->Add, &QToolButton::clicked, this, &pqTautlineObjectives::add);
  const auto changed = QOverload<int>::of(&QComboBox::currentIndexChanged);
  std::vector<QComboBox*> boxes = { this->Scalarization };
  for (const Row& row : this->Rows)
  {
    boxes.insert(boxes.end(), { row.metric, row.objectiveTemplate, row.target });
  }
  for (QComboBox* box : boxes)
  {
    QObject::connect(box, changed, this, &pqTautlineObjectives::refresh);
  }
  const auto counted = QOverload<int>::of(&QSpinBox::valueChanged);
  QObject::connect(this->Number, counted, this, &pqTautlineObjectives::refresh);
  this->refresh();
}

//------------------------------------------------------------------------------
void pqTautlineObjectives::makeDialog()
{
  this->Dialog->setObjectName("ObjectivesDialog");
  this->Dialog->setWindowTitle("Objectives");
  this->Dialog->resize(720, 260);
  this->Number->setObjectName("Number");
  this->Number->hide();
  this->Add->setObjectName("Add");
  this->Add->setText("&Add Objective");
  this->Problem->setObjectName("Problem");
  this->Problem->setWordWrap(true);
  auto* buttons =
    new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this->Dialog);
  buttons->setObjectName("Buttons");

  auto* table = new QGridLayout;
  for (int column = MetricColumn; column <= WeightColumn; ++column)
  {
    table->addWidget(new QLabel(Headers[column], this->Dialog), 0, column);
    table->setColumnStretch(column, Stretches[column]);
  }
  int line = 0;
  for (const Row& row : this->Rows)
  {
    ++line;
    table->addWidget(row.metric, line, MetricColumn);
    table->addWidget(row.objectiveTemplate, line, TemplateColumn);
    table->addWidget(row.target, line, TargetColumn);
    table->addWidget(row.weight, line, WeightColumn);
    table->addWidget(row.remove, line, RemoveColumn);
  }
  auto* combination = new QHBoxLayout;
  combination->addWidget(this->Add);
  combination->addStretch();
  auto* label = new QLabel("&Scalarization", this->Dialog);
  label->setBuddy(this->Scalarization);
  combination->addWidget(label);
  combination->addWidget(this->Scalarization);
  auto* layout = new QVBoxLayout(this->Dialog);
  layout->addLayout(table);
  layout->addLayout(combination);
  layout->addWidget(this->Problem);
  layout->addStretch();
  layout->addWidget(buttons);
  QObject::connect(buttons, &QDialogButtonBox::accepted, this->Dialog, &QDialog::accept);
  QObject::connect(buttons, &QDialogButtonBox::rejected, this->Dialog, &QDialog::reject);
}

//------------------------------------------------------------------------------
pqTautlineObjectives::~pqTautlineObjectives() = default;

//------------------------------------------------------------------------------
QComboBox* pqTautlineObjectives::makeChoice(const QString& property)
{
  auto* box = new QComboBox(this->Dialog);
  box->setObjectName(property);
  this->addPropertyLink(box, property.toUtf8().constData());
  box->view()->setMinimumWidth(box->view()->sizeHintForColumn(0));
  return box;
}

//------------------------------------------------------------------------------
pqTautlineObjectives::Row pqTautlineObjectives::makeRow(int number)
{
  Row row;
  row.metric = this->makeChoice(nameOf("Metric", number));
  row.objectiveTemplate = this->makeChoice(nameOf("Template", number));
  row.target = this->makeChoice(nameOf("Target", number));
  row.weight = new pqDoubleLineEdit(this->Dialog);
  row.weight->setObjectName(nameOf("Weight", number));
  row.weight->setValidator(new QDoubleValidator(row.weight));
  row.weight->setMinimumWidth(row.weight->fontMetrics().horizontalAdvance("0.000"));
  this->pqPropertyWidget::addPropertyLink(row.weight, "text2",
    SIGNAL(textChangedAndEditingFinished()),
    this->propertyGroup()->GetProperty(row.weight->objectName().toUtf8().constData()));
  row.remove = new QToolButton(this->Dialog);
  row.remove->setObjectName(nameOf("Remove", number));
  row.remove->setText(QString(QChar(0x2212))); // minus
  const int index = number - 1;
  QObject::connect(row.remove, &QToolButton::clicked, this, [this, index] { this->remove(index); });
  return row;
}

//------------------------------------------------------------------------------
void pqTautlineObjectives::edit()
{
  const QStringList before = this->state();
  const QPointer<pqTautlineObjectives> panel(this); // the filter may be deleted meanwhile
  if (this->Dialog->exec() != QDialog::Accepted && panel)
  {
    this->setState(before);
  }
}

//------------------------------------------------------------------------------
void pqTautlineObjectives::add()
{
  this->Number->setValue(this->Number->value() + 1);
}

//------------------------------------------------------------------------------
void pqTautlineObjectives::remove(int index)
{
  const int last = this->Number->value() - 1;
  for (int i = index; i < last; ++i)
  {
    const Row &row = this->Rows[i], &next = this->Rows[i + 1];
    row.metric->setCurrentIndex(next.metric->currentIndex());
    row.objectiveTemplate->setCurrentIndex(next.objectiveTemplate->currentIndex());
    row.target->setCurrentIndex(next.target->currentIndex());
    row.weight->setTextAndResetCursor(next.weight->text());
    Q_EMIT row.weight->textChangedAndEditingFinished();
  }
  this->Number->setValue(last);
}

//------------------------------------------------------------------------------
int pqTautlineObjectives::valueOf(const QComboBox* box, const QString& property) const
{
  auto* values = this->propertyGroup()
                   ->GetProperty(property.toUtf8().constData())
                   ->FindDomain<vtkSMEnumerationDomain>();
  int valid = 0;
  const int value = values ? values->GetEntryValue(box->currentText().toUtf8(), valid) : 0;
  return valid ? value : 0;
}

//------------------------------------------------------------------------------
QString pqTautlineObjectives::restrict(QComboBox* box, const std::vector<QString>& problems)
{
  auto* items = qobject_cast<QStandardItemModel*>(box->model());
  int applicable = 0;
  QString reason;
  const int count = std::min(box->count(), static_cast<int>(problems.size()));
  for (int i = 0; items && i < count; ++i)
  {
    items->item(i)->setEnabled(problems[i].isEmpty());
    items->item(i)->setToolTip(problems[i]);
    applicable += problems[i].isEmpty();
    reason = problems[i].isEmpty() ? reason : problems[i];
  }
  const int index = box->currentIndex();
  const bool listed = index >= 0 && index < static_cast<int>(problems.size());
  const QString current = listed ? problems[index] : QString();
  // A choice that does not apply can be changed, even if there is one that applies only.
  box->setEnabled(applicable > 1 || !current.isEmpty());
  box->setToolTip(box->isEnabled() ? box->currentText() : reason);
  return current;
}

//------------------------------------------------------------------------------
QStringList pqTautlineObjectives::state() const
{
  QStringList values = { QString::number(this->Number->value()),
    this->Scalarization->currentText() };
  for (const Row& row : this->Rows)
  {
    values << row.metric->currentText() << row.objectiveTemplate->currentText()
           << row.target->currentText() << row.weight->text();
  }
  return values;
}

//------------------------------------------------------------------------------
void pqTautlineObjectives::setState(const QStringList& state)
{
  if (state == this->state())
  {
    return;
  }
  auto value = state.begin();
  this->Number->setValue(value++->toInt());
  this->Scalarization->setCurrentText(*value++);
  for (const Row& row : this->Rows)
  {
    row.metric->setCurrentText(*value++);
    row.objectiveTemplate->setCurrentText(*value++);
    row.target->setCurrentText(*value++);
    row.weight->setTextAndResetCursor(*value++);
    Q_EMIT row.weight->textChangedAndEditingFinished();
  }
}

//------------------------------------------------------------------------------
QString pqTautlineObjectives::summary() const
{
  QStringList metrics;
  for (int i = 0; i < this->Number->value(); ++i)
  {
    metrics << this->Rows[i].metric->currentText();
  }
  const QString text = metrics.join(", ");
  return metrics.size() > 1 ? text + " (" + this->Scalarization->currentText() + ")" : text;
}

//------------------------------------------------------------------------------
QString pqTautlineObjectives::refreshRow(int index, int count, const QString& noWeight)
{
  const Row& row = this->Rows[index];
  const int number = index + 1;
  const bool shown = index < count;
  const std::initializer_list<QWidget*> widgets = { row.metric, row.objectiveTemplate, row.target,
    row.weight, row.remove };
  for (QWidget* widget : widgets)
  {
    widget->setVisible(shown);
  }
  const int metric = this->valueOf(row.metric, nameOf("Metric", number));
  QStringList problems;
  const auto check = [&](QComboBox* box, auto reason)
  {
    auto* values = this->propertyGroup()
                     ->GetProperty(box->objectName().toUtf8().constData())
                     ->FindDomain<vtkSMEnumerationDomain>();
    std::vector<QString> reasons;
    for (unsigned int entry = 0; entry < values->GetNumberOfEntries(); ++entry)
    {
      reasons.push_back(QString::fromStdString(reason(metric, values->GetEntryValue(entry))));
    }
    const QString problem = this->restrict(box, reasons);
    if (shown && !problem.isEmpty())
    {
      problems << QString("Objective %1: %2").arg(number).arg(problem);
    }
  };
  check(row.metric, [](int, int value) { return tautline::metricReason(value); });
  check(row.objectiveTemplate, tautline::templateReason);
  check(row.target, tautline::targetReason);
  row.weight->setEnabled(noWeight.isEmpty());
  row.weight->setToolTip(noWeight.isEmpty() ? "The weight of the objective; above 0." : noWeight);
  row.remove->setEnabled(count > 1);
  row.remove->setToolTip(count > 1 ? "Remove this objective." : "At least one objective stays.");
  return problems.join("\n");
}

//------------------------------------------------------------------------------
void pqTautlineObjectives::refresh()
{
  const int count = this->Number->value();
  const int scalarization = this->valueOf(this->Scalarization, ScalarizationProperty);
  const QString noWeight = QString::fromStdString(tautline::weightReason(scalarization, count));
  QStringList problems;
  for (int i = 0; i < static_cast<int>(this->Rows.size()); ++i)
  {
    problems << this->refreshRow(i, count, noWeight);
  }
  problems.removeAll(QString());
  const int most = this->Number->maximum();
  this->Add->setEnabled(count < most);
  this->Add->setToolTip(count < most
      ? "Add an objective, to improve several metrics simultaneously."
      : QString("At most %1 objectives.").arg(most));
  this->Scalarization->setEnabled(count > 1);
  for (QLabel* label : { this->Problem, this->Warning })
  {
    label->setText(problems.join("\n"));
    label->setVisible(!problems.isEmpty());
  }
  this->Text->setText(this->summary());
}
