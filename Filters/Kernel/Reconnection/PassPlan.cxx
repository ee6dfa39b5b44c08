// SPDX-License-Identifier: BSD-3-Clause
#include "PassPlan.h"

#include "Constants.h"

#include <cmath>

namespace tautline
{
namespace
{
/// Qualities of the first passes: the worst tetrahedra first, also of the whole mesh.
constexpr double FirstTargets[] = { 0.3, 0.45, 0.55 };
/// The minimum gain of a point motion in the passes for the target, and after these. Smaller gains
/// cost time and, at 50,000 tetrahedra, no longer improve the worst.
constexpr double TargetGain = 1e-3, FineGain = 5e-4;
/// Replaces both up to the last pass for targets above this quality, where half of all tetrahedra
/// are processed.
constexpr double HighTarget = 0.57, HighTargetGain = 4e-3;
/// The number of steps of a point in the last pass; the other passes use two.
constexpr int CompoundSteps = 4;
/// The number of swaps and insertions that may follow a tentative change in the last pass.
constexpr int Repairs = 4;
/// It ends after this many unsuccessful tetrahedra, plus one per this many tetrahedra of the mesh:
/// each takes some milliseconds.
constexpr Index MaxFailures = 100, TetrahedraPerFailure = 10000;

/// Target angles of the stages. Every stage tries all operations on the tetrahedra below its angle,
/// so that the allowed count is used for the worst first. First slivers, then steps that a user can
/// distinguish; the default target is one of them.
constexpr double StageAngles[] = { SliverAngle, 25.0, 33.4, 40.0, 45.0, 50.0, 55.0, 60.0 };

/// The passes of a stage. @param target quality; @param former target of the previous stage, 0:
/// none
std::vector<PassOptions> planStage(
  const ReconnectionOptions& options, Index size, double target, double former)
{
  const bool sums = options.objective == ReconnectionObjective::Sum;
  PassOptions pass;
  pass.swap = options.swap;
  pass.smooth = options.smooth;
  pass.skipsBound = options.boundary == BoundaryMotion::Fixed && !sums;
  pass.facets = options.boundary != BoundaryMotion::Fixed && !sums;
  std::vector<PassOptions> passes;
  for (double first : FirstTargets)
  {
    if (first > former && first < target && !sums)
    {
      pass.target = first;
      passes.push_back(pass);
    }
  }
  pass.target = target;
  const bool high = target > HighTarget;
  pass.leastGain = high ? HighTargetGain : TargetGain;
  passes.push_back(pass);
  const bool keepsCount = options.smallestCount == 1.0 && options.largestCount == 1.0;
  // For sums, insertions gain little: on 50,000 tetrahedra half a percent, at nine times the cost.
  if (options.insert && !keepsCount && !sums)
  {
    pass.insert = true;
    pass.leastGain = high ? HighTargetGain : FineGain;
    passes.push_back(pass);
  }
  if (options.contract && !keepsCount)
  {
    pass.contract = true;
    passes.push_back(pass);
  }
  if (options.compound && options.smooth && !sums)
  {
    pass.compound = true;
    pass.leastGain = FineGain;
    pass.smoothingSteps = CompoundSteps;
    passes.push_back(pass);
    pass.repairs = Repairs;
    pass.maxFailures = MaxFailures + size / TetrahedraPerFailure;
    passes.push_back(pass);
  }
  return passes;
}
}

//------------------------------------------------------------------------------
std::vector<std::vector<PassOptions>> planStages(const ReconnectionOptions& options, Index size)
{
  if (options.objective == ReconnectionObjective::Sum)
  {
    return { planStage(options, size, 1.0, 0.0) };
  }
  std::vector<std::vector<PassOptions>> stages;
  double former = 0.0;
  for (double angle : StageAngles)
  {
    const double target = std::sin(radians(angle));
    stages.push_back(planStage(options, size, target, former));
    former = target;
    if (angle >= options.targetAngle)
    {
      break;
    }
  }
  return stages;
}

PassOptions withoutCompound(PassOptions pass)
{
  pass.compound = false;
  pass.maxFailures = 0;
  return pass;
}

std::vector<PassOptions> lastPasses(const std::vector<PassOptions>& passes)
{
  std::vector<PassOptions> last;
  // A pass includes the operations of the earlier ones, so only the last of several simple passes
  // remains.
  for (const PassOptions& pass : passes)
  {
    if (!last.empty() && !last.back().compound)
    {
      last.pop_back();
    }
    last.push_back(pass);
  }
  return last;
}

void applyPreset(ReconnectionPreset preset, ReconnectionOptions& options)
{
  if (preset == ReconnectionPreset::Custom)
  {
    return;
  }
  const bool all =
    preset == ReconnectionPreset::RemoveSlivers || preset == ReconnectionPreset::Aggressive;
  options.adapt = preset == ReconnectionPreset::Adapt;
  options.swap = true;
  options.smooth = preset != ReconnectionPreset::SwapOnly;
  options.contract = options.insert = all || options.adapt;
  options.compound = all;
  options.targetAngle =
    preset == ReconnectionPreset::RemoveSlivers ? SliverAngle : ReconnectionOptions().targetAngle;
}
}
