// SPDX-License-Identifier: BSD-3-Clause
// Filters on meshes of extreme size or far from the origin: the result matches the mesh of
// ordinary size, or an error or a warning names the problem and the remedy.
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Optimization/OptimizeOptions.h"
#include "tautline/Perturbation/Perturb.h"
#include "vtkConditionEstimator.h"
#include "vtkElementQuality.h"
#include "vtkHorizonNeighbors.h"
#include "vtkInteractionLayer.h"
#include "vtkMeshComparison.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkMeshWarp.h"

using namespace tautline;

namespace
{
/// 1e-150, 1e-100, 1e-30, 1e-12 and so on, as exponents of two.
constexpr int exponents[] = { -498, -332, -100, -40, 40, 100, 332, 498 };

MeshData scaled(MeshData data, int exponent)
{
  data.transform([=](const Vec3& p) { return std::ldexp(1.0, exponent) * p; });
  return data;
}

MeshData moved(MeshData data, double distance)
{
  data.transform([=](const Vec3& p) { return p + Vec3{ distance, distance, 0 }; });
  return data;
}

/// A block with its inner points moved at random; some elements inverted if tangled.
MeshData perturbed(CellType type, bool tangled = false)
{
  const Index n = topology(type).dimension == 2 ? 10 : 4;
  MeshData data = blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
  TAUTLINE_LET(PerturbOptions, options, percentage = 100, fraction = 0.7,
    tangledFraction = tangled ? 0.05 : 0.0, seed = 3);
  data.points = perturb(Mesh(data.view()), nullptr, options).points;
  return data;
}

std::vector<double> pointsOf(vtkAlgorithm* filter)
{
  auto* set = outputOf<vtkPointSet>(filter);
  std::vector<double> points(3 * set->GetNumberOfPoints());
  for (vtkIdType i = 0; i < set->GetNumberOfPoints(); ++i)
  {
    set->GetPoint(i, points.data() + 3 * i);
  }
  return points;
}

/// The largest distance between points, after the first ones are divided by a power of two.
double difference(const std::vector<double>& a, int exponent, const std::vector<double>& b)
{
  return largestOf<double>(a.size() == b.size() ? 0.0 : HUGE_VAL, std::min(a.size(), b.size()),
    [&](std::size_t i) { return std::abs(std::ldexp(a[i], -exponent) - b[i]); });
}

double statistic(vtkTable* table, const char* column)
{
  return table->GetValueByName(0, column).ToDouble();
}

//------------------------------------------------------------------------------
/// Filters that move points give the points of the mesh of ordinary size, scaled.
template <class Filter>
void testMoving(const char* name, bool tangled, const std::function<void(Filter*)>& setUp)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const MeshData data = perturbed(type, tangled);
    vtkNew<Filter> filter;
    setUp(filter);
    Messages messages(filter);
    TAUTLINE_SET(filter, SetInputData(toGrid(data)), Update());
    const std::vector<double> expected = pointsOf(filter);
    TAUTLINE_CHECK(difference(expected, 0, data.points) > 0.05);
    for (int exponent : exponents)
    {
      const Context context(std::string(name) + ", 2^" + std::to_string(exponent));
      TAUTLINE_SET(filter, SetInputData(toGrid(scaled(data, exponent))), Update());
      TAUTLINE_CHECK_NEAR(difference(pointsOf(filter), exponent, expected), 0, 1e-9);
      auto* displacement = outputOf<vtkPointSet>(filter)->GetPointData()->GetArray("Displacement");
      double most = largestOf<double>(0, displacement->GetNumberOfTuples(),
        [&](vtkIdType i) { return std::abs(displacement->GetComponent(i, 0)); });
      TAUTLINE_CHECK(std::ldexp(most, -exponent) > 0.05);
      TAUTLINE_CHECK(messages.empty());
      messages.clear();
    }
  }
}

