// SPDX-License-Identifier: BSD-3-Clause
#include "vtkEllipticSolver.h"

#include "ContentStamp.h"
#include "EllipticInput.h"
#include "EllipticOutput.h"
#include "PointFunction.h"
#include "ProcessGroup.h"
#include "Sections.h"
#include "TableRows.h"

#include "tautline/Elliptic/ErrorNorms.h"
#include "tautline/Elliptic/TimeStepping.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>

vtkStandardNewMacro(vtkEllipticSolver);

namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

constexpr int SolutionPort = 0, HistoryPort = 1, SectionsPort = 2, SolverPorts = 3;
constexpr int NumberOfInputs = 2;
constexpr int InitialArray = 5, VelocityArray = 6;
constexpr double ReportInterval = 0.05; // of progress, in seconds

/// The progress of a Krylov method, by the number of digits gained.
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

/// @param time the time shown @param outside the number of points in no element
std::string summaryOf(const tautline::TimeSeries& series, double time, int steps, double step,
  const tautline::EllipticSystem& system, tautline::Index outside)
{
  std::ostringstream text;
  text << series.times.size() - 1 << " of " << steps << " time steps of " << step << "; time "
       << time << " is shown. " << tautline::sentence(tautline::describe(series.reason)) << "\n"
       << system.unknowns() << " unknowns, " << series.iterations << " iterations in all.";
  text.precision(3);
  text << "\nSeconds: assembly " << system.assembleSeconds() << ", set-up " << series.setupSeconds
       << ", solve " << series.solveSeconds << ".";
  if (outside > 0)
  {
    text << "\n" << outside << " points are in no element; their solution is 0.";
  }
  return text.str();
}
}

//------------------------------------------------------------------------------
vtkEllipticSolver::vtkEllipticSolver()
{
  this->SetNumberOfOutputPorts(SolverPorts);
}

//------------------------------------------------------------------------------
vtkEllipticSolver::~vtkEllipticSolver() = default;

//------------------------------------------------------------------------------
vtkTable* vtkEllipticSolver::GetHistory()
{
  return this->GetOutputTable(HistoryPort);
}

//------------------------------------------------------------------------------
vtkPolyData* vtkEllipticSolver::GetSections()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(SectionsPort));
}

