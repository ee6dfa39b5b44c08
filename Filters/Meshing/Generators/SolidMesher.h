// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SolidMesher.h
 * @brief Quality tetrahedralization of a region with TetGen (AGPL), which is linked by the program
 * tautline-mesher, not by this library and its users.
 *
 * Any failure of TetGen there (exception, crash, exit, infinite loop) becomes an Error here or can
 * be stopped. For self-intersecting surfaces the Error names the facets. The result depends only on
 * the input.
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
  /// Largest ratio of circumradius to shortest edge, above 1; 0 for no bound.
  double radiusEdgeRatio = 1.4;
  /// Target for the smallest dihedral angle, in degrees.
  double minimumDihedralAngle = 10.0;
  /// Largest volume; 0 for no bound.
  double volume = 0.0;
  /// Target edge length at each point of the boundary; empty for none.
  std::vector<double> pointSizes;
  /// Whether the facets of the boundary are preserved: no point is added to them.
  bool preserveSurface = false;
  /// Regions: x y z, reference, largest volume (negative for none) each.
  std::vector<double> regions;
  /// Time limit of TetGen in seconds; 0 for no limit (on some inputs it does not terminate).
  double timeLimit = 0.0;
  /// Called several times a second; returning false stops with an Error.
  std::function<bool()> progress;
};

struct SolidMesh
{
  std::vector<double> points; ///< x y z each; boundary points come first
  std::vector<Index> tetrahedra;
  std::vector<int> references;   ///< region reference of each tetrahedron; 0 without regions
  std::vector<int> pointMarkers; ///< lowest marker of a point's facets, 0 inside
  std::vector<Index> faces;      ///< three points each: the facets, subdivided
  std::vector<int> faceMarkers;
};

/// Runs the program tautline-mesher. Throws Error on failure and, with the name of its package, if
/// the program is missing.
TAUTLINE_MESH_GENERATORS_EXPORT SolidMesh meshSolid(
  const SolidBoundary& boundary, const SolidOptions& options);
}
#endif
