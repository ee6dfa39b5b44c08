// SPDX-License-Identifier: BSD-3-Clause
// The preparation before an optimization and the measurement after it: the same for any number of
// threads, and the values that are passed on equal a new measurement.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Core/CountingSort.h"
#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Patches/SimplexMesh.h"

using namespace tautline;

namespace
{
constexpr int Several = 4; // threads

/// Keys in an order that repeats, by several uses of an item: sorted, and in their order.
TAUTLINE_PART(testCountingSort)
{
  constexpr Index items = 200001; // more than one part
  constexpr std::int32_t keys = 1009;
  const auto keyOf = [](Index item, int use)
  { return static_cast<std::int32_t>((item * item + 7 * use) % keys); };
  std::vector<std::int32_t> expected;
  for (const int threads : { 1, Several })
  {
    CountingSort sort(items, keys, threads,
      [&](Index item, const auto& use)
      {
        for (int k = 0; k < item % 3; ++k)
        {
          use(keyOf(item, k));
        }
      });
    TAUTLINE_CHECK_EQUAL(sort.starts().back(), static_cast<std::int32_t>(items));
    std::vector<std::int32_t> found(items, -1); // one use for each item on the average
    const std::vector<std::int32_t> starts = sort.starts();
    std::atomic<bool> near{ true };
    bool within = true;
    sort.place(
      [&](Index item, const auto& placeOf)
      {
        for (int k = 0; k < item % 3; ++k)
        {
          const std::int32_t key = keyOf(item, k), place = placeOf(key);
          within = within && place >= starts[key] && place < starts[key + 1];
          found[place] = static_cast<std::int32_t>(item);
        }
      },
      [&](Index item, const auto& placeOf)
      {
        const std::int32_t key = keyOf(item, 0), place = placeOf(key);
        near = near && item < items && place >= starts[key] && place <= starts[key + 1];
      });
    TAUTLINE_CHECK(near);
    TAUTLINE_CHECK(within);
    bool ordered = true;
    for (std::int32_t key = 0; key < keys; ++key)
    {
      ordered =
        ordered && std::is_sorted(found.begin() + starts[key], found.begin() + starts[key + 1]);
    }
    TAUTLINE_CHECK(ordered);
    expected = expected.empty() ? found : expected;
    TAUTLINE_CHECK(found == expected);
  }
}

std::vector<std::int32_t> listOf(const SimplexMesh& s)
{
  const int corners = s.dimension() + 1;
  std::vector<std::int32_t> all;
  for (std::int32_t i = 0; i < s.simplices(); ++i)
  {
    all.insert(all.end(), s.corners() + corners * i, s.corners() + corners * (i + 1));
    all.push_back(static_cast<std::int32_t>(s.cell(i)));
  }
  for (std::int32_t v = 0; v <= s.freeVertices(); ++v)
  {
    all.push_back(s.patchStart(v));
  }
  const std::int32_t entries = s.patchStart(s.freeVertices());
  all.insert(all.end(), s.patchVertices(), s.patchVertices() + s.dimension() * entries);
  if (!s.uniform())
  {
    all.insert(all.end(), s.patchCorners(), s.patchCorners() + entries);
  }
  all.insert(all.end(), s.blocks().byColour.begin(), s.blocks().byColour.end());
  all.insert(all.end(), s.blocks().colourStarts.begin(), s.blocks().colourStarts.end());
  return all;
}

/// Each patch has the simplices of its vertex, and no others.
void checkPatches(const SimplexMesh& s)
{
  const int corners = s.dimension() + 1;
  std::vector<Index> count(s.freeVertices(), 0), sums(s.freeVertices(), 0);
  for (std::int32_t i = 0; i < s.simplices(); ++i)
  {
    const std::int32_t* corner = s.corners() + corners * i;
    Index sum = 0;
    std::for_each(corner, corner + corners, [&sum](std::int32_t v) { sum += v; });
    for (int k = 0; k < corners; ++k)
    {
      if (corner[k] < s.freeVertices())
      {
        ++count[corner[k]];
        sums[corner[k]] += sum - corner[k];
      }
    }
  }
  bool same = true;
  for (std::int32_t v = 0; v < s.freeVertices(); ++v)
  {
    Index sum = 0;
    for (std::int32_t i = s.dimension() * s.patchStart(v); i < s.dimension() * s.patchStart(v + 1);
         ++i)
    {
      sum += s.patchVertices()[i];
    }
    same = same && s.patchStart(v + 1) - s.patchStart(v) == count[v] && sum == sums[v];
  }
  TAUTLINE_CHECK(same);
}

/// The first cell once more, at the other end of the list: it is in another part.
void checkDuplicateAmongMany(MeshData data)
{
  const Index cells = data.numberOfCells();
  data.addCell(data.types[0],
    std::vector<Index>(data.connectivity.begin(), data.connectivity.begin() + data.offsets[1]));
  const std::vector<DuplicateCell> found = findSkin(Mesh(data.view()), Several).duplicates;
  TAUTLINE_CHECK_EQUAL(found.size(), std::size_t(1));
  TAUTLINE_CHECK(found.size() == 1 && found[0].cell == cells && found[0].original == 0);
}

/// For meshes large enough for several parts, of one cell type and of two.
TAUTLINE_PART(testSimplexMesh)
{
  for (const CellType type : { CellType::Tetrahedron, CellType::Triangle, CellType::Quadrilateral,
         CellType::Hexahedron, CellType::Wedge })
  {
    const Context context(topology(type).name);
    const Index n = topology(type).dimension == 2 ? 330 : type == CellType::Hexahedron ? 48 : 38;
    const MeshData data = perturbedBlock(type, n, 0.05);
    const Mesh mesh(data.view());
    TAUTLINE_CHECK(numberOfParts(mesh.view().numberOfCells, Several) > 1);
    const SimplexMesh one(mesh, nullptr, nullptr, 1), several(mesh, nullptr, nullptr, Several);
    TAUTLINE_CHECK(listOf(one) == listOf(several));
    TAUTLINE_CHECK_EQUAL(one.scale(), several.scale());
    TAUTLINE_CHECK_EQUAL(one.scale(), 1.0); // edges are about 1 long
    checkPatches(one);
    TAUTLINE_CHECK(findSkin(mesh, 1).boundaryPoints == findSkin(mesh, Several).boundaryPoints);
    TAUTLINE_CHECK(findSkin(mesh, Several).boundaryPoints == mesh.boundary().isBoundaryPoint);
    checkDuplicateAmongMany(data);
  }
}

/// A cell twice, also one without a point on the boundary, is found among the others.
TAUTLINE_PART(testDuplicates)
{
  for (const CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Triangle })
  {
    const Context context(topology(type).name);
    const Index n = 6;
    MeshData data = blockMesh(type, n, n, topology(type).dimension == 3 ? n : 0);
    const Index cells = data.numberOfCells();
    for (const Index cell : { cells / 2, Index(0) })
    {
      const std::vector<Index> nodes = data.nodes(cell);
      data.addCell(type, nodes);
    }
    const std::vector<DuplicateCell> found = findSkin(Mesh(data.view())).duplicates;
    TAUTLINE_CHECK_EQUAL(found.size(), std::size_t(2));
    TAUTLINE_CHECK(found.size() == 2 && found[0].original == cells / 2 && found[1].original == 0);
  }
}

