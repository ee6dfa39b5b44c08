// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh on processes, each with its piece: every method and choice of coefficients moves the
// points as one process does, however the mesh is cut, and nothing is put together.
#include "ProcessGroup.h"
#include "Processes.h"
#include "Registry.h"
#include "WarpingRanks.h"
#include "tautline/Deformation/Warp.h"
#include "tautline/Mesh/Ranks.h"

using namespace tautline;

namespace
{
/// The numbers of a filter that refer to the whole mesh.
struct Numbers
{
  vtkIdType inverted, invertedAfterWarp, impossible;
  double worst;
};

Numbers numbersOf(vtkMeshWarp* filter)
{
  return { filter->GetInverted(), filter->GetInvertedAfterWarp(), filter->GetImpossible(),
    filter->GetWorstShape() };
}

/// The tables of all processes together equal the tables of one, to a relative tolerance.
void checkTables(vtkMeshWarp* serial, vtkMeshWarp* ranks, int rank, double tolerance)
{
  vtkTable *one = serial->GetHistory(), *here = ranks->GetHistory();
  TAUTLINE_CHECK_EQUAL(here->GetNumberOfRows(), rank == 0 ? one->GetNumberOfRows() : 0);
  for (vtkIdType row = 0; row < here->GetNumberOfRows(); ++row)
  {
    for (const char* column : { "Amount", "Inverted", "Worst shape", "Mean shape" })
    {
      TAUTLINE_CHECK_RELATIVE(value(here, column, row), value(one, column, row), tolerance);
    }
  }
}

/// @param bound on the distance of the points from the result of one process
template <class Set>
void testSame(const char* name, vtkMPIController* controller, const MeshData& whole, double bound,
  const Set& set)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  vtkNew<vtkMeshWarp> serial;
  const std::vector<double> expected = alone(controller, whole, set, serial);
  TAUTLINE_CHECK(farthest(expected, whole.points) > 0.1);
  const Numbers one = numbersOf(serial);
  const auto check = [&](const RankPart& part, vtkMeshWarp* filter)
  {
    const double far = farthest(pointsOf(whole, part, set, filter), expected);
    TAUTLINE_CHECK(far <= bound);
    const Numbers found = numbersOf(filter);
    TAUTLINE_CHECK_EQUAL(found.inverted, one.inverted);
    TAUTLINE_CHECK_EQUAL(found.invertedAfterWarp, one.invertedAfterWarp);
    TAUTLINE_CHECK_EQUAL(found.impossible, one.impossible);
    TAUTLINE_CHECK_RELATIVE(found.worst, one.worst, 1e4 * bound);
    checkTables(serial, filter, rank, 1e4 * bound);
    TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("put-together")));
    return far;
  };
  double far = 0;
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    const Context inner("cut " + std::to_string(static_cast<int>(cut)));
    const auto rankOf = cutBy(whole, cut, size);
    vtkNew<vtkMeshWarp> filter, other;
    far = std::max(far, check(partOf(whole, rank, rankOf, cut == Cut::Slabs), filter));
    // More processes than pieces.
    far = std::max(far,
      check(partOf(whole, rank,
              [&](Index cell) { return size > 2 && rankOf(cell) == 0 ? size - 1 : 1; }),
        other));
  }
  const Context inner("redistributed");
  TAUTLINE_NEW(vtkMeshWarp, filter, SetRedistribute(vtkMeshWarp::KD_TREE));
  far = std::max(far, check(partOf(whole, rank, [](Index) { return 0; }), filter));
  if (rank == 0)
  {
    std::cout << name << ": farthest " << far << "\n";
  }
}

/**
 * Untangling and optimization use another order than one process: all elements are valid, as
 * there, and the points do not depend on how the mesh is cut.
 * @param inverts whether the warp itself inverts elements
 * @param follows whether untangling fails where the motion ends, so that short steps follow
 */
