// SPDX-License-Identifier: BSD-3-Clause
// Random meshes of all cell types through the filter Optimize Mesh, with every preset and boundary,
// in single and double precision, listed in both orders, near and far from the origin: what is
// written is not worse than the input, and the reported numbers match the written mesh.
#include "NeverWorse.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkMeshOptimizer.h"

#include <cstdio>

using namespace tautline;

namespace
{
constexpr int presets = 7;
constexpr int boundaries[] = { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING,
  vtkMeshOptimizer::ON_SURFACE, vtkMeshOptimizer::FREE };
constexpr int motions = 4;
constexpr int meshes = 1008;      // all of the combinations twice
constexpr int stride = 13;        // in the fast run; it divides no number of choices
constexpr double rounding = 1e-8; // relative, of what is computed in another order
constexpr Index half = 3;         // the elements on both sides of it are two regions

/// The properties of a mesh, from its number.
struct Case
{
  int number;
  Preset preset;
  CellType type;
  int boundary;
  bool surface, single, mixed, regions;
  double amplitude, offset;

  explicit Case(int n)
    : number(n)
    , preset(static_cast<Preset>(1 + n / 6 % presets))
    , type(allTypes[n % 6])
    , boundary(boundaries[n / (6 * presets) % motions])
    , surface(false)
    , single(n % 3 > 0)
    , mixed(n % 5 == 0)
    , regions(n % 4 == 0)
    , amplitude(0.1 + 0.08 * (n % 11))
  {
    if (this->preset == Preset::LowInterpolationError)
    {
      // The interpolation metric is one of simplices.
      this->type = n % 2 == 0 ? CellType::Triangle : CellType::Tetrahedron;
    }
    this->surface = topology(this->type).dimension == 2 && n / (6 * presets * motions) % 3 == 2;
    constexpr double offsets[] = { 0.0, 10.0, 1e3, 1e4 };
    this->offset = offsets[n / 7 % 4];
  }

  std::string label() const
  {
    return "mesh " + std::to_string(this->number) + ", preset " +
      std::to_string(static_cast<int>(this->preset)) + ", boundary " +
      std::to_string(this->boundary) + (this->surface ? ", surface, " : ", ") +
      topology(this->type).plural + (this->single ? ", float, " : ", double, ") +
      std::to_string(this->offset) + " off" + (this->mixed ? ", mixed" : "");
  }
};

/// The same element listed in the opposite order.
std::vector<Index> opposite(CellType type, const Index* n)
{
  switch (type)
  {
    case CellType::Triangle:
      return { n[0], n[2], n[1] };
    case CellType::Quadrilateral:
      return { n[0], n[3], n[2], n[1] };
    case CellType::Tetrahedron:
      return { n[0], n[2], n[1], n[3] };
    case CellType::Pyramid:
      return { n[0], n[3], n[2], n[1], n[4] };
    case CellType::Wedge:
      return { n[3], n[4], n[5], n[0], n[1], n[2] };
    default:
      return { n[4], n[5], n[6], n[7], n[0], n[1], n[2], n[3] };
  }
}

/// A third of the cells in the opposite order.
MeshData listedInBothOrders(const MeshData& data)
{
  TAUTLINE_LET(MeshData, mixed, points = data.points);
  Random random(5);
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index* nodes = data.connectivity.data() + data.offsets[c];
    const auto type = static_cast<CellType>(data.types[c]);
    const bool turned = random.uniform(0, 1) < 1.0 / 3;
    mixed.addCell(type,
      turned ? opposite(type, nodes)
             : std::vector<Index>(nodes, nodes + data.offsets[c + 1] - data.offsets[c]));
  }
  return mixed;
}

/// The mesh as it is in its precision, in one order.
MeshData meshOf(const Case& test)
{
  MeshData data =
    randomMesh(test.type, test.surface, test.amplitude, 3000U + static_cast<unsigned>(test.number));
  data.transform([&](const Vec3& p) { return p + Vec3{ test.offset, test.offset, 0 }; });
  for (double& x : data.points)
  {
    x = test.single ? static_cast<double>(static_cast<float>(x)) : x;
  }
  return data;
}

vtkSmartPointer<vtkUnstructuredGrid> gridOf(const Case& test, const MeshData& data)
{
  auto grid =
    toGrid(test.mixed ? listedInBothOrders(data) : data, test.single ? VTK_FLOAT : VTK_DOUBLE);
  vtkNew<vtkIntArray> region, number;
  region->SetName("region");
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index first = data.connectivity[data.offsets[c]];
    region->InsertNextValue(data.point(first)[0] - test.offset < half ? 1 : 2);
  }
  number->SetName("number");
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    number->InsertNextValue(static_cast<int>(p * p % 97));
  }
  TAUTLINE_SET(grid, GetCellData()->AddArray(region), GetPointData()->AddArray(number));
  return grid;
}

