// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementType.h
 * @brief One description of the elements of all shapes and orders: reference coordinates, the
 * polynomials of the map, and its Bernstein form.
 *
 * Reference elements: the triangle and the tetrahedron with legs of length 1, the unit square and
 * cube, the prism over the triangle. A pyramid is described by the cube that collapses to it, (u,
 * v, w) -> (u (1 - w), v (1 - w), w), like VTK's pyramids with 5 and 13 nodes.
 *
 * VTK's types and their nodes:
 * - linear: 5, 9, 10, 12, 13, 14;
 * - quadratic: 22 (6), 23 (8), 24 (10), 25 (20), 26 (15), 27 (13), 28 (9), 29 (27), 30 (6), 31
 *   (12),
 *   32 (18), 33 (24), 34 (7), 37 (19);
 * - Lagrange: 69 to 73, with orders 1 to MaxElementOrder that may differ by axis, and with the
 *   special node counts 7 (triangle), 15 (tetrahedron) and 21 (wedge);
 * - Bezier: 76 to 80, whose nodes are control points, with equal weights.
 */
#ifndef tautline_ElementType_h
#define tautline_ElementType_h

#include "BernsteinSpace.h"
#include "DeterminantForm.h"
#include "ElementShape.h"

namespace tautline
{
struct VtkElement;

/**
 * @class ElementType
 * @brief The map from the reference element, as a matrix from nodes to Bernstein coefficients.
 *
 * Immutable; may be used by any number of threads.
 */
class TAUTLINE_KERNEL_EXPORT ElementType
{
public:
  /**
   * @brief The type of a VTK cell. Built at the first call, then the same object; thread safe.
   * @param vtkType a code of the list above
   * @param nodes of the cell
   * @param orders of a Lagrange or Bezier cell, the "HigherOrderDegrees" of VTK; {0, 0, 0}, the
   * default, derives one order for all axes from the number of nodes. Ignored for other types.
   * @throws Error for other types, node counts and orders
   */
  static const ElementType& ofVtk(
    int vtkType, int nodes, const ElementOrders& orders = { 0, 0, 0 });

  /**
   * @brief An element with nodes at any positions: Gauss or Lobatto points, or the node order of
   * another program.
   * @param shape the map has all polynomials of the given orders over it; for a pyramid, the
   * polynomials of M. Bergot, G. Cohen, M. Durufle, "Higher-order finite elements for hybrid meshes
   * using new nodal pyramidal elements", J. Sci. Comput. 42 (2010)
   * @param orders 1 to MaxElementOrder; the orders of a pyramid are equal
   * @param coordinates of the nodes: u, v, w; for a pyramid, in the collapsed cube
   * @throws Error if the numbers of nodes and polynomials differ, or if the nodes do not determine
   * the polynomials
   */
  ElementType(
    ElementShape shape, const ElementOrders& orders, const std::vector<Vec3>& coordinates);

  ElementShape shape() const { return this->Shape; }
  int dimension() const { return this->Space.dimension(); }
  int nodes() const { return static_cast<int>(this->Coordinates.size()); }
  const ElementOrders& orders() const { return this->Orders; }

  /// The reference coordinates of the nodes (for Bezier control points: of the corresponding
  /// nodes).
  const std::vector<Vec3>& coordinates() const { return this->Coordinates; }

  /// The Bernstein polynomials in which the map is written.
  const BernsteinSpace& space() const { return this->Space; }
  /// The matrix from nodes to control points: the coefficients of the map.
  const ControlMatrix& controls() const { return this->Controls; }
  /// The form of the Jacobian determinant in terms of the control points.
  const DeterminantForm& determinant() const { return this->Determinant; }

  /// The values of the shape functions at a point of the reference element, one per node.
  std::vector<double> shapeFunctions(const Vec3& at) const;

private:
  explicit ElementType(const VtkElement& element);

  ElementShape Shape;
  ElementOrders Orders;
  std::vector<Vec3> Coordinates;
  BernsteinSpace Space;
  ControlMatrix Controls;
  DeterminantForm Determinant;
};
}
#endif
