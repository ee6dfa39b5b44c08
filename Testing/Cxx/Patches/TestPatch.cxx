// SPDX-License-Identifier: BSD-3-Clause
// Simplices, patches and energies against the metrics and against differences.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Patches/Energies.h"
#include "tautline/Patches/SimplexMesh.h"

using namespace tautline;

namespace
{
const double step = 1e-4;

/// Boundary flags by fingerprints and by sorting, on each type and on a mixture.
TAUTLINE_PART(testBoundary)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const MeshData data = shuffled(blockMesh(type, 4, 4, topology(type).dimension == 2 ? 0 : 4), 3);
    const Mesh mesh(data.view());
    const std::vector<char> expected = mesh.boundary().isBoundaryPoint;
    const std::vector<char> actual = boundaryPoints(mesh);
    TAUTLINE_CHECK_EQUAL(
      std::equal(expected.begin(), expected.end(), actual.begin(), actual.end()), true);
    TAUTLINE_CHECK(std::count(actual.begin(), actual.end(), 0) > 0);

    // With every cell there twice no facet has two cells only: nothing is inside.
    MeshData doubled = data;
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      doubled.addCell(type, data.nodes(c));
    }
    const Mesh twice(doubled.view());
    const std::vector<char> all = boundaryPoints(twice);
    TAUTLINE_CHECK_EQUAL(all == twice.boundary().isBoundaryPoint, true);
    TAUTLINE_CHECK(std::count(all.begin(), all.end(), 1) > 0);
  }
}

/// N and D of each patch simplex give the inverse mean ratio of its cell.
template <int Dim>
void testPatches(CellType type)
{
  const Context context(topology(type).name);
  const MeshData data = movedBlock(type, 5, 0.08);
  const Mesh mesh(data.view());
  const std::vector<double> imr = valuesOf(mesh, Metric::InverseMeanRatio);
  SimplexMesh simplices(mesh, nullptr, nullptr, 1);
  TAUTLINE_CHECK(simplices.freeVertices() > 0);
  simplices.indexPatches();
  const bool one = topology(type).samples == 1;
  std::vector<double> sums(data.numberOfCells(), 0.0);
  std::vector<int> seen(data.numberOfCells(), 0);
  Patch<Dim> patch;
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    gatherPatch<Dim>(simplices, simplices.coordinates(), v, nullptr, patch);
    const double zero[Dim] = {};
    for (std::int32_t i = simplices.patchStart(v); i < simplices.patchStart(v + 1); ++i)
    {
      const int place = i - simplices.patchStart(v);
      Packet N, D;
      invariants(patch.packets[place / PacketWidth], zero, N, D);
      const double n = N[place % PacketWidth], d = D[place % PacketWidth];
      const double q = n / (Dim * std::pow(d, 2.0 / Dim));
      const Index cell = simplices.cell(simplices.patchCorners()[i] / (Dim + 1));
      sums[cell] += q;
      ++seen[cell];
      if (one)
      {
        TAUTLINE_CHECK_RELATIVE(q, imr[cell], 1e-12);
      }
    }
  }
  TAUTLINE_CHECK(std::count(seen.begin(), seen.end(), 0) < data.numberOfCells());
}

/// Blocks of one color, whose vertices move at the same time, have no cell in common.
void testBlocks(CellType type)
{
  const Context context(topology(type).name);
  const bool planar = topology(type).dimension == 2;
  const MeshData data =
    shuffled(planar ? blockMesh(type, 60, 60, 0) : blockMesh(type, 20, 20, 20), 3);
  const SimplexMesh simplices(Mesh(data.view()), nullptr, nullptr, 1);
  const VertexBlocks& blocks = simplices.blocks();
  const std::int32_t numberOfBlocks = static_cast<std::int32_t>(blocks.byColour.size());
  TAUTLINE_CHECK(numberOfBlocks > 10);
  std::vector<int> colour(numberOfBlocks, -1);
  for (std::size_t c = 0; c + 1 < blocks.colourStarts.size(); ++c)
  {
    for (std::int32_t i = blocks.colourStarts[c]; i < blocks.colourStarts[c + 1]; ++i)
    {
      colour[blocks.byColour[i]] = static_cast<int>(c);
    }
  }
  std::vector<std::int32_t> blockOf(data.numberOfPoints(), -1);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    blockOf[simplices.point(v)] = v / blocks.size;
  }
  int shared = 0, clashes = 0;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    for (Index i = data.offsets[cell]; i < data.offsets[cell + 1]; ++i)
    {
      for (Index j = data.offsets[cell]; j < i; ++j)
      {
        const std::int32_t a = blockOf[data.connectivity[i]], b = blockOf[data.connectivity[j]];
        shared += a >= 0 && b >= 0 && a != b;
        clashes += a >= 0 && b >= 0 && a != b && colour[a] == colour[b];
      }
    }
  }
  TAUTLINE_CHECK(shared > 0);
  TAUTLINE_CHECK_EQUAL(clashes, 0);
}

