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
GlobalFunction::GlobalFunction(OptimizationProblem& problem, Optimizer optimizer,
  std::vector<std::int32_t> rowOfPoint, Index rows)
  : Problem(problem)
  , Newton(optimizer == Optimizer::NewtonConjugateGradient)
  , Size(problem.moving().dimension() == Dimension::Planar ? 2 : 3)
  , RowOfPoint(std::move(rowOfPoint))
  , Rows(RowOfPoint.empty() ? problem.simplices().freeVertices() : rows)
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
    this->move(std::vector<double>(this->size(), 0.0).data());
  }
  findValidityLevels(problem.moving(), problem.options().threads, this->Start);
  // An objective that is infinite on inverted elements needs no other check, if these have no
  // inside.
  const bool someInvalid = std::any_of(
    this->Start.begin(), this->Start.end(), [](signed char v) { return v != ValidThroughout; });
  const std::vector<CellBlock>& blocks = problem.moving().blocks();
  const bool inside = std::any_of(
    blocks.begin(), blocks.end(), [](const CellBlock& block) { return hasInside(block.type); });
  this->Check = !problem.options().allowInversion;
  for (std::size_t i = 0; i < problem.objectives() && !someInvalid && !inside; ++i)
  {
    if (!this->hasElements(i))
    {
      continue;
    }
    const Fault fault = problem.sum(i).state().function.fault;
    const bool all = !problem.sum(i).objective().elementWeights;
    this->Check =
      this->Check && !(all && (fault == Fault::NotPositive || fault == Fault::Jacobian));
  }
}

//------------------------------------------------------------------------------
std::size_t GlobalFunction::size() const
{
  return static_cast<std::size_t>(this->Size * this->Rows);
}

/// Whether the objective has elements here. A part of a mesh may have none; its sum would be
/// refused.
bool GlobalFunction::hasElements(std::size_t objective) const
{
  if (this->RowOfPoint.empty())
  {
    return true;
  }
  const Objective& o = this->Problem.resolved()[objective];
  for (const CellBlock& block : this->Problem.moving().blocks())
  {
    const bool counts =
      isElement(this->Problem.moving(), block.type) && metricInfo(o.metric).definedOn(block.type);
    for (Index i = 0; counts && i < block.count; ++i)
    {
      if (!o.elementWeights || o.elementWeights[block.cell(i)] > 0)
      {
        return true;
      }
    }
  }
  return false;
}

template <class Visit>
void GlobalFunction::forEachFree(const Visit& visit) const
{
  const SimplexMesh& s = this->Problem.simplices();
  for (std::int32_t v = 0; v < s.freeVertices(); ++v)
  {
    const auto p = static_cast<std::size_t>(s.point(v));
    visit(this->RowOfPoint.empty() ? static_cast<std::size_t>(v)
                                   : static_cast<std::size_t>(this->RowOfPoint[p]),
      p);
  }
}

//------------------------------------------------------------------------------
/// Sets the free points.
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
/// Takes a point back to its limit. At the limit, values do not change with steps outwards; those
/// inwards are left to sweeps, as the gradient there need not be the same on all ranks.
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
  this->move(x);
  this->Problem.simplices().load(this->Problem.points().data(), this->Problem.options().threads);
  this->Problem.coordinatesChanged();
}

//------------------------------------------------------------------------------
/// No element is less valid than it was at the start.
bool GlobalFunction::allowed()
{
  if (this->Surface && !this->Problem.options().allowInversion && this->Surface->turned())
  {
    return false;
  }
  if (!this->Check)
  {
    return true;
  }
  findValidityLevels(this->Problem.moving(), this->Problem.options().threads, this->Levels);
  return std::equal(this->Levels.begin(), this->Levels.end(), this->Start.begin(),
    [](signed char now, signed char before) { return now >= before; });
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
/// The part of a vector a point may follow: in a planar mesh's plane, along its line or plane.
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
  this->move(x);
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
  this->takeGradient(gradient);
  return std::isnan(value) ? infinity : value;
}

