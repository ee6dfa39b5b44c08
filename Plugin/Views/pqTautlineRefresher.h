// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineRefresher
 * @brief Shows the results of the latest run: Summary, Notice and the numbers of a panel.
 *
 * ParaView updates the information properties of a filter when its panel is built or applied.
 * However, Apply precedes the run of the filter, so a panel would show the results of the previous
 * run. This object, started by the plugin in the GUI, updates the information properties of
 * Tautline's proxies after each update of their data. Other proxies are unchanged.
 */

#ifndef pqTautlineRefresher_h
#define pqTautlineRefresher_h

#include <QObject>

class pqPipelineSource;

class pqTautlineRefresher : public QObject
{
  Q_OBJECT

public:
  ///@{
  /// Called by ParaView when the plugin is loaded in the GUI, and before it is unloaded.
  void startup();
  void shutdown();
  ///@}

private Q_SLOTS:
  void refresh(pqPipelineSource* source);
};

#endif
