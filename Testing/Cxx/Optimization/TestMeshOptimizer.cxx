// SPDX-License-Identifier: BSD-3-Clause
// Optimize Mesh against the kernel: every option arrives, arrays and tables report what happened.
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Optimization/Optimize.h"
#include "tautline/Perturbation/Perturb.h"
#include "vtkMeshOptimizer.h"

#include <sstream>

using namespace tautline;

namespace
{
/// A block of cells with its inner points moved at random, valid.
MeshData perturbed(CellType type, Index n)
{
  MeshData data = blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
  TAUTLINE_LET(PerturbOptions, options, percentage = 100, fraction = 0.8, seed = 3);
  data.points = perturb(Mesh(data.view()), nullptr, options).points;
  return data;
}

std::vector<unsigned char> boundaryOf(const MeshData& data)
{
  const Boundary boundary = Mesh(data.view()).boundary();
  return { boundary.isBoundaryPoint.begin(), boundary.isBoundaryPoint.end() };
}

std::vector<double> pointsOf(vtkDataObject* output)
{
  auto* set = vtkPointSet::SafeDownCast(output);
  std::vector<double> points(3 * set->GetNumberOfPoints());
  for (vtkIdType i = 0; i < set->GetNumberOfPoints(); ++i)
  {
    set->GetPoint(i, points.data() + 3 * i);
  }
  return points;
}

std::vector<double> pointsOf(vtkMeshOptimizer* filter)
{
  return pointsOf(filter->GetOutputDataObject(0));
}

double largestStep(const MeshData& before, const std::vector<double>& after, Index point)
{
  return norm(
    Vec3{ after[3 * point], after[3 * point + 1], after[3 * point + 2] } - before.point(point));
}

vtkSmartPointer<vtkDoubleArray> arrayOf(const char* name, const std::vector<double>& values)
{
  auto array = TAUTLINE_CHANGED(vtkSmartPointer<vtkDoubleArray>::New(), SetName(name));
  for (double value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}

double sumOfSquares(const MeshData& data, Metric metric = Metric::InverseMeanRatio)
{
  const std::vector<double> q = valuesOf(data, metric);
  return std::inner_product(q.begin(), q.end(), q.begin(), 0.0);
}

double cell(vtkTable* table, vtkIdType row, const char* column)
{
  return table->GetValueByName(row, column).ToDouble();
}

/// Presets and rows of objectives give bitwise what the kernel gives.
TAUTLINE_PART(testAgainstKernel)
{
  const MeshData data = perturbed(CellType::Tetrahedron, 4);
  const Mesh mesh(data.view());
  const auto boundary = boundaryOf(data);
  for (int preset = vtkMeshOptimizer::FAST_CLEAN_UP; preset <= vtkMeshOptimizer::WORST_ELEMENT;
       ++preset)
  {
    if (preset == vtkMeshOptimizer::PRESERVE_SHAPE)
    {
      continue;
    }
    const Context context("preset " + std::to_string(preset));
    OptimizeOptions options;
    applyPreset(Preset(preset), options);
    options.fixed = boundary.data();
    const OptimizeResult expected = optimize(mesh, options);
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)), SetPreset(preset), Update());
    TAUTLINE_CHECK(pointsOf(filter) == expected.points);
    TAUTLINE_CHECK_EQUAL(filter->GetIterations(), expected.iterations);
    TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), int(expected.reason));
    TAUTLINE_CHECK_EQUAL(std::string(filter->GetReason()), describe(expected.reason));
    TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), Index(expected.history.size()));
    TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), 27);
  }
}