template <class Set>
void testValid(const char* name, vtkMPIController* controller, const MeshData& whole, bool inverts,
  bool follows, const Set& set)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  vtkNew<vtkMeshWarp> serial;
  const std::vector<double> one = alone(controller, whole, set, serial);
  const vtkIdType inverted = serial->GetInvertedAfterWarp();
  TAUTLINE_CHECK_EQUAL(inverted > 0, inverts);
  TAUTLINE_CHECK_EQUAL(serial->GetInverted(), 0);
  std::vector<double> expected; // of the first cut: all that is here
  const auto check = [&](const RankPart& part, vtkMeshWarp* filter)
  {
    const std::vector<double> here = pointsOf(whole, part, set, filter);
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfterWarp(), inverted);
    TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
    TAUTLINE_CHECK_EQUAL(filter->GetImpossible(), 0);
    TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("put-together")));
    constexpr double similar = 0.3; // of the size of a cell: no point goes elsewhere
    TAUTLINE_CHECK(farthest(here, one) <= similar);
    vtkTable *first = serial->GetHistory(), *history = filter->GetHistory();
    const vtkIdType rows = history->GetNumberOfRows();
    TAUTLINE_CHECK_EQUAL(rows > 0, rank == 0);
    // Steps that follow the motion depend on what the former ones have come to.
    const bool followed = first->GetNumberOfRows() > 3;
    TAUTLINE_CHECK_EQUAL(followed, follows);
    TAUTLINE_CHECK(followed || rank > 0 || rows == first->GetNumberOfRows());
    TAUTLINE_CHECK(!followed || rank > 0 || rows > 10);
    for (vtkIdType row = 0; row < rows && !followed; ++row)
    {
      TAUTLINE_CHECK_EQUAL(history->GetValueByName(row, "Stage").ToString(),
        first->GetValueByName(row, "Stage").ToString());
      TAUTLINE_CHECK_EQUAL(value(history, "Inverted", row), value(first, "Inverted", row));
    }
    TAUTLINE_CHECK(rows == 0 || value(history, "Amount", rows - 1) == 1.0);
    // The points of the whole mesh, from all processes.
    std::vector<double> all(here.size());
    std::vector<double> known(here);
    std::replace(known.begin(), known.end(), HUGE_VAL, -HUGE_VAL);
    controller->AllReduce(
      known.data(), all.data(), static_cast<vtkIdType>(all.size()), vtkCommunicator::MAX_OP);
    expected = expected.empty() ? all : expected;
    TAUTLINE_CHECK(farthest(all, expected) <= 1e-10);
    return farthest(all, one);
  };
  double far = 0;
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    const Context inner("cut " + std::to_string(static_cast<int>(cut)));
    vtkNew<vtkMeshWarp> filter;
    far =
      std::max(far, check(partOf(whole, rank, cutBy(whole, cut, size), cut == Cut::Slabs), filter));
  }
  const Context inner("redistributed");
  TAUTLINE_NEW(vtkMeshWarp, filter, SetRedistribute(vtkMeshWarp::KD_TREE));
  check(partOf(whole, rank, [](Index) { return 0; }), filter);
  if (rank == 0)
  {
    std::cout << name << ": farthest from one process " << far << ", stages "
              << serial->GetHistory()->GetNumberOfRows() << "\n";
  }
}

