/**
 * @file VectorAlgebra.h
 * @brief Threaded operations on long vectors, bitwise the same for any number of threads. Internal:
 * not installed.
 */
#ifndef tautline_VectorAlgebra_h
#define tautline_VectorAlgebra_h

#include "Parallel.h"

#include <numeric>
#include <vector>

namespace tautline
{
class VectorAlgebra
{
public:
  VectorAlgebra(std::size_t size, int threads)
    : Size(static_cast<Index>(size))
    , Threads(threads)
    , Partial(numberOfChunks(Size))
  {
  }

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
    forEachChunk(this->Size, this->Threads,
      [&](Index chunk, Index begin, Index end)
      {
        // Several sums side by side, for the vector units.
        constexpr int width = 8;
        double sums[width] = {};
        Index i = begin;
        for (; i + width <= end; i += width)
        {
          for (int k = 0; k < width; ++k)
          {
            sums[k] += term(i + k);
          }
        }
        double total = 0;
        for (; i < end; ++i)
        {
          total += term(i);
        }
        this->Partial[chunk] = std::accumulate(sums, sums + width, total);
      });
    return std::accumulate(this->Partial.begin(), this->Partial.end(), 0.0);
  }

  double dot(const double* a, const double* b) const
  {
    return this->sum([=](Index i) { return a[i] * b[i]; });
  }

private:
  Index Size;
  int Threads;
  mutable std::vector<double> Partial;
};
}
#endif
