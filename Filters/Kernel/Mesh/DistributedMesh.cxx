// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedMesh.h"

#include "CellCopies.h"
#include "PointDivision.h"
#include "SampleSort.h"
#include "TakenCells.h"
#include "tautline/Core/Random.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <tuple>

namespace tautline
{
namespace
{
constexpr int mortonBits = 21;            ///< per direction
constexpr double mortonCells = 2097151.0; ///< 2 ^ mortonBits - 1

/// Spreads the lower 21 bits so that two zeros follow each.
std::uint64_t spreadBits(std::uint64_t x)
{
  x &= 0x1fffffu;
  x = (x | (x << 32)) & 0x001f00000000ffffu;
  x = (x | (x << 16)) & 0x001f0000ff0000ffu;
  x = (x | (x << 8)) & 0x100f00f00f00f00fu;
  x = (x | (x << 4)) & 0x10c30c30c30c30c3u;
  return (x | (x << 2)) & 0x1249249249249249u;
}

/// Flags of the points of a piece.
enum Use : char
{
  OfCell = 1,    ///< used by a cell, which may be a ghost
  OfElement = 2, ///< used by a cell that is not a ghost
  Follows = 4    ///< MeshPiece::followers
};

struct IdAndPlace
{
  Index id;
  double x[3];
};

/// Throws Error on all ranks if an id is at two locations.
void checkIds(RankGroup& group, const std::vector<IdAndPlace>& own)
{
  std::vector<std::vector<IdAndPlace>> sent;
  sent.resize(group.size());
  for (const IdAndPlace& item : own)
  {
    sent[SplitMix::mixed(static_cast<std::uint64_t>(item.id)) % sent.size()].push_back(item);
  }
  const auto received = group.exchangeItems(sent);
  std::vector<IdAndPlace> all;
  for (const auto& list : received)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(
    all.begin(), all.end(), [](const IdAndPlace& a, const IdAndPlace& b) { return a.id < b.id; });
  for (std::size_t i = 1; i < all.size(); ++i)
  {
    if (all[i].id == all[i - 1].id && !std::equal(all[i].x, all[i].x + 3, all[i - 1].x))
    {
      throw Error("The global point id " + std::to_string(all[i].id) +
        " is at two locations: run Generate Global Ids again.");
    }
  }
}
}

/// The sort key of a point, and its source.
struct DistributedMesh::PointKey
{
  std::uint64_t curve;
  double x[3];
  Index id;
  Index source;   ///< the point of the piece
  Index rank;     ///< of the piece
  Index withCell; ///< whether a cell there that is not a ghost has it
  Index owner;    ///< the requested owner, or -1
  Index counts;   ///< whether a cell there has it, not only a follower

