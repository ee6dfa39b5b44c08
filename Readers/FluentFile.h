// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FluentFile.h
 * @brief The mesh in a case or mesh file of ANSYS Fluent (.cas, .msh): text or binary sections.
 *
 * Files of the Common Fluids Format (.cas.h5) are not read.
 */
#ifndef tautline_FluentFile_h
#define tautline_FluentFile_h

#include "FoamMesh.h"

namespace tautline
{
struct FluentMesh
{
  /// Internal faces in upper triangular order, then the zones of the boundary in the order of the
  /// file. In two dimensions faces have two points, and z is 0; the owner is on their left.
  FoamMesh mesh;
  int dimension = 3;
  std::vector<std::string> warnings;
};

/// Whether a file begins as a section does: with a parenthesis and a number.
TAUTLINEREADERS_EXPORT bool isFluentFile(const std::string& name);

/**
 * @brief Reads the nodes, faces and zones of a file; its other sections are passed over.
 *
 * Types of patches are those of Fluent ("velocity-inlet"), but "cyclic" for pairs of periodic zones
 * whose faces the file lists: the faces of both correspond by their order.
 *
 * Throws FileError with the line (in a file with binary sections, the byte) for what is truncated
 * or inconsistent, and for what needs a conversion in Fluent: hanging nodes of adapted meshes,
 * intersected mesh interfaces, meshes of a surface only.
 */
TAUTLINEREADERS_EXPORT FluentMesh readFluent(const std::string& name);

/// Cells as cellsOf() finds them; in two dimensions triangles, quadrilaterals and polygons. Throws
/// FoamDefect.
TAUTLINEREADERS_EXPORT FoamCells fluentCells(const FoamMesh& mesh, int dimension);
}
#endif
