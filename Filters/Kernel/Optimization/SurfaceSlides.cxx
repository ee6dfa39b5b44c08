// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSlides.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>

namespace tautline
{
namespace
{
Vec3 unit(const Vec3& v)
{
  const double length = norm(v);
  return length > 0 ? (1.0 / length) * v : Vec3{ 0, 0, 0 };
}
}

//------------------------------------------------------------------------------
bool keepsSurface(const OptimizationProblem& problem)
{
  const OptimizeOptions& options = problem.options();
  // Without features, steps would cross sharp edges. The result is compared with the surface
  // afterwards if it is the surface of the mesh.
  if (!problem.surface() || !options.model || options.limits ||
    (options.onGeometry && options.surfaceTolerance > 0) || options.slidePlanes ||
    options.slideLines || problem.moving().nonFinitePoints() > 0)
  {
    return false;
  }
  const std::vector<const SurfaceProjection*> surfaces = problem.localOptions().surfaces;
  return std::all_of(surfaces.begin(), surfaces.end(),
    [](const SurfaceProjection* surface) { return surface && !surface->empty(); });
}

//------------------------------------------------------------------------------
SurfaceSlides::SurfaceSlides(OptimizationProblem& problem)
  : Problem(problem)
  , Surfaces(problem.localOptions().surfaces)
  , VertexOf(problem.points().size() / 3, -1)
  , Directions(problem.simplices().freeVertices(), Vec3{ 0, 0, 0 })
  , Normals(problem.moving().view().numberOfCells, Vec3{ 0, 0, 0 })
{
  for (std::int32_t v = 0; v < problem.simplices().freeVertices(); ++v)
  {
    this->VertexOf[problem.simplices().point(v)] = v;
  }
  this->place();
  this->keepNormals();
  this->findSides();
}

//------------------------------------------------------------------------------
void SurfaceSlides::findSides()
{
  constexpr unsigned char above = 1, below = 2;
  std::vector<unsigned char> found(this->Directions.size(), 0);
  this->forEachElement(
    [&](Index, const Corners& corners)
    {
      for (int s = 0; s < corners.count; ++s)
      {
        const std::int32_t v = this->VertexOf[corners.points[s]];
        if (v >= 0)
        {
          found[v] |= dot(corners.areas[s], this->Directions[v]) > 0 ? above : below;
        }
      }
    });
  for (std::size_t v = 0; v < found.size(); ++v)
  {
    this->Sides.push_back(this->Surfaces[v]->isCurve() ? 0
        : found[v] == above                            ? 1
        : found[v] == below                            ? -1
                                                       : 0);
  }
}

//------------------------------------------------------------------------------
void SurfaceSlides::place()
{
  const SimplexMesh& s = this->Problem.simplices();
  forEachChunk(s.freeVertices(), this->Problem.options().threads,
    [&](Index, Index begin, Index end)
    {
      for (Index v = begin; v < end; ++v)
      {
        double* p =
          &this->Problem
             .points()[3 * static_cast<std::size_t>(s.point(static_cast<std::int32_t>(v)))];
        Vec3 d;
        const Vec3 on = this->Surfaces[v]->closest(s.transform({ p[0], p[1], p[2] }), d);
        s.storeVertex(on.data(), p);
        this->Directions[v] = unit(d[0] * s.axis(0) + d[1] * s.axis(1) + d[2] * s.axis(2));
      }
    });
}

//------------------------------------------------------------------------------
Vec3 SurfaceSlides::project(std::size_t p, const Vec3& g) const
{
  const std::int32_t v = this->VertexOf[p];
  const Vec3& d = this->Directions[v];
  const Vec3 along = dot(g, d) * d;
  return this->Surfaces[v]->isCurve() ? along : g - along;
}

//------------------------------------------------------------------------------
/// Calls visit(cell, corners) for all elements.
template <class Visit>
void SurfaceSlides::forEachElement(const Visit& visit) const
{
  const MeshView& view = this->Problem.moving().view();
  for (const CellBlock& block : this->Problem.moving().blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == 2 && i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      Corners corners = {};
      for (int s = 0; s < t.corners; ++s)
      {
        const auto& nodes = t.cornerNodes[s];
        const Vec3 a = pointOf(view, node[nodes[0]]);
        corners.points[s] = node[nodes[0]];
        corners.areas[s] =
          cross(pointOf(view, node[nodes[1]]) - a, pointOf(view, node[nodes[2]]) - a);
      }
      corners.count = t.corners;
      visit(cell, corners);
    }
  }
}

void SurfaceSlides::keepNormals()
{
  this->forEachElement(
    [this](Index cell, const Corners& corners)
    {
      this->Normals[cell] = { 0, 0, 0 };
      for (int s = 0; s < corners.count; ++s)
      {
        this->Normals[cell] += corners.areas[s];
      }
    });
}

bool SurfaceSlides::turned() const
{
  bool turned = false;
  this->forEachElement(
    [&](Index cell, const Corners& corners)
    {
      if (turned)
      {
        return;
      }
      // The surface at the points of the element that slide on a patch.
      Vec3 outwards = { 0, 0, 0 };
      for (int s = 0; s < corners.count; ++s)
      {
        const std::int32_t v = this->VertexOf[corners.points[s]];
        outwards +=
          v >= 0 ? static_cast<double>(this->Sides[v]) * this->Directions[v] : Vec3{ 0, 0, 0 };
      }
      for (int s = 0; s < corners.count; ++s)
      {
        const auto faces = [&](const Vec3& n)
        { return dot(corners.areas[s], n) > 0 || !(dot(n, n) > 0); };
        turned = turned || !faces(outwards) || !faces(this->Normals[cell]);
      }
    });
  return turned;
}
}
