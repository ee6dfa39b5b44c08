// SPDX-License-Identifier: BSD-3-Clause
// Perturbation: nothing inverts, steps are within the fraction, tangling meets its fraction, and
// the same seed gives the same mesh.
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Mesh/CurvedCells.h"
#include "tautline/Mesh/FollowingNodes.h"
#include "tautline/Perturbation/Perturb.h"
#include "vtkMeshPerturbation.h"
#include "vtkSphereSource.h"
#include "vtkStructuredGrid.h"
#include "vtkTriangleFilter.h"

using namespace tautline;

namespace
{
/// Squares or cubes of which every other one is cut into triangles or pyramids.
MeshData mixedMesh(bool flat, Index n)
{
  const MeshData whole =
    blockMesh(flat ? CellType::Quadrilateral : CellType::Hexahedron, n, n, flat ? 0 : n);
  const MeshData cut = blockMesh(flat ? CellType::Triangle : CellType::Pyramid, n, n, flat ? 0 : n);
  const Index parts = flat ? 2 : 6;
  TAUTLINE_LET(MeshData, mixed, points = whole.points);
  for (Index i = 0; i < whole.numberOfCells(); ++i)
  {
    if (i % 2 == 0)
    {
      mixed.addCell(int(whole.types[i]),
        { whole.connectivity.begin() + whole.offsets[i],
          whole.connectivity.begin() + whole.offsets[i + 1] });
      continue;
    }
    const Index apex = flat ? -1 : mixed.addPoint(cut.point(whole.numberOfPoints() + i));
    for (Index c = parts * i; c < parts * (i + 1); ++c)
    {
      std::vector<Index> nodes = cut.nodes(c);
      if (!flat)
      {
        nodes[4] = apex;
      }
      mixed.addCell(int(cut.types[c]), nodes);
    }
  }
  return mixed;
}

/// A mesh to perturb, and the number of its interior vertices.
struct Sample
{
  std::string name;
  MeshData mesh;
  Index interior;
};

std::vector<Sample> samples()
{
  std::vector<Sample> all;
  for (CellType type : allTypes)
  {
    const bool flat = topology(type).dimension == 2;
    const Index extra = type == CellType::Pyramid ? 216 : 0;
    all.push_back({ topology(type).name,
      blockMesh(type, flat ? 20 : 6, flat ? 20 : 6, flat ? 0 : 6), flat ? 361 : 125 + extra });
  }
  all.push_back({ "mixed flat", mixedMesh(true, 21), 400 });
  all.push_back({ "mixed solid", mixedMesh(false, 5), 64 + 62 });
  return all;
}

MeshData moved(const MeshData& mesh, const Perturbation& result)
{
  return TAUTLINE_CHANGED(mesh, points = result.points);
}

Index count(const std::vector<signed char>& validity, signed char value)
{
  return std::count(validity.begin(), validity.end(), value);
}

TAUTLINE_PART(testNothingInverts)
{
  for (const Sample& sample : samples())
  {
    const Context context(sample.name);
    const Mesh mesh(sample.mesh.view());
    for (double fraction : { 0.5, 1.0 })
    {
      TAUTLINE_LET(PerturbOptions, options, percentage = 100, fraction = fraction, seed = 11);
      const Perturbation result = perturb(mesh, nullptr, options);
      TAUTLINE_CHECK_EQUAL(result.movable, sample.interior);
      TAUTLINE_CHECK_EQUAL(result.moved, sample.interior);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
      TAUTLINE_CHECK(result.largestDisplacement > 0.3 * fraction);
      const auto validity = validityOf(moved(sample.mesh, result));
      TAUTLINE_CHECK_EQUAL(count(validity, Valid), sample.mesh.numberOfCells());
    }
  }
}

/// How far a vertex can go before a corner of a cell around it vanishes, by bisection.
double reach(const MeshData& mesh, const std::vector<Index>& cells, Index vertex, const Vec3& along)
{
  auto valid = [&](double distance)
  {
    const Vec3 p = mesh.point(vertex) + distance * along;
    for (Index cell : cells)
    {
      std::vector<Vec3> corners;
      for (Index n = mesh.offsets[cell]; n < mesh.offsets[cell + 1]; ++n)
      {
        const Index node = mesh.connectivity[n];
        corners.push_back(node == vertex ? p : mesh.point(node));
      }
      const auto sines = cornerSines(CellType(mesh.types[cell]), corners);
      if (*std::min_element(sines.begin(), sines.end()) <= 0)
      {
        return false;
      }
    }
    return true;
  };
  double low = 0, high = 100;
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (low + high);
    (valid(middle) ? low : high) = middle;
  }
  return low;
}