/// The metric that judges the worst element is stated, chosen or not, once.
TAUTLINE_PART(testWorstMetric)
{
  for (const CellType type :
    { CellType::Hexahedron, CellType::Quadrilateral, CellType::Tetrahedron })
  {
    const bool simplices = type == CellType::Tetrahedron;
    for (const bool chosen : { false, true })
    {
      const Context context(std::string(topology(type).plural) + (chosen ? ", chosen" : ""));
      TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(perturbed(type, 4))),
        SetPreset(vtkMeshOptimizer::WORST_ELEMENT));
      if (chosen)
      {
        filter->SetWorstMetric(static_cast<int>(Metric::ScaledJacobian));
      }
      filter->Update();
      const bool stated = chosen || !simplices;
      const std::string summary = filter->GetSummary();
      const std::string label = metricInfo(Metric::ScaledJacobian).label;
      const std::string name = metricInfo(Metric::ScaledJacobian).name;
      vtkCellData* arrays = vtkDataSet::SafeDownCast(filter->GetOutput())->GetCellData();
      TAUTLINE_CHECK_EQUAL(contains(summary, "\n" + label + ": mean "), stated);
      TAUTLINE_CHECK_EQUAL(arrays->HasArray(name.c_str()) == 1, stated);
      TAUTLINE_CHECK_EQUAL(arrays->HasArray((name + "_before").c_str()) == 1, stated);
      TAUTLINE_CHECK_EQUAL(filter->GetStatistics()->GetNumberOfRows(), stated ? 2 : 1);
    }
  }
}

TAUTLINE_PART(testCustom)
{
  const MeshData data = perturbed(CellType::Tetrahedron, 4);
  const auto boundary = boundaryOf(data);
  const std::vector<double> weights = [&]
  {
    std::vector<double> w(data.numberOfCells());
    std::iota(w.begin(), w.end(), 1.0);
    return w;
  }();
  OptimizeOptions options;
  options.objectives.resize(2);
  TAUTLINE_SET(options, objectives[0].objectiveTemplate = ObjectiveTemplate::PowerMean,
    objectives[1].metric = Metric::RadiusRatio, objectives[1].weight = 3);
  for (Objective& objective : options.objectives)
  {
    TAUTLINE_SET(objective, power = 4, elementWeights = weights.data());
  }
  TAUTLINE_SET(options, scalarization.method = Scalarization::WeightedSum,
    optimizer = Optimizer::LimitedMemoryBFGS, stopping.maximumIterations = 7,
    stopping.relativeChange = 0, fixed = boundary.data());
  const OptimizeResult expected = optimize(Mesh(data.view()), options);

  vtkNew<vtkMeshOptimizer> filter;
  auto grid = TAUTLINE_CHANGED(toGrid(data), GetCellData()->AddArray(arrayOf("w", weights)));
  TAUTLINE_SET(filter, SetInputData(grid), AddObjectiveByName("imr", vtkMeshOptimizer::P_MEAN),
    AddObjectiveByName("rr", vtkMeshOptimizer::DEFAULT_TEMPLATE, 3));
  TAUTLINE_CHECK_EQUAL(filter->GetPreset(), int(vtkMeshOptimizer::CUSTOM));
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfObjectives(), 2);
  TAUTLINE_SET(filter, SetPower(4), SetScalarization(vtkMeshOptimizer::WEIGHTED_SUM),
    SetOptimizer(vtkMeshOptimizer::LIMITED_MEMORY_BFGS), SetMaximumIterations(7),
    SetRelativeChange(0),
    SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "w"), Update());
  TAUTLINE_CHECK(pointsOf(filter) == expected.points);
  TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), 8);
  for (const char* column : { "Objective", "imr objective", "imr mean", "imr worst", "rr objective",
         "rr mean", "rr worst", "Inverted", "N gradient", "N moving", "Time (s)" })
  {
    TAUTLINE_CHECK(filter->GetHistory()->GetColumnByName(column) != nullptr);
  }
  const IterationRecord& last = expected.history.back();
  TAUTLINE_CHECK_EQUAL(cell(filter->GetHistory(), 7, "Objective"), last.objective);
  TAUTLINE_CHECK_EQUAL(cell(filter->GetHistory(), 7, "rr objective"), last.objectives[1]);
  TAUTLINE_CHECK_EQUAL(cell(filter->GetHistory(), 7, "rr worst"), last.worst[1]);
  // The summary states each of several objectives, not their scalarization.
  const IterationRecord& first = expected.history.front();
  std::ostringstream objectives;
  objectives << "Objectives: " << first.objectives[0] << " to " << last.objectives[0] << ", "
             << first.objectives[1] << " to " << last.objectives[1] << ".";
  TAUTLINE_CHECK(contains(filter->GetSummary(), objectives.str()));

  // The slots of the panel are the same rows.
  TAUTLINE_NEW(vtkMeshOptimizer, slots, SetInputData(grid), SetPreset(vtkMeshOptimizer::CUSTOM),
    SetMetric2(int(Metric::RadiusRatio)), SetWeight2(3), SetTemplate1(vtkMeshOptimizer::P_MEAN),
    SetNumberOfObjectives(2), SetPower(4), SetScalarization(vtkMeshOptimizer::WEIGHTED_SUM),
    SetOptimizer(vtkMeshOptimizer::LIMITED_MEMORY_BFGS), SetMaximumIterations(7),
    SetRelativeChange(0),
    SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "w"), Update());
  TAUTLINE_CHECK(pointsOf(slots) == expected.points);
  slots->RemoveAllObjectives();
  slots->Update(); // the default objective
  TAUTLINE_CHECK(slots->GetHistory()->GetColumnByName("rr mean") == nullptr);
}