  auto place() const { return std::tie(this->curve, this->x[0], this->x[1], this->x[2], this->id); }
  /// Compares only the position: keys of one point are equal.
  bool operator<(const PointKey& other) const { return this->place() < other.place(); }
};

/// A point as it is sent to the ranks that need it.
struct DistributedMesh::SentPoint
{
  Index number;
  double x[3];
  Index owner;
};

//------------------------------------------------------------------------------
DistributedMesh::DistributedMesh(RankGroup& group, const MeshPiece& piece)
  : Group(&group)
{
  group.together([&] { this->build(piece); });
}

//------------------------------------------------------------------------------
void DistributedMesh::build(const MeshPiece& piece)
{
  RankGroup& group = *this->Group;
  std::vector<char> used;
  const Mesh checked(piece.view); // throws for arrays that are out of range
  used.assign(piece.view.numberOfPoints, 0);
  for (Index cell = 0; cell < piece.view.numberOfCells; ++cell)
  {
    const char mark = piece.ghosts && piece.ghosts[cell] ? OfCell : OfCell | OfElement;
    for (Index n = piece.view.offsets[cell];
         takesPart(piece.view, cell) && n < piece.view.offsets[cell + 1]; ++n)
    {
      const Index point = piece.view.connectivity[n];
      if (point < 0 || point >= piece.view.numberOfPoints) // beyond the nodes of the cell type
      {
        throw Error("Cell " + std::to_string(cell) + " lists point " + std::to_string(point) +
          ", but the mesh has " + std::to_string(piece.view.numberOfPoints) + " points.");
      }
      used[point] |= mark;
    }
  }
  for (Index p = 0; p < piece.view.numberOfPoints; ++p)
  {
    const double* x = piece.view.points + 3 * p;
    if (used[p] && !(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])))
    {
      throw Error("Point " + std::to_string(p) +
        " has a coordinate that is not finite: remove its cells first, by Threshold or Clean "
        "to Grid.");
    }
    if (used[p] && piece.globalIds && piece.globalIds[p] < 0)
    {
      throw Error("The global id of point " + std::to_string(p) +
        " is negative: run Generate Global Ids again.");
    }
    if (used[p] && piece.owners && (piece.owners[p] < 0 || piece.owners[p] >= group.size()))
    {
      throw Error("Point " + std::to_string(p) + " shall be owned by rank " +
        std::to_string(piece.owners[p]) + " of " + std::to_string(group.size()) + ".");
    }
  }
  this->addFollowers(piece, used);
  this->numberPoints(piece, used);
  for (Index p = 0; p < piece.view.numberOfPoints; ++p)
  {
    used[p] = this->PieceNumbers[p] < 0 ? 0 : used[p]; // followers have no element
  }
  this->takeCells(piece, used);
  this->connect();
}

//------------------------------------------------------------------------------
void DistributedMesh::addFollowers(const MeshPiece& piece, std::vector<char>& used) const
{
  for (Index p = 0; piece.followers && p < piece.view.numberOfPoints; ++p)
  {
    const double* x = piece.view.points + 3 * p;
    const bool named = !piece.globalIds || piece.globalIds[p] >= 0;
    if (piece.followers[p] && named && std::isfinite(x[0]) && std::isfinite(x[1]) &&
      std::isfinite(x[2]))
    {
      used[p] |= Follows;
    }
  }
}

//------------------------------------------------------------------------------
/// The bounds of the points of all ranks.
void DistributedMesh::findBounds(const MeshPiece& piece, const std::vector<char>& used)
{
  RankGroup& group = *this->Group;
  const Index n = piece.view.numberOfPoints;
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> box = { infinity, infinity, infinity, -infinity, -infinity, -infinity };
  for (Index p = 0; p < n; ++p)
  {
    for (int c = 0; c < 3 && (used[p] & OfCell) != 0; ++c)
    {
      box[c] = std::min(box[c], piece.view.points[3 * p + c]);
      box[3 + c] = std::max(box[3 + c], piece.view.points[3 * p + c]);
    }
  }
  for (const auto& other : group.gatherItems(std::vector<double>(box)))
  {
    for (int c = 0; c < 3; ++c)
    {
      box[c] = std::min(box[c], other[c]);
      box[3 + c] = std::max(box[3 + c], other[3 + c]);
    }
  }
  for (int c = 0; c < 3 && box[0] <= box[3]; ++c)
  {
    this->Bounds[c] = box[c];
    this->Bounds[3 + c] = box[3 + c];
  }
}

