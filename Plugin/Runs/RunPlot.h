// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::RunPlot
 * @brief Plots two values over the iterations of a run: the first on the left axis, the second on
 * the right axis.
 *
 * An axis is logarithmic if all its values are positive and span more than a factor of ten.
 */

#ifndef tautline_RunPlot_h
#define tautline_RunPlot_h

#include <QString>
#include <QWidget>

#include <array>
#include <vector>

namespace tautline
{

class RunPlot : public QWidget
{
  Q_OBJECT

public:
  /// A curve: its name, and its values by iteration.
  struct Curve
  {
    QString name;
    std::vector<std::pair<int, double>> points;
  };

  explicit RunPlot(QWidget* parent = nullptr);

  /// Removes the curves.
  void clear();

  /// Adds the values of an iteration. A number below the last one starts new curves; an equal
  /// number replaces the last values.
  void add(int iteration, const QString& name, double value, int curve);

  const std::array<Curve, 2>& curves() const { return this->Curves; }
  QSize sizeHint() const override;

private:
  void paintEvent(QPaintEvent*) override;

  std::array<Curve, 2> Curves;
};

} // namespace tautline

#endif
