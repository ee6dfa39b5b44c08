// SPDX-License-Identifier: BSD-3-Clause
#include "LoopProgress.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace tautline
{
namespace
{
constexpr double ShareOfLoop = 0.5; ///< of what is left
constexpr double SmallestStep = 1.0 / 512;

thread_local LoopProgress* innermost = nullptr;
}

//------------------------------------------------------------------------------
LoopProgress::LoopProgress(std::function<void(double)> report, double from, double to)
  : Report(std::move(report))
  , From(from)
  , To(to)
  , Reported(from)
  , Outer(std::exchange(innermost, this))
{
}

LoopProgress::~LoopProgress()
{
  innermost = this->Outer;
  if (std::uncaught_exceptions() == 0)
  {
    this->Report(this->To);
  }
}

//------------------------------------------------------------------------------
void LoopProgress::at(double done)
{
  if (innermost)
  {
    innermost->take(std::clamp(done, 0.0, 1.0));
  }
}

void LoopProgress::take(double done)
{
  if (done < this->Last)
  {
    this->From += ShareOfLoop * this->Last * (this->To - this->From);
  }
  this->Last = done;
  const double now = this->From + ShareOfLoop * done * (this->To - this->From);
  if (now >= this->Reported + SmallestStep)
  {
    this->Reported = now;
    this->Report(now);
  }
}

//------------------------------------------------------------------------------
LoopProgress::Nested::Nested()
  : Outer(std::exchange(innermost, nullptr))
{
}

LoopProgress::Nested::~Nested()
{
  innermost = this->Outer;
}
}
