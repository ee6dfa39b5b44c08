// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshImprover.h"

#include "BlockSeams.h"
#include "Blocks.h"
#include "ImprovedMesh.h"
#include "GatheredExecution.h"
#include "ReconnectableMesh.h"
#include "TableRows.h"
#include "tautline/Quality/Metrics.h"
#include "tautline/Reconnection/TriangleReconnection.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

vtkStandardNewMacro(vtkMeshImprover);

namespace
{
constexpr int NumberOfInputPorts = 2, NumberOfOutputPorts = 3;
constexpr int FixedArray = 0, RegionArray = 1, SizeArray = 2;
constexpr int ListedElements = 10;
constexpr const char* FilterName = "Improve Mesh"; // in the menu

/// In the order of tautline::ReconnectionObstacle.
using Reasons = std::array<const char*, 6>;
constexpr Reasons obstacles = { "it is not below the target",
  "no operation improves it, or a limit ended the run",
  "a facet that it has on the boundary or between regions allows no better one",
  "it has a fixed point", "it has a point between regions", "it has a point on the boundary" };

/// What would help, in the same order.
constexpr Reasons remedies = { "", "try the preset Aggressive, a larger time limit or other counts",
  "let the boundary slide on flat parts or on the surface, or repair the surface mesh",
  "fix fewer points", "choose fewer regions",
  "let the boundary slide on flat parts or on the surface" };

/// The same for triangles.
constexpr Reasons edgeObstacles = { "it is not below the target",
  "no operation improves it, or a limit ended the run",
  "the angle between two edges that are kept allows no better one", "it has a fixed point",
  "it has a point between regions or on a sharp edge", "it has a point on the border" };
constexpr Reasons edgeRemedies = { "",
  "try the preset Aggressive, a larger time limit, other counts or, on a surface, a larger surface "
  "distance",
  "change the geometry", "fix fewer points",
  "let the boundary slide on flat parts, choose fewer regions or a larger feature angle",
  "let the boundary slide on flat parts" };

/// How the elements and their angles are called.
struct Words
{
  const char *one, *many, *title, *angle;
  const Reasons &obstacles, &remedies;
};
constexpr Words tetrahedra = { "tetrahedron", "tetrahedra", "Tetrahedra", "dihedral angle",
  obstacles, remedies };
constexpr Words triangles = { "triangle", "triangles", "Triangles", "angle", edgeObstacles,
  edgeRemedies };

const char* reasonText(tautline::StopReason reason)
{
  switch (reason)
  {
    case tautline::StopReason::Reduction:
      return "Every element has reached the target.";
    case tautline::StopReason::NoProgress:
      return "No operation improves the worst elements any further.";
    default:
      return tautline::describe(reason);
  }
}

/// The cells below the target, the worst first.
std::vector<tautline::Index> remainingOf(
  const tautline::ReconnectionResult& result, const tautline::ImprovedMesh& improved)
{
  std::vector<std::pair<double, tautline::Index>> byAngle;
  for (std::size_t i = 0; i < result.obstacles.size(); ++i)
  {
    if (result.obstacles[i] != static_cast<signed char>(tautline::ReconnectionObstacle::None))
    {
      byAngle.emplace_back(improved.smallestAngles[i], static_cast<tautline::Index>(i));
    }
  }
  std::sort(byAngle.begin(), byAngle.end());
  std::vector<tautline::Index> cells(byAngle.size());
  std::transform(
    byAngle.begin(), byAngle.end(), cells.begin(), [](const auto& entry) { return entry.second; });
  return cells;
}

void addHistory(tautline::TableRows& rows, const std::vector<tautline::ReconnectionRecord>& history,
  const std::string& block)
{
  for (const tautline::ReconnectionRecord& record : history)
  {
    const auto add = [&rows](const char* column, auto value)
    { rows.add(column, static_cast<double>(value)); };
    rows.begin(block);
    add("Smallest angle", record.smallestAngle);
    add("Largest angle", record.largestAngle);
    add("Worst imr", record.worstInverseMeanRatio);
    add("N elements", record.tetrahedra);
    add("N below target", record.belowTarget);
    add("N edge removals", record.edgeRemovals);
    add("N face removals", record.faceRemovals);
    add("N boundary swaps", record.boundarySwaps);
    add("N contractions", record.contractions);
    add("N insertions", record.insertions);
    add("N moves", record.moves);
    add("Time (s)", record.seconds);
  }
}

void addRemaining(tautline::TableRows& rows, const std::vector<tautline::Index>& cells,
  const tautline::ReconnectionResult& result, const tautline::ImprovedMesh& improved,
  const Words& words, const std::string& block)
{
  const std::size_t n = cells.size();
  if (n == 0)
  {
    return;
  }
  // Column by column: rows of cells in any order are slow to collect, and there may be many.
  rows.begin();
  if (!block.empty())
  {
    rows.addManyTexts("Block", n, [&](std::size_t) { return block; });
  }
  const auto add = [&](const char* column, const std::vector<double>& values)
  { rows.addMany(column, n, [&](std::size_t i) { return values[cells[i]]; }); };
  rows.addMany("Cell", n, [&](std::size_t i) { return static_cast<double>(cells[i]); });
  add("Smallest angle", improved.smallestAngles);
  add("imr", improved.inverseMeanRatios);
  constexpr std::array<const char*, 3> axes = { "X", "Y", "Z" };
  for (std::size_t c = 0; c < axes.size(); ++c)
  {
    rows.addMany(axes[c], n, [&](std::size_t i) { return improved.centers[cells[i]][c]; });
  }
  add("Quality", result.qualities);
  add("Quality bound", result.bounds);
  rows.addManyTexts(
    "Reason", n, [&](std::size_t i) { return words.obstacles[result.obstacles[cells[i]]]; });
}

/// "12 edge removals, 3 motions of points"
std::string describeOperations(const tautline::ReconnectionRecord& record)
{
  const std::array<std::pair<tautline::Index, const char*>, 6> operations = { {
    { record.edgeRemovals, "edge removals" },
    { record.faceRemovals, "face removals" },
    { record.boundarySwaps, "boundary swaps" },
    { record.contractions, "contractions" },
    { record.insertions, "insertions" },
    { record.moves, "motions of points" },
  } };
  std::string text;
  for (const auto& [count, name] : operations)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
    }
  }
  return text.empty() ? "none" : text;
}

