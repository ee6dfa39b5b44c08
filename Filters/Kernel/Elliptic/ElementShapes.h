// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementShapes.h
 * @brief Shape functions of the six linear cell types and of quadratic simplices with quadrature,
 * and their gradients in space.
 * Internal: not installed.
 */
#ifndef tautline_ElementShapes_h
#define tautline_ElementShapes_h

#include "tautline/Mesh/Mesh.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tautline
{
/// The elements. The linear ones are in the order of topologies().
enum class ElementKind : signed char
{
  None = -1,
  Triangle,
  Quadrilateral,
  Tetrahedron,
  Hexahedron,
  Wedge,
  Pyramid,
  QuadraticTriangle,
  BubbleTriangle, ///< with 7 nodes: quadratic with a cubic bubble
  QuadraticTetrahedron
};

constexpr int NumberOfElementKinds = 9;
constexpr int MaxElementNodes = 10;

/**
 * @brief The element of a VTK cell: linear cells (5, 9, 10, 12, 13, 14), quadratic triangles (22;
 * 34, with a node at the center) and tetrahedra (24), and Lagrange triangles (69) and tetrahedra
 * (71) with the same numbers of nodes. None for all other cells.
 * @param nodes of the cell
 */
ElementKind elementKind(int vtkType, Index nodes);

inline ElementKind elementKind(const MeshView& view, Index cell)
{
  return elementKind(view.cellTypes[cell], view.offsets[cell + 1] - view.offsets[cell]);
}

inline bool isQuadratic(ElementKind kind)
{
  return kind > ElementKind::Pyramid;
}

/// The number of nodes of an element; 0 for None.
int nodesOf(ElementKind kind);

/// A quadrature point in the reference cell: weight, shape functions and their derivatives with
/// respect to reference coordinates.
struct ReferencePoint
{
  double weight;
  std::array<double, MaxElementNodes> value;
  std::array<std::array<double, MaxElementNodes>, 3> derivative; ///< [direction][node]
};

/**
 * @brief Quadrature on the reference cell: Gauss points, this many per direction. Simplices, wedges
 * and pyramids are cubes with collapsed sides, so that n points are exact to degree 2 n - 2 on
 * triangles and 2 n - 3 on tetrahedra and pyramids. The weights of simplices sum to 1/2 and 1/6.
 */
std::vector<ReferencePoint> referenceRule(ElementKind kind, int pointsPerDirection);

/**
 * @brief The quadrature points for the matrix of an element: one point for simplices with constant
 * gradients, two Gauss points per direction for other linear cells. Quadratic simplices have rules
 * of positive weights that are exact to degree 5, which is enough for order 3 in L2 on curved
 * elements (P. G. Ciarlet, The Finite Element Method for Elliptic Problems, 1978, section 4.4): 7
 * points (J. Radon 1948) and 14 (N. J. Walkington, "Quadrature on simplices of arbitrary
 * dimension", 2000). With the bubble, the degree is 6.
 */
std::vector<ReferencePoint> elementRule(ElementKind kind);

/// The point at which the derivatives of a solution are evaluated: for simplices, the center.
std::vector<ReferencePoint> centerRule(ElementKind kind);

/// One rule for each kind of element.
using ElementRules = std::array<std::vector<ReferencePoint>, NumberOfElementKinds>;

template <class MakeRule>
ElementRules elementRules(const MakeRule& makeRule)
{
  ElementRules rules;
  for (int kind = 0; kind < NumberOfElementKinds; ++kind)
  {
    rules[kind] = makeRule(static_cast<ElementKind>(kind));
  }
  return rules;
}

/// The gradients of the shape functions at one point of an element, and the weight of the point in
/// an integral.
template <int Nodes>
struct ElementSample
{
  double weight;                         ///< |det J| times the weight; 0 where J vanishes
  const double* value;                   ///< shape functions
  std::array<double, Nodes> gradient[3]; ///< [x, y, z][node]
};

/// A point is flat if |det J| is at most this fraction of the product of the lengths of the columns
/// of J.
constexpr double flatTolerance = 1e-13; // Mesh::degenerateTolerance()

/// False for overflow and NaN, which are propagated so that they are detected.
inline bool isFlat(double det, double lengths)
{
  return det <= flatTolerance * lengths && lengths <= std::numeric_limits<double>::max();
}

/**
 * @brief Fills a sample: for a cell of dimension 3, or a cell of dimension 2 anywhere in space,
 * whose gradients are tangential. A point where the Jacobian vanishes gets weight 0 and gradients
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
  // The rows of the inverse (in two dimensions: the pseudo-inverse), up to the determinant.
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

/// Calls work(nodes of the element, its dimension) with both as compile-time constants.
template <class Work>
void withElement(ElementKind kind, const Work& work)
{
  const std::integral_constant<int, 2> two{};
  const std::integral_constant<int, 3> three{};
  switch (kind)
  {
    case ElementKind::Triangle:
      return work(std::integral_constant<int, 3>{}, two);
    case ElementKind::Quadrilateral:
      return work(std::integral_constant<int, 4>{}, two);
    case ElementKind::Tetrahedron:
      return work(std::integral_constant<int, 4>{}, three);
    case ElementKind::Hexahedron:
      return work(std::integral_constant<int, 8>{}, three);
    case ElementKind::Wedge:
      return work(std::integral_constant<int, 6>{}, three);
    case ElementKind::Pyramid:
      return work(std::integral_constant<int, 5>{}, three);
    case ElementKind::QuadraticTriangle:
      return work(std::integral_constant<int, 6>{}, two);
    case ElementKind::BubbleTriangle:
      return work(std::integral_constant<int, 7>{}, two);
    case ElementKind::QuadraticTetrahedron:
      return work(std::integral_constant<int, 10>{}, three);
    case ElementKind::None:
      break;
  }
}
}
#endif
