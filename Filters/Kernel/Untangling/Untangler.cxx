// SPDX-License-Identifier: BSD-3-Clause
#include "Untangler.h"

#include "GlobalDescent.h"
#include "HarmonicMap.h"
#include "InfeasibleSimplices.h"
#include "RotationContinuation.h"
#include "tautline/Core/Interruption.h"

#include <limits>

namespace tautline
{
namespace
{
// Tolerances of the harmonic maps used as initial meshes.
constexpr double harmonicTolerance = 1e-3, tightHarmonicTolerance = 1e-6;

/// The iteration limit of an effort, for all phases together.
int iterationLimit(Effort effort)
{
  constexpr int local = 60, normal = 1500, thorough = 5000;
  return effort == Effort::Local ? local : effort == Effort::Normal ? normal : thorough;
}
}

//------------------------------------------------------------------------------
template <int Dim>
Untangler<Dim>::Untangler(const Mesh& mesh, SimplexMesh& simplices, const UntangleOptions& options,
  UntangleProgress& progress)
  : View(mesh.view())
  , Simplices(simplices)
  , Options(options)
  , Tangled(simplices, options.threads)
  , Progress(progress)
  , OnlySimplices(std::all_of(mesh.blocks().begin(), mesh.blocks().end(),
      [](const CellBlock& block)
      { return topology(block.type).dimension != Dim || topology(block.type).samples == 1; }))
  , Coordinates(static_cast<std::size_t>(VertexStride) * simplices.vertices())
  , Start(simplices.coordinates(), simplices.coordinates() + Coordinates)
  , Best(Start)
  , Active(simplices.freeVertices())
{
}

template <int Dim>
void Untangler<Dim>::record()
{
  // While fixed vertices are displaced, no coordinates are accepted as better.
  const double* x = this->Continuing ? this->Best.data() : this->x();
  const Index invalid = this->Continuing ? this->FewestInvalid : this->invalidCells();
  const int iteration = this->Progress.iteration();
  if (!this->Continuing && (iteration == 0 || invalid < this->FewestInvalid))
  {
    this->FewestInvalid = invalid;
    std::copy_n(x, this->Coordinates, this->Best.begin());
  }
  const auto points = [this, x](double* to)
  {
    std::copy_n(this->View.points, 3 * this->View.numberOfPoints, to);
    this->Simplices.store(x, to, this->Options.threads);
  };
  const int limit = iterationLimit(this->Options.effort);
  const double fraction = static_cast<double>(iteration) / limit;
  if (this->Progress.record(invalid, this->State.invertedVolume, fraction, points) &&
    iteration >= limit)
  {
    this->Progress.stop(StopReason::IterationLimit);
  }
}

template <int Dim>
void Untangler<Dim>::setCoordinates(const std::vector<double>& from)
{
  std::copy(from.begin(), from.end(), this->x());
  this->examine();
}

template <int Dim>
std::vector<double> Untangler<Dim>::coordinates() const
{
  return std::vector<double>(this->x(), this->x() + this->Coordinates);
}

template <int Dim>
double Untangler<Dim>::invalidFraction() const
{
  return static_cast<double>(this->State.invalid) / std::max(1, this->Simplices.simplices());
}

//------------------------------------------------------------------------------
template <int Dim>
Index Untangler<Dim>::invalidCells() const
{
  const MeshState& state = this->State;
  if (this->OnlySimplices)
  {
    return state.invalid + static_cast<Index>(state.infeasible.size());
  }
  std::vector<Index> ids;
  ids.reserve(state.simplices.size() + state.infeasible.size());
  for (const std::vector<std::int32_t>* list : { &state.simplices, &state.infeasible })
  {
    for (std::int32_t s : *list)
    {
      ids.push_back(this->Simplices.cell(s));
    }
  }
  std::sort(ids.begin(), ids.end());
  return std::unique(ids.begin(), ids.end()) - ids.begin();
}

/// Marks the free vertices of invalid simplices and the given number of rings around them.
template <int Dim>
void Untangler<Dim>::markActive(int rings)
{
  const std::int32_t free = this->Simplices.freeVertices();
  std::fill(this->Active.begin(), this->Active.end(), 0);
  std::vector<std::int32_t> front, next;
  const auto mark = [&](std::int32_t v, std::vector<std::int32_t>& to)
  {
    if (v < free && !this->Active[v])
    {
      this->Active[v] = 1;
      to.push_back(v);
    }
  };
  for (std::int32_t s : this->State.simplices)
  {
    for (int k = 0; k <= Dim; ++k)
    {
      mark(this->Simplices.corners()[static_cast<std::size_t>(Dim + 1) * s + k], front);
    }
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    next.clear();
    for (std::int32_t v : front)
    {
      const std::size_t end = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v + 1);
      for (std::size_t i = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v); i < end;
           ++i)
      {
        mark(this->Simplices.patchVertices()[i], next);
      }
    }
    front.swap(next);
  }
}

