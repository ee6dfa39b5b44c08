// SPDX-License-Identifier: BSD-3-Clause
// The surface and the interfaces that the points of an optimization are kept on.
#include "OptimizationProblem.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// The fraction of the surface tolerance that the elements of a volume may use before the worst one
/// is improved: points at the limit would obstruct it. On a surface, the worst elements use all of
/// it immediately.
constexpr double beforeWorst = 0.3;
/// The fraction of the surface tolerance used at the sample points: positions between them may be
/// farther away, more often on surfaces than in volumes, whose elements constrain the points of
/// flat facets, and most often at points that leave the surface.
constexpr double marginOfSliding = 0.85, marginOfSurface = 0.8, marginOfLeaving = 0.7;
}

//------------------------------------------------------------------------------
void OptimizationProblem::makeSurface()
{
  const OptimizeOptions& options = this->Options;
  if (options.model)
  {
    for (const SurfacePart& part : options.model->parts)
    {
      this->Parts.emplace_back(part, this->Simplices.get());
    }
  }
  const bool slides = this->TheMesh.dimension() == Dimension::Surface
    ? options.surface.project
    : options.slideSurface != nullptr;
  if (options.model && options.onGeometry)
  {
    this->Surface = std::make_unique<SurfaceProjection>(
      SurfaceProjection::ofFacets(*options.model, this->Simplices.get()));
  }
  else if (options.model || slides)
  {
    this->Surface = std::make_unique<SurfaceProjection>(this->TheMesh, *this->Simplices);
  }
  if (this->Surface && options.surfaceTolerance > 0)
  {
    const bool surface = this->TheMesh.dimension() == Dimension::Surface;
    const double margin = options.leaving ? marginOfLeaving
      : surface                           ? marginOfSurface
                                          : marginOfSliding;
    this->Limit = std::make_unique<SurfaceLimit>(this->TheMesh, surfaceFacets(this->TheMesh),
      *this->Simplices, *this->Surface,
      margin * options.surfaceTolerance / this->Simplices->scale(), !options.onGeometry);
  }
  this->makeInterfaces();
  const bool surface = this->TheMesh.dimension() == Dimension::Surface;
  this->shareTolerance(options.improveWorst > 0 && !surface ? beforeWorst : 1.0);
}

//------------------------------------------------------------------------------
/// Separate from the boundary: proximity to the boundary does not imply proximity to an interface.
void OptimizationProblem::makeInterfaces()
{
  const OptimizeOptions& options = this->Options;
  if (!options.model || options.model->interfaces.empty() || options.onGeometry)
  {
    return;
  }
  const std::vector<SurfaceFacet>& facets = options.model->interfaces;
  this->Interfaces = std::make_unique<SurfaceProjection>(this->TheMesh, facets, *this->Simplices);
  if (options.surfaceTolerance > 0)
  {
    this->BetweenLimit =
      std::make_unique<SurfaceLimit>(this->TheMesh, facets, *this->Simplices, *this->Interfaces,
        marginOfSliding * options.surfaceTolerance / this->Simplices->scale(), true);
  }
}

//------------------------------------------------------------------------------
/// The distance between the current and the original facets of the mesh, in both directions.
double OptimizationProblem::distanceOf(
  const SurfaceProjection& now, const SurfaceProjection& before) const
{
  const int threads = this->Options.threads;
  const int divisions = this->Limit ? SurfaceLimit::divisions : 2;
  const double there = now.distanceTo(before, threads, divisions);
  // A mesh may represent only a part of a geometry.
  const double back = this->Options.onGeometry ? 0.0 : before.distanceTo(now, threads, divisions);
  return this->Simplices->scale() * std::max(there, back);
}

double OptimizationProblem::errorOfBoundary() const
{
  return this->Surface
    ? this->distanceOf(SurfaceProjection(*this->Moving, *this->Simplices), *this->Surface)
    : 0.0;
}

double OptimizationProblem::errorOfInterfaces() const
{
  return this->Interfaces ? this->distanceOf(SurfaceProjection(*this->Moving,
                                               this->Options.model->interfaces, *this->Simplices),
                              *this->Interfaces)
                          : 0.0;
}

double OptimizationProblem::surfaceError() const
{
  return std::max(this->errorOfBoundary(), this->errorOfInterfaces());
}

//------------------------------------------------------------------------------
bool OptimizationProblem::isWithinTolerance() const
{
  const OptimizeOptions& options = this->Options;
  if (options.onGeometry || !(options.surfaceTolerance > 0))
  {
    return true;
  }
  // A boundary that is free, or only slides on flat parts, has no tolerance.
  const auto slides = [&](Index p)
  {
    return p >= 0 &&
      ((options.model && options.parts[p] >= 0) ||
        (options.slideSurface && options.slideSurface[p]));
  };
  const std::vector<SurfaceFacet> facets = surfaceFacets(this->TheMesh);
  const bool onBoundary = std::any_of(facets.begin(), facets.end(),
    [&](const SurfaceFacet& facet)
    { return std::any_of(facet.nodes.begin(), facet.nodes.begin() + facet.size, slides); });
  return this->errorOfInterfaces() <= options.surfaceTolerance &&
    (!onBoundary || this->errorOfBoundary() <= options.surfaceTolerance);
}

//------------------------------------------------------------------------------
void OptimizationProblem::shareTolerance(double share)
{
  for (SurfaceLimit* limit : { this->Limit.get(), this->BetweenLimit.get() })
  {
    if (limit)
    {
      limit->setShare(share);
    }
  }
}

//------------------------------------------------------------------------------
Index OptimizationProblem::heldOnSurface() const
{
  if (!this->Limit)
  {
    return 0;
  }
  const std::vector<unsigned char>& held = this->Limit->held();
  return std::count(held.begin(), held.end(), 1);
}

//------------------------------------------------------------------------------
Index OptimizationProblem::heldOnInterfaces() const
{
  Index count = 0;
  for (std::size_t v = 0; this->BetweenLimit && v < this->BetweenLimit->held().size(); ++v)
  {
    count += this->BetweenLimit->held()[v] && !this->Limit->held()[v];
  }
  return count;
}
}