TAUTLINE_PART(testStatistics)
{
  const MeshData data = perturbed(CellType::Tetrahedron);
  TAUTLINE_NEW(
    vtkMeshOptimizer, filter, AddObjectiveByName("imr"), SetInputData(toGrid(data)), Update());
  const double before = statistic(filter->GetStatistics(), "MeanBefore");
  const double after = statistic(filter->GetStatistics(), "MeanAfter");
  const std::string reason = filter->GetReason();
  TAUTLINE_CHECK(after < before - 0.02);
  for (int exponent : exponents)
  {
    const Context context("2^" + std::to_string(exponent));
    TAUTLINE_SET(filter, SetInputData(toGrid(scaled(data, exponent))), Update());
    TAUTLINE_CHECK_NEAR(statistic(filter->GetStatistics(), "MeanBefore"), before, 1e-12);
    TAUTLINE_CHECK_NEAR(statistic(filter->GetStatistics(), "MeanAfter"), after, 1e-9);
    TAUTLINE_CHECK_EQUAL(std::string(filter->GetReason()), reason);
  }
}

/// An objective that compares with a target of length 1 is rejected; with a reference it is not.
TAUTLINE_PART(testTargets)
{
  const MeshData data = scaled(perturbed(CellType::Triangle), -498);
  vtkNew<vtkMeshOptimizer> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, AddObjectiveByName("mu_size"), SetInputData(toGrid(data)), Update());
  TAUTLINE_CHECK(messages.has(wording("size-barrier-cannot-be-optimized-on-elements")));
  TAUTLINE_CHECK(messages.has(wording("target-by-reference")));
  messages.clear();
  TAUTLINE_SET(filter, RemoveAllObjectives(),
    AddObjectiveByName(
      "mu_shape_size", vtkMeshOptimizer::DEFAULT_TEMPLATE, 1.0, vtkMeshOptimizer::REFERENCE),
    SetInputData(1, toGrid(scaled(blockMesh(CellType::Triangle, 10, 10, 0), -498))), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(statistic(filter->GetStatistics(), "MeanAfter") <
    0.05 * statistic(filter->GetStatistics(), "MeanBefore"));
}

