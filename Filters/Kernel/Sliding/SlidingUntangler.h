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
 * code", ACM TOG 40, 2021) of the corners about inverted ones, with the energy of the boundary.
 *
 * With J the Jacobian of a corner relative to an ideal cell of the size of the edges about it, D
 * its determinant and chi = (D + sqrt(eps^2 + D^2)) / 2, the energy is a weighted sum of
 * |J|^2 / (d chi^(2/d)) and (1 + D^2) / chi. eps follows the smallest D to zero. The first term is
 * convex in J and chi, the second in D: the model of Gauss and Newton keeps these parts.
 */
class TAUTLINE_KERNEL_EXPORT SlidingUntangler
{
public:
  /// The points are `x`, which has to live as long as this, as all else has.
  SlidingUntangler(const SlidingCells& cells, const ConstrainedPoints& constrained,
    BoundaryTerms& boundary, std::vector<Vec3>& x, int threads);

  /**
   * @brief Moves the points within `rings` rings about the cells that have a corner which is not
   * valid.
   * @param proceed called after each step with the number of such cells; returns false to stop
   * @return whether there is none any more
   */
  bool run(int rings, int steps, const std::function<bool(Index)>& proceed);
  /// Cells with a corner that is not valid.
  Index invalid() const;
  /// Takes the sizes of the edges where the points are now.
  void findSizes();
  /// The sum of -D over inverted corners, in units of the mean size.
  double invertedVolume() const;
  /// A few steps with almost no regularization, of the points that moved last and those that are
  /// not in their bands: valid cells stay so.
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
  std::vector<double> Sizes; ///< of the edges about each cell
  double Eps2 = 1;
  std::vector<std::int32_t> Near; ///< cells with a point that moves
  std::vector<Index> Moving;
  std::vector<std::int32_t> Local;
  std::vector<double> Shortest;
  double Damping = 1e-3;
};
}
#endif
