// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleTable.h
 * @brief The shape-function gradients of an element at its sample points.
 * Internal: not installed.
 */
#ifndef tautline_SampleTable_h
#define tautline_SampleTable_h

#include "SamplePlaces.h"
#include "tautline/Core/Packet.h"

#include <memory>

namespace tautline
{
/// W^-1 of the ideal element with edges of length 1, with respect to the reference coordinates.
SmallMatrix idealInverse(ElementShape shape);
double determinantOf(const SmallMatrix& m, int dimension);

/**
 * @class SampleTable
 * @brief The gradients of the shape functions at some points, times W^-1 of the ideal element: the
 * columns of T = A W^-1 are sums of the nodes times these gradients.
 *
 * The points are the lanes of packets; lanes beyond the last point repeat it with weight 0.
 */
class SampleTable
{
public:
  /// @param mirrored whether the elements are treated as their mirror images
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
  /// det W, where det A = det T det W.
  double idealDeterminant() const { return this->IdealDeterminant; }

private:
  int Nodes, Stride;
  std::vector<SamplePlace> Places;
  std::vector<Packet> Weights, Gradients;
  double IdealDeterminant;
};
}
#endif
