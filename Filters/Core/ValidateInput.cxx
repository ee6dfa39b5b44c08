// SPDX-License-Identifier: BSD-3-Clause
#include "ValidateInput.h"

#include "Blocks.h"
#include "Processes.h"
#include "VtkCompatibility.h"
#include "tautline/Mesh/ArrayChecks.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkExplicitStructuredGrid.h"
#include "vtkFloatArray.h"
#include "vtkGraph.h"
#include "vtkHyperTreeGrid.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkStructuredGrid.h"
#include "vtkTable.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tautline
{
static_assert(sizeof(vtkIdType) == sizeof(Index), "Tautline needs a VTK with 64-bit ids.");

namespace
{
constexpr const char* CheckSource = "Check the file or the program that made the mesh.";

/// The number of points of each VTK cell type; of corners for types of any order.
CellSizes makeCellSizes()
{
  CellSizes sizes;
  const auto set = [&sizes](std::initializer_list<std::pair<int, int>> numbers)
  {
    for (const auto& [type, points] : numbers)
    {
      sizes.points[static_cast<std::size_t>(type)] = points;
    }
  };
  // Obsolete types, and types without a fixed size, may list any number of points.
  for (int type = VTK_EMPTY_CELL; type < VTK_NUMBER_OF_CELL_TYPES; ++type)
  {
    const bool exists = std::string(cellClassName(type)) != "UnknownClass";
    sizes.points[static_cast<std::size_t>(type)] =
      exists ? CellSizes::atLeast(0) : CellSizes::Unknown;
  }
  set({ { VTK_VERTEX, 1 }, { VTK_LINE, 2 }, { VTK_TRIANGLE, 3 }, { VTK_PIXEL, 4 }, { VTK_QUAD, 4 },
    { VTK_TETRA, 4 }, { VTK_VOXEL, 8 }, { VTK_HEXAHEDRON, 8 }, { VTK_WEDGE, 6 }, { VTK_PYRAMID, 5 },
    { VTK_PENTAGONAL_PRISM, 10 }, { VTK_HEXAGONAL_PRISM, 12 } });
  set({ { VTK_QUADRATIC_EDGE, 3 }, { VTK_QUADRATIC_TRIANGLE, 6 }, { VTK_QUADRATIC_QUAD, 8 },
    { VTK_QUADRATIC_TETRA, 10 }, { VTK_QUADRATIC_HEXAHEDRON, 20 }, { VTK_QUADRATIC_WEDGE, 15 },
    { VTK_QUADRATIC_PYRAMID, 13 }, { VTK_BIQUADRATIC_QUAD, 9 }, { VTK_TRIQUADRATIC_HEXAHEDRON, 27 },
    { VTK_TRIQUADRATIC_PYRAMID, 19 }, { VTK_QUADRATIC_LINEAR_QUAD, 6 },
    { VTK_QUADRATIC_LINEAR_WEDGE, 12 }, { VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18 },
    { VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 24 }, { VTK_BIQUADRATIC_TRIANGLE, 7 },
    { VTK_CUBIC_LINE, 4 } });
  const auto least = CellSizes::atLeast;
  set({ { VTK_POLY_VERTEX, least(1) }, { VTK_POLY_LINE, least(1) },
    { VTK_TRIANGLE_STRIP, least(3) }, { VTK_POLYGON, least(3) },
    { VTK_QUADRATIC_POLYGON, least(6) }, { VTK_POLYHEDRON, least(4) } });
  for (const int shift : { 0, VTK_BEZIER_CURVE - VTK_LAGRANGE_CURVE })
  {
    set({ { VTK_LAGRANGE_CURVE + shift, least(2) }, { VTK_LAGRANGE_TRIANGLE + shift, least(3) },
      { VTK_LAGRANGE_QUADRILATERAL + shift, least(4) },
      { VTK_LAGRANGE_TETRAHEDRON + shift, least(4) }, { VTK_LAGRANGE_HEXAHEDRON + shift, least(8) },
      { VTK_LAGRANGE_WEDGE + shift, least(6) }, { VTK_LAGRANGE_PYRAMID + shift, least(5) } });
  }
  return sizes;
}

const CellSizes& cellSizes()
{
  static const CellSizes sizes = makeCellSizes();
  return sizes;
}

/// "10 points (0 to 9)"
std::string range(Index points)
{
  return std::to_string(points) + " points" +
    (points > 0 ? " (0 to " + std::to_string(points - 1) + ")" : "");
}

//------------------------------------------------------------------------------
std::string arrayProblem(
  vtkDataSetAttributes* data, vtkIdType expected, const char* what, const char* plural)
{
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    if (!array)
    {
      continue;
    }
    const std::string name = array->GetName() ? array->GetName() : "";
    const std::string subject = std::string("The ") + what + " array '" + name + "' ";
    if (array->GetNumberOfTuples() != expected)
    {
      return subject + "has " + std::to_string(array->GetNumberOfTuples()) +
        " tuples; the mesh has " + std::to_string(expected) + " " + plural +
        ": compute the array again for this mesh, or leave it out (Pass Arrays).";
    }
    const bool ghosts = name == vtkDataSetAttributes::GhostArrayName();
    if (ghosts &&
      (!vtkUnsignedCharArray::SafeDownCast(array) || array->GetNumberOfComponents() != 1))
    {
      return subject +
        "marks ghosts and must have type unsigned char and one component; its type is " +
        array->GetDataTypeAsString() + " with " + std::to_string(array->GetNumberOfComponents()) +
        ": compute it again (Ghost Cells), or leave it out (Pass Arrays).";
    }
  }
  return "";
}

//------------------------------------------------------------------------------
std::string nonFinite(vtkDataArray* values, int components, int threads)
{
  const Index count = values->GetNumberOfValues();
  Index found = -1;
  if (auto* doubles = vtkDoubleArray::FastDownCast(values))
  {
    found = findNonFinite(doubles->GetPointer(0), count, threads);
  }
  else if (auto* floats = vtkFloatArray::FastDownCast(values))
  {
    found = findNonFinite(floats->GetPointer(0), count, threads);
  }
  else
  {
    for (Index i = 0; i < count && found < 0; ++i)
    {
      found = std::isfinite(values->GetComponent(i / components, static_cast<int>(i % components)))
        ? -1
        : i;
    }
  }
  return found < 0 ? ""
                   : "Point " + std::to_string(found / components) +
      " has a coordinate that is not a finite number: remove such points (Threshold, Clean), or "
      "repair the "
      "program that made them.";
}

//------------------------------------------------------------------------------
/// The arrays of a cell array as plain arrays, copied if VTK stores them differently.
template <class Id, class ArrayT>
const Id* plain(vtkDataArray* array, std::vector<Id>& copy)
{
  if (auto* typed = ArrayT::FastDownCast(array))
  {
    return reinterpret_cast<const Id*>(typed->GetPointer(0));
  }
  copy.resize(static_cast<std::size_t>(array->GetNumberOfValues()));
  for (std::size_t i = 0; i < copy.size(); ++i)
  {
    copy[i] = static_cast<Id>(array->GetComponent(static_cast<vtkIdType>(i), 0));
  }
  copy.reserve(1);
  return copy.data();
}

/// The requirements on the cells of a cell array.
struct CellRules
{
  vtkUnsignedCharArray* types = nullptr; ///< null: each cell has at least `least` points
  Index least = 0;
  Index points = 0;    ///< of the mesh
  Index firstCell = 0; ///< its index in the data set
  const char* name = "";
  int threads = 0;
};

template <class Id, class ArrayT>
std::string cellProblemOf(vtkCellArray* cells, const CellRules& rules)
{
  vtkDataArray* offsetArray = cells->GetOffsetsArray();
  vtkDataArray* idArray = cells->GetConnectivityArray();
  const Index count = std::max<Index>(cells->GetNumberOfCells(), 0);
  const Index length = idArray->GetNumberOfValues();
  if (offsetArray->GetNumberOfComponents() != 1 || idArray->GetNumberOfComponents() != 1)
  {
    return std::string("The connectivity has several components. ") + CheckSource;
  }
  std::vector<Id> offsetCopy, idCopy;
  const Id* offsets = plain<Id, ArrayT>(offsetArray, offsetCopy);
  const Id* ids = plain<Id, ArrayT>(idArray, idCopy);
  const auto cellName = [&](Index cell)
  { return "Cell " + std::to_string(rules.firstCell + cell); };
  if (count > 0 && offsets[0] != 0)
  {
    return cellName(0) + " begins at position " + std::to_string(offsets[0]) +
      " of the connectivity, not at 0. " + CheckSource;
  }

  // Sizes that fit are not negative, so that the offsets ascend.
  const Index wrong = rules.types
    ? findWrongSize(offsets, rules.types->GetPointer(0), count, cellSizes(), rules.threads)
    : findTooShort(offsets, count, rules.least, rules.threads);
  if (wrong >= 0)
  {
    const int type = rules.types ? rules.types->GetValue(wrong) : 0;
    if (offsets[wrong + 1] < offsets[wrong])
    {
      return cellName(wrong) +
        " has an invalid range in the connectivity: its offsets descend from " +
        std::to_string(offsets[wrong]) + " to " + std::to_string(offsets[wrong + 1]) + ". " +
        CheckSource;
    }
    if (rules.types && cellSizes().points[static_cast<std::size_t>(type)] == CellSizes::Unknown)
    {
      return cellName(wrong) + " has the type " + std::to_string(type) +
        ", which does not exist. " + CheckSource;
    }
    const std::string name = rules.types ? cellClassName(type) : rules.name;
    return cellName(wrong) + " is not a valid " + name + ": it lists " +
      std::to_string(offsets[wrong + 1] - offsets[wrong]) + " points. " + CheckSource;
  }
  if (count > 0 && static_cast<Index>(offsets[count]) != length)
  {
    return "The offsets of the cells end at " + std::to_string(offsets[count]) +
      ", but the connectivity has " + std::to_string(length) + " entries. " + CheckSource;
  }

  const Index place = count > 0 ? findIdOutside(ids, length, rules.points, rules.threads) : -1;
  if (place < 0)
  {
    return "";
  }
  const Index cell = std::upper_bound(offsets, offsets + count + 1, place) - offsets - 1;
  return cellName(cell) + " lists point " + std::to_string(ids[place]) + ", but the mesh has " +
    range(rules.points) + ". " + CheckSource;
}

std::string cellProblem(vtkCellArray* cells, const CellRules& rules)
{
  if (!cells)
  {
    return "";
  }
  return cells->IsStorage64Bit() ? cellProblemOf<std::int64_t, vtkTypeInt64Array>(cells, rules)
                                 : cellProblemOf<std::int32_t, vtkTypeInt32Array>(cells, rules);
}

//------------------------------------------------------------------------------
/// Ids of the faces of polyhedra, as a cell array or as a stream.
std::string polyhedronProblem(vtkUnstructuredGrid* grid, int threads)
{
  const vtkSmartPointer<vtkUnsignedCharArray> types = cellTypesOf(grid);
  const Index cells = grid->GetNumberOfCells();
  const unsigned char* type = types ? types->GetPointer(0) : nullptr;
  if (!type || std::find(type, type + cells, VTK_POLYHEDRON) == type + cells)
  {
    return "";
  }
  const Index points = grid->GetNumberOfPoints();
  const std::string missing =
    std::string("There are polyhedra without a list of their faces. ") + CheckSource;
#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 4)
  vtkCellArray* faces = grid->GetPolyhedronFaces();
  vtkCellArray* places = grid->GetPolyhedronFaceLocations();
  if (!faces || !places || places->GetNumberOfCells() != cells)
  {
    return missing;
  }
  CellRules rules;
  rules.least = 3;
  rules.points = points;
  rules.name = "face of a polyhedron";
  rules.threads = threads;
  const std::string problem = cellProblem(faces, rules);
  rules.least = 0;
  rules.points = faces->GetNumberOfCells();
  return problem.empty() ? cellProblem(places, rules) : problem;
#else
  vtkIdTypeArray* faces = grid->GetFaces();
  vtkIdTypeArray* places = grid->GetFaceLocations();
  if (!faces || !places || places->GetNumberOfValues() != cells)
  {
    return missing;
  }
  const auto* stream = reinterpret_cast<const Index*>(faces->GetPointer(0));
  const Index length = faces->GetNumberOfValues();
  for (Index cell = 0; cell < cells; ++cell)
  {
    if (type[cell] != VTK_POLYHEDRON)
    {
      continue;
    }
    // Number of faces; for each face its number of points and their ids.
    Index at = places->GetValue(cell);
    bool good = at >= 0 && at < length && stream[at] > 0;
    const Index count = good ? stream[at++] : 0;
    for (Index face = 0; good && face < count; ++face)
    {
      good = at < length && stream[at] >= 3 && stream[at] < length - at;
      const Index size = good ? stream[at++] : 0;
      good = good && findIdOutside(stream + at, size, points, threads) < 0;
      at += size;
    }
    if (!good)
    {
      return "The faces of cell " + std::to_string(cell) +
        ", a polyhedron, are corrupt: they list points that the mesh does not have, or exceed the "
        "array. " +
        CheckSource;
    }
  }
  return "";
#endif
}

//------------------------------------------------------------------------------
std::string gridProblem(vtkUnstructuredGrid* grid, int threads)
{
  const Index cells = grid->GetNumberOfCells();
  const vtkSmartPointer<vtkUnsignedCharArray> types = cellTypesOf(grid);
  const Index given = types ? types->GetNumberOfValues() : 0;
  if (given != cells)
  {
    return "There are " + std::to_string(cells) + " cells but " + std::to_string(given) +
      " cell types. " + CheckSource;
  }
  CellRules rules;
  rules.types = types;
  rules.points = grid->GetNumberOfPoints();
  rules.threads = threads;
  const std::string problem = cells > 0 ? cellProblem(grid->GetCells(), rules) : "";
  return problem.empty() ? polyhedronProblem(grid, threads) : problem;
}

std::string polyDataProblem(vtkPolyData* poly, int threads)
{
  CellRules rules;
  rules.points = poly->GetNumberOfPoints();
  rules.threads = threads;
  const struct
  {
    vtkCellArray* cells;
    Index least;
    const char* name;
  } kinds[] = { { poly->GetVerts(), 1, "vertex" }, { poly->GetLines(), 1, "line" },
    { poly->GetPolys(), 3, "polygon" }, { poly->GetStrips(), 3, "triangle strip" } };
  for (const auto& kind : kinds)
  {
    rules.least = kind.least;
    rules.name = kind.name;
    const std::string problem = cellProblem(kind.cells, rules);
    if (!problem.empty())
    {
      return problem;
    }
    rules.firstCell += kind.cells ? kind.cells->GetNumberOfCells() : 0;
  }
  return "";
}

/// The number of points for given dimensions.
std::string dimensionProblem(const int dimensions[3], Index points)
{
  Index expected = 1;
  for (int c = 0; c < 3; ++c)
  {
    expected *= std::max(dimensions[c], 0);
  }
  return expected == points
    ? ""
    : "The grid has " + std::to_string(points) + " points, but its dimensions, " +
      std::to_string(dimensions[0]) + " x " + std::to_string(dimensions[1]) + " x " +
      std::to_string(dimensions[2]) + ", need " + std::to_string(expected) + ". " + CheckSource;
}

std::string rectilinearProblem(vtkRectilinearGrid* grid, int threads)
{
  const char* const axes = "xyz";
  vtkDataArray* coordinates[] = { grid->GetXCoordinates(), grid->GetYCoordinates(),
    grid->GetZCoordinates() };
  int dimensions[3];
  grid->GetDimensions(dimensions);
  for (int c = 0; c < 3 && grid->GetNumberOfPoints() > 0; ++c)
  {
    const Index given = coordinates[c] ? coordinates[c]->GetNumberOfTuples() : 0;
    if (given != dimensions[c])
    {
      return "The grid has " + std::to_string(given) + " coordinates in " + axes[c] +
        " but its dimension is " + std::to_string(dimensions[c]) + ". " + CheckSource;
    }
    if (!nonFinite(coordinates[c], 1, threads).empty())
    {
      return std::string("A coordinate in ") + axes[c] + " is NaN or infinite. " + CheckSource;
    }
  }
  return "";
}

std::string imageProblem(vtkImageData* image)
{
  for (int c = 0; c < 3; ++c)
  {
    if (!std::isfinite(image->GetSpacing()[c]) || !std::isfinite(image->GetOrigin()[c]))
    {
      return std::string("The spacing or the origin of the image is NaN or infinite. ") +
        CheckSource;
    }
  }
  return "";
}

/// Structure first: VTK's own counts of points and cells follow from it.
std::string structureProblem(vtkDataSet* data, int threads)
{
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    return gridProblem(grid, threads);
  }
  if (auto* poly = vtkPolyData::SafeDownCast(data))
  {
    return polyDataProblem(poly, threads);
  }
  if (auto* image = vtkImageData::SafeDownCast(data))
  {
    return imageProblem(image);
  }
  if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data))
  {
    return rectilinearProblem(rectilinear, threads);
  }
  int dimensions[3];
  if (auto* curved = vtkStructuredGrid::SafeDownCast(data))
  {
    curved->GetDimensions(dimensions);
    return curved->GetPoints() ? dimensionProblem(dimensions, curved->GetNumberOfPoints()) : "";
  }
  if (auto* corner = vtkExplicitStructuredGrid::SafeDownCast(data))
  {
    CellRules rules;
    rules.least = 8;
    rules.points = corner->GetNumberOfPoints();
    rules.name = "hexahedron";
    rules.threads = threads;
    return cellProblem(corner->GetCells(), rules);
  }
  return "";
}

