// SPDX-License-Identifier: BSD-3-Clause
// Untangle Mesh: valid, or a report of which elements remain, where and why.
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Perturbation/Perturb.h"
#include "tautline/Untangling/Untangle.h"
#include "vtkInterruption.h"
#include "vtkMeshUntangler.h"

using namespace tautline;

namespace
{
MeshData tangled(CellType type, Index n, double fraction)
{
  MeshData data = blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
  TAUTLINE_LET(PerturbOptions, options, fraction = 0.5, tangledFraction = fraction, seed = 7);
  data.points = perturb(Mesh(data.view()), nullptr, options).points;
  return data;
}

Index invalidOf(const MeshData& data)
{
  const auto validity = validityOf(data);
  return Index(validity.size()) - std::count(validity.begin(), validity.end(), Valid);
}

TAUTLINE_PART(testValid)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    const MeshData data = tangled(type, flat ? 10 : 4, 0.05);
    const Mesh mesh(data.view());
    const auto boundary = mesh.boundary().isBoundaryPoint;
    const std::vector<unsigned char> fixed(boundary.begin(), boundary.end());
    TAUTLINE_LET(UntangleOptions, options, fixed = fixed.data());
    const UntangleResult expected = untangle(mesh, options);
    vtkNew<vtkMeshUntangler> filter;
    Messages messages(filter);
    TAUTLINE_SET(filter, SetInputData(toGrid(data)), Update());
    const MeshData after = withPointsOf(data, meshOf(filter));
    TAUTLINE_CHECK(after.points == expected.points);
    TAUTLINE_CHECK(invalidOf(data) > 0);
    TAUTLINE_CHECK_EQUAL(invalidOf(after), 0);
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedBefore(), invalidOf(data));
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
    TAUTLINE_CHECK_EQUAL(filter->GetImpossible(), 0);
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("all-elements-are-valid")));
    TAUTLINE_CHECK(messages.empty());
    vtkTable* history = filter->GetHistory();
    TAUTLINE_CHECK_EQUAL(history->GetNumberOfRows(), Index(expected.history.size()));
    TAUTLINE_CHECK_EQUAL(
      history->GetValueByName(history->GetNumberOfRows() - 1, "Inverted").ToDouble(), 0);
    for (Index i = 0; i < data.numberOfCells(); ++i)
    {
      TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetCellData(), "Obstacle", i), 0);
      TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetCellData(), "Validity", i), 1);
    }
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const double step = norm(after.point(i) - data.point(i));
      TAUTLINE_CHECK(!fixed[i] || step == 0);
      TAUTLINE_CHECK_NEAR(component(meshOf(filter)->GetPointData(), "Displacement", i, 0),
        after.point(i)[0] - data.point(i)[0], 0);
    }
    const MeshData valid = blockMesh(type, 3, 3, flat ? 0 : 3);
    TAUTLINE_SET(filter, SetInputData(toGrid(valid)), Update());
    TAUTLINE_CHECK(withPointsOf(valid, meshOf(filter)).points == valid.points);
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("all-elements-are-valid-0-were-not")));
  }
}