//------------------------------------------------------------------------------
/// Far from the origin points move as near to it, to the digits of the coordinates; where these are
/// too few for the elements, a warning says so.
TAUTLINE_PART(testOffsets)
{
  const MeshData data = perturbed(CellType::Triangle);
  vtkNew<vtkMeshOptimizer> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, AddObjectiveByName("imr"), SetInputData(toGrid(data)), Update());
  const double after = statistic(filter->GetStatistics(), "MeanAfter");
  for (double distance : { 1e3, 1e6, 1e9, 1e12 })
  {
    const Context context("at " + std::to_string(distance));
    TAUTLINE_SET(filter, SetInputData(toGrid(moved(data, distance))), Update());
    TAUTLINE_CHECK(messages.empty());
    // Coordinates of 1e12 have steps of 1.2e-4.
    TAUTLINE_CHECK_NEAR(statistic(filter->GetStatistics(), "MeanAfter"), after, 1e-4);
    const std::vector<double> values =
      valuesOf(withPointsOf(data, outputOf(filter)), Metric::InverseMeanRatio);
    double sum =
      sumOf<double>(0, values, [&](double q) { return q / static_cast<double>(values.size()); });
    TAUTLINE_CHECK_NEAR(sum, statistic(filter->GetStatistics(), "MeanAfter"), 1e-12);
  }
  // Steps of 0.125 at 1e15.
  TAUTLINE_SET(filter, SetInputData(toGrid(moved(data, 1e15))), Update());
  TAUTLINE_CHECK(messages.has(wording("the-coordinates-are-too-coarse-for-the")));
  TAUTLINE_CHECK(messages.has(wording("double-precision-have-steps-of-0-12")));
  TAUTLINE_CHECK(messages.has(wording("near-the-origin")));
  TAUTLINE_CHECK(filter->GetInvertedAfter() <= filter->GetInvertedBefore());

  TAUTLINE_NEW(
    vtkElementQuality, quality, SetInputData(toGrid(moved(data, 1e5), VTK_FLOAT)), Update());
  TAUTLINE_CHECK(quality->GetNotice() == std::string());
  TAUTLINE_SET(quality, SetInputData(toGrid(moved(data, 1e6), VTK_FLOAT)), Update());
  TAUTLINE_CHECK(contains(quality->GetNotice(), wording("single-precision-have-steps-of-0-062")));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testMeasuring)
{
  const MeshData data = perturbed(CellType::Tetrahedron);
  vtkNew<vtkElementQuality> quality;
  vtkNew<vtkMeshComparison> comparison;
  Messages messages(quality), compared(comparison);
  TAUTLINE_SET(quality, AddMetricByName("scaled_jacobian"), SetInputData(toGrid(data)), Update());
  const double mean = statistic(quality->GetStatistics(), "Mean");
  for (int exponent : exponents)
  {
    const Context context("2^" + std::to_string(exponent));
    const MeshData far = scaled(data, exponent);
    TAUTLINE_SET(quality, SetInputData(toGrid(far)), Update());
    TAUTLINE_CHECK_EQUAL(statistic(quality->GetStatistics(), "Mean"), mean);
    TAUTLINE_SET(comparison, SetInputData(0, toGrid(far)),
      SetInputData(1, toGrid(scaled(perturbed(CellType::Tetrahedron, true), exponent))), Update());
    auto* table = vtkTable::SafeDownCast(comparison->GetOutputDataObject(1));
    TAUTLINE_CHECK(statistic(table, "InvertedAfter") > 0 && statistic(table, "Worse") > 0);
  }
  TAUTLINE_CHECK(messages.empty() && compared.empty());
  TAUTLINE_SET(
    quality, AddMetricByName("size"), SetInputData(toGrid(scaled(data, -100))), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_SET(quality, SetInputData(toGrid(scaled(data, -498))), Update());
  TAUTLINE_CHECK(messages.has(wording("size-area-or-volume-of-320-elements")));
}

/// Filters that assemble matrices reject extreme sizes by name.
TAUTLINE_PART(testRejections)
{
  const auto rejects = [](vtkAlgorithm* filter, const MeshData& data, const char* text)
  {
    for (int exponent : { -498, -100, 100, 498 })
    {
      const Context context(
        std::string(filter->GetClassName()) + ", 2^" + std::to_string(exponent));
      Messages messages(filter);
      auto grid = toGrid(scaled(data, exponent));
      TAUTLINE_NEW(vtkDoubleArray, d, SetName("d"), SetNumberOfComponents(3),
        SetNumberOfTuples(grid->GetNumberOfPoints()), Fill(0),
        FillComponent(0, std::ldexp(0.1, exponent)));
      grid->GetPointData()->AddArray(d);
      TAUTLINE_SET(filter, SetInputDataObject(0, grid), Update());
      TAUTLINE_CHECK(messages.has(text));
      TAUTLINE_CHECK(messages.has(wording("cale-the-mesh-first-filter-transform")));
    }
  };
  const MeshData data = blockMesh(CellType::Triangle, 4, 4, 0);
  TAUTLINE_NEW(vtkMeshWarp, warp, SetMotion(vtkMeshWarp::DISPLACEMENT),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d"));
  rejects(warp, data, wording("warping-needs-cells-between-5-4e-20"));
  vtkNew<vtkConditionEstimator> condition;
  rejects(condition, data, wording("a-finite-element-matrix-needs-cells-between"));
  vtkNew<vtkHorizonNeighbors> neighbors;
  rejects(neighbors, data, wording("a-nonlocal-model-needs-cells-between"));
  vtkNew<vtkInteractionLayer> layer;
  rejects(layer, data, wording("a-nonlocal-model-needs-cells-between"));

  Messages messages(neighbors);
  TAUTLINE_SET(neighbors, SetInputData(toGrid(data)), SetHorizon(1e200), Update());
  TAUTLINE_CHECK(messages.has(wording("the-horizon-has-to-be-between-5e")));
}
}

TAUTLINE_TEST(TestScaleFilters)
{
  TAUTLINE_RUN(testMoving<vtkMeshOptimizer>(
    "optimize", false, [](vtkMeshOptimizer* filter) { filter->AddObjectiveByName("imr"); }));
  TAUTLINE_RUN(testMoving<vtkMeshOptimizer>("L-BFGS", false,
    [](vtkMeshOptimizer* filter)
    {
      filter->AddObjectiveByName("imr");
      filter->SetOptimizer(static_cast<int>(Optimizer::LimitedMemoryBFGS));
    }));
  TAUTLINE_RUN(testMoving<vtkMeshUntangler>("untangle", true, [](vtkMeshUntangler*) {}));
  TAUTLINE_RUN(testMoving<vtkMeshPerturbation>("perturb", false, [](vtkMeshPerturbation*) {}));
}
