// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkOptimization PART ...: times the optimizer, in passes of the yardstick (see Yardstick.h)
// of the CPU time of one thread, from the filter's input to its output. Prints lines
// "key<tab>number". Run by optimization.py. PARTs:
//   yardstick REPEATS          nanoseconds per element of the unit
//   make RECIPE CELLS FILE     a mesh: disk2d or disk3d, then -plain, -perturbed (50 %),
//                              -tangled (1 % of the cells) or -scattered (30 % of the inner
//                              points anywhere in the bounding box)
//   best FILE                  sum of squared IMR after hundreds of sweeps, close to the minimum
//   objective FILE REPEATS     value and gradient of the sum of squared IMR
//   shape FILE REPEATS BEST    95 % of the reduction to BEST, 1.0001 BEST, the presets
//   threads FILE REPEATS       one thread against two, wall time, total and of the main thread
//   busy PROCESSES REPEATS     one thread against all, in seconds, while this many processes
//   compute untangle FILE REPEATS      vtkMeshUntangler, then the best shape
//   converge FILE REPEATS      the preset that untangles and then improves
//   worst FILE                 the preset for the worst element against the best shape
//   sweeps FILE REPEATS        ten local sweeps of IMR and size by the exponential sum
//   memory CUBES               the best shape of 6 CUBES^3 tetrahedra; peak memory in bytes

#include "../../Filters/Core/MeshAdapter.h"
#include "../Cxx/VtkMeshes.h"
#include "Clocks.h"
#include "KuhnMesh.h"
#include "Yardstick.h"

#include "tautline/Objectives/ObjectiveSum.h"
#include "tautline/Perturbation/Perturb.h"
#include "vtkDomainSource.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"

#include "vtkTable.h"
#include "vtkUnstructuredGridReader.h"
#include "vtkUnstructuredGridWriter.h"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>

#include <csignal>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace tautline;

namespace
{
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

void print(const std::string& key, double value)
{
  std::cout << key << '\t' << std::setprecision(12) << value << std::endl;
}

/// Alternates the yardstick and some work, so that both run under the same load.
class Race
{
public:
  explicit Race(int repeats)
    : Repeats(repeats)
  {
  }

  /// The best time of the work by a clock, in passes over this many elements.
  double passes(
    vtkIdType elements, const std::function<void()>& work, double (*clock)() = processTime)
  {
    double best = std::numeric_limits<double>::infinity();
    constexpr int unitsPerTurn = 1;
    for (int i = 0; i < this->Repeats; ++i)
    {
      this->Unit = std::min(this->Unit, this->Stick.measure(unitsPerTurn));
      const double start = clock();
      work();
      best = std::min(best, clock() - start);
    }
    return best / (this->Unit * static_cast<double>(elements));
  }

