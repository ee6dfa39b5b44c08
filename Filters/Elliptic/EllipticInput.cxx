// SPDX-License-Identifier: BSD-3-Clause
#include "EllipticInput.h"

#include "Blocks.h"
#include "PointMerge.h"
#include "ProcessGroup.h"

#include "tautline/Elliptic/TimeStepping.h"
#include "tautline/Mesh/CellOrder.h"
#include "tautline/Mesh/PointCopies.h"
#include "tautline/Mesh/RankPieces.h"

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

/// A chosen cell array, or null; throws Error if it is a point array or has the wrong number of
/// components.
vtkDataArray* cellArray(vtkAlgorithm* algorithm, int index, vtkDataSet* data,
  const std::string& purpose, const std::vector<int>& components)
{
  vtkDataArray* array = chosenArray(algorithm, index, data, purpose.c_str(), ArrayOf::Cells);
  if (!array)
  {
    return nullptr;
  }
  const std::string subject = "The array '" + std::string(array->GetName()) + "' chosen " + purpose;
  const int has = array->GetNumberOfComponents();
  if (std::find(components.begin(), components.end(), has) == components.end())
  {
    throw Error(subject + " has " + std::to_string(has) + " components; " +
      std::to_string(components.front()) +
      (components.size() > 1 ? " or " + std::to_string(components.back()) : "") + " are expected.");
  }
  return array;
}

/// Throws Error if a part of the mesh has no consistent order, see MeshAdapter::orient().
void requireOrder(RankOrder& order, Dimension dimension)
{
  if (order.order.ambiguous > 0)
  {
    order.order.reversed = 0; // nothing is done about it
    throw Error(describe(order, dimension) +
      " Cut the mesh so that each part has one (Clip), or remove cells.");
  }
}

/// Lists the nodes between the corners of a quadratic triangle or tetrahedron in the order of its
/// corners after reverseCell(). Other curved cells are rejected later.
void reverseMiddles(CellType type, Index* nodes, Index size)
{
  constexpr Index triangle = 6, withCenter = 7, tetrahedron = 10;
  if (type == CellType::Triangle && (size == triangle || size == withCenter))
  {
    std::swap(nodes[3], nodes[5]);
  }
  if (type == CellType::Tetrahedron && size == tetrahedron)
  {
    std::swap(nodes[4], nodes[6]);
    std::swap(nodes[8], nodes[9]);
  }
}

/// The values, or null if there are none; not null merely because this process has no points.
const double* orNull(std::vector<double>& values, bool given)
{
  values.reserve(1);
  return given ? values.data() : nullptr;
}
}

//------------------------------------------------------------------------------
EllipticInput::EllipticInput(LocalMesh& mesh, const EllipticChoice& choice, vtkAlgorithm* algorithm,
  RankGroup& processes, int threads)
  : Local(mesh)
{
  this->Adapter = std::make_unique<MeshAdapter>(mesh.input, threads);
  this->Skip = cellsBesideElements(*this->Adapter);
  requireDistinctCells(this->Adapter->mesh(), this->Skip.empty() ? nullptr : this->Skip.data());
  MeshRemarks remarks = this->Adapter->remarks();
  remarks.higherOrderCells = 0; // these are rejected, or all their nodes count
  const std::string more = describe(remarks);
  this->Notice = mesh.notice + (mesh.notice.empty() || more.empty() ? "" : " ") + more;
  this->Problem.pde = choice.pde;
  if (mesh.input->GetNumberOfPoints() > 0)
  {
    this->readArrays(choice, algorithm);
  }
  this->settleOrientation(processes, threads);
  this->settleDimension(choice, processes);
  this->Part.communicator = processes.communicator();
  this->Part.globalIds = processes.size() > 1 ? mesh.globalIds.data() : nullptr;
  this->Part.skip = this->Skip.empty() ? nullptr : this->Skip.data();
  this->markFixed(choice, algorithm, processes);

  EllipticProblem& problem = this->Problem;
  problem.diffusion.tensor = { choice.diffusion[0], choice.diffusion[1], choice.diffusion[2], 0, 0,
    0 };
  problem.diffusion.reaction = choice.reaction;
  problem.diffusion.tensors = this->Values.tensors.empty() ? nullptr : this->Values.tensors.data();
  problem.elastic.youngsModulus = choice.youngsModulus;
  problem.elastic.poissonRatio = choice.poissonRatio;
  problem.elastic.plane = choice.plane;
  problem.elastic.stiffening =
    this->Values.stiffening.empty() ? nullptr : this->Values.stiffening.data();
  problem.source = choice.source.constant;
  problem.sources = orNull(this->Values.sources, choice.source.kind != PointFunction::Constant);
  problem.fixedValues = orNull(this->Values.given, !choice.given.isZero());
  if (choice.redistribution != Redistribution::None && processes.size() > 1)
  {
    this->divide(choice.redistribution, threads);
  }
  this->assemble(processes, threads);
}

