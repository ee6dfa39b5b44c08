// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineCharts
 * @brief Sets up the charts of Tautline's outputs when they are shown for the first time.
 *
 * History: the objective on a left axis, logarithmic if possible, the other series on the right
 * axis, since their magnitudes differ. Distribution: the counts over the values of the metric
 * instead of the numbers of the rows. Study: the times in the order of the ranks, with the names
 * of the combinations. After Apply, the view of the mesh is active again, not the chart that was
 * added: the mesh of the next filter then appears there. A filter that refuses its input opens no
 * chart; it does once it has a result. A run that the dock draws opens none. The charts of a
 * loaded state stay as they are. The plugin starts the object in the GUI.
 */

#ifndef pqTautlineCharts_h
#define pqTautlineCharts_h

#include "pqDataRepresentation.h"

#include <QList>
#include <QObject>
#include <QPointer>

class pqPipelineSource;
class pqRepresentation;
class pqServerManagerModelItem;

class pqTautlineCharts : public QObject
{
  Q_OBJECT

public:
  ///@{
  /// Called by ParaView when the plugin is loaded in the GUI, and before it is unloaded.
  void startup();
  void shutdown();
  ///@}

private Q_SLOTS:
  void added(pqRepresentation* shown);
  void applied();
  void updated(pqPipelineSource* source);
  void stateChanged(pqServerManagerModelItem* item);

private:
  void arrange(pqDataRepresentation* chart);

  /// What the first Apply of filters has shown: charts among them may be needless.
  QList<QPointer<pqDataRepresentation>> OpenedByApply;
};

#endif