//------------------------------------------------------------------------------
/// The sorted keys of the points of cells.
std::vector<DistributedMesh::PointKey> DistributedMesh::makeKeys(
  const MeshPiece& piece, const std::vector<char>& used)
{
  RankGroup& group = *this->Group;
  const Index n = piece.view.numberOfPoints;
  const bool here = std::any_of(used.begin(), used.end(), [](char u) { return u != 0; });
  const bool withIds = group.any(here && piece.globalIds),
             without = group.any(here && !piece.globalIds);
  if (withIds && without)
  {
    throw Error("Some processes have global point ids and others do not: run Generate Global "
                "Ids.");
  }
  this->findBounds(piece, used);
  double extent = 0;
  for (int c = 0; c < 3; ++c)
  {
    extent = std::max(extent, this->Bounds[3 + c] - this->Bounds[c]);
  }
  const double perLength = extent > 0 && std::isfinite(extent) ? mortonCells / extent : 0.0;

  std::vector<PointKey> keys;
  std::vector<IdAndPlace> ids;
  const auto keyOf = [&](Index p)
  {
    PointKey key = { 0, { 0, 0, 0 }, withIds ? piece.globalIds[p] : 0, p, group.rank(),
      (used[p] & OfElement) != 0, piece.owners ? piece.owners[p] : -1, (used[p] & OfCell) != 0 };
    for (int c = 0; c < 3; ++c)
    {
      key.x[c] = piece.view.points[3 * p + c] + 0.0;                // -0 becomes 0
      const double cell = perLength * (key.x[c] - this->Bounds[c]); // NaN if too small or too large
      key.curve |=
        spreadBits(static_cast<std::uint64_t>(cell > 0 ? std::min(cell, mortonCells) : 0.0)) << c;
    }
    return key;
  };
  for (Index p = 0; p < n; ++p)
  {
    if (used[p])
    {
      keys.push_back(keyOf(p));
    }
  }
  for (const PointKey& key : keys)
  {
    if (withIds && key.counts)
    {
      ids.push_back({ key.id, { key.x[0], key.x[1], key.x[2] } });
    }
  }
  std::sort(keys.begin(), keys.end());
  if (withIds)
  {
    checkIds(group, ids);
  }
  return keys;
}

//------------------------------------------------------------------------------
/// Sends keys to ranks so that each gets a range of them, and returns the sorted keys of this rank.
std::vector<DistributedMesh::PointKey> DistributedMesh::distribute(
  const std::vector<PointKey>& keys) const
{
  RankGroup& group = *this->Group;
  std::vector<PointKey> range = group.exchangeJoined(splitIntoRanges(group, keys));
  std::sort(range.begin(), range.end(),
    [&](const PointKey& a, const PointKey& b)
    {
      return std::make_tuple(a.place(), a.rank, a.source) <
        std::make_tuple(b.place(), b.rank, b.source);
    });
  return range;
}

//------------------------------------------------------------------------------
/// Determines the numbers of the points and the owners: of the ranks with a cell there, one is
/// chosen by a hash.
void DistributedMesh::numberPoints(const MeshPiece& piece, const std::vector<char>& used)
{
  RankGroup& group = *this->Group;
  std::vector<PointKey> keys = this->makeKeys(piece, used);
  std::unique_ptr<PointDivision> division;
  if (piece.divideAnew)
  {
    std::vector<Vec3> places;
    for (const PointKey& key : keys)
    {
      if (key.counts)
      {
        places.push_back({ key.x[0], key.x[1], key.x[2] });
      }
    }
    division = std::make_unique<PointDivision>(group, places);
  }
  const std::vector<PointKey> range = this->distribute(keys);
  keys = std::vector<PointKey>();
  const auto endOf = [&range](std::size_t begin)
  {
    std::size_t end = begin + 1;
    while (end < range.size() && !(range[begin] < range[end]))
    {
      ++end;
    }
    return end;
  };
  // The first key of a cell; the end if there are only followers.
  const auto firstThatCounts = [&range](std::size_t begin, std::size_t end)
  {
    while (begin < end && !range[begin].counts)
    {
      ++begin;
    }
    return begin;
  };
  Index count = 0;
  for (std::size_t begin = 0, end = 0; begin < range.size(); begin = end)
  {
    end = endOf(begin);
    count += firstThatCounts(begin, end) < end;
  }
  Index first = 0;
  const auto counts = group.gatherItems(std::vector<Index>{ count });
  for (int r = 0; r < group.size(); ++r)
  {
    first += r < group.rank() ? counts[r][0] : 0;
    this->GlobalPoints += counts[r][0];
  }
  struct Reply
  {
    Index source, number, owner;
  };
  std::vector<std::vector<Reply>> replies;
  replies.resize(group.size());
  for (std::size_t begin = 0, end = 0; begin < range.size(); begin = end)
  {
    end = endOf(begin);
    const std::size_t counted = firstThatCounts(begin, end);
    if (counted == end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        replies[range[i].rank].push_back({ range[i].source, -1, -1 });
      }
      continue;
    }
    Index owner = range[counted].rank;
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = begin; i < end; ++i)
    {
      const std::uint64_t hash = ownerHash(first, static_cast<int>(range[i].rank));
      if (range[i].withCell && hash < least)
      {
        least = hash;
        owner = range[i].rank;
      }
    }
    if (least < std::numeric_limits<std::uint64_t>::max()) // an element uses it
    {
      const PointKey& key = range[counted];
      owner = key.owner >= 0 ? key.owner
        : division           ? division->find({ key.x[0], key.x[1], key.x[2] })
                             : owner;
    }
    for (std::size_t i = begin; i < end; ++i)
    {
      replies[range[i].rank].push_back({ range[i].source, first, owner });
    }
    ++first;
  }
  this->PieceNumbers.assign(piece.view.numberOfPoints, -1);
  this->PieceOwners.assign(piece.view.numberOfPoints, -1);
  for (const auto& list : group.exchangeItems(replies))
  {
    for (const Reply& reply : list)
    {
      this->PieceNumbers[reply.source] = reply.number;
      this->PieceOwners[reply.source] = static_cast<int>(reply.owner);
    }
  }
}

