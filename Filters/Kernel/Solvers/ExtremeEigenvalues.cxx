// SPDX-License-Identifier: BSD-3-Clause
#include "ExtremeEigenvalues.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Random.h"

namespace tautline
{
void EigensolverStoppingTest::stage(double begin, double end)
{
  this->Begin = begin;
  this->End = end;
}

/// Whether the progress function or the user ends the work. No exception may pass through PETSc.
bool EigensolverStoppingTest::userStops(double fraction)
{
  try
  {
    if (this->Work && this->Work->abandoned())
    {
      return true;
    }
    if (!this->Work && this->System.ranks() == 1)
    {
      throwIfInterrupted();
    }
    // The waiting thread is queried periodically; switching to it takes longer than a short step.
    const bool due = this->SinceAsked.reached(WatchInterval);
    if (!this->Work && due && this->Options.cancelled && this->Options.cancelled())
    {
      return true;
    }
    const double done = this->Begin + fraction * (this->End - this->Begin);
    bool proceed = true;
    if (this->Options.progress && !this->Work)
    {
      proceed = this->Options.progress(done);
    }
    else if (this->Options.progress && due)
    {
      proceed = this->Work->inCaller([&]() { proceed = this->Options.progress(done); }) && proceed;
    }
    if (due)
    {
      this->SinceAsked = Stopwatch();
    }
    return !proceed;
  }
  catch (...)
  {
    this->Thrown = std::current_exception();
    return true;
  }
}

bool EigensolverStoppingTest::stop(double fraction)
{
  const bool aborted = this->Aborted || this->userStops(fraction);
  if (this->System.ranks() == 1)
  {
    this->Aborted = aborted;
  }
  else if (this->Options.progress || this->Options.cancelled)
  {
    this->Aborted = this->System.anywhere(aborted);
  }
  if (this->Options.maximumSeconds > 0.0)
  {
    this->Late = this->System.anywhere(this->Time.reached(this->Options.maximumSeconds));
  }
  return this->stopped();
}

std::string EigensolverStoppingTest::message() const
{
  return this->Aborted ? "Stopped by the user."
    : this->Late       ? "The time limit was reached before the tolerance."
                       : "";
}

void EigensolverStoppingTest::rethrow() const
{
  if (this->Thrown)
  {
    std::rethrow_exception(this->Thrown);
  }
}

//------------------------------------------------------------------------------
void fillStartVector(Vec vector, std::uint64_t seed)
{
  PetscInt begin = 0, end = 0;
  double* values = nullptr;
  petsc(VecGetOwnershipRange(vector, &begin, &end));
  petsc(VecGetArrayWrite(vector, &values));
  for (PetscInt row = begin; row < end; ++row)
  {
    const std::uint64_t state =
      (static_cast<std::uint64_t>(row) + 1 + (seed << 40)) * SplitMix::Increment;
    values[row - begin] = SplitMix::unit(SplitMix::hash(state)) + 0.25;
  }
  petsc(VecRestoreArrayWrite(vector, &values));
}
}
