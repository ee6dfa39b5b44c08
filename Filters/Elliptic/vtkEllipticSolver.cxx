#include "vtkEllipticSolver.h"

#include "EllipticInput.h"
#include "EllipticOutput.h"
#include "TableRows.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkTable.h"

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkEllipticSolver);

namespace
{
constexpr int HistoryPort = 1;
constexpr double ReportInterval = 0.05; // of progress, in seconds

/// How far a Krylov method is, by the digits it has gained.
double fractionOf(double first, double residual, double tolerance)
{
  if (!(first > 0 && residual > 0 && tolerance > 0 && tolerance < 1))
  {
    return 0.0;
  }
  return std::clamp(std::log(residual / first) / std::log(tolerance), 0.0, 1.0);
}

/// @param outside the number of points in no element
std::string summaryOf(const tautline::LinearSolution& solved,
  const tautline::SolverOptions& options, const tautline::EllipticSystem& system,
  tautline::Index outside)
{
  std::ostringstream text;
  text << tautline::sentence(tautline::describe(solved.reason))
       << (solved.message.empty() ? "" : " ") << tautline::sentence(solved.message) << "\n"
       << system.unknowns() << " unknowns, ";
  if (options.method == tautline::KrylovMethod::Direct)
  {
    text << "a direct solve";
  }
  else
  {
    text << solved.iterations << " iterations of " << tautline::nameOf(options.method) << " with "
         << tautline::nameOf(options.preconditioner);
  }
  text.precision(3);
  text << ".\nSeconds: assembly " << system.assembleSeconds() << ", set-up " << solved.setupSeconds
       << ", solve " << solved.solveSeconds << ".";
  if (outside > 0)
  {
    text << "\n" << outside << " points are in no element; their solution is 0.";
  }
  return text.str();
}
}

//------------------------------------------------------------------------------
vtkEllipticSolver::vtkEllipticSolver() = default;

//------------------------------------------------------------------------------
vtkEllipticSolver::~vtkEllipticSolver() = default;

//------------------------------------------------------------------------------
vtkTable* vtkEllipticSolver::GetHistory()
{
  return this->GetOutputTable(HistoryPort);
}

//------------------------------------------------------------------------------
void vtkEllipticSolver::Reset()
{
  this->Converged = true;
  this->Reason.clear();
  this->Iterations = 0;
  this->SetupSeconds = this->SolveSeconds = 0.0;
}

//------------------------------------------------------------------------------
tautline::SolverOptions vtkEllipticSolver::GetSolverOptions() const
{
  tautline::SolverOptions options;
  options.method = static_cast<tautline::KrylovMethod>(this->Solver);
  options.preconditioner = static_cast<tautline::Preconditioner>(this->Preconditioner);
  this->SetCommonOptions(options);
  options.maximumSeconds = this->GetRemainingSeconds();
  if (this->FastMultigrid && this->Preconditioner == AMG && this->Solver != DIRECT &&
    this->PETScOptions.find("-pc_") == std::string::npos)
  {
    options.defaultPetscOptions = tautline::fastMultigridOptions();
  }
  return options;
}

//------------------------------------------------------------------------------
void vtkEllipticSolver::Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
  const tautline::Processes&, tautline::TableRows& table)
{
  const tautline::EllipticSystem& system = input.system();
  tautline::SolverOptions options = this->GetSolverOptions();
  double first = 0.0;
  options.observer = [&](int iteration, double residual)
  {
    first = iteration == 0 ? residual : first;
    return this->Report(mesh, fractionOf(first, residual, this->RelativeTolerance));
  };
  options.observerSeconds = ReportInterval;
  options.cancelled = this->Cancelled();

  tautline::LinearSystem linear = system.linearSystem();
  linear.coordinates = this->RigidBodyModes ? linear.coordinates : nullptr;
  tautline::LinearSolver solver(linear, options);
  std::vector<double> x(system.freePoints().size() * system.blockSize(), 0.0);
  const tautline::LinearSolution solved = solver.solve(system.rightHandSide().data(), x.data());
  const tautline::Index outside = this->AddSolution(system.fields(x), mesh.output);
  tautline::addResiduals(table, solved.residuals, mesh.name);

  const bool converged = tautline::converged(solved.reason);
  this->Converged = this->Converged && converged;
  this->Reason = tautline::sentence(tautline::describe(solved.reason));
  this->Iterations += solved.iterations;
  this->SetupSeconds += solved.setupSeconds;
  this->SolveSeconds += solved.solveSeconds;
  this->Describe(mesh, summaryOf(solved, options, system, outside));
  if (!converged)
  {
    this->Warn();
  }
}

//------------------------------------------------------------------------------
vtkIdType vtkEllipticSolver::AddSolution(
  const tautline::EllipticSolution& solution, vtkDataSet* output) const
{
  const bool elastic = this->Equation == ELASTICITY;
  const std::string name = !this->SolutionName.empty() ? this->SolutionName
    : elastic                                          ? "Displacement"
                                                       : "Solution";
  if (this->ComputeGradient && elastic)
  {
    tautline::addStress(output, solution.gradients);
  }
  else if (this->ComputeGradient)
  {
    tautline::addArray(output, true, "Gradient", solution.gradients, 3);
  }
  const tautline::Index outside =
    tautline::addArray(output, false, name, solution.values, solution.components);
  output->GetCellData()->SetActiveScalars(nullptr); // the solution is shown first
  return outside;
}

//------------------------------------------------------------------------------
void vtkEllipticSolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Solver: " << this->Solver << "\n";
  os << indent << "Preconditioner: " << this->Preconditioner << "\n";
  os << indent << "RigidBodyModes: " << this->RigidBodyModes << "\n";
  os << indent << "FastMultigrid: " << this->FastMultigrid << "\n";
  os << indent << "SolutionName: " << this->SolutionName << "\n";
  os << indent << "ComputeGradient: " << this->ComputeGradient << "\n";
}
