// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleProgress.h
 * @brief The history, the observer and the time limit of an untangling.
 * Internal: not installed.
 */
#ifndef tautline_UntangleProgress_h
#define tautline_UntangleProgress_h

#include "UntangleOptions.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Mesh/Ranks.h"

namespace tautline
{
/// Invalid elements of the whole mesh. @param validity of the local cells
Index countInvalid(
  const Mesh& mesh, const std::vector<signed char>& validity, const Ranks& ranks = {});

/// The history, the observer and the time limit; the clock starts at construction.
class UntangleProgress
{
public:
  /// The references must outlive this object.
  UntangleProgress(const UntangleOptions& options, const Ranks& ranks, UntangleResult& result)
    : Options(options)
    , TheRanks(ranks)
    , Result(result)
  {
  }

  /// The number of the next record.
  int iteration() const { return static_cast<int>(this->Result.history.size()); }

  /**
   * @brief Records an iteration and calls the observer. The ranks stop together: collective.
   * @param inverted, objective as in UntangleResult::history
   * @param fraction upper bound of the completed fraction of the work
   * @param points writes the coordinates, 3 per point of the local mesh
   * @return whether another iteration may follow
   */
  bool record(
    Index inverted, double objective, double fraction, const std::function<void(double*)>& points);

  /// Whether a limit or the observer has ended the untangling; the result holds the reason.
  bool stopped() const { return this->Stopped; }
  void stop(StopReason reason);
  /// Whether the time limit is reached on this rank.
  bool late() const { return this->Clock.reached(this->Options.maximumSeconds); }
  /// The time left for further untangling; 0 if there is no limit, otherwise above 0.
  double secondsLeft() const;

private:
  const UntangleOptions& Options;
  const Ranks& TheRanks;
  UntangleResult& Result;
  Stopwatch Clock;
  bool Stopped = false;
};
}
#endif
