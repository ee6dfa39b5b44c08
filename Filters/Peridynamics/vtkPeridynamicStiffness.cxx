// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPeridynamicStiffness.h"

#include "GatheredExecution.h"
#include "HorizonInput.h"
#include "PeridynamicOutput.h"
#include "PointMerge.h"
#include "ProcessGroup.h"

#include "tautline/Peridynamics/PeridynamicSolve.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkPeridynamicStiffness);

namespace
{
enum Ports
{
  MeshPort,
  SpectrumPort,
  SparsityPort,
  NumberOfPorts
};

enum Arrays
{
  RegionArray = 0,
  SourceArray = 1,
  GivenArray = 2,
  GivenPointArray = 3
};
constexpr const char* DefaultRegion = "Reference";

// Fractions of the progress: after the matrix, and after its eigenvalues.
constexpr double AssemblyShare = 0.7, SpectrumShare = 0.9;
constexpr double MebiByte = 1048576.0;
constexpr double SolverTolerance = 1e-10; // relative residual of the solution
}

//------------------------------------------------------------------------------
vtkPeridynamicStiffness::~vtkPeridynamicStiffness() = default;

vtkPeridynamicStiffness::vtkPeridynamicStiffness()
{
  this->SetNumberOfOutputPorts(NumberOfPorts);
  this->SetInputArrayToProcess(
    RegionArray, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, DefaultRegion);
}

//------------------------------------------------------------------------------
vtkDataSet* vtkPeridynamicStiffness::GetOutput()
{
  return vtkDataSet::SafeDownCast(this->GetOutputDataObject(MeshPort));
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::AddKernelValue(double value)
{
  this->KernelValues.push_back(value);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::ClearKernelValues()
{
  this->KernelValues.clear();
  this->Modified();
}

//------------------------------------------------------------------------------
int vtkPeridynamicStiffness::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(),
    port == MeshPort         ? "vtkDataSet"
      : port == SpectrumPort ? "vtkTable"
                             : "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkPeridynamicStiffness::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int succeeded = this->Superclass::RequestDataObject(request, inputVector, outputVector);
  vtkInformation* info = outputVector->GetInformationObject(MeshPort);
  // The data sets of composite data form one mesh.
  if (succeeded && !vtkDataSet::GetData(info))
  {
    info->Set(vtkDataObject::DATA_OBJECT(), vtkSmartPointer<vtkUnstructuredGrid>::New());
  }
  return succeeded;
}

//------------------------------------------------------------------------------
int vtkPeridynamicStiffness::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  // The extent of the picture is known only after the assembly; the maximum is announced.
  const int last = std::max(this->SparsityPixels, 1) - 1;
  const int extent[6] = { 0, last, 0, last, 0, 0 };
  outputVector->GetInformationObject(SparsityPort)
    ->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  return 1;
}

//------------------------------------------------------------------------------
bool vtkPeridynamicStiffness::ProceedWithin(double from, double to, double fraction)
{
  return this->Proceed(from + (to - from) * fraction);
}

//------------------------------------------------------------------------------
tautline::PeridynamicOptions vtkPeridynamicStiffness::GetOptions()
{
  tautline::PeridynamicOptions options;
  options.horizon = this->Horizon;
  options.kernel.shape = static_cast<tautline::KernelShape>(this->Kernel);
  options.kernel.exponent = this->Exponent;
  options.kernel.width = this->GaussianWidth;
  options.kernel.table = this->KernelValues;
  options.basis = static_cast<tautline::PeridynamicBasis>(this->Basis);
  options.model = !this->Elastic ? tautline::PeridynamicModel::Scalar
    : this->StateBased           ? tautline::PeridynamicModel::StateBased
                                 : tautline::PeridynamicModel::Elastic;
  options.poissonRatio = this->PoissonRatio;
  options.planeState =
    this->PlaneStress ? tautline::PlaneState::Stress : tautline::PlaneState::Strain;
  options.cutBonds = this->CutBonds;
  options.discretization = static_cast<tautline::Discretization>(this->Discretization);
  options.rules = static_cast<tautline::RuleSet>(this->Rules);
  options.tolerance = this->Tolerance;
  options.constrained = this->Constrained;
  options.allowThinLayer = this->AllowThinLayer;
  options.memoryLimit = this->MemoryLimit * MebiByte;
  options.timeLimit = this->TimeLimit;
  options.threads = this->Threads;
  options.progress = [this](double part) { return this->ProceedWithin(0.0, AssemblyShare, part); };
  return options;
}

