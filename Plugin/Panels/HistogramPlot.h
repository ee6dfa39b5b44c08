// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::HistogramPlot
 * @brief Draws the bars of a histogram; dragging over bars chooses them.
 *
 * Click a bar, or drag from one to another; with the keyboard, the arrow keys move the choice and
 * extend it with Shift. Escape, or a click beside the bars, chooses nothing. The height of a bar is
 * the root of its count, so that few elements beside many can be seen; the tooltip has the number.
 */

#ifndef tautline_HistogramPlot_h
#define tautline_HistogramPlot_h

#include "HistogramBars.h"

#include <QWidget>

namespace tautline
{

class HistogramPlot : public QWidget
{
  Q_OBJECT

public:
  explicit HistogramPlot(QWidget* parent = nullptr);

  /// Shows another histogram, with the bars first to last chosen; first is -1 for none.
  void show(const MetricHistogram& histogram, int first, int last);

  int first() const { return this->First; }
  int last() const { return this->Last; }
  QSize sizeHint() const override;

Q_SIGNALS:
  /// The user chose the bars first to last; first is -1 for none.
  void chosen(int first, int last);

private:
  void paintEvent(QPaintEvent*) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  bool event(QEvent* event) override;

  int number() const { return static_cast<int>(this->Histogram.bars.size()); }
  int barAt(int x) const; ///< -1 beside the bars
  QRectF place(int bar) const;
  void choose(int from, int to);

  MetricHistogram Histogram;
  std::vector<double> Positions; ///< of the left ends of the bars, in widths of a bar
  int First = -1;
  int Last = -1;
  int Anchor = -1; ///< where a drag began
};

} // namespace tautline

#endif