//------------------------------------------------------------------------------
/// Of the points that are free, along what they may follow.
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
void GlobalFunction::findTerms(std::size_t objective, double* terms)
{
  if (this->hasElements(objective))
  {
    this->Problem.sum(objective).state().findTerms(1.0, nullptr, terms);
  }
  else
  {
    std::fill_n(terms, this->Problem.moving().view().numberOfCells, 0.0);
  }
}

void GlobalFunction::findGradient(
  const std::vector<double>& slopes, double* gradient, double* terms)
{
  this->Slopes = slopes;
  std::fill(this->Gradient.begin(), this->Gradient.end(), 0.0);
  OrderlessSums sums(this->Gradient.data(), this->Gradient.size());
  for (std::size_t i = slopes.size(); i-- > 0;) // at last the first, whose terms are wanted
  {
    if (this->hasElements(i))
    {
      this->Problem.sum(i).state().findTerms(slopes[i], &sums, terms);
    }
    else
    {
      this->findTerms(i, terms);
    }
  }
  sums.finish();
  this->takeGradient(gradient);
}

//------------------------------------------------------------------------------
void GlobalFunction::makeMatrix()
{
  std::vector<std::int32_t> rows(this->Problem.moving().view().numberOfPoints, -1);
  this->forEachFree([&](std::size_t i, std::size_t p) { rows[p] = static_cast<std::int32_t>(i); });
  this->Hessian = std::make_unique<HessianMatrix>(this->Problem.moving(), std::move(rows),
    this->Rows, this->Newton ? HessianMatrix::Pattern::Full : HessianMatrix::Pattern::Diagonal,
    this->Problem.options().threads);
  this->Hessian->setOrderless(!this->RowOfPoint.empty() && !this->Newton);
}

//------------------------------------------------------------------------------
/// Lets a point that slides move along its line or plane only, and one that is held not at all.
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
bool GlobalFunction::fillMatrix()
{
  this->Hessian->clear();
  // With the positive semidefinite part of each Hessian no direction of Newton's method needs a
  // shift, and multigrid solves its systems.
  bool convex = this->Newton;
  for (std::size_t i = 0; i < this->Objectives.size(); ++i)
  {
    convex =
      convex && this->Slopes[i] >= 0 && HessianMatrix::hasConvexPart(this->Problem.resolved()[i]);
  }
  for (std::size_t i = 0; i < this->Objectives.size(); ++i)
  {
    if (this->hasElements(i))
    {
      convex ? this->Hessian->addConvexPart(this->Problem.sum(i), this->Slopes[i])
             : this->Hessian->add(this->Problem.sum(i), this->Slopes[i]);
    }
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
  return convex;
}

//------------------------------------------------------------------------------
/// Adds the second derivative of a way along the limit, which is a sphere: a force that draws a
/// point outwards by so much draws it back to where the limit is farthest out.
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
void GlobalFunction::rebase(const double* x)
{
  if (!this->bends())
  {
    return;
  }
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
  if (this->bends())
  {
    this->put(x);
    this->rebase(x);
  }
  if (!this->Hessian)
  {
    this->makeMatrix();
  }
  const bool convex = this->fillMatrix();
  convex ? this->Hessian->factorizeByMultigrid() : this->Hessian->factorize();
}

//------------------------------------------------------------------------------
void GlobalFunction::keepSlides(double* d) const
{
  if (!this->hasConstraints())
  {
    return;
  }
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
  this->Hessian->precondition(r, z);
  // The coarse grids of multigrid do not have the planes and lines of the points.
  this->keepSlides(z);
  return true;
}

//------------------------------------------------------------------------------
bool GlobalFunction::hessianTimes(const double* d, double* product)
{
  if (!this->Newton)
  {
    return false;
  }
  this->Hessian->times(d, product);
  return true;
}
}
