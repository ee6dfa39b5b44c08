// SPDX-License-Identifier: BSD-3-Clause
#include "GlobalFunction.h"

#include "ValidityLevels.h"
#include "tautline/Mesh/JacobianBounds.h"
#include "tautline/Mesh/MeshElements.h"
#include "tautline/Objectives/ObjectiveSumState.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// The direction of a point in an array of 3 per point, which may be empty; 0 for none.
Vec3 directionOf(const std::vector<double>& directions, std::size_t p)
{
  return directions.empty()
    ? Vec3{ 0, 0, 0 }
    : Vec3{ directions[3 * p], directions[3 * p + 1], directions[3 * p + 2] };
}
}

//------------------------------------------------------------------------------
GlobalFunction::GlobalFunction(OptimizationProblem& problem, Optimizer optimizer)
  : Problem(problem)
  , Newton(optimizer == Optimizer::NewtonConjugateGradient)
  , Size(problem.moving().dimension() == Dimension::Planar ? 2 : 3)
  , Rows(problem.rows())
  , Axes(coordinateAxes(problem.moving()))
  , Slides(problem.slides())
  , Origin(problem.points())
  , Gradient(3 * problem.moving().view().numberOfPoints)
  , Objectives(problem.objectives())
  , Slopes(problem.objectives(), 1.0)
{
  if (problem.options().limits)
  {
    this->Outward.assign(this->Origin.size(), 0.0);
    this->Shortened.assign(this->Origin.size() / 3, 1.0);
  }
  if (problem.moving().dimension() == Dimension::Surface)
  {
    this->Surface = std::make_unique<SurfaceSlides>(problem);
    this->Origin = problem.points();
  }
  if (this->bends())
  {
    this->move(std::vector<double>(this->Size * this->Rows.rows(), 0.0).data());
  }
  for (const Objective& objective : problem.resolved())
  {
    this->Stand.push_back(needsDifferences(objective.metric)
        ? std::make_unique<ObjectiveSum>(
            problem.moving(), Objective(), problem.options().threads, problem.ranks())
        : nullptr);
  }
  findValidityLevels(problem.moving(), problem.options().threads, this->Start);
  // An objective that is infinite on inverted elements needs no other check if validity is decided
  // at the corners.
  const bool someInvalid = std::any_of(
    this->Start.begin(), this->Start.end(), [](signed char v) { return v != ValidThroughout; });
  const std::vector<CellBlock>& blocks = problem.moving().blocks();
  const bool inside = std::any_of(
    blocks.begin(), blocks.end(), [](const CellBlock& block) { return hasInside(block.type); });
  this->Check = !problem.options().allowInversion;
  for (std::size_t i = 0; i < problem.objectives() && !someInvalid && !inside; ++i)
  {
    const Fault fault = problem.sum(i).state().function.fault;
    const bool all = !problem.sum(i).objective().elementWeights;
    this->Check =
      this->Check && !(all && (fault == Fault::NotPositive || fault == Fault::Jacobian));
  }
}

//------------------------------------------------------------------------------
std::size_t GlobalFunction::size() const
{
  return this->Size * this->Rows.numberOfOwned();
}

/// Whether positions may differ from the start plus the steps.
bool GlobalFunction::bends() const
{
  return this->Surface || !this->Outward.empty();
}

/// Calls visit(row, point) for each free point.
template <class Visit>
void GlobalFunction::forEachFree(const Visit& visit) const
{
  const SimplexMesh& s = this->Problem.simplices();
  for (std::int32_t v = 0; v < s.freeVertices(); ++v)
  {
    const auto p = static_cast<std::size_t>(s.point(v));
    visit(static_cast<std::size_t>(this->Rows.rowOfPoint()[p]), p);
  }
}

//------------------------------------------------------------------------------
/// Moves only the points of the problem. @param x of all rows
void GlobalFunction::move(const double* x)
{
  this->forEachFree(
    [&](std::size_t i, std::size_t p)
    {
      for (int c = 0; c < 3; ++c)
      {
        double sum = this->Origin[3 * p + c];
        for (int a = 0; a < this->Size; ++a)
        {
          sum += x[this->Size * i + a] * this->Axes[a][c];
        }
        this->Problem.points()[3 * p + c] = sum;
      }
      if (!this->Outward.empty())
      {
        this->keepLimit(p);
      }
    });
  if (this->Surface)
  {
    this->Surface->place();
  }
}

