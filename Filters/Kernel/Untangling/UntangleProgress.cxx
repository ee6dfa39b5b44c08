// SPDX-License-Identifier: BSD-3-Clause
#include "UntangleProgress.h"

#include <algorithm>
#include <limits>

namespace tautline
{
//------------------------------------------------------------------------------
Index countInvalid(const Mesh& mesh, const std::vector<signed char>& validity, const Ranks& ranks)
{
  return ranks.countInvalid(mesh, validity);
}

//------------------------------------------------------------------------------
bool UntangleProgress::record(
  Index inverted, double objective, double fraction, const std::function<void(double*)>& points)
{
  IterationRecord record;
  record.iteration = this->iteration();
  record.seconds = this->Clock.seconds();
  record.objective = objective;
  record.objectives = { objective };
  record.inverted = inverted;
  this->Result.history.push_back(record);
  const double maximumSeconds = this->Options.maximumSeconds;
  if (maximumSeconds > 0)
  {
    fraction = std::max(fraction, record.seconds / maximumSeconds);
  }
  const bool aborted =
    this->Options.observer && !this->Options.observer({ record, std::min(fraction, 1.0), points });
  if (this->TheRanks.any(aborted))
  {
    this->stop(StopReason::Aborted);
  }
  else if (this->TheRanks.any(maximumSeconds > 0 && record.seconds >= maximumSeconds))
  {
    this->stop(StopReason::TimeLimit);
  }
  return !this->Stopped;
}

//------------------------------------------------------------------------------
double UntangleProgress::secondsLeft() const
{
  const double maximumSeconds = this->Options.maximumSeconds;
  return maximumSeconds > 0
    ? std::max(std::numeric_limits<double>::min(), maximumSeconds - this->Clock.seconds())
    : 0.0;
}

//------------------------------------------------------------------------------
void UntangleProgress::stop(StopReason reason)
{
  this->Result.reason = reason;
  this->Stopped = true;
}
}
