// SPDX-License-Identifier: BSD-3-Clause
#include "HistogramPlot.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPalette>
#include <QToolTip>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{

constexpr int Margin = 4;            // pixels around everything
constexpr int PlotHeight = 110;      // pixels of the bars
constexpr int TickLength = 4;        // pixels
constexpr int HandleReach = 4;       // pixels beside a handle where it is taken
constexpr int NarrowestOutlined = 4; // pixels of a bar
constexpr int DarkLightness = 128;   // of a window, below which lines are brighter
constexpr int OutlineGray = 120;
constexpr double HandleWidth = 6, HandleHeight = 22;

/// As ParaView draws selected elements.
const QColor RangeColor(255, 0, 255, 50);
const QColor HandleColor(170, 0, 170);

QColor colorOfMark(const HistogramMark& mark, const QPalette& palette)
{
  const QColor color = mark.fail ? QColor(140, 20, 20) : QColor(179, 107, 0);
  constexpr int brighter = 190; // percent
  return palette.color(QPalette::Window).lightness() < DarkLightness ? color.lighter(brighter)
                                                                     : color;
}

} // anonymous namespace

//------------------------------------------------------------------------------
HistogramPlot::HistogramPlot(QWidget* parentObject)
  : QWidget(parentObject)
{
  this->setFocusPolicy(Qt::StrongFocus);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  this->setMouseTracking(true);
  this->setAccessibleName("Quality histogram");
}

//------------------------------------------------------------------------------
void HistogramPlot::show(
  const MetricHistogram& histogram, const std::vector<HistogramLimit>& limits, int first, int last)
{
  this->Histogram = histogram;
  this->Limits = limits;
  this->First = first;
  this->Last = last;
  this->Anchor = -1;
  this->Dragging = Drag::None;
  this->layOut();
}

//------------------------------------------------------------------------------
void HistogramPlot::setScale(CountScale scale)
{
  this->View.scale = scale;
  this->layOut();
}

//------------------------------------------------------------------------------
void HistogramPlot::layOut()
{
  const int widest = this->fontMetrics().horizontalAdvance("0.00") + 4 * Margin;
  this->View.valueTicks = std::max(1, static_cast<int>(this->plotArea().width()) / widest);
  this->Layout =
    this->number() == 0 ? HistogramLayout() : layoutOf(this->Histogram, this->Limits, this->View);
  this->updateGeometry();
  this->update();
}

//------------------------------------------------------------------------------
QSize HistogramPlot::sizeHint() const
{
  constexpr int narrowest = 240, lines = 3; // titles of both axes, and the labels of ticks
  const int marks = static_cast<int>(this->Layout.marks.size());
  if (this->number() == 0)
  {
    return { narrowest, 2 * (this->fontMetrics().height() + Margin) };
  }
  return { narrowest,
    PlotHeight + TickLength + (lines + marks) * this->fontMetrics().height() + 3 * Margin };
}

//------------------------------------------------------------------------------
QRectF HistogramPlot::plotArea() const
{
  const QFontMetrics metrics = this->fontMetrics();
  int labels = 0;
  for (const HistogramTick& tick : this->Layout.counts)
  {
    labels = std::max(labels, metrics.horizontalAdvance(QString::fromStdString(tick.label)));
  }
  const int left = 2 * Margin + labels + TickLength;
  const int lines = 1 + static_cast<int>(this->Layout.marks.size());
  const int top = 2 * Margin + lines * metrics.height();
  // Half of the last label is beyond the plot.
  const int right = 2 * Margin + metrics.horizontalAdvance("00") / 2;
  return { double(left), double(top), std::max(1.0, double(this->width() - left - right)),
    double(PlotHeight) };
}

//------------------------------------------------------------------------------
QRectF HistogramPlot::place(int bar) const
{
  const QRectF area = this->plotArea();
  const auto i = static_cast<std::size_t>(bar);
  const double left = area.left() + this->Layout.left[i] * area.width();
  const double right = area.left() + this->Layout.right[i] * area.width();
  return { left, area.top(), right - left, area.height() };
}

//------------------------------------------------------------------------------
int HistogramPlot::barAt(int x) const
{
  for (int bar = 0; bar < this->number(); ++bar)
  {
    const QRectF area = this->place(bar);
    if (x >= area.left() && x < area.right())
    {
      return bar;
    }
  }
  return -1;
}

//------------------------------------------------------------------------------
int HistogramPlot::nearestBar(int x) const
{
  int nearest = 0;
  double distance = std::numeric_limits<double>::max();
  for (int bar = 0; bar < this->number(); ++bar)
  {
    const double away = std::abs(x - this->place(bar).center().x());
    nearest = away < distance ? bar : nearest;
    distance = std::min(distance, away);
  }
  return nearest;
}

