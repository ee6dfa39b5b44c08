#include "vtkShapeMatcher.h"

#include "ShapeAdapter.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <memory>
#include <sstream>

vtkStandardNewMacro(vtkShapeMatcher);

namespace
{
/// The source, and where its vertices are in space.
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
int vtkShapeMatcher::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataSet* input = vtkDataSet::GetData(inputVector[0]);
  vtkImageData* targetInput = vtkImageData::GetData(inputVector[1]);
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkTable* statistics = vtkTable::GetData(outputVector, 1);
  this->Summary.clear();
  this->Energy = this->CentreDistance = 0.0;
  this->Rank = 0;
  this->Exact = false;
  if (!input || !targetInput || input->GetNumberOfPoints() == 0 ||
    targetInput->GetNumberOfPoints() == 0)
  {
    return 1;
  }
  try
  {
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
    const tautline::ShapeMatch match = tautline::matchShape(source.shape, target, options);

    tautline::fillGrid(output, source.shape.mesh, match.points, image);
    const vtkIdType n = output->GetNumberOfPoints();
    if (!source.pointIds.empty())
    {
      vtkPointData* from = input->GetPointData();
      output->GetPointData()->CopyAllocate(from, n);
      for (vtkIdType i = 0; i < n; ++i)
      {
        output->GetPointData()->CopyData(from, source.pointIds[i], i);
      }
    }
    tautline::addOrders(output, source.shape.mesh);
    auto displacement = makeArray("Displacement", 3, n);
    for (vtkIdType i = 0; i < n; ++i)
    {
      const double* x = output->GetPoint(i);
      for (int c = 0; c < 3; ++c)
      {
        displacement->SetComponent(i, c, x[c] - source.places[i][c]);
      }
    }
    output->GetPointData()->AddArray(displacement);
    addTriangleTerms(output, match, options.energy);

    const double theta = this->CentreTolerance * target.maxDistance();
    const std::pair<const char*, double> columns[] = { { "Energy", match.energy },
      { "EdgeCost", match.edge }, { "Deformation", match.deformation },
      { "Distortion", match.distortion }, { "Rotation", match.rotation },
      { "Descriptor", match.descriptor }, { "Ordering", match.ordering },
      { "Rank", static_cast<double>(match.rank) }, { "CentreDistance", match.centreDistance },
      { "CentreTolerance", theta }, { "CentreAccepted", match.centreAccepted ? 1.0 : 0.0 },
      { "Mirrored", match.mirrored ? 1.0 : 0.0 }, { "Angle", match.angle },
      { "Scale", match.scale }, { "Exact", match.exact ? 1.0 : 0.0 },
      { "Stop", static_cast<double>(match.stop) } };
    for (const auto& [name, value] : columns)
    {
      auto column = makeArray(name, 1, 1);
      column->SetValue(0, value);
      statistics->AddColumn(column);
    }
    this->Energy = match.energy;
    this->Rank = static_cast<int>(match.rank);
    this->CentreDistance = match.centreDistance;
    this->Exact = match.exact;
    std::ostringstream text;
    text << "Energy " << match.energy << ": edges " << match.edge << ", deformation "
         << match.deformation << ", distortion " << match.distortion << " (unweighted); solution "
         << match.rank << ", centre off by " << match.centreDistance << " of " << theta
         << " pixels.";
    if (match.stop != tautline::MatchStop::Complete)
    {
      text << " Ended early: the best so far.";
    }
    else if (!match.centreAccepted)
    {
      text << " No solution tried is close enough to the centre of mass.";
    }
    this->Summary = text.str();
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    statistics->Initialize();
    vtkErrorMacro(<< error.what());
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkShapeMatcher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Spacing: " << this->Spacing << "\n";
  os << indent << "GreyGradient: " << this->GreyGradient << "\n";
  os << indent << "Summary: " << this->Summary << "\n";
}