/// The result's data on its elements equal a measurement on its points.
TAUTLINE_PART(testVerified)
{
  for (const CellType type : { CellType::Tetrahedron, CellType::Quadrilateral })
  {
    for (const Preset preset : { Preset::FastCleanUp, Preset::BestShape, Preset::WorstElement })
    {
      const Context context(topology(type).name);
      const MeshData data = perturbedBlock(type, 6, 0.2);
      const Mesh mesh(data.view());
      OptimizeOptions options;
      applyPreset(preset, options);
      const OptimizeResult result = optimize(mesh, options, validityOf(data));
      MeshData moved = TAUTLINE_CHANGED(data, points = result.points);
      TAUTLINE_CHECK(result.elements.validity == validityOf(moved));
      const bool sameMetric = type == CellType::Tetrahedron || preset != Preset::WorstElement;
      TAUTLINE_CHECK_EQUAL(result.elements.after.empty(), !sameMetric);
      TAUTLINE_CHECK_EQUAL(result.elements.before.empty(), !sameMetric);
      if (sameMetric)
      {
        TAUTLINE_CHECK(result.elements.before == valuesOf(data, Metric::InverseMeanRatio));
        TAUTLINE_CHECK(result.elements.after == valuesOf(moved, Metric::InverseMeanRatio));
      }
      TAUTLINE_CHECK(run(data, options).points == result.points);
    }
  }
}
}
