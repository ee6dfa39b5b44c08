// SPDX-License-Identifier: BSD-3-Clause
#include "HistogramPlot.h"

#include "ColorMaps.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{

constexpr int Margin = 4;      // pixels around the bars
constexpr int PlotHeight = 90; // pixels of the bars
constexpr double Gap = 0.5;    // widths of a bar

bool isBin(const HistogramBar& bar)
{
  return bar.kind == HistogramBar::Bin || bar.kind == HistogramBar::LastBin;
}

/// The colours of the colour maps: unacceptable dark red, inverted blue.
QColor colorOf(const HistogramBar& bar)
{
  switch (bar.kind)
  {
    case HistogramBar::Inverted:
      return QColor::fromRgbF(InvertedColor[0], InvertedColor[1], InvertedColor[2]);
    case HistogramBar::Degenerate:
      return QColor(120, 60, 120);
    case HistogramBar::Below:
    case HistogramBar::Above:
      return QColor(140, 20, 20);
    default:
      return QColor(150, 160, 170);
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
HistogramPlot::HistogramPlot(QWidget* parentObject)
  : QWidget(parentObject)
{
  this->setFocusPolicy(Qt::StrongFocus);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  this->setAccessibleName("Quality histogram");
}

//------------------------------------------------------------------------------
void HistogramPlot::show(const MetricHistogram& histogram, int first, int last)
{
  this->Histogram = histogram;
  // A gap separates the bins over the acceptable range from what is beyond.
  this->Positions.clear();
  double position = 0;
  for (std::size_t i = 0; i < histogram.bars.size(); ++i)
  {
    const bool border = i > 0 && isBin(histogram.bars[i - 1]) != isBin(histogram.bars[i]);
    position += border ? Gap : 0.0;
    this->Positions.push_back(position);
    position += 1;
  }
  this->First = first;
  this->Last = last;
  this->Anchor = -1;
  this->update();
}

//------------------------------------------------------------------------------
QSize HistogramPlot::sizeHint() const
{
  return { 240, PlotHeight + this->fontMetrics().height() + 3 * Margin };
}

//------------------------------------------------------------------------------
QRectF HistogramPlot::place(int bar) const
{
  const double width = (this->width() - 2.0 * Margin) / (this->Positions.back() + 1);
  return { Margin + this->Positions[bar] * width, double(Margin), width, double(PlotHeight) };
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
void HistogramPlot::choose(int from, int to)
{
  this->First = from < 0 ? -1 : std::min(from, to);
  this->Last = from < 0 ? -1 : std::max(from, to);
  this->update();
}

//------------------------------------------------------------------------------
void HistogramPlot::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  if (this->number() == 0)
  {
    painter.drawText(this->rect(), Qt::AlignCenter, "Apply the filter to see its histogram.");
    return;
  }
  const auto& bars = this->Histogram.bars;
  const auto fullest = std::max_element(bars.begin(), bars.end(),
    [](const HistogramBar& a, const HistogramBar& b) { return a.count < b.count; });
  const double most = std::sqrt(std::max<double>(1, static_cast<double>(fullest->count)));
  const double base = Margin + PlotHeight;
  int firstBin = -1, lastBin = -1;
  for (int i = 0; i < this->number(); ++i)
  {
    QRectF area = this->place(i);
    if (i >= this->First && i <= this->Last && this->First >= 0)
    {
      painter.fillRect(area, this->palette().color(QPalette::Highlight).lighter(160));
    }
    // At least one pixel where there is an element.
    const double height = PlotHeight * std::sqrt(static_cast<double>(bars[i].count)) / most;
    area.setTop(base - (bars[i].count > 0 ? std::max(1.0, height) : 0.0));
    painter.fillRect(area.adjusted(0.5, 0, -0.5, 0), colorOf(bars[i]));
    if (isBin(bars[i]))
    {
      firstBin = firstBin < 0 ? i : firstBin;
      lastBin = i;
    }
  }
  painter.setPen(this->palette().color(QPalette::WindowText));
  painter.drawLine(QPointF(Margin, base), QPointF(this->width() - Margin, base));
  if (firstBin < 0)
  {
    return;
  }
  const QRectF labels(
    Margin, base + Margin, this->width() - 2 * Margin, this->fontMetrics().height());
  const auto label = [&](double x, double value)
  {
    const QString text = QString::number(value, 'g', 4);
    const double width = this->fontMetrics().horizontalAdvance(text);
    const double left = std::clamp(x - width / 2, labels.left(), labels.right() - width);
    painter.drawLine(QPointF(x, base), QPointF(x, base + Margin));
    painter.drawText(QPointF(left, labels.bottom()), text);
  };
  label(this->place(firstBin).left(), bars[firstBin].low);
  label(this->place(lastBin).right(), bars[lastBin].high);
}

//------------------------------------------------------------------------------
void HistogramPlot::mousePressEvent(QMouseEvent* event)
{
  if (event->button() == Qt::LeftButton && this->number() > 0)
  {
    this->Anchor = this->barAt(event->pos().x());
    this->choose(this->Anchor, this->Anchor);
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::mouseMoveEvent(QMouseEvent* event)
{
  const int bar = this->barAt(event->pos().x());
  if (this->Anchor >= 0 && bar >= 0)
  {
    this->choose(this->Anchor, bar);
  }
}

//------------------------------------------------------------------------------
void HistogramPlot::mouseReleaseEvent(QMouseEvent* event)
{
  if (event->button() == Qt::LeftButton && this->number() > 0)
  {
    this->mouseMoveEvent(event);
    this->Anchor = -1;
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
