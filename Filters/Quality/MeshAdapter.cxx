#include "MeshAdapter.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellTypes.h"
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
#include <map>

namespace tautline
{
static_assert(sizeof(vtkIdType) == sizeof(Index), "Tautline needs a VTK with 64-bit ids.");

//------------------------------------------------------------------------------
MeshAdapter::MeshAdapter(vtkDataSet* input, int threads)
{
  this->takePoints(input);
  this->takeCells(input);
  if (vtkUnsignedCharArray* ghosts = input->GetCellGhostArray())
  {
    this->Ghosts = ghosts->GetPointer(0);
  }
  this->TheMesh = std::make_unique<Mesh>(this->View, threads);
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
  offsets = reinterpret_cast<const Index*>(cells->GetOffsetsArray64()->GetPointer(0));
  connectivity = reinterpret_cast<const Index*>(cells->GetConnectivityArray64()->GetPointer(0));
  return true;
}

/// Types whose local numbering or generality differs from the kernel's, and what they become.
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
void MeshAdapter::takeCells(vtkDataSet* input)
{
  const Index count = input->GetNumberOfCells();
  this->View.numberOfCells = count;

  // An unstructured grid without pixels, voxels and polygons is taken as it is.
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    vtkUnsignedCharArray* types = grid->GetCellTypesArray();
    const unsigned char* type = types ? types->GetPointer(0) : nullptr;
    const bool plain = type &&
      std::none_of(type, type + count,
        [](unsigned char t) { return t == VTK_PIXEL || t == VTK_VOXEL || t == VTK_POLYGON; });
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

  // Anything else goes cell by cell.
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
    // Pixels and voxels count rows of points; quadrilaterals and hexahedra walk round.
    if (type == VTK_PIXEL || type == VTK_VOXEL)
    {
      std::swap(this->Connectivity[first + 2], this->Connectivity[first + 3]);
    }
    if (type == VTK_VOXEL)
    {
      std::swap(this->Connectivity[first + 6], this->Connectivity[first + 7]);
    }
    this->Offsets.push_back(static_cast<Index>(this->Connectivity.size()));
  }
  this->Connectivity.reserve(1); // so that data() is never null
  this->View.offsets = this->Offsets.data();
  this->View.connectivity = this->Connectivity.data();
}

//------------------------------------------------------------------------------
std::string MeshAdapter::notice() const
{
  std::string text;
  const Mesh& mesh = *this->TheMesh;
  if (mesh.higherOrderCells() > 0)
  {
    text += std::to_string(mesh.higherOrderCells()) +
      " cells of quadratic or higher order are measured on their corners only. ";
  }
  if (mesh.unsupportedCells() > 0)
  {
    std::map<int, Index> counts;
    for (Index i = 0; i < this->View.numberOfCells; ++i)
    {
      if (cornerType(this->View.cellTypes[i]) == CellType::Unsupported)
      {
        ++counts[this->View.cellTypes[i]];
      }
    }
    text += "Not measured:";
    for (const auto& entry : counts)
    {
      text += " " + std::to_string(entry.second) + " " +
        vtkCellTypes::GetClassNameFromTypeId(entry.first) + ",";
    }
    text.back() = '.';
    text +=
      " Vertices and lines have no quality; run Triangulate or Tetrahedralize first to measure "
      "polygons, strips and polyhedra. ";
  }
  if (mesh.nonFinitePoints() > 0)
  {
    text += std::to_string(mesh.nonFinitePoints()) +
      " points have a NaN or infinite coordinate; cells that use them have Validity -3. ";
  }
  if (!text.empty())
  {
    text.pop_back();
  }
  return text;
}

//------------------------------------------------------------------------------
std::size_t MeshAdapter::copiedBytes() const
{
  return this->Points.size() * sizeof(double) + this->Types.size() +
    (this->Offsets.size() + this->Connectivity.size()) * sizeof(Index);
}

//------------------------------------------------------------------------------
std::string describe(const Orientation& o, const Mesh& mesh)
{
  const std::string seen =
    mesh.dimension() == Dimension::Planar ? " (clockwise, seen against the plane's normal)" : "";
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
        (mesh.dimension() == Dimension::Volume ? " faces" : " edges") +
        " have neighbours that list their points in opposite senses";
    }
    else
    {
      text += std::to_string(o.reversedParts) + " of " + std::to_string(o.parts) +
        " connected parts are reversed";
    }
    return text +
      ". Cells of the wrong orientation count as inverted; make the orientation consistent first "
      "(for surfaces: Surface Normals with Consistency).";
  }
  return "";
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPoints> makePoints(const std::vector<double>& coordinates, vtkPoints* like)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(like ? like->GetDataType() : VTK_DOUBLE);
  points->SetNumberOfPoints(static_cast<vtkIdType>(coordinates.size() / 3));
  auto range = vtk::DataArrayValueRange<3>(points->GetData());
  std::copy(coordinates.begin(), coordinates.end(), range.begin());
  return points;
}
}