/// What remains below the target, why, and which are the worst.
std::string describeRemaining(const std::vector<tautline::Index>& cells,
  const tautline::ReconnectionResult& result, const tautline::ImprovedMesh& improved,
  const Words& words, double targetAngle)
{
  std::ostringstream text;
  if (cells.empty())
  {
    text << "No " << words.one << " remains below the target of " << targetAngle << " degrees.";
    return text.str();
  }
  text << cells.size() << " " << (cells.size() == 1 ? words.one : words.many)
       << (cells.size() == 1 ? " remains" : " remain") << " below the target of " << targetAngle
       << " degrees:";
  std::array<tautline::Index, obstacles.size()> counts = {};
  for (const tautline::Index cell : cells)
  {
    ++counts[result.obstacles[cell]];
  }
  for (std::size_t k = 0; k < obstacles.size(); ++k)
  {
    if (counts[k] > 0)
    {
      text << "\n- " << counts[k] << ": " << words.obstacles[k] << " (" << words.remedies[k] << ")";
    }
  }
  const auto listed = std::min<std::size_t>(cells.size(), ListedElements);
  for (std::size_t i = 0; i < listed; ++i)
  {
    const tautline::Vec3& at = improved.centers[cells[i]];
    text << "\nElement " << cells[i] << " at (" << at[0] << ", " << at[1] << ", " << at[2]
         << "): smallest " << words.angle << " " << improved.smallestAngles[cells[i]]
         << ", inverse mean ratio " << improved.inverseMeanRatios[cells[i]] << "; "
         << words.obstacles[result.obstacles[cells[i]]] << ".";
  }
  if (cells.size() > listed)
  {
    text << "\n... and " << cells.size() - listed << " more: see the output Remaining.";
  }
  return text.str();
}

