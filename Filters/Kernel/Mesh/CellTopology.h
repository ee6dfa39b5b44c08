// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellTopology.h
 * @brief The cell types that Tautline supports: local numbering, edges, faces, corners, ideal
 * shape.
 *
 * Local numbering and type codes are the same as in VTK, so that a VTK cell array is used directly.
 * z points up.
 *
 *     Triangle                          Quadrilateral
 *
 *          2                              3 ----- 2
 *         / \                             |       |
 *        /   \                            |       |
 *       0 --- 1                           0 ----- 1
 *
 *     edges 01 12 20                    edges 01 12 23 30
 *
 *     Tetrahedron                       Hexahedron
 *
 *              3                               7 ------ 6
 *             /|\                             /|       /|
 *            / | \                           4 ------ 5 |
 *           /  |  \                          | |      | |
 *          0 --|-- 2                         | 3 -----|-2
 *           \  |  /                          |/       |/
 *             \|/                            0 ------ 1
 *              1
 *
 *     edges 01 12 20 03 13 23           edges 01 12 23 30  45 56 67 74  04 15 26 37
 *     faces 013 123 203 021             faces 0473 1265 0154 3762 0321 4567
 *
 *     Wedge                             Pyramid
 *
 *          4                                      4
 *        / | \                                   /|\ `.
 *       3 --- 5                                 / | \  `.
 *       |  |  |                                /  3 -\--- 2
 *       |  1  |                               /  /    \  /
 *       |/   \|                              0 ------- 1
 *       0 --- 2
 *
 *     edges 01 12 20  34 45 53          edges 01 12 23 30  04 14 24 34
 *           03 14 25                    faces 0321 014 124 234 304
 *     faces 012 354 0341 1452 2530
 *
 * Nodes 0 1 2 of a wedge run counterclockwise as seen from below (outside), unlike the base of a
 * pyramid or hexahedron: the Jacobian at corner 0 of a valid wedge takes the edges to 2, 1 and 3.
 */
#ifndef tautline_CellTopology_h
#define tautline_CellTopology_h

#include "tautline/Core/Types.h"

namespace tautline
{
/// Cell types by VTK's codes.
enum class CellType : unsigned char
{
  Unsupported = 0,
  Triangle = 5,
  Quadrilateral = 9,
  Tetrahedron = 10,
  Hexahedron = 12,
  Wedge = 13,
  Pyramid = 14
};

/// VTK's codes of cells with any number of edges or faces, which only metrics of finite volumes
/// measure.
constexpr int PolygonType = 7, PolyhedronType = 42;

constexpr int MaxNodes = 8;
constexpr int MaxEdges = 12;
constexpr int MaxFaces = 6;
constexpr int MaxFaceNodes = 4;
constexpr int NumberOfCellTypes = 6;

/**
 * @brief Constant facts of one cell type.
 *
 * A corner c spans the Jacobian A_c = [p(k1)-p(c), p(k2)-p(c), p(k3)-p(c)] with k1 k2 k3 its
 * neighbors in right-handed order (two in 2D); W_c is the same matrix of the ideal cell, whose
 * edges all have length 1 (equilateral triangle and faces, square, cube, right wedge, equilateral
 * pyramid). Metrics that are independent of the corner use the first `samples` corners.
 */
struct CellTopology
{
  CellType type;
  const char* name;   ///< singular, lower case
  const char* plural; ///< for messages
  int dimension;      ///< 2 or 3
  int nodes;
  int edges;
  int faces; ///< 0 in 2D
  /// Corners with a Jacobian. A pyramid has 4: at its apex, four edges meet, and there is none.
  int corners;
  /// Corners at which a target metric is sampled: 1 for simplices (A W^-1 is the same at each),
  /// otherwise all.
  int samples;
  std::array<std::array<int, 2>, MaxEdges> edgeNodes;
  std::array<std::array<int, 2>, MaxEdges> edgeFaces; ///< the two faces at each edge, in 3D
  std::array<int, MaxFaces> faceSizes;
  /// Nodes of each face, counterclockwise as seen from outside.
  std::array<std::array<int, MaxFaceNodes>, MaxFaces> faceNodes;
  std::array<std::array<int, 4>, MaxNodes> cornerNodes; ///< corner, then its neighbors
  /// W^-1 at each corner, row by row, 3 x 3 (2D uses the leading 2 x 2).
  std::array<std::array<double, 9>, MaxNodes> idealInverse;
  /// Area or volume of the ideal cell divided by det W: 1/2, 1, 1/6, 1, 1/2, 1/3.
  double sizePerDeterminant;
  /// Product of the lengths of W's columns over det W; scales a scaled Jacobian to 1.
  double scaledJacobianFactor;
};

/// The facts of a type; throws Error for CellType::Unsupported.
TAUTLINE_KERNEL_EXPORT const CellTopology& topology(CellType type);

/// All six, in the order triangle, quadrilateral, tetrahedron, hexahedron, wedge, pyramid.
TAUTLINE_KERNEL_EXPORT const std::array<CellTopology, NumberOfCellTypes>& topologies();

/// Position of a type in topologies(), or -1.
TAUTLINE_KERNEL_EXPORT int topologyIndex(CellType type);

/**
 * @brief The type whose corners a VTK cell has: itself for the six linear types; triangle for
 * quadratic and bi-quadratic triangles and so on (VTK lists corners first); Unsupported for
 * vertices, lines, strips, polygons, pixels, voxels, polyhedra and all other types.
 */
TAUTLINE_KERNEL_EXPORT CellType cornerType(int vtkCellType);

/// Whether a VTK type is a quadratic (or higher) one that cornerType() reduces to its corners.
TAUTLINE_KERNEL_EXPORT bool isHigherOrder(int vtkCellType);
}
#endif
