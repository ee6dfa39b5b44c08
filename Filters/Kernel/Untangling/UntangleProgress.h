/**
 * @file UntangleProgress.h
 * @brief The history, the observer and the limits of an untangling. Internal: not installed.
 */
#ifndef tautline_UntangleProgress_h
#define tautline_UntangleProgress_h

#include "tautline/Patches/SimplexMesh.h"
#include "UntangleOptions.h"

#include <chrono>

namespace tautline
{
using Clock = std::chrono::steady_clock;

/// Iterations an effort allows, of all phases together.
inline int iterationLimit(Effort effort)
{
  constexpr int local = 60, normal = 1500, thorough = 5000;
  return effort == Effort::Local ? local : effort == Effort::Normal ? normal : thorough;
}

/// The history, the observer, the limits, and the best coordinates so far.
class Progress
{
public:
  Progress(const Mesh& mesh, const SimplexMesh& simplices, const UntangleOptions& options,
    Clock::time_point start, UntangleResult& result)
    : Input(mesh)
    , Simplices(simplices)
    , Options(options)
    , Result(result)
    , Start(start)
    , Best(simplices.coordinates(),
        simplices.coordinates() + static_cast<std::size_t>(VertexStride) * simplices.vertices())
  {
  }

  /// Records an iteration that led to x. False if it has to be the last.
  bool record(const double* x, Index invalidCells, double depth)
  {
    if (this->Result.history.empty() || invalidCells < this->Fewest)
    {
      this->Fewest = invalidCells;
      std::copy_n(x, this->Best.size(), this->Best.begin());
    }
    IterationRecord record;
    record.iteration = static_cast<int>(this->Result.history.size());
    record.seconds = this->seconds();
    record.objective = depth;
    record.objectives = { depth };
    record.inverted = invalidCells;
    this->Result.history.push_back(record);
    const int limit = iterationLimit(this->Options.effort);
    double part = static_cast<double>(record.iteration) / limit;
    if (this->Options.maximumSeconds > 0)
    {
      part = std::max(part, record.seconds / this->Options.maximumSeconds);
    }
    if (this->Options.observer)
    {
      const auto points = [this, x](double* to)
      {
        const MeshView& view = this->Input.view();
        std::copy_n(view.points, 3 * view.numberOfPoints, to);
        this->Simplices.store(x, to, this->Options.threads);
      };
      if (!this->Options.observer({ record, std::min(part, 1.0), points }))
      {
        return this->stop(StopReason::Aborted);
      }
    }
    if (this->Options.maximumSeconds > 0 && record.seconds >= this->Options.maximumSeconds)
    {
      return this->stop(StopReason::TimeLimit);
    }
    if (record.iteration >= limit)
    {
      return this->stop(StopReason::IterationLimit);
    }
    return true;
  }

  bool stopped() const { return this->Stopped; }
  const double* best() const { return this->Best.data(); }
  Index fewest() const { return this->Fewest; }
  /// Forgets the best so far but keeps the limits.
  void restart(Index fewest) { this->Fewest = fewest; }

private:
  bool stop(StopReason reason)
  {
    this->Result.reason = reason;
    this->Stopped = true;
    return false;
  }
  double seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

  const Mesh& Input;
  const SimplexMesh& Simplices;
  const UntangleOptions& Options;
  UntangleResult& Result;
  Clock::time_point Start;
  std::vector<double> Best;
  Index Fewest = 0;
  bool Stopped = false;
};
}
#endif
