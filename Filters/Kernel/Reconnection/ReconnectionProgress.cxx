// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectionProgress.h"

#include "tautline/Core/Interruption.h"

namespace tautline
{
//------------------------------------------------------------------------------
bool ReconnectionProgress::record(ReconnectionRecord record, int pass, double fraction)
{
  record.pass = pass;
  record.seconds = this->Clock.seconds();
  this->Result.history.push_back(record);
  this->Fraction = fraction;
  this->LastCall = record.seconds;
  if (this->Result.reason == StopReason::Aborted)
  {
    return false; // within the pass: the observer is not called again
  }
  const bool goesOn = !this->Options.observer || this->Options.observer(record, fraction);
  if (!goesOn && this->Result.reason != StopReason::TimeLimit)
  {
    this->Result.reason = StopReason::Aborted;
  }
  return goesOn;
}

//------------------------------------------------------------------------------
bool ReconnectionProgress::proceed()
{
  if (this->late())
  {
    this->Result.reason = StopReason::TimeLimit;
    return false;
  }
  throwIfInterrupted();
  const double now = this->Clock.seconds();
  if (this->Options.observer && now - this->LastCall > ObserverSeconds)
  {
    this->LastCall = now;
    if (!this->Options.observer(this->last(), this->Fraction))
    {
      this->Result.reason = StopReason::Aborted;
      return false;
    }
  }
  return true;
}
}