/// Positions of the boundary that former ones span need no solve: norms and products cover all
/// processes, also where a matrix is the sum of their parts.
void testSpanned(vtkMPIController* controller, const MeshData& whole)
{
  const Context context("spanned");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const auto group = makeProcessGroup();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  DistributedMesh spread(*group, { part.data.view() });
  const std::vector<unsigned char> boundary = rankBoundary(spread);
  const auto solved = [&](WarpMethod method)
  {
    TAUTLINE_LET(WarpOptions, options, method = method, threads = 1, prescribed = boundary.data(),
      automaticSolver = false, solver.method = KrylovMethod::ConjugateGradient,
      solver.preconditioner = Preconditioner::Jacobi);
    Warper warper(spread, false, spread.numbers(), group->communicator(), options);
    std::vector<int> iterations;
    // No affine motions, which are split off: the third is the sum of the others.
    for (const Vec3& factors : { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0.5, 0.25, 0 } })
    {
      std::vector<double> displacement;
      for (Index i = 0; i < spread.localPoints(); ++i)
      {
        const Vec3 p = tautline::pointOf(spread.view(), i);
        displacement.insert(displacement.end(),
          { factors[0] * 0.02 * p[1] * p[1] + factors[1] * 0.01 * p[0] * p[1], 0, 0 });
      }
      iterations.push_back(warper.warp(displacement.data()).history.front().iterations);
    }
    return iterations;
  };
  for (const WarpMethod method : { WarpMethod::Femwarp, WarpMethod::Biharmonic })
  {
    const Context inner("method " + std::to_string(static_cast<int>(method)));
    const std::vector<int> iterations = solved(method);
    TAUTLINE_CHECK(iterations[0] > 5 && iterations[1] > 5);
    TAUTLINE_CHECK_EQUAL(iterations[2], 0);
  }
}

/// The second step of Hybrid, to its minimum, equals the result of one process to 1e-6.
void testConverged(vtkMPIController* controller, const MeshData& whole, double degrees)
{
  const Context context("converged");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const bool flat = topology(static_cast<CellType>(whole.types[0])).dimension == 2;
  TAUTLINE_LET(WarpOptions, options, method = WarpMethod::Hybrid, threads = 1,
    optimization.stopping.maximumIterations = 3000, optimization.stopping.relativeChange = 1e-14);
  const double middle = flat ? 3.5 : 2.5;
  const double angle = degrees * Pi / 180;
  // The hole, and the outer boundary stays.
  const auto motionOf = [&](const Vec3& p)
  {
    const Vec3 d = { p[0] - middle, p[1] - middle, flat ? 0 : p[2] - middle };
    if (std::max({ std::abs(d[0]), std::abs(d[1]), std::abs(d[2]) }) > 1)
    {
      return Vec3{ 0, 0, 0 };
    }
    return Vec3{ (std::cos(angle) - 1) * d[0] - std::sin(angle) * d[1],
      std::sin(angle) * d[0] + (std::cos(angle) - 1) * d[1], 0 };
  };
  const auto displacementsOf = [&](const MeshView& view)
  {
    std::vector<double> displacement;
    for (Index i = 0; i < view.numberOfPoints; ++i)
    {
      const Vec3 d = motionOf(tautline::pointOf(view, i));
      displacement.insert(displacement.end(), d.begin(), d.end());
    }
    return displacement;
  };
  const Mesh mesh(whole.view());
  const WarpResult one = Warper(mesh, options).warp(displacementsOf(whole.view()).data());
  const auto group = makeProcessGroup();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  DistributedMesh spread(*group, { part.data.view() });
  const std::vector<unsigned char> boundary = rankBoundary(spread);
  options.prescribed = boundary.data();
  const std::vector<double> before = spread.points();
  Warper warper(spread, false, spread.numbers(), group->communicator(), options);
  const WarpResult found = warper.warp(displacementsOf(spread.view()).data());
  TAUTLINE_CHECK(before == spread.points()); // bitwise, as they were
  TAUTLINE_CHECK_EQUAL(found.invertedAfter, 0);
  TAUTLINE_CHECK_EQUAL(found.history.size(), one.history.size());
  const WarpRecord &last = found.history.back(), &expected = one.history.back();
  TAUTLINE_CHECK_EQUAL(last.stage, "optimize");
  TAUTLINE_CHECK(std::abs(last.meanShape - found.history.front().meanShape) > 1e-4);
  TAUTLINE_CHECK(last.iterations > 10);
  TAUTLINE_CHECK_RELATIVE(last.meanShape, expected.meanShape, 1e-6);
  TAUTLINE_CHECK_RELATIVE(last.worstShape, expected.worstShape, 1e-4);
  if (rank == 0)
  {
    std::cout << "converged: mean shape " << last.meanShape << ", off by "
              << last.meanShape - expected.meanShape << " after " << last.iterations << " ("
              << expected.iterations << ") iterations\n";
  }
}

