// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTable.h"

#include "tautline/Elements/ElementSamples.h"

namespace tautline
{
//------------------------------------------------------------------------------
SmallMatrix idealInverse(ElementShape shape)
{
  const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0), root6 = std::sqrt(6.0);
  SmallMatrix m = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  switch (shape)
  {
    case ElementShape::Tetrahedron:
      // Edges (1, 0, 0), (1/2, sqrt(3)/2, 0) and (1/2, sqrt(3)/6, sqrt(2/3)).
      m = { { { 1, -1 / root3, -1 / root6 }, { 0, 2 / root3, -1 / root6 }, { 0, 0, 3 / root6 } } };
      break;
    case ElementShape::Triangle:
    case ElementShape::Wedge:
      m[0][1] = -1 / root3;
      m[1][1] = 2 / root3;
      break;
    case ElementShape::Pyramid:
      // The apex is above the middle of the base.
      m = { { { 1, 0, -1 / root2 }, { 0, 1, -1 / root2 }, { 0, 0, root2 } } };
      break;
    default:
      break;
  }
  return m;
}

//------------------------------------------------------------------------------
double determinantOf(const SmallMatrix& m, int dimension)
{
  return dimension == 2
    ? m[0][0] * m[1][1] - m[0][1] * m[1][0]
    : dot(Vec3{ m[0][0], m[0][1], m[0][2] }, cross(Vec3{ m[1][0], m[1][1], m[1][2] }, m[2]));
}

//------------------------------------------------------------------------------
SampleTable::SampleTable(const ElementType& type, bool mirrored, std::vector<SamplePlace> places)
  : Nodes(type.nodes())
  , Stride(type.nodes() * type.dimension())
  , Places(std::move(places))
{
  const int dimension = type.dimension();
  const SmallMatrix inverse = idealInverse(type.shape());
  this->IdealDeterminant = 1 / determinantOf(inverse, dimension);
  const auto count = static_cast<int>(this->Places.size());
  const int packets = (count + PacketWidth - 1) / PacketWidth;
  this->Weights.assign(packets, Packet{});
  this->Gradients.resize(static_cast<std::size_t>(packets) * this->Stride);
  const ElementSamples samples(type, {});
  std::vector<Vec3> gradients;
  for (int sample = 0; sample < packets * PacketWidth; ++sample)
  {
    const int packet = sample / PacketWidth, lane = sample % PacketWidth;
    // Padded lanes repeat the last sample, with weight 0.
    if (sample < count)
    {
      gradients = samples.gradientsAt(this->Places[sample].at);
      this->Weights[packet][lane] = this->Places[sample].weight;
    }
    Packet* to = this->Gradients.data() + static_cast<std::size_t>(packet) * this->Stride;
    for (int node = 0; node < this->Nodes; ++node)
    {
      for (int column = 0; column < dimension; ++column)
      {
        double sum = 0;
        for (int k = 0; k < dimension; ++k)
        {
          sum += gradients[node][k] * inverse[k][column];
        }
        // In a mirrored element, the changed sign of the last column makes valid determinants
        // positive.
        to[node * dimension + column][lane] = mirrored && column == dimension - 1 ? -sum : sum;
      }
    }
  }
}
}
