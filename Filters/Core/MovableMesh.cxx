// SPDX-License-Identifier: BSD-3-Clause
#include "MovableMesh.h"

#include "Blocks.h"
#include "PointMerge.h"
#include "tautline/Mesh/BoundaryShape.h"
#include "tautline/Mesh/BoundaryPoints.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tautline
{
namespace
{
vtkDataSet* withPoints(vtkDataSet* input)
{
  if (!vtkPointSet::SafeDownCast(input))
  {
    throw Error(std::string("The points of ") + input->GetClassName() +
      " are implicit and cannot move: run Image Data to Point Set or Rectilinear Data to Point Set "
      "first, which give them coordinates.");
  }
  return input;
}

std::vector<signed char> validityOf(const Mesh& mesh, int threads)
{
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), threads);
  return validity;
}
}

//------------------------------------------------------------------------------
MovableMesh::MovableMesh(vtkDataSet* input, int threads, bool mergePoints, bool framed)
  : Input(vtkPointSet::SafeDownCast(withPoints(input)))
  , Adapter(input, threads)
  , Threads(threads)
  , MergePoints(mergePoints)
{
  if (mergePoints)
  {
    const JoinedCopies copies = this->Adapter.joinCopies(input->GetPointData()->GetGlobalIds());
    this->Adapter.mergeCoincidentPoints(threads);
    this->Notice = describeMerged(this->Adapter.coincident(), this->given());
    const std::string joined = describeJoined(copies);
    this->Notice += (this->Notice.empty() || joined.empty() ? "" : " ") + joined;
  }
  if (framed)
  {
    this->Adapter.enterFrame();
  }
  if (this->mesh().dimension() == Dimension::None)
  {
    throw Error("There is no element whose points could move. " + this->Adapter.notice());
  }
  if (this->mesh().higherOrderCells() > 0)
  {
    throw Error("The mesh has " + std::to_string(this->mesh().higherOrderCells()) +
      " cells of quadratic or higher order, whose midpoints would stay behind: run Tessellate "
      "first.");
  }
  this->Validity.resize(this->mesh().view().numberOfCells);
  const std::string oriented = this->Adapter.orient(this->Validity.data());
  const Mesh& mesh = this->mesh();
  MeshSkin skin = findSkin(mesh, threads);
  this->Skin = std::move(skin.boundaryPoints);
  for (const std::string& more :
    { oriented, describeDuplicates(skin.duplicates), this->Adapter.notice() })
  {
    this->Notice += (this->Notice.empty() || more.empty() ? "" : " ") + more;
  }
  this->Skip = cellsToSkip(this->Adapter);
  this->Fixed.assign(mesh.view().numberOfPoints, 0);
  this->fixWhatStays();
}

//------------------------------------------------------------------------------
const unsigned char* MovableMesh::skipped() const
{
  return this->Skip.empty() ? nullptr : this->Skip.data();
}

//------------------------------------------------------------------------------
void MovableMesh::fixWhatStays()
{
  const Mesh& mesh = this->mesh();
  const MeshView& view = mesh.view();
  const bool slide = mesh.dimension() == Dimension::Volume && !this->Skip.empty();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const bool ghost = this->Adapter.ghostCells() && this->Adapter.ghostCells()[cell];
    const bool measured = this->Validity[cell] != NotMeasured;
    if (measured && (this->Skip.empty() || !this->Skip[cell]))
    {
      continue;
    }
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      // The triangles on the boundary of a solid do not keep its points from sliding.
      const Index point = view.connectivity[n];
      if (ghost || !slide || !this->Skin[point])
      {
        this->Fixed[point] = 1;
      }
    }
  }
}

//------------------------------------------------------------------------------
void MovableMesh::fix(vtkDataArray* array, bool ofCells)
{
  const MeshView& view = this->mesh().view();
  for (Index cell = 0; array && ofCells && cell < view.numberOfCells; ++cell)
  {
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      this->Fixed[view.connectivity[n]] |= array->GetComponent(cell, 0) != 0;
    }
  }
  for (Index i = 0; array && !ofCells && i < view.numberOfPoints; ++i)
  {
    this->Fixed[i] |= array->GetComponent(i, 0) != 0;
  }
  this->uniteFixed();
}

