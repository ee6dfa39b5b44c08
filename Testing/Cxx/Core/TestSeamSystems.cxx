// SPDX-License-Identifier: BSD-3-Clause
// Meshes in pieces, with several points at each place of their seams: linear systems and nonlocal
// models on them equal the results of the whole mesh; blocks with seams between them.
#include "Registry.h"
#include "Seams.h"
#include "vtkConditionEstimator.h"
#include "vtkEllipticSolver.h"
#include "vtkInteractionLayer.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkPeridynamicStiffness.h"
#include "vtkSolverStudy.h"

using namespace tautline;

namespace
{
constexpr double Tight = 1e-12;

TAUTLINE_PART(testElliptic)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const Case both = quarters(type, 4, 0.1);
    vtkNew<vtkEllipticSolver> pieces, whole;
    Messages messages(pieces);
    for (vtkEllipticSolver* each : { pieces.Get(), whole.Get() })
    {
      each->SetRelativeTolerance(Tight);
    }
    runBoth(both, pieces.Get(), whole.Get());
    TAUTLINE_CHECK(messages.empty());
    TAUTLINE_CHECK_EQUAL(pieces->GetUnknowns(), whole->GetUnknowns());
    const double largest = pointsOf(whole)->GetPointData()->GetArray("Solution")->GetRange()[1];
    TAUTLINE_CHECK(largest > 0.1);
    TAUTLINE_CHECK_NEAR(
      farthest(both, pointsOf(pieces), pointsOf(whole), "Solution"), 0, 1e-12 * largest);
    vtkDataArray* a = pointsOf(pieces)->GetCellData()->GetArray("Gradient");
    vtkDataArray* b = pointsOf(whole)->GetCellData()->GetArray("Gradient");
    for (vtkIdType i = 0; TAUTLINE_CHECK(a && b) && i < b->GetNumberOfTuples(); ++i)
    {
      TAUTLINE_CHECK_NEAR(a->GetComponent(i, 1), b->GetComponent(i, 1), 1e-10);
    }
    TAUTLINE_CHECK(contains(pieces->GetSummary(), said(both)));
    TAUTLINE_CHECK(!contains(pieces->GetSummary(), wording("in-no-element")));
    // Kept apart, the solution is 0 on the seams.
    TAUTLINE_SET(pieces, MergeCoincidentPointsOff(), Update());
    TAUTLINE_CHECK(pieces->GetUnknowns() < whole->GetUnknowns());
    TAUTLINE_CHECK(
      pointsOf(pieces)->GetPointData()->GetArray("Solution")->GetRange()[1] < 0.9 * largest);
  }

  const Case both = quarters(CellType::Triangle, 8, 0.1);
  vtkNew<vtkConditionEstimator> pieces, whole;
  runBoth(both, pieces.Get(), whole.Get());
  TAUTLINE_CHECK(whole->GetCondition() > 5);
  TAUTLINE_CHECK_RELATIVE(pieces->GetCondition(), whole->GetCondition(), 1e-12);
  vtkDataArray* a = pointsOf(pieces)->GetCellData()->GetArray("Share");
  vtkDataArray* b = pointsOf(whole)->GetCellData()->GetArray("Share");
  for (vtkIdType i = 0; TAUTLINE_CHECK(a && b) && i < b->GetNumberOfTuples(); ++i)
  {
    TAUTLINE_CHECK_NEAR(a->GetComponent(i, 0), b->GetComponent(i, 0), 1e-10);
  }
  vtkNew<vtkSolverStudy> study, expected;
  runBoth(both, study.Get(), expected.Get());
  TAUTLINE_CHECK_EQUAL(study->GetUnknowns(), expected->GetUnknowns());

  // Values that differ between points that are one are no secret.
  const auto grid = toGrid(both.pieces.mesh);
  const auto ids = filledArray<vtkDoubleArray>(
    "ids", both.pieces.mesh.numberOfPoints(), [&](Index p) { return static_cast<double>(p); });
  grid->GetPointData()->AddArray(ids);
  TAUTLINE_SET(pieces, SetInputDataObject(0, grid), Update());
  TAUTLINE_CHECK(contains(pieces->GetSummary(), wording("values-differ-in-the-point-array-ids")));
  TAUTLINE_CHECK_EQUAL(
    component(pointsOf(pieces)->GetPointData(), "ids", ids->GetNumberOfTuples() - 1),
    static_cast<double>(ids->GetNumberOfTuples() - 1));

  // Two meshes at the same place.
  MeshData twice = both.whole;
  for (Index cell = 0; cell < both.whole.numberOfCells(); ++cell)
  {
    std::vector<Vec3> corners;
    for (Index n = both.whole.offsets[cell]; n < both.whole.offsets[cell + 1]; ++n)
    {
      corners.push_back(both.whole.point(both.whole.connectivity[n]));
    }
    twice.addCell(CellType::Triangle, corners);
  }
  vtkNew<vtkEllipticSolver> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputDataObject(0, toGrid(twice)), Update());
  TAUTLINE_CHECK(messages.has(wording("stay-apart")) && messages.has(wording("clean-to-grid")));
  TAUTLINE_CHECK_EQUAL(pointsOf(filter)->GetNumberOfPoints(), 0);
}

