// SPDX-License-Identifier: BSD-3-Clause
// Objectives of curved elements reach minima that are known, and no element is invalid on the way.
#include "CurvedBlocks.h"
#include "MfemFile.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Curved/OptimizeCurved.h"

using namespace tautline;

namespace
{
CurvedOptimizeResult optimize(
  const MeshData& data, const std::function<void(CurvedOptimizeOptions&)>& set = {})
{
  CurvedOptimizeOptions options;
  options.boundary = BoundaryMotion::Fixed;
  if (set)
  {
    set(options);
  }
  return optimizeCurved(Mesh(data.view()), options);
}

double largestDistance(const std::vector<double>& a, const std::vector<double>& b)
{
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

MeshData dataOf(const char* name)
{
  const MeshFile file = readMfem(externalData("curved") + "/" + name, false);
  TAUTLINE_LET(MeshData, data, points = file.points, types = file.cellTypes, offsets = file.offsets,
    connectivity = file.connectivity);
  return data;
}

/// The sum of a metric at the points of the result, as MFEM has it: with the determinant of the
/// ideal element and the size of the reference element as weight.
double objectiveOf(
  const MeshData& data, const CurvedOptimizeResult& result, const char* metric, double weight)
{
  MeshView view = data.view();
  view.points = result.points.data();
  CurvedObjective objective;
  objective.objective.metric = findMetric(metric)->metric;
  objective.objective.objectiveTemplate = ObjectiveTemplate::Sum;
  return weight * evaluateCurvedObjective(Mesh(view), {}, objective, nullptr).value;
}

void minimize(CurvedOptimizeOptions& options, const char* metric)
{
  options.objectives[0].objective.metric = findMetric(metric)->metric;
  options.objectives[0].objective.objectiveTemplate = ObjectiveTemplate::Sum;
}
}

TAUTLINE_PART(testSquares)
{
  // Squares and cubes are ideal: from a distorted block, the uniform one is reached.
  for (const CellType type : { CellType::Quadrilateral, CellType::Hexahedron })
  {
    for (const int order : { 2, 3 })
    {
      if (type == CellType::Hexahedron && order == 3)
      {
        continue;
      }
      const Context context(topology(type).name + std::to_string(order));
      const MeshData uniform = movedCurvedBlock(type, order, 3, 0);
      const MeshData data = movedCurvedBlock(type, order, 3, 0.05);
      const CurvedOptimizeResult result = optimize(
        data, [](CurvedOptimizeOptions& options) { options.stopping.relativeChange = 1e-12; });
      TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
      TAUTLINE_CHECK_RELATIVE(
        result.history.back().objective, static_cast<double>(data.numberOfCells()), 1e-9);
      TAUTLINE_CHECK(largestDistance(result.points, uniform.points) < 1e-4);
    }
  }
}

TAUTLINE_PART(testReference)
{
  // The elements of another mesh as targets: its points are the minimum.
  const MeshData wanted = movedCurvedBlock(CellType::Tetrahedron, 2, 2, 0.03);
  const MeshData data = movedCurvedBlock(CellType::Tetrahedron, 2, 2, 0);
  const CurvedOptimizeResult result = optimize(data,
    [&](CurvedOptimizeOptions& options)
    {
      options.objectives[0].target = TargetType::Reference;
      options.objectives[0].data = wanted.points.data();
      options.stopping.relativeChange = 1e-13;
    });
  TAUTLINE_CHECK(largestDistance(result.points, wanted.points) < 1e-4);
}

TAUTLINE_PART(testNeverInvalid)
{
  const MeshData data = movedCurvedBlock(CellType::Triangle, 3, 3, 0.2);
  double last = HUGE_VAL;
  bool optimizing = false;
  const CurvedOptimizeResult result = optimize(data,
    [&](CurvedOptimizeOptions& options)
    {
      options.observer = [&](const IterationState& state)
      {
        optimizing = optimizing || state.record.inverted == 0;
        if (optimizing && state.record.objective > 0 && state.record.gradientNorm > 0)
        {
          std::vector<double> points(data.points.size());
          state.points(points.data());
          TAUTLINE_CHECK_EQUAL(invalidCells(data, points), 0);
          last = state.record.objective;
        }
        return true;
      };
    });
  TAUTLINE_CHECK(result.untangled);
  TAUTLINE_CHECK(result.invalidBefore > 0);
  TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
  TAUTLINE_CHECK(last < HUGE_VAL);
  const auto first = std::find_if(result.history.begin(), result.history.end(),
    [](const IterationRecord& record) { return record.gradientNorm > 0; });
  TAUTLINE_CHECK(result.history.back().objective < first->objective);
}

TAUTLINE_PART(testSeveralObjectives)
{
  const MeshData data = movedCurvedBlock(CellType::Quadrilateral, 2, 3, 0.08);
  const std::vector<double> sizes(data.numberOfCells(), 1.0);
  const CurvedOptimizeResult result = optimize(data,
    [&](CurvedOptimizeOptions& options)
    {
      options.objectives.resize(2);
      options.objectives[1].objective.metric = Metric::SizeBarrier;
      options.objectives[1].target = TargetType::Size;
      options.objectives[1].data = sizes.data();
      options.scalarization.method = Scalarization::WeightedSum;
      options.stopping.relativeChange = 1e-12;
    });
  // Both are least on the uniform mesh: 1 a square, and 0.
  TAUTLINE_CHECK_NEAR(result.history.back().objectives[0], 9, 1e-6);
  TAUTLINE_CHECK_NEAR(result.history.back().objectives[1], 0, 1e-6);
}

TAUTLINE_PART(testCubeHoles)
{
  const MeshData data = dataOf("cube-holes-inv.mesh");
  const CurvedOptimizeResult result = optimize(data,
    [](CurvedOptimizeOptions& options)
    {
      minimize(options, "mu_303");
      options.boundary = BoundaryMotion::FlatParts;
    });
  TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
  TAUTLINE_CHECK(objectiveOf(data, result, "mu_303", std::sqrt(0.5) / 6) <= 92.43);
}

TAUTLINE_PART(testBlade)
{
  const MeshData data = dataOf("blade.mesh");
  const CurvedOptimizeResult result = optimize(data,
    [](CurvedOptimizeOptions& options)
    {
      minimize(options, "mu_2");
      options.boundary = BoundaryMotion::FlatParts;
    });
  TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
  TAUTLINE_CHECK_EQUAL(invalidCells(data, result.points), 0);
  TAUTLINE_CHECK(objectiveOf(data, result, "mu_2", 1) <= 66.52);
}