  void printUnit() const { print("yardstick", 1e9 * this->Unit); }

private:
  int Repeats;
  Yardstick Stick;
  double Unit = std::numeric_limits<double>::infinity();
};

Grid readMesh(const std::string& file)
{
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  Grid grid = reader->GetOutput();
  if (grid->GetNumberOfCells() == 0)
  {
    throw Error("There is no mesh in " + file + ".");
  }
  return grid;
}

Grid outputOf(vtkAlgorithm* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

void run(vtkAlgorithm* filter)
{
  filter->Modified();
  filter->Update();
}

/// The sum of squared inverse mean ratios, their mean and the worst, of an output of the optimizer.
struct Shape
{
  double sum = 0, mean = 0, worst = 0;
  double worstMovable = 0; ///< of the elements with a point inside the mesh
  vtkIdType inverted = 0;
};

Shape shapeOf(vtkMeshOptimizer* filter, const char* array = "imr")
{
  const Grid grid = outputOf(filter);
  const MeshAdapter adapter(grid, 1);
  const MeshView& view = adapter.mesh().view();
  const std::vector<char> fixed = adapter.mesh().boundary().isBoundaryPoint;
  Shape shape;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const double q = component(grid->GetCellData(), array, cell);
    shape.sum += q * q;
    shape.mean += q / static_cast<double>(view.numberOfCells);
    shape.worst = std::max(shape.worst, q);
    const Index* nodes = view.connectivity + view.offsets[cell];
    if (!std::all_of(nodes, view.connectivity + view.offsets[cell + 1],
          [&fixed](Index node) { return fixed[node]; }))
    {
      shape.worstMovable = std::max(shape.worstMovable, q);
    }
  }
  shape.inverted = filter->GetInvertedAfter();
  return shape;
}

/// One thread, no limit of time.
vtkSmartPointer<vtkMeshOptimizer> optimizerOf(vtkDataSet* mesh, int preset)
{
  auto filter = vtkSmartPointer<vtkMeshOptimizer>::New();
  filter->SetInputData(mesh);
  filter->SetPreset(preset);
  filter->SetThreads(1);
  filter->SetTimeLimit(0);
  return filter;
}

/// The sum of squared IMR to a part of the reduction to a known optimum, only.
vtkSmartPointer<vtkMeshOptimizer> optimizerTo(vtkDataSet* mesh, double reduction, double best)
{
  constexpr int endless = 1000;
  auto filter = optimizerOf(mesh, vtkMeshOptimizer::CUSTOM);
  filter->SetMaximumIterations(endless);
  filter->SetReduction(reduction);
  filter->SetBestKnown(best);
  filter->UseBestKnownOn();
  filter->SetRelativeChange(0);
  filter->SetGradientNorm(0);
  return filter;
}

//------------------------------------------------------------------------------
/// 30 % of the points inside anywhere in the bounding box.
void scatter(vtkUnstructuredGrid* grid)
{
  constexpr double share = 0.3;
  const std::vector<char> fixed = MeshAdapter(grid, 1).mesh().boundary().isBoundaryPoint;
  double bounds[6];
  grid->GetBounds(bounds);
  std::mt19937 random(1);
  const auto uniform = [&random] { return random() / 4294967296.0; };
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    if (fixed[i] || uniform() >= share)
    {
      continue;
    }
    double p[3];
    for (int x = 0; x < 3; ++x)
    {
      p[x] = bounds[2 * x] + uniform() * (bounds[2 * x + 1] - bounds[2 * x]);
    }
    grid->GetPoints()->SetPoint(i, p);
  }
}

void makePart(const std::string& recipe, vtkIdType cells, const std::string& file)
{
  const std::size_t dash = recipe.find('-');
  const std::string state = recipe.substr(dash + 1);
  vtkNew<vtkDomainSource> domain;
  domain->SetDomainByName(recipe.substr(0, dash).c_str());
  domain->SetNumberOfCells(cells);
  vtkNew<vtkMeshPerturbation> perturbation;
  perturbation->SetInputConnection(domain->GetOutputPort());
  perturbation->SetPercentage(state == "perturbed" || state == "tangled" ? 50 : 0);
  constexpr double nearlyInverted = 0.95;
  perturbation->SetFraction(nearlyInverted);
  perturbation->SetTangledFraction(state == "tangled" ? 0.01 : 0);
  perturbation->Update();
  const Grid grid = vtkUnstructuredGrid::SafeDownCast(perturbation->GetOutputDataObject(0));
  if (state == "scattered")
  {
    scatter(grid);
  }
  // The arrays of source and filter are no part of the mesh.
  grid->GetPointData()->Initialize();
  grid->GetCellData()->Initialize();
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName(file.c_str());
  writer->SetFileTypeToBinary();
  writer->Write();
  print("elements", static_cast<double>(grid->GetNumberOfCells()));
}

//------------------------------------------------------------------------------
/// A close upper bound of the minimum sum: Newton's method for all points at once would take far
/// longer.
double bestSum(vtkDataSet* mesh)
{
  constexpr int many = 300;
  constexpr double settled = 1e-8;
  const auto filter = optimizerTo(mesh, 1, 0);
  filter->SetMaximumIterations(many);
  filter->SetRelativeChange(settled);
  filter->SetCulling(0);
  filter->Update();
  return shapeOf(filter).sum;
}

//------------------------------------------------------------------------------
void objectivePart(const std::string& file, int repeats)
{
  const Grid grid = readMesh(file);
  const MeshAdapter adapter(grid, 1);
  const ObjectiveSum sum(adapter.mesh(), Objective(), 1), both(adapter.mesh(), Objective(), 2);
  std::vector<double> gradient(3 * grid->GetNumberOfPoints());
  const vtkIdType n = grid->GetNumberOfCells();
  Race race(repeats);
  print("value", race.passes(n, [&] { sum.value(); }));
  print("gradient", race.passes(n, [&] { sum.addGradient(1.0, gradient.data()); }));
  const auto wall = [&](const ObjectiveSum& which)
  {
    return race.passes(
      n, [&] { which.addGradient(1.0, gradient.data()); }, wallTime);
  };
  const double one = wall(sum);
  print("gradient speed-up", one / wall(both));
  print("elements", static_cast<double>(n));
  race.printUnit();
}