//------------------------------------------------------------------------------
/// Moves a point back to its limit. At the limit, outward steps do not change values; inward steps
/// are left to sweeps, because the gradient there may differ between ranks.
void GlobalFunction::keepLimit(std::size_t p)
{
  double* x = &this->Problem.points()[3 * p];
  const double* start = this->Problem.start() + 3 * p;
  const Vec3 way = { x[0] - start[0], x[1] - start[1], x[2] - start[2] };
  const double limit = this->Problem.limitOf(p), length = norm(way);
  const bool at = length >= insideLimit * limit && length > 0;
  this->Shortened[p] = length > limit ? limit / length : 1.0;
  for (int c = 0; c < 3; ++c)
  {
    this->Outward[3 * p + c] = at ? way[c] / length : 0.0;
    x[c] = length > limit ? start[c] + this->Shortened[p] * way[c] : x[c];
  }
}

Vec3 GlobalFunction::outwardOf(std::size_t p) const
{
  return directionOf(this->Outward, p);
}

//------------------------------------------------------------------------------
void GlobalFunction::put(const double* x)
{
  this->move(this->Rows.spread(x, this->All, this->Size));
  this->Problem.simplices().load(this->Problem.points().data(), this->Problem.options().threads);
  this->Problem.coordinatesChanged();
  // Update points of the piece without a local cell.
  this->Problem.ranks().exchange(this->Problem.points().data(), 3);
}

//------------------------------------------------------------------------------
/// No element is less valid than it was at the start.
bool GlobalFunction::allowed()
{
  bool allowed =
    !(this->Surface && !this->Problem.options().allowInversion && this->Surface->turned());
  if (allowed && this->Check)
  {
    findValidityLevels(this->Problem.moving(), this->Problem.options().threads, this->Levels);
    allowed = std::equal(this->Levels.begin(), this->Levels.end(), this->Start.begin(),
      [](signed char now, signed char before) { return now >= before; });
  }
  return !this->Problem.ranks().any(!allowed);
}

//------------------------------------------------------------------------------
bool GlobalFunction::hasConstraints() const
{
  return !this->Slides.lines.empty() || !this->Slides.planes.empty() ||
    !this->Slides.held.empty() || !this->Outward.empty() || this->Surface;
}

bool GlobalFunction::isHeld(std::size_t p) const
{
  return (!this->Slides.held.empty() && this->Slides.held[p]) || this->Problem.limitOf(p) == 0;
}

//------------------------------------------------------------------------------
/// The component of a vector that a point may follow: in the plane of a planar mesh, along its line
/// or plane.
Vec3 GlobalFunction::project(std::size_t p, Vec3 g) const
{
  if (this->isHeld(p))
  {
    return { 0, 0, 0 };
  }
  if (this->Surface)
  {
    g = this->Surface->project(p, g);
  }
  if (this->Problem.moving().dimension() == Dimension::Planar)
  {
    const Vec3& normal = this->Problem.moving().normal();
    g = g - dot(g, normal) * normal;
  }
  const auto along = [&g](const Vec3& n) { return (dot(g, n) / dot(n, n)) * n; };
  const Vec3 line = directionOf(this->Slides.lines, p), plane = directionOf(this->Slides.planes, p);
  g = dot(line, line) > 0 ? along(line) : dot(plane, plane) > 0 ? g - along(plane) : g;
  const Vec3 outward = this->outwardOf(p);
  return dot(outward, outward) > 0 ? g - along(outward) : g;
}

