// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FluentFile.h
 * @brief Reads the mesh in a case or mesh file of ANSYS Fluent (.cas, .msh), with text or binary
 * sections.
 *
 * Files in the Common Fluids Format (.cas.h5) are not supported.
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

/// Whether a file begins like a section, with a parenthesis and a number.
TAUTLINEREADERS_EXPORT bool isFluentFile(const std::string& name);

/**
 * @brief Reads the nodes, faces and zones of a file; other sections are skipped.
 *
 * Patch types are as in Fluent ("velocity-inlet"), except "cyclic" for pairs of periodic zones
 * whose faces the file lists: the faces of both correspond by their order.
 *
 * Throws FileError with the line (in a file with binary sections, the byte) for truncated or
 * inconsistent data, and for meshes that need a conversion in Fluent: hanging nodes of adapted
 * meshes, intersected mesh interfaces, surface-only meshes.
 */
TAUTLINEREADERS_EXPORT FluentMesh readFluent(const std::string& name);

/// The cells as from cellsOf(); in two dimensions, triangles, quadrilaterals and polygons. Throws
/// FoamDefect.
TAUTLINEREADERS_EXPORT FoamCells fluentCells(const FoamMesh& mesh, int dimension);
}
#endif
