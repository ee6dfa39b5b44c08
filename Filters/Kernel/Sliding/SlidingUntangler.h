// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlidingUntangler.h
 * @brief Untangles a mesh whose boundary points slide.
 * Internal: not installed.
 */
#ifndef tautline_SlidingUntangler_h
#define tautline_SlidingUntangler_h

#include "BoundaryTerms.h"
#include "SlidingCells.h"

#include <functional>

namespace tautline
{
/**
 * @class tautline::SlidingUntangler
 * @brief The foldover-free map energy (V. Garanzha et al., "Foldover-free maps in 50 lines of
 * code", ACM TOG 40, 2021) of the corners around inverted ones, plus the energy of the boundary.
 *
 * With the Jacobian J of a corner relative to an ideal cell with the size of the surrounding edges,
 * its determinant D, and chi = (D + sqrt(eps^2 + D^2)) / 2, the energy is a weighted sum of
 * |J|^2 / (d chi^(2/d)) and (1 + D^2) / chi. eps follows the smallest D to zero. The first term is
 * convex in J and chi, the second in D: the Gauss-Newton model keeps these parts.
 */
class TAUTLINE_KERNEL_EXPORT SlidingUntangler
{
public:
  /// The points are `x`; all arguments must outlive this object.
  SlidingUntangler(const SlidingCells& cells, const ConstrainedPoints& constrained,
    BoundaryTerms& boundary, std::vector<Vec3>& x, int threads);

  /**
   * @brief Moves the points within `rings` rings around the cells with an invalid corner.
   * @param proceed called after each step with the number of such cells; returns false to stop
   * @return whether there are no such cells left
   */
  bool run(int rings, int steps, const std::function<bool(Index)>& proceed);
  /// The number of cells with an invalid corner.
  Index invalid() const;
  /// Updates the sizes of the edges from the current points.
  void findSizes();
  /// The sum of -D over inverted corners, in units of the mean size.
  double invertedVolume() const;
  /// A few steps with almost no regularization, of the points that moved last and of points outside
  /// their bands: valid cells stay valid.
  void smooth(int steps);
  /// Another start: moves each point to the mean of its neighbors, and back to its part.
  void relax(int sweeps);

  /// For tests: the energy of all cells with this eps, and its model.
  double energyWith(double eps);
  void modelWith(double eps, QuadraticModel& model);

private:
  struct Corner
  {
    Columns jacobian, cofactor;
    std::array<Vec3, 3> weights; ///< as in CornerBlock
    double determinant;
  };
  Corner cornerOf(std::size_t cell, int corner, const std::vector<Vec3>& x) const;
  bool isInvalid(std::size_t cell) const;
  void select(std::vector<char> moving);
  double energyOf(const Corner& corner, int dimension) const;
  double energy(const std::vector<Vec3>& x) const;
  double leastDeterminant() const;
  void addCorner(std::size_t cell, int corner, QuadraticModel& model) const;
  void linearize(QuadraticModel& model) const;
  bool step();

  const SlidingCells& Cells;
  const ConstrainedPoints& Constrained;
  BoundaryTerms& Boundary;
  std::vector<Vec3>& X;
  int Threads;
  std::vector<double> Sizes; ///< of the edges around each cell
  double Eps2 = 1;
  std::vector<std::int32_t> Near; ///< cells with a moving point
  std::vector<Index> Moving;
  std::vector<std::int32_t> Local;
  std::vector<double> Shortest;
  double Damping = 1e-3;
};
}
#endif