//------------------------------------------------------------------------------
/// Cells and arrays of the input are in the output.
void checkKept(vtkUnstructuredGrid* input, vtkUnstructuredGrid* output)
{
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfPoints(), input->GetNumberOfPoints());
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfCells(), input->GetNumberOfCells());
  TAUTLINE_CHECK(toMesh(output).connectivity == toMesh(input).connectivity);
  for (const auto& [before, after, name] :
    { std::tuple<vtkDataSetAttributes*, vtkDataSetAttributes*, const char*>{
        input->GetCellData(), output->GetCellData(), "region" },
      { input->GetPointData(), output->GetPointData(), "number" } })
  {
    vtkDataArray *then = before->GetArray(name), *now = after->GetArray(name);
    TAUTLINE_CHECK(now && now->GetNumberOfTuples() == then->GetNumberOfTuples());
    for (vtkIdType i = 0; now && i < now->GetNumberOfTuples(); ++i)
    {
      TAUTLINE_CHECK_EQUAL(now->GetComponent(i, 0), then->GetComponent(i, 0));
    }
  }
}

/// The objective of the preset; with a free boundary, sizes are compared with their mean.
double objectiveAt(
  const Case& test, const MeshData& input, const Mesh& mesh, const Targets* targets)
{
  if (test.preset != Preset::UniformSize || test.boundary != vtkMeshOptimizer::FREE)
  {
    return objectiveOf(test.preset, mesh, targets);
  }
  const std::vector<double> sizes = valuesOf(input, Metric::Size);
  const double mean =
    std::accumulate(sizes.begin(), sizes.end(), 0.0) / static_cast<double>(sizes.size());
  const Targets ofMean = sizeTargets(mesh, std::vector<double>(sizes.size(), mean).data());
  TAUTLINE_LET(EvaluationOptions, evaluation, targets = &ofMean);
  std::vector<double> q(sizes.size());
  evaluateMetric(mesh, Metric::SizeBarrier, evaluation, q.data());
  return objectiveOf(Preset::BestShape, mesh, nullptr) + std::accumulate(q.begin(), q.end(), 0.0);
}

/// The reported numbers, for the points as they are written.
void checkReported(vtkMeshOptimizer* filter, vtkUnstructuredGrid* output, const MeshData& after,
  const Targets* targets)
{
  const Mesh now(after.view());
  TAUTLINE_LET(EvaluationOptions, evaluation, targets = targets);
  std::vector<double> q(after.numberOfCells());
  evaluateMetric(now, Metric::InverseMeanRatio, evaluation, q.data());
  const std::vector<signed char> validity = validityOf(after);
  for (Index c = 0; c < after.numberOfCells(); ++c)
  {
    TAUTLINE_CHECK_EQUAL(component(output->GetCellData(), "Validity", c), double(validity[c]));
    if (validity[c] == Valid)
    {
      TAUTLINE_CHECK_RELATIVE(component(output->GetCellData(), "imr", c), q[c], rounding);
    }
  }
  if (std::all_of(validity.begin(), validity.end(), [](signed char v) { return v == Valid; }))
  {
    TAUTLINE_CHECK_RELATIVE(filter->GetStatistics()->GetValueByName(0, "WorstAfter").ToDouble(),
      *std::max_element(q.begin(), q.end()), rounding);
  }
}

struct Totals
{
  int valid = 0, tangled = 0, rejected = 0, better = 0, doubled = 0, unchanged = 0, drifted = 0;
};

