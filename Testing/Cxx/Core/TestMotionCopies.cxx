// SPDX-License-Identifier: BSD-3-Clause
// Filters that move points, of pieces whose copies of a point have the same global id and places
// that differ by rounding: seams move as in one mesh, on processes, gathered on the first
// one, and in one data set on one process.
#include "MotionRanks.h"
#include "Registry.h"
#include "vtkAppendFilter.h"
#include "vtkMeshImprover.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkMeshWarp.h"

using namespace tautline;

namespace
{
constexpr double rounding = 1e-12;
constexpr char remark[] = "copies with the same global id that are up to ";

/// Copies of the points of a part that no other piece has.
RankPart shifted(
  const MeshData& whole, int piece, const std::function<int(Index)>& pieceOf, bool ghosts = false)
{
  RankPart part = partOf(whole, piece, pieceOf, ghosts);
  Random random(11 + piece);
  part.data.transform([&](const Vec3& p) { return p + random.vector(-rounding, rounding); });
  return part;
}

/// The mesh with the places that the copies get: the first by the coordinates, or, of a mesh that
/// is gathered, the points of the first process.
MeshData joined(const MeshData& whole, int pieces, const std::function<int(Index)>& pieceOf,
  bool gathered, bool ghosts = false)
{
  MeshData result = whole;
  std::vector<char> known(whole.numberOfPoints(), 0);
  Index differing = 0;
  for (int piece = 0; piece < pieces; ++piece)
  {
    const RankPart part = shifted(whole, piece, pieceOf, ghosts);
    for (std::size_t p = 0; p < part.pointOf.size(); ++p)
    {
      const Index point = part.pointOf[p];
      const Vec3 place = part.data.point(static_cast<Index>(p));
      differing += known[point] && place != result.point(point);
      if (!known[point] || (!gathered && place < result.point(point)))
      {
        std::copy(place.begin(), place.end(), &result.points[3 * point]);
      }
      known[point] = 1;
    }
  }
  TAUTLINE_CHECK(differing > 10);
  return result;
}

const auto allOf = [](Index) { return 0; };

/// The result of moved() on one process, without the others.
template <class Filter, class Set>
std::vector<double> alone(
  vtkMPIController* controller, const MeshData& whole, const Set& set, Filter* filter)
{
  const RankPart all = partOf(whole, 0, allOf);
  vtkMultiProcessController::SetGlobalController(nullptr);
  std::vector<double> points = moved(whole, all, numberedGridOf(all), set, filter);
  vtkMultiProcessController::SetGlobalController(controller);
  return points;
}

bool remarked(const char* summary)
{
  return contains(summary, remark);
}

/// On processes, against one process with the mesh of the joined copies.
template <class Filter, class Set>
void testFilter(const char* name, vtkMPIController* controller, const MeshData& whole,
  bool gathered, const Set& set)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    const Context inner("cut " + std::to_string(static_cast<int>(cut)));
    const auto rankOf = cutBy(whole, cut, size);
    const bool ghosts = cut == Cut::Slabs && !gathered;
    vtkNew<Filter> serial, filter;
    const std::vector<double> expected =
      alone(controller, joined(whole, size, rankOf, gathered, ghosts), set, serial.Get());
    TAUTLINE_CHECK(!remarked(serial->GetSummary()));
    const RankPart part = shifted(whole, rank, rankOf, ghosts);
    checkSame(moved(whole, part, numberedGridOf(part), set, filter.Get()), expected);
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), serial->GetInvertedAfter());
    TAUTLINE_CHECK_EQUAL(remarked(filter->GetSummary()), !gathered);
  }
}

/// Pieces that number their points each from 0 are joined by the coordinates.
void testOwnNumbers(vtkMPIController* controller)
{
  const Context context("own numbers");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = jittered(CellType::Tetrahedron, 4, 0.25);
  const auto set = [](vtkMeshOptimizer* filter) { filter->ReproducibleOrderOn(); };
  vtkNew<vtkMeshOptimizer> serial, filter;
  const std::vector<double> expected = alone(controller, whole, set, serial.Get());
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  const auto grid = numberedGridOf(part);
  for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
  {
    grid->GetPointData()->GetGlobalIds()->SetComponent(p, 0, static_cast<double>(p));
  }
  checkSame(moved(whole, part, grid, set, filter.Get()), expected);
  TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), serial->GetFreePoints());
  TAUTLINE_CHECK(!remarked(filter->GetSummary()));
  TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("global-id")));
}

