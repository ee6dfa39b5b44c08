// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QuadraticFit.h
 * @brief Derivatives at a point from values at its neighbors, by weighted least squares.
 * Internal: not installed.
 */
#ifndef tautline_QuadraticFit_h
#define tautline_QuadraticFit_h

#include "AdaptationMesh.h"

#include <vector>

namespace tautline
{
struct QuadraticFit
{
  Vec3 gradient = { 0, 0, 0 };
  MetricTensor hessian = {};
  int rank = -1;           ///< the number of coefficients that the neighbors determine
  bool determined = false; ///< whether all are determined
};

/// The number of coefficients of a quadratic with a given value at its center.
constexpr int unknownsOf(int dimension)
{
  return dimension + dimension * (dimension + 1) / 2;
}

/**
 * @brief Fits a quadratic, exact for quadratics if they are determined; otherwise the second
 * derivatives are as small as possible. The fit is invariant to stretching: linear maps of the
 * neighbors give the mapped derivatives.
 * @param dimension 2, of x and y, or 3
 * @param offsets of the neighbors from the center; with dimension 2 their third coordinate is 0
 * @param values per neighbor: its value minus the value at the center
 */
QuadraticFit fitQuadratic(
  int dimension, const std::vector<Vec3>& offsets, const std::vector<double>& values);

/// Rings of neighbors are added until a fit is determined by more points than it has coefficients;
/// at most this many.
constexpr int MaximumRings = 3;

/**
 * @brief A fit to the points around a point, with as many rings of them as it needs.
 * @param found the first ring
 * @param enough the sufficient number of points
 * @param grow adds the next ring to points
 * @param fit the fit to some points
 */
template <class Grow, class Fit>
QuadraticFit fitRings(
  std::vector<Index> found, std::size_t enough, const Grow& grow, const Fit& fit)
{
  QuadraticFit best;
  bool few = true;
  for (int ring = 1; ring <= MaximumRings && (few || !best.determined); ++ring)
  {
    const QuadraticFit next = fit(found);
    best = few || next.rank > best.rank ? next : best;
    few = found.size() < enough;
    if (ring < MaximumRings && (few || !best.determined))
    {
      grow(found);
    }
  }
  return best;
}

/// The same for a field around a point of a mesh; on surfaces, in the tangent plane.
QuadraticFit fitField(const AdaptationMesh& mesh, Index point, const std::vector<double>& values);

/// Converts a tensor from the coordinates x . axes[i] to the coordinates x.
MetricTensor outOf(const MetricTensor& m, const std::array<Vec3, 3>& axes);
}
#endif
