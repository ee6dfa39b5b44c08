/**
 * @file Peridynamics.h
 * @brief Stiffness matrices of bond-based nonlocal (peridynamic) models on triangle meshes.
 *
 * The bilinear form is that of dissertation (4.6),
 *
 *     a(u, w) = s int_Omega' w(x) int_{B(x, delta)} (u(x) - u(y)) k(|x - y|) dy dx,
 *
 * with B the disc of radius delta, the horizon. The kernel k is r^-p with s = 1 / delta^(4-p), or
 * one of the others of KernelShape with s = 1 / delta^4. The linearised elastic model (4.4)-(4.5)
 * has the tensor kernel (y-x) (y-x)^T k(|x - y|) and s divided by delta^2 once more, so that both
 * have a local limit: s a -> pi / (2 (4-p)) times the Laplacian's form. The solution is given in a
 * interaction layer of width delta around the domain Omega (the volume constraint); unknowns are
 * those of Omega.
 *
 * Two readings of the integrals:
 * - Dissertation: the rules of its section 4.3. The disc is centred at each outer quadrature point,
 *   cut triangles are replaced by the one or two triangles of Figures 4.4 and 4.5, and a low-order
 *   rule is used on each. Which rules reproduce its tables: RuleSet.
 * - Exact: the integral over y is exact in its geometry (circle and triangle) and its singularity
 *   (by transformation to polar coordinates); the one over x is graded towards common vertices and
 *   edges and refined until the tolerance is met. Converges; symmetric.
 *
 * Example: the condition number of Table 4.2, aspect ratio 1, h = 0.1, delta = 0.2.
 *
 *     const HorizonMesh mesh = horizonSquare(0.1, 1, 0.2);
 *     PeridynamicOptions options;
 *     options.horizon = 0.2;
 *     options.discretization = Discretization::Dissertation;
 *     const PeridynamicSystem system = assemblePeridynamics(mesh, options);
 *     const double condition = extremeEigenvalues(system.matrix).condition;
 *
 * Source: J. Kim, dissertation, The Pennsylvania State University, 2012, chapter 4; S. A. Silling,
 * J. Mech. Phys. Solids 48 (2000) 175-209.
 */
#ifndef tautline_Peridynamics_h
#define tautline_Peridynamics_h

#include "PeridynamicOptions.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/**
 * @brief The square (0,1)^2 of right triangles with legs h sqrt(r) and h / sqrt(r), r the aspect
 * ratio, with an interaction layer from -delta to 1 + delta, as the dissertation's tables need it.
 *
 * The grid starts exactly at -delta, also where then the sides of the square are no mesh lines (r =
 * 4, h = 0.1, delta = 0.3; the text does not say so, its numbers do): a triangle is of the domain
 * if its centroid is, and the linear basis is unknown at the points strictly inside. The
 * interaction layer is then too thin for those next to a side. See also structuredSquare(), whose
 * interaction layer has whole layers. Throws Error where the extent is no whole number of elements.
 * @param extraLayers layers of elements added on each side, for an interaction layer that is wide
 * enough all the same
 */
TAUTLINE_SOLVERS_EXPORT HorizonMesh horizonSquare(
  double h, double aspectRatio, double delta, Index extraLayers = 0);

/**
 * @brief Assembles the stiffness matrix.
 *
 * @param given values in the interaction layer, one per function and component of the basis (those
 * of unknown functions do not matter), for PeridynamicSystem::constraintLoad; may be null
 *
 * Throws Error, with the remedy, for: a horizon that is not above 0; an exponent at or above the
 * singular limit (singularLimit()); triangles that are inverted, degenerate, of mixed orientation
 * or have coordinates that are not finite; a missing interaction layer, one narrower than the
 * horizon; no unknown; in the dissertation's discretization, a horizon so small that a function
 * meets no triangle; more memory than allowed; time up; progress() said stop.
 */
TAUTLINE_SOLVERS_EXPORT PeridynamicSystem assemblePeridynamics(const HorizonMesh& mesh,
  const PeridynamicOptions& options, const std::vector<double>* given = nullptr);

/**
 * @brief The exponent p has to be below: for r^-p the form is finite on linear functions up to 4,
 * on those that jump up to 3; the tensor kernel takes two powers off. (4.7) is about integrability
 * alone: p < 2.
 */
TAUTLINE_SOLVERS_EXPORT double singularLimit(PeridynamicBasis basis, PeridynamicModel model);

/// The number of functions of a basis.
TAUTLINE_SOLVERS_EXPORT Index numberOfFunctions(const HorizonMesh& mesh, PeridynamicBasis basis);

/// Bytes assemblePeridynamics() will take, from a sample of the rows. Checks the mesh on the way.
TAUTLINE_SOLVERS_EXPORT double estimatePeridynamicMemory(
  const HorizonMesh& mesh, const PeridynamicOptions& options);

/**
 * @brief By how much the mesh falls short of reaching `horizon` beyond the domain, 0 if it does;
 * the domain is what is not interaction layer.
 */
TAUTLINE_SOLVERS_EXPORT double layerDeficit(
  const HorizonMesh& mesh, double horizon, int threads = 0);

/**
 * @brief The load of a source b: int phi_i b for each unknown and component.
 * @param source per vertex (`perVertex`) or per triangle, `components` values each; linear or
 * constant in a triangle
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> sourceLoad(const HorizonMesh& mesh,
  const PeridynamicSystem& system, PeridynamicBasis basis, const std::vector<double>& source,
  bool perVertex);

/// How a triangle meets a disc; the cases are those of Figure 4.4.
struct DiscIntersection
{
  int corners = 0;      ///< in the disc: 3 is case 1, 2 case 2, 1 case 3, 0 none
  double exactArea = 0; ///< of triangle and disc
  double chordArea = 0; ///< as the dissertation takes it
  /// The triangles taken for it, x y of three corners each: none, one or two.
  std::vector<double> chords;
};

/// @param corners x y of the three corners, of either orientation
TAUTLINE_SOLVERS_EXPORT DiscIntersection intersectDisc(
  const double* corners, double x, double y, double radius);
}
#endif
