// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MovingBarrier.h
 * @brief Improves the worst corner of a mesh whose boundary points slide.
 * Internal: not installed.
 *
 * The method of centers (P. Huard, "Resolution of mathematical programming with nonlinear
 * constraints by the method of centres", 1967) with a compact barrier, as used for contact by M. Li
 * et al., "Incremental potential contact", ACM TOG 39 (2020): for corners of shape s below a
 * threshold, b(u) = -(1 - u)^2 ln u with u = (s - low) / (threshold - low), where low is slightly
 * below the worst corner. After a few Newton steps, the window moves up with the worst corner; it
 * is narrowed when the worst corner no longer improves. Determinants at the corners and, for
 * hexahedra and wedges, in between, in units of a tenth of their initial mean, are also used as s:
 * they keep cells from collapsing and from folding inside.
 *
 * Steps use the Gauss-Newton method with a curvature along the edges of the corners, Levenberg
 * damping and matrix-free conjugate gradients. Points move according to ConstrainedPoints, see
 * BoundaryTerms.
 */
#ifndef tautline_MovingBarrier_h
#define tautline_MovingBarrier_h

#include "BoundaryTerms.h"
#include "CornerShape.h"
#include "SlidingCells.h"

#include <functional>

namespace tautline
{
struct BarrierOptions
{
  CornerMeasure measure = CornerMeasure::ScaledJacobian;
  int steps = 2000; ///< at most
  /// Stop as soon as the worst corner is this good; above 1: never.
  double enough = 2.0;
  int threads = 0; ///< the result does not depend on it
  /// Called after each round with the worst corner there; return false to stop.
  std::function<bool(double worst)> proceed;
};

/**
 * @class tautline::MovingBarrier
 * @brief Moves the points of a mesh to improve its worst corner.
 */
class TAUTLINE_KERNEL_EXPORT MovingBarrier
{
public:
  /**
   * @param x the initial points; the best ones after run(). All arguments must outlive this object.
   */
  MovingBarrier(const SlidingCells& cells, const ConstrainedPoints& constrained,
    BoundaryTerms& boundary, std::vector<Vec3>& x, const BarrierOptions& options);

  /**
   * @brief Runs until the worst corner no longer improves.
   * @param accept whether points are acceptable, in addition to being within their bounds; called
   * when the worst corner has improved sufficiently
   */
  void run(const std::function<bool(const std::vector<Vec3>&)>& accept);
  /// The smallest measure of the corners with a movable point, and of the determinants in their
  /// units, at x.
  double worst() const;
  /// The smallest measure of the corners only.
  double worstCorner() const;
  /// The same for one cell with other vertices.
  double worstCornerOf(std::size_t cell, const Vec3* vertices) const;
  int steps() const { return this->Steps; }

  /// For tests: the energy of the whole mesh with this window, and its model.
  double energyWith(double low, double threshold);
  void modelWith(double low, double threshold, QuadraticModel& model);

private:
  struct Values
  {
    int corners = 0, count = 0;
    bool measured = false;    ///< the determinants
    std::array<double, 64> s; ///< the corners, then the determinants
  };
  void valuesOf(std::size_t cell, const std::vector<Vec3>& x, double least, Values& values) const;
  double leastDeterminant(std::size_t cell, const std::vector<Vec3>& x) const;
  void measure(std::size_t cell, double least);
  void moveTo(std::vector<Vec3>& x);
  void measureAll();
  void selectAll();
  bool selectNear();
  void indexPoints(const std::vector<char>& moving);
  double energy(const std::vector<Vec3>& x) const;
  void linearize(QuadraticModel& model) const;
  void addCell(std::size_t cell, QuadraticModel& model) const;
  CornerEdges edgesAt(const SlidingCells::Cell& cell, int corner, const Vec3* vertices) const;
  int cornersOf(const CellTopology& t) const
  {
    return this->Options.measure == CornerMeasure::MeanRatio ? t.samples : t.corners;
  }
  /// Whether a corner (from MaxNodes on, a determinant) depends on a movable point.
  bool canMove(std::size_t cell, int corner) const
  {
    return (this->Movable[cell] >> corner & 1) != 0;
  }
  void findMovable();
  bool step();

  const SlidingCells& Cells;
  const ConstrainedPoints& Constrained;
  BoundaryTerms& Boundary;
  std::vector<Vec3>& X;
  const BarrierOptions Options;
  std::vector<double> Units;              ///< of the determinants of each cell
  std::vector<double> Worst, WorstCorner; ///< per cell
  std::vector<double> Least, Longest;     ///< per cell: a bound of the determinants, and an edge
  std::vector<std::uint64_t> Movable;     ///< per cell, see canMove()
  double Low = 0, Threshold = 0;
  std::vector<std::int32_t> Near;  ///< cells with a moving point
  std::vector<Index> Moving;       ///< points
  std::vector<std::int32_t> Local; ///< per point: its number in Moving, or -1
  std::vector<double> Shortest;    ///< edges at each point
  double Damping = 1e-3;
  int Steps = 0;
};
}
#endif
