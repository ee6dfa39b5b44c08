// SPDX-License-Identifier: BSD-3-Clause
// Optimize Mesh on inputs of all kinds: rejected by name, or taken as they are; blocks, precision,
// iterations as time steps, abort.
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Optimization/Optimize.h"
#include "tautline/Perturbation/Perturb.h"
#include "vtkMeshOptimizer.h"
#include "vtkSphereSource.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTriangleFilter.h"

#include <array>

using namespace tautline;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{
MeshData perturbed(CellType type, Index n, double fraction = 0.8)
{
  MeshData data = blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
  TAUTLINE_LET(PerturbOptions, options, percentage = 100, fraction = fraction, seed = 5);
  data.points = perturb(Mesh(data.view()), nullptr, options).points;
  return data;
}

double sumOfSquares(const MeshData& data)
{
  const std::vector<double> q = valuesOf(data, Metric::InverseMeanRatio);
  return std::inner_product(q.begin(), q.end(), q.begin(), 0.0);
}

double objective(vtkMeshOptimizer* filter, vtkIdType row)
{
  return filter->GetHistory()->GetValueByName(row, "Objective").ToDouble();
}

/// Each is rejected with a message that names what is wrong and what to do; the output is empty.
TAUTLINE_PART(testRejected)
{
  const MeshData data = perturbed(CellType::Tetrahedron, 3);
  const auto reject = [](
                        const std::string& text, vtkDataObject* input,
                        const std::function<void(vtkMeshOptimizer*)>& change = [](auto*) {})
  {
    const Context context(text);
    vtkNew<vtkMeshOptimizer> filter;
    Messages messages(filter);
    filter->SetInputDataObject(0, input);
    change(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(text));
    auto* output = outputOf(filter);
    TAUTLINE_CHECK(!output || output->GetNumberOfCells() == 0);
    TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), -1);
  };
  TAUTLINE_NEW(vtkImageData, image, SetDimensions(3, 3, 3));
  reject(wording("image-data-to-point-set"), image);

  // Curved cells have no limits.
  reject(wording("set-maximum-displacement-to-0"), toGrid(quadraticOf(data)),
    [](vtkMeshOptimizer* filter) { filter->SetMaximumDisplacement(1); });

  TAUTLINE_LET(MeshData, lines, points = data.points);
  lines.addCell(VTK_LINE, { 0, 1 });
  reject(wording("no-element-whose-points-could-move"), toGrid(lines));

  const auto custom = [](const char* metric, int form = -1, double weight = 1, int target = 0)
  {
    return [=](vtkMeshOptimizer* filter)
    { filter->AddObjectiveByName(metric, form, weight, target); };
  };
  reject(wording("no-template"), toGrid(data),
    [&](auto* filter)
    {
      custom("imr", 17)(filter);
      filter->SetInputData(nullptr);
      filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "none");
    });
  reject(wording("set-the-input-reference"), toGrid(data), custom("mu_2", -1, 1, 1));
  reject(wording("needs-a-size"), toGrid(data), custom("mu_size", -1, 1, 2));
  reject(wording("needs-a-metric-tensor"), toGrid(data), custom("mu_size", -1, 1, 3));
  reject("weight", toGrid(data), custom("imr", -1, -2));
  reject(wording("no-point-array-absent"), toGrid(data),
    [](auto* filter) {
      filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "absent");
    });
  reject(wording("no-cell-array-absent"), toGrid(data),
    [](auto* filter)
    { filter->SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "absent"); });
  reject(wording("set-the-input-reference"), toGrid(data),
    [](auto* filter) { filter->SetPreset(vtkMeshOptimizer::PRESERVE_SHAPE); });

  vtkNew<vtkMeshOptimizer> filter;
  Messages messages(filter);
  filter->AddObjectiveByName("nonsense");
  TAUTLINE_CHECK(messages.has(wording("no-metric-nonsense")));
  messages.clear();
  filter->AddObjective(4711);
  TAUTLINE_CHECK(!messages.empty());
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfObjectives(), 0);
}

