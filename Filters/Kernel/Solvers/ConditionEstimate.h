/**
 * @file ConditionEstimate.h
 * @brief Extreme eigenvalues and 2-norm condition numbers of A and of P^-1 A, and the elements that cause them.
 */
#ifndef tautline_ConditionEstimate_h
#define tautline_ConditionEstimate_h

#include "EllipticProblem.h"

namespace tautline
{
/// How eigenvalues are found. The numbers are stable: ParaView state files hold them.
enum class SpectrumMethod : int
{
  Automatic = 0,  ///< Accurate
  RitzValues = 1, ///< of the Krylov solver (CG): cheap, from inside the spectrum, no error bound
  /// To a tolerance: SLEPc for A and D^-1 A (Krylov-Schur, shift-invert where a factorisation is affordable, else LOBPCG), the
  /// Lanczos method in the inner product of P for other P^-1 A.
  Accurate = 2
};

struct ConditionOptions
{
  SpectrumMethod method = SpectrumMethod::Automatic;
  /// None: the spectrum of A; else of P^-1 A.
  Preconditioner preconditioner = Preconditioner::None;
  double omega = 1.0; ///< of SSOR
  /// Relative, of each eigenvalue; multigrid takes ten times longer to 1e-6.
  double tolerance = 1e-4;
  int maximumIterations = 10000;
  /// 0: no limit; looked at between iterations, not in a factorisation.
  double maximumSeconds = 0.0;
  std::string petscOptions;
  std::function<bool(double)> progress; ///< told a fraction; stops when it returns false
};

struct ConditionEstimate
{
  double smallest = 0.0, largest = 0.0; ///< eigenvalues; 0 where not found
  /// Relative errors: bounds from residuals or, where eigenvalues crowd, an estimate from the last half of the iterations;
  /// infinity where nothing is known (Ritz values).
  double smallestError = 0.0, largestError = 0.0;
  double condition = 0.0; ///< largest / smallest; 0 where the smallest is not positive
  bool converged = false;
  std::string method;  ///< "Krylov-Schur, shift-invert (Cholesky)", ...
  std::string message; ///< what limits the accuracy, or why it failed; or ""
  int iterations =
    0; ///< steps of Lanczos, restarts of Krylov-Schur, iterations of CG or LOBPCG; of both ends
  double seconds = 0.0;
  /// Eigenvectors, this rank's unknowns; empty where not found (Ritz values, or no time).
  std::vector<double> smallestVector, largestVector;
};

/**
 * @brief Extreme eigenvalues of A or of P^-1 A, and their ratio. Collective over the ranks.
 *
 * Failures of PETSc or SLEPc, a matrix that is singular or not definite, a preconditioner that is not symmetric or not
 * definite, the time limit and an abort are messages, not exceptions; what was found is kept. Bad options throw Error, and so
 * does what LinearSolver refuses. Errors are those of the computed vectors: that no eigenvalue lies further out rests on the
 * start vector, which is random, and for a factorised A on its number of negative pivots.
 */
TAUTLINE_KERNEL_EXPORT ConditionEstimate estimateCondition(
  const LinearSystem& system, const ConditionOptions& options);
TAUTLINE_KERNEL_EXPORT ConditionEstimate estimateCondition(
  const EllipticSystem& system, const ConditionOptions& options);

/// What each element adds to the largest eigenvalue and to the condition number.
struct ElementContributions
{
  std::vector<double> largestEigenvalue; ///< of each cell's stiffness matrix; NaN for cells skipped
  /**
   * @brief x_e^T A_e x_e of the eigenvector of the largest eigenvalue, over the whole: the cell's share of it; sums to 1 over
   * the cells of all ranks. Empty if the eigenvector was not wanted.
   */
  std::vector<double> share;
  double bound = 0.0; ///< the largest eigenvalue is at most this: max over points of the cells' sum
  double lowerBound = 0; ///< and at least this: the largest of one element matrix's free part
};

TAUTLINE_KERNEL_EXPORT ElementContributions elementContributions(
  const EllipticSystem& system, bool shares, int threads = 0);
}
#endif
