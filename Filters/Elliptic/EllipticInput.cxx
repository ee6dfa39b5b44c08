// SPDX-License-Identifier: BSD-3-Clause
#include "EllipticInput.h"

#include "Blocks.h"
#include "PointMerge.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPointData.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr int TensorSize = 6;
constexpr int FullTensorSize = 9;
/// Components of a full tensor, row by row, in the order of SymmetricTensor.
constexpr std::array<int, TensorSize> OfFullTensor = { 0, 4, 8, 1, 5, 2 };

/// A chosen cell array, or null; Error if it is on points or has other numbers of components.
vtkDataArray* cellArray(vtkAlgorithm* algorithm, int index, vtkDataSet* data,
  const std::string& purpose, const std::vector<int>& components)
{
  vtkDataArray* array = chosenArray(algorithm, index, data, purpose.c_str());
  if (!array)
  {
    return nullptr;
  }
  const std::string subject = "The array '" + std::string(array->GetName()) + "' chosen " + purpose;
  if (data->GetCellData()->GetArray(array->GetName()) != array)
  {
    throw Error(subject + " is on points; one on cells is needed: run Point Data to Cell Data.");
  }
  const int has = array->GetNumberOfComponents();
  if (std::find(components.begin(), components.end(), has) == components.end())
  {
    throw Error(subject + " has " + std::to_string(has) + " components; " +
      std::to_string(components.front()) +
      (components.size() > 1 ? " or " + std::to_string(components.back()) : "") + " are expected.");
  }
  return array;
}

/// The values, or null if there are none; not null only because this process has no points.
const double* orNull(std::vector<double>& values, bool given)
{
  values.reserve(1);
  return given ? values.data() : nullptr;
}

/// Flags points where a point array is not 0, or those of cells where a cell array is not.
void flag(
  vtkDataArray* array, bool ofCells, const MeshView& view, std::vector<unsigned char>& flags)
{
  for (Index cell = 0; array && ofCells && cell < view.numberOfCells; ++cell)
  {
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      flags[view.connectivity[n]] |= array->GetComponent(cell, 0) != 0;
    }
  }
  for (Index i = 0; array && !ofCells && i < view.numberOfPoints; ++i)
  {
    flags[i] |= array->GetComponent(i, 0) != 0;
  }
}
}

//------------------------------------------------------------------------------
EllipticInput::EllipticInput(LocalMesh& mesh, const EllipticChoice& choice, vtkAlgorithm* algorithm,
  const Processes& processes, int threads)
  : Local(mesh)
{
  processes.together(
    [&]()
    {
      this->Adapter = std::make_unique<MeshAdapter>(mesh.input, threads);
      this->Skip = cellsToSkip(*this->Adapter);
      requireDistinctCells(this->Adapter->mesh(), this->Skip.empty() ? nullptr : this->Skip.data());
      const std::string more = this->Adapter->notice();
      this->Notice = mesh.notice + (mesh.notice.empty() || more.empty() ? "" : " ") + more;
      this->Problem.pde = choice.pde;
      if (mesh.input->GetNumberOfPoints() > 0)
      {
        this->readArrays(choice, algorithm);
      }
    });
  this->settleOrientation(processes);
  this->settleDimension(choice, processes);
  this->Part.communicator = processes.communicator();
  this->Part.globalIds = processes.count() > 1 ? mesh.globalIds.data() : nullptr;
  this->Part.skip = this->Skip.empty() ? nullptr : this->Skip.data();
  this->markFixed(choice, algorithm, processes);

  EllipticProblem& problem = this->Problem;
  problem.diffusion.tensor = { choice.diffusion[0], choice.diffusion[1], choice.diffusion[2], 0, 0,
    0 };
  problem.diffusion.reaction = choice.reaction;
  problem.diffusion.tensors = this->Tensors.empty() ? nullptr : this->Tensors.data();
  problem.elastic.youngsModulus = choice.youngsModulus;
  problem.elastic.poissonRatio = choice.poissonRatio;
  problem.elastic.plane = choice.plane;
  problem.elastic.stiffening = this->Stiffening.empty() ? nullptr : this->Stiffening.data();
  problem.source = choice.source.constant;
  problem.sources = orNull(this->Sources, choice.source.kind != PointFunction::Constant);
  problem.fixedValues = orNull(this->Given, !choice.given.isZero());
  processes.together(
    [&]()
    {
      this->System =
        std::make_unique<EllipticSystem>(this->Adapter->mesh(), problem, this->Part, threads);
    });
}

