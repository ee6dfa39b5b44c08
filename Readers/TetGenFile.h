// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetGenFile.h
 * @brief The file sets of TetGen and Triangle: .node .ele .face .edge, .poly and .smesh.
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
 * @brief Reads the set that a file belongs to.
 *
 * - .node, .ele, .face, .edge: the vertices and whichever companions exist, elements first, then
 *   faces, then edges. A file that was named must be there, and so must the .node file.
 * - .poly, .smesh: the polygons (3D) or segments (2D), with the vertices of the .node file if the
 *   list in the file itself is empty.
 *
 * Vertices without any companion become vertex cells.
 * @param lowerCells false leaves .face and .edge files of a set with elements unread
 */
TAUTLINEREADERS_EXPORT MeshFile readTetGen(const std::string& name, bool lowerCells);

/**
 * @brief Writes the set of files a mesh needs, or one .poly or .smesh file when the name ends so.
 *
 * Tetrahedra (planar meshes: triangles) go to .ele, triangles beside them to .face, lines to .edge;
 * these may be quadratic. The .node file is always written; companions that the mesh does not need
 * are removed if they exist, since a reader would take them for a part of this mesh.
 * @return the names of the files written
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeTetGen(
  const MeshFile& mesh, const std::string& name);
}
#endif
