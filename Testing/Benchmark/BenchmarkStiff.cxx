// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkStiff PART ...: what meshes of stretched elements cost to optimize: CPU seconds of one
// thread, passes of the yardstick (see Yardstick.h) and iterations. Prints lines
// "key<tab>number". Run by stiff.py. PARTs:
//   grid NAME CELLS METHOD REPEATS   a mesh made here, see makeGrid()
//   file FILE METHOD REPEATS BEST    a mesh of a legacy VTK file; BEST is its minimum sum
//   compare FILE REPEATS             the default against each of our methods, on a mesh of a file
// METHOD: automatic, local, local-cg, fletcher-reeves, polak-ribiere, lbfgs or newton. The minimum
// is known for grids of quadrilaterals and hexahedra, otherwise found by Newton's method to ten
// digits.

#include "../../Filters/Core/MeshAdapter.h"
#include "../Cxx/Blocks.h"
#include "Clocks.h"
#include "KuhnMesh.h"
#include "Yardstick.h"

#include "tautline/Optimization/Optimize.h"
#include "tautline/Untangling/Untangle.h"

#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"
#include "vtkUnstructuredGridReader.h"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>

using namespace tautline;

namespace
{
void print(const std::string& key, double value)
{
  std::cout << key << '\t' << std::setprecision(12) << value << std::endl;
}

//------------------------------------------------------------------------------
/// Moves the points inside the unit square or cube.
template <class Function>
MeshData stretched(MeshData data, Index n, const Function& function)
{
  const Mesh mesh(data.view());
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = (1.0 / static_cast<double>(n)) * data.point(i);
    data.setPoint(i, boundary[i] ? p : function(p));
  }
  return data;
}

/// How many times the first row of cells the last is to be, so that cells that grow geometrically
/// from one row to the next have this aspect ratio in the first: (G - 1) / log G.
double growthFor(double aspect)
{
  double low = 1, high = 1e3 * (aspect + 1);
  constexpr int bisections = 100;
  for (int i = 0; i < bisections && aspect > 1; ++i)
  {
    const double middle = 0.5 * (low + high);
    ((middle - 1) / std::log(middle) < aspect ? low : high) = middle;
  }
  return low;
}

/**
 * @brief How a grid is stretched: sine, x + 0.14 sin(2 pi x) sin(2 pi y) and y alike; powerE, y to
 * the power E; aspectA, rows that grow geometrically, the first of cells A times as long as high
 * (in fine grids; 0.6 A with ten rows).
 */
std::function<Vec3(const Vec3&)> stretching(const std::string& name)
{
  if (name == "sine")
  {
    return [](const Vec3& p)
    {
      const double s = 0.14 * std::sin(2 * Pi * p[0]) * std::sin(2 * Pi * p[1]);
      return Vec3{ p[0] + s, p[1] + s, p[2] };
    };
  }
  if (name.compare(0, 5, "power") == 0)
  {
    const double exponent = std::stod(name.substr(5));
    return [exponent](const Vec3& p) { return Vec3{ p[0], std::pow(p[1], exponent), p[2] }; };
  }
  if (name.compare(0, 6, "aspect") == 0)
  {
    const double growth = growthFor(std::stod(name.substr(6)));
    return [growth](const Vec3& p)
    {
      const double y = growth > 1 ? (std::pow(growth, p[1]) - 1) / (growth - 1) : p[1];
      return Vec3{ p[0], y, p[2] };
    };
  }
  throw Error("Unknown stretching " + name + ": sine, powerE or aspectA.");
}

/**
 * @brief A grid of about this many cells on the unit square or cube, of which the inner points are
 * moved: TYPE-STRETCHING, the type triangles, quads, tets or hexes.
 */
MeshData makeGrid(const std::string& name, double cells)
{
  const std::size_t dash = name.find('-');
  const std::string type = name.substr(0, dash);
  const auto move = stretching(dash < name.size() ? name.substr(dash + 1) : "");
  const auto side = [cells](double perCube, int dimension)
  { return std::max<Index>(2, std::lround(std::pow(cells / perCube, 1.0 / dimension))); };
  if (type == "triangles" || type == "quads")
  {
    const bool quads = type == "quads";
    const Index n = side(quads ? 1 : 2, 2);
    const CellType cell = quads ? CellType::Quadrilateral : CellType::Triangle;
    return stretched(blockMesh(cell, n, n, 0), n, move);
  }
  if (type == "tets" || type == "hexes")
  {
    const Index n = side(type == "hexes" ? 1 : 6, 3);
    MeshData cubes = blockMesh(CellType::Hexahedron, n, n, n);
    return stretched(type == "hexes" ? cubes : cutIntoTetrahedra(cubes, n), n, move);
  }
  throw Error("Unknown type of cells " + type + ": triangles, quads, tets or hexes.");
}

//------------------------------------------------------------------------------
const std::map<std::string, Optimizer> methods = { { "automatic", Optimizer::Automatic },
  { "local", Optimizer::LocalNewton }, { "local-cg", Optimizer::LocalConjugateGradient },
  { "fletcher-reeves", Optimizer::ConjugateGradientFletcherReeves },
  { "polak-ribiere", Optimizer::ConjugateGradientPolakRibiere },
  { "lbfgs", Optimizer::LimitedMemoryBFGS }, { "newton", Optimizer::NewtonConjugateGradient } };

