/**
 * @file EllipticProblem.h
 * @brief The boundary value problems of chapter 2: Poisson (2.2), general second order (2.3), linear elasticity (2.4).
 *
 * Example: -laplace u = 1, u = 0 on the boundary, by CG with BoomerAMG.
 *
 *     tautline::EllipticProblem problem;
 *     problem.source = { 1, 0, 0 };
 *     tautline::EllipticSystem system(mesh, problem);
 *     tautline::EllipticSolution solution = system.solve({});
 */
#ifndef tautline_EllipticProblem_h
#define tautline_EllipticProblem_h

#include "FiniteElements.h"
#include "LinearSolver.h"
#include "PointNumbering.h"

#include <functional>
#include <memory>

namespace tautline
{
/// The numbers are stable: ParaView state files hold them.
enum class Pde : int
{
  Poisson = 0,   ///< -laplace u = f
  Elliptic = 1,  ///< -alpha u_xx - beta u_yy - gamma u_zz + a u = f
  Elasticity = 2 ///< -div tau(u) = f
};

struct EllipticProblem
{
  Pde pde = Pde::Poisson;
  /// Of Elliptic; Poisson ignores it. C must be positive definite in the plane of a planar mesh, in space otherwise.
  DiffusionOperator diffusion;
  ElasticOperator elastic; ///< Elasticity
  /// f, constant: the first component, or a vector in space for elasticity (of a planar mesh in its plane).
  Vec3 source = { 1, 0, 0 };
  /// f at the points instead, 1 (elasticity: 3) per point, linear in between; or null.
  const double* sources = nullptr;
  /// One flag per point, nonzero = its values are given; null: the boundary of the mesh (over all ranks).
  const unsigned char* fixed = nullptr;
  /// Given values at the points, 1 (elasticity: 3) per point; null: 0. Only those of fixed points are read.
  const double* fixedValues = nullptr;
};

/// The part of a mesh on this rank; the default is the whole mesh in one process.
struct MeshPart
{
  Communicator communicator = nullptr;
  const Index* globalIds = nullptr;    ///< of the points
  const unsigned char* skip = nullptr; ///< of the cells: nonzero for ghosts
};

struct EllipticSolution
{
  int components = 1; ///< 1, or 3 for elasticity
  /// Components per point; NaN at points outside all cells: no equation is about them.
  std::vector<double> values;
  /// Per cell, at its centre: gradient (3), or stress of elasticity (6, as SymmetricTensor). Ghosts have theirs, too; NaN for
  /// faces beside volumes and where a value is NaN.
  std::vector<double> gradients;
  LinearSolution linear;
};

/**
 * @class tautline::EllipticSystem
 * @brief The assembled system A u = b of the free unknowns, and everything that can be asked of it.
 */
class TAUTLINE_KERNEL_EXPORT EllipticSystem
{
public:
  /**
   * @brief Assembles. Collective over the ranks, which all throw if one does. Throws Error that names the problem and the remedy:
   *
   * - no cells, cells of other types, coordinates or coefficients that are not finite or out of range;
   * - degenerate elements, or elements inverted against the rest (how many, the first). A mesh that is reversed throughout is taken;
   * - f or given values that are not finite where they are needed, or that point out of the plane of a planar mesh;
   * - no free point; parts of the mesh without a fixed point where the operator is singular there (Poisson, a = 0). Elastic parts
   *   need two fixed points in the plane and three in space, not in one line; parts that touch in one point (or in space along
   *   one edge) count as one, and that they may turn about it is not found. On several ranks only one fixed point is asked for.
   *
   * @param mesh stays alive as long as the system, and so do the arrays of problem and part
   */
  EllipticSystem(
    const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part = {}, int threads = 0);
  ~EllipticSystem();

  Index unknowns() const;         ///< on all ranks
  int blockSize() const;          ///< unknowns per point: 1, 2 or 3
  double assembleSeconds() const; ///< wall time of the matrix and the right-hand side
  /// This rank's contributions; unknown blockSize i + k is component k of point freePoints()[i]. On one rank the matrix.
  const SparseMatrix& matrix() const;
  const std::vector<double>& rightHandSide() const;
  const std::vector<Index>& freePoints() const;
  const Mesh& mesh() const;
  const EllipticProblem& problem() const;
  const MeshPart& part() const;
  int threads() const;
  const PointNumbering& numbering() const; ///< of the free points: entry i is freePoints()[i]

  /// What LinearSolver wants; valid as long as the system.
  LinearSystem linearSystem() const;

  /// Solves, with a solver of its own. A failure is a reason in `linear`, as in LinearSolver.
  EllipticSolution solve(const SolverOptions& options) const;
  /// The fields of a solution of the linear system, one number per unknown of this rank.
  EllipticSolution fields(const std::vector<double>& unknowns) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl;
};

/**
 * @brief Norms of the difference between a solution and a known function, by four Gauss points in each direction. Collective.
 * @param exact writes `components` values and their gradients (3 per component; of a surface its tangential ones) at a place
 * @return { L2 norm of the error, L2 norm of the gradient's error }
 */
TAUTLINE_KERNEL_EXPORT std::array<double, 2> errorNorms(const EllipticSystem& system,
  const EllipticSolution& solution,
  const std::function<void(const Vec3&, double* value, double* gradient)>& exact);
}
#endif
