// SPDX-License-Identifier: BSD-3-Clause
#include "PointNumbering.h"
#include "tautline/Mesh/FacetTable.h"

#include "RankExchange.h"

#include <unordered_map>

namespace tautline
{
namespace
{
constexpr Index NoRow = -1;

/// An item and its original position in a list.
struct Entry
{
  Index id;
  int rank;
  std::size_t place;
};

/// A facet, as the global ids of its points in increasing order with leading -1, and its number of
/// cells.
struct SharedFacet
{
  std::array<Index, MaxFaceNodes> ids;
  int cells;
};

/// The items of a list of points, grouped by rank.
template <class Item, class Get>
RankLists<Item> filed(const ItemsByRank& order, const Get& get)
{
  RankLists<Item> lists;
  lists.counts = order.counts;
  lists.items.reserve(order.order.size());
  for (const Index i : order.order)
  {
    lists.items.push_back(get(i));
  }
  return lists;
}
}

//------------------------------------------------------------------------------
struct PointNumbering::Implementation
{
  MPI_Comm Comm = MPI_COMM_SELF;
  bool Alone = true; // no communicator: MPI is not called
  int Rank = 0, Ranks = 1;
  Index Points = 0, GlobalSize = 0, FirstRow = 0, OwnedRows = 0;
  std::vector<Index> Rows;
  std::vector<unsigned char> Owned;
  /// Lent: local points owned by other ranks, in order of owner. Borrowed: owned points that other
  /// ranks have, in order of rank.
  RankLists<Index> Lent, Borrowed;

  void build(const Index* globalIds, const unsigned char* used);
  void numberOwned(const std::vector<Index>& points, const std::vector<int>& owners);
  void shareRows(const std::vector<Index>& points, const std::vector<Index>& ids,
    const std::vector<int>& owners);
  std::vector<int> findOwners(const std::vector<Index>& ids, std::string& complaint) const;

  /// Combines the values of shared points at their owners, and sends the result to all ranks that
  /// have them.
  template <class Item, class Read, class Combine, class Write>
  void combine(const Read& read, const Combine& add, const Write& write) const
  {
    RankLists<Item> toOwners;
    toOwners.counts = this->Lent.counts;
    for (const Index point : this->Lent.items)
    {
      toOwners.items.push_back(read(point));
    }
    const RankLists<Item> arrived = exchange(this->Comm, toOwners);
    for (std::size_t i = 0; i < arrived.items.size(); ++i)
    {
      add(this->Borrowed.items[i], arrived.items[i]);
    }
    RankLists<Item> back;
    back.counts = this->Borrowed.counts;
    for (const Index point : this->Borrowed.items)
    {
      back.items.push_back(read(point));
    }
    const RankLists<Item> results = exchange(this->Comm, back);
    for (std::size_t i = 0; i < results.items.size(); ++i)
    {
      write(this->Lent.items[i], results.items[i]);
    }
  }
};

/// The lowest rank that has each id, from a directory distributed over the ranks.
std::vector<int> PointNumbering::Implementation::findOwners(
  const std::vector<Index>& ids, std::string& complaint) const
{
  // Each rank keeps the directory entries of some of the ids.
  std::vector<int> target(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    target[i] = directoryRank(ids[i], this->Ranks);
  }
  const ItemsByRank order(target, this->Ranks);
  const RankLists<Index> asked =
    exchange(this->Comm, filed<Index>(order, [&](Index i) { return ids[i]; }));
  std::vector<Entry> entries;
  entries.reserve(asked.items.size());
  for (int rank = 0; rank < this->Ranks; ++rank)
  {
    for (int k = 0; k < asked.counts[rank]; ++k)
    {
      entries.push_back({ asked.items[entries.size()], rank, entries.size() });
    }
  }
  // Equal ids are adjacent, the lowest rank first: it is the owner.
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b) { return a.id != b.id ? a.id < b.id : a.place < b.place; });
  RankLists<int> answers;
  answers.counts = asked.counts;
  answers.items.resize(entries.size());
  for (std::size_t i = 0, first = 0; i < entries.size(); ++i)
  {
    first = entries[i].id == entries[first].id ? first : i;
    answers.items[entries[i].place] = entries[first].rank;
    if (i > first && entries[i].rank == entries[i - 1].rank)
    {
      complaint = "Global point id " + std::to_string(entries[i].id) +
        " occurs twice on one MPI rank: give each point a unique id (filter Generate Global "
        "Ids).";
    }
  }
  const RankLists<int> owners = exchange(this->Comm, answers);
  std::vector<int> result(ids.size());
  for (std::size_t k = 0; k < order.order.size(); ++k)
  {
    result[order.order[k]] = owners.items[k];
  }
  return result;
}