//------------------------------------------------------------------------------
void MovableMesh::uniteFixed()
{
  unite(this->Fixed, this->representative());
}

//------------------------------------------------------------------------------
void MovableMesh::fixBoundary()
{
  this->BoundaryFixed = true;
  std::transform(this->Fixed.begin(), this->Fixed.end(), this->Skin.begin(), this->Fixed.begin(),
    [](unsigned char fixed, char on) { return fixed || on; });
  this->uniteFixed();
}

//------------------------------------------------------------------------------
void MovableMesh::fixCorners(const BoundaryShape& shape)
{
  std::transform(this->Fixed.begin(), this->Fixed.end(), shape.fixed.begin(), this->Fixed.begin(),
    [](unsigned char fixed, unsigned char corner) { return fixed || corner; });
  this->SlidingFixed = true;
  this->uniteFixed();
}

//------------------------------------------------------------------------------
namespace
{
std::string boundaryIsFixed(Index used, Index onBoundary)
{
  return onBoundary == used ? "Every point is on the boundary of the mesh, which is fixed"
                            : std::to_string(onBoundary) + " of the " + std::to_string(used) +
      " points are on the boundary of the mesh, which is fixed, and the others are fixed by an "
      "array, a selection or cells that stay";
}
}

std::string noneIsFree(Index used, Index onBoundary, bool slides, const std::string& boundaryRemedy)
{
  if (onBoundary > 0)
  {
    return boundaryIsFixed(used, onBoundary) + ": " + boundaryRemedy + ", or refine the mesh.";
  }
  return slides
    ? "Every point is fixed, by an array or a selection or because it is on the boundary and "
      "cannot slide: " +
      boundaryRemedy + ", or fix fewer points."
    : "Every point is fixed by an array or a selection: fix fewer points.";
}

//------------------------------------------------------------------------------
std::string MovableMesh::whyNoneIsFree(const std::string& boundaryRemedy) const
{
  const Mesh& mesh = this->mesh();
  const MeshView& view = mesh.view();
  const VertexCells cells = mesh.vertexCells();
  Index used = 0, fixed = 0, onBoundary = 0;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (cells.offsets[p] < cells.offsets[p + 1])
    {
      ++used;
      fixed += this->Fixed[p] != 0;
      onBoundary += this->BoundaryFixed && this->Skin[p];
    }
  }
  if (fixed < used)
  {
    return "";
  }
  if (onBoundary == 0)
  {
    return noneIsFree(used, onBoundary, this->SlidingFixed, boundaryRemedy);
  }
  const std::string text = boundaryIsFixed(used, onBoundary);
  // Pieces whose points are not merged are the usual cause.
  const Index coincident = this->MergePoints ? 0 : findCoincidentPoints(mesh).merged;
  Index first = 0;
  const Index near = coincident > 0 ? 0 : countNearPoints(mesh, this->Skin, &first);
  if (coincident > 0)
  {
    return text + ". " + std::to_string(coincident) +
      " points are at the place of another one, so that neighbouring elements are not connected: "
      "switch Merge Coincident Points on, or run Clean to Grid first.";
  }
  if (near > 0)
  {
    return text + ". " + std::to_string(near) +
      " points nearly coincide with another one, the first is " +
      placeOf(this->Adapter.inputView(), first) +
      ", so that neighbouring elements are not connected: run Clean to Grid with a tolerance "
      "first.";
  }
  return noneIsFree(used, onBoundary, this->SlidingFixed, boundaryRemedy);
}

//------------------------------------------------------------------------------
std::string MovableMesh::move(vtkPointSet* output, const std::vector<double>& moved) const
{
  bool single = this->isSingle();
  std::string note;
  if (single)
  {
    const auto before = this->validityAt(moved),
               after = this->validityAt(this->rounded(moved, true));
    const auto lost = std::inner_product(before.begin(), before.end(), after.begin(), Index(0),
      std::plus<>(), [](signed char a, signed char b) { return Index(a == Valid && b != Valid); });
    if (lost > 0)
    {
      single = false;
      note = "The points are given in double precision: in single precision " +
        std::to_string(lost) + " valid elements would not be valid.";
    }
  }
  this->move(output, moved, single);
  return note;
}

