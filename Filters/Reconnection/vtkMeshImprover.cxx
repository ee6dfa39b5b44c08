// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshImprover.h"

#include "BlockSeams.h"
#include "Blocks.h"
#include "GatheredExecution.h"
#include "ImprovedMesh.h"
#include "ImproverReport.h"
#include "MovableMesh.h"
#include "ReconnectableMesh.h"
#include "TableRows.h"
#include "tautline/Quality/Metrics.h"
#include "tautline/Reconnection/TriangleReconnection.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <sstream>

vtkStandardNewMacro(vtkMeshImprover);

namespace
{
constexpr int NumberOfInputPorts = 2, NumberOfOutputPorts = 3;
constexpr const char* FilterName = "Improve Mesh"; // in the menu
}

//------------------------------------------------------------------------------
vtkMeshImprover::vtkMeshImprover()
{
  this->DeclarePorts(NumberOfInputPorts, NumberOfOutputPorts, { SelectionPort });
}

//------------------------------------------------------------------------------
vtkMeshImprover::~vtkMeshImprover() = default;

//------------------------------------------------------------------------------
void vtkMeshImprover::SetMetric(int metric)
{
  try
  {
    if (tautline::missingMetric(metric).empty())
    {
      tautline::metricInfo(static_cast<tautline::Metric>(metric)); // throws if there is none
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what() << " Element Quality and its help page list the metrics.");
    return;
  }
  if (metric != this->Metric)
  {
    this->Metric = metric;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkMeshImprover::SetMetricByName(const char* name)
{
  const tautline::MetricInfo* info = tautline::findMetric(name ? name : "");
  if (!info)
  {
    vtkErrorMacro(<< "There is no metric '" << (name ? name : "")
                  << "'. Element Quality and its help page list them.");
    return;
  }
  this->SetMetric(static_cast<int>(info->metric));
}

//------------------------------------------------------------------------------
std::string vtkMeshImprover::GetUserMetrics()
{
  return tautline::listUserMetrics();
}

//------------------------------------------------------------------------------
std::string vtkMeshImprover::FindSettingProblem() const
{
  return tautline::missingMetric(this->Metric);
}

//------------------------------------------------------------------------------
int vtkMeshImprover::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ClearResult();
  this->SetProgressText(FilterName);
  return this->Attempt(outputVector, "improve the mesh in parts",
    [&]
    {
      vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
      tautline::TableRows history, remaining;
      if (this->Pieces || !this->PieceError.empty())
      {
        this->ImproveOnRanks(
          inputVector, vtkDataObject::GetData(outputVector, MeshPort), history, remaining);
        history.fill(vtkTable::GetData(outputVector, HistoryPort));
        remaining.fill(vtkTable::GetData(outputVector, RemainingPort));
        return;
      }
      this->CheckSeams(input);
      const auto fixed =
        tautline::markSelected(input, vtkSelection::GetData(inputVector[SelectionPort]));
      const int blocks = tautline::countBlocks(input);
      tautline::forEachBlock(input, nullptr, fixed, vtkDataObject::GetData(outputVector, MeshPort),
        [&](const tautline::InputBlock& block)
        {
          if (block.input->GetNumberOfPoints() == 0 || block.input->GetNumberOfCells() == 0)
          {
            block.output->ShallowCopy(block.input);
            return;
          }
          this->Improve(block, blocks, history, remaining);
        });
      this->AddToSummary(this->WhyGathered);
      history.fill(vtkTable::GetData(outputVector, HistoryPort));
      remaining.fill(vtkTable::GetData(outputVector, RemainingPort));
    });
}

//------------------------------------------------------------------------------
void vtkMeshImprover::ClearResult()
{
  this->Superclass::ClearResult();
  this->Reason.clear();
  this->ElementsBefore = this->ElementsAfter = this->Remaining = 0;
  this->SmallestAngleBefore = this->SmallestAngleAfter = 0.0;
  this->WorstBefore = this->WorstAfter = this->BoundaryDistance = 0.0;
  this->WorstMetricBefore = this->WorstMetricAfter = 0.0;
  this->EdgesInRangeBefore = this->EdgesInRangeAfter = this->WorstInMetric = 0.0;
}

//------------------------------------------------------------------------------
void vtkMeshImprover::CheckSeams(vtkDataObject* input)
{
  const std::string seams =
    this->MergeCoincidentPoints ? tautline::describeBlockSeams(input, this->Threads) : "";
  if (!seams.empty() && this->Boundary != FIXED)
  {
    throw tautline::Error("The boundary is not fixed, and blocks would come apart: " + seams +
      " Or switch Merge Coincident Points off.");
  }
  this->AddToSummary(seams);
  this->Warn(seams);
}

//------------------------------------------------------------------------------
/// Sets all options except the preset.
void vtkMeshImprover::SetOptions(tautline::ReconnectionOptions& options) const
{
  options.swap = this->Swap;
  options.smooth = this->Smooth;
  options.contract = this->Contract;
  options.insert = this->Insert;
  options.compound = this->Compound;
  options.objective = static_cast<tautline::ReconnectionObjective>(this->Objective);
  options.metric = static_cast<tautline::Metric>(this->Metric);
  options.boundary = static_cast<tautline::BoundaryMotion>(this->Boundary);
  options.flatAngle = this->FlatAngle;
  options.featureAngle = this->FeatureAngle;
  options.surfaceAngle = this->SurfaceAngle;
  options.surfaceTolerance = this->SurfaceTolerance;
  options.smallestCount = this->SmallestCount;
  options.largestCount = this->LargestCount;
  options.threads = this->Threads;
  options.edgeLength = this->EdgeLength;
  options.edgeFactor = this->EdgeFactor;
  options.improveMean = this->ThenBestShape;
  options.overlaps = this->CellTransfer == CONSERVATIVE;
  options.maximumSeconds = this->GetRemainingSeconds();
  using tautline::ReconnectionSize;
  options.size = this->Size == EDGE_LENGTH ? ReconnectionSize::Length
    : this->Size == LENGTH_OF_INPUT        ? ReconnectionSize::Input
    : this->Size == SIZE_ARRAY             ? ReconnectionSize::Lengths
                                           : ReconnectionSize::None;
}

//------------------------------------------------------------------------------
bool vtkMeshImprover::IsArrayChosen(int index)
{
  vtkInformation* choice = this->GetInputArrayInformation(index);
  const char* name = choice ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  return name && *name && std::string(name) != "None";
}

//------------------------------------------------------------------------------
/// The array of target lengths, or null. An adaptation without other lengths uses the chosen array,
/// or otherwise the only array of metric tensors.
vtkDataArray* vtkMeshImprover::FindSizeArray(vtkDataSet* input)
{
  constexpr int componentsOfTensor = 6;
  const bool adapts = this->Preset == ADAPT && this->Size == ANY_LENGTH;
  if (this->Size == SIZE_ARRAY || (adapts && this->IsArrayChosen(tautline::ImproverArrays::Size)))
  {
    return tautline::chosenArray(
      this, tautline::ImproverArrays::Size, input, "of target lengths", tautline::ArrayOf::Points);
  }
  vtkDataArray* only = nullptr;
  int tensors = 0;
  for (int a = 0; adapts && a < input->GetPointData()->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = input->GetPointData()->GetArray(a);
    if (array && array->GetNumberOfComponents() == componentsOfTensor)
    {
      only = array;
      ++tensors;
    }
  }
  return tensors == 1 ? only : nullptr;
}

//------------------------------------------------------------------------------
/// Sets all options for tetrahedra or triangles except the options of a particular mesh.
template <class Options>
void vtkMeshImprover::PrepareOptions(Options& options, double block, double blocks)
{
  this->SetOptions(options);
  tautline::applyPreset(static_cast<tautline::ReconnectionPreset>(this->Preset), options);
  if (this->TargetAngle > 0)
  {
    options.targetAngle = this->TargetAngle;
  }
  options.observer = [=](const tautline::ReconnectionRecord& record, double progress)
  {
    const bool adapts = this->Preset == ADAPT;
    this->ShowIteration(FilterName, record.pass,
      { { "below target", static_cast<double>(record.belowTarget) },
        { adapts ? "edges in range" : "worst",
          adapts ? record.edgesInRange : record.worstInverseMeanRatio } });
    return this->Proceed((block + progress) / blocks);
  };
}

template void vtkMeshImprover::PrepareOptions(
  tautline::ReconnectionOptions& options, double block, double blocks);

//------------------------------------------------------------------------------
/// Runs the kernel on a mesh. @param targetAngle set to the angle used
tautline::ReconnectionResult vtkMeshImprover::Run(const tautline::ReconnectableMesh& mesh,
  const tautline::InputBlock& block, int blocks, double& targetAngle)
{
  const auto prepare = [&](auto& options)
  {
    this->PrepareOptions(options, block.number, blocks);
    targetAngle = options.adapt ? 0.0 : options.targetAngle;
    options.fixed = mesh.fixed().data();
    options.regions = mesh.regions().empty() ? nullptr : mesh.regions().data();
    options.outside = mesh.outside().empty() ? nullptr : mesh.outside().data();
  };
  std::vector<double> sizes;
  if (!mesh.isTriangles())
  {
    tautline::ReconnectionOptions options;
    prepare(options);
    sizes = this->SetSize(block.input, options);
    options.sizes = sizes.data();
    options.markedFacets = mesh.facets();
    if (options.adapt)
    {
      options.markedClasses = mesh.facetClasses();
    }
    return tautline::improveConnectivity(mesh.mesh(), options);
  }
  if (this->Objective != ANGLES_AND_SHAPE)
  {
    throw tautline::Error("the objective applies to tetrahedra: leave it at its default for "
                          "triangles, whose angles are improved");
  }
  tautline::TriangleOptions options;
  options.keepVolume = this->KeepVolume;
  prepare(options);
  sizes = this->SetSize(block.input, options);
  options.sizes = sizes.data();
  options.markedEdges = mesh.lines();
  return tautline::improveTriangles(mesh.mesh(), options);
}

//------------------------------------------------------------------------------
std::vector<double> vtkMeshImprover::SetSize(
  vtkDataSet* input, tautline::ReconnectionOptions& options)
{
  using tautline::ReconnectionSize;
  std::vector<double> sizes;
  vtkDataArray* array = this->FindSizeArray(input);
  if (!array && options.adapt && this->Size == ANY_LENGTH)
  {
    throw tautline::Error(
      "the preset Adapt needs target lengths: set Edge Lengths to a length or to an array of "
      "lengths or metric tensors, for example from Metric Tensor");
  }
  if (!array && this->Size != SIZE_ARRAY)
  {
    return sizes;
  }
  const int components = array ? array->GetNumberOfComponents() : 0;
  if (components != 1 && components != 6 && components != 9)
  {
    throw tautline::Error("target lengths are needed: choose a point array with one component "
                          "(lengths) or six or nine (metric tensors)");
  }
  // From nine components, the upper triangle in VTK's order of six.
  constexpr std::array<int, 6> upper = { 0, 4, 8, 1, 5, 2 };
  options.size = components == 1 ? ReconnectionSize::Lengths : ReconnectionSize::Metrics;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < std::min(components, static_cast<int>(upper.size())); ++k)
    {
      sizes.push_back(array->GetComponent(i, components == 9 ? upper[k] : k));
    }
  }
  return sizes;
}