TAUTLINE_PART(testStepsAreWithinTheFraction)
{
  for (const Sample& sample : samples())
  {
    const Context context(sample.name);
    const Mesh mesh(sample.mesh.view());
    const VertexCells adjacency = mesh.vertexCells();
    TAUTLINE_LET(PerturbOptions, options, percentage = 80);
    const MeshData after = moved(sample.mesh, perturb(mesh, nullptr, options));
    // The vertices moved one after the other: follow them.
    MeshData now = sample.mesh;
    double sum = 0, largest = 0;
    Index steps = 0;
    for (Index v = 0; v < now.numberOfPoints(); ++v)
    {
      const Vec3 step = after.point(v) - now.point(v);
      if (norm(step) > 0)
      {
        const std::vector<Index> cells(adjacency.cells.begin() + adjacency.offsets[v],
          adjacency.cells.begin() + adjacency.offsets[v + 1]);
        const double part = norm(step) / reach(now, cells, v, (1 / norm(step)) * step);
        sum += part;
        largest = std::max(largest, part);
        ++steps;
        now.setPoint(v, after.point(v));
      }
    }
    TAUTLINE_CHECK_EQUAL(steps, Index(0.8 * double(sample.interior) + 0.5));
    TAUTLINE_CHECK(largest < 0.5 + 1e-9);
    TAUTLINE_CHECK(largest > 0.45);
    // The mean of evenly drawn parts, within four standard errors.
    TAUTLINE_CHECK_NEAR(sum / double(steps), 0.25, 4 * 0.5 / std::sqrt(12.0 * double(steps)));
  }
}

TAUTLINE_PART(testPercentageAndSeed)
{
  const MeshData data = blockMesh(CellType::Tetrahedron, 8, 8, 8);
  const Mesh mesh(data.view());
  PerturbOptions options;
  std::vector<char> before(data.numberOfPoints(), 0);
  for (double percentage : { 0.0, 5.0, 10.0, 25.0, 50.0, 100.0 })
  {
    options.percentage = percentage;
    const Perturbation result = perturb(mesh, nullptr, options);
    TAUTLINE_CHECK_EQUAL(result.moved, Index(percentage / 100 * 343 + 0.5));
    const MeshData after = moved(data, result);
    for (Index v = 0; v < data.numberOfPoints(); ++v)
    {
      const bool moves = after.point(v) != data.point(v);
      TAUTLINE_CHECK(moves || !before[v]); // the sets grow
      before[v] = moves;
    }
  }
  TAUTLINE_SET(options, percentage = 50, tangledFraction = 0.05, threads = 1);
  const std::vector<double> first = perturb(mesh, nullptr, options).points;
  options.threads = 2;
  TAUTLINE_CHECK(first == perturb(mesh, nullptr, options).points);
  options.seed = 1;
  TAUTLINE_CHECK(first != perturb(mesh, nullptr, options).points);
}

TAUTLINE_PART(testSameOnEveryMachine)
{
  const MeshData data = blockMesh(CellType::Quadrilateral, 2, 2, 0);
  TAUTLINE_LET(PerturbOptions, options, percentage = 100, seed = 42);
  const MeshData after = moved(data, perturb(Mesh(data.view()), nullptr, options));
  TAUTLINE_CHECK_NEAR(after.point(4)[0], 1.0481343153848104, 1e-15);
  TAUTLINE_CHECK_NEAR(after.point(4)[1], 0.9279608648967268, 1e-15);
}

