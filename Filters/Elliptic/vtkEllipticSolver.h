/**
 * @class vtkEllipticSolver
 * @brief Solves an elliptic partial differential equation on a mesh.
 *
 * The problem and the inputs are those of vtkEllipticAlgorithm. The linear system is solved by a
 * Krylov method with a preconditioner, dissertation sections 2.5 and 2.6, or directly.
 *
 * @par Output port 0 `Mesh`:
 * The input with the point array `Solution` (ELASTICITY: the vector `Displacement`), or of the name
 * SolutionName, and, if ComputeGradient is on, the cell arrays `Gradient` (3 components) or, of
 * ELASTICITY, `Stress` (6: XX YY ZZ XY YZ XZ) and `VonMises`. Points outside all elements get 0.
 *
 * @par Output port 1 `History`:
 * A vtkTable whose row i is iteration i (0 is the start): `Log10 residual`, relative to the first,
 * and `N residual`, its norm as the method measures it; of composite data sets also `Block`.
 *
 * A solve that does not converge is a warning with its reason; the solution is then the best there
 * was. Whatever the method reports, it has converged only if norm of b - A x is at most 1000 times
 * the tolerance (tautline::ResidualFactor).
 *
 * TimeLimit covers set-ups and factorizations: one that takes longer is given up, the solution is
 * 0, and the next solve waits until the abandoned work has ended in the background. In pvserver,
 * pvbatch and with several processes the limit is checked after a set-up and between iterations.
 *
 *     vtkNew<vtkEllipticSolver> solver;
 *     solver->SetInputData(mesh);
 *     solver->SetEquation(vtkEllipticAlgorithm::ELASTICITY);
 *     solver->Update();
 *
 * @sa vtkSolverStudy, vtkConditionEstimator
 */

#ifndef vtkEllipticSolver_h
#define vtkEllipticSolver_h

#include "vtkKrylovAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

class vtkDataSet;

namespace tautline
{
struct EllipticSolution;
}

class TAUTLINEELLIPTIC_EXPORT vtkEllipticSolver : public vtkKrylovAlgorithm
{
public:
  static vtkEllipticSolver* New();
  vtkTypeMacro(vtkEllipticSolver, vtkKrylovAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Numbers of the methods; those of tautline::KrylovMethod.
  enum Solvers
  {
    CG = 0,
    GMRES = 1,
    MINRES = 2,
    BICGSTAB = 3,
    DIRECT = 4
  };
  ///@{
  /// The method. The default is CG.
  vtkTautlineSetRangeMacro(Solver, int, CG, DIRECT);
  vtkGetMacro(Solver, int);
  ///@}

  /// Numbers of the preconditioners; those of tautline::Preconditioner.
  enum Preconditioners
  {
    JACOBI = 0,
    SSOR = 1,
    ILU = 2,
    AMG = 3,
    ICC = 4,
    GAMG = 5,
    NONE = 6
  };
  ///@{
  /**
   * Jacobi, SSOR with Omega, ILU(0), BoomerAMG (the default), incomplete Cholesky, smoothed
   * aggregation, or none. With several processes SSOR, ILU and incomplete Cholesky work in the
   * block of each process.
   */
  vtkTautlineSetRangeMacro(Preconditioner, int, JACOBI, NONE);
  vtkGetMacro(Preconditioner, int);
  ///@}

  ///@{
  /// Whether multigrid gets the rigid body modes of an elastic body, its near-null space. On.
  vtkSetMacro(RigidBodyModes, bool);
  vtkGetMacro(RigidBodyModes, bool);
  vtkBooleanMacro(RigidBodyModes, bool);
  ///@}

  ///@{
  /**
   * Whether BoomerAMG coarsens aggressively and interpolates sparsely,
   * tautline::fastMultigridOptions(). It takes more iterations and much less time, above all in
   * volumes and on several processes. Off: PETSc's defaults, those of the dissertation. On.
   */
  vtkSetMacro(FastMultigrid, bool);
  vtkGetMacro(FastMultigrid, bool);
  vtkBooleanMacro(FastMultigrid, bool);
  ///@}

  ///@{
  /// Name of the solution; "" is `Solution`, or `Displacement` of ELASTICITY. The default is "".
  vtkSetMacro(SolutionName, std::string);
  vtkGetMacro(SolutionName, std::string);
  ///@}

  ///@{
  /// Whether to add gradient or stress. On.
  vtkSetMacro(ComputeGradient, bool);
  vtkGetMacro(ComputeGradient, bool);
  vtkBooleanMacro(ComputeGradient, bool);
  ///@}

  /// The output other than the mesh.
  vtkTable* GetHistory();

  ///@{
  /**
   * The result of the last execution: whether all blocks converged and how the last one ended;
   * iterations, seconds of set-up of the preconditioner and of the solve, of all blocks together.
   */
  bool GetConverged() const { return this->Converged; }
  const char* GetReason() const { return this->Reason.c_str(); }
  int GetIterations() const { return this->Iterations; }
  double GetSetupSeconds() const { return this->SetupSeconds; }
  double GetSolveSeconds() const { return this->SolveSeconds; }
  ///@}

protected:
  vtkEllipticSolver();
  ~vtkEllipticSolver() override;

  void Reset() override;
  void Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
    const tautline::Processes& processes, tautline::TableRows& table) override;

private:
  vtkEllipticSolver(const vtkEllipticSolver&) = delete;
  void operator=(const vtkEllipticSolver&) = delete;

  tautline::SolverOptions GetSolverOptions() const;
  /// Adds the arrays. @return the number of points in no element
  vtkIdType AddSolution(const tautline::EllipticSolution& solution, vtkDataSet* output) const;

  int Solver = CG;
  int Preconditioner = AMG;
  bool RigidBodyModes = true;
  bool FastMultigrid = true;
  std::string SolutionName;
  bool ComputeGradient = true;
  bool Converged = false;
  std::string Reason;
  int Iterations = 0;
  double SetupSeconds = 0.0;
  double SolveSeconds = 0.0;
};

#endif
