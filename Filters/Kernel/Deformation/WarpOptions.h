// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpOptions.h
 * @brief The options of a mesh deformation, and its result.
 */
#ifndef tautline_WarpOptions_h
#define tautline_WarpOptions_h

#include "tautline/Elliptic/Materials.h"
#include "tautline/Optimization/OptimizeOptions.h"
#include "tautline/Solvers/SolverOptions.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/// The methods of deformation; the numbers are stable: ParaView state files hold them.
enum class WarpMethod : int
{
  Hybrid =
    0, ///< anisotropic FEMWARP, then shape against the initial mesh and untangling (4.22)-(4.24)
  Femwarp = 1,            ///< one harmonic solve (4.10)
  AnisotropicFemwarp = 2, ///< with coefficients (4.11), (4.20)
  SmallStepFemwarp = 3,   ///< FEMWARP in steps, each with the matrix of the previous mesh
  /// FEMWARP, then untangling; moved elements are restored to their initial shapes
  FemwarpUntangling = 4,
  IterativeStiffening = 5, ///< linear elasticity, inverted elements stiffened until there are none
  JacobianStiffening =
    6, ///< linear elasticity, small elements stiff (Stein, Tezduyar and Benson 2003)
  Biharmonic = 7,
  InverseDistance = 8,
  RadialBasis = 9, ///< compactly supported, points chosen greedily
  WeightedLaplacian =
    10, ///< weighted Laplacian smoothing: each vertex an affine combination of its neighbors
  InverseDistanceRotations =
    11, ///< weighted means of the rigid motions of the wall (Luke, Collins and Blades 2012)
  /**
   * @brief RadialBasis if all elements stay valid with an inverse mean ratio up to 2 relative to
   * the initial mesh, otherwise the better of RadialBasis and InverseDistanceRotations; then the
   * second step of Hybrid if an element is inverted or has an inverse mean ratio above 10
   */
  Automatic = 12
};

/// Whether a number is a valid method; numbers come from state files and Python.
TAUTLINE_SOLVERS_EXPORT bool isKnown(WarpMethod method);
/// Whether a method uses the coefficients of WarpOptions::coefficients.
TAUTLINE_SOLVERS_EXPORT bool isAnisotropic(WarpMethod method);
/// Whether a method untangles the elements that its motion inverts.
TAUTLINE_SOLVERS_EXPORT bool untangles(WarpMethod method);

/// Whether coefficients (xx yy zz xy yz xz) are finite and positive semidefinite, up to rounding.
TAUTLINE_SOLVERS_EXPORT bool isPositiveSemidefinite(const double* tensor);

/// The source of the coefficients of AnisotropicFemwarp and Hybrid. The numbers are stable.
enum class WarpCoefficients : int
{
  DisplacementSums = 0,    ///< (4.19), (4.21): sums of the absolute displacements along the axes
  PrincipalDirections = 1, ///< a tensor along the principal directions of the motion
  Manual = 2,              ///< `tensor`
  PerCell = 3,             ///< `tensors`
  /// A tensor per cell: large along the displacement that FEMWARP gives the cell, and increasing
  /// with the displacement gradient there. Suggested as future work in the dissertation.
  LocalGradients = 5 ///< 4 is the filter's choice by regions
};

/// Whether a number is a valid choice of coefficients.
TAUTLINE_SOLVERS_EXPORT bool isKnown(WarpCoefficients coefficients);

/// The default options of the second step of Hybrid: at most 50 iterations, to a relative change of
/// 1e-3.
TAUTLINE_SOLVERS_EXPORT OptimizeOptions hybridOptimization();

