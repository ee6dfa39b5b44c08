// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineMetrics.h"

#include "FetchOutput.h"
#include "MetricGroups.h"
#include "ResultWatch.h"

#include "tautline/Quality/Metrics.h"

#include "pqTreeWidget.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkEventQtSlotConnect.h"
#include "vtkSMEnumerationDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMProxy.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <QHeaderView>
#include <QLineEdit>
#include <QSignalBlocker>
#include <QTreeWidgetItem>
#include <QVBoxLayout>

#include <algorithm>
#include <map>
#include <string>

namespace
{
constexpr int MetricColumn = 0;
constexpr int CountColumn = 1;
constexpr int Rows = 9;             // of the list
constexpr int Place = Qt::UserRole; // of an entry in the domain
const QColor Bad(0xb0, 0x00, 0x20);

/// The numbers in a column by the names of the metrics in another one.
std::map<QString, double> countsOf(vtkDataObject* output, const char* column)
{
  auto* table = vtkTable::SafeDownCast(output);
  auto* names = table ? vtkStringArray::SafeDownCast(table->GetColumnByName("Metric")) : nullptr;
  auto* numbers = table ? vtkDataArray::SafeDownCast(table->GetColumnByName(column)) : nullptr;
  std::map<QString, double> counts;
  for (vtkIdType row = 0; names && numbers && row < names->GetNumberOfValues(); ++row)
  {
    counts[QString::fromStdString(names->GetValue(row))] += numbers->GetComponent(row, 0);
  }
  return counts;
}
}

//------------------------------------------------------------------------------
pqTautlineMetrics::pqTautlineMetrics(
  vtkSMProxy* smproxy, vtkSMProperty* smproperty, QWidget* parentObject)
  : Superclass(smproxy, parentObject)
  , Domain(smproperty->FindDomain<vtkSMEnumerationDomain>())
  , Filter(new QLineEdit(this))
  , Tree(new QTreeWidget(this))
  , Observer(vtkSmartPointer<vtkEventQtSlotConnect>::New())
{
  this->setShowLabel(false);
  this->Filter->setObjectName("Filter");
  this->Filter->setPlaceholderText("Find a metric");
  this->Filter->setToolTip("Show only the metrics whose name has this text.");
  this->Filter->setClearButtonEnabled(true);
  this->Tree->setObjectName("TreeWidget");
  this->Tree->setColumnCount(2);
  this->Tree->setHeaderLabels({ "Metrics", "Bad" });
  this->Tree->headerItem()->setToolTip(MetricColumn, pqPropertyWidget::getTooltip(smproperty));
  this->Tree->headerItem()->setToolTip(CountColumn,
    "Elements that fail the criteria or, without criteria, are outside the acceptable range.");
  this->Tree->header()->setStretchLastSection(false);
  this->Tree->header()->setSectionResizeMode(MetricColumn, QHeaderView::Stretch);
  this->Tree->header()->setSectionResizeMode(CountColumn, QHeaderView::ResizeToContents);
  this->Tree->setUniformRowHeights(true);
  const int row = this->Tree->fontMetrics().lineSpacing() + 4;
  this->Tree->setFixedHeight((Rows + 1) * row + 2 * this->Tree->frameWidth());

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  layout->addWidget(this->Filter);
  layout->addWidget(this->Tree);

  this->fill();
  QObject::connect(this->Filter, &QLineEdit::textChanged, this, &pqTautlineMetrics::narrow);
  QObject::connect(this->Tree, &QTreeWidget::itemChanged, this, &pqTautlineMetrics::itemChanged);
  if (this->Domain)
  {
    this->Observer->Connect(this->Domain, vtkCommand::DomainModifiedEvent, this, SLOT(fill()));
  }
  this->addPropertyLink(this, "values", SIGNAL(valuesChanged()), smproperty);
  this->openChosen();

  this->Watch = new tautline::ResultWatch(this, smproxy, [this] { this->count(); });
}

//------------------------------------------------------------------------------
pqTautlineMetrics::~pqTautlineMetrics() = default;

//------------------------------------------------------------------------------
void pqTautlineMetrics::fill()
{
  const QList<QList<QVariant>> chosen = this->values();
  const QSignalBlocker blocker(this->Tree);
  this->Tree->clear();
  std::vector<int> numbers;
  std::map<int, int> places;
  const unsigned int entries = this->Domain ? this->Domain->GetNumberOfEntries() : 0;
  for (unsigned int entry = 0; entry < entries; ++entry)
  {
    numbers.push_back(this->Domain->GetEntryValue(entry));
    places[numbers.back()] = static_cast<int>(entry);
  }
  for (const tautline::MetricGroup& group : tautline::groupMetrics(numbers))
  {
    auto* title = new QTreeWidgetItem(this->Tree, { QString::fromStdString(group.title) });
    title->setToolTip(MetricColumn, QString::fromStdString(group.purpose));
    title->setFlags(Qt::ItemIsEnabled);
    for (const int number : group.metrics)
    {
      const int place = places[number];
      const char* label = this->Domain->GetEntryText(static_cast<unsigned int>(place));
      auto* item = new QTreeWidgetItem(title, { QString::fromUtf8(label) });
      item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable | Qt::ItemIsSelectable);
      item->setData(MetricColumn, Place, place);
      item->setCheckState(MetricColumn, Qt::Unchecked);
      item->setTextAlignment(CountColumn, Qt::AlignRight);
      if (const tautline::MetricInfo* info = tautline::findMetric(label))
      {
        item->setToolTip(MetricColumn, QString("%1 = %2").arg(info->name, info->formula));
      }
    }
  }
  {
    // The choice is the same: it is not a change that the user could apply.
    const QSignalBlocker unchanged(this);
    this->setValues(chosen);
  }
  this->openChosen();
  this->narrow(this->Filter->text());
}

