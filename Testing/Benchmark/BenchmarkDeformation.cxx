// SPDX-License-Identifier: BSD-3-Clause
// BenchmarkDeformation PART ...: times the warping of meshes on one thread. Prints lines
// "key<tab>number"; times are seconds of CPU unless the key states another unit. Run by
// deformation.py. PARTs:
//   box CELLS REPEATS      the inner box of the domain box-in-box turned by 30 to 180 degrees
//   domains FACTOR         the hybrid algorithm on the domains of section 4.10, cells times FACTOR
//   stages CUBES REPEATS   FEMWARP of 5 CUBES^3 tetrahedra without a box in their middle;
//                          positions after the first
//   groups CUBES           inverse distance weighting of CUBES^3 hexahedra: with groups of
//                          prescribed points, and the plain sums over all of them
//   layers POINTS          methods side by side on boundary layers and boxes that turn, with POINTS
//                          on the wall of an airfoil, and as anchors interpolations of all
//                          prescribed points by plain formulas, see Anchors.h

#include "../../Filters/Core/MeshAdapter.h"
#include "../Cxx/Blocks.h"
#include "../Cxx/Deformation/LayeredMeshes.h"
#include "../Cxx/VtkMeshes.h"
#include "Anchors.h"
#include "Clocks.h"

#include "tautline/Domains/Domains.h"
#include "vtkDomainSource.h"

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

/// A mesh of a domain, and where its boundary goes.
class Domain
{
public:
  Domain(const std::string& name, double factor)
    : Name(name)
  {
    this->Source->SetDomainByName(name.c_str());
    this->Source->SetNumberOfCells(
      static_cast<vtkIdType>(factor * static_cast<double>(findDomain(name).cells)));
    this->Source->Update();
    this->Grid = vtkUnstructuredGrid::SafeDownCast(this->Source->GetOutputDataObject(0));
    this->Adapter = std::make_unique<MeshAdapter>(this->Grid, 1);
  }

  const Mesh& mesh() const { return this->Adapter->mesh(); }

  std::vector<double> motion(double amount) const
  {
    const MeshView& view = this->mesh().view();
    std::vector<double> result;
    for (Index i = 0; i < view.numberOfPoints; ++i)
    {
      const auto marker =
        static_cast<int>(component(this->Grid->GetPointData(), "BoundaryMarker", i));
      const Vec3 d = domainDisplacement(this->Name, pointOf(view, i), marker, amount);
      result.insert(result.end(), d.begin(), d.end());
    }
    return result;
  }

private:
  std::string Name;
  vtkNew<vtkDomainSource> Source;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  std::unique_ptr<MeshAdapter> Adapter;
};

//------------------------------------------------------------------------------
void boxPart(double cells, int repeats)
{
  const Domain domain("box-in-box", cells / static_cast<double>(findDomain("box-in-box").cells));
  print("elements", static_cast<double>(domain.mesh().view().numberOfCells));
  for (const auto& [name, method] : { std::pair("hybrid", WarpMethod::Hybrid),
         std::pair("warp then untangle", WarpMethod::FemwarpUntangling) })
  {
    for (const int degrees : { 30, 60, 90, 120, 180 })
    {
      const std::vector<double> motion = domain.motion(degrees / 180.0);
      const std::string key = std::string(name) + ", " + std::to_string(degrees) + " degrees";
      double best = 1e300;
      WarpResult result;
      for (int i = 0; i < repeats; ++i)
      {
        const double start = processTime();
        result = Warper(domain.mesh(), withMethod(method)).warp(motion.data());
        best = std::min(best, processTime() - start);
      }
      print(key + " seconds", best);
      print(key + " inverted before", static_cast<double>(result.history[0].inverted));
      print(key + " inverted left", static_cast<double>(result.invertedAfter));
      print(key + " worst shape", result.history.back().worstShape);
    }
  }
}

//------------------------------------------------------------------------------
void domainsPart(double factor)
{
  for (const char* name :
    { "cylinder", "bar", "gate", "cylinder-diagonal", "bending-bar", "sphere" })
  {
    const Domain domain(name, factor);
    for (const double amount : { 1.0, 1.5 })
    {
      const std::string key = std::string(name) + (amount == 1 ? "" : " x 1.5");
      const double start = processTime();
      const WarpResult result =
        Warper(domain.mesh(), withMethod(WarpMethod::Hybrid)).warp(domain.motion(amount).data());
      print(key + " seconds", processTime() - start);
      print(key + " inverted before", static_cast<double>(result.history[0].inverted));
      print(key + " inverted left", static_cast<double>(result.invertedAfter));
      print(key + " boundary crossings", static_cast<double>(result.crossings));
    }
  }
}

