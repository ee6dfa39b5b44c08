// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OrderlessSums.h
 * @brief Sums that are almost always independent of the order of their terms.
 * Internal: not installed.
 */
#ifndef tautline_OrderlessSums_h
#define tautline_OrderlessSums_h

#include <cstddef>
#include <vector>

namespace tautline
{
/**
 * @class tautline::OrderlessSums
 * @brief Sums with their accumulated rounding errors, which are added at the end (T. Ogita, S. Rump
 * and S. Oishi, "Accurate sum and dot product", SIAM J. Sci. Comput. 26, 2005, Sum2). If cells are
 * visited in an order that depends on the decomposition of a mesh, the results are the same except
 * in about one of 1e15 cases.
 */
class OrderlessSums
{
public:
  /// @param sums the initial values and, after finish(), the results
  OrderlessSums(double* sums, std::size_t count)
    : Sums(sums)
    , Rests(count, 0.0)
  {
  }

  void add(std::size_t i, double term)
  {
    const double before = this->Sums[i], sum = before + term, part = sum - before;
    this->Rests[i] += (before - (sum - part)) + (term - part);
    this->Sums[i] = sum;
  }

  void finish()
  {
    for (std::size_t i = 0; i < this->Rests.size(); ++i)
    {
      this->Sums[i] += this->Rests[i];
    }
  }

private:
  double* Sums;
  std::vector<double> Rests;
};
}
#endif
