// SPDX-License-Identifier: BSD-3-Clause
#include "FaceQuality.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedIntArray.h"

#include <algorithm>
#include <unordered_map>

namespace tautline
{
namespace
{
template <class Array>
vtkSmartPointer<Array> faceArray(vtkPolyData* output, const std::string& name, std::size_t faces)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name.c_str());
  array->SetNumberOfValues(static_cast<vtkIdType>(faces));
  output->GetCellData()->AddArray(array);
  return array;
}
}

//------------------------------------------------------------------------------
FaceQuality::FaceQuality(vtkDataSet* input, std::unique_ptr<FaceMeshAdapter> adapter,
  FaceConvention convention, int threads)
  : Input(input)
  , Adapter(std::move(adapter))
  , Measures(this->Adapter->mesh(), this->Adapter->points(), convention, threads)
{
}

//------------------------------------------------------------------------------
const std::string& FaceQuality::classify(signed char* validity) const
{
  const std::vector<signed char> found = this->Measures.validity();
  for (std::size_t i = 0; i < this->Adapter->cells().size(); ++i)
  {
    signed char& value = validity[this->Adapter->cells()[i]];
    value = value == NotMeasured ? found[i] : value;
  }
  return this->Adapter->notice();
}

//------------------------------------------------------------------------------
void FaceQuality::measure(Metric metric, double* values)
{
  FaceValues found = this->Measures.evaluate(metric);
  std::fill_n(values, this->Input->GetNumberOfCells(), 0.0);
  for (std::size_t i = 0; i < this->Adapter->cells().size(); ++i)
  {
    // The value for cells without faces, and if points are not finite.
    values[this->Adapter->cells()[i]] = std::isfinite(found.cells[i]) ? found.cells[i] : 0.0;
  }
  if (!found.faces.empty())
  {
    this->FaceValuesOf.emplace_back(metric, std::move(found.faces));
  }
}

//------------------------------------------------------------------------------
MeshCheckReport& FaceQuality::check()
{
  if (!this->Checked)
  {
    this->Report = checkMesh(this->Measures, this->Adapter->points(), this->Adapter->facts());
    this->Checked = true;
  }
  return this->Report;
}

//------------------------------------------------------------------------------
/// Per face the checks that it or one of its cells fails.
std::vector<std::uint32_t> FaceQuality::failures() const
{
  const FaceMesh& mesh = this->Adapter->mesh();
  std::vector<std::uint32_t> failed = this->Report.faces;
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    failed[face] |= this->Report.cells[mesh.owner[face]] |
      (mesh.internal(face) ? this->Report.cells[mesh.neighbor[face]] : 0);
  }
  return failed;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> FaceQuality::faces(bool all) const
{
  const FaceMesh& mesh = this->Adapter->mesh();
  const std::vector<std::uint32_t> failed = this->failures();
  std::vector<Index> chosen;
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    // Failures seen from the other piece are not known here.
    const bool other = mesh.has(face, OnBorder) && mesh.touches(face) && failed[face] && !all;
    if ((mesh.ownsFace(face) && (all || failed[face])) || other)
    {
      chosen.push_back(face);
    }
  }
  auto output = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  std::unordered_map<Index, vtkIdType> made;
  for (const Index face : chosen)
  {
    polygons->InsertNextCell(static_cast<int>(mesh.size(face)));
    for (Index i = mesh.offsets[face]; i < mesh.offsets[face + 1]; ++i)
    {
      const auto entry = made.emplace(mesh.nodes[i], points->GetNumberOfPoints());
      if (entry.second)
      {
        points->InsertNextPoint(this->Adapter->points() + 3 * mesh.nodes[i]);
      }
      polygons->InsertCellPoint(entry.first->second);
    }
  }
  output->SetPoints(points);
  output->SetPolys(polygons);

  std::vector<int> patchOf(mesh.faces(), -1);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
  {
    std::fill_n(patchOf.begin() + mesh.patches[p].first, mesh.patches[p].count, p);
  }
  const std::vector<double> weights = this->Measures.ownerWeights();
  const auto numbers = faceArray<vtkIdTypeArray>(output, "Face", chosen.size());
  const auto owners = faceArray<vtkIdTypeArray>(output, "Owner", chosen.size());
  const auto neighbors = faceArray<vtkIdTypeArray>(output, "Neighbour", chosen.size());
  const auto patches = faceArray<vtkIntArray>(output, "Patch", chosen.size());
  const auto failures = faceArray<vtkUnsignedIntArray>(output, "Failed", chosen.size());
  const auto ownerWeights = faceArray<vtkDoubleArray>(output, "OwnerWeight", chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
  {
    const auto row = static_cast<vtkIdType>(i);
    const Index face = chosen[i];
    numbers->SetValue(row, face);
    owners->SetValue(row, this->Adapter->cells()[mesh.owner[face]]);
    neighbors->SetValue(
      row, mesh.internal(face) ? this->Adapter->cells()[mesh.neighbor[face]] : -1);
    patches->SetValue(row, mesh.has(face, OnBorder) ? -1 : patchOf[face]);
    failures->SetValue(row, failed[face]);
    ownerWeights->SetValue(row, weights[face]);
  }
  for (const auto& [metric, values] : this->FaceValuesOf)
  {
    const auto array = faceArray<vtkDoubleArray>(output, metricInfo(metric).name, chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i)
    {
      array->SetValue(static_cast<vtkIdType>(i), values[chosen[i]]);
    }
  }
  if (!this->FaceValuesOf.empty())
  {
    output->GetCellData()->SetActiveScalars(metricInfo(this->FaceValuesOf.front().first).name);
  }
  return output;
}

