// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineRunDock
 * @brief Shows the run of a filter of Tautline while it lasts, and stops it.
 *
 * Of Optimize Mesh, Untangle Mesh and Improve Mesh it draws two values over the iterations, and the
 * button Stop ends the run with the best mesh so far. Of the other filters it shows the progress.
 * The values are those of the text of the progress, which also comes from a server; see
 * vtkTautlineAlgorithm::ShowIteration(). ParaView drops texts that follow each other fast: after
 * the run, all iterations are drawn, from the filter's output History.
 *
 * Nothing is executed within a run but the drawing of this dock: no events are processed. The
 * clicks on Stop are noticed by tautline::StopWindow; see RunControl.h for how the run ends.
 *
 * The dock appears the first time that one of the three filters is created.
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
  /// What the last run showed, for tests: whether a curve was drawn, up to which iteration, and the
  /// names of the two axes.
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

  /// The name in the menu of the filter that a text of the progress is of; "" if not Tautline's.
  QString filterOf(const QString& text) const;
  /// Why the run of a filter cannot be stopped; "" if it can.
  QString whyNoStop(const QString& filter) const;
  void begin(const QString& filter);
  void showValues(const QString& values);
  /// Draws the iterations of a run that has ended, after Apply; nothing if they were drawn before.
  void showHistoryLater(pqPipelineSource* source);
  void showHistory(pqPipelineSource* source);
  void setStop(const QString& text, const QString& tip, bool enabled);

  std::map<QString, QString> Filters; ///< name in the menu by name of class
  QString Running;                    ///< name in the menu; "" if no filter runs
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
