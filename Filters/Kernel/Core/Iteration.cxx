// SPDX-License-Identifier: BSD-3-Clause
#include "Iteration.h"

namespace tautline
{
const char* describe(StopReason reason)
{
  switch (reason)
  {
    case StopReason::GradientNorm:
      return "Converged: the gradient norm is below its tolerance.";
    case StopReason::RelativeChange:
      return "Converged: the objective hardly changes anymore.";
    case StopReason::TwoDigits:
      return "The mean qualities keep two decimals.";
    case StopReason::Reduction:
      return "The requested fraction of the possible reduction is reached.";
    case StopReason::AllValid:
      return "All elements are valid.";
    case StopReason::IterationLimit:
      return "The iteration limit is reached.";
    case StopReason::TimeLimit:
      return "The time limit is reached.";
    case StopReason::Aborted:
      return "Stopped on request.";
    case StopReason::NoProgress:
      return "No step reduces the objective.";
    default:
      return "No vertex is free to move.";
  }
}
}
