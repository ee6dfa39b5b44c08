// SPDX-License-Identifier: BSD-3-Clause
#include "Untangle.h"

#include "SurfaceRegions.h"
#include "Unfold.h"
#include "UntangleRegions.h"
#include "Untangler.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/FoldedCells.h"
#include "tautline/Mesh/JacobianBounds.h"
#include "tautline/Sliding/UntangleSliding.h"

namespace tautline
{
namespace
{
/// Writes the vertices that moved; the others are bitwise unchanged.
void storeMoved(const SimplexMesh& simplices, const std::vector<double>& start, const double* x,
  int threads, std::vector<double>& points)
{
  std::vector<double> all = points;
  simplices.store(x, all.data(), threads);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    const std::size_t i = VertexStride * static_cast<std::size_t>(v);
    if (!std::equal(&start[i], &start[i] + VertexStride, x + i))
    {
      std::copy_n(&all[3 * static_cast<std::size_t>(simplices.point(v))], 3,
        &points[3 * static_cast<std::size_t>(simplices.point(v))]);
    }
  }
}

//------------------------------------------------------------------------------
/// Sets the reason for each invalid cell.
void findObstacles(const Mesh& mesh, const SimplexMesh& simplices,
  const std::vector<signed char>& validity, const std::vector<std::int32_t>& infeasible,
  UntangleResult& result)
{
  const MeshView& view = mesh.view();
  std::vector<char> free(view.numberOfPoints, 0);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    free[simplices.point(v)] = 1;
  }
  std::vector<char> held(view.numberOfCells, 0);
  for (std::int32_t s : infeasible)
  {
    held[simplices.cell(s)] = 1;
  }
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      if (validity[cell] == NonFinite)
      {
        result.obstacles[cell] = static_cast<signed char>(Obstacle::NonFinite);
      }
      if (validity[cell] != Inverted && validity[cell] != Degenerate)
      {
        continue;
      }
      const Index* node = view.connectivity + view.offsets[cell];
      const auto isFree = [&](int k) { return free[node[k]] != 0; };
      bool anyFree = false;
      for (int k = 0; k < t.nodes; ++k)
      {
        anyFree = anyFree || isFree(k);
      }
      Obstacle obstacle = anyFree ? Obstacle::Unknown : Obstacle::FixedElement;
      if (anyFree && held[cell])
      {
        obstacle = Obstacle::FixedNeighbours;
      }
      for (int s = 0; anyFree && s < t.samples && t.dimension == simplices.dimension(); ++s)
      {
        // If a corner with only fixed vertices is invalid, the cell cannot become valid.
        bool fixedCorner = true;
        Vec3 e[4];
        for (int k = 0; k <= t.dimension; ++k)
        {
          fixedCorner = fixedCorner && !isFree(t.cornerNodes[s][k]);
          e[k] = pointOf(view, node[t.cornerNodes[s][k]]);
        }
        if (fixedCorner)
        {
          const Vec3 a = e[1] - e[0], b = e[2] - e[0];
          const Vec3 c = t.dimension == 3 ? e[3] - e[0] : mesh.normal();
          const double det = (mesh.mirrored() ? -1.0 : 1.0) * dot(cross(a, b), c);
          if (det <= Mesh::degenerateTolerance() * norm(a) * norm(b) * norm(c))
          {
            obstacle = Obstacle::FixedNeighbours;
          }
        }
      }
      result.obstacles[cell] = static_cast<signed char>(obstacle);
      result.impossible += obstacle != Obstacle::Unknown;
    }
  }
}

//------------------------------------------------------------------------------
/// The invalid cells with an invalid corner: those detected by the simplices.
Index countInvalidCorners(
  const Mesh& mesh, const std::vector<double>& points, const std::vector<signed char>& validity)
{
  const MeshView& view = mesh.view();
  Index count = 0;
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    if (isInvalid(validity[cell]))
    {
      const CellTopology& t = topology(cornerType(view.cellTypes[cell]));
      Vec3 p[MaxNodes];
      for (int k = 0; k < t.nodes; ++k)
      {
        const double* at = &points[3 * view.connectivity[view.offsets[cell] + k]];
        p[k] = { at[0], at[1], at[2] };
      }
      count += mesh.classifyCorners(t, p) != Valid;
    }
  }
  return count;
}

