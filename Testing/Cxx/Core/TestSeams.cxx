// SPDX-License-Identifier: BSD-3-Clause
// Meshes in pieces, with several points at each place of their seams: filters that move or measure
// points take them as the whole mesh; duplicate cells; why no point is free.
#include "Registry.h"
#include "Seams.h"
#include "vtkElementQuality.h"
#include "vtkEllipticSolver.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkMeshWarp.h"

using namespace tautline;

namespace
{
TAUTLINE_PART(testOptimize)
{
  for (CellType type :
    { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const Case both = quarters(type, 6);
    for (int boundary : { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING })
    {
      vtkNew<vtkMeshOptimizer> pieces, whole;
      Messages messages(pieces);
      pieces->SetBoundary(boundary);
      whole->SetBoundary(boundary);
      runBoth(both, pieces.Get(), whole.Get());
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(whole->GetFreePoints() > 0);
      TAUTLINE_CHECK_EQUAL(pieces->GetFreePoints(), whole->GetFreePoints());
      TAUTLINE_CHECK_NEAR(farthest(both, pointsOf(pieces), pointsOf(whole)), 0, 1e-12);
      TAUTLINE_CHECK(contains(pieces->GetSummary(), said(both)));
      TAUTLINE_CHECK(!contains(whole->GetSummary(), "coincident"));
      TAUTLINE_CHECK_EQUAL(
        pointsOf(pieces)->GetNumberOfPoints(), both.pieces.mesh.numberOfPoints());
    }
    // Kept apart, the seams are boundary.
    TAUTLINE_NEW(vtkMeshOptimizer, apart, MergeCoincidentPointsOff(),
      SetInputDataObject(0, toGrid(both.pieces.mesh)), Update());
    const Mesh mesh(both.pieces.mesh.view());
    const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
    TAUTLINE_CHECK_EQUAL(apart->GetFreePoints(), std::count(boundary.begin(), boundary.end(), 0));
    TAUTLINE_CHECK(!contains(apart->GetSummary(), "coincident"));
  }
  // An array of fixed points that has one of several at a place, and limits.
  const Case both = quarters(CellType::Triangle, 6);
  Index copy = -1; // the last one inside
  const std::vector<char> boundary = Mesh(both.whole.view()).boundary().isBoundaryPoint;
  std::vector<char> seen(both.whole.numberOfPoints(), 0);
  for (Index p = 0; p < both.pieces.mesh.numberOfPoints(); ++p)
  {
    copy = seen[both.wholeId[p]] && !boundary[both.wholeId[p]] ? p : copy;
    seen[both.wholeId[p]] = 1;
  }
  TAUTLINE_CHECK(copy > 0);
  const auto grid = toGrid(both.pieces.mesh);
  vtkNew<vtkDoubleArray> marks, limits;
  marks->SetName("marks");
  limits->SetName("limits");
  for (Index p = 0; p < both.pieces.mesh.numberOfPoints(); ++p)
  {
    marks->InsertNextValue(p == copy);
    limits->InsertNextValue(p == copy ? 1e-3 : -1);
  }
  TAUTLINE_SET(grid, GetPointData()->AddArray(marks), GetPointData()->AddArray(limits));
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputDataObject(0, grid));
  const auto moved = [&]()
  {
    filter->Update();
    const double* d = pointsOf(filter)->GetPointData()->GetArray("Displacement")->GetTuple3(copy);
    return std::hypot(d[0], d[1]);
  };
  TAUTLINE_CHECK(moved() > 0.01);
  filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "limits");
  TAUTLINE_CHECK(moved() > 0 && moved() <= 1.001e-3);
  filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "marks");
  TAUTLINE_CHECK_EQUAL(moved(), 0.0);
}