/// A data set per piece.
std::vector<vtkSmartPointer<vtkUnstructuredGrid>> gridsOf(const Case& both, double at)
{
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> grids;
  for (int q = 0; q < 4; ++q)
  {
    MeshData part;
    std::map<Index, Index> known;
    const MeshData& mesh = both.pieces.mesh;
    for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
    {
      const Vec3 c = centerOf(mesh, cell);
      if ((c[0] > at) + 2 * (c[1] > at) != q)
      {
        continue;
      }
      std::vector<Index> nodes;
      for (Index n = mesh.offsets[cell]; n < mesh.offsets[cell + 1]; ++n)
      {
        const Index p = mesh.connectivity[n];
        const auto [known_, fresh] = known.emplace(p, part.numberOfPoints());
        if (fresh)
        {
          part.addPoint(mesh.point(p));
        }
        nodes.push_back(known_->second);
      }
      part.addCell(static_cast<int>(mesh.types[cell]), nodes);
    }
    grids.push_back(toGrid(part));
  }
  return grids;
}

TAUTLINE_PART(testBlocks)
{
  const Case both = quarters(CellType::Triangle, 8, 0.1);
  const auto grids = gridsOf(both, 4.0);
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned int q = 0; q < 4; ++q)
  {
    blocks->SetBlock(q, grids[q]);
  }
  // Blocks with seams between them are one mesh to solve on.
  vtkNew<vtkEllipticSolver> solver, whole;
  Messages messages(solver);
  solver->SetInputDataObject(0, blocks);
  whole->SetInputDataObject(0, toGrid(both.whole));
  for (vtkEllipticSolver* each : { solver.Get(), whole.Get() })
  {
    TAUTLINE_SET(each, SetRelativeTolerance(Tight), Update());
  }
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(solver->GetUnknowns(), whole->GetUnknowns());
  auto* output = outputOf<vtkMultiBlockDataSet>(solver);
  double largest = 0;
  for (unsigned int q = 0; q < 4; ++q)
  {
    auto* part = vtkDataSet::SafeDownCast(output->GetBlock(q));
    TAUTLINE_CHECK_EQUAL(part->GetNumberOfPoints(), grids[q]->GetNumberOfPoints());
    largest = std::max(largest, part->GetPointData()->GetArray("Solution")->GetRange()[1]);
  }
  const double expected = pointsOf(whole)->GetPointData()->GetArray("Solution")->GetRange()[1];
  TAUTLINE_CHECK_RELATIVE(largest, expected, 1e-10);
  TAUTLINE_CHECK(contains(solver->GetSummary(), wording("blocks-with-a-seam-between-them-are")));
  TAUTLINE_CHECK(contains(solver->GetSummary(), wording("in-block-1-block-2-block-3")));
  TAUTLINE_SET(solver, MergeCoincidentPointsOff(), Update());
  TAUTLINE_CHECK(solver->GetUnknowns() < whole->GetUnknowns());

  // Filters that move points treat blocks one by one: a warning, or an error if seams would open.
  const auto check = [&](auto* filter)
  {
    const Context context(filter->GetClassName());
    Messages said(filter);
    TAUTLINE_SET(filter, SetInputDataObject(0, blocks), Update());
    TAUTLINE_CHECK(said.has(
      std::to_string(both.pieces.copies) + " points" + wording("points-of-a-block-coincide-with")));
    TAUTLINE_CHECK(said.has(wording("merge-blocks")));
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("merge-blocks")));
    TAUTLINE_CHECK(outputOf<vtkMultiBlockDataSet>(filter)->GetBlock(3)->GetNumberOfElements(
                     vtkDataObject::POINT) == grids[3]->GetNumberOfPoints());
    said.clear();
    TAUTLINE_SET(filter, SetMergeCoincidentPoints(false), Update());
    TAUTLINE_CHECK(said.empty());
  };
  vtkNew<vtkMeshOptimizer> optimizer;
  check(optimizer.Get());
  vtkNew<vtkMeshUntangler> untangler;
  check(untangler.Get());
  vtkNew<vtkMeshPerturbation> perturbation;
  check(perturbation.Get());
  TAUTLINE_CHECK(perturbation->GetNumberOfMovablePoints() == 4 * 9);
  vtkNew<vtkMeshOptimizer> sliding;
  Messages rejected(sliding);
  TAUTLINE_SET(
    sliding, SetInputDataObject(0, blocks), SetBoundary(vtkMeshOptimizer::SLIDING), Update());
  TAUTLINE_CHECK(rejected.has(wording("blocks-would-come-apart")));
  TAUTLINE_CHECK(rejected.has(wording("merge-blocks")));

  // Blocks at the same place are no neighbors, and neither are blocks that are far from each other.
  TAUTLINE_SET(
    blocks, SetBlock(1, grids[0]), SetBlock(2, toGrid(both.whole)), SetBlock(3, nullptr));
  vtkNew<vtkMeshOptimizer> quiet;
  Messages none(quiet);
  TAUTLINE_SET(quiet, SetInputDataObject(0, blocks), Update());
  TAUTLINE_CHECK(none.empty());
}