//------------------------------------------------------------------------------
HistogramPlot::Drag HistogramPlot::handleAt(int x) const
{
  if (this->First < 0)
  {
    return Drag::None;
  }
  const double left = std::abs(x - this->place(this->First).left());
  const double right = std::abs(x - this->place(this->Last).right());
  return std::min(left, right) > HandleReach ? Drag::None : left < right ? Drag::Left : Drag::Right;
}

//------------------------------------------------------------------------------
void HistogramPlot::choose(int from, int to)
{
  this->First = from < 0 ? -1 : std::min(from, to);
  this->Last = from < 0 ? -1 : std::max(from, to);
  this->update();
}

//------------------------------------------------------------------------------
void HistogramPlot::drawAxes(QPainter& painter) const
{
  const QRectF area = this->plotArea();
  const QFontMetrics metrics = this->fontMetrics();
  const QColor text = this->palette().color(QPalette::WindowText);
  const QColor grid = this->palette().color(QPalette::Mid);
  const double height = metrics.height();
  painter.setPen(text);
  painter.drawText(QRectF(Margin, Margin, this->width() - 2 * Margin, height), Qt::AlignLeft,
    QString::fromStdString(this->Layout.countTitle));
  for (const HistogramTick& tick : this->Layout.counts)
  {
    const double y = area.bottom() - tick.position * area.height();
    painter.setPen(QPen(grid, 0, Qt::DotLine));
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
    painter.setPen(text);
    painter.drawLine(QPointF(area.left() - TickLength, y), QPointF(area.left(), y));
    painter.drawText(QRectF(0, y - height / 2, area.left() - TickLength - 2, height),
      Qt::AlignRight | Qt::AlignVCenter, QString::fromStdString(tick.label));
  }
  double end = -1;
  for (const HistogramTick& tick : this->Layout.values)
  {
    const double x = area.left() + tick.position * area.width();
    const QString label = QString::fromStdString(tick.label);
    const double width = metrics.horizontalAdvance(label);
    const double left = std::clamp(x - width / 2, 0.0, std::max(0.0, this->width() - width));
    painter.drawLine(QPointF(x, area.bottom()), QPointF(x, area.bottom() + TickLength));
    // The tick without its label where there is no room.
    if (left > end + Margin)
    {
      painter.drawText(QPointF(left, area.bottom() + TickLength + metrics.ascent()), label);
      end = left + width;
    }
  }
  painter.drawText(QRectF(area.left(), area.bottom() + TickLength + height, area.width(), height),
    Qt::AlignHCenter, QString::fromStdString(this->Layout.title));
}

//------------------------------------------------------------------------------
void HistogramPlot::drawBars(QPainter& painter) const
{
  const QColor outline(OutlineGray, OutlineGray, OutlineGray);
  for (int i = 0; i < this->number(); ++i)
  {
    const auto bar = static_cast<std::size_t>(i);
    QRectF area = this->place(i);
    if (i >= this->First && i <= this->Last && this->First >= 0)
    {
      painter.fillRect(area, RangeColor);
    }
    if (this->Histogram.bars[bar].count == 0)
    {
      continue;
    }
    // At least one pixel where there is an element.
    const double base = area.bottom();
    area.setTop(base - std::max(1.0, this->Layout.heights[bar] * area.height()));
    const auto& color = this->Layout.colors[bar];
    painter.fillRect(
      area.adjusted(0.5, 0, -0.5, 0), QColor::fromRgbF(color[0], color[1], color[2]));
    if (area.width() >= NarrowestOutlined)
    {
      painter.setPen(QPen(outline, 0));
      painter.drawRect(area.adjusted(0.5, 0, -0.5, 0));
    }
  }
  const QRectF area = this->plotArea();
  painter.setPen(this->palette().color(QPalette::WindowText));
  painter.drawLine(area.bottomLeft(), area.bottomRight());
  painter.drawLine(area.topLeft(), area.bottomLeft());
}

