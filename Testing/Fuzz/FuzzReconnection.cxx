// SPDX-License-Identifier: BSD-3-Clause
// Random operations on meshes whose connectivity changes.

#include "FuzzTargets.h"
#include "ReconnectionSteps.h"

#include "Reconnection/Reconnecting.h"
#include "Reconnection/Triangulating.h"

#include "tautline/Reconnection/BoundaryFreedom.h"
#include "tautline/Reconnection/BoundarySurface.h"
#include "tautline/Reconnection/CavityOperations.h"
#include "tautline/Reconnection/TriangleOperations.h"

#include <iterator>
#include <map>
#include <set>

namespace tautline
{
namespace
{
constexpr double Rounding = 1e-12;
constexpr long FuzzAttempts = 400;
/// Triangles: contractions are preferred above this multiple of the first number.
constexpr double LargestGrowth = 1.5;

/// Area (of a planar mesh) and Euler's number: points less edges plus triangles.
struct TriangleTotals
{
  double area = 0;
  Index euler = 0;
};

TriangleTotals totalsOf(const TriangleMesh& mesh)
{
  TriangleTotals totals;
  Index sides = 0, borders = 0;
  for (TriId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; mesh.alive(t) && i < 3; ++i)
    {
      ++sides;
      borders += mesh.isBorder(t, i);
    }
    if (mesh.alive(t))
    {
      const Corners& v = mesh.triangle(t).vertices;
      const Vec3& a = mesh.point(v[0]);
      totals.area += 0.5 * cross(mesh.point(v[1]) - a, mesh.point(v[2]) - a)[2];
    }
  }
  Index points = 0;
  for (VertexId v = 0; v < mesh.pointSlots(); ++v)
  {
    points += mesh.used(v);
  }
  totals.euler = points - (sides + borders) / 2 + mesh.size();
  return totals;
}

TriangleInput inputOf(const MeshData& data, bool planar)
{
  TriangleInput input;
  input.planar = planar;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    input.points.push_back(data.point(i));
  }
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    Corners v;
    for (int k = 0; k < 3; ++k)
    {
      v[k] = static_cast<VertexId>(data.connectivity[3 * c + k]);
    }
    input.cells.push_back(v);
  }
  return input;
}

/// A mesh under random operations.
class TriangleSteps
{
public:
  TriangleSteps(const TriangleInput& input, Choices& choices)
    : Choose(choices)
    , Mesh(input.points, input.cells, {}, {}, input.planar)
    , Operations(this->Mesh, input)
    , First(totalsOf(this->Mesh))
    , FirstSize(this->Mesh.size())
  {
    this->Operations.smallestSize = 2;
    this->Operations.largestSize = 4 * this->FirstSize;
    this->Operations.freedoms.resize(this->Mesh.pointSlots());
    for (TriId t = 0; t < this->Mesh.slots(); ++t)
    {
      for (int i = 0; i < 3; ++i)
      {
        if (this->Mesh.isBorder(t, i))
        {
          this->fix(this->Mesh.triangle(t).vertices[Next[i]]);
        }
      }
    }
  }

  long run(long attempts)
  {
    long accepted = 0;
    for (long k = 0; k < attempts && this->Choose.left(); ++k)
    {
      const TriId t = this->Choose(this->Mesh.slots());
      if (!this->Mesh.alive(t))
      {
        continue;
      }
      accepted += this->Mesh.planar() && this->Choose(3) == 0 ? this->improve(t) : this->change(t);
      this->check();
    }
    return accepted;
  }

private:
  void fix(VertexId v) { this->Operations.freedoms[v].kind = PointFreedom::Fixed; }
  bool isFixed(VertexId v) const
  {
    return this->Operations.freedoms[v].kind == PointFreedom::Fixed;
  }

  void check() const
  {
    const std::string violation = this->Mesh.findViolation();
    expectThat(violation.empty(), "the mesh is consistent: " + violation);
    const TriangleTotals totals = totalsOf(this->Mesh);
    expectThat(totals.euler == this->First.euler, "Euler's number stays");
    expectThat(!this->Mesh.planar() ||
        std::abs(totals.area - this->First.area) <= Rounding * this->First.area,
      "the area stays");
  }