TAUTLINE_PART(testUntangle)
{
  const Case both = quarters(CellType::Triangle, 8, 0.9);
  vtkNew<vtkMeshUntangler> pieces, whole;
  runBoth(both, pieces.Get(), whole.Get());
  TAUTLINE_CHECK(whole->GetInvertedBefore() > 10);
  TAUTLINE_CHECK_EQUAL(pieces->GetInvertedBefore(), whole->GetInvertedBefore());
  TAUTLINE_CHECK_EQUAL(pieces->GetInvertedAfter(), 0);
  TAUTLINE_CHECK_NEAR(farthest(both, pointsOf(pieces), pointsOf(whole)), 0, 1e-12);
  TAUTLINE_CHECK(contains(pieces->GetSummary(), wording("treated-as-one")));
  TAUTLINE_SET(pieces, MergeCoincidentPointsOff(), Update());
  TAUTLINE_CHECK(pieces->GetInvertedAfter() > 0); // tangled points of the seam stay
}

TAUTLINE_PART(testPerturb)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Case both = quarters(type, 6, 0.0);
    vtkNew<vtkMeshPerturbation> pieces, whole;
    pieces->SetPercentage(100);
    whole->SetPercentage(100);
    runBoth(both, pieces.Get(), whole.Get());
    TAUTLINE_CHECK_EQUAL(pieces->GetNumberOfMovablePoints(), whole->GetNumberOfMovablePoints());
    TAUTLINE_CHECK(contains(pieces->GetSummary(), said(both)));
    // All points of a place move together, also on the seams.
    MeshData moved = both.whole;
    for (Index p = both.pieces.mesh.numberOfPoints() - 1; p >= 0; --p)
    {
      Vec3 x;
      pointsOf(pieces)->GetPoint(p, x.data());
      moved.setPoint(both.wholeId[p], x);
    }
    Index seam = 0;
    std::vector<char> seen(both.whole.numberOfPoints(), 0);
    for (Index p = 0; p < both.pieces.mesh.numberOfPoints(); ++p)
    {
      Vec3 x;
      pointsOf(pieces)->GetPoint(p, x.data());
      TAUTLINE_CHECK(x == moved.point(both.wholeId[p]));
      seam += seen[both.wholeId[p]] && x != both.pieces.mesh.point(p);
      seen[both.wholeId[p]] = 1;
    }
    TAUTLINE_CHECK(seam > 5);
    const std::vector<signed char> validity = validityOf(moved);
    TAUTLINE_CHECK_EQUAL(
      std::count(validity.begin(), validity.end(), Valid), moved.numberOfCells());
  }
}

void addDisplacement(vtkDataSet* grid, double difference, Index at)
{
  TAUTLINE_NEW(vtkDoubleArray, displacement, SetName("Displacement"), SetNumberOfComponents(3));
  for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
  {
    const double* x = grid->GetPoint(p);
    displacement->InsertNextTuple3(
      0.1 * x[1] + (p == at ? difference : 0.0), 0.02 * x[0] * x[0], 0);
  }
  grid->GetPointData()->AddArray(displacement);
}