/// Empty, without a free point, with one, reversed, disconnected, far from the origin, not finite.
/// Only the name of an array counts if only points or only cells can have it: ParaView's Python
/// leaves the association of a property that is set to a name.
TAUTLINE_PART(testAssociations)
{
  const MeshData data = perturbed(CellType::Tetrahedron, 3);
  const auto grid = toGrid(data);
  vtkNew<vtkDoubleArray> mark, region;
  mark->SetName("mark");
  region->SetName("region");
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    mark->InsertNextValue(p % 2);
  }
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    region->InsertNextValue(grid->GetCell(c)->GetBounds()[1] > 1.5 ? 1 : 0);
  }
  TAUTLINE_SET(grid, GetPointData()->AddArray(mark), GetCellData()->AddArray(region));
  constexpr int points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  constexpr int cells = vtkDataObject::FIELD_ASSOCIATION_CELLS;
  const auto run = [&](int index, int association, const char* name)
  {
    vtkNew<vtkMeshOptimizer> filter;
    Messages messages(filter);
    filter->SetInputData(grid);
    filter->SetBoundary(vtkMeshOptimizer::ON_SURFACE); // reads the kinds of features
    TAUTLINE_SET(filter, SetInputArrayToProcess(index, 0, 0, association, name), Update());
    const bool taken = meshOf(filter) && meshOf(filter)->GetNumberOfPoints() > 0;
    TAUTLINE_CHECK(taken != messages.has(wording("is-needed-run")));
    return taken ? withPointsOf(data, meshOf(filter)).points : std::vector<double>();
  };
  constexpr int fixed = 2, limits = 3, weights = 4, kinds = 5, regions = 6;
  for (const int index : { weights, regions })
  {
    TAUTLINE_CHECK(run(index, points, "mark").empty());
    TAUTLINE_CHECK(run(index, cells, "mark").empty());
    TAUTLINE_CHECK(!run(index, cells, "region").empty());
    TAUTLINE_CHECK(run(index, points, "region") == run(index, cells, "region"));
  }
  for (const int index : { fixed, limits, kinds })
  {
    TAUTLINE_CHECK(run(index, cells, "region").empty());
    TAUTLINE_CHECK(run(index, points, "region").empty());
    TAUTLINE_CHECK(run(index, cells, "mark") == run(index, points, "mark"));
  }
}

