// SPDX-License-Identifier: BSD-3-Clause
// The orders of the cells of a mesh, also of one in pieces on ranks, and its orientation.
#include "CellOrder.h"
#include "SeamFacets.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <tuple>

namespace tautline
{
namespace
{
// number of cells above which a part is not considered a group of inverted elements
constexpr Index Enough = 10;

/// Cells in their given order, c, and in the opposite order, c + n; orders that agree are in one
/// set.
class OrderSets
{
public:
  explicit OrderSets(Index count)
    : Count(count)
    , Sets(2 * count)
  {
  }

  void join(Index a, Index b, bool agree)
  {
    // Both orders are joined in parallel, so that the set of c + n remains the mirror image of the
    // set of c.
    this->Sets.join(a, agree ? b : b + this->Count);
    this->Sets.join(a + this->Count, agree ? b + this->Count : b);
  }
  /// The first member of the part of a.
  Index part(Index a) { return std::min(this->Sets.find(a), this->Sets.find(a + this->Count)); }
  /// Whether the order of a is opposite to the order of the first member.
  bool opposite(Index a) { return this->Sets.find(a) != this->part(a); }
  /// Whether the part of a has no consistent order.
  bool ambiguous(Index a) { return this->Sets.find(a) == this->Sets.find(a + this->Count); }
  bool joined(Index a, Index b) { return this->part(a) == this->part(b); }
  bool agree(Index a, Index b)
  {
    return this->ambiguous(a) || this->Sets.find(a) == this->Sets.find(b);
  }

private:
  Index Count;
  UnionFind Sets;
};

/// A connected part of a piece, in the order of its first cell.
struct PiecePart
{
  PartSign inOrder;   ///< with all cells in the order of the first cell
  PartSign given;     ///< with the cells as given
  Index cells = 0;    ///< of the part
  Index opposite = 0; ///< of these: in the opposite order of the first
  Index first = -1;   ///< the smallest cell
  bool ambiguous = false;
};

/// A facet on the boundary of a piece, with the order information of its cell.
struct OrderFacet : SeamFacet
{
  Index part;
  bool opposite; ///< whether its cell has the opposite order of its part
  signed char validity;
};

/// Facets between two parts.
struct PartPair
{
  Index a, b;    ///< numbers of the parts, a not above b
  bool agree;    ///< whether the orders of the parts agree
  bool doubtful; ///< whether the cells are neighbors in opposite orders or overlap
  Index facets, disagreeing;

  auto key() const { return std::tie(this->a, this->b, this->agree, this->doubtful); }
};

/// How a part is ordered.
enum class Turn : char
{
  Stays,  ///< its cells have the order of the first
  Turned, ///< they have the opposite order
  None    ///< all keep their given order
};

/// The totals that the first rank sends to the others.
struct OrderTotals
{
  Index disagreeing = 0, parts = 0, reversedParts = 0;
  Index reversed = 0, cells = 0, ambiguous = 0, firstAmbiguous = -1;
};

/// The parts of the pieces of one rank.
class PieceOrders
{
public:
  PieceOrders(const std::vector<RankPiece>& pieces, const std::vector<const signed char*>& validity,
    int dimension, bool haveSigns)
    : Pieces(pieces)
    , Validity(validity)
    , Dimension(dimension)
    , HaveSigns(haveSigns)
  {
  }

  /// @param facets whether to list the boundary facets
  void find(const Vec3& origin, bool facets);
  std::vector<std::vector<unsigned char>> reverse(const std::vector<Turn>& turns) const;

  std::vector<PiecePart> Parts;
  std::vector<OrderFacet> Facets;
  Index Disagreeing = 0;

private:
  void addPiece(std::size_t number, const Vec3& origin, bool facets);
  void flagGhosts(const RankPiece& piece, std::vector<unsigned char>& flags) const;

