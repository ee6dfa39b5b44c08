// SPDX-License-Identifier: BSD-3-Clause
// Hexahedra, wedges, pyramids and quadrilaterals that list points twice are measured and moved as
// what remains of them; the cells written keep their types and points.
#include "CollapsedMeshes.h"
#include "MeshAdapter.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Mesh/CollapsedCells.h"
#include "tautline/Mesh/PartSign.h"
#include "vtkElementQuality.h"
#include "vtkEllipticSolver.h"
#include "vtkMeshImprover.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshUntangler.h"

using namespace tautline;

namespace
{
double sizeOf(CellType type, const std::vector<Vec3>& places, const std::vector<Index>& nodes)
{
  MeshData data;
  data.addPoints(places);
  data.addCell(type, std::vector<Index>(nodes.begin(), nodes.begin() + topology(type).nodes));
  const Mesh mesh(data.view());
  return signedSize(mesh, topology(type), data.connectivity.data(), { 0.3, 0.2, 0.1 });
}

/// Every way to make ends of edges of a cell one: what remains has the volume of the given cell.
std::map<CellType, int> shapesOf(CellType type)
{
  const CellTopology& t = topology(type);
  Random random(3);
  std::map<CellType, int> found;
  for (int chosen = 1; chosen < 1 << t.edges; ++chosen)
  {
    std::vector<Index> nodes(t.nodes);
    std::iota(nodes.begin(), nodes.end(), Index(0));
    for (int e = 0; e < t.edges; ++e)
    {
      if (chosen >> e & 1)
      {
        const Index a = nodes[t.edgeNodes[e][0]], b = nodes[t.edgeNodes[e][1]];
        std::replace(nodes.begin(), nodes.end(), std::max(a, b), std::min(a, b));
      }
    }
    std::vector<Index> remaining = nodes;
    const CellType shape = remainingShape(type, remaining.data());
    ++found[shape];
    if (shape == CellType::Unsupported)
    {
      TAUTLINE_CHECK(remaining == nodes);
      continue;
    }
    std::vector<Vec3> places;
    for (int k = 0; k < t.nodes; ++k)
    {
      places.push_back(random.vector(0, 1));
    }
    const std::set<Index> distinct(nodes.begin(), nodes.end());
    TAUTLINE_CHECK_EQUAL(distinct.size(), static_cast<std::size_t>(topology(shape).nodes));
    // Over a quadrilateral cut along its other diagonal a tetrahedron is twice as large.
    const double is = sizeOf(shape, places, remaining), was = sizeOf(type, places, nodes);
    const bool cut = shape == CellType::Tetrahedron && std::abs(is - was) > 1e-14;
    TAUTLINE_CHECK_NEAR(is, cut ? 2 * was : was, 1e-14);
  }
  return found;
}

TAUTLINE_PART(testShapes)
{
  std::map<CellType, int> found = shapesOf(CellType::Hexahedron);
  for (CellType type :
    { CellType::Wedge, CellType::Pyramid, CellType::Tetrahedron, CellType::Unsupported })
  {
    TAUTLINE_CHECK(found[type] > 0);
  }
  // Two opposite edges of one of the six faces.
  TAUTLINE_CHECK_EQUAL(found[CellType::Wedge], 12);
  found = shapesOf(CellType::Wedge);
  TAUTLINE_CHECK(found[CellType::Pyramid] > 0 && found[CellType::Tetrahedron] > 0);
  TAUTLINE_CHECK(shapesOf(CellType::Pyramid)[CellType::Tetrahedron] > 0);
  TAUTLINE_CHECK_EQUAL(shapesOf(CellType::Tetrahedron)[CellType::Unsupported], 63);
  // LS-DYNA's tetrahedron: the last four and one more point of the base are one.
  std::vector<Index> nodes = { 0, 1, 2, 3, 3, 3, 3, 3 };
  TAUTLINE_CHECK(remainingShape(CellType::Hexahedron, nodes.data()) == CellType::Tetrahedron);
  const std::vector<Vec3> corners = idealCell(CellType::Tetrahedron);
  TAUTLINE_CHECK_NEAR(sizeOf(CellType::Tetrahedron, corners, nodes), std::sqrt(2.0) / 12.0, 1e-15);
  // Quadrilaterals.
  nodes = { 7, 8, 8, 9 };
  TAUTLINE_CHECK(remainingShape(CellType::Quadrilateral, nodes.data()) == CellType::Triangle);
  TAUTLINE_CHECK((nodes == std::vector<Index>{ 7, 8, 9, 9 }));
  nodes = { 7, 8, 7, 9 };
  TAUTLINE_CHECK(remainingShape(CellType::Quadrilateral, nodes.data()) == CellType::Unsupported);
  nodes = { 7, 8, 8, 7 };
  TAUTLINE_CHECK(remainingShape(CellType::Quadrilateral, nodes.data()) == CellType::Unsupported);
}

/// All metrics equal the metrics of the mesh of wedges, also with cells of 32 bits.
TAUTLINE_PART(testMetrics)
{
  const MeshData collapsed = wheel(true, 0.15), wedges = wheel(false, 0.15);
  const auto narrow = toGrid(collapsed);
  narrow->GetCells()->ConvertTo32BitStorage();
  for (const auto& grid : { toGrid(collapsed), narrow })
  {
    const MeshAdapter adapter(grid);
    const Mesh expected(wedges.view());
    TAUTLINE_CHECK_EQUAL(
      adapter.notice(), "12 hexahedra that list points twice are measured as wedges.");
    TAUTLINE_CHECK(validityOf(adapter.mesh()) == validityOf(expected));
    for (const MetricInfo& info : elementMetrics())
    {
      const std::vector<double> is = valuesOf(adapter.mesh(), info.metric),
                                was = valuesOf(expected, info.metric);
      TAUTLINE_EACH(std::size_t, i, was.size(),
        TAUTLINE_CHECK(is[i] == was[i] || (std::isnan(is[i]) && std::isnan(was[i])) ||
          std::abs(is[i] - was[i]) <= 1e-12 * std::abs(was[i])));
    }
  }
}

/// One cell that no shape remains of is named; the others are measured.
TAUTLINE_PART(testRemarks)
{
  MeshData data = wheel(true, 0);
  const Index last = data.offsets[data.numberOfCells() - 1];
  data.connectivity[last + 1] = data.connectivity[last]; // one edge
  const auto grid = toGrid(data);
  const MeshAdapter adapter(grid);
  TAUTLINE_CHECK(
    contains(adapter.notice(), "1 hexahedron that lists points twice leaves no other"));
  TAUTLINE_CHECK(contains(adapter.notice(), wording("measured-as-wedges")));
  const std::vector<signed char> validity = validityOf(adapter.mesh());
  TAUTLINE_CHECK_EQUAL(std::count(validity.begin(), validity.end(), Valid),
    static_cast<std::ptrdiff_t>(validity.size()) - 1);
  TAUTLINE_CHECK_EQUAL(static_cast<int>(validity.back()), static_cast<int>(Degenerate));
  // The corners of quadratic cells count, and the cells stay quadratic.
  MeshData quadratic;
  for (int k = 0; k < 20; ++k)
  {
    quadratic.addPoint({ 0.1 * k, 0.2, 0.3 });
  }
  const std::vector<Vec3> prism = idealCell(CellType::Wedge);
  for (int k = 0; k < 6; ++k)
  {
    quadratic.setPoint(k, prism[k]);
  }
  std::vector<Index> nodes = { 0, 2, 1, 0, 3, 5, 4, 3 };
  for (Index k = 8; k < 20; ++k)
  {
    nodes.push_back(k);
  }
  quadratic.addCell(VTK_QUADRATIC_HEXAHEDRON, nodes);
  const auto quadraticGrid = toGrid(quadratic);
  const MeshAdapter higher(quadraticGrid);
  TAUTLINE_CHECK_EQUAL(higher.mesh().higherOrderCells(), 1);
  TAUTLINE_CHECK(validityOf(higher.mesh())[0] == Valid);
}

template <class Filter, class Set>
void testMotion(const Set& set)
{
  const MeshData collapsed = wheel(true, 0.45), wedges = wheel(false, 0.45);
  std::vector<std::vector<double>> points;
  for (const MeshData* data : { &collapsed, &wedges })
  {
    const auto grid = toGrid(*data);
    TAUTLINE_NEW(Filter, filter, SetInputData(grid), SetThreads(1));
    set(filter.Get());
    filter->Update();
    const MeshData result = toMesh(outputOf<vtkUnstructuredGrid>(filter));
    TAUTLINE_CHECK(result.types == data->types);
    TAUTLINE_CHECK(result.connectivity == data->connectivity);
    TAUTLINE_CHECK(result.points != data->points);
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
    TAUTLINE_CHECK_EQUAL(
      contains(filter->GetSummary(), wording("measured-as-wedges")), data == &collapsed);
    points.push_back(result.points);
  }
  double most = largestOf<double>(
    0, points[0].size(), [&](std::size_t i) { return std::abs(points[0][i] - points[1][i]); });
  TAUTLINE_CHECK(most <= 1e-9);
}

TAUTLINE_PART(testFilters)
{
  testMotion<vtkMeshOptimizer>(
    [](vtkMeshOptimizer* filter)
    {
      filter->SetPreset(vtkMeshOptimizer::CUSTOM);
      filter->AddObjectiveByName("imr");
    });
  testMotion<vtkMeshUntangler>([](vtkMeshUntangler*) {});
  // Element Quality names them and writes the cells as they are.
  const auto grid = toGrid(wheel(true, 0.1));
  TAUTLINE_NEW(vtkElementQuality, quality, SetInputData(grid));
  const Messages messages(quality);
  quality->Update();
  TAUTLINE_CHECK(contains(quality->GetNotice(), wording("measured-as-wedges")));
  TAUTLINE_CHECK_EQUAL(outputOf(quality)->GetCellType(0), VTK_HEXAHEDRON);
  TAUTLINE_CHECK_EQUAL(component(outputOf(quality)->GetCellData(), "Validity", 0), 1.0);
  // Improve Mesh takes tetrahedra only.
  TAUTLINE_NEW(vtkMeshImprover, improver, SetInputData(grid));
  TAUTLINE_CHECK(contains(errorOf(improver), "Tetrahedralize"));
}

/// Solve PDE: the solution is the one on wedges.
TAUTLINE_PART(testSolver)
{
  std::vector<double> peaks;
  for (const bool collapsed : { true, false })
  {
    TAUTLINE_NEW(vtkEllipticSolver, solver, SetInputData(toGrid(wheel(collapsed, 0.1))),
      SetSourceValue(1), SetRelativeTolerance(1e-12), Update());
    vtkDataArray* values = outputOf(solver)->GetPointData()->GetArray("Solution");
    double peak = 0;
    for (vtkIdType p = 0; TAUTLINE_CHECK(values) && p < values->GetNumberOfTuples(); ++p)
    {
      peak = std::max(peak, values->GetComponent(p, 0));
    }
    peaks.push_back(peak);
  }
  TAUTLINE_CHECK(peaks[0] > 0);
  TAUTLINE_CHECK_RELATIVE(peaks[0], peaks[1], 1e-9);
}
}
