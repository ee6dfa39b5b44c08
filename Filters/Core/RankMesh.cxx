// SPDX-License-Identifier: BSD-3-Clause
#include "RankMesh.h"

#include "Blocks.h"
#include "MovableMesh.h"
#include "PointMerge.h"
#include "ProcessGroup.h"
#include "Processes.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/CoordinateOrder.h"
#include "tautline/Mesh/RankPieces.h"
#include "tautline/Mesh/Ranks.h"

#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkMultiProcessController.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace tautline
{
namespace
{
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
}

//------------------------------------------------------------------------------
std::unique_ptr<RankMesh> takePieces(std::unique_ptr<RankGroup>& group, vtkDataObject* input,
  int threads, bool mergePoints, Redistribution redistribution, std::string* why)
{
  bool scattered = true;
  const auto gather = [&](const std::string& reason)
  {
    if (why)
    {
      *why = scattered ? reason : "";
    }
    return std::unique_ptr<RankMesh>();
  };
  auto* piece = vtkDataSet::SafeDownCast(input);
  std::unique_ptr<RankMesh> mesh;
  try
  {
    group = makeProcessGroup();
  }
  catch (const Error&) // on all processes
  {
    return gather("the processes do not communicate by MPI");
  }
  const bool elsewhere =
    group->rank() > 0 && input && input->GetNumberOfElements(vtkDataObject::CELL) > 0;
  scattered = group->any(elsewhere);
  if (group->size() == 1 || (redistribution == Redistribution::None && !scattered))
  {
    return gather("");
  }
  if (group->any(!piece))
  {
    return gather("it has blocks");
  }
  try
  {
    mesh = RankMesh::make(*group, piece, threads, mergePoints, redistribution);
  }
  catch (const Error& error) // the same on all processes; one process may refuse it, too
  {
    return gather(std::string("its pieces could not be joined. ") + error.what());
  }
  if (!mesh)
  {
    return gather(oppositeOrders);
  }
  if (mesh->mesh().globalCells() == 0)
  {
    return gather("");
  }
  const bool framed = !CoordinateFrame(coordinateRange(mesh->mesh().view()), false).isIdentity();
  if (group->any(framed))
  {
    return gather("its coordinates are of extreme size");
  }
  return mesh->inSpaceOrPlane()
    ? std::move(mesh)
    : gather("it is a surface in space, or in a plane that is not at right angles to an axis");
}

//------------------------------------------------------------------------------
bool isScattered(vtkDataObject* input)
{
  vtkMultiProcessController* all = severalProcesses();
  const bool here = all && all->GetLocalProcessId() > 0 && input &&
    input->GetNumberOfElements(vtkDataObject::CELL) > 0;
  return minimumOverProcesses(here ? 0 : 1) == 0;
}

//------------------------------------------------------------------------------
std::string gatheredSentence(const std::string& why)
{
  const char* end = !why.empty() && why.back() == '.' ? "" : ".";
  return why.empty() ? "" : "The mesh was put together on the first process: " + why + end;
}

//------------------------------------------------------------------------------
vtkDataSet* requirePiece(vtkDataObject* input)
{
  auto* piece = vtkDataSet::SafeDownCast(input);
  if (!piece)
  {
    throw Error("The reproducible order is that of one mesh, and the input has blocks: run Merge "
                "Blocks first, or switch Reproducible Order off.");
  }
  return piece;
}

//------------------------------------------------------------------------------
std::unique_ptr<RankMesh> RankMesh::make(
  RankGroup& group, vtkDataSet* input, int threads, bool mergePoints, Redistribution redistribution)
{
  std::unique_ptr<RankMesh> mesh;
  group.together(
    [&]
    {
      try
      {
        mesh = std::make_unique<RankMesh>(group, input, threads, mergePoints, redistribution);
      }
      catch (const OppositeOrders&) // on all processes
      {
      }
    });
  return mesh;
}

//------------------------------------------------------------------------------
RankMesh::RankMesh(
  RankGroup& group, vtkDataSet* input, int threads, bool mergePoints, Redistribution redistribution)
  : Group(group)
  , Input(vtkPointSet::SafeDownCast(input))
  , Threads(threads)
  , MergePoints(mergePoints)
  , Divided(group.size() > 1 ? redistribution : Redistribution::None)
{
  Elements elements;
  bool copies = false;
  std::vector<Index> ids;
  if (!this->Input && input->GetNumberOfPoints() > 0)
  {
    throw Error(std::string("The points of ") + input->GetClassName() +
      " are implicit and cannot move: run Image Data to Point Set or Rectilinear Data to Point "
      "Set first, which give them coordinates.");
  }
  this->Adapter = std::make_unique<MeshAdapter>(input, threads);
  if (this->Adapter->mesh().higherOrderCells() > 0)
  {
    throw Error("The mesh has " + std::to_string(this->Adapter->mesh().higherOrderCells()) +
      " cells of quadratic or higher order, whose midpoints would stay behind: run Tessellate "
      "first.");
  }
  for (Index cell = 0; cell < this->piece().numberOfCells; ++cell)
  {
    this->Dimension = std::max(this->Dimension, dimensionOf(this->piece().cellTypes[cell]));
  }
  this->Dimension = static_cast<int>(group.maximum(static_cast<Index>(this->Dimension)));
  const MeshView& view = this->piece();
  this->Held.assign(view.numberOfPoints, 0);
  this->Marked.assign(view.numberOfPoints, 0);
  this->Skip.assign(view.numberOfCells, 0);
  // As a rule all cells are elements, and need not be copied.
  copies = this->Dimension == 0 ||
    std::any_of(view.cellTypes, view.cellTypes + view.numberOfCells,
      [this](unsigned char type) { return dimensionOf(type) != this->Dimension; });
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const bool ghost = this->Adapter->ghostCells() && this->Adapter->ghostCells()[cell];
    const auto begin = view.connectivity + view.offsets[cell],
               end = view.connectivity + view.offsets[cell + 1];
    const int dimension = dimensionOf(view.cellTypes[cell]);
    this->Skip[cell] = ghost || dimension < this->Dimension;
    if (copies && dimension == this->Dimension && dimension > 0)
    {
      elements.types.push_back(view.cellTypes[cell]);
      elements.ghosts.push_back(ghost);
      elements.connectivity.insert(elements.connectivity.end(), begin, end);
      elements.offsets.push_back(static_cast<Index>(elements.connectivity.size()));
    }
    for (auto p = begin; dimension < this->Dimension && p != end; ++p)
    {
      this->Held[*p] = 1;
    }
  }
  vtkDataArray* given = input->GetPointData()->GetGlobalIds();
  ids = idsOf(given);
  for (Index p = 0; !mergePoints && !given && p < view.numberOfPoints; ++p)
  {
    ids.push_back(p);
  }
  if (!mergePoints && !given && group.size() > 1 && view.numberOfPoints > 0)
  {
    throw Error("With Merge Coincident Points off, points of different processes are one by "
                "their global ids, and there are none: run Generate Global Ids first.");
  }
  const bool unnamed = static_cast<Index>(ids.size()) < this->piece().numberOfPoints;
  this->Copies = tautline::joinCopies(group, this->piece(), unnamed ? nullptr : ids.data());
  ids = mergePoints ? std::vector<Index>() : std::move(ids);
  MeshView joined = view;
  joined.points = this->joinedPoints();
  const unsigned char* ghosts = this->Adapter->ghostCells();
  if (copies)
  {
    joined.numberOfCells = static_cast<Index>(elements.types.size());
    joined.cellTypes = elements.types.data();
    joined.offsets = elements.offsets.data();
    joined.connectivity = elements.connectivity.data();
    ghosts = elements.ghosts.data();
  }
  this->divide({ joined, mergePoints ? nullptr : ids.data(), ghosts });
  this->checkOrder();
}

