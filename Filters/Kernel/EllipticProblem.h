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
  DiffusionOperator diffusion; ///< Elliptic; Poisson ignores it
  ElasticOperator elastic;     ///< Elasticity
  Vec3 source = { 1, 0,
    0 }; ///< f, constant: the first component, or a vector in space for elasticity
  const double* sources =
    nullptr; ///< f at the points instead, 1 (elasticity: 3) per point; or null
  /// One flag per point, nonzero = its values are given; null: the boundary of the mesh (over all ranks).
  const unsigned char* fixed = nullptr;
  /// Given values at the points, 1 (elasticity: 3) per point; null: 0.
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
  int components = 1;         ///< 1, or 3 for elasticity
  std::vector<double> values; ///< components per point; NaN at points outside all cells
  /// Per cell, at its centre: gradient (3), or stress of elasticity (6, as SymmetricTensor); NaN for cells skipped.
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
   * @brief Assembles. Collective over the ranks. Throws Error that names the problem and the remedy: inverted or degenerate elements
   * (how many, the first), no cells, cells of other types, no free point, a part without a fixed point where the operator
   * is singular there (Poisson, a = 0, elasticity), f or given values that are not finite.
   * @param mesh stays alive as long as the system; oriented consistently
   */
  EllipticSystem(
    const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part = {}, int threads = 0);
  ~EllipticSystem();

  Index unknowns() const; ///< on all ranks
  int blockSize() const;  ///< unknowns per point: 1, 2 or 3
  double assembleSeconds() const;
  /// This rank's contributions; unknown blockSize i + k is component k of point freePoints()[i].
  const SparseMatrix& matrix() const;
  const std::vector<double>& rightHandSide() const;
  const std::vector<Index>& freePoints() const;
  const Mesh& mesh() const;
  const EllipticProblem& problem() const;
  const PointNumbering& numbering() const;

  /// What LinearSolver wants; valid as long as the system.
  LinearSystem linearSystem() const;

  /// Solves, with a solver of its own.
  EllipticSolution solve(const SolverOptions& options) const;
  /// The fields of a solution of the linear system.
  EllipticSolution fields(const std::vector<double>& unknowns) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl;
};

/**
 * @brief Norms of the difference between a solution and a known function, by quadrature of degree 4.
 * @param exact writes `components` values and their gradients (3 per component) at a place
 * @return { L2 norm of the error, L2 norm of the gradient's error }
 */
TAUTLINE_KERNEL_EXPORT std::array<double, 2> errorNorms(const EllipticSystem& system,
  const EllipticSolution& solution,
  const std::function<void(const Vec3&, double* value, double* gradient)>& exact);
}
#endif