/// Infeasible elements: an element of fixed points; one whose fixed neighbors leave no place.
TAUTLINE_PART(testImpossible)
{
  MeshData data = blockMesh(CellType::Triangle, 4, 4, 0);
  data.setPoint(6, { 2.5, 2.6, 0 }); // a point of the second row beyond its neighbors
  auto grid = toGrid(data);
  const auto all =
    filledArray<vtkDoubleArray>("all", data.numberOfPoints(), [](Index) { return 1; });
  grid->GetPointData()->AddArray(all);
  vtkNew<vtkMeshUntangler> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(grid),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "all"), Update());
  const Index inverted = invalidOf(data);
  TAUTLINE_CHECK(inverted > 0);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), inverted);
  TAUTLINE_CHECK_EQUAL(filter->GetImpossible(), inverted);
  const auto validity = validityOf(data);
  Index first = -1;
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    first = first < 0 && validity[i] != Valid ? i : first;
    TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetCellData(), "Obstacle", i),
      validity[i] == Valid ? 0 : int(Obstacle::FixedElement));
  }
  TAUTLINE_CHECK(contains(filter->GetSummary(), "Element " + std::to_string(first) + " at ("));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("all-its-points-are-fixed")));
  TAUTLINE_CHECK(messages.has(wording("because-of-fixed-points")));
  TAUTLINE_CHECK_EQUAL(std::string(filter->GetSummary()).rfind("Warning: ", 0), 0);

  // Free are then the points of these elements, and no others.
  TAUTLINE_SET(filter, FreeInvalidOn(), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  const MeshData repaired = withPointsOf(data, meshOf(filter));
  Index moved = 0;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    bool ofInvalid = false;
    for (Index i = 0; i < data.numberOfCells(); ++i)
    {
      const auto begin = data.connectivity.begin() + data.offsets[i];
      ofInvalid |= validity[i] != Valid && std::count(begin, begin + 3, p) > 0;
    }
    const bool away = norm(repaired.point(p) - data.point(p)) > 0;
    TAUTLINE_CHECK(ofInvalid || !away);
    moved += away;
  }
  TAUTLINE_CHECK(moved > 0);
  filter->FreeInvalidOff();

  // Freed except for the one point, the others cannot follow: or they can, and all is valid.
  TAUTLINE_SET(all, Fill(0), Modified());
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);

  // A selection that fixes the misplaced point: its star reaches over fixed points of the boundary.
  MeshData star = blockMesh(CellType::Triangle, 2, 2, 0);
  star.setPoint(4, { 5, 5, 0 });
  TAUTLINE_NEW(vtkIdTypeArray, ids, InsertNextValue(4));
  const auto selection = pointSelection(ids);
  vtkNew<vtkMeshUntangler> chosen;
  Messages warnings(chosen);
  TAUTLINE_SET(chosen, SetInputData(0, toGrid(star)), Update());
  TAUTLINE_CHECK_EQUAL(chosen->GetInvertedAfter(), 0);
  TAUTLINE_SET(chosen, SetInputData(1, selection), Update());
  TAUTLINE_CHECK(chosen->GetInvertedAfter() > 0);
  TAUTLINE_CHECK_EQUAL(chosen->GetImpossible(), chosen->GetInvertedAfter());
}

TAUTLINE_PART(testInputs)
{
  vtkNew<vtkMeshUntangler> filter;
  Messages messages(filter);
  vtkNew<vtkUnstructuredGrid> empty;
  TAUTLINE_SET(filter, SetInputData(empty), Update());
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-cells")));
  messages.clear();
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfCells(), 0);
  TAUTLINE_NEW(vtkImageData, image, SetDimensions(3, 3, 3));
  TAUTLINE_SET(filter, SetInputData(image), Update());
  TAUTLINE_CHECK(messages.has(wording("image-data-to-point-set")));
  messages.clear();

  // More than half of the elements are inverted: tangled, not reversed, as the boundary shows.
  MeshData worse = blockMesh(CellType::Triangle, 6, 6, 0);
  Random random(11);
  const auto boundary = Mesh(worse.view()).boundary().isBoundaryPoint;
  for (Index i = 0; i < worse.numberOfPoints(); ++i)
  {
    if (!boundary[i])
    {
      worse.setPoint(i, { 6 - worse.point(i)[0], worse.point(i)[1], 0 });
    }
  }
  const auto validity = validityOf(worse);
  TAUTLINE_CHECK(
    2 * std::count(validity.begin(), validity.end(), Inverted) > worse.numberOfCells());
  TAUTLINE_SET(filter, SetInputData(toGrid(worse)), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  TAUTLINE_CHECK(!contains(filter->GetSummary(), "reversed"));

  // A corner that is NaN: its elements cannot be valid, the rest is.
  MeshData broken = tangled(CellType::Triangle, 8, 0.05);
  broken.points[0] = std::numeric_limits<double>::quiet_NaN();
  TAUTLINE_SET(filter, SetInputData(toGrid(broken)), Update());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("2-elements-are-not-valid")));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("nan-or-infinite")));
  TAUTLINE_CHECK(messages.has(wording("2-elements-are-not-valid")));
  TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetCellData(), "Obstacle", 0), 4);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);

  const MeshData data = tangled(CellType::Tetrahedron, 4, 0.05);
  TAUTLINE_NEW(
    vtkMultiBlockDataSet, blocks, SetBlock(0, toGrid(data, VTK_FLOAT)), SetBlock(1, toGrid(data)));
  TAUTLINE_SET(filter, SetInputData(blocks), Update());
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  for (unsigned int i : { 0u, 1u })
  {
    auto* block = vtkPointSet::SafeDownCast(output->GetBlock(i));
    TAUTLINE_CHECK_EQUAL(invalidOf(withPointsOf(data, block)), 0);
    TAUTLINE_CHECK_EQUAL(block->GetPoints()->GetDataType(), i == 0 ? VTK_FLOAT : VTK_DOUBLE);
  }
  TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetValueByName(0, "Block").ToString(), "block 1");
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("in-block-2-all-elements-are-valid")));
}

