/**
 * @file Optimize.h
 * @brief Moves the free vertices of a mesh so that one or several objectives become smaller.
 *
 * Example: the best shape of every element, boundary fixed.
 *
 *     tautline::Mesh mesh(view);
 *     tautline::OptimizeOptions options; // sum of squared inverse mean ratios
 *     tautline::Optimization result = tautline::optimize(mesh, options);
 *     // result.points has the new coordinates; result.reason says why it stopped.
 */
#ifndef tautline_Optimize_h
#define tautline_Optimize_h

#include "Objective.h"
#include "Scalarization.h"

#include <functional>
#include <limits>

namespace tautline
{
/// The algorithms. The numbers are stable: ParaView state files hold them.
enum class Optimizer : int
{
  /// LocalNewton; should a sweep fail to lower several objectives, LimitedMemoryBFGS from there
  Automatic = 0,
  LocalNewton = 1,            ///< sweeps over one-vertex patches, a damped Newton step in each
  LocalConjugateGradient = 2, ///< sweeps over one-vertex patches, Polak-Ribiere+ steps in each
  ConjugateGradientFletcherReeves = 3, ///< all vertices at once
  ConjugateGradientPolakRibiere = 4,   ///< all vertices at once
  LimitedMemoryBFGS = 5,               ///< all vertices at once
  NewtonConjugateGradient = 6          ///< all vertices at once; truncated Newton
};

/// Why an optimization ended.
enum class StopReason : int
{
  GradientNorm = 0,   ///< the gradient is small enough
  RelativeChange = 1, ///< the objective hardly changes any more
  TwoDigits = 2,      ///< mean qualities agree with the previous iteration's to two decimals
  Reduction = 3,      ///< the wanted fraction of the possible reduction is reached
  AllValid = 4,       ///< no element is inverted or degenerate
  IterationLimit = 5,
  TimeLimit = 6,
  Aborted = 7,
  NoProgress = 8,    ///< no step lowers the objective
  NoFreeVertices = 9 ///< every vertex is fixed or outside all cells
};

/// A sentence for the user.
TAUTLINE_KERNEL_EXPORT const char* describe(StopReason reason);

struct StoppingCriteria
{
  /// Sweeps of the local algorithms, iterations of the others; at least 0.
  int maximumIterations = 100;
  /// Seconds of wall time; 0: no limit. Honoured within two iterations.
  double maximumSeconds = 0.0;
  /// Stop when the gradient's norm has fallen by this factor; 0: never.
  double gradientNorm = 1e-6;
  /// Stop when an iteration lowers the objective by less than this, relative to it; 0: never.
  double relativeChange = 1e-5;
  /// "Inaccurate smoothing", section 3.4: stop when all mean qualities keep two decimals.
  bool twoDigits = false;
  /**
   * @brief Section 2.4: stop when this fraction of the possible reduction is reached (0.95 there); 1: never. The
   * possible reduction is that to bestKnown, or an estimate from the decrease of the iterations so far.
   */
  double reduction = 1.0;
  /// The objective of the completely smoothed mesh, if known.
  double bestKnown = std::numeric_limits<double>::quiet_NaN();
  /// Stop when every element is valid.
  bool allValid = false;
};

/// One line of the history; iteration 0 is the input.
struct IterationRecord
{
  int iteration = 0;
  double seconds = 0;              ///< wall time since the start
  double objective = 0;            ///< the scalarized objective
  std::vector<double> objectives;  ///< each F_i
  std::vector<double> mean, worst; ///< of each objective's metric over the valid elements
  Index inverted = 0;              ///< inverted or degenerate elements
  double gradientNorm = 0; ///< of the scalarized objective over free vertices; 0 if not known
  Index moving = 0;        ///< vertices that still move (local algorithms with culling)
};

/// What an observer is told after each iteration.
struct IterationState
{
  const IterationRecord& record;
  double progress; ///< 0 to 1, of the iteration or time limit, whichever is closer
  /// Writes 3 x numberOfPoints coordinates in the order of the mesh.
  std::function<void(double*)> points;
};

/// A surface the vertices of a surface mesh stay on.
struct SurfaceConstraint
{
  bool project = true; ///< project moved vertices back to the input surface
};

/// Ready-made options. The numbers are stable: ParaView state files hold them.
enum class Preset : int
{
  Custom = 0,      ///< the options as they are
  FastCleanUp = 1, ///< sum of squared IMR, a few sweeps: 95 % of the possible reduction
  BestShape = 2,   ///< sum of squared IMR to convergence
  UniformSize = 3, ///< shape (IMR) and size at once, by the objective product
  LowInterpolationError =
    4, ///< shape (IMR) and SS of section 3.2.1 at once, by the objective product
  UntangleThenImprove = 5, ///< untangle(), then BestShape
  PreserveShape = 6, ///< sum of squared IMR against the elements of a reference mesh (targets)
  WorstElement = 7   ///< BestShape, then the worst IMR without giving up the mean
};

struct OptimizeOptions
{
  /// At least one.
  std::vector<Objective> objectives = std::vector<Objective>(1);
  ScalarizationOptions scalarization;
  Optimizer optimizer = Optimizer::Automatic;
  StoppingCriteria stopping;
  /// One flag per point, nonzero = fixed; null: the points of the boundary.
  const unsigned char* fixed = nullptr;
  /**
   * @brief Unit normals n of planes that points may slide in: 3 per point; zero for a point that is free or
   * fixed. Null: none. Only for points that are not fixed.
   */
  const double* slidePlanes = nullptr;
  /// Unit directions of lines that points may slide along; 3 per point, zero elsewhere; or null.
  const double* slideLines = nullptr;
  /// How far each point may go from its start, 3D distance; one per point (infinity = any), or null.
  const double* limits = nullptr;
  /**
   * @brief One flag per point: nonzero for boundary points of a volume or planar mesh that slide on the boundary as it
   * was (only those that are not fixed); or null. Points on sharp edges are the caller's to fix. Needs a local optimizer.
   */
  const unsigned char* slideSurface = nullptr;
  SurfaceConstraint surface;
  /// Lets steps invert elements that are valid. Off: they are shortened.
  bool allowInversion = false;
  /**
   * @brief What to do with an input that has inverted elements and objectives none of which orders them:
   * untangle() first (on), or refuse with an Error (off).
   */
  bool untangleFirst = true;
  /**
   * @brief Section 3.3.3: multiplies the untangling objectives by a constant that makes their largest element
   * value exceed the largest of the other objectives at the start.
   */
  bool rescaleUntangling = true;
  /// Local algorithms: leave out vertices that moved less than this times their shortest edge; 0: none.
  double culling = 1e-3;
  /// Steps in each patch of the local algorithms.
  int patchIterations = 1;
  /**
   * @brief Over-relaxation of LocalNewton: a step is this times Newton's, 1 to 2 (exclusive). Around 1.4
   * halves the number of sweeps.
   */
  double relaxation = 1.4;
  /**
   * @brief WorstElement: after the objective has converged, lowers the largest value of the first
   * objective's metric as long as its mean does not rise by more than this part of it; 0: off.
   */
  double improveWorst = 0.0;
  int threads = 0; ///< 0: all cores. The result does not depend on it.
  /**
   * @brief Called after each iteration; return false to stop. Called from the calling thread. While untangle() runs
   * first, the records are its own, with 0 for what belongs to the objectives, and progress stays 0.
   */
  std::function<bool(const IterationState&)> observer;
};

struct Optimization
{
  std::vector<double> points; ///< 3 x numberOfPoints; the best found
  std::vector<IterationRecord> history;
  StopReason reason = StopReason::IterationLimit;
  int iterations = 0;
  Index freeVertices = 0;
  Index invertedBefore = 0, invertedAfter = 0;
  /// Largest distance of the output's surface (of a surface mesh, or of points that slide) from the input's; else 0.
  double surfaceError = 0;
  bool untangled = false; ///< untangle() was run first
};

/**
 * @brief Sets objectives, scalarization, optimizer and stopping criteria to those of a preset; the rest
 * stays. For PreserveShape, set objectives[0].evaluation.targets afterwards (referenceTargets()).
 */
TAUTLINE_KERNEL_EXPORT void applyPreset(Preset preset, OptimizeOptions& options);

/**
 * @brief Optimises. Elements that are not valid at the start are left out of the objectives that cannot repair them, and
 * join as soon as they are valid; the objective in the history rises by their share then. The result is never worse than the input in the scalarized objective, and unless
 * allowInversion no valid element becomes inverted. Throws Error on options that cannot be met and
 * names the remedy.
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed.
 */
TAUTLINE_KERNEL_EXPORT Optimization optimize(const Mesh& mesh, const OptimizeOptions& options);
}
#endif
