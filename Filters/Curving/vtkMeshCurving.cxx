// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshCurving.h"

#include "Blocks.h"
#include "CurvedFacts.h"
#include "CurvedGrid.h"
#include "GatheredExecution.h"
#include "GeometrySurface.h"
#include "MeshAdapter.h"
#include "PointMerge.h"
#include "tautline/Curved/UntangleCurved.h"
#include "tautline/Curving/CurveMesh.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkMeshCurving);

namespace
{
enum Ports
{
  MeshPort,
  GeometryPort,
  NumberOfInputPorts
};
constexpr int RegionArray = 0;
constexpr const char* FilterName = "Curve Mesh"; // in the menu

/// The values of a cell array with one component; empty without one.
std::vector<double> valuesOf(vtkDataArray* array)
{
  std::vector<double> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetComponent(i, 0));
  }
  return values;
}

vtkIdType countInvalid(const std::vector<signed char>& validity)
{
  return std::count_if(validity.begin(), validity.end(), tautline::isInvalid);
}

std::string counted(vtkIdType n, const char* one, const char* many)
{
  return std::to_string(n) + " " + (n == 1 ? one : many);
}
}

//------------------------------------------------------------------------------
vtkMeshCurving::vtkMeshCurving()
{
  this->DeclarePorts(NumberOfInputPorts, 1);
}

//------------------------------------------------------------------------------
vtkMeshCurving::~vtkMeshCurving() = default;

//------------------------------------------------------------------------------
int vtkMeshCurving::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int succeeded = this->Superclass::RequestDataObject(request, inputVector, outputVector);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  // No other data set holds curved cells.
  if (vtkDataSet::SafeDownCast(output) && !vtkUnstructuredGrid::SafeDownCast(output))
  {
    vtkNew<vtkUnstructuredGrid> grid;
    outputVector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), grid);
  }
  return succeeded;
}

//------------------------------------------------------------------------------
bool vtkMeshCurving::NeedsFinitePoints(int) const
{
  return true;
}

//------------------------------------------------------------------------------
int vtkMeshCurving::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ClearResult();
  this->SetProgressText(FilterName);
  return this->Attempt(outputVector, "curve the mesh in parts",
    [&]
    {
      const auto input = tautline::asGrids(vtkDataObject::GetData(inputVector[MeshPort]));
      vtkDataObject* geometry = vtkDataObject::GetData(inputVector[GeometryPort]);
      tautline::forEachBlock(input, nullptr, nullptr, vtkDataObject::GetData(outputVector),
        [&](const tautline::InputBlock& block)
        {
          if (block.input->GetNumberOfPoints() == 0 || block.input->GetNumberOfCells() == 0)
          {
            block.output->ShallowCopy(block.input);
            return;
          }
          this->Curve(block, geometry);
        });
    });
}

//------------------------------------------------------------------------------
void vtkMeshCurving::Curve(const tautline::InputBlock& block, vtkDataObject* geometry)
{
  tautline::MeshAdapter adapter(block.input, this->Threads);
  if (this->MergeCoincidentPoints)
  {
    adapter.joinCopies(block.input->GetPointData()->GetGlobalIds());
    adapter.mergeCoincidentPoints(this->Threads);
  }
  adapter.enterFrame();
  const tautline::Dimension dimension = adapter.mesh().dimension();
  if (dimension == tautline::Dimension::None)
  {
    throw tautline::Error("There is no element to curve. " + adapter.notice());
  }
  tautline::CurvingOptions options;
  options.order = this->Order;
  options.serendipity = this->Serendipity;
  options.smooth = this->Surface == SMOOTH;
  options.featureAngle = this->FeatureAngle;
  options.threads = this->Threads;
  const std::vector<double> regions = valuesOf(
    tautline::chosenArray(this, RegionArray, block.input, "of regions", tautline::ArrayOf::Cells));
  options.regions = regions.empty() ? nullptr : regions.data();
  std::unique_ptr<tautline::GeometrySurface> surface;
  if (geometry)
  {
    surface = std::make_unique<tautline::GeometrySurface>(tautline::counterpartOf(block, geometry),
      adapter.frame(), dimension == tautline::Dimension::Planar, this->Threads);
    options.geometry = &surface->mesh();
  }
  const int blocks = tautline::countBlocks(this->GetInputDataObject(0, 0));
  options.progress = [this, &block, blocks](double fraction)
  { return this->Proceed((block.number + fraction) / blocks); };
  const std::string oriented = adapter.orient(nullptr, false);
  vtkIdType invalidBefore = 0;
  const tautline::CurvingResult curved = this->Run(block, adapter, options, invalidBefore);
  tautline::writeCurved(
    curved, adapter, block.input, vtkUnstructuredGrid::SafeDownCast(block.output));
  this->Report(block, adapter, curved, invalidBefore);
  this->AddToSummary(oriented);
}

