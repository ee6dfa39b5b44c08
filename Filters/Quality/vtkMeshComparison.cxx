// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshComparison.h"

#include "Blocks.h"
#include "FaceQuality.h"
#include "GatheredExecution.h"
#include "MeshAdapter.h"
#include "MetricSelection.h"
#include "ProgressStep.h"
#include "tautline/Core/Memory.h"
#include "tautline/Mesh/CellOrder.h"
#include "tautline/Quality/Compare.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSignedCharArray.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

vtkStandardNewMacro(vtkMeshComparison);

/// The totals over the blocks.
struct vtkMeshComparison::Totals
{
  std::vector<tautline::Metric> metrics;
  std::vector<tautline::MetricChange> changes; ///< one per metric
  tautline::Index invertedBefore = 0, invertedAfter = 0;
  double largestDisplacement = 0;
  double blocks = 1, blocksDone = 0; ///< for the progress
};

namespace
{
/// A new array of one double per cell, added to the cell data.
double* addCellArray(vtkDataSet* output, const std::string& name)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfTuples(output->GetNumberOfCells());
  output->GetCellData()->AddArray(array);
  return array->GetPointer(0);
}

/// The same for signed characters.
signed char* addFlags(vtkDataSet* output, const char* name)
{
  vtkNew<vtkSignedCharArray> array;
  array->SetName(name);
  array->SetNumberOfTuples(output->GetNumberOfCells());
  output->GetCellData()->AddArray(array);
  return array->GetPointer(0);
}

/// Adds the array Displacement and returns the largest one.
double addDisplacement(
  vtkDataSet* output, const tautline::MeshView& before, const tautline::MeshView& after)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName("Displacement");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(before.numberOfPoints);
  double largest = 0;
  using tautline::operator-;
  for (tautline::Index i = 0; i < before.numberOfPoints; ++i)
  {
    tautline::Vec3 d = tautline::pointOf(after, i) - tautline::pointOf(before, i);
    const double length = tautline::norm(d);
    d = std::isfinite(length) ? d : tautline::Vec3{ 0, 0, 0 };
    largest = std::max(largest, tautline::norm(d));
    array->SetTypedTuple(i, d.data());
  }
  output->GetPointData()->AddArray(array);
  return largest;
}

/// Lists the cells of both meshes in a consistent order, and mirrors both if both are reversed.
void settleOrientation(tautline::MeshAdapter& before, tautline::MeshAdapter& after,
  signed char* validBefore, signed char* validAfter, int threads)
{
  using namespace tautline;
  before.mesh().classifyCells(validBefore, threads);
  Orientation first = before.mesh().orientation(validBefore);
  if (first.state == Orientation::Mixed)
  {
    // Cells that are reversed in only one of the meshes count as inverted there.
    after.mesh().classifyCells(validAfter, threads);
    std::vector<unsigned char> reverse = consistentOrder(before.mesh(), validBefore).reverse;
    const std::vector<unsigned char> other = consistentOrder(after.mesh(), validAfter).reverse;
    if (!reverse.empty() && !other.empty())
    {
      std::transform(reverse.begin(), reverse.end(), other.begin(), reverse.begin(),
        [](unsigned char a, unsigned char b) { return a && b; });
      before.reverseCells(reverse);
      after.reverseCells(reverse);
      before.mesh().classifyCells(validBefore, threads);
      first = before.mesh().orientation(validBefore);
    }
  }
  after.mesh().classifyCells(validAfter, threads);
  if (first.state == Orientation::Reversed &&
    after.mesh().orientation(validAfter).state == Orientation::Reversed)
  {
    for (MeshAdapter* adapter : { &before, &after })
    {
      adapter->mesh().setMirrored(true);
    }
    before.mesh().classifyCells(validBefore, threads);
    after.mesh().classifyCells(validAfter, threads);
  }
}
}

//------------------------------------------------------------------------------
vtkMeshComparison::vtkMeshComparison()
{
  this->DeclarePorts(2, 2);
}

//------------------------------------------------------------------------------
vtkMeshComparison::~vtkMeshComparison() = default;

//------------------------------------------------------------------------------
int vtkMeshComparison::FillInputPortInformation(int port, vtkInformation* info)
{
  this->Superclass::FillInputPortInformation(port, info);
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 0);
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshComparison::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Summary.clear();
  Totals totals;
  totals.metrics = this->GetSelection().metrics();
  totals.changes.resize(totals.metrics.size());
  totals.blocks = tautline::countBlocks(vtkDataObject::GetData(inputVector[0]));
  vtkDataObject* output = vtkDataObject::GetData(outputVector, 0);
  return this->Attempt(outputVector, "choose fewer metrics or compare the mesh in parts",
    [&]
    {
      this->CompareBlocks(vtkDataObject::GetData(inputVector[0]),
        vtkDataObject::GetData(inputVector[1]), output, totals);
      this->Tabulate(totals, vtkDataObject::GetData(outputVector, 1));
    });
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshComparison::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  rules.base = 1; // the output is the second mesh
  return rules;
}