/// Every scalarization, optimizer and stopping criterion reaches the kernel.
TAUTLINE_PART(testOptions)
{
  const MeshData data = perturbed(CellType::Triangle, 8);
  const auto boundary = boundaryOf(data);
  using Change = std::function<void(vtkMeshOptimizer*, OptimizeOptions&)>;
  std::vector<std::pair<std::string, Change>> changes;
  for (int s = 0; s <= vtkMeshOptimizer::RAO; ++s)
  {
    changes.emplace_back("scalarization " + std::to_string(s),
      [s](vtkMeshOptimizer* f, OptimizeOptions& o)
      {
        f->SetScalarization(s);
        o.scalarization.method = Scalarization(s);
      });
  }
  for (int a = 0; a <= vtkMeshOptimizer::NEWTON_CONJUGATE_GRADIENT; ++a)
  {
    changes.emplace_back("optimizer " + std::to_string(a),
      [a](vtkMeshOptimizer* f, OptimizeOptions& o)
      {
        f->SetOptimizer(a);
        o.optimizer = Optimizer(a);
      });
  }
  const auto more = [&](const std::string& name, const Change& change)
  { changes.emplace_back(name, change); };
  more("c", [](auto* f, auto& o) { f->SetC(o.scalarization.c = 50); });
  more("exponent",
    [](auto* f, auto& o)
    {
      f->SetScalarization(vtkMeshOptimizer::EXPONENTIAL_WEIGHTED);
      o.scalarization.method = Scalarization::ExponentialWeighted;
      TAUTLINE_SET(f, SetExponent(o.scalarization.exponent = 3), AddUtopia(1), AddUtopia(2));
      o.scalarization.utopia = { 1, 2 };
    });
  more("gradient", [](auto* f, auto& o) { f->SetGradientNorm(o.stopping.gradientNorm = 0.1); });
  more("change", [](auto* f, auto& o) { f->SetRelativeChange(o.stopping.relativeChange = 0.05); });
  more("digits", [](auto* f, auto& o) { f->SetTwoDigits(o.stopping.twoDigits = true); });
  more("reduction", [](auto* f, auto& o) { f->SetReduction(o.stopping.reduction = 0.5); });
  // 0 is an ordinary best known value, and counts only if it is declared known.
  more("best known 0",
    [](auto* f, auto& o)
    {
      TAUTLINE_SET(f, SetReduction(o.stopping.reduction = 0.5),
        SetBestKnown(o.stopping.bestKnown = 0), UseBestKnownOn());
    });
  more("best unknown",
    [](auto* f, auto& o)
    { TAUTLINE_SET(f, SetReduction(o.stopping.reduction = 0.5), SetBestKnown(1e9)); });
  more("valid", [](auto* f, auto& o) { f->SetStopWhenValid(o.stopping.allValid = true); });
  more("iterations",
    [](auto* f, auto& o) { f->SetMaximumIterations(o.stopping.maximumIterations = 2); });
  more("none", [](auto* f, auto& o) { f->SetMaximumIterations(o.stopping.maximumIterations = 0); });
  more("culling", [](auto* f, auto& o) { f->SetCulling(o.culling = 0.1); });
  more("patch", [](auto* f, auto& o) { f->SetPatchIterations(o.patchIterations = 3); });
  more("relaxation", [](auto* f, auto& o) { f->SetRelaxation(o.relaxation = 1.0); });
  more("worst", [](auto* f, auto& o) { f->SetImproveWorst(o.improveWorst = 0.01); });
  more("combination",
    [](auto* f, auto& o)
    {
      f->SetCombination(vtkMeshOptimizer::WORST);
      o.objectives[0].evaluation.combination = Combination::Worst;
      o.objectives[1].evaluation.combination = Combination::Worst;
    });
  for (const auto& [name, change] : changes)
  {
    const Context context(name);
    OptimizeOptions options;
    options.objectives.resize(2);
    TAUTLINE_SET(options, objectives[1].metric = Metric::Size, stopping.maximumIterations = 12,
      fixed = boundary.data());
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)), AddObjectiveByName("imr"),
      AddObjectiveByName("size"), SetMaximumIterations(12));
    change(filter, options);
    filter->Update();
    const OptimizeResult expected = optimize(Mesh(data.view()), options);
    TAUTLINE_CHECK(pointsOf(filter) == expected.points);
    TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), int(expected.reason));
  }
}

