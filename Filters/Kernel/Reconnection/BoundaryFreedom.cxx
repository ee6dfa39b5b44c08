// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFreedom.h"

#include "tautline/Core/Interruption.h"

namespace tautline
{
namespace
{
/// The planes of the walls at a point.
struct WallPlanes
{
  int count = 0; ///< 3: more than two
  Vec3 normals[2];

  void add(const Vec3& n, double tolerance)
  {
    for (int i = 0; i < std::min(this->count, 2); ++i)
    {
      if (norm(cross(this->normals[i], n)) <= tolerance)
      {
        return;
      }
    }
    if (this->count < 2)
    {
      this->normals[this->count] = n;
    }
    this->count = std::min(this->count + 1, 3);
  }
};
}

void keepBorders(const TetrahedronMesh& mesh, const std::vector<std::int32_t>& classes,
  double tolerance, std::vector<PointFreedom>& freedoms)
{
  if (!mesh.hasLabels())
  {
    return;
  }
  // The walls at each edge, by their third points; interior walls are listed from both sides.
  using Entry = std::array<std::int32_t, 4>;
  std::vector<Entry> walls;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    pollInterruption(t);
    for (int i = 0; i < 4 && mesh.alive(t); ++i)
    {
      if (mesh.isWall(t, i))
      {
        TriangleVertices f = mesh.face(t, i);
        std::sort(f.begin(), f.end());
        const std::int32_t kind = mesh.label(t, i) == NoLabel ? 0 : classes[mesh.label(t, i)];
        walls.insert(walls.end(),
          { { f[0], f[1], f[2], kind }, { f[0], f[2], f[1], kind }, { f[1], f[2], f[0], kind } });
      }
    }
  }
  std::sort(walls.begin(), walls.end());
  walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
  const auto restrict = [&](PointId v, const Vec3& direction)
  {
    PointFreedom& freedom = freedoms[v];
    // A point in a plane may still slide along a border; a second border in another direction fixes
    // it.
    if (freedom.kind == PointFreedom::InPlane && !freedom.isCurved())
    {
      freedom = { PointFreedom::OnLine, direction };
    }
    else if (freedom.isCurved() || norm(cross(freedom.direction, direction)) > tolerance)
    {
      freedom.fix();
    }
  };
  for (auto first = walls.begin(); first != walls.end();)
  {
    const auto [a, b, third, kind] = *first;
    const auto last = std::find_if(
      first, walls.end(), [a = a, b = b](const Entry& e) { return e[0] != a || e[1] != b; });
    // An edge is part of a border if it has a single wall or walls of different classes.
    const bool differs =
      std::any_of(first, last, [kind = kind](const Entry& e) { return e[3] != kind; });
    if (differs || last - first == 1)
    {
      const Vec3 e = mesh.point(b) - mesh.point(a);
      restrict(a, (1.0 / norm(e)) * e);
      restrict(b, (1.0 / norm(e)) * e);
    }
    first = last;
  }
}

std::vector<char> nonManifoldPoints(TetrahedronMesh& mesh)
{
  std::vector<std::int32_t> uses(mesh.pointSlots(), 0);
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    pollInterruption(t);
    for (PointId v : mesh.tet(t).vertices)
    {
      ++uses[v];
    }
  }
  std::vector<char> flags(mesh.pointSlots(), 0);
  std::vector<TetId> star;
  for (PointId v = 0; v < mesh.pointSlots(); ++v)
  {
    pollInterruption(v);
    if (mesh.used(v))
    {
      // star() walks across faces: at a non-manifold point, it misses a part of the tetrahedra.
      mesh.star(v, star);
      flags[v] = static_cast<std::int32_t>(star.size()) != uses[v];
    }
  }
  return flags;
}

void fixNonManifold(TetrahedronMesh& mesh, std::vector<PointFreedom>& freedoms)
{
  const std::vector<char> flags = nonManifoldPoints(mesh);
  for (std::size_t v = 0; v < flags.size(); ++v)
  {
    if (flags[v] && freedoms[v].kind != PointFreedom::Fixed)
    {
      freedoms[v].fix();
    }
  }
}

std::vector<PointFreedom> findFreedoms(TetrahedronMesh& mesh, bool slide, double tolerance)
{
  std::vector<PointFreedom> freedoms(mesh.pointSlots());
  std::vector<WallPlanes> planes(slide ? mesh.pointSlots() : 0);
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    pollInterruption(t);
    for (int i = 0; i < 4; ++i)
    {
      if (!mesh.isWall(t, i))
      {
        continue;
      }
      const TriangleVertices f = mesh.face(t, i);
      const Vec3& a = mesh.point(f[0]);
      const Vec3 n = cross(mesh.point(f[1]) - a, mesh.point(f[2]) - a);
      for (PointId v : f)
      {
        freedoms[v].kind = PointFreedom::Fixed;
        if (slide)
        {
          planes[v].add((1.0 / norm(n)) * n, tolerance);
        }
      }
    }
  }
  if (!slide)
  {
    return freedoms;
  }
  for (PointId v = 0; v < mesh.pointSlots(); ++v)
  {
    const WallPlanes& p = planes[v];
    if (p.count == 1)
    {
      freedoms[v] = { PointFreedom::InPlane, p.normals[0] };
    }
    else if (p.count == 2)
    {
      const Vec3 d = cross(p.normals[0], p.normals[1]);
      freedoms[v] = { PointFreedom::OnLine, (1.0 / norm(d)) * d };
    }
  }
  fixNonManifold(mesh, freedoms);
  return freedoms;
}
}
