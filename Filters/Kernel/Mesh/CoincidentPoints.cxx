// SPDX-License-Identifier: BSD-3-Clause
#include "CoincidentPoints.h"

#include "CellCopies.h"
#include "CornerPoints.h"
#include "tautline/Core/CountingSort.h"
#include "tautline/Core/Random.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
std::uint64_t hashOf(const std::array<std::uint64_t, 3>& key)
{
  std::uint64_t hash = SplitMix::Increment;
  for (std::uint64_t part : key)
  {
    hash = SplitMix::hash(hash + part);
  }
  return hash;
}

/// The bits of the coordinates; -0 has the bits of 0.
std::array<std::uint64_t, 3> placeOf(const MeshView& view, Index point)
{
  std::array<std::uint64_t, 3> bits;
  for (int c = 0; c < 3; ++c)
  {
    const double x = view.points[3 * point + c] + 0.0;
    std::memcpy(&bits[c], &x, sizeof x);
  }
  return bits;
}

/// Ids stored by keys that a function computes from an id: open addressing, linear probing. Keys
/// are compared only where the leading bits of their hashes are equal.
class IdTable
{
public:
  explicit IdTable(Index count)
  {
    std::size_t size = 16;
    // At most half of the slots are used, so that probe sequences stay short.
    while (size < 2 * static_cast<std::size_t>(count))
    {
      size *= 2;
    }
    this->Slots.assign(size, empty);
  }

  /// The stored id with an equal key, or this id, which is then stored.
  template <class Key, class KeyOf>
  Index insert(Index id, const Key& key, const KeyOf& keyOf)
  {
    const std::uint64_t hash = hashOf(key);
    std::uint64_t& slot = this->Slots[this->slotOf(hash, key, keyOf)];
    slot = slot == empty ? ((hash & tag) | static_cast<std::uint64_t>(id)) : slot;
    return idIn(slot);
  }

  /// The stored id with an equal key, or -1.
  template <class Key, class KeyOf>
  Index find(const Key& key, const KeyOf& keyOf) const
  {
    const std::uint64_t slot = this->Slots[this->slotOf(hashOf(key), key, keyOf)];
    return slot == empty ? -1 : idIn(slot);
  }

private:
  static constexpr int idBits = 44; // more than memory has points
  static constexpr std::uint64_t tag = ~std::uint64_t(0) << idBits;
  static constexpr std::uint64_t empty = ~std::uint64_t(0);

  static Index idIn(std::uint64_t slot) { return static_cast<Index>(slot & ~tag); }

