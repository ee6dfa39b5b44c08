// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SamplePlaces.h
 * @brief Where the map of an element is sampled.
 * Internal: not installed.
 *
 * The places are those of a quadrature whose weights are positive: with a negative one a
 * sum of barriers has no minimum. Intervals have Gauss-Lobatto rules, whose places include the
 * corners; triangles and tetrahedra products of Gauss-Jacobi rules (A. H. Stroud, "Approximate
 * calculation of multiple integrals", 1971), tetrahedra up to order 2 quadratureOf().
 */
#ifndef tautline_SamplePlaces_h
#define tautline_SamplePlaces_h

#include "tautline/Elements/ElementType.h"

namespace tautline
{
struct SamplePlace
{
  Vec3 at;       ///< reference coordinates
  double weight; ///< share of the element
};

/// The places and weights of the quadrature over an element; the weights add up to 1.
TAUTLINE_KERNEL_EXPORT std::vector<SamplePlace> quadrature(const ElementType& type);

/// A matrix of the dimension of the element in the leading rows and columns.
using SmallMatrix = std::array<std::array<double, 3>, 3>;

/// Places all over a shape, edges included, that tell apart polynomials of the degree of the
/// determinant of an element; their weights are equal and add up to 1.
TAUTLINE_KERNEL_EXPORT std::vector<SamplePlace> lattice(
  ElementShape shape, const ElementOrders& orders);
}
#endif
