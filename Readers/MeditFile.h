// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeditFile.h
 * @brief Reads and writes Medit's .mesh (text), .meshb (binary, versions 1 to 4, both byte orders)
 * and .sol files.
 *
 * The supported sections are Vertices, Corners, RequiredVertices, Edges, Triangles, Quadrilaterals,
 * Tetrahedra, Hexahedra, Prisms, Pyramids, Ridges, RequiredEdges and RequiredTriangles; other
 * sections are skipped, with a warning if they have cells. A file without the keyword End is read,
 * with a warning, if its last section is as long as its count; a truncated section is an error.
 *
 * Cells are ordered by type: tetrahedra, hexahedra, wedges, pyramids, triangles, quadrilaterals,
 * lines. The array names are listed in MeshFile.h; `Reference` is always there.
 *
 * A .sol file adds an array for each of its fields: scalars, vectors (3 components) and symmetric
 * tensors, which become full 3 x 3 matrices, row by row (9 components).
 */
#ifndef tautline_MeditFile_h
#define tautline_MeditFile_h

#include "MeshFile.h"

namespace tautline
{
class FileContent;

/**
 * @brief Reads a .mesh or .meshb with its .sol companion, or a .sol with its .mesh or otherwise its
 * .meshb.
 *
 * A .sol beside both a .mesh and a .meshb belongs to the .mesh.
 */
TAUTLINEREADERS_EXPORT MeshFile readMedit(const std::string& name, bool lowerCells);

/**
 * @brief Writes a .meshb, or a .mesh and, if there are arrays that a .mesh cannot hold, the .sol
 * beside it.
 *
 * An existing .sol is removed if the mesh needs none. Symmetric 3 x 3 matrices are written as
 * tensors, triples as vectors, other tuples component by component. A .meshb is written without a
 * .sol, in version 2, or in version 3 or 4 if the file or its numbers are too large; see
 * meditArraysLeftOut().
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeMedit(
  const MeshFile& mesh, const std::string& name);

/// Whether a file begins like a .meshb, in either byte order.
TAUTLINEREADERS_EXPORT bool isMeditBinary(const std::string& name);

/// The names of the arrays that a .meshb cannot hold, separated by commas.
TAUTLINEREADERS_EXPORT std::string meditArraysLeftOut(const MeshFile& mesh);

/// Cell types in the order of Medit's sections, with the section's name and its code in binary
/// files.
struct MeditSection
{
  const char* name;
  unsigned char type;
  int code;
};
constexpr MeditSection MeditSections[] = { { "Tetrahedra", FileTetrahedron, 8 },
  { "Hexahedra", FileHexahedron, 10 }, { "Prisms", FileWedge, 9 }, { "Pyramids", FilePyramid, 49 },
  { "Triangles", FileTriangle, 6 }, { "Quadrilaterals", FileQuadrilateral, 7 },
  { "Edges", FileLine, 5 } };

/// Sections with numbers of points or cells, with their codes.
struct MeditList
{
  const char* name;
  int code;
};
constexpr MeditList MeditLists[] = { { "Corners", 13 }, { "RequiredVertices", 15 },
  { "Ridges", 14 }, { "RequiredEdges", 16 }, { "RequiredTriangles", 17 } };

/// Codes of the other sections of binary files.
enum MeditCode
{
  MeditDimension = 3,
  MeditVertices = 4,
  MeditEnd = 54
};

/// Adds the fields of a .sol file to its mesh.
void readMeditSolution(const FileContent& file, MeshFile& mesh);
}
#endif