/// Repairs cells that are valid only at the corners, and adds a record.
void unfoldCells(const Mesh& mesh, const SimplexMesh& simplices, UntangleProgress& progress,
  std::vector<signed char>& validity, UntangleResult& result)
{
  const bool inside = std::any_of(mesh.blocks().begin(), mesh.blocks().end(),
    [](const CellBlock& block) { return hasInside(block.type); });
  if (!inside || result.reason == StopReason::Aborted || result.invertedAfter == 0)
  {
    return;
  }
  std::vector<char> free(mesh.view().numberOfPoints, 0);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    free[simplices.point(v)] = 1;
  }
  unfold(mesh, free, result.points, validity, [&] { return !progress.late(); });
  result.invertedAfter = countInvalid(mesh, validity);
  progress.record(result.invertedAfter, result.history.back().objective, 1.0,
    [&](double* to) { std::copy(result.points.begin(), result.points.end(), to); });
}

template <int Dim>
void untangleSimplices(const Mesh& mesh, SimplexMesh& simplices, const UntangleOptions& options,
  UntangleProgress& progress, std::vector<signed char>& validity, UntangleResult& result)
{
  const std::vector<double> start(simplices.coordinates(),
    simplices.coordinates() + static_cast<std::size_t>(VertexStride) * simplices.vertices());
  const std::vector<double> input = result.points;
  const std::vector<signed char> before = validity;
  Index fewest = countInvalidCorners(mesh, input, before);
  Untangler<Dim> untangler(mesh, simplices, options, progress);
  // Coordinates are rounded when stored as points: if cells become invalid, repeat with a wider
  // margin.
  for (const double margin : { 1e-12, 1e-9, 1e-6 })
  {
    const double* x = untangler.run(margin);
    std::vector<double> points = input;
    storeMoved(simplices, start, x, options.threads, points);
    std::vector<signed char> after = before;
    mesh.classifyMovedCells(points.data(), after.data(), options.threads);
    const Index invalid = countInvalidCorners(mesh, points, after);
    if (invalid < fewest)
    {
      fewest = invalid;
      result.points = points;
      validity = after;
    }
    if (untangler.stopped() || !untangler.untangled() || invalid <= untangler.invalidCells())
    {
      break;
    }
  }
  result.invertedAfter = countInvalid(mesh, validity);
  unfoldCells(mesh, simplices, progress, validity, result);
  if (result.invertedAfter > result.invertedBefore)
  {
    result.points = input;
    validity = before;
    result.invertedAfter = result.history.back().inverted = result.invertedBefore;
  }
  findObstacles(mesh, simplices, validity, untangler.infeasible(), result);
}

//------------------------------------------------------------------------------
/// Whether points slide.
bool slides(const UntangleOptions& options)
{
  return options.slidePlanes || options.slideLines || options.model;
}

BoundaryConstraints constraintsOf(const UntangleOptions& options, const unsigned char* fixed)
{
  BoundaryConstraints constraints = options;
  constraints.fixed = fixed;
  return constraints;
}

/// Flags the points that do not slide and are not free: the specified points, or the boundary
/// points.
std::vector<unsigned char> fixedPoints(const Mesh& mesh, const UntangleOptions& options)
{
  const Index points = mesh.view().numberOfPoints;
  if (options.fixed)
  {
    return { options.fixed, options.fixed + points };
  }
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  std::vector<unsigned char> fixed(boundary.begin(), boundary.end());
  const auto isSet = [](const double* vectors, Index p) {
    return vectors && (vectors[3 * p] != 0 || vectors[3 * p + 1] != 0 || vectors[3 * p + 2] != 0);
  };
  for (Index p = 0; p < points; ++p)
  {
    fixed[p] = fixed[p] && !(options.model && options.parts[p] >= 0) &&
      !isSet(options.slidePlanes, p) && !isSet(options.slideLines, p);
  }
  return fixed;
}

