// SPDX-License-Identifier: BSD-3-Clause
#include "MovableMesh.h"

#include "Blocks.h"
#include "CurvedMesh.h"
#include "PointMerge.h"
#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Mesh/BoundaryShape.h"
#include "tautline/Mesh/CellCopies.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/Mesh/Ranks.h"

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
  if (!vtkPointSet::SafeDownCast(input) && input->GetNumberOfPoints() > 0)
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

void requireLinear(const Mesh& mesh)
{
  if (mesh.higherOrderCells() > 0)
  {
    throw Error("The mesh has " + std::to_string(mesh.higherOrderCells()) +
      " cells of quadratic or higher order, whose midpoints would stay behind: run Tessellate "
      "first.");
  }
}

int dimensionOf(unsigned char cellType)
{
  const CellType type = cornerType(cellType);
  return type == CellType::Unsupported ? 0 : topology(type).dimension;
}

/// The elements of a piece: cells of the dimension of the mesh.
struct Elements
{
  std::vector<unsigned char> types, ghosts;
  std::vector<Index> offsets = { 0 }, connectivity;
};

/// @param ghosts one flag per cell, or null
Elements elementsOf(const MeshView& view, const unsigned char* ghosts, int dimension)
{
  Elements elements;
  for (Index cell = 0; cell < view.numberOfCells && dimension > 0; ++cell)
  {
    if (dimensionOf(view.cellTypes[cell]) == dimension)
    {
      elements.types.push_back(view.cellTypes[cell]);
      elements.ghosts.push_back(ghosts && ghosts[cell]);
      elements.connectivity.insert(elements.connectivity.end(),
        view.connectivity + view.offsets[cell], view.connectivity + view.offsets[cell + 1]);
      elements.offsets.push_back(static_cast<Index>(elements.connectivity.size()));
    }
  }
  return elements;
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
    this->Adapter.mergeCoincidentPoints(threads, true);
    this->Notice = describeMerged(this->Adapter.coincident(), this->given());
    const std::string joined = describeJoined(copies);
    this->Notice += (this->Notice.empty() || joined.empty() ? "" : " ") + joined;
  }
  if (framed)
  {
    this->Adapter.enterFrame();
  }
  const int solid = this->mesh().dimension() == Dimension::Volume ? 3 : 2;
  const auto isElement = [solid](const CellBlock& block)
  { return topology(block.type).dimension == solid; };
  if (std::none_of(this->mesh().blocks().begin(), this->mesh().blocks().end(), isElement))
  {
    throw Error("There is no element with points that can move. " + this->Adapter.notice() +
      (this->mesh().polyhedra() > 0
          ? " The preset Finite volumes of Optimize Mesh moves the points of polyhedra."
          : ""));
  }
  requireLinear(this->mesh());
  this->Validity.resize(this->mesh().view().numberOfCells);
  const std::string oriented = this->Adapter.orient(this->Validity.data());
  const std::string duplicates = this->findSkin();
  const std::vector<unsigned char>& dropped = this->Adapter.droppedCells();
  const Index copies = std::count(dropped.begin(), dropped.end(), 1);
  for (const std::string& more :
    { oriented, duplicates, describeCopies(copies), this->Adapter.notice() })
  {
    this->Notice += (this->Notice.empty() || more.empty() ? "" : " ") + more;
  }
  this->Skip = cellsToSkip(this->Adapter);
  this->Fixed.assign(this->mesh().view().numberOfPoints, 0);
  this->fixWhatStays();
  for (std::size_t cell = 0; cell < dropped.size(); ++cell) // once the points are fixed
  {
    this->Skip.resize(dropped.size(), 0);
    this->Skip[cell] |= dropped[cell];
  }
  this->Stays = this->Fixed;
}

//------------------------------------------------------------------------------
/// Finds the boundary of a mesh of this process alone; duplicate cells then count once.
/// @return a sentence on the duplicates, or ""
std::string MovableMesh::findSkin()
{
  const Mesh& mesh = this->mesh();
  MeshSkin skin = tautline::findSkin(mesh, this->Threads);
  this->Skin = std::move(skin.boundaryPoints);
  const MeshView view = mesh.view();
  std::vector<unsigned char> copies;
  for (const DuplicateCell& cell : skin.duplicates)
  {
    const auto isCopy = [&](bool reversed)
    {
      return sameFacets(cornerType(view.cellTypes[cell.cell]),
        view.connectivity + view.offsets[cell.original],
        view.connectivity + view.offsets[cell.cell], reversed);
    };
    if (isCopy(false) || (mesh.dimension() == Dimension::Surface && isCopy(true)))
    {
      copies.resize(view.numberOfCells, 0);
      copies[cell.cell] = 1;
      this->Validity[cell.cell] = NotMeasured;
    }
  }
  this->Adapter.dropCells(copies);
  if (!skin.consistent)
  {
    const Overlap overlap = findOverlap(this->mesh(), this->Validity.data());
    requireNoOverlap(overlap.facets, mesh.dimension(),
      overlap.facets > 0 ? placeOf(this->Adapter.inputView(), overlap.first) : "");
  }
  return describeDuplicates(skin.duplicates);
}