TAUTLINE_PART(testPeridynamics)
{
  MeshData square = blockMesh(CellType::Triangle, 8, 8, 0);
  square.transform([](Vec3 p) { return 0.125 * p; });
  const Case both(inQuarters(square, 0.5));
  vtkNew<vtkInteractionLayer> pieces, whole;
  runBoth(both, pieces.Get(), whole.Get());
  TAUTLINE_CHECK_EQUAL(
    pieces->GetOutput()->GetNumberOfCells(), whole->GetOutput()->GetNumberOfCells());
  TAUTLINE_CHECK_EQUAL(pieces->GetOutput()->GetNumberOfPoints(),
    whole->GetOutput()->GetNumberOfPoints() + both.pieces.copies);
  vtkNew<vtkPeridynamicStiffness> stiffness, expected;
  stiffness->SetInputDataObject(0, pieces->GetOutput());
  expected->SetInputDataObject(0, whole->GetOutput());
  for (vtkPeridynamicStiffness* each : { stiffness.Get(), expected.Get() })
  {
    TAUTLINE_SET(each, SetSolve(true), Update());
  }
  TAUTLINE_CHECK(expected->GetCondition() > 2);
  TAUTLINE_CHECK_RELATIVE(stiffness->GetCondition(), expected->GetCondition(), 1e-9);

  // The layer is also in pieces.
  MeshData layered;
  auto* grid = vtkUnstructuredGrid::SafeDownCast(whole->GetOutput());
  for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
  {
    const double* x = grid->GetPoint(p);
    layered.addPoint({ x[0], x[1], x[2] });
  }
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(cell, size, ids);
    layered.addCell(CellType::Triangle, std::vector<Index>{ ids[0], ids[1], ids[2] });
  }
  const Case cut(inQuarters(layered, 0.5));
  const auto copy = toGrid(cut.pieces.mesh), single = toGrid(cut.whole);
  copy->GetCellData()->AddArray(grid->GetCellData()->GetArray("Reference"));
  single->GetCellData()->AddArray(grid->GetCellData()->GetArray("Reference"));
  stiffness->SetInputDataObject(0, copy);
  expected->SetInputDataObject(0, single);
  stiffness->Update();
  expected->Update();
  TAUTLINE_CHECK_RELATIVE(stiffness->GetCondition(), expected->GetCondition(), 1e-12);
  TAUTLINE_CHECK_NEAR(farthest(cut, pointsOf(stiffness), pointsOf(expected), "Solution"), 0, 1e-12);
  TAUTLINE_CHECK_NEAR(farthest(cut, pointsOf(stiffness), pointsOf(expected), "Unknown"), 0, 0);
  TAUTLINE_CHECK(contains(stiffness->GetSummary(), wording("treated-as-one")));
  const double condition = expected->GetCondition();
  TAUTLINE_SET(stiffness, MergeCoincidentPointsOff(), Update());
  TAUTLINE_CHECK(std::abs(stiffness->GetCondition() / condition - 1) > 1e-3);
  // Blocks are one mesh.
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(1, copy));
  TAUTLINE_SET(stiffness, MergeCoincidentPointsOn(), SetInputDataObject(0, blocks), Update());
  TAUTLINE_CHECK_RELATIVE(stiffness->GetCondition(), condition, 1e-12);
  Messages messages(stiffness);
  MeshData twice = TAUTLINE_CHANGED(cut.whole,
    addCell(CellType::Triangle,
      std::vector<Index>(cut.whole.connectivity.begin(), cut.whole.connectivity.begin() + 3)));
  TAUTLINE_SET(stiffness, SetInputDataObject(0, toGrid(twice)), Update());
  TAUTLINE_CHECK(messages.has(wording("1-duplicate-cell-has-the-same-points")));
}
}