/// Motions that still put the mesh together, with the points of one process: the summary states it.
void testPutTogether(vtkMPIController* controller)
{
  const Context context("put together");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  MeshData whole = blockWithHole(CellType::Triangle);
  // In a plane that is at right angles to no axis.
  whole.transform(TAUTLINE_PLACE(p[0], 0.8 * p[1], 0.6 * p[1]));
  const auto set = [](vtkMeshWarp* filter)
  {
    TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::TRANSLATION), SetTranslation(0.3, 0, 0),
      SetMethod(vtkMeshWarp::FEMWARP));
  };
  vtkNew<vtkMeshWarp> serial, filter, onFirst;
  vtkMultiProcessController::SetGlobalController(nullptr);
  const auto all = [](Index) { return 0; };
  const std::vector<double> expected =
    pointsOf(whole, partOf(whole, 0, all), set, serial.Get(), true);
  vtkMultiProcessController::SetGlobalController(controller);
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  const std::vector<double> here = pointsOf(whole, part, set, filter.Get(), true);
  TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
  TAUTLINE_CHECK(farthest(here, whole.points) > 0.1);
  const std::string sentence = "The mesh was put together on the first process: it is a surface in "
                               "space, or in a plane that is not perpendicular to an axis.";
  TAUTLINE_CHECK(contains(filter->GetSummary(), sentence));
  // All of it is in one place from the start.
  pointsOf(whole, partOf(whole, rank, all), set, onFirst.Get(), true);
  TAUTLINE_CHECK(!contains(onFirst->GetSummary(), wording("put-together")));
}

/// Wrong coefficients of one cell are an error on all processes.
void testWrong(vtkMPIController* controller, const MeshData& whole)
{
  const Context context("wrong coefficients");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  const struct
  {
    double value;
    const char* message;
  } cases[] = { { std::nan(""), "cell 0 of the piece are not finite" },
    { -1.0, "cell 0 of the piece are not finite or not positive semidefinite: correct" } };
  for (const auto& [wrong, message] : cases)
  {
    const auto grid = gridOf(part);
    vtkDataArray* tensors = grid->GetCellData()->GetArray("tensors");
    if (rank == size - 1)
    {
      tensors->SetComponent(0, 0, wrong);
    }
    TAUTLINE_NEW(vtkMeshWarp, filter, SetInputData(grid));
    turn(filter, 20);
    filter->SetMethod(vtkMeshWarp::ANISOTROPIC_FEMWARP);
    filter->SetCoefficients(vtkMeshWarp::PER_CELL);
    filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "tensors");
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(message));
  }
}