//------------------------------------------------------------------------------
void MovableMesh::move(vtkPointSet* output, const std::vector<double>& moved, bool single) const
{
  const std::vector<double> actual = this->written(moved, single);
  output->SetPoints(makePoints(actual, single ? this->Input->GetPoints() : nullptr));
  addDisplacement(output, this->Adapter.inputView().points, actual);
}

//------------------------------------------------------------------------------
bool MovableMesh::isSingle() const
{
  return this->Input->GetPoints()->GetDataType() == VTK_FLOAT;
}

//------------------------------------------------------------------------------
std::vector<double> MovableMesh::written(const std::vector<double>& points, bool single) const
{
  std::vector<double> together = points;
  spread(together, 3, this->representative());
  std::vector<double> actual = this->actual(together);
  if (single)
  {
    std::transform(actual.begin(), actual.end(), actual.begin(),
      [](double x) { return static_cast<double>(static_cast<float>(x)); });
  }
  return actual;
}

//------------------------------------------------------------------------------
std::vector<double> MovableMesh::rounded(const std::vector<double>& points, bool single) const
{
  if (!single && this->frame().isIdentity())
  {
    return points;
  }
  std::vector<double> result = this->written(points, single);
  this->frame().enter(result);
  return result;
}

//------------------------------------------------------------------------------
Mesh MovableMesh::actualMesh(const std::vector<double>& actualPoints) const
{
  MeshView view = this->Adapter.inputView();
  view.points = actualPoints.data();
  Mesh moved(view, this->Threads);
  moved.setMirrored(this->mesh().mirrored());
  return moved;
}

//------------------------------------------------------------------------------
std::vector<double> MovableMesh::settle(const std::vector<double>& points, std::string& note) const
{
  if (this->frame().isIdentity())
  {
    return points;
  }
  std::vector<double> settled = this->rounded(points, false);
  const auto invalid = [](const std::vector<signed char>& validity)
  { return std::count_if(validity.begin(), validity.end(), isInvalid); };
  const auto count = invalid(this->validityAt(settled));
  if (count <= invalid(this->Validity))
  {
    return settled;
  }
  note =
    "The points stay where they are: so far from the origin coordinates have too few digits, and "
    "rounded to these " +
    std::to_string(count) +
    " elements would not be valid. Create the "
    "mesh near the origin.";
  const double* input = this->mesh().view().points;
  return { input, input + points.size() };
}

//------------------------------------------------------------------------------
std::vector<signed char> MovableMesh::validityAt(const std::vector<double>& points) const
{
  Mesh moved = this->mesh().at(points.data());
  moved.setSpace(this->mesh().space());
  return validityOf(moved, this->Threads);
}

//------------------------------------------------------------------------------
void fixSelected(MovableMesh& mesh, vtkDataSet* selected)
{
  if (selected)
  {
    vtkDataArray* ofCells = selected->GetCellData()->GetArray(SelectedArray);
    vtkDataArray* ofPoints = selected->GetPointData()->GetArray(SelectedArray);
    mesh.fix(ofCells, true);
    mesh.fix(ofPoints, false);
  }
}

//------------------------------------------------------------------------------
void addDisplacement(vtkDataSet* output, const double* before, const std::vector<double>& after)
{
  vtkNew<vtkDoubleArray> displacement;
  displacement->SetName("Displacement");
  displacement->SetNumberOfComponents(3);
  displacement->SetNumberOfTuples(output->GetNumberOfPoints());
  std::transform(after.begin(), after.end(), before, displacement->GetPointer(0),
    [](double now, double then) { return std::isfinite(now - then) ? now - then : 0.0; });
  output->GetPointData()->AddArray(displacement);
}
}