//------------------------------------------------------------------------------
void shapePart(const std::string& file, int repeats, double best)
{
  const Grid grid = readMesh(file);
  const vtkIdType n = grid->GetNumberOfCells();
  print("elements", static_cast<double>(n));
  Race race(repeats);
  const auto nothing = optimizerTo(grid, 1, 0);
  nothing->SetMaximumIterations(0);
  print("overhead passes", race.passes(n, [&] { run(nothing); }));
  const Shape before = shapeOf(nothing);
  print("before sum", before.sum);
  print("before worst", before.worst);
  best = best > 0 ? best : bestSum(grid);
  print("best sum", best);

  const auto measure = [&](const std::string& name, vtkMeshOptimizer* filter)
  {
    print(name + " passes", race.passes(n, [&] { run(filter); }));
    const Shape after = shapeOf(filter);
    print(name + " reduction", (before.sum - after.sum) / (before.sum - best));
    print(name + " sum", after.sum);
    print(name + " / best", after.sum / best);
    print(name + " worst", after.worst);
    print(name + " mean", after.mean);
    print(name + " iterations", filter->GetIterations());
  };
  measure("95 %", optimizerTo(grid, 0.95, best));
  constexpr double close = 1.0001;
  measure("close", optimizerTo(grid, (before.sum - close * best) / (before.sum - best), best));
  measure("fast clean-up", optimizerOf(grid, vtkMeshOptimizer::FAST_CLEAN_UP));
  measure("best shape", optimizerOf(grid, vtkMeshOptimizer::BEST_SHAPE));
  race.printUnit();
}

//------------------------------------------------------------------------------
void threadsPart(const std::string& file, int repeats)
{
  const Grid grid = readMesh(file);
  const vtkIdType n = grid->GetNumberOfCells();
  for (const auto& [name, preset] : { std::pair("fast clean-up", vtkMeshOptimizer::FAST_CLEAN_UP),
         std::pair("best shape", vtkMeshOptimizer::BEST_SHAPE) })
  {
    // The computing time of the main thread is the time that would pass if no other program ran.
    const auto filter = optimizerOf(grid, preset);
    double wall[2], own[2];
    wall[0] = wall[1] = own[0] = own[1] = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < 2 * repeats; ++turn)
    {
      filter->SetThreads(1 + turn % 2);
      const double startWall = wallTime(), startOwn = threadTime();
      run(filter);
      wall[turn % 2] = std::min(wall[turn % 2], wallTime() - startWall);
      own[turn % 2] = std::min(own[turn % 2], threadTime() - startOwn);
    }
    print(std::string(name) + " speed-up", wall[0] / wall[1]);
    print(std::string(name) + " speed-up by CPU time", own[0] / own[1]);
  }
  print("elements", static_cast<double>(n));
}

//------------------------------------------------------------------------------
void untanglePart(const std::string& file, int repeats)
{
  const Grid grid = readMesh(file);
  const vtkIdType n = grid->GetNumberOfCells();
  print("elements", static_cast<double>(n));
  Race race(repeats);
  vtkNew<vtkMeshUntangler> untangler;
  untangler->SetInputData(grid);
  untangler->SetThreads(1);
  untangler->SetTimeLimit(0);
  print("untangle passes", race.passes(n, [&] { run(untangler); }));
  print("inverted before", static_cast<double>(untangler->GetInvertedBefore()));
  print("inverted left", static_cast<double>(untangler->GetInvertedAfter()));
  const Grid valid = outputOf(untangler);
  print("shape passes",
    race.passes(n,
      [&]
      {
        const auto shape = optimizerOf(valid, vtkMeshOptimizer::BEST_SHAPE);
        shape->Update();
      }));
  const auto shape = optimizerOf(valid, vtkMeshOptimizer::BEST_SHAPE);
  shape->Update();
  print("shape sum", shapeOf(shape).sum);
  print("shape worst", shapeOf(shape).worst);
  race.printUnit();
}

