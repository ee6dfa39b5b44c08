// SPDX-License-Identifier: BSD-3-Clause
#include "CornerShape.h"

namespace tautline
{
namespace
{
/// The coordinates of the nodes of a hexahedron in the unit cube.
constexpr double cube[MaxNodes][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
  { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

/// The derivatives of the trilinear functions of the nodes.
DeterminantPlace placeInCube(const std::array<double, 3>& at)
{
  DeterminantPlace place = {};
  for (int n = 0; n < MaxNodes; ++n)
  {
    std::array<double, 3> factor, slope;
    for (int c = 0; c < 3; ++c)
    {
      factor[c] = cube[n][c] > 0 ? at[c] : 1 - at[c];
      slope[c] = cube[n][c] > 0 ? 1.0 : -1.0;
    }
    for (int c = 0; c < 3; ++c)
    {
      place.weights[c][n] = slope[c] * factor[(c + 1) % 3] * factor[(c + 2) % 3];
    }
  }
  return place;
}

/// Halfway along a wedge edge between its triangles: there, the derivatives in the triangle are the
/// means of the derivatives at both ends.
DeterminantPlace placeInWedge(const CellTopology& t, int corner)
{
  DeterminantPlace place = {};
  for (const int end : { corner, corner + 3 })
  {
    const std::array<int, 4>& nodes = t.cornerNodes[end];
    // As seen from the other triangle, the first two edges are exchanged.
    for (int c = 0; c < 2; ++c)
    {
      const int to = nodes[(end == corner ? c : 1 - c) + 1];
      place.weights[c][to] += 0.5;
      place.weights[c][end] -= 0.5;
    }
  }
  place.weights[2][corner + 3] = 1;
  place.weights[2][corner] = -1;
  return place;
}

std::vector<DeterminantPlace> makePlaces(const CellTopology& t)
{
  std::vector<DeterminantPlace> places;
  for (int corner = 0; corner < t.corners && t.type != CellType::Hexahedron; ++corner)
  {
    DeterminantPlace place = {};
    for (int c = 0; c < t.dimension; ++c)
    {
      place.weights[c][t.cornerNodes[corner][c + 1]] = 1;
      place.weights[c][t.cornerNodes[corner][0]] = -1;
    }
    places.push_back(place);
    if (t.samples == 1)
    {
      break; // the same at each corner
    }
  }
  constexpr int lattice = 27;
  for (int i = 0; t.type == CellType::Hexahedron && i < lattice; ++i)
  {
    places.push_back(placeInCube({ 0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9) }));
  }
  for (int corner = 0; t.type == CellType::Wedge && corner < 3; ++corner)
  {
    places.push_back(placeInWedge(t, corner));
  }
  return places;
}

CornerValue scaledJacobian(const CellTopology& t, const CornerEdges& at, bool gradient)
{
  const auto& [a, b, c] = at.edges;
  const Vec3 bc = cross(b, c);
  const double a2 = dot(a, a), b2 = dot(b, b), c2 = dot(c, c), lengths = std::sqrt(a2 * b2 * c2);
  CornerValue result = { -1, {} };
  if (!(lengths > 0))
  {
    return result;
  }
  const double f = at.sign * t.scaledJacobianFactor / lengths;
  result.value = f * dot(a, bc);
  if (gradient)
  {
    result.gradient = { f * bc - (result.value / a2) * a, f * cross(c, a) - (result.value / b2) * b,
      f * cross(a, b) - (result.value / c2) * c };
  }
  return result;
}

CornerValue meanRatio(const CellTopology& t, int corner, const CornerEdges& at, bool gradient)
{
  const std::array<double, 9>& w = t.idealInverse[corner];
  std::array<Vec3, 3> columns = {};
  for (int j = 0; j < 3; ++j)
  {
    for (int k = 0; k < 3; ++k)
    {
      columns[j] += w[3 * k + j] * at.edges[k];
    }
  }
  const auto& [a, b, c] = columns;
  const std::array<Vec3, 3> cofactor = { at.sign * cross(b, c), at.sign * cross(c, a),
    at.sign * cross(a, b) };
  const double det = dot(a, cofactor[0]), d = at.dimension;
  const double size2 = dot(a, a) + dot(b, b) + (d > 2 ? dot(c, c) : 0.0);
  CornerValue result = { -1, {} };
  if (!(det > 0))
  {
    return result;
  }
  result.value = d * (d > 2 ? std::cbrt(det * det) : det) / size2;
  for (int j = 0; gradient && j < at.dimension; ++j)
  {
    const Vec3 byColumn =
      result.value * ((2.0 / (d * det)) * cofactor[j] - (2.0 / size2) * columns[j]);
    for (int k = 0; k < at.dimension; ++k)
    {
      result.gradient[k] += w[3 * k + j] * byColumn;
    }
  }
  return result;
}
}

//------------------------------------------------------------------------------
CornerValue measureCorner(
  const CellTopology& t, int corner, const CornerEdges& edges, CornerMeasure measure, bool gradient)
{
  return measure == CornerMeasure::ScaledJacobian ? scaledJacobian(t, edges, gradient)
                                                  : meanRatio(t, corner, edges, gradient);
}

//------------------------------------------------------------------------------
const std::vector<DeterminantPlace>& determinantPlaces(CellType type)
{
  static const std::array<std::vector<DeterminantPlace>, NumberOfCellTypes> table = []
  {
    std::array<std::vector<DeterminantPlace>, NumberOfCellTypes> result;
    for (int i = 0; i < NumberOfCellTypes; ++i)
    {
      result[i] = makePlaces(topologies()[i]);
    }
    return result;
  }();
  return table[topologyIndex(type)];
}

//------------------------------------------------------------------------------
double determinantAt(const CellTopology& t, const DeterminantPlace& place, const Vec3* vertices,
  const Vec3& normal, Vec3* gradient)
{
  Vec3 derivative[3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
  for (int c = 0; c < t.dimension; ++c)
  {
    for (int n = 0; n < t.nodes; ++n)
    {
      derivative[c] += place.weights[c][n] * vertices[n];
    }
  }
  if (t.dimension == 2)
  {
    derivative[2] = normal;
  }
  const Vec3 &a = derivative[0], &b = derivative[1], &c = derivative[2];
  const Vec3 bc = cross(b, c);
  if (gradient)
  {
    const Vec3 ca = cross(c, a), ab = cross(a, b);
    for (int n = 0; n < t.nodes; ++n)
    {
      gradient[n] = place.weights[0][n] * bc + place.weights[1][n] * ca;
      gradient[n] += t.dimension == 2 ? Vec3{ 0, 0, 0 } : place.weights[2][n] * ab;
    }
  }
  return dot(a, bc);
}
}
