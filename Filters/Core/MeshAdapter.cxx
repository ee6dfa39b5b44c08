// SPDX-License-Identifier: BSD-3-Clause
#include "MeshAdapter.h"

#include "VtkCompatibility.h"
#include "tautline/Core/RankGroup.h"
#include "tautline/Mesh/CellOrder.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArrayRange.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <sstream>

namespace tautline
{
static_assert(sizeof(vtkIdType) == sizeof(Index), "Tautline needs a VTK with 64-bit ids.");

//------------------------------------------------------------------------------
MeshAdapter::MeshAdapter(vtkDataSet* input, int threads)
  : Threads(threads)
{
  this->takePoints(input);
  this->takeCells(input);
  if (vtkUnsignedCharArray* ghosts = input->GetCellGhostArray())
  {
    this->Ghosts = ghosts->GetPointer(0);
  }
  this->TheMesh = std::make_unique<Mesh>(this->View, threads);
  this->takeCollapsed();
  this->InputView = this->View;
}

//------------------------------------------------------------------------------
/// Replaces cells that list points more than once by their remaining shape. They have been checked.
void MeshAdapter::takeCollapsed()
{
  this->Collapsed = findCollapsedCells(*this->TheMesh, this->Threads);
  if (!this->Collapsed.types.empty())
  {
    this->View.cellTypes = this->Collapsed.types.data();
    this->View.offsets = this->Collapsed.offsets.data();
    this->View.connectivity = this->Collapsed.connectivity.data();
    this->TheMesh = std::make_unique<Mesh>(this->View, this->Threads);
  }
}

//------------------------------------------------------------------------------
void MeshAdapter::enterFrame(bool shifted)
{
  this->Frame = CoordinateFrame(coordinateRange(this->InputView), shifted);
  if (this->Frame.isIdentity())
  {
    return;
  }
  this->FramedPoints.assign(this->View.points, this->View.points + 3 * this->View.numberOfPoints);
  this->Frame.enter(this->FramedPoints);
  this->View.points = this->FramedPoints.data();
  for (std::unique_ptr<Mesh>* mesh : { &this->Given, &this->TheMesh })
  {
    if (*mesh)
    {
      MeshView view = (*mesh)->view();
      view.points = this->FramedPoints.data();
      auto framed = std::make_unique<Mesh>(view, this->Threads);
      framed->setMirrored((*mesh)->mirrored());
      *mesh = std::move(framed);
    }
  }
}

//------------------------------------------------------------------------------
std::vector<double> MeshAdapter::leaveFrame(const std::vector<double>& points) const
{
  std::vector<double> result = points;
  if (!this->Frame.isIdentity())
  {
    this->Frame.leave(result);
    const double* given =
      this->JoinedPoints.empty() ? this->InputView.points : this->JoinedPoints.data();
    for (std::size_t i = 0; i < result.size(); ++i)
    {
      result[i] = points[i] == this->View.points[i] ? given[i] : result[i];
    }
  }
  return result;
}

//------------------------------------------------------------------------------
std::string MeshAdapter::coarseness() const
{
  constexpr double enoughSteps = 100;
  const CoordinateRange range = coordinateRange(this->InputView);
  const double step = range.spacing(this->SinglePrecision);
  std::ostringstream text;
  text.precision(2);
  if (range.extent > 0 && range.extent < enoughSteps * step)
  {
    text << "The coordinates are too coarse for the elements: these are about " << range.extent
         << " long and up to " << range.farthest() << " from the origin, where coordinates in "
         << (this->SinglePrecision ? "single" : "double") << " precision have steps of " << step
         << ". Lengths and angles are computed from the rounded points, and points move only in "
            "these steps. Create the mesh near the origin"
         << (this->SinglePrecision ? ", or in double precision." : ".");
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::vector<Index> idsOf(vtkDataArray* globalIds)
{
  std::vector<Index> ids;
  ids.reserve(globalIds ? globalIds->GetNumberOfTuples() : 0);
  for (vtkIdType i = 0; globalIds && i < globalIds->GetNumberOfTuples(); ++i)
  {
    ids.push_back(static_cast<Index>(globalIds->GetComponent(i, 0)));
  }
  return ids;
}

//------------------------------------------------------------------------------
JoinedCopies MeshAdapter::joinCopies(vtkDataArray* globalIds)
{
  SingleRank alone;
  JoinedCopies result;
  if (globalIds)
  {
    result = tautline::joinCopies(alone, this->View, idsOf(globalIds).data());
  }
  if (result.joined > 0)
  {
    this->JoinedPoints = std::move(result.points);
    this->View.points = this->JoinedPoints.data();
    this->TheMesh = std::make_unique<Mesh>(this->View, this->Threads);
  }
  return result;
}

//------------------------------------------------------------------------------
void MeshAdapter::mergeCoincidentPoints(int threads, bool dropCopies)
{
  std::vector<unsigned char> copies;
  this->Coincident = findCoincidentPoints(*this->TheMesh, nullptr, threads, this->Ghosts, &copies);
  if (this->Coincident.overlapping > 0 || this->Coincident.crowded > 0)
  {
    // Cells that list their points in the opposite order appear on the wrong side of a facet.
    std::vector<signed char> validity(this->View.numberOfCells);
    this->TheMesh->classifyCells(validity.data(), threads);
    const RankOrder found = this->findOrder(validity.data());
    if (found.order.reversed > 0)
    {
      this->Coincident = findCoincidentPoints(
        *this->TheMesh, found.reverse[0].data(), threads, this->Ghosts, &copies);
    }
  }
  if (!this->Coincident.any())
  {
    return;
  }
  MeshView merged = this->View;
  const Index* first = merged.connectivity;
  this->MergedConnectivity.assign(first, first + merged.offsets[merged.numberOfCells]);
  for (Index& node : this->MergedConnectivity)
  {
    // Unsupported cells may have any number here.
    if (node >= 0 && node < merged.numberOfPoints)
    {
      node = this->Coincident.representative[node];
    }
  }
  merged.connectivity = this->MergedConnectivity.data();
  this->Given = std::move(this->TheMesh);
  this->TheMesh = std::make_unique<Mesh>(merged, threads);
  if (dropCopies)
  {
    this->dropCells(copies);
  }
}

//------------------------------------------------------------------------------
void MeshAdapter::dropCells(const std::vector<unsigned char>& flags)
{
  if (flags.empty())
  {
    return;
  }
  MeshView view = this->TheMesh->view();
  // Points of unsupported cells stay; these cells have none.
  std::vector<Index> offsets = { 0 }, connectivity;
  std::vector<unsigned char> types(view.cellTypes, view.cellTypes + view.numberOfCells);
  this->Dropped.resize(flags.size(), 0);
  offsets.reserve(flags.size() + 1);
  for (std::size_t cell = 0; cell < flags.size(); ++cell)
  {
    if (flags[cell])
    {
      types[cell] = static_cast<unsigned char>(CellType::Unsupported);
      this->Dropped[cell] = 1;
    }
    else
    {
      connectivity.insert(connectivity.end(), view.connectivity + view.offsets[cell],
        view.connectivity + view.offsets[cell + 1]);
    }
    offsets.push_back(static_cast<Index>(connectivity.size()));
  }
  if (!this->Given)
  {
    this->Given = std::make_unique<Mesh>(*this->TheMesh);
  }
  this->MergedConnectivity = std::move(connectivity);
  this->KeptOffsets = std::move(offsets);
  this->KeptTypes = std::move(types);
  view.connectivity = this->MergedConnectivity.data();
  view.offsets = this->KeptOffsets.data();
  view.cellTypes = this->KeptTypes.data();
  const bool mirrored = this->TheMesh->mirrored();
  *this->TheMesh = Mesh(view, this->Threads); // in place: others refer to it
  this->setMirrored(mirrored);
}

//------------------------------------------------------------------------------
void MeshAdapter::setMirrored(bool mirrored)
{
  this->TheMesh->setMirrored(mirrored);
  if (this->Given)
  {
    this->Given->setMirrored(mirrored);
  }
}

//------------------------------------------------------------------------------
void MeshAdapter::reverseCells(const std::vector<unsigned char>& flags)
{
  const Index* offsets = this->View.offsets;
  const Index* given = this->View.connectivity;
  std::vector<Index> turned(given, given + offsets[this->View.numberOfCells]);
  const bool merged = this->Given != nullptr;
  for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
  {
    if (flags[cell])
    {
      const CellType type = cornerType(this->View.cellTypes[cell]);
      reverseCell(type, turned.data() + offsets[cell]);
      if (merged && (this->Dropped.empty() || !this->Dropped[cell]))
      {
        reverseCell(type, this->MergedConnectivity.data() + this->TheMesh->view().offsets[cell]);
      }
    }
  }
  this->OrientedConnectivity = std::move(turned);
  this->View.connectivity = this->InputView.connectivity = this->OrientedConnectivity.data();
  const bool mirrored = this->TheMesh->mirrored();
  MeshView view = this->View;
  if (merged)
  {
    *this->Given = Mesh(view, this->Threads);
    view.connectivity = this->MergedConnectivity.data();
    view.offsets = this->TheMesh->view().offsets; // without the cells that are dropped
    view.cellTypes = this->TheMesh->view().cellTypes;
  }
  const MeshSpace space = this->TheMesh->space(); // the whole mesh's, if this is a piece
  *this->TheMesh = Mesh(view, this->Threads);     // in place: others refer to it
  this->TheMesh->setSpace(space);
  this->setMirrored(mirrored);
}

//------------------------------------------------------------------------------
std::string MeshAdapter::orient(signed char* validity, bool required)
{
  std::vector<signed char> own(validity ? 0 : this->View.numberOfCells);
  validity = validity ? validity : own.data();
  this->TheMesh->classifyCells(validity, this->Threads);
  RankOrder found;
  found.orientation = this->TheMesh->orientation(validity);
  if (found.orientation.state == Orientation::Mixed)
  {
    found.order = consistentOrder(*this->TheMesh, validity);
    found.reverse.push_back(std::move(found.order.reverse));
    if (required && found.order.ambiguous > 0)
    {
      found.order.reversed = 0; // nothing is done about it
      throw Error(describe(found, this->TheMesh->dimension()) +
        " Cut the mesh so that each part has one (Clip), or remove cells.");
    }
  }
  return this->orient(validity, found);
}

//------------------------------------------------------------------------------
std::string MeshAdapter::orient(signed char* validity, const RankOrder& found, std::size_t piece)
{
  if (found.order.reversed > 0 && piece < found.reverse.size())
  {
    const std::vector<unsigned char>& reverse = found.reverse[piece];
    if (std::any_of(reverse.begin(), reverse.end(), [](unsigned char flag) { return flag != 0; }))
    {
      this->reverseCells(reverse);
      this->Reversed = reverse;
      this->TheMesh->classifyCells(validity, this->Threads);
    }
  }
  if (found.orientation.state == Orientation::Reversed)
  {
    this->setMirrored(true);
    this->TheMesh->classifyCells(validity, this->Threads);
  }
  return describe(found, this->TheMesh->dimension());
}

//------------------------------------------------------------------------------
RankOrder MeshAdapter::findOrder(signed char* validity) const
{
  SingleRank alone;
  return consistentOrder(alone, { { this->TheMesh.get(), this->Ghosts, nullptr } }, { validity });
}

//------------------------------------------------------------------------------
void MeshAdapter::takePoints(vtkDataSet* input)
{
  const Index count = input->GetNumberOfPoints();
  this->View.numberOfPoints = count;
  vtkPointSet* pointSet = vtkPointSet::SafeDownCast(input);
  if (pointSet && pointSet->GetPoints())
  {
    vtkDataArray* data = pointSet->GetPoints()->GetData();
    this->SinglePrecision = data->GetDataType() == VTK_FLOAT;
    if (auto* doubles = vtkDoubleArray::SafeDownCast(data))
    {
      this->View.points = doubles->GetPointer(0);
      return;
    }
    this->Points.resize(3 * count);
    const auto range = vtk::DataArrayValueRange<3>(data);
    std::copy(range.begin(), range.end(), this->Points.begin());
  }
  else
  {
    this->Points.resize(3 * count);
    for (Index i = 0; i < count; ++i)
    {
      input->GetPoint(i, this->Points.data() + 3 * i);
    }
  }
  this->View.points = this->Points.data();
}

namespace
{
/// The 64-bit arrays of a cell array, or null if it stores 32 bits.
bool plainArrays(vtkCellArray* cells, const Index*& offsets, const Index*& connectivity)
{
  if (!cells->IsStorage64Bit())
  {
    return false;
  }
  offsets = reinterpret_cast<const Index*>(plainOffsets(cells));
  connectivity = reinterpret_cast<const Index*>(plainConnectivity(cells));
  return offsets && connectivity;
}

/// Types whose local numbering or generality differs from the kernel's, and their replacements.
unsigned char kernelType(int vtkType, vtkIdType size)
{
  switch (vtkType)
  {
    case VTK_PIXEL:
      return VTK_QUAD;
    case VTK_VOXEL:
      return VTK_HEXAHEDRON;
    case VTK_POLYGON:
      return size == 3 ? VTK_TRIANGLE : size == 4 ? VTK_QUAD : VTK_POLYGON;
    default:
      return static_cast<unsigned char>(vtkType);
  }
}
}

//------------------------------------------------------------------------------
bool MeshAdapter::acrossY(Index first) const
{
  const Index* node = this->Connectivity.data() + first;
  if (std::any_of(
        node, node + 3, [this](Index id) { return id < 0 || id >= this->View.numberOfPoints; }))
  {
    return false; // the mesh reports the error
  }
  const Vec3 a = pointOf(this->View, node[0]);
  return cross(pointOf(this->View, node[1]) - a, pointOf(this->View, node[2]) - a)[1] < 0;
}

//------------------------------------------------------------------------------
void MeshAdapter::takeCells(vtkDataSet* input)
{
  const Index count = input->GetNumberOfCells();
  this->View.numberOfCells = count;

  // An unstructured grid without pixels, voxels and polygons is used as it is.
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    this->GivenTypes = cellTypesOf(grid);
    const unsigned char* type = this->GivenTypes ? this->GivenTypes->GetPointer(0) : nullptr;
    const bool plain = type &&
      std::none_of(type, type + count,
        [](unsigned char t)
        {
          return t == VTK_PIXEL || t == VTK_VOXEL || t == VTK_POLYGON || t == VTK_LAGRANGE_WEDGE ||
            t == VTK_BEZIER_WEDGE;
        });
    if (plain && plainArrays(grid->GetCells(), this->View.offsets, this->View.connectivity))
    {
      this->View.cellTypes = type;
      return;
    }
  }

  this->Types.resize(count);
  this->View.cellTypes = this->Types.data();
  auto* poly = vtkPolyData::SafeDownCast(input);
  if (poly && poly->GetNumberOfPolys() == count &&
    plainArrays(poly->GetPolys(), this->View.offsets, this->View.connectivity))
  {
    for (Index i = 0; i < count; ++i)
    {
      this->Types[i] = kernelType(VTK_POLYGON, this->View.offsets[i + 1] - this->View.offsets[i]);
    }
    return;
  }

  // Anything else is converted cell by cell.
  this->Offsets.reserve(count + 1);
  this->Offsets.push_back(0);
  auto ids = vtkSmartPointer<vtkIdList>::New();
  for (Index i = 0; i < count; ++i)
  {
    const int type = input->GetCellType(i);
    input->GetCellPoints(i, ids);
    const vtkIdType size = ids->GetNumberOfIds();
    this->Types[i] = kernelType(type, size);
    const Index first = static_cast<Index>(this->Connectivity.size());
    this->Connectivity.insert(
      this->Connectivity.end(), ids->GetPointer(0), ids->GetPointer(0) + size);
    // A pixel across y runs along x, then z, so its normal is -y; the normal of the plane is +y.
    if (type == VTK_PIXEL && size == 4 && this->acrossY(first))
    {
      std::swap(this->Connectivity[first + 1], this->Connectivity[first + 2]);
    }
    // Lagrange and Bezier wedges list their triangles as seen from inside, unlike all other wedges.
    if ((type == VTK_LAGRANGE_WEDGE || type == VTK_BEZIER_WEDGE) && size >= 6)
    {
      std::swap(this->Connectivity[first + 1], this->Connectivity[first + 2]);
      std::swap(this->Connectivity[first + 4], this->Connectivity[first + 5]);
    }
    // Pixels and voxels list points row by row; quadrilaterals and hexahedra list them around a
    // face.
    if ((type == VTK_PIXEL && size == 4) || (type == VTK_VOXEL && size == 8))
    {
      std::swap(this->Connectivity[first + 2], this->Connectivity[first + 3]);
    }
    if (type == VTK_VOXEL && size == 8)
    {
      std::swap(this->Connectivity[first + 6], this->Connectivity[first + 7]);
    }
    this->Offsets.push_back(static_cast<Index>(this->Connectivity.size()));
  }
  this->Connectivity.reserve(1); // so that data() is never null
  this->View.offsets = this->Offsets.data();
  this->View.connectivity = this->Connectivity.data();
}

namespace
{
/// Vertices, lines and empty cells have no quality.
bool hasQuality(int vtkType)
{
  switch (vtkType)
  {
    case VTK_EMPTY_CELL:
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
    case VTK_LINE:
    case VTK_POLY_LINE:
    case VTK_QUADRATIC_EDGE:
    case VTK_CUBIC_LINE:
    case VTK_LAGRANGE_CURVE:
    case VTK_BEZIER_CURVE:
      return false;
    default:
      return true;
  }
}
}

//------------------------------------------------------------------------------
MeshRemarks MeshAdapter::remarks(bool ghosts) const
{
  MeshRemarks remarks;
  const Mesh& mesh = *this->TheMesh;
  const bool any = mesh.higherOrderCells() > 0 || mesh.unsupportedCells() > 0;
  for (Index i = 0; any && i < this->View.numberOfCells; ++i)
  {
    const unsigned char type = this->View.cellTypes[i];
    if (!ghosts && this->Ghosts && this->Ghosts[i])
    {
      continue;
    }
    if (cornerType(type) != CellType::Unsupported)
    {
      remarks.higherOrderCells += isHigherOrder(type);
    }
    else if (hasQuality(type))
    {
      ++remarks.notMeasured[type];
    }
  }
  for (const CollapsedCell& collapsed : this->Collapsed.found)
  {
    if (ghosts || !this->Ghosts || !this->Ghosts[collapsed.cell])
    {
      ++remarks.collapsed[collapsedKey(collapsed.given, collapsed.remaining)];
    }
  }
  remarks.nonFinitePoints = mesh.nonFinitePoints();
  remarks.coarseness = this->coarseness();
  return remarks;
}

//------------------------------------------------------------------------------
std::string MeshAdapter::notice() const
{
  return describe(this->remarks());
}

namespace
{
std::string describeCollapsed(const std::map<int, Index>& collapsed)
{
  std::string text;
  for (const auto& [key, cells] : collapsed)
  {
    const CellTopology& given = topology(static_cast<CellType>(key / 100));
    const auto remaining = static_cast<CellType>(key % 100);
    const bool one = cells == 1;
    text += std::to_string(cells) + " " + (one ? given.name : given.plural) +
      (one ? " that lists points twice " : " that list points twice ");
    if (remaining == CellType::Unsupported)
    {
      text += std::string(one ? "leaves" : "leave") + " no other shape and " +
        (one ? "counts" : "count") +
        " as degenerate: replace such cells in the program that made the mesh. ";
      continue;
    }
    const CellTopology& shape = topology(remaining);
    text += std::string(one ? "is measured as a " : "are measured as ") +
      (one ? shape.name : shape.plural) + ". ";
  }
  return text;
}
}

//------------------------------------------------------------------------------
std::string describe(const MeshRemarks& remarks)
{
  std::string text = describeCollapsed(remarks.collapsed);
  if (remarks.higherOrderCells > 0)
  {
    text += std::to_string(remarks.higherOrderCells) +
      " cells of quadratic or higher order are measured on their corners only. ";
  }
  if (!remarks.notMeasured.empty())
  {
    text += "Not measured as elements:";
    for (const auto& entry : remarks.notMeasured)
    {
      text += " " + std::to_string(entry.second) + " " + cellClassName(entry.first) + ",";
    }
    text.back() = '.';
    const auto is = [&remarks](int type) { return remarks.notMeasured.count(type) > 0; };
    if (is(PolyhedronType) || is(PolygonType))
    {
      text += " Metrics of finite volumes, such as non_orthogonality, measure polyhedra and, in "
              "plane meshes, polygons.";
    }
    // ParaView's Triangulate takes poly data only; Tetrahedralize takes all data sets.
    text += " Run Tetrahedralize first to measure them as elements: it cuts all cells into "
            "triangles or tetrahedra. ";
  }
  if (remarks.nonFinitePoints > 0)
  {
    text += std::to_string(remarks.nonFinitePoints) +
      " points have a NaN or infinite coordinate; cells that use them have Validity -3. ";
  }
  text += remarks.coarseness.empty() ? "" : remarks.coarseness + " ";
  if (!text.empty())
  {
    text.pop_back();
  }
  return text;
}

//------------------------------------------------------------------------------
std::string firstText(RankGroup& group, const std::string& own)
{
  for (const std::vector<char>& text : group.gatherItems(std::vector<char>(own.begin(), own.end())))
  {
    if (!text.empty())
    {
      return { text.begin(), text.end() };
    }
  }
  return "";
}

namespace
{
/// The sums of numbers of cells by a key, on all ranks.
std::map<int, Index> sumsByKey(RankGroup& group, const std::map<int, Index>& own)
{
  struct Count
  {
    Index key, cells;
  };
  std::vector<Count> counts;
  for (const auto& [key, cells] : own)
  {
    counts.push_back({ key, cells });
  }
  std::map<int, Index> sums;
  for (const std::vector<Count>& list : group.gatherItems(counts))
  {
    for (const Count& count : list)
    {
      sums[static_cast<int>(count.key)] += count.cells;
    }
  }
  return sums;
}
}

//------------------------------------------------------------------------------
MeshRemarks joinRemarks(RankGroup& group, const MeshRemarks& own)
{
  MeshRemarks all;
  all.higherOrderCells = group.sum(own.higherOrderCells);
  all.nonFinitePoints = group.sum(own.nonFinitePoints);
  all.notMeasured = sumsByKey(group, own.notMeasured);
  all.collapsed = sumsByKey(group, own.collapsed);
  all.coarseness = firstText(group, own.coarseness);
  return all;
}

//------------------------------------------------------------------------------
std::size_t MeshAdapter::copiedBytes() const
{
  return this->Points.size() * sizeof(double) + this->Types.size() + this->Collapsed.types.size() +
    (this->Offsets.size() + this->Connectivity.size() + this->OrientedConnectivity.size() +
      this->Collapsed.offsets.size() + this->Collapsed.connectivity.size()) *
    sizeof(Index);
}

//------------------------------------------------------------------------------
std::string describe(const Orientation& o, Dimension dimension)
{
  const std::string seen =
    dimension == Dimension::Planar ? " (clockwise, seen against the plane's normal)" : "";
  if (o.state == Orientation::Reversed)
  {
    return "The mesh is reversed: its cells list their points in the opposite order" + seen + ", " +
      std::to_string(o.negativeCells) + " of " + std::to_string(o.negativeCells + o.positiveCells) +
      " being negative.";
  }
  if (o.state == Orientation::Mixed)
  {
    std::string text = "The orientation of the mesh is mixed: ";
    if (o.disagreeing > 0)
    {
      text += std::to_string(o.disagreeing) +
        (dimension == Dimension::Volume ? " faces" : " edges") +
        " have neighbors that list their points in opposite order";
    }
    else
    {
      text += std::to_string(o.reversedParts) + " of " + std::to_string(o.parts) +
        " connected parts are reversed";
    }
    return text + ".";
  }
  return "";
}

//------------------------------------------------------------------------------
std::string describe(const RankOrder& found, Dimension dimension)
{
  std::string text = describe(found.orientation, dimension);
  const CellOrder& order = found.order;
  if (order.ambiguous > 0)
  {
    const std::string cells = order.firstAmbiguous >= 0
      ? "The cells connected with cell " + std::to_string(order.firstAmbiguous)
      : "The cells of " + std::to_string(order.ambiguous) + " connected parts";
    text += " " + cells + " have no consistent orientation, as on a Moebius band.";
  }
  if (order.reversed > 0)
  {
    text += " " + std::to_string(order.reversed) + " of the " + std::to_string(order.cells) +
      (order.reversed == 1 ? " cells is" : " cells are") +
      " treated as if listed in the opposite order.";
  }
  if (found.orientation.state == Orientation::Reversed)
  {
    text += " It is treated as if its cells were flipped.";
  }
  return text;
}

namespace
{
/// The order of the points that mirrors a cell, for each type.
std::vector<int> mirroredOrder(int vtkType, vtkIdType size)
{
  switch (vtkType)
  {
    case VTK_TRIANGLE:
      return { 0, 2, 1 };
    case VTK_QUAD:
      return { 0, 3, 2, 1 };
    case VTK_TETRA:
      return { 0, 2, 1, 3 };
    case VTK_HEXAHEDRON:
      return { 4, 5, 6, 7, 0, 1, 2, 3 };
    case VTK_WEDGE:
      return { 3, 4, 5, 0, 1, 2 };
    case VTK_PYRAMID:
      return { 0, 3, 2, 1, 4 };
    default:
      break;
  }
  if (isHigherOrder(vtkType) || vtkType == VTK_PIXEL || vtkType == VTK_VOXEL ||
    vtkType == VTK_POLYHEDRON)
  {
    throw Error(
      "Only linear cells can be flipped in the output; choose to measure the mesh as if it "
      "were flipped.");
  }
  std::vector<int> order(size);
  for (vtkIdType k = 0; k < size; ++k)
  {
    order[k] = static_cast<int>(vtkType == VTK_POLYGON ? size - 1 - k : k);
  }
  return order;
}
}

//------------------------------------------------------------------------------
void flipCells(vtkDataSet* data, const std::vector<unsigned char>& flags)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  auto* poly = vtkPolyData::SafeDownCast(data);
  if (!grid && !poly)
  {
    throw Error(
      "The cells of a structured grid cannot be flipped in the output; choose to measure the "
      "mesh as if it were flipped.");
  }
  vtkCellArray* old = grid ? grid->GetCells() : poly->GetPolys();
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->AllocateExact(old->GetNumberOfCells(), old->GetNumberOfConnectivityIds());
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (vtkIdType i = 0; i < old->GetNumberOfCells(); ++i)
  {
    old->GetCellAtId(i, size, ids);
    if (!flags.empty() && !flags[i])
    {
      cells->InsertNextCell(size, ids);
      continue;
    }
    cells->InsertNextCell(static_cast<int>(size));
    for (int k : mirroredOrder(grid ? grid->GetCellType(i) : VTK_POLYGON, size))
    {
      cells->InsertCellPoint(ids[k]);
    }
  }
  if (grid)
  {
    auto types = vtkSmartPointer<vtkUnsignedCharArray>::New();
    types->DeepCopy(storedCellTypes(grid));
    grid->SetCells(types, cells);
  }
  else
  {
    poly->SetPolys(cells);
  }
}

//------------------------------------------------------------------------------
std::vector<unsigned char> facesBesideVolumes(const Mesh& mesh)
{
  std::vector<unsigned char> skip;
  for (const CellBlock& block : mesh.blocks())
  {
    if (mesh.dimension() == Dimension::Volume && topology(block.type).dimension == 2)
    {
      skip.resize(mesh.view().numberOfCells, 0);
      for (Index i = 0; i < block.count; ++i)
      {
        skip[block.cell(i)] = 1;
      }
    }
  }
  return skip;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> cellsToSkip(const MeshAdapter& adapter)
{
  std::vector<unsigned char> skip = facesBesideVolumes(adapter.mesh());
  if (const unsigned char* ghosts = adapter.ghostCells())
  {
    skip.resize(adapter.mesh().view().numberOfCells, 0);
    std::transform(skip.begin(), skip.end(), ghosts, skip.begin(),
      [](unsigned char face, unsigned char ghost) { return face ? face : ghost; });
  }
  return skip;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> cellsBesideElements(const MeshAdapter& adapter)
{
  std::vector<unsigned char> skip = cellsToSkip(adapter);
  const MeshView& view = adapter.mesh().view();
  for (Index i = 0; adapter.mesh().unsupportedCells() > 0 && i < view.numberOfCells; ++i)
  {
    const unsigned char type = view.cellTypes[i];
    if (cornerType(type) == CellType::Unsupported && !hasQuality(type))
    {
      skip.resize(view.numberOfCells, 0);
      skip[i] = 1;
    }
  }
  return skip;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPoints> makePoints(const std::vector<double>& coordinates, vtkPoints* like)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  // Integers cannot hold points that moved.
  const bool single = like && like->GetDataType() == VTK_FLOAT;
  points->SetDataType(single ? VTK_FLOAT : VTK_DOUBLE);
  points->SetNumberOfPoints(static_cast<vtkIdType>(coordinates.size() / 3));
  auto range = vtk::DataArrayValueRange<3>(points->GetData());
  std::copy(coordinates.begin(), coordinates.end(), range.begin());
  return points;
}
}
