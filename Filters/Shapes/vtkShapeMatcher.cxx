// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShapeMatcher.h"

#include "GatheredExecution.h"
#include "Processes.h"
#include "ShapeAdapter.h"
#include "TableRows.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <memory>
#include <sstream>

vtkStandardNewMacro(vtkShapeMatcher);

namespace
{
/// The source and the positions of its vertices in space.
struct Source
{
  tautline::ShapeSource shape;
  std::vector<std::array<double, 3>> places;
  std::vector<tautline::Index> pointIds; ///< of a source mesh
};

Source takeSource(vtkDataObject* input, double spacing, tautline::Foreground foreground)
{
  Source source;
  if (vtkImageData* picture = vtkImageData::SafeDownCast(input))
  {
    const tautline::GreyImage image(picture);
    tautline::SilhouetteOptions options;
    options.foreground = foreground;
    source.shape =
      tautline::makeShapeSource(tautline::traceSilhouette(image.view(), options), spacing);
    for (const tautline::Vec2& p : source.shape.mesh.points)
    {
      source.places.emplace_back();
      image.toSpace(p, source.places.back().data());
    }
    return source;
  }
  vtkDataSet* mesh = vtkDataSet::SafeDownCast(input);
  tautline::SourceMesh taken = tautline::takeSourceMesh(mesh);
  for (tautline::Index id : taken.pointIds)
  {
    source.places.emplace_back();
    mesh->GetPoint(id, source.places.back().data());
  }
  source.shape = std::move(taken.source);
  source.pointIds = std::move(taken.pointIds);
  return source;
}

vtkSmartPointer<vtkDoubleArray> makeArray(const char* name, int components, vtkIdType size)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(size);
  return array;
}

void addTriangleTerms(
  vtkUnstructuredGrid* grid, const tautline::ShapeMatch& match, const tautline::ShapeEnergy& energy)
{
  const vtkIdType n = static_cast<vtkIdType>(match.triangles.size());
  auto edge = makeArray("EdgeCost", 1, n), deformation = makeArray("Deformation", 1, n),
       distortion = makeArray("Distortion", 1, n), sum = makeArray("Energy", 1, n);
  for (vtkIdType t = 0; t < n; ++t)
  {
    const tautline::TriangleEnergy& terms = match.triangles[t];
    edge->SetValue(t, terms.edge);
    deformation->SetValue(t, terms.deformation);
    distortion->SetValue(t, terms.distortion);
    sum->SetValue(t,
      terms.edge + energy.deformation * terms.deformation + energy.distortion * terms.distortion +
        energy.rotation * terms.rotation);
  }
  for (vtkDoubleArray* array : { edge.Get(), deformation.Get(), distortion.Get(), sum.Get() })
  {
    grid->GetCellData()->AddArray(array);
  }
  grid->GetCellData()->SetActiveScalars("Energy");
}

/// Adds the arrays of a source mesh, the orders of the vertices, and Displacement.
void addPointData(vtkUnstructuredGrid* grid, const Source& source, vtkDataSet* input)
{
  const vtkIdType n = grid->GetNumberOfPoints();
  if (!source.pointIds.empty())
  {
    vtkPointData* from = input->GetPointData();
    grid->GetPointData()->CopyAllocate(from, n);
    for (vtkIdType i = 0; i < n; ++i)
    {
      grid->GetPointData()->CopyData(from, source.pointIds[i], i);
    }
  }
  tautline::addOrders(grid, source.shape.mesh);
  auto displacement = makeArray("Displacement", 3, n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    const double* x = grid->GetPoint(i);
    for (int c = 0; c < 3; ++c)
    {
      displacement->SetComponent(i, c, x[c] - source.places[i][c]);
    }
  }
  grid->GetPointData()->AddArray(displacement);
}

/// Fills one row. @param tolerance the accepted distance from the center of mass, in pixels
void fillStatistics(const tautline::ShapeMatch& match, double tolerance, vtkTable* table)
{
  tautline::TableRows rows;
  rows.begin();
  rows.add("Energy", match.energy);
  rows.add("EdgeCost", match.edge);
  rows.add("Deformation", match.deformation);
  rows.add("Distortion", match.distortion);
  rows.add("Rotation", match.rotation);
  rows.add("Descriptor", match.descriptor);
  rows.add("Ordering", match.ordering);
  rows.add("Rank", static_cast<double>(match.rank));
  rows.add("CentreDistance", match.centreDistance);
  rows.add("CentreTolerance", tolerance);
  rows.add("CentreAccepted", match.centreAccepted);
  rows.add("Mirrored", match.mirrored);
  rows.add("Angle", match.angle);
  rows.add("Scale", match.scale);
  rows.add("Exact", match.exact);
  rows.add("Stop", static_cast<double>(match.stop));
  rows.fill(table);
}