//------------------------------------------------------------------------------
MovableMesh::MovableMesh(
  RankGroup& group, vtkDataSet* input, int threads, bool mergePoints, Redistribution redistribution)
  : Input(vtkPointSet::SafeDownCast(withPoints(input)))
  , Adapter(input, threads)
  , Threads(threads)
  , MergePoints(mergePoints)
  , Spread(new Pieces(group, group.size() > 1 ? redistribution : Redistribution::None))
{
  requireLinear(this->mesh());
  const MeshView& view = this->piece();
  const unsigned char* ghosts = this->Adapter.ghostCells();
  Index dimension = 0;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    dimension = std::max<Index>(dimension, dimensionOf(view.cellTypes[cell]));
  }
  this->Spread->dimension = static_cast<int>(group.maximum(dimension));
  this->Spread->marked.assign(view.numberOfPoints, 0);
  this->Skip.assign(view.numberOfCells, 0);
  std::vector<unsigned char> held(view.numberOfPoints, 0);
  // Usually all cells are elements and need not be copied.
  bool copies = this->Spread->dimension == 0;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const bool lower = dimensionOf(view.cellTypes[cell]) < this->Spread->dimension;
    copies = copies || lower;
    this->Skip[cell] = lower || (ghosts && ghosts[cell]);
    for (Index n = view.offsets[cell]; lower && n < view.offsets[cell + 1]; ++n)
    {
      held[view.connectivity[n]] = 1;
    }
  }
  vtkDataArray* given = input->GetPointData()->GetGlobalIds();
  std::vector<Index> ids = idsOf(given);
  if (!mergePoints && !given && view.numberOfPoints > 0)
  {
    if (group.size() > 1)
    {
      throw Error("With Merge Coincident Points off, points of different processes are identified "
                  "by global ids, and there are none: run Generate Global Ids first.");
    }
    ids.resize(view.numberOfPoints);
    std::iota(ids.begin(), ids.end(), Index(0));
  }
  const bool unnamed = static_cast<Index>(ids.size()) < view.numberOfPoints;
  this->Spread->copies = tautline::joinCopies(group, view, unnamed ? nullptr : ids.data());
  MeshView joined = view;
  joined.points = this->joinedPoints();
  Elements elements;
  if (copies)
  {
    elements = elementsOf(view, ghosts, this->Spread->dimension);
    joined.numberOfCells = static_cast<Index>(elements.types.size());
    joined.cellTypes = elements.types.data();
    joined.offsets = elements.offsets.data();
    joined.connectivity = elements.connectivity.data();
    ghosts = elements.ghosts.data();
  }
  MeshPiece piece = { joined, mergePoints ? nullptr : ids.data(), ghosts };
  piece.followers = copies ? held.data() : nullptr;
  this->divide(piece);
  this->skipCopies();
  this->checkOrder();
  this->fixHeld(held);
}