/// Values, gradients and Hessians of an energy over patches, against fourth-order differences.
template <int Dim, class Energy>
void testEnergy(const char* name, const Energy& energy)
{
  const Context context(name + std::string(Dim == 2 ? " 2D" : " 3D"));
  const CellType type = Dim == 2 ? CellType::Triangle : CellType::Tetrahedron;
  const MeshData data = movedBlock(type, 3, 0.08);
  SimplexMesh simplices(Mesh(data.view()), nullptr, nullptr, 1);
  Patch<Dim> patch;
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    gatherPatch<Dim>(simplices, simplices.coordinates(), v, nullptr, patch);
    double d[Dim];
    for (int c = 0; c < Dim; ++c)
    {
      d[c] = 0.01 * (c + 1);
    }
    const PatchSum<Dim> sum = sumOver(patch, d, energy);
    TAUTLINE_CHECK_RELATIVE(valueOver(patch, d, energy), sum.f, 1e-12);
    const auto at = [&](int c, double shift)
    {
      double moved[Dim];
      std::copy_n(d, Dim, moved);
      moved[c] += shift;
      return sumOver(patch, moved, energy);
    };
    double scale = 0, curvature = 0;
    for (int c = 0; c < Dim; ++c)
    {
      scale = std::max(scale, std::abs(sum.g[c]));
      curvature = std::max(curvature, std::abs(sum.H[c][c]));
    }
    for (int c = 0; c < Dim; ++c)
    {
      const PatchSum<Dim> far = at(c, 2 * step), near = at(c, step), back = at(c, -step),
                          farBack = at(c, -2 * step);
      const auto difference = [&](double a, double b, double e, double f)
      { return (-a + 8 * b - 8 * e + f) / (12 * step); };
      TAUTLINE_CHECK_NEAR(
        difference(far.f, near.f, back.f, farBack.f), sum.g[c], 1e-6 * (scale + std::abs(sum.f)));
      TAUTLINE_EACH(int, r, Dim,
        TAUTLINE_CHECK_NEAR(difference(far.g[r], near.g[r], back.g[r], farBack.g[r]), sum.H[r][c],
          1e-6 * (curvature + scale)));
    }
    // Newton's direction solves the system where the Hessian is positive definite.
    double s[Dim], slope = 0;
    newtonDirection<Dim>(sum, s);
    for (int c = 0; c < Dim; ++c)
    {
      slope += s[c] * sum.g[c];
    }
    TAUTLINE_CHECK(slope < 0);

    // At the step to inversion the minimum D vanishes, and not before.
    const double zero[Dim] = {};
    const double direction[3] = { 0.3, -0.5, 0.8 };
    const double t = stepToInversion<Dim>(patch, zero, direction);
    TAUTLINE_CHECK(std::isfinite(t) && t > 0);
    double least = 1e300;
    for (int i = 0; i < patch.count; ++i)
    {
      double to[Dim];
      for (int c = 0; c < Dim; ++c)
      {
        to[c] = t * direction[c];
      }
      Packet N, D;
      invariants(patch.packets[i], to, N, D);
      least = std::min(least, minOf(D));
    }
    TAUTLINE_CHECK_NEAR(least, 0.0, 1e-12);
  }
}

template <int Dim>
void testEnergies()
{
  testEnergy<Dim>("IMR", InverseMeanRatioEnergy<Dim, 1>());
  testEnergy<Dim>("IMR^2", InverseMeanRatioEnergy<Dim, 2>());
  testEnergy<Dim>("worst", WorstRatioEnergy<Dim>{ 0.4 });
  testEnergy<Dim>("regularized", RegularizedShapeEnergy<Dim>{ 0.3 });
}

/// Points off a cube's surface come back to it.
TAUTLINE_PART(testProjection)
{
  MeshData data = blockMesh(CellType::Quadrilateral, 4, 4, 0);
  data.transform(TAUTLINE_PLACE(p[0], p[1], 0.25 * p[0] * p[0]));
  const Mesh mesh(data.view());
  const SimplexMesh simplices(mesh, nullptr, nullptr, 1);
  const SurfaceProjection surface(mesh, simplices);
  TAUTLINE_CHECK_NEAR(SurfaceProjection(mesh, simplices).distanceTo(surface), 0.0, 1e-12);
  Random random(5);
  for (int i = 0; i < 100; ++i)
  {
    const Vec3 x = random.vector(-1, 1);
    const Vec3 p = surface.closest(x);
    // Nothing sampled on the surface is closer.
    for (Index v = 0; v < data.numberOfPoints(); ++v)
    {
      const Vec3 q = simplices.transform(data.point(v));
      TAUTLINE_CHECK(norm(q - x) >= norm(p - x) - 1e-12);
    }
    TAUTLINE_CHECK_NEAR(norm(surface.closest(p) - p), 0.0, 1e-12);
  }
}
}

TAUTLINE_TEST(TestPatch)
{
  for (CellType type : allTypes)
  {
    TAUTLINE_RUN(testBlocks(type));
  }
  TAUTLINE_RUN(testPatches<2>(CellType::Triangle));
  TAUTLINE_RUN(testPatches<2>(CellType::Quadrilateral));
  TAUTLINE_RUN(testPatches<3>(CellType::Tetrahedron));
  TAUTLINE_RUN(testPatches<3>(CellType::Hexahedron));
  TAUTLINE_RUN(testPatches<3>(CellType::Wedge));
  TAUTLINE_RUN(testPatches<3>(CellType::Pyramid));
  TAUTLINE_RUN(testEnergies<2>());
  TAUTLINE_RUN(testEnergies<3>());
}