/// Copies that are too far apart stay so, and the summary states it on all processes.
void testApart(vtkMPIController* controller)
{
  const Context context("apart");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = jittered(CellType::Tetrahedron, 4, 0.25);
  const auto rankOf = cutBy(whole, Cut::Slabs, size);
  const RankPart first = partOf(whole, 0, rankOf);
  RankPart part = partOf(whole, rank, rankOf);
  const auto shared = std::find_if(part.pointOf.begin(), part.pointOf.end(),
    [&](Index p) { return std::count(first.pointOf.begin(), first.pointOf.end(), p) > 0; });
  if (rank == 1)
  {
    part.data.points[3 * (shared - part.pointOf.begin())] += 0.05;
  }
  vtkNew<vtkMeshOptimizer> filter;
  moved(
    whole, part, numberedGridOf(part),
    [](vtkMeshOptimizer* optimizer) { optimizer->ReproducibleOrderOn(); }, filter.Get());
  TAUTLINE_CHECK(!remarked(filter->GetSummary()));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("1-global-id-is-at-places-that")));
}

/// A mesh of several pieces as one data set on one process: the seam moves as the rest.
void testOneProcess(vtkMPIController* controller)
{
  const Context context("one process");
  const MeshData whole = jittered(CellType::Tetrahedron, 4, 0.25);
  const auto pieceOf = cutBy(whole, Cut::Slabs, 2);
  TAUTLINE_NEW(vtkAppendFilter, append, MergePointsOff());
  RankPart both;
  for (int piece = 0; piece < 2; ++piece)
  {
    const RankPart part = shifted(whole, piece, pieceOf);
    both.pointOf.insert(both.pointOf.end(), part.pointOf.begin(), part.pointOf.end());
    append->AddInputData(numberedGridOf(part));
  }
  append->Update();
  // vtkAppendFilter keeps the array of the ids, but not what it is.
  TAUTLINE_NEW(vtkUnstructuredGrid, grid, ShallowCopy(append->GetOutput()),
    GetPointData()->SetGlobalIds(grid->GetPointData()->GetArray("point ids")),
    GetCellData()->SetGlobalIds(nullptr));
  TAUTLINE_CHECK(grid->GetNumberOfPoints() > whole.numberOfPoints());
  const auto set = [](auto* filter) { filter->SetMergeCoincidentPoints(true); };
  vtkNew<vtkMeshOptimizer> serial, optimizer, apart;
  alone(controller, whole, set, serial.Get());
  vtkMultiProcessController::SetGlobalController(nullptr);
  const std::vector<double> points = moved(whole, both, grid, set, optimizer.Get());
  TAUTLINE_CHECK(remarked(optimizer->GetSummary()));
  TAUTLINE_CHECK_EQUAL(optimizer->GetFreePoints(), serial->GetFreePoints());
  auto* output = outputOf<vtkUnstructuredGrid>(optimizer);
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    // Copies stay together.
    Vec3 place;
    output->GetPoint(p, place.data());
    const double* last = &points[3 * both.pointOf[p]];
    TAUTLINE_CHECK(norm(place - Vec3{ last[0], last[1], last[2] }) <= 4 * rounding);
  }
  TAUTLINE_NEW(vtkMeshImprover, improver, SetInputData(grid), Update());
  TAUTLINE_CHECK(remarked(improver->GetSummary()));
  const auto pointsOf = [](vtkMeshImprover* filter)
  { return outputOf(filter)->GetNumberOfPoints(); };
  const vtkIdType joined = pointsOf(improver);
  TAUTLINE_CHECK(joined < grid->GetNumberOfPoints());
  // Also beside triangles, which the output does not have.
  TAUTLINE_NEW(vtkUnstructuredGrid, mixed, DeepCopy(grid));
  vtkNew<vtkIdList> corners;
  mixed->GetCellPoints(0, corners);
  corners->SetNumberOfIds(3);
  TAUTLINE_SET(mixed, InsertNextCell(VTK_TRIANGLE, corners), GetCellData()->Initialize());
  TAUTLINE_SET(improver, SetInputData(mixed), Update());
  TAUTLINE_CHECK(remarked(improver->GetSummary()));
  TAUTLINE_CHECK(pointsOf(improver) < grid->GetNumberOfPoints());
  TAUTLINE_NEW(vtkMeshPerturbation, perturbation, SetInputData(grid), Update());
  TAUTLINE_CHECK(remarked(perturbation->GetSummary()));
  // Without ids they are apart, as before.
  grid->GetPointData()->SetGlobalIds(nullptr);
  moved(whole, both, grid, set, apart.Get());
  TAUTLINE_CHECK(!remarked(apart->GetSummary()));
  TAUTLINE_CHECK(apart->GetFreePoints() < serial->GetFreePoints());
  vtkMultiProcessController::SetGlobalController(controller);
}

