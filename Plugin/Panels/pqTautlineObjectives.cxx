// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineObjectives.h"

#include "ObjectiveRules.h"

#include "pqDoubleLineEdit.h"

#include "vtkCommand.h"
#include "vtkEventQtSlotConnect.h"
#include "vtkSMEnumerationDomain.h"
#include "vtkSMIntRangeDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMProxy.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <QAbstractItemView>
#include <QComboBox>
#include <QDoubleValidator>
#include <QGridLayout>
#include <QLabel>
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
  , Number(new QSpinBox(this))
  , Add(new QToolButton(this))
  , Problem(new QLabel(this))
  , Observer(vtkSmartPointer<vtkEventQtSlotConnect>::New())
{
  this->setShowLabel(false);
  this->Number->setObjectName("Number");
  this->Number->hide();
  this->Add->setObjectName("Add");
  this->Add->setText("Add Objective");
  this->Problem->setObjectName("Problem");
  this->Problem->setWordWrap(true);

  auto* table = new QGridLayout;
  table->setHorizontalSpacing(2);
  for (int column = MetricColumn; column <= WeightColumn; ++column)
  {
    table->addWidget(new QLabel(Headers[column], this), 0, column);
    table->setColumnStretch(column, Stretches[column]);
  }
  const int most = mostObjectives(smgroup);
  this->Number->setRange(1, most);
  this->addPropertyLink(this->Number, NumberProperty);
  for (int number = 1; number <= most; ++number)
  {
    const Row row = this->makeRow(number);
    table->addWidget(row.metric, number, MetricColumn);
    table->addWidget(row.objectiveTemplate, number, TemplateColumn);
    table->addWidget(row.target, number, TargetColumn);
    table->addWidget(row.weight, number, WeightColumn);
    table->addWidget(row.remove, number, RemoveColumn);
    this->Rows.push_back(row);
  }
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addLayout(table);
  layout->addWidget(this->Add);
  layout->addWidget(this->Problem);

  QObject::connect(this->Add, &QToolButton::clicked, this, &pqTautlineObjectives::add);
  const auto changed = QOverload<int>::of(&QComboBox::currentIndexChanged);
  for (const Row& row : this->Rows)
  {
    for (QComboBox* box : { row.metric, row.objectiveTemplate, row.target })
    {
      QObject::connect(box, changed, this, &pqTautlineObjectives::refresh);
      QObject::connect(box, changed, this, &pqTautlineObjectives::changeAvailable);
    }
    QObject::connect(row.weight, &pqDoubleLineEdit::textChangedAndEditingFinished, this,
      &pqTautlineObjectives::changeAvailable);
  }
  const auto counted = QOverload<int>::of(&QSpinBox::valueChanged);
  QObject::connect(this->Number, counted, this, &pqTautlineObjectives::refresh);
  QObject::connect(this->Number, counted, this, &pqTautlineObjectives::changeAvailable);
  this->Observer->Connect(smproxy->GetProperty(ScalarizationProperty),
    vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(refresh()));
  this->refresh();
}

//------------------------------------------------------------------------------
pqTautlineObjectives::~pqTautlineObjectives() = default;

//------------------------------------------------------------------------------
pqTautlineObjectives::Row pqTautlineObjectives::makeRow(int number)
{
  const auto choice = [&](const char* property)
  {
    auto* box = new QComboBox(this);
    box->setObjectName(nameOf(property, number));
    // As narrow as the panel; the list that opens is as wide as its texts.
    constexpr int fewestLetters = 3;
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(fewestLetters);
    this->addPropertyLink(box, box->objectName().toUtf8().constData());
    box->view()->setMinimumWidth(box->view()->sizeHintForColumn(0));
    return box;
  };
  Row row;
  row.metric = choice("Metric");
  row.objectiveTemplate = choice("Template");
  row.target = choice("Target");
  row.weight = new pqDoubleLineEdit(this);
  row.weight->setObjectName(nameOf("Weight", number));
  row.weight->setValidator(new QDoubleValidator(row.weight));
  row.weight->setMinimumWidth(row.weight->fontMetrics().horizontalAdvance("0.000"));
  this->pqPropertyWidget::addPropertyLink(row.weight, "text2",
    SIGNAL(textChangedAndEditingFinished()),
    this->propertyGroup()->GetProperty(row.weight->objectName().toUtf8().constData()));
  row.remove = new QToolButton(this);
  row.remove->setObjectName(nameOf("Remove", number));
  row.remove->setText(QString(QChar(0x2212))); // minus
  const int index = number - 1;
  QObject::connect(row.remove, &QToolButton::clicked, this, [this, index] { this->remove(index); });
  return row;
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
int pqTautlineObjectives::valueOf(const QComboBox* box, const char* property, int number) const
{
  auto* values = this->propertyGroup()
                   ->GetProperty(nameOf(property, number).toUtf8().constData())
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
void pqTautlineObjectives::refresh()
{
  const int count = this->Number->value();
  const int scalarization =
    vtkSMUncheckedPropertyHelper(this->proxy(), ScalarizationProperty).GetAsInt();
  const QString noWeight = QString::fromStdString(tautline::weightReason(scalarization, count));
  QStringList problems;
  for (int i = 0; i < static_cast<int>(this->Rows.size()); ++i)
  {
    const Row& row = this->Rows[i];
    const std::initializer_list<QWidget*> widgets = { row.metric, row.objectiveTemplate, row.target,
      row.weight, row.remove };
    for (QWidget* widget : widgets)
    {
      widget->setVisible(i < count);
    }
    const int number = i + 1;
    const int metric = this->valueOf(row.metric, "Metric", number);
    const auto check = [&](QComboBox* box, const char* property, auto reason)
    {
      auto* values = this->propertyGroup()
                       ->GetProperty(nameOf(property, number).toUtf8().constData())
                       ->FindDomain<vtkSMEnumerationDomain>();
      std::vector<QString> reasons;
      for (unsigned int entry = 0; entry < values->GetNumberOfEntries(); ++entry)
      {
        reasons.push_back(QString::fromStdString(reason(metric, values->GetEntryValue(entry))));
      }
      const QString problem = this->restrict(box, reasons);
      if (i < count && !problem.isEmpty())
      {
        problems << QString("Objective %1: %2").arg(number).arg(problem);
      }
    };
    check(row.metric, "Metric", [](int, int value) { return tautline::metricReason(value); });
    check(row.objectiveTemplate, "Template", tautline::templateReason);
    check(row.target, "Target", tautline::targetReason);
    row.weight->setEnabled(noWeight.isEmpty());
    row.weight->setToolTip(noWeight.isEmpty() ? "The weight of the objective; above 0." : noWeight);
    row.remove->setEnabled(count > 1);
    row.remove->setToolTip(count > 1 ? "Remove this objective." : "At least one objective stays.");
  }
  const int most = this->Number->maximum();
  this->Add->setEnabled(count < most);
  this->Add->setToolTip(count < most
      ? "Add an objective, to improve several metrics simultaneously."
      : QString("At most %1 objectives.").arg(most));
  this->Problem->setText(problems.join("\n"));
  this->Problem->setVisible(!problems.isEmpty());
}