//------------------------------------------------------------------------------
const double* RankMesh::joinedPoints() const
{
  return this->Copies.points.empty() ? this->piece().points : this->Copies.points.data();
}

//------------------------------------------------------------------------------
/// Makes the mesh of the pieces.
void RankMesh::divide(const MeshPiece& given)
{
  MeshPiece piece = given;
  piece.divideAnew = this->Divided != Redistribution::None;
  std::vector<int> owners;
  if (this->Divided == Redistribution::PtScotch)
  {
    owners = ownersByGraph(this->Group, piece, this->Divided, this->WhyTree);
    std::replace(owners.begin(), owners.end(), -1, 0);
    piece.owners = owners.data();
  }
  this->TheMesh = std::make_unique<DistributedMesh>(this->Group, piece);
}

//------------------------------------------------------------------------------
/// Whether the cells list their points in one order, and which.
void RankMesh::checkOrder()
{
  const MeshView& view = this->TheMesh->view();
  std::unique_ptr<Mesh> mesh; // none where the process has no cells
  std::vector<signed char> validity;
  std::vector<unsigned char> copies;
  std::vector<RankPiece> pieces;
  std::vector<const signed char*> validities;
  if (view.numberOfCells > 0)
  {
    mesh = std::make_unique<Mesh>(view, this->Threads);
    validity.resize(view.numberOfCells);
    mesh->classifyCells(validity.data(), this->Threads);
    for (const unsigned char owned : this->TheMesh->ownedCells())
    {
      copies.push_back(!owned);
    }
    pieces.push_back({ mesh.get(), copies.data(), this->TheMesh->numbers().data() });
    validities.push_back(validity.data());
  }
  const Orientation found = orientation(this->Group, pieces, validities);
  // As on one process: a mesh with more inverted elements than others is not reversed by that.
  this->Mirrored = found.state == Orientation::Reversed;
  this->InvertedElements = this->Mirrored ? found.positiveCells : found.negativeCells;
  RankOrder order;
  order.orientation = found;
  this->Reversal = describe(order, this->volume() ? Dimension::Volume : Dimension::Planar);
  if (found.disagreeing > 0 || (found.reversedParts > 0 && found.reversedParts < found.parts))
  {
    throw OppositeOrders(
      (found.disagreeing > 0 ? "Neighbouring cells list their points in opposite orders"
                             : std::to_string(found.reversedParts) + " of " +
            std::to_string(found.parts) + " connected parts of the mesh are reversed") +
      ": gather the mesh on one process, in ParaView by Aggregate Dataset, with Reproducible Order "
      "off, or let Element Quality reorder the cells (Reorient) first.");
  }
}