//------------------------------------------------------------------------------
/// Curves a block, and repairs the result if requested.
tautline::CurvingResult vtkMeshCurving::Run(const tautline::InputBlock& block,
  const tautline::MeshAdapter& adapter, tautline::CurvingOptions& options, vtkIdType& invalidBefore)
{
  const tautline::Mesh& mesh = adapter.mesh();
  const tautline::CurvedFacts facts(block.input, adapter);
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), this->Threads);
  tautline::certifyCurvedCells(mesh, facts, validity.data(), nullptr, this->Threads);
  invalidBefore = countInvalid(validity);

  tautline::MeshView cells = adapter.inputView();
  cells.points = mesh.view().points;
  const std::vector<tautline::Index>& one = adapter.coincident().representative;
  options.representative = one.empty() ? nullptr : one.data();
  tautline::CurvingResult curved = tautline::curveMesh(mesh, cells, facts, options);
  if (this->Repair && countInvalid(curved.validity) > invalidBefore)
  {
    this->RepairResult(curved, adapter);
  }
  return curved;
}

//------------------------------------------------------------------------------
/// Moves the nodes around invalid cells.
void vtkMeshCurving::RepairResult(
  tautline::CurvingResult& curved, const tautline::MeshAdapter& adapter)
{
  const bool surface = adapter.mesh().dimension() == tautline::Dimension::Surface;
  if (surface || !adapter.reversedCells().empty())
  {
    return; // reversed cells are listed as in the input, and have no common orientation
  }
  tautline::MeshView view;
  view.numberOfPoints = static_cast<tautline::Index>(curved.points.size() / 3);
  view.points = curved.points.data();
  view.numberOfCells = static_cast<tautline::Index>(curved.types.size());
  view.cellTypes = curved.types.data();
  view.offsets = curved.offsets.data();
  view.connectivity = curved.connectivity.data();
  tautline::Mesh mesh(view, this->Threads);
  mesh.setMirrored(adapter.mesh().mirrored());
  tautline::CurvedOptions options;
  options.featureAngle = this->FeatureAngle;
  options.threads = this->Threads;
  options.maximumSeconds = this->GetRemainingSeconds();
  options.observer = [this](const tautline::IterationState& state)
  { return this->Proceed(state.progress); };
  tautline::CurvedUntangleResult repaired = tautline::untangleCurved(mesh, options);
  for (tautline::Index p = 0; p < view.numberOfPoints; ++p)
  {
    this->RepairedNodes +=
      !std::equal(&repaired.points[3 * p], &repaired.points[3 * p] + 3, &curved.points[3 * p]);
  }
  curved.points = std::move(repaired.points);
  tautline::certifyCurvedCells(
    mesh.at(curved.points.data()), {}, curved.validity.data(), nullptr, this->Threads);
}

