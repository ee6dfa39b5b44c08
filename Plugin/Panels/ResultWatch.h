// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::ResultWatch
 * @brief Calls a function of a panel's widget when its filter has a new result.
 *
 * The function may fetch outputs: it is called after the update of the pipeline, not within it. The
 * results of a filter whose widget is hidden wait until the widget is shown: ParaView keeps the
 * panels of all filters, and each fetch transfers data.
 */

#ifndef tautline_ResultWatch_h
#define tautline_ResultWatch_h

#include "pqPipelineSource.h"

#include <QObject>
#include <QPointer>

#include <functional>

class QWidget;
class vtkSMProxy;

namespace tautline
{

class ResultWatch : public QObject
{
  Q_OBJECT

public:
  /// @param widget the widget to show the result in, which owns the watch
  /// @param proxy the filter
  /// @param refresh shows the result; also called when the widget is first shown, possibly before
  /// the filter is executed
  ResultWatch(QWidget* widget, vtkSMProxy* proxy, std::function<void()> refresh);

  /// The filter, or null if it is not in the pipeline.
  pqPipelineSource* source() const { return this->Source; }

private Q_SLOTS:
  void dataUpdated(pqPipelineSource* source);
  void refreshIfVisible();

private:
  bool eventFilter(QObject* watched, QEvent* event) override;

  QWidget* Widget;
  vtkSMProxy* Proxy;
  std::function<void()> Refresh;
  QPointer<pqPipelineSource> Source;
  bool Stale = true;
};

} // namespace tautline

#endif
