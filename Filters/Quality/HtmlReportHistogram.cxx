// SPDX-License-Identifier: BSD-3-Clause
#include "HtmlReportHistogram.h"

#include "HtmlReportText.h"

#include <sstream>

namespace tautline
{
namespace
{

// Pixels; the plot is inside the margins.
constexpr double Width = 430, Left = 62, Right = 14, PlotHeight = 150, Bottom = 40;
constexpr double MarkLine = 13; // between the labels of limits
constexpr double TickLength = 4, TextHeight = 11;
constexpr double BarGap = 0.5; // beside a bar
constexpr const char* AxisColor = "#555";
constexpr const char* GridColor = "#e4e4e4";
constexpr const char* WarnColor = "#b36b00";
constexpr const char* FailColor = "#8c1414";

/// Places of a plot in pixels.
struct Frame
{
  double top;
  double bottom() const { return this->top + PlotHeight; }
  double x(double position) const { return Left + position * (Width - Left - Right); }
  double y(double height) const { return this->top + PlotHeight * (1 - height); }
};

void svgLine(
  std::ostream& svg, double x1, double y1, double x2, double y2, const std::string& style)
{
  svg << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2 << "\" "
      << style << "/>\n";
}

void svgText(std::ostream& svg, double x, double y, const char* anchor, const std::string& text,
  const char* color = nullptr)
{
  svg << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\""
      << (color ? std::string(" style=\"fill:") + color + "\"" : "") << ">" << escapeHtml(text)
      << "</text>\n";
}

std::string stroke(const char* color)
{
  return std::string("stroke=\"") + color + "\"";
}

void drawAxes(std::ostream& svg, const HistogramLayout& layout, const Frame& frame)
{
  for (const HistogramTick& tick : layout.counts)
  {
    const double y = frame.y(tick.position);
    svgLine(svg, frame.x(0), y, frame.x(1), y, stroke(GridColor));
    svgLine(svg, frame.x(0) - TickLength, y, frame.x(0), y, stroke(AxisColor));
    svgText(svg, frame.x(0) - TickLength - 2, y + TextHeight / 3, "end", tick.label);
  }
  for (const HistogramTick& tick : layout.values)
  {
    const double x = frame.x(tick.position);
    svgLine(svg, x, frame.bottom(), x, frame.bottom() + TickLength, stroke(AxisColor));
    svgText(svg, x, frame.bottom() + TickLength + TextHeight, "middle", tick.label);
  }
  svgText(svg, frame.x(0.5), frame.bottom() + Bottom - 6, "middle", layout.title);
  const double x = TextHeight, y = frame.y(0.5);
  svg << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"middle\" transform=\"rotate(-90 "
      << x << " " << y << ")\">" << escapeHtml(layout.countTitle) << "</text>\n";
}

void drawMarks(std::ostream& svg, const HistogramLayout& layout, const Frame& frame)
{
  for (std::size_t i = 0; i < layout.marks.size(); ++i)
  {
    const HistogramMark& mark = layout.marks[i];
    const char* color = mark.fail ? FailColor : WarnColor;
    const double x = frame.x(mark.position), y = static_cast<double>(i + 1) * MarkLine - 3;
    svgLine(svg, x, frame.top, x, frame.bottom(), stroke(color) + " stroke-dasharray=\"4 2\"");
    const bool right = mark.position > 0.5;
    svgText(svg, x + (right ? -3 : 3), y, right ? "end" : "start", mark.label, color);
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::string htmlHistogram(const MetricHistogram& histogram,
  const std::vector<HistogramLimit>& limits, const std::string& caption, vtkIdType most)
{
  HistogramView view;
  view.most = most;
  const HistogramLayout layout = layoutOf(histogram, limits, view);
  const Frame frame = { TextHeight + static_cast<double>(layout.marks.size()) * MarkLine };
  std::ostringstream svg;
  svg << "<figure><svg width=\"" << Width << "\" height=\"" << frame.bottom() + Bottom
      << "\" viewBox=\"0 0 " << Width << " " << frame.bottom() + Bottom
      << "\" role=\"img\" aria-label=\"" << escapeHtml("Histogram: " + layout.title) << "\">\n";
  drawAxes(svg, layout, frame);
  for (std::size_t i = 0; i < histogram.bars.size(); ++i)
  {
    const HistogramBar& bar = histogram.bars[i];
    const double x = frame.x(layout.left[i]), y = frame.y(layout.heights[i]);
    const int index = static_cast<int>(i);
    svg << "<rect x=\"" << x + BarGap << "\" y=\"" << y << "\" width=\""
        << frame.x(layout.right[i]) - x - 2 * BarGap << "\" height=\"" << frame.bottom() - y
        << "\" fill=\"" << htmlColor(layout.colors[i]) << "\" "
        << (bar.count > 0 ? "stroke=\"#777\" stroke-width=\"0.5\"" : "") << "><title>"
        << escapeHtml(describeBars(histogram, index, index)) << ": " << bar.count << " elements"
        << "</title></rect>\n";
  }
  svgLine(svg, frame.x(0), frame.top, frame.x(0), frame.bottom(), stroke(AxisColor));
  svgLine(svg, frame.x(0), frame.bottom(), frame.x(1), frame.bottom(), stroke(AxisColor));
  drawMarks(svg, layout, frame);
  svg << "</svg>" << (caption.empty() ? "" : "<figcaption>" + escapeHtml(caption) + "</figcaption>")
      << "</figure>\n";
  return svg.str();
}

} // namespace tautline