//------------------------------------------------------------------------------
QList<QTreeWidgetItem*> pqTautlineMetrics::items() const
{
  QList<QTreeWidgetItem*> all;
  for (int group = 0; group < this->Tree->topLevelItemCount(); ++group)
  {
    QTreeWidgetItem* title = this->Tree->topLevelItem(group);
    for (int i = 0; i < title->childCount(); ++i)
    {
      all << title->child(i);
    }
  }
  std::sort(all.begin(), all.end(),
    [](const QTreeWidgetItem* a, const QTreeWidgetItem* b)
    { return a->data(MetricColumn, Place).toInt() < b->data(MetricColumn, Place).toInt(); });
  return all;
}

//------------------------------------------------------------------------------
QList<QList<QVariant>> pqTautlineMetrics::values() const
{
  QList<QList<QVariant>> result;
  const auto all = this->items();
  for (const QTreeWidgetItem* item : all)
  {
    result << QList<QVariant>{ item->text(MetricColumn),
      item->checkState(MetricColumn) == Qt::Checked };
  }
  return result;
}

//------------------------------------------------------------------------------
void pqTautlineMetrics::setValues(const QList<QList<QVariant>>& values)
{
  std::map<QString, bool> chosen;
  for (const QList<QVariant>& value : values)
  {
    if (value.size() == 2)
    {
      chosen[value[0].toString()] = value[1].toBool();
    }
  }
  bool changed = false;
  {
    const QSignalBlocker blocker(this->Tree);
    const auto all = this->items();
    for (QTreeWidgetItem* item : all)
    {
      const Qt::CheckState state = chosen[item->text(MetricColumn)] ? Qt::Checked : Qt::Unchecked;
      changed = changed || item->checkState(MetricColumn) != state;
      item->setCheckState(MetricColumn, state);
    }
  }
  this->Tree->viewport()->update();
  if (changed)
  {
    Q_EMIT this->valuesChanged();
  }
}

//------------------------------------------------------------------------------
void pqTautlineMetrics::openChosen()
{
  const auto all = this->items();
  for (const QTreeWidgetItem* item : all)
  {
    if (item->checkState(MetricColumn) == Qt::Checked)
    {
      item->parent()->setExpanded(true);
    }
  }
}

//------------------------------------------------------------------------------
void pqTautlineMetrics::narrow(const QString& text)
{
  for (int group = 0; group < this->Tree->topLevelItemCount(); ++group)
  {
    QTreeWidgetItem* title = this->Tree->topLevelItem(group);
    const bool whole = title->text(MetricColumn).contains(text, Qt::CaseInsensitive);
    bool any = false;
    for (int i = 0; i < title->childCount(); ++i)
    {
      QTreeWidgetItem* item = title->child(i);
      const bool shown = whole || item->text(MetricColumn).contains(text, Qt::CaseInsensitive) ||
        item->toolTip(MetricColumn).startsWith(text, Qt::CaseInsensitive);
      item->setHidden(!shown);
      any = any || shown;
    }
    title->setHidden(!any);
    if (!text.isEmpty())
    {
      title->setExpanded(any);
    }
  }
}

//------------------------------------------------------------------------------
void pqTautlineMetrics::itemChanged(QTreeWidgetItem* item)
{
  if (item->parent())
  {
    Q_EMIT this->valuesChanged();
  }
}

//------------------------------------------------------------------------------
void pqTautlineMetrics::count()
{
  std::map<QString, double> outside, failed;
  if (pqPipelineSource* source = this->Watch->source())
  {
    outside = countsOf(tautline::fetchOutput(source, "Statistics"), "OutsideAcceptable");
    failed = countsOf(tautline::fetchOutput(source, "Criteria"), "Failed");
  }
  const QSignalBlocker blocker(this->Tree);
  const auto all = this->items();
  for (QTreeWidgetItem* item : all)
  {
    const std::string label = item->text(MetricColumn).toStdString();
    const tautline::MetricInfo* info = tautline::findMetric(label);
    const QString name = info ? QString(info->name) : QString();
    const auto& counts = failed.count(name) ? failed : outside;
    const auto found = counts.find(name);
    const bool known = found != counts.end();
    item->setText(CountColumn, known ? QString::number(found->second, 'f', 0) : QString());
    item->setForeground(CountColumn,
      known && found->second > 0 ? QBrush(Bad) : this->Tree->palette().brush(QPalette::Text));
    if (known)
    {
      item->parent()->setExpanded(true);
    }
  }
  this->Tree->viewport()->update();
}
