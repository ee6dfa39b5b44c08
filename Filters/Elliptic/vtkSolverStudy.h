// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSolverStudy
 * @brief Solves an elliptic problem with many combinations of solver and preconditioner and
 * recommends one.
 *
 * See vtkEllipticAlgorithm for the problem and the inputs. The combinations are the sixteen of
 * dissertation Table 2.5, with the same numbers, and some more.
 *
 * @par Output port 0 `Mesh`:
 * The unchanged input.
 *
 * @par Output port 1 `Study`:
 * A vtkTable with a row per combination (and block): `Combination`, its name; `N combination`, its
 * number; `Total time (s)`, for the preconditioner setup and the solve, 0 if it failed; `Result`,
 * the same as text, "*" if it failed, as in the dissertation's tables, "-" if there was no time for
 * it; `Time set-up (s)`, `Time solve (s)`, `Time CPU (s)` of the process for both, `N iterations`,
 * `N condition` of P^-1 A (an estimate; 0: not known), `N true residual`, the norm of b - A x over
 * the norm of b; `N converged`, 1 or 0; `Reason`; of composite data sets also `Block`. ParaView's
 * bar chart shows the total time.
 *
 * @sa vtkEllipticSolver, vtkConditionEstimator, tautline/Elliptic/SolverStudy.h
 */

#ifndef vtkSolverStudy_h
#define vtkSolverStudy_h

#include "vtkKrylovAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

#include <vector> // for combinations

class TAUTLINEELLIPTIC_EXPORT vtkSolverStudy : public vtkKrylovAlgorithm
{
public:
  static vtkSolverStudy* New();
  vtkTypeMacro(vtkSolverStudy, vtkKrylovAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Combinations to run, by number; none by default, which means 1 to 16, as in Table 2.5: Jacobi,
   * SSOR, ILU(0), BoomerAMG, each with CG, GMRES, MINRES, Bi-CGSTAB. 17 is a direct solver; 18 CG
   * with incomplete Cholesky; 19 to 22 smoothed aggregation (GAMG) with CG, GMRES, MINRES,
   * Bi-CGSTAB; 23 CG without preconditioner. In 19 to 22 multigrid gets the rigid body modes of an
   * elastic body, in 13 to 16 only the matrix; 24 is 13 with the modes, 25 is 19 without them.
   */
  void AddCombination(int number);
  void ClearCombinations();
  ///@}
  static constexpr int GetNumberOfCombinations() { return 25; }
  /// The name of a combination by its number; "" for an unknown number.
  static const char* GetCombinationName(int number);

  ///@{
  /// Whether to estimate the condition number of each P^-1 A. The default is on.
  vtkSetMacro(EstimateConditions, bool);
  vtkGetMacro(EstimateConditions, bool);
  vtkBooleanMacro(EstimateConditions, bool);
  ///@}

  ///@{
  /// Number of runs of each combination, 1 to 100; the best time counts. The default is 1.
  vtkTautlineSetRangeMacro(Repetitions, int, 1, 100);
  vtkGetMacro(Repetitions, int);
  ///@}

  ///@{
  /// Time limit of each combination in seconds, including its setup; 0 means no limit. The default
  /// is 60. TimeLimit applies to the whole study. The next combination waits for an abandoned
  /// setup.
  vtkTautlineSetRangeMacro(CombinationTimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(CombinationTimeLimit, double);
  ///@}

  /// The table of output port 1, Study.
  vtkTable* GetStudy();

  ///@{
  /// The combination recommended for the last block, and the reason; "" if none converged or the
  /// fastest times differ by less than their noise.
  const char* GetRecommended() const { return this->Recommended.c_str(); }
  const char* GetWhy() const { return this->Why.c_str(); }
  ///@}

protected:
  vtkSolverStudy();
  ~vtkSolverStudy() override;

  void Reset() override;
  void Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
    tautline::RankGroup& processes, tautline::TableRows& table) override;

private:
  vtkSolverStudy(const vtkSolverStudy&) = delete;
  void operator=(const vtkSolverStudy&) = delete;

  std::vector<int> Combinations;
  bool EstimateConditions = true;
  int Repetitions = 1;
  double CombinationTimeLimit = 60.0;
  std::string Recommended;
  std::string Why;
};

#endif
