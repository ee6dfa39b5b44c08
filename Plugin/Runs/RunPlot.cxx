// SPDX-License-Identifier: BSD-3-Clause
#include "RunPlot.h"

#include <QPainter>
#include <QPolygonF>

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{

// Green and orange: blue marks inverted elements, here as elsewhere.
const QColor Colors[] = { QColor(27, 120, 55), QColor(214, 96, 16) };

/// The range of an axis, and the position of a value in it.
struct Axis
{
  double low = 0, high = 1;
  bool logarithmic = false;

  explicit Axis(const RunPlot::Curve& curve)
  {
    if (curve.points.empty())
    {
      return;
    }
    const auto [least, most] = std::minmax_element(curve.points.begin(), curve.points.end(),
      [](const auto& a, const auto& b) { return a.second < b.second; });
    constexpr double manyTimes = 10;
    this->low = least->second;
    this->high = most->second;
    this->logarithmic = this->low > 0 && this->high > manyTimes * this->low;
  }

  /// 0 at the bottom, 1 at the top.
  double at(double value) const
  {
    const auto scaled = [this](double x) { return this->logarithmic ? std::log(x) : x; };
    const double span = scaled(this->high) - scaled(this->low);
    constexpr double middle = 0.5;
    return span > 0 ? (scaled(value) - scaled(this->low)) / span : middle;
  }
};

QString number(double value)
{
  constexpr int digits = 4;
  return QString::number(value, 'g', digits);
}

} // anonymous namespace

//------------------------------------------------------------------------------
RunPlot::RunPlot(QWidget* parentObject)
  : QWidget(parentObject)
{
  constexpr int lines = 5;
  this->setMinimumHeight(lines * this->fontMetrics().lineSpacing());
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

//------------------------------------------------------------------------------
QSize RunPlot::sizeHint() const
{
  constexpr int columns = 40, lines = 6;
  return { columns * this->fontMetrics().averageCharWidth(),
    lines * this->fontMetrics().lineSpacing() };
}

//------------------------------------------------------------------------------
void RunPlot::clear()
{
  this->Curves = {};
}

//------------------------------------------------------------------------------
void RunPlot::add(int iteration, const QString& name, double value, int curve)
{
  Curve& changed = this->Curves[static_cast<std::size_t>(curve)];
  auto& points = changed.points;
  if (name != changed.name || (!points.empty() && iteration < points.back().first))
  {
    points.clear();
  }
  if (!points.empty() && iteration == points.back().first)
  {
    points.pop_back();
  }
  changed.name = name;
  points.emplace_back(iteration, value);
}

//------------------------------------------------------------------------------
void RunPlot::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(this->rect(), this->palette().base());
  const int line = this->fontMetrics().lineSpacing();
  const int margin = this->fontMetrics().horizontalAdvance("-0.0000e+00");
  const QRectF area =
    QRectF(this->rect()).adjusted(margin, 1.5 * line, -margin, -1.25 * line); // space for labels
  painter.setPen(this->palette().color(QPalette::Mid));
  painter.drawRect(area);

  int first = 0, last = 1;
  for (const Curve& curve : this->Curves)
  {
    if (!curve.points.empty())
    {
      first = curve.points.front().first;
      last = std::max({ last, first + 1, curve.points.back().first });
    }
  }
  painter.setPen(this->palette().color(QPalette::Text));
  const QRectF below(area.left(), area.bottom(), area.width(), this->height() - area.bottom());
  painter.drawText(below, Qt::AlignLeft | Qt::AlignVCenter, QString::number(first));
  painter.drawText(below, Qt::AlignCenter, "iteration");
  painter.drawText(below, Qt::AlignRight | Qt::AlignVCenter, QString::number(last));

  for (std::size_t i = 0; i < this->Curves.size(); ++i)
  {
    const Curve& curve = this->Curves[i];
    if (curve.points.empty())
    {
      continue;
    }
    const Axis axis(curve);
    QPolygonF polygon;
    for (const auto& [iteration, value] : curve.points)
    {
      polygon << QPointF(
        area.left() + area.width() * (iteration - first) / static_cast<double>(last - first),
        area.bottom() - area.height() * axis.at(value));
    }
    constexpr double width = 2;
    painter.setPen(QPen(Colors[i], width));
    painter.drawPolyline(polygon);
    painter.drawEllipse(polygon.back(), width, width);
    const bool left = i == 0;
    const Qt::Alignment side = left ? Qt::AlignRight : Qt::AlignLeft;
    const double gap = this->fontMetrics().averageCharWidth();
    const QRectF beside(left ? 0 : area.right() + gap, area.top(), margin - gap, area.height());
    const QRectF above(area.left(), 0, area.width(), area.top());
    painter.drawText(beside, side | Qt::AlignTop, number(axis.high));
    if (axis.high > axis.low)
    {
      painter.drawText(beside, side | Qt::AlignBottom, number(axis.low));
    }
    painter.drawText(above, (left ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter,
      curve.name + (axis.logarithmic ? " (logarithmic)" : ""));
  }
}

} // namespace tautline
