// SPDX-License-Identifier: BSD-3-Clause
// Optimization and untangling on ranks: the points do not depend on how the mesh is cut, and are as
// good as on one process in its own order.
#include "OptimizingRanks.h"
#include "Registry.h"
#include "tautline/Untangling/Untangle.h"

using namespace tautline;

namespace
{
std::vector<int> numbersOfRanks = { 2, 3, 4 };

/// Runs on one rank and on several, and compares; returns the run on one.
Run testCuts(const char* name, const MeshData& whole, const OptimizeOptions& options,
  Constraint constraint = Constraint::FixedBoundary, double limit = 0,
  const SetElements& set = nullptr)
{
  const Context context(name);
  const Run one = runOn(whole, Cut::FirstOnly, 1, options, constraint, limit, set);
  forEachCut(numbersOfRanks,
    [&](Cut cut, int ranks)
    {
      const Run run = runOn(whole, cut, ranks, options, constraint, limit, set);
      TAUTLINE_CHECK(farthest(run.points, one.points) <= 1e-10);
      TAUTLINE_CHECK_EQUAL(run.result.history.size(), one.result.history.size());
      TAUTLINE_CHECK_EQUAL(
        run.result.history.back().objective, one.result.history.back().objective);
      TAUTLINE_CHECK_EQUAL(run.result.history.back().moving, one.result.history.back().moving);
      TAUTLINE_CHECK_EQUAL(
        static_cast<int>(run.result.reason), static_cast<int>(one.result.reason));
      TAUTLINE_CHECK_EQUAL(run.result.freeVertices, one.result.freeVertices);
      TAUTLINE_CHECK_EQUAL(run.result.invertedAfter, one.result.invertedAfter);
      TAUTLINE_CHECK_EQUAL(run.result.restored, one.result.restored);
      TAUTLINE_CHECK_EQUAL(run.result.remaining, one.result.remaining);
    });
  return one;
}

/// The same problem in the order of one process: the objective agrees to 1e-6, validity is equal.
void testOrders(const char* name, const MeshData& whole, OptimizeOptions options,
  bool slides = false, const SetElements& set = nullptr)
{
  const Context context(name);
  options.optimizer = isGlobal(options.optimizer) ? options.optimizer : Optimizer::LocalNewton;
  options.stopping.relativeChange = 1e-9;
  options.stopping.maximumIterations = 1000;
  const Run run = testCuts(
    name, whole, options, slides ? Constraint::Sliding : Constraint::FixedBoundary, 0, set);
  const Mesh mesh(whole.view());
  ElementData elements;
  if (set)
  {
    set(mesh, elements, options);
  }
  BoundaryShape shape;
  if (slides)
  {
    shape = boundaryShape(mesh, 1.0);
    options.fixed = shape.fixed.data();
    options.slidePlanes = shape.planes.data();
    options.slideLines = shape.lines.data();
  }
  const OptimizeResult usual = optimize(mesh, options);
  const double now = run.result.history.back().objective, then = usual.history.back().objective;
  TAUTLINE_CHECK(now < run.result.history.front().objective);
  TAUTLINE_CHECK(std::abs(now - then) <= 1e-6 * std::abs(then));
  TAUTLINE_CHECK(std::abs(run.result.history.front().objective - usual.history.front().objective) <=
    1e-12 * std::abs(then));
  TAUTLINE_CHECK_EQUAL(run.result.invertedAfter, usual.invertedAfter);
  TAUTLINE_CHECK_EQUAL(run.result.freeVertices, usual.freeVertices);
  std::cout << name << ": " << run.result.iterations << " and " << usual.iterations
            << " sweeps, objectives differ by " << now / then - 1 << ", points by "
            << farthest(run.points, usual.points) << "\n";
}

/// Where a cell is: the sum of its points, which does not depend on the rank.
double placeOf(const Mesh& mesh, Index cell)
{
  const MeshView& view = mesh.view();
  double sum = 0;
  for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
  {
    sum += view.points[3 * view.connectivity[n]];
  }
  return sum / static_cast<double>(view.offsets[cell + 1] - view.offsets[cell]);
}

/// Weights that are 0 in a part of the mesh, so that some ranks may have no other.
void setWeights(const Mesh& mesh, ElementData& elements, OptimizeOptions& options)
{
  constexpr double without = 2.5;
  for (Index cell = 0; cell < mesh.view().numberOfCells; ++cell)
  {
    const double x = placeOf(mesh, cell);
    elements.weights.push_back(x < without ? 0.0 : x);
  }
  options.objectives[0].elementWeights = elements.weights.data();
}

void setSizes(const Mesh& mesh, ElementData& elements, OptimizeOptions& options)
{
  std::vector<double> sizes;
  for (Index cell = 0; cell < mesh.view().numberOfCells; ++cell)
  {
    sizes.push_back((1.0 + 0.3 * placeOf(mesh, cell)) / 6.0);
  }
  elements.targets = sizeTargets(mesh, sizes.data());
  options.objectives[0].evaluation.targets = &elements.targets;
}

void setTensors(const Mesh& mesh, ElementData& elements, OptimizeOptions& options)
{
  std::vector<double> tensors;
  for (Index cell = 0; cell < mesh.view().numberOfCells; ++cell)
  {
    const double stretch = 1.0 + 0.4 * placeOf(mesh, cell);
    for (const double entry : { stretch, 0.1, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0, 1.0 })
    {
      tensors.push_back(entry);
    }
  }
  elements.targets = tensorTargets(mesh, tensors.data());
  options.objectives[0].evaluation.targets = &elements.targets;
}

/// Weights and targets, which each rank has of its own cells.
void testElementData()
{
  const MeshData tets = jittered(CellType::Tetrahedron, 5, 0.2);
  const MeshData hexes = jittered(CellType::Hexahedron, 5, 0.2);
  OptimizeOptions ratio = with({ Metric::InverseMeanRatio });
  OptimizeOptions shapeSize = with({ Metric::ShapeSizeBarrier });
  const Run weighted = testCuts("weights", tets, ratio, Constraint::FixedBoundary, 0, setWeights);
  const Run plain = runOn(tets, Cut::FirstOnly, 1, ratio);
  TAUTLINE_CHECK(farthest(weighted.points, plain.points) > 0.02);
  testOrders("weights of one process", tets, ratio, false, setWeights);
  testOrders("sizes", tets, shapeSize, false, setSizes);
  testOrders("sizes of hexahedra", hexes, shapeSize, false, setSizes);
  testOrders("tensors", tets, ratio, false, setTensors);
  OptimizeOptions quick = ratio;
  quick.optimizer = Optimizer::LimitedMemoryBFGS;
  quick.stopping.gradientNorm = 1e-7;
  const Run one = runOn(tets, Cut::FirstOnly, 1, quick, Constraint::FixedBoundary, 0, setWeights);
  forEachCut({ 2, 3 },
    [&](Cut cut, int ranks)
    {
      const Run run = runOn(tets, cut, ranks, quick, Constraint::FixedBoundary, 0, setWeights);
      TAUTLINE_CHECK(farthest(run.points, one.points) <= 1e-10);
    });
  // All 0: an error on all ranks.
  const auto nothing = [](const Mesh& mesh, ElementData& elements, OptimizeOptions& options)
  {
    elements.weights.assign(mesh.view().numberOfCells, 0.0);
    options.objectives[0].elementWeights = elements.weights.data();
  };
  std::string message;
  try
  {
    runOn(tets, Cut::Slabs, 3, ratio, Constraint::FixedBoundary, 0, nothing);
  }
  catch (const Error& error)
  {
    message = error.what();
  }
  TAUTLINE_CHECK(message.find(wording("weights-of-all-elements-are-0")) != std::string::npos);
}

/// See testConvergenceOfAll() of TestLocalSweep.
void testConvergenceOfAll()
{
  constexpr double tolerance = 1e-3;
  const MeshData data = waveAndQuickVertex();
  OptimizeOptions options = with({ Metric::InverseMeanRatio });
  options.culling = QuickCulling;
  options.relaxation = 1;
  options.stopping.relativeChange = tolerance;
  const Run found = testCuts("convergence of all", data, options);
  TAUTLINE_CHECK(found.result.reason == StopReason::RelativeChange);
  const std::vector<IterationRecord>& history = found.result.history;
  TAUTLINE_CHECK(wentOn(history, tolerance));
  TAUTLINE_CHECK(nextGain(data, found.points) <= tolerance);
}

/// Throws on one rank: an error on all.
void testFailure()
{
  const MeshData whole = jittered(CellType::Tetrahedron, 4, 0.2);
  const auto rankOf = cutBy(whole, Cut::Slabs, 3);
  int errors = 0;
  std::mutex mutex;
  onRanks(3,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(whole, group.rank(), rankOf);
      DistributedMesh mesh(group, { part.data.view(), nullptr, nullptr });
      const std::vector<unsigned char> fixed = rankBoundary(mesh);
      OptimizeOptions options;
      options.fixed = fixed.data();
      options.observer = [&](const IterationState& state)
      {
        if (group.rank() == 1 && state.record.iteration == 2)
        {
          throw Error("The observer has failed.");
        }
        return true;
      };
      try
      {
        optimize(localMesh(mesh), options, {}, Ranks(mesh));
      }
      catch (const Error& error)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        errors += std::string(error.what()) == "In process 1: The observer has failed.";
      }
    });
  TAUTLINE_CHECK_EQUAL(errors, 3);
}

