// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticSystem.h
 * @brief A boundary value problem assembled on a mesh, and its solution.
 *
 * Example: -laplace u = 1, u = 0 on the boundary, by CG with BoomerAMG.
 *
 *     tautline::EllipticProblem problem;
 *     problem.source = { 1, 0, 0 };
 *     tautline::EllipticSystem system(mesh, problem);
 *     tautline::EllipticSolution solution = system.solve({});
 */
#ifndef tautline_EllipticSystem_h
#define tautline_EllipticSystem_h

#include "EllipticProblem.h"
#include "EllipticSolution.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/Ranks/PointNumbering.h"
#include "tautline/Solvers/LinearSolver.h"
#include "tautline/SolversExport.h"

#include <memory>

namespace tautline
{
/**
 * @class tautline::EllipticSystem
 * @brief The assembled system A u = b of the free unknowns, with the fields computed from it.
 */
class TAUTLINE_SOLVERS_EXPORT EllipticSystem
{
public:
  /**
   * @brief Assembles the system. Collective over the ranks, which all throw if one does. Throws
   * Error with the problem and a remedy for:
   *
   * - no cells, cells of other types, coordinates or coefficients that are not finite or out of
   *   range;
   * - degenerate elements, or elements inverted relative to the rest (stating their number and the
   *   first). A fully reversed mesh is accepted;
   * - f or given values that are needed but not finite, or that point out of the plane of a planar
   *   mesh;
   * - no free point; parts of the mesh without a fixed point if the operator is singular there
   *   (Poisson, a = 0). Elastic parts need two fixed points in the plane and three noncollinear
   *   points in space. Parts that touch in one point (or, in space, along one edge) are treated as
   *   one; that they may rotate about it is not detected. On several ranks, only one fixed point is
   *   required.
   *
   * @param mesh must outlive the system, as must the arrays of problem and part
   */
  EllipticSystem(
    const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part = {}, int threads = 0);
  ~EllipticSystem();
  EllipticSystem(const EllipticSystem&) = delete;
  EllipticSystem& operator=(const EllipticSystem&) = delete;

  Index unknowns() const;         ///< on all ranks
  int blockSize() const;          ///< unknowns per point: 1, 2 or 3
  double assembleSeconds() const; ///< wall time of the matrix and the right-hand side
  /// This rank's contributions; unknown blockSize i + k is component k of point freePoints()[i]. On
  /// one rank, the whole matrix.
  const SparseMatrix& matrix() const;
  const std::vector<double>& rightHandSide() const;
  const std::vector<Index>& freePoints() const;
  const Mesh& mesh() const;
  const EllipticProblem& problem() const;
  const MeshPart& part() const;
  int threads() const;
  const PointNumbering& numbering() const; ///< of the free points: entry i is freePoints()[i]

  /// The system in the form that LinearSolver uses; valid as long as this object.
  LinearSystem linearSystem() const;

  /// Solves with a new solver. Failures are reported as a reason in `linear`, as by LinearSolver.
  EllipticSolution solve(const SolverOptions& options) const;
  /// The fields of a solution of the linear system, one number per unknown of this rank.
  EllipticSolution fields(const std::vector<double>& unknowns) const;

private:
  struct Implementation;
  std::shared_ptr<Implementation> Impl; // an abandoned setup may still read the matrix
};

/// Throws in the same cases as the constructor of EllipticSystem, except for a mesh without a free
/// point. For a repartitioned mesh: messages use the numbers of its pieces. Collective.
TAUTLINE_SOLVERS_EXPORT void requireSolvable(
  const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part = {}, int threads = 0);
}
#endif