/// Moves the points together with the boundary points, if that leaves fewer invalid cells.
void slideHere(const Mesh& mesh, const UntangleOptions& options,
  const std::vector<unsigned char>& fixed, UntangleProgress& progress,
  std::vector<signed char>& validity, UntangleResult& result)
{
  const MeshView& view = mesh.view();
  progress.record(result.invertedBefore, 0.0, 0.0,
    [&](double* to) { std::copy_n(view.points, 3 * view.numberOfPoints, to); });
  const std::vector<Vec3> start = pointsOf(view.points, view.numberOfPoints);
  const std::vector<double> moved =
    untangleSliding(mesh, constraintsOf(options, fixed.data()), options.threads,
      [&](const SlidingState& state)
      {
        return progress.record(state.invalid, state.invertedVolume, state.progress,
          [&](double* to)
          {
            std::copy_n(view.points, 3 * view.numberOfPoints, to);
            storeMovedPoints(start, state.points, to);
          });
      });
  std::vector<signed char> after = validity;
  mesh.classifyMovedCells(moved.data(), after.data(), options.threads);
  const Index invalid = countInvalid(mesh, after);
  if (invalid < result.invertedBefore)
  {
    result.points = moved;
    validity = after;
    result.invertedAfter = invalid;
  }
  progress.record(result.invertedAfter, 0.0, 1.0,
    [&](double* to) { std::copy(result.points.begin(), result.points.end(), to); });
}

//------------------------------------------------------------------------------
/// Untangles a mesh of one process.
void untangleHere(const Mesh& mesh, const UntangleOptions& options, UntangleProgress& progress,
  std::vector<signed char>& validity, UntangleResult& result)
{
  requireOrdinaryScale(mesh.view(), "Untangling");
  SimplexMesh simplices(mesh, options.fixed, nullptr, options.threads);
  if (result.invertedBefore == 0 || simplices.freeVertices() == 0)
  {
    findObstacles(mesh, simplices, validity, {}, result);
    result.reason = StopReason::NoFreeVertices;
  }
  else if (simplices.dimension() == 3)
  {
    untangleSimplices<3>(mesh, simplices, options, progress, validity, result);
  }
  else
  {
    untangleSimplices<2>(mesh, simplices, options, progress, validity, result);
  }
}

/// The same, starting from the points of the result and with other points held, if that leaves
/// fewer invalid cells.
void untangleHolding(const Mesh& mesh, const UntangleOptions& options,
  const ConstrainedPoints& constrained, UntangleProgress& progress,
  std::vector<signed char>& validity, UntangleResult& result)
{
  const Index points = mesh.view().numberOfPoints;
  std::vector<unsigned char> held(points);
  const Freedom free = mesh.dimension() == Dimension::Planar ? Freedom::Plane : Freedom::Space;
  for (Index p = 0; p < points; ++p)
  {
    held[p] = constrained.freedom(p) != free || constrained.band(p) >= 0;
  }
  UntangleOptions inner = options;
  inner.fixed = held.data();
  const std::vector<double> from = result.points;
  Mesh moved = mesh.at(from.data());
  moved.setSpace(mesh.space());
  const Index before = result.invertedBefore;
  result.invertedBefore = result.invertedAfter;
  untangleHere(moved, inner, progress, validity, result);
  result.invertedBefore = before;
}