//------------------------------------------------------------------------------
double GlobalFunction::valueAndGradient(const double* x, double* gradient)
{
  this->move(this->Rows.spread(x, this->All, this->Size));
  const double infinity = std::numeric_limits<double>::infinity();
  if (!this->allowed())
  {
    return infinity;
  }
  const std::size_t n = this->Objectives.size();
  double value = 0;
  if (n > 1)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      this->Objectives[i] = this->Problem.sum(i).value();
    }
    value = this->Problem.scalarizer().value(this->Objectives, this->Slopes);
    if (!std::isfinite(value))
    {
      return infinity;
    }
  }
  std::fill(this->Gradient.begin(), this->Gradient.end(), 0.0);
  for (std::size_t i = 0; i < n; ++i)
  {
    const double own = this->Problem.sum(i).addGradient(this->Slopes[i], this->Gradient.data());
    value = n == 1 ? own : value;
  }
  this->takeGradient(this->Rows.target(gradient, this->Product, this->Size));
  this->Rows.pick(this->Product, gradient, this->Size);
  return std::isnan(value) ? infinity : value;
}

//------------------------------------------------------------------------------
/// The gradient of the free points, along their allowed directions.
void GlobalFunction::takeGradient(double* gradient) const
{
  this->forEachFree(
    [&](std::size_t i, std::size_t p)
    {
      const double* full = this->Gradient.data() + 3 * p;
      const double scale = this->Shortened.empty() ? 1.0 : this->Shortened[p];
      const Vec3 g = scale * this->project(p, { full[0], full[1], full[2] });
      for (int a = 0; a < this->Size; ++a)
      {
        gradient[this->Size * i + a] = dot(g, this->Axes[a]);
      }
    });
}

//------------------------------------------------------------------------------
/// Allocates the memory for the Hessian.
void GlobalFunction::makeMatrix()
{
  std::vector<std::int32_t> rows(this->Problem.moving().view().numberOfPoints, -1);
  this->forEachFree([&](std::size_t i, std::size_t p) { rows[p] = static_cast<std::int32_t>(i); });
  const Ranks& ranks = this->Problem.ranks();
  ranks.inMemory(
    [&]
    {
      this->Hessian =
        std::make_unique<HessianMatrix>(this->Problem.moving(), std::move(rows), this->Rows.rows(),
          this->Newton ? HessianMatrix::Pattern::Full : HessianMatrix::Pattern::Diagonal,
          this->Problem.options().threads);
    },
    "The matrix of Newton's method does not fit into memory: choose another optimizer, such as "
    "Local Newton, or use more processes.");
  this->Hessian->setOrderless(ranks.several() && !this->Newton);
}

//------------------------------------------------------------------------------
/// Restricts a sliding point to its line or plane, and fixes a held point.
void GlobalFunction::restrict(std::size_t row, std::size_t p)
{
  const Vec3 line = directionOf(this->Slides.lines, p), plane = directionOf(this->Slides.planes, p);
  const Vec3 outward = this->outwardOf(p);
  if (!this->isHeld(p) && !(dot(line, line) > 0) && !(dot(plane, plane) > 0) &&
    !(dot(outward, outward) > 0) && !this->Surface)
  {
    return;
  }
  double projector[9];
  for (int a = 0; a < this->Size; ++a)
  {
    const Vec3 along = this->project(p, this->Axes[a]);
    for (int b = 0; b < this->Size; ++b)
    {
      projector[this->Size * a + b] = dot(along, this->Axes[b]);
    }
  }
  this->Hessian->restrict(static_cast<Index>(row), projector);
}

//------------------------------------------------------------------------------
/// The Hessian with the slopes of the last gradient, or its positive semidefinite part.
void GlobalFunction::fillMatrix()
{
  this->Hessian->clear();
  // With the positive semidefinite part of each Hessian, no Newton direction needs a shift, and
  // multigrid solves the systems.
  bool convex = this->Newton;
  for (std::size_t i = 0; i < this->Objectives.size(); ++i)
  {
    convex =
      convex && this->Slopes[i] >= 0 && HessianMatrix::hasConvexPart(this->Problem.resolved()[i]);
  }
  this->Convex = !this->Problem.ranks().any(!convex);
  for (std::size_t i = 0; i < this->Objectives.size(); ++i)
  {
    const ObjectiveSum& sum = this->Stand[i] ? *this->Stand[i] : this->Problem.sum(i);
    this->Convex ? this->Hessian->addConvexPart(sum, this->Slopes[i])
                 : this->Hessian->add(sum, this->Slopes[i]);
  }
  if (this->hasConstraints())
  {
    this->forEachFree(
      [&](std::size_t i, std::size_t p)
      {
        this->bendAtLimit(i, p);
        this->restrict(i, p);
      });
  }
}

