// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizeOptions.h
 * @brief The options of optimize(): objectives, algorithm, constraints, stopping criteria, presets.
 */
#ifndef tautline_OptimizeOptions_h
#define tautline_OptimizeOptions_h

#include "tautline/Boundary/BoundaryConstraints.h"
#include "tautline/Core/Iteration.h"
#include "tautline/Objectives/Objective.h"
#include "tautline/Objectives/Scalarization.h"

#include <limits>
#include <optional>
#include <string>

namespace tautline
{
/// The algorithms. The numbers are stable: ParaView state files hold them.
enum class Optimizer : int
{
  /**
   * @brief LocalNewton. Sums of the inverse mean ratio on meshes with more than 1 % of other cells
   * than simplices, and where its sweeps converge slowly (by the ratio of their gains):
   * NewtonConjugateGradient from the start, or from its harmonic map if valid and the objective
   * smaller there; near the minimum, where more than 25 sweeps are to be expected, from where they
   * are. Where that stops short of the minimum, or holds points, sweeps and NewtonConjugateGradient
   * in turn: with slideSurface, or a model of the boundary, it moves points on flat patches and
   * straight curves and holds the others; with limits, only sweeps move points inwards from their
   * limit. Meshes of surfaces in space need a model for it, and go back to where sweeps led if it
   * leaves the surfaceTolerance. Not with a maximum as objective, nor several in lexicographic
   * order. Should a sweep fail to reduce several objectives, LimitedMemoryBFGS from there, unless
   * points slide on the surface.
   */
  Automatic = 0,
  LocalNewton = 1,            ///< sweeps over one-vertex patches, a damped Newton step in each
  LocalConjugateGradient = 2, ///< sweeps over one-vertex patches, Polak-Ribiere+ steps in each
  ConjugateGradientFletcherReeves = 3, ///< all vertices at once
  ConjugateGradientPolakRibiere = 4,   ///< all vertices at once
  LimitedMemoryBFGS = 5,               ///< all vertices at once
  NewtonConjugateGradient = 6          ///< all vertices at once; truncated Newton
};

/// Whether an optimizer always moves one vertex at a time. Throws Error for an unknown number.
TAUTLINE_KERNEL_EXPORT bool isLocal(Optimizer optimizer);

/// Whether an optimizer always moves all vertices at once; Automatic is neither local nor global.
/// Throws Error for an unknown number.
TAUTLINE_KERNEL_EXPORT bool isGlobal(Optimizer optimizer);

struct StoppingCriteria
{
  /// Sweeps of the local algorithms, iterations of the others; at least 0.
  int maximumIterations = 300;
  /// Seconds of wall time for the whole run, untangling included; 0: no limit. Honoured within two
  /// iterations.
  double maximumSeconds = 0.0;
  /// Stop when the gradient's norm has fallen by this factor and, unless relativeChange is 0, an
  /// estimate of what is left to gain is small, too; 0: never. Not used by NewtonConjugateGradient.
  double gradientNorm = 1e-6;
  /**
   * @brief Stop when the objective hardly changes any more; 0: never. Relative to it: the decrease
   * of an iteration; of sweeps also what further ones would gain if their gains went on as a
   * geometric series; of NewtonConjugateGradient half of the squared Newton decrement.
   */
  double relativeChange = 1e-5;
  /// "Inaccurate smoothing", section 3.4: stop when all mean qualities keep two decimals.
  bool twoDigits = false;
  /**
   * @brief Section 2.4: stop when this fraction of the possible reduction is reached (0.95 there);
   * 1: never. The possible reduction is that to bestKnown, or an estimate from the decreases of
   * the iterations so far: of two where the mean of the inverse mean ratio is below 3, of six where
   * it is above, of three of other metrics.
   */
  double reduction = 1.0;
  /// The objective of the completely smoothed mesh; NaN: not known. 0 is that of untangling
  /// objectives.
  double bestKnown = std::numeric_limits<double>::quiet_NaN();
  /// Stop when every element is valid.
  bool allValid = false;
};

/// Ready-made options. The numbers are stable: ParaView state files hold them.
enum class Preset : int
{
  Custom = 0,      ///< the options as they are
  FastCleanUp = 1, ///< sum of squared IMR, a few sweeps: 95 % of the possible reduction
  BestShape = 2,   ///< sum of squared IMR to convergence
  /// Shape (IMR) and size at once, by the objective product; not for a boundary that moves freely.
  UniformSize = 3,
  LowInterpolationError =
    4, ///< shape (IMR) and SS of section 3.2.1 at once, by the objective product
  UntangleThenImprove = 5, ///< untangle(), then BestShape
  PreserveShape = 6, ///< sum of squared IMR against the elements of a reference mesh (targets)
  WorstElement =
    7, ///< BestShape, then the worst element; the mean hardly worsens (improveWorst 0.01)
  /// Not of optimize(): improveFaces() of tautline/Polyhedral/ImproveFaces.h.
  FiniteVolumes = 8
};

/// Points that slide on the surface, or on a model, need a local optimizer.
struct OptimizeOptions : BoundaryConstraints
{
  /// At least one.
  std::vector<Objective> objectives = std::vector<Objective>(1);
  ScalarizationOptions scalarization;
  Optimizer optimizer = Optimizer::Automatic;
  StoppingCriteria stopping;
  /// How far each point may go from where it is in the input, 3D distance; one per point (infinity
  /// = any), or null. An Error where untangling, which comes first, needs more.
  const double* limits = nullptr;
  SurfaceConstraint surface;
  /// Lets steps invert elements that are valid. Off: they are shortened.
  bool allowInversion = false;
  /**
   * @brief What to do with an input that has inverted elements and objectives none of which repairs
   * them: untangle() first (on), or throw Error (off).
   */
  bool untangleFirst = true;
  /**
   * @brief Section 3.3.3: multiplies the untangling objectives by a constant that makes their
   * largest element value exceed the largest of the other objectives at the start.
   */
  bool rescaleUntangling = true;
  /// Local algorithms: leave out vertices that moved less than this times their shortest edge; 0:
  /// none.
  double culling = 1e-3;
  /// Steps in each patch of the local algorithms. It becomes 1 when a sweep
  /// has raised the objective.
  int patchIterations = 1;
  /**
   * @brief Over-relaxation of LocalNewton: a step is this times Newton's, 1 to 2 (exclusive).
   * Around 1.4 halves the number of sweeps.
   */
  double relaxation = 1.4;
  /**
   * @brief WorstElement: after the objective has converged, improves the worst element as long as
   * the mean of the first objective's metric does not get worse by more than this fraction of it,
   * or by five times as much where another metric judges the worst element (the two disagree on
   * stretched hexahedra); 0: off.
   *
   * In planar and volume meshes of one process that have more than a few other cells than
   * simplices, judged by the scaled Jacobian of corners or the inverse mean ratio, all points move
   * together first, from the input on if its elements are valid, and sweeps that hold what was
   * reached follow. This is the result if its worst element is better, and if the mean is worse
   * than in the input by at most that fraction and the fraction of the way to the ideal that the
   * worst element has gone; the objective may then be larger than in the input, see
   * OptimizeResult::worstFirst. Points of the boundary stay within half of surfaceTolerance of what
   * they slide on; at places on facets and surface the distances are at most what they were about
   * there, and surfaceTolerance (0: a thousandth of the diagonal).
   */
  double improveWorst = 0.0;
  /**
   * @brief The metric that tells which element is the worst one, for improveWorst and for what may
   * not get worse. Not set: where improveWorst is above 0 the scaled Jacobian for meshes with
   * quadrilaterals, hexahedra or wedges, but no pyramids; else the metric of the first objective.
   */
  std::optional<Metric> worstMetric;
  /// Whether the worst element of a valid input must not get worse. Off: a smaller objective may
  /// cost single elements.
  bool holdWorst = true;
  int threads = 0; ///< 0: all cores. The result does not depend on it.
  /**
   * @brief Called after each iteration; return false to stop. Called from the calling thread. While
   * untangle() runs first, the records are its own, with 0 for what belongs to the objectives, and
   * progress stays 0.
   */
  std::function<bool(const IterationState&)> observer;
};

/**
 * @brief Sets objectives, scalarization, optimizer and stopping criteria to those of a preset; the
 * rest stays. For PreserveShape, set objectives[0].evaluation.targets afterwards
 * (referenceTargets()).
 */
TAUTLINE_KERNEL_EXPORT void applyPreset(Preset preset, OptimizeOptions& options);

/// Why options need the whole mesh in one place, if they do.
TAUTLINE_KERNEL_EXPORT NeedOfWholeMesh needOfWholeMesh(const OptimizeOptions& options);

/**
 * @brief Throws Error for options that need the whole mesh in one place, by name and with the
 * remedy: the templates p-mean and maximum, points that slide on curved surfaces, improvement
 * of the worst element.
 */
TAUTLINE_KERNEL_EXPORT void requireLocalOptions(const OptimizeOptions& options);
}
#endif
