// SPDX-License-Identifier: BSD-3-Clause
// What a mesh in pieces is as a whole: its division, its orientation, and the points of all pieces.
#include "MovableMesh.h"

#include "PointMerge.h"
#include "tautline/Mesh/CellCopies.h"
#include "tautline/Mesh/CoordinateOrder.h"
#include "tautline/Mesh/RankPieces.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <sstream>

namespace tautline
{
//------------------------------------------------------------------------------
std::string gatheredSentence(const std::string& why)
{
  const char* end = !why.empty() && why.back() == '.' ? "" : ".";
  return why.empty() ? "" : "The mesh was put together on the first process: " + why + end;
}

//------------------------------------------------------------------------------
std::unique_ptr<MovableMesh> MovableMesh::makePiece(
  RankGroup& group, vtkDataSet* input, int threads, bool mergePoints, Redistribution redistribution)
{
  std::unique_ptr<MovableMesh> mesh;
  group.together(
    [&]
    {
      try
      {
        mesh = std::make_unique<MovableMesh>(group, input, threads, mergePoints, redistribution);
      }
      catch (const OppositeOrders&) // on all processes
      {
      }
    });
  return mesh;
}

//------------------------------------------------------------------------------
Mesh MovableMesh::local() const
{
  Mesh mesh(this->distributed().view(), this->Threads);
  mesh.setMirrored(this->mirrored());
  return mesh;
}

//------------------------------------------------------------------------------
const double* MovableMesh::joinedPoints() const
{
  return this->Spread->copies.points.empty() ? this->piece().points
                                             : this->Spread->copies.points.data();
}

//------------------------------------------------------------------------------
/// Makes the mesh of the pieces.
void MovableMesh::divide(const MeshPiece& given)
{
  MeshPiece piece = given;
  piece.dropCopies = true; // pieces may overlap
  piece.divideAnew = this->Spread->divided != Redistribution::None;
  std::vector<int> owners;
  if (this->Spread->divided == Redistribution::PtScotch)
  {
    owners = ownersByGraph(this->group(), piece, this->Spread->divided, this->Spread->whyTree);
    std::replace(owners.begin(), owners.end(), -1, 0);
    piece.owners = owners.data();
  }
  this->Spread->mesh = std::make_unique<DistributedMesh>(this->group(), piece);
  this->Spread->dropped = this->distributed().droppedCells();
}

//------------------------------------------------------------------------------
/// Throws Error, on all processes, if parts of the mesh overlap.
/// @param mesh the local cells, including all cells at an owned point; null without one
void MovableMesh::requireOneLayer(const Mesh* mesh, const std::vector<signed char>& validity) const
{
  const DistributedMesh& all = this->distributed();
  Overlap overlap;
  if (mesh && !tautline::findSkin(*mesh, this->Threads).consistent)
  {
    std::vector<unsigned char> own(all.localPoints());
    for (Index p = 0; p < all.localPoints(); ++p)
    {
      own[p] = all.owned(p);
    }
    overlap = findOverlap(*mesh, validity.data(), own.data());
  }
  const Index facets = this->group().sum(overlap.facets);
  if (facets == 0)
  {
    return;
  }
  // The first one in the order of point numbers, on which all processes agree.
  struct First
  {
    Index number;
    Vec3 place;
  };
  std::vector<First> own;
  if (overlap.facets > 0)
  {
    own.push_back({ all.numbers()[overlap.first], pointOf(all.view(), overlap.first) });
  }
  const std::vector<First> found = this->group().gatherJoined(own);
  const First first = *std::min_element(
    found.begin(), found.end(), [](const First& a, const First& b) { return a.number < b.number; });
  std::ostringstream place;
  place << "(" << first.place[0] << ", " << first.place[1] << ", " << first.place[2] << ")";
  requireNoOverlap(facets, this->dimension() == 3 ? Dimension::Volume : Dimension::Planar,
    place.str(), ", or switch Reproducible Order off to keep parts with different points apart");
}

//------------------------------------------------------------------------------
/// Tests whether the cells list their points in a consistent order, and finds it.
void MovableMesh::checkOrder()
{
  const MeshView& view = this->distributed().view();
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
    for (const unsigned char owned : this->distributed().ownedCells())
    {
      copies.push_back(!owned);
    }
    pieces.push_back({ mesh.get(), copies.data(), this->distributed().numbers().data() });
    validities.push_back(validity.data());
  }
  this->requireOneLayer(mesh.get(), validity);
  const Orientation found = orientation(this->group(), pieces, validities);
  // As on one process, a majority of inverted elements alone does not make a mesh reversed.
  this->Adapter.mesh().setMirrored(found.state == Orientation::Reversed);
  this->Spread->inverted = this->mirrored() ? found.positiveCells : found.negativeCells;
  RankOrder order;
  order.orientation = found;
  this->Notice = describe(order, this->dimension() == 3 ? Dimension::Volume : Dimension::Planar);
  const std::string remarks = describe(joinRemarks(this->group(), this->Adapter.remarks(false)));
  this->Notice += (this->Notice.empty() || remarks.empty() ? "" : "\n") + remarks;
  if (found.disagreeing > 0 || (found.reversedParts > 0 && found.reversedParts < found.parts))
  {
    throw OppositeOrders(
      (found.disagreeing > 0 ? "Neighboring cells list their points in opposite orders"
                             : std::to_string(found.reversedParts) + " of " +
            std::to_string(found.parts) + " connected parts of the mesh are reversed") +
      ": gather the mesh on one process, in ParaView with Aggregate Dataset, with Reproducible "
      "Order "
      "off, or let Element Quality reorder the cells (Reorient) first.");
  }
}

