// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpSystem.h
 * @brief The partition (4.8) of a matrix by points whose values are given and points whose values
 * are unknown, and solutions of (4.10) for many given values.
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
  WarpMatrix(const SparseMatrix& given) // NOLINT(google-explicit-constructor): a matrix as it is
    : matrix(given)
  {
  }
  const SparseMatrix& matrix;
  bool symmetric = true; ///< and positive semidefinite; else diagonally dominant
  /// On several ranks: the matrix is the sum of those of all of them. Else the rows of own points
  /// count, which are whole.
  bool shared = false;
};

/**
 * @class tautline::WarpSystem
 * @brief Keeps the matrix, its preconditioner or factorization, and former solutions.
 *
 * A new solve starts from the projection of its right-hand side on the former ones (P. F. Fischer,
 * "Projection techniques for iterative solution of Ax = b with successive right-hand sides", CMAME
 * 163, 1998), and ends there where nothing is left: a boundary that turns, shifts or stretches as a
 * whole needs no solve once it has done so.
 */
class WarpSystem
{
public:
  /**
   * @param ranks that solve together; values are given and found at all local points
   * @param all the matrix of all points, read here only. Where it is not symmetric the automatic
   * solver is taken.
   * @param block unknowns per point
   * @param held one flag per point: its values are given
   * @param points 3 coordinates per point
   * @param dimension of the mesh, for the choice of the solver
   */
  WarpSystem(const WarpMatrix& all, int block, const std::vector<unsigned char>& held,
    const double* points, int dimension, const WarpOptions& options, const Ranks& ranks);

  /**
   * @brief Finds the values of the points that are not held from those that are; `values` has block
   * x numberOfPoints. Adds times and iterations to the control's result.
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

  /// What a set-up that was given up may still read.
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

/// What became of solveComponents().
struct ComponentSolution
{
  bool converged = true;
  bool bounded = true; ///< no point moves much farther than the prescribed ones
  std::string failure; ///< of the first system that failed, or ""
};

/**
 * @brief Solves for the components of a motion, one after the other, and adds them to it at the
 * points that are not held. The ranks of the parts solve together.
 * @param systems each takes what the one before has found; null ones are left out
 * @param rest 3 per point: what the prescribed points move by, 0 elsewhere
 * @param nothing components that are nowhere larger are 0
 * @param moved 3 per point; where the control stops, not all components are added
 */
ComponentSolution solveComponents(const std::vector<WarpSystem*>& systems, const WarpParts& parts,
  const std::vector<double>& rest, double nothing, WarpControl& control,
  std::vector<double>& moved);
}
#endif
