// SPDX-License-Identifier: BSD-3-Clause
// Validity between the corners of hexahedra and wedges, and of pyramids: against dense samples of
// the determinant, in any frame and numbering, at the limits; the minimum.
#include "Registry.h"
#include "VtkMeshes.h"

#include <filesystem>

using namespace tautline;

namespace
{
constexpr CellType solidTypes[] = { CellType::Hexahedron, CellType::Wedge, CellType::Pyramid };

/// The map of an element, written again: a pyramid's is B(u, v) + w (apex - B(u, v)).
Vec3 mapAt(CellType type, const std::vector<Vec3>& p, const Vec3& x)
{
  const double u = x[0], v = x[1], w = x[2];
  if (type == CellType::Wedge)
  {
    const Vec3 low = (1 - u - v) * p[0] + v * p[1] + u * p[2];
    const Vec3 high = (1 - u - v) * p[3] + v * p[4] + u * p[5];
    return low + w * (high - low);
  }
  const auto square = [&](int k)
  {
    return ((1 - u) * (1 - v)) * p[k] + (u * (1 - v)) * p[k + 1] + (u * v) * p[k + 2] +
      ((1 - u) * v) * p[k + 3];
  };
  const Vec3 low = square(0), high = type == CellType::Pyramid ? p[4] : square(4);
  return low + w * (high - low);
}

/// The determinant, by differences of the map, exact where it is linear; of a pyramid at its base.
double determinantAt(CellType type, const std::vector<Vec3>& p, const Vec3& at)
{
  Vec3 d[3];
  for (int a = 0; a < 3; ++a)
  {
    Vec3 low = at, high = at;
    low[a] = 0;
    high[a] = 1;
    d[a] = mapAt(type, p, high) - mapAt(type, p, low);
  }
  return dot(d[0], cross(d[1], d[2]));
}

/// The smallest of n^3 samples, brought down by a search along the axes with ever shorter steps.
double sampledMinimum(CellType type, const std::vector<Vec3>& p, int n)
{
  const bool wedge = type == CellType::Wedge, pyramid = type == CellType::Pyramid;
  const auto inside = [&](const Vec3& x)
  {
    return x[0] >= 0 && x[1] >= 0 && x[2] >= 0 && x[2] <= 1 &&
      (wedge ? x[0] + x[1] <= 1 : x[0] <= 1 && x[1] <= 1);
  };
  double least = HUGE_VAL;
  Vec3 best = { 0, 0, 0 };
  for (int k = 0; k <= (pyramid ? 0 : n); ++k)
  {
    for (int j = 0; j <= n; ++j)
    {
      for (int i = 0; i <= n; ++i)
      {
        const Vec3 at = { double(i) / n, double(j) / n, double(k) / n };
        const double det = inside(at) ? determinantAt(type, p, at) : HUGE_VAL;
        best = det < least ? at : best;
        least = std::min(least, det);
      }
    }
  }
  for (double step = 0.5 / n; step > 1e-7; step *= 0.5)
  {
    for (bool moved = true; moved;)
    {
      moved = false;
      for (int direction = 0; direction < 26; ++direction)
      {
        const int code = direction < 13 ? direction : direction + 1;
        const Vec3 to = best +
          step *
            Vec3{ double(code % 3 - 1), double(code / 3 % 3 - 1),
              pyramid ? 0.0 : double(code / 9 - 1) };
        const double det = inside(to) ? determinantAt(type, p, to) : HUGE_VAL;
        if (det < least)
        {
          least = det;
          best = to;
          moved = true;
        }
      }
    }
  }
  return least;
}

signed char verdictOn(CellType type, const std::vector<Vec3>& corners)
{
  return validityOf(singleCell(type, corners))[0];
}

bool cornersPositive(CellType type, const std::vector<Vec3>& corners)
{
  const std::vector<double> sines = cornerSines(type, corners);
  return std::all_of(sines.begin(), sines.end(), [](double s) { return s > 0; });
}

/// Elements with valid corners that are folded inside.
std::vector<std::vector<Vec3>> foldedCells(CellType type, int count, Random& random)
{
  std::vector<std::vector<Vec3>> found;
  while (static_cast<int>(found.size()) < count)
  {
    const std::vector<Vec3> p = perturbedCell(type, 0.8, random);
    if (cornersPositive(type, p) && sampledMinimum(type, p, 6) < -0.01)
    {
      found.push_back(p);
    }
  }
  return found;
}

//------------------------------------------------------------------------------
/// Verdict and metric agree with samples.
TAUTLINE_PART(testSamples)
{
  constexpr int cells = 400, fine = 50, coarse = 16;
  for (CellType type : solidTypes)
  {
    const Context context(topology(type).name);
    Random random(3);
    int folded = 0, valid = 0, bent = 0;
    for (int i = 0; i < cells; ++i)
    {
      const Context which("cell " + std::to_string(i));
      const std::vector<Vec3> p = perturbedCell(type, random.uniform(0.1, 0.9), random);
      const double sampled = sampledMinimum(type, p, i % 20 == 0 ? fine : coarse);
      const double minimum = valueOf(type, p, Metric::MinimumJacobian);
      TAUTLINE_CHECK_NEAR(minimum, sampled, 1e-9);
      if (std::abs(sampled) > 1e-9)
      {
        TAUTLINE_CHECK_EQUAL(int(verdictOn(type, p)), int(sampled > 0 ? Valid : Inverted));
      }
      double corner = HUGE_VAL;
      for (const auto& n : topology(type).cornerNodes)
      {
        const Vec3 a = p[n[1]] - p[n[0]], b = p[n[2]] - p[n[0]], c = p[n[3]] - p[n[0]];
        corner = n[1] == n[2] ? corner : std::min(corner, dot(cross(a, b), c));
      }
      valid += sampled > 0;
      bent += sampled > 0 && sampled < corner - 1e-6;
      folded += sampled < -1e-9 && corner > 0;
    }
    // A pyramid's determinant is smallest at a corner.
    const bool inside = type != CellType::Pyramid;
    TAUTLINE_CHECK(valid > cells / 8);
    TAUTLINE_CHECK_EQUAL(bent > 0, inside);
    TAUTLINE_CHECK_EQUAL(folded > 0, inside);
  }
}

/// A folded element is found in every numbering, size and place, and in the mirror.
TAUTLINE_PART(testFrames)
{
  for (CellType type : solidTypes)
  {
    const Context context(topology(type).name);
    Random random(5);
    const int half = type == CellType::Pyramid ? 0 : 20;
    std::vector<std::vector<Vec3>> cells = foldedCells(type, half, random);
    for (int i = 0; i < 20; ++i)
    {
      cells.push_back(validCell(type, 0.1, 0.3, random));
    }
    for (const std::vector<Vec3>& cell : cells)
    {
      const int verdict = verdictOn(type, cell);
      TAUTLINE_CHECK_EQUAL(verdict, int(&cell < &cells[half] ? Inverted : Valid));
      const Columns turn = randomRotation(random);
      for (double scale : { 1e-8, 1.0, 1e8 })
      {
        std::vector<Vec3> moved = cell;
        for (Vec3& p : moved)
        {
          p = scale * (turn * p);
        }
        TAUTLINE_CHECK_EQUAL(int(verdictOn(type, moved)), verdict);
      }
      std::vector<Vec3> far = cell, mirrored = cell;
      for (std::size_t k = 0; k < cell.size(); ++k)
      {
        far[k] += Vec3{ 1e6, -1e6, 1e6 };
        mirrored[k][1] *= -1;
      }
      TAUTLINE_CHECK_EQUAL(int(verdictOn(type, far)), verdict);
      const MeshData data = singleCell(type, mirrored);
      Mesh mesh(data.view());
      mesh.setMirrored(true);
      TAUTLINE_CHECK_EQUAL(int(validityOf(mesh)[0]), verdict);
      TAUTLINE_CHECK_RELATIVE(valuesOf(mesh, Metric::MinimumJacobian)[0],
        valueOf(type, cell, Metric::MinimumJacobian), 1e-9);
    }
  }
}

/// The 24 rotations of a cube, as permutations of VTK's nodes.
std::vector<std::vector<int>> cubeRotations()
{
  constexpr int turnZ[8] = { 1, 2, 3, 0, 5, 6, 7, 4 }, turnX[8] = { 3, 2, 6, 7, 0, 1, 5, 4 };
  std::vector<std::vector<int>> all = { { 0, 1, 2, 3, 4, 5, 6, 7 } };
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    for (const auto& turn : { turnZ, turnX })
    {
      auto next = collect<int>(8, [&](int k) { return all[i][turn[k]]; });
      if (std::find(all.begin(), all.end(), next) == all.end())
      {
        all.push_back(next);
      }
    }
  }
  return all;
}

