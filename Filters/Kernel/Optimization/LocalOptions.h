// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalOptions.h
 * @brief The terms and the options of the local sweeps.
 * Internal: not installed.
 */
#ifndef tautline_LocalOptions_h
#define tautline_LocalOptions_h

#include "OptimizeOptions.h"
#include "SurfaceLimit.h"
#include "tautline/Objectives/ObjectiveSum.h"

namespace tautline
{
/// One of the objectives in the form used by the sweeps: the one that is set.
struct LocalTerm
{
  /// The power (1 or 2) of an inverse mean ratio; 0: see metric.
  int shapePower = 0;
  /// Above 0: the squared inverse mean ratio with emphasis on values near this, see
  /// WorstRatioEnergy.
  double worst = 0;
  /// The squared size times this; 0: see metric.
  double sizeSquared = 0;
  /// Above 0: a user metric that only depends on |T|^2 and det T, where T is T of the simplices
  /// times this; also sets metric. See InvariantFunction.
  double invariantScale = 0;
  const ObjectiveSum* metric = nullptr;

  /// Whether the simplices suffice to evaluate the term.
  bool ofSimplices() const
  {
    return this->shapePower > 0 || this->sizeSquared > 0 || this->invariantScale > 0;
  }
};

/// Points farther from their start than this times their limit are at the limit, up to rounding.
constexpr double insideLimit = 1 - 1e-9;

struct LocalOptions
{
  bool newton = true; ///< or Polak-Ribiere+ conjugate gradients
  int patchIterations = 1;
  double relaxation = 1.0;
  double culling = 0.0;
  bool allowInversion = false;
  int threads = 0;
  /// Per vertex of the simplex mesh, or empty: a direction (line or plane normal) or zero.
  std::vector<Vec3> planes, lines;
  /// Per vertex: the start and the largest allowed distance from it, in the coordinates of the
  /// simplex mesh; or empty.
  std::vector<double> limits, start;
  /// Per vertex, or empty: the surface on which it slides, or null.
  std::vector<const SurfaceProjection*> surfaces;
  /// Per vertex, or empty: whether it is on the surface but only constrained by surfaceLimits.
  std::vector<unsigned char> loose;
  /// The limits on the motion of the surface and the interfaces; all must allow a step.
  std::vector<SurfaceLimit*> surfaceLimits;
  /// Per simplex, or empty; for the fast terms. Needs SimplexMesh::indexPatches().
  std::vector<double> weights;
};
}
#endif