//------------------------------------------------------------------------------
void convergePart(const std::string& file, int repeats)
{
  const Grid grid = readMesh(file);
  const vtkIdType n = grid->GetNumberOfCells();
  print("elements", static_cast<double>(n));
  Race race(repeats);
  const auto filter = optimizerOf(grid, vtkMeshOptimizer::UNTANGLE_THEN_IMPROVE);
  print("converge passes", race.passes(n, [&] { run(filter); }));
  const Shape shape = shapeOf(filter);
  print("inverted before", static_cast<double>(filter->GetInvertedBefore()));
  print("inverted left", static_cast<double>(shape.inverted));
  print("converge sum", shape.sum);
  print("converge worst", shape.worst);
  print("converge iterations", filter->GetIterations());
  race.printUnit();
}

//------------------------------------------------------------------------------
void worstPart(const std::string& file)
{
  const Grid grid = readMesh(file);
  const vtkIdType n = grid->GetNumberOfCells();
  print("elements", static_cast<double>(n));
  Race race(1);
  for (const auto& [name, preset] : { std::pair("best shape", vtkMeshOptimizer::BEST_SHAPE),
         std::pair("worst element", vtkMeshOptimizer::WORST_ELEMENT) })
  {
    const auto filter = optimizerOf(grid, preset);
    print(std::string(name) + " passes", race.passes(n, [&] { run(filter); }));
    const Shape shape = shapeOf(filter);
    print(std::string(name) + " mean", shape.mean);
    print(std::string(name) + " worst", shape.worst);
    print(std::string(name) + " worst movable", shape.worstMovable);
  }
  // By other metrics, which have no closed form.
  for (const char* metric : { "min_angle", "scaled_jacobian" })
  {
    const auto filter = optimizerOf(grid, vtkMeshOptimizer::WORST_ELEMENT);
    filter->SetWorstMetricByName(metric);
    print(std::string(metric) + " passes", race.passes(n, [&] { run(filter); }));
  }
}

//------------------------------------------------------------------------------
void sweepsPart(const std::string& file, int repeats)
{
  const Grid grid = readMesh(file);
  const vtkIdType n = grid->GetNumberOfCells();
  print("elements", static_cast<double>(n));
  Race race(repeats);
  for (const auto& [name, method] :
    { std::pair("conjugate gradient", vtkMeshOptimizer::LOCAL_CONJUGATE_GRADIENT),
      std::pair("Newton", vtkMeshOptimizer::LOCAL_NEWTON) })
  {
    constexpr int sweeps = 10;
    const auto filter = optimizerOf(grid, vtkMeshOptimizer::CUSTOM);
    filter->AddObjectiveByName("imr");
    filter->AddObjectiveByName("size");
    filter->SetScalarization(vtkMeshOptimizer::EXPONENTIAL_SUM);
    filter->SetOptimizer(method);
    filter->SetMaximumIterations(sweeps);
    filter->SetRelativeChange(0);
    filter->SetGradientNorm(0);
    filter->SetCulling(0);
    print(std::string(name) + " passes", race.passes(n, [&] { run(filter); }));
    print(std::string(name) + " sweeps", filter->GetIterations());
    print(std::string(name) + " mean imr", shapeOf(filter).mean);
    vtkTable* statistics = filter->GetStatistics();
    for (const char* column : { "RMSBefore", "RMSAfter" })
    {
      print(
        std::string(name) + " size " + column, statistics->GetValueByName(1, column).ToDouble());
    }
  }
  race.printUnit();
}

//------------------------------------------------------------------------------
/// Arrays made in the size they need: a builder that grows would itself need more than the
/// optimizer.
Grid perturbed(MeshData data, int cellType)
{
  PerturbOptions options;
  options.threads = 1;
  data.points = perturb(Mesh(data.view()), nullptr, options).points;
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(toPoints(data));
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(data.numberOfCells(), static_cast<vtkIdType>(data.connectivity.size()));
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    cells->InsertNextCell(static_cast<int>(data.offsets[cell + 1] - data.offsets[cell]));
    for (Index k = data.offsets[cell]; k < data.offsets[cell + 1]; ++k)
    {
      cells->InsertCellPoint(data.connectivity[k]);
    }
  }
  grid->SetCells(cellType, cells);
  return grid;
}

Grid perturbedCubes(Index n)
{
  return perturbed(cutIntoTetrahedra(blockMesh(CellType::Hexahedron, n, n, n), n), VTK_TETRA);
}

