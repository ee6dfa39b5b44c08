// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineHistogram
 * @brief The quality histogram of Element Quality, in which ranges are chosen to select elements.
 *
 * A combo box chooses the metric. Its histogram has bins over the acceptable range, a bar for the
 * elements beyond it and one for the inverted ones, in the colors of the mesh; dashed lines are the
 * limits of the criteria. Dragging over bars selects the cells in the views, as a selection that
 * Extract Selection and Find Data work on; the ends of the range can then be dragged, and the
 * selection follows. Each metric can have one range; cells are selected that are in all of them, or
 * in any. The number of cells selected and their fraction are shown; the server counts them. The
 * axis of counts is linear or logarithmic, which is remembered.
 *
 * In the XML of a proxy: `panel_widget="tautline_histogram"` on the group of the property
 * HistogramBins. The proxy has the outputs Statistics and Histogram, see vtkElementQuality.
 */

#ifndef pqTautlineHistogram_h
#define pqTautlineHistogram_h

#include "pqPropertyGroupWidget.h"

#include "HistogramBars.h"

#include <QStringList>
#include <QTimer>

#include <map>

class QComboBox;
class QLabel;
class QToolButton;
class pqOutputPort;
class pqPipelineSource;

namespace tautline
{
class HistogramPlot;
class ResultWatch;
}

class pqTautlineHistogram : public pqPropertyGroupWidget
{
  Q_OBJECT
  using Superclass = pqPropertyGroupWidget;

public:
  pqTautlineHistogram(vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqTautlineHistogram() override;

  /// The number of bins is an advanced property.
  void updateWidget(bool showAdvanced) override;

private Q_SLOTS:
  void refresh();
  void metricChanged();
  void scaleChanged();
  void choose(int first, int last);
  void drag(int first, int last);
  void clear();
  void selectionChanged(pqOutputPort* port);

private:
  pqPipelineSource* source() const; ///< null if it is not in the pipeline
  /// The bars chosen of a metric.
  struct Choice
  {
    int first;
    int last;
  };
  const tautline::MetricHistogram* shown() const;
  /// The choice of the metric shown; false without a metric.
  bool setChoice(int first, int last);
  QStringList conditions() const;
  void showConditions();
  void selectElements(); // not select(), which ParaView calls for each widget of a panel
  void describe(vtkTypeInt64 selected);

  tautline::ResultWatch* Watch = nullptr;
  std::vector<tautline::MetricHistogram> Histograms;
  std::map<std::string, Choice> Choices; ///< by metric
  bool Selecting = false;
  QTimer Pause; ///< between two selections while a range is dragged

  QComboBox* Metric;
  tautline::HistogramPlot* Plot;
  QLabel* Height;
  QComboBox* Scale;
  QLabel* Colors;
  QComboBox* Combination;
  QLabel* Conditions;
  QLabel* Count;
  QToolButton* Clear;
  QWidget* Bins;
};

#endif