//------------------------------------------------------------------------------
void vtkMeshImprover::Improve(const tautline::InputBlock& block, int blocks,
  tautline::TableRows& history, tautline::TableRows& remaining)
{
  tautline::ReconnectableMesh mesh(block.input, this->MergeCoincidentPoints, this->Threads);
  mesh.fixPoints(tautline::chosenArray(this, tautline::ImproverArrays::Fixed, block.input,
    "of fixed points", tautline::ArrayOf::Points));
  const bool changes = this->Selected == CHANGES;
  if (block.selected && changes)
  {
    mesh.keepOthers(block.selected->GetCellData()->GetArray(tautline::SelectedArray));
  }
  else if (block.selected)
  {
    mesh.fixPoints(block.selected->GetPointData()->GetArray(tautline::SelectedArray));
    mesh.fixCells(block.selected->GetCellData()->GetArray(tautline::SelectedArray));
  }
  vtkDataArray* regions = tautline::chosenArray(
    this, tautline::ImproverArrays::Region, block.input, "of regions", tautline::ArrayOf::Cells);
  mesh.setRegions(regions);
  if (!regions && this->Preset == ADAPT)
  {
    this->AddToSummary(mesh.setRegionsByTags());
  }
  mesh.keepOthers(tautline::chosenArray(this, tautline::ImproverArrays::Changing, block.input,
    "of cells that change", tautline::ArrayOf::Cells));
  mesh.removeDegenerate();
  if (this->Preset == ADAPT && mesh.isTriangles())
  {
    mesh.fixLineBorders();
  }

  double targetAngle = 0.0;
  const bool triangles = mesh.isTriangles();
  const tautline::ReconnectionResult result = this->Run(mesh, block, blocks, targetAngle);
  const tautline::ImprovedCells improved =
    tautline::writeImproved(mesh, result, this->Threads, vtkPointSet::SafeDownCast(block.output));

  std::vector<tautline::RemainingElement> left =
    tautline::remainingOf(result.obstacles, result.qualities, result.bounds, improved);
  this->Remaining += static_cast<vtkIdType>(left.size());
  this->Report(result, std::move(left),
    { block.name, "", improved.note, mesh.leftOut(result.adapted), mesh.notice(), triangles,
      targetAngle },
    history, remaining);
}

