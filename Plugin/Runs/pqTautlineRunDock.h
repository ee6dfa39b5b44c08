// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineRunDock
 * @brief Shows the progress of a Tautline filter and can stop its run.
 *
 * For Optimize Mesh, Untangle Mesh and Improve Mesh, it plots two values over the iterations, and
 * the button Stop ends the run with the best mesh so far. For other filters, it shows the progress.
 * The values come from the progress text, which a server also sends; see
 * vtkTautlineAlgorithm::ShowIteration(). ParaView drops texts in quick succession: after the run,
 * all iterations are plotted from the filter's output History.
 *
 * During a run, only this dock is redrawn: no events are processed. tautline::StopWindow detects
 * the clicks on Stop; RunControl.h describes how the run ends.
 *
 * The dock appears when one of the three filters is created for the first time.
 */

#ifndef pqTautlineRunDock_h
#define pqTautlineRunDock_h

#include <QDockWidget>

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

class QLabel;
class QProgressBar;
class QToolButton;
class pqPipelineSource;
class pqServer;
class pqServerManagerModelItem;

namespace tautline
{
class RunPlot;
class StopWindow;
}

class pqTautlineRunDock : public QDockWidget
{
  Q_OBJECT
  using Superclass = QDockWidget;

  ///@{
  /// For tests: whether the last run drew a curve, its last iteration, and the names of the two
  /// axes.
  Q_PROPERTY(bool drawn READ drawn)
  Q_PROPERTY(int iterations READ iterations)
  Q_PROPERTY(QString axes READ axes)
  ///@}

public:
  explicit pqTautlineRunDock(QWidget* parent = nullptr);
  ~pqTautlineRunDock() override;

  bool drawn() const;
  int iterations() const;
  QString axes() const;

private Q_SLOTS:
  void sourceAdded(pqPipelineSource* source);
  void serverAdded(pqServer* server);
  void progress(const QString& text, int percent);
  void end();
  void dataUpdated(pqPipelineSource* source);
  void stateChanged(pqServerManagerModelItem* item);

private:
  /// Name and values of the two curves.
  using History = std::array<std::pair<QString, std::vector<double>>, 2>;

  /// The menu name of the filter that sent a progress text; "" if it is not a Tautline filter.
  QString filterOf(const QString& text) const;
  /// Why the run of a filter cannot be stopped; "" if it can.
  QString whyNoStop(const QString& filter) const;
  void begin(const QString& filter);
  void showValues(const QString& values);
  /// Draws the iterations of a run that has ended, after Apply; nothing if they were drawn before.
  void showHistoryLater(pqPipelineSource* source);
  void showHistory(pqPipelineSource* source);
  void setStop(const QString& text, const QString& tip, bool enabled);

  std::map<QString, QString> Filters; ///< menu name by class name
  QString Running;                    ///< menu name; "" if no filter runs
  QString Ended;                      ///< the filter that ran; "" once its history is drawn
  QString EndedText;                  ///< how its run ended
  History Last;                       ///< the history drawn last
  bool Shown = false;                 ///< the dock has appeared by itself
  bool Sent = false;                  ///< the request to stop was sent to the server

  QWidget* Content;
  QLabel* Filter;
  QLabel* Values;
  QProgressBar* Bar;
  QToolButton* Stop;
  tautline::RunPlot* Plot;
  std::unique_ptr<tautline::StopWindow> Cover;
};

#endif