TAUTLINE_PART(testWarp)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Case both = quarters(type, 4, 0.1);
    for (int method : { vtkMeshWarp::FEMWARP, vtkMeshWarp::HYBRID, vtkMeshWarp::INVERSE_DISTANCE })
    {
      vtkNew<vtkMeshWarp> pieces, whole;
      Messages messages(pieces);
      const auto grid = toGrid(both.pieces.mesh), single = toGrid(both.whole);
      addDisplacement(grid, 0, -1);
      addDisplacement(single, 0, -1);
      for (vtkMeshWarp* each : { pieces.Get(), whole.Get() })
      {
        TAUTLINE_SET(each, SetMotion(vtkMeshWarp::DISPLACEMENT), SetMethod(method),
          SetInputDataObject(0, each == whole.Get() ? single : grid), Update());
      }
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK_NEAR(farthest(both, pointsOf(pieces), pointsOf(whole)), 0, 1e-12);
      TAUTLINE_CHECK(contains(pieces->GetSummary(), said(both)));
      // The same mesh again: nothing is recomputed.
      TAUTLINE_SET(pieces, SetAmount(0.5), Update());
      TAUTLINE_CHECK_EQUAL(pieces->GetReused(), 1);
    }
  }
  // Two points at a place on the boundary that are to move apart.
  const Case both = quarters(CellType::Triangle, 4, 0.1);
  const auto grid = toGrid(both.pieces.mesh);
  Index copy = -1;
  std::vector<char> seen(both.whole.numberOfPoints(), 0);
  for (Index p = 0; p < both.pieces.mesh.numberOfPoints(); ++p)
  {
    copy = seen[both.wholeId[p]] && both.pieces.mesh.point(p)[1] == 0 ? p : copy;
    seen[both.wholeId[p]] = 1;
  }
  addDisplacement(grid, 0.01, copy);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetMotion(vtkMeshWarp::DISPLACEMENT), SetInputDataObject(0, grid), Update());
  TAUTLINE_CHECK(messages.has(wording("different-displacements")));
  TAUTLINE_CHECK(messages.has(wording("switch-merge-coincident-points-off")));
  messages.clear();
  TAUTLINE_SET(filter, MergeCoincidentPointsOff(), Update());
  TAUTLINE_CHECK(messages.empty());
}

TAUTLINE_PART(testQuality)
{
  const Case both = quarters(CellType::Tetrahedron, 4, 0.1);
  vtkNew<vtkElementQuality> filter;
  Messages messages(filter);
  const auto notice = [&](const MeshData& data)
  {
    TAUTLINE_SET(filter, SetInputDataObject(0, toGrid(data)), Update());
    return std::string(filter->GetNotice());
  };
  TAUTLINE_CHECK_EQUAL(notice(both.whole), "");
  TAUTLINE_CHECK(messages.empty());
  const std::string text = notice(both.pieces.mesh);
  TAUTLINE_CHECK(contains(text,
    std::to_string(both.pieces.copies) +
      " points on 1 seam coincide with another one; the "
      "first is point "));
  TAUTLINE_CHECK(messages.has(wording("clean-to-grid")));
  MeshData nearly = both.pieces.mesh;
  for (Index p = 0; p < nearly.numberOfPoints() / 2; ++p)
  {
    nearly.points[3 * p] += 1e-9;
  }
  TAUTLINE_CHECK(contains(notice(nearly), wording("nearly-coincide-with-another-one")));
  MeshData twice = both.whole;
  for (Index cell : { 7, 9 })
  {
    twice.addCell(CellType::Tetrahedron,
      std::vector<Index>(
        twice.connectivity.begin() + 4 * cell, twice.connectivity.begin() + 4 * cell + 4));
  }
  const Index cells = both.whole.numberOfCells();
  TAUTLINE_CHECK(contains(notice(twice),
    "2 duplicate cells have the same points as another one: " + std::to_string(cells) +
      wording("duplicate-cell-of") + "7), " + std::to_string(cells + 1) +
      wording("duplicate-cell-of") + "9)."));
}