//------------------------------------------------------------------------------
std::string RankMesh::notice() const
{
  const std::string division = dividedSentence(this->Group, this->Divided, this->WhyTree);
  std::string text;
  for (const std::string& sentence :
    { this->Reversal, this->Adapter->notice(), describeJoined(this->Copies), division })
  {
    text += (text.empty() || sentence.empty() ? "" : "\n") + sentence;
  }
  return text;
}

//------------------------------------------------------------------------------
void RankMesh::fix(vtkDataArray* array, bool ofCells)
{
  const MeshView& view = this->piece();
  for (Index cell = 0; array && ofCells && cell < view.numberOfCells; ++cell)
  {
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      this->Marked[view.connectivity[n]] |= array->GetComponent(cell, 0) != 0;
    }
  }
  for (Index p = 0; array && !ofCells && p < view.numberOfPoints; ++p)
  {
    this->Marked[p] |= array->GetComponent(p, 0) != 0;
  }
}

//------------------------------------------------------------------------------
void RankMesh::fixSelected(vtkDataObject* input, vtkSelection* selection)
{
  const vtkSmartPointer<vtkDataObject> marked = markSelected(input, selection);
  if (auto* selected = vtkDataSet::SafeDownCast(marked))
  {
    this->fix(selected->GetCellData()->GetArray(SelectedArray), true);
    this->fix(selected->GetPointData()->GetArray(SelectedArray), false);
  }
}

//------------------------------------------------------------------------------
std::vector<unsigned char> RankMesh::fixed(bool boundary)
{
  const DistributedMesh& mesh = *this->TheMesh;
  std::vector<unsigned char> marked = this->anyOf(this->Marked);
  const std::vector<unsigned char> held = this->anyOf(this->Held);
  const std::vector<unsigned char> on = rankBoundary(mesh);
  for (std::size_t p = 0; p < marked.size(); ++p)
  {
    marked[p] |= (held[p] && !(this->volume() && on[p])) || (boundary && on[p]);
  }
  return marked;
}