/// The same with sliding points. They are held if that is sufficient; otherwise all points move
/// together, and then the free points alone repair the rest.
void untangleWithBoundary(const Mesh& mesh, const UntangleOptions& options,
  UntangleProgress& progress, std::vector<signed char>& validity, UntangleResult& result)
{
  requireOrdinaryScale(mesh.view(), "Untangling");
  const std::vector<unsigned char> fixed = fixedPoints(mesh, options);
  const ConstrainedPoints constrained(mesh, constraintsOf(options, fixed.data()));
  const Index points = mesh.view().numberOfPoints;
  if (result.invertedBefore > 0 && !options.onGeometry)
  {
    const std::vector<double> start = result.points;
    const std::vector<signed char> before = validity;
    untangleHolding(mesh, options, constrained, progress, validity, result);
    if (result.invertedAfter > 0 && !progress.stopped())
    {
      // Discard moves of sliding points that did not help.
      result.points = start;
      validity = before;
      result.invertedAfter = result.invertedBefore;
      result.impossible = 0;
      result.obstacles.assign(mesh.view().numberOfCells, static_cast<signed char>(Obstacle::None));
    }
  }
  if (result.invertedAfter > 0 && !progress.stopped())
  {
    slideHere(mesh, options, fixed, progress, validity, result);
  }
  if (result.invertedAfter > 0 && !progress.stopped())
  {
    untangleHolding(mesh, options, constrained, progress, validity, result);
  }
  const OffSurface off = offSurface(constrained, pointsOf(result.points.data(), points));
  result.offSurface = off.points;
  result.offSurfaceDistance = off.distance;
}
}

//------------------------------------------------------------------------------
UntangleResult untangle(const Mesh& mesh, const UntangleOptions& options, const Ranks& ranks)
{
  UntangleResult result;
  UntangleProgress progress(options, ranks, result);
  ranks.together(
    [&]
    {
      const MeshView& view = mesh.view();
      if (ranks.several() && !options.fixed && view.numberOfPoints > 0)
      {
        throw Error(
          "The fixed points of a mesh on several ranks must be specified, see rankBoundary().");
      }
      result.points.assign(view.points, view.points + 3 * view.numberOfPoints);
      result.obstacles.assign(view.numberOfCells, static_cast<signed char>(Obstacle::None));
      std::vector<signed char> validity(view.numberOfCells);
      mesh.classifyCells(validity.data(), options.threads);
      if (!ranks.several())
      {
        markFolded(mesh, validity.data());
      }
      const std::vector<signed char> before = validity;
      result.invertedBefore = result.invertedAfter = countInvalid(mesh, validity, ranks);
      const Dimension dimension = ranks.dimension(mesh);
      const bool onSurface = dimension == Dimension::Surface;
      if (result.invertedBefore > 0 && onSurface && ranks.several())
      {
        throw Error(
          "Untangling on several processes or in the reproducible order is only supported for "
          "planar and volume meshes: this is a surface in space. Gather it on one process.");
      }
      if (slides(options) && (onSurface || ranks.several()))
      {
        throw Error(onSurface
            ? "Untangling a surface in space requires a fixed boundary and does not support a "
              "geometry: fix the boundary."
            : "Untangling with a sliding boundary is only supported on one process: fix the "
              "boundary, or gather the mesh.");
      }
      if (dimension == Dimension::None || (onSurface && result.invertedBefore == 0))
      {
        return;
      }
      result.reason = StopReason::NoProgress;
      if (onSurface)
      {
        untangleSurface(
          mesh, options, progress,
          [](const Mesh& flat, const UntangleOptions& local) { return untangle(flat, local); },
          validity, result);
      }
      else if (ranks.several())
      {
        untangleRegions(mesh, options, ranks, progress, validity, result);
      }
      else if (slides(options) && options.method == UntangleMethod::Automatic)
      {
        untangleWithBoundary(mesh, options, progress, validity, result);
      }
      else
      {
        untangleHere(mesh, options, progress, validity, result);
      }
      if (result.invertedAfter == 0)
      {
        result.reason = StopReason::AllValid;
      }
      for (std::size_t cell = 0; cell < before.size(); ++cell)
      {
        const bool owned = ranks.ownsCell(static_cast<Index>(cell));
        result.newlyInvalid += owned && before[cell] == Valid && isInvalid(validity[cell]);
      }
      result.newlyInvalid = ranks.sum(result.newlyInvalid);
    });
  return result;
}
}