//------------------------------------------------------------------------------
void vtkMeshImprover::Report(const tautline::ReconnectionResult& result,
  std::vector<tautline::RemainingElement> left, const tautline::ImproverRemarks& remarks,
  tautline::TableRows& history, tautline::TableRows& remaining)
{
  const auto boundary = static_cast<tautline::BoundaryMotion>(this->Boundary);
  const bool triangles = remarks.triangles;
  tautline::sortWorstFirst(left);
  tautline::addHistory(history, result.history, remarks.block, result.adapted);
  tautline::addRemaining(remaining, left, triangles, remarks.block);
  this->AddToSummary((remarks.block.empty() ? "" : "In " + remarks.block + ": ") +
    tautline::describeResult(result, triangles));
  this->TakeResult(result, triangles);
  this->AddToSummary(remarks.rounds);
  this->AddToSummary(tautline::describeRemaining(left, triangles, boundary, remarks.targetAngle));
  if (!result.adapted)
  {
    this->AddToSummary(tautline::describeForced(left, triangles, result.forcedInverseMeanRatio));
  }
  for (const std::string& sentence : { remarks.precision, remarks.leftOut, remarks.notice })
  {
    this->AddToSummary(sentence);
  }
  this->Warn(remarks.leftOut);
}

//------------------------------------------------------------------------------
void vtkMeshImprover::TakeResult(const tautline::ReconnectionResult& result, bool triangles)
{
  const tautline::ReconnectionRecord &first = result.history.front(), &last = result.history.back();
  const bool none = this->ElementsBefore == 0;
  const auto smaller = [none](double& number, double other)
  { number = none ? other : std::min(number, other); };
  smaller(this->SmallestAngleBefore, first.smallestAngle);
  smaller(this->SmallestAngleAfter, last.smallestAngle);
  this->WorstBefore = std::max(this->WorstBefore, first.worstInverseMeanRatio);
  this->WorstAfter = std::max(this->WorstAfter, last.worstInverseMeanRatio);
  this->BoundaryDistance = std::max(this->BoundaryDistance, result.boundaryDistance);
  if (result.adapted)
  {
    smaller(this->EdgesInRangeBefore, first.edgesInRange);
    smaller(this->EdgesInRangeAfter, last.edgesInRange);
    this->WorstInMetric =
      std::max(this->WorstInMetric, tautline::inverseMeanRatioOf(last, triangles));
  }
  else if (this->Objective == METRIC)
  {
    const tautline::MetricInfo& info =
      tautline::metricInfo(static_cast<tautline::Metric>(this->Metric));
    const bool larger = info.direction == tautline::Direction::LargerIsBetter;
    const auto worse = [none, larger](double& number, double other)
    { number = none || (larger ? other < number : other > number) ? other : number; };
    worse(this->WorstMetricBefore, result.worstMetricBefore);
    worse(this->WorstMetricAfter, result.worstMetricAfter);
    std::ostringstream text;
    text << info.label << " of the worst tetrahedron: " << result.worstMetricBefore << " to "
         << result.worstMetricAfter << ".";
    this->AddToSummary(text.str());
  }
  this->ElementsBefore += first.tetrahedra;
  this->ElementsAfter += last.tetrahedra;
  this->Reason = tautline::reasonText(result.reason);
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshImprover::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::NewMesh;
  rules.joinsPartitions = this->MergeCoincidentPoints || this->PartitionsHaveIds();
  return rules;
}

