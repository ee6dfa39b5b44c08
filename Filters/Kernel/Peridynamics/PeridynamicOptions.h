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

/// A radial kernel; each shape uses the members mentioned in its description.
struct KernelFunction
{
  KernelShape shape = KernelShape::Power;
  double exponent = 1.0; ///< p for Power, 0 to singularLimit() (exclusive)
  double width = 0.5;    ///< for Gaussian, in horizons; above 0
  /// For Table: two or more values, at least 0 and not all 0; the first at r = 0, the last at
  /// delta.
  std::vector<double> table;
};

/// The basis functions of the solution.
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

/// The numbers of points in the quadrature rules of the Dissertation discretization.
enum class RuleSet
{
  /// Three outer points; one inner point for the linear bases, three for the constant one: these
  /// reproduce the tables.
  Tables = 0,
  /// One outer and three inner points: as stated in section 4.3.1. Often indefinite with the linear
  /// basis.
  Literal = 1,
  OneOne = 2,     ///< one outer point, one inner
  ThreeThree = 3, ///< three and three
  ThreeOne = 4    ///< three outer points, one inner
};

/// The model, its discretization and the limits of an assembly.
struct PeridynamicOptions
{
  double horizon = 0.2; ///< delta, above 0, in mesh units
  KernelFunction kernel;
  PeridynamicBasis basis = PeridynamicBasis::Linear;
  PeridynamicModel model = PeridynamicModel::Scalar;
  Discretization discretization = Discretization::Exact;
  RuleSet rules = RuleSet::Tables;
  /// StateBased: Poisson's ratio, above -1 and below 0.5. The bond-based model has 1/4 in plane
  /// strain and 1/3 in plane stress.
  double poissonRatio = 0.25;
  PlaneState planeState = PlaneState::Strain; ///< for StateBased
  /// Whether interactions across the outside of the mesh, for example a hole or a crack, are
  /// removed. Has no effect with a sufficiently wide interaction layer.
  bool cutBonds = true;
  /**
   * Exact: the tolerance at which the refinement of the outer integral over a pair of triangles
   * stops, 1e-10 to 0.1. A part of a triangle is quartered until two rules agree within a fraction
   * of the possible contribution of the pair: the tolerance at common corners and edges, three
   * times its power 3/4 where the horizon cuts the other triangle, otherwise its square root
   * (there, the error of the finer rule is the square of the difference). Errors of the matrix are
   * larger than the tolerance and decrease more slowly: measured relative to the largest entry, at
   * most 3e-3, 5e-4 and 1e-4 for 1e-3, 1e-5 and 1e-7 with a horizon of 1.5 elements, and 7e-3, 8e-4
   * and 3e-4 with a horizon of 0.3 elements; smaller for the condition number.
   */
  double tolerance = 1e-5;
  /// Whether functions of the interaction layer are given. False: all are unknown, nothing is
  /// constrained, and constants (elasticity: rigid motions) are in the null space.
  bool constrained = true;
  /// Whether an interaction layer that is too thin is accepted: interactions beyond the mesh are
  /// then ignored.
  bool allowThinLayer = false;
  /// Exact: whether pairs of triangles that are congruent up to a translation are integrated once.
  bool reuseCongruent = true;
  double memoryLimit = 0.0; ///< maximum bytes of the result; 0: 90 % of the free memory
  double timeLimit = 0.0;   ///< seconds; 0: none
  int threads = 0;          ///< 0: all cores; the result does not depend on it
  /// Called with the fraction done, 0 to 1; the assembly throws Error if it returns false.
  std::function<bool(double)> progress;
};

/**
 * @brief The upper limit of the exponent p: for r^-p, the form is finite below 4 on continuous
 * functions, and below 3 on discontinuous ones; the tensor kernel of elasticity adds 2. The bound p
 * < 2 of (4.7) only concerns integrability of the kernel.
 */
TAUTLINE_SOLVERS_EXPORT double singularLimit(PeridynamicBasis basis, PeridynamicModel model);

/// The range of interaction of functions beyond their supports, and the required width of the
/// interaction layer: the horizon or, for StateBased, twice the horizon.
TAUTLINE_SOLVERS_EXPORT double interactionReach(const PeridynamicOptions& options);

/// Lame's lambda over mu; 1 for the bond-based model.
TAUTLINE_SOLVERS_EXPORT double lameRatio(const PeridynamicOptions& options);

/// The number of functions of a basis.
TAUTLINE_SOLVERS_EXPORT Index numberOfFunctions(const HorizonMesh& mesh, PeridynamicBasis basis);

/// A stiffness matrix, the meaning of its rows, and a report.
struct PeridynamicSystem
{
  SparseMatrix matrix;  ///< symmetric
  Index components = 1; ///< 1, elasticity: 2; row of function f, component c: components * f + c
  /// Per function of the basis (triangle, vertex, or 3 x triangle + corner): its number among the
  /// unknown ones; -1 if it is given; -2 if no triangle has it.
  std::vector<Index> unknownOf;
  std::vector<Index> functionOf; ///< the function of each unknown
  /// Per row, sum of a(phi_j, phi_i) g_j over the given functions j; empty unless requested.
  std::vector<double> constraintLoad;
  /// For the Dissertation discretization: the Frobenius norm of the dropped unsymmetric part,
  /// relative to the whole.
  double asymmetry = 0.0;
  /// The amount by which the interaction layer is narrower than interactionReach(); 0 if it is wide
  /// enough.
  double layerDeficit = 0.0;
  double memory = 0.0;       ///< bytes, estimated before starting
  Index integratedPairs = 0; ///< Exact: pairs of triangles integrated (not reused)
};
}
#endif