  /// The slot with an equal key, otherwise an empty slot.
  template <class Key, class KeyOf>
  std::size_t slotOf(std::uint64_t hash, const Key& key, const KeyOf& keyOf) const
  {
    const std::size_t mask = this->Slots.size() - 1;
    std::size_t slot = hash & mask;
    while (this->Slots[slot] != empty &&
      (((this->Slots[slot] ^ hash) & tag) != 0 || keyOf(idIn(this->Slots[slot])) != key))
    {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  std::vector<std::uint64_t> Slots; ///< the leading bits of the hash, then the id
};

bool isFinite(const MeshView& view, Index point)
{
  const double* p = view.points + 3 * point;
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// One flag per point: nonzero for a finite corner of a supported cell.
std::vector<char> usedPoints(const Mesh& mesh, int threads)
{
  const MeshView& view = mesh.view();
  std::vector<char> used = cornerPoints(mesh, 0, threads);
  for (Index p = 0; mesh.nonFinitePoints() > 0 && p < view.numberOfPoints; ++p)
  {
    used[p] = used[p] && isFinite(view, p);
  }
  return used;
}

/// The locations of coincident points.
struct Places
{
  std::vector<Index> of;     ///< per point: the smallest point at its location
  std::vector<char> several; ///< per point: whether others coincide with it
  bool any = false;
};

/// Whether any of the used points coincide. Each part processes the points whose hashes belong to
/// it: coincident points belong to the same part.
bool anyAtOnePlace(const MeshView& view, const std::vector<char>& used, Index count, int threads)
{
  constexpr int PartBit = 32; // of the hash: the table uses the bits below and above
  const Index parts = numberOfParts(count, threads);
  const auto keyOf = [&view](Index point) { return placeOf(view, point); };
  std::atomic<bool> found{ false };
  parallelFor(parts, 1, threads,
    [&](Index part)
    {
      IdTable table(count / parts);
      for (Index p = 0; p < view.numberOfPoints && !found; ++p)
      {
        pollInterruption(p);
        if (!used[p])
        {
          continue;
        }
        const auto key = keyOf(p);
        const std::uint64_t hash = hashOf(key);
        if (static_cast<Index>((hash >> PartBit) % parts) == part &&
          table.insert(p, key, keyOf) != p)
        {
          found = true;
        }
      }
    });
  return found;
}

Places findPlaces(const Mesh& mesh, int threads)
{
  const MeshView& view = mesh.view();
  const std::vector<char> used = usedPoints(mesh, threads);
  Places places;
  const Index count = std::count(used.begin(), used.end(), 1);
  // In most meshes no points coincide: this test in parallel then avoids the sequential search
  // below.
  if (numberOfParts(count, threads) > 1 && !anyAtOnePlace(view, used, count, threads))
  {
    return places;
  }
  IdTable table(count);
  const auto keyOf = [&view](Index point) { return placeOf(view, point); };
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index same = used[p] ? table.insert(p, keyOf(p), keyOf) : p;
    // Most meshes have no coincident points, so the arrays are only created for the first one.
    if (same != p && !places.any)
    {
      places.any = true;
      places.several.assign(view.numberOfPoints, 0);
      places.of.resize(view.numberOfPoints);
      std::iota(places.of.begin(), places.of.end(), Index(0));
    }
    if (same != p)
    {
      places.of[p] = same;
      places.several[p] = places.several[same] = 1;
    }
  }
  return places;
}

using FacetNodes = std::array<Index, MaxFaceNodes>;

/// A use of a facet with a point that coincides with others.
struct SidedFacet
{
  FacetNodes places; ///< in increasing order; a missing one is -1 and first
  FacetNodes nodes;  ///< in the order of their places
  Index cell;
  bool forward;    ///< the direction in which the cell traverses it, by its locations
  bool collapsing; ///< whether it has a location where a cell has two points
};

/// The facet of a cell, and its orientation, by locations.
SidedFacet seamFacet(const Index* nodes, int size, Index cell, const Places& places)
{
  SidedFacet facet;
  facet.places.fill(-1);
  facet.nodes.fill(-1);
  facet.cell = cell;
  std::array<std::pair<Index, Index>, MaxFaceNodes> sorted;
  int smallest = 0;
  for (int k = 0; k < size; ++k)
  {
    sorted[k] = { places.of[nodes[k]], nodes[k] };
    smallest = sorted[k].first < sorted[smallest].first ? k : smallest;
  }
  // For an edge, whether its smallest node comes first; for a face, which neighbor of its smallest
  // node follows it.
  const Index next = sorted[(smallest + 1) % size].first;
  const Index previous = sorted[(smallest + size - 1) % size].first;
  facet.forward = size == 2 ? smallest == 0 : next < previous;
  for (int k = 1; k < size; ++k)
  {
    for (int j = k; j > 0 && sorted[j] < sorted[j - 1]; --j)
    {
      std::swap(sorted[j], sorted[j - 1]);
    }
  }
  for (int k = 0; k < size; ++k)
  {
    facet.places[MaxFaceNodes - size + k] = sorted[k].first;
    facet.nodes[MaxFaceNodes - size + k] = sorted[k].second;
  }
  return facet;
}

/// The facets of cells of the mesh dimension, except ghosts, with a point that coincides with
/// others; marks the locations where a cell has two points.
std::vector<SidedFacet> seamFacets(
  const Mesh& mesh, const Places& places, const unsigned char* ghosts, std::vector<char>& collapses)
{
  const MeshView& view = mesh.view();
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  std::vector<SidedFacet> facets;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    const int count = t.dimension == 3 ? t.faces : t.edges;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      if ((ghosts && ghosts[cell]) ||
        std::none_of(node, node + t.nodes, [&](Index p) { return places.several[p] != 0; }))
      {
        continue;
      }
      for (int a = 0; a < t.nodes; ++a)
      {
        for (int b = 0; places.several[node[a]] && b < a; ++b)
        {
          if (node[a] != node[b] && places.of[node[a]] == places.of[node[b]])
          {
            collapses[places.of[node[a]]] = 1;
          }
        }
      }
      for (int f = 0; t.dimension == dimension && f < count; ++f)
      {
        const int size = dimension == 3 ? t.faceSizes[f] : 2;
        const int* member = dimension == 3 ? t.faceNodes[f].data() : t.edgeNodes[f].data();
        if (std::any_of(member, member + size, [&](int k) { return places.several[node[k]] != 0; }))
        {
          Index nodes[MaxFaceNodes];
          std::transform(member, member + size, nodes, [node](int k) { return node[k]; });
          facets.push_back(seamFacet(nodes, size, cell, places));
        }
      }
    }
  }
  return facets;
}

