// SPDX-License-Identifier: BSD-3-Clause
// The plane and the orientation of a mesh in pieces on ranks.
#include "RankPieces.h"

#include "FacetTable.h"
#include "PartSign.h"
#include "PlaneSearch.h"
#include "PointKey.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// Sums and maxima over the ranks.
struct RankTotals
{
  RankGroup& group;
  double sum(double value) { return this->group.orderlessSum({ value }); }
  double maximum(double value) { return this->group.maximum(value); }
};

/// A facet on the boundary of a piece.
struct SeamFacet
{
  PointKey key;       ///< of the point with the smallest key
  std::uint64_t hash; ///< of all points
  Index part;
  bool forward; ///< the sense in which its cell walks round it

  bool operator<(const SeamFacet& other) const
  {
    return this->key != other.key ? this->key < other.key : this->hash < other.hash;
  }
};

/// What is known of a connected part of the mesh.
struct SignedPart
{
  Index label;
  PartSign sign;
};

/**
 * @class SeamedParts
 * @brief The connected parts of the pieces of this rank, joined with those of others across facets.
 */
class SeamedParts
{
public:
  SeamedParts(RankGroup& group, const std::vector<RankPiece>& pieces, int dimension)
    : Group(group)
    , Pieces(pieces)
    , Dimension(dimension)
  {
  }

  void find(const std::vector<const signed char*>& validity, bool haveSigns);
  Index disagreeing() { return this->Group.sum(this->Disagreeing); }
  void count(double sign, Orientation& result);

private:
  void addPiece(std::size_t number, const signed char* validity, bool haveSigns);
  void addSeam(const RankPiece& piece, Index smallest, const FacetUse& use, Index part);
  void join();
  Vec3 commonOrigin();

  RankGroup& Group;
  const std::vector<RankPiece>& Pieces;
  int Dimension;
  Vec3 Origin = { 0, 0, 0 };
  Index Disagreeing = 0;
  std::vector<PartSign> Signs; ///< of the parts of this rank
  std::vector<Index> Labels;   ///< of them: the number of the first part that each is joined with
  std::vector<SeamFacet> Seams;
};

//------------------------------------------------------------------------------
/// A point that all ranks measure sizes from.
Vec3 SeamedParts::commonOrigin()
{
  std::vector<Vec3> own;
  for (const RankPiece& piece : this->Pieces)
  {
    if (own.empty() && piece.mesh->view().numberOfPoints > 0)
    {
      own.push_back(finitePoint(piece.mesh->view()));
    }
  }
  for (const std::vector<Vec3>& list : this->Group.gatherItems(own))
  {
    if (!list.empty() && std::isfinite(dot(list[0], list[0])))
    {
      return list[0];
    }
  }
  return { 0, 0, 0 };
}

//------------------------------------------------------------------------------
/// Notes a facet that one cell of a piece has.
void SeamedParts::addSeam(const RankPiece& piece, Index smallest, const FacetUse& use, Index part)
{
  // The points in the order in which the cell walks round the facet.
  std::array<Index, MaxFaceNodes> nodes = { smallest, use.others[0], -1, -1 };
  int size = 2;
  if (use.others[1] >= 0)
  {
    const Index next = use.others[use.forward ? 0 : 1], previous = use.others[use.forward ? 1 : 0];
    size = use.others[2] >= 0 ? 4 : 3;
    nodes = { smallest, next, size == 4 ? use.others[2] : previous, size == 4 ? previous : -1 };
  }
  else if (!use.forward)
  {
    std::swap(nodes[0], nodes[1]);
  }
  std::array<PointKey, MaxFaceNodes> keys;
  int first = 0;
  for (int k = 0; k < size; ++k)
  {
    keys[k] = keyOfPoint(piece, nodes[k]);
    first = keys[k] < keys[first] ? k : first;
  }
  SeamFacet facet = { keys[first], 0, part, first == 0 };
  if (size > 2)
  {
    facet.forward = keys[(first + 1) % size] < keys[(first + size - 1) % size];
  }
  std::sort(keys.begin(), keys.begin() + size);
  for (int k = 0; k < size; ++k)
  {
    facet.hash = addToHash(facet.hash, hashOf(keys[k]));
  }
  this->Seams.push_back(facet);
}

