// SPDX-License-Identifier: BSD-3-Clause
#include "OptimizeOptions.h"

namespace tautline
{
namespace
{
enum class Reach
{
  Local,
  Global,
  Either
};

/// No default, so that the compiler warns about a new optimizer without a case.
Reach reachOf(Optimizer optimizer)
{
  switch (optimizer)
  {
    case Optimizer::Automatic:
      return Reach::Either;
    case Optimizer::LocalNewton:
    case Optimizer::LocalConjugateGradient:
      return Reach::Local;
    case Optimizer::ConjugateGradientFletcherReeves:
    case Optimizer::ConjugateGradientPolakRibiere:
    case Optimizer::LimitedMemoryBFGS:
    case Optimizer::NewtonConjugateGradient:
      return Reach::Global;
  }
  throw Error("Unknown optimizer " + std::to_string(static_cast<int>(optimizer)) + ".");
}
}

//------------------------------------------------------------------------------
bool isLocal(Optimizer optimizer)
{
  return reachOf(optimizer) == Reach::Local;
}

bool isGlobal(Optimizer optimizer)
{
  return reachOf(optimizer) == Reach::Global;
}

//------------------------------------------------------------------------------
void applyPreset(Preset preset, OptimizeOptions& options)
{
  if (preset == Preset::Custom)
  {
    return;
  }
  Objective shape;
  options.objectives = { shape };
  options.scalarization = ScalarizationOptions();
  options.optimizer = Optimizer::Automatic;
  options.stopping = StoppingCriteria();
  options.improveWorst = 0.0;
  options.untangleFirst = true;
  Objective second;
  switch (preset)
  {
    case Preset::FastCleanUp:
      options.stopping.maximumIterations = 10;
      options.stopping.reduction = 0.95;
      break;
    case Preset::UniformSize:
      second.metric = Metric::Size;
      options.objectives.push_back(second);
      options.scalarization.method = Scalarization::ObjectiveProduct;
      break;
    case Preset::LowInterpolationError:
      second.metric = Metric::InterpolationSizeShape;
      options.objectives.push_back(second);
      options.scalarization.method = Scalarization::ObjectiveProduct;
      break;
    case Preset::WorstElement:
      options.improveWorst = 0.01;
      break;
    default: // BestShape, UntangleThenImprove, PreserveShape
      break;
  }
}
}
