// SPDX-License-Identifier: BSD-3-Clause
// Offsets along the normals that keep the volume of a closed surface.
#include "TriangleOperations.h"

#include "Constants.h"

namespace tautline
{
namespace
{
/// The offsets are repeated, because the normals change with them, until the volume is preserved to
/// this fraction, at most this many times.
constexpr double VolumeGoal = 1e-6;
constexpr int MaxOffsets = 20;
/// Degrees: points whose triangles differ by less from their mean normal are in a flat part, which
/// has not lost volume and stays flat.
constexpr double LeastBend = 0.1;

/// A moving point, its original position, and twice the vector area of its triangles.
struct Offset
{
  VertexId point;
  Vec3 start, area;
  bool back = false; ///< whether it has been permanently restored
};
}

//------------------------------------------------------------------------------
double TriangleOperations::enclosedVolume() const
{
  double sum = 0.0;
  VertexId first = NoNumber; // relative to a point of the surface, which may be far from the origin
  for (TriId t = 0; t < this->Mesh.slots(); ++t)
  {
    if (this->Mesh.alive(t))
    {
      const Corners& v = this->Mesh.triangle(t).vertices;
      first = first == NoNumber ? v[0] : first;
      const Vec3& origin = this->Mesh.point(first);
      sum += dot(this->Mesh.point(v[0]) - origin,
        cross(this->Mesh.point(v[1]) - origin, this->Mesh.point(v[2]) - origin));
    }
  }
  return sum / 6.0;
}

/// The sum of the vector areas of the triangles `Around`, times 2; 0 if these are coplanar.
Vec3 TriangleOperations::bentArea() const
{
  Vec3 sum = { 0, 0, 0 };
  std::vector<Vec3> areas;
  for (TriId t : this->Around)
  {
    const Corners& v = this->Mesh.triangle(t).vertices;
    const Vec3& a = this->Mesh.point(v[0]);
    areas.push_back(cross(this->Mesh.point(v[1]) - a, this->Mesh.point(v[2]) - a));
    sum += areas.back();
  }
  const double sine = std::sin(radians(LeastBend));
  const bool bent = std::any_of(areas.begin(), areas.end(),
    [&](const Vec3& area) { return norm(cross(area, sum)) > sine * norm(area) * norm(sum); });
  return bent ? sum : Vec3{ 0, 0, 0 };
}

//------------------------------------------------------------------------------
void TriangleOperations::keepVolume(double volume, double leastQuality)
{
  std::vector<Offset> offsets;
  for (VertexId v = 0; v < this->Mesh.pointSlots(); ++v)
  {
    if (this->Mesh.used(v) && this->freedoms[v].kind == PointFreedom::Free)
    {
      offsets.push_back({ v, this->Mesh.point(v), {} });
    }
  }
  const auto place = [this](const Offset& offset, const Vec3& x)
  {
    this->Mesh.star(offset.point, this->Around);
    this->Mesh.movePoint(offset.point, x, this->Around);
  };
  for (int round = 0; round < MaxOffsets; ++round)
  {
    const double lacking = volume - this->enclosedVolume();
    double area = 0.0; // the volume gained per unit of the offset
    for (Offset& offset : offsets)
    {
      this->Mesh.star(offset.point, this->Around);
      offset.area = offset.back ? Vec3{ 0, 0, 0 } : this->bentArea();
      // A point that moves by h along its normal adds h / 3 times the area of its triangles; the
      // vector has twice this area.
      area += norm(offset.area) / 6.0;
    }
    if (std::abs(lacking) <= VolumeGoal * std::abs(volume) || !(area > 0.0))
    {
      break;
    }
    for (const Offset& offset : offsets)
    {
      const double length = norm(offset.area);
      if (length > 0.0)
      {
        place(offset, this->Mesh.point(offset.point) + (lacking / (area * length)) * offset.area);
      }
    }
    // A restored point may make adjacent triangles too bad. Each iteration permanently restores a
    // point.
    for (bool more = true; more;)
    {
      more = false;
      for (Offset& offset : offsets)
      {
        this->Mesh.star(offset.point, this->Around);
        if (!offset.back && !std::isfinite(this->sumAround(leastQuality)))
        {
          place(offset, offset.start);
          offset.back = more = true;
        }
      }
    }
  }
}
}
