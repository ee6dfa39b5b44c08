// SPDX-License-Identifier: BSD-3-Clause
// The plane and the orientation of a mesh in pieces equal the whole mesh's, however it is cut.
#include "Blocks.h"
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/CellOrder.h"
#include "tautline/Mesh/RankPieces.h"

#include <algorithm>

using namespace tautline;

namespace
{
constexpr int MostRanks = 7;

void flip(MeshData& data, Index cell)
{
  reverseCell(cornerType(data.types[cell]), &data.connectivity[data.offsets[cell]]);
}

/// Two blocks side by side, apart from each other.
MeshData twoBlocks(CellType type)
{
  const MeshData block = jittered(type, 4, 0.2);
  MeshData both;
  for (const double shift : { 0.0, 6.0 })
  {
    const Index first = both.numberOfPoints();
    for (Index p = 0; p < block.numberOfPoints(); ++p)
    {
      both.addPoint(block.point(p) + Vec3{ shift, 0, 0 });
    }
    for (Index cell = 0; cell < block.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes;
      for (Index n = block.offsets[cell]; n < block.offsets[cell + 1]; ++n)
      {
        nodes.push_back(first + block.connectivity[n]);
      }
      both.addCell(static_cast<int>(block.types[cell]), nodes);
    }
  }
  return both;
}

/// Calls check(group, part, piece) for all cuts, numbers of ranks, with and without ids.
template <class Check>
void forEachCut(const MeshData& whole, const Check& check)
{
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    for (int ranks = 1; ranks <= MostRanks; ranks += ranks > 2 ? 2 : 1)
    {
      for (const bool ids : { false, true })
      {
        const Context context("cut " + std::to_string(static_cast<int>(cut)) + ", " +
          std::to_string(ranks) + (ids ? " ranks, ids" : " ranks"));
        const auto rankOf = cutBy(whole, cut, ranks);
        onRanks(ranks,
          [&](RankGroup& group)
          {
            const RankPart part = partOf(whole, group.rank(), rankOf, cut != Cut::Random);
            class Mesh mesh(part.data.view());
            const RankPiece piece = { &mesh, part.ghosts.data(),
              ids ? part.pointOf.data() : nullptr };
            check(group, part, mesh, piece);
          });
      }
    }
  }
}

void checkOrientation(const Orientation& found, const Orientation& one)
{
  TAUTLINE_CHECK_EQUAL(found.state, one.state);
  TAUTLINE_CHECK_EQUAL(found.positiveCells, one.positiveCells);
  TAUTLINE_CHECK_EQUAL(found.negativeCells, one.negativeCells);
  TAUTLINE_CHECK_EQUAL(found.disagreeing, one.disagreeing);
  TAUTLINE_CHECK_EQUAL(found.parts, one.parts);
  TAUTLINE_CHECK_EQUAL(found.reversedParts, one.reversedParts);
}

/// The order of the cells of the pieces, also of copies, is that in the whole mesh.
void checkOrder(const RankOrder& found, const CellOrder& one, const RankPart& part)
{
  TAUTLINE_CHECK_EQUAL(found.order.reversed, one.reversed);
  TAUTLINE_CHECK_EQUAL(found.order.cells, one.cells);
  TAUTLINE_CHECK_EQUAL(found.order.ambiguous, one.ambiguous);
  TAUTLINE_CHECK_EQUAL(found.reverse.size(), std::size_t(1));
  for (std::size_t cell = 0; cell < part.cellOf.size() && !found.reverse.empty(); ++cell)
  {
    const bool reversed = one.reversed > 0 && one.reverse[part.cellOf[cell]] != 0;
    TAUTLINE_CHECK_EQUAL(found.reverse[0][cell] != 0, reversed);
  }
}

void testOrientation(const char* name, const MeshData& whole, Orientation::State state)
{
  const Context context(name);
  const class Mesh mesh(whole.view());
  const std::vector<signed char> validity = validityOf(mesh);
  const Orientation one = mesh.orientation(validity.data());
  TAUTLINE_CHECK_EQUAL(one.state, state);
  const CellOrder order = consistentOrder(mesh, validity.data());
  forEachCut(whole,
    [&](RankGroup& group, const RankPart& part, class Mesh& own, const RankPiece& piece)
    {
      const MeshSpace space = spaceOf(group, { piece });
      TAUTLINE_CHECK_EQUAL(static_cast<int>(space.dimension), static_cast<int>(mesh.dimension()));
      TAUTLINE_CHECK(norm(space.normal - mesh.normal()) < 1e-12);
      TAUTLINE_CHECK(norm(space.frame[0] - mesh.frame()[0]) < 1e-12);
      own.setSpace(space);
      const std::vector<signed char> here = validityOf(own);
      for (std::size_t cell = 0; cell < here.size(); ++cell)
      {
        TAUTLINE_CHECK_EQUAL(here[cell], validity[part.cellOf[cell]]);
      }
      checkOrientation(orientation(group, { piece }, { here.data() }), one);
      const RankOrder ordered = consistentOrder(group, { piece }, { here.data() });
      checkOrientation(ordered.orientation, one);
      if (one.state == Orientation::Mixed)
      {
        checkOrder(ordered, order, part);
      }
    });
}