/// The options of a deformation; options of a single method state its name.
struct WarpOptions
{
  WarpMethod method = WarpMethod::Hybrid;
  WarpCoefficients coefficients = WarpCoefficients::DisplacementSums;
  SymmetricTensor tensor = IdentityTensor; ///< Manual; alpha, beta, gamma are its first three
  const double* tensors = nullptr;         ///< PerCell: 6 per cell
  /// One flag per point, nonzero = follows its given displacement; null: the boundary points.
  const unsigned char* prescribed = nullptr;
  /**
   * @brief The number of steps of the motion, each starting from the mesh of the previous step; at
   * least 0. 0 means automatic: steps that invert an element, or flatten one to an inverse mean
   * ratio above 1000 relative to the initial mesh, are halved, others doubled. The result is then
   * valid and may reach only a fraction of the motion, see WarpResult::amount. SmallStepFemwarp
   * treats 1 as 0. Between the steps, each connected component of prescribed points rotates and
   * stretches by the affine map of its displacements if they are nearly affine; otherwise it moves
   * along straight lines.
   *
   * Hybrid, FemwarpUntangling and Automatic try one step first, with 0 and with 1; if untangling
   * then fails although the moved boundary does not intersect itself, they follow the motion in
   * short steps.
   */
  int steps = 1;
  int maximumSteps = 100; ///< the limit if the number is automatic; at least 1
  /// Direct up to 600,000 unknowns (planar) or 20,000 (volume), otherwise CG with BoomerAMG; off:
  /// `solver`.
  bool automaticSolver = true;
  SolverOptions solver; ///< its tolerance is `tolerance`
  double tolerance =
    1e-10; ///< relative, for the solves, 0 to 1 (exclusive); affine motions are always exact
  double poissonRatio = 0.3;    ///< of the elastic methods, -1 to 0.5 (exclusive)
  double stiffeningPower = 1.0; ///< JacobianStiffening: chi, at least 0
  int maximumStiffenings = 50;  ///< IterativeStiffening
  double stiffeningFactor =
    2.0; ///< IterativeStiffening: factor on the stiffness of inverted elements, above 1
  double distancePower = 3.0; ///< InverseDistance: above 0, at most 20
  double supportRadius = 0.0; ///< RadialBasis; 0: twice the extent of the prescribed points
  /**
   * @brief RadialBasis: the allowed error at a prescribed point, relative to the smallest height of
   * the cells there; 0 to 1 (exclusive). Thus, layers of any height follow their wall.
   */
  double fitTolerance = 1e-2;
  /**
   * @brief The second step of Hybrid. On: untangle() the inverted elements; if there were any, or
   * if an inverse mean ratio of T is above 10, reduce the squared ratios and, on one rank, if one
   * is still above 10, reduce the worst of them while the mean grows by at most a tenth; then
   * minimize the exponential sum of F_1, the shape (4.22), and of these squared ratios, without
   * increasing the worst ratio. The ratios are a barrier that keeps every element valid, and
   * replace the untangling metric of (4.24), which is 0 there. Off: minimize (4.24) itself with
   * `optimization`; c and the optimizer are chosen automatically unless specified (the
   * dissertation: local conjugate gradients, c of 1e4 to 1e6 in its unit of length). Elements that
   * remain inverted are untangled afterwards.
   */
  bool untangleFirst = true;
  /// beta of (4.24) with untangleFirst off, relative to the mean area or volume of the elements; at
  /// least 0.
  double untanglingBeta = 0.0;
  /// The second step of Hybrid: only the optimizer, the stopping criteria, and c of the exponential
  /// sum are used; the rest is overwritten.
  OptimizeOptions optimization = hybridOptimization();
  double maximumSeconds = 0.0; ///< 0: no limit
  int threads = 0;             ///< 0: all cores. The result does not depend on it.
  /// Called with the fraction done, 0 to 1; the deformation stops when it returns false.
  std::function<bool(double)> progress;
};

/// One line of the history: a stage of a step.
struct WarpRecord
{
  double amount = 0.0;     ///< of the motion, 0 to 1
  Index inverted = 0;      ///< inverted or degenerate elements
  double worstShape = 0.0; ///< largest TMP shape (4.22) over the valid elements
  double meanShape = 0.0;
  double worstRatio = 0.0; ///< their largest inverse mean ratio relative to the initial mesh
  double seconds = 0.0;
  int iterations = 0; ///< of linear solvers and optimizers
  /// "warp", "untangle", "optimize"; for Automatic also "radial basis", "inverse distance"
  std::string stage;
};

/// The result of a method that Automatic tried.
struct WarpAttempt
{
  WarpMethod method = WarpMethod::RadialBasis;
  Index inverted = 0;
  double worstRatio = 0; ///< as in WarpRecord
};

/// The deformed mesh, and a report.
struct WarpResult
{
  std::vector<double> points; ///< 3 x numberOfPoints
  std::vector<WarpRecord> history;
  double amount = 1.0; ///< the fraction of the motion that was reached
  /// For Automatic, in the last step: the methods tried, and the chosen one.
  std::vector<WarpAttempt> attempts;
  WarpMethod chosen = WarpMethod::Hybrid; ///< the method itself if it is not Automatic
  /// Whether the prescribed points end where they begin, so that one step moves nothing.
  bool still = false;
  SymmetricTensor tensor = IdentityTensor; ///< the coefficients used, unless they vary
  Index invertedWarp = 0;                  ///< after the warp itself
  Index invertedAfter = 0;                 ///< at the end
  /// Inverted elements that no interior point positions can make valid, because the moved boundary
  /// itself is invalid there.
  Index impossible = 0;
  /// Pairs of edges, or of boundary triangles, of the moved boundary that cross but did not cross
  /// before.
  Index crossings = 0;
  /**
   * @brief Points that a coefficient of 0 decouples from all prescribed points. They follow the
   * surrounding points through the isotropic operator, which does not affect the other points.
   */
  Index decoupled = 0;
  /// Multiple of the isotropic operator that was added to a singular one for a bounded motion,
  /// relative to the largest coefficient; 0: none.
  double regularization = 0.0;
  double assembleSeconds = 0, setupSeconds = 0, solveSeconds = 0, improveSeconds = 0;
  bool aborted = false, timeLimit = false;
  std::string message; ///< warnings for the user, or ""
};
}
#endif
