// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineNavigator
 * @brief The toolbar that steps from one bad element to the next.
 *
 * It shows the worst elements of the active filter of the pipeline, by a selectable measure; see
 * tautline::worstElementsOf() for the lists. Previous and Next select an element and, if Zoom is
 * on, move the camera to it. Table shows the list in a dock; Over Time plots the worst value of a
 * time series. Isolate fades the mesh and shows its edges, and shows the element with layers of its
 * neighbors, so that it is visible inside a solid; its value appears beside it. A text such as
 * "3 of 10: cell 433, imr -2.1, inverted" describes the selected element.
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
  /// Puts the table in a tab with the run dock, if both are in the same area.
  void placeTable();
  /// Selects an element; numbers wrap around.
  void go(int element);

private:
  const tautline::WorstElementList* list() const;
  /// Finds the elements of the current list, if it is not complete yet.
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