//------------------------------------------------------------------------------
void vtkMeshCurving::ClearResult()
{
  this->Superclass::ClearResult();
  this->AddedNodes = this->InvalidBefore = this->InvalidAfter = this->RepairedNodes = 0;
  this->LargestOffset = this->MeanOffset = this->DistanceBefore = this->DistanceAfter = 0.0;
}

//------------------------------------------------------------------------------
void vtkMeshCurving::Report(const tautline::InputBlock& block, const tautline::MeshAdapter& adapter,
  const tautline::CurvingResult& curved, vtkIdType invalidBefore)
{
  const double unit = adapter.frame().unit();
  const auto added = static_cast<vtkIdType>(curved.starts.size()) - 1;
  const vtkIdType invalid = countInvalid(curved.validity);
  const auto dropped =
    static_cast<vtkIdType>(adapter.mesh().view().numberOfPoints - curved.kept.size());
  std::ostringstream text;
  text << (block.name.empty() ? "" : "In " + block.name + ": ")
       << counted(static_cast<vtkIdType>(curved.types.size()), "cell", "cells") << " of order "
       << this->Order << ": " << counted(added, "node", "nodes") << " added";
  if (dropped > 0)
  {
    text << ", " << counted(dropped, "node", "nodes") << " of curved cells dropped";
  }
  text << ".\nInvalid elements, certified: " << invalidBefore << " before, " << invalid
       << " after.";
  if (invalid > 0)
  {
    text << " Untangle Mesh moves nodes to repair them.";
  }
  if (this->RepairedNodes > 0)
  {
    text << "\n" << counted(this->RepairedNodes, "node", "nodes") << " moved to make cells valid.";
  }
  if (this->Order > 1 && this->Surface == SMOOTH)
  {
    text << "\nFeatures: " << counted(curved.corners, "corner", "corners") << ", "
         << counted(curved.curves, "curve", "curves") << ", "
         << counted(curved.patches, "patch", "patches") << ".";
    if (curved.curvedBefore > 0)
    {
      text << "\nThe mesh has "
           << counted(curved.curvedBefore, "cell that is curved", "cells that are curved")
           << " already: its shape is kept. To reconstruct a smooth surface from its corners, run "
              "Curve Mesh with order 1 first.";
    }
    text << "\nOffset of the boundary's nodes: largest " << unit * curved.largestOffset << ", mean "
         << unit * curved.meanOffset << ".";
  }
  if (this->GetNumberOfInputConnections(GeometryPort) > 0)
  {
    text << "\nLargest distance of the boundary from the Geometry: " << unit * curved.distanceBefore
         << " before, " << unit * curved.distanceAfter << " after.";
  }
  this->AddToSummary(text.str());
  this->AddToSummary(tautline::describeMerged(adapter.coincident(), adapter.given()));
  this->AddedNodes += added;
  this->InvalidBefore += invalidBefore;
  this->InvalidAfter += invalid;
  this->LargestOffset = std::max(this->LargestOffset, unit * curved.largestOffset);
  this->MeanOffset = std::max(this->MeanOffset, unit * curved.meanOffset);
  this->DistanceBefore = std::max(this->DistanceBefore, unit * curved.distanceBefore);
  this->DistanceAfter = std::max(this->DistanceAfter, unit * curved.distanceAfter);
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshCurving::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::NewMesh;
  rules.joinsPartitions = this->MergeCoincidentPoints || this->PartitionsHaveIds();
  return rules;
}

//------------------------------------------------------------------------------
void vtkMeshCurving::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->AddedNodes, this->InvalidBefore, this->InvalidAfter, this->LargestOffset,
    this->MeanOffset, this->DistanceBefore, this->DistanceAfter);
}

//------------------------------------------------------------------------------
void vtkMeshCurving::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Order: " << this->Order << "\n";
  os << indent << "Serendipity: " << this->Serendipity << "\n";
  os << indent << "Surface: " << this->Surface << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "Repair: " << this->Repair << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
}