//------------------------------------------------------------------------------
/// The connected parts of a piece.
void SeamedParts::addPiece(std::size_t number, const signed char* validity, bool haveSigns)
{
  const RankPiece& piece = this->Pieces[number];
  const Mesh& mesh = *piece.mesh;
  const MeshView& view = mesh.view();
  UnionFind sets(view.numberOfCells);
  struct OpenFacet
  {
    Index smallest;
    FacetUse use;
  };
  std::vector<OpenFacet> open;
  FacetTable(mesh, piece.ghosts)
    .forEachFacet(
      [&](Index smallest, const FacetUse* uses, Index count)
      {
        if (count == 2)
        {
          this->Disagreeing += uses[0].forward == uses[1].forward;
          sets.join(uses[0].cell, uses[1].cell);
        }
        else if (count == 1)
        {
          open.push_back({ smallest, uses[0] });
        }
      });
  std::vector<Index> partOf(view.numberOfCells, -1);
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count && t.dimension == this->Dimension; ++i)
    {
      const Index cell = block.cell(i);
      if (piece.ghosts && piece.ghosts[cell])
      {
        continue;
      }
      Index& part = partOf[sets.find(cell)];
      if (part < 0)
      {
        part = static_cast<Index>(this->Signs.size());
        this->Signs.emplace_back();
      }
      if (haveSigns && validity[cell] >= Inverted)
      {
        this->Signs[part].add(
          signedSize(mesh, t, view.connectivity + view.offsets[cell], this->Origin),
          validity[cell]);
      }
    }
  }
  for (const OpenFacet& facet : open)
  {
    this->addSeam(piece, facet.smallest, facet.use, partOf[sets.find(facet.use.cell)]);
  }
}

//------------------------------------------------------------------------------
void SeamedParts::find(const std::vector<const signed char*>& validity, bool haveSigns)
{
  this->Origin = this->commonOrigin();
  this->Group.together(
    [&]
    {
      for (std::size_t i = 0; i < this->Pieces.size(); ++i)
      {
        this->addPiece(i, validity[i], haveSigns);
      }
    });
  Index first = 0;
  const auto counts = this->Group.gatherItems(std::vector<std::size_t>{ this->Signs.size() });
  for (int rank = 0; rank < this->Group.rank(); ++rank)
  {
    first += static_cast<Index>(counts[rank][0]);
  }
  this->Labels.resize(this->Signs.size());
  std::iota(this->Labels.begin(), this->Labels.end(), first);
  this->join();
}

//------------------------------------------------------------------------------
/// Gives parts that share facets the smallest of their numbers. Each facet has a rank that gets
/// what all have of it; the labels go there and back until none changes.
void SeamedParts::join()
{
  const auto ranks = static_cast<std::size_t>(this->Group.size());
  std::vector<std::vector<SeamFacet>> sent(ranks);
  this->Group.together(
    [&]
    {
      for (const SeamFacet& facet : this->Seams)
      {
        sent[homeOf(facet.hash, this->Group)].push_back(facet);
      }
    });
  const std::vector<std::vector<SeamFacet>> received = this->Group.exchangeItems(sent);
  struct Place
  {
    std::size_t rank, number;
  };
  std::vector<std::pair<Place, Place>> pairs;
  this->Group.together(
    [&]
    {
      std::vector<Place> places;
      for (std::size_t rank = 0; rank < ranks; ++rank)
      {
        for (std::size_t i = 0; i < received[rank].size(); ++i)
        {
          places.push_back({ rank, i });
        }
      }
      const auto facetAt = [&](const Place& at) -> const SeamFacet&
      { return received[at.rank][at.number]; };
      std::sort(places.begin(), places.end(),
        [&](const Place& a, const Place& b) { return facetAt(a) < facetAt(b); });
      for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end)
      {
        while (end < places.size() && !(facetAt(places[begin]) < facetAt(places[end])))
        {
          ++end;
        }
        // Cells that meet at a facet with more than two are not neighbours there.
        if (end - begin == 2)
        {
          const Place &a = places[begin], &b = places[begin + 1];
          this->Disagreeing += facetAt(a).forward == facetAt(b).forward;
          pairs.emplace_back(a, b);
        }
      }
    });
  bool changed = true;
  while (this->Group.any(changed))
  {
    changed = false;
    std::vector<std::vector<Index>> labels(ranks);
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      for (const SeamFacet& facet : sent[rank])
      {
        labels[rank].push_back(this->Labels[facet.part]);
      }
    }
    std::vector<std::vector<Index>> joined = this->Group.exchangeItems(labels);
    for (const auto& [a, b] : pairs)
    {
      Index &one = joined[a.rank][a.number], &other = joined[b.rank][b.number];
      one = other = std::min(one, other);
    }
    labels = this->Group.exchangeItems(joined);
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      for (std::size_t i = 0; i < sent[rank].size(); ++i)
      {
        Index& label = this->Labels[sent[rank][i].part];
        changed = changed || labels[rank][i] < label;
        label = std::min(label, labels[rank][i]);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The parts of the whole mesh, and those that are reversed.
void SeamedParts::count(double sign, Orientation& result)
{
  std::vector<std::vector<SignedPart>> sent(this->Group.size());
  for (std::size_t part = 0; part < this->Labels.size(); ++part)
  {
    const Index label = this->Labels[part];
    sent[label % this->Group.size()].push_back({ label, this->Signs[part] });
  }
  std::vector<SignedPart> parts;
  for (const std::vector<SignedPart>& list : this->Group.exchangeItems(sent))
  {
    parts.insert(parts.end(), list.begin(), list.end());
  }
  std::stable_sort(parts.begin(), parts.end(),
    [](const SignedPart& a, const SignedPart& b) { return a.label < b.label; });
  Index count = 0, reversed = 0;
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end)
  {
    PartSign whole;
    for (; end < parts.size() && parts[end].label == parts[begin].label; ++end)
    {
      whole.sum += parts[end].sign.sum;
      whole.magnitude += parts[end].sign.magnitude;
      whole.majority += parts[end].sign.majority;
    }
    ++count;
    reversed += whole.reversed(sign);
  }
  result.parts = this->Group.sum(count);
  result.reversedParts = this->Group.sum(reversed);
}
}