//------------------------------------------------------------------------------
void MovableMesh::certifyBy(const CurvedMesh& curved)
{
  this->Curved = &curved;
  const MeshView& view = this->Adapter.inputView();
  curved.certify({ view.points, view.points + 3 * view.numberOfPoints }, this->Validity);
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
  const std::vector<unsigned char>& dropped = this->Adapter.droppedCells();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    if (!dropped.empty() && dropped[cell])
    {
      continue; // its points are the points of the original cell
    }
    const bool ghost = this->Adapter.ghostCells() && this->Adapter.ghostCells()[cell];
    const bool measured = this->Validity[cell] != NotMeasured;
    if (measured && (this->Skip.empty() || !this->Skip[cell]))
    {
      continue;
    }
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      // Triangles on the boundary of a solid do not prevent its points from sliding.
      const Index point = view.connectivity[n];
      if (ghost || !slide || !this->Skin[point])
      {
        this->Fixed[point] = 1;
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The points of cells that are not elements stay, except on the boundary of a volume.
void MovableMesh::fixHeld(const std::vector<unsigned char>& held)
{
  this->Fixed.assign(this->distributed().localPoints(), 0);
  if (!this->group().any(std::find(held.begin(), held.end(), 1) != held.end()))
  {
    return;
  }
  this->Fixed = this->anyOf(held);
  if (this->dimension() == 3)
  {
    const std::vector<unsigned char> on = rankBoundary(this->distributed());
    std::transform(this->Fixed.begin(), this->Fixed.end(), on.begin(), this->Fixed.begin(),
      [](unsigned char fixed, unsigned char boundary) { return fixed && !boundary; });
  }
}

//------------------------------------------------------------------------------
/// @param flags one per point of the input
void MovableMesh::addFixed(const std::vector<unsigned char>& flags)
{
  const auto add = [](std::vector<unsigned char>& to, const std::vector<unsigned char>& more)
  {
    std::transform(to.begin(), to.end(), more.begin(), to.begin(),
      [](unsigned char a, unsigned char b) -> unsigned char { return a || b; });
  };
  if (this->inPieces())
  {
    add(this->Spread->marked, flags);
  }
  add(this->Fixed, this->inPieces() ? this->anyOf(flags) : flags);
  this->uniteFixed();
}

//------------------------------------------------------------------------------
void MovableMesh::fix(vtkDataArray* array, bool ofCells)
{
  std::vector<unsigned char> flags(this->piece().numberOfPoints, 0);
  markPoints(this->piece(), array, ofCells, flags);
  this->addFixed(flags);
}

//------------------------------------------------------------------------------
void MovableMesh::fixSelected(vtkDataSet* selected)
{
  std::vector<unsigned char> flags(this->piece().numberOfPoints, 0);
  markPoints(this->piece(), selected, flags);
  this->addFixed(flags);
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
  if (this->inPieces())
  {
    const std::vector<unsigned char> on = rankBoundary(this->distributed());
    this->Skin.assign(on.begin(), on.end());
  }
  std::transform(this->Fixed.begin(), this->Fixed.end(), this->Skin.begin(), this->Fixed.begin(),
    [](unsigned char fixed, char on) { return fixed || on; });
  this->uniteFixed();
}

//------------------------------------------------------------------------------
void MovableMesh::freeInvalid()
{
  const MeshView& view = this->mesh().view();
  std::vector<unsigned char> freed(this->Fixed.size(), 0);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const signed char validity = this->validity()[cell];
    if (validity == Inverted || validity == Degenerate)
    {
      for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
      {
        freed[view.connectivity[n]] = 1;
      }
    }
  }
  unite(freed, this->representative());
  for (std::size_t p = 0; p < freed.size(); ++p)
  {
    this->Fixed[p] &= this->Stays[p] || !freed[p];
  }
  this->uniteFixed();
}

//------------------------------------------------------------------------------
void MovableMesh::fixCorners(const BoundaryShape& shape)
{
  std::transform(this->Fixed.begin(), this->Fixed.end(), shape.fixed.begin(), this->Fixed.begin(),
    [](unsigned char fixed, unsigned char corner) { return fixed || corner; });
  this->SlidingFixed = true;
  if (this->inPieces())
  {
    this->distributed().exchange(this->Fixed.data());
  }
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
}

//------------------------------------------------------------------------------
std::string MovableMesh::whyNoneIsFree(const std::string& boundaryRemedy) const
{
  const Mesh& mesh = this->mesh();
  Index used = 0, fixed = 0, onBoundary = 0;
  const auto count = [&](std::size_t p)
  {
    ++used;
    fixed += this->Fixed[p] != 0;
    onBoundary += this->BoundaryFixed && this->Skin[p];
  };
  const VertexCells cells = this->inPieces() ? VertexCells() : mesh.vertexCells();
  for (std::size_t p = 0; p < this->Fixed.size(); ++p)
  {
    const bool counts = this->inPieces() ? this->distributed().owned(static_cast<Index>(p))
                                         : cells.offsets[p] < cells.offsets[p + 1];
    if (counts)
    {
      count(p);
    }
  }
  if (this->inPieces())
  {
    for (Index* number : { &used, &fixed, &onBoundary })
    {
      *number = this->group().sum(*number);
    }
  }
  if (fixed < used)
  {
    return "";
  }
  if (onBoundary == 0 || this->inPieces())
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
      " points coincide with another one, so that neighboring elements are not connected: switch "
      "Merge Coincident Points on, or run Clean to Grid first.";
  }
  if (near > 0)
  {
    return text + ". " + std::to_string(near) +
      " points nearly coincide with another one; the first is " +
      placeOf(this->Adapter.inputView(), first) +
      ", so that neighboring elements are not connected: run Clean to Grid with a tolerance first.";
  }
  return noneIsFree(used, onBoundary, this->SlidingFixed, boundaryRemedy);
}