//------------------------------------------------------------------------------
std::string MovableMesh::notice() const
{
  if (!this->inPieces())
  {
    return this->Notice;
  }
  const std::string division =
    dividedSentence(this->group(), this->Spread->divided, this->Spread->whyTree);
  std::string text;
  for (const std::string& sentence : { this->Notice, describeJoined(this->Spread->copies),
         describeCopies(this->Spread->dropped), division })
  {
    text += (text.empty() || sentence.empty() ? "" : "\n") + sentence;
  }
  return text;
}

//------------------------------------------------------------------------------
std::vector<double> MovableMesh::ofPiece(const std::vector<double>& local) const
{
  const MeshView& view = this->piece();
  std::vector<double> points(view.points, view.points + 3 * view.numberOfPoints);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index from = this->distributed().localOfPiece()[p];
    if (from >= 0)
    {
      std::copy_n(&local[3 * from], 3, &points[3 * p]);
    }
  }
  return points;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> MovableMesh::anyOf(const std::vector<unsigned char>& ofPiece) const
{
  const DistributedMesh& mesh = this->distributed();
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
std::vector<double> MovableMesh::leastOf(const std::vector<double>& ofPiece, double none) const
{
  if (!this->inPieces())
  {
    std::vector<double> least = ofPiece;
    const std::vector<Index>& one = this->representative();
    for (std::size_t p = 0; !least.empty() && p < one.size(); ++p)
    {
      least[one[p]] = std::min(least[one[p]], least[p]);
    }
    return least;
  }
  // The owner may have a point from another piece: finds the smallest across all processes.
  const DistributedMesh& mesh = this->distributed();
  struct Value
  {
    Index number;
    double value;
  };
  std::vector<std::vector<Value>> sent(this->group().size());
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
  for (const auto& list : this->group().exchangeItems(sent))
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
bool MovableMesh::inSpaceOrPlane() const
{
  const std::array<double, 6>& box = this->distributed().bounds();
  return this->Spread->dimension == 3 ||
    (this->Spread->dimension == 2 && (box[0] == box[3] || box[1] == box[4] || box[2] == box[5]));
}

//------------------------------------------------------------------------------
std::vector<Index> MovableMesh::pointIds() const
{
  const DistributedMesh& mesh = this->distributed();
  vtkDataArray* given = this->Input ? this->Input->GetPointData()->GetGlobalIds() : nullptr;
  if (this->group().any(this->piece().numberOfPoints > 0 && !given))
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
  // Each id is sent to one process, which counts its points.
  const auto ranks = static_cast<std::uint64_t>(this->group().size());
  std::vector<std::vector<Index>> sent(this->group().size());
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    if (mesh.owned(p))
    {
      sent[static_cast<std::uint64_t>(ids[p]) % ranks].push_back(ids[p]);
    }
  }
  std::vector<Index> received;
  for (const std::vector<Index>& list : this->group().exchangeItems(sent))
  {
    received.insert(received.end(), list.begin(), list.end());
  }
  std::sort(received.begin(), received.end());
  const auto twice = std::adjacent_find(received.begin(), received.end());
  const bool some = this->group().any(twice != received.end());
  const Index wrong =
    this->group().maximum(twice == received.end() ? std::numeric_limits<Index>::lowest() : *twice);
  if (some)
  {
    throw Error("Points at different positions have the global id " + std::to_string(wrong) +
      ": run Generate Global Ids again.");
  }
  return ids;
}

//------------------------------------------------------------------------------
namespace
{
/// A point that is requested by ranks without an element at it.
struct PointQuery
{
  std::array<double, 3> place;
  Index given; ///< the global id if global ids identify points, otherwise 0
  Index id;    ///< the answer, or the index of the request

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
std::vector<Index> MovableMesh::idsOfPiece(const std::vector<Index>& ids) const
{
  const MeshView& view = this->piece();
  const DistributedMesh& mesh = this->distributed();
  std::vector<Index> ofPiece(view.numberOfPoints, -1);
  bool unknown = false;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    ofPiece[p] = local < 0 ? -1 : ids[local];
    unknown = unknown || local < 0;
  }
  if (!this->group().any(unknown))
  {
    return ofPiece;
  }
  // Points are found by their identifying data.
  vtkDataArray* given =
    this->MergePoints || !this->Input ? nullptr : this->Input->GetPointData()->GetGlobalIds();
  const std::size_t ranks = static_cast<std::size_t>(this->group().size());
  std::vector<std::vector<PointQuery>> known(ranks), asked(ranks);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    const PointQuery query = queryOf(this->joinedPoints() + 3 * p,
      given ? static_cast<Index>(given->GetComponent(p, 0)) : 0, local < 0 ? p : ids[local]);
    (local < 0 ? asked : known)[query.rank(ranks)].push_back(query);
  }
  std::vector<PointQuery> found;
  for (const std::vector<PointQuery>& list : this->group().exchangeItems(known))
  {
    found.insert(found.end(), list.begin(), list.end());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::vector<PointQuery>> answers;
  for (const std::vector<PointQuery>& list : this->group().exchangeItems(asked))
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
  for (const std::vector<PointQuery>& list : this->group().exchangeItems(answers))
  {
    for (const PointQuery& answer : list)
    {
      ofPiece[answer.id] = answer.given;
    }
  }
  return ofPiece;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> MovableMesh::markedOfPiece(const std::vector<Index>& idsOfPiece) const
{
  const std::vector<unsigned char> local = this->anyOf(this->Spread->marked);
  std::vector<unsigned char> marked(idsOfPiece.size(), 0);
  std::vector<Index> own, all; // for points without an element here
  for (std::size_t p = 0; p < marked.size(); ++p)
  {
    const Index at = this->distributed().localOfPiece()[p];
    marked[p] = at >= 0 && local[at];
    if (at < 0 && this->Spread->marked[p] && idsOfPiece[p] >= 0)
    {
      own.push_back(idsOfPiece[p]);
    }
  }
  for (const std::vector<Index>& list : this->group().gatherItems(own))
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
std::vector<Index> MovableMesh::numbersOf(Index cell) const
{
  const MeshView& view = this->piece();
  std::vector<Index> numbers;
  for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
  {
    const Index local = this->distributed().localOfPiece()[view.connectivity[n]];
    numbers.push_back(local < 0 ? -1 : this->distributed().numbers()[local]);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}
}