  /// An operation that is accepted if it is an improvement.
  bool improve(TriId t)
  {
    const int i = this->Choose(3), j = (i + 1 + this->Choose(2)) % 3;
    switch (this->Choose(4))
    {
      case 0:
        return this->Operations.flip(t, i);
      case 1:
        return this->Operations.smooth(this->Mesh.triangle(t).vertices[i], 2);
      case 2:
        return this->Operations.contract(t, i, j);
      default:
        return this->Operations.insert(t);
    }
  }

  /// Any operation that leaves all triangles positive; sometimes undone.
  bool change(TriId t)
  {
    const std::vector<PointFreedom> freedoms = this->Operations.freedoms;
    this->Mesh.begin();
    bool done = this->apply(t);
    std::vector<TriId> changed;
    std::vector<double> before;
    this->Mesh.compare(changed, before);
    for (TriId s : changed)
    {
      constexpr double Least = 1e-6; // so that the area is not lost in rounding
      done = done && this->Mesh.quality(s) > Least;
    }
    if (done && this->Choose(8) != 0)
    {
      this->Mesh.commit();
      return true;
    }
    this->Mesh.undo();
    this->Operations.freedoms = freedoms;
    return false;
  }

  bool apply(TriId t)
  {
    const int i = this->Choose(3), j = (i + 1 + this->Choose(2)) % 3;
    const Corners v = this->Mesh.triangle(t).vertices;
    const bool large = this->Mesh.size() > LargestGrowth * this->FirstSize;
    const int kind = large ? 3 + this->Choose(2) : this->Choose(6);
    if (kind == 0 || kind == 1)
    {
      return this->Mesh.flip(t, i);
    }
    if (kind == 2)
    {
      const Vec3 a = this->Mesh.point(v[Next[i]]), b = this->Mesh.point(v[Previous[i]]);
      const bool border = this->Mesh.isBorder(t, i);
      const VertexId p = this->Mesh.splitEdge(t, i, a + this->Choose.real(0.2, 0.8) * (b - a));
      this->add(p, border);
      return true;
    }
    if (kind == 3 || kind == 4)
    {
      return !this->isFixed(v[i]) && this->Mesh.contract(t, i, j);
    }
    const double s = this->Choose.real(0.1, 0.9), r = this->Choose.real(0.1, 0.9);
    const Vec3 x = this->Mesh.point(v[0]) +
      s *
        (this->Mesh.point(v[1]) - this->Mesh.point(v[0]) +
          r * (this->Mesh.point(v[2]) - this->Mesh.point(v[1])));
    if (this->Choose(2) == 0)
    {
      this->add(this->Mesh.splitTriangle(t, x), false);
      return true;
    }
    std::vector<TriId> around;
    this->Mesh.star(v[i], around);
    if (!this->isFixed(v[i]))
    {
      this->Mesh.movePoint(v[i], x, around);
    }
    return !this->isFixed(v[i]);
  }

  void add(VertexId p, bool fixed)
  {
    this->Operations.freedoms.resize(this->Mesh.pointSlots());
    this->Operations.freedoms[p] = PointFreedom();
    if (fixed)
    {
      this->fix(p);
    }
  }

  Choices& Choose;
  TriangleMesh Mesh;
  TriangleOperations Operations;
  TriangleTotals First;
  Index FirstSize;
};

double volumeOf(const TetrahedronMesh& mesh)
{
  double sum = 0.0;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    if (mesh.alive(t))
    {
      const TetVertices& v = mesh.tet(t).vertices;
      const Vec3& p = mesh.point(v[0]);
      sum += dot(cross(mesh.point(v[1]) - p, mesh.point(v[2]) - p), mesh.point(v[3]) - p) / 6.0;
    }
  }
  return sum;
}

