// SPDX-License-Identifier: BSD-3-Clause
// A mesh in pieces is measured as the whole: every metric on every cell, and every check.
#include "Check.h"
#include "FaceMeshes.h"
#include "Registry.h"
#include "ThreadRanks.h"

#include <mutex>

namespace tautline
{
namespace
{
/// A piece on a rank, ready to be measured.
struct MeasuredPiece
{
  RankPart part;
  FaceMesh mesh;
  std::vector<double> points;
  std::vector<Index> facetIds;
};

/// The values of all metrics and the checks, by cells of the whole mesh.
struct Measured
{
  std::vector<std::vector<double>> values;
  std::vector<MeshCheck> checks;
};

/// Facets of boundary patches: the plane x = 0 is a wall, the planes across z are optionally empty.
using Facets = std::function<ListedFacets(const MeshData&, const FaceMesh&)>;

Measured measureWhole(
  const MeshData& data, const Facets& facetsOf, const std::vector<FacePatch>& patches)
{
  const FaceMesh plain = faceMeshOf(data);
  FaceMesh mesh = findFaces(plain.points, facesOf(data), facetsOf(data, plain), patches);
  if (patches.empty())
  {
    markLayerAlone(mesh, data);
  }
  const FaceMeasures measures(mesh, data.points.data(), FaceConvention::Esi);
  Measured all;
  for (Metric metric : faceMetrics())
  {
    all.values.push_back(measures.evaluate(metric).cells);
  }
  all.checks = checkMesh(measures, data.points.data()).checks;
  return all;
}

/// Ids of the facets across x of a block, by the row and column of their cells: the same in all
/// pieces.
std::vector<Index> idsOf(const MeshData& data, const ListedFacets& facets)
{
  std::vector<Index> ids;
  for (std::size_t i = 0; i < facets.patch.size(); ++i)
  {
    double y = 0, z = 0;
    const auto size = static_cast<double>(facets.offsets[i + 1] - facets.offsets[i]);
    for (Index n = facets.offsets[i]; n < facets.offsets[i + 1]; ++n)
    {
      y += data.points[3 * facets.nodes[n] + 1] / size;
      z += data.points[3 * facets.nodes[n] + 2] / size;
    }
    constexpr Index perRow = 10, perPatch = 1000;
    ids.push_back(
      perPatch * facets.patch[i] + perRow * static_cast<Index>(y) + static_cast<Index>(z));
  }
  ids.push_back(-1); // so that there is an address where there is no facet
  return ids;
}

/// @param pieceOf the piece of a cell; pieces are dealt to the ranks in turn
template <class PieceOf>
Measured measurePieces(const MeshData& data, const Facets& facetsOf,
  const std::vector<FacePatch>& patches, int ranks, int pieces, const PieceOf& pieceOf, bool ghosts)
{
  Measured all;
  all.values.assign(faceMetrics().size(), std::vector<double>(data.numberOfCells(), std::nan("")));
  std::mutex mutex;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      std::vector<MeasuredPiece> own;
      for (int piece = group.rank(); piece < pieces; piece += ranks)
      {
        own.emplace_back();
        MeasuredPiece& made = own.back();
        made.part = partOf(data, piece, pieceOf, ghosts);
        const MeshData& mine = made.part.data;
        const ListedFacets facets = facetsOf(mine, faceMeshOf(mine));
        made.mesh = findFaces(mine.numberOfPoints(), facesOf(mine), facets, patches);
        made.facetIds = idsOf(mine, facets);
        made.points = mine.points;
        if (ghosts)
        {
          made.mesh.foreignCells = made.part.ghosts;
        }
      }
      std::vector<FacePiece> list;
      for (MeasuredPiece& piece : own)
      {
        list.push_back({ &piece.mesh, piece.points.data(), nullptr, piece.facetIds.data() });
      }
      if (patches.empty())
      {
        markLayer(group, list);
      }
      const auto added = joinPieces(group, list);
      std::vector<FaceMeasures> measures;
      std::vector<FaceMeasures*> pointers;
      measures.reserve(own.size());
      for (std::size_t i = 0; i < own.size(); ++i)
      {
        own[i].points.insert(own[i].points.end(), added[i].begin(), added[i].end());
        measures.emplace_back(own[i].mesh, own[i].points.data(), FaceConvention::Esi);
        pointers.push_back(&measures.back());
      }
      joinMeasures(group, pointers);
      std::vector<MeshCheckReport> reports;
      reports.reserve(own.size());
      std::vector<MeshCheckReport*> reportList;
      for (std::size_t i = 0; i < own.size(); ++i)
      {
        reports.push_back(checkMesh(measures[i], own[i].points.data()));
        reportList.push_back(&reports.back());
      }
      const std::vector<MeshCheck> checks = joinReports(group, reportList);
      const std::lock_guard<std::mutex> lock(mutex);
      all.checks = checks;
      const std::vector<Metric> metrics = faceMetrics();
      for (std::size_t m = 0; m < metrics.size(); ++m)
      {
        for (std::size_t i = 0; i < own.size(); ++i)
        {
          const std::vector<double> values = measures[i].evaluate(metrics[m]).cells;
          for (std::size_t cell = 0; cell < own[i].part.cellOf.size(); ++cell)
          {
            if (own[i].mesh.ownsCell(static_cast<Index>(cell)))
            {
              all.values[m][own[i].part.cellOf[cell]] = values[cell];
            }
          }
        }
      }
    });
  return all;
}

