// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LimitedMemory.h
 * @brief The history and the two-loop recursion of limited-memory BFGS (J. Nocedal and S. J.
 * Wright, "Numerical Optimization", 2nd ed. 2006, section 7.2).
 * Internal: not installed.
 */
#ifndef tautline_LimitedMemory_h
#define tautline_LimitedMemory_h

#include "VectorAlgebra.h"

#include <cmath>
#include <utility>

namespace tautline
{
/// The last steps of a minimization and the approximation of the inverse Hessian they give.
class LimitedMemory
{
public:
  /// A step s and the change y of the gradient over it.
  struct Pair
  {
    std::vector<double> s, y;
    double sy = 0, yy = 0; ///< s . y and y . y
  };

  /// `algebra` must outlive this object.
  explicit LimitedMemory(const VectorAlgebra& algebra)
    : Algebra(algebra)
  {
  }
  /// A copy of its owner would refer to the algebra of the original.
  LimitedMemory(const LimitedMemory&) = delete;
  LimitedMemory& operator=(const LimitedMemory&) = delete;

  bool empty() const { return this->Pairs.empty(); }
  const Pair& newest() const { return this->Pairs.back(); }
  void clear() { this->Pairs.clear(); }

  /**
   * @brief Keeps the pair of a step t d from the gradient `before` to `after`, if the function
   * curves upwards along it. A full memory loses its oldest pair either way.
   */
  void add(double t, const double* d, const double* before, const double* after)
  {
    Pair pair;
    if (this->Pairs.size() == Capacity)
    {
      pair = std::move(this->Pairs.front());
      this->Pairs.erase(this->Pairs.begin());
    }
    pair.s.resize(this->Algebra.size());
    pair.y.resize(this->Algebra.size());
    double *s = pair.s.data(), *y = pair.y.data();
    this->Algebra.each(
      [=](Index i)
      {
        s[i] = t * d[i];
        y[i] = after[i] - before[i];
      });
    pair.sy = this->Algebra.dot(s, y);
    pair.yy = this->Algebra.dot(y, y);
    const double ss = this->Algebra.dot(s, s);
    if (pair.sy > SmallestCosine * std::sqrt(ss * pair.yy))
    {
      this->Pairs.push_back(std::move(pair));
    }
  }

  /**
   * @brief d = -H g with the approximation H of the inverse Hessian.
   * @param precondition called as double(std::vector<double>& q) between the loops: replaces q by P
   * q, with its own approximation P of the inverse Hessian, and returns a factor for P
   * @return the slope g . d
   */
  template <class Precondition>
  double direction(
    const std::vector<double>& g, std::vector<double>& d, const Precondition& precondition) const
  {
    const int pairs = static_cast<int>(this->Pairs.size());
    const VectorAlgebra& algebra = this->Algebra;
    double* q = d.data();
    const double* gradient = g.data();
    // Each update is fused with the product for the next one.
    const double* s = pairs > 0 ? this->newest().s.data() : gradient;
    double product = algebra.updateAndDot([=](double, Index i) { return -gradient[i]; }, q, s);
    double alpha[Capacity];
    for (int k = pairs - 1; k >= 0; --k)
    {
      alpha[k] = product / this->Pairs[k].sy;
      const double a = alpha[k];
      const double* y = this->Pairs[k].y.data();
      s = this->Pairs[std::max(k - 1, 0)].s.data();
      product = algebra.updateAndDot([=](double x, Index i) { return x - a * y[i]; }, q, s);
    }
    const double gamma = precondition(d);
    q = d.data();
    const double* y = pairs > 0 ? this->Pairs.front().y.data() : gradient;
    product = algebra.updateAndDot([=](double x, Index) { return gamma * x; }, q, y);
    for (int k = 0; k < pairs; ++k)
    {
      const double a = alpha[k] - product / this->Pairs[k].sy;
      s = this->Pairs[k].s.data();
      const double* next = k + 1 < pairs ? this->Pairs[k + 1].y.data() : gradient;
      product = algebra.updateAndDot([=](double x, Index i) { return x + a * s[i]; }, q, next);
    }
    return product;
  }

private:
  static constexpr std::size_t Capacity = 8;
  static constexpr double SmallestCosine = 1e-10; ///< between s and y of a pair

  const VectorAlgebra& Algebra;
  std::vector<Pair> Pairs; ///< oldest first
};
}
#endif