TAUTLINE_PART(testArrays)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const MeshData data = perturbed(type, 4);
    vtkNew<vtkMeshOptimizer> filter;
    auto grid = toGrid(data);
    grid->GetPointData()->AddArray(arrayOf("mine", std::vector<double>(data.numberOfPoints(), 5)));
    TAUTLINE_SET(filter, SetInputData(grid), Update());
    vtkDataSet* output = meshOf(filter);
    const MeshData after = withPointsOf(data, output);
    const std::vector<double> before = valuesOf(data, Metric::InverseMeanRatio),
                              now = valuesOf(after, Metric::InverseMeanRatio);
    for (Index i = 0; i < data.numberOfCells(); ++i)
    {
      TAUTLINE_CHECK_EQUAL(component(output->GetCellData(), "imr_before", i), before[i]);
      TAUTLINE_CHECK_EQUAL(component(output->GetCellData(), "imr", i), now[i]);
      TAUTLINE_CHECK_EQUAL(component(output->GetCellData(), "Validity", i), 1);
    }
    const auto boundary = boundaryOf(data);
    double moved = 0;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 step = after.point(i) - data.point(i);
      TAUTLINE_EACH(int, c, 3,
        TAUTLINE_CHECK_EQUAL(component(output->GetPointData(), "Displacement", i, c), step[c]));
      TAUTLINE_CHECK(!boundary[i] || norm(step) == 0);
      moved += norm(step) > 0.01;
    }
    TAUTLINE_CHECK(moved > 3);
    TAUTLINE_CHECK(output->GetPointData()->GetArray("mine") != nullptr);
    TAUTLINE_CHECK_EQUAL(std::string(output->GetCellData()->GetScalars()->GetName()), "imr");
    TAUTLINE_CHECK(grid->GetPointData()->GetArray("Displacement") == nullptr);

    vtkTable* statistics = filter->GetStatistics();
    TAUTLINE_CHECK_EQUAL(statistics->GetNumberOfRows(), 1);
    TAUTLINE_CHECK_EQUAL(statistics->GetValueByName(0, "Metric").ToString(), "imr");
    const auto n = double(data.numberOfCells());
    TAUTLINE_CHECK_RELATIVE(cell(statistics, 0, "MeanBefore"),
      std::accumulate(before.begin(), before.end(), 0.0) / n, 1e-13);
    TAUTLINE_CHECK_RELATIVE(
      cell(statistics, 0, "MeanAfter"), std::accumulate(now.begin(), now.end(), 0.0) / n, 1e-13);
    TAUTLINE_CHECK_EQUAL(
      cell(statistics, 0, "WorstBefore"), *std::max_element(before.begin(), before.end()));
    TAUTLINE_CHECK_EQUAL(
      cell(statistics, 0, "WorstAfter"), *std::max_element(now.begin(), now.end()));
    TAUTLINE_CHECK_EQUAL(cell(statistics, 0, "InvertedAfter"), 0);
    TAUTLINE_CHECK(cell(statistics, 0, "RMSAfter") < 0.97 * cell(statistics, 0, "RMSBefore"));
    TAUTLINE_CHECK_RELATIVE(cell(filter->GetHistory(), 0, "Objective"), sumOfSquares(data), 1e-12);
    TAUTLINE_CHECK_RELATIVE(
      cell(filter->GetHistory(), filter->GetHistory()->GetNumberOfRows() - 1, "Objective"),
      sumOfSquares(after), 1e-10);
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("inverse-mean-ratio-mean")));
  }
}

