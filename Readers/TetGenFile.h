// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetGenFile.h
 * @brief Reads and writes the file sets of TetGen and Triangle: .node .ele .face .edge, .poly and
 * .smesh.
 *
 * 2D files (Triangle) and 3D files (TetGen) have the same names; the header of the vertices
 * distinguishes them. Vertices are numbered from 0 or 1. The array names are listed in MeshFile.h.
 */
#ifndef tautline_TetGenFile_h
#define tautline_TetGenFile_h

#include "MeshFile.h"

namespace tautline
{
/**
 * @brief Reads the set of a file.
 *
 * - .node, .ele, .face, .edge: the vertices and all existing companions: elements first, then
 *   faces, then edges. The named file and the .node file must exist.
 * - .poly, .smesh: the polygons (3D) or segments (2D), with the vertices of the .node file if the
 *   list in the file itself is empty.
 *
 * Vertices without a companion file become vertex cells.
 * @param lowerCells if false, .face and .edge files of a set with elements are not read
 */
TAUTLINEREADERS_EXPORT MeshFile readTetGen(const std::string& name, bool lowerCells);

/**
 * @brief Writes the set of files needed for a mesh, or one .poly or .smesh file if the name has
 * this extension.
 *
 * Tetrahedra (planar meshes: triangles) go to .ele, triangles beside them to .face, lines to .edge;
 * these may be quadratic. The .node file is always written; existing companions that the mesh does
 * not need are removed, because a reader would treat them as part of this mesh.
 * @return the names of the files written
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeTetGen(
  const MeshFile& mesh, const std::string& name);
}
#endif