//------------------------------------------------------------------------------
/// Moves the vertices around the invalid simplices one by one.
template <int Dim>
void Untangler<Dim>::sweepLocally(const SweepLimits& limits)
{
  // Over time, more vertices are moved; the linear programs are used for the few remaining
  // simplices.
  constexpr int steps = 4, maxRings = 4, sweepsPerRing = 2;
  constexpr double few = 0.02;
  Index fewest = this->State.invalid;
  int without = 0;
  for (int sweep = 0; sweep < limits.sweeps && !this->done() && without < limits.patience; ++sweep)
  {
    this->markActive(std::min(maxRings, (sweep + 1) / sweepsPerRing));
    const bool tryCenter = sweep > 0 && this->invalidFraction() < few;
    this->Tangled.sweep(this->Active.data(),
      [&](std::int32_t v, Patch<Dim>& patch)
      { this->Tangled.relax(this->x(), v, steps, tryCenter, patch); });
    this->examine();
    this->record();
    const bool better =
      static_cast<double>(this->State.invalid) <= limits.progress * static_cast<double>(fewest);
    without = better ? 0 : without + 1;
    fewest = better ? this->State.invalid : fewest;
  }
}

//------------------------------------------------------------------------------
/// Excludes contradicting simplices at the vertices of invalid ones.
template <int Dim>
void Untangler<Dim>::excludeInfeasible()
{
  this->markActive(0);
  const std::vector<std::int32_t> infeasible =
    findInfeasible<Dim>(this->Tangled, this->x(), this->Active);
  if (!infeasible.empty())
  {
    this->Tangled.exclude(infeasible);
    this->Infeasible.insert(this->Infeasible.end(), infeasible.begin(), infeasible.end());
    this->examine();
  }
}

//------------------------------------------------------------------------------
/// Whether a vertex of a simplex has moved from its input position.
template <int Dim>
bool Untangler<Dim>::moved(std::int32_t simplex) const
{
  const std::int32_t* corner =
    this->Simplices.corners() + static_cast<std::size_t>(Dim + 1) * simplex;
  return std::any_of(corner, corner + Dim + 1,
    [&](std::int32_t v)
    {
      const std::size_t i = VertexStride * static_cast<std::size_t>(v);
      return !std::equal(&this->Start[i], &this->Start[i] + Dim, this->x() + i);
    });
}

/// Improves the shape of the worst simplices that moved; none becomes invalid.
template <int Dim>
void Untangler<Dim>::smoothWorst()
{
  constexpr int sweeps = 2, steps = 2;
  constexpr double poor = 1e-2;
  for (int sweep = 0; sweep < sweeps && !this->stopped(); ++sweep)
  {
    // With a wide margin, poor simplices count as invalid.
    const double margin = this->Tangled.margin();
    this->Tangled.setMargin(std::max(margin, poor));
    this->examine();
    this->Tangled.setMargin(margin);
    auto& simplices = this->State.simplices;
    simplices.erase(std::remove_if(simplices.begin(), simplices.end(),
                      [&](std::int32_t s) { return !this->moved(s); }),
      simplices.end());
    this->markActive(0);
    this->Tangled.sweep(this->Active.data(),
      [&](std::int32_t v, Patch<Dim>& patch)
      { this->Tangled.relax(this->x(), v, steps, false, patch); });
    this->examine();
  }
}

/// Reduces the energy of a valid mesh slightly; it remains valid.
template <int Dim>
void Untangler<Dim>::smoothAll()
{
  constexpr int iterations = 6;
  if (!this->untangled())
  {
    return;
  }
  GlobalDescent<Dim> descent(this->Tangled);
  descent.start(this->x(), 0.0);
  for (int k = 0; k < iterations && !this->stopped(); ++k)
  {
    const std::vector<double> keep = this->coordinates();
    if (!descent.step(this->x()))
    {
      break;
    }
    this->examine();
    this->record();
    if (!this->untangled())
    {
      this->setCoordinates(keep); // positive, but not by the margin
      break;
    }
  }
}

