// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryShape.h"

#include "FacetTable.h"

#include <string>

namespace tautline
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The directions (normals of faces, or edges) of the facets around one point: two, or too many.
struct Directions
{
  Vec3 first = { 0, 0, 0 }, second = { 0, 0, 0 }; ///< unit: the first seen of each kind
  Vec3 firstSum = { 0, 0, 0 }, secondSum = { 0, 0, 0 };
  Vec3 sum = { 0, 0, 0 };
  double minCosine = 1; ///< between a facet and the sum
  bool faulty = false;  ///< a facet without size, or of three cells
  int kinds = 0;        ///< 3: three or more, or something that forbids to slide
  int facets = 0;
};

/// Files a facet with the direction `area`, whose length is its weight.
void add(Directions& d, const Vec3& area, double cosine)
{
  const double length = norm(area);
  ++d.facets;
  if (!(length > 0) || !std::isfinite(length))
  {
    d.faulty = true;
    d.kinds = 3;
    return;
  }
  d.sum += area;
  if (d.kinds == 3)
  {
    return;
  }
  const Vec3 unit = (1 / length) * area;
  if (d.kinds > 0 && dot(unit, d.first) >= cosine)
  {
    d.firstSum += area;
  }
  else if (d.kinds > 1 && dot(unit, d.second) >= cosine)
  {
    d.secondSum += area;
  }
  else if (++d.kinds < 3)
  {
    (d.kinds == 1 ? d.first : d.second) = unit;
    (d.kinds == 1 ? d.firstSum : d.secondSum) = area;
  }
}

/// The nodes of a facet in the order its cell traverses it; returns their number.
int walk(Index smallest, const FacetUse& use, Index* nodes)
{
  nodes[0] = smallest;
  if (use.others[1] < 0)
  {
    nodes[1] = use.others[0];
    return 2;
  }
  const int size = use.others[2] < 0 ? 3 : 4;
  nodes[1] = use.others[use.forward ? 0 : 1];
  nodes[size - 1] = use.others[use.forward ? 1 : 0];
  if (size == 4)
  {
    nodes[2] = use.others[2];
  }
  return size;
}

/// An edge's vector in its cell's sense, a face's normal times twice its area.
Vec3 direction(const MeshView& view, const FacetUse& use, const Index* nodes, int size)
{
  const Vec3 a = pointOf(view, nodes[0]), b = pointOf(view, nodes[1]);
  if (size == 2)
  {
    return use.forward ? b - a : a - b;
  }
  const Vec3 c = pointOf(view, nodes[2]);
  return size == 3 ? cross(b - a, c - a) : cross(c - a, pointOf(view, nodes[3]) - b);
}

void set(std::vector<double>& all, Index point, const Vec3& v)
{
  const double length = norm(v);
  for (int c = 0; c < 3; ++c)
  {
    all[3 * point + c] = v[c] / length;
  }
}

/// Sets whether a boundary point slides in a plane, along a line, on the surface, or is fixed.
void classify(Index i, const Directions& d, bool volume, double cosine, double smoothCosine,
  BoundaryShape& shape)
{
  const Vec3 shared = cross(d.firstSum, d.secondSum);
  if (volume && d.kinds == 1)
  {
    set(shape.planes, i, d.firstSum);
    ++shape.inPlanes;
  }
  else if (!volume && d.kinds == 1 && d.facets == 2)
  {
    set(shape.lines, i, d.firstSum);
    ++shape.onLines;
  }
  else if (!d.faulty && (volume || d.facets == 2) && d.minCosine >= smoothCosine)
  {
    shape.surface[i] = 1;
    ++shape.onSurface;
  }
  else if (volume && d.kinds == 2 &&
    norm(shared) > std::sqrt(1 - cosine * cosine) * norm(d.firstSum) * norm(d.secondSum))
  {
    set(shape.lines, i, shared);
    ++shape.onLines;
  }
  else
  {
    shape.fixed[i] = 1;
  }
}
}

//------------------------------------------------------------------------------
BoundaryShape boundaryShape(const Mesh& mesh, double flatAngle, double featureAngle)
{
  if (!(flatAngle >= 0 && flatAngle <= 90))
  {
    throw Error("The angle up to which the boundary counts as flat is " +
      std::to_string(flatAngle) + " degrees; it must be between 0 and 90.");
  }
  if (!(featureAngle >= 0 && featureAngle <= 180))
  {
    throw Error("The angle from which on an edge of the boundary is sharp is " +
      std::to_string(featureAngle) + " degrees; it must be between 0 and 180.");
  }
  const MeshView& view = mesh.view();
  // Rounding makes even the faces of a cube differ a little.
  const double cosine = std::min(std::cos(flatAngle * Pi / 180), 1 - 1e-12);
  std::vector<Directions> around(view.numberOfPoints);
  FacetTable facets(mesh);
  const auto forEachBoundaryFacet = [&](const auto& visit)
  {
    facets.forEachFacet(
      [&](Index smallest, const FacetUse* uses, Index count)
      {
        if (count == 2)
        {
          return;
        }
        Index nodes[MaxFaceNodes];
        const int size = walk(smallest, *uses, nodes);
        const Vec3 along = direction(view, *uses, nodes, size);
        for (int k = 0; k < size; ++k)
        {
          visit(around[nodes[k]], along, count);
        }
      });
  };
  forEachBoundaryFacet(
    [cosine](Directions& here, const Vec3& along, Index count)
    {
      if (count > 2)
      {
        here.faulty = true;
        here.kinds = 3;
      }
      add(here, along, cosine);
    });
  const bool smooth = featureAngle > 0 && mesh.dimension() != Dimension::Surface;
  const double smoothCosine = std::cos(0.5 * featureAngle * Pi / 180);
  if (smooth)
  {
    forEachBoundaryFacet(
      [](Directions& here, const Vec3& along, Index)
      {
        const double lengths = norm(along) * norm(here.sum);
        here.minCosine =
          std::min(here.minCosine, lengths > 0 ? dot(along, here.sum) / lengths : -1.0);
      });
  }

  BoundaryShape shape;
  shape.fixed.assign(view.numberOfPoints, 0);
  shape.planes.assign(3 * view.numberOfPoints, 0.0);
  shape.lines.assign(3 * view.numberOfPoints, 0.0);
  shape.surface.assign(view.numberOfPoints, 0);
  const bool volume = mesh.dimension() == Dimension::Volume;
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    if (around[i].facets > 0)
    {
      classify(i, around[i], volume, cosine, smooth ? smoothCosine : infinity, shape);
    }
  }
  return shape;
}
}
