// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleInput.h"

#include "Constants.h"
#include "ReconnectionInput.h"
#include "tautline/Core/Memory.h"

#include <limits>

namespace tautline
{
namespace
{
/// The memory for mesh, surface, workspace and result.
constexpr double BytesPerTriangle = 500.0;

void requireTriangles(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  Index others = view.numberOfCells;
  for (const CellBlock& block : mesh.blocks())
  {
    others -= block.type == CellType::Triangle ? block.count : 0;
  }
  if (mesh.higherOrderCells() > 0)
  {
    throw Error(std::to_string(mesh.higherOrderCells()) +
      " cells of higher order: reconnection requires linear triangles. Run Curve Mesh with "
      "order 1 first, and with the original order on the result");
  }
  if (others > 0)
  {
    throw Error(std::to_string(others) +
      " cells are not triangles: reconnection requires triangles; extract them, or run "
      "Triangulate first");
  }
  if (mesh.nonFinitePoints() > 0)
  {
    throw Error(std::to_string(mesh.nonFinitePoints()) +
      " points have a NaN or infinite coordinate: repair or remove them first");
  }
  // Edges are coded in 31 bits.
  if (view.numberOfCells > std::numeric_limits<std::int32_t>::max() / 8 ||
    view.numberOfPoints > std::numeric_limits<std::int32_t>::max() / 2)
  {
    throw Error("reconnection supports at most 268 million triangles: split the mesh into parts");
  }
  std::vector<signed char> validity(view.numberOfCells);
  mesh.classifyCells(validity.data());
  const Index bad =
    std::count_if(validity.begin(), validity.end(), [](signed char v) { return v != Valid; });
  if (bad > 0)
  {
    const bool planar = mesh.dimension() == Dimension::Planar;
    throw Error(std::to_string(bad) +
      (planar ? " inverted or degenerate triangles: run Untangle Mesh first (or reorient the "
                "cells, if all are reversed)"
              : " degenerate triangles that cannot be removed without changing the surface: "
                "fix fewer points, or remesh there"));
  }
}

/// Converts points to the plane of a planar mesh, if any, and scales them.
void convertPoints(const Mesh& mesh, TriangleInput& input)
{
  const MeshView& view = mesh.view();
  const auto& [e1, e2] = mesh.frame();
  if (input.planar && view.numberOfCells > 0)
  {
    input.origin = dot(pointOf(view, view.connectivity[0]), mesh.normal()) * mesh.normal();
  }
  input.points.resize(view.numberOfPoints);
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const Vec3 x = pointOf(view, i);
    input.points[i] = input.planar ? Vec3{ dot(x, e1), dot(x, e2), 0.0 } : x;
  }
  double largest = 0.0;
  for (Index n = 0; n < view.offsets[view.numberOfCells]; ++n)
  {
    for (double x : input.points[view.connectivity[n]])
    {
      largest = std::max(largest, std::abs(x));
    }
  }
  std::frexp(largest, &input.exponent);
  for (Vec3& x : input.points)
  {
    for (double& coordinate : x)
    {
      coordinate = std::ldexp(coordinate, -input.exponent);
    }
  }
}

/// The features of a surface: its sharp edges and borders are walls.
void convertSurface(const Mesh& mesh, const TriangleOptions& options, TriangleInput& input)
{
  MeshView view = mesh.view();
  view.points = input.points.data()->data();
  const Mesh scaled(view);
  FeatureOptions features;
  features.angle = options.featureAngle;
  features.asSurface = true;
  std::vector<double> regions(input.regions.begin(), input.regions.end());
  features.regions = regions.empty() ? nullptr : regions.data();
  const Features found = findFeatures(scaled, features);
  for (const Features::Edge& edge : found.edges)
  {
    input.walls.push_back({ edge.first, edge.second });
  }
  input.corners.assign(view.numberOfPoints, 0);
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    input.corners[i] = found.kind[i] == CornerPoint;
  }
  input.patches = found.patchOfCell;
  Vec3 low = { 0, 0, 0 }, high = low;
  for (Index n = 0; n < view.offsets[view.numberOfCells]; ++n)
  {
    const Vec3& x = input.points[view.connectivity[n]];
    for (int k = 0; k < 3; ++k)
    {
      low[k] = n > 0 ? std::min(low[k], x[k]) : x[k];
      high[k] = n > 0 ? std::max(high[k], x[k]) : x[k];
    }
  }
  const double distance = std::max(options.surfaceTolerance, LeastDistance) * norm(high - low);
  input.surface = TriangleSurface(scaled, found, distance, options.surfaceAngle);
}
}

