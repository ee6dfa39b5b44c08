// SPDX-License-Identifier: BSD-3-Clause
#include "PolyhedralMesh.h"

#include "Blocks.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkSignedCharArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <sstream>

namespace tautline
{
namespace
{
/// Gives the solid the point and cell arrays of a data set; the added points have zeros.
/// @param sources per cell of the solid, the cell of the data set
void giveArrays(vtkDataSet* from, const std::vector<Index>& sources, vtkUnstructuredGrid* solid)
{
  vtkPointData* points = solid->GetPointData();
  points->CopyAllOn();
  points->CopyAllocate(from->GetPointData(), solid->GetNumberOfPoints());
  for (vtkIdType i = 0; i < solid->GetNumberOfPoints(); ++i)
  {
    pollInterruption(i);
    if (i < from->GetNumberOfPoints())
    {
      points->CopyData(from->GetPointData(), i, i);
    }
    else
    {
      points->NullData(i);
    }
  }
  vtkCellData* cells = solid->GetCellData();
  cells->CopyAllOn();
  cells->CopyAllocate(from->GetCellData(), solid->GetNumberOfCells());
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    pollInterruption(static_cast<Index>(i));
    cells->CopyData(from->GetCellData(), sources[i], static_cast<vtkIdType>(i));
  }
}
}

//------------------------------------------------------------------------------
PolyhedralMesh::PolyhedralMesh(const InputBlock& block, int threads)
  : Given(block)
  , Threads(threads)
  , Adapter(block.input, threads)
  , Faces(
      [this, &block]() -> vtkDataSet*
      {
        if (!vtkPointSet::SafeDownCast(block.input))
        {
          throw Error("The points of the mesh are implicit (image data, rectilinear grid): run "
                      "Append Datasets or Threshold first to make them explicit.");
        }
        std::vector<signed char> validity(this->Adapter.mesh().view().numberOfCells);
        this->Adapter.mesh().classifyCells(validity.data(), this->Threads);
        this->Adapter.orient(validity.data(), false);
        return block.input;
      }(),
      this->Adapter, threads)
{
  if (this->Faces.extruded())
  {
    throw Error("The mesh is planar: choose another preset, which improves its elements.");
  }
  this->Notice = this->Faces.notice();
  this->makeSolid();
}

PolyhedralMesh::~PolyhedralMesh() = default;

//------------------------------------------------------------------------------
void PolyhedralMesh::makeSolid()
{
  const FaceMesh& mesh = this->Faces.mesh();
  const FaceGeometry geometry =
    faceGeometry(mesh, this->Faces.points(), FaceConvention::Esi, this->Threads);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.points + mesh.cells);
  for (Index i = 0; i < mesh.points; ++i)
  {
    points->SetPoint(i, this->Faces.points() + 3 * i);
  }
  for (Index cell = 0; cell < mesh.cells; ++cell)
  {
    points->SetPoint(mesh.points + cell, geometry.cellCenter[cell].data());
  }
  vtkNew<vtkCellArray> cells;
  std::vector<Index> sources;
  const auto add = [&](Index a, Index b, Index c, Index cell)
  {
    const vtkIdType nodes[] = { a, b, c, mesh.points + cell };
    cells->InsertNextCell(4, nodes);
    sources.push_back(this->Faces.cells()[cell]);
  };
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    pollInterruption(face);
    const Index* nodes = mesh.nodes.data() + mesh.offsets[face];
    for (Index i = 1; i + 1 < mesh.size(face); ++i)
    {
      add(nodes[0], nodes[i + 1], nodes[i], mesh.owner[face]);
      if (mesh.internal(face))
      {
        add(nodes[0], nodes[i], nodes[i + 1], mesh.neighbor[face]);
      }
    }
  }
  this->Solid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  this->Solid->SetPoints(points);
  this->Solid->SetCells(VTK_TETRA, cells);
  if (this->Given.selected)
  {
    this->Selected = vtkSmartPointer<vtkUnstructuredGrid>::New();
    this->Selected->CopyStructure(this->Solid);
    giveArrays(this->Given.selected, sources, this->Selected);
  }
  giveArrays(this->Given.input, sources, this->Solid);
}

//------------------------------------------------------------------------------
ImproveFacesResult PolyhedralMesh::improve(
  const BoundaryProperties& boundary, ImproveFacesOptions options)
{
  InputBlock block = this->Given;
  block.input = this->Solid;
  block.selected = this->Selected;
  MovableMesh movable(this->Solid, this->Threads, false);
  BoundaryProperties properties = boundary;
  if (properties.motion == BoundaryMotion::Fixed && !properties.freeInvalid)
  {
    // The sides of a single layer do not count as its boundary.
    properties.motion = BoundaryMotion::Free;
    options.patchesStay = true;
  }
  const BoundarySetup setup(properties, block, movable);
  const Mesh& start = setup.start();
  options.facts = this->Faces.facts();
  options.threads = this->Threads;
  ImproveFacesResult result =
    improveFaces(this->Faces.mesh(), start.view().points, start, setup.constraints(), options);
  const std::string features = setup.describeFeatures();
  this->Notice += (this->Notice.empty() || features.empty() ? "" : " ") + features;
  return result;
}

