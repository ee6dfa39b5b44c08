// SPDX-License-Identifier: BSD-3-Clause
#include "MovedBoundary.h"

#include "Blocks.h"
#include "tautline/Deformation/WarpOptions.h"
#include "tautline/Mesh/BoundaryPoints.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tautline
{
namespace
{
Index count(const PointFlags& flags)
{
  return static_cast<Index>(flags.size()) - std::count(flags.begin(), flags.end(), 0);
}

/// Calls mark(point) for the points of a cell.
template <class Mark>
void forEachPoint(const MeshView& view, Index cell, const Mark& mark)
{
  std::for_each(
    view.connectivity + view.offsets[cell], view.connectivity + view.offsets[cell + 1], mark);
}

/// Marks the points, or all points of the cells, for which chosen(value) holds.
template <class Chosen>
void markWhere(
  const Mesh& mesh, vtkDataArray* array, bool ofCells, PointFlags& flags, const Chosen& chosen)
{
  const MeshView& view = mesh.view();
  const Index size = ofCells ? view.numberOfCells : view.numberOfPoints;
  for (Index i = 0; array && i < size; ++i)
  {
    if (!chosen(array->GetComponent(i, 0)))
    {
      continue;
    }
    if (ofCells)
    {
      forEachPoint(view, i, [&flags](Index point) { flags[point] = 1; });
    }
    else
    {
      flags[i] = 1;
    }
  }
}

PointFlags pointsOfParts(const PartChoice& choice)
{
  const BoundaryParts& parts = choice.parts();
  std::vector<char> chosen(parts.parts + 1, 0);
  for (int number : choice.numbers)
  {
    if (number < 1 || number > parts.parts)
    {
      throw Error("There is no boundary part " + std::to_string(number) +
        ": there are parts 1 to " + std::to_string(parts.parts) + ", the largest first.");
    }
    chosen[number] = 1;
  }
  if (choice.part == MovedPart::Inner)
  {
    std::transform(parts.outer.begin(), parts.outer.end(), chosen.begin() + 1,
      [](char outer) { return char(!outer); });
    if (std::find(chosen.begin(), chosen.end(), 1) == chosen.end())
    {
      std::fill(chosen.begin() + 1, chosen.end(), 1); // only an outer boundary
    }
  }
  PointFlags flags(parts.part.size());
  std::transform(parts.part.begin(), parts.part.end(), flags.begin(),
    [&chosen](int part) { return static_cast<unsigned char>(chosen[part]); });
  return flags;
}
}

//------------------------------------------------------------------------------
bool hasNoInside(int type)
{
  return type == VTK_EMPTY_CELL || type == VTK_VERTEX || type == VTK_POLY_VERTEX ||
    type == VTK_LINE || type == VTK_POLY_LINE;
}

//------------------------------------------------------------------------------
void requireShapes(Index shapeless)
{
  if (shapeless > 0)
  {
    throw Error("The mesh has " + std::to_string(shapeless) +
      " polygons, polyhedra or other cells that cannot be warped: run Tetrahedralize first to cut "
      "all cells into triangles or tetrahedra.");
  }
}

//------------------------------------------------------------------------------
void requireElements(const MovableMesh& mesh)
{
  const MeshView& view = mesh.mesh().view();
  Index shapeless = 0, inverted = 0, first = -1;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const signed char validity = mesh.validity()[cell];
    shapeless += validity == NotMeasured && !hasNoInside(view.cellTypes[cell]);
    if (isInvalid(validity) && !(mesh.skipped() && mesh.skipped()[cell]))
    {
      ++inverted;
      first = first < 0 ? cell : first;
    }
  }
  if (mesh.mesh().nonFinitePoints() > 0)
  {
    throw Error(std::to_string(mesh.mesh().nonFinitePoints()) +
      " points have a coordinate that is NaN or infinite: repair them or leave them out "
      "(Threshold).");
  }
  requireShapes(shapeless);
  if (inverted > 0)
  {
    throw Error(std::to_string(inverted) +
      " elements are inverted or degenerate before the warp; the first is element " +
      std::to_string(first) + ": run Untangle Mesh first.");
  }
}

//------------------------------------------------------------------------------
PointFlags boundaryOf(const Mesh& mesh)
{
  const std::vector<char> boundary = boundaryPoints(mesh);
  PointFlags flags(boundary.begin(), boundary.end());
  if (count(flags) == 0)
  {
    throw Error("The mesh has no boundary (it is closed) that its points could follow.");
  }
  return flags;
}

//------------------------------------------------------------------------------
PointFlags movedPoints(const Mesh& mesh, const PointFlags& boundary, const PartChoice& choice)
{
  switch (choice.part)
  {
    case MovedPart::Automatic:
    case MovedPart::Whole:
      return boundary;
    case MovedPart::Inner:
      return pointsOfParts(choice);
    case MovedPart::Numbered:
      if (choice.numbers.empty())
      {
        throw Error(
          "No boundary part is given: add the numbers of the parts that move; 1 is the largest.");
      }
      return pointsOfParts(choice);
    case MovedPart::Values:
    case MovedPart::Selection:
      break;
  }
  PointFlags flags = markedPoints(mesh, choice);
  const Index chosen = count(flags);
  for (std::size_t i = 0; i < flags.size(); ++i)
  {
    flags[i] = flags[i] && boundary[i];
  }
  if (!(chosen == 0 && choice.elsewhere))
  {
    requireMoved(count(flags), chosen);
  }
  return flags;
}