TAUTLINE_PART(testTaken)
{
  vtkNew<vtkMeshOptimizer> filter;
  Messages messages(filter);
  vtkNew<vtkUnstructuredGrid> empty;
  TAUTLINE_SET(filter, SetInputData(empty), Update());
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-cells")));
  messages.clear();
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfCells(), 0);
  TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), 0);

  const MeshData none = blockMesh(CellType::Triangle, 1, 1, 0);
  TAUTLINE_SET(filter, SetInputData(toGrid(none)), Update());
  TAUTLINE_CHECK(withPointsOf(none, meshOf(filter)).points == none.points);
  TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), int(StopReason::NoFreeVertices));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("0-of-4-points-were-free")));

  MeshData one = blockMesh(CellType::Quadrilateral, 2, 2, 0);
  one.setPoint(4, { 1.6, 0.7, 0 });
  TAUTLINE_SET(filter, SetInputData(toGrid(one)), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), 1);
  TAUTLINE_CHECK_NEAR(norm(withPointsOf(one, meshOf(filter)).point(4) - Vec3{ 1, 1, 0 }), 0, 1e-2);

  // Listed the other way round, the points go where they went, and it is reported.
  const MeshData data = perturbed(CellType::Triangle, 6);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), Update());
  const MeshData straight = withPointsOf(data, meshOf(filter));
  MeshData reversed = TAUTLINE_CHANGED(data, swapNodes(1, 2));
  TAUTLINE_SET(filter, SetInputData(toGrid(reversed)), Update());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("the-mesh-is-reversed")));
  const MeshData mirrored = withPointsOf(data, meshOf(filter));
  TAUTLINE_EACH(std::size_t, i, data.points.size(),
    TAUTLINE_CHECK_NEAR(mirrored.points[i], straight.points[i], 1e-3));
  TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetCellData(), "Validity", 0), 1);

  // Every third cell the other way round; the output keeps the cells as they are, with data.
  MeshData mixed = TAUTLINE_CHANGED(data, swapNodes(1, 2, 0, 3));
  TAUTLINE_SET(filter, SetInputData(toGrid(mixed)), Update());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("24-of-the-72-cells-are-treated")));
  const MeshData alike = withPointsOf(data, meshOf(filter));
  TAUTLINE_EACH(std::size_t, i, data.points.size(),
    TAUTLINE_CHECK_NEAR(alike.points[i], straight.points[i], 1e-3));
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetCell(i)->GetPointId(1), mixed.connectivity[3 * i + 1]);
    TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetCellData(), "Validity", i), 1);
  }
  // Against a reference in the order of the mesh itself: the same points as without flipped cells.
  for (const MeshData* of : { &data, static_cast<const MeshData*>(&mixed) })
  {
    vtkNew<vtkMeshOptimizer> shaped;
    MeshData reference = *of;
    reference.points = blockMesh(CellType::Triangle, 6, 6, 0).points;
    TAUTLINE_SET(shaped, SetInputData(0, toGrid(*of)), SetInputData(1, toGrid(reference)),
      SetPreset(vtkMeshOptimizer::PRESERVE_SHAPE));
    Messages told(shaped);
    shaped->Update();
    const MeshData restored = withPointsOf(reference, meshOf(shaped));
    TAUTLINE_EACH(std::size_t, i, data.points.size(),
      TAUTLINE_CHECK_NEAR(restored.points[i], reference.points[i], 1e-2));
  }

  MeshData far = data;
  far.transform([](const Vec3& p) { return p + Vec3{ 1e6, -1e6, 0 }; });
  TAUTLINE_SET(filter, SetInputData(toGrid(far)), Update());
  MeshData back = withPointsOf(far, meshOf(filter));
  back.transform([](const Vec3& p) { return p - Vec3{ 1e6, -1e6, 0 }; });
  TAUTLINE_CHECK_RELATIVE(sumOfSquares(back), sumOfSquares(straight), 1e-4);

  MeshData twice = data;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    twice.addPoint(data.point(i) + Vec3{ 20, 0, 0 });
  }
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    const Index* node = data.connectivity.data() + 3 * i;
    const Index shift = data.numberOfPoints();
    twice.addCell(CellType::Triangle, { node[0] + shift, node[1] + shift, node[2] + shift });
  }
  TAUTLINE_SET(filter, SetInputData(toGrid(twice)), Update());
  TAUTLINE_CHECK_RELATIVE(
    sumOfSquares(withPointsOf(twice, meshOf(filter))), 2 * sumOfSquares(straight), 1e-4);
  TAUTLINE_CHECK(messages.empty());

  // A NaN: either rejected by name, or the rest is finite and no worse.
  MeshData broken = data;
  broken.points[3 * 24] = std::numeric_limits<double>::quiet_NaN();
  TAUTLINE_SET(filter, SetInputData(toGrid(broken)), Update());
  TAUTLINE_EACH(vtkIdType, i, meshOf(filter)->GetNumberOfPoints(),
    TAUTLINE_CHECK(i == 24 || std::isfinite(meshOf(filter)->GetPoint(i)[0])));
  TAUTLINE_CHECK(!messages.empty() || contains(filter->GetSummary(), "NaN"));
}

/// Points stay in single precision where that keeps the elements valid.
TAUTLINE_PART(testPrecision)
{
  const MeshData data = perturbed(CellType::Tetrahedron, 4, 0.5);
  for (int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data, type)), Update());
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetPoints()->GetDataType(), type);
    const MeshData after = withPointsOf(data, meshOf(filter));
    TAUTLINE_CHECK(sumOfSquares(after) < sumOfSquares(data));
    const auto validity = validityOf(after);
    TAUTLINE_CHECK(std::count(validity.begin(), validity.end(), Valid) == data.numberOfCells());
  }
  // Beyond 2^25 single precision has every fourth number. The point that halves a rectangle of 4 by
  // 8 must lie between two of them.
  const double far = 1 << 25;
  MeshData narrow;
  for (const Vec3& p :
    { Vec3{ 0, 0, 0 }, Vec3{ 4, 0, 0 }, Vec3{ 4, 8, 0 }, Vec3{ 0, 8, 0 }, Vec3{ 0, 4, 0 } })
  {
    narrow.addPoint(p + Vec3{ far, far, 0 });
  }
  for (Index k = 0; k < 4; ++k)
  {
    narrow.addCell(CellType::Triangle, { k, (k + 1) % 4, 4 });
  }
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(narrow, VTK_FLOAT)), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedBefore(), 1);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetPoints()->GetDataType(), VTK_DOUBLE);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("given-in-double-precision")));
}

