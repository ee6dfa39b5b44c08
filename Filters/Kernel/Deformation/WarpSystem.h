// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpSystem.h
 * @brief The partition (4.8) of a matrix into points with given and with unknown values, and
 * solutions of (4.10) for many right-hand sides.
 * Internal: not installed.
 */
#ifndef tautline_WarpSystem_h
#define tautline_WarpSystem_h

#include "WarpControl.h"
#include "tautline/Elliptic/FiniteElements.h"
#include "tautline/Ranks/PointNumbering.h"
#include "tautline/Solvers/LinearSolver.h"

#include <deque>
#include <memory>

namespace tautline
{
class WarpParts;

/// The matrix of all points.
struct WarpMatrix
{
  WarpMatrix(const SparseMatrix& given) // NOLINT(google-explicit-constructor): implicit by design
    : matrix(given)
  {
  }
  const SparseMatrix& matrix;
  bool symmetric = true; ///< and positive semidefinite; otherwise diagonally dominant
  /// On several ranks: whether the matrix is the sum of the rank matrices. If not, the rows of
  /// owned points are used, which must be complete.
  bool shared = false;
};

/**
 * @class tautline::WarpSystem
 * @brief Keeps the matrix, its preconditioner or factorization, and previous solutions.
 *
 * A new solve starts from the projection of its right-hand side onto the previous ones (P. F.
 * Fischer, "Projection techniques for iterative solution of Ax = b with successive right-hand
 * sides", CMAME 163, 1998), and ends there if there is no remainder: a boundary that repeatedly
 * rotates, shifts or stretches as a whole needs only the first solves.
 */
class WarpSystem
{
public:
  /**
   * @param ranks that solve together; values are given and found at all local points
   * @param all the matrix of all points, read by the constructor only. If it is not symmetric, the
   * automatic solver is used.
   * @param block unknowns per point
   * @param held one flag per point: nonzero if its values are given
   * @param points 3 coordinates per point
   * @param dimension of the mesh, for the choice of the solver
   */
  WarpSystem(const WarpMatrix& all, int block, const std::vector<unsigned char>& held,
    const double* points, int dimension, const WarpOptions& options, const Ranks& ranks);

  /**
   * @brief Computes the values of free points from the values of held points; `values` has block x
   * numberOfPoints. Adds times and iterations to the control's result.
   * @return false if the solver failed: `values` are its last iterate, and failure() has the reason
   */
  bool solve(std::vector<double>& values, WarpControl& control);

  const std::string& failure() const { return this->Failure; }

private:
  struct Former
  {
    std::vector<double> right, solution; ///< A solution = right; right has length 1
  };

  std::vector<double> rightHandSide(const std::vector<double>& values) const;
  void addShares(std::vector<double>& vector) const;
  bool automatic() const { return this->Options.automaticSolver || !this->Symmetric; }
  double project(std::vector<double>& right, std::vector<double>& solution) const;
  void remember(const std::vector<double>& solution);
  bool runSolver(const std::vector<double>& right, double tolerance, std::vector<double>& solution,
    WarpControl& control);
  void makeSolver(KrylovMethod method, WarpControl& control);

  /// Data that an abandoned setup may still read.
  struct InnerSystem
  {
    SparseMatrix matrix;             ///< A_I
    std::vector<double> coordinates; ///< of the free points
  };

  double product(const std::vector<double>& a, const std::vector<double>& b) const;

  const WarpOptions& Options;
  Ranks TheRanks;
  std::unique_ptr<PointNumbering> Numbering; ///< of the free points of several ranks
  Index Unknowns = 0;                        ///< on all ranks
  int Block;
  bool Symmetric, Shared;
  std::vector<Index> Free; ///< points that are not held
  std::shared_ptr<InnerSystem> Inner = std::make_shared<InnerSystem>();
  std::vector<Index> Starts;  ///< of the rows of A_B
  std::vector<Index> Columns; ///< of A_B: unknowns of all points
  std::vector<double> Values;
  std::unique_ptr<LinearSolver> Solver;
  KrylovMethod Method = KrylovMethod::ConjugateGradient;
  Index DirectLimit = 0; ///< unknowns
  std::deque<Former> Basis;
  std::string Failure;
};

/// The outcome of solveComponents().
struct ComponentSolution
{
  bool converged = true;
  bool bounded = true; ///< no point moves much farther than the prescribed ones
  std::string failure; ///< of the first system that failed, or ""
};

/**
 * @brief Solves for the components of a motion, one after the other, and adds them to it at the
 * points that are not held. The ranks of the parts solve together.
 * @param systems each uses the result of the previous one; null systems are skipped
 * @param rest 3 per point: the displacements of the prescribed points, 0 elsewhere
 * @param nothing components that nowhere exceed this are treated as 0
 * @param moved 3 per point; if the control stops, not all components are added
 */
ComponentSolution solveComponents(const std::vector<WarpSystem*>& systems, const WarpParts& parts,
  const std::vector<double>& rest, double nothing, WarpControl& control,
  std::vector<double>& moved);
}
#endif
