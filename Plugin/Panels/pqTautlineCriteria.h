// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineCriteria
 * @brief Chooses the quality criteria of a filter: none, a preset, or one's own.
 *
 * The combo box has the presets and takes the name of a file on the server. Edit opens the criteria
 * as a table, beginning with the chosen ones; Load and Save read and write a JSON file on the
 * computer of the client. Edited and loaded criteria are stored in the property as text, so that
 * state files and scripts have them.
 *
 * In the XML of a proxy: `panel_widget="tautline_criteria"` on a string property.
 */

#ifndef pqTautlineCriteria_h
#define pqTautlineCriteria_h

#include "pqPropertyWidget.h"

class QComboBox;
class QLabel;
class QToolButton;
class pqOutputPort;

class pqTautlineCriteria : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QString criteria READ criteria WRITE setCriteria NOTIFY criteriaChanged)
  using Superclass = pqPropertyWidget;

public:
  pqTautlineCriteria(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqTautlineCriteria() override;

  ///@{
  /// The value of the property: "", the name of a preset or of a file, or JSON.
  const QString& criteria() const { return this->Criteria; }
  void setCriteria(const QString& criteria);
  ///@}

Q_SIGNALS:
  void criteriaChanged();

private Q_SLOTS:
  void chosen(const QString& text);
  void edit();
  void load();
  void save();
  /// Colors the mesh by Grade in the views that show it.
  void color();
  void enableColor();

private:
  /// The output with the array Grade; null before the elements are graded.
  pqOutputPort* gradedMesh() const;
  /// The criteria chosen as JSON; "" if there are none or they are in a file on the server.
  QString json() const;
  void showProblem(const QString& problem);

  QString Criteria;
  QComboBox* Choice;
  QToolButton* Color;
  QToolButton* Save;
  QLabel* Problem;
};

#endif