OptimizeResult run(
  const Mesh& mesh, const std::string& method, double best, double& seconds, double close = 1.00001)
{
  OptimizeOptions options;
  options.threads = 1;
  const auto known = methods.find(method);
  if (known == methods.end())
  {
    throw Error("Unknown method " + method + ", see the head of the source file.");
  }
  options.optimizer = known->second;
  const double start = processTime();
  seconds = 0;
  options.observer = [&](const IterationState& state)
  {
    if (seconds == 0 && state.record.objective <= close * best)
    {
      seconds = processTime() - start;
    }
    return true;
  };
  return optimize(mesh, options);
}

/// The minimum by Newton's method.
double minimumOf(const Mesh& mesh)
{
  OptimizeOptions options;
  options.threads = 1;
  options.optimizer = Optimizer::NewtonConjugateGradient;
  options.stopping.relativeChange = 1e-10;
  options.stopping.maximumIterations = 3000;
  return optimize(mesh, options).history.back().objective;
}

void measure(const Mesh& mesh, const std::string& method, int repeats, double best)
{
  Yardstick stick;
  double unit = stick.measure(repeats), whole = HUGE_VAL, close = HUGE_VAL;
  OptimizeResult result;
  for (int i = 0; i < repeats; ++i)
  {
    const double start = processTime();
    double seconds = 0;
    result = run(mesh, method, best, seconds);
    whole = std::min(whole, processTime() - start);
    close = std::min(close, seconds);
    unit = std::min(unit, stick.measure());
  }
  const double elements = static_cast<double>(mesh.view().numberOfCells);
  print("elements", elements);
  print("sum at the start / minimum", result.history.front().objective / best);
  print("sum", result.history.back().objective);
  print("sum / minimum", result.history.back().objective / best);
  print("worst", result.history.back().worst[0]);
  print("iterations", result.iterations);
  print("reason", static_cast<int>(result.reason));
  print("seconds", whole);
  print("seconds to 1.00001", close);
  print("passes", whole / (unit * elements));
  print("passes to 1.00001", close / (unit * elements));
}

/**
 * @brief For each method: the sum over the least that any reached, the seconds of the whole run and
 * to 1.001 of the least (0: not reached). For the default also its time over the time of the
 * fastest other method to 1.001.
 */
void comparePart(const std::string& file, int repeats)
{
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (reader->GetOutput()->GetNumberOfCells() == 0)
  {
    throw Error("There is no mesh in " + file + ".");
  }
  const MeshAdapter adapter(reader->GetOutput(), 1);
  // All start at the same valid points.
  UntangleOptions untangling;
  untangling.threads = 1;
  const UntangleResult valid = untangle(adapter.mesh(), untangling);
  MeshView view = adapter.mesh().view();
  view.points = valid.points.data();
  Mesh mesh(view);
  mesh.setMirrored(adapter.mesh().mirrored());
  double best = minimumOf(mesh), unused = 0;
  constexpr double close = 1.001;
  std::map<std::string, double> sums, whole, reached;
  for (const auto& [name, method] : methods)
  {
    const double start = processTime();
    sums[name] = run(mesh, name, 0, unused).history.back().objective;
    whole[name] = processTime() - start;
    best = std::min(best, sums[name]);
  }
  double fastest = HUGE_VAL;
  for (const auto& [name, method] : methods)
  {
    reached[name] = HUGE_VAL;
    for (int i = 0; i < repeats && sums[name] <= close * best; ++i)
    {
      double seconds = 0;
      run(mesh, name, best, seconds, close);
      reached[name] = std::min(reached[name], seconds);
    }
    const bool close = std::isfinite(reached[name]);
    print(name + " sum / minimum", sums[name] / best);
    print(name + " seconds", whole[name]);
    print(name + " seconds to 1.001", close ? reached[name] : 0.0);
    fastest = name == "automatic" ? fastest : std::min(fastest, reached[name]);
  }
  print("elements", static_cast<double>(view.numberOfCells));
  print("automatic / fastest", std::isfinite(fastest) ? reached["automatic"] / fastest : 1.0);
}

void gridPart(const std::string& name, double cells, const std::string& method, int repeats)
{
  const MeshData data = makeGrid(name, cells);
  const Mesh mesh(data.view());
  const bool known = name[0] == 'q' || name[0] == 'h';
  measure(
    mesh, method, repeats, known ? static_cast<double>(data.numberOfCells()) : minimumOf(mesh));
}

void filePart(const std::string& file, const std::string& method, int repeats, double best)
{
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (reader->GetOutput()->GetNumberOfCells() == 0)
  {
    throw Error("There is no mesh in " + file + ".");
  }
  const MeshAdapter adapter(reader->GetOutput(), 1);
  measure(adapter.mesh(), method, repeats, best > 0 ? best : minimumOf(adapter.mesh()));
}
}

int main(int argc, char* argv[])
{
  const std::vector<std::string> a(argv + std::min(argc, 1), argv + argc);
  try
  {
    if (a.size() == 5 && a[0] == "grid")
    {
      gridPart(a[1], std::stod(a[2]), a[3], std::max(1, std::stoi(a[4])));
    }
    else if (a.size() == 3 && a[0] == "compare")
    {
      comparePart(a[1], std::max(1, std::stoi(a[2])));
    }
    else if (a.size() == 5 && a[0] == "file")
    {
      filePart(a[1], a[2], std::max(1, std::stoi(a[3])), std::stod(a[4]));
    }
    else
    {
      std::cerr << "usage: BenchmarkStiff PART ..., see the head of its source file\n";
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