//------------------------------------------------------------------------------
int vtkEllipticSolver::FillOutputPortInformation(int port, vtkInformation* info)
{
  this->Superclass::FillOutputPortInformation(port, info);
  if (port == SectionsPort)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkEllipticSolver::Reset()
{
  this->Converged = true;
  this->Reason.clear();
  this->Iterations = 0;
  this->ComputedTimeSteps = this->TimeScheme == STATIONARY ? 0 : this->NumberOfTimeSteps;
  this->SetupSeconds = this->SolveSeconds = 0.0;
  this->SolutionError = this->GradientError = 0.0;
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
std::vector<double> vtkEllipticSolver::Times() const
{
  std::vector<double> times;
  for (int i = 0; i <= this->NumberOfTimeSteps; ++i)
  {
    times.push_back(i * this->TimeStep);
  }
  return times;
}

//------------------------------------------------------------------------------
int vtkEllipticSolver::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const bool usable = std::isfinite(this->TimeStep) && this->TimeStep > 0;
  const bool ours = this->TimeScheme != STATIONARY && usable;
  const bool theirs = inputVector[SolutionPort]->GetNumberOfInformationObjects() > 0 &&
    inputVector[SolutionPort]->GetInformationObject(0)->Has(Pipeline::TIME_STEPS());
  for (int port = 0; port < SolverPorts; ++port)
  {
    vtkInformation* info = outputVector->GetInformationObject(port);
    if (!ours)
    {
      if (!theirs) // left by an earlier scheme
      {
        info->Remove(Pipeline::TIME_STEPS());
        info->Remove(Pipeline::TIME_RANGE());
      }
      continue;
    }
    const std::vector<double> times = this->Times();
    const double range[2] = { times.front(), times.back() };
    info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkEllipticSolver::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // The requested time belongs to the equation and has no meaning upstream.
  for (int port = 0; this->TimeScheme != STATIONARY && port < NumberOfInputs; ++port)
  {
    for (int i = 0; i < inputVector[port]->GetNumberOfInformationObjects(); ++i)
    {
      inputVector[port]->GetInformationObject(i)->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkEllipticSolver::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (!this->SolveOrShow(request, inputVector, outputVector))
  {
    return 0;
  }
  if (!this->ComputeSections)
  {
    return 1;
  }
  return this->Attempt(outputVector, "switch Sections off",
    [&]
    {
      const auto processes = tautline::makeProcessGroup();
      tautline::cutVolumes(vtkDataObject::GetData(outputVector, SolutionPort), *processes,
        vtkPolyData::GetData(outputVector, SectionsPort));
    });
}

//------------------------------------------------------------------------------
int vtkEllipticSolver::SolveOrShow(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (this->TimeScheme == STATIONARY)
  {
    this->Series.clear();
    return this->Superclass::RequestData(request, inputVector, outputVector);
  }
  std::vector<vtkDataObject*> data;
  for (int port = 0; port < NumberOfInputs; ++port)
  {
    data.push_back(vtkDataObject::GetData(inputVector[port]));
  }
  tautline::ContentStamp inputs = tautline::contentStamp(data);
  const bool same = this->SeriesTime.GetMTime() > this->GetMTime() && inputs == this->SeriesInputs;
  this->SeriesInputs = std::move(inputs);
  // A process whose piece has not changed solves again with the others.
  if (!tautline::makeProcessGroup()->everywhere(same))
  {
    this->Series.clear();
    this->ForgetSystems();
  }
  vtkInformation* info = outputVector->GetInformationObject(SolutionPort);
  this->RequestedTime = info->Has(Pipeline::UPDATE_TIME_STEP())
    ? info->Get(Pipeline::UPDATE_TIME_STEP())
    : this->NumberOfTimeSteps * this->TimeStep;
  const int succeeded = this->Superclass::RequestData(request, inputVector, outputVector);
  if (!succeeded)
  {
    this->Series.clear();
    this->ForgetSystems();
    return 0;
  }
  this->SeriesTime.Modified();
  vtkDataObject::GetData(outputVector, SolutionPort)
    ->GetInformation()
    ->Set(vtkDataObject::DATA_TIME_STEP(), this->RequestedTime);
  return 1;
}

//------------------------------------------------------------------------------
std::vector<double> vtkEllipticSolver::StartValues(const tautline::PointFunction& function,
  const tautline::EllipticInput& input, tautline::LocalMesh& mesh)
{
  const int components = this->Equation == ELASTICITY ? 3 : 1;
  return input.unknownsOf(tautline::valuesAt(function, this, mesh.input, components));
}

//------------------------------------------------------------------------------
void vtkEllipticSolver::ComputeSteps(const tautline::EllipticInput& input,
  tautline::LocalMesh& mesh, tautline::RankGroup& processes, tautline::TableRows& table)
{
  const tautline::EllipticSystem& system = input.system();
  if (this->Series.size() <= static_cast<std::size_t>(mesh.number))
  {
    this->Series.resize(mesh.number + 1);
  }
  std::shared_ptr<tautline::TimeSeries>& series = this->Series[mesh.number];
  if (!series)
  {
    const auto function = [&](const char* what, int kind, double value, const double* vector,
                            int array, const std::string& expression)
    {
      const tautline::Vec3 constant = this->Equation == ELASTICITY
        ? tautline::Vec3{ vector[0], vector[1], vector[2] }
        : tautline::Vec3{ value, 0, 0 };
      return tautline::PointFunction{ what, kind, constant, array, expression };
    };
    const std::vector<double> start =
      this->StartValues(function("initial solution", this->InitialType, this->InitialValue,
                          this->InitialDisplacement, InitialArray, this->InitialExpression),
        input, mesh);
    const std::vector<double> velocity = this->TimeScheme == NEWMARK
      ? this->StartValues(function("initial velocity", this->VelocityType, this->VelocityValue,
                            this->VelocityVector, VelocityArray, this->VelocityExpression),
          input, mesh)
      : std::vector<double>();
    tautline::TimeOptions time;
    time.scheme = static_cast<tautline::TimeScheme>(this->TimeScheme);
    time.step = this->TimeStep;
    time.steps = this->NumberOfTimeSteps;
    time.mass = static_cast<tautline::MassMatrix>(this->MassMatrix);
    time.density = this->Density;
    time.rigidBodyModes = this->RigidBodyModes;
    tautline::requireSeriesMemory(system, time);
    processes.agree(); // before PETSc communicates
    tautline::SolverOptions options = this->GetSolverOptions();
    options.observer = [&](int step, double)
    { return this->Report(mesh, static_cast<double>(step) / this->NumberOfTimeSteps); };
    options.cancelled = this->Cancelled();
    series = std::make_shared<tautline::TimeSeries>(
      tautline::integrate(system, time, start, velocity, options));
  }

  // The last step at or before the requested time.
  const double slack = 1e-9 * this->TimeStep;
  const auto after =
    std::upper_bound(series->times.begin(), series->times.end(), this->RequestedTime + slack);
  const std::ptrdiff_t shown = std::max<std::ptrdiff_t>(after - series->times.begin() - 1, 0);
  const tautline::Index outside =
    this->AddSolution(input.fields(series->values[shown]), mesh.output);
  for (std::size_t i = 0; i < series->solves.size(); ++i)
  {
    table.begin(mesh.name);
    table.add("Time", static_cast<double>(i + 1) * this->TimeStep);
    table.add("N iterations", series->solves[i].iterations);
    table.add("N residual", std::isfinite(series->residuals[i]) ? series->residuals[i] : 0.0);
  }

  const std::size_t steps = series->times.size() - 1;
  const bool complete = steps == static_cast<std::size_t>(this->NumberOfTimeSteps);
  this->Converged = this->Converged && complete;
  this->ComputedTimeSteps = std::min(this->ComputedTimeSteps, static_cast<int>(steps));
  this->Reason = tautline::sentence(tautline::describe(series->reason));
  this->Iterations += series->iterations;
  this->SetupSeconds += series->setupSeconds;
  this->SolveSeconds += series->solveSeconds;
  this->Describe(mesh,
    summaryOf(
      *series, series->times[shown], this->NumberOfTimeSteps, this->TimeStep, system, outside));
  if (!complete)
  {
    this->Warn();
  }
}

//------------------------------------------------------------------------------
void vtkEllipticSolver::Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
  tautline::RankGroup& processes, tautline::TableRows& table)
{
  if (this->TimeScheme != STATIONARY)
  {
    if (!this->ExactSolution.empty())
    {
      throw tautline::Error("An exact solution can be compared only with a stationary solution: "
                            "choose no time scheme, or leave the exact solution empty.");
    }
    this->ComputeSteps(input, mesh, processes, table);
    return;
  }
  const tautline::EllipticSystem& system = input.system();
  tautline::SolverOptions options = this->GetSolverOptions();
  double first = 0.0;
  options.observer = [&](int iteration, double residual)
  {
    constexpr double setup = 0.4; // fraction for the preconditioner, which takes about as long
    first = iteration == 0 ? residual : first;
    const double solved = fractionOf(first, residual, this->RelativeTolerance);
    return this->Report(mesh, setup + (1.0 - setup) * solved);
  };
  options.observerSeconds = ReportInterval;
  options.cancelled = this->Cancelled();

  tautline::LinearSystem linear = system.linearSystem();
  linear.coordinates = this->RigidBodyModes ? linear.coordinates : nullptr;
  tautline::LinearSolver solver(linear, options);
  std::vector<double> x(system.freePoints().size() * system.blockSize(), 0.0);
  const tautline::LinearSolution solved = solver.solve(system.rightHandSide().data(), x.data());
  const tautline::Index outside = this->AddSolution(input.fields(x), mesh.output);
  tautline::addResiduals(table, solved.residuals, mesh.name);
  if (!this->ExactSolution.empty())
  {
    this->Compare(system, x, processes);
  }

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
void vtkEllipticSolver::Compare(const tautline::EllipticSystem& system,
  const std::vector<double>& unknowns, tautline::RankGroup& processes)
{
  // The smallest step for which rounding errors stay below the errors of the differences.
  constexpr double relativeStep = 1e-5;
  const tautline::EllipticSolution solution = system.fields(unknowns);
  const double size = processes.maximum(tautline::diagonalOf(system.mesh().view()));
  tautline::PlaceFunction exact(
    this->ExactSolution, "exact solution", solution.components, relativeStep * size);
  // A local error must not keep a process from the collective sums.
  std::exception_ptr failure;
  const std::array<double, 2> norms = tautline::errorNorms(system, solution,
    [&](const tautline::Vec3& place, double* value, double* gradient)
    {
      try
      {
        if (!failure)
        {
          exact.evaluate(place, value, gradient);
        }
      }
      catch (...)
      {
        failure = std::current_exception();
      }
    });
  if (failure)
  {
    std::rethrow_exception(failure);
  }
  this->SolutionError = std::hypot(this->SolutionError, norms[0]);
  this->GradientError = std::hypot(this->GradientError, norms[1]);
  std::ostringstream text;
  text << "Errors in L2: " << norms[0] << " of the solution, " << norms[1] << " of its gradient.";
  this->AddToSummary(text.str());
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
  os << indent << "TimeScheme: " << this->TimeScheme << "\n";
  os << indent << "TimeStep: " << this->TimeStep << "\n";
  os << indent << "NumberOfTimeSteps: " << this->NumberOfTimeSteps << "\n";
  os << indent << "MassMatrix: " << this->MassMatrix << "\n";
  os << indent << "Density: " << this->Density << "\n";
  os << indent << "InitialType: " << this->InitialType << "\n";
  os << indent << "VelocityType: " << this->VelocityType << "\n";
  os << indent << "SolutionName: " << this->SolutionName << "\n";
  os << indent << "ComputeGradient: " << this->ComputeGradient << "\n";
  os << indent << "ExactSolution: " << this->ExactSolution << "\n";
  os << indent << "ComputeSections: " << this->ComputeSections << "\n";
}