//------------------------------------------------------------------------------
/// Minimizes the energy of the whole mesh for a falling sequence of regularizations. Between the
/// solves, local sweeps try to finish; if they fail, their moves are undone.
template <int Dim>
void Untangler<Dim>::descend(const Regularization& schedule)
{
  constexpr double few = 0.02;
  GlobalDescent<Dim> descent(this->Tangled);
  double eps = schedule.eps;
  for (int solve = 0; solve < schedule.solves && !this->done(); ++solve, eps *= schedule.factor)
  {
    descent.start(this->x(), eps);
    double energy = descent.energy();
    for (int k = 0; k < schedule.iterations && !this->done(); ++k)
    {
      const bool moved = descent.step(this->x());
      this->examine();
      this->record();
      const double next = descent.energy();
      if (!moved || energy - next < schedule.tolerance * energy)
      {
        break;
      }
      energy = next;
    }
    if (!this->done() && this->invalidFraction() < few)
    {
      const std::vector<double> keep = this->coordinates();
      this->sweepLocally(SweepLimits());
      if (!this->untangled())
      {
        this->setCoordinates(keep);
      }
    }
  }
}

/// Sets the coordinates to the harmonic map; false if no vertex is fixed.
template <int Dim>
bool Untangler<Dim>::startHarmonic(double tolerance)
{
  constexpr int iterations = 1000;
  const bool held =
    harmonicMap<Dim>(this->Simplices, this->x(), tolerance, iterations, this->Tangled.threads());
  this->examine();
  this->record();
  return held;
}

//------------------------------------------------------------------------------
/// For rotated holes: starts with a mesh in which the holes are rotated back and moves them step by
/// step to their positions; the mesh is valid after each step. Ends with the fixed vertices at
/// their original positions.
template <int Dim>
void Untangler<Dim>::continueRotation(double tolerance)
{
  constexpr double largestStep = 0.27, smallestStep = 0.01; // radians
  constexpr double growth = 1.5;
  const RotationContinuation<Dim> rotation(this->Tangled, this->x(), tolerance);
  if (rotation.empty())
  {
    return;
  }
  this->Continuing = true;
  this->setCoordinates(rotation.start());
  this->untangleAll();
  this->smoothAll();
  const double largest = largestStep / rotation.largestAngle();
  const double smallest = smallestStep / rotation.largestAngle();
  double fraction = 0, step = largest;
  while (fraction < 1.0 && this->untangled() && !this->stopped())
  {
    // Shorten the step if the elements do not become valid.
    step = std::min(step, 1.0 - fraction);
    const std::vector<double> keep = this->coordinates();
    rotation.advance(step, this->x());
    this->examine();
    this->untangleNearby();
    if (this->untangled())
    {
      fraction += step;
      step = std::min(largest, growth * step);
    }
    else
    {
      this->setCoordinates(keep);
      step *= 0.5;
      if (step < smallest)
      {
        break;
      }
    }
    this->smoothAll();
  }
  this->Continuing = false;
  const std::size_t free = VertexStride * static_cast<std::size_t>(this->Simplices.freeVertices());
  std::copy(
    this->Start.begin() + static_cast<std::ptrdiff_t>(free), this->Start.end(), this->x() + free);
  this->examine();
  if (!this->stopped())
  {
    this->record();
    this->untangleNearby();
  }
}

//------------------------------------------------------------------------------
/// Local sweeps, then regularizations of the magnitude of the worst determinant, which preserve
/// most of the mesh.
template <int Dim>
void Untangler<Dim>::untangleNearby()
{
  constexpr double ofWorst = 0.3, minEps = 1e-3;
  this->sweepLocally(SweepLimits());
  Regularization nearby;
  nearby.eps = std::max(ofWorst * std::abs(this->State.minDeterminant), minEps);
  nearby.solves = 1;
  nearby.iterations = 6;
  this->descend(nearby);
}

/// Local sweeps, then the usual schedule.
template <int Dim>
void Untangler<Dim>::untangleAll()
{
  this->sweepLocally(SweepLimits());
  this->descend(Regularization());
}