//------------------------------------------------------------------------------
/// Sets the local points and the position of each number among them.
void DistributedMesh::takePoints(
  const MeshPiece& piece, const std::vector<char>& used, std::vector<SentPoint>& points)
{
  std::sort(points.begin(), points.end(),
    [](const SentPoint& a, const SentPoint& b) { return a.number < b.number; });
  for (const SentPoint& point : points)
  {
    if (this->Numbers.empty() || this->Numbers.back() != point.number)
    {
      this->Numbers.push_back(point.number);
      this->Owners.push_back(static_cast<int>(point.owner));
      this->Points.insert(this->Points.end(), point.x, point.x + 3);
    }
  }
  this->Intervals =
    NumberIntervals(this->localPoints(), [this](Index p) { return this->Numbers[p]; });
  this->LocalOfPiece.assign(piece.view.numberOfPoints, -1);
  for (Index p = 0; p < piece.view.numberOfPoints; ++p)
  {
    this->LocalOfPiece[p] = used[p] ? this->local(this->PieceNumbers[p]) : -1;
  }
}

//------------------------------------------------------------------------------
Index DistributedMesh::local(Index number) const
{
  const Index at = this->Intervals.find(number, [this](Index p) { return this->Numbers[p]; });
  return at < this->localPoints() && this->Numbers[at] == number ? at : -1;
}

//------------------------------------------------------------------------------
/// Exchanges the points of cells on this rank and of the cells that others send.
/// @param needed per other rank, points of the piece that it needs, with repetitions
void DistributedMesh::exchangePoints(
  const MeshPiece& piece, const std::vector<char>& used, std::vector<std::vector<Index>> needed)
{
  RankGroup& group = *this->Group;
  const MeshView& view = piece.view;
  const auto pointAt = [&](Index p)
  {
    SentPoint point = { this->PieceNumbers[p], { 0, 0, 0 }, this->PieceOwners[p] };
    std::copy_n(view.points + 3 * p, 3, point.x);
    return point;
  };
  std::vector<std::vector<SentPoint>> sent;
  std::vector<SentPoint> points;
  sent.resize(group.size());
  for (int rank = 0; rank < group.size(); ++rank)
  {
    std::vector<Index>& some = needed[rank];
    std::sort(some.begin(), some.end());
    some.erase(std::unique(some.begin(), some.end()), some.end());
    std::transform(some.begin(), some.end(), std::back_inserter(sent[rank]), pointAt);
  }
  points.reserve(static_cast<std::size_t>(view.numberOfPoints));
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (used[p])
    {
      points.push_back(pointAt(p));
    }
  }
  const auto received = group.exchangeItems(sent);
  for (const auto& list : received)
  {
    points.insert(points.end(), list.begin(), list.end());
  }
  this->takePoints(piece, used, points);
}

