// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementSamples.h
 * @brief Weighted sample points of an element, and the derivatives of its map there.
 *
 * The rules are symmetric, so that the order of the nodes does not matter, have positive weights,
 * and their points are inside:
 * - quadratureOf(), for means and integrals: triangles 12 points of degree 6 (D. A. Dunavant, Int.
 *   J. Numer. Meth. Eng. 21 (1985)), tetrahedra 14 points of degree 5 (N. J. Walkington, CNA report
 *   00-023 (2000)); along other axes, Gauss points, two more than the order;
 * - integrationPoints(), where solvers evaluate the Jacobian determinant: for quadratic elements, 3
 *   points for the triangle, 4 for the tetrahedron (as in C3D10), 3 x 3 (x 3) for the quadrilateral
 *   (hexahedron, C3D20), 9 for the wedge (C3D15), 2 x 2 x 2 for the pyramid in the collapsed cube;
 *   for higher orders, 6 and 14, and order + 1 along an axis.
 */
#ifndef tautline_ElementSamples_h
#define tautline_ElementSamples_h

#include "ElementType.h"

#include <memory>

namespace tautline
{
struct ColumnForm;

/// Points and weights; coordinates as in ElementType.
struct ElementRule
{
  std::vector<Vec3> places;
  std::vector<double> weights; ///< their sum is 1
};

TAUTLINE_KERNEL_EXPORT ElementRule quadratureOf(const ElementType& type);
TAUTLINE_KERNEL_EXPORT ElementRule integrationPoints(const ElementType& type);
/// The corners (for a pyramid, only of its base), with equal weights.
TAUTLINE_KERNEL_EXPORT ElementRule cornersOf(const ElementType& type);
/// The nodes of the element, with equal weights.
TAUTLINE_KERNEL_EXPORT ElementRule nodesOf(const ElementType& type);

/**
 * @class ElementSamples
 * @brief The columns of the Jacobian of elements of one type at the points of a rule.
 *
 * For a pyramid, with respect to the coordinates that are not collapsed.
 */
class TAUTLINE_KERNEL_EXPORT ElementSamples
{
public:
  ElementSamples(const ElementType& type, ElementRule rule);

  int count() const { return static_cast<int>(this->Rule.places.size()); }
  const ElementRule& rule() const { return this->Rule; }

  /// The columns at point s of an element; the third one is 0 in 2D.
  std::array<Vec3, 3> columns(int s, const double* points, const Index* nodes) const;

  /// The same at any position; slower.
  std::array<Vec3, 3> columnsAt(const Vec3& at, const double* points, const Index* nodes) const;

  /**
   * @brief The determinants at all points.
   * @param normal the unit normal of planar elements; {0, 0, 0}: elements of a surface, whose
   * normals are projected onto the normal at the mean of the points
   * @param mirrored the opposite sign, except for surfaces
   */
  void determinants(const double* points, const Index* nodes, const Vec3& normal, bool mirrored,
    double* result) const;

  /// The gradients of the shape functions at a position, one per node; for a pyramid, with respect
  /// to the coordinates that are not collapsed.
  std::vector<Vec3> gradientsAt(const Vec3& at) const;

private:
  std::array<Vec3, 3> columns(
    const Vec3* gradients, const double* points, const Index* nodes) const;

  ElementRule Rule;
  int Dimension, Nodes;
  std::shared_ptr<const ColumnForm> Form;
  std::vector<Vec3> Gradients; ///< by point and node
};

/// The point of an element at a reference position.
TAUTLINE_KERNEL_EXPORT Vec3 pointOfElement(
  const ElementType& type, const double* points, const Index* nodes, const Vec3& at);

/// The area or volume of the reference element: 1/2, 1, 1/6, 1, 1/2, 1/3.
TAUTLINE_KERNEL_EXPORT double referenceSizeOf(ElementShape shape);
}
#endif
