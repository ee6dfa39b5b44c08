// SPDX-License-Identifier: BSD-3-Clause
#include "FaceMesh.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Random.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace tautline
{
namespace
{
/// A list of points, in `nodes` from `first` on.
struct NodeList
{
  const Index* nodes;
  Index size;
};

NodeList listOf(const std::vector<Index>& offsets, const std::vector<Index>& nodes, Index i)
{
  return { nodes.data() + offsets[i], offsets[i + 1] - offsets[i] };
}

/// A hash that is independent of the order of the points and rarely equal for other points.
std::uint64_t keyOf(const NodeList& list)
{
  std::uint64_t key = 0;
  for (Index i = 0; i < list.size; ++i)
  {
    key += SplitMix::mixed(static_cast<std::uint64_t>(list.nodes[i]));
  }
  return key;
}

bool samePoints(const NodeList& a, const NodeList& b)
{
  return a.size == b.size && std::is_permutation(a.nodes, a.nodes + a.size, b.nodes);
}

/// Whether two lists of the same points run around the face in the same sense.
bool sameSense(const NodeList& a, const NodeList& b)
{
  const Index* at = std::find(b.nodes, b.nodes + b.size, a.nodes[0]);
  const Index next = (at - b.nodes + 1) % b.size;
  return b.nodes[next] == a.nodes[1];
}

/// Finds which listed faces and facets have the same points.
class FaceMatch
{
public:
  FaceMatch(Index points, const ListedFaces& cells, const ListedFacets& facets,
    const std::vector<FacePatch>& patches, int threads)
    : Cells(cells)
    , Facets(facets)
    , Patches(patches)
    , Listed(static_cast<Index>(cells.faceOffsets.size()) - 1)
    , Mate(this->Listed, -1)
    , Facet(this->Listed, -1)
    , ListedAt(facets.patch.size(), -1)
    , CellOf(this->Listed)
  {
    for (Index cell = 0; cell + 1 < static_cast<Index>(cells.cellOffsets.size()); ++cell)
    {
      pollInterruption(cell);
      std::fill(this->CellOf.begin() + cells.cellOffsets[cell],
        this->CellOf.begin() + cells.cellOffsets[cell + 1], cell);
    }
    this->file(points, threads);
    constexpr Index grain = 4096;
    parallelFor(points, grain, threads, [&](Index point) { this->matchAt(point); });
  }

  const std::vector<Index>& mates() const { return this->Mate; }
  /// Per listed face: the first facet there, or -1.
  const std::vector<Index>& facets() const { return this->Facet; }
  /// Per facet: a listed face there, or -1; for an internal face, either of its two.
  const std::vector<Index>& listed() const { return this->ListedAt; }
  const std::vector<Index>& cells() const { return this->CellOf; }

  /// The facets that are not faces of a cell.
  Index strayFacets() const { return std::count(this->ListedAt.begin(), this->ListedAt.end(), -1); }

  /// Throws Error where three cells share a face.
  void check() const
  {
    for (Index i = 0; i < this->Listed; ++i)
    {
      if (this->Mate[i] <= TooMany)
      {
        throw Error("A face of cell " + std::to_string(this->CellOf[i]) + " is one of cell " +
          std::to_string(this->CellOf[TooMany - this->Mate[i]]) +
          " and also of others: remove duplicate and overlapping cells. (ParaView's own reader of "
          "OpenFOAM cases makes such cells unless Decompose Polyhedra is off.)");
      }
    }
  }

private:
  /// Stored instead of a mate, minus the number of another face, if there are three or more.
  static constexpr Index TooMany = -2;

  struct Use
  {
    std::uint64_t key;
    Index number; ///< of a listed face, or of a facet after these
  };

  NodeList list(Index number) const
  {
    return number < this->Listed
      ? listOf(this->Cells.faceOffsets, this->Cells.nodes, number)
      : listOf(this->Facets.offsets, this->Facets.nodes, number - this->Listed);
  }

  /// Sorts all lists by their smallest points.
  void file(Index points, int threads)
  {
    const Index all = this->Listed + static_cast<Index>(this->Facets.patch.size());
    std::vector<Index> smallest(all);
    parallelFor(all, ChunkSize, threads,
      [&](Index i)
      {
        const NodeList nodes = this->list(i);
        smallest[i] = *std::min_element(nodes.nodes, nodes.nodes + nodes.size);
      });
    this->Starts.assign(points + 1, 0);
    for (Index i = 0; i < all; ++i)
    {
      pollInterruption(i);
      ++this->Starts[smallest[i] + 1];
    }
    std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
    std::vector<Index> next(this->Starts.begin(), this->Starts.end() - 1);
    this->Uses.resize(all);
    for (Index i = 0; i < all; ++i)
    {
      pollInterruption(i);
      this->Uses[next[smallest[i]]++] = { 0, i };
    }
  }

  void matchAt(Index point)
  {
    const auto begin = this->Uses.begin() + this->Starts[point];
    const auto end = this->Uses.begin() + this->Starts[point + 1];
    for (auto use = begin; use != end; ++use)
    {
      use->key = keyOf(this->list(use->number));
    }
    std::sort(begin, end,
      [](const Use& a, const Use& b)
      { return std::tie(a.key, a.number) < std::tie(b.key, b.number); });
    std::vector<Index> same;
    for (auto use = begin; use != end; ++use)
    {
      if (use->number < 0)
      {
        continue; // taken
      }
      same.assign(1, use->number);
      for (auto other = use + 1; other != end && other->key == use->key; ++other)
      {
        if (other->number >= 0 && samePoints(this->list(use->number), this->list(other->number)))
        {
          same.push_back(other->number);
          other->number = -1;
        }
      }
      this->join(same);
    }
  }

  /// Listed faces and, after them, facets that have the same points.
  void join(const std::vector<Index>& same)
  {
    const auto isListed = [this](Index number) { return number < this->Listed; };
    const Index listed = std::count_if(same.begin(), same.end(), isListed);
    const Index facets = static_cast<Index>(same.size()) - listed;
    if (listed == 0)
    {
      return;
    }
    // The two sides of a processor border that the cells have closed.
    const bool closed = listed == 2 &&
      std::all_of(same.begin() + listed, same.end(),
        [this](Index number)
        {
          const int patch = this->Facets.patch[number - this->Listed];
          return patch >= 0 && this->Patches[patch].type == "processor";
        });
    for (Index i = 0; i < facets; ++i)
    {
      // At a baffle, each cell has the facets that point out of it.
      const Index facet = same[listed + i] - this->Listed;
      const Index side = listed == 2 && facets > 1 && !closed && !this->pointsOut(same, i);
      this->ListedAt[facet] = same[side];
      if (listed <= 2 && !closed && this->Facet[same[side]] < 0 && (listed == 1 || facets > 1))
      {
        this->Facet[same[side]] = facet;
      }
    }
    if (listed > 2)
    {
      for (Index i = 0; i < listed; ++i)
      {
        this->Mate[same[i]] = TooMany - same[i == 0 ? 1 : 0];
      }
    }
    else if (listed == 2 && (facets < 2 || closed))
    {
      this->Mate[same[0]] = same[1];
      this->Mate[same[1]] = same[0];
    }
  }

  /// Whether a facet of a baffle, whose two cells come first, belongs to the first cell. Each cell
  /// gets one of two facets, for any orientation.
  bool pointsOut(const std::vector<Index>& same, Index facet) const
  {
    const bool second = facet == 1 && same.size() == 4;
    return sameSense(this->list(same[0]), this->list(same[second ? 2 : 2 + facet])) != second;
  }

  const ListedFaces& Cells;
  const ListedFacets& Facets;
  const std::vector<FacePatch>& Patches;
  Index Listed;
  std::vector<Index> Mate, Facet; ///< per listed face
  std::vector<Index> ListedAt;    ///< per facet
  std::vector<Index> CellOf;      ///< per listed face
  std::vector<Index> Starts;      ///< of each point in Uses
  std::vector<Use> Uses;
};

void append(FaceMesh& mesh, const NodeList& list, Index owner)
{
  mesh.nodes.insert(mesh.nodes.end(), list.nodes, list.nodes + list.size);
  mesh.offsets.push_back(static_cast<Index>(mesh.nodes.size()));
  mesh.owner.push_back(owner);
}

/// A face of the boundary: a listed face, and a facet or -1.
struct OuterFace
{
  Index listed, facet;
};

/// The boundary faces: patch by patch in the order of the facets, then faces without a facet. Two
/// patches, one of which slides, may both have a facet at a face.
std::vector<std::vector<OuterFace>> boundaryOf(
  const FaceMatch& match, const ListedFacets& facets, const std::vector<FacePatch>& patches)
{
  std::vector<std::vector<OuterFace>> lists(patches.size() + 1);
  for (std::size_t i = 0; i < match.mates().size(); ++i)
  {
    const Index facet = match.facets()[i];
    if (match.mates()[i] < 0 && (facet < 0 || facets.patch[facet] < 0))
    {
      lists.back().push_back({ static_cast<Index>(i), facet });
    }
  }
  for (std::size_t i = 0; i < facets.patch.size(); ++i)
  {
    const auto facet = static_cast<Index>(i);
    const Index listed = match.listed()[i];
    if (listed < 0 || match.mates()[listed] >= 0 || facets.patch[i] < 0)
    {
      continue;
    }
    const Index first = match.facets()[listed];
    const int patch = facets.patch[i], other = facets.patch[first];
    if (first == facet ||
      (other >= 0 && patch != other && patches[patch].isPartly() != patches[other].isPartly()))
    {
      lists[patch].push_back({ listed, facet });
    }
  }
  return lists;
}

void coupleCyclic(FaceMesh& mesh)
{
  mesh.partner.assign(mesh.faces() - mesh.internalFaces, -1);
  const int patches = static_cast<int>(mesh.patches.size());
  for (FacePatch& patch : mesh.patches)
  {
    patch.partner = patch.partner < patches ? patch.partner : -1;
    const bool coupled = patch.partner >= 0 && mesh.patches[patch.partner].count == patch.count;
    for (Index i = 0; i < patch.count && coupled; ++i)
    {
      mesh.partner[patch.first + i - mesh.internalFaces] = mesh.patches[patch.partner].first + i;
    }
  }
}

void listCellFaces(FaceMesh& mesh)
{
  mesh.cellOffsets.assign(mesh.cells + 1, 0);
  const auto forEachUse = [&](const auto& use)
  {
    for (Index face = 0; face < mesh.faces(); ++face)
    {
      pollInterruption(face);
      use(mesh.owner[face], face);
      if (mesh.internal(face))
      {
        use(mesh.neighbor[face], face);
      }
    }
  };
  forEachUse([&](Index cell, Index) { ++mesh.cellOffsets[cell + 1]; });
  std::partial_sum(mesh.cellOffsets.begin(), mesh.cellOffsets.end(), mesh.cellOffsets.begin());
  mesh.cellFaces.resize(mesh.cellOffsets.back());
  std::vector<Index> next(mesh.cellOffsets.begin(), mesh.cellOffsets.end() - 1);
  forEachUse([&](Index cell, Index face) { mesh.cellFaces[next[cell]++] = face; });
}
}

//------------------------------------------------------------------------------
FaceMesh findFaces(Index points, const ListedFaces& cells, const ListedFacets& facets,
  std::vector<FacePatch> patches, int threads)
{
  const FaceMatch match(points, cells, facets, patches, threads);
  match.check();
  FaceMesh mesh;
  mesh.points = points;
  mesh.cells = static_cast<Index>(cells.cellOffsets.size()) - 1;
  mesh.strayFacets = match.strayFacets();

  // Sort by owner, then by neighbor, then in the order of the owner's list.
  std::vector<std::pair<Index, Index>> ofCell;
  for (Index cell = 0; cell < mesh.cells; ++cell)
  {
    pollInterruption(cell);
    ofCell.clear();
    for (Index i = cells.cellOffsets[cell]; i < cells.cellOffsets[cell + 1]; ++i)
    {
      const Index mate = match.mates()[i];
      if (mate >= 0 && match.cells()[mate] > cell)
      {
        ofCell.emplace_back(match.cells()[mate], i);
      }
      else if (mate >= 0 && match.cells()[mate] == cell)
      {
        throw Error("Cell " + std::to_string(cell) + " lists a face twice: remove the cell.");
      }
    }
    std::sort(ofCell.begin(), ofCell.end());
    for (const auto& [neighbor, listed] : ofCell)
    {
      append(mesh, listOf(cells.faceOffsets, cells.nodes, listed), cell);
      mesh.neighbor.push_back(neighbor);
      // Start at the smallest point, for any starting point in a file or a piece.
      const auto first = mesh.nodes.begin() + mesh.offsets[mesh.faces() - 1];
      std::rotate(first, std::min_element(first, mesh.nodes.end()), mesh.nodes.end());
    }
  }
  mesh.internalFaces = mesh.faces();

  const auto lists = boundaryOf(match, facets, patches);
  if (!lists.back().empty())
  {
    patches.emplace_back();
    patches.back().name = "boundary";
  }
  mesh.patches = std::move(patches);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
  {
    mesh.patches[p].first = mesh.faces();
    mesh.patches[p].count = static_cast<Index>(lists[p].size());
    for (const auto& [listed, facet] : lists[p])
    {
      // A facet begins with the point that corresponds to the first point of the coupled face.
      const NodeList ofCell = listOf(cells.faceOffsets, cells.nodes, listed);
      const NodeList given = facet >= 0 ? listOf(facets.offsets, facets.nodes, facet) : ofCell;
      append(mesh, sameSense(ofCell, given) ? given : ofCell, match.cells()[listed]);
      mesh.facet.push_back(facet);
    }
  }
  coupleCyclic(mesh);
  listCellFaces(mesh);
  return mesh;
}

namespace
{
/// Flags the boundary faces in the two extreme planes perpendicular to an axis; empty if these
/// planes do not contain all points, or if a cell does not have one face in each.
std::vector<char> findSides(
  const FaceMesh& mesh, const double* points, const FaceExtent& box, int axis)
{
  constexpr double tolerance = 1e-9; // of the largest extent
  const Vec3 extent = box.high - box.low;
  const double slack = tolerance * std::max({ extent[0], extent[1], extent[2] });
  const auto isLow = [&](Index node) { return points[3 * node + axis] <= box.low[axis] + slack; };
  const auto isHigh = [&](Index node) { return points[3 * node + axis] >= box.high[axis] - slack; };
  const bool flat = extent[axis] > 2 * slack &&
    std::all_of(mesh.nodes.begin(), mesh.nodes.end(),
      [&](Index node) { return isLow(node) || isHigh(node); });
  if (!flat)
  {
    return {};
  }
  std::vector<char> side(mesh.faces(), 0);
  std::vector<std::array<int, 2>> counts(mesh.cells, { 0, 0 });
  for (Index face = mesh.internalFaces; face < mesh.faces(); ++face)
  {
    const auto begin = mesh.nodes.begin() + mesh.offsets[face];
    const auto end = mesh.nodes.begin() + mesh.offsets[face + 1];
    const bool below = std::all_of(begin, end, isLow), above = std::all_of(begin, end, isHigh);
    counts[mesh.owner[face]][0] += below;
    counts[mesh.owner[face]][1] += above;
    side[face] = below || above;
  }
  const bool all = std::all_of(counts.begin(), counts.end(),
    [](const std::array<int, 2>& count) { return count[0] == 1 && count[1] == 1; });
  return all ? side : std::vector<char>();
}
}

//------------------------------------------------------------------------------
bool isLayer(const FaceMesh& mesh, const double* points, const FaceExtent& extent, int axis)
{
  return mesh.cells == 0 || !findSides(mesh, points, extent, axis).empty();
}

//------------------------------------------------------------------------------
void markLayer(FaceMesh& mesh, const double* points, const FaceExtent& extent, int axis)
{
  std::vector<char> side = findSides(mesh, points, extent, axis);
  side.resize(mesh.faces(), 0); // for a piece without cells
  // The sides come first, each part in its original order.
  std::vector<Index> order;
  for (const bool ofSides : { true, false })
  {
    for (Index face = mesh.internalFaces; face < mesh.faces(); ++face)
    {
      if ((side[face] != 0) == ofSides)
      {
        order.push_back(face);
      }
    }
  }
  const FaceMesh before = mesh;
  mesh.nodes.resize(mesh.offsets[mesh.internalFaces]);
  mesh.offsets.resize(mesh.internalFaces + 1);
  mesh.owner.resize(mesh.internalFaces);
  mesh.facet.clear();
  for (Index face : order)
  {
    append(mesh, listOf(before.offsets, before.nodes, face), before.owner[face]);
    mesh.facet.push_back(before.facet[face - before.internalFaces]);
  }
  FacePatch empty, rest;
  empty.name = "sides of the layer";
  empty.type = "empty";
  empty.first = mesh.internalFaces;
  empty.count = std::count(side.begin(), side.end(), 1);
  rest.name = "boundary";
  rest.first = empty.first + empty.count;
  rest.count = mesh.faces() - rest.first;
  mesh.patches = { empty, rest };
  coupleCyclic(mesh);
  listCellFaces(mesh);
}
}
