// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshPerturbation.h"

#include "BlockSeams.h"
#include "Blocks.h"
#include "CurvedPerturbation.h"
#include "GatheredExecution.h"
#include "MeshAdapter.h"
#include "MovableMesh.h"
#include "PointMerge.h"
#include "tautline/Mesh/CoordinateOrder.h"
#include "tautline/Perturbation/Perturb.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkMeshPerturbation);

namespace
{
constexpr int FixedArray = 0;

/// Marks the points of ghost cells and the points where the chosen array, if any, is not 0.
std::vector<unsigned char> fixedPoints(
  vtkDataArray* chosen, const tautline::MeshAdapter& adapter, vtkIdType count)
{
  std::vector<unsigned char> fixed(count, 0);
  for (vtkIdType i = 0; chosen && i < count; ++i)
  {
    fixed[i] = chosen->GetComponent(i, 0) != 0;
  }
  const tautline::MeshView& view = adapter.mesh().view();
  for (tautline::Index cell = 0; adapter.ghostCells() && cell < view.numberOfCells; ++cell)
  {
    for (auto n = view.offsets[cell]; adapter.ghostCells()[cell] && n < view.offsets[cell + 1]; ++n)
    {
      fixed[view.connectivity[n]] = 1;
    }
  }
  return fixed;
}

/// The global ids of the points (the smallest for merged points); empty without ids.
std::vector<tautline::Index> pointIds(
  vtkDataSet* input, const std::vector<tautline::Index>& representative)
{
  std::vector<tautline::Index> ids;
  vtkDataArray* given = input->GetPointData()->GetGlobalIds();
  for (vtkIdType i = 0; given && i < input->GetNumberOfPoints(); ++i)
  {
    ids.push_back(static_cast<tautline::Index>(given->GetComponent(i, 0)));
  }
  for (std::size_t i = 0; i < ids.size() && i < representative.size(); ++i)
  {
    tautline::Index& id = ids[representative[i]];
    id = std::min(id, ids[i]);
  }
  return ids;
}

std::string describeCurved(const tautline::CurvedMesh& curved, tautline::Index retreated)
{
  const std::size_t nodes = curved.nodes().points().size();
  std::string text = std::to_string(nodes) +
    " nodes of curved cells followed their corners; a cell counts as inverted if it is inverted at "
    "any point.";
  if (retreated > 0)
  {
    text += " " + std::to_string(retreated) +
      " corners moved less than drawn so that valid curved cells stayed valid.";
  }
  return text;
}
}

//------------------------------------------------------------------------------
vtkMeshPerturbation::vtkMeshPerturbation() = default;

//------------------------------------------------------------------------------
vtkMeshPerturbation::~vtkMeshPerturbation() = default;

//------------------------------------------------------------------------------
vtkDataSet* vtkMeshPerturbation::GetOutput()
{
  return vtkDataSet::SafeDownCast(this->GetOutputDataObject(0));
}

//------------------------------------------------------------------------------
int vtkMeshPerturbation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  this->ClearResult();
  return this->Attempt(outputVector, "perturb the mesh in parts",
    [&]
    {
      const std::string seams = this->MergeCoincidentPoints
        ? tautline::describeBlockSeams(input, this->Threads)
        : std::string();
      tautline::Perturbation total;
      std::string notices;
      tautline::forEachBlock(input, nullptr, nullptr, vtkDataObject::GetData(outputVector),
        [&](const tautline::InputBlock& block) { this->Perturb(block, total, notices); });
      this->Report(total);
      this->AddToSummary(notices);
      this->AddToSummary(seams);
      if (!seams.empty())
      {
        vtkWarningMacro(<< seams);
      }
    });
}

