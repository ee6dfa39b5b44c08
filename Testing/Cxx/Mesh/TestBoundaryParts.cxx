// SPDX-License-Identifier: BSD-3-Clause
// The parts of the boundary on ranks equal the parts on one process, however the mesh is cut.
#include "Blocks.h"
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/BoundaryParts.h"
#include "tautline/Mesh/BoundaryShape.h"

#include <cmath>

using namespace tautline;

namespace
{
/// Blocks side by side, apart from each other, each with as many holes as its number.
MeshData holed(CellType type, Index blocks)
{
  constexpr Index side = 7;
  const bool flat = topology(type).dimension == 2;
  const MeshData block = blockMesh(type, side, side, flat ? 0 : side);
  MeshData all;
  for (Index b = 0; b < blocks; ++b)
  {
    const Index first = all.numberOfPoints();
    for (Index p = 0; p < block.numberOfPoints(); ++p)
    {
      all.addPoint(block.point(p) + Vec3{ static_cast<double>(2 * b * side), 0, 0 });
    }
    for (Index cell = 0; cell < block.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes;
      Vec3 middle = { 0, 0, 0 };
      for (Index n = block.offsets[cell]; n < block.offsets[cell + 1]; ++n)
      {
        nodes.push_back(first + block.connectivity[n]);
        middle += block.point(block.connectivity[n]);
      }
      middle = (1.0 / static_cast<double>(nodes.size())) * middle;
      bool hole = false;
      for (Index h = 0; h < b; ++h)
      {
        // Holes of one block, apart from each other.
        const double at = 2.5 + 2.0 * static_cast<double>(h);
        hole = hole ||
          (std::abs(middle[0] - at) < 0.5 && std::abs(middle[1] - at) < 0.5 &&
            (flat || std::abs(middle[2] - 3.5) < 0.5));
      }
      if (!hole)
      {
        all.addCell(static_cast<int>(block.types[cell]), nodes);
      }
    }
  }
  return all;
}

void testCuts(const char* name, const MeshData& whole, int parts)
{
  const Context context(name);
  const BoundaryParts one = boundaryParts(Mesh(whole.view()));
  TAUTLINE_CHECK_EQUAL(one.parts, parts);
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    for (const int ranks : { 1, 2, 3, 4, 7 })
    {
      const Context inner(
        "cut " + std::to_string(static_cast<int>(cut)) + ", " + std::to_string(ranks) + " ranks");
      const auto rankOf = cutBy(whole, cut, ranks);
      onRanks(ranks,
        [&](RankGroup& group)
        {
          const RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
          DistributedMesh mesh(group, { part.data.view(), nullptr, part.ghosts.data() });
          const BoundaryParts found = boundaryParts(Mesh(mesh.view()), Ranks(mesh));
          TAUTLINE_CHECK_EQUAL(found.parts, one.parts);
          TAUTLINE_CHECK_EQUAL(found.outer.size(), one.outer.size());
          // Parts of the same size may be in another order: each has one number of the other.
          std::map<int, int> numbers;
          for (std::size_t p = 0; p < part.pointOf.size(); ++p)
          {
            const int here = found.part[mesh.localOfPiece()[p]], there = one.part[part.pointOf[p]];
            const int number = numbers.emplace(there, here).first->second;
            TAUTLINE_CHECK_EQUAL(here, number);
            TAUTLINE_CHECK_EQUAL(here == 0, there == 0);
            TAUTLINE_CHECK(here == 0 || found.outer[here - 1] == one.outer[there - 1]);
          }
        });
    }
  }
}

/// A block whose top is bent to an arc, by half a degree from row to row: where points slide is the
/// same on ranks.
void testShape(CellType type)
{
  const Context context(std::string("shape, ") + topology(type).name);
  const bool flat = topology(type).dimension == 2;
  constexpr Index length = 30, side = 3;
  MeshData whole = blockMesh(type, length, side, flat ? 0 : side);
  constexpr double radius = 120;
  whole.transform(
    [](const Vec3& p)
    {
      const double angle = p[0] / radius;
      const double y = p[1] / side * radius * (1 - std::cos(angle));
      return Vec3{ radius * std::sin(angle), p[1] + y, p[2] };
    });
  const BoundaryShape one = boundaryShape(Mesh(whole.view()), 1);
  const auto slides = [](const BoundaryShape& shape, Index p)
  {
    double square = 0;
    for (Index i = 3 * p; i < 3 * p + 3; ++i)
    {
      square += shape.planes[i] * shape.planes[i] + shape.lines[i] * shape.lines[i];
    }
    return square > 0;
  };
  Index held = 0, free = 0;
  for (Index p = 0; p < whole.numberOfPoints(); ++p)
  {
    const Vec3 x = whole.point(p);
    const bool inside = flat || (x[2] > 0 && x[2] < side);
    held += inside && one.fixed[p];
    free += slides(one, p);
  }
  TAUTLINE_CHECK(held >= (flat ? 1 : 2) * (length - 1));
  TAUTLINE_CHECK(free >= length - 1);
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    for (const int ranks : { 1, 2, 4 })
    {
      const auto rankOf = cutBy(whole, cut, ranks);
      onRanks(ranks,
        [&](RankGroup& group)
        {
          const RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
          DistributedMesh mesh(group, { part.data.view(), nullptr, part.ghosts.data() });
          const BoundaryShape found = boundaryShape(Mesh(mesh.view()), 1, 0, Ranks(mesh));
          for (std::size_t p = 0; p < part.pointOf.size(); ++p)
          {
            const Index here = mesh.localOfPiece()[p], there = part.pointOf[p];
            TAUTLINE_CHECK_EQUAL(int(found.fixed[here]), int(one.fixed[there]));
            TAUTLINE_CHECK(!mesh.owned(here) || slides(found, here) == slides(one, there));
          }
        });
    }
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestBoundaryParts)
{
  TAUTLINE_RUN(testCuts("triangles", holed(CellType::Triangle, 3), 6));
  TAUTLINE_RUN(testCuts("quadrilaterals", holed(CellType::Quadrilateral, 2), 3));
  TAUTLINE_RUN(testCuts("hexahedra", holed(CellType::Hexahedron, 3), 6));
  TAUTLINE_RUN(testCuts("tetrahedra", holed(CellType::Tetrahedron, 2), 3));
  TAUTLINE_RUN(testShape(CellType::Triangle));
  TAUTLINE_RUN(testShape(CellType::Hexahedron));
}