/// Fixed points: by array, by a selection of points or cells, ghost cells, lines.
TAUTLINE_PART(testFixed)
{
  const MeshData data = perturbed(CellType::Triangle, 8);
  const Index center = 4 * 9 + 4;
  auto run = [&](const std::function<void(vtkMeshOptimizer*, vtkUnstructuredGrid*)>& change)
  {
    auto grid = toGrid(data);
    vtkNew<vtkMeshOptimizer> filter;
    change(filter, grid);
    TAUTLINE_SET(filter, SetInputData(grid), Update());
    return pointsOf(filter);
  };
  const auto select = [](int type, vtkIdType id, vtkMeshOptimizer* filter)
  {
    TAUTLINE_NEW(vtkIdTypeArray, ids, InsertNextValue(id));
    TAUTLINE_NEW(vtkSelectionNode, node, SetContentType(vtkSelectionNode::INDICES),
      SetFieldType(type), SetSelectionList(ids));
    TAUTLINE_NEW(vtkSelection, selection, AddNode(node));
    filter->SetInputData(2, selection);
  };
  const auto plain = run([](auto*, auto*) {});
  TAUTLINE_CHECK(largestStep(data, plain, center) > 0.01);
  const auto byArray = run(
    [&](auto* filter, auto* grid)
    {
      std::vector<double> stay(data.numberOfPoints(), 0);
      stay[center] = 2;
      grid->GetPointData()->AddArray(arrayOf("stay", stay));
      filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "stay");
    });
  TAUTLINE_CHECK_EQUAL(largestStep(data, byArray, center), 0);
  TAUTLINE_CHECK(largestStep(data, byArray, center + 1) > 0);
  const auto byPoint =
    run([&](auto* filter, auto*) { select(vtkSelectionNode::POINT, center, filter); });
  TAUTLINE_CHECK(byPoint == byArray);
  const auto byCell =
    run([&](auto* filter, auto*) { select(vtkSelectionNode::CELL, 2 * (4 * 8 + 4), filter); });
  TAUTLINE_CHECK_EQUAL(largestStep(data, byCell, center), 0);
  TAUTLINE_CHECK_EQUAL(largestStep(data, byCell, center + 1), 0);
  TAUTLINE_CHECK_EQUAL(largestStep(data, byCell, center + 10), 0);
  TAUTLINE_CHECK(largestStep(data, byCell, center + 9) > 0);
  const auto byGhost = run(
    [&](auto*, auto* grid)
    {
      grid->AllocateCellGhostArray();
      grid->GetCellGhostArray()->SetValue(2 * (4 * 8 + 4), vtkDataSetAttributes::DUPLICATECELL);
    });
  TAUTLINE_CHECK(byGhost == byCell);
  const auto byLine = run(
    [&](auto*, auto* grid)
    {
      const vtkIdType ends[2] = { center, 0 };
      grid->InsertNextCell(VTK_LINE, 2, ends);
    });
  TAUTLINE_CHECK(byLine == byArray);
}

bool isOnBlock(const Vec3& p, double size)
{
  return std::any_of(p.begin(), p.end(), [size](double x) { return x == 0 || x == size; });
}

