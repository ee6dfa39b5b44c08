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
  int rank = -1;           ///< how many coefficients the neighbors determine
  bool determined = false; ///< whether that is all of them
};

/// The coefficients of a quadratic that has a given value at its center.
constexpr int unknownsOf(int dimension)
{
  return dimension + dimension * (dimension + 1) / 2;
}

/**
 * @brief Fits a quadratic, exact for quadratics where it is determined; else the second derivatives
 * are as small as possible. It does not depend on how the neighbors are stretched: linear maps of
 * them give the mapped derivatives.
 * @param dimension 2, of x and y, or 3
 * @param offsets of the neighbors from the center; with dimension 2 their third coordinate is 0
 * @param values per neighbor, its value minus that at the center
 */
QuadraticFit fitQuadratic(
  int dimension, const std::vector<Vec3>& offsets, const std::vector<double>& values);

/// Rings of neighbors are added until a fit is determined by more points than it has coefficients,
/// at most so many.
constexpr int MaximumRings = 3;

/**
 * @brief A fit to the points around a point, with as many rings of them as it needs.
 * @param found the first ring
 * @param enough how many points suffice
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

/// The same around a point of a mesh, of a field, in the tangent plane of surfaces.
QuadraticFit fitField(const AdaptationMesh& mesh, Index point, const std::vector<double>& values);

/// A tensor given in coordinates x . axes[i], in those of x.
MetricTensor outOf(const MetricTensor& m, const std::array<Vec3, 3>& axes);
}
#endif
