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
    // The caller has stopped waiting, so the result is not needed any more.
    if (this->Work && this->Work->abandoned())
    {
      return true;
    }
    // On several ranks, an exception on one of them would leave the others in a collective call.
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
  // Ranks have to agree on the end; this needs a collective call only if one of them can abort.
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
    // A value per global row makes the vector independent of the number of ranks; all entries are
    // positive, like the lowest mode.
    const std::uint64_t state =
      (static_cast<std::uint64_t>(row) + 1 + (seed << 40)) * SplitMix::Increment;
    values[row - begin] = SplitMix::unit(SplitMix::hash(state)) + 0.25;
  }
  petsc(VecRestoreArrayWrite(vector, &values));
}
}
