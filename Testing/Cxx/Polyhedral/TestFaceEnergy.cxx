// SPDX-License-Identifier: BSD-3-Clause
// The energy of faces: its gradient against differences, its value where it is known.
#include "Blocks.h"
#include "FiniteVolume/FaceMeshes.h"
#include "Registry.h"

#include "tautline/Polyhedral/FaceEnergy.h"

using namespace tautline;

namespace
{
/// @param inside whether a point is free
template <class Inside>
void testGradient(
  MeshData& data, const FaceMesh& mesh, const FaceEnergyOptions& options, const Inside& inside)
{
  std::vector<char> free(mesh.points, 0);
  for (Index i = 0; i < mesh.points; ++i)
  {
    free[i] = inside(i);
  }
  FaceEnergy energy(mesh, data.points.data(), free, options);
  energy.freeze(data.points.data());
  std::vector<double> gradient(3 * energy.freePoints().size());
  const double value = energy.evaluate(data.points.data(), gradient.data());
  TAUTLINE_CHECK(std::isfinite(value) && value > 0);
  double largest = 0;
  for (double g : gradient)
  {
    largest = std::max(largest, std::abs(g));
  }
  TAUTLINE_CHECK(largest > 0);
  constexpr double step = 1e-6;
  TAUTLINE_CHECK_EQUAL(
    energy.freePoints().size(), static_cast<std::size_t>(std::count(free.begin(), free.end(), 1)));
  for (std::size_t i = 0; i < energy.freePoints().size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      double& x = data.points[3 * energy.freePoints()[i] + c];
      const double at = x;
      const double slope = gradient[3 * i + c];
      x = at + step;
      const double above = energy.evaluate(data.points.data(), nullptr);
      x = at - step;
      const double below = energy.evaluate(data.points.data(), nullptr);
      x = at;
      TAUTLINE_CHECK_NEAR((above - below) / (2 * step), slope, 1e-6 * largest);
    }
  }
}

void perturb(MeshData& data, double amplitude)
{
  Random random(7);
  data.transform(
    [&](const Vec3& p)
    {
      return p +
        Vec3{ random.uniform(-amplitude, amplitude), random.uniform(-amplitude, amplitude),
          random.uniform(-amplitude, amplitude) };
    });
}
}

TAUTLINE_PART(testGradientOfTypes)
{
  for (CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const Context context(topology(type).name);
    MeshData data = blockMesh(type, 2, 2, 2);
    perturb(data, 0.15);
    const FaceMesh mesh = faceMeshOf(data);
    FaceEnergyOptions options;
    options.shrinking = 0.9; // so that it acts on all
    testGradient(data, mesh, options, [](Index) { return true; });
    testGradient(data, mesh, options, [](Index i) { return i % 3 == 0; });
  }
}

/// Where cells are inverted, the energy is finite with delta only.
TAUTLINE_PART(testGradientOfInverted)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 2, 2);
  perturb(data, 0.1);
  data.setPoint(13, { 2.3, 2.2, 2.1 });
  const FaceMesh mesh = faceMeshOf(data);
  FaceEnergyOptions options;
  options.delta = 0.3;
  testGradient(data, mesh, options, [](Index) { return true; });
  options.delta = 0;
  FaceEnergy energy(mesh, data.points.data(), std::vector<char>(mesh.points, 1), options);
  energy.freeze(data.points.data());
  TAUTLINE_CHECK(std::isinf(energy.evaluate(data.points.data(), nullptr)));
  TAUTLINE_CHECK(energy.leastTetrahedron() < 0);
}

/// Patches coupled by a translation.
TAUTLINE_PART(testGradientOfCoupled)
{
  MeshData data = blockMesh(CellType::Hexahedron, 3, 2, 2);
  const FaceMesh whole = faceMeshOf(data);
  ListedFacets facets;
  addFacets(facets, whole, 0, data, [](const Vec3& p) { return p[0] < 0.5; });
  addFacets(facets, whole, 1, data, [](const Vec3& p) { return p[0] > 2.5; });
  const FaceMesh mesh = findFaces(whole.points, facesOf(data), facets,
    { patchOf("left", "cyclic", 1), patchOf("right", "cyclic", 0) });
  const MeshData plain = data;
  Random random(5);
  for (Index i = 0; i < mesh.points; ++i)
  {
    const bool onEnd = plain.points[3 * i] < 0.5 || plain.points[3 * i] > 2.5;
    for (int c = 0; c < 3 && !onEnd; ++c)
    {
      data.points[3 * i + c] += random.uniform(-0.2, 0.2);
    }
  }
  testGradient(data, mesh, {},
    [&](Index i) { return plain.points[3 * i] > 0.5 && plain.points[3 * i] < 2.5; });
}

/// A sheared block: each internal face across the shear costs the same.
TAUTLINE_PART(testValue)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 2, 2);
  data.transform([](const Vec3& p) { return Vec3{ p[0] + p[1], p[1], p[2] }; });
  const FaceMesh mesh = faceMeshOf(data);
  FaceEnergyOptions options;
  options.angle = 45;
  options.skewness = 1;
  options.power = 1;
  options.skewPower = 2;
  FaceEnergy energy(mesh, data.points.data(), std::vector<char>(mesh.points, 1), options);
  energy.freeze(data.points.data());
  const double value = energy.evaluate(data.points.data(), nullptr);
  const FaceMeasures measures(mesh, data.points.data(), FaceConvention::Esi);
  double expected = 0;
  const FaceValues angles = measures.evaluate(Metric::NonOrthogonality);
  const FaceValues skews = measures.evaluate(Metric::FaceSkewness);
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    expected += (1 - std::cos(angles.faces[face] / DegreesPerRadian)) / (1 - std::sqrt(0.5)) +
      skews.faces[face] * skews.faces[face];
  }
  TAUTLINE_CHECK_RELATIVE(value, expected, 1e-9);
}
