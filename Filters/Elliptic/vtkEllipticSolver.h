// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkEllipticSolver
 * @brief Solves an elliptic partial differential equation on a mesh, or a heat or wave equation.
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
 * @par Output port 2 `Sections`:
 * A vtkPolyData, filled if ComputeSections is on: sections of a volume mesh by three planes, normal
 * to the axes, in the middle of where it has large sections, with the data of the mesh. They show
 * the solution inside, of which the surface shows nothing where the whole boundary is fixed.
 *
 * With a TimeScheme other than STATIONARY the filter solves the heat equation rho u_t + L u = f or
 * the wave equation rho u_tt + L u = f, where L u = f is the stationary equation: NumberOfTimeSteps
 * of length TimeStep from the initial values, which are the time steps of the pipeline. f and the
 * given values do not depend on time. The output is that of the time requested, at first of the
 * last one; the table then has a row per step: `Time`, `N iterations` and `N residual`, the norm of
 * the last one. All steps are computed once and kept: 8 bytes per unknown and step.
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
#include "vtkTimeStamp.h"        // for SeriesTime

#include <memory> // for Series
#include <vector> // for Series

class vtkDataSet;
class vtkPolyData;

namespace tautline
{
class EllipticSystem;
struct EllipticSolution;
struct PointFunction;
struct TimeSeries;
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

  ///@{
  /**
   * The exact solution of a stationary problem, as an expression of x, y and z (ELASTICITY: a
   * vector), to compute SolutionError and GradientError; "" (the default): it is not known. Its
   * gradient is found by central differences. Computing the norms takes about 20 microseconds for
   * a triangle and 100 for a tetrahedron.
   */
  vtkSetMacro(ExactSolution, std::string);
  vtkGetMacro(ExactSolution, std::string);
  ///@}

  ///@{
  /// Whether the output Sections is filled. The default is off.
  vtkSetMacro(ComputeSections, bool);
  vtkGetMacro(ComputeSections, bool);
  vtkBooleanMacro(ComputeSections, bool);
  ///@}

  /// Numbers of the schemes; those of tautline::TimeScheme.
  enum TimeSchemes
  {
    STATIONARY = 0,
    BACKWARD_EULER = 1,
    BDF2 = 2,
    CRANK_NICOLSON = 3,
    NEWMARK = 4
  };
  ///@{
  /**
   * STATIONARY (the default): no time. Of the heat equation: BACKWARD_EULER (order 1), BDF2 (order
   * 2) and CRANK_NICOLSON (order 2, does not damp the finest oscillations). Of the wave equation:
   * NEWMARK, with constant average acceleration (order 2, keeps the energy).
   */
  vtkTautlineSetRangeMacro(TimeScheme, int, STATIONARY, NEWMARK);
  vtkGetMacro(TimeScheme, int);
  ///@}

  ///@{
  /// Length of the steps in time, above 0. The default is 0.01.
  vtkSetMacro(TimeStep, double);
  vtkGetMacro(TimeStep, double);
  ///@}

  ///@{
  /// Number of steps in time, 1 to 1,000,000. The default is 100.
  vtkTautlineSetRangeMacro(NumberOfTimeSteps, int, 1, 1000000);
  vtkGetMacro(NumberOfTimeSteps, int);
  ///@}

  /// Numbers of the mass matrices; those of tautline::MassMatrix.
  enum MassMatrices
  {
    CONSISTENT = 0,
    LUMPED = 1
  };
  ///@{
  /// The mass matrix: CONSISTENT (the default), or LUMPED, diagonal.
  vtkTautlineSetRangeMacro(MassMatrix, int, CONSISTENT, LUMPED);
  vtkGetMacro(MassMatrix, int);
  ///@}

  ///@{
  /// rho, the factor of the time derivative, above 0. The default is 1.
  vtkSetMacro(Density, double);
  vtkGetMacro(Density, double);
  ///@}

  ///@{
  /**
   * The solution at time 0: CONSTANT (the default), ARRAY (array 5) or EXPRESSION. Fixed points
   * have their given values from the start on.
   */
  vtkTautlineSetRangeMacro(InitialType, int, CONSTANT, EXPRESSION);
  vtkGetMacro(InitialType, int);
  vtkSetMacro(InitialValue, double);
  vtkGetMacro(InitialValue, double);
  vtkSetVector3Macro(InitialDisplacement, double);
  vtkGetVector3Macro(InitialDisplacement, double);
  vtkSetMacro(InitialExpression, std::string);
  vtkGetMacro(InitialExpression, std::string);
  ///@}

