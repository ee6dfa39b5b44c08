// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkPeers PART ...: the optimizer on meshes that other programs have been run on, or that
// resemble these: what is reached and CPU seconds of one thread. Prints lines "key<tab>number". Run
// by peers.py. PARTs:
//   worst FILE               the preset for the worst element on a mesh of hexahedra, with the
//                            boundary on the surface
//   disk CELLS REPEATS       a disk of triangles, stretched along the radius: both methods
//   box NX NY NZ REPEATS     hexahedra of the unit box with y^3 for y inside: both methods
//   isotropic FILE REPEATS   tetrahedra: the default against local sweeps
//   cubes N REPEATS          the same on 6 N^3 tetrahedra, perturbed
// The methods: the default (automatic) and Newton's for all points at once.

#include "../../Filters/Core/MeshAdapter.h"
#include "../Cxx/VtkMeshes.h"
#include "Clocks.h"
#include "KuhnMesh.h"

#include "tautline/Optimization/Optimize.h"
#include "tautline/Perturbation/Perturb.h"
#include "vtkDomainSource.h"
#include "vtkMeshOptimizer.h"

#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numeric>

using namespace tautline;

namespace
{
void print(const std::string& key, double value)
{
  std::cout << key << '\t' << std::setprecision(12) << value << std::endl;
}

vtkSmartPointer<vtkUnstructuredGrid> readMesh(const std::string& file)
{
  auto grid = readGrid(file);
  if (grid->GetNumberOfCells() == 0)
  {
    throw Error("There is no mesh in " + file + ".");
  }
  return grid;
}

double worstJacobian(vtkDataSet* grid)
{
  const MeshAdapter adapter(grid, 1);
  std::vector<double> values(adapter.mesh().view().numberOfCells);
  evaluateMetric(adapter.mesh(), Metric::ScaledJacobian, EvaluationOptions(), values.data());
  return *std::min_element(values.begin(), values.end());
}

void worstPart(const std::string& file)
{
  const auto grid = readMesh(file);
  vtkNew<vtkMeshOptimizer> filter;
  filter->SetInputData(grid);
  filter->SetPreset(vtkMeshOptimizer::WORST_ELEMENT);
  filter->SetBoundary(vtkMeshOptimizer::ON_SURFACE);
  filter->SetThreads(1);
  filter->SetTimeLimit(0);
  const double start = processTime();
  filter->Update();
  print("seconds", processTime() - start);
  print("elements", static_cast<double>(grid->GetNumberOfCells()));
  print("worst scaled Jacobian before", worstJacobian(grid));
  print("worst scaled Jacobian",
    worstJacobian(vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0))));
  print("invalid", static_cast<double>(filter->GetInvertedAfter()));
  print("surface error / diagonal", filter->GetSurfaceError() / grid->GetLength());
}

//------------------------------------------------------------------------------
/// One run on one thread, with the default's stopping criteria.
OptimizeResult run(const Mesh& mesh, Optimizer method, double& seconds)
{
  OptimizeOptions options;
  options.threads = 1;
  options.optimizer = method;
  const double start = processTime();
  OptimizeResult result = optimize(mesh, options);
  seconds = std::min(seconds, processTime() - start);
  return result;
}

/// Runs both methods, one after the other.
void bothMethods(const Mesh& mesh, int repeats)
{
  print("elements", static_cast<double>(mesh.view().numberOfCells));
  std::array<double, 2> seconds = { HUGE_VAL, HUGE_VAL };
  std::array<OptimizeResult, 2> results;
  constexpr std::pair<const char*, Optimizer> methods[] = { { "default", Optimizer::Automatic },
    { "Newton", Optimizer::NewtonConjugateGradient } };
  for (int i = 0; i < repeats; ++i)
  {
    for (std::size_t m = 0; m < results.size(); ++m)
    {
      results[m] = run(mesh, methods[m].second, seconds[m]);
    }
  }
  print("start sum", results[0].history.front().objective);
  print("start mean", results[0].history.front().mean[0]);
  for (std::size_t m = 0; m < results.size(); ++m)
  {
    const std::string name = methods[m].first;
    const IterationRecord& last = results[m].history.back();
    print(name + " sum", last.objective);
    print(name + " mean", last.mean[0]);
    print(name + " worst", last.worst[0]);
    print(name + " iterations", results[m].iterations);
    print(name + " seconds", seconds[m]);
  }
}