TAUTLINE_PART(testBlocks)
{
  const MeshData flat = perturbed(CellType::Triangle, 5),
                 solid = perturbed(CellType::Hexahedron, 3);
  vtkNew<vtkMultiBlockDataSet> blocks, references;
  TAUTLINE_SET(
    blocks, SetBlock(0, toGrid(flat)), SetBlock(2, toPolyData(flat)), SetBlock(3, toGrid(solid)));
  vtkNew<vtkMeshOptimizer> filter, single;
  TAUTLINE_SET(filter, SetInputData(blocks), Update());
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfBlocks(), 4u);
  double rows = 0, free = 0;
  const std::array inputs = { std::make_pair(0u, &flat), std::make_pair(2u, &flat),
    std::make_pair(3u, &solid) };
  for (const auto& [number, data] : inputs)
  {
    TAUTLINE_SET(single, SetInputData(toGrid(*data)), Update());
    auto* block = vtkPointSet::SafeDownCast(output->GetBlock(number));
    TAUTLINE_CHECK(block->IsA(number == 2 ? "vtkPolyData" : "vtkUnstructuredGrid"));
    TAUTLINE_CHECK(withPointsOf(*data, block).points == withPointsOf(*data, meshOf(single)).points);
    rows += double(single->GetHistory()->GetNumberOfRows());
    free += double(single->GetFreePoints());
  }
  TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), rows);
  TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), free);
  TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetValueByName(0, "Block").ToString(), "block 1");
  TAUTLINE_CHECK_EQUAL(filter->GetStatistics()->GetNumberOfRows(), 3);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("in-block-4")));

  Messages messages(filter);
  TAUTLINE_SET(
    filter, SetInputData(1, toGrid(flat)), SetPreset(vtkMeshOptimizer::PRESERVE_SHAPE), Update());
  TAUTLINE_CHECK(messages.has(wording("the-reference-has-none")));
  messages.clear();
  TAUTLINE_SET(
    references, SetBlock(0, toGrid(flat)), SetBlock(2, toGrid(flat)), SetBlock(3, toGrid(flat)));
  TAUTLINE_SET(filter, SetInputData(1, references), Update());
  TAUTLINE_CHECK(messages.has(wording("in-block-4")));
}

