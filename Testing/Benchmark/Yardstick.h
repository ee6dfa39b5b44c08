// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Yardstick.h
 * @brief The unit of computing time that carries figures from one machine to another.
 */
#ifndef tautline_Yardstick_h
#define tautline_Yardstick_h

#include <array>
#include <cstdint>
#include <vector>

namespace tautline
{
/**
 * @class Yardstick
 * @brief A loop over 998,250 tetrahedra that sums up the squared inverse mean ratio and its
 * gradient, written as the formulas stand on paper, in the order of the elements, on one thread.
 *
 * A *pass* over N elements is N times what this loop takes for one. Its source file is compiled
 * with -O2 for the plainest instruction set, whatever the flags of the rest: the unit does not
 * change as the compiler's vectorization or the kernel does.
 */
class Yardstick
{
public:
  /// A grid of `cubes`^3 cubes, each cut into six tetrahedra round a diagonal (Kuhn).
  explicit Yardstick(int cubes = 55);

  /// CPU seconds of this thread for one element, of one run of the loop.
  double measure();
  /// The smallest of several.
  double measure(int repeats);

  /// Sum of the squared inverse mean ratios, as the last run of the loop had it.
  double sum() const { return this->Sum; }
  std::size_t elements() const { return this->Elements.size(); }

private:
  using Triple = std::array<double, 3>;

  void run();

  std::vector<Triple> Points, Gradient;
  std::vector<std::array<std::int32_t, 4>> Elements;
  double Sum = 0;
};
}
#endif
