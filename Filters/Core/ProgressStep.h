// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProgressStep.h
 * @brief The progress of a filter while the kernel computes a part of its result.
 */
#ifndef tautline_ProgressStep_h
#define tautline_ProgressStep_h

#include "tautline/Core/LoopProgress.h"

#include "vtkAlgorithm.h"

#include <algorithm>

namespace tautline
{
/// Reports progress, 0 to 1, or what was reported before in this execution if that is more.
inline void advance(vtkAlgorithm* algorithm, double fraction)
{
  algorithm->UpdateProgress(std::clamp(fraction, algorithm->GetProgress(), 1.0));
}

/// Iterations after which one half is done, where only a large limit of their number is known.
constexpr double UsualIterations = 8.0;

/// The progress of an iteration without a known end.
inline double openEnded(double iterations, double half = UsualIterations)
{
  return iterations / (iterations + half);
}

/**
 * @class tautline::ProgressStep
 * @brief While it exists, the loops of this thread move the progress of an algorithm from one
 * fraction to another, which it has at the end.
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