//------------------------------------------------------------------------------
std::string RankMesh::whyNoneIsFree(
  bool boundaryFixed, bool slides, const std::string& boundaryRemedy) const
{
  const DistributedMesh& mesh = *this->TheMesh;
  const std::vector<unsigned char> on = rankBoundary(mesh);
  Index onBoundary = 0;
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    onBoundary += boundaryFixed && on[p] && mesh.owned(p);
  }
  return noneIsFree(mesh.globalPoints(), this->Group.sum(onBoundary), slides, boundaryRemedy);
}

//------------------------------------------------------------------------------
std::vector<unsigned char> RankMesh::anyOf(const std::vector<unsigned char>& ofPiece) const
{
  const DistributedMesh& mesh = *this->TheMesh;
  std::vector<unsigned char> flags(mesh.localPoints(), 0);
  for (std::size_t p = 0; p < ofPiece.size(); ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    if (local >= 0)
    {
      flags[local] |= ofPiece[p];
    }
  }
  mesh.either(flags.data());
  return flags;
}

//------------------------------------------------------------------------------
std::vector<double> RankMesh::leastOf(const std::vector<double>& ofPiece, double none) const
{
  // The owner may have a point from another piece: the least by way of all processes.
  const DistributedMesh& mesh = *this->TheMesh;
  struct Value
  {
    Index number;
    double value;
  };
  std::vector<std::vector<Value>> sent(this->Group.size());
  std::vector<double> values;
  values.assign(mesh.localPoints(), none);
  for (std::size_t p = 0; p < ofPiece.size(); ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    if (local >= 0 && mesh.owned(local))
    {
      values[local] = std::min(values[local], ofPiece[p]);
    }
    else if (local >= 0)
    {
      sent[mesh.owners()[local]].push_back({ mesh.numbers()[local], ofPiece[p] });
    }
  }
  for (const auto& list : this->Group.exchangeItems(sent))
  {
    for (const Value& value : list)
    {
      double& to = values[mesh.local(value.number)];
      to = std::min(to, value.value);
    }
  }
  mesh.exchange(values.data(), 1);
  return values;
}

//------------------------------------------------------------------------------
bool RankMesh::inSpaceOrPlane() const
{
  const std::array<double, 6>& box = this->TheMesh->bounds();
  return this->Dimension == 3 ||
    (this->Dimension == 2 && (box[0] == box[3] || box[1] == box[4] || box[2] == box[5]));
}

//------------------------------------------------------------------------------
std::vector<Index> RankMesh::pointIds() const
{
  const DistributedMesh& mesh = *this->TheMesh;
  vtkDataArray* given = this->Input ? this->Input->GetPointData()->GetGlobalIds() : nullptr;
  if (this->Group.any(this->piece().numberOfPoints > 0 && !given))
  {
    return coordinateOrder(mesh);
  }
  std::vector<double> ofPiece;
  for (Index p = 0; p < this->piece().numberOfPoints; ++p)
  {
    ofPiece.push_back(given->GetComponent(p, 0));
  }
  const std::vector<double> least = this->leastOf(ofPiece, std::numeric_limits<double>::infinity());
  std::vector<Index> ids(least.begin(), least.end());
  // Each id goes to one process, which counts its points.
  const auto ranks = static_cast<std::uint64_t>(this->Group.size());
  std::vector<std::vector<Index>> sent(this->Group.size());
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    if (mesh.owned(p))
    {
      sent[static_cast<std::uint64_t>(ids[p]) % ranks].push_back(ids[p]);
    }
  }
  std::vector<Index> received;
  for (const std::vector<Index>& list : this->Group.exchangeItems(sent))
  {
    received.insert(received.end(), list.begin(), list.end());
  }
  std::sort(received.begin(), received.end());
  const auto twice = std::adjacent_find(received.begin(), received.end());
  const bool some = this->Group.any(twice != received.end());
  const Index wrong =
    this->Group.maximum(twice == received.end() ? std::numeric_limits<Index>::lowest() : *twice);
  if (some)
  {
    throw Error("Points at different places have the global id " + std::to_string(wrong) +
      ": run Generate Global Ids again.");
  }
  return ids;
}

