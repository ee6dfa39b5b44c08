// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionProgress.h
 * @brief The common part of runs on tetrahedra and triangles: the clock, the observer and the
 * history; the queue of the worst cells; the sweeps for the mean.
 * Internal: not installed.
 */
#ifndef tautline_ReconnectionProgress_h
#define tautline_ReconnectionProgress_h

#include "Constants.h"
#include "ReconnectionOptions.h"
#include "ReconnectionResult.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <vector>

namespace tautline
{
/// The clock, the observer and the history of a run; starts at construction.
class ReconnectionProgress
{
public:
  /// Both must outlive this object.
  ReconnectionProgress(const ReconnectionOptions& options, ReconnectionResult& result)
    : Options(options)
    , Result(result)
  {
  }

  /**
   * @brief Adds a line to the history.
   * @param record without number and seconds
   * @param fraction fraction of the run done
   * @return false if the observer stops the run; this becomes the reason unless proceed() has ended
   * the run
   */
  bool record(ReconnectionRecord record, int pass, double fraction);
  /// Called periodically within a pass; false if the run ends; the result has the reason.
  bool proceed();

  /// Whether the time limit is reached.
  bool late() const { return this->Clock.reached(this->Options.maximumSeconds); }
  double fraction() const { return this->Fraction; }
  const ReconnectionRecord& last() const { return this->Result.history.back(); }

  /**
   * @brief Moves all points in turn for the mean, until a sweep hardly decreases the sum.
   * @param points their number
   * @param cells the number of cells
   * @param move improves the mean by moving a point; returns the decrease of the sum
   * @return false if stopped
   */
  template <class Point, class Move>
  bool sweepForMean(Point points, Index cells, const Move& move)
  {
    bool stopped = false;
    for (int sweep = 0; sweep < MaxMeanSweeps && !stopped; ++sweep)
    {
      double decrease = 0.0;
      for (Point v = 0; v < points && !stopped; ++v)
      {
        stopped = v % MeanInterval == 0 && !this->proceed();
        decrease += stopped ? 0.0 : move(v);
      }
      if (decrease < LeastMeanDecrease * static_cast<double>(cells))
      {
        break;
      }
    }
    return !stopped;
  }

private:
  const ReconnectionOptions& Options;
  ReconnectionResult& Result;
  Stopwatch Clock;
  double LastCall = 0, Fraction = 0;
};

/// Cells ordered by quality: the worst comes first, ties by the smallest id.
template <class Cell>
class QualityQueue
{
public:
  struct Entry
  {
    double quality;
    Cell cell;
    bool operator<(const Entry& other) const
    {
      return this->quality != other.quality ? this->quality > other.quality
                                            : this->cell > other.cell;
    }
  };

  /// All cells from 0 on that `counts`.
  template <class Mesh, class Counts>
  void fill(const Mesh& mesh, const Counts& counts)
  {
    this->Heap.clear();
    for (Cell t = 0; t < mesh.slots(); ++t)
    {
      pollInterruption(t);
      if (counts(t))
      {
        this->Heap.push_back({ mesh.quality(t), t });
      }
    }
    std::make_heap(this->Heap.begin(), this->Heap.end());
  }
  bool empty() const { return this->Heap.empty(); }
  void push(const Entry& entry)
  {
    this->Heap.push_back(entry);
    std::push_heap(this->Heap.begin(), this->Heap.end());
  }
  Entry pop()
  {
    std::pop_heap(this->Heap.begin(), this->Heap.end());
    const Entry entry = this->Heap.back();
    this->Heap.pop_back();
    return entry;
  }

private:
  std::vector<Entry> Heap;
};
}
#endif