/// Moves a point to a place in one of its tetrahedra, if all of them stay positive.
bool shake(TetrahedronMesh& mesh, const CavityOperations& operations, TetId t, Choices& choices)
{
  const TetVertices v = mesh.tet(t).vertices;
  const int i = choices(4);
  if (operations.freedoms.size() <= static_cast<std::size_t>(v[i]) ||
    operations.freedoms[v[i]].kind != PointFreedom::Free)
  {
    return false;
  }
  Vec3 x = mesh.point(v[i]);
  const Vec3 start = x;
  for (int k = 0; k < 4; ++k)
  {
    x += choices.real(0.0, 0.3) * (mesh.point(v[k]) - start);
  }
  std::vector<TetId> star;
  mesh.star(v[i], star);
  mesh.movePoint(v[i], x, star, nullptr);
  constexpr double Least = 1e-6;
  if (std::all_of(star.begin(), star.end(), [&](TetId s) { return mesh.quality(s) > Least; }))
  {
    return true;
  }
  mesh.movePoint(v[i], start, star, nullptr);
  return false;
}

bool operate(CavityOperations& operations, TetrahedronMesh& mesh, TetId t, Choices& choices)
{
  using Compound = CavityOperations::Compound;
  const int i = choices(4), j = (i + 1 + choices(3)) % 4;
  switch (choices(12))
  {
    case 0:
    case 1:
      return operations.removeEdge(t, i, j);
    case 2:
      return operations.removeFaces(t, i);
    case 3:
      return operations.contract(t, i, j);
    case 4:
      return operations.insert(t);
    case 5:
      return operations.tryCompound(t, Compound::Swap);
    case 6:
      return operations.tryCompound(t, Compound::Insertion);
    case 7:
      return operations.tryCompound(t, Compound::Contraction);
    case 8:
      return operations.smooth(mesh.tet(t).vertices[i], 2);
    default:
      return shake(mesh, operations, t, choices);
  }
}

/// The outer boundary: its area, points less edges plus facets, and whether each edge has two.
struct BoundaryTotals
{
  double area = 0;
  Index euler = 0;
  bool closed = true;
};

BoundaryTotals boundaryOf(const TetrahedronMesh& mesh)
{
  std::map<std::array<PointId, 2>, int> edges;
  std::set<PointId> points;
  BoundaryTotals totals;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; mesh.alive(t) && i < 4; ++i)
    {
      if (mesh.tet(t).neighbors[i] != NoId)
      {
        continue;
      }
      const TriangleVertices f = mesh.face(t, i);
      const Vec3& a = mesh.point(f[0]);
      totals.area += 0.5 * norm(cross(mesh.point(f[1]) - a, mesh.point(f[2]) - a));
      ++totals.euler;
      for (int k = 0; k < 3; ++k)
      {
        ++edges[{ std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3]) }];
        points.insert(f[k]);
      }
    }
  }
  totals.euler += static_cast<Index>(points.size()) - static_cast<Index>(edges.size());
  totals.closed =
    std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 2; });
  return totals;
}

/// A mesh of tetrahedra under random operations, with what its boundary keeps to.
class TetrahedronSteps
{
public:
  TetrahedronSteps(const MeshData& data, BoundaryMotion boundary, Choices& choices)
    : Choose(choices)
    , Changing(pointsOf(data), cellsOf(data))
    , Operations(this->Changing)
  {
    ReconnectionOptions options;
    options.boundary = boundary;
    this->Operations.flatTolerance = std::sin(options.flatAngle * (Pi / 180.0));
    this->Operations.swapsBoundary = boundary != BoundaryMotion::Fixed;
    if (boundary == BoundaryMotion::OnSurface)
    {
      const Mesh mesh(data.view());
      this->Operations.surface = std::make_shared<BoundarySurface>(mesh, this->Changing, options);
      this->Operations.freedoms = this->Operations.surface->freedoms();
      this->Distance = options.surfaceTolerance * diagonalOf(data);
    }
    else
    {
      this->Operations.freedoms = findFreedoms(
        this->Changing, boundary == BoundaryMotion::FlatParts, this->Operations.flatTolerance);
    }
    this->Operations.smallestSize = this->Changing.size() / 2;
    this->Operations.largestSize = 2 * this->Changing.size();
    this->Operations.prepareStamps();
    this->Volume = volumeOf(this->Changing);
    this->First = boundaryOf(this->Changing);
  }

