// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImproveFaces.h
 * @brief Moves points so that a finite-volume mesh passes the checks of OpenFOAM's checkMesh.
 *
 * Only points near faces beyond the targets move. If cells are inverted, untangle() is called
 * first, on tetrahedra of the cell centers and fans of their faces or, for one layer, on its
 * polygons. Then the energy of FaceEnergy.h is minimized by L-BFGS, in rounds; near faces that
 * would fail a check, points move only part of the way or not at all. The boundary moves according
 * to BoundaryConstraints. Points of coupled patches, and points where three patches or two coplanar
 * patches meet, are fixed, as are points of "empty" patches, unless these are the sides of one
 * layer of cells, whose points move together.
 *
 * The result is never worse: no check that can fail has more offending faces or cells than in the
 * input, nor a worse value beyond its limit. The concavity of cells and the checks that only warn
 * (short edges, concave and warped faces) are guarded in the same way if nothing offends in the
 * input: for coplanar faces, concavity depends on rounding.
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
  /// The targets: the maximum non-orthogonality, in degrees, and skewness of faces.
  double angle = 65, skewness = 3.5;
  /// Whether only the faces of invalid cells are deficient, and other checks may get worse.
  bool untangleOnly = false;
  /// whether the points of patches, except "empty" ones of a layer, are fixed
  bool patchesStay = false;
  int rounds = 40;           ///< at most
  int iterations = 40;       ///< of L-BFGS in a round, at most
  double maximumSeconds = 0; ///< of wall time; 0: no limit
  FaceConvention convention = FaceConvention::Esi;
  MeshCheckFacts facts;
  int threads = 0;
  /// Called after each round with a lower bound of the fraction done; false ends the improvement.
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
 * @param solid a volume mesh whose first points are the points of `mesh`, with the same boundary:
 * tetrahedra of its cells, for the constraints
 * @param constraints for the points of `solid`; constraints beyond the points of `mesh` are ignored
 */
TAUTLINE_KERNEL_EXPORT ImproveFacesResult improveFaces(const FaceMesh& mesh, const double* points,
  const Mesh& solid, const BoundaryConstraints& constraints, const ImproveFacesOptions& options);
}
#endif