namespace
{
/// Whether a mesh has cells that only finite-volume metrics support: polyhedra, and polygons in a
/// planar mesh.
bool hasPolyhedra(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  return mesh.polyhedra() > 0 ||
    (mesh.unsupportedCells() > 0 && mesh.dimension() == Dimension::Planar &&
      std::find(view.cellTypes, view.cellTypes + view.numberOfCells, VTK_POLYGON) !=
        view.cellTypes + view.numberOfCells);
}
}

//------------------------------------------------------------------------------
bool measuresElementsOnly(const std::vector<Metric>& metrics)
{
  return std::all_of(metrics.begin(), metrics.end(),
    [](Metric metric) { return metricInfo(metric).family != MetricFamily::Faces; });
}

//------------------------------------------------------------------------------
std::vector<std::unique_ptr<FaceQuality>> makeFaceQuality(RankGroup& group,
  const std::vector<FaceInput>& pieces, const std::vector<Metric>& metrics,
  FaceConvention convention, int threads)
{
  const auto anyPiece = [&](const auto& condition)
  {
    return group.any(std::any_of(pieces.begin(), pieces.end(),
      [&](const FaceInput& piece) { return condition(piece.adapter->mesh()); }));
  };
  const bool wanted = std::any_of(metrics.begin(), metrics.end(),
    [](Metric metric) { return metricInfo(metric).family == MetricFamily::Faces; });
  const bool polygons = wanted &&
    anyPiece([](const Mesh& mesh)
      { return mesh.unsupportedCells() > 0 && mesh.dimension() != Dimension::Volume; });
  if (polygons)
  {
    setSpaceWithPolygons(group, pieces);
  }
  std::vector<std::unique_ptr<FaceQuality>> made;
  if (!wanted && !anyPiece(hasPolyhedra))
  {
    return made;
  }
  auto adapters = FaceMeshAdapter::ofPieces(group, pieces, threads);
  std::vector<FaceMeasures*> measures;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    made.push_back(
      std::make_unique<FaceQuality>(pieces[i].data, std::move(adapters[i]), convention, threads));
    measures.push_back(&made.back()->measures());
  }
  joinMeasures(group, measures);
  return made;
}

//------------------------------------------------------------------------------
std::unique_ptr<FaceQuality> makeFaceQuality(
  const FaceInput& mesh, const std::vector<Metric>& metrics, FaceConvention convention, int threads)
{
  SingleRank alone;
  auto made = makeFaceQuality(alone, { mesh }, metrics, convention, threads);
  return made.empty() ? nullptr : std::move(made.front());
}
}