TAUTLINE_PART(testNumberings)
{
  const auto rotations = cubeRotations();
  TAUTLINE_CHECK_EQUAL(rotations.size(), 24u);
  Random random(7);
  for (int i = 0; i < 200; ++i)
  {
    const std::vector<Vec3> cell = perturbedCell(CellType::Hexahedron, 0.4, random);
    const double minimum = valueOf(CellType::Hexahedron, cell, Metric::MinimumJacobian);
    for (const std::vector<int>& rotation : rotations)
    {
      auto turned = collect<Vec3>(8, [&](int k) { return cell[rotation[k]]; });
      TAUTLINE_CHECK_EQUAL(
        int(verdictOn(CellType::Hexahedron, turned)), int(verdictOn(CellType::Hexahedron, cell)));
      TAUTLINE_CHECK_NEAR(
        valueOf(CellType::Hexahedron, turned, Metric::MinimumJacobian), minimum, 1e-10);
    }
  }
}

//------------------------------------------------------------------------------
/// The top turned about the axis: with R(w) the mean of the turns, det = |R|^2, which is 1 at the
/// corners and falls to cos^2(angle / 2) half way up: 0 at half a turn, negative nowhere.
TAUTLINE_PART(testTwists)
{
  for (CellType type : { CellType::Hexahedron, CellType::Wedge })
  {
    const Context context(topology(type).name);
    const double half = std::acos(-1.0);
    for (double angle : { 0.5 * half, 0.9 * half, 0.999 * half, half })
    {
      std::vector<Vec3> p = idealCell(type);
      const std::size_t base = p.size() / 2;
      const Vec3 center = { 0.5, 0.4, 0 };
      for (std::size_t k = base; k < p.size(); ++k)
      {
        p[k] = center + rotation({ 0, 0, 1 }, angle) * (p[k] - center);
      }
      const double c = std::cos(0.5 * angle);
      const double corner = type == CellType::Hexahedron ? 1 : std::sqrt(0.75);
      TAUTLINE_CHECK_NEAR(valueOf(type, p, Metric::MinimumJacobian), corner * c * c, 1e-12);
      TAUTLINE_CHECK_EQUAL(int(verdictOn(type, p)), int(angle < half ? Valid : Degenerate));
    }
  }
}