//------------------------------------------------------------------------------
/// A wave on the inner box; no two are combinations of others.
Field wave(double phase)
{
  return [phase](const Vec3& p)
  {
    const double a = 7 * p[0] + phase, b = 9 * p[1] - 2 * phase, c = 5 * p[2];
    return onInnerBox(p, false)
      ? 0.02 * Vec3{ std::sin(a + c), std::cos(b + phase * c), std::sin(a + b) }
      : Vec3{ 0, 0, 0 };
  };
}

void stagesPart(Index cubes, int repeats)
{
  const MeshData data = boxInBox(CellType::Tetrahedron, cubes, 2 * (cubes / 5), 0.1);
  const auto elements = static_cast<double>(data.numberOfCells());
  print("elements", elements);
  const Mesh mesh(data.view(), 1);
  const auto shifted = [](const Vec3& p)
  {
    return turnedBox(25, false)(p) + (onInnerBox(p, false) ? 1.0 : 0.0) * Vec3{ 0.02, -0.01, 0.03 };
  };
  struct Motion
  {
    const char* name;
    Field field;
  };
  // Each on a warper that has had the first of its kind.
  const std::vector<Motion> kinds[] = {
    { { "turn", turnedBox(20, false) }, { "turned on", turnedBox(33, false) },
      { "shifted too", shifted } },
    { { "wave", wave(0) }, { "wave, larger", [](const Vec3& p) { return 1.2 * wave(0)(p); } },
      { "wave, little later", wave(0.01) }, { "wave, another", wave(1) } },
  };
  std::map<std::string, double> best;
  WarpResult first;
  for (int i = 0; i < repeats; ++i)
  {
    for (const std::vector<Motion>& kind : kinds)
    {
      std::unique_ptr<Warper> warper;
      for (const Motion& motion : kind)
      {
        const std::vector<double> d = displacements(data, motion.field);
        if (!warper)
        {
          resetPeakMemory();
        }
        const double before = statusBytes("VmRSS"), wall = wallTime(), start = processTime();
        const bool isFirst = !warper;
        warper = warper ? std::move(warper)
                        : std::make_unique<Warper>(mesh, withMethod(WarpMethod::Femwarp));
        const WarpResult result = warper->warp(d.data());
        const double seconds = processTime() - start, passed = wallTime() - wall;
        const auto note = [&](const std::string& key, double value)
        { best[key] = best.count(key) ? std::min(best[key], value) : value; };
        note(std::string(motion.name) + " seconds", seconds);
        best[std::string(motion.name) + " iterations"] = result.history[0].iterations;
        if (isFirst && motion.name == std::string("turn"))
        {
          note("assemble wall seconds", result.assembleSeconds);
          note("set-up wall seconds", result.setupSeconds);
          note("solve wall seconds", result.solveSeconds);
          note("whole / set-up and solve", passed / (result.setupSeconds + result.solveSeconds));
          best["bytes per element"] = (statusBytes("VmHWM") - before) / elements;
          first = result;
        }
      }
    }
  }
  for (const auto& [key, value] : best)
  {
    print(key, value);
  }
  print("inverted", static_cast<double>(first.invertedAfter));
}

//------------------------------------------------------------------------------
/// The weights and means of inverse distance weighting at every 20th point that is not
/// prescribed, by plain sums over the prescribed ones. Seconds for all points.
double plainSums(
  const MeshData& data, const std::vector<char>& prescribed, const std::vector<double>& motion)
{
  constexpr Index stride = 20;
  std::vector<Index> sources, targets;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    (prescribed[i] ? sources : targets).push_back(i);
  }
  double check = 0;
  const double start = processTime();
  for (std::size_t t = 0; t < targets.size(); t += stride)
  {
    const Vec3 y = data.point(targets[t]);
    Vec3 mean = { 0, 0, 0 };
    for (const Index i : sources)
    {
      const Vec3 d = y - data.point(i);
      const double square = dot(d, d), weight = 1 / (square * std::sqrt(square));
      mean += weight * Vec3{ motion[3 * i], motion[3 * i + 1], motion[3 * i + 2] };
      check += weight;
    }
    check += mean[0];
  }
  const double seconds = double(stride) * (processTime() - start);
  // The sums must be used, or the compiler leaves them out.
  return std::isfinite(check) ? seconds : 0.0;
}

void groupsPart(Index cubes)
{
  const MeshData data = blockMesh(CellType::Hexahedron, cubes, cubes, cubes);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  const double size = static_cast<double>(cubes);
  // A bump on one side and a shear that is not linear.
  const std::vector<double> motion = displacements(data,
    [size](const Vec3& p)
    {
      const Vec3 q = (1 / size) * p;
      return size * Vec3{ 0.15 * std::sin(3 * q[1]) * q[0], 0.1 * q[0] * q[0], 0.1 * q[1] * q[2] };
    });
  const Mesh mesh(data.view());
  const double start = processTime();
  const WarpResult result =
    Warper(mesh, withMethod(WarpMethod::InverseDistance)).warp(motion.data());
  print("seconds by groups", processTime() - start);
  print("seconds by plain sums", plainSums(data, boundary, motion));
  print("points", static_cast<double>(data.numberOfPoints()));
  print("inverted", static_cast<double>(result.invertedAfter));
}

