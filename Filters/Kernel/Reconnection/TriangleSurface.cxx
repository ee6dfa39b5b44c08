// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleSurface.h"

namespace tautline
{
TriangleSurface::TriangleSurface(
  const Mesh& mesh, const Features& features, double distance, double angle)
  : Distance(distance)
  , Cosine(std::cos(angle * (Pi / 180.0)))
{
  const SurfaceModel model = makeSurfaceModel(mesh, features, false);
  for (int patch = 0; patch < model.patches; ++patch)
  {
    this->Patches.emplace_back(model.parts[patch], nullptr);
  }
}

bool TriangleSurface::accepts(const Vec3& a, const Vec3& b, const Vec3& c, int patch) const
{
  const SurfaceProjection& surface = this->Patches[patch];
  const Vec3 centre = (1.0 / 3.0) * (a + b + c);
  const Vec3 normal = cross(b - a, c - a);
  // The mean normal: slivers of the input may be turned anywhere.
  Vec3 below = { 0, 0, 0 };
  for (const Vec3& x : { centre, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a) })
  {
    if (!(norm(surface.closest(x) - x) <= this->Distance))
    {
      return false;
    }
    below += surface.direction(x);
  }
  return dot(normal, below) >= this->Cosine * norm(normal) * norm(below);
}
}