  const std::vector<RankPiece>& Pieces;
  const std::vector<const signed char*>& Validity;
  int Dimension;
  bool HaveSigns;
  std::vector<std::vector<Index>> PartOf;        ///< per piece and cell; -1: none
  std::vector<std::vector<unsigned char>> Other; ///< per piece and cell: opposite in its part
};

//------------------------------------------------------------------------------
void PieceOrders::find(const Vec3& origin, bool facets)
{
  for (std::size_t i = 0; i < this->Pieces.size(); ++i)
  {
    this->addPiece(i, origin, facets);
  }
}

//------------------------------------------------------------------------------
void PieceOrders::addPiece(std::size_t number, const Vec3& origin, bool facets)
{
  const RankPiece& piece = this->Pieces[number];
  const Mesh& mesh = *piece.mesh;
  const Index cells = mesh.view().numberOfCells;
  OrderSets sets(cells);
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
          // In a consistent order, neighbors traverse their common facet in opposite directions.
          const bool agree = uses[0].forward != uses[1].forward;
          this->Disagreeing += !agree;
          sets.join(uses[0].cell, uses[1].cell, agree);
        }
        else if (count == 1 && facets)
        {
          open.push_back({ smallest, uses[0] });
        }
      });
  this->PartOf.emplace_back(cells, -1);
  this->Other.emplace_back(cells, 0);
  std::vector<Index> partAt(cells, -1); // by the first member
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
      Index& part = partAt[sets.part(cell)];
      if (part < 0)
      {
        part = static_cast<Index>(this->Parts.size());
        this->Parts.emplace_back();
      }
      this->PartOf.back()[cell] = part;
      PiecePart& of = this->Parts[part];
      const bool opposite = sets.opposite(cell);
      this->Other.back()[cell] = opposite;
      ++of.cells;
      of.opposite += opposite;
      of.first = of.first < 0 ? cell : std::min(of.first, cell);
      of.ambiguous = sets.ambiguous(cell);
      const signed char validity = this->Validity[number][cell];
      if (this->HaveSigns && validity >= Inverted)
      {
        const double size =
          signedSize(mesh, t, mesh.view().connectivity + mesh.view().offsets[cell], origin);
        of.given.add(size, validity);
        of.inOrder.add(opposite ? -size : size, opposite ? -static_cast<int>(validity) : validity);
      }
    }
  }
  for (const OpenFacet& facet : open)
  {
    const Index cell = facet.use.cell;
    this->Facets.push_back({ seamFacetOf(piece, facet.smallest, facet.use),
      this->PartOf.back()[cell], this->Other.back()[cell] != 0, this->Validity[number][cell] });
  }
}

//------------------------------------------------------------------------------
/// The flags of the cells whose order must be reversed.
std::vector<std::vector<unsigned char>> PieceOrders::reverse(const std::vector<Turn>& turns) const
{
  std::vector<std::vector<unsigned char>> reverse;
  for (std::size_t i = 0; i < this->Pieces.size(); ++i)
  {
    std::vector<unsigned char>& flags = reverse.emplace_back(this->PartOf[i].size(), 0);
    for (std::size_t cell = 0; cell < flags.size(); ++cell)
    {
      const Index part = this->PartOf[i][cell];
      const Turn turn = part < 0 ? Turn::None : turns[part];
      flags[cell] = turn != Turn::None && (this->Other[i][cell] != 0) != (turn == Turn::Turned);
    }
    if (this->Pieces[i].ghosts)
    {
      this->flagGhosts(this->Pieces[i], flags);
    }
  }
  return reverse;
}

//------------------------------------------------------------------------------
/// Ghost cells get the order of the cells to which they are connected.
void PieceOrders::flagGhosts(const RankPiece& piece, std::vector<unsigned char>& flags) const
{
  const Mesh& mesh = *piece.mesh;
  const auto cells = static_cast<Index>(flags.size());
  OrderSets sets(cells);
  FacetTable(mesh).forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
      if (count == 2)
      {
        sets.join(uses[0].cell, uses[1].cell, uses[0].forward != uses[1].forward);
      }
    });
  std::vector<signed char> firstReversed(cells, -1); // by the first member; -1: unknown
  for (Index cell = 0; cell < cells; ++cell)
  {
    if (!piece.ghosts[cell] && !sets.ambiguous(cell))
    {
      firstReversed[sets.part(cell)] = (flags[cell] != 0) != sets.opposite(cell);
    }
  }
  for (Index cell = 0; cell < cells; ++cell)
  {
    const signed char first = firstReversed[sets.part(cell)];
    if (piece.ghosts[cell] && first >= 0 && !sets.ambiguous(cell))
    {
      flags[cell] = (first > 0) != sets.opposite(cell);
    }
  }
}