/// Moves all vertices at once, from several initial meshes in turn.
template <int Dim>
void Untangler<Dim>::untangleGlobally()
{
  constexpr double ofWorst = 0.1, few = 0.002;
  const std::vector<double> before = this->coordinates();
  const double relativeEps = ofWorst * std::abs(this->State.minDeterminant);

  // For a few invalid simplices: a short attempt that hardly moves the others.
  if (this->invalidFraction() < few)
  {
    Regularization brief;
    brief.eps = std::max(relativeEps, this->Tangled.margin());
    brief.factor = 1.0;
    brief.solves = 2;
    brief.iterations = 8;
    this->descend(brief);
  }
  if (!this->done() && this->startHarmonic(harmonicTolerance))
  {
    this->untangleAll();
  }
  if (!this->done())
  {
    this->setCoordinates(before);
    this->continueRotation(harmonicTolerance);
  }
  if (!this->done())
  {
    this->setCoordinates(before);
    Regularization usual;
    usual.eps = std::max(usual.eps, relativeEps);
    this->descend(usual);
  }
  if (this->Options.effort == Effort::Thorough)
  {
    constexpr double larger = 10.0;
    this->untangleThoroughly(before, std::max(larger * Regularization().eps, relativeEps));
  }
}

/// Slower schedules, from the input and from an accurate harmonic map.
template <int Dim>
void Untangler<Dim>::untangleThoroughly(const std::vector<double>& before, double firstEps)
{
  Regularization slow;
  slow.eps = firstEps;
  slow.factor = 0.7;
  slow.solves = 30;
  Regularization slower;
  slower.eps = firstEps;
  slower.factor = 0.8;
  slower.tolerance = 1e-4;
  slower.solves = 40;
  slower.iterations = 60;
  for (const Regularization& schedule : { slow, slower })
  {
    if (!this->done())
    {
      this->setCoordinates(this->Start);
      this->descend(schedule);
    }
    if (!this->done())
    {
      this->setCoordinates(before);
      this->startHarmonic(tightHarmonicTolerance);
      this->descend(schedule);
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
const double* Untangler<Dim>::run(double margin)
{
  this->Tangled.setMargin(margin);
  this->examine();
  this->forgetBest();
  this->record();
  // Thrown to end a sweep or a harmonic map of a large mesh where it polls.
  struct OutOfTime
  {
  };
  try
  {
    const PollScope scope(
      [this]
      {
        if (this->Progress.late())
        {
          throw OutOfTime();
        }
      });
    if (this->Options.method == UntangleMethod::Simultaneous)
    {
      this->untangleSimultaneously();
    }
    else
    {
      this->untangleAutomatically();
    }
  }
  catch (const OutOfTime&)
  {
    this->Progress.stop(StopReason::TimeLimit);
    this->Continuing = false;
    this->Tangled.setMargin(margin);
  }
  std::copy(this->Best.begin(), this->Best.end(), this->x());
  this->examine();
  return this->x();
}

/// Sweeps over all vertices until the energy of a valid mesh has converged.
template <int Dim>
void Untangler<Dim>::untangleSimultaneously()
{
  constexpr int sweeps = 100, steps = 4;
  constexpr double tolerance = 1e-3;
  GlobalDescent<Dim> function(this->Tangled);
  double energy = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < sweeps && !this->stopped(); ++sweep)
  {
    this->Tangled.sweep(nullptr,
      [&](std::int32_t v, Patch<Dim>& patch)
      { this->Tangled.relax(this->x(), v, steps, false, patch, true); });
    this->examine();
    if (this->untangled())
    {
      this->forgetBest(); // the last valid mesh is the smoothest
    }
    this->record();
    if (this->untangled())
    {
      function.start(this->x(), 0.0);
      if (energy - function.energy() < tolerance * energy)
      {
        break;
      }
      energy = function.energy();
    }
  }
  if (!this->untangled() && !this->stopped())
  {
    this->excludeInfeasible(); // for the obstacles of the remaining elements
  }
}

/// Local moves around the invalid simplices, then all vertices at once for the rest.
template <int Dim>
void Untangler<Dim>::untangleAutomatically()
{
  // For few invalid simplices: first, only the vertices around them.
  constexpr double many = 0.05;
  const bool onlyLocal = this->Options.effort == Effort::Local;
  if (!this->done() && (onlyLocal || this->invalidFraction() < many))
  {
    SweepLimits limits;
    limits.sweeps = onlyLocal ? 40 : 12;
    limits.progress = 0.9;
    limits.patience = onlyLocal ? 6 : 3;
    this->sweepLocally(limits);
  }
  if (!this->done())
  {
    this->excludeInfeasible();
    this->record();
  }
  if (!this->done() && !onlyLocal)
  {
    this->untangleGlobally();
  }
  if (this->untangled() && !this->stopped())
  {
    this->smoothWorst();
    this->forgetBest();
    this->record();
  }
}

template class Untangler<2>;
template class Untangler<3>;
}