//------------------------------------------------------------------------------
void vtkMeshComparison::CompareBlocks(
  vtkDataObject* before, vtkDataObject* after, vtkDataObject* output, Totals& totals)
{
  auto* first = vtkDataSet::SafeDownCast(before);
  auto* second = vtkDataSet::SafeDownCast(after);
  if (first && second)
  {
    this->Compare(first, second, vtkDataSet::SafeDownCast(output), totals);
    return;
  }
  auto* blocks = vtkCompositeDataSet::SafeDownCast(before);
  auto* others = vtkCompositeDataSet::SafeDownCast(after);
  if (!blocks || !others)
  {
    throw tautline::Error(
      "One input is a single mesh, the other has blocks: extract the block first "
      "(Extract Block), or merge them (Merge Blocks).");
  }
  auto* results = vtkCompositeDataSet::SafeDownCast(output);
  results->CopyStructure(others);
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  auto walkOther = vtkSmartPointer<vtkCompositeDataIterator>::Take(others->NewIterator());
  walk->InitTraversal();
  walkOther->InitTraversal();
  for (; !walk->IsDoneWithTraversal() && !walkOther->IsDoneWithTraversal();
       walk->GoToNextItem(), walkOther->GoToNextItem())
  {
    first = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject());
    second = vtkDataSet::SafeDownCast(walkOther->GetCurrentDataObject());
    if (walk->GetCurrentFlatIndex() != walkOther->GetCurrentFlatIndex() || !first || !second)
    {
      break;
    }
    auto result = vtkSmartPointer<vtkDataSet>::Take(second->NewInstance());
    this->Compare(first, second, result, totals);
    results->SetDataSet(walkOther, result);
  }
  if (!walk->IsDoneWithTraversal() || !walkOther->IsDoneWithTraversal())
  {
    const auto& at = walk->IsDoneWithTraversal() ? walkOther : walk;
    throw tautline::Error("The inputs differ in their blocks, first at block " +
      std::to_string(at->GetCurrentFlatIndex()) +
      ": give two data sets of the same structure, with a mesh in each block.");
  }
}

//------------------------------------------------------------------------------
void vtkMeshComparison::Compare(
  vtkDataSet* before, vtkDataSet* after, vtkDataSet* output, Totals& totals)
{
  using namespace tautline;
  MeshAdapter was(before, this->Threads), is(after, this->Threads);
  const std::string difference = connectivityDifference(was.mesh(), is.mesh());
  if (!difference.empty())
  {
    throw Error("The meshes have different connectivity: " + difference +
      ". Compare meshes that differ only in their coordinates.");
  }
  const unsigned char* skip = is.ghostCells();
  const auto stepAt = [&](double step)
  {
    const double steps = static_cast<double>(totals.metrics.size()) + 1.0; // including the checks
    return (totals.blocksDone + step / steps) / totals.blocks;
  };
  std::optional<ProgressStep> progress(std::in_place, this, stepAt(0.0), stepAt(1.0));
  constexpr std::size_t arrays = 3; // per metric
  requireMemory(static_cast<double>(is.mesh().view().numberOfCells) *
      static_cast<double>(arrays * totals.metrics.size() * sizeof(double)),
    "the arrays of " + std::to_string(totals.metrics.size()) + " metrics",
    "choose fewer metrics or compare the mesh in parts");
  output->ShallowCopy(after);
  totals.largestDisplacement = std::max(
    totals.largestDisplacement, addDisplacement(output, was.mesh().view(), is.mesh().view()));

  signed char* validBefore = addFlags(output, "Validity_before");
  signed char* validAfter = addFlags(output, "Validity_after");
  settleOrientation(was, is, validBefore, validAfter, this->Threads);
  const auto facesOf = [&](vtkDataSet* input, MeshAdapter& adapter, signed char* validity)
  {
    auto faces =
      makeFaceQuality({ input, &adapter }, totals.metrics, FaceConvention::Esi, this->Threads);
    if (faces)
    {
      faces->classify(validity);
    }
    return faces;
  };
  const auto facesBefore = facesOf(before, was, validBefore);
  const auto facesAfter = facesOf(after, is, validAfter);
  const Index cells = output->GetNumberOfCells();
  totals.invertedBefore += countValidity(validBefore, skip, cells).inverted;
  totals.invertedAfter += countValidity(validAfter, skip, cells).inverted;

  EvaluationOptions options;
  options.threads = this->Threads;
  const int dimension = is.mesh().dimension() == Dimension::Volume ? 3 : 2;
  const unsigned char* types = is.mesh().view().cellTypes;
  std::vector<signed char> change(cells);
  std::vector<char> better(cells, 0), worse(cells, 0);
  for (std::size_t m = 0; m < totals.metrics.size() && !this->GetAbortExecute(); ++m)
  {
    const MetricInfo& info = metricInfo(totals.metrics[m]);
    double* low = addCellArray(output, std::string(info.name) + "_before");
    double* high = addCellArray(output, std::string(info.name) + "_after");
    double* delta = addCellArray(output, std::string(info.name) + "_difference");
    const double step = static_cast<double>(m) + 1.0;
    progress.emplace(this, stepAt(step), stepAt(step + 1.0));
    if (info.family == MetricFamily::Faces)
    {
      facesBefore->measure(info.metric, low);
      facesAfter->measure(info.metric, high);
    }
    else
    {
      requireInRange(info, evaluateMetric(was.mesh(), info.metric, options, low));
      requireInRange(info, evaluateMetric(is.mesh(), info.metric, options, high));
    }
    compareMetric(info, dimension, { cells, low, validBefore, types, skip },
      { cells, high, validAfter, types, skip }, this->Tolerance, change.data(), totals.changes[m]);
    for (Index i = 0; i < cells; ++i)
    {
      delta[i] = high[i] - low[i];
      better[i] |= change[i] > 0;
      worse[i] |= change[i] < 0;
    }
  }
  totals.blocksDone += 1.0;
  progress.reset();
  signed char* verdict = addFlags(output, "Change");
  std::transform(better.begin(), better.end(), worse.begin(), verdict,
    [](char up, char down) { return static_cast<signed char>(up - down); });
  output->GetCellData()->SetActiveScalars("Change");
}