/// Pieces that overlap, without ghost marks: by a layer of cells, or each is the whole mesh.
template <class Filter, class Set>
void testOverlap(
  const char* name, vtkMPIController* controller, const MeshData& whole, const Set& set)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  vtkNew<Filter> serial;
  const std::vector<double> expected = alone(controller, whole, set, serial.Get());
  for (const bool all : { false, true })
  {
    const Context inner(all ? "all" : "a layer");
    RankPart part =
      all ? partOf(whole, 0, allOf) : partOf(whole, rank, cutBy(whole, Cut::Slabs, size), true);
    part.ghosts.assign(part.ghosts.size(), 0);
    vtkNew<Filter> filter;
    checkSame(moved(whole, part, gridOf(part), set, filter.Get()), expected);
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), serial->GetInvertedAfter());
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("they-count-once")));
    // The counts equal the counts of the mesh without copies.
    const auto countOf = [](Filter* one)
    {
      const std::string summary = one->GetSummary();
      const std::size_t begin = summary.find("Inverted elements:");
      return begin == std::string::npos ? std::string()
                                        : summary.substr(begin, summary.find('\n', begin) - begin);
    };
    TAUTLINE_CHECK_EQUAL(countOf(filter), countOf(serial));
  }
}

/// Tetrahedra with the triangles of their boundary behind them.
MeshData withSurface(MeshData data)
{
  std::map<std::array<Index, 3>, int> uses;
  const Index cells = data.numberOfCells();
  const auto& faces = topology(CellType::Tetrahedron).faceNodes;
  const auto faceOf = [&](Index cell, int f)
  {
    const std::vector<Index> nodes = data.nodes(cell);
    return std::array<Index, 3>{ nodes[faces[f][0]], nodes[faces[f][1]], nodes[faces[f][2]] };
  };
  const auto sorted = [](std::array<Index, 3> face)
  {
    std::sort(face.begin(), face.end());
    return face;
  };
  for (Index cell = 0; cell < cells; ++cell)
  {
    for (int f = 0; f < 4; ++f)
    {
      ++uses[sorted(faceOf(cell, f))];
    }
  }
  for (Index cell = 0; cell < cells; ++cell)
  {
    for (int f = 0; f < 4; ++f)
    {
      const std::array<Index, 3> face = faceOf(cell, f);
      if (uses[sorted(face)] == 1)
      {
        data.addCell(CellType::Triangle, std::vector<Index>(face.begin(), face.end()));
      }
    }
  }
  return data;
}

/// The points of the faces z = 0 and z = 4 moved within them, so that sliding has work to do.
MeshData slanted(MeshData data)
{
  Random random(9);
  data.transform(
    [&](const Vec3& p)
    {
      const Vec3 d = random.vector(-0.2, 0.2);
      const bool inside = p[0] > 0 && p[0] < 4 && p[1] > 0 && p[1] < 4;
      return inside && (p[2] == 0 || p[2] == 4) ? p + Vec3{ d[0], d[1], 0 } : p;
    });
  return data;
}

/// The triangles of the boundary on the last process, without a tetrahedron beside them.
template <class Filter, class Set>
void testTorn(
  const char* name, vtkMPIController* controller, const MeshData& solid, bool byIds, const Set& set)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = withSurface(solid);
  vtkNew<Filter> serial, filter;
  const std::vector<double> expected = alone(controller, whole, set, serial.Get());
  TAUTLINE_CHECK(whole.numberOfCells() > solid.numberOfCells());
  const auto halves = cutBy(solid, Cut::Slabs, size > 1 ? size - 1 : 1);
  const RankPart part = partOf(whole, rank,
    [&](Index cell) { return cell < solid.numberOfCells() ? halves(cell) : size - 1; });
  const auto grid = byIds ? numberedGridOf(part) : gridOf(part);
  checkSame(moved(whole, part, grid, set, filter.Get()), expected);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), serial->GetInvertedAfter());
  const std::vector<char> boundary = Mesh(solid.view()).boundary().isBoundaryPoint;
  double slid = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    slid = std::max(slid, boundary[i / 3] ? std::abs(expected[i] - whole.points[i]) : 0.0);
  }
  TAUTLINE_CHECK(slid > 0.01);
}