//------------------------------------------------------------------------------
int vtkPeridynamicStiffness::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* given = vtkDataObject::GetData(inputVector[0]);
  vtkDataSet* output = vtkDataSet::GetData(outputVector, MeshPort);
  vtkTable* table = vtkTable::GetData(outputVector, SpectrumPort);
  vtkImageData* picture = vtkImageData::GetData(outputVector, SparsityPort);
  tautline::Assistants assistants(std::move(this->Group));
  this->ClearResult();
  this->Assembled = false;
  table->Initialize();
  picture->Initialize();
  if (this->SparsityPixels == 0)
  {
    // The pipeline would execute again for an image without the announced extent.
    picture->SetExtent(0, 0, 0, 0, 0, 0);
  }
  return this->Attempt(outputVector, "choose a smaller horizon or a coarser mesh",
    [&]
    {
      const vtkSmartPointer<vtkDataSet> input = tautline::wholeMesh(given);
      output->ShallowCopy(input);
      if (input->GetNumberOfCells() > 0)
      {
        this->Compute(assistants, input, output, table, picture);
      }
    });
}

//------------------------------------------------------------------------------
bool vtkPeridynamicStiffness::NeedsFinitePoints(int) const
{
  return true;
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::ClearResult()
{
  this->Superclass::ClearResult();
  this->Condition = this->SmallestEigenvalue = this->LargestEigenvalue = 0.0;
  this->SolverIterations = 0;
}

//------------------------------------------------------------------------------
vtkDataArray* vtkPeridynamicStiffness::GetRegion(vtkDataSet* input)
{
  vtkInformation* choice = this->GetInputArrayInformation(RegionArray);
  const char* name = choice->Get(vtkDataObject::FIELD_NAME());
  // The default array may be missing in the input.
  const bool chosen = !name || std::string(name) != DefaultRegion;
  if (!this->Constrained || (!chosen && !input->GetCellData()->GetArray(name)))
  {
    return nullptr;
  }
  bool onPoints = false;
  return tautline::chosenArray(choice, input, "interaction layer", onPoints);
}

//------------------------------------------------------------------------------
tautline::Spectrum vtkPeridynamicStiffness::FindSpectrum(const tautline::PeridynamicSystem& system)
{
  tautline::LanczosOptions options;
  options.tolerance = this->SpectrumTolerance;
  options.timeLimit = this->GetRemainingSeconds();
  options.threads = this->Threads;
  options.progress = [this](double fraction)
  { return this->ProceedWithin(AssemblyShare, SpectrumShare, fraction); };
  return tautline::extremeEigenvalues(system.matrix, options);
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::Compute(tautline::Assistants& assistants, vtkDataSet* input,
  vtkDataSet* output, vtkTable* table, vtkImageData* picture)
{
  const tautline::PeridynamicOptions options = this->GetOptions();
  tautline::HorizonInput taken(
    input, this->GetRegion(input), this->LayerValue, this->MergeCoincidentPoints, this->Threads);
  bool onPoints = false;
  if (vtkDataArray* points = tautline::chosenArray(
        this->GetInputArrayInformation(GivenPointArray), input, "given points", onPoints))
  {
    if (!onPoints)
    {
      throw tautline::Error("the given points must be a point array");
    }
    taken.setGivenPoints(points);
  }
  const tautline::Index components = this->Elastic ? 2 : 1;
  std::vector<double> given;
  if (vtkDataArray* array = tautline::chosenArray(
        this->GetInputArrayInformation(GivenArray), input, "given solution", onPoints);
      array && this->Solve)
  {
    tautline::requireEqualValues(
      onPoints ? array : nullptr, taken.representative(), "given values");
    given = tautline::onFunctions(taken, options.basis, components, array, onPoints);
  }

  // All processes assemble a part of the rows.
  tautline::RankGroup& group = assistants.call();
  if (group.size() > 1)
  {
    tautline::meshOfFirst(group, taken.mesh());
    group.gatherItems(given);
  }
  const tautline::PeridynamicSystem system =
    tautline::assemblePeridynamics(group, taken.mesh(), options, given.empty() ? nullptr : &given);
  this->Assembled = true;
  const tautline::Spectrum found =
    this->ComputeSpectrum ? this->FindSpectrum(system) : tautline::Spectrum();
  const tautline::Spectrum* spectrum = this->ComputeSpectrum ? &found : nullptr;

  const tautline::PeridynamicResult result = { taken, options.basis, system };
  tautline::addRowData(result, output);
  if (spectrum)
  {
    tautline::addRowVector(result, spectrum->smallestVector, "SmallestMode", nullptr, output);
    tautline::addRowVector(result, spectrum->largestVector, "LargestMode", nullptr, output);
  }
  const tautline::SolveReport solved =
    this->Solve ? this->SolveSystem(taken, system, given, input, output) : tautline::SolveReport();
  vtkDataSetAttributes* data = this->Basis == PIECEWISE_LINEAR
    ? static_cast<vtkDataSetAttributes*>(output->GetPointData())
    : output->GetCellData();
  data->SetActiveScalars(this->Solve ? "Solution" : "Neighbors");
  tautline::fillSpectrum(system, spectrum, table);
  tautline::addSolveReport(solved, table);
  if (this->SparsityPixels > 0)
  {
    tautline::drawSparsity(system.matrix, this->SparsityPixels, picture);
  }
  this->Report(system, spectrum, solved);
  this->AddToSummary(taken.notice());
}

//------------------------------------------------------------------------------
tautline::SolveReport vtkPeridynamicStiffness::SolveSystem(const tautline::HorizonInput& input,
  const tautline::PeridynamicSystem& system, const std::vector<double>& given, vtkDataSet* data,
  vtkDataSet* output)
{
  const auto basis = static_cast<tautline::PeridynamicBasis>(this->Basis);
  const tautline::Index components = system.components;
  bool onPoints = false;
  vtkDataArray* array =
    tautline::chosenArray(this->GetInputArrayInformation(SourceArray), data, "source", onPoints);
  std::vector<double> source;
  if (array)
  {
    tautline::requireEqualValues(
      onPoints ? array : nullptr, input.representative(), "values of the source");
    source = tautline::onMesh(input, components, array, onPoints);
  }
  else
  {
    source.assign(components * input.mesh().numberOfTriangles(), 0.0);
    for (std::size_t i = 0; i < source.size(); i += components)
    {
      source[i] = this->UniformSource;
    }
  }
  std::vector<double> load = tautline::sourceLoad(input.mesh(), system, basis, source, onPoints);
  for (std::size_t i = 0; i < system.constraintLoad.size(); ++i)
  {
    load[i] -= system.constraintLoad[i];
  }
  tautline::LanczosOptions options;
  options.maxIterations = std::max<tautline::Index>(1000, 4 * system.matrix.size);
  options.timeLimit = this->GetRemainingSeconds();
  options.threads = this->Threads;
  options.progress = [this](double part) { return this->ProceedWithin(SpectrumShare, 1.0, part); };
  std::vector<double> solution;
  const tautline::SolveReport report = tautline::solvePeridynamics(input.mesh(), this->GetOptions(),
    system, static_cast<tautline::NonlocalPreconditioner>(this->Preconditioner), load, solution,
    SolverTolerance, options);
  this->SolverIterations = static_cast<int>(report.iterations);
  if (!report.converged)
  {
    vtkWarningMacro("The solution has not converged: its relative residual is " << report.residual);
  }
  const tautline::PeridynamicResult result = { input, basis, system };
  const std::vector<double>* prescribed = given.empty() ? nullptr : &given;
  tautline::addRowVector(result, solution, "Solution", prescribed, output);
  if (this->Elastic)
  {
    tautline::addStrain(result, this->GetOptions(), solution, prescribed, output);
  }
  return report;
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::Report(const tautline::PeridynamicSystem& system,
  const tautline::Spectrum* spectrum, const tautline::SolveReport& solved)
{
  std::ostringstream text;
  text.precision(7);
  text << system.matrix.size << " rows, " << system.matrix.nonzeros() << " entries.";
  if (spectrum)
  {
    this->Condition = spectrum->condition;
    this->SmallestEigenvalue = spectrum->smallest;
    this->LargestEigenvalue = spectrum->largest;
    text << "\nEigenvalues from " << spectrum->smallest << " to " << spectrum->largest << ".";
    if (spectrum->definite)
    {
      text << "\nCondition number " << spectrum->condition << ".";
    }
    else
    {
      text << "\nNot positive definite"
           << (this->Constrained ? "."
                                 : ": nothing is constrained, so constants are in the null space.");
    }
    if (!spectrum->converged)
    {
      text << "\nThe eigenvalues have not converged: error bounds " << spectrum->smallestBound
           << " and " << spectrum->largestBound << ".";
      vtkWarningMacro("The eigenvalues have not converged: their error bounds are "
        << spectrum->smallestBound << " and " << spectrum->largestBound);
    }
  }
  if (this->Solve)
  {
    text << "\nSolved in " << solved.iterations << " iterations (preconditioner: "
         << tautline::nameOf(static_cast<tautline::NonlocalPreconditioner>(this->Preconditioner))
         << ").";
  }
  if (system.layerDeficit > 0.0)
  {
    text << "\nThe interaction layer is too thin by " << system.layerDeficit << ".";
  }
  this->Summary = text.str();
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkPeridynamicStiffness::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  rules.assist = [this] { this->Assist(); };
  return rules;
}

//------------------------------------------------------------------------------
bool vtkPeridynamicStiffness::TakesPieces(vtkInformationVector**)
{
  this->Group = tautline::tryProcessGroup();
  return false;
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::Assist()
{
  const std::unique_ptr<tautline::RankGroup> group = std::move(this->Group);
  if (!group || !tautline::Assistants::areCalled(*group))
  {
    return;
  }
  const tautline::HorizonMesh mesh = tautline::meshOfFirst(*group, {});
  const std::vector<double> given = group->gatherItems(std::vector<double>())[0];
  tautline::PeridynamicOptions options = this->GetOptions();
  options.progress = nullptr; // the first process reports
  tautline::assemblePeridynamics(*group, mesh, options, given.empty() ? nullptr : &given);
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Condition, this->SmallestEigenvalue, this->LargestEigenvalue);
  stream(this->SolverIterations);
}

//------------------------------------------------------------------------------
void vtkPeridynamicStiffness::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
  os << indent << "Horizon: " << this->Horizon << "\n";
  os << indent << "Kernel: " << this->Kernel << "\n";
  os << indent << "Exponent: " << this->Exponent << "\n";
  os << indent << "GaussianWidth: " << this->GaussianWidth << "\n";
  os << indent << "KernelValues: " << this->KernelValues.size() << "\n";
  os << indent << "Basis: " << this->Basis << "\n";
  os << indent << "Elastic: " << this->Elastic << "\n";
  os << indent << "StateBased: " << this->StateBased << "\n";
  os << indent << "PoissonRatio: " << this->PoissonRatio << "\n";
  os << indent << "PlaneStress: " << this->PlaneStress << "\n";
  os << indent << "CutBonds: " << this->CutBonds << "\n";
  os << indent << "Discretization: " << this->Discretization << "\n";
  os << indent << "Rules: " << this->Rules << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "LayerValue: " << this->LayerValue << "\n";
  os << indent << "Constrained: " << this->Constrained << "\n";
  os << indent << "AllowThinLayer: " << this->AllowThinLayer << "\n";
  os << indent << "ComputeSpectrum: " << this->ComputeSpectrum << "\n";
  os << indent << "SpectrumTolerance: " << this->SpectrumTolerance << "\n";
  os << indent << "Solve: " << this->Solve << "\n";
  os << indent << "Preconditioner: " << this->Preconditioner << "\n";
  os << indent << "UniformSource: " << this->UniformSource << "\n";
  os << indent << "SparsityPixels: " << this->SparsityPixels << "\n";
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
}