//------------------------------------------------------------------------------
/// The pairs of parts that meet at the facets a rank has received.
std::vector<PartPair> pairsAt(const std::vector<std::vector<OrderFacet>>& received,
  const std::vector<Index>& firsts, bool sided)
{
  std::vector<PartPair> pairs;
  forEachSeamPair(received,
    [&](const SeamPlace& at, const SeamPlace& other)
    {
      const OrderFacet& f = received[at.rank][at.number];
      const OrderFacet& g = received[other.rank][other.number];
      const bool agree = f.forward != g.forward;
      const bool oneSide =
        f.validity == g.validity && (f.validity == Valid || f.validity == Inverted);
      PartPair pair = { firsts[at.rank] + f.part, firsts[other.rank] + g.part,
        agree == (f.opposite == g.opposite), sided && !agree && oneSide, 1, !agree };
      if (pair.b < pair.a)
      {
        std::swap(pair.a, pair.b);
      }
      pairs.push_back(pair);
    });
  return pairs;
}

/// Adds up the facets of equal pairs.
void unitePairs(std::vector<PartPair>& pairs)
{
  std::sort(pairs.begin(), pairs.end(),
    [](const PartPair& a, const PartPair& b) { return a.key() < b.key(); });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    if (kept > 0 && pairs[kept - 1].key() == pairs[i].key())
    {
      pairs[kept - 1].facets += pairs[i].facets;
      pairs[kept - 1].disagreeing += pairs[i].disagreeing;
    }
    else
    {
      pairs[kept++] = pairs[i];
    }
  }
  pairs.resize(kept);
}

/// Joins the parts at their facets. @return the facets whose cells have opposite orders
Index joinParts(OrderSets& sets, const std::vector<PartPair>& pairs, Index disagreeing)
{
  for (const PartPair& pair : pairs)
  {
    if (!pair.doubtful)
    {
      sets.join(pair.a, pair.b, pair.agree);
      disagreeing += pair.disagreeing;
    }
  }
  // Doubtful pairs: first use the ones confirmed by others; decide the rest by majority.
  std::vector<PartPair> open;
  Index doubtful = 0;
  for (const PartPair& pair : pairs)
  {
    if (pair.doubtful && sets.joined(pair.a, pair.b))
    {
      const bool confirmed = sets.agree(pair.a, pair.b) == pair.agree;
      disagreeing += confirmed ? pair.disagreeing : 0;
      doubtful += confirmed ? 0 : pair.facets;
    }
    else if (pair.doubtful)
    {
      open.push_back(pair);
      doubtful += pair.facets;
    }
  }
  const bool opposite = disagreeing > doubtful;
  for (const PartPair& pair : open)
  {
    if (sets.joined(pair.a, pair.b) ? sets.agree(pair.a, pair.b) == pair.agree : opposite)
    {
      sets.join(pair.a, pair.b, pair.agree);
      disagreeing += pair.disagreeing;
    }
  }
  return disagreeing;
}

/// Decides the order of the connected parts of the whole mesh, and of the parts of the pieces.
OrderTotals decide(const std::vector<PiecePart>& parts, const std::vector<PartPair>& pairs,
  bool haveSigns, double sign, Index disagreeing, std::vector<Turn>& turns)
{
  const auto count = static_cast<Index>(parts.size());
  OrderSets sets(count);
  for (Index p = 0; p < count; ++p)
  {
    // A part that is joined with its own opposite has no consistent order.
    if (parts[p].ambiguous)
    {
      sets.join(p, p, false);
    }
  }
  OrderTotals totals;
  totals.disagreeing = joinParts(sets, pairs, disagreeing);
  const auto add = [](PartSign& to, const PartSign& own, double by)
  {
    to.sum += by * own.sum;
    to.magnitude += own.magnitude;
    to.majority += static_cast<Index>(by) * own.majority;
  };
  std::vector<PiecePart> whole(count);
  for (Index p = 0; p < count; ++p)
  {
    PiecePart& of = whole[sets.part(p)];
    const bool opposite = sets.opposite(p);
    add(of.given, parts[p].given, 1);
    add(of.inOrder, parts[p].inOrder, opposite ? -1 : 1);
    of.cells += parts[p].cells;
    of.opposite += opposite ? parts[p].cells - parts[p].opposite : parts[p].opposite;
    of.first = of.first < 0 ? parts[p].first : std::min(of.first, parts[p].first);
  }
  turns.assign(count, Turn::None);
  Index inverted = 0; // parts that are negative because their cells are inverted, not reversed
  for (Index p = 0; p < count; ++p)
  {
    const PiecePart& of = whole[sets.part(p)];
    const bool one = sets.part(p) == p; // once for each part of the whole
    totals.parts += one;
    const bool negative = one && haveSigns && of.given.reversed(sign);
    totals.reversedParts += negative;
    totals.cells += parts[p].cells;
    if (sets.ambiguous(p))
    {
      totals.ambiguous += one;
      totals.firstAmbiguous = totals.firstAmbiguous < 0 || of.first < totals.firstAmbiguous
        ? of.first
        : totals.firstAmbiguous;
      continue;
    }
    // With signs, the total size decides; on a surface, the given order of the majority is kept.
    bool turn = haveSigns ? of.inOrder.reversed(sign) : 2 * of.opposite > of.cells;
    if (haveSigns && of.opposite == 0)
    {
      // Only the sign of the part determines its order. A few cells may be inverted elements.
      const bool many = of.cells >= Enough && of.inOrder.majority == -of.cells;
      inverted += negative && turn && !many;
      turn = turn && many;
    }
    turns[p] = turn != sets.opposite(p) ? Turn::Turned : Turn::Stays;
    totals.reversed +=
      turns[p] == Turn::Turned ? parts[p].cells - parts[p].opposite : parts[p].opposite;
  }
  // If all parts are negative, the mesh is reversed, even if it has few cells.
  totals.reversedParts -= totals.reversedParts < totals.parts ? inverted : 0;
  return totals;
}