std::string dataSetProblem(vtkDataSet* data, const InputRules& rules)
{
  auto* set = vtkPointSet::SafeDownCast(data);
  vtkDataArray* points = set && set->GetPoints() ? set->GetPoints()->GetData() : nullptr;
  if (points && points->GetNumberOfComponents() != 3)
  {
    return "The points have " + std::to_string(points->GetNumberOfComponents()) +
      " coordinates, not 3. " + CheckSource;
  }
  std::string problem = structureProblem(data, rules.threads);
  if (problem.empty())
  {
    problem = arrayProblem(data->GetPointData(), data->GetNumberOfPoints(), "point", "points");
  }
  if (problem.empty())
  {
    problem = arrayProblem(data->GetCellData(), data->GetNumberOfCells(), "cell", "cells");
  }
  if (problem.empty() && rules.finitePoints && points)
  {
    problem = nonFinite(points, 3, rules.threads);
  }
  return problem;
}

/// A data object that is neither a data set nor composite, and how to convert it to a mesh.
std::string typeProblem(vtkDataObject* data)
{
  const char* remedy = "convert it to a mesh first";
  if (vtkHyperTreeGrid::SafeDownCast(data))
  {
    remedy = "run HyperTreeGrid To Unstructured Grid first";
  }
  else if (vtkTable::SafeDownCast(data))
  {
    remedy = "choose the mesh it belongs to, or run Table To Points and a mesher first";
  }
  else if (vtkGraph::SafeDownCast(data))
  {
    remedy = "choose a mesh; a graph has no elements";
  }
  return std::string("The input is a ") + data->GetClassName() + ", not a mesh: " + remedy + ".";
}
}