//------------------------------------------------------------------------------
MeshSpace spaceOnRanks(RankGroup& group, const std::vector<RankPiece>& pieces)
{
  int dimension = 0;
  for (const RankPiece& piece : pieces)
  {
    for (const CellBlock& block : piece.mesh->blocks())
    {
      dimension = std::max(dimension, topology(block.type).dimension);
    }
  }
  dimension = static_cast<int>(group.maximum(static_cast<Index>(dimension)));
  MeshSpace space;
  space.dimension = dimension == 3 ? Dimension::Volume
    : dimension == 2               ? Dimension::Surface
                                   : Dimension::None;
  if (space.dimension == Dimension::Surface)
  {
    const auto corners = [&pieces](const auto& visit)
    {
      for (const RankPiece& piece : pieces)
      {
        forEachFiniteCorner(piece.mesh->view(), piece.mesh->blocks(), piece.ghosts, visit);
      }
    };
    RankTotals totals = { group };
    PlaneSearch(corners, totals).run(space);
  }
  return space;
}

//------------------------------------------------------------------------------
Orientation orientationOnRanks(RankGroup& group, const std::vector<RankPiece>& pieces,
  const std::vector<const signed char*>& validity)
{
  Orientation result;
  int dimension = 0;
  bool haveSigns = true, mirrored = false;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    const Mesh& mesh = *pieces[i].mesh;
    haveSigns = haveSigns && mesh.dimension() != Dimension::Surface;
    mirrored = mirrored || mesh.mirrored();
    dimension = std::max(dimension, mesh.dimension() == Dimension::Volume ? 3 : 2);
    for (const CellBlock& block : mesh.blocks())
    {
      for (Index k = 0; k < block.count && topology(block.type).dimension == dimension; ++k)
      {
        const Index cell = block.cell(k);
        const bool counts = !(pieces[i].ghosts && pieces[i].ghosts[cell]);
        result.positiveCells += counts && validity[i][cell] == Valid;
        result.negativeCells += counts && validity[i][cell] == Inverted;
      }
    }
  }
  result.positiveCells = group.sum(result.positiveCells);
  result.negativeCells = group.sum(result.negativeCells);
  haveSigns = !group.any(!haveSigns);
  mirrored = group.any(mirrored);
  dimension = static_cast<int>(group.maximum(static_cast<Index>(dimension)));
  if (haveSigns && result.negativeCells == 0)
  {
    return result;
  }
  if (haveSigns && result.positiveCells == 0)
  {
    result.state = Orientation::Reversed;
    return result;
  }
  SeamedParts parts(group, pieces, dimension);
  parts.find(validity, haveSigns);
  result.disagreeing = parts.disagreeing();
  parts.count(mirrored ? -1.0 : 1.0, result);
  result.reversedParts = haveSigns ? result.reversedParts : 0;
  if (result.disagreeing > 0 || (result.reversedParts > 0 && result.reversedParts < result.parts))
  {
    result.state = Orientation::Mixed;
  }
  else if (result.reversedParts > 0)
  {
    result.state = Orientation::Reversed;
  }
  return result;
}
}
