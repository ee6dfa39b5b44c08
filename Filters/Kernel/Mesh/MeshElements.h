// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshElements.h
 * @brief Determines which cells of a mesh are elements.
 * Internal: not installed.
 */
#ifndef tautline_MeshElements_h
#define tautline_MeshElements_h

#include "Mesh.h"

namespace tautline
{
/// Cells of the mesh dimension, which are measured and optimized.
inline bool isElement(const Mesh& mesh, CellType type)
{
  return topology(type).dimension == (mesh.dimension() == Dimension::Volume ? 3 : 2);
}
}
#endif