//------------------------------------------------------------------------------
void EllipticInput::assemble(RankGroup& processes, int threads)
{
  processes.agree(); // before PETSc communicates
  if (!this->Division)
  {
    this->System =
      std::make_unique<EllipticSystem>(this->piece(), this->Problem, this->Part, threads);
    return;
  }
  try
  {
    this->System = std::make_unique<EllipticSystem>(
      *this->DividedMesh, this->DividedProblem, this->DividedPart, threads);
  }
  catch (const Error&) // on all processes
  {
    // The message uses the numbers of cells and points in the pieces.
    requireSolvable(this->piece(), this->Problem, this->Part, threads);
    processes.agree();
    throw;
  }
  this->Values = Arrays(); // the data of the pieces in Problem are no longer read
}

//------------------------------------------------------------------------------
/// Divides the mesh and the data of the problem among the processes.
void EllipticInput::divide(Redistribution how, int threads)
{
  RankGroup& group = *this->Group;
  MeshView view = this->piece().view();
  const Index* ids = this->Local.globalIds.data();

  std::string why;
  std::vector<int> owners;
  if (how == Redistribution::PtScotch)
  {
    try
    {
      group.together(
        [&]
        {
          const JoinedCopies joined = joinCopies(group, view, ids);
          view.points = joined.points.empty() ? view.points : joined.points.data();
          owners = ownersByGraph(group, { view, ids, this->skipped() }, how, why);
        });
    }
    catch (const Error& error) // on all processes: copies of cells or ids, which a solver accepts
    {
      how = Redistribution::KdTree;
      why = std::string(" ") + error.what();
      owners.clear();
    }
    view.points = this->piece().view().points;
  }
  if (group.any(static_cast<Index>(owners.size()) != view.numberOfPoints))
  {
    owners = ownersByTree(group, view, this->skipped());
  }

  this->Skip.resize(static_cast<std::size_t>(view.numberOfCells), 0);
  this->Part.skip = this->Skip.data();
  this->Division = std::make_unique<CellDivision>(group, view, ids, owners);

  const CellDivision& division = *this->Division;
  const int components = this->Problem.pde == Pde::Elasticity ? 3 : 1;
  // A process without points has no values, but may get some.
  this->DividedProblem = this->Problem;
  EllipticProblem& problem = this->DividedProblem;
  const Arrays& from = this->Values;
  Arrays& to = this->DividedValues;
  const auto given = [&](const void* values) { return group.any(values != nullptr); };
  if (given(problem.fixed))
  {
    to.fixed = division.pointsToParts(from.fixed, 1);
    to.fixed.reserve(1); // so that it is not null where there are no points
    problem.fixed = to.fixed.data();
  }
  if (given(problem.sources))
  {
    to.sources = division.pointsToParts(from.sources, components);
    problem.sources = orNull(to.sources, true);
  }
  if (given(problem.fixedValues))
  {
    to.given = division.pointsToParts(from.given, components);
    problem.fixedValues = orNull(to.given, true);
  }
  if (given(problem.diffusion.tensors))
  {
    to.tensors = division.cellsToParts(from.tensors, TensorSize);
    problem.diffusion.tensors = orNull(to.tensors, true);
  }
  if (given(problem.elastic.stiffening))
  {
    to.stiffening = division.cellsToParts(from.stiffening, 1);
    problem.elastic.stiffening = orNull(to.stiffening, true);
  }
  this->DividedSkip = division.cellsToParts(this->Skip, 1);
  this->DividedPart = this->Part;
  this->DividedPart.globalIds = division.ids().data();
  this->DividedPart.skip = this->DividedSkip.data();
  this->DividedMesh = std::make_unique<Mesh>(division.view(), threads);
  this->DividedMesh->setSpace(this->piece().space());
  this->DividedMesh->setMirrored(this->piece().mirrored());
  this->Notice += (this->Notice.empty() ? "" : " ") + dividedSentence(group, how, why);
}

