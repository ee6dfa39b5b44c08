// SPDX-License-Identifier: BSD-3-Clause
#include "UntangleProgress.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Iterations an effort allows, of all phases together.
int iterationLimit(Effort effort)
{
  constexpr int local = 60, normal = 1500, thorough = 5000;
  return effort == Effort::Local ? local : effort == Effort::Normal ? normal : thorough;
}
}

//------------------------------------------------------------------------------
UntangleProgress::UntangleProgress(const Mesh& mesh, const SimplexMesh& simplices,
  const UntangleOptions& options, const Stopwatch& clock, UntangleResult& result)
  : Input(mesh)
  , Simplices(simplices)
  , Options(options)
  , Result(result)
  , Clock(clock)
  , Best(simplices.coordinates(),
      simplices.coordinates() + static_cast<std::size_t>(VertexStride) * simplices.vertices())
{
}

//------------------------------------------------------------------------------
bool UntangleProgress::record(const double* x, Index invalidCells, double invertedVolume)
{
  if (this->Result.history.empty() || invalidCells < this->FewestInvalid)
  {
    this->FewestInvalid = invalidCells;
    std::copy_n(x, this->Best.size(), this->Best.begin());
  }
  IterationRecord record;
  record.iteration = static_cast<int>(this->Result.history.size());
  record.seconds = this->Clock.seconds();
  record.objective = invertedVolume;
  record.objectives = { invertedVolume };
  record.inverted = invalidCells;
  this->Result.history.push_back(record);
  const int limit = iterationLimit(this->Options.effort);
  const double maximumSeconds = this->Options.maximumSeconds;
  double fraction = static_cast<double>(record.iteration) / limit;
  if (maximumSeconds > 0)
  {
    fraction = std::max(fraction, record.seconds / maximumSeconds);
  }
  if (this->Options.observer)
  {
    const auto points = [this, x](double* to)
    {
      const MeshView& view = this->Input.view();
      std::copy_n(view.points, 3 * view.numberOfPoints, to);
      this->Simplices.store(x, to, this->Options.threads);
    };
    if (!this->Options.observer({ record, std::min(fraction, 1.0), points }))
    {
      return this->stop(StopReason::Aborted);
    }
  }
  if (maximumSeconds > 0 && record.seconds >= maximumSeconds)
  {
    return this->stop(StopReason::TimeLimit);
  }
  if (record.iteration >= limit)
  {
    return this->stop(StopReason::IterationLimit);
  }
  return true;
}

void UntangleProgress::forgetBest()
{
  this->FewestInvalid = std::numeric_limits<Index>::max();
}

bool UntangleProgress::stop(StopReason reason)
{
  this->Result.reason = reason;
  this->Stopped = true;
  return false;
}
}