/// Every third cell of a block is in the opposite order, so that many pieces have no neighbors
/// that agree.
MeshData everyThirdFlipped(MeshData mesh)
{
  for (Index cell = 0; cell < mesh.numberOfCells(); cell += 3)
  {
    flip(mesh, cell);
  }
  return mesh;
}

/// A valid copy of a mesh on top of it, with an inverted cell in one of them: cells on one side of
/// a facet overlap, and none is in the opposite order.
void testOverlap(CellType type)
{
  const Context context(topology(type).name);
  const MeshData block = jittered(type, 2, 1.2);
  MeshData both = block;
  const Index shift = block.numberOfPoints();
  for (Index p = 0; p < shift; ++p)
  {
    both.addPoint(block.point(p));
  }
  for (Index cell = 0; cell < block.numberOfCells(); ++cell)
  {
    std::vector<Index> nodes;
    for (Index n = block.offsets[cell]; n < block.offsets[cell + 1]; ++n)
    {
      nodes.push_back(shift + block.connectivity[n]);
    }
    both.addCell(static_cast<int>(block.types[cell]), nodes);
  }
  const class Mesh mesh(both.view());
  const std::vector<signed char> validity = validityOf(mesh);
  TAUTLINE_CHECK(std::count(validity.begin(), validity.end(), Inverted) > 0);
  SingleRank alone;
  const RankOrder found =
    consistentOrder(alone, { { &mesh, nullptr, nullptr } }, { validity.data() });
  TAUTLINE_CHECK_EQUAL(found.orientation.state, Orientation::Consistent);
  TAUTLINE_CHECK_EQUAL(found.orientation.disagreeing, 0);
}

void testOrientations(CellType type)
{
  const Context context(topology(type).name);
  const MeshData plain = jittered(type, 4, 0.2);
  testOrientation("plain", plain, Orientation::Consistent);
  testOrientation("tangled", jittered(type, 4, 1.2), Orientation::Consistent);
  MeshData reversed = jittered(type, 4, 1.2);
  for (Index cell = 0; cell < reversed.numberOfCells(); ++cell)
  {
    flip(reversed, cell);
  }
  testOrientation("reversed and tangled", reversed, Orientation::Reversed);
  MeshData mixed = plain;
  flip(mixed, mixed.numberOfCells() / 2);
  testOrientation("one cell flipped", mixed, Orientation::Mixed);
  testOrientation("every third cell flipped", everyThirdFlipped(plain), Orientation::Mixed);
  testOrientation("tangled, every third cell flipped", everyThirdFlipped(jittered(type, 4, 0.7)),
    Orientation::Mixed);
  MeshData blocks = twoBlocks(type);
  for (Index cell = blocks.numberOfCells() / 2; cell < blocks.numberOfCells(); ++cell)
  {
    flip(blocks, cell);
  }
  testOrientation("one of two blocks reversed", blocks, Orientation::Mixed);
}

/// Planes and surfaces, of which a piece may be flat.
void testSpaces()
{
  const auto onto = [](const std::function<Vec3(const Vec3&)>& place)
  {
    MeshData data = jittered(CellType::Triangle, 6, 0.2);
    data.transform(place);
    return data;
  };
  testOrientation("inclined",
    onto(
      [](const Vec3& p) {
        return Vec3{ p[0] - p[1], p[0] + p[1], 0.5 * p[0] + 0.1 * p[1] };
      }),
    Orientation::Consistent);
  testOrientation("across y",
    onto(
      [](const Vec3& p) {
        return Vec3{ p[1], 2.0, p[0] };
      }),
    Orientation::Consistent);
  testOrientation("a roof",
    onto(
      [](const Vec3& p) {
        return Vec3{ p[0], p[1], std::abs(p[0] - 3) };
      }),
    Orientation::Consistent);
  testOrientation("curved",
    onto(
      [](const Vec3& p) {
        return Vec3{ p[0], p[1], 0.1 * p[0] * p[1] };
      }),
    Orientation::Consistent);
  // Triangles beside tetrahedra: a piece may have no other cells.
  MeshData volume = jittered(CellType::Tetrahedron, 3, 0.1);
  const Index p = volume.numberOfPoints() - 1;
  volume.addCell(CellType::Triangle, std::vector<Index>{ 0, 1, p });
  testOrientation("a volume with a triangle", volume, Orientation::Consistent);
}
}

TAUTLINE_TEST(TestRankPieces)
{
  for (const CellTopology& t : topologies())
  {
    TAUTLINE_RUN(testOrientations(t.type));
    TAUTLINE_RUN(testOverlap(t.type));
  }
  TAUTLINE_RUN(testSpaces());
}
