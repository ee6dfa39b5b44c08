// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkQuality PART N REPEATS: times element quality on an N x N x N grid of perturbed cells
// and prints lines "key<tab>nanoseconds per element" (other units as stated below). Run by run.py.
// PARTs:
//   kernel   plain loops, then the kernel's evaluations, in turns, best of REPEATS
//   filter   vtkElementQuality and its parts against vtkMeshQuality, in turns, best of REPEATS
//   memory-tautline, memory-verdict   one filter, once; peak memory in bytes per element

#include "../../Filters/Core/MeshAdapter.h"
#include "../Cxx/Quality/VerdictCompatibility.h"
#include "../Cxx/VtkMeshes.h"
#include "Clocks.h"
#include "KuhnMesh.h"

#include "vtkElementQuality.h"
#include "vtkMeshQuality.h"

#include <cmath>
#include <iostream>
#include <limits>

using namespace tautline;

namespace
{
/// Cubes cut into six tetrahedra round a diagonal (Kuhn), or left whole, in natural order; every
/// point moved by up to a tenth of an edge.
MeshData makeMesh(CellType type, Index n)
{
  MeshData data = blockMesh(CellType::Hexahedron, n, n, n);
  std::mt19937 random(1);
  data.transform(
    [&](Vec3 p)
    {
      for (double& x : p)
      {
        x += 0.2 * (random() / 4294967296.0 - 0.5);
      }
      return p;
    });
  if (type == CellType::Hexahedron)
  {
    return data;
  }
  return cutIntoTetrahedra(std::move(data), n);
}

/// The memory floor: read every element's coordinates, add something to its vertices' gradient.
template <int Nodes>
void gatherAndScatter(const MeshData& mesh, double* gradient)
{
  const Index* cell = mesh.connectivity.data();
  for (Index i = 0; i < mesh.numberOfCells(); ++i, cell += Nodes)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      const double* p = &mesh.points[3 * cell[(k + 1) % Nodes]];
      for (int c = 0; c < 3; ++c)
      {
        gradient[3 * cell[k] + c] += p[c];
      }
    }
  }
}

/// The yardstick: sum of IMR^2 over tetrahedra with its gradient, as one would write it at first.
double plainInverseMeanRatio(const MeshData& mesh, double* gradient)
{
  const auto& inverse = topology(CellType::Tetrahedron).idealInverse[0];
  double sum = 0;
  for (Index i = 0; i < mesh.numberOfCells(); ++i)
  {
    const Index* node = &mesh.connectivity[4 * i];
    const Vec3 p = mesh.point(node[0]);
    const Vec3 a[3] = { mesh.point(node[1]) - p, mesh.point(node[2]) - p, mesh.point(node[3]) - p };
    Vec3 t[3]; // columns of T = A W^-1
    for (int c = 0; c < 3; ++c)
    {
      t[c] = inverse[c] * a[0] + inverse[3 + c] * a[1] + inverse[6 + c] * a[2];
    }
    const Vec3 cofactor[3] = { cross(t[1], t[2]), cross(t[2], t[0]), cross(t[0], t[1]) };
    const double det = dot(t[0], cofactor[0]);
    const double size = 3 * std::cbrt(det * det);
    const double q = (dot(t[0], t[0]) + dot(t[1], t[1]) + dot(t[2], t[2])) / size;
    sum += q * q;
    Vec3 dt[3];
    for (int c = 0; c < 3; ++c)
    {
      dt[c] = (4 * q / size) * t[c] + (-4 * q * q / (3 * det)) * cofactor[c];
    }
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 g =
        inverse[3 * k] * dt[0] + inverse[3 * k + 1] * dt[1] + inverse[3 * k + 2] * dt[2];
      for (int c = 0; c < 3; ++c)
      {
        gradient[3 * node[k + 1] + c] += g[c];
        gradient[3 * node[0] + c] -= g[c];
      }
    }
  }
  return sum;
}

