// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineElementTable.h"

#include "HiddenSelection.h"

#include "pqOutputPort.h"

#include "vtkSMSourceProxy.h"

#include <QHeaderView>
#include <QSignalBlocker>
#include <QStringList>
#include <QTableWidget>

#include <algorithm>
#include <cmath>
#include <map>

namespace
{
enum Columns
{
  Rank,
  Cell,
  Block,
  Finding,
  FirstArray
};
constexpr int ElementRole = Qt::UserRole; ///< the number of the element in the list
constexpr int Digits = 6;

/// A table cell that is sorted by its number, not by its text.
class NumberItem : public QTableWidgetItem
{
public:
  explicit NumberItem(double value)
    : QTableWidgetItem(QString::number(value, 'g', Digits))
    , Value(value)
  {
    constexpr double exact = 1e15; // for integers such as ids
    if (std::floor(value) == value && std::abs(value) < exact)
    {
      this->setText(QString::number(value, 'f', 0));
    }
    this->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  }

  bool operator<(const QTableWidgetItem& other) const override
  {
    const auto* number = dynamic_cast<const NumberItem*>(&other);
    return number ? this->Value < number->Value : QTableWidgetItem::operator<(other);
  }

private:
  double Value;
};

/// The order of the columns: the array of the list comes first.
std::vector<std::size_t> arrayOrder(const tautline::ElementValues& cells, const std::string& first)
{
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < cells.arrays.size(); ++i)
  {
    order.insert(cells.arrays[i] == first ? order.begin() : order.end(), i);
  }
  return order;
}
}

//------------------------------------------------------------------------------
pqTautlineElementTable::pqTautlineElementTable(QWidget* parentObject)
  : Superclass("Tautline Elements", parentObject)
  , Table(new QTableWidget(this))
{
  this->setObjectName("TautlineElements");
  this->Table->setObjectName("Table");
  this->Table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  this->Table->setSelectionBehavior(QAbstractItemView::SelectRows);
  this->Table->setSelectionMode(QAbstractItemView::SingleSelection);
  this->Table->verticalHeader()->hide();
  constexpr int spacing = 4; // pixels
  const int rowHeight = this->fontMetrics().height() + spacing;
  this->Table->verticalHeader()->setDefaultSectionSize(rowHeight);
  this->Table->horizontalHeader()->setToolTip("Click to sort by this column.");
  // Only a few rows: the mesh needs the space.
  constexpr int leastRows = 3;
  this->Table->setMinimumHeight((leastRows + 1) * rowHeight);
  this->setWidget(this->Table);
  this->hide();
  QObject::connect(
    this->Table, &QTableWidget::itemSelectionChanged, this, &pqTautlineElementTable::choose);
  QObject::connect(this, &QDockWidget::visibilityChanged, this,
    [this](bool visible)
    {
      if (visible)
      {
        Q_EMIT this->shown();
      }
    });
}

//------------------------------------------------------------------------------
QString pqTautlineElementTable::titles() const
{
  QStringList texts;
  for (int column = 0; column < this->Table->columnCount(); ++column)
  {
    texts << this->Table->horizontalHeaderItem(column)->text();
  }
  return texts.join("; ");
}

//------------------------------------------------------------------------------
QString pqTautlineElementTable::firstRow() const
{
  QStringList texts;
  for (int column = 0; this->Table->rowCount() > 0 && column < this->Table->columnCount(); ++column)
  {
    const QTableWidgetItem* item = this->Table->item(0, column);
    texts << (item ? item->text() : QString());
  }
  return texts.join("; ");
}

//------------------------------------------------------------------------------
void pqTautlineElementTable::addColumn(const QString& title)
{
  const int column = this->Table->columnCount();
  this->Table->insertColumn(column);
  this->Table->setHorizontalHeaderItem(column, new QTableWidgetItem(title));
}

//------------------------------------------------------------------------------
void pqTautlineElementTable::setCell(int row, int column, const QVariant& value)
{
  const bool text = value.userType() == QMetaType::QString;
  QTableWidgetItem* item =
    text ? new QTableWidgetItem(value.toString()) : new NumberItem(value.toDouble());
  item->setData(ElementRole, row);
  this->Table->setItem(row, column, item);
}

//------------------------------------------------------------------------------
void pqTautlineElementTable::fill(pqOutputPort* mesh, const tautline::WorstElementList* list)
{
  const QSignalBlocker blocker(this->Table);
  // While rows are added, they must not move.
  this->Table->setSortingEnabled(false);
  this->Table->clear();
  this->Table->setRowCount(0);
  this->Table->setColumnCount(0);
  for (const char* title : { "Rank", "Cell", "Block", "Finding" })
  {
    this->addColumn(title);
  }
  if (!mesh || !list || list->elements.empty())
  {
    return;
  }
  const tautline::ElementNumbers numbers(mesh);
  std::vector<tautline::ElementName> names;
  for (const tautline::WorstElementEntry& entry : list->elements)
  {
    names.push_back(entry.name);
  }
  std::string problem;
  const auto selection = tautline::selectionOf(mesh, names, problem);
  const tautline::ElementValues cells =
    selection ? tautline::HiddenSelection(mesh, selection).cells() : tautline::ElementValues();
  std::map<vtkTypeInt64, const tautline::ElementValues::Row*> rows;
  for (const tautline::ElementValues::Row& row : cells.rows)
  {
    rows[numbers.of(row.name)] = &row;
  }
  const std::vector<std::size_t> order = arrayOrder(cells, list->array);
  for (const std::size_t array : order)
  {
    this->addColumn(QString::fromStdString(cells.arrays[array]));
  }
  this->Table->setRowCount(static_cast<int>(names.size()));
  bool blocks = false;
  for (int row = 0; row < this->Table->rowCount(); ++row)
  {
    const tautline::WorstElementEntry& entry = list->elements[static_cast<std::size_t>(row)];
    const QString block = QString::fromStdString(numbers.blockOf(entry.name));
    blocks = blocks || !block.isEmpty();
    this->setCell(row, Rank, row + 1);
    this->setCell(row, Cell, static_cast<double>(entry.name.cell));
    this->setCell(row, Block, block);
    this->setCell(row, Finding, QString::fromStdString(entry.text));
    const auto found = rows.find(numbers.of(entry.name));
    for (std::size_t i = 0; found != rows.end() && i < order.size(); ++i)
    {
      const double value = found->second->values[order[i]];
      if (!std::isnan(value))
      {
        this->setCell(row, FirstArray + static_cast<int>(i), value);
      }
    }
  }
  this->Table->setColumnHidden(Block, !blocks);
  this->Table->resizeColumnsToContents();
  this->Table->sortByColumn(Rank, Qt::AscendingOrder);
  this->Table->setSortingEnabled(true);
}

//------------------------------------------------------------------------------
void pqTautlineElementTable::mark(int element)
{
  const QSignalBlocker blocker(this->Table);
  for (int row = 0; row < this->Table->rowCount(); ++row)
  {
    if (this->Table->item(row, Rank)->data(ElementRole).toInt() == element)
    {
      this->Table->selectRow(row);
      return;
    }
  }
  this->Table->clearSelection();
}

//------------------------------------------------------------------------------
void pqTautlineElementTable::choose()
{
  const QList<QTableWidgetItem*> selected = this->Table->selectedItems();
  if (!selected.isEmpty())
  {
    Q_EMIT this->chosen(selected.front()->data(ElementRole).toInt());
  }
}