TAUTLINE_PART(testTangling)
{
  for (const Sample& sample : samples())
  {
    const Mesh mesh(sample.mesh.view());
    for (double fraction : { 0.01, 0.1, 0.5, 0.8 })
    {
      const Context context(sample.name + " " + std::to_string(fraction));
      TAUTLINE_LET(PerturbOptions, options, tangledFraction = fraction);
      const Perturbation result = perturb(mesh, nullptr, options);
      const auto validity = validityOf(moved(sample.mesh, result));
      TAUTLINE_CHECK_EQUAL(result.elements, sample.mesh.numberOfCells());
      TAUTLINE_CHECK_EQUAL(count(validity, Inverted), result.invertedAfter);
      TAUTLINE_CHECK_EQUAL(count(validity, Degenerate), 0);
      TAUTLINE_CHECK_NEAR(
        double(result.invertedAfter), fraction * double(result.elements), 0.5 + 1e-9);
    }
  }
}

TAUTLINE_PART(testTanglingOneElement)
{
  // A single vertex can move; as little as one element is never overdone.
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    const MeshData data = blockMesh(type, 2, 2, flat ? 0 : 2);
    const Mesh mesh(data.view());
    Index reached = 0;
    for (std::uint64_t seed = 0; seed < 50; ++seed)
    {
      TAUTLINE_LET(
        PerturbOptions, options, seed = seed, tangledFraction = 1.0 / double(data.numberOfCells()));
      const Perturbation result = perturb(mesh, nullptr, options);
      TAUTLINE_CHECK(result.invertedAfter <= 1);
      reached += result.invertedAfter;
    }
    TAUTLINE_CHECK_EQUAL(reached, 50);
  }
}

TAUTLINE_PART(testTangledInput)
{
  // Perturbing a tangled mesh tangles no further element.
  const MeshData data = blockMesh(CellType::Tetrahedron, 6, 6, 6);
  TAUTLINE_LET(PerturbOptions, options, tangledFraction = 0.1);
  const MeshData tangled = moved(data, perturb(Mesh(data.view()), nullptr, options));
  TAUTLINE_SET(options, tangledFraction = 0.0, percentage = 100, seed = 5);
  const Perturbation again = perturb(Mesh(tangled.view()), nullptr, options);
  TAUTLINE_CHECK_EQUAL(again.invertedBefore, 108);
  TAUTLINE_CHECK_EQUAL(again.invertedAfter, 108);
  const auto before = validityOf(tangled), after = validityOf(moved(tangled, again));
  TAUTLINE_EACH(std::size_t, i, before.size(), TAUTLINE_CHECK(after[i] >= before[i]));
}

TAUTLINE_PART(testSurface)
{
  TAUTLINE_NEW(vtkSphereSource, sphere, SetThetaResolution(24), SetPhiResolution(24));
  TAUTLINE_NEW(vtkMeshPerturbation, filter, SetInputConnection(sphere->GetOutputPort()),
    SetPercentage(100), Update());
  vtkDataSet *before = filter->GetInput() ? vtkDataSet::SafeDownCast(filter->GetInput()) : nullptr,
             *after = filter->GetOutput();
  TAUTLINE_CHECK(vtkPolyData::SafeDownCast(after));
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMovedPoints(), before->GetNumberOfPoints());
  auto turned = [&]()
  {
    vtkIdType number = 0;
    for (vtkIdType cell = 0; cell < before->GetNumberOfCells(); ++cell)
    {
      Vec3 normal[2];
      vtkDataSet* sets[2] = { before, vtkDataSet::SafeDownCast(filter->GetOutput()) };
      for (int s = 0; s < 2; ++s)
      {
        Vec3 p[3];
        for (int k = 0; k < 3; ++k)
        {
          sets[s]->GetPoint(sets[s]->GetCell(cell)->GetPointId(k), p[k].data());
        }
        normal[s] = cross(p[1] - p[0], p[2] - p[0]);
      }
      number += dot(normal[0], normal[1]) <= 0;
    }
    return number;
  };
  TAUTLINE_CHECK_EQUAL(turned(), 0);
  for (vtkIdType v = 0; v < after->GetNumberOfPoints(); ++v)
  {
    Vec3 p;
    after->GetPoint(v, p.data());
    TAUTLINE_CHECK_NEAR(norm(p), 0.5, 0.05); // near the sphere: tangential
  }
  TAUTLINE_SET(filter, SetTangledFraction(0.1), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), turned());
  TAUTLINE_CHECK_NEAR(double(turned()), 0.1 * double(before->GetNumberOfCells()), 0.5);
}

