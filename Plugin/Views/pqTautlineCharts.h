// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineCharts
 * @brief Sets up the charts of Tautline's outputs when they are shown for the first time.
 *
 * History: the objective on the left axis, logarithmic if possible, and the other series on the
 * right axis, because their magnitudes differ. Distribution: the counts over the values of the
 * metric instead of the row numbers. Study: the times in the order of the ranks, with the names of
 * the combinations. After Apply, the view of the mesh is active again, not the added chart: the
 * mesh of the next filter then appears there. A filter that rejects its input opens no chart until
 * it has a result. A run drawn by the dock opens none. The charts of a loaded state remain
 * unchanged. The plugin starts the object in the GUI.
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

  /// Displays opened by the first Apply of filters; charts among them may be unnecessary.
  QList<QPointer<pqDataRepresentation>> OpenedByApply;
};

#endif
