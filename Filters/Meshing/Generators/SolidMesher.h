// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SolidMesher.h
 * @brief Quality tetrahedralization of a region with TetGen (AGPL), which the program
 * tautline-mesher links; this library and its users do not.
 *
 * Whatever TetGen does there (throw, crash, exit, loop) comes out as an Error here, or can be
 * stopped. For surfaces that intersect themselves the Error names the facets. The result depends on
 * nothing but the input.
 */
#ifndef tautline_SolidMesher_h
#define tautline_SolidMesher_h

#include "MeshGeneratorsExport.h"

#include "tautline/Domains/Domains.h"

#include <functional>
#include <vector>

namespace tautline
{
/// Requirements on the tetrahedra.
struct SolidOptions
{
  /// Largest ratio of circumradius and shortest edge; 0 for no bound. above 1.
  double radiusEdgeRatio = 1.4;
  /// Smallest dihedral angle aimed at, degrees.
  double minimumDihedralAngle = 10.0;
  /// Largest volume; 0 for no bound.
  double volume = 0.0;
  /// Target edge length at each point of the boundary; empty for none.
  std::vector<double> pointSizes;
  /// The facets of the boundary are kept as they are: no point is added to them.
  bool preserveSurface = false;
  /// Regions: x y z, reference, largest volume (negative for none) each.
  std::vector<double> regions;
  /// Seconds TetGen may take; 0: no limit (on some inputs it does not terminate).
  double timeLimit = 0.0;
  /// Called some times a second; returning false stops with an Error.
  std::function<bool()> progress;
};

struct SolidMesh
{
  std::vector<double> points; ///< x y z each; those of the boundary come first
  std::vector<Index> tetrahedra;
  std::vector<int> references;   ///< of the region of each tetrahedron; 0 without regions
  std::vector<int> pointMarkers; ///< lowest marker of a point's facets, 0 inside
  std::vector<Index> faces;      ///< three points each: the facets, subdivided
  std::vector<int> faceMarkers;
};

/// Runs the program tautline-mesher. Throws Error; where the program is missing, it names the
/// package that has it.
TAUTLINE_MESH_GENERATORS_EXPORT SolidMesh meshSolid(
  const SolidBoundary& boundary, const SolidOptions& options);
}
#endif
