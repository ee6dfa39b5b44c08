// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineNavigator
 * @brief The tool bar that goes from one bad element to the next.
 *
 * It shows the worst elements of the active filter of the pipeline, by a measure to choose; see
 * tautline::worstElementsOf() for the lists. Previous and Next select an element and, if Zoom is
 * on, move the camera to it. Table shows the list in a dock, Over Time plots the worst value of a
 * time series. Isolate shows the mesh faded with its edges, and the element with layers of its
 * neighbors, so that it is visible inside a solid; its value stands beside it. "3 of 10: cell 433,
 * imr -2.1, inverted" is the element selected.
 */

#ifndef pqTautlineNavigator_h
#define pqTautlineNavigator_h

#include "Isolation.h"
#include "WorstElements.h"

#include <QPointer>
#include <QToolBar>

class QAction;
class QComboBox;
class QLabel;
class QSpinBox;
class pqPipelineSource;
class pqTautlineElementTable;

class pqTautlineNavigator : public QToolBar
{
  Q_OBJECT
  using Superclass = QToolBar;

public:
  explicit pqTautlineNavigator(QWidget* parent = nullptr);
  ~pqTautlineNavigator() override;

private Q_SLOTS:
  void sourceChanged(pqPipelineSource* source);
  void dataUpdated(pqPipelineSource* source);
  void refresh();
  void listChanged();
  void previous() { this->go(this->Current < 0 ? -1 : this->Current - 1); }
  void next() { this->go(this->Current + 1); }
  void zoom(bool on);
  void isolate(bool on);
  void plotOverTime();
  void fillTable();
  /// Puts the table on the dock of the run, if that is shown at the same place.
  void placeTable();
  /// Selects an element; numbers count around.
  void go(int element);

private:
  const tautline::WorstElementList* list() const;
  /// Finds the elements of the current list, if they were not found yet.
  void complete();
  void describe(const std::string& problem = {});

  QPointer<pqPipelineSource> Source;
  std::vector<tautline::WorstElementList> Lists;
  int Current = -1; ///< element of the list, -1: none
  tautline::Isolation Isolated;

  QComboBox* Measure;
  QAction* Previous;
  QAction* Next;
  QAction* Zoom;
  QAction* Isolate;
  QAction* OverTime;
  QSpinBox* Layers;
  QLabel* Element;
  pqTautlineElementTable* Table; ///< owned by the main window
};

#endif