/// Before and after, in words.
std::string describeResult(const tautline::ReconnectionResult& result, const Words& words)
{
  const tautline::ReconnectionRecord &first = result.history.front(), &last = result.history.back();
  std::ostringstream text;
  text << reasonText(result.reason) << "\n"
       << words.title << ": " << first.tetrahedra << " to " << last.tetrahedra << ". Smallest "
       << words.angle << ": " << first.smallestAngle << " to " << last.smallestAngle
       << " degrees; largest: " << first.largestAngle << " to " << last.largestAngle
       << ". Worst inverse mean ratio: " << first.worstInverseMeanRatio << " to "
       << last.worstInverseMeanRatio << ".";
  if (result.meanAfter > 0.0)
  {
    text << " Mean: " << result.meanBefore << " to " << result.meanAfter << ".";
  }
  text << "\nOperations: " << describeOperations(last) << ".";
  if (result.markedFacets > 0)
  {
    text << "\nFacets inside the mesh that triangles mark, and that are kept: "
         << result.markedFacets << ".";
  }
  if (result.volumeBefore > 0.0)
  {
    text << "\nLargest distance between the boundary and that of the input: "
         << result.boundaryDistance << ". Volume: " << result.volumeBefore << " to "
         << result.volumeAfter << ".";
  }
  return text.str();
}
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
    tautline::metricInfo(static_cast<tautline::Metric>(metric)); // throws if there is none
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
int vtkMeshImprover::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ClearResult();
  this->SetProgressText(FilterName);
  return this->Attempt(outputVector, "improve the mesh in parts",
    [&]
    {
      vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
      this->CheckSeams(input);
      const auto fixed =
        tautline::markSelected(input, vtkSelection::GetData(inputVector[SelectionPort]));
      const int blocks = tautline::countBlocks(input);
      tautline::TableRows history, remaining;
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
/// Sets all options but the preset.
void vtkMeshImprover::SetOptions(tautline::ReconnectionOptions& options) const
{
  options.swap = this->Swap;
  options.smooth = this->Smooth;
  options.contract = this->Contract;
  options.insert = this->Insert;
  options.compound = this->Compound;
  options.objective = static_cast<tautline::ReconnectionObjective>(this->Objective);
  options.metric = static_cast<tautline::Metric>(this->Metric);
  options.boundary = static_cast<tautline::ReconnectionBoundary>(this->Boundary);
  options.flatAngle = this->FlatAngle;
  options.featureAngle = this->FeatureAngle;
  options.surfaceAngle = this->SurfaceAngle;
  options.surfaceDistance = this->SurfaceDistance;
  options.smallestCount = this->SmallestCount;
  options.largestCount = this->LargestCount;
  options.threads = this->Threads;
  options.edgeLength = this->EdgeLength;
  options.edgeFactor = this->EdgeFactor;
  options.improveMean = this->ThenBestShape;
  options.overlaps = this->CellTransfer == CONSERVATIVE;
  options.maximumSeconds = this->GetRemainingSeconds();
}

//------------------------------------------------------------------------------
/// Runs the kernel on a mesh. @param targetAngle set to the one that was used
tautline::ReconnectionResult vtkMeshImprover::Run(const tautline::ReconnectableMesh& mesh,
  const tautline::InputBlock& block, int blocks, double& targetAngle)
{
  const auto prepare = [&](auto& options)
  {
    this->SetOptions(options);
    tautline::applyPreset(static_cast<tautline::ReconnectionPreset>(this->Preset), options);
    if (this->TargetAngle > 0)
    {
      options.targetAngle = this->TargetAngle;
    }
    targetAngle = options.targetAngle;
    options.fixed = mesh.fixed().data();
    options.regions = mesh.regions().empty() ? nullptr : mesh.regions().data();
    options.observer = [&](const tautline::ReconnectionRecord& record, double progress)
    {
      this->ShowIteration(FilterName, record.pass,
        { { "below target", static_cast<double>(record.belowTarget) },
          { "worst", record.worstInverseMeanRatio } });
      return this->Proceed((block.number + progress) / static_cast<double>(blocks));
    };
  };
  std::vector<double> sizes;
  if (!mesh.isTriangles())
  {
    tautline::ReconnectionOptions options;
    prepare(options);
    sizes = this->SetSize(block.input, options);
    options.sizes = sizes.data();
    options.markedFacets = mesh.facets();
    return tautline::improveConnectivity(mesh.mesh(), options);
  }
  if (this->Objective != ANGLES_AND_SHAPE)
  {
    throw tautline::Error(
      "the objective is for tetrahedra: leave it at its default for triangles, whose angles are "
      "improved");
  }
  tautline::TriangleOptions options;
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
  options.size = this->Size == EDGE_LENGTH ? ReconnectionSize::Length
    : this->Size == LENGTH_OF_INPUT        ? ReconnectionSize::Input
                                           : ReconnectionSize::None;
  std::vector<double> sizes;
  if (this->Size != SIZE_ARRAY)
  {
    return sizes;
  }
  vtkDataArray* array = tautline::chosenArray(this, SizeArray, input, "of target lengths");
  const int components = array ? array->GetNumberOfComponents() : 0;
  if (components != 1 && components != 6 && components != 9)
  {
    throw tautline::Error("target lengths are needed: choose a point array with one component "
                          "(lengths) or six or nine (metric tensors)");
  }
  // Of nine components those of the upper triangle, in VTK's order of six.
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
  mesh.fixPoints(tautline::chosenArray(this, FixedArray, block.input, "of fixed points"));
  if (block.selected)
  {
    mesh.fixPoints(block.selected->GetPointData()->GetArray(tautline::SelectedArray));
    mesh.fixCells(block.selected->GetCellData()->GetArray(tautline::SelectedArray));
  }
  mesh.setRegions(tautline::chosenArray(this, RegionArray, block.input, "of regions"));

  double targetAngle = 0.0;
  const Words& words = mesh.isTriangles() ? triangles : tetrahedra;
  const tautline::ReconnectionResult result = this->Run(mesh, block, blocks, targetAngle);
  const tautline::ImprovedMesh improved =
    tautline::writeImproved(mesh, result, this->Threads, vtkPointSet::SafeDownCast(block.output));

  const std::vector<tautline::Index> cells = remainingOf(result, improved);
  addHistory(history, result.history, block.name);
  addRemaining(remaining, cells, result, improved, words, block.name);
  this->Remaining += static_cast<vtkIdType>(cells.size());
  this->AddToSummary(
    (block.name.empty() ? "" : "In " + block.name + ": ") + describeResult(result, words));
  this->TakeResult(result);
  this->AddToSummary(describeRemaining(cells, result, improved, words, targetAngle));
  if (!cells.empty())
  {
    std::ostringstream bound;
    bound << "With the " << (mesh.isTriangles() ? "edges" : "facets")
          << " of its boundary and between regions, no mesh has a worst inverse mean ratio below "
          << result.forcedInverseMeanRatio << ".";
    this->AddToSummary(bound.str());
  }
  this->AddToSummary(improved.note);
  this->AddToSummary(mesh.leftOut());
  this->AddToSummary(mesh.notice());
  this->Warn(mesh.leftOut());
}

//------------------------------------------------------------------------------
void vtkMeshImprover::TakeResult(const tautline::ReconnectionResult& result)
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
  if (this->Objective == METRIC)
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
  this->Reason = reasonText(result.reason);
}

//------------------------------------------------------------------------------
tautline::GatheredResult vtkMeshImprover::GetGatheredResult() const
{
  return tautline::GatheredResult::NewMesh;
}

//------------------------------------------------------------------------------
void vtkMeshImprover::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Reason, this->ElementsBefore, this->ElementsAfter, this->SmallestAngleBefore,
    this->SmallestAngleAfter, this->WorstBefore, this->WorstAfter, this->Remaining,
    this->BoundaryDistance, this->WorstMetricBefore, this->WorstMetricAfter);
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
  os << indent << "SurfaceDistance: " << this->SurfaceDistance << "\n";
  os << indent << "Size: " << this->Size << "\n";
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
  os << indent << "EdgeFactor: " << this->EdgeFactor << "\n";
  os << indent << "ThenBestShape: " << this->ThenBestShape << "\n";
  os << indent << "CellTransfer: " << this->CellTransfer << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
}
