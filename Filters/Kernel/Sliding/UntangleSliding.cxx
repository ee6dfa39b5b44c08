// SPDX-License-Identifier: BSD-3-Clause
#include "UntangleSliding.h"

#include "MovingBarrier.h"
#include "SlidingUntangler.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// The weight of the boundary until all corners are valid, and its growth factor afterwards.
constexpr double weakBoundary = 0.01, growth = 2.0;
constexpr int returnSteps = 60;
/// The neighborhoods of the invalid cells, and the number of steps in each.
constexpr int everywhere = 1 << 20;
constexpr int rings[] = { 3, 8, everywhere };
constexpr int stepsOfRings = 300;
constexpr int sweepsOfRelaxation = 100;
/// The successive targets of the worst corner to which cells are improved, until cells are also
/// valid inside.
constexpr double clearlyValid[] = { 0.02, 0.1, 0.3 };

/// A run, with the time limit and the observer of the caller.
class SlidingRun
{
public:
  SlidingRun(const Mesh& mesh, const BoundaryConstraints& constraints, int threads,
    const std::function<bool(const SlidingState&)>& report)
    : TheMesh(mesh)
    , Threads(threads)
    , Report(report)
    , Constrained(mesh, constraints)
    , Start(pointsOf(mesh.view().points, mesh.view().numberOfPoints))
    , X(Start)
    , Cells(mesh, Constrained)
    , Boundary(mesh, Constrained, Start)
    , Untangler(Cells, Constrained, Boundary, X, threads)
  {
  }

  std::vector<double> run()
  {
    this->attempt();
    if (!this->Stopped && !this->isDone())
    {
      const std::vector<Vec3> kept = this->X;
      const Index invalid = this->countInvalid();
      const double off = offSurface(this->Constrained, kept).distance;
      this->X = this->Start;
      this->Untangler.relax(sweepsOfRelaxation);
      this->attempt();
      const Index now = this->countInvalid();
      if (now > invalid ||
        (now == invalid && offSurface(this->Constrained, this->X).distance >= off))
      {
        this->X = kept;
      }
    }
    return this->stored();
  }

private:
  bool report(double progress)
  {
    this->Stopped = this->Stopped ||
      !this->Report(
        { this->Untangler.invalid(), this->Untangler.invertedVolume(), progress, this->X });
    return !this->Stopped;
  }

  std::vector<double> stored() const
  {
    const double* from = this->TheMesh.view().points;
    std::vector<double> points(from, from + 3 * this->X.size());
    storeMovedPoints(this->Start, this->X, points.data());
    return points;
  }

  /// The number of cells that are not valid everywhere.
  Index countInvalid() const
  {
    std::vector<signed char> validity(this->TheMesh.view().numberOfCells);
    const std::vector<double> points = this->stored();
    this->TheMesh.at(points.data()).classifyCells(validity.data(), this->Threads);
    return std::count_if(this->Cells.cells().begin(), this->Cells.cells().end(),
      [&](const SlidingCells::Cell& cell) { return validity[cell.cell] != Valid; });
  }

  bool isDone() const
  {
    return this->countInvalid() == 0 &&
      offSurface(this->Constrained, this->X).distance <= this->Constrained.tolerance();
  }

  /// Attempts to untangle from the current points.
  void attempt()
  {
    this->Boundary.setWeight(weakBoundary);
    this->untangle();
    if (!this->Stopped)
    {
      this->returnToSurface();
      this->unfold();
    }
    this->place();
  }

  void untangle()
  {
    constexpr double done = 0.5;
    bool valid = this->Untangler.invalid() == 0;
    for (std::size_t i = 0; i < std::size(rings) && !valid && !this->Stopped; ++i)
    {
      const double progress = done * static_cast<double>(i) / std::size(rings);
      valid =
        this->Untangler.run(rings[i], stepsOfRings, [&](Index) { return this->report(progress); });
    }
  }

  /// Increases the weight of the boundary as long as the corners stay valid.
  void returnToSurface()
  {
    constexpr double done = 0.6;
    const double enough = 2.0;
    this->Untangler.findSizes();
    const Index invalid = this->Untangler.invalid();
    for (double weight = weakBoundary; weight < enough && !this->Stopped; weight *= growth)
    {
      const std::vector<Vec3> kept = this->X;
      this->Boundary.setWeight(weight);
      this->Untangler.smooth(returnSteps / 10);
      if (this->Untangler.invalid() > invalid)
      {
        this->X = kept;
        this->Boundary.moveTo(kept);
        break;
      }
      this->report(done);
    }
  }

  /// Improves the worst corners, and the determinants between corners, until all cells are valid.
  void unfold()
  {
    constexpr double done = 0.8;
    this->Boundary.setWeight(1.0);
    for (const double enough : clearlyValid)
    {
      if (this->Stopped || (this->countInvalid() == 0 && this->Boundary.isWithin()))
      {
        break;
      }
      BarrierOptions options;
      options.threads = this->Threads;
      options.enough = enough;
      options.proceed = [&](double) { return this->report(done); };
      MovingBarrier(this->Cells, this->Constrained, this->Boundary, this->X, options)
        .run([](const std::vector<Vec3>&) { return true; });
    }
  }

  /// Moves points onto their surfaces or curves if the cells stay equally valid.
  void place()
  {
    placeOnParts(this->Cells, this->Constrained, this->Boundary, this->Start, this->X,
      [&](std::int32_t c, const Vec3* vertices)
      { return this->TheMesh.classifyCell(*this->Cells.cells()[c].t, vertices) == Valid; });
  }

  const Mesh& TheMesh;
  int Threads;
  const std::function<bool(const SlidingState&)>& Report;
  ConstrainedPoints Constrained;
  std::vector<Vec3> Start, X;
  SlidingCells Cells;
  BoundaryTerms Boundary;
  SlidingUntangler Untangler;
  bool Stopped = false;
};
}

//------------------------------------------------------------------------------
std::vector<double> untangleSliding(const Mesh& mesh, const BoundaryConstraints& constraints,
  int threads, const std::function<bool(const SlidingState&)>& report)
{
  return SlidingRun(mesh, constraints, threads, report).run();
}
}