void PointNumbering::Implementation::build(const Index* globalIds, const unsigned char* used)
{
  std::vector<Index> points, ids;
  std::string complaint;
  if (!globalIds && this->Points > 0 && this->Ranks > 1)
  {
    complaint =
      "A mesh on several MPI ranks needs global point ids: use the filter Generate Global Ids.";
  }
  for (Index p = 0; p < this->Points; ++p)
  {
    if (!used || used[p])
    {
      const Index id = globalIds ? globalIds[p] : p;
      if (id < 0)
      {
        complaint = "Global point id " + std::to_string(id) + " is negative.";
      }
      points.push_back(p);
      ids.push_back(id);
    }
  }
  this->Rows.assign(static_cast<std::size_t>(this->Points), NoRow);
  this->Owned.assign(static_cast<std::size_t>(this->Points), 0);
  std::vector<int> owners(points.size(), 0);
  if (this->Ranks > 1)
  {
    throwTogether(this->Comm, complaint);
    owners = this->findOwners(ids, complaint);
    throwTogether(this->Comm, complaint);
  }
  this->numberOwned(points, owners);
  if (this->Ranks > 1)
  {
    this->shareRows(points, ids, owners);
  }
}

/// Numbers the rows of the points of this rank; the ranks are numbered consecutively.
void PointNumbering::Implementation::numberOwned(
  const std::vector<Index>& points, const std::vector<int>& owners)
{
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (owners[i] == this->Rank)
    {
      this->Rows[points[i]] = this->OwnedRows++;
      this->Owned[points[i]] = 1;
    }
  }
  this->GlobalSize = this->OwnedRows;
  if (this->Ranks == 1)
  {
    return;
  }
  Index end = 0;
  MPI_Scan(&this->OwnedRows, &end, 1, MPI_INT64_T, MPI_SUM, this->Comm);
  MPI_Allreduce(&this->OwnedRows, &this->GlobalSize, 1, MPI_INT64_T, MPI_SUM, this->Comm);
  this->FirstRow = end - this->OwnedRows;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (owners[i] == this->Rank)
    {
      this->Rows[points[i]] += this->FirstRow;
    }
  }
}

/// Each rank lists the points it shares with their owners, who answer with the rows.
void PointNumbering::Implementation::shareRows(
  const std::vector<Index>& points, const std::vector<Index>& ids, const std::vector<int>& owners)
{
  std::unordered_map<Index, Index> pointOf;
  pointOf.reserve(points.size());
  std::vector<std::size_t> shared;
  std::vector<int> sharedOwner;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (owners[i] == this->Rank)
    {
      pointOf.emplace(ids[i], points[i]);
    }
    else
    {
      shared.push_back(i);
      sharedOwner.push_back(owners[i]);
    }
  }
  const ItemsByRank order(sharedOwner, this->Ranks);
  this->Lent = filed<Index>(order, [&](Index k) { return points[shared[k]]; });
  const RankLists<Index> asked =
    exchange(this->Comm, filed<Index>(order, [&](Index k) { return ids[shared[k]]; }));
  this->Borrowed.counts = asked.counts;
  for (const Index id : asked.items)
  {
    this->Borrowed.items.push_back(pointOf.at(id));
  }
  this->combine<Index>([&](Index point) { return this->Rows[point]; }, [](Index, Index) {},
    [&](Index point, Index row) { this->Rows[point] = row; });
}

//------------------------------------------------------------------------------
PointNumbering::PointNumbering(
  Communicator communicator, Index points, const Index* globalIds, const unsigned char* used)
  : Impl(std::make_unique<Implementation>())
{
  this->Impl->Points = points;
  if (communicator)
  {
    this->Impl->Alone = false;
    this->Impl->Comm = mpiOf(communicator);
    MPI_Comm_rank(this->Impl->Comm, &this->Impl->Rank);
    MPI_Comm_size(this->Impl->Comm, &this->Impl->Ranks);
  }
  this->Impl->build(globalIds, used);
}