//------------------------------------------------------------------------------
EllipticSolution EllipticInput::fields(const std::vector<double>& unknowns) const
{
  EllipticSolution solution;
  if (!this->Division)
  {
    return this->System->fields(unknowns);
  }
  solution = this->System->fields(unknowns);
  const int derivatives = solution.components == 1 ? 3 : TensorSize;
  solution.values = this->Division->pointsToPieces(solution.values, solution.components);
  solution.gradients = this->Division->cellsToPieces(solution.gradients, derivatives);
  return solution;
}

//------------------------------------------------------------------------------
std::vector<double> EllipticInput::unknownsOf(const std::vector<double>& ofPiece) const
{
  const int components = this->Problem.pde == Pde::Elasticity ? 3 : 1;
  return tautline::unknownsOf(
    *this->System, this->Division ? this->Division->pointsToParts(ofPiece, components) : ofPiece);
}

//------------------------------------------------------------------------------
std::vector<double> EllipticInput::cellsOfPiece(const std::vector<double>& ofSystem) const
{
  return this->Division ? this->Division->cellsToPieces(ofSystem, 1) : ofSystem;
}

//------------------------------------------------------------------------------
void EllipticInput::readArrays(const EllipticChoice& choice, vtkAlgorithm* algorithm)
{
  vtkDataSet* data = this->Local.input;
  const int components = choice.pde == Pde::Elasticity ? 3 : 1;
  if (choice.source.kind != PointFunction::Constant)
  {
    this->Values.sources = valuesAt(choice.source, algorithm, data, components);
  }
  if (!choice.given.isZero())
  {
    this->Values.given = valuesAt(choice.given, algorithm, data, components);
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
        this->Values.tensors.push_back(tensors->GetComponent(cell, full ? OfFullTensor[k] : k));
      }
    }
  }
  if (choice.pde == Pde::Elasticity)
  {
    vtkDataArray* factors = cellArray(
      algorithm, choice.stiffnessArray, data, "to take the factors of the stiffness from", { 1 });
    for (vtkIdType cell = 0; factors && cell < data->GetNumberOfCells(); ++cell)
    {
      this->Values.stiffening.push_back(factors->GetComponent(cell, 0));
    }
  }
}

//------------------------------------------------------------------------------
void EllipticInput::settleOrientation(RankGroup& processes, int threads)
{
  std::string text;
  std::vector<signed char> validity;
  const Mesh& mesh = this->piece();
  text = processes.size() > 1 ? "" : this->Adapter->orient();
  if (processes.size() > 1)
  {
    // Sets the plane and the order of its cells, as part of the whole mesh.
    this->Group = makeProcessGroup();
    RankPiece part = { &this->piece(), this->skipped(), this->Local.globalIds.data() };
    const MeshSpace whole = spaceOf(*this->Group, { part });
    this->Adapter->mesh().setSpace(whole);
    validity.resize(static_cast<std::size_t>(this->piece().view().numberOfCells));
    this->piece().classifyCells(validity.data(), threads);
    part.ghosts = this->Adapter->ghostCells();
    RankOrder order = consistentOrder(*this->Group, { part }, { validity.data() });
    requireOrder(order, whole.dimension);
    text = this->Adapter->orient(validity.data(), order);
  }
  if (mesh.higherOrderCells() > 0 && !this->Adapter->reversedCells().empty())
  {
    this->reverseQuadratic(threads);
  }
  this->Notice = text + (text.empty() || this->Notice.empty() ? "" : " ") + this->Notice;
}