void testPieces(vtkMPIController* controller)
{
  constexpr double same = 1e-10;
  // The condition number of the biharmonic equation is the square of the harmonic one's.
  const MeshData planar = blockWithHole(CellType::Triangle);
  const MeshData volume = blockWithHole(CellType::Tetrahedron);
  for (const MeshData* mesh : { &planar, &volume })
  {
    const Context context(mesh == &planar ? "planar" : "volume");
    const auto method = [](int number)
    {
      return [number](vtkMeshWarp* filter)
      {
        turn(filter, 20);
        filter->SetMethod(number);
      };
    };
    testSame("per cell", controller, *mesh, same,
      [](vtkMeshWarp* filter)
      {
        turn(filter, 20);
        filter->SetMethod(vtkMeshWarp::ANISOTROPIC_FEMWARP);
        filter->SetCoefficients(vtkMeshWarp::PER_CELL);
        filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "tensors");
      });
    // 0 along y in some of the cells: points there may decouple.
    for (const double beta : { 0.1, 0.0 })
    {
      testSame(beta > 0 ? "per region" : "singular per region", controller, *mesh, same,
        [beta](vtkMeshWarp* filter)
        {
          turn(filter, 20);
          TAUTLINE_SET(filter, SetMethod(vtkMeshWarp::ANISOTROPIC_FEMWARP),
            SetCoefficients(vtkMeshWarp::PER_REGION), AddRegion(7, 1, beta, 5),
            SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "regions"));
        });
    }
    testSame("local gradients", controller, *mesh, same,
      [](vtkMeshWarp* filter)
      {
        turn(filter, 20);
        filter->SetMethod(vtkMeshWarp::ANISOTROPIC_FEMWARP);
        filter->SetCoefficients(vtkMeshWarp::LOCAL_GRADIENTS);
      });
    testSame("biharmonic", controller, *mesh, same, method(vtkMeshWarp::BIHARMONIC));
    testSame("biharmonic in steps", controller, *mesh, same,
      [](vtkMeshWarp* filter)
      {
        turn(filter, 20);
        TAUTLINE_SET(filter, SetMethod(vtkMeshWarp::BIHARMONIC), SetSteps(2));
      });
    // Walls include all cells around a point, whichever process has them.
    testSame("radial basis", controller, *mesh, same, method(vtkMeshWarp::RADIAL_BASIS));
    testSame("rotations", controller, *mesh, same, method(vtkMeshWarp::INVERSE_DISTANCE_ROTATIONS));
    testSame("automatic", controller, *mesh, same, method(vtkMeshWarp::AUTOMATIC));
    // One process solves by BiCGSTAB and ends at the tolerance, processes by a factorization.
    testSame(
      "weighted Laplacian", controller, *mesh, 1e-9, method(vtkMeshWarp::WEIGHTED_LAPLACIAN));
    testSame("weighted Laplacian, exact", controller, *mesh, same,
      [](vtkMeshWarp* filter)
      {
        turn(filter, 20);
        TAUTLINE_SET(filter, SetMethod(vtkMeshWarp::WEIGHTED_LAPLACIAN), SetTolerance(1e-13));
      });
  }
  testWrong(controller, volume);
  testPutTogether(controller);
  const auto setTo = [](int method, double angle)
  {
    return [method, angle](vtkMeshWarp* filter)
    {
      turn(filter, angle);
      filter->SetMethod(method);
    };
  };
  for (const MeshData* mesh : { &planar, &volume })
  {
    const Context context(mesh == &planar ? "planar" : "volume");
    testValid("hybrid", controller, *mesh, false, false, setTo(vtkMeshWarp::HYBRID, 20));
    testValid("tangled hybrid", controller, *mesh, true, false, setTo(vtkMeshWarp::HYBRID, 90));
    testValid(
      "untangled", controller, *mesh, true, false, setTo(vtkMeshWarp::FEMWARP_UNTANGLING, 90));
    testValid("followed", controller, *mesh, true, mesh == &volume,
      setTo(vtkMeshWarp::FEMWARP_UNTANGLING, 170));
    // (4.24) as it stands: its untangling metric is rescaled by the largest values of all.
    for (const double beta : { 0.0, 0.1 })
    {
      const Context inner("beta " + std::to_string(beta));
      const auto literal = [beta](vtkMeshWarp* filter)
      {
        turn(filter, 90);
        TAUTLINE_SET(
          filter, SetMethod(vtkMeshWarp::HYBRID), UntangleFirstOff(), SetUntanglingBeta(beta));
      };
      testValid("literal hybrid", controller, *mesh, true, false, literal);
    }
    testConverged(controller, *mesh, 20);
    testSpanned(controller, *mesh);
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMeshWarpPieces)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testPieces(controller));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