std::string summaryOf(const tautline::ShapeMatch& match, double tolerance)
{
  std::ostringstream text;
  text << "Energy " << match.energy << ": edges " << match.edge << ", deformation "
       << match.deformation << ", distortion " << match.distortion << " (unweighted); solution "
       << match.rank << ", center off by " << match.centreDistance << " of " << tolerance
       << " pixels.";
  if (match.stop != tautline::MatchStop::Complete)
  {
    text << " Stopped early: this is the best result so far.";
  }
  else if (!match.centreAccepted)
  {
    text << " None of the solutions tried is close enough to the center of mass.";
  }
  return text.str();
}
}

//------------------------------------------------------------------------------
vtkShapeMatcher::vtkShapeMatcher()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
void vtkShapeMatcher::SetTargetData(vtkImageData* image)
{
  this->SetInputDataInternal(1, image);
}

//------------------------------------------------------------------------------
int vtkShapeMatcher::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkDataSet" : "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkShapeMatcher::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkShapeMatcher::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // Each image is used as a whole, because the sizes differ.
  for (int port = 0; port < 2; ++port)
  {
    vtkInformation* info = inputVector[port]->GetInformationObject(0);
    if (info && info->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
    {
      info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
        info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkShapeMatcher::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataSet* input = vtkDataSet::GetData(inputVector[0]);
  vtkImageData* targetInput = vtkImageData::GetData(inputVector[1]);
  this->ClearResult();
  const bool alone = this->Attempt(outputVector, "run ParaView with one process",
    [&]
    {
      tautline::requireFirstProcess(this, 0, input, "Match Shape");
      tautline::requireFirstProcess(this, 1, targetInput, "Match Shape");
    });
  if (!alone)
  {
    return 0;
  }
  if (!input || !targetInput || input->GetNumberOfPoints() == 0 ||
    targetInput->GetNumberOfPoints() == 0)
  {
    return 1;
  }
  return this->Attempt(outputVector, "choose a coarser grid or a larger spacing",
    [&]
    {
      vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
      tautline::SilhouetteOptions tracing;
      tracing.foreground = static_cast<tautline::Foreground>(this->Foreground);
      const Source source = takeSource(input, this->Spacing, tracing.foreground);
      const tautline::GreyImage image(targetInput);
      const tautline::ImageView view = image.view();
      tautline::LocationOptions locations;
      tautline::MatchOptions options;
      this->GetOptions(locations, options);
      const tautline::ShapeTarget target(tautline::traceSilhouette(view, tracing), locations,
        options.energy, this->GreyGradient ? &view : nullptr);
      options.timeLimit = this->GetRemainingSeconds();
      this->Matching = true;
      const tautline::ShapeMatch match = tautline::matchShape(source.shape, target, options);

      tautline::fillGrid(output, source.shape.mesh, match.points, image);
      addPointData(output, source, input);
      addTriangleTerms(output, match, options.energy);
      const double tolerance = this->CentreTolerance * target.maxDistance();
      fillStatistics(match, tolerance, vtkTable::GetData(outputVector, 1));
      this->Energy = match.energy;
      this->Rank = static_cast<int>(match.rank);
      this->CentreDistance = match.centreDistance;
      this->Exact = match.exact;
      this->Summary = summaryOf(match, tolerance);
    });
}

//------------------------------------------------------------------------------
bool vtkShapeMatcher::NeedsFinitePoints(int) const
{
  return true;
}

//------------------------------------------------------------------------------
void vtkShapeMatcher::ClearResult()
{
  this->Superclass::ClearResult();
  this->Energy = this->CentreDistance = 0.0;
  this->Rank = 0;
  this->Exact = false;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkShapeMatcher::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::OnFirst;
  return rules;
}

//------------------------------------------------------------------------------
void vtkShapeMatcher::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Energy, this->Rank, this->CentreDistance, this->Exact);
}

//------------------------------------------------------------------------------
void vtkShapeMatcher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Spacing: " << this->Spacing << "\n";
  os << indent << "GreyGradient: " << this->GreyGradient << "\n";
}