//------------------------------------------------------------------------------
/// Runs the filter on a grid with the cells and points of `data`, one order of its cells.
vtkSmartPointer<vtkUnstructuredGrid> runOne(
  const Case& test, vtkUnstructuredGrid* grid, const MeshData& data, Totals& totals)
{
  const Mesh mesh(data.view());
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(grid),
    SetPreset(static_cast<int>(test.preset)), SetBoundary(test.boundary),
    SetShowFeatures(test.number % 2 == 1));
  if (test.regions)
  {
    filter->SetInputArrayToProcess(6, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "region");
  }
  Targets targets;
  const Targets* of = nullptr;
  if (test.preset == Preset::PreserveShape)
  {
    const MeshData reference =
      randomMesh(test.type, test.surface, 0, static_cast<unsigned>(test.number));
    filter->SetInputData(1, toGrid(test.mixed ? listedInBothOrders(reference) : reference));
    targets = referenceTargets(mesh, Mesh(reference.view()));
    of = &targets;
  }
  const Messages messages(filter);
  filter->Update();
  if (!messages.empty() && std::string(filter->GetSummary()).empty())
  {
    // Presets that depend on size would shrink a mesh whose boundary moves freely.
    const bool sized =
      test.preset == Preset::UniformSize || test.preset == Preset::LowInterpolationError;
    TAUTLINE_CHECK(messages.has("shrink") && sized && test.boundary != vtkMeshOptimizer::FIXED);
    ++totals.rejected;
    return nullptr;
  }
  vtkSmartPointer<vtkUnstructuredGrid> output = outputOf<vtkUnstructuredGrid>(filter);
  checkKept(grid, output);
  const MeshData after = withPointsOf(data, output);
  const Mesh now(after.view());
  const Index before = invalid(data, data.points), left = invalid(data, after.points);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedBefore(), before);
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), left);
  TAUTLINE_CHECK(left <= before);
  TAUTLINE_CHECK_EQUAL(messages.has(wording("inverted-or-degenerate-before")), left > 0);
  checkReported(filter, output, after, of);
  const bool doubled = grid->GetPoints()->GetDataType() == VTK_FLOAT &&
    output->GetPoints()->GetDataType() == VTK_DOUBLE;
  totals.doubled += doubled;
  totals.unchanged += after.points == data.points;
  if (before > 0)
  {
    ++totals.tangled;
    return output;
  }
  ++totals.valid;
  OptimizeOptions options;
  applyPreset(test.preset, options);
  options.objectives[0].evaluation.targets = of;
  const double worst = worstOf(mesh, options, test.type);
  TAUTLINE_CHECK(worstOf(now, options, test.type) <= worst + rounding * std::abs(worst));
  const double first = objectiveAt(test, data, mesh, of), last = objectiveAt(test, data, now, of);
  if (test.preset == Preset::WorstElement && topology(test.type).samples > 1)
  {
    // The worst element comes first: the mean may grow by 5 %, and by the way of that to the ideal.
    constexpr double allowance = 0.05;
    const double ideal = test.type == CellType::Pyramid ? 1 : -1;
    const double way = 1 - std::abs(worstOf(now, options, test.type) - ideal) / (worst - ideal);
    const auto meanOf = [](const MeshData& of)
    {
      const std::vector<double> q = valuesOf(of, Metric::InverseMeanRatio);
      return std::accumulate(q.begin(), q.end(), 0.0) / static_cast<double>(q.size());
    };
    TAUTLINE_CHECK(
      last <= first * (1 + rounding) || meanOf(after) <= (1 + allowance + way) * meanOf(data));
  }
  else
  {
    TAUTLINE_CHECK(last <= first * (1 + rounding));
  }
  totals.better += last < 0.999 * first;
  return output;
}

/// By how much the center of a mesh has moved.
double drift(const MeshData& before, const MeshData& after)
{
  Vec3 sum = { 0, 0, 0 };
  for (Index p = 0; p < before.numberOfPoints(); ++p)
  {
    sum = sum + (after.point(p) - before.point(p));
  }
  return norm(sum) / static_cast<double>(before.numberOfPoints());
}

/// The output of a first run is also an input: nearly as good as it gets, so that rounding matters.
void testOne(int number, Totals& once, Totals& again)
{
  const Case test(number);
  const Context context(test.label());
  const MeshData data = meshOf(test);
  vtkSmartPointer<vtkUnstructuredGrid> output = runOne(test, gridOf(test, data), data, once);
  if (output)
  {
    constexpr double far = 3; // elements, of some in a row; untangled meshes go farther than others
    TAUTLINE_CHECK(drift(data, withPointsOf(data, output)) < far);
  }
  if (output && invalid(data, withPointsOf(data, output).points) == 0)
  {
    const Context repeated("repeated");
    TAUTLINE_NEW(vtkUnstructuredGrid, grid, ShallowCopy(output));
    runOne(test, grid, withPointsOf(data, grid), again);
  }
}

void print(const char* run, const Totals& totals)
{
  std::printf("%s: %d valid meshes, %d of them better; %d tangled; %d rejected; %d written in "
              "double precision instead of single; %d unchanged\n",
    run, totals.valid, totals.better, totals.tangled, totals.rejected, totals.doubled,
    totals.unchanged);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestFilterNeverWorse)
{
  Totals once, again;
  const int step = slowParts() ? 1 : stride, count = meshes / step;
  for (int i = 0; i < meshes; i += step)
  {
    testOne(i, once, again);
  }
  print("input", once);
  print("repeated", again);
  TAUTLINE_CHECK(once.valid > count / 4);
  TAUTLINE_CHECK(once.tangled > count / 4);
  TAUTLINE_CHECK(once.better > 3 * once.valid / 4);
  TAUTLINE_CHECK(once.rejected < count / 5);
  TAUTLINE_CHECK(again.valid > count / 2);
}