//------------------------------------------------------------------------------
std::string MovableMesh::move(vtkPointSet* output, const std::vector<double>& moved) const
{
  vtkPoints* like = this->Input ? this->Input->GetPoints() : nullptr;
  const bool single = like && like->GetDataType() == VTK_FLOAT;
  const unsigned char* ghosts = this->inPieces() ? this->Adapter.ghostCells() : nullptr;
  Index lost = 0;
  if (single)
  {
    const auto before = this->validityAt(moved),
               after = this->validityAt(this->rounded(moved, true));
    for (std::size_t cell = 0; cell < after.size(); ++cell)
    {
      lost += !(ghosts && ghosts[cell]) && before[cell] == Valid && after[cell] != Valid;
    }
  }
  lost = this->inPieces() ? this->group().sum(lost) : lost;
  this->move(output, moved, single && lost == 0);
  return lost == 0 ? ""
                   : "The points are given in double precision: in single precision " +
      std::to_string(lost) + " valid elements would not be valid.";
}

//------------------------------------------------------------------------------
void MovableMesh::move(vtkPointSet* output, const std::vector<double>& moved, bool single) const
{
  if (!output)
  {
    return; // an empty piece of another kind
  }
  const std::vector<double> actual = this->written(moved, single);
  vtkPoints* like = this->Input ? this->Input->GetPoints() : nullptr;
  output->SetPoints(makePoints(actual, single ? like : nullptr));
  addDisplacement(output, this->Adapter.inputView().points, actual);
}

//------------------------------------------------------------------------------
bool MovableMesh::isSingle() const
{
  vtkPoints* points = this->Input ? this->Input->GetPoints() : nullptr;
  const bool single = points && points->GetDataType() == VTK_FLOAT;
  return this->inPieces() ? !this->group().any(this->piece().numberOfPoints > 0 && !single)
                          : single;
}

//------------------------------------------------------------------------------
std::vector<double> MovableMesh::written(const std::vector<double>& points, bool single) const
{
  std::vector<double> actual = points;
  if (!this->inPieces())
  {
    spread(actual, 3, this->representative());
    actual = this->actual(actual);
  }
  if (single)
  {
    std::transform(actual.begin(), actual.end(), actual.begin(),
      [](double x) { return static_cast<double>(static_cast<float>(x)); });
  }
  return this->inPieces() ? this->ofPiece(actual) : actual;
}

//------------------------------------------------------------------------------
std::vector<double> MovableMesh::rounded(const std::vector<double>& points, bool single) const
{
  if (!single && this->frame().isIdentity())
  {
    return points;
  }
  if (this->inPieces())
  {
    std::vector<double> result = points;
    std::transform(result.begin(), result.end(), result.begin(),
      [](double x) { return static_cast<double>(static_cast<float>(x)); });
    return result;
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
  note = "The points do not move: this far from the origin, coordinates have too few digits, and "
         "after rounding " +
    std::to_string(count) +
    " elements would not be valid. Create the "
    "mesh near the origin.";
  const double* input = this->mesh().view().points;
  return { input, input + points.size() };
}

//------------------------------------------------------------------------------
Mesh MovableMesh::placed(const std::vector<double>& points, std::vector<double>& storage) const
{
  if (this->inPieces())
  {
    storage = this->ofPiece(points);
  }
  Mesh moved = this->mesh().at(this->inPieces() ? storage.data() : points.data());
  moved.setSpace(this->mesh().space());
  return moved;
}

//------------------------------------------------------------------------------
std::vector<signed char> MovableMesh::validityAt(const std::vector<double>& points) const
{
  std::vector<double> storage;
  std::vector<signed char> validity = validityOf(this->placed(points, storage), this->Threads);
  if (this->Curved)
  {
    this->Curved->certify(this->actual(points), validity);
  }
  return validity;
}

//------------------------------------------------------------------------------
const std::vector<signed char>& MovableMesh::validity() const
{
  if (this->Validity.empty()) // of a piece: most filters do not need it
  {
    this->Validity = validityOf(this->mesh(), this->Threads);
  }
  return this->Validity;
}

//------------------------------------------------------------------------------
int MovableMesh::dimension() const
{
  return this->inPieces()                           ? this->Spread->dimension
    : this->mesh().dimension() == Dimension::Volume ? 3
                                                    : 2;
}

//------------------------------------------------------------------------------
Index MovableMesh::allPoints() const
{
  return this->inPieces() ? this->distributed().globalPoints() : this->mesh().view().numberOfPoints;
}

//------------------------------------------------------------------------------
Index MovableMesh::allCells() const
{
  if (this->inPieces())
  {
    return this->distributed().globalCells();
  }
  Index elements = 0;
  for (const CellBlock& block : this->mesh().blocks())
  {
    elements += topology(block.type).dimension == this->dimension() ? block.count : 0;
  }
  return elements;
}

//------------------------------------------------------------------------------
std::string MovableMesh::coarseness() const
{
  return this->inPieces() ? "" : this->Adapter.coarseness();
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