TAUTLINE_PART(testTiltedPlane)
{
  MeshData data = blockMesh(CellType::Triangle, 10, 10, 0);
  const Columns turn = rotation({ 1, 2, 3 }, 0.7);
  data.transform([&](const Vec3& p) { return turn * p; });
  const Mesh mesh(data.view());
  TAUTLINE_LET(PerturbOptions, options, tangledFraction = 0.1);
  const Perturbation result = perturb(mesh, nullptr, options);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, 20);
  const MeshData after = moved(data, result);
  TAUTLINE_EACH(
    Index, v, data.numberOfPoints(), TAUTLINE_CHECK_NEAR(dot(after.point(v), turn[2]), 0, 1e-13));
}

TAUTLINE_PART(testFloatPoints)
{
  // Cells of eight units in the last place: rounding alone can invert them.
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    MeshData data = blockMesh(type, flat ? 20 : 6, flat ? 20 : 6, flat ? 0 : 6);
    data.transform(TAUTLINE_PLACE(1024 + p[0] / 1024, 1024 + p[1] / 1024, 1024 + p[2] / 1024));
    TAUTLINE_NEW(vtkMeshPerturbation, filter, SetInputData(toGrid(data, VTK_FLOAT)),
      SetPercentage(100), SetFraction(1.0), Update());
    auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutput());
    TAUTLINE_CHECK_EQUAL(output->GetPoints()->GetDataType(), VTK_FLOAT);
    TAUTLINE_CHECK(filter->GetNumberOfMovedPoints() > filter->GetNumberOfMovablePoints() / 2);
    const auto validity = validityOf(withPointsOf(data, output));
    TAUTLINE_CHECK_EQUAL(count(validity, Valid), data.numberOfCells());
    TAUTLINE_SET(filter, SetTangledFraction(0.1), Update());
    TAUTLINE_CHECK_EQUAL(count(validityOf(withPointsOf(data, output)), Inverted),
      Index(0.1 * double(data.numberOfCells()) + 0.5));
  }
}