//------------------------------------------------------------------------------
struct Case
{
  std::string name;
  MeshData data;
  std::vector<double> motion;
};

std::vector<Case> layerCases(Index points)
{
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const LayeredMesh& mesh, const Field& field) {
    cases.push_back({ name, mesh.data, mesh.motion(field) });
  };
  constexpr double far = 15, growth = 1.18, shellGrowth = 1.3, shellFar = 6;
  constexpr Index layers = 60, shellLayers = 16;
  const Vec3 axes = { 1, 0.5, 0.3 }, diagonal = { 1, 1, 1 };
  const LayeredMesh airfoil =
    layeredRing(CellType::Quadrilateral, points, layers, growth, airfoilShape(far));
  for (const int degrees : { 30, 60 })
  {
    add("airfoil turned by " + std::to_string(degrees), airfoil, turnedWall(degrees));
  }
  add("airfoil shifted", airfoil, [](const Vec3&) { return Vec3{ 2, 3, 0 }; });
  for (const CellType type : { CellType::Tetrahedron, CellType::Wedge })
  {
    add(std::string("ellipsoid turned by 60, ") + topology(type).plural,
      layeredShell(type, std::max<Index>(2, points / 20), shellLayers, shellGrowth, axes, shellFar),
      turnedWall(60, diagonal));
  }
  for (const int degrees : { 60, 180 })
  {
    const MeshData flat = boxInBox(CellType::Triangle, points / 4, 2 * (points / 20));
    cases.push_back({ "square turned by " + std::to_string(degrees), flat,
      displacements(flat, turnedBox(degrees, true)) });
    const MeshData solid = boxInBox(CellType::Tetrahedron, 2 * (points / 23), 2 * (points / 80));
    cases.push_back({ "box turned by " + std::to_string(degrees), solid,
      displacements(solid, turnedBox(degrees, false)) });
  }
  return cases;
}

void layersPart(Index points)
{
  const std::pair<const char*, WarpMethod> methods[] = { { "Automatic", WarpMethod::Automatic },
    { "Hybrid", WarpMethod::Hybrid }, { "FEMWARP", WarpMethod::Femwarp },
    { "FEMWARP and untangling", WarpMethod::FemwarpUntangling },
    { "biharmonic", WarpMethod::Biharmonic }, { "inverse distance", WarpMethod::InverseDistance },
    { "inverse distance with rotations", WarpMethod::InverseDistanceRotations },
    { "radial basis", WarpMethod::RadialBasis },
    { "weighted Laplacian", WarpMethod::WeightedLaplacian } };
  const std::pair<const char*, Anchor> anchors[] = { { "anchor thin plate", thinPlateSplines },
    { "anchor Wendland C2", wendlandFunctions }, { "anchor IDWarp", idwarpFormula } };
  for (const Case& one : layerCases(points))
  {
    const Mesh mesh(one.data.view(), 1);
    const auto report = [&](const char* name, const std::vector<double>& moved, double seconds)
    {
      const WarpQuality quality = qualityOf(mesh, moved.data(), 1);
      print(one.name + ", " + name + " inverted", static_cast<double>(quality.inverted));
      print(one.name + ", " + name + " worst ratio", quality.worstRatio);
      print(one.name + ", " + name + " seconds", seconds);
    };
    for (const auto& [name, method] : methods)
    {
      const double start = processTime();
      const WarpResult result = Warper(mesh, withMethod(method)).warp(one.motion.data());
      report(name, result.points, processTime() - start);
    }
    for (const auto& [name, anchor] : anchors)
    {
      const double start = processTime();
      const std::vector<double> moved = anchor(mesh, one.motion);
      report(name, moved, processTime() - start);
    }
  }
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
  { "box", { 2, [](const Arguments& a) { boxPart(number(a[0]), number(a[1])); } } },
  { "domains", { 1, [](const Arguments& a) { domainsPart(std::stod(a[0])); } } },
  { "groups", { 1, [](const Arguments& a) { groupsPart(number(a[0])); } } },
  { "layers", { 1, [](const Arguments& a) { layersPart(number(a[0])); } } },
  { "stages", { 2, [](const Arguments& a) { stagesPart(number(a[0]), number(a[1])); } } },
};
}

int main(int argc, char* argv[])
{
  const auto part = argc > 1 ? parts.find(argv[1]) : parts.end();
  const Arguments arguments(argv + std::min(argc, 2), argv + argc);
  if (part == parts.end() || arguments.size() != part->second.arguments)
  {
    std::cerr << "usage: BenchmarkDeformation PART ..., see the head of its source file\n";
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