void checkTriangleOptions(const TriangleOptions& options)
{
  checkReconnectionOptions(options);
  if (options.boundary == BoundaryMotion::OnSurface)
  {
    throw Error("motion within a distance of the boundary is only supported for tetrahedra: "
                "let the boundary of triangles slide in flat parts (their points always stay "
                "on the surface)");
  }
}

Vec3 TriangleInput::leave(const Mesh& mesh, const Vec3& x) const
{
  const Vec3 unscaled = { std::ldexp(x[0], this->exponent), std::ldexp(x[1], this->exponent),
    std::ldexp(x[2], this->exponent) };
  const auto& [e1, e2] = mesh.frame();
  return this->planar ? this->origin + (unscaled[0] * e1 + unscaled[1] * e2) : unscaled;
}

TriangleInput convertTriangles(const Mesh& mesh, const TriangleOptions& options)
{
  requireTriangles(mesh);
  const MeshView& view = mesh.view();
  requireMemory(BytesPerTriangle * static_cast<double>(view.numberOfCells),
    "reconnection of this mesh", "use a smaller mesh");
  TriangleInput input;
  input.planar = mesh.dimension() != Dimension::Surface;
  convertPoints(mesh, input);
  input.cells.resize(view.numberOfCells);
  for (Index c = 0; c < view.numberOfCells; ++c)
  {
    const Index* v = view.connectivity + view.offsets[c];
    for (int k = 0; k < 3; ++k)
    {
      input.cells[c][k] = static_cast<VertexId>(v[k]);
    }
    if (mesh.mirrored() && input.planar)
    {
      std::swap(input.cells[c][1], input.cells[c][2]);
    }
  }
  input.regions = renumberRegions(options.regions, view.numberOfCells);
  if (options.outside)
  {
    input.regions.resize(view.numberOfCells, 0);
    for (Index c = 0; c < view.numberOfCells; ++c)
    {
      input.regions[c] = options.outside[c] ? OutsideRegion : input.regions[c];
    }
  }
  input.walls = options.markedEdges;
  input.markedEdges = static_cast<std::int32_t>(options.markedEdges.size());
  const bool own = options.size == ReconnectionSize::Input;
  input.metrics = edgeMetrics(input.points, input.exponent,
    own ? meanEdgeLengths(input.points, input.cells) : std::vector<double>(), options);
  if (input.planar && options.size == ReconnectionSize::Metrics)
  {
    // The points are in the frame of the plane.
    const auto& [e1, e2] = mesh.frame();
    for (EdgeMetric& metric : input.metrics)
    {
      metric = turned(metric, { e1, e2, cross(e1, e2) });
    }
  }
  if (!input.planar)
  {
    convertSurface(mesh, options, input);
  }
  return input;
}

//------------------------------------------------------------------------------
namespace
{
/// Calls visit(triangle, its other end) for the walls at a point, once each.
template <class Visit>
void forEachWall(
  const TriangleMesh& mesh, VertexId v, const std::vector<TriId>& around, Visit visit)
{
  for (TriId t : around)
  {
    const Corners& c = mesh.triangle(t).vertices;
    const int k = mesh.indexOf(t, v);
    if (mesh.isWall(t, Previous[k]))
    {
      visit(c[Next[k]]);
    }
    if (mesh.isBorder(t, Next[k]))
    {
      visit(c[Previous[k]]);
    }
  }
}
}

std::vector<PointFreedom> findFreedoms(
  const TriangleMesh& mesh, const TriangleInput& input, const TriangleOptions& options)
{
  const double tolerance = std::max(
    std::sin(options.flatAngle * (Pi / 180.0)), 4.0 * std::numeric_limits<double>::epsilon());
  const bool slide = options.boundary == BoundaryMotion::FlatParts;
  std::vector<PointFreedom> freedoms(mesh.pointSlots());
  std::vector<TriId> around;
  for (VertexId v = 0; v < mesh.pointSlots(); ++v)
  {
    if (!mesh.used(v))
    {
      continue;
    }
    mesh.star(v, around);
    int walls = 0;
    Vec3 directions[2] = { { 0, 0, 0 }, { 0, 0, 0 } };
    forEachWall(mesh, v, around,
      [&](VertexId w)
      {
        const Vec3 d = mesh.point(w) - mesh.point(v);
        directions[std::min(walls++, 1)] = (1.0 / norm(d)) * d;
      });
    const bool beside = std::any_of(around.begin(), around.end(),
      [&](TriId t) { return mesh.triangle(t).region == OutsideRegion; });
    const bool kept =
      beside || mesh.isNonManifold(v) || (!input.corners.empty() && input.corners[v]);
    const bool straight = walls == 2 && dot(directions[0], directions[1]) < 0.0 &&
      norm(cross(directions[0], directions[1])) <= tolerance;
    if (kept || (walls > 0 && !(slide && straight)))
    {
      freedoms[v].kind = PointFreedom::Fixed;
    }
    else if (walls > 0)
    {
      const Vec3 d = directions[0] - directions[1];
      freedoms[v] = { PointFreedom::OnLine, (1.0 / norm(d)) * d };
    }
    if (options.fixed && options.fixed[v])
    {
      freedoms[v] = { PointFreedom::Fixed, { 0, 0, 0 } };
    }
  }
  return freedoms;
}

