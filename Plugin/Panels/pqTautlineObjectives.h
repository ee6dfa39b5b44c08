// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineObjectives
 * @brief The objectives of Optimize Mesh: one line in the panel, and a dialog that edits them.
 *
 * The dialog has a table with metric, template, target and weight in a row, and the scalarization.
 * One button adds an objective, one in each row removes it. Fields that do not apply are gray, with
 * the reason as a tool tip: targets of metrics that do not compare with a target, a target size for
 * metrics without size, templates that would spoil the mesh, weights where the scalarization has
 * none. A choice that the filter will reject or ignore is named below the table and in the panel.
 * Cancel restores the objectives as they were when the dialog was opened.
 *
 * In the XML of a proxy: `panel_widget="tautline_objectives"` on the group of NumberOfObjectives,
 * Scalarization and of Metric1, Template1, Target1, Weight1, Metric2, ...
 */

#ifndef pqTautlineObjectives_h
#define pqTautlineObjectives_h

#include "pqPropertyGroupWidget.h"

#include <QStringList>

#include <vector>

class QComboBox;
class QDialog;
class QLabel;
class QSpinBox;
class QToolButton;
class pqDoubleLineEdit;

class pqTautlineObjectives : public pqPropertyGroupWidget
{
  Q_OBJECT
  using Superclass = pqPropertyGroupWidget;

public:
  pqTautlineObjectives(vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqTautlineObjectives() override;

private Q_SLOTS:
  /// Opens the dialog.
  void edit();
  void add();
  /// Shows as many rows as there are objectives, and what applies in each.
  void refresh();

private:
  struct Row
  {
    QComboBox* metric;
    QComboBox* objectiveTemplate;
    QComboBox* target;
    pqDoubleLineEdit* weight;
    QToolButton* remove;
  };
  /// Makes the widgets of the dialog.
  void makeDialog();
  QComboBox* makeChoice(const QString& property);
  Row makeRow(int number);
  void remove(int index);
  /// The value of an enumeration that a combo box shows.
  int valueOf(const QComboBox* box, const QString& property) const;
  /// Grays out the choices of a combo box that do not apply. @return why the current one does not
  QString restrict(QComboBox* box, const std::vector<QString>& problems);

  ///@{
  /// The values of all widgets.
  QStringList state() const;
  void setState(const QStringList& state);
  ///@}
  /// The objectives in a line: "Inverse mean ratio, Minimum angle (Weighted sum)".
  QString summary() const;
  /// Grays out the fields of a row that do not apply. @return the problem of the row, or ""
  QString refreshRow(int index, int count, const QString& noWeight);

  std::vector<Row> Rows;
  QLabel* Text;    ///< the line in the panel
  QLabel* Warning; ///< the problem in the panel
  QDialog* Dialog;
  QSpinBox* Number; ///< hidden: the property
  QComboBox* Scalarization;
  QToolButton* Add;
  QLabel* Problem;
};

#endif
