// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProgressStep.h
 * @brief Reports the progress of a filter while the kernel computes a part of its result.
 */
#ifndef tautline_ProgressStep_h
#define tautline_ProgressStep_h

#include "tautline/Core/LoopProgress.h"

#include "vtkAlgorithm.h"

#include <algorithm>

namespace tautline
{
/// Reports progress, 0 to 1, or the largest value reported before in this execution.
inline void advance(vtkAlgorithm* algorithm, double fraction)
{
  algorithm->UpdateProgress(std::clamp(fraction, algorithm->GetProgress(), 1.0));
}

/// Iterations after which half is done, if only a large upper limit on their number is known.
constexpr double UsualIterations = 8.0;

/// The progress of an iteration without a known end.
inline double openEnded(double iterations, double half = UsualIterations)
{
  return iterations / (iterations + half);
}

/**
 * @class tautline::ProgressStep
 * @brief While it exists, the loops of this thread advance the progress of an algorithm from one
 * fraction to another.
 */
class ProgressStep
{
public:
  ProgressStep(vtkAlgorithm* algorithm, double from, double to)
    : Loops([algorithm](double done) { advance(algorithm, done); }, from, to)
  {
  }

private:
  LoopProgress Loops;
};
}
#endif
