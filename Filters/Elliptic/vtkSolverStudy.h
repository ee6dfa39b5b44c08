// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSolverStudy
 * @brief Solves an elliptic problem by many combinations of solver and preconditioner and
 * recommends one.
 *
 * The problem and the inputs are those of vtkEllipticAlgorithm. The combinations are the sixteen of
 * dissertation Table 2.5, by its numbers, and some beyond it.
 *
 * @par Output port 0 `Mesh`:
 * The input, as it is.
 *
 * @par Output port 1 `Study`:
 * A vtkTable with a row per combination (and block): `Combination`, its name; `N combination`, its
 * number; `Total time (s)`, set-up of the preconditioner and solve, 0 if it failed; `Result`, the
 * same as text, "*" if it failed as in the dissertation's tables, "-" if there was no time for it;
 * `Time set-up (s)`, `Time solve (s)`, `Time CPU (s)` of the process for both, `N iterations`,
 * `N condition` of P^-1 A (an estimate; 0: not known), `N true residual`, norm of b - A x over that
 * of b; `N converged`, 1 or 0; `Reason`; of composite data sets also `Block`. ParaView's bar chart
 * shows the total time.
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
   * Combinations to run, by number; none by default, which means 1 to 16, those of Table 2.5:
   * Jacobi, SSOR, ILU(0), BoomerAMG, each with CG, GMRES, MINRES, Bi-CGSTAB. 17 is a direct solver;
   * 18 CG with incomplete Cholesky; 19 to 22 smoothed aggregation (GAMG) with CG, GMRES, MINRES,
   * Bi-CGSTAB; 23 CG without preconditioner. In 19 to 22 multigrid gets the rigid body modes of an
   * elastic body, in 13 to 16 the matrix only; 24 is 13 with them, 25 is 19 without.
   */
  void AddCombination(int number);
  void ClearCombinations();
  ///@}
  static constexpr int GetNumberOfCombinations() { return 25; }
  /// The name of a combination by its number, "" for one that is not there.
  static const char* GetCombinationName(int number);

  ///@{
  /// Whether to estimate the condition of each P^-1 A. On.
  vtkSetMacro(EstimateConditions, bool);
  vtkGetMacro(EstimateConditions, bool);
  vtkBooleanMacro(EstimateConditions, bool);
  ///@}

  ///@{
  /// How often each is run, 1 to 100; the best time counts. The default is 1.
  vtkTautlineSetRangeMacro(Repetitions, int, 1, 100);
  vtkGetMacro(Repetitions, int);
  ///@}

  ///@{
  /// Seconds for each combination, with its set-up; 0 is no limit. The default is 60. TimeLimit is
  /// that of the whole study. The next combination waits for a set-up that was given up.
  vtkTautlineSetRangeMacro(CombinationTimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(CombinationTimeLimit, double);
  ///@}

  /// The output other than the mesh.
  vtkTable* GetStudy();

  ///@{
  /// The combination recommended for the last block, "" if none converged or the times of the
  /// fastest differ by less than their noise; and why.
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