/// The corners of a cell by their locations.
struct CellAtPlace
{
  std::array<std::pair<Index, Index>, MaxNodes> corners; ///< place and node, in increasing order
  bool ghost;
  Index cell;

  bool samePlaces(const CellAtPlace& other) const
  {
    return std::equal(this->corners.begin(), this->corners.end(), other.corners.begin(),
      [](const auto& a, const auto& b) { return a.first == b.first; });
  }
  bool operator<(const CellAtPlace& other) const
  {
    for (int k = 0; k < MaxNodes; ++k)
    {
      if (this->corners[k].first != other.corners[k].first)
      {
        return this->corners[k].first < other.corners[k].first;
      }
    }
    return this->ghost != other.ghost ? other.ghost : this->cell < other.cell;
  }
};

/// The cells with a point that coincides with others, grouped by location; cells that are not
/// ghosts come first.
std::vector<CellAtPlace> cellsByPlace(
  const Mesh& mesh, const Places& places, const unsigned char* ghosts)
{
  const MeshView& view = mesh.view();
  std::vector<CellAtPlace> cells;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      if (std::any_of(node, node + t.nodes, [&](Index p) { return places.several[p] != 0; }))
      {
        CellAtPlace found = { {}, ghosts[cell] != 0, cell };
        found.corners.fill({ -1, -1 });
        for (int k = 0; k < t.nodes; ++k)
        {
          found.corners[k] = { places.of[node[k]], node[k] };
        }
        std::sort(found.corners.begin(), found.corners.end());
        cells.push_back(found);
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// Processes the uses of coincident facets.
class SeamJoiner
{
public:
  explicit SeamJoiner(const Mesh& mesh)
    : Sided(mesh.dimension() != Dimension::Surface)
    , Points(mesh.view().numberOfPoints)
    , Seams(mesh.view().numberOfPoints)
    , OnSeam(mesh.view().numberOfPoints, 0)
  {
  }

  /// Joins the points of two coincident boundary facets, or counts the reason why they stay
  /// separate.
  void visit(const SidedFacet* uses, Index count)
  {
    // Uses of the same nodes are adjacent: two uses form an interior facet.
    std::array<const SidedFacet*, 2> boundary = {};
    Index facets = 0;
    for (Index i = 0; i < count;)
    {
      Index j = i + 1;
      while (j < count && uses[j].nodes == uses[i].nodes)
      {
        ++j;
      }
      if (facets < 2)
      {
        boundary[facets] = j == i + 1 ? &uses[i] : nullptr;
      }
      ++facets;
      i = j;
    }
    if (facets < 2)
    {
      return;
    }
    // Only the first reason that applies is counted.
    Index& reason = uses->collapsing                         ? this->Found.collapsing
      : facets > 2 || !boundary[0] || !boundary[1]           ? this->Found.crowded
      : this->Sided && uses->forward == boundary[1]->forward ? this->Found.overlapping
                                                             : this->Found.facets;
    ++reason;
    if (&reason == &this->Found.facets)
    {
      this->join(boundary[0]->nodes, boundary[1]->nodes);
      return;
    }
    for (Index point : uses->nodes)
    {
      if (point >= 0 && (this->Found.firstApart < 0 || point < this->Found.firstApart))
      {
        this->Found.firstApart = point;
      }
    }
  }

  /// Joins the points of ghosts with the points of the cells of which they are copies.
  void joinGhosts(const Mesh& mesh, const Places& places, const unsigned char* ghosts)
  {
    const std::vector<CellAtPlace> cells = cellsByPlace(mesh, places, ghosts);
    for (std::size_t i = 0, first = 0; i < cells.size(); ++i)
    {
      // If any cell of a group is not a ghost, the first one is not.
      first = cells[i].samePlaces(cells[first]) ? first : i;
      for (int k = 0; cells[i].ghost && k < MaxNodes; ++k)
      {
        if (cells[i].corners[k].first >= 0)
        {
          this->Points.join(cells[first].corners[k].second, cells[i].corners[k].second);
        }
      }
    }
    // A ghost whose cell is elsewhere may have points that another piece has.
    std::vector<char> ofOwn(this->OnSeam.size(), 0);
    for (const CellAtPlace& cell : cells)
    {
      for (int k = 0; !cell.ghost && k < MaxNodes; ++k)
      {
        if (cell.corners[k].first >= 0)
        {
          ofOwn[cell.corners[k].second] = 1;
        }
      }
    }
    constexpr Index None = -1, Ambiguous = -2;
    // the point that all ghosts at a location get
    std::vector<Index> pointAt(this->OnSeam.size(), None);
    const auto count = static_cast<Index>(places.several.size());
    // First the points of cells that are not ghosts, then the others, which join them if the choice
    // is unique.
    for (const char own : { 1, 0 })
    {
      for (Index p = 0; p < count; ++p)
      {
        Index& point = pointAt[places.of[p]];
        if (!places.several[p] || ofOwn[p] != own)
        {
          continue;
        }
        if (point == None)
        {
          point = p;
        }
        else if (own && point != Ambiguous)
        {
          point = this->Points.find(point) == this->Points.find(p) ? point : Ambiguous;
        }
        else if (!own && point != Ambiguous)
        {
          this->Points.join(point, p);
        }
      }
    }
    this->Ghosts = true;
  }

  /// Joins the points of the 2D cells of a volume mesh with the points of the 3D cells.
  void joinSurface(const Mesh& mesh, const Places& places)
  {
    const std::vector<char> ofElement = cornerPoints(mesh, 3, 1);
    constexpr Index None = -1, Ambiguous = -2;
    const auto count = static_cast<Index>(places.several.size());
    std::vector<Index> pointAt(places.several.size(), None);
    for (Index p = 0; p < count; ++p)
    {
      Index& point = pointAt[places.of[p]];
      if (places.several[p] && ofElement[p] && point != Ambiguous)
      {
        // If different points of elements coincide here, the choice is ambiguous.
        const bool same = point == None || this->Points.find(point) == this->Points.find(p);
        point = !same ? Ambiguous : point == None ? p : point;
      }
    }
    for (Index p = 0; p < count; ++p)
    {
      const Index point = places.several[p] && !ofElement[p] ? pointAt[places.of[p]] : None;
      if (point >= 0)
      {
        this->Points.join(point, p);
        this->Ghosts = true;
      }
    }
  }

  CoincidentPoints finish()
  {
    const Index points = static_cast<Index>(this->OnSeam.size());
    if (this->Found.facets > 0 || this->Ghosts)
    {
      this->Found.representative.resize(points);
      for (Index p = 0; p < points; ++p)
      {
        const Index one = this->Points.find(p);
        this->Found.representative[p] = one;
        this->Found.merged += one != p;
        this->Found.first = this->Found.first < 0 && one != p ? p : this->Found.first;
        this->Found.seams += this->OnSeam[p] && this->Seams.find(p) == p;
      }
    }
    if (this->Found.merged == 0)
    {
      this->Found.representative.clear();
    }
    return std::move(this->Found);
  }

private:
  void join(const FacetNodes& a, const FacetNodes& b)
  {
    for (int k = 0; k < MaxFaceNodes; ++k)
    {
      if (a[k] < 0)
      {
        continue;
      }
      this->Points.join(a[k], b[k]);
      // All points of both facets belong to one seam, so that connected seams are counted once.
      this->Seams.join(a[MaxFaceNodes - 1], a[k]);
      this->Seams.join(a[MaxFaceNodes - 1], b[k]);
      this->OnSeam[a[k]] = this->OnSeam[b[k]] = 1;
    }
  }

  bool Sided;
  UnionFind Points, Seams;
  std::vector<char> OnSeam;
  bool Ghosts = false; ///< whether points off the seams were joined
  CoincidentPoints Found;
};
}

//------------------------------------------------------------------------------
CoincidentPoints findCoincidentPoints(const Mesh& mesh, const unsigned char* reversed, int threads,
  const unsigned char* ghosts, std::vector<unsigned char>* copies)
{
  const Places places = findPlaces(mesh, threads);
  if (copies)
  {
    copies->clear();
  }
  if (!places.any)
  {
    return {};
  }
  std::vector<unsigned char> apart; // ghosts and copies
  if (copies)
  {
    *copies = findCopies(mesh, places.of, places.several, reversed, ghosts);
    // Copies of cells are treated like ghosts, so that they form no seams.
    if (!copies->empty())
    {
      apart = *copies;
      for (std::size_t cell = 0; ghosts && cell < apart.size(); ++cell)
      {
        apart[cell] |= ghosts[cell];
      }
      ghosts = apart.data();
    }
  }
  std::vector<char> collapses(mesh.view().numberOfPoints, 0);
  std::vector<SidedFacet> facets = seamFacets(mesh, places, ghosts, collapses);
  for (SidedFacet& facet : facets)
  {
    facet.collapsing = std::any_of(facet.places.begin(), facet.places.end(),
      [&collapses](Index place) { return place >= 0 && collapses[place]; });
    facet.forward = facet.forward != (reversed && reversed[facet.cell]);
  }
  // Facets at the same places become adjacent and, among these, the uses of the same nodes.
  std::sort(facets.begin(), facets.end(),
    [](const SidedFacet& a, const SidedFacet& b)
    {
      return a.places != b.places ? a.places < b.places
        : a.nodes != b.nodes      ? a.nodes < b.nodes
                                  : a.cell < b.cell;
    });
  SeamJoiner joiner(mesh);
  for (std::size_t i = 0; i < facets.size();)
  {
    std::size_t j = i + 1;
    while (j < facets.size() && facets[j].places == facets[i].places)
    {
      ++j;
    }
    joiner.visit(&facets[i], static_cast<Index>(j - i));
    i = j;
  }
  if (ghosts)
  {
    joiner.joinGhosts(mesh, places, ghosts);
  }
  if (copies && mesh.dimension() == Dimension::Volume)
  {
    joiner.joinSurface(mesh, places);
  }
  CoincidentPoints result = joiner.finish();
  result.copies = copies ? std::count(copies->begin(), copies->end(), 1) : 0;
  return result;
}

//------------------------------------------------------------------------------
Index countForeignCells(const Mesh& mesh, const unsigned char* ghosts)
{
  Places places = findPlaces(mesh, 1);
  if (!places.any)
  {
    places.of.resize(mesh.view().numberOfPoints);
    std::iota(places.of.begin(), places.of.end(), Index(0));
  }
  places.several.assign(mesh.view().numberOfPoints, 1); // so that all cells are listed
  const std::vector<CellAtPlace> cells = cellsByPlace(mesh, places, ghosts);
  Index foreign = 0;
  for (std::size_t i = 0, first = 0; i < cells.size(); ++i)
  {
    first = cells[i].samePlaces(cells[first]) ? first : i;
    foreign += cells[first].ghost;
  }
  return foreign;
}

namespace
{
/// The length of the shortest edge between flagged points, above 0; infinite if there is none.
double shortestEdge(const Mesh& mesh, const std::vector<char>& flags)
{
  const MeshView& view = mesh.view();
  double shortest = std::numeric_limits<double>::infinity();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      bool flagged[MaxNodes];
      std::transform(node, node + t.nodes, flagged, [&flags](Index p) { return flags[p] != 0; });
      for (int e = 0; e < t.edges; ++e)
      {
        const int a = t.edgeNodes[e][0], b = t.edgeNodes[e][1];
        if (flagged[a] && flagged[b])
        {
          const double length = norm(pointOf(view, node[a]) - pointOf(view, node[b]));
          shortest = length > 0 ? std::min(shortest, length) : shortest;
        }
      }
    }
  }
  return shortest;
}