/// A part, then all of the inner points anywhere: valid, or each element left has its reason.
TAUTLINE_PART(testRandom)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron })
  {
    const bool flat = topology(type).dimension == 2;
    const Index n = flat ? 12 : 5;
    for (double part : { 0.3, 0.6, 1.0 })
    {
      const Context context(std::string(topology(type).name) + " " + std::to_string(part));
      MeshData data = blockMesh(type, n, n, flat ? 0 : n);
      const auto boundary = Mesh(data.view()).boundary().isBoundaryPoint;
      Random random(4);
      for (Index i = 0; i < data.numberOfPoints(); ++i)
      {
        if (!boundary[i] && random.uniform(0, 1) < part)
        {
          const Vec3 p = random.vector(0, double(n));
          data.setPoint(i, { p[0], p[1], flat ? 0 : p[2] });
        }
      }
      vtkNew<vtkMeshUntangler> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetInputData(toGrid(data)), Update());
      TAUTLINE_CHECK(!contains(filter->GetSummary(), "reversed"));
      TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
      TAUTLINE_CHECK_EQUAL(invalidOf(withPointsOf(data, meshOf(filter))), 0);
    }
  }
}

TAUTLINE_PART(testStops)
{
  const MeshData data = tangled(CellType::Tetrahedron, 6, 0.3);
  vtkNew<vtkMeshUntangler> filter;
  Messages messages(filter);
  filter->SetInputData(toGrid(data));
  const auto aborting = stopAt(filter, vtkCommand::ProgressEvent, 0);
  filter->Update();
  TAUTLINE_CHECK(invalidOf(withPointsOf(data, meshOf(filter))) <= invalidOf(data));
  TAUTLINE_SET(filter, RemoveObserver(aborting), SetAbortExecute(0));
  // Before the first iteration there is nothing: no output, or an error that names the limit.
  const auto early = stopAt(filter, vtkInterruption::PollEvent);
  TAUTLINE_SET(filter, Modified(), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetAbortExecute(), 1);
  TAUTLINE_CHECK_EQUAL(outputOf(filter)->GetNumberOfCells(), 0);
  TAUTLINE_SET(filter, RemoveObserver(early), SetAbortExecute(0));
  messages.clear();
  TAUTLINE_SET(filter, SetTimeLimit(1e-9), Update());
  TAUTLINE_CHECK(messages.has(wording("the-time-limit-of-1e-09-s")));
  filter->SetTimeLimit(0);
  std::vector<double> first;
  for (int threads : { 1, 2, 4 })
  {
    TAUTLINE_SET(filter, SetThreads(threads), Update());
    const auto points = withPointsOf(data, meshOf(filter)).points;
    first = first.empty() ? points : first;
    TAUTLINE_CHECK(points == first);
  }
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
}
}
