// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionInput.h
 * @brief Checks and converts the input of reconnection.
 * Internal: not installed.
 */
#ifndef tautline_ReconnectionInput_h
#define tautline_ReconnectionInput_h

#include "ReconnectionOptions.h"
#include "TetrahedronMesh.h"
#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/// The arrays of a TetrahedronMesh, in its units: coordinates times a power of two, so that the
/// largest is about 1 and products of lengths neither overflow nor underflow.
struct ReconnectionInput
{
  std::vector<Vec3> points;
  std::vector<TetVertices> cells;    ///< positive, even for a mirrored mesh
  std::vector<std::int32_t> regions; ///< renumbered from 0, or OutsideRegion; empty: one region
  int exponent = 0;                  ///< point = input point times 2^-exponent
};

/// Renumbers the regions from 0 in increasing order; empty for null.
std::vector<std::int32_t> renumberRegions(const Index* regions, Index count);

/// The quality below which tetrahedra are below the target.
double targetQuality(const ReconnectionOptions& options);

/// Throws Error for options out of range.
void checkReconnectionOptions(const ReconnectionOptions& options);

/// Converts the input. Throws Error for cells and points that reconnection does not support.
ReconnectionInput convertInput(const Mesh& mesh, const ReconnectionOptions& options);

/// Throws Error for faces of three tetrahedra, or of two on the same side.
void checkFaces(const TetrahedronMesh& mesh, int threads);
}
#endif