//------------------------------------------------------------------------------
std::vector<signed char> PolyhedralMesh::move(
  vtkPointSet* output, const ImproveFacesResult& result) const
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(result.points.size() / 3));
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    points->SetPoint(i, result.points.data() + 3 * i);
  }
  addDisplacement(output, this->Adapter.inputView().points, result.points);
  output->SetPoints(points);
  const std::vector<signed char> found = this->validityAt(result.points.data());
  vtkNew<vtkSignedCharArray> validity;
  validity->SetName("Validity");
  validity->SetNumberOfValues(output->GetNumberOfCells());
  std::copy(found.begin(), found.end(), validity->GetPointer(0));
  output->GetCellData()->AddArray(validity);
  return found;
}

//------------------------------------------------------------------------------
void PolyhedralMesh::addMeasures(vtkPointSet* output, const ImproveFacesResult& result) const
{
  this->addMeasures(output, this->Faces.points(), "_before");
  this->addMeasures(output, result.points.data(), "");
  output->GetCellData()->SetActiveScalars(metricInfo(Metric::NonOrthogonality).name);
}

//------------------------------------------------------------------------------
void PolyhedralMesh::addMeasures(
  vtkPointSet* output, const double* points, const char* ending) const
{
  const FaceMeasures measures(this->Faces.mesh(), points, FaceConvention::Esi, this->Threads);
  for (Metric metric : { Metric::NonOrthogonality, Metric::FaceSkewness })
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName((std::string(metricInfo(metric).name) + ending).c_str());
    array->SetNumberOfValues(output->GetNumberOfCells());
    array->FillValue(0);
    const std::vector<double> values = measures.evaluate(metric).cells;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      array->SetValue(this->Faces.cells()[i], std::isfinite(values[i]) ? values[i] : 0.0);
    }
    output->GetCellData()->AddArray(array);
  }
}

//------------------------------------------------------------------------------
std::vector<signed char> PolyhedralMesh::validityAt(const double* points) const
{
  const FaceMeasures measures(this->Faces.mesh(), points, FaceConvention::Esi, this->Threads);
  const std::vector<signed char> found = measures.validity();
  std::vector<signed char> all(this->Given.input->GetNumberOfCells(), NotMeasured);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    all[this->Faces.cells()[i]] = found[i];
  }
  return all;
}

//------------------------------------------------------------------------------
bool hasPolyhedra(vtkDataObject* input)
{
  bool found = false;
  forEachLeaf(input,
    [&found](unsigned int, vtkDataSet* data)
    {
      auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
      const vtkUnsignedCharArray* types = grid ? grid->GetCellTypesArray() : nullptr;
      for (vtkIdType cell = 0; types && !found && cell < types->GetNumberOfValues(); ++cell)
      {
        found = types->GetValue(cell) == VTK_POLYHEDRON;
      }
    });
  return found;
}

//------------------------------------------------------------------------------
std::string summarize(const ImproveFacesResult& result)
{
  std::ostringstream text;
  text << (result.reason == StopReason::AllValid ? "All faces reach the targets."
                                                 : describe(result.reason))
       << " checkMesh before: " << result.before.verdict(false)
       << " After: " << result.after.verdict(false)
       << " With all checks, before: " << result.before.verdict(true)
       << " After: " << result.after.verdict(true) << "\n"
       << result.rounds << " rounds, " << result.iterations << " iterations, " << result.freePoints
       << " points could move. Faces beyond the targets: " << result.wantingBefore << " before, "
       << result.wantingAfter << " after.";
  for (MeshCheckKind kind : { MeshCheckKind::NonOrthogonality, MeshCheckKind::FaceSkewness })
  {
    const MeshCheck &before = result.before[kind], &after = result.after[kind];
    text << "\n"
         << after.label << ": largest " << before.most << " before, " << after.most << " after.";
  }
  for (std::size_t i = 0; i < result.after.checks.size(); ++i)
  {
    const MeshCheck &before = result.before.checks[i], &after = result.after.checks[i];
    if (before.failed() || after.failed())
    {
      text << "\nFailed: " << after.label << ": " << before.offending << " before, "
           << after.offending << " after" << (after.thorough ? "; on request only." : ".");
    }
  }
  return text.str();
}
}