/// The same in one data set whose triangles have points of their own.
void testTornInOne(vtkMPIController* controller, const MeshData& solid)
{
  const Context context("torn in one data set");
  const MeshData whole = withSurface(solid);
  const RankPart all = partOf(whole, 0, allOf);
  RankPart torn = all;
  std::map<Index, Index> own;
  for (Index n = whole.offsets[solid.numberOfCells()]; n < whole.offsets.back(); ++n)
  {
    const Index point = whole.connectivity[n];
    if (own.emplace(point, torn.data.numberOfPoints()).second)
    {
      torn.data.addPoint(whole.point(point));
      torn.pointOf.push_back(point);
    }
    torn.data.connectivity[n] = own[point];
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  for (const bool reproducible : { false, true })
  {
    vtkNew<vtkMeshOptimizer> filter;
    const auto set = [&](vtkMeshOptimizer* one)
    {
      one->SetBoundary(vtkMeshOptimizer::SLIDING);
      one->SetReproducibleOrder(reproducible);
    };
    vtkNew<vtkMeshOptimizer> shared;
    const std::vector<double> expected = moved(whole, all, gridOf(all), set, shared.Get());
    const std::vector<double> points = moved(whole, torn, gridOf(torn), set, filter.Get());
    TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), shared->GetFreePoints());
    double far = 0;
    for (vtkIdType p = 0; p < torn.data.numberOfPoints(); ++p)
    {
      Vec3 x;
      outputOf<vtkUnstructuredGrid>(filter)->GetPoint(p, x.data());
      const Index of = 3 * torn.pointOf[p];
      TAUTLINE_CHECK((x == Vec3{ points[of], points[of + 1], points[of + 2] }));
      far = std::max(far, norm(x - Vec3{ expected[of], expected[of + 1], expected[of + 2] }));
    }
    TAUTLINE_CHECK(far <= 1e-10);
  }
  vtkMultiProcessController::SetGlobalController(controller);
}

/// A process without cells needs no arrays: with no point, or with points that no cell has.
template <class Filter, class Set>
void testNothing(
  const char* name, vtkMPIController* controller, const MeshData& whole, const Set& set)
{
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  for (const int bare : { 0, size - 1 })
  {
    for (const bool loose : { false, true })
    {
      if (loose && size == 2)
      {
        continue; // the mesh of one process is put together, where all points need the arrays
      }
      const Context context(
        std::string(name) + ", process " + std::to_string(bare) + (loose ? ", loose" : ""));
      auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
      if (size == 1 || rank != bare)
      {
        const int pieces = std::max(size - 1, 1);
        const auto cut = cutBy(whole, Cut::Slabs, pieces);
        const int own = rank > bare ? rank - 1 : rank;
        grid = toGrid(partOf(whole, own, cut).data);
        vtkNew<vtkDoubleArray> push, fixed;
        TAUTLINE_SET(push, SetName("push"), SetNumberOfComponents(3));
        fixed->SetName("fixed");
        for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
        {
          const double* x = grid->GetPoint(p);
          push->InsertNextTuple3(0.02 * x[1], 0.01 * x[2], 0);
          fixed->InsertNextValue(x[0] < 1);
        }
        TAUTLINE_SET(grid, GetPointData()->AddArray(push), GetPointData()->AddArray(fixed));
      }
      else if (loose)
      {
        vtkNew<vtkPoints> points;
        points->InsertNextPoint(1, 2, 3);
        grid->SetPoints(points);
      }
      vtkNew<Filter> filter;
      Messages messages(filter);
      set(filter.Get());
      TAUTLINE_SET(filter, SetInputData(grid), Update());
      TAUTLINE_CHECK(!messages.has("ERROR: "));
      auto* output = outputOf<vtkUnstructuredGrid>(filter);
      TAUTLINE_CHECK_EQUAL(output->GetNumberOfPoints(), grid->GetNumberOfPoints());
      TAUTLINE_CHECK_EQUAL(output->GetNumberOfCells(), grid->GetNumberOfCells());
      double moved = 0;
      for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
      {
        Vec3 x, from;
        output->GetPoint(p, x.data());
        grid->GetPoint(p, from.data());
        moved = std::max(moved, norm(x - from));
      }
      TAUTLINE_CHECK((moved > 0.001) == (grid->GetNumberOfCells() > 0));
    }
  }
}

