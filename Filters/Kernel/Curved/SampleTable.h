// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleTable.h
 * @brief Where the map of an element is sampled, and what its Jacobian is made of there.
 * Internal: not installed.
 *
 * The standard places are those of a quadrature whose weights are positive: with a negative one a
 * sum of barriers has no minimum. Intervals have Gauss-Lobatto rules, whose places include the
 * corners; triangles and tetrahedra products of Gauss-Jacobi rules (A. H. Stroud, "Approximate
 * calculation of multiple integrals", 1971), tetrahedra up to order 2 quadratureOf().
 */
#ifndef tautline_SampleTable_h
#define tautline_SampleTable_h

#include "tautline/Core/Packet.h"
#include "tautline/Elements/ElementType.h"

#include <memory>

namespace tautline
{
struct SamplePlace
{
  Vec3 at;       ///< reference coordinates
  double weight; ///< share of the element
};

/// The places and weights of the quadrature over an element; the weights add up to 1.
std::vector<SamplePlace> quadrature(const ElementType& type);

/// A matrix of the dimension of the element in the leading rows and columns.
using SmallMatrix = std::array<std::array<double, 3>, 3>;

/// Places all over a shape, edges included, that tell apart polynomials of the degree of the
/// determinant of an element; their weights are equal and add up to 1.
std::vector<SamplePlace> lattice(ElementShape shape, const ElementOrders& orders);

/// W^-1 of the ideal element with edges of length 1, with respect to the reference coordinates.
SmallMatrix idealInverse(ElementShape shape);
double determinantOf(const SmallMatrix& m, int dimension);

/**
 * @class SampleTable
 * @brief The gradients of the shape functions at some places, times W^-1 of the ideal element: the
 * columns of T = A W^-1 are the sums of nodes times these.
 *
 * The places are the lanes of packets; lanes beyond the last place repeat it with weight 0.
 */
class SampleTable
{
public:
  /// @param mirrored whether the elements are taken for their mirror images
  SampleTable(const ElementType& type, bool mirrored, std::vector<SamplePlace> places);

  int nodes() const { return this->Nodes; }
  int packets() const { return static_cast<int>(this->Weights.size()); }
  const std::vector<SamplePlace>& places() const { return this->Places; }
  Packet weights(int packet) const { return this->Weights[packet]; }
  /// One per node and column of T: node * dimension + column.
  const Packet* gradients(int packet) const
  {
    return this->Gradients.data() + static_cast<std::size_t>(packet) * this->Stride;
  }
  /// det W: det A = det T det W.
  double idealDeterminant() const { return this->IdealDeterminant; }

private:
  int Nodes, Stride;
  std::vector<SamplePlace> Places;
  std::vector<Packet> Weights, Gradients;
  double IdealDeterminant;
};
}
#endif