/// Tasks that alternate, so that all of them run under the same load; the best time of each counts.
class Contest
{
public:
  void add(const std::string& name, double elements, double (*clock)(), std::function<void()> work)
  {
    this->Tasks.push_back({ name, elements, clock, std::move(work) });
  }
  void run(int repeats)
  {
    for (int i = 0; i < repeats; ++i)
    {
      for (Task& task : this->Tasks)
      {
        const double start = task.clock();
        task.work();
        task.best = std::min(task.best, task.clock() - start);
      }
    }
    for (const Task& task : this->Tasks)
    {
      std::cout << task.name << '\t' << 1e9 * task.best / task.elements << '\n';
    }
  }

private:
  struct Task
  {
    std::string name;
    double elements;
    double (*clock)();
    std::function<void()> work;
    double best = std::numeric_limits<double>::infinity();
  };
  std::vector<Task> Tasks;
};

void kernelPart(Index n, int repeats)
{
  Contest contest;
  const MeshData tetrahedra = makeMesh(CellType::Tetrahedron, n);
  const MeshData hexahedra = makeMesh(CellType::Hexahedron, n);
  const Mesh tets(tetrahedra.view()), hexes(hexahedra.view());
  std::vector<double> values(tetrahedra.numberOfCells());
  std::vector<double> gradient(tetrahedra.points.size(), 0.0), check = gradient;
  std::cout << "elements tetrahedra\t" << tetrahedra.numberOfCells() << '\n';
  std::cout << "elements hexahedra\t" << hexahedra.numberOfCells() << '\n';
  double expected = 0;
  std::vector<std::unique_ptr<MetricSum>> sums;

  for (const Mesh* mesh : { &tets, &hexes })
  {
    const bool isTets = mesh == &tets;
    const MeshData& data = isTets ? tetrahedra : hexahedra;
    const std::string kind = isTets ? "tetrahedra " : "hexahedra ";
    const double count = static_cast<double>(data.numberOfCells());
    contest.add(kind + "floor", count, threadTime,
      [&, isTets]
      {
        isTets ? gatherAndScatter<4>(data, gradient.data())
               : gatherAndScatter<8>(data, gradient.data());
      });
    if (isTets)
    {
      contest.add(kind + "plain imr", count, threadTime,
        [&] { expected = plainInverseMeanRatio(data, gradient.data()); });
    }
    for (Metric metric : { Metric::InverseMeanRatio, Metric::ConditioningScaleInvariant,
           Metric::ConditioningSizeShape, Metric::RadiusRatio, Metric::ConditionNumber,
           Metric::ShapeConditionSquared, Metric::MinimumAngle })
    {
      if (!metricInfo(metric).definedOn(mesh->blocks()[0].type))
      {
        continue;
      }
      for (int threads : { 1, 2 })
      {
        if (threads == 2 && metric != Metric::InverseMeanRatio)
        {
          continue;
        }
        EvaluationOptions options;
        options.threads = threads;
        sums.push_back(std::make_unique<MetricSum>(*mesh, metric, options, 2.0));
        const MetricSum* sum = sums.back().get();
        const std::string name = kind + metricInfo(metric).name;
        auto values1 = [=, &values] { evaluateMetric(*mesh, metric, options, values.data()); };
        auto gradient1 = [=, &gradient] { sum->valueAndGradient(gradient.data()); };
        if (threads == 1)
        {
          contest.add(name + " value", count, threadTime, values1);
          contest.add(name + " gradient", count, threadTime, gradient1);
        }
        if (metric == Metric::InverseMeanRatio)
        {
          const std::string wall = " wall " + std::to_string(threads);
          contest.add(name + " value" + wall, count, wallTime, values1);
          contest.add(name + " gradient" + wall, count, wallTime, gradient1);
        }
      }
    }
  }
  contest.run(repeats);

  // The yardstick and the kernel compute the same thing.
  std::fill(check.begin(), check.end(), 0.0);
  expected = plainInverseMeanRatio(tetrahedra, check.data());
  const double sum = sums[0]->valueAndGradient(gradient.data());
  double difference = std::abs(sum / expected - 1), largest = 0;
  for (std::size_t i = 0; i < check.size(); ++i)
  {
    difference = std::max(difference, std::abs(check[i] - gradient[i]));
    largest = std::max(largest, std::abs(check[i]));
  }
  std::cout << "difference from the plain loop\t" << difference / largest << '\n';
}

vtkSmartPointer<vtkElementQuality> tautlineFilter(vtkDataSet* grid)
{
  auto filter = vtkSmartPointer<vtkElementQuality>::New();
  filter->SetInputData(grid);
  filter->AddMetric(static_cast<int>(Metric::InverseMeanRatio));
  filter->SetThreads(1);
  return filter;
}