/// Sliding keeps planes, edges and corners of the block; free does not.
TAUTLINE_PART(testBoundary)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  // Shift the points of faces and edges within them, so that sliding has work to do.
  Random random(2);
  data.transform(
    [&](const Vec3& p)
    {
      Vec3 shifted = p;
      for (double& x : shifted)
      {
        x += x == 0 || x == 4 ? 0 : random.uniform(-0.25, 0.25) * (isOnBlock(p, 4) ? 1 : 0);
      }
      return shifted;
    });
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)), Update());
  const double fixed = sumOfSquares(withPointsOf(data, meshOf(filter)));
  TAUTLINE_SET(filter, SetBoundary(vtkMeshOptimizer::SLIDING), Update());
  const MeshData slid = withPointsOf(data, meshOf(filter));
  TAUTLINE_CHECK(sumOfSquares(slid) < 0.98 * fixed);
  Index inFace = 0, onEdge = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    int kept = 0;
    for (int c = 0; c < 3; ++c)
    {
      const double before = data.point(i)[c];
      if (before == 0 || before == 4)
      {
        TAUTLINE_CHECK_NEAR(slid.point(i)[c], before, 1e-13);
        ++kept;
      }
    }
    const double step = norm(slid.point(i) - data.point(i));
    TAUTLINE_CHECK(kept < 3 || step == 0);
    inFace += kept == 1 && step > 1e-3;
    onEdge += kept == 2 && step > 1e-3;
  }
  TAUTLINE_CHECK(inFace > 40);
  TAUTLINE_CHECK(onEdge > 24);
  TAUTLINE_SET(filter, SetBoundary(vtkMeshOptimizer::FREE), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), 125);
  TAUTLINE_CHECK(norm(withPointsOf(data, meshOf(filter)).point(0) - data.point(0)) > 1e-3);

  // A flat mesh: along its sides only.
  MeshData flat = TAUTLINE_CHANGED(perturbed(CellType::Triangle, 4), setPoint(2, { 2.4, 0, 0 }));
  TAUTLINE_NEW(vtkMeshOptimizer, sides, SetInputData(toGrid(flat)),
    SetBoundary(vtkMeshOptimizer::SLIDING), Update());
  const MeshData after = withPointsOf(flat, meshOf(sides));
  TAUTLINE_CHECK_NEAR(after.point(2)[1], 0, 1e-14);
  TAUTLINE_CHECK(std::abs(after.point(2)[0] - 2.4) > 1e-2);
  TAUTLINE_CHECK_EQUAL(norm(after.point(0) - flat.point(0)), 0);
}

/// Points that slide keep to their planes and edges also while a tangled mesh is untangled first.
TAUTLINE_PART(testSlidingTangled)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  const auto pushed = [](const Vec3& p) { return p[2] == 1 && !isOnBlock(p, 4); };
  data.transform([&](const Vec3& p) { return pushed(p) ? Vec3{ p[0], p[1], -0.5 } : p; });
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)),
    SetBoundary(vtkMeshOptimizer::SLIDING), Update());
  TAUTLINE_CHECK(filter->GetInvertedBefore() > 0);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  const MeshData before = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  const MeshData after = withPointsOf(data, meshOf(filter));
  for (Index i = 0; i < before.numberOfPoints(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      const double x = before.point(i)[c];
      TAUTLINE_CHECK((x != 0 && x != 4) || std::abs(after.point(i)[c] - x) < 1e-13);
    }
  }
}

/// On a ball, points of the sphere slide on it; with fixed points the mesh is worse.
TAUTLINE_PART(testOnSurface)
{
  MeshData ball = perturbed(CellType::Tetrahedron, 6);
  ball.transform(
    [](const Vec3& p)
    {
      const double x = p[0] / 3 - 1, y = p[1] / 3 - 1, z = p[2] / 3 - 1;
      const double xx = x * x, yy = y * y, zz = z * z;
      return Vec3{ x * std::sqrt(1 - yy / 2 - zz / 2 + yy * zz / 3),
        y * std::sqrt(1 - xx / 2 - zz / 2 + xx * zz / 3),
        z * std::sqrt(1 - xx / 2 - yy / 2 + xx * yy / 3) };
    });
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(ball)), Update());
  const double fixed = sumOfSquares(withPointsOf(ball, meshOf(filter)));
  TAUTLINE_SET(filter, SetBoundary(vtkMeshOptimizer::ON_SURFACE), SetFeatureAngle(90));
  filter->SetSurfaceTolerance(0); // the ball is so coarse that its points could hardly slide
  filter->Update();
  const MeshData slid = withPointsOf(ball, meshOf(filter));
  TAUTLINE_CHECK(sumOfSquares(slid) < 0.98 * fixed);
  const auto boundary = boundaryOf(ball);
  Index moved = 0;
  for (Index i = 0; i < ball.numberOfPoints(); ++i)
  {
    // The facets of the sphere are up to 0.05 inside it.
    TAUTLINE_CHECK(!boundary[i] || std::abs(norm(slid.point(i)) - 1) < 0.05);
    moved += boundary[i] && norm(slid.point(i) - ball.point(i)) > 1e-3;
  }
  TAUTLINE_CHECK(moved > 100);
  TAUTLINE_CHECK(filter->GetSurfaceError() > 0 && filter->GetSurfaceError() < 0.05);
  const auto validity = validityOf(slid);
  TAUTLINE_CHECK_EQUAL(std::count(validity.begin(), validity.end(), Valid), ball.numberOfCells());
}