/// Gathered, in the order of one process.
void testOverlapGathered(vtkMPIController* controller, const MeshData& whole)
{
  const Context context("overlap, gathered");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const auto set = [](vtkMeshOptimizer* filter)
  { filter->SetPreset(vtkMeshOptimizer::WORST_ELEMENT); };
  vtkNew<vtkMeshOptimizer> serial, filter;
  alone(controller, whole, set, serial.Get());
  RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size), true);
  part.ghosts.assign(part.ghosts.size(), 0);
  const std::vector<double> points = moved(whole, part, gridOf(part), set, filter.Get());
  TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), serial->GetFreePoints());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("they-count-once")));
  const std::vector<char> boundary = Mesh(whole.view()).boundary().isBoundaryPoint;
  for (const Index p : part.pointOf)
  {
    TAUTLINE_CHECK(
      !boundary[p] || std::equal(&points[3 * p], &points[3 * p] + 3, &whole.points[3 * p]));
  }
}

/// The whole mesh on two processes, with other points inside: its boundary cannot be found.
void testOtherCells(vtkMPIController* controller)
{
  const Context context("other cells");
  const int rank = controller->GetLocalProcessId();
  const MeshData whole = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  const std::vector<char> boundary = Mesh(whole.view()).boundary().isBoundaryPoint;
  // Two of them: a facet of three elements is on the boundary in any case.
  RankPart part = partOf(whole, 0, [rank](Index) { return rank > 1 ? 1 : 0; });
  Random random(7 + rank);
  for (std::size_t p = 0; p < part.pointOf.size(); ++p)
  {
    for (std::size_t c = 0; c < 3 && !boundary[part.pointOf[p]]; ++c)
    {
      part.data.points[3 * p + c] += random.uniform(-0.15, 0.15);
    }
  }
  for (const bool reproducible : { false, true })
  {
    vtkNew<vtkMeshOptimizer> filter;
    Messages messages(filter);
    TAUTLINE_SET(filter, SetReproducibleOrder(reproducible), SetInputData(gridOf(part)), Update());
    TAUTLINE_CHECK(messages.has(wording("two-elements-on-the-same-side")) || rank > 0);
    TAUTLINE_CHECK_EQUAL(outputOf<vtkUnstructuredGrid>(filter)->GetNumberOfPoints(), 0);
  }
}

/// Cells of all processes, and a number that follows from their places, except for their order.
std::pair<vtkIdType, double> contentOf(vtkMPIController* controller, vtkMeshImprover* filter)
{
  auto* output = outputOf<vtkUnstructuredGrid>(filter);
  vtkIdType own = output->GetNumberOfCells(), cells = 0;
  double here = 0, sum = 0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < own; ++cell)
  {
    output->GetCellPoints(cell, ids);
    double product = 1;
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      const double* p = output->GetPoint(ids->GetId(i));
      product *= 1 + p[0] + 2 * p[1] + 3 * p[2];
    }
    here += product;
  }
  controller->AllReduce(&own, &cells, 1, vtkCommunicator::SUM_OP);
  controller->AllReduce(&here, &sum, 1, vtkCommunicator::SUM_OP);
  return { cells, sum };
}

