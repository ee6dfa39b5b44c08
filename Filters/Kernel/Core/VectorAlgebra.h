// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VectorAlgebra.h
 * @brief Threaded operations on long vectors, bitwise the same for any number of threads.
 * Internal: not installed.
 */
#ifndef tautline_VectorAlgebra_h
#define tautline_VectorAlgebra_h

#include "Parallel.h"
#include "RankGroup.h"

#include <numeric>
#include <vector>

namespace tautline
{
/// The order in which the lane sums are added at the end of a chunk.
enum class LaneOrder
{
  Sequential, ///< one after the other, starting from the sum of the remaining entries
  Halves      ///< by halves, then those entries
};

class VectorAlgebra
{
public:
  /**
   * @brief For vectors of `size` entries; threads as in Parallel.h.
   * @param group null, or ranks that each have a part of the vectors, of any size. The sums are
   * then over the whole vectors, independent of the distribution, and collective.
   */
  VectorAlgebra(std::size_t size, int threads, LaneOrder order = LaneOrder::Sequential,
    RankGroup* group = nullptr)
    : Size(static_cast<Index>(size))
    , Threads(threads)
    , Order(order)
    , Group(group)
    , Partial(numberOfChunks(Size))
    , Terms(group ? size : 0)
  {
  }

  std::size_t size() const { return static_cast<std::size_t>(this->Size); }
  /// Entries on all ranks.
  Index totalSize() const { return this->Group ? this->Group->sum(this->Size) : this->Size; }

  /// Calls work(i) for each entry.
  template <class Work>
  void each(const Work& work) const
  {
    forEachChunk(this->Size, this->Threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          work(i);
        }
      });
  }

  /// The sum of term(i), which may have effects on entry i.
  template <class Term>
  double sum(const Term& term) const
  {
    if (this->Group)
    {
      this->each([&](Index i) { this->Terms[i] = term(i); });
      return this->Group->orderlessSum(this->Terms);
    }
    forEachChunk(this->Size, this->Threads,
      [&](Index chunk, Index begin, Index end)
      {
        // Several independent sums, for vectorization.
        double sums[Lanes] = {};
        Index i = begin;
        for (; i + Lanes <= end; i += Lanes)
        {
          for (int k = 0; k < Lanes; ++k)
          {
            sums[k] += term(i + k);
          }
        }
        const bool halves = this->Order == LaneOrder::Halves;
        double total = halves ? sumByHalves(sums) : 0.0;
        for (; i < end; ++i)
        {
          total += term(i);
        }
        this->Partial[chunk] = halves ? total : std::accumulate(sums, sums + Lanes, total);
      });
    return std::accumulate(this->Partial.begin(), this->Partial.end(), 0.0);
  }

  double dot(const double* a, const double* b) const
  {
    return this->sum([=](Index i) { return a[i] * b[i]; });
  }

  /**
   * @brief Sets a[i] = update(a[i], i) and returns a . b; with sequential lanes, in one pass over
   * memory.
   */
  template <class Update>
  double updateAndDot(const Update& update, double* a, const double* b) const
  {
    if (this->Order == LaneOrder::Halves)
    {
      this->each([=](Index i) { a[i] = update(a[i], i); });
      return this->dot(a, b);
    }
    return this->sum(
      [=](Index i)
      {
        a[i] = update(a[i], i);
        return a[i] * b[i];
      });
  }

  /// y = x + a z, where y may be x.
  void addScaled(const double* x, double a, const double* z, double* y) const
  {
    this->each([=](Index i) { y[i] = x[i] + a * z[i]; });
  }

private:
  static constexpr int Lanes = 8;

  static double sumByHalves(double* sums)
  {
    for (int half = Lanes / 2; half > 0; half /= 2)
    {
      for (int k = 0; k < half; ++k)
      {
        sums[k] += sums[k + half];
      }
    }
    return sums[0];
  }

  Index Size;
  int Threads;
  LaneOrder Order;
  RankGroup* Group;
  mutable std::vector<double> Partial;
  mutable std::vector<double> Terms; ///< the terms of a sum over ranks
};
}
#endif
