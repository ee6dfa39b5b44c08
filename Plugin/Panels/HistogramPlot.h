// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::HistogramPlot
 * @brief Draws a histogram with axes; a range of bars is chosen with the mouse or the keyboard.
 *
 * Click a bar, or drag from one to another; then drag the handles at the ends of the range. With
 * the keyboard, the arrow keys move the choice and extend it with Shift. Escape, or a click beside
 * the bars, chooses nothing. The tooltip of a bar has its number of elements.
 */

#ifndef tautline_HistogramPlot_h
#define tautline_HistogramPlot_h

#include "HistogramBars.h"
#include "HistogramLayout.h"

#include <QWidget>

namespace tautline
{

class HistogramPlot : public QWidget
{
  Q_OBJECT

public:
  explicit HistogramPlot(QWidget* parent = nullptr);

  /// Shows another histogram, with the bars first to last chosen; first is -1 for none.
  void show(const MetricHistogram& histogram, const std::vector<HistogramLimit>& limits, int first,
    int last);
  void setScale(CountScale scale);

  int first() const { return this->First; }
  int last() const { return this->Last; }
  QSize sizeHint() const override;

Q_SIGNALS:
  /// The user chose the bars first to last; first is -1 for none.
  void chosen(int first, int last);
  /// The same while a drag has not ended.
  void dragged(int first, int last);

private:
  /// What a drag moves.
  enum class Drag
  {
    None,
    Range, ///< from the bar where it began
    Left,
    Right
  };

  void paintEvent(QPaintEvent*) override;
  void resizeEvent(QResizeEvent*) override;
  void changeEvent(QEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  bool event(QEvent* event) override;

  int number() const { return static_cast<int>(this->Histogram.bars.size()); }
  int barAt(int x) const; ///< -1 beside the bars
  int nearestBar(int x) const;
  Drag handleAt(int x) const;
  QRectF plotArea() const;
  QRectF place(int bar) const;
  void layOut();
  void choose(int from, int to);
  void drawAxes(QPainter& painter) const;
  void drawBars(QPainter& painter) const;
  void drawMarks(QPainter& painter) const;
  void drawHandles(QPainter& painter) const;

  MetricHistogram Histogram;
  std::vector<HistogramLimit> Limits;
  HistogramView View;
  HistogramLayout Layout;
  int First = -1;
  int Last = -1;
  int Anchor = -1; ///< the bar where a drag began
  Drag Dragging = Drag::None;
};

} // namespace tautline

#endif