/// Improve Mesh, whose result depends on the number of processes: the same result as with exact
/// copies.
void testImprover(vtkMPIController* controller)
{
  const MeshData whole = jittered(CellType::Tetrahedron, 5, 0.25);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  for (const bool gathered : { false, true })
  {
    for (const Cut cut : { Cut::Slabs, Cut::Random })
    {
      const Context context(std::string("improve, ") + (gathered ? "gathered" : "in parts") +
        ", cut " + std::to_string(static_cast<int>(cut)));
      const auto rankOf = cutBy(whole, cut, size);
      const MeshData exact = joined(whole, size, rankOf, gathered);
      vtkNew<vtkMeshImprover> expected, filter;
      expected->SetInputData(numberedGridOf(partOf(exact, rank, rankOf)));
      filter->SetInputData(numberedGridOf(shifted(whole, rank, rankOf)));
      for (vtkMeshImprover* one : { expected.Get(), filter.Get() })
      {
        one->SetGatherBelow(gathered ? whole.numberOfCells() + 1 : 0);
        Messages messages(one);
        one->Update();
        TAUTLINE_CHECK(!messages.has("ERROR: "));
      }
      const auto [cells, content] = contentOf(controller, expected);
      const auto [found, same] = contentOf(controller, filter);
      TAUTLINE_CHECK_EQUAL(found, cells);
      TAUTLINE_CHECK_RELATIVE(same, content, 1e-14);
      TAUTLINE_CHECK(cells != whole.numberOfCells()); // it has done something
    }
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMotionCopies)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  const MeshData tets = jittered(CellType::Tetrahedron, 4, 0.25);
  TAUTLINE_RUN(testFilter<vtkMeshOptimizer>("optimize", controller, tets, false,
    [](vtkMeshOptimizer* filter) { filter->ReproducibleOrderOn(); }));
  TAUTLINE_RUN(testFilter<vtkMeshOptimizer>("optimize, gathered", controller, tets, true,
    [](vtkMeshOptimizer* filter) { filter->SetPreset(vtkMeshOptimizer::WORST_ELEMENT); }));
  TAUTLINE_RUN(
    testFilter<vtkMeshUntangler>("untangle", controller, jittered(CellType::Tetrahedron, 5, 0.45),
      false, [](vtkMeshUntangler* filter) { filter->ReproducibleOrderOn(); }));
  TAUTLINE_RUN(testFilter<vtkMeshPerturbation>("perturb, gathered", controller, tets, true,
    [](vtkMeshPerturbation* filter) { filter->SetTangledFraction(0.01); }));
  TAUTLINE_RUN(testFilter<vtkMeshPerturbation>(
    "perturb", controller, tets, true, [](vtkMeshPerturbation*) {}));
  TAUTLINE_RUN(testOwnNumbers(controller));
  TAUTLINE_RUN(testOverlap<vtkMeshOptimizer>(
    "overlap", controller, tets, [](vtkMeshOptimizer* filter) { filter->ReproducibleOrderOn(); }));
  TAUTLINE_RUN(testOverlap<vtkMeshOptimizer>("overlap, sliding", controller, tets,
    [](vtkMeshOptimizer* filter)
    {
      filter->ReproducibleOrderOn();
      filter->SetBoundary(vtkMeshOptimizer::SLIDING);
    }));
  TAUTLINE_RUN(testOverlap<vtkMeshOptimizer>("overlap, in the plane", controller,
    jittered(CellType::Triangle, 12, 0.25),
    [](vtkMeshOptimizer* filter) { filter->ReproducibleOrderOn(); }));
  TAUTLINE_RUN(testOverlap<vtkMeshUntangler>("overlap, untangle", controller,
    jittered(CellType::Tetrahedron, 5, 0.45),
    [](vtkMeshUntangler* filter) { filter->ReproducibleOrderOn(); }));
  const MeshData rough = slanted(tets);
  for (const bool byIds : { false, true })
  {
    TAUTLINE_RUN(testTorn<vtkMeshOptimizer>("torn", controller, rough, byIds,
      [byIds](vtkMeshOptimizer* filter)
      {
        filter->SetBoundary(vtkMeshOptimizer::SLIDING);
        filter->SetMergeCoincidentPoints(!byIds);
        filter->ReproducibleOrderOn();
      }));
  }
  TAUTLINE_RUN(testTornInOne(controller, rough));
  TAUTLINE_RUN(testNothing<vtkMeshWarp>("warp", controller, tets,
    [](vtkMeshWarp* filter)
    {
      filter->SetMotion(vtkMeshWarp::DISPLACEMENT);
      filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "push");
    }));
  TAUTLINE_RUN(testNothing<vtkMeshOptimizer>("optimize", controller, tets,
    [](vtkMeshOptimizer* filter)
    {
      filter->ReproducibleOrderOn();
      filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "fixed");
    }));
  TAUTLINE_RUN(testOverlapGathered(controller, tets));
  TAUTLINE_RUN(testOtherCells(controller));
  TAUTLINE_RUN(testApart(controller));
  TAUTLINE_RUN(testImprover(controller));
  TAUTLINE_RUN(testOneProcess(controller));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
