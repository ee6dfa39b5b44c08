// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleProgress.h
 * @brief The history, the observer and the limits of an untangling. Internal: not installed.
 */
#ifndef tautline_UntangleProgress_h
#define tautline_UntangleProgress_h

#include "tautline/Core/Stopwatch.h"
#include "tautline/Patches/SimplexMesh.h"
#include "UntangleOptions.h"

namespace tautline
{
/// The history, the observer, the limits, and the best coordinates so far.
class UntangleProgress
{
public:
  /// The references have to live as long as this; `clock` started with the untangling.
  UntangleProgress(const Mesh& mesh, const SimplexMesh& simplices, const UntangleOptions& options,
    const Stopwatch& clock, UntangleResult& result);

  /**
   * @brief Records an iteration that led to x and calls the observer.
   * @param x VertexStride coordinates per vertex of the SimplexMesh
   * @param invertedVolume the sum of -D over the inverted simplices
   * @return whether another iteration may follow
   */
  bool record(const double* x, Index invalidCells, double invertedVolume);

  /// Whether a limit or the observer has ended the untangling; the result holds the reason.
  bool stopped() const { return this->Stopped; }
  /// Whether the time limit is reached, and ends the untangling there.
  bool late() const { return this->Clock.reached(this->Options.maximumSeconds); }
  void stopLate() { this->stop(StopReason::TimeLimit); }
  /// The coordinates with the fewest invalid cells, and the number of those.
  const double* best() const { return this->Best.data(); }
  Index fewestInvalid() const { return this->FewestInvalid; }
  /// The next record becomes the best; the limits stay.
  void forgetBest();

private:
  bool stop(StopReason reason);

  const Mesh& Input;
  const SimplexMesh& Simplices;
  const UntangleOptions& Options;
  UntangleResult& Result;
  Stopwatch Clock;
  std::vector<double> Best;
  Index FewestInvalid = 0;
  bool Stopped = false;
};
}
#endif