/// Properties of a parallelepiped and a simplex; collapsed elements are degenerate, not inverted.
TAUTLINE_PART(testKnownValues)
{
  const Columns shear = { Vec3{ 2, 0, 0 }, { 1, 3, 0 }, { 0.5, -1, 0.7 } };
  const double volume = 2 * 3 * 0.7;
  const std::vector<Vec3> cube = idealCell(CellType::Hexahedron);
  const auto sheared = [&](const std::vector<int>& nodes)
  { return collect<Vec3>(nodes, [&](int n) { return shear * cube[n]; }); };
  const Metric metric = Metric::MinimumJacobian;
  TAUTLINE_CHECK_RELATIVE(
    valueOf(CellType::Hexahedron, sheared({ 0, 1, 2, 3, 4, 5, 6, 7 }), metric), volume, 1e-14);
  TAUTLINE_CHECK_RELATIVE(
    valueOf(CellType::Wedge, sheared({ 0, 3, 1, 4, 7, 5 }), metric), volume, 1e-14);
  TAUTLINE_CHECK_RELATIVE(
    valueOf(CellType::Pyramid, sheared({ 0, 1, 2, 3, 4 }), metric), volume, 1e-14);
  TAUTLINE_CHECK_RELATIVE(
    valueOf(CellType::Tetrahedron, sheared({ 0, 1, 3, 4 }), metric), volume, 1e-14);
  TAUTLINE_CHECK_RELATIVE(valueOf(CellType::Quadrilateral,
                            { { 0, 0, 0 }, { 2, 0, 0 }, { 3, 3, 0 }, { 1, 3, 0 } }, metric),
    6, 1e-14);
  TAUTLINE_CHECK_RELATIVE(
    valueOf(CellType::Triangle, { { 0, 0, 0 }, { 2, 0, 0 }, { 1, 3, 0 } }, metric), 6, 1e-14);
  // An edge or a face of a hexahedron drawn together.
  std::vector<Vec3> edge = cube, face = cube;
  edge[1] = edge[0];
  face[5] = face[6] = face[7] = face[4];
  TAUTLINE_CHECK_EQUAL(int(verdictOn(CellType::Hexahedron, edge)), int(Degenerate));
  TAUTLINE_CHECK_EQUAL(int(verdictOn(CellType::Hexahedron, face)), int(Degenerate));
  // One that is much smaller at one corner is as valid as its corners.
  std::vector<Vec3> graded = cube;
  for (int k : { 1, 3, 4 })
  {
    graded[k] = 1e-4 * graded[k];
  }
  const double minimum = sampledMinimum(CellType::Hexahedron, graded, 20);
  TAUTLINE_CHECK_EQUAL(
    int(verdictOn(CellType::Hexahedron, graded)), int(minimum > 0 ? Valid : Inverted));
}

