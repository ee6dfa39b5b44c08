// SPDX-License-Identifier: BSD-3-Clause
// Boundary facets, edges and vertices listed beside the elements of a mesh, in any order, as in
// most files: every preset and optimizer moves points as without them.
#include "Optimizing.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshUntangler.h"

using namespace tautline;

namespace
{
struct Cells
{
  std::vector<std::pair<int, std::vector<Index>>> list; ///< VTK's type and points

  void add(int type, std::vector<Index> nodes) { this->list.emplace_back(type, std::move(nodes)); }
};

/// The facets of the elements that one of them has (the boundary), or two (inside).
Cells facetsOf(const MeshData& data, int uses)
{
  std::map<std::vector<Index>, std::pair<std::vector<Index>, int>> facets; // by sorted nodes
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const CellTopology& t = topology(static_cast<CellType>(data.types[c]));
    const Index* nodes = data.connectivity.data() + data.offsets[c];
    for (int f = 0; f < (t.dimension == 2 ? t.edges : t.faces); ++f)
    {
      auto facet = collect<Index>((t.dimension == 2 ? 2 : t.faceSizes[f]),
        [&](int k) { return nodes[t.dimension == 2 ? t.edgeNodes[f][k] : t.faceNodes[f][k]]; });
      std::vector<Index> key = facet;
      std::sort(key.begin(), key.end());
      auto& found = facets.emplace(key, std::pair(facet, 0)).first->second;
      ++found.second;
    }
  }
  Cells cells;
  for (const auto& [key, facet] : facets)
  {
    if (facet.second == uses)
    {
      constexpr int types[] = { VTK_LINE, VTK_TRIANGLE, VTK_QUAD };
      cells.add(types[facet.first.size() - 2], facet.first);
    }
  }
  return cells;
}

enum class Order
{
  Before,
  After,
  Between,
  EdgesToo, ///< after the elements, with edges and vertices
};

/// The mesh with its boundary facets, or those inside, as cells.
MeshData withFacets(const MeshData& data, Order order, int uses = 1)
{
  Cells facets = facetsOf(data, uses);
  if (order == Order::EdgesToo)
  {
    facets.add(VTK_LINE, { data.connectivity[0], data.connectivity[1] });
    facets.add(VTK_VERTEX, { data.connectivity[0] });
  }
  TAUTLINE_LET(MeshData, mixed, points = data.points);
  std::size_t next = 0;
  const auto addFacets = [&](std::size_t end)
  {
    for (; next < std::min(end, facets.list.size()); ++next)
    {
      mixed.addCell(facets.list[next].first, facets.list[next].second);
    }
  };
  addFacets(order == Order::Before ? facets.list.size() : 0);
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    mixed.addCell(data.types[c], data.nodes(c));
    addFacets(order == Order::Between ? next + 2 : 0);
  }
  addFacets(facets.list.size());
  return mixed;
}

/// Hexahedra of which one column is cut into wedges.
MeshData hexahedraAndWedges(Index n)
{
  const MeshData hexahedra = perturbedBlock(CellType::Hexahedron, n, 0.2);
  TAUTLINE_LET(MeshData, mixed, points = hexahedra.points);
  for (Index c = 0; c < hexahedra.numberOfCells(); ++c)
  {
    const Index* p = hexahedra.connectivity.data() + hexahedra.offsets[c];
    if (c % (n * n) == 1)
    {
      mixed.addCell(CellType::Wedge, { p[0], p[2], p[1], p[4], p[6], p[5] });
      mixed.addCell(CellType::Wedge, { p[0], p[3], p[2], p[4], p[7], p[6] });
    }
    else
    {
      mixed.addCell(CellType::Hexahedron, std::vector<Index>(p, p + 8));
    }
  }
  return mixed;
}

std::vector<double> pointsOf(vtkDataObject* output)
{
  return toMesh(vtkUnstructuredGrid::SafeDownCast(output)).points;
}

std::vector<double> optimized(const MeshData& data, int preset, int optimizer, int boundary)
{
  vtkNew<vtkMeshOptimizer> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetPreset(preset), SetBoundary(boundary),
    SetMaximumIterations(4), SetThreads(1));
  if (preset == vtkMeshOptimizer::CUSTOM)
  {
    TAUTLINE_SET(filter, AddObjectiveByName("imr"), SetOptimizer(optimizer));
  }
  filter->Update();
  TAUTLINE_CHECK(!messages.has("ERROR"));
  return pointsOf(filter->GetOutputDataObject(0));
}

std::vector<double> untangled(const MeshData& data)
{
  vtkNew<vtkMeshUntangler> filter;
  const Messages messages(filter); // elements of which all points are fixed may stay
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetThreads(1), Update());
  TAUTLINE_CHECK(filter->GetInvertedAfter() < filter->GetInvertedBefore());
  return pointsOf(filter->GetOutputDataObject(0));
}

/// @param expected without facets. Where the boundary moves, facets hold points of it: the elements
/// stay valid, and some points move.
void checkSame(const MeshData& data, const std::vector<double>& points,
  const std::vector<double>& expected, int boundary = vtkMeshOptimizer::FIXED)
{
  constexpr double rounding = 1e-9; // of sums in another order
  if (boundary != vtkMeshOptimizer::FIXED)
  {
    TAUTLINE_CHECK_EQUAL(invalid(data, points), Index(0));
    TAUTLINE_CHECK(points != data.points);
    return;
  }
  if (TAUTLINE_CHECK_EQUAL(points.size(), expected.size()))
  {
    double most = largestOf<double>(
      0, points.size(), [&](std::size_t i) { return std::abs(points[i] - expected[i]); });
    TAUTLINE_CHECK(most <= rounding);
  }
}