TAUTLINE_PART(testLimits)
{
  const MeshData data = perturbed(CellType::Triangle, 8);
  vtkNew<vtkMeshOptimizer> filter;
  auto grid = toGrid(data);
  std::vector<double> limits(data.numberOfPoints(), 0.02);
  limits[40] = 0;
  limits[41] = -1;
  grid->GetPointData()->AddArray(arrayOf("limit", limits));
  TAUTLINE_SET(filter, SetInputData(grid), SetMaximumDisplacement(0.01), Update());
  const auto byNumber = pointsOf(filter);
  filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "limit");
  filter->Update();
  const auto byArray = pointsOf(filter);
  double longest = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    TAUTLINE_CHECK(largestStep(data, byNumber, i) <= 0.01 * (1 + 1e-12));
    TAUTLINE_CHECK(limits[i] < 0 || largestStep(data, byArray, i) <= limits[i] * (1 + 1e-12));
    longest = std::max(longest, largestStep(data, byArray, i));
  }
  TAUTLINE_CHECK(longest > 0.01);
}

/// With the target elements as reference, sizes or tensors, the mesh reaches them.
TAUTLINE_PART(testTargets)
{
  const MeshData data = perturbed(CellType::Triangle, 6);
  MeshData wanted = blockMesh(CellType::Triangle, 6, 6, 0);
  wanted.transform(TAUTLINE_PLACE(p[0] * p[0] / 6, p[1], 0));
  MeshData start = wanted;
  TAUTLINE_LET(PerturbOptions, perturbation, fraction = 0.6);
  start.points = perturb(Mesh(wanted.view()), nullptr, perturbation).points;

  vtkNew<vtkMeshOptimizer> filter;
  auto grid = toGrid(start);
  grid->GetCellData()->AddArray(arrayOf("size", valuesOf(wanted, Metric::Size)));
  TAUTLINE_SET(filter, SetInputData(0, grid), SetInputData(1, toGrid(wanted)),
    AddObjectiveByName(
      "mu_shape_size_orientation_nb", vtkMeshOptimizer::SUM, 1.0, vtkMeshOptimizer::REFERENCE),
    SetMaximumIterations(300), SetRelativeChange(1e-12), Update());
  const auto points = pointsOf(filter);
  TAUTLINE_EACH(
    std::size_t, i, points.size(), TAUTLINE_CHECK_NEAR(points[i], wanted.points[i], 1e-4));
  TAUTLINE_SET(filter, SetPreset(vtkMeshOptimizer::PRESERVE_SHAPE), Update());
  TAUTLINE_CHECK(cell(filter->GetStatistics(), 0, "MeanAfter") < 1.001);

  TAUTLINE_SET(filter, RemoveAllObjectives(),
    AddObjectiveByName("mu_size", vtkMeshOptimizer::DEFAULT_TEMPLATE, 1.0, vtkMeshOptimizer::SIZE),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "size"), Update());
  TAUTLINE_CHECK(cell(filter->GetStatistics(), 0, "MeanAfter") <
    0.1 * cell(filter->GetStatistics(), 0, "MeanBefore"));
}

TAUTLINE_PART(testThreads)
{
  const auto grid = toGrid(perturbed(CellType::Tetrahedron, 8));
  std::vector<double> first;
  for (int threads : { 1, 2, 4 })
  {
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(grid), SetThreads(threads), Update());
    first = first.empty() ? pointsOf(filter) : first;
    TAUTLINE_CHECK(pointsOf(filter) == first);
  }
}
}