TAUTLINE_PART(testDuplicateCells)
{
  // The boundary is also fixed at duplicate cells.
  const MeshData data = rough(CellType::Tetrahedron, 4, 0.2);
  MeshData twice = data;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    twice.addCell(CellType::Tetrahedron,
      std::vector<Index>(
        data.connectivity.begin() + 4 * cell, data.connectivity.begin() + 4 * cell + 4));
  }
  MeshData some = data;
  for (Index cell = 0; cell < 5; ++cell) // at a corner of the block
  {
    some.addCell(CellType::Tetrahedron,
      std::vector<Index>(
        data.connectivity.begin() + 4 * cell, data.connectivity.begin() + 4 * cell + 4));
  }
  const auto check = [&](auto* filter)
  {
    for (const MeshData* mesh : std::initializer_list<const MeshData*>{ &data, &some, &twice })
    {
      TAUTLINE_SET(filter, SetInputDataObject(0, toGrid(*mesh)), Update());
      TAUTLINE_CHECK_EQUAL(
        contains(filter->GetSummary(), wording("the-same-points-as-another-one")), mesh != &data);
      const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
      Index moved = 0;
      for (Index p = 0; p < data.numberOfPoints(); ++p)
      {
        Vec3 x;
        pointsOf(filter)->GetPoint(p, x.data());
        TAUTLINE_CHECK(!boundary[p] || x == data.point(p));
        moved += x != data.point(p);
      }
      TAUTLINE_CHECK(moved > 10);
    }
  };
  vtkNew<vtkMeshOptimizer> optimizer;
  check(optimizer.Get());
  TAUTLINE_NEW(vtkMeshPerturbation, perturbation, SetPercentage(100));
  check(perturbation.Get());
  for (const MeshData* mesh : { &some, &twice })
  {
    vtkNew<vtkEllipticSolver> solver;
    Messages messages(solver);
    TAUTLINE_SET(solver, SetInputDataObject(0, toGrid(*mesh)), Update());
    TAUTLINE_CHECK(messages.has(wording("clean-cells-to-grid")));
  }
}

TAUTLINE_PART(testNothingFree)
{
  const Case all(exploded(blockMesh(CellType::Triangle, 4, 4, 0)));
  vtkNew<vtkMeshOptimizer> filter;
  const auto summary = [&](const MeshData& data)
  {
    TAUTLINE_SET(filter, SetInputDataObject(0, toGrid(data)), Update());
    return std::string(filter->GetSummary());
  };
  TAUTLINE_CHECK(!contains(summary(all.pieces.mesh), wording("no-vertex-is-free")));
  TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), 9);
  filter->MergeCoincidentPointsOff();
  std::string text = summary(all.pieces.mesh);
  TAUTLINE_CHECK(contains(text, wording("no-vertex-is-free")));
  TAUTLINE_CHECK(contains(text, wording("switch-merge-coincident-points-on-or-run")));
  filter->MergeCoincidentPointsOn();
  MeshData nearly = all.pieces.mesh;
  Random random(1);
  nearly.transform([&](Vec3 p) { return p + random.vector(-1e-9, 1e-9); });
  nearly.transform(TAUTLINE_PLACE(p[0], p[1], 0));
  TAUTLINE_CHECK(contains(summary(nearly), wording("run-clean-to-grid-with-a-tolerance")));
  text = summary(blockMesh(CellType::Triangle, 3, 1, 0));
  TAUTLINE_CHECK(contains(text, wording("every-point-is-on-the-boundary-of")));
  TAUTLINE_CHECK(contains(text, wording("choose-another-boundary-or-refine-the-mesh")));
  TAUTLINE_CHECK(!contains(text, wording("clean-to-grid")));
  const auto grid = toGrid(blockMesh(CellType::Triangle, 4, 4, 0));
  TAUTLINE_NEW(
    vtkDoubleArray, marks, SetName("marks"), SetNumberOfTuples(grid->GetNumberOfPoints()), Fill(1));
  grid->GetPointData()->AddArray(marks);
  TAUTLINE_SET(filter,
    SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "marks"),
    SetBoundary(vtkMeshOptimizer::FREE), SetInputDataObject(0, grid), Update());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("fixed-by-an-array-or-a-selection")));
  vtkNew<vtkMeshUntangler> untangler;
  MeshData tangled = blockMesh(CellType::Triangle, 3, 1, 0);
  std::swap(tangled.points[3 * 1], tangled.points[3 * 2]);
  TAUTLINE_SET(untangler, SetInputDataObject(0, toGrid(tangled)),
    SetBoundary(vtkMeshUntangler::FIXED), Update());
  TAUTLINE_CHECK(contains(untangler->GetSummary(), wording("choose-another-boundary")));
}
}
