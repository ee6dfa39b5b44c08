// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicOptions.h
 * @brief The options and the result of a peridynamic assembly.
 */
#ifndef tautline_PeridynamicOptions_h
#define tautline_PeridynamicOptions_h

#include "Horizon.h"
#include "tautline/Core/PlaneState.h"
#include "tautline/Solvers/SparseMatrix.h"
#include "tautline/SolversExport.h"

#include <functional>
#include <vector>

namespace tautline
{
/// The kernel k(r), r < delta.
enum class KernelShape
{
  Power = 0,    ///< r^-p
  Constant = 1, ///< 1
  Gaussian = 2, ///< exp(-(r / (w delta))^2), w = KernelFunction::width
  Conical = 3,  ///< 1 - r / delta
  Table = 4     ///< linear between values at equal distances from 0 to delta
};

/// A radial kernel; each shape reads the members it names.
struct KernelFunction
{
  KernelShape shape = KernelShape::Power;
  double exponent = 1.0; ///< p of Power, 0 to singularLimit() (exclusive)
  double width = 0.5;    ///< of Gaussian, in horizons; above 0
  /// Of Table: two or more values, at least 0 and not all 0; the first at r = 0, the last at delta.
  std::vector<double> table;
};

/// The functions the solution is made of.
enum class PeridynamicBasis
{
  Constant = 0,           ///< one per triangle
  Linear = 1,             ///< continuous, one per vertex
  DiscontinuousLinear = 2 ///< three per triangle
};

/// The model, by its equations in the dissertation.
enum class PeridynamicModel
{
  Scalar = 0,    ///< diffusion, (4.6)
  Elastic = 1,   ///< bond-based linearized elasticity, (4.4)-(4.5): two components per function
  StateBased = 2 ///< linear ordinary state-based elasticity, see Dilatation.h: two components
};

/// Whether the model has two components per function.
constexpr bool isElastic(PeridynamicModel model)
{
  return model != PeridynamicModel::Scalar;
}

/// How the double integrals are discretized, see Peridynamics.h.
enum class Discretization
{
  Dissertation = 0, ///< the quadrature rules of section 4.3
  Exact = 1         ///< to a tolerance
};

/// Numbers of points of the rules of the dissertation's discretization.
enum class RuleSet
{
  /// Three outer points; one inner point for the linear bases, three for the constant one: these
  /// reproduce the tables.
  Tables = 0,
  /// One outer and three inner points: what section 4.3.1 states. Often indefinite with the linear
  /// basis.
  Literal = 1,
  OneOne = 2,     ///< one outer point, one inner
  ThreeThree = 3, ///< three and three
  ThreeOne = 4    ///< three outer points, one inner
};

/// The model, its discretization and the limits of an assembly.
struct PeridynamicOptions
{
  double horizon = 0.2; ///< delta, above 0, in the unit of the mesh
  KernelFunction kernel;
  PeridynamicBasis basis = PeridynamicBasis::Linear;
  PeridynamicModel model = PeridynamicModel::Scalar;
  Discretization discretization = Discretization::Exact;
  RuleSet rules = RuleSet::Tables;
  /// StateBased: Poisson's ratio, above -1 and below 0.5. The bond-based model has 1/4 in plane
  /// strain and 1/3 in plane stress.
  double poissonRatio = 0.25;
  PlaneState planeState = PlaneState::Strain; ///< of StateBased
  /// Whether triangles do not interact where the mesh ends between them, as across a hole or a
  /// crack. Has no effect with an interaction layer that is wide enough.
  bool cutBonds = true;
  /**
   * Exact: where the refinement of the outer integral over a pair of triangles stops, 1e-10 to 0.1:
   * a part of a triangle is quartered until two rules agree within a fraction of what the pair
   * can contribute: the tolerance at common corners and edges, three times its power 3/4 where the
   * horizon cuts the other triangle, else its square root (there the finer rule errs by the square
   * of the difference). Errors of the matrix are larger than the tolerance and fall more slowly:
   * measured, relative to the largest entry, at most 3e-3, 5e-4 and 1e-4 for 1e-3, 1e-5 and 1e-7
   * with a horizon of 1.5 elements, 7e-3, 8e-4 and 3e-4 with one of 0.3; of the condition number
   * less.
   */
  double tolerance = 1e-5;
  /// Whether functions of the interaction layer are given. False: all are unknown, nothing is
  /// constrained, and constants (elasticity: rigid motions) are in the null space.
  bool constrained = true;
  /// Whether an interaction layer that is too thin is accepted: what lies beyond the mesh then does
  /// not count.
  bool allowThinLayer = false;
  /// Exact: whether pairs of triangles that are congruent up to a translation are integrated once.
  bool reuseCongruent = true;
  double memoryLimit = 0.0; ///< bytes the result may take; 0: 90 % of the free memory
  double timeLimit = 0.0;   ///< seconds; 0 is none
  int threads = 0;          ///< 0 is all cores; the result does not depend on it
  /// Called with the fraction done, 0 to 1; the assembly ends with an Error when it returns false.
  std::function<bool(double)> progress;
};

/**
 * @brief The limit that the exponent p has to stay below: for r^-p the form is finite on continuous
 * functions below 4, on discontinuous ones below 3; the tensor kernel of elasticity adds 2. The
 * bound p < 2 of (4.7) is about integrability of the kernel alone.
 */
TAUTLINE_SOLVERS_EXPORT double singularLimit(PeridynamicBasis basis, PeridynamicModel model);

/// How far functions interact beyond their supports, and how wide the interaction layer has to be:
/// the horizon, StateBased: twice the horizon.
TAUTLINE_SOLVERS_EXPORT double interactionReach(const PeridynamicOptions& options);

/// Lame's lambda over mu; 1 of the bond-based model.
TAUTLINE_SOLVERS_EXPORT double lameRatio(const PeridynamicOptions& options);

/// The number of functions of a basis.
TAUTLINE_SOLVERS_EXPORT Index numberOfFunctions(const HorizonMesh& mesh, PeridynamicBasis basis);

/// A stiffness matrix, the meaning of its rows, and a report.
struct PeridynamicSystem
{
  SparseMatrix matrix;  ///< symmetric
  Index components = 1; ///< 1, elasticity: 2; row of function f, component c: components * f + c
  /// Per function of the basis (triangle, vertex, or 3 x triangle + corner): its number among the
  /// unknown ones, -1 where it is given, -2 where no triangle has it.
  std::vector<Index> unknownOf;
  std::vector<Index> functionOf; ///< of an unknown one
  /// Per row, sum of a(phi_j, phi_i) g_j over the given functions j; empty unless requested.
  std::vector<double> constraintLoad;
  /// Of the dissertation's discretization: Frobenius norm of the unsymmetric part, which is
  /// dropped, over all.
  double asymmetry = 0.0;
  /// By how much the interaction layer is narrower than interactionReach(); 0 if it is wide enough.
  double layerDeficit = 0.0;
  double memory = 0.0;       ///< bytes, estimated before starting
  Index integratedPairs = 0; ///< Exact: pairs of triangles integrated (not reused)
};
}
#endif
