// SPDX-License-Identifier: BSD-3-Clause
#include "RestingMesh.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace tautline
{
namespace
{
bool sameMesh(const MeshView& a, const MeshView& b)
{
  return a.numberOfPoints == b.numberOfPoints && a.numberOfCells == b.numberOfCells &&
    std::equal(a.points, a.points + 3 * a.numberOfPoints, b.points) &&
    std::equal(a.cellTypes, a.cellTypes + a.numberOfCells, b.cellTypes) &&
    std::equal(a.offsets, a.offsets + a.numberOfCells + 1, b.offsets) &&
    std::equal(a.connectivity, a.connectivity + a.offsets[a.numberOfCells], b.connectivity);
}
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPointSet> structureOf(vtkPointSet* input)
{
  auto copy = vtkSmartPointer<vtkPointSet>::Take(input->NewInstance());
  copy->CopyStructure(input);
  if (vtkUnsignedCharArray* ghosts = input->GetCellGhostArray())
  {
    copy->GetCellData()->AddArray(ghosts);
  }
  copy->GetCellData()->SetHigherOrderDegrees(input->GetCellData()->GetHigherOrderDegrees());
  copy->GetPointData()->SetRationalWeights(input->GetPointData()->GetRationalWeights());
  return copy;
}

//------------------------------------------------------------------------------
bool RestingMesh::sameAs(vtkPointSet* input, int threads) const
{
  const MeshAdapter other(input, threads);
  return this->curved
    ? sameMesh(other.mesh().view(), MeshAdapter(this->data, threads).mesh().view())
    : sameMesh(other.mesh().view(), this->mesh->given().view());
}

//------------------------------------------------------------------------------
void RestingMesh::take(vtkPointSet* input, int threads, bool mergePoints)
{
  // The copy shares its arrays with the input, which may have been changed in place.
  if (this->data && this->data->GetMTime() <= this->time && mergePoints == this->MergePoints &&
    input->HasAnyGhostCells() == this->data->HasAnyGhostCells() && this->sameAs(input, threads))
  {
    return;
  }
  this->warper.reset();
  this->data = nullptr; // so that it does not count as up to date if an exception follows
  vtkSmartPointer<vtkPointSet> copy = structureOf(input);
  this->mesh.reset(); // refers to the other
  this->curved = hasCurvedCells(copy) ? std::make_unique<CurvedMesh>(copy, threads) : nullptr;
  this->mesh = std::make_unique<MovableMesh>(
    this->curved ? static_cast<vtkDataSet*>(this->curved->corners()) : copy.Get(), threads,
    mergePoints);
  if (this->curved)
  {
    this->curved->join(this->mesh->representative());
    this->mesh->certifyBy(*this->curved);
  }
  this->MergePoints = mergePoints;
  requireElements(*this->mesh);
  this->boundary = boundaryOf(this->mesh->mesh());
  for (std::size_t i = 0; this->curved && i < this->boundary.size(); ++i)
  {
    this->boundary[i] |= this->curved->nodes().boundary()[i];
  }
  this->Parts.reset();
  this->takeElements(threads);
  this->data = copy;
  this->time = copy->GetMTime();
}

//------------------------------------------------------------------------------
const BoundaryParts& RestingMesh::parts() const
{
  if (!this->Parts)
  {
    this->Parts = std::make_unique<BoundaryParts>(boundaryParts(this->mesh->mesh()));
  }
  return *this->Parts;
}

//------------------------------------------------------------------------------
void RestingMesh::takeElements(int threads)
{
  const Mesh& all = this->mesh->mesh();
  MeshView view = all.view();
  const int dimension = all.dimension() == Dimension::Volume ? 3 : 2;
  this->elements.reset();
  this->cells.clear();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    if (type != CellType::Unsupported && topology(type).dimension == dimension)
    {
      this->cells.push_back(cell);
    }
  }
  if (static_cast<Index>(this->cells.size()) == view.numberOfCells)
  {
    this->cells.clear();
    return;
  }
  this->types.clear();
  this->offsets.assign(1, 0);
  this->connectivity.clear();
  for (Index cell : this->cells)
  {
    this->types.push_back(view.cellTypes[cell]);
    this->connectivity.insert(this->connectivity.end(), view.connectivity + view.offsets[cell],
      view.connectivity + view.offsets[cell + 1]);
    this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
  }
  view.numberOfCells = static_cast<Index>(this->cells.size());
  view.cellTypes = this->types.data();
  view.offsets = this->offsets.data();
  view.connectivity = this->connectivity.data();
  this->elements = std::make_unique<Mesh>(view, threads);
  this->elements->setMirrored(all.mirrored());
}
}