//------------------------------------------------------------------------------
void vtkMeshComparison::Tabulate(const Totals& totals, vtkDataObject* output)
{
  auto* table = vtkTable::SafeDownCast(output);
  table->Initialize();
  const vtkIdType rows = static_cast<vtkIdType>(totals.metrics.size());
  vtkNew<vtkStringArray> names;
  names->SetName("Metric");
  names->SetNumberOfValues(rows);
  table->AddColumn(names);
  auto column = [&](auto array, const char* name, auto value)
  {
    array->SetName(name);
    array->SetNumberOfTuples(rows);
    for (vtkIdType i = 0; i < rows; ++i)
    {
      array->SetValue(i, value(totals.changes[i]));
    }
    table->AddColumn(array);
  };
  using Change = tautline::MetricChange;
  auto counts = [&](const char* name, auto value)
  { column(vtkNew<vtkIdTypeArray>(), name, value); };
  auto values = [&](const char* name, auto value)
  { column(vtkNew<vtkDoubleArray>(), name, value); };
  counts("Better", [](const Change& c) { return c.better; });
  counts("Worse", [](const Change& c) { return c.worse; });
  counts("Equal", [](const Change& c) { return c.equal; });
  counts("InvertedBefore", [&](const Change&) { return totals.invertedBefore; });
  counts("InvertedAfter", [&](const Change&) { return totals.invertedAfter; });
  values("MinimumBefore", [](const Change& c) { return c.before.count ? c.before.minimum : 0; });
  values("MinimumAfter", [](const Change& c) { return c.after.count ? c.after.minimum : 0; });
  values("MeanBefore", [](const Change& c) { return c.before.mean(); });
  values("MeanAfter", [](const Change& c) { return c.after.mean(); });
  values("MaximumBefore", [](const Change& c) { return c.before.count ? c.before.maximum : 0; });
  values("MaximumAfter", [](const Change& c) { return c.after.count ? c.after.maximum : 0; });
  values("LargestDisplacement", [&](const Change&) { return totals.largestDisplacement; });

  std::ostringstream text;
  for (vtkIdType i = 0; i < rows; ++i)
  {
    const tautline::MetricInfo& info = tautline::metricInfo(totals.metrics[i]);
    const Change& change = totals.changes[i];
    names->SetValue(i, info.name);
    text << info.label << ": " << change.better << " better, " << change.worse << " worse, "
         << change.equal << " equal.\n";
  }
  text << "Inverted elements: " << totals.invertedBefore << " before, " << totals.invertedAfter
       << " after.";
  this->Summary = text.str();
}

//------------------------------------------------------------------------------
void vtkMeshComparison::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
}