PointNumbering::~PointNumbering() = default;

Communicator PointNumbering::communicator() const
{
  return this->Impl->Alone ? nullptr : &this->Impl->Comm;
}

int PointNumbering::ranks() const
{
  return this->Impl->Ranks;
}

Index PointNumbering::globalSize() const
{
  return this->Impl->GlobalSize;
}

Index PointNumbering::firstRow() const
{
  return this->Impl->FirstRow;
}

Index PointNumbering::ownedRows() const
{
  return this->Impl->OwnedRows;
}

const std::vector<Index>& PointNumbering::rows() const
{
  return this->Impl->Rows;
}

bool PointNumbering::owned(Index point) const
{
  return this->Impl->Owned[point] != 0;
}

void PointNumbering::sum(double* values, int components) const
{
  if (this->Impl->Ranks == 1)
  {
    return;
  }
  // Process one component after the other, so that items have a fixed size.
  for (int c = 0; c < components; ++c)
  {
    const auto at = [=](Index point) -> double& { return values[components * point + c]; };
    this->Impl->combine<double>([&](Index point) { return at(point); },
      [&](Index point, double value) { at(point) += value; },
      [&](Index point, double value) { at(point) = value; });
  }
}

void PointNumbering::either(unsigned char* flags) const
{
  if (this->Impl->Ranks > 1)
  {
    this->Impl->combine<unsigned char>([&](Index point) { return flags[point]; },
      [&](Index point, unsigned char flag) { flags[point] = flags[point] ? flags[point] : flag; },
      [&](Index point, unsigned char flag) { flags[point] = flag; });
  }
}

double PointNumbering::sum(double value) const
{
  double result = value;
  if (this->Impl->Ranks > 1)
  {
    MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, MPI_SUM, this->Impl->Comm);
  }
  return result;
}

double PointNumbering::maximum(double value) const
{
  double result = value;
  if (this->Impl->Ranks > 1)
  {
    MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, MPI_MAX, this->Impl->Comm);
  }
  return result;
}

Index PointNumbering::sum(Index value) const
{
  Index result = value;
  if (this->Impl->Ranks > 1)
  {
    MPI_Allreduce(&value, &result, 1, MPI_INT64_T, MPI_SUM, this->Impl->Comm);
  }
  return result;
}

//------------------------------------------------------------------------------
namespace
{
/// The local points of a facet; unused entries are -1.
using LocalFacet = std::array<Index, MaxFaceNodes>;

/// Calls visit(facet, cells) for each facet that does not have two cells on this rank; cells with
/// skip flags are ignored.
template <class Visit>
void forEachOpenFacet(const Mesh& mesh, const unsigned char* skip, const Visit& visit)
{
  FacetTable(mesh, skip)
    .forEachFacet(
      [&](Index smallest, const FacetUse* uses, Index count)
      {
        if (count != 2)
        {
          visit(LocalFacet{ smallest, uses->others[0], uses->others[1], uses->others[2] },
            static_cast<int>(count));
        }
      });
}

/**
 * The middle nodes of boundary edges. Since an edge between two boundary points may be inside, the
 * edges of facets are used. For quadratic triangles and tetrahedra, where any two corners of a
 * facet form an edge of the cell.
 */
class QuadraticEdges
{
public:
  QuadraticEdges(const Mesh& mesh, const unsigned char* skip)
    : TheMesh(mesh)
    , Skip(skip)
  {
  }

  void add(const LocalFacet& facet)
  {
    for (std::size_t i = 0; this->TheMesh.higherOrderCells() > 0 && i < facet.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        if (facet[i] >= 0 && facet[j] >= 0)
        {
          this->Edges.push_back(std::minmax(facet[i], facet[j]));
        }
      }
    }
  }

