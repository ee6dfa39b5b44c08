// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Peridynamics.h
 * @brief Stiffness matrices of nonlocal (peridynamic) models on triangle meshes.
 *
 * The bilinear form is (4.6) of the dissertation,
 *
 *     a(u, w) = s int_Omega' w(x) int_{B(x, delta)} (u(x) - u(y)) k(|x - y|) dy dx,
 *
 * where B is the disk of radius delta, the horizon. The kernel k is r^-p with s = 1 / delta^(4-p),
 * or one of the others of KernelShape with s = 1 / delta^4. The linearized elastic model
 * (4.4)-(4.5) has the tensor kernel (y-x) (y-x)^T k(|x - y|) and s divided by delta^2 once more, so
 * that both have a local limit: s a -> pi / (2 (4-p)) times the form of the Laplacian. The
 * state-based model adds a dilatation term to the elastic model, for any Poisson's ratio: see
 * Dilatation.h. The solution is given in an interaction layer of width delta (state-based: 2 delta)
 * around the domain Omega (the volume constraint); the unknowns are in Omega.
 *
 * Two discretizations of the integrals:
 * - Dissertation: the rules of its section 4.3. The disk is centered at each outer quadrature
 *   point, cut triangles are replaced by the one or two triangles of Figures 4.4 and 4.5, and a
 *   low-order rule is used on each. For the rules that reproduce its tables, see RuleSet.
 * - Exact: the integral over y is exact in its geometry (circle and triangle) and its singularity
 *   (by transformation to polar coordinates); the integral over x is graded toward common vertices
 *   and edges and refined according to PeridynamicOptions::tolerance. Convergent and symmetric. It
 *   does not depend on the order of points, triangles and corners: all sums are in the order of
 *   their coordinates.
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
#include "tautline/Core/RankGroup.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/**
 * @brief Assembles the stiffness matrix.
 *
 * @param given values in the interaction layer, one per function and component of the basis (values
 * of unknown functions are ignored), for PeridynamicSystem::constraintLoad; may be null
 *
 * Throws Error, with the remedy, for: a horizon that is not above 0; an exponent at or above the
 * singular limit (singularLimit()); triangles that are inverted, degenerate, of mixed orientation
 * or have coordinates that are not finite; a missing interaction layer, or one narrower than the
 * horizon; no unknowns; in the Dissertation discretization, a horizon so small that a function
 * meets no triangle; more memory than allowed; an exceeded time limit; progress() returning false.
 */
TAUTLINE_SOLVERS_EXPORT PeridynamicSystem assemblePeridynamics(const HorizonMesh& mesh,
  const PeridynamicOptions& options, const std::vector<double>* given = nullptr);

/**
 * @brief The same on several ranks: they divide the functions by planes (k-d tree), and each
 * integrates the rows of its own functions, with all triangles within the horizon around them.
 * Collective; all ranks pass the same mesh, options (except threads, time limit and progress) and
 * values.
 *
 * @return on the first rank, the system of a serial run, bitwise; on other ranks, a system without
 * a matrix. Integrated pairs needed by several ranks are counted on each. The dilatation of the
 * state-based model is added on the first rank.
 */
TAUTLINE_SOLVERS_EXPORT PeridynamicSystem assemblePeridynamics(RankGroup& group,
  const HorizonMesh& mesh, const PeridynamicOptions& options,
  const std::vector<double>* given = nullptr);

/// Broadcasts the mesh of the first rank to all ranks. Collective. @param own of the first rank
TAUTLINE_SOLVERS_EXPORT HorizonMesh meshOfFirst(RankGroup& group, const HorizonMesh& own);

/// The number of bytes that assemblePeridynamics() will need, from a sample of the rows. Also
/// checks the mesh.
TAUTLINE_SOLVERS_EXPORT double estimatePeridynamicMemory(
  const HorizonMesh& mesh, const PeridynamicOptions& options);

/**
 * @brief The load of a source b: int phi_i b for each unknown and component.
 * @param source per vertex (`perVertex`) or per triangle, `components` values each; linear or
 * constant in a triangle
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> sourceLoad(const HorizonMesh& mesh,
  const PeridynamicSystem& system, PeridynamicBasis basis, const std::vector<double>& source,
  bool perVertex);

}
#endif
