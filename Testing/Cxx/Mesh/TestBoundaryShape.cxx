// SPDX-License-Identifier: BSD-3-Clause
// Which points of a boundary may slide, and where.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Mesh/BoundaryShape.h"

using namespace tautline;

namespace
{
Vec3 at(const std::vector<double>& values, Index i)
{
  return { values[3 * i], values[3 * i + 1], values[3 * i + 2] };
}

/// A cube: faces slide in their plane, edges along themselves, eight corners stay.
TAUTLINE_PART(testCube)
{
  for (CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const Context context(topology(type).name);
    const MeshData data = blockMesh(type, 4, 4, 4);
    const BoundaryShape shape = boundaryShape(Mesh(data.view()), 1);
    TAUTLINE_CHECK_EQUAL(shape.inPlanes, 6 * 9);
    TAUTLINE_CHECK_EQUAL(shape.onLines, 12 * 3);
    Index corners = 0;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      corners += shape.fixed[i];
      const Vec3 p = data.point(i), plane = at(shape.planes, i), line = at(shape.lines, i);
      int on = 0;
      for (int c = 0; c < 3; ++c)
      {
        const bool flush = p[c] == 0 || p[c] == 4;
        on += flush;
        if (norm(plane) > 0)
        {
          TAUTLINE_CHECK_NEAR(std::abs(plane[c]), flush ? 1 : 0, 1e-14);
        }
        if (norm(line) > 0)
        {
          TAUTLINE_CHECK_NEAR(std::abs(line[c]), flush ? 0 : 1, 1e-14);
        }
      }
      TAUTLINE_CHECK_EQUAL(int(norm(plane) > 0), int(on == 1));
      TAUTLINE_CHECK_EQUAL(int(norm(line) > 0), int(on == 2));
    }
    TAUTLINE_CHECK_EQUAL(corners, 8);
  }
}

/// A top that bends by 1.1 degrees at each row of points: folds at 1 degree, flat at 5.
TAUTLINE_PART(testAngle)
{
  MeshData data = blockMesh(CellType::Hexahedron, 3, 3, 3);
  data.transform(TAUTLINE_PLACE(p[0], p[1], p[2] + 0.01 * p[0] * p[0]));
  const Mesh mesh(data.view());
  const Index top = 1 + 4 * (1 + 4 * 3);
  TAUTLINE_CHECK_EQUAL(int(boundaryShape(mesh, 1).fixed[top]), 0); // 1.1 degrees: along the fold
  TAUTLINE_CHECK_NEAR(std::abs(at(boundaryShape(mesh, 1).lines, top)[1]), 1, 1e-12);
  TAUTLINE_CHECK_NEAR(norm(at(boundaryShape(mesh, 5).planes, top)), 1, 1e-12);
  TAUTLINE_CHECK_THROWS(boundaryShape(mesh, -1), wording("between-0-and-90"));
  TAUTLINE_CHECK_THROWS(boundaryShape(mesh, std::nan("")), wording("between-0-and-90"));
}

/// A square: the sides slide along themselves, inner points are free, corners stay.
TAUTLINE_PART(testFlat)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    MeshData data = blockMesh(type, 3, 3, 0);
    const BoundaryShape shape = boundaryShape(Mesh(data.view()), 1);
    TAUTLINE_CHECK_EQUAL(shape.onLines, 8);
    TAUTLINE_CHECK_EQUAL(shape.inPlanes, 0);
    TAUTLINE_CHECK_EQUAL(std::count(shape.fixed.begin(), shape.fixed.end(), 1), 4);
    TAUTLINE_CHECK_NEAR(std::abs(at(shape.lines, 1)[0]), 1, 1e-14);
    TAUTLINE_CHECK_EQUAL(int(shape.fixed[5]), 0);
    TAUTLINE_CHECK_EQUAL(norm(at(shape.lines, 5)), 0);
  }
}

/// A disk of a square: its rim is smooth at 30 degrees except at the corners, at 60 everywhere.
TAUTLINE_PART(testSmooth)
{
  MeshData disk = blockMesh(CellType::Triangle, 16, 16, 0);
  const auto onRim = Mesh(disk.view()).boundary().isBoundaryPoint;
  disk.transform(
    [](const Vec3& p)
    {
      const double x = p[0] / 8 - 1, y = p[1] / 8 - 1;
      return Vec3{ x * std::sqrt(1 - y * y / 2), y * std::sqrt(1 - x * x / 2), 0 };
    });
  const BoundaryShape none = boundaryShape(Mesh(disk.view()), 1);
  TAUTLINE_CHECK_EQUAL(none.onSurface, 0);
  const BoundaryShape rim = boundaryShape(Mesh(disk.view()), 1, 60);
  TAUTLINE_CHECK_EQUAL(rim.onSurface, 64);
  TAUTLINE_CHECK_EQUAL(std::count(rim.fixed.begin(), rim.fixed.end(), 1), 0);
  TAUTLINE_EACH(
    Index, i, disk.numberOfPoints(), TAUTLINE_CHECK_EQUAL(int(rim.surface[i]), int(onRim[i])));
  // A cube has planes and straight sharp edges only; bent a little, its top is smooth.
  const MeshData cube = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  const BoundaryShape sharp = boundaryShape(Mesh(cube.view()), 1, 60);
  TAUTLINE_CHECK_EQUAL(sharp.onSurface, 0);
  TAUTLINE_CHECK_EQUAL(sharp.inPlanes, 54);
  TAUTLINE_CHECK_EQUAL(sharp.onLines, 36);
  MeshData bent = cube;
  bent.transform(TAUTLINE_PLACE(p[0], p[1], p[2] + 0.02 * p[0] * p[0] * p[2]));
  const BoundaryShape smooth = boundaryShape(Mesh(bent.view()), 1, 60);
  TAUTLINE_CHECK_EQUAL(smooth.onSurface, 9);
  TAUTLINE_CHECK_THROWS(boundaryShape(Mesh(cube.view()), 1, -5), wording("between-0-and-180"));
}

