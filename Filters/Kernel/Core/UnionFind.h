// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UnionFind.h
 * @brief Disjoint sets of the numbers 0 to n - 1 (R. E. Tarjan, "Efficiency of a good but not
 * linear set union algorithm", J. ACM 22, 1975).
 */
#ifndef tautline_UnionFind_h
#define tautline_UnionFind_h

#include "Types.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace tautline
{
/// Disjoint sets; the root of a set is its smallest member, for any order of the joins.
class UnionFind
{
public:
  /// n sets of one member each; n is at least 0.
  explicit UnionFind(Index n)
    : Parent(static_cast<std::size_t>(n))
  {
    std::iota(this->Parent.begin(), this->Parent.end(), Index(0));
  }

  /// The smallest member of the set of i; compresses the path for the next call.
  Index find(Index i)
  {
    while (this->Parent[i] != i)
    {
      i = this->Parent[i] = this->Parent[this->Parent[i]];
    }
    return i;
  }

  /// Merges the sets of i and j.
  void join(Index i, Index j)
  {
    i = this->find(i);
    j = this->find(j);
    this->Parent[std::max(i, j)] = std::min(i, j);
  }

private:
  std::vector<Index> Parent;
};
}
#endif