//------------------------------------------------------------------------------
void vtkMeshImprover::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Reason, this->ElementsBefore, this->ElementsAfter, this->SmallestAngleBefore,
    this->SmallestAngleAfter, this->WorstBefore, this->WorstAfter, this->Remaining,
    this->BoundaryDistance, this->WorstMetricBefore, this->WorstMetricAfter,
    this->EdgesInRangeBefore, this->EdgesInRangeAfter, this->WorstInMetric);
}

//------------------------------------------------------------------------------
void vtkMeshImprover::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Preset: " << this->Preset << "\n";
  os << indent << "Swap: " << this->Swap << "\n";
  os << indent << "Smooth: " << this->Smooth << "\n";
  os << indent << "Contract: " << this->Contract << "\n";
  os << indent << "Insert: " << this->Insert << "\n";
  os << indent << "Compound: " << this->Compound << "\n";
  os << indent << "TargetAngle: " << this->TargetAngle << "\n";
  os << indent << "Objective: " << this->Objective << "\n";
  os << indent << "Metric: " << this->Metric << "\n";
  os << indent << "Boundary: " << this->Boundary << "\n";
  os << indent << "FlatAngle: " << this->FlatAngle << "\n";
  os << indent << "SmallestCount: " << this->SmallestCount << "\n";
  os << indent << "LargestCount: " << this->LargestCount << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "SurfaceAngle: " << this->SurfaceAngle << "\n";
  os << indent << "SurfaceTolerance: " << this->SurfaceTolerance << "\n";
  os << indent << "KeepVolume: " << this->KeepVolume << "\n";
  os << indent << "Size: " << this->Size << "\n";
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
  os << indent << "EdgeFactor: " << this->EdgeFactor << "\n";
  os << indent << "Selected: " << this->Selected << "\n";
  os << indent << "ThenBestShape: " << this->ThenBestShape << "\n";
  os << indent << "CellTransfer: " << this->CellTransfer << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
  os << indent << "GatherBelow: " << this->GatherBelow << "\n";
  os << indent << "Rounds: " << this->Rounds << "\n";
}
