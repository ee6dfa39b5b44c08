// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineElementTable
 * @brief The list of worst elements as a table that can be sorted by any column.
 *
 * A row shows the rank, the cell number, its block, its defect, and the values of the cell arrays
 * of the output: metrics, grade, ids from the file. A click on a row selects the element. The
 * toolbar of the worst elements creates and fills the dock.
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
  /// For tests: the column titles, and the texts of the first visible row, joined with "; ".
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
  /// The dock appeared and must be filled.
  void shown();

private:
  void addColumn(const QString& title);
  void setCell(int row, int column, const QVariant& value);
  void choose();

  QTableWidget* Table;
};

#endif
