// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkConditionEstimator
 * @brief Estimates the condition number of the linear system of an elliptic problem on a mesh, and
 * finds the elements that cause it.
 *
 * See vtkEllipticAlgorithm for the problem and the inputs. The filter finds the extreme eigenvalues
 * of the matrix A of the free unknowns and, unless Preconditioner is NONE, of P^-1 A: the larger
 * the condition number of P^-1 A, the more iterations a Krylov method needs.
 *
 * @par Output port 0 `Mesh`:
 * The input with the cell arrays `LargestEigenvalue` of the stiffness matrix of each element;
 * `Excess`, the log10 of its ratio to the geometric mean of all elements (1: ten times); and, if
 * ComputeShares is on, `Share`: the fraction of the largest eigenvalue of A that is due to the
 * element, x_e^T A_e x_e of the eigenvector x over the sum of all elements. Shares add up to 1;
 * often a few elements have most of it. `Share` is missing if the time limit was reached. All
 * arrays are 0 for cells that do not take part in the solution.
 *
 * @par Output port 1 `Spectrum`:
 * A vtkTable with a row for A and one for P^-1 A (per block): `Matrix`, `Smallest`, `Largest`,
 * `Condition` (0: not positive definite, or not found), `SmallestError`, `LargestError` (relative
 * bounds; -1: not known), `Converged`, `Iterations`, `Seconds`, `Method`, `Message`; of composite
 * data sets also `Block`.
 *
 * @sa vtkSolverStudy, vtkEllipticSolver, tautline/Solvers/ConditionEstimate.h
 */

#ifndef vtkConditionEstimator_h
#define vtkConditionEstimator_h

#include "vtkEllipticAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

class TAUTLINEELLIPTIC_EXPORT vtkConditionEstimator : public vtkEllipticAlgorithm
{
public:
  static vtkConditionEstimator* New();
  vtkTypeMacro(vtkConditionEstimator, vtkEllipticAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The methods; values as in tautline::SpectrumMethod.
  enum Methods
  {
    AUTOMATIC = 0,
    RITZ_VALUES = 1,
    ACCURATE = 2
  };
  ///@{
  /// RITZ_VALUES: from a Krylov method; fast, without error bounds. ACCURATE: to Tolerance.
  /// AUTOMATIC, the default, is ACCURATE.
  vtkTautlineSetRangeMacro(Method, int, AUTOMATIC, ACCURATE);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /// The preconditioner P, see vtkEllipticSolver::Preconditioners. The default is BoomerAMG (3);
  /// with 6 (none), P^-1 A is left out.
  vtkTautlineSetRangeMacro(Preconditioner, int, 0, 6);
  vtkGetMacro(Preconditioner, int);
  ///@}

  ///@{
  /// The relative tolerance of the eigenvalues, above 0 and below 1. The default is 1e-6.
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// The maximum number of iterations, at least 1. The default is 10000.
  vtkSetMacro(MaximumIterations, int);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /// Whether to find the share of each element. The default is on.
  vtkSetMacro(ComputeShares, bool);
  vtkGetMacro(ComputeShares, bool);
  vtkBooleanMacro(ComputeShares, bool);
  ///@}

  /// The table of output port 1, Spectrum.
  vtkTable* GetSpectrum();

  ///@{
  /// Condition numbers of A and of P^-1 A in the last execution (for blocks, the largest); 0: not
  /// known.
  double GetCondition() const { return this->Condition; }
  double GetPreconditionedCondition() const { return this->PreconditionedCondition; }
  ///@}

protected:
  vtkConditionEstimator();
  ~vtkConditionEstimator() override;

  void Reset() override;
  void Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
    tautline::RankGroup& processes, tautline::TableRows& table) override;

private:
  vtkConditionEstimator(const vtkConditionEstimator&) = delete;
  void operator=(const vtkConditionEstimator&) = delete;

  double Estimate(const tautline::EllipticInput& input, int preconditioner,
    const tautline::LocalMesh& mesh, tautline::TableRows& table, std::string& text);

  int Method = AUTOMATIC;
  int Preconditioner = 3;
  double Tolerance = 1e-6;
  int MaximumIterations = 10000;
  bool ComputeShares = true;
  double Condition = 0.0;
  double PreconditionedCondition = 0.0;
};

#endif
