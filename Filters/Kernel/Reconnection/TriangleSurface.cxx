// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleSurface.h"

namespace tautline
{
TriangleSurface::TriangleSurface(
  const Mesh& mesh, const Features& features, double distance, double angle)
  : Cosine(std::cos(angle * (Pi / 180.0)))
{
  const SurfaceModel model =
    makeSurfaceModel(mesh, features, true, false, SmoothPart::shareOfPoints * distance);
  for (int patch = 0; patch < model.patches; ++patch)
  {
    this->Patches.emplace_back(model.parts[patch], distance);
  }
}

bool TriangleSurface::accepts(const Vec3& a, const Vec3& b, const Vec3& c, int patch) const
{
  return this->Patches[patch].accepts({ a, b, c }, cross(b - a, c - a), this->Cosine);
}
}