/// A time is an iteration: the mesh the kernel's observer saw.
TAUTLINE_PART(testAnimation)
{
  const MeshData data = perturbed(CellType::Tetrahedron, 4);
  const auto on = Mesh(data.view()).boundary().isBoundaryPoint;
  const std::vector<unsigned char> boundary(on.begin(), on.end());
  std::vector<std::vector<double>> seen;
  TAUTLINE_LET(OptimizeOptions, options, fixed = boundary.data());
  options.observer = [&](const IterationState& state)
  {
    seen.emplace_back(data.points.size());
    state.points(seen.back().data());
    return true;
  };
  const OptimizeResult expected = optimize(Mesh(data.view()), options);
  TAUTLINE_CHECK(seen.size() > 5);

  vtkNew<vtkMeshOptimizer> filter;
  int runs = 0;
  const auto input = toGrid(data);
  TAUTLINE_SET(filter, SetInputData(input), SetAnimation(true), UpdateInformation());
  vtkInformation* info = filter->GetOutputInformation(0);
  TAUTLINE_CHECK_EQUAL(info->Length(Pipeline::TIME_STEPS()), 301); // as many as there can be
  filter->Update();
  TAUTLINE_CHECK_EQUAL(info->Length(Pipeline::TIME_STEPS()), int(seen.size()));
  TAUTLINE_CHECK(withPointsOf(data, meshOf(filter)).points == expected.points);
  observe(filter, vtkCommand::ProgressEvent, [&runs](vtkAlgorithm*) { ++runs; });
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    const Context context("iteration " + std::to_string(i));
    input->Modified(); // ParaView copies the input at each time step
    filter->UpdateTimeStep(double(i));
    TAUTLINE_CHECK(withPointsOf(data, meshOf(filter)).points ==
      (i + 1 < seen.size() ? seen[i] : expected.points));
    TAUTLINE_CHECK_EQUAL(
      meshOf(filter)->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), double(i));
  }
  filter->UpdateTimeStep(2.5);
  TAUTLINE_CHECK(withPointsOf(data, meshOf(filter)).points == seen[2]);
  filter->UpdateTimeStep(1000);
  TAUTLINE_CHECK(withPointsOf(data, meshOf(filter)).points == expected.points);
  TAUTLINE_CHECK(runs < int(seen.size()) * 6); // no iteration was computed again

  // A client that shows time 0 first: the summary belongs to the result.
  TAUTLINE_NEW(vtkMeshOptimizer, first, SetInputData(toGrid(data)), SetAnimation(true),
    UpdateInformation(), UpdateTimeStep(0));
  TAUTLINE_CHECK(withPointsOf(data, meshOf(first)).points == seen[0]);
  const auto qualities = [](vtkMeshOptimizer* optimizer)
  {
    const std::string summary = optimizer->GetSummary();
    return summary.substr(summary.find(": mean "));
  };
  TAUTLINE_CHECK_EQUAL(qualities(first), qualities(filter));

  // Another option starts over.
  TAUTLINE_SET(filter, SetPreset(vtkMeshOptimizer::CUSTOM), SetMaximumIterations(2), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetOutputInformation(0)->Length(Pipeline::TIME_STEPS()), 3);

  // A megabyte holds about 31 meshes of 1331 points: then every second iteration.
  TAUTLINE_NEW(vtkMeshOptimizer, bounded,
    SetInputData(toGrid(perturbed(CellType::Tetrahedron, 10))), SetAnimation(true),
    SetAnimationMemory(1), AddObjectiveByName("imr"),
    SetOptimizer(vtkMeshOptimizer::CONJUGATE_GRADIENT_FLETCHER_REEVES), SetRelativeChange(0),
    SetGradientNorm(0), Update());
  TAUTLINE_CHECK(bounded->GetIterations() > 34);
  const auto at = [&](double time)
  {
    bounded->UpdateTimeStep(time);
    return withPointsOf(blockMesh(CellType::Tetrahedron, 10, 10, 10), meshOf(bounded)).points;
  };
  TAUTLINE_CHECK(at(33) == at(32));
  TAUTLINE_CHECK(at(34) != at(32));
}

/// Stops on request, keeps the result so far; a time limit of almost 0 too.
TAUTLINE_PART(testStops)
{
  const MeshData data = perturbed(CellType::Tetrahedron, 6);
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)));
  const auto tag = stopAt(filter, vtkCommand::ProgressEvent, 0.005);
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), int(StopReason::Aborted));
  TAUTLINE_CHECK(filter->GetIterations() > 0 && filter->GetIterations() < 5);
  const double aborted = sumOfSquares(withPointsOf(data, meshOf(filter)));
  TAUTLINE_CHECK(aborted < sumOfSquares(data));
  TAUTLINE_SET(filter, RemoveObserver(tag), SetAbortExecute(0), SetTimeLimit(1e-9), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), int(StopReason::TimeLimit));
  TAUTLINE_CHECK(filter->GetIterations() <= 2);
  constexpr double rounding = 1e-12; // of points that come back from the units of the sweeps
  TAUTLINE_CHECK(
    sumOfSquares(withPointsOf(data, meshOf(filter))) <= (1 + rounding) * sumOfSquares(data));
  TAUTLINE_SET(filter, SetTimeLimit(0), Update());
  TAUTLINE_CHECK(sumOfSquares(withPointsOf(data, meshOf(filter))) < aborted);
  TAUTLINE_CHECK_RELATIVE(objective(filter, 0), sumOfSquares(data), 1e-12);
}