//------------------------------------------------------------------------------
namespace
{
/// A point that ranks without an element at it ask for.
struct PointQuery
{
  std::array<double, 3> place;
  Index given; ///< the global id where these identify points, else 0
  Index id;    ///< the answer, or the place of the question

  bool operator<(const PointQuery& other) const
  {
    return this->place != other.place ? this->place < other.place : this->given < other.given;
  }
  /// The rank that answers.
  std::size_t rank(std::size_t ranks) const
  {
    std::uint64_t hash = static_cast<std::uint64_t>(this->given);
    for (const double x : this->place)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof(bits));
      constexpr std::uint64_t odd = 0x9E3779B97F4A7C15u; // 2^64 over the golden ratio
      hash = (hash ^ bits) * odd;
      hash ^= hash >> 32;
    }
    return hash % ranks;
  }
};

PointQuery queryOf(const double* x, Index given, Index id)
{
  return { { x[0] + 0.0, x[1] + 0.0, x[2] + 0.0 }, given, id }; // -0 is 0
}
}

//------------------------------------------------------------------------------
std::vector<Index> RankMesh::idsOfPiece(const std::vector<Index>& ids) const
{
  const MeshView& view = this->piece();
  const DistributedMesh& mesh = *this->TheMesh;
  std::vector<Index> ofPiece(view.numberOfPoints, -1);
  bool unknown = false;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    ofPiece[p] = local < 0 ? -1 : ids[local];
    unknown = unknown || local < 0;
  }
  if (!this->Group.any(unknown))
  {
    return ofPiece;
  }
  // Points are found by what identifies them.
  vtkDataArray* given =
    this->MergePoints || !this->Input ? nullptr : this->Input->GetPointData()->GetGlobalIds();
  const std::size_t ranks = static_cast<std::size_t>(this->Group.size());
  std::vector<std::vector<PointQuery>> known(ranks), asked(ranks);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    const PointQuery query = queryOf(this->joinedPoints() + 3 * p,
      given ? static_cast<Index>(given->GetComponent(p, 0)) : 0, local < 0 ? p : ids[local]);
    (local < 0 ? asked : known)[query.rank(ranks)].push_back(query);
  }
  std::vector<PointQuery> found;
  for (const std::vector<PointQuery>& list : this->Group.exchangeItems(known))
  {
    found.insert(found.end(), list.begin(), list.end());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::vector<PointQuery>> answers;
  for (const std::vector<PointQuery>& list : this->Group.exchangeItems(asked))
  {
    answers.emplace_back();
    for (PointQuery query : list)
    {
      const auto at = std::lower_bound(found.begin(), found.end(), query);
      const bool same = at != found.end() && at->place == query.place && at->given == query.given;
      query.given = same ? at->id : -1;
      answers.back().push_back(query);
    }
  }
  for (const std::vector<PointQuery>& list : this->Group.exchangeItems(answers))
  {
    for (const PointQuery& answer : list)
    {
      ofPiece[answer.id] = answer.given;
    }
  }
  return ofPiece;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> RankMesh::markedOfPiece(const std::vector<Index>& idsOfPiece) const
{
  const std::vector<unsigned char> local = this->anyOf(this->Marked);
  std::vector<unsigned char> marked(idsOfPiece.size(), 0);
  std::vector<Index> own, all; // of points without an element here
  for (std::size_t p = 0; p < marked.size(); ++p)
  {
    const Index at = this->TheMesh->localOfPiece()[p];
    marked[p] = at >= 0 && local[at];
    if (at < 0 && this->Marked[p] && idsOfPiece[p] >= 0)
    {
      own.push_back(idsOfPiece[p]);
    }
  }
  for (const std::vector<Index>& list : this->Group.gatherItems(own))
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end());
  for (std::size_t p = 0; p < marked.size() && !all.empty(); ++p)
  {
    marked[p] |= std::binary_search(all.begin(), all.end(), idsOfPiece[p]);
  }
  return marked;
}

//------------------------------------------------------------------------------
std::vector<Index> RankMesh::numbersOf(Index cell) const
{
  const MeshView& view = this->piece();
  std::vector<Index> numbers;
  for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
  {
    const Index local = this->TheMesh->localOfPiece()[view.connectivity[n]];
    numbers.push_back(local < 0 ? -1 : this->TheMesh->numbers()[local]);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}
}
