// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BernsteinQuotient.h
 * @brief The minimum of the quotient of a polynomial and a root of a product of polynomials, by
 * branch and bound.
 *
 * Let D be the numerator and F_i > 0 the other polynomials, all in one Bernstein space. Over a box,
 * the denominator is at most a linear combination E of the F_i, and D / E is at least the smallest
 * quotient of coefficients D_k / E_k if it is positive. E is:
 * - for F: F itself;
 * - for (F / 3)^(3/2), which is convex: its secant between the smallest and the largest F_k;
 * - for sqrt(F G): (t F + G / t) / 2, where t is chosen from the means of F and G;
 * - for sqrt(F G H): the bound of (S / 3)^(3/2), where S is a sum with weights of product 1. The
 * bounds converge with the square of the size of the boxes.
 * Internal: not installed.
 */
#ifndef tautline_BernsteinQuotient_h
#define tautline_BernsteinQuotient_h

#include "BernsteinHalving.h"

namespace tautline
{
/// The denominator of a quotient, from one to three polynomials.
enum class QuotientDenominator
{
  Itself,      ///< F
  ThreeHalves, ///< (F / 3)^(3/2)
  RootOfTwo,   ///< sqrt(F G)
  RootOfThree  ///< sqrt(F G H)
};

/// The number of polynomials of a denominator.
int polynomialsOf(QuotientDenominator denominator);

/// Bounds of the minimum of a quotient.
struct QuotientMinimum
{
  double lower = 0;
  double upper = 0;      ///< a value
  Vec3 at = { 0, 0, 0 }; ///< the position of that value
};

/**
 * @class BernsteinQuotient
 * @brief Searches quotients of one kind.
 *
 * Has its own memory: use one object per thread. The tables must outlive it.
 */
class BernsteinQuotient
{
public:
  BernsteinQuotient(QuotientDenominator denominator, const BernsteinSpace& space,
    const std::vector<BernsteinBisection>& bisections, const std::vector<BernsteinCorner>& corners);

  /// The storage for the coefficients of polynomial i: 0 is the numerator, then the others.
  double* coefficients(int i) { return this->Pool.data() + i * this->Size; }

  /**
   * @param power the quotient is raised to this power; the tolerance and the bounds refer to the
   * result; at most 1
   * @param tolerance the largest distance of the bounds
   * @param above the search also ends when the lower bound reaches this value
   *
   * Ends if the numerator is found to be negative, with the value there (with the sign of the
   * numerator) as the upper bound and -infinity as the lower bound.
   */
  QuotientMinimum minimum(double power, double tolerance, double above);

  /// The smallest value at the corners of the domain, raised to the power, as both bounds.
  QuotientMinimum atCorners(double power);

  int splits() const { return this->Splits; }
  static constexpr int MaxSplits = 4000;

private:
  static constexpr int MaxPolynomials = 4;

  struct Box
  {
    double least; ///< lower bound of the quotient, at least 0
    int slot;
    int age; ///< bisections since the measures were computed
    BernsteinHalving::Vertices vertices;
    BernsteinHalving::Measures measures;
  };

  double* at(const Box& box, int i = 0)
  {
    return this->Pool.data() + (box.slot * this->Count + i) * this->Size;
  }
  int newSlot();
  void push(const Box& box);
  /// Computes the denominators and the bound.
  void bound(Box& box);
  void addSecant(const double* sum);
  void measure(Box& box);
  Box split(Box& box);
  /// The whole domain.
  Box whole() const;
  void lookAtCorners(const Box& box, QuotientMinimum& result);

  QuotientDenominator Denominator;
  BernsteinHalving Halving;
  const std::vector<BernsteinCorner>& Corners;
  std::size_t Count; ///< number of polynomials, including the numerator
  std::size_t Size;
  std::vector<double> Pool, Sum, Below;
  std::vector<int> Free;
  std::vector<Box> Heap;
  int Slots = 1;
  int Splits = 0;
};
}
#endif
