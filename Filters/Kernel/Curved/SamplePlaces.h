// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SamplePlaces.h
 * @brief The sample points of the map of an element.
 *
 * They are the points of a quadrature with positive weights: with a negative weight, a sum of
 * barriers has no minimum. Intervals use Gauss-Lobatto rules, whose points include the corners;
 * triangles and tetrahedra use products of Gauss-Jacobi rules (A. H. Stroud, "Approximate
 * calculation of multiple integrals", 1971); tetrahedra up to order 2 use quadratureOf().
 * Internal: not installed.
 */
#ifndef tautline_SamplePlaces_h
#define tautline_SamplePlaces_h

#include "tautline/Elements/ElementType.h"

namespace tautline
{
struct SamplePlace
{
  Vec3 at;       ///< reference coordinates
  double weight; ///< fraction of the element
};

/// The points and weights of the quadrature over an element; the weights add up to 1.
TAUTLINE_KERNEL_EXPORT std::vector<SamplePlace> quadrature(const ElementType& type);

/// A matrix of the dimension of the element in the leading rows and columns.
using SmallMatrix = std::array<std::array<double, 3>, 3>;

/// Points distributed over a shape, including its edges, that determine polynomials of the degree
/// of the element determinant; their weights are equal and add up to 1.
TAUTLINE_KERNEL_EXPORT std::vector<SamplePlace> lattice(
  ElementShape shape, const ElementOrders& orders);
}
#endif