/// Whether two points are of a common cell.
bool neighbors(const Mesh& mesh, VertexCells& around, Index a, Index b)
{
  const MeshView& view = mesh.view();
  if (around.offsets.empty())
  {
    around = mesh.vertexCells(); // usually, no points are near
  }
  return std::any_of(around.cells.begin() + around.offsets[a],
    around.cells.begin() + around.offsets[a + 1],
    [&](Index cell)
    {
      const Index* node = view.connectivity + view.offsets[cell];
      const Index* end = view.connectivity + view.offsets[cell + 1];
      return std::find(node, end, b) != end;
    });
}
}

//------------------------------------------------------------------------------
Index countNearPoints(
  const Mesh& mesh, const std::vector<char>& boundary, Index* first, double tolerance)
{
  constexpr double LargestIndex = 1e15; // of a box of the grid; above it, boxes are not exact
  const MeshView& view = mesh.view();
  std::vector<char> flags = boundary;
  for (Index p = 0; mesh.nonFinitePoints() > 0 && p < view.numberOfPoints; ++p)
  {
    flags[p] = flags[p] && isFinite(view, p);
  }
  const double distance = tolerance * shortestEdge(mesh, flags);
  if (!(distance > 0) || !std::isfinite(distance))
  {
    return 0;
  }
  // Boxes twice as wide as the distance: only points in eight boxes can be near a point.
  const double width = 2 * distance;
  using Box = std::array<std::uint64_t, 3>;
  const auto boxOf = [&](const Vec3& p)
  {
    Box box;
    std::transform(p.begin(), p.end(), box.begin(),
      [&](double x)
      { return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / width))); });
    return box;
  };
  const auto keyOf = [&](Index point) { return boxOf(pointOf(view, point)); };
  // The points of a box form a list that begins at the stored one.
  std::vector<Index> next(view.numberOfPoints, -1);
  IdTable table(std::count(flags.begin(), flags.end(), 1));
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (flags[p])
    {
      const Vec3 x = pointOf(view, p);
      if (std::max({ std::abs(x[0]), std::abs(x[1]), std::abs(x[2]) }) / width > LargestIndex)
      {
        return 0; // the distance is below the resolution of the coordinates
      }
      const Index head = table.insert(p, keyOf(p), keyOf);
      if (head != p)
      {
        next[p] = next[head];
        next[head] = p;
      }
    }
  }
  VertexCells around;
  Index near = 0;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Vec3 x = pointOf(view, p);
    bool found = false;
    for (int corner = 0; flags[p] && !found && corner < 8; ++corner)
    {
      const Box box = boxOf({ x[0] + (corner & 1 ? distance : -distance),
        x[1] + (corner & 2 ? distance : -distance), x[2] + (corner & 4 ? distance : -distance) });
      for (Index q = table.find(box, keyOf); q >= 0 && !found; q = next[q])
      {
        // Points of a common cell may be this close.
        const double apart = norm(pointOf(view, q) - x);
        found = apart > 0 && apart <= distance && !neighbors(mesh, around, p, q);
      }
    }
    if (found && near++ == 0 && first)
    {
      *first = p;
    }
  }
  return near;
}
}