//------------------------------------------------------------------------------
void requireMoved(Index moved, Index chosen)
{
  if (moved == 0)
  {
    throw Error("None of the " + std::to_string(chosen) +
      " points chosen to move is on the boundary: choose others, or other values.");
  }
}

//------------------------------------------------------------------------------
PointFlags markedPoints(const Mesh& mesh, const PartChoice& choice)
{
  PointFlags flags(mesh.view().numberOfPoints, 0);
  if (choice.part == MovedPart::Values)
  {
    if (!choice.array)
    {
      throw Error("No array is chosen for the part that moves: choose one, or another Moved Part.");
    }
    const std::set<double> values(choice.values.begin(), choice.values.end());
    markWhere(mesh, choice.array, choice.ofCells, flags,
      [&values](double value) { return values.empty() ? value != 0 : values.count(value) > 0; });
    return flags;
  }
  if (!choice.selected && !choice.elsewhere)
  {
    throw Error("No points to move are selected: select points or cells and press Copy Active "
                "Selection, or choose another Moved Part.");
  }
  markPoints(mesh.view(), choice.selected, flags);
  return flags;
}

//------------------------------------------------------------------------------
void markGhosts(vtkDataSet* input, PointFlags& flags)
{
  vtkUnsignedCharArray* ghosts = input->GetCellGhostArray();
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; ghosts && cell < input->GetNumberOfCells(); ++cell)
  {
    if (ghosts->GetValue(cell) &
      (vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL))
    {
      input->GetCellPoints(cell, points);
      for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i)
      {
        flags[points->GetId(i)] = 1;
      }
    }
  }
}

//------------------------------------------------------------------------------
std::vector<double> displacementsOf(vtkDataArray* array, const PointFlags& flags)
{
  if (!array)
  {
    throw Error("No array of displacements is chosen: choose a point array of vectors, or another "
                "Motion.");
  }
  const std::string name = std::string("The array '") + array->GetName() + "'";
  const int components = array->GetNumberOfComponents();
  if (components != 2 && components != 3)
  {
    throw Error(name + " has " + std::to_string(components) +
      " components per point: a displacement has 3 (or 2, in the plane).");
  }
  std::vector<double> result(3 * flags.size(), 0.0);
  Index wrong = 0, first = -1;
  for (Index i = 0; i < static_cast<Index>(flags.size()); ++i)
  {
    for (int k = 0; flags[i] && k < components; ++k)
    {
      result[3 * i + k] = array->GetComponent(i, k);
    }
    const double* d = &result[3 * i];
    if (!std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2]))
    {
      ++wrong;
      first = first < 0 ? i : first;
    }
  }
  if (wrong > 0)
  {
    throw Error(name + " is NaN or infinite at " + std::to_string(wrong) + " of " +
      std::to_string(count(flags)) + " points of the boundary; the first is point " +
      std::to_string(first) + ": give each of them a displacement, 0 where it stays.");
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<double> tensorsOf(vtkDataArray* array)
{
  if (!array)
  {
    throw Error("No array of coefficients is chosen: choose a cell array of tensors, or other "
                "Coefficients.");
  }
  const int components = array->GetNumberOfComponents();
  if (components != 1 && components != 3 && components != 6 && components != 9)
  {
    throw Error(std::string("The array '") + array->GetName() + "' has " +
      std::to_string(components) +
      " components per cell: coefficients have 1 (isotropic), 3 (alpha, beta, gamma), 6 (xx yy zz "
      "xy yz "
      "xz) or 9.");
  }
  const vtkIdType cells = array->GetNumberOfTuples();
  std::vector<double> result(6 * cells, 0.0);
  for (vtkIdType i = 0; i < cells; ++i)
  {
    double value[9];
    array->GetTuple(i, value);
    double* tensor = &result[6 * i];
    if (components == 6)
    {
      std::copy_n(value, 6, tensor);
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      tensor[k] = value[components == 1 ? 0 : components == 3 ? k : 4 * k];
    }
    if (components == 9)
    {
      tensor[3] = (value[1] + value[3]) / 2;
      tensor[4] = (value[5] + value[7]) / 2;
      tensor[5] = (value[2] + value[6]) / 2;
    }
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<double> tensorsOf(vtkDataArray* regions,
  const std::vector<std::array<double, 4>>& coefficients, const double* otherwise)
{
  if (!regions)
  {
    throw Error("No array of regions is chosen: choose a cell array, or other Coefficients.");
  }
  const vtkIdType cells = regions->GetNumberOfTuples();
  std::vector<double> result(6 * cells);
  for (vtkIdType i = 0; i < cells; ++i)
  {
    const double region = regions->GetComponent(i, 0);
    const auto found = std::find_if(coefficients.begin(), coefficients.end(),
      [region](const std::array<double, 4>& row) { return row[0] == region; });
    double* tensor = &result[6 * i];
    std::copy_n(otherwise, 6, tensor);
    if (found != coefficients.end())
    {
      std::copy_n(found->data() + 1, 3, tensor);
      std::fill_n(tensor + 3, 3, 0.0);
    }
  }
  return result;
}

//------------------------------------------------------------------------------
void requireTensor(const double* tensor, Index cell, const char* where)
{
  if (!isPositiveSemidefinite(tensor))
  {
    throw Error("The coefficients of cell " + std::to_string(cell) + " of the " + where +
      " are not finite or not positive semidefinite: correct the array, or choose other "
      "Coefficients.");
  }
}
}
