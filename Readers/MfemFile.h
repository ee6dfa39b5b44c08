// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MfemFile.h
 * @brief Reads and writes MFEM's .mesh files of version 1.0, 1.2 and 1.3, straight or curved.
 *
 * Elements and boundary elements get `Reference`, their attribute. A curved mesh has nodes: a
 * function in MFEM's spaces H1 or L2, of order 1 to MaxMfemOrder, given by nodal values
 * (Gauss-Lobatto, Gauss-Legendre, uniform) or Bernstein coefficients. Its cells become VTK's:
 * quadratic cells with all nodes for order 2, Lagrange cells for higher orders. The functions are
 * evaluated at the evenly spaced nodes of these cells, so that the shape of every cell is kept to
 * rounding. Points are in the order of H1: vertices, nodes of edges, of faces, of elements. If the
 * elements of an L2 space differ at a common node, as in periodic meshes, each value is a point.
 *
 * The following are an error with the remedy: nonconforming, NURBS and inline meshes, meshes of
 * lines, curved pyramids, and the collection Cubic on cubes and prisms.
 *
 * Source: https://mfem.org/mesh-formats and the documentation of its finite element collections.
 */
#ifndef tautline_MfemFile_h
#define tautline_MfemFile_h

#include "CellPlaces.h"

#include "tautline/Elements/ElementType.h"

#include <array>

namespace tautline
{
/// The largest supported order of nodes.
constexpr int MaxMfemOrder = MaxElementOrder;

/// Reads a mesh, with its boundary elements if `lowerCells` is set.
TAUTLINEREADERS_EXPORT MeshFile readMfem(const std::string& name, bool lowerCells);

/**
 * @brief Writes version 1.0. Curved meshes have nodes of the largest order of their cells at the
 * Gauss-Lobatto points; cells of lower order and incomplete cells of second order are raised to it,
 * which does not change their shape.
 *
 * Cells of the highest dimension become elements, cells of one dimension less boundary elements;
 * the attribute is `Reference` if it is above 0, otherwise 1. Throws FileError for cells that MFEM
 * does not have, and for curved pyramids.
 *
 * @param continuous whether nodes are in H1; otherwise in L2 (Gauss-Lobatto), which is required if
 * the points of neighbors differ at a common node; H1 is then an error
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeMfem(
  const MeshFile& mesh, const std::string& name, bool continuous = true);

/**
 * @brief Writes a copy of a curved file with the nodes of a mesh: the space, the ordering and all
 * other text do not change, including the numbers of nodes whose elements have not moved.
 *
 * @param mesh the file as read by readMfem(), with other points
 * @param source the file
 * @throws FileError if the cells of the mesh and the file differ, or the file has no nodes
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> rewriteMfem(
  const MeshFile& mesh, const std::string& source, const std::string& name);

/// An element shape of MFEM, by its number in the files.
struct MfemShape
{
  struct Face
  {
    int corners; ///< 3 or 4
    std::array<int, 4> corner;
  };

  const char* name;
  ElementShape shape; ///< for a triangle, a square or a volume
  int dimension;
  std::vector<LatticePoint> corners; ///< for order 1
  std::vector<std::array<int, 2>> edges;
  std::vector<Face> faces;        ///< for a volume
  std::array<int, 3> simplexAxes; ///< 1 for axes whose coordinates add up to at most 1, otherwise 0

  /// The lattice of an order, the first coordinate fastest.
  std::vector<LatticePoint> lattice(int order) const;
  bool isInside(const LatticePoint& place, int order) const;
};

/// Shapes 0 (point) to 7 (pyramid).
const MfemShape& mfemShape(int geometry);
}
#endif