  long run(long attempts)
  {
    long accepted = 0;
    for (long k = 0; k < attempts && this->Choose.left(); ++k)
    {
      const TetId t = this->Choose(this->Changing.slots());
      if (this->Changing.alive(t) && operate(this->Operations, this->Changing, t, this->Choose))
      {
        ++accepted;
        this->check();
      }
    }
    return accepted;
  }

private:
  static std::vector<Vec3> pointsOf(const MeshData& data)
  {
    std::vector<Vec3> points;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      points.push_back(data.point(i));
    }
    return points;
  }

  static std::vector<TetVertices> cellsOf(const MeshData& data)
  {
    std::vector<TetVertices> cells;
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      TetVertices v;
      for (int k = 0; k < 4; ++k)
      {
        v[k] = static_cast<PointId>(data.connectivity[4 * c + k]);
      }
      cells.push_back(v);
    }
    return cells;
  }

  static double diagonalOf(const MeshData& data)
  {
    Vec3 low = data.point(0), high = low;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        low[k] = std::min(low[k], data.point(i)[k]);
        high[k] = std::max(high[k], data.point(i)[k]);
      }
    }
    return norm(high - low);
  }

  void check() const
  {
    const std::string violation = this->Changing.findViolation();
    expectThat(violation.empty(), "the mesh is consistent: " + violation);
    const BoundaryTotals now = boundaryOf(this->Changing);
    expectThat(now.closed && now.euler == this->First.euler, "the boundary stays closed");
    // A boundary that moves by at most the distance sweeps at most so much, on either side.
    const double swept = this->Distance * (now.area + this->First.area);
    expectThat(std::abs(volumeOf(this->Changing) - this->Volume) <= swept + Rounding * this->Volume,
      "the volume stays");
  }

  Choices& Choose;
  TetrahedronMesh Changing;
  CavityOperations Operations;
  double Distance = 0, Volume = 0;
  BoundaryTotals First;
};
}

//------------------------------------------------------------------------------
long changeTriangles(Choices& choices, long attempts)
{
  const int kind = choices(4);
  const MeshData data = kind == 0 ? sphereSurface(CellType::Triangle, 2)
    : kind == 1                   ? cubeSurface(CellType::Triangle, 2)
                                  : sliverSheet(5, 1 + choices.next() % 1000);
  const TriangleInput input = inputOf(data, kind > 1);
  return TriangleSteps(input, choices).run(attempts);
}

long changeTetrahedra(Choices& choices, long attempts)
{
  MeshData data = sliverBlock(3, 1 + choices.next() % 1000, 0.9);
  data.transform([](const Vec3& p) { return (1.0 / 4.0) * p; });
  return TetrahedronSteps(data, BoundaryMotion::Fixed, choices).run(attempts);
}

long changeSliding(Choices& choices, long attempts)
{
  MeshData data = sliverBlock(3, 1 + choices.next() % 1000, 0.9);
  data.transform([](const Vec3& p) { return (1.0 / 4.0) * p; });
  return TetrahedronSteps(data, BoundaryMotion::FlatParts, choices).run(attempts);
}

long changeSurface(Choices& choices, long attempts)
{
  constexpr Index Cubes = 4;
  const int directions = 2 + choices(2); // a cylinder or a ball
  const MeshData data = roundMesh(directions, 1 + choices.next() % 1000, Cubes);
  return TetrahedronSteps(data, BoundaryMotion::OnSurface, choices).run(attempts);
}

void fuzzReconnection(std::string_view bytes)
{
  ByteReader input(bytes);
  Choices choices = { [&] { return input.next<std::uint16_t>() * 65537U; },
    [&] { return !input.atEnd(); } };
  constexpr long (*changes[])(
    Choices&, long) = { changeTriangles, changeTetrahedra, changeSliding, changeSurface };
  changes[choices(static_cast<int>(std::size(changes)))](choices, FuzzAttempts);
}
}