TAUTLINE_PART(testWhatStays)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 6, 6, 6);
  auto grid = toGrid(data);
  TAUTLINE_NEW(vtkUnsignedCharArray, fixed, SetName("fixed"));
  TAUTLINE_NEW(vtkIdTypeArray, ids, SetName("ids"));
  for (Index v = 0; v < data.numberOfPoints(); ++v)
  {
    fixed->InsertNextValue(data.point(v)[0] <= 3);
    ids->InsertNextValue(v);
  }
  TAUTLINE_SET(grid, GetPointData()->AddArray(fixed), GetPointData()->AddArray(ids));
  TAUTLINE_NEW(
    vtkDoubleArray, cellData, SetName("c"), SetNumberOfTuples(data.numberOfCells()), FillValue(2));
  grid->GetCellData()->AddArray(cellData);

  TAUTLINE_NEW(vtkMeshPerturbation, filter, SetInputData(grid), SetPercentage(100),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "fixed"), Update());
  vtkDataSet* output = vtkDataSet::SafeDownCast(filter->GetOutput());
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMovedPoints(), 50);
  const MeshData after = withPointsOf(data, output);
  for (Index v = 0; v < data.numberOfPoints(); ++v)
  {
    const Vec3 p = data.point(v);
    const bool inside =
      *std::min_element(p.begin(), p.end()) > 0 && *std::max_element(p.begin(), p.end()) < 6;
    TAUTLINE_CHECK_EQUAL(after.point(v) != p, inside && p[0] > 3);
    TAUTLINE_EACH(int, c, 3,
      TAUTLINE_CHECK_EQUAL(
        component(output->GetPointData(), "Displacement", v, c), after.point(v)[c] - p[c]));
  }
  TAUTLINE_CHECK(output->GetPointData()->GetArray("ids") == ids);
  TAUTLINE_CHECK(output->GetCellData()->GetArray("c") == cellData);
  TAUTLINE_CHECK_EQUAL(grid->GetPointData()->GetNumberOfArrays(), 2);

  Messages messages(filter);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "other");
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("no-point-array-other")));
  TAUTLINE_CHECK_EQUAL(filter->GetOutput()->GetNumberOfElements(vtkDataObject::POINT), 0);

  // A line, and an interface of 2D cells, keep their points.
  data.addCell(VTK_LINE, { 7 * 7 * 3 + 7 * 3 + 3, 7 * 7 * 3 + 7 * 3 + 4 });
  data.addCell(
    CellType::Triangle, { 7 * 7 * 2 + 7 * 2 + 2, 7 * 7 * 2 + 7 * 2 + 3, 7 * 7 * 2 + 7 * 3 + 2 });
  TAUTLINE_CHECK_EQUAL(perturb(Mesh(data.view()), nullptr, {}).movable, 120);
  // A point with NaN coordinates keeps its neighbors.
  data.setPoint(7 * 7 * 5 + 7 * 5 + 5, { NAN, 0, 0 });
  const Perturbation result = perturb(Mesh(data.view()), nullptr, {});
  TAUTLINE_CHECK(result.movable < 120 && result.moved > 0 && result.invertedAfter == 0);
}

TAUTLINE_PART(testReversed)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 6, 6, 6);
  data.transform(TAUTLINE_PLACE(p[0], p[1], -p[2]));
  TAUTLINE_NEW(
    vtkMeshPerturbation, filter, SetInputData(toGrid(data)), SetPercentage(100), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMovedPoints(), 125);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  vtkDataSet* output = vtkDataSet::SafeDownCast(filter->GetOutput());
  TAUTLINE_CHECK_EQUAL(
    count(validityOf(withPointsOf(data, output)), Inverted), data.numberOfCells());
}