//------------------------------------------------------------------------------
/// Adds the second derivative along the limit, which is a sphere: an outward force pulls a point
/// along the sphere toward the position farthest in its direction.
void GlobalFunction::bendAtLimit(std::size_t row, std::size_t p)
{
  const Vec3 outward = this->outwardOf(p);
  const double limit = this->Problem.limitOf(p);
  if (!(dot(outward, outward) > 0) || !(limit > 0))
  {
    return;
  }
  const double* g = &this->Gradient[3 * p];
  const double force = -dot(Vec3{ g[0], g[1], g[2] }, outward);
  this->Hessian->addToDiagonal(static_cast<Index>(row), std::max(0.0, force) / limit);
}

//------------------------------------------------------------------------------
/// Makes the points moved by put() the origin of further steps: points at limits and on surfaces
/// are not at the start plus the steps. @param x of all rows
void GlobalFunction::rebase(const double* x)
{
  this->forEachFree(
    [&](std::size_t i, std::size_t p)
    {
      for (int c = 0; c < 3; ++c)
      {
        double by = 0;
        for (int a = 0; a < this->Size; ++a)
        {
          by += x[this->Size * i + a] * this->Axes[a][c];
        }
        this->Origin[3 * p + c] = this->Problem.points()[3 * p + c] - by;
      }
    });
  if (this->Surface)
  {
    this->Surface->keepNormals();
  }
}

//------------------------------------------------------------------------------
void GlobalFunction::linearize(const double* x)
{
  if (this->Problem.ranks().any(this->bends()))
  {
    this->put(x);
    this->rebase(this->Rows.spread(x, this->All, this->Size));
  }
  if (!this->Hessian)
  {
    this->makeMatrix();
  }
  this->fillMatrix();
  if (!this->Convex)
  {
    this->Hessian->factorize();
    return;
  }
  if (!this->Grids)
  {
    this->Grids = makeGrids(this->Rows, this->Problem.options().threads);
  }
  this->Grids->build(this->Hessian->view());
}

//------------------------------------------------------------------------------
/// Removes the components of steps that leave the planes and lines of the points.
void GlobalFunction::keepSlides(double* d) const
{
  this->forEachFree(
    [&](std::size_t i, std::size_t p)
    {
      double* of = d + this->Size * i;
      Vec3 step = { 0, 0, 0 };
      for (int a = 0; a < this->Size; ++a)
      {
        step += of[a] * this->Axes[a];
      }
      step = this->project(p, step);
      for (int a = 0; a < this->Size; ++a)
      {
        of[a] = dot(step, this->Axes[a]);
      }
    });
}

//------------------------------------------------------------------------------
bool GlobalFunction::precondition(const double* r, double* z)
{
  if (this->Convex)
  {
    this->Grids->apply(r, z);
  }
  else if (!this->Problem.ranks().several())
  {
    this->Hessian->precondition(r, z);
  }
  else
  {
    this->Hessian->preconditionByDiagonal(
      this->Rows.place(r, this->All, this->Size), this->Rows.target(z, this->Product, this->Size));
    this->Rows.pick(this->Product, z, this->Size);
  }
  if (this->hasConstraints())
  {
    // The coarse grids of multigrid ignore the planes and lines of the points.
    this->Rows.place(z, this->All, this->Size);
    this->keepSlides(this->Rows.target(z, this->All, this->Size));
    this->Rows.pick(this->All, z, this->Size);
  }
  return true;
}

//------------------------------------------------------------------------------
bool GlobalFunction::hessianTimes(const double* d, double* product)
{
  if (!this->Newton)
  {
    return false;
  }
  this->Hessian->times(this->Rows.spread(d, this->All, this->Size),
    this->Rows.target(product, this->Product, this->Size));
  this->Rows.pick(this->Product, product, this->Size);
  return true;
}
}