//------------------------------------------------------------------------------
void HistogramPlot::drawMarks(QPainter& painter) const
{
  const QRectF area = this->plotArea();
  const QFontMetrics metrics = this->fontMetrics();
  double y = 2 * Margin + metrics.height();
  for (const HistogramMark& mark : this->Layout.marks)
  {
    const double x = area.left() + mark.position * area.width();
    const QString label = QString::fromStdString(mark.label);
    const double width = metrics.horizontalAdvance(label);
    const double left = mark.position > 0.5 ? std::max(0.0, x - width - Margin) : x + Margin;
    painter.setPen(QPen(colorOfMark(mark, this->palette()), 0, Qt::DashLine));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setPen(colorOfMark(mark, this->palette()));
    painter.drawText(QPointF(left, y + metrics.ascent()), label);
    y += metrics.height();
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::drawHandles(QPainter& painter) const
{
  if (this->First < 0)
  {
    return;
  }
  const QRectF area = this->plotArea();
  painter.setRenderHint(QPainter::Antialiasing);
  for (const double x : { this->place(this->First).left(), this->place(this->Last).right() })
  {
    painter.setPen(QPen(HandleColor, 1));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setBrush(this->palette().color(QPalette::Button));
    painter.drawRoundedRect(
      QRectF(x - HandleWidth / 2, area.center().y() - HandleHeight / 2, HandleWidth, HandleHeight),
      2, 2);
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  if (this->number() == 0)
  {
    painter.drawText(
      this->rect(), Qt::AlignCenter | Qt::TextWordWrap, "Apply the filter to see its histogram.");
    return;
  }
  this->drawAxes(painter);
  this->drawBars(painter);
  this->drawMarks(painter);
  this->drawHandles(painter);
}

//------------------------------------------------------------------------------
void HistogramPlot::resizeEvent(QResizeEvent*)
{
  this->layOut();
}

//------------------------------------------------------------------------------
void HistogramPlot::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange)
  {
    this->updateGeometry();
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::mousePressEvent(QMouseEvent* event)
{
  if (event->button() != Qt::LeftButton || this->number() == 0)
  {
    return;
  }
  this->Dragging = this->handleAt(event->pos().x());
  if (this->Dragging == Drag::None)
  {
    this->Dragging = Drag::Range;
    this->Anchor = this->barAt(event->pos().x());
    this->choose(this->Anchor, this->Anchor);
    Q_EMIT this->dragged(this->First, this->Last);
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::mouseMoveEvent(QMouseEvent* event)
{
  const int x = event->pos().x();
  if (this->Dragging == Drag::None)
  {
    this->setCursor(this->handleAt(x) == Drag::None ? Qt::ArrowCursor : Qt::SizeHorCursor);
    return;
  }
  const int first = this->First, last = this->Last;
  if (this->Dragging == Drag::Range)
  {
    if (this->Anchor >= 0)
    {
      this->choose(this->Anchor, this->nearestBar(x));
    }
  }
  else
  {
    // The bar whose edge is nearest; the handles do not pass each other.
    const bool left = this->Dragging == Drag::Left;
    int nearest = left ? first : last;
    double distance = std::numeric_limits<double>::max();
    for (int bar = left ? 0 : first; bar <= (left ? last : this->number() - 1); ++bar)
    {
      const QRectF area = this->place(bar);
      const double away = std::abs(x - (left ? area.left() : area.right()));
      nearest = away < distance ? bar : nearest;
      distance = std::min(distance, away);
    }
    this->choose(left ? nearest : first, left ? last : nearest);
  }
  if (this->First != first || this->Last != last)
  {
    Q_EMIT this->dragged(this->First, this->Last);
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::mouseReleaseEvent(QMouseEvent* event)
{
  if (event->button() == Qt::LeftButton && this->number() > 0 && this->Dragging != Drag::None)
  {
    this->mouseMoveEvent(event);
    this->Anchor = -1;
    this->Dragging = Drag::None;
    Q_EMIT this->chosen(this->First, this->Last);
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::keyPressEvent(QKeyEvent* event)
{
  const int step = event->key() == Qt::Key_Left ? -1 : event->key() == Qt::Key_Right ? 1 : 0;
  if (this->number() == 0 || (step == 0 && event->key() != Qt::Key_Escape))
  {
    QWidget::keyPressEvent(event);
    return;
  }
  if (step == 0)
  {
    this->choose(-1, -1);
  }
  else if (this->First < 0)
  {
    const int start = step > 0 ? 0 : this->number() - 1;
    this->choose(start, start);
  }
  else
  {
    const int end = std::clamp(step > 0 ? this->Last + 1 : this->First - 1, 0, this->number() - 1);
    const bool extend = event->modifiers() & Qt::ShiftModifier;
    this->choose(extend ? (step > 0 ? this->First : this->Last) : end, end);
  }
  Q_EMIT this->chosen(this->First, this->Last);
}

//------------------------------------------------------------------------------
bool HistogramPlot::event(QEvent* event)
{
  if (event->type() == QEvent::ToolTip)
  {
    const auto* help = static_cast<QHelpEvent*>(event);
    const int bar = this->barAt(help->pos().x());
    QToolTip::showText(help->globalPos(),
      bar < 0 ? QString()
              : QString("%1: %2 elements")
                  .arg(QString::fromStdString(describeBars(this->Histogram, bar, bar)))
                  .arg(this->Histogram.bars[bar].count));
    return true;
  }
  return QWidget::event(event);
}

} // namespace tautline