constexpr int boundaries[] = { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING,
  vtkMeshOptimizer::ON_SURFACE };
constexpr Order orders[] = { Order::Before, Order::After, Order::Between, Order::EdgesToo };

void testPresets(const MeshData& data)
{
  const bool simplices = std::all_of(data.types.begin(), data.types.end(),
    [](int t) { return t == VTK_TRIANGLE || t == VTK_TETRA; });
  for (const int boundary : boundaries)
  {
    for (int preset = vtkMeshOptimizer::FAST_CLEAN_UP; preset <= vtkMeshOptimizer::WORST_ELEMENT;
         ++preset)
    {
      // The metric of one preset is one of simplices; of another one the second input is needed.
      if ((preset == vtkMeshOptimizer::LOW_INTERPOLATION_ERROR && !simplices) ||
        preset == vtkMeshOptimizer::PRESERVE_SHAPE)
      {
        continue;
      }
      const std::vector<double> alone = optimized(data, preset, 0, boundary);
      TAUTLINE_CHECK(alone != data.points);
      for (const Order order : orders)
      {
        const Context context("preset " + std::to_string(preset) + ", boundary " +
          std::to_string(boundary) + ", order " + std::to_string(static_cast<int>(order)));
        checkSame(data, optimized(withFacets(data, order), preset, 0, boundary), alone, boundary);
      }
    }
  }
}

void testOptimizers(const MeshData& data)
{
  for (int optimizer = vtkMeshOptimizer::AUTOMATIC;
       optimizer <= vtkMeshOptimizer::NEWTON_CONJUGATE_GRADIENT; ++optimizer)
  {
    for (const int boundary : { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING })
    {
      const std::vector<double> alone =
        optimized(data, vtkMeshOptimizer::CUSTOM, optimizer, boundary);
      for (const Order order : orders)
      {
        const Context context("optimizer " + std::to_string(optimizer) + ", boundary " +
          std::to_string(boundary) + ", order " + std::to_string(static_cast<int>(order)));
        checkSame(data,
          optimized(withFacets(data, order), vtkMeshOptimizer::CUSTOM, optimizer, boundary), alone,
          boundary);
      }
    }
  }
}

void testUntangling(CellType type, Index n)
{
  const MeshData data = perturbedBlock(type, n, 0.6, 11);
  const std::vector<double> alone = untangled(data);
  for (const Order order : orders)
  {
    checkSame(data, untangled(withFacets(data, order)), alone);
  }
}

/// The elements are counted, and not the facets beside them, of which one has no area here.
TAUTLINE_PART(testCounts)
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 3, 0.2);
  MeshData mixed = withFacets(data, Order::EdgesToo);
  const Index corner = data.connectivity[0];
  const Index middle =
    mixed.addPoint(0.5 * (data.point(corner) + data.point(data.connectivity[1])));
  mixed.addCell(VTK_TRIANGLE, { corner, data.connectivity[1], middle });
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(mixed)), AddObjectiveByName("imr"),
    SetMaximumIterations(2), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedBefore(), 0);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  TAUTLINE_CHECK(contains(filter->GetSummary(),
    "Inverted elements: 0 before, 0 after, of " + std::to_string(data.numberOfCells()) + "."));
  TAUTLINE_NEW(vtkMeshUntangler, untangler, SetInputData(toGrid(mixed)), Update());
  TAUTLINE_CHECK_EQUAL(untangler->GetInvertedBefore(), 0);
}

/// A sheet of facets inside, as interfaces are: its points stay, whatever is chosen.
void testInside(const MeshData& data)
{
  const MeshData sheet = withFacets(data, Order::After, 2);
  for (int optimizer = vtkMeshOptimizer::AUTOMATIC;
       optimizer <= vtkMeshOptimizer::NEWTON_CONJUGATE_GRADIENT; ++optimizer)
  {
    vtkNew<vtkMeshOptimizer> filter;
    const Messages messages(filter); // nothing can move
    TAUTLINE_SET(filter, SetInputData(toGrid(sheet)), SetPreset(vtkMeshOptimizer::CUSTOM),
      AddObjectiveByName("imr"), SetOptimizer(optimizer), Update());
    TAUTLINE_CHECK(pointsOf(filter->GetOutputDataObject(0)) == data.points);
  }
}

void testAll(const MeshData& data)
{
  TAUTLINE_RUN(testPresets(data));
  TAUTLINE_RUN(testOptimizers(data));
  TAUTLINE_RUN(testInside(data));
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestFacetsBeside)
{
  for (const CellType type : allTypes)
  {
    const Context context(topology(type).plural);
    testAll(perturbedBlock(type, topology(type).dimension == 2 ? 5 : 3, 0.2));
  }
  {
    const Context context("hexahedra and wedges");
    testAll(hexahedraAndWedges(3));
  }
  TAUTLINE_RUN(testUntangling(CellType::Tetrahedron, 4));
  TAUTLINE_RUN(testUntangling(CellType::Hexahedron, 4));
  TAUTLINE_RUN(testUntangling(CellType::Triangle, 6));
}
