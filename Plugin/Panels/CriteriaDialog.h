// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::CriteriaDialog
 * @brief Edits quality criteria in a table: a row per metric and cell type.
 *
 * The columns are metric, cell type ("all" or one), weight and the five limits. Criteria that the
 * kernel rejects cannot be accepted: the problem is shown below the table.
 */

#ifndef tautline_CriteriaDialog_h
#define tautline_CriteriaDialog_h

#include <QDialog>
#include <QStringList>

class QDialogButtonBox;
class QLabel;
class QLineEdit;
class QTableWidget;

namespace tautline
{

class CriteriaDialog : public QDialog
{
  Q_OBJECT

public:
  /**
   * @param json the criteria to begin with; "" is an empty table
   * @param metrics the names of the metrics to choose from
   */
  CriteriaDialog(const QString& json, const QStringList& metrics, QWidget* parent = nullptr);

  /// The criteria in the table as JSON, see tautline/Quality/Criteria.h.
  QString json() const;

private Q_SLOTS:
  void check();
  void addRow();
  void removeRow();

private:
  void insertRow(
    const QString& metric, const QString& type, const QString& weight, const QStringList& limits);

  QStringList Metrics;
  QString Source;
  QLineEdit* Name;
  QTableWidget* Table;
  QLabel* Problem;
  QDialogButtonBox* Buttons;
};

} // namespace tautline

#endif