//------------------------------------------------------------------------------
std::string inputProblem(vtkDataObject* data, const InputRules& rules)
{
  if (!data)
  {
    return "";
  }
  const bool composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite && !vtkDataSet::SafeDownCast(data))
  {
    return typeProblem(data);
  }
  std::string problem;
  bool any = false;
  std::map<unsigned int, BlockPlace> places = blockPlaces(data);
  forEachLeaf(data,
    [&](unsigned int index, vtkDataSet* leaf)
    {
      any = true;
      if (problem.empty())
      {
        problem = dataSetProblem(leaf, rules);
        const std::string name = places[index].name();
        problem = problem.empty() || name.empty() ? problem : "In " + name + ": " + problem;
      }
    });
  if (!any && !skippedLeaves(data).empty())
  {
    return "None of the blocks is a mesh. " + skippedLeaves(data);
  }
  return problem;
}

//------------------------------------------------------------------------------
void validateInput(vtkDataObject* data, const InputRules& rules)
{
  const std::string problem = inputProblem(data, rules);
  if (!problem.empty())
  {
    throw Error(problem);
  }
}

//------------------------------------------------------------------------------
std::string emptyInput(vtkDataObject* data, const char* needed)
{
  const bool points = std::string(needed) == "points";
  vtkIdType count = 0, ofPoints = 0;
  bool some = false;
  forEachLeaf(data,
    [&](unsigned int, vtkDataSet* leaf)
    {
      count += points ? leaf->GetNumberOfPoints() : leaf->GetNumberOfCells();
      ofPoints += leaf->GetNumberOfPoints();
      some = true;
    });
  auto* controller = severalProcesses();
  const bool composite = vtkCompositeDataSet::SafeDownCast(data) != nullptr;
  if ((!some && !composite) || count > 0 || (controller && controller->GetLocalProcessId() > 0))
  {
    return "";
  }
  return std::string("The input has no ") + needed +
    (ofPoints > 0 ? ", only points: create cells first, with Delaunay 2D or Delaunay 3D."
                  : ": apply the filters before it, or choose another input.");
}