//------------------------------------------------------------------------------
/// The cells that have a point of this rank, from each rank: type, number of points, local points.
std::vector<std::vector<std::int32_t>> DistributedMesh::exchangeCells(
  const MeshPiece& piece, const std::vector<char>& used)
{
  RankGroup& group = *this->Group;
  const MeshView& view = piece.view;
  const int self = group.rank();
  const auto takes = [&](Index cell)
  { return !(piece.ghosts && piece.ghosts[cell]) && takesPart(view, cell); };
  const auto isOwn = [&](Index point) { return this->PieceOwners[point] == self; };
  std::vector<std::vector<Index>> sent, needed;
  std::size_t staying = 0; // length of the list for this rank
  sent.resize(group.size());
  needed.resize(group.size());
  std::vector<int> ranks;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    if (!takes(cell))
    {
      continue;
    }
    const Index *begin = view.connectivity + view.offsets[cell],
                *end = view.connectivity + view.offsets[cell + 1];
    const auto own = std::count_if(begin, end, isOwn);
    staying += own > 0 ? 2 + static_cast<std::size_t>(end - begin) : 0;
    if (own == end - begin) // most cells stay
    {
      continue;
    }
    ranks.clear();
    for (const Index* node = begin; node != end; ++node)
    {
      ranks.push_back(this->PieceOwners[*node]);
    }
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
    for (const int rank : ranks)
    {
      if (rank == self)
      {
        continue;
      }
      sent[rank].push_back(view.cellTypes[cell]);
      sent[rank].push_back(end - begin);
      for (const Index* node = begin; node != end; ++node)
      {
        sent[rank].push_back(this->PieceNumbers[*node]);
        needed[rank].push_back(*node);
      }
    }
  }
  this->exchangePoints(piece, used, std::move(needed));

  std::vector<std::vector<std::int32_t>> lists;
  const std::vector<std::vector<Index>> received = group.exchangeItems(sent);
  lists.resize(group.size());
  for (int rank = 0; rank < group.size(); ++rank)
  {
    const std::vector<Index>& from = received[rank];
    for (std::size_t i = 0; i < from.size(); i += 2 + static_cast<std::size_t>(from[i + 1]))
    {
      const auto begin = from.begin() + static_cast<std::ptrdiff_t>(i) + 2;
      lists[rank].push_back(static_cast<std::int32_t>(from[i]));
      lists[rank].push_back(static_cast<std::int32_t>(from[i + 1]));
      std::transform(begin, begin + static_cast<std::ptrdiff_t>(from[i + 1]),
        std::back_inserter(lists[rank]),
        [this](Index number) { return static_cast<std::int32_t>(this->local(number)); });
    }
  }
  lists[self].reserve(staying);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index *begin = view.connectivity + view.offsets[cell],
                *end = view.connectivity + view.offsets[cell + 1];
    if (takes(cell) && std::any_of(begin, end, isOwn))
    {
      lists[self].push_back(view.cellTypes[cell]);
      lists[self].push_back(static_cast<std::int32_t>(end - begin));
      std::transform(begin, end, std::back_inserter(lists[self]),
        [this](Index point) { return static_cast<std::int32_t>(this->LocalOfPiece[point]); });
    }
  }
  return lists;
}

//------------------------------------------------------------------------------
/// Keeps the first of cells that are copies of each other; the choice depends only on their points.
void DistributedMesh::dropCopies(TakenCells& taken)
{
  const std::vector<TakenCells::Cell>& cells = taken.cells();
  std::vector<char> dropped;
  Index own = 0;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < cells.size(); ++i)
  {
    if (cells[i].least != cells[i - 1].least || !taken.same(cells[i], cells[i - 1]))
    {
      begin = i;
      continue;
    }
    const CellType type = cornerType(static_cast<unsigned char>(taken.type(cells[i])));
    for (std::size_t first = begin; first < i; ++first)
    {
      const std::vector<Index> a(taken.begin(cells[first]), taken.end(cells[first])),
        b(taken.begin(cells[i]), taken.end(cells[i]));
      if ((dropped.empty() || !dropped[first]) && sameFacets(type, a.data(), b.data()))
      {
        dropped.resize(cells.size(), 0);
        dropped[i] = 1;
        own += this->owned(cells[i].least);
        break;
      }
    }
  }
  this->DroppedCells = this->Group->sum(own);
  taken.drop(dropped);
}

