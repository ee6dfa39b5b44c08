// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkKrylovAlgorithm
 * @brief Base class of filters that run Krylov methods; defines the stopping criteria.
 *
 * Abstract. See vtkEllipticAlgorithm for the boundary value problem.
 *
 * @sa vtkEllipticSolver, vtkSolverStudy, tautline/Solvers/SolverOptions.h
 */

#ifndef vtkKrylovAlgorithm_h
#define vtkKrylovAlgorithm_h

#include "TautlineEllipticModule.h" // for export macro
#include "vtkEllipticAlgorithm.h"

namespace tautline
{
struct SolverOptions;
}

class TAUTLINEELLIPTIC_EXPORT vtkKrylovAlgorithm : public vtkEllipticAlgorithm
{
public:
  vtkTypeMacro(vtkKrylovAlgorithm, vtkEllipticAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Tolerance of the preconditioned residual relative to the first, above 0 and below 1. The
  /// default is 1e-5, PETSc's.
  vtkSetMacro(RelativeTolerance, double);
  vtkGetMacro(RelativeTolerance, double);
  ///@}

  ///@{
  /// Residual norm that suffices in any case, at least 0. The default is 1e-50, PETSc's.
  vtkSetMacro(AbsoluteTolerance, double);
  vtkGetMacro(AbsoluteTolerance, double);
  ///@}

  ///@{
  /// Maximum number of iterations, at least 1. The default is 10000.
  vtkSetMacro(MaximumIterations, int);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /// The restart parameter m of GMRES(m), at least 1. The default is 30.
  vtkSetMacro(Restart, int);
  vtkGetMacro(Restart, int);
  ///@}

protected:
  vtkKrylovAlgorithm();
  ~vtkKrylovAlgorithm() override;

  /// Copies these properties, omega, PETSc's options and threads to the options of the kernel.
  void SetCommonOptions(tautline::SolverOptions& options) const;

  double RelativeTolerance = 1e-5;
  double AbsoluteTolerance = 1e-50;
  int MaximumIterations = 10000;
  int Restart = 30;

private:
  vtkKrylovAlgorithm(const vtkKrylovAlgorithm&) = delete;
  void operator=(const vtkKrylovAlgorithm&) = delete;
};

#endif
