// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineElementTable
 * @brief The list of the worst elements as a table that can be sorted by each column.
 *
 * A row has the rank, the number of the cell, its block, what is wrong with it, and the values of
 * the cell arrays of the output: metrics, grade, ids of the file. A click on a row selects the
 * element. The tool bar of the worst elements makes and fills the dock.
 */

#ifndef pqTautlineElementTable_h
#define pqTautlineElementTable_h

#include "WorstElements.h"

#include <QDockWidget>

class QTableWidget;
class pqOutputPort;

class pqTautlineElementTable : public QDockWidget
{
  Q_OBJECT
  using Superclass = QDockWidget;

  ///@{
  /// For tests: the titles of the columns, and the texts of the first row shown; with "; ".
  Q_PROPERTY(QString titles READ titles)
  Q_PROPERTY(QString firstRow READ firstRow)
  ///@}

public:
  explicit pqTautlineElementTable(QWidget* parent = nullptr);

  QString titles() const;
  QString firstRow() const;

  /// Shows a list of elements of an output; an empty table for null.
  void fill(pqOutputPort* mesh, const tautline::WorstElementList* list);

  /// Marks the row of an element; none for -1. Emits nothing.
  void mark(int element);

Q_SIGNALS:
  /// The user chose an element of the list.
  void chosen(int element);
  /// The dock appeared: it is to be filled.
  void shown();

private:
  void addColumn(const QString& title);
  void setCell(int row, int column, const QVariant& value);
  void choose();

  QTableWidget* Table;
};

#endif