/// Mean ratio: the same formula, turned over.
vtkSmartPointer<vtkMeshQuality> verdictFilter(vtkDataSet* grid)
{
  auto filter = vtkSmartPointer<vtkMeshQuality>::New();
  filter->SetInputData(grid);
  measureMeanRatio(filter);
  return filter;
}

void filterPart(Index n, int repeats)
{
  const MeshData data = makeMesh(CellType::Tetrahedron, n);
  const auto grid = toGrid(data);
  const auto tautline = tautlineFilter(grid);
  const auto verdict = verdictFilter(grid);
  const double count = static_cast<double>(data.numberOfCells());
  std::vector<double> values(data.numberOfCells());
  std::vector<signed char> validity(data.numberOfCells());
  const MeshAdapter kept(grid, 1);
  const MeshData hexahedra = makeMesh(CellType::Hexahedron, n);
  const Mesh hexahedralMesh(hexahedra.view());
  const double hexahedraCount = static_cast<double>(hexahedra.numberOfCells());
  EvaluationOptions options;
  options.threads = 1;
  Contest contest;
  contest.add("filter tautline", count, threadTime,
    [&]
    {
      tautline->Modified();
      tautline->Update();
    });
  contest.add("filter verdict", count, threadTime,
    [&]
    {
      verdict->Modified();
      verdict->Update();
    });
  contest.add("filter adapter", count, threadTime, [&] { MeshAdapter adapter(grid, 1); });
  contest.add(
    "filter validity", count, threadTime, [&] { kept.mesh().classifyCells(validity.data(), 1); });
  contest.add("filter values", count, threadTime,
    [&] { evaluateMetric(kept.mesh(), Metric::InverseMeanRatio, options, values.data()); });
  contest.add("filter validity of hexahedra", hexahedraCount, threadTime,
    [&] { hexahedralMesh.classifyCells(validity.data(), 1); });
  contest.add("filter min_jacobian of hexahedra", hexahedraCount, threadTime,
    [&] { evaluateMetric(hexahedralMesh, Metric::MinimumJacobian, options, values.data()); });
  contest.run(repeats);

  auto* ours = vtkDataSet::SafeDownCast(tautline->GetOutputDataObject(0))->GetCellData();
  auto* theirs = verdict->GetOutput()->GetCellData();
  double difference = 0;
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    const double ratio = std::pow(component(ours, "imr", i), VerdictFunctions::tetMeanRatioPower);
    difference = std::max(difference, std::abs(ratio * component(theirs, "Quality", i) - 1));
  }
  std::cout << "difference from vtkMeshQuality\t" << difference << '\n';
}

void memoryPart(Index n, bool verdict)
{
  const auto grid = toGrid(makeMesh(CellType::Tetrahedron, n));
  const double count = static_cast<double>(grid->GetNumberOfCells());
  // A small mesh first: libraries load, thread pools start.
  const auto warm = toGrid(makeMesh(CellType::Tetrahedron, 2));
  verdict ? verdictFilter(warm)->Update() : tautlineFilter(warm)->Update();
  resetPeakMemory();
  const double before = statusBytes("VmRSS");
  if (verdict)
  {
    const auto filter = verdictFilter(grid);
    filter->Update();
    std::cout << "memory verdict peak\t" << (statusBytes("VmHWM") - before) / count << '\n';
  }
  else
  {
    const auto filter = tautlineFilter(grid);
    filter->Update();
    std::cout << "memory tautline peak\t" << (statusBytes("VmHWM") - before) / count << '\n';
    std::cout << "memory tautline working\t" << filter->GetWorkingBytes() / count << '\n';
  }
}
}

int main(int argc, char* argv[])
{
  const std::string part = argc == 4 ? argv[1] : "";
  const Index n = argc == 4 ? std::atoi(argv[2]) : 0;
  const int repeats = argc == 4 ? std::atoi(argv[3]) : 0;
  if (n < 1 || repeats < 1)
  {
    std::cerr << "usage: BenchmarkQuality kernel|filter|memory-tautline|memory-verdict N REPEATS\n";
    return EXIT_FAILURE;
  }
  if (part == "kernel")
  {
    kernelPart(n, repeats);
  }
  else if (part == "filter")
  {
    filterPart(n, repeats);
  }
  else
  {
    memoryPart(n, part == "memory-verdict");
  }
  return EXIT_SUCCESS;
}
