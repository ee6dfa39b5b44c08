// SPDX-License-Identifier: BSD-3-Clause
#include "CriteriaDialog.h"

#include "tautline/Quality/Criteria.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTableWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include <map>

namespace tautline
{
namespace
{

enum Columns
{
  MetricColumn,
  TypeColumn,
  WeightColumn,
  FirstLimit
};
const QStringList LimitNames = { "ideal", "good", "warn", "fail", "worst" };

QStringList typeNames()
{
  QStringList names = { "all" };
  for (const CellTopology& topology : topologies())
  {
    names << topology.name;
  }
  return names;
}

QString textOf(const QJsonValue& value)
{
  return value.isDouble() ? QString::number(value.toDouble(), 'g', 12) : QString();
}

/// A number, or the text itself, which the kernel rejects by name.
QJsonValue valueOf(const QString& text)
{
  bool isNumber = false;
  const double number = text.toDouble(&isNumber);
  return isNumber ? QJsonValue(number) : QJsonValue(text);
}

} // anonymous namespace

//------------------------------------------------------------------------------
CriteriaDialog::CriteriaDialog(
  const QString& json, const QStringList& metrics, QWidget* parentObject)
  : QDialog(parentObject)
  , Metrics(metrics)
  , Name(new QLineEdit(this))
  , Table(new QTableWidget(this))
  , Problem(new QLabel(this))
  , Buttons(new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this))
{
  this->setObjectName("CriteriaDialog");
  this->setWindowTitle("Quality Criteria");
  this->resize(760, 360);
  this->Name->setObjectName("Name");
  this->Table->setObjectName("Table");
  this->Table->setColumnCount(FirstLimit + LimitNames.size());
  this->Table->setHorizontalHeaderLabels(QStringList{ "Metric", "Cells", "Weight" } + LimitNames);
  this->Table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  this->Table->setSelectionBehavior(QAbstractItemView::SelectRows);
  this->Problem->setObjectName("Problem");
  this->Problem->setWordWrap(true);
  this->Buttons->setObjectName("Buttons");
  auto* add = new QToolButton(this);
  add->setObjectName("Add");
  add->setText("&Add Row");
  auto* remove = new QToolButton(this);
  remove->setObjectName("Remove");
  remove->setText("&Remove Row");

  auto* top = new QHBoxLayout;
  auto* name = new QLabel("&Name", this);
  name->setBuddy(this->Name);
  top->addWidget(name);
  top->addWidget(this->Name, 1);
  top->addWidget(add);
  top->addWidget(remove);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(top);
  layout->addWidget(this->Table, 1);
  layout->addWidget(this->Problem);
  layout->addWidget(this->Buttons);

  const QJsonObject criteria = QJsonDocument::fromJson(json.toUtf8()).object();
  this->Name->setText(criteria["name"].toString());
  const QJsonValue source = criteria["source"];
  QStringList lines;
  for (const QJsonValue& line : source.toArray())
  {
    lines << line.toString();
  }
  this->Source = source.isArray() ? lines.join(" ") : source.toString();
  for (const QJsonValue& item : criteria["criteria"].toArray())
  {
    const QJsonObject criterion = item.toObject();
    const QJsonObject types = criterion["limits"].toObject();
    const QString metric = criterion["metric"].toString();
    const MetricInfo* info = findMetric(metric.toStdString());
    const QString weight = criterion.contains("weight") ? textOf(criterion["weight"]) : "1";
    for (auto type = types.begin(); type != types.end(); ++type)
    {
      QStringList limits;
      for (const QString& name : LimitNames)
      {
        limits << textOf(type.value().toObject()[name]);
      }
      this->insertRow(info ? info->name : metric, type.key(), weight, limits);
    }
  }

  QObject::connect(add, &QToolButton::clicked, this, &CriteriaDialog::addRow);
  QObject::connect(remove, &QToolButton::clicked, this, &CriteriaDialog::removeRow);
  QObject::connect(this->Table, &QTableWidget::itemChanged, this, &CriteriaDialog::check);
  QObject::connect(this->Buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  QObject::connect(this->Buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  this->check();
}

//------------------------------------------------------------------------------
void CriteriaDialog::insertRow(
  const QString& metric, const QString& type, const QString& weight, const QStringList& limits)
{
  const int row = this->Table->rowCount();
  this->Table->insertRow(row);
  const auto choice = [&](int column, const QStringList& items, const QString& current)
  {
    auto* box = new QComboBox(this->Table);
    box->setObjectName(QString("%1_%2").arg(column).arg(row));
    box->addItems(items);
    if (!items.contains(current)) // the problem below names it
    {
      box->addItem(current);
    }
    box->setCurrentText(current);
    QObject::connect(
      box, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &CriteriaDialog::check);
    this->Table->setCellWidget(row, column, box);
  };
  choice(MetricColumn, this->Metrics, metric);
  choice(TypeColumn, typeNames(), type);
  this->Table->setItem(row, WeightColumn, new QTableWidgetItem(weight));
  for (int i = 0; i < LimitNames.size(); ++i)
  {
    this->Table->setItem(row, FirstLimit + i, new QTableWidgetItem(limits.value(i)));
  }
}

//------------------------------------------------------------------------------
void CriteriaDialog::addRow()
{
  // A new row has the preset limits of the first metric, to be edited.
  this->insertRow(this->Metrics.first(), "all", "1", { "1", "1.5", "3", "10", "100" });
  this->check();
}

//------------------------------------------------------------------------------
void CriteriaDialog::removeRow()
{
  this->Table->removeRow(this->Table->currentRow());
  this->check();
}

//------------------------------------------------------------------------------
QString CriteriaDialog::json() const
{
  // Rows of the same metric are one criterion, with the weight of the first of them.
  QStringList order;
  std::map<QString, QJsonObject> byMetric;
  const auto choice = [this](int row, int column)
  {
    auto* box = qobject_cast<QComboBox*>(this->Table->cellWidget(row, column));
    return box ? box->currentText() : QString();
  };
  const auto text = [this](int row, int column)
  {
    const QTableWidgetItem* item = this->Table->item(row, column);
    return item ? item->text() : QString();
  };
  for (int row = 0; row < this->Table->rowCount(); ++row)
  {
    const QString metric = choice(row, MetricColumn);
    QJsonObject& criterion = byMetric[metric];
    if (!order.contains(metric))
    {
      order << metric;
      criterion["metric"] = metric;
      criterion["weight"] = valueOf(text(row, WeightColumn));
    }
    QJsonObject limits;
    for (int i = 0; i < LimitNames.size(); ++i)
    {
      limits[LimitNames[i]] = valueOf(text(row, FirstLimit + i));
    }
    QJsonObject types = criterion["limits"].toObject();
    types[choice(row, TypeColumn)] = limits;
    criterion["limits"] = types;
  }
  QJsonArray criteria;
  for (const QString& metric : order)
  {
    criteria.append(byMetric[metric]);
  }
  QJsonObject all;
  all["name"] = this->Name->text();
  all["source"] = this->Source;
  all["criteria"] = criteria;
  return QString::fromUtf8(QJsonDocument(all).toJson());
}

//------------------------------------------------------------------------------
void CriteriaDialog::check()
{
  QString problem;
  try
  {
    parseCriteria(this->json().toStdString());
  }
  catch (const Error& error)
  {
    problem = error.what();
  }
  this->Problem->setText(problem);
  this->Buttons->button(QDialogButtonBox::Ok)->setEnabled(problem.isEmpty());
}

} // namespace tautline