  void mark(std::vector<unsigned char>& flags)
  {
    std::sort(this->Edges.begin(), this->Edges.end());
    const MeshView& view = this->TheMesh.view();
    for (Index cell = 0; !this->Edges.empty() && cell < view.numberOfCells; ++cell)
    {
      const CellType type = cornerType(view.cellTypes[cell]);
      const bool simplex = type == CellType::Triangle || type == CellType::Tetrahedron;
      if (!simplex || !isHigherOrder(view.cellTypes[cell]) || (this->Skip && this->Skip[cell]))
      {
        continue;
      }
      const CellTopology& t = topology(type);
      const Index* node = view.connectivity + view.offsets[cell];
      const Index nodes = view.offsets[cell + 1] - view.offsets[cell];
      for (int e = 0; e < t.edges && t.nodes + e < nodes; ++e)
      {
        const std::pair<Index, Index> edge =
          std::minmax(node[t.edgeNodes[e][0]], node[t.edgeNodes[e][1]]);
        const bool found = std::binary_search(this->Edges.begin(), this->Edges.end(), edge);
        flags[node[t.nodes + e]] |= static_cast<unsigned char>(found);
      }
    }
  }

private:
  const Mesh& TheMesh;
  const unsigned char* Skip;
  std::vector<std::pair<Index, Index>> Edges;
};

/// The number of cells of each facet on all ranks, summed by a directory distributed over the
/// ranks.
std::vector<int> cellsOnAllRanks(MPI_Comm comm, int ranks, const std::vector<SharedFacet>& facets)
{
  std::vector<int> target;
  for (const SharedFacet& facet : facets)
  {
    target.push_back(directoryRank(facet.ids.back(), ranks));
  }
  const ItemsByRank order(target, ranks);
  const RankLists<SharedFacet> asked =
    exchange(comm, filed<SharedFacet>(order, [&](Index i) { return facets[i]; }));
  // Equal facets are adjacent in this order.
  std::vector<std::size_t> sorted(asked.items.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t(0));
  std::sort(sorted.begin(), sorted.end(),
    [&](std::size_t a, std::size_t b) { return asked.items[a].ids < asked.items[b].ids; });
  RankLists<int> answers;
  answers.counts = asked.counts;
  answers.items.resize(sorted.size());
  for (std::size_t i = 0; i < sorted.size();)
  {
    int cells = 0;
    std::size_t j = i;
    for (; j < sorted.size() && asked.items[sorted[j]].ids == asked.items[sorted[i]].ids; ++j)
    {
      cells += asked.items[sorted[j]].cells;
    }
    for (; i < j; ++i)
    {
      answers.items[sorted[i]] = cells;
    }
  }
  const RankLists<int> cells = exchange(comm, answers);
  std::vector<int> result(facets.size());
  for (std::size_t k = 0; k < order.order.size(); ++k)
  {
    result[order.order[k]] = cells.items[k];
  }
  return result;
}
}

//------------------------------------------------------------------------------
std::vector<unsigned char> globalBoundaryPoints(
  const Mesh& mesh, Communicator communicator, const Index* globalIds, const unsigned char* skip)
{
  const Index points = mesh.view().numberOfPoints;
  std::vector<unsigned char> flags(static_cast<std::size_t>(points), 0);
  const PointNumbering all(communicator, points, globalIds);
  const bool volume = mesh.dimension() == Dimension::Volume;
  const bool volumeSomewhere = all.maximum(volume ? 1.0 : 0.0) > 0.0;
  QuadraticEdges edges(mesh, skip);
  const auto mark = [&](const LocalFacet& facet)
  {
    for (const Index point : facet)
    {
      if (point >= 0)
      {
        flags[point] = 1;
      }
    }
    edges.add(facet);
  };
  // As in Mesh::boundary(), facets that do not have two cells are on the boundary.
  if (all.ranks() == 1)
  {
    forEachOpenFacet(mesh, skip, [&](const LocalFacet& facet, int) { mark(facet); });
    edges.mark(flags);
    return flags;
  }
  // Another rank may have the second cell. A rank without volume cells has no facets of a volume
  // mesh.
  std::vector<LocalFacet> facets;
  std::vector<SharedFacet> shared;
  if (volume == volumeSomewhere)
  {
    forEachOpenFacet(mesh, skip,
      [&](const LocalFacet& facet, int cells)
      {
        SharedFacet item = { facet, cells };
        for (Index& id : item.ids)
        {
          id = id < 0 ? id : globalIds[id];
        }
        std::sort(item.ids.begin(), item.ids.end());
        facets.push_back(facet);
        shared.push_back(item);
      });
  }
  const std::vector<int> cells = cellsOnAllRanks(mpiOf(communicator), all.ranks(), shared);
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    if (cells[i] != 2)
    {
      mark(facets[i]);
    }
  }
  edges.mark(flags);
  all.either(flags.data());
  return flags;
}
}
