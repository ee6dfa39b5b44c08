// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeditFile.h
 * @brief Medit's ASCII .mesh (versions 1 and 2) and .sol files.
 *
 * Read are Vertices, Corners, RequiredVertices, Edges, Triangles, Quadrilaterals, Tetrahedra,
 * Hexahedra, Prisms, Pyramids, Ridges, RequiredEdges and RequiredTriangles; other sections are
 * skipped. Cells are ordered by type: tetrahedra, hexahedra, wedges, pyramids, triangles,
 * quadrilaterals, lines. The array names are listed in MeshFile.h; `Reference` is always there.
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

/// Reads a .mesh with its .sol companion, or a .sol with its .mesh.
TAUTLINEREADERS_EXPORT MeshFile readMedit(const std::string& name, bool lowerCells);

/**
 * @brief Writes a .mesh and, when there are arrays a .mesh cannot hold, the .sol beside it.
 *
 * A .sol from before is removed when the mesh needs none. Symmetric 3 x 3 matrices are written as
 * tensors, triples as vectors, other tuples component by component.
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeMedit(
  const MeshFile& mesh, const std::string& name);

/// Cells in the order of Medit's sections, with the section's name.
struct MeditSection
{
  const char* name;
  unsigned char type;
};
constexpr MeditSection MeditSections[] = { { "Tetrahedra", FileTetrahedron },
  { "Hexahedra", FileHexahedron }, { "Prisms", FileWedge }, { "Pyramids", FilePyramid },
  { "Triangles", FileTriangle }, { "Quadrilaterals", FileQuadrilateral }, { "Edges", FileLine } };

/// Adds the fields of a .sol file to the mesh they belong to.
void readMeditSolution(const FileContent& file, MeshFile& mesh);
}
#endif