//------------------------------------------------------------------------------
/// MeshAdapter lists only the corners of cells in the opposite order.
void EllipticInput::reverseQuadratic(int threads)
{
  Mesh& mesh = this->Adapter->mesh();
  MeshView view = mesh.view();
  this->Turned.assign(view.connectivity, view.connectivity + view.offsets[view.numberOfCells]);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const bool counts = !(this->skipped() && this->skipped()[cell]);
    if (this->Adapter->reversedCells()[cell] && isHigherOrder(view.cellTypes[cell]) && counts)
    {
      const Index first = view.offsets[cell];
      reverseMiddles(
        cornerType(view.cellTypes[cell]), &this->Turned[first], view.offsets[cell + 1] - first);
    }
  }
  view.connectivity = this->Turned.data();
  const MeshSpace space = mesh.space();
  const bool mirrored = mesh.mirrored();
  mesh = Mesh(view, threads); // in place: others refer to it
  mesh.setSpace(space);
  mesh.setMirrored(mirrored);
}

//------------------------------------------------------------------------------
void EllipticInput::settleDimension(const EllipticChoice& choice, RankGroup& processes)
{
  const Mesh& mesh = this->piece();
  const auto highest =
    static_cast<Dimension>(processes.maximum(static_cast<Index>(mesh.dimension())));
  const bool solid = std::any_of(mesh.blocks().begin(), mesh.blocks().end(),
    [](const CellBlock& block) { return topology(block.type).dimension == 3; });
  if (highest == Dimension::Volume && !solid)
  {
    // This process has only faces of volumes on other processes.
    this->Skip.assign(static_cast<std::size_t>(mesh.view().numberOfCells), 1);
  }
  if (highest == Dimension::Surface && choice.pde == Pde::Elasticity)
  {
    throw Error(
      "The mesh is a surface in space; linear elasticity requires a planar mesh or a volume.");
  }
}

//------------------------------------------------------------------------------
void EllipticInput::markFixed(
  const EllipticChoice& choice, vtkAlgorithm* algorithm, RankGroup& processes)
{
  const MeshView& view = this->Adapter->mesh().view();
  vtkDataSet* data = this->Local.input;
  const auto points = static_cast<std::size_t>(view.numberOfPoints);
  std::vector<unsigned char> chosen(points, 0), where(points, 1);
  bool any = choice.fixedPart == EllipticChoice::OnlyChosen;
  if (points > 0)
  {
    vtkDataArray* array = chosenArray(algorithm, choice.fixedArray, data, "of fixed points");
    const bool ofCells = array && data->GetCellData()->GetArray(array->GetName()) == array;
    markPoints(view, array, ofCells, chosen);
    markPoints(view, this->Local.selected, chosen);
    any = any || array || this->Local.selected;
    if (choice.fixedPart == EllipticChoice::PartOfBoundary)
    {
      const auto values = evaluate(choice.fixedWhere, "fixed part of the boundary", data, 1);
      std::transform(
        values.begin(), values.end(), where.begin(), [](double value) { return value != 0; });
      any = true;
    }
  }
  if (processes.everywhere(!any))
  {
    return; // the whole boundary, which the system itself finds
  }
  this->Values.fixed = std::move(chosen);
  if (choice.fixedPart != EllipticChoice::OnlyChosen)
  {
    const auto boundary = globalBoundaryPoints(
      this->Adapter->mesh(), this->Part.communicator, this->Part.globalIds, this->Part.skip);
    for (std::size_t i = 0; i < points; ++i)
    {
      this->Values.fixed[i] |= boundary[i] && where[i];
    }
  }
  // Selections and arrays of cells may mark a point on one process only.
  PointNumbering(this->Part.communicator, view.numberOfPoints, this->Part.globalIds)
    .either(this->Values.fixed.data());
  this->Values.fixed.reserve(1); // so that it is not null where there are no points
  this->Problem.fixed = this->Values.fixed.data();
}
}
