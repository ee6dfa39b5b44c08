// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImproveFaces.h
 * @brief Moves points so that a mesh of finite volumes passes the checks of OpenFOAM's checkMesh.
 *
 * Only points near faces that are beyond the targets move. Where cells are inverted, untangle()
 * comes first, on tetrahedra of the centers of cells and fans of their faces, or, of one layer, on
 * its polygons. Then the points minimize the energy of FaceEnergy.h by L-BFGS, in rounds; near
 * faces that would be worse in a check, they go a part of the way, or stay. What the boundary may
 * do is that of BoundaryConstraints. Points of coupled patches, and where three patches meet or two
 * in one plane, stay; so do those of "empty" patches, unless these are the sides of one layer of
 * cells, whose points move together.
 *
 * The result is never worse: no check that can fail has more offending faces or cells than in the
 * input, nor a worse value beyond its limit. The concavity of cells and the checks that only warn
 * (short edges, concave and warped faces) count like this where nothing offends in the input: of
 * faces in one plane, concavity is a matter of rounding.
 */
#ifndef tautline_ImproveFaces_h
#define tautline_ImproveFaces_h

#include "tautline/Boundary/BoundaryConstraints.h"
#include "tautline/Core/Iteration.h"
#include "tautline/FiniteVolume/MeshChecks.h"

#include <functional>

namespace tautline
{
struct ImproveFacesOptions
{
  /// Faces are to have at most this non-orthogonality, degrees, and this skewness.
  double angle = 65, skewness = 3.5;
  /// The faces of cells that are not valid alone are wanting, and other checks may become worse.
  bool untangleOnly = false;
  bool patchesStay = false;  ///< the points of patches, but for "empty" ones of a layer, stay
  int rounds = 40;           ///< at most
  int iterations = 40;       ///< of L-BFGS in a round, at most
  double maximumSeconds = 0; ///< of wall time; 0: no limit
  FaceConvention convention = FaceConvention::Esi;
  MeshCheckFacts facts;
  int threads = 0;
  /// After each round, with the fraction of the way that is certainly done; false ends it.
  std::function<bool(int round, double fraction)> proceed;
};

struct ImproveFacesResult
{
  std::vector<double> points; ///< 3 per point of the mesh
  MeshCheckReport before, after;
  Index wantingBefore = 0, wantingAfter = 0; ///< faces beyond a target, or of an inverted cell
  Index freePoints = 0;                      ///< points that could move
  int rounds = 0, iterations = 0;
  StopReason reason = StopReason::NoProgress;
};

/**
 * @brief Improves a mesh.
 * @param points 3 coordinates per point of the mesh
 * @param solid a mesh of volumes whose first points are those of `mesh`, with the same boundary:
 * tetrahedra of its cells, for the constraints
 * @param constraints of the points of `solid`; those beyond the points of `mesh` do not count
 */
TAUTLINE_KERNEL_EXPORT ImproveFacesResult improveFaces(const FaceMesh& mesh, const double* points,
  const Mesh& solid, const BoundaryConstraints& constraints, const ImproveFacesOptions& options);
}
#endif
