// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MfemFile.h
 * @brief MFEM's .mesh files of version 1.0, 1.2 and 1.3, straight or curved.
 *
 * Elements and boundary elements get `Reference`, their attribute. A curved mesh has nodes: a
 * function of MFEM's spaces H1 or L2, of order 1 to MaxMfemOrder, by nodal values (Gauss-Lobatto,
 * Gauss-Legendre, uniform) or Bernstein coefficients. Its cells become VTK's: quadratic ones with
 * all nodes for order 2, Lagrange cells for higher orders, whose nodes are evenly spaced: the
 * functions are evaluated there, so that the shape of every cell is kept to rounding. Points are in
 * the order of H1: vertices, nodes of edges, of faces, of elements. Where the elements of a space
 * L2 differ at a common node, as in periodic meshes, each value is a point.
 *
 * Refused by name, with the remedy: nonconforming, NURBS and inline meshes, meshes of lines, curved
 * pyramids, and the collection Cubic on cubes and prisms.
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
/// The largest order of nodes that are read.
constexpr int MaxMfemOrder = MaxElementOrder;

/// Reads a mesh; `lowerCells`: with the boundary elements.
TAUTLINEREADERS_EXPORT MeshFile readMfem(const std::string& name, bool lowerCells);

/**
 * @brief Writes version 1.0. Curved meshes have nodes of the order of their cells at the points of
 * Gauss and Lobatto; those of lower order and the incomplete ones of second order are raised to it,
 * which does not change their shape.
 *
 * Cells of the highest dimension are elements, those of one dimension less boundary elements;
 * `Reference` is the attribute where it is above 0, else 1. Throws FileError for cells that MFEM
 * does not have, and for curved pyramids.
 *
 * @param continuous whether nodes are of H1; else of L2 (Gauss-Lobatto), as neighbors need whose
 * points differ at a common node; H1 is refused for such
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeMfem(
  const MeshFile& mesh, const std::string& name, bool continuous = true);

/**
 * @brief Writes a copy of a curved file in which the nodes are those of a mesh: the space, the
 * ordering and all other text stay, also numbers of nodes whose elements have not moved.
 *
 * @param mesh the file as readMfem() reads it, with other points
 * @param source the file
 * @throws FileError where the mesh has other cells than the file, or the file no nodes
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
  ElementShape shape; ///< of a triangle, a square or a volume
  int dimension;
  std::vector<LatticePoint> corners; ///< of order 1
  std::vector<std::array<int, 2>> edges;
  std::vector<Face> faces;        ///< of a volume
  std::array<int, 3> simplexAxes; ///< the axes whose coordinates add up to 1 at most: 1, else 0

  /// The lattice of an order, the first coordinate fastest.
  std::vector<LatticePoint> lattice(int order) const;
  bool isInside(const LatticePoint& place, int order) const;
};

/// Shapes 0 (point) to 7 (pyramid).
const MfemShape& mfemShape(int geometry);
}
#endif
