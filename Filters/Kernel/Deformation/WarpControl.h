/**
 * @file WarpControl.h
 * @brief The clock, the observer and the running totals of one warp. Internal: not installed.
 */
#ifndef tautline_WarpControl_h
#define tautline_WarpControl_h

#include "WarpOptions.h"

#include <algorithm>
#include <chrono>

namespace tautline
{
class WarpControl
{
public:
  WarpControl(const WarpOptions& options, WarpResult& result)
    : Options(options)
    , Result(result)
    , Start(std::chrono::steady_clock::now())
  {
  }

  const WarpOptions& options() const { return this->Options; }
  WarpResult& result() { return this->Result; }

  double elapsed() const
  {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - this->Start;
    return passed.count();
  }
  /// Seconds left, for the limits of solvers; 0 where there is no limit, else above 0.
  double secondsLeft() const
  {
    constexpr double next = 1e-3; // what is as good as none
    return this->Options.maximumSeconds > 0
      ? std::max(next, this->Options.maximumSeconds - this->elapsed())
      : 0.0;
  }

  /// Which part of the whole the work from here on is; fractions told to goOn() are of that part.
  void setRange(double from, double to)
  {
    this->From = from;
    this->To = to;
  }
  /// False when it is time to stop; says so in the result.
  bool goOn(double fraction)
  {
    if (this->Options.maximumSeconds > 0 && this->elapsed() >= this->Options.maximumSeconds)
    {
      this->Result.timeLimit = true;
    }
    // What is tried again in another way does not start again for who watches.
    const double now = this->From + (this->To - this->From) * std::clamp(fraction, 0.0, 1.0);
    this->Told = std::max(this->Told, now);
    if (!this->stopped() && this->Options.progress && !this->Options.progress(this->Told))
    {
      this->Result.aborted = true;
    }
    return !this->stopped();
  }
  bool stopped() const { return this->Result.timeLimit || this->Result.aborted; }

  /// Of linear solvers, so far.
  int iterations() const { return this->Iterations; }
  void addIterations(int iterations) { this->Iterations += iterations; }

  /// Adds a sentence to the message, once.
  void say(const std::string& sentence)
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
  std::chrono::steady_clock::time_point Start;
  double From = 0, To = 1, Told = 0;
  int Iterations = 0;
};
}
#endif