void checkSame(double one, double many)
{
  constexpr double rounding = 1e-9;
  TAUTLINE_CHECK_NEAR(many, one, rounding * std::max(1.0, std::abs(one)));
}

void compare(const Measured& whole, const Measured& pieces)
{
  const std::vector<Metric> metrics = faceMetrics();
  for (std::size_t m = 0; m < metrics.size(); ++m)
  {
    const Context context(metricInfo(metrics[m]).name);
    TAUTLINE_EACH(
      std::size_t, i, whole.values[m].size(), checkSame(whole.values[m][i], pieces.values[m][i]));
  }
  for (std::size_t i = 0; i < whole.checks.size(); ++i)
  {
    const MeshCheck &one = whole.checks[i], &many = pieces.checks[i];
    const Context context(one.name);
    TAUTLINE_CHECK_EQUAL(one.offending, many.offending);
    TAUTLINE_CHECK_EQUAL(one.warned, many.warned);
    TAUTLINE_CHECK(one.mean == 0 || one.weight == many.weight);
    checkSame(one.least, many.least);
    checkSame(one.most, many.most);
    checkSame(one.mean, many.mean);
    checkSame(one.limit, many.limit);
  }
}

ListedFacets noFacets(const MeshData&, const FaceMesh&)
{
  return {};
}
}

/// Tangled hexahedra, of which many checks fail, in pieces whose borders are rough.
TAUTLINE_PART(testTangledPieces)
{
  const MeshData data = jittered(CellType::Hexahedron, 5, 1.5);
  const Facets wall = [](const MeshData& part, const FaceMesh& mesh)
  {
    ListedFacets facets;
    addFacets(facets, mesh, 0, part, [](const Vec3& p) { return p[0] == 0; });
    return facets;
  };
  const std::vector<FacePatch> patches = { patchOf("wall", "wall") };
  const Measured whole = measureWhole(data, wall, patches);
  TAUTLINE_CHECK(whole.checks[static_cast<std::size_t>(MeshCheckKind::FaceSkewness)].offending > 0);
  TAUTLINE_CHECK(
    whole.checks[static_cast<std::size_t>(MeshCheckKind::PyramidVolume)].offending > 0);
  const auto rough = [](Index cell) { return static_cast<int>((cell * 7 / 3) % 5); };
  for (const bool ghosts : { false, true })
  {
    for (const int ranks : { 1, 2, 5, 7 })
    {
      const Context context(std::to_string(ranks) + (ghosts ? " ranks, ghosts" : " ranks"));
      compare(whole, measurePieces(data, wall, patches, ranks, 5, rough, ghosts));
    }
  }
}

/// A layer is also one layer in pieces, one of which is a row of cells: edges askew are counted
/// once.
TAUTLINE_PART(testLayerPieces)
{
  MeshData data = blockMesh(CellType::Hexahedron, 6, 5, 1);
  Random random(3);
  data.transform(
    [&](const Vec3& p)
    {
      const Vec3 d = random.vector(-0.2, 0.2);
      return p + Vec3{ d[0], d[1], 0 };
    });
  const Measured whole = measureWhole(data, noFacets, {});
  TAUTLINE_CHECK(
    whole.checks[static_cast<std::size_t>(MeshCheckKind::EdgeAlignment)].offending > 0);
  const auto rows = [](Index cell) { return static_cast<int>(cell / 6); };
  compare(whole, measurePieces(data, noFacets, {}, 3, 5, rows, false));
}

