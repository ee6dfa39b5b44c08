// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementShapes.h
 * @brief Shape functions of the six linear cell types with quadrature, and their gradients in
 * space.
 * Internal: not installed.
 */
#ifndef tautline_ElementShapes_h
#define tautline_ElementShapes_h

#include "tautline/Mesh/CellTopology.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tautline
{
/// A place in the reference cell: weight, shape functions and their derivatives by reference
/// coordinates.
struct ReferencePoint
{
  double weight;
  std::array<double, MaxNodes> value;
  std::array<std::array<double, MaxNodes>, 3> derivative; ///< [direction][node]
};

/**
 * @brief Quadrature on the reference cell: Gauss points, so many per direction. Simplices, wedges
 * and pyramids are cubes with collapsed sides, so that n points are exact to degree 2 n - 2 on
 * triangles and 2 n - 3 on tetrahedra and pyramids. The weights of simplices sum to 1/2 and 1/6.
 */
std::vector<ReferencePoint> referenceRule(CellType type, int pointsPerDirection);

/// Gradients of the shape functions at one place of an element, and what the place counts in an
/// integral.
template <int Nodes>
struct ElementSample
{
  double weight;                         ///< |det J| times the weight; 0 where J vanishes
  const double* value;                   ///< shape functions
  std::array<double, Nodes> gradient[3]; ///< [x, y, z][node]
};

/// A place whose |det J| is at most so much of the product of the lengths of J's columns counts as
/// flat.
constexpr double flatTolerance = 1e-13; // Mesh::degenerateTolerance()

/// False for what overflows or is not a number: that goes on, so that it is found.
inline bool isFlat(double det, double lengths)
{
  return det <= flatTolerance * lengths && lengths <= std::numeric_limits<double>::max();
}

/**
 * @brief Fills a sample: a cell of dimension 3 in space, or one of dimension 2 anywhere in space,
 * whose gradients are tangential. A place where the Jacobian vanishes gets weight 0 and gradients
 * 0.
 */
template <int Nodes, int CellDimension>
inline void sampleElement(
  const ReferencePoint& reference, const Vec3* p, ElementSample<Nodes>& sample)
{
  Vec3 column[3] = {};
  for (int d = 0; d < CellDimension; ++d)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        column[d][c] += reference.derivative[d][k] * p[k][c];
      }
    }
  }
  sample.value = reference.value.data();
  // Rows of the inverse, up to the determinant; in two dimensions of the pseudo-inverse.
  Vec3 row[3] = {};
  double det = 0, lengths = norm(column[0]) * norm(column[1]);
  if (CellDimension == 3)
  {
    row[0] = cross(column[1], column[2]);
    row[1] = cross(column[2], column[0]);
    row[2] = cross(column[0], column[1]);
    det = dot(column[0], row[0]);
    lengths *= norm(column[2]);
  }
  else
  {
    const Vec3 normal = cross(column[0], column[1]);
    det = norm(normal);
    const Vec3 unit = (det > 0 ? 1 / det : 0.0) * normal;
    row[0] = cross(column[1], unit);
    row[1] = cross(unit, column[0]);
  }
  const bool flat = isFlat(std::abs(det), lengths);
  sample.weight = flat ? 0.0 : std::abs(det) * reference.weight;
  const double inverse = flat ? 0.0 : 1 / det;
  for (int c = 0; c < 3; ++c)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      double sum = 0;
      for (int d = 0; d < CellDimension; ++d)
      {
        sum += reference.derivative[d][k] * row[d][c];
      }
      sample.gradient[c][k] = inverse * sum;
    }
  }
}

/// Calls work(nodes of the type, its dimension) with both as compile-time constants.
template <class Work>
void withElement(CellType type, const Work& work)
{
  const std::integral_constant<int, 2> two{};
  const std::integral_constant<int, 3> three{};
  switch (type)
  {
    case CellType::Triangle:
      return work(std::integral_constant<int, 3>{}, two);
    case CellType::Quadrilateral:
      return work(std::integral_constant<int, 4>{}, two);
    case CellType::Tetrahedron:
      return work(std::integral_constant<int, 4>{}, three);
    case CellType::Hexahedron:
      return work(std::integral_constant<int, 8>{}, three);
    case CellType::Wedge:
      return work(std::integral_constant<int, 6>{}, three);
    case CellType::Pyramid:
      return work(std::integral_constant<int, 5>{}, three);
    case CellType::Unsupported:
      break;
  }
}
}
#endif