/// Elements that are left invalid are a warning; valid and inverted elements are not compared.
TAUTLINE_PART(testLeftInvalid)
{
  MeshData data = perturbed(CellType::Triangle, 6);
  // Two corners; all points of the element at one of them are on the boundary.
  data.setPoint(0, { 1.5, 1.5, 0 });
  data.setPoint(6, { 4.5, 1.5, 0 });
  const auto validity = validityOf(data);
  const Index inverted = std::count(validity.begin(), validity.end(), Inverted);
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)));
  Messages messages(filter);
  filter->Update();
  const std::string left = std::to_string(filter->GetInvertedAfter());
  TAUTLINE_CHECK(inverted > 0 && filter->GetInvertedAfter() > 0);
  TAUTLINE_CHECK(messages.has(wording("inverted-or-degenerate-before") + std::to_string(inverted)));
  TAUTLINE_CHECK_EQUAL(
    std::string(filter->GetSummary()).rfind("Warning: " + left + " element", 0), 0);
  // Mean and worst value of the valid elements, which are computed here.
  const MeshData after = withPointsOf(data, meshOf(filter));
  const auto of = [&](const MeshData& mesh)
  {
    std::vector<double> values(mesh.numberOfCells());
    evaluateMetric(Mesh(mesh.view()), Metric::InverseMeanRatio, {}, values.data());
    const auto valid = validityOf(mesh);
    double sum = 0, worst = 0, number = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const bool counts = valid[i] == Valid;
      sum += counts ? values[i] : 0;
      number += counts;
      worst = counts ? std::max(worst, values[i]) : worst;
    }
    return std::array<double, 2>{ sum / number, worst };
  };
  const auto first = of(data), last = of(after);
  std::ostringstream text;
  text << " of the valid elements: mean " << first[0] << " to " << last[0] << ", worst " << first[1]
       << " to " << last[1] << ".";
  TAUTLINE_CHECK(contains(filter->GetSummary(), text.str()));

  messages.clear();
  TAUTLINE_SET(filter, FreeInvalidOn(), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(!contains(filter->GetSummary(), "Warning"));
}

/// The points of a sphere stay on it, and the error is reported.
TAUTLINE_PART(testSurface)
{
  TAUTLINE_NEW(vtkSphereSource, sphere, SetThetaResolution(24), SetPhiResolution(24), SetRadius(1),
    SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION));
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputConnection(sphere->GetOutputPort()), Update());
  TAUTLINE_CHECK(meshOf(filter)->IsA("vtkPolyData"));
  TAUTLINE_CHECK(filter->GetSurfaceError() <= 0.001 * meshOf(filter)->GetLength());
  TAUTLINE_CHECK(!contains(filter->GetSummary(), "Warning: The surface has moved by up to "));
  TAUTLINE_SET(filter, SetSurfaceTolerance(0), Update());
  const double longest = 2 * vtkMath::Pi() / 24;
  double off = 0;
  for (vtkIdType i = 0; i < meshOf(filter)->GetNumberOfPoints(); ++i)
  {
    const double* p = meshOf(filter)->GetPoint(i);
    off = std::max(off, std::abs(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 1));
  }
  TAUTLINE_CHECK(off < 0.25 * longest * longest);
  TAUTLINE_CHECK(filter->GetSurfaceError() > 0);
  TAUTLINE_CHECK(filter->GetSurfaceError() < 0.25 * longest * longest);
  const double share = filter->GetSurfaceError() / meshOf(filter)->GetLength();
  TAUTLINE_CHECK(share > 0.001);
  TAUTLINE_CHECK(contains(filter->GetSummary(), " % of the diagonal of the bounding box."));
  TAUTLINE_CHECK(filter->GetStatistics()->GetValueByName(0, "MeanAfter").ToDouble() <
    filter->GetStatistics()->GetValueByName(0, "MeanBefore").ToDouble());
}
}