TAUTLINE_PART(testKindsOfInput)
{
  vtkNew<vtkMeshPerturbation> filter;
  Messages messages(filter);

  vtkNew<vtkUnstructuredGrid> nothing;
  TAUTLINE_SET(filter, SetInputData(nothing), Update());
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-cells")));
  messages.clear();

  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  blocks->SetBlock(0, toGrid(blockMesh(CellType::Hexahedron, 4, 4, 4)));
  blocks->SetBlock(1, toPolyData(blockMesh(CellType::Triangle, 4, 4, 0), VTK_FLOAT));
  TAUTLINE_SET(filter, SetInputData(blocks), Update());
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  TAUTLINE_CHECK(messages.empty());
  for (unsigned block = 0; output && block < 2; ++block)
  {
    TAUTLINE_CHECK_EQUAL(std::string(output->GetBlock(block)->GetClassName()),
      std::string(blocks->GetBlock(block)->GetClassName()));
    auto* mesh = vtkDataSet::SafeDownCast(output->GetBlock(block));
    TAUTLINE_CHECK(mesh->GetPointData()->GetArray("Displacement")->GetMaxNorm() > 0);
  }
  TAUTLINE_CHECK(output != nullptr);

  TAUTLINE_NEW(vtkStructuredGrid, structured, SetDimensions(4, 4, 4),
    SetPoints(toPoints(blockMesh(CellType::Hexahedron, 3, 3, 3))));
  TAUTLINE_SET(filter, SetInputData(structured), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMovablePoints(), 8);
  TAUTLINE_CHECK(outputOf<vtkStructuredGrid>(filter));
  TAUTLINE_CHECK(messages.empty());

  TAUTLINE_NEW(vtkImageData, image, SetDimensions(3, 3, 3));
  TAUTLINE_SET(filter, SetInputData(image), Update());
  TAUTLINE_CHECK(messages.has(wording("run-image-data-to-point-set")));

  messages.clear();
  TAUTLINE_LET(MeshData, pentagon,
    addPoints({ { 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }));
  pentagon.addCell(VTK_POLYGON, { 0, 3, 1, 4, 2 });
  TAUTLINE_SET(filter, SetInputData(toPolyData(pentagon)), Update());
  TAUTLINE_CHECK(messages.has(wording("run-tetrahedralize-first")));
}

/// Corners move, the other nodes follow; no valid curved cell becomes invalid unless asked.
TAUTLINE_PART(testCurvedCells)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Context context(topology(type).name);
    const bool flat = type == CellType::Triangle;
    const Index n = flat ? 12 : 4;
    MeshData data = quadraticOf(blockMesh(type, n, n, flat ? 0 : n));
    data.transform(
      [&](const Vec3& p)
      {
        const double bend =
          0.2 * std::sin(M_PI * p[0]) * std::sin(M_PI * p[1]) * (flat ? 1 : std::cos(M_PI * p[2]));
        return p + bend * Vec3{ 1, -0.7, flat ? 0 : 0.5 };
      });
    const auto invalid = [&](const MeshData& mesh)
    {
      std::vector<signed char> validity(mesh.numberOfCells());
      const Mesh view(mesh.view());
      view.classifyCells(validity.data());
      certifyCurvedCells(view, {}, validity.data(), nullptr);
      return static_cast<Index>(std::count_if(validity.begin(), validity.end(), isInvalid));
    };
    TAUTLINE_CHECK_EQUAL(invalid(data), 0);
    vtkNew<vtkMeshPerturbation> filter;
    Messages messages(filter);
    TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetPercentage(100), SetFraction(1), Update());
    const MeshData moved = withPointsOf(data, filter->GetOutput());
    TAUTLINE_CHECK(messages.empty());
    TAUTLINE_CHECK(filter->GetNumberOfMovedPoints() > (flat ? 60 : 15));
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
    TAUTLINE_CHECK_EQUAL(invalid(moved), 0);
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("corners-moved-less-than-drawn")));
    // Nodes inside have moved, nodes on the boundary have not.
    const FollowingNodes nodes(Mesh(data.view()));
    Index followed = 0;
    for (const Index i : nodes.points())
    {
      const bool still = norm(moved.point(i) - data.point(i)) == 0;
      TAUTLINE_CHECK(still || !nodes.boundary()[i]);
      followed += !still;
    }
    TAUTLINE_CHECK(followed > (flat ? 200 : 100));
    TAUTLINE_SET(filter, SetPercentage(20), SetFraction(0.5), SetTangledFraction(0.1), Update());
    TAUTLINE_CHECK_EQUAL(
      filter->GetInvertedAfter(), invalid(withPointsOf(data, filter->GetOutput())));
    TAUTLINE_CHECK(filter->GetTangledFractionReached() >= 0.09);
  }
}

TAUTLINE_PART(testAbortAndProgress)
{
  const MeshData data = blockMesh(CellType::Triangle, 100, 100, 0);
  TAUTLINE_NEW(vtkMeshPerturbation, filter, SetInputData(toGrid(data)), SetPercentage(100));
  stopAt(filter, vtkCommand::ProgressEvent, 0.4);
  filter->Update();
  TAUTLINE_CHECK(filter->GetNumberOfMovedPoints() > 3000);
  TAUTLINE_CHECK(filter->GetNumberOfMovedPoints() < 6000);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("stopped-early")));
}

TAUTLINE_PART(testRejectedOptions)
{
  const MeshData data = blockMesh(CellType::Triangle, 3, 3, 0);
  TAUTLINE_LET(PerturbOptions, options, percentage = 101);
  TAUTLINE_CHECK_THROWS(perturb(Mesh(data.view()), nullptr, options), wording("between-0-and-100"));
}

} // anonymous namespace