//------------------------------------------------------------------------------
namespace
{
constexpr double RegularSine = 0.8660254037844386; // sin 60 degrees

/// The smallest angle between two walls of triangle t at vertex k; 60 degrees or more means none.
double wallAngle(const TriangleMesh& mesh, TriId t, int k)
{
  if (!mesh.isWall(t, Next[k]) || !mesh.isWall(t, Previous[k]))
  {
    return Pi;
  }
  const Corners& v = mesh.triangle(t).vertices;
  const Vec3 u = mesh.point(v[Next[k]]) - mesh.point(v[k]);
  const Vec3 w = mesh.point(v[Previous[k]]) - mesh.point(v[k]);
  return std::atan2(norm(cross(u, w)), dot(u, w));
}

/**
 * @brief The largest possible quality at a corner of walls: its angle is preserved or divided.
 * @param divides whether the walls may be divided, so that the triangle need not have both
 */
double cornerBound(const TriangleMesh& mesh, TriId t, double angle, bool divides)
{
  const double regular = Pi / 3.0;
  const double half = std::sin(std::min(0.5 * angle, regular));
  return divides ? std::sin(std::min(angle, regular)) : std::max(half, mesh.quality(t));
}
}

double targetQuality(const TriangleOptions& options)
{
  constexpr double targetInMetric = 0.7;
  return options.adapt ? targetInMetric : std::sin(radians(options.targetAngle));
}

void findObstacles(const TriangleMesh& mesh, const std::vector<char>& fixedPoints,
  const TriangleOptions& options, ReconnectionResult& result)
{
  const double target = targetQuality(options);
  const bool divides = options.boundary == BoundaryMotion::FlatParts && options.insert;
  std::vector<char> atBorder(mesh.pointSlots(), 0), atInterface(atBorder);
  double forced = 1.0, smallestCorner = Pi;
  // Bounds on angles do not bound mean ratios in a metric.
  std::vector<double> bounds(mesh.slots(), options.adapt ? 1.0 : RegularSine);
  for (TriId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; mesh.alive(t) && i < 3; ++i)
    {
      if (mesh.isWall(t, i))
      {
        const Corners& v = mesh.triangle(t).vertices;
        std::vector<char>& flags = mesh.isBorder(t, i) ? atBorder : atInterface;
        flags[v[Next[i]]] = flags[v[Previous[i]]] = 1;
      }
      const double angle = options.adapt ? Pi : wallAngle(mesh, t, i);
      if (angle < Pi)
      {
        bounds[t] = std::min(bounds[t], cornerBound(mesh, t, angle, divides));
        smallestCorner = std::min(smallestCorner, angle);
      }
    }
    forced = std::min(forced, bounds[t]);
  }
  result.forcedQuality = options.adapt ? 1.0 : std::min(forced, RegularSine);
  // The isosceles triangle has the best mean ratio of all triangles with this angle.
  const double angle = std::min(smallestCorner, Pi / 3.0);
  result.forcedInverseMeanRatio =
    (1.0 / std::tan(angle) + 2.0 * std::tan(0.5 * angle)) / std::sqrt(3.0);
  using Obstacle = ReconnectionObstacle;
  for (TriId t = 0; t < mesh.slots(); ++t)
  {
    if (!mesh.alive(t))
    {
      continue;
    }
    const Corners& v = mesh.triangle(t).vertices;
    const auto any = [&](const std::vector<char>& flags)
    {
      return std::any_of(v.begin(), v.end(),
        [&](VertexId p) { return p < static_cast<VertexId>(flags.size()) && flags[p]; });
    };
    Obstacle obstacle = Obstacle::None;
    if (mesh.quality(t) < target)
    {
      obstacle = bounds[t] <= mesh.quality(t) * (1.0 + AtBound) ? Obstacle::Facets
        : any(fixedPoints)                                      ? Obstacle::FixedPoints
        : any(atInterface)                                      ? Obstacle::Interface
        : any(atBorder)                                         ? Obstacle::Surface
                                                                : Obstacle::Limit;
    }
    result.obstacles.push_back(static_cast<signed char>(obstacle));
    result.qualities.push_back(mesh.quality(t));
    result.bounds.push_back(
      obstacle == Obstacle::None ? 1.0 : std::max(bounds[t], mesh.quality(t)));
  }
}
}