/// The goal of orderOf().
enum class Search
{
  Orientation,    ///< two cells on one side of a facet are neighbors in opposite orders
  OrderOnceMixed, ///< they may also be overlapping cells; the order is only found for a mixed mesh
  Order           ///< as Orientation; the order is found for any mesh
};

/// Counts the valid and inverted cells of the dimension of the whole mesh, without ghosts.
void countSigns(const std::vector<RankPiece>& pieces,
  const std::vector<const signed char*>& validity, int dimension, Orientation& found)
{
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    for (const CellBlock& block : pieces[i].mesh->blocks())
    {
      for (Index k = 0; k < block.count && topology(block.type).dimension == dimension; ++k)
      {
        const Index cell = block.cell(k);
        const bool counts = !(pieces[i].ghosts && pieces[i].ghosts[cell]);
        found.positiveCells += counts && validity[i][cell] == Valid;
        found.negativeCells += counts && validity[i][cell] == Inverted;
      }
    }
  }
}

/// Combines the parts of all ranks, and decides on the first rank.
/// @param turns of the parts of this rank
OrderTotals decideTogether(RankGroup& group, const PieceOrders& own, bool haveSigns,
  bool overlapping, double sign, std::vector<Turn>& turns)
{
  std::vector<std::vector<OrderFacet>> sent(group.size());
  for (const OrderFacet& facet : own.Facets)
  {
    // Both sides of a facet have the same hash, so they arrive at the same rank.
    sent[homeOf(facet.hash, group)].push_back(facet);
  }
  std::vector<Index> firsts = { 0 };
  for (const std::size_t count : group.gatherJoined(std::vector<std::size_t>{ own.Parts.size() }))
  {
    firsts.push_back(firsts.back() + static_cast<Index>(count));
  }
  std::vector<PartPair> pairs =
    pairsAt(group.exchangeItems(sent), firsts, haveSigns && overlapping);
  unitePairs(pairs);
  const Index disagreeing = group.sum(own.Disagreeing);
  const auto allParts = group.gatherOnFirst(own.Parts);
  std::vector<PartPair> allPairs = group.gatherOnFirst(pairs);
  std::vector<std::vector<Turn>> turnsOf(group.size());
  std::vector<OrderTotals> totals;
  if (group.rank() == 0)
  {
    unitePairs(allPairs);
    std::vector<Turn> all;
    totals.push_back(decide(allParts, allPairs, haveSigns, sign, disagreeing, all));
    for (int rank = 0; rank < group.size(); ++rank)
    {
      turnsOf[rank].assign(all.begin() + firsts[rank], all.begin() + firsts[rank + 1]);
    }
  }
  const OrderTotals all = group.gatherJoined(totals)[0];
  turns = group.exchangeItems(turnsOf)[0];
  return all;
}