  ///@{
  /// The time derivative of the solution at time 0, of NEWMARK: as the initial solution; array 6.
  vtkTautlineSetRangeMacro(VelocityType, int, CONSTANT, EXPRESSION);
  vtkGetMacro(VelocityType, int);
  vtkSetMacro(VelocityValue, double);
  vtkGetMacro(VelocityValue, double);
  vtkSetVector3Macro(VelocityVector, double);
  vtkGetVector3Macro(VelocityVector, double);
  vtkSetMacro(VelocityExpression, std::string);
  vtkGetMacro(VelocityExpression, std::string);
  ///@}

  ///@{
  /// The outputs other than the mesh.
  vtkTable* GetHistory();
  vtkPolyData* GetSections();
  ///@}

  ///@{
  /// Of the last execution: whether all blocks converged and how the last one ended; iterations of
  /// all blocks together.
  bool GetConverged() const { return this->Converged; }
  const char* GetReason() const { return this->Reason.c_str(); }
  int GetIterations() const { return this->Iterations; }
  /// Time steps that were computed, of all blocks: fewer than asked for where one did not converge.
  int GetComputedTimeSteps() const { return this->ComputedTimeSteps; }
  ///@}

  ///@{
  /**
   * With ExactSolution, of all blocks together: the norm in L2 of the difference between the
   * solution and the exact one, and the norm in L2 of the difference of the gradients, the H1
   * seminorm of the error. Else 0.
   */
  double GetSolutionError() const { return this->SolutionError; }
  double GetGradientError() const { return this->GradientError; }
  ///@}

  ///@{
  /// Seconds of the set-up of the preconditioner and of the solve, of all blocks together.
  double GetSetupSeconds() const { return this->SetupSeconds; }
  double GetSolveSeconds() const { return this->SolveSeconds; }
  ///@}

protected:
  vtkEllipticSolver();
  ~vtkEllipticSolver() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void Reset() override;
  /// The time steps of one solution have one system.
  bool KeepsSystems() const override { return this->TimeScheme != STATIONARY; }
  void Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
    tautline::RankGroup& processes, tautline::TableRows& table) override;

private:
  vtkEllipticSolver(const vtkEllipticSolver&) = delete;
  void operator=(const vtkEllipticSolver&) = delete;

  tautline::SolverOptions GetSolverOptions() const;
  /// Solves a stationary problem, or shows a time step.
  int SolveOrShow(
    vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  /// Computes all time steps of a mesh, unless they are known, and shows the requested one.
  void ComputeSteps(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
    tautline::RankGroup& processes, tautline::TableRows& table);
  /// The unknowns at time 0, or their derivatives.
  std::vector<double> StartValues(const tautline::PointFunction& function,
    const tautline::EllipticInput& input, tautline::LocalMesh& mesh);
  /// The times of the steps.
  std::vector<double> Times() const;
  /// Adds the errors of a block to the totals. Collective.
  void Compare(const tautline::EllipticSystem& system, const std::vector<double>& unknowns,
    tautline::RankGroup& processes);
  /// Adds the arrays. @return the number of points in no element
  vtkIdType AddSolution(const tautline::EllipticSolution& solution, vtkDataSet* output) const;

  int Solver = CG;
  int Preconditioner = AMG;
  bool RigidBodyModes = true;
  bool FastMultigrid = true;
  std::string SolutionName;
  bool ComputeGradient = true;
  std::string ExactSolution;
  bool ComputeSections = false;
  int TimeScheme = STATIONARY;
  double TimeStep = 0.01;
  int NumberOfTimeSteps = 100;
  int MassMatrix = CONSISTENT;
  double Density = 1.0;
  int InitialType = CONSTANT;
  double InitialValue = 0.0;
  double InitialDisplacement[3] = { 0.0, 0.0, 0.0 };
  std::string InitialExpression;
  int VelocityType = CONSTANT;
  double VelocityValue = 0.0;
  double VelocityVector[3] = { 0.0, 0.0, 0.0 };
  std::string VelocityExpression;
  double RequestedTime = 0.0;
  std::vector<std::shared_ptr<tautline::TimeSeries>> Series; ///< by the number of the mesh
  vtkTimeStamp SeriesTime;                                   ///< of Series
  std::vector<vtkMTimeType> SeriesInputs;                    ///< their content, for Series
  bool Converged = false;
  std::string Reason;
  int Iterations = 0;
  int ComputedTimeSteps = 0;
  double SetupSeconds = 0.0;
  double SolveSeconds = 0.0;
  double SolutionError = 0.0;
  double GradientError = 0.0;
};

#endif