//------------------------------------------------------------------------------
void EllipticInput::readArrays(const EllipticChoice& choice, vtkAlgorithm* algorithm)
{
  vtkDataSet* data = this->Local.input;
  const int components = choice.pde == Pde::Elasticity ? 3 : 1;
  if (choice.source.kind != PointFunction::Constant)
  {
    this->Sources = valuesAt(choice.source, algorithm, data, components);
  }
  if (!choice.given.isZero())
  {
    this->Given = valuesAt(choice.given, algorithm, data, components);
  }
  if (choice.pde == Pde::Elliptic)
  {
    vtkDataArray* tensors = cellArray(algorithm, choice.tensorArray, data,
      "to take the tensors from", { TensorSize, FullTensorSize });
    for (vtkIdType cell = 0; tensors && cell < data->GetNumberOfCells(); ++cell)
    {
      for (int k = 0; k < TensorSize; ++k)
      {
        const bool full = tensors->GetNumberOfComponents() == FullTensorSize;
        this->Tensors.push_back(tensors->GetComponent(cell, full ? OfFullTensor[k] : k));
      }
    }
  }
  if (choice.pde == Pde::Elasticity)
  {
    vtkDataArray* factors = cellArray(
      algorithm, choice.stiffnessArray, data, "to take the factors of the stiffness from", { 1 });
    for (vtkIdType cell = 0; factors && cell < data->GetNumberOfCells(); ++cell)
    {
      this->Stiffening.push_back(factors->GetComponent(cell, 0));
    }
  }
}

//------------------------------------------------------------------------------
void EllipticInput::settleOrientation(const Processes& processes)
{
  // Each part is given a positive size, so that processes need not agree on more.
  std::string text;
  processes.together(
    [&]()
    {
      const Mesh& mesh = this->Adapter->mesh();
      if (mesh.higherOrderCells() > 0)
      {
        throw Error("The mesh has " + std::to_string(mesh.higherOrderCells()) +
          " cells of quadratic or higher order: run Tessellate first.");
      }
      text = this->Adapter->orient();
    });
  this->Notice = text + (text.empty() || this->Notice.empty() ? "" : " ") + this->Notice;
}

//------------------------------------------------------------------------------
void EllipticInput::settleDimension(const EllipticChoice& choice, const Processes& processes)
{
  const Mesh& mesh = this->Adapter->mesh();
  const auto mine = static_cast<Index>(mesh.dimension());
  const Index highest = processes.maximum(mine);
  if (highest == static_cast<Index>(Dimension::Volume) && mine != highest)
  {
    // Here there are only faces of volumes on other processes.
    this->Skip.assign(static_cast<std::size_t>(mesh.view().numberOfCells), 1);
  }
  if (highest == static_cast<Index>(Dimension::Surface) && choice.pde == Pde::Elasticity)
  {
    throw Error(
      "The mesh is a surface in space; linear elasticity is for planar meshes and volumes.");
  }
}

//------------------------------------------------------------------------------
void EllipticInput::markFixed(
  const EllipticChoice& choice, vtkAlgorithm* algorithm, const Processes& processes)
{
  const MeshView& view = this->Adapter->mesh().view();
  vtkDataSet* data = this->Local.input;
  const auto points = static_cast<std::size_t>(view.numberOfPoints);
  std::vector<unsigned char> chosen(points, 0), where(points, 1);
  bool any = choice.fixedPart == EllipticChoice::OnlyChosen;
  processes.together(
    [&]()
    {
      if (points == 0)
      {
        return;
      }
      vtkDataArray* array = chosenArray(algorithm, choice.fixedArray, data, "of fixed points");
      flag(array, array && data->GetCellData()->GetArray(array->GetName()) == array, view, chosen);
      if (this->Local.selected)
      {
        flag(this->Local.selected->GetCellData()->GetArray(SelectedArray), true, view, chosen);
        flag(this->Local.selected->GetPointData()->GetArray(SelectedArray), false, view, chosen);
      }
      any = any || array || this->Local.selected;
      if (choice.fixedPart == EllipticChoice::PartOfBoundary)
      {
        const auto values = evaluate(choice.fixedWhere, "fixed part of the boundary", data, 1);
        std::transform(
          values.begin(), values.end(), where.begin(), [](double value) { return value != 0; });
        any = true;
      }
    });
  if (processes.everywhere(!any))
  {
    return; // the whole boundary, which the system finds by itself
  }
  this->Fixed = std::move(chosen);
  if (choice.fixedPart != EllipticChoice::OnlyChosen)
  {
    const auto boundary = globalBoundaryPoints(
      this->Adapter->mesh(), this->Part.communicator, this->Part.globalIds, this->Part.skip);
    for (std::size_t i = 0; i < points; ++i)
    {
      this->Fixed[i] |= boundary[i] && where[i];
    }
  }
  // Selections and arrays of cells may mark a point on one process only.
  PointNumbering(this->Part.communicator, view.numberOfPoints, this->Part.globalIds)
    .either(this->Fixed.data());
  this->Fixed.reserve(1); // so that it is not null where there are no points
  this->Problem.fixed = this->Fixed.data();
}
}