//------------------------------------------------------------------------------
/// Hexahedral meshes with elements that are valid at the corners only.
void testFiles(const std::string& directory)
{
  for (const char* name : { "CAD4", "CAD4Per", "rkm012", "lower_arm" })
  {
    const Context context(name);
    const std::string file = directory + "/" + name + ".vtk";
    if (!TAUTLINE_CHECK(std::filesystem::exists(file)))
    {
      continue;
    }
    const MeshData data = toMesh(readGrid(file));
    const std::vector<signed char> validity = validityOf(data);
    const std::vector<double> minimum = valuesOf(data, Metric::MinimumJacobian);
    Index invalid = 0, folded = 0;
    for (Index cell = 0; cell < data.numberOfCells(); ++cell)
    {
      std::vector<Vec3> p;
      for (Index n = data.offsets[cell]; n < data.offsets[cell + 1]; ++n)
      {
        p.push_back(data.point(data.connectivity[n]));
      }
      const double sampled = sampledMinimum(CellType::Hexahedron, p, 6);
      TAUTLINE_CHECK((sampled > 0) == (validity[cell] == Valid));
      TAUTLINE_CHECK((sampled > 0) == (minimum[cell] > 0));
      invalid += validity[cell] != Valid;
      folded += validity[cell] != Valid && cornersPositive(CellType::Hexahedron, p);
    }
    std::cout << name << ": " << data.numberOfCells() << " hexahedra, " << invalid << " invalid, "
              << folded << " of them between valid corners\n";
  }
}
}

// Meshes that are not part of the repository.
TAUTLINE_TEST(TestExactValidityFiles)
{
  testFiles(externalData("hex"));
}