/// A ring (of volume cells, a thick one) of this many edges around, whose inner points are at the
/// radius 1 and whose outer ones are at 2.
MeshData ring(CellType type, Index around)
{
  const bool flat = topology(type).dimension == 2;
  const MeshData block = blockMesh(type, around, 2, flat ? 0 : 2);
  MeshData data;
  const auto number = [around](Index p)
  { return p / (around + 1) * around + p % (around + 1) % around; };
  for (Index p = 0; p < block.numberOfPoints(); ++p)
  {
    const Vec3 x = block.point(p);
    if (p % (around + 1) < around)
    {
      const double angle = -2 * Pi * x[0] / static_cast<double>(around), r = 1 + 0.5 * x[1];
      data.addPoint({ r * std::cos(angle), r * std::sin(angle), x[2] });
    }
  }
  for (Index c = 0; c < block.numberOfCells(); ++c)
  {
    std::vector<Index> nodes;
    for (Index n = block.offsets[c]; n < block.offsets[c + 1]; ++n)
    {
      nodes.push_back(number(block.connectivity[n]));
    }
    data.addCell(static_cast<int>(block.types[c]), nodes);
  }
  return data;
}

/// Fine circles bend by half a degree at each point, but are not straight: nothing slides along
/// their tangents. On the flat ends of a thick ring points slide.
TAUTLINE_PART(testFineCircle)
{
  constexpr Index around = 720;
  for (CellType type : { CellType::Triangle, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    const MeshData data = ring(type, around);
    const Mesh mesh(data.view());
    const BoundaryShape shape = boundaryShape(mesh, 1);
    TAUTLINE_CHECK_EQUAL(shape.onLines, 0);
    TAUTLINE_CHECK_EQUAL(shape.inPlanes, flat ? 0 : 2 * around);
    TAUTLINE_CHECK_EQUAL(
      std::count(shape.fixed.begin(), shape.fixed.end(), 1), (flat ? 2 : 6) * around);
    TAUTLINE_EACH_OF(double value, shape.lines, TAUTLINE_CHECK_EQUAL(value, 0));
    const BoundaryShape smooth = boundaryShape(mesh, 1, 60);
    TAUTLINE_CHECK_EQUAL(smooth.onSurface, 2 * around);
  }
}

/// A side that is straight at first and then a fine arc, and one that is rough by less than the
/// tolerance: the straight and the rough points slide, the points of the arc do not.
TAUTLINE_PART(testBentSide)
{
  constexpr Index n = 400, straight = 200;
  MeshData data = blockMesh(CellType::Quadrilateral, n, 1, 0);
  constexpr double radius = 200, rough = 2e-4;
  data.transform(
    [](const Vec3& p)
    {
      if (p[1] == 0)
      {
        return Vec3{ p[0], p[1] + rough * (static_cast<Index>(p[0]) % 2), 0 };
      }
      const double angle = std::max(0.0, p[0] - straight) / radius;
      return angle > 0
        ? Vec3{ straight + radius * std::sin(angle), 1 + radius * (1 - std::cos(angle)), 0 }
        : p;
    });
  const BoundaryShape shape = boundaryShape(Mesh(data.view()), 1);
  for (Index i = 1; i < n; ++i)
  {
    TAUTLINE_CHECK_EQUAL(int(norm(at(shape.lines, i)) > 0), 1);
    TAUTLINE_CHECK_EQUAL(int(norm(at(shape.lines, n + 1 + i)) > 0), int(i < straight));
  }
  TAUTLINE_CHECK_EQUAL(shape.onLines, n - 1 + straight - 1);
}

/// Three cells at one edge, a sheet without thickness, an edge without length: nothing slides.
TAUTLINE_PART(testFaulty)
{
  TAUTLINE_LET(MeshData, fan,
    addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1, 0 }, { 0.5, -1, 0 }, { 0.5, 0, 1 } }),
    addCell(CellType::Triangle, { 0, 1, 2 }), addCell(CellType::Triangle, { 1, 0, 3 }),
    addCell(CellType::Triangle, { 0, 1, 4 }));
  const BoundaryShape shape = boundaryShape(Mesh(fan.view()), 1);
  TAUTLINE_CHECK_EQUAL(std::count(shape.fixed.begin(), shape.fixed.end(), 1), 5);

  MeshData collapsed = blockMesh(CellType::Triangle, 3, 1, 0);
  collapsed.setPoint(1, collapsed.point(0));
  const BoundaryShape none = boundaryShape(Mesh(collapsed.view()), 1);
  TAUTLINE_CHECK_EQUAL(int(none.fixed[0]), 1);
  TAUTLINE_CHECK_EQUAL(int(none.fixed[1]), 1);
  TAUTLINE_EACH_OF(double value, none.lines, TAUTLINE_CHECK(std::isfinite(value)));
}
}
