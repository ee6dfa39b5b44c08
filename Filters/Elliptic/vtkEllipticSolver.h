// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkEllipticSolver
 * @brief Solves an elliptic partial differential equation on a mesh, or a heat or wave equation.
 *
 * See vtkEllipticAlgorithm for the problem and the inputs. The linear system is solved by a Krylov
 * method with a preconditioner, dissertation sections 2.5 and 2.6, or directly.
 *
 * @par Output port 0 `Mesh`:
 * The input with the point array `Solution` (ELASTICITY: the vector `Displacement`), or the name in
 * SolutionName, and, if ComputeGradient is on, the cell arrays `Gradient` (3 components) or, for
 * ELASTICITY, `Stress` (6: XX YY ZZ XY YZ XZ) and `VonMises`. Points outside all elements get 0.
 *
 * @par Output port 1 `History`:
 * A vtkTable whose row i is iteration i (0 is the start): `Log10 residual`, relative to the first,
 * and `N residual`, its norm as measured by the method; of composite data sets also `Block`.
 *
 * @par Output port 2 `Sections`:
 * A vtkPolyData, filled if ComputeSections is on: sections of a volume mesh by three planes, normal
 * to the axes, in the middle of the range of large sections, with the data of the mesh. They show
 * the interior solution, which is not visible on the surface if the whole boundary is fixed.
 *
 * With a TimeScheme other than STATIONARY the filter solves the heat equation rho u_t + L u = f or
 * the wave equation rho u_tt + L u = f, where L u = f is the stationary equation: NumberOfTimeSteps
 * steps of length TimeStep from the initial values, which become the time steps of the pipeline. f
 * and the given values do not depend on time. The output is for the requested time, by default the
 * last one; the table then has a row per step: `Time`, `N iterations` and `N residual`, the norm of
 * the last one. All steps are computed once and kept: 8 bytes per unknown and step.
 *
 * A solve that does not converge causes a warning with the reason; the solution is then the best
 * one found. Whatever the method reports, it has converged only if the norm of b - A x is at most
 * 1000 times the tolerance (tautline::ResidualFactor).
 *
 * TimeLimit covers setups and factorizations: a setup that takes longer is abandoned, the solution
 * is 0, and the next solve waits until the abandoned work has ended in the background. In pvserver,
 * pvbatch and with several processes the limit is checked after a setup and between iterations.
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

  /// The methods; values as in tautline::KrylovMethod.
  enum Solvers
  {
    CG = 0,
    GMRES = 1,
    MINRES = 2,
    BICGSTAB = 3,
    DIRECT = 4
  };
  ///@{
  /// The solution method. The default is CG.
  vtkTautlineSetRangeMacro(Solver, int, CG, DIRECT);
  vtkGetMacro(Solver, int);
  ///@}

  /// The preconditioners; values as in tautline::Preconditioner.
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
   * aggregation, or none. With several processes, SSOR, ILU and incomplete Cholesky act on the
   * diagonal block of each process.
   */
  vtkTautlineSetRangeMacro(Preconditioner, int, JACOBI, NONE);
  vtkGetMacro(Preconditioner, int);
  ///@}

  ///@{
  /// Whether multigrid uses the rigid body modes of an elastic body, its near-null space. The
  /// default is on.
  vtkSetMacro(RigidBodyModes, bool);
  vtkGetMacro(RigidBodyModes, bool);
  vtkBooleanMacro(RigidBodyModes, bool);
  ///@}

  ///@{
  /**
   * Whether BoomerAMG coarsens aggressively and interpolates sparsely,
   * tautline::fastMultigridOptions(). This takes more iterations but much less time, especially in
   * volumes and on several processes. If off, PETSc's defaults apply, as in the dissertation. The
   * default is on.
   */
  vtkSetMacro(FastMultigrid, bool);
  vtkGetMacro(FastMultigrid, bool);
  vtkBooleanMacro(FastMultigrid, bool);
  ///@}

  ///@{
  /// Name of the solution; "" stands for `Solution`, or `Displacement` for ELASTICITY. The default
  /// is "".
  vtkSetMacro(SolutionName, std::string);
  vtkGetMacro(SolutionName, std::string);
  ///@}

  ///@{
  /// Whether to add the gradient or the stress. The default is on.
  vtkSetMacro(ComputeGradient, bool);
  vtkGetMacro(ComputeGradient, bool);
  vtkBooleanMacro(ComputeGradient, bool);
  ///@}

  ///@{
  /**
   * The exact solution of a stationary problem, as an expression of x, y and z (ELASTICITY: a
   * vector), to compute SolutionError and GradientError; "" (the default) if it is not known. Its
   * gradient is computed by central differences. Computing the norms takes about 20 microseconds
   * for a triangle and 100 for a tetrahedron.
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

  /// The schemes; values as in tautline::TimeScheme.
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
   * STATIONARY (the default): no time. For the heat equation: BACKWARD_EULER (order 1), BDF2 (order
   * 2) and CRANK_NICOLSON (order 2, does not damp the finest oscillations). For the wave equation:
   * NEWMARK, with constant average acceleration (order 2, conserves energy).
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

  /// The mass matrices; values as in tautline::MassMatrix.
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
  /// The density rho, the factor of the time derivative, above 0. The default is 1.
  vtkSetMacro(Density, double);
  vtkGetMacro(Density, double);
  ///@}

  ///@{
  /**
   * The solution at time 0: CONSTANT (the default), ARRAY (array 5) or EXPRESSION. Fixed points
   * have their given values from the start.
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
  /// The time derivative of the solution at time 0, for NEWMARK; defined like the initial solution,
  /// with array 6.
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
  /// In the last execution: whether all blocks converged, the reason why the last one ended, and
  /// the total number of iterations.
  bool GetConverged() const { return this->Converged; }
  const char* GetReason() const { return this->Reason.c_str(); }
  int GetIterations() const { return this->Iterations; }
  /// Number of computed time steps over all blocks: fewer than requested if one did not converge.
  int GetComputedTimeSteps() const { return this->ComputedTimeSteps; }
  ///@}

  ///@{
  /**
   * With ExactSolution, over all blocks: the L2 norm of the error of the solution, and the L2 norm
   * of the error of its gradient (the H1 seminorm of the error). Otherwise 0.
   */
  double GetSolutionError() const { return this->SolutionError; }
  double GetGradientError() const { return this->GradientError; }
  ///@}

  ///@{
  /// Time of the preconditioner setup and of the solve in seconds, over all blocks.
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
  /// The time steps of one solution share one system.
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