//------------------------------------------------------------------------------
void vtkMeshPerturbation::Perturb(
  const tautline::InputBlock& block, tautline::Perturbation& total, std::string& notices)
{
  auto* points = vtkPointSet::SafeDownCast(block.input);
  auto* moved = vtkPointSet::SafeDownCast(block.output);
  if (!points || !moved)
  {
    throw tautline::Error(std::string("The points of ") + block.input->GetClassName() +
      " are implicit and cannot move: run Image Data to Point Set or Rectilinear Data to Point Set "
      "first, which give them coordinates.");
  }
  moved->ShallowCopy(points);
  if (points->GetNumberOfPoints() == 0 || points->GetNumberOfCells() == 0)
  {
    return;
  }
  // The corners of curved cells move as in linear cells, and the nodes between them follow.
  std::unique_ptr<tautline::CurvedMesh> curved;
  if (tautline::hasCurvedCells(points))
  {
    curved = std::make_unique<tautline::CurvedMesh>(points, this->Threads);
    points = curved->corners();
  }
  tautline::MeshAdapter adapter(points, this->Threads);
  tautline::JoinedCopies copies;
  if (this->MergeCoincidentPoints)
  {
    copies = adapter.joinCopies(points->GetPointData()->GetGlobalIds());
    adapter.mergeCoincidentPoints(this->Threads, true);
  }
  adapter.enterFrame(false);
  tautline::Mesh& mesh = adapter.mesh();
  if (mesh.dimension() == tautline::Dimension::None)
  {
    throw tautline::Error("There is no element to perturb. " + adapter.notice());
  }
  const std::string oriented = adapter.orient();
  notices += (notices.empty() || oriented.empty() ? "" : " ") + oriented;
  const std::vector<tautline::Index>& one = adapter.coincident().representative;
  std::vector<unsigned char> fixed = fixedPoints(
    tautline::chosenArray(this, FixedArray, points, "of fixed points", tautline::ArrayOf::Points),
    adapter, points->GetNumberOfPoints());
  tautline::unite(fixed, one);
  const int type = points->GetPoints()->GetDataType();
  const int blocks = tautline::countBlocks(this->GetInputDataObject(0, 0));

  std::vector<tautline::Index> ids = pointIds(points, one);
  if (ids.empty())
  {
    ids = tautline::coordinateOrder(mesh, adapter.inputView().points, one);
  }
  tautline::PerturbOptions options;
  options.percentage = this->Percentage;
  options.fraction = this->Fraction;
  options.tangledFraction = this->TangledFraction;
  options.seed = static_cast<std::uint64_t>(this->Seed);
  options.singlePrecision = type == VTK_FLOAT;
  options.threads = this->Threads;
  options.ids = ids.data();
  options.progress = [this, &block, blocks](double fraction)
  { return this->Proceed((block.number + fraction) / blocks); };
  tautline::Perturbation result = tautline::perturb(mesh, fixed.data(), options);
  tautline::spread(result.points, 3, one);
  result.points = adapter.leaveFrame(result.points);
  if (curved)
  {
    curved->join(one);
    tautline::CurvedPerturbation follow(*curved, adapter, fixed, type == VTK_FLOAT, this->Threads);
    const tautline::Index retreated = follow.finish(result, this->TangledFraction == 0);
    notices += (notices.empty() ? "" : " ") + describeCurved(*curved, retreated);
  }
  result.largestDisplacement *= curved ? 1.0 : adapter.frame().unit();
  moved->SetPoints(
    tautline::makePoints(result.points, type == VTK_FLOAT ? points->GetPoints() : nullptr));
  tautline::addDisplacement(moved, adapter.inputView().points, result.points);
  this->Warn(adapter.coarseness());

  total.movable += result.movable;
  total.moved += result.moved;
  total.elements += result.elements;
  total.invertedBefore += result.invertedBefore;
  total.invertedAfter += result.invertedAfter;
  total.largestDisplacement = std::max(total.largestDisplacement, result.largestDisplacement);
  total.stopped = total.stopped || result.stopped;
  const tautline::Index odd = mesh.nonFinitePoints();
  const std::string notFinite = odd == 0
    ? std::string()
    : std::to_string(odd) + (odd == 1 ? " point has" : " points have") +
      " a NaN or infinite coordinate: the cells that use them are not measured.";
  for (const std::string& notice :
    { notFinite, tautline::describeMerged(adapter.coincident(), adapter.given()),
      tautline::describeJoined(copies), tautline::describeCopies(adapter.coincident().copies),
      tautline::describeDuplicates(tautline::findSkin(mesh).duplicates) })
  {
    notices += (notices.empty() || notice.empty() ? "" : "\n") +
      (notice.empty() || block.name.empty() ? "" : "In " + block.name + ": ") + notice;
  }
}

//------------------------------------------------------------------------------
void vtkMeshPerturbation::ClearResult()
{
  this->Report({});
  this->Superclass::ClearResult();
}

//------------------------------------------------------------------------------
void vtkMeshPerturbation::Report(const tautline::Perturbation& result)
{
  this->NumberOfMovablePoints = result.movable;
  this->NumberOfMovedPoints = result.moved;
  this->InvertedBefore = result.invertedBefore;
  this->InvertedAfter = result.invertedAfter;
  this->TangledFractionReached = result.elements > 0
    ? static_cast<double>(result.invertedAfter) / static_cast<double>(result.elements)
    : 0.0;
  this->LargestDisplacement = result.largestDisplacement;
  std::ostringstream text;
  text << result.moved << " of " << result.movable << " movable points moved.\n"
       << "Largest displacement: " << result.largestDisplacement << ".\n"
       << "Inverted elements: " << result.invertedBefore << " before, " << result.invertedAfter
       << " after, of " << result.elements << "." << (result.stopped ? "\nStopped early." : "");
  this->Summary = text.str();
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshPerturbation::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  rules.joinsPartitions = this->MergeCoincidentPoints || this->PartitionsHaveIds();
  return rules;
}

//------------------------------------------------------------------------------
void vtkMeshPerturbation::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->NumberOfMovablePoints, this->NumberOfMovedPoints, this->InvertedBefore,
    this->InvertedAfter, this->TangledFractionReached, this->LargestDisplacement);
}

//------------------------------------------------------------------------------
void vtkMeshPerturbation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Percentage: " << this->Percentage << "\n";
  os << indent << "Fraction: " << this->Fraction << "\n";
  os << indent << "TangledFraction: " << this->TangledFraction << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
}
