// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineObjectives
 * @brief The objectives of Optimize Mesh as a table: metric, template, target and weight in a row.
 *
 * One button below the table adds an objective, one in each row removes it. What does not apply is
 * grey, with the reason as its tool tip: targets of metrics that do not compare with a target, a
 * target size for metrics without size, templates that would spoil the mesh, weights where the
 * scalarization has none. A choice that the filter will refuse or ignore is named below the table.
 *
 * In the XML of a proxy: `panel_widget="tautline_objectives"` on the group of NumberOfObjectives
 * and of Metric1, Template1, Target1, Weight1, Metric2, ... The proxy has the property
 * Scalarization.
 */

#ifndef pqTautlineObjectives_h
#define pqTautlineObjectives_h

#include "pqPropertyGroupWidget.h"

#include "vtkSmartPointer.h"

#include <vector>

class QComboBox;
class QLabel;
class QSpinBox;
class QToolButton;
class pqDoubleLineEdit;
class vtkEventQtSlotConnect;
class vtkSMProperty;

class pqTautlineObjectives : public pqPropertyGroupWidget
{
  Q_OBJECT
  using Superclass = pqPropertyGroupWidget;

public:
  pqTautlineObjectives(vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqTautlineObjectives() override;

private Q_SLOTS:
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
  Row makeRow(int number);
  void remove(int index);
  /// The value of an enumeration that a combo box of row `number` shows.
  int valueOf(const QComboBox* box, const char* property, int number) const;
  /// Makes the choices of a combo box grey that do not apply. @return why the current one does not
  QString restrict(QComboBox* box, const std::vector<QString>& problems);

  std::vector<Row> Rows;
  QSpinBox* Number; ///< hidden: the property
  QToolButton* Add;
  QLabel* Problem;
  vtkSmartPointer<vtkEventQtSlotConnect> Observer;
};

#endif
