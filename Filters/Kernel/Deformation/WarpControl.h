// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpControl.h
 * @brief The time limit, the observer and the running totals of one deformation.
 * Internal: not installed.
 */
#ifndef tautline_WarpControl_h
#define tautline_WarpControl_h

#include "WarpOptions.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Mesh/Ranks.h"

#include <algorithm>

namespace tautline
{
/**
 * @class tautline::WarpControl
 * @brief Created when a deformation starts; every loop checks here whether to continue. To be used
 * from the calling thread only.
 */
class WarpControl
{
public:
  /// Both must outlive this object; the result receives the flags timeLimit and aborted, and the
  /// message.
  WarpControl(const WarpOptions& options, WarpResult& result, const Ranks& ranks = {})
    : Options(options)
    , Result(result)
    , TheRanks(ranks)
  {
  }

  const WarpOptions& options() const { return this->Options; }
  WarpResult& result() { return this->Result; }

  /// Seconds since the start.
  double elapsed() const { return this->Time.seconds(); }
  /// Seconds left, for the limits of solvers; 0 if there is no limit, otherwise above 0.
  double secondsLeft() const
  {
    constexpr double smallest = 1e-3; // 0 would mean no limit
    return this->Options.maximumSeconds > 0
      ? std::max(smallest, this->Options.maximumSeconds - this->elapsed())
      : 0.0;
  }

  /// Sets the range within 0 to 1 to which the fractions passed to proceed() are mapped.
  void setRange(double from, double to)
  {
    this->From = from;
    this->To = to;
  }
  /// Reports progress; false if the deformation has to stop. The result then states the reason.
  /// Collective: all ranks stop together.
  bool proceed(double fraction)
  {
    this->watch(fraction);
    return this->agree();
  }
  /// Whether to continue, considering the results of watch() on all ranks. Collective.
  bool agree()
  {
    this->Result.timeLimit = this->TheRanks.any(this->Result.timeLimit);
    this->Result.aborted = this->TheRanks.any(this->Result.aborted);
    return !this->stopped();
  }
  /// The same within work that does not communicate; all ranks must then call proceed() or agree().
  bool watch(double fraction)
  {
    if (this->Time.reached(this->Options.maximumSeconds))
    {
      this->Result.timeLimit = true;
    }
    // A second attempt starts at a smaller fraction; the reported progress never decreases.
    const double now = this->From + (this->To - this->From) * std::clamp(fraction, 0.0, 1.0);
    this->Reported = std::max(this->Reported, now);
    if (!this->stopped() && this->Options.progress && !this->Options.progress(this->Reported))
    {
      this->Result.aborted = true;
    }
    return !this->stopped();
  }
  bool stopped() const { return this->Result.timeLimit || this->Result.aborted; }

  /// Iterations of linear solvers so far.
  int iterations() const { return this->Iterations; }
  void addIterations(int iterations) { this->Iterations += iterations; }

  /// Appends a sentence to the message of the result, once.
  void addMessage(const std::string& sentence)
  {
    std::string& message = this->Result.message;
    if (message.find(sentence) == std::string::npos)
    {
      message += (message.empty() ? "" : " ") + sentence;
    }
  }

private:
  const WarpOptions& Options;
  WarpResult& Result;
  Ranks TheRanks;
  Stopwatch Time;
  double From = 0, To = 1, Reported = 0;
  int Iterations = 0;
};
}
#endif