/// The order of the whole mesh.
/// @param group null: one piece, whose coincident points are not identified
RankOrder orderOf(RankGroup* group, const std::vector<RankPiece>& pieces,
  const std::vector<const signed char*>& validity, Search search)
{
  RankOrder result;
  Orientation& found = result.orientation;
  bool haveSigns = true, mirrored = false;
  int dimension = 0;
  for (const RankPiece& piece : pieces)
  {
    haveSigns = haveSigns && piece.mesh->dimension() != Dimension::Surface;
    mirrored = mirrored || piece.mesh->mirrored();
    dimension = std::max(dimension, piece.mesh->dimension() == Dimension::Volume ? 3 : 2);
  }
  if (group)
  {
    haveSigns = group->everywhere(haveSigns);
    mirrored = group->any(mirrored);
    dimension = static_cast<int>(group->maximum(static_cast<Index>(dimension)));
  }
  countSigns(pieces, validity, dimension, found);
  if (group)
  {
    found.positiveCells = group->sum(found.positiveCells);
    found.negativeCells = group->sum(found.negativeCells);
  }
  // If all signs agree, the order is consistent, and neighbors need not be compared.
  const bool settled = haveSigns && (found.negativeCells == 0 || found.positiveCells == 0);
  if (settled)
  {
    found.state = found.negativeCells > 0 ? Orientation::Reversed : Orientation::Consistent;
  }
  if (settled && search != Search::Order)
  {
    return result;
  }

  // If signs differ (a tangled or mixed mesh) or do not exist (a surface), compare neighbors.
  const double sign = mirrored ? -1.0 : 1.0;
  PieceOrders own(pieces, validity, dimension, haveSigns);
  // The signed size of an open part depends on the origin, so all ranks use the same one.
  own.find(
    group ? commonOrigin(*group, pieces) : finitePoint(pieces[0].mesh->view()), group != nullptr);
  std::vector<Turn> turns;
  const OrderTotals all = group
    ? decideTogether(*group, own, haveSigns, search == Search::OrderOnceMixed, sign, turns)
    : decide(own.Parts, {}, haveSigns, sign, own.Disagreeing, turns);
  found.disagreeing = all.disagreeing;
  found.parts = all.parts;
  found.reversedParts = all.reversedParts;
  if (found.disagreeing > 0 || (found.reversedParts > 0 && found.reversedParts < found.parts))
  {
    found.state = Orientation::Mixed;
  }
  else if (found.reversedParts > 0)
  {
    found.state = Orientation::Reversed;
  }
  if (search == Search::Order ||
    (search == Search::OrderOnceMixed && found.state == Orientation::Mixed))
  {
    result.order.reversed = all.reversed;
    result.order.cells = all.cells;
    result.order.ambiguous = all.ambiguous;
    // A cell number has a meaning only on its own rank.
    result.order.firstAmbiguous = !group || group->size() == 1 ? all.firstAmbiguous : -1;
    result.reverse = own.reverse(turns);
  }
  return result;
}
}

//------------------------------------------------------------------------------
Orientation Mesh::orientation(const signed char* validity) const
{
  return orderOf(nullptr, { { this, nullptr, nullptr } }, { validity }, Search::Orientation)
    .orientation;
}

//------------------------------------------------------------------------------
Orientation orientation(RankGroup& group, const std::vector<RankPiece>& pieces,
  const std::vector<const signed char*>& validity)
{
  return orderOf(&group, pieces, validity, Search::Orientation).orientation;
}

//------------------------------------------------------------------------------
CellOrder consistentOrder(const Mesh& mesh, const signed char* validity)
{
  RankOrder found = orderOf(nullptr, { { &mesh, nullptr, nullptr } }, { validity }, Search::Order);
  if (found.order.reversed > 0)
  {
    found.order.reverse = std::move(found.reverse[0]);
  }
  return found.order;
}

//------------------------------------------------------------------------------
RankOrder consistentOrder(RankGroup& group, const std::vector<RankPiece>& pieces,
  const std::vector<const signed char*>& validity)
{
  return orderOf(&group, pieces, validity, Search::OrderOnceMixed);
}

//------------------------------------------------------------------------------
void reverseCell(CellType type, Index* nodes)
{
  switch (type)
  {
    case CellType::Triangle:
    case CellType::Tetrahedron:
      std::swap(nodes[1], nodes[2]);
      return;
    case CellType::Quadrilateral:
    case CellType::Pyramid:
      std::swap(nodes[1], nodes[3]);
      return;
    case CellType::Hexahedron:
      // Exchanging the bottom and the top reverses the orientation.
      std::swap_ranges(nodes, nodes + 4, nodes + 4);
      return;
    case CellType::Wedge:
      std::swap_ranges(nodes, nodes + 3, nodes + 3);
      return;
    default:
      throw Error("Only triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids "
                  "can be reversed.");
  }
}
}