//------------------------------------------------------------------------------
void warnOfEmptyInput(vtkAlgorithm* filter, vtkDataObject* data, const char* needed)
{
  const std::string empty = emptyInput(data, needed);
  if (!empty.empty())
  {
    vtkWarningWithObjectMacro(filter, << empty);
  }
}

//------------------------------------------------------------------------------
std::string leftOut(vtkDataObject* block, const char* needed)
{
  return std::string("A block is a ") + (block ? block->GetClassName() : "null") + ", not a " +
    needed + ": it is left out.";
}

//------------------------------------------------------------------------------
std::string skippedLeaves(vtkDataObject* data)
{
  auto* blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks)
  {
    return "";
  }
  std::string list;
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    vtkDataObject* leaf = walk->GetCurrentDataObject();
    if (leaf && !vtkDataSet::SafeDownCast(leaf))
    {
      list += (list.empty() ? "" : ", ") + std::to_string(walk->GetCurrentFlatIndex()) + " (" +
        leaf->GetClassName() + ")";
    }
  }
  return list.empty() ? "" : "Blocks that are not meshes are left out: " + list + ".";
}

//------------------------------------------------------------------------------
std::string selectionProblem(vtkSelection* selection, vtkDataObject* mesh)
{
  auto* data = vtkDataSet::SafeDownCast(mesh);
  for (unsigned int i = 0; selection && i < selection->GetNumberOfNodes(); ++i)
  {
    vtkSelectionNode* node = selection->GetNode(i);
    if (node->GetContentType() != vtkSelectionNode::INDICES)
    {
      continue;
    }
    auto* ids = vtkDataArray::SafeDownCast(node->GetSelectionList());
    if (!ids)
    {
      return node->GetSelectionList() ? "The selection lists text instead of ids: select again."
                                      : "";
    }
    const bool ofPoints = node->GetFieldType() == vtkSelectionNode::POINT;
    // For composite data only ids that no block can have are rejected; VTK finds the block.
    Index limit = 0;
    const auto count = [&](vtkDataSet* set)
    { return ofPoints ? set->GetNumberOfPoints() : set->GetNumberOfCells(); };
    if (data)
    {
      limit = count(data);
    }
    else
    {
      forEachLeaf(
        mesh, [&](unsigned int, vtkDataSet* leaf) { limit = std::max<Index>(limit, count(leaf)); });
    }
    for (vtkIdType k = 0; k < ids->GetNumberOfTuples(); ++k)
    {
      const double id = ids->GetComponent(k, 0);
      if (!(id >= 0 && id < static_cast<double>(limit)))
      {
        const std::string what = ofPoints ? "point" : "cell";
        return "The selection names " + what + " " + ids->GetVariantValue(k).ToString() +
          ", but the mesh has " + std::to_string(limit) + " " + what +
          "s: it was made on another mesh; select again.";
      }
    }
  }
  return "";
}
}