/// The points inside the unit disk go out to r (1 + 0.3 sin(pi r)).
void diskPart(vtkIdType cells, int repeats)
{
  vtkNew<vtkDomainSource> domain;
  domain->SetDomainByName("disk2d");
  domain->SetNumberOfCells(cells);
  domain->Update();
  MeshData data = toMesh(vtkUnstructuredGrid::SafeDownCast(domain->GetOutputDataObject(0)));
  Vec3 low = data.point(0), high = low;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    for (int c = 0; c < 2; ++c)
    {
      low[c] = std::min(low[c], data.point(p)[c]);
      high[c] = std::max(high[c], data.point(p)[c]);
    }
  }
  const Vec3 center = 0.5 * (low + high);
  const double radius = 0.5 * (high[0] - low[0]);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  constexpr double stretch = 0.3;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 away = data.point(p) - center;
    const double r = norm(away) / radius;
    if (!boundary[p])
    {
      data.setPoint(p, center + (1 + stretch * std::sin(Pi * r)) * away);
    }
  }
  bothMethods(Mesh(data.view()), repeats);
}

/// Equal cells, of which the points inside are moved; the least sum is the number of cells times
/// the square of the inverse mean ratio of one.
void boxPart(Index nx, Index ny, Index nz, int repeats)
{
  MeshData data = blockMesh(CellType::Hexahedron, nx, ny, nz);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 at = data.point(p);
    const double y = at[1] / static_cast<double>(ny);
    if (!boundary[p])
    {
      data.setPoint(p, { at[0], static_cast<double>(ny) * y * y * y, at[2] });
    }
  }
  bothMethods(Mesh(data.view()), repeats);
  print("least sum", static_cast<double>(data.numberOfCells()));
}

//------------------------------------------------------------------------------
void isotropicPart(const Mesh& mesh, int repeats)
{
  print("elements", static_cast<double>(mesh.view().numberOfCells));
  double automatic = HUGE_VAL, local = HUGE_VAL, defaultSum = 0, localSum = 0, unused = HUGE_VAL;
  run(mesh, Optimizer::LocalNewton, unused); // the first run of a program takes longer
  for (int i = 0; i < repeats; ++i)
  {
    defaultSum = run(mesh, Optimizer::Automatic, automatic).history.back().objective;
    localSum = run(mesh, Optimizer::LocalNewton, local).history.back().objective;
  }
  print("default seconds", automatic);
  print("local seconds", local);
  print("default sum", defaultSum);
  print("local sum", localSum);
}

void cubesPart(Index n, int repeats)
{
  MeshData data = cutIntoTetrahedra(blockMesh(CellType::Hexahedron, n, n, n), n);
  PerturbOptions options;
  options.percentage = 50;
  data.points = perturb(Mesh(data.view()), nullptr, options).points;
  isotropicPart(Mesh(data.view()), repeats);
}
}

int main(int argc, char* argv[])
{
  const std::vector<std::string> a(argv + std::min(argc, 1), argv + argc);
  const auto number = [&a](std::size_t i) { return std::max(1, std::stoi(a[i])); };
  try
  {
    if (a.size() == 2 && a[0] == "worst")
    {
      worstPart(a[1]);
    }
    else if (a.size() == 3 && a[0] == "disk")
    {
      diskPart(number(1), number(2));
    }
    else if (a.size() == 5 && a[0] == "box")
    {
      boxPart(number(1), number(2), number(3), number(4));
    }
    else if (a.size() == 3 && a[0] == "isotropic")
    {
      const auto grid = readMesh(a[1]);
      const MeshAdapter adapter(grid, 1);
      isotropicPart(adapter.mesh(), number(2));
    }
    else if (a.size() == 3 && a[0] == "cubes")
    {
      cubesPart(number(1), number(2));
    }
    else
    {
      std::cerr << "usage: BenchmarkPeers PART ..., see the head of its source file\n";
      return EXIT_FAILURE;
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
