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
   * @brief LocalNewton in general. For sums of the inverse mean ratio on meshes with more than 1 %
   * of cells other than simplices, and if sweeps converge slowly (according to the ratio of their
   * gains): NewtonConjugateGradient from the start, or from its harmonic map if that is valid and
   * has a smaller objective; near the minimum, if more than 25 sweeps are expected, from the
   * current points. If that stops before the minimum, or holds points, sweeps and
   * NewtonConjugateGradient alternate: with slideSurface, or a model of the boundary, it moves
   * points on flat patches and straight curves and holds the others; with limits, only sweeps move
   * points inwards from their limit. Surface meshes in space need a model for it, and return to the
   * result of the sweeps if it exceeds the surfaceTolerance. Not used with a maximum as objective
   * or with several objectives in lexicographic order. If a sweep fails to reduce several
   * objectives, LimitedMemoryBFGS continues from there, unless points slide on the surface.
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
  /// Seconds of wall time for the whole run, including untangling; 0: no limit. Honored within two
  /// iterations.
  double maximumSeconds = 0.0;
  /// Stop when the gradient norm has decreased by this factor and, unless relativeChange is 0, the
  /// estimated remaining gain is also small; 0: never. Not used by NewtonConjugateGradient.
  double gradientNorm = 1e-6;
  /**
   * @brief Stop when the objective hardly changes anymore; 0: never. Relative to the objective: the
   * decrease of an iteration; for sweeps, also the extrapolated gain of further sweeps as a
   * geometric series; for NewtonConjugateGradient, half of the squared Newton decrement.
   */
  double relativeChange = 1e-5;
  /// "Inaccurate smoothing", section 3.4: stop when all mean qualities keep two decimals.
  bool twoDigits = false;
  /**
   * @brief Section 2.4: stop when this fraction of the possible reduction is reached (0.95 there);
   * 1: never. The possible reduction is the reduction to bestKnown, or an estimate from the
   * decreases of the iterations so far: from two if the mean inverse mean ratio is below 3, from
   * six if it is above, from three for other metrics.
   */
  double reduction = 1.0;
  /// The objective of the completely smoothed mesh; NaN: unknown. It is 0 for untangling
  /// objectives.
  double bestKnown = std::numeric_limits<double>::quiet_NaN();
  /// Stop when every element is valid.
  bool allValid = false;
};

/// Ready-made options. The numbers are stable: ParaView state files hold them.
enum class Preset : int
{
  Custom = 0,      ///< the options unchanged
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
  /// Not for optimize(): uses improveFaces() of tautline/Polyhedral/ImproveFaces.h.
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
  /// The largest 3D distance of each point from its input position; one per point (infinity = any),
  /// or null. Throws Error if the preceding untangling needs more.
  const double* limits = nullptr;
  SurfaceConstraint surface;
  /// Whether steps may invert valid elements. Off: steps are shortened.
  bool allowInversion = false;
  /**
   * @brief How to treat an input with inverted elements if no objective repairs them: untangle()
   * first (on), or throw Error (off).
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
  /// The number of steps in each patch of the local algorithms. It becomes 1 when a sweep has
  /// increased the objective.
  int patchIterations = 1;
  /**
   * @brief Over-relaxation of LocalNewton: a step is this times the Newton step, 1 to 2
   * (exclusive). Around 1.4 halves the number of sweeps.
   */
  double relaxation = 1.4;
  /**
   * @brief WorstElement: after the objective has converged, improves the worst element as long as
   * the mean of the metric of the first objective does not worsen by more than this fraction, or by
   * five times as much if another metric defines the worst element (the two disagree on stretched
   * hexahedra); 0: off.
   *
   * In planar and volume meshes on one process with more than a few cells other than simplices, and
   * with the scaled Jacobian or the inverse mean ratio as the metric of the worst element, all
   * points move together first (from the input if its elements are valid), followed by sweeps that
   * preserve this improvement. This result is used if its worst element is better, and if the mean
   * worsens relative to the input by at most this fraction and by at most the relative progress of
   * the worst element toward the ideal; the objective may then be larger than in the input, see
   * OptimizeResult::worstFirst. Boundary points stay within half of surfaceTolerance of the surface
   * on which they slide; at samples of facets and surface, the distances are limited to the
   * previous distances there and surfaceTolerance (0: a thousandth of the diagonal).
   */
  double improveWorst = 0.0;
  /**
   * @brief The metric that defines the worst element, for improveWorst and holdWorst. Not set: if
   * improveWorst is above 0, the scaled Jacobian for meshes with quadrilaterals, hexahedra or
   * wedges but no pyramids; otherwise the metric of the first objective.
   */
  std::optional<Metric> worstMetric;
  /// Whether the worst element of a valid input must not get worse. Off: individual elements may
  /// get worse for a smaller objective.
  bool holdWorst = true;
  int threads = 0; ///< 0: all cores. The result does not depend on it.
  /**
   * @brief Called after each iteration; return false to stop. Called from the calling thread. While
   * untangle() runs first, the records come from it, with 0 for the objectives, and progress stays
   * 0.
   */
  std::function<bool(const IterationState&)> observer;
};

/**
 * @brief Sets objectives, scalarization, optimizer and stopping criteria to the values of a preset;
 * other options are unchanged. For PreserveShape, set objectives[0].evaluation.targets afterwards
 * (referenceTargets()).
 */
TAUTLINE_KERNEL_EXPORT void applyPreset(Preset preset, OptimizeOptions& options);

/// The reason why options need the whole mesh on one process, if they do.
TAUTLINE_KERNEL_EXPORT NeedOfWholeMesh needOfWholeMesh(const OptimizeOptions& options);

/**
 * @brief Throws Error, with the names and a remedy, for options that need the whole mesh on one
 * process: the templates p-mean and maximum, points that slide on curved surfaces, improvement of
 * the worst element.
 */
TAUTLINE_KERNEL_EXPORT void requireLocalOptions(const OptimizeOptions& options);
}
#endif