//------------------------------------------------------------------------------
void DistributedMesh::copyCells(const TakenCells& taken)
{
  this->Offsets.assign(1, 0);
  std::size_t nodes = 0;
  for (const TakenCells::Cell& cell : taken.cells())
  {
    nodes += static_cast<std::size_t>(taken.end(cell) - taken.begin(cell));
  }
  this->CellTypes.reserve(taken.cells().size());
  this->OwnedCells.reserve(taken.cells().size());
  this->Offsets.reserve(taken.cells().size() + 1);
  this->Connectivity.reserve(nodes);
  for (const TakenCells::Cell& cell : taken.cells())
  {
    this->CellTypes.push_back(static_cast<unsigned char>(taken.type(cell)));
    this->Connectivity.insert(this->Connectivity.end(), taken.begin(cell), taken.end(cell));
    this->Offsets.push_back(static_cast<Index>(this->Connectivity.size()));
    this->OwnedCells.push_back(this->owned(cell.least));
  }
}

//------------------------------------------------------------------------------
void DistributedMesh::takeCells(const MeshPiece& piece, const std::vector<char>& used)
{
  RankGroup& group = *this->Group;
  std::vector<std::vector<std::int32_t>> lists = this->exchangeCells(piece, used);
  std::unique_ptr<TakenCells> taken;
  taken = std::make_unique<TakenCells>(std::move(lists), this->localPoints());
  if (piece.dropCopies)
  {
    this->dropCopies(*taken);
  }
  const std::vector<TakenCells::Cell>& cells = taken->cells();
  for (std::size_t i = 1; !piece.dropCopies && i < cells.size(); ++i)
  {
    if (cells[i].rank != cells[i - 1].rank && cells[i].least == cells[i - 1].least &&
      taken->same(cells[i], cells[i - 1]))
    {
      throw Error("Processes " + std::to_string(std::min(cells[i].rank, cells[i - 1].rank)) +
        " and " + std::to_string(std::max(cells[i].rank, cells[i - 1].rank)) +
        " have the same cell, and neither marks it as a ghost: assign each cell to one process, "
        "or mark copies in the array vtkGhostType.");
    }
  }
  this->copyCells(*taken);

  const Index own = std::count(this->OwnedCells.begin(), this->OwnedCells.end(), 1);
  this->GlobalCells = group.sum(own);
  this->View.numberOfPoints = this->localPoints();
  this->View.points = this->Points.data();
  this->View.numberOfCells = static_cast<Index>(this->CellTypes.size());
  this->View.cellTypes = this->CellTypes.data();
  this->View.offsets = this->Offsets.data();
  this->View.connectivity = this->Connectivity.data();
}

//------------------------------------------------------------------------------
/// The lists of points that are sent to and received from each rank.
void DistributedMesh::connect()
{
  RankGroup& group = *this->Group;
  std::vector<std::vector<Index>> wanted;
  std::vector<std::vector<std::int32_t>> received;
  wanted.resize(group.size());
  received.resize(group.size());
  for (Index p = 0; p < this->localPoints(); ++p)
  {
    if (!this->owned(p))
    {
      wanted[this->Owners[p]].push_back(this->Numbers[p]);
      received[this->Owners[p]].push_back(static_cast<std::int32_t>(p));
    }
  }
  const auto asked = group.exchangeItems(wanted);
  for (int rank = 0; rank < group.size(); ++rank)
  {
    Subset::Neighbour neighbour = { rank, {}, std::move(received[rank]) };
    for (const Index number : asked[rank])
    {
      neighbour.sent.push_back(static_cast<std::int32_t>(this->local(number)));
    }
    if (!neighbour.sent.empty() || !neighbour.received.empty())
    {
      this->Halo.push_back(std::move(neighbour));
    }
  }
}
}
