// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineMetrics
 * @brief Chooses quality metrics from a list by purpose, which a line of text narrows.
 *
 * Groups with a chosen metric are open at first, the others are closed. After a run, the second
 * column has the number of bad elements beside each metric: with criteria, the elements that fail
 * them, otherwise the elements outside the acceptable range.
 *
 * In the XML of a proxy: `panel_widget="tautline_metrics"` on an integer property with an
 * enumeration that may have several values. The counts are on the outputs Statistics and Criteria
 * of the proxy, if it has them.
 */

#ifndef pqTautlineMetrics_h
#define pqTautlineMetrics_h

#include "pqPropertyWidget.h"

#include "vtkSmartPointer.h"

#include <QList>
#include <QVariant>

class QLineEdit;
class QTreeWidget;
class QTreeWidgetItem;
class vtkEventQtSlotConnect;
class vtkSMEnumerationDomain;

namespace tautline
{
class ResultWatch;
}

class pqTautlineMetrics : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QList<QList<QVariant>> values READ values WRITE setValues NOTIFY valuesChanged)
  using Superclass = pqPropertyWidget;

public:
  pqTautlineMetrics(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqTautlineMetrics() override;

  ///@{
  /// A pair of label and whether it is chosen for each metric, as ParaView has selections.
  QList<QList<QVariant>> values() const;
  void setValues(const QList<QList<QVariant>>& values);
  ///@}

Q_SIGNALS:
  void valuesChanged();

private Q_SLOTS:
  /// Makes the list of the metrics that the property may have.
  void fill();
  /// Shows the metrics whose label has the text, or whose group has it in its title.
  void narrow(const QString& text);
  void itemChanged(QTreeWidgetItem* item);
  /// Writes the numbers of bad elements beside the metrics.
  void count();

private:
  /// The item of each metric, in the order of the domain.
  QList<QTreeWidgetItem*> items() const;
  void openChosen();

  vtkSMEnumerationDomain* Domain;
  QLineEdit* Filter;
  QTreeWidget* Tree;
  tautline::ResultWatch* Watch = nullptr;
  vtkSmartPointer<vtkEventQtSlotConnect> Observer;
};

#endif