void testRejections()
{
  const MeshData whole = jittered(CellType::Tetrahedron, 2, 0.1);
  SingleRank group;
  DistributedMesh mesh(group, { whole.view(), nullptr, nullptr });
  const std::vector<unsigned char> fixed = rankBoundary(mesh);
  OptimizeOptions options;
  options.fixed = fixed.data();
  const auto message = [&](const OptimizeOptions& wrong) -> std::string
  {
    try
    {
      optimize(localMesh(mesh), wrong, {}, Ranks(mesh));
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  };
  TAUTLINE_CHECK_EQUAL(message(options), "");
  OptimizeOptions worst = options;
  worst.improveWorst = 0.1;
  TAUTLINE_CHECK(message(worst).find(wording("improve-worst")) != std::string::npos);
  OptimizeOptions mean = options;
  mean.objectives[0].objectiveTemplate = ObjectiveTemplate::PowerMean;
  TAUTLINE_CHECK(message(mean).find("p-Mean") != std::string::npos);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestOptimizeRanks)
{
  constexpr int most = 3; // the argument that is another number of ranks
  if (argc > most)
  {
    numbersOfRanks = { std::stoi(argv[most]) };
  }
  const MeshData tets = jittered(CellType::Tetrahedron, 5, 0.2);
  const MeshData hexes = jittered(CellType::Hexahedron, 5, 0.2);
  const MeshData triangles = jittered(CellType::Triangle, 9, 0.25);
  TAUTLINE_RUN(testOrders("tetrahedra", tets, with({ Metric::InverseMeanRatio })));
  TAUTLINE_RUN(testOrders("hexahedra", hexes, with({ Metric::InverseMeanRatio })));
  TAUTLINE_RUN(testOrders("triangles", triangles, with({ Metric::InverseMeanRatio })));
  TAUTLINE_RUN(testOrders("tetrahedra that slide", tets, with({ Metric::InverseMeanRatio }), true));
  OptimizeOptions product = with({ Metric::InverseMeanRatio, Metric::Size });
  product.scalarization.method = Scalarization::ObjectiveProduct;
  TAUTLINE_RUN(testCuts("two objectives", tets, product));
  TAUTLINE_RUN(testCuts("conjugate gradients", tets,
    []
    {
      OptimizeOptions options = with({ Metric::InverseMeanRatio });
      options.optimizer = Optimizer::LocalConjugateGradient;
      return options;
    }()));
  constexpr double limit = 0.02;
  const Run limited =
    testCuts("limits", tets, with({ Metric::InverseMeanRatio }), Constraint::Limits, limit);
  const double way = farthest(limited.points, tets.points);
  TAUTLINE_CHECK(way > 0.5 * limit && way <= limit * (1 + 1e-12));
  // Only points inside are moved far: all elements can become valid, in any order.
  const MeshData whole = jittered(CellType::Tetrahedron, 6, 0.8);
  MeshData tangled = blockMesh(CellType::Tetrahedron, 6, 6, 6);
  for (Index p = 0; p < tangled.numberOfPoints(); ++p)
  {
    const Vec3 at = tangled.point(p);
    if (*std::min_element(at.begin(), at.end()) > 0 && *std::max_element(at.begin(), at.end()) < 6)
    {
      std::copy_n(&whole.points[3 * p], 3, &tangled.points[3 * p]);
    }
  }
  const Run untangled = testCuts("untangle", tangled, {}, Constraint::Untangle);
  TAUTLINE_CHECK(untangled.result.invertedBefore > 0);
  const UntangleResult usual = untangle(Mesh(tangled.view()), {});
  TAUTLINE_CHECK_EQUAL(usual.invertedAfter, 0);
  TAUTLINE_CHECK_EQUAL(untangled.result.invertedAfter, usual.invertedAfter);
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(untangled.result.remaining), usual.invertedAfter);
  const Run both = testCuts("untangle first", tangled, with({ Metric::InverseMeanRatio }));
  TAUTLINE_CHECK_EQUAL(both.result.invertedAfter, usual.invertedAfter);
  std::cout << "untangled " << untangled.result.invertedBefore << " elements, "
            << usual.invertedAfter << " remain\n";
  TAUTLINE_RUN(testConvergenceOfAll());
  TAUTLINE_RUN(testElementData());
  TAUTLINE_RUN(testFailure());
  TAUTLINE_RUN(testRejections());
}
