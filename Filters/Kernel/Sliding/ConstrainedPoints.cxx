// SPDX-License-Identifier: BSD-3-Clause
#include "ConstrainedPoints.h"

#include "tautline/Boundary/FlatPart.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Fraction of the diagonal.
constexpr double defaultTolerance = 1e-3;
/// Fraction of the tolerance: a point this close to a flat part is on it.
constexpr double onFlatPart = 1e-6;

Vec3 entryOf(const double* vectors, Index p)
{
  return vectors ? Vec3{ vectors[3 * p], vectors[3 * p + 1], vectors[3 * p + 2] } : Vec3{ 0, 0, 0 };
}
}

//------------------------------------------------------------------------------
ConstrainedPoints::ConstrainedPoints(const Mesh& mesh, const BoundaryConstraints& constraints)
  : Given(constraints)
  , Tolerance(constraints.surfaceTolerance > 0 ? constraints.surfaceTolerance
                                               : defaultTolerance * diagonalOf(mesh.view()))
  , Planar(mesh.dimension() == Dimension::Planar)
  , Normal(mesh.normal())
{
  const MeshView& view = mesh.view();
  if (constraints.model)
  {
    for (const SurfacePart& part : constraints.model->parts)
    {
      SurfacePart facets;
      facets.curve = part.curve;
      facets.pieces = part.pieces;
      this->Facets.emplace_back(facets, nullptr);
      this->Smooth.emplace_back(part, nullptr);
      this->DirectionsOfParts.emplace_back();
      this->Flat.push_back(
        isFlatPart(part, this->Tolerance, this->DirectionsOfParts.back()) ? 1 : 0);
    }
  }
  this->Freedoms.assign(view.numberOfPoints, Freedom::None);
  this->Directions.assign(view.numberOfPoints, this->Normal);
  this->Bands.assign(view.numberOfPoints, -1);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    pollInterruption(p);
    const Vec3 x = pointOf(view, p);
    if ((constraints.fixed && constraints.fixed[p]) || !std::isfinite(dot(x, x)))
    {
      continue;
    }
    const Vec3 plane = entryOf(constraints.slidePlanes, p);
    const Vec3 line = entryOf(constraints.slideLines, p);
    const std::int32_t part = constraints.model ? constraints.parts[p] : -1;
    this->Freedoms[p] = this->Planar ? Freedom::Plane : Freedom::Space;
    if (dot(line, line) > 0)
    {
      this->Freedoms[p] = Freedom::Line;
      this->Directions[p] = line;
    }
    else if (dot(plane, plane) > 0)
    {
      this->Freedoms[p] = Freedom::Plane;
      this->Directions[p] = plane;
    }
    else if (part >= 0)
    {
      this->slideOnPart(p, part, x);
    }
  }
}

//------------------------------------------------------------------------------
void ConstrainedPoints::slideOnPart(Index p, std::int32_t part, const Vec3& x)
{
  const bool curve = this->Facets[part].isCurve();
  const Vec3 off = this->Facets[part].closest(x) - x;
  if (this->Flat[part] && norm(off) <= onFlatPart * this->Tolerance && (curve || !this->Planar))
  {
    this->Freedoms[p] = curve ? Freedom::Line : Freedom::Plane;
    this->Directions[p] = this->DirectionsOfParts[part];
  }
  else
  {
    this->Bands[p] = part;
  }
}

//------------------------------------------------------------------------------
Vec3 ConstrainedPoints::onPart(Index p, const Vec3& x) const
{
  return this->Smooth[this->Bands[p]].closest(x);
}
}
