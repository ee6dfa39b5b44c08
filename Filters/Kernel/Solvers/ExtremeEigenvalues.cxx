#include "ExtremeEigenvalues.h"

#include "tautline/Core/Random.h"

namespace tautline
{
void EigensolverStoppingTest::stage(double begin, double end)
{
  this->Begin = begin;
  this->End = end;
}

bool EigensolverStoppingTest::stop(double fraction)
{
  bool aborted = this->Aborted;
  try
  {
    aborted = aborted ||
      (this->Options.progress &&
        !this->Options.progress(this->Begin + fraction * (this->End - this->Begin)));
  }
  catch (...)
  {
    // No exception may pass through PETSc.
    this->Thrown = std::current_exception();
    aborted = true;
  }
  if (this->Options.progress)
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
