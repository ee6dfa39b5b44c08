// SPDX-License-Identifier: BSD-3-Clause
#include "TargetChoice.h"

#include "MeshAdapter.h"
#include "tautline/Mesh/CellOrder.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSet.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace tautline
{
namespace
{
/**
 * One tuple per cell from a point or cell array; a point array is averaged over the points of each
 * cell.
 */
std::vector<double> perCell(
  vtkDataArray* array, int association, const MeshView& view, const char* what)
{
  if (!array)
  {
    throw Error(std::string("The target needs ") + what +
      ": choose a point or cell array of the mesh for it.");
  }
  const bool onPoints = association == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  const vtkIdType expected = onPoints ? view.numberOfPoints : view.numberOfCells;
  if (array->GetNumberOfTuples() != expected)
  {
    throw Error(std::string("The array '") + (array->GetName() ? array->GetName() : "") + "' has " +
      std::to_string(array->GetNumberOfTuples()) + " tuples; the mesh has " +
      std::to_string(expected) + (onPoints ? " points." : " cells."));
  }
  const int components = array->GetNumberOfComponents();
  std::vector<double> result(components * view.numberOfCells, 0.0);
  std::vector<double> tuple(components);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    double* sum = result.data() + components * cell;
    if (!onPoints)
    {
      array->GetTuple(cell, sum);
      continue;
    }
    const Index begin = view.offsets[cell], end = view.offsets[cell + 1];
    for (Index i = begin; i < end; ++i)
    {
      array->GetTuple(view.connectivity[i], tuple.data());
      for (int c = 0; c < components; ++c)
      {
        sum[c] += tuple[c] / static_cast<double>(end - begin);
      }
    }
  }
  return result;
}

/// Converts tensors of 6 (xx yy zz xy yz xz) or 9 components to 3 x 3 matrices.
std::vector<double> asMatrices(const std::vector<double>& values, int components)
{
  if (components == 9)
  {
    return values;
  }
  if (components != 6)
  {
    throw Error("A metric tensor has 6 (xx yy zz xy yz xz) or 9 components; the array has " +
      std::to_string(components) + ".");
  }
  constexpr int entry[9] = { 0, 3, 5, 3, 1, 4, 5, 4, 2 };
  std::vector<double> matrices(values.size() / 6 * 9);
  for (std::size_t i = 0; i < matrices.size(); ++i)
  {
    matrices[i] = values[i / 9 * 6 + entry[i % 9]];
  }
  return matrices;
}

/// Reverses the cells of the reference that were reversed in `mesh` by orientation.
void orientAlike(const Mesh& mesh, MeshAdapter& reference)
{
  const MeshView& view = mesh.view();
  const MeshView& other = reference.mesh().view();
  if (view.numberOfCells != other.numberOfCells)
  {
    return; // referenceTargets() reports it
  }
  std::vector<unsigned char> reverse(view.numberOfCells, 0);
  for (const CellBlock& block : mesh.blocks())
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* wanted = view.connectivity + view.offsets[cell];
      if (cornerType(other.cellTypes[cell]) == block.type)
      {
        std::array<Index, MaxNodes> turned = {};
        std::copy_n(other.connectivity + other.offsets[cell], nodes, turned.begin());
        reverseCell(block.type, turned.data());
        reverse[cell] = std::equal(wanted, wanted + nodes, turned.begin());
      }
    }
  }
  if (std::any_of(reverse.begin(), reverse.end(), [](unsigned char flag) { return flag != 0; }))
  {
    reference.reverseCells(reverse);
  }
}

/// Views the reference, as its mirror image if it is reversed.
Targets fromReference(const Mesh& mesh, vtkDataSet* reference, int threads)
{
  if (!reference)
  {
    throw Error("The target is a reference mesh but there is none: set the input "
                "Reference to a mesh with the same cells.");
  }
  MeshAdapter other(reference, threads);
  orientAlike(mesh, other);
  std::vector<signed char> validity(other.mesh().view().numberOfCells);
  other.mesh().classifyCells(validity.data(), threads);
  other.mesh().setMirrored(
    other.mesh().orientation(validity.data()).state == Orientation::Reversed);
  return referenceTargets(mesh, other.mesh());
}
}

//------------------------------------------------------------------------------
std::vector<double> targetValues(const MeshView& view, const TargetChoice& choice)
{
  if (choice.type == TargetType::Tensor)
  {
    const auto tensors =
      perCell(choice.tensor.array, choice.tensor.association, view, "a metric tensor");
    return asMatrices(tensors, choice.tensor.array->GetNumberOfComponents());
  }
  std::vector<double> sizes = perCell(choice.size.array, choice.size.association, view, "a size");
  if (choice.size.array->GetNumberOfComponents() != 1)
  {
    throw Error("A size array has one component: the target area or volume.");
  }
  return sizes;
}

//------------------------------------------------------------------------------
Targets targetsOf(const Mesh& mesh, TargetType type, const std::vector<double>& values)
{
  return type == TargetType::Size ? sizeTargets(mesh, values.data())
                                  : tensorTargets(mesh, values.data());
}

//------------------------------------------------------------------------------
Targets makeTargets(const Mesh& mesh, const TargetChoice& choice, int threads)
{
  switch (choice.type)
  {
    case TargetType::Reference:
      return fromReference(mesh, choice.reference, threads);
    case TargetType::Size:
    case TargetType::Tensor:
      return targetsOf(mesh, choice.type, targetValues(mesh.view(), choice));
    default:
      return {};
  }
}
}
