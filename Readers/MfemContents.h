// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MfemContents.h
 * @brief The contents of an MFEM file before nodes are evaluated, and the shapes of its elements.
 *
 * Internal: not installed.
 */
#ifndef tautline_MfemContents_h
#define tautline_MfemContents_h

#include "MfemNumbering.h"
#include "MfemSpace.h"
#include "TextCursor.h"

#include <optional>
#include <utility>

namespace tautline
{
/// The numbers of shapes in the files.
enum MfemGeometry : int
{
  MfemPoint = 0,
  MfemSegment,
  MfemTriangle,
  MfemSquare,
  MfemTetrahedron,
  MfemCube,
  MfemPrism,
  MfemPyramid
};
constexpr int MfemShapes = 8;

/// The elements of a file, and its vertices or nodes.
struct MfemMesh
{
  int dimension = 0;
  int spaceDimension = 0;
  MfemElements elements;
  MfemElements boundary;
  Index vertices = 0;
  std::vector<double> coordinates; ///< spaceDimension per vertex, or per value of the space
};

struct MfemContents
{
  MfemMesh mesh;
  bool curved = false; ///< whether it has nodes
  MfemSpace space;
  bool byNodes = false; ///< whether all first coordinates come first (Ordering: 0)
  /// For each coordinate of a node, in the order of MfemMesh::coordinates: the start and end of its
  /// text, in bytes.
  std::vector<std::pair<std::size_t, std::size_t>> texts;
  std::vector<std::string> warnings;
  /// The numbering of the nodes, or of the vertices of a straight mesh.
  std::optional<MfemNumbering> numbering;

  MfemContents() = default;
  MfemContents(const MfemContents&) = delete; ///< numbering refers to the mesh
  void operator=(const MfemContents&) = delete;
};

/**
 * @brief Reads all sections of a file. Throws FileError.
 * @param start of the file, the origin of MfemContents::texts; if null, these stay empty
 */
void readMfemContents(TextCursor& cursor, const char* start, MfemContents& contents);

/// VTK's cell for a shape, with all nodes of an order.
unsigned char mfemCellType(int geometry, int order);

/// The shape of a cell, by the number in MFEM's files; -1 for a cell that MFEM does not have.
int mfemGeometry(unsigned char type);

/// The number of values of the space on the elements, separate or shared by neighbors.
Index countMfemValues(const MfemMesh& mesh, const MfemSpace& space, const MfemNumbering& numbering);
}
#endif