//------------------------------------------------------------------------------
/// Processes that compute until this object is deleted.
class BusyProcesses
{
public:
  explicit BusyProcesses(int number)
  {
    for (int i = 0; i < number; ++i)
    {
      const pid_t child = fork();
      if (child == 0)
      {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        for (volatile unsigned count = 0;; count = count + 1)
        {
        }
      }
      this->Children.push_back(child);
    }
  }
  ~BusyProcesses()
  {
    for (const pid_t child : this->Children)
    {
      if (child > 0)
      {
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
      }
    }
  }
  BusyProcesses(const BusyProcesses&) = delete;
  BusyProcesses& operator=(const BusyProcesses&) = delete;

private:
  std::vector<pid_t> Children;
};

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void busyPart(int processes, int repeats)
{
  constexpr Index columns = 60, rows = 40, cubes = 10;
  MeshData surface = blockMesh(CellType::Triangle, columns, rows, 0);
  surface.transform(
    [](const Vec3& p) {
      return Vec3{ p[0], p[1], std::sin(0.2 * p[0]) * std::cos(0.2 * p[1]) };
    });
  const std::pair<const char*, Grid> meshes[] = { { "surface", perturbed(surface, VTK_TRIANGLE) },
    { "solid", perturbedCubes(cubes) } };
  const BusyProcesses busy(processes);
  for (const auto& [name, grid] : meshes)
  {
    const auto filter = optimizerOf(grid, vtkMeshOptimizer::BEST_SHAPE);
    std::vector<double> seconds[2];
    for (int turn = 0; turn < 2 * repeats; ++turn)
    {
      const bool all = turn % 2 == 1;
      filter->SetThreads(all ? 0 : 1);
      const double start = wallTime();
      run(filter);
      seconds[all].push_back(wallTime() - start);
    }
    print(std::string(name) + " elements", static_cast<double>(grid->GetNumberOfCells()));
    print(std::string(name) + " one thread", median(seconds[0]));
    print(std::string(name) + " all threads", median(seconds[1]));
  }
}

void memoryPart(Index n)
{
  const Grid grid = perturbedCubes(n);
  const vtkIdType count = grid->GetNumberOfCells();
  resetPeakMemory();
  print("memory input", statusBytes("VmRSS"));
  Race race(1);
  const auto filter = optimizerOf(grid, vtkMeshOptimizer::BEST_SHAPE);
  print("memory passes", race.passes(count, [&] { run(filter); }));
  print("memory peak", statusBytes("VmHWM"));
  print("memory iterations", filter->GetIterations());
  print("memory sum", shapeOf(filter).sum);
  print("elements", static_cast<double>(count));
  race.printUnit();
}

//------------------------------------------------------------------------------
using Arguments = std::vector<std::string>;

struct Part
{
  std::size_t arguments;
  std::function<void(const Arguments&)> run;
};

int number(const std::string& text)
{
  return std::max(1, std::stoi(text));
}

const std::map<std::string, Part> parts = {
  { "yardstick",
    { 1,
      [](const Arguments& a) { print("yardstick", 1e9 * Yardstick().measure(number(a[0]))); } } },
  { "make", { 3, [](const Arguments& a) { makePart(a[0], number(a[1]), a[2]); } } },
  { "best", { 1, [](const Arguments& a) { print("best sum", bestSum(readMesh(a[0]))); } } },
  { "objective", { 2, [](const Arguments& a) { objectivePart(a[0], number(a[1])); } } },
  { "shape", { 3, [](const Arguments& a) { shapePart(a[0], number(a[1]), std::stod(a[2])); } } },
  { "threads", { 2, [](const Arguments& a) { threadsPart(a[0], number(a[1])); } } },
  { "busy", { 2, [](const Arguments& a) { busyPart(std::stoi(a[0]), number(a[1])); } } },
  { "untangle", { 2, [](const Arguments& a) { untanglePart(a[0], number(a[1])); } } },
  { "converge", { 2, [](const Arguments& a) { convergePart(a[0], number(a[1])); } } },
  { "worst", { 1, [](const Arguments& a) { worstPart(a[0]); } } },
  { "sweeps", { 2, [](const Arguments& a) { sweepsPart(a[0], number(a[1])); } } },
  { "memory", { 1, [](const Arguments& a) { memoryPart(number(a[0])); } } },
};
}

int main(int argc, char* argv[])
{
  const auto part = argc > 1 ? parts.find(argv[1]) : parts.end();
  const Arguments arguments(argv + std::min(argc, 2), argv + argc);
  if (part == parts.end() || arguments.size() != part->second.arguments)
  {
    std::cerr << "usage: BenchmarkOptimization PART ..., see the head of its source file\n";
    return EXIT_FAILURE;
  }
  try
  {
    part->second.run(arguments);
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