/// Periodic sides whose halves are in different pieces, and in one.
TAUTLINE_PART(testCyclicPieces)
{
  constexpr Index size = 4;
  constexpr double length = size;
  MeshData data = blockMesh(CellType::Hexahedron, size, size, size);
  const Facets sides = [](const MeshData& part, const FaceMesh& mesh)
  {
    ListedFacets facets;
    addFacets(facets, mesh, 0, part, [](const Vec3& p) { return p[0] < 0.5; });
    addFacets(facets, mesh, 1, part, [](const Vec3& p) { return p[0] > length - 0.5; });
    return facets;
  };
  data.transform(
    [](const Vec3& p)
    {
      const double x = 2 * Pi * p[0] / length, y = std::sin(Pi * p[1] / length);
      return p + Vec3{ 0.4 * y * std::sin(x), 0.4 * y * std::cos(x + p[2]), 0 };
    });
  const std::vector<FacePatch> patches = { patchOf("a", "cyclic", 1), patchOf("b", "cyclic", 0) };
  const Measured whole = measureWhole(data, sides, patches);
  TAUTLINE_CHECK_EQUAL(
    whole.checks[static_cast<std::size_t>(MeshCheckKind::CoupledPoints)].offending, 0);
  TAUTLINE_CHECK(whole.checks[static_cast<std::size_t>(MeshCheckKind::NonOrthogonality)].most > 10);
  const auto column = [](Index cell) { return cell % size; };
  const auto row = [](Index cell) { return cell / size % size; };
  const auto slabs = [&](Index cell) { return static_cast<int>(2 * column(cell) / size); };
  // Each piece has as many faces of one half as of the other, of which none belong together.
  const auto crossed = [&](Index cell)
  { return static_cast<int>((2 * column(cell) / size + 2 * row(cell) / size) % 2); };
  const auto rough = [](Index cell) { return static_cast<int>(cell * 7 / 3 % 5); };
  compare(whole, measurePieces(data, sides, patches, 2, 2, slabs, false));
  compare(whole, measurePieces(data, sides, patches, 2, 2, crossed, false));
  compare(whole, measurePieces(data, sides, patches, 3, 5, rough, true));
}

/// Points of short edges on the border count once.
TAUTLINE_PART(testShortEdges)
{
  MeshData data = blockMesh(CellType::Hexahedron, 4, 4, 4);
  data.transform(
    [](const Vec3& p) {
      return Vec3{ p[0] > 1.5 && p[0] < 2.5 ? 1 + 1e-7 : p[0], p[1], p[2] };
    });
  const Measured whole = measureWhole(data, noFacets, {});
  TAUTLINE_CHECK_EQUAL(
    whole.checks[static_cast<std::size_t>(MeshCheckKind::EdgeLength)].offending, 50);
  const auto slabs = [](Index cell) { return static_cast<int>((cell / 4) % 4 / 2); };
  compare(whole, measurePieces(data, noFacets, {}, 2, 2, slabs, false));
}

/// Cells in three pieces that share a face are reported on all ranks.
TAUTLINE_PART(testOverlappingPieces)
{
  const MeshData data = blockMesh(CellType::Hexahedron, 1, 1, 1);
  const auto work = [&](RankGroup& group)
  {
    FaceMesh mesh = faceMeshOf(data);
    joinPieces(group, { { &mesh, data.points.data() } });
  };
  TAUTLINE_CHECK_THROWS(onRanks(3, work), wording("remove-duplicate-and-overlapping-cells"));
  // Two copies of a cell are neighbors across each face.
  onRanks(2, work);
}

/// A baffle between two pieces stays one; a facet on one side alone does not part them.
TAUTLINE_PART(testBaffleBetweenPieces)
{
  const MeshData data = blockMesh(CellType::Hexahedron, 2, 1, 1);
  for (const bool both : { true, false })
  {
    onRanks(2,
      [&](RankGroup& group)
      {
        const RankPart part =
          partOf(data, group.rank(), [](Index cell) { return static_cast<int>(cell); });
        ListedFacets facets;
        if (both || group.rank() == 0)
        {
          const double middle = 1;
          addFacets(facets, faceMeshOf(part.data), 0, part.data,
            [=](const Vec3& p) { return p[0] == middle; });
        }
        FaceMesh mesh = findFaces(
          part.data.numberOfPoints(), facesOf(part.data), facets, { patchOf("baffle", "wall") });
        joinPieces(group, { { &mesh, part.data.points.data() } });
        Index coupled = 0;
        for (Index face = mesh.internalFaces; face < mesh.faces(); ++face)
        {
          coupled += mesh.coupled(face) >= 0 && mesh.touches(face);
        }
        TAUTLINE_CHECK_EQUAL(coupled, both ? 0 : 1);
      });
  }
}
}
