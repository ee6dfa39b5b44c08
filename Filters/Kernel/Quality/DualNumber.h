// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DualNumber.h
 * @brief A number with its derivatives, in which the formulas of user metrics are written.
 *
 * DualNumber<K> propagates the derivatives with respect to K variables through every operation
 * (forward automatic differentiation); DualNumber<0> is only the value. It is a packet with one
 * number for each of several elements, so that formulas are vectorized. Therefore, a comparison is
 * not a `bool`, and `if` cannot be used on a number: write select(x < y, a, b).
 *
 * Loops over entries or corners are best unrolled (`#pragma GCC unroll 3`): derivatives that are
 * always 0 then cost nothing.
 *
 * Where a function is singular (1 / 0, sqrt of a negative number), the value and derivatives are
 * not finite. Measured values are then 0; an objective is infinite, so that steps avoid it.
 */
#ifndef tautline_DualNumber_h
#define tautline_DualNumber_h

#include "tautline/Core/Packet.h"

#include <array>
#include <limits>

namespace tautline
{
/// The result of a comparison, one per element.
struct DualMask
{
  Mask mask;
  friend DualMask operator&(DualMask a, DualMask b) { return { a.mask & b.mask }; }
  friend DualMask operator|(DualMask a, DualMask b) { return { a.mask | b.mask }; }
  friend DualMask operator~(DualMask a) { return { ~a.mask }; }
};

namespace dual_number
{
inline Mask isFinite(Packet x)
{
  return tautline::abs(x) <= std::numeric_limits<double>::max();
}

/// For x > 0 and 0; otherwise NaN.
inline Packet cubeRoot(Packet x)
{
  const Packet inverse = inverseCbrt(x);
  const Packet special =
    select((x == 0.0) | (x == HUGE_VAL), x, broadcast(std::numeric_limits<double>::quiet_NaN()));
  return select((x > 0.0) & isFinite(x), x * inverse * inverse, special);
}

/// A power of x > 0 (otherwise as std::pow()) and its derivatives. If the exponent is a small
/// multiple of 1/3, all are whole powers of the same number: x or its cube root.
class Power
{
public:
  Power(Packet x, double exponent)
    : X(x)
    , Exponent(exponent)
  {
    constexpr double most = 12;
    const double thirds = 3 * exponent, rounded = std::round(thirds);
    this->Few = std::abs(thirds - rounded) <= 8 * std::numeric_limits<double>::epsilon() &&
      std::abs(rounded) <= most;
    if (this->Few)
    {
      const int count = static_cast<int>(rounded);
      const bool whole = count % 3 == 0;
      this->Base = whole ? x : cubeRoot(x);
      this->Count = whole ? count / 3 : count;
      this->One = whole ? 1 : 3;
    }
  }

  /// The derivative of an order.
  Packet lowered(int order) const
  {
    double factor = 1;
    for (int i = 0; i < order; ++i)
    {
      factor *= this->Exponent - i;
    }
    if (!this->Few)
    {
      return factor * tautline::pow(this->X, this->Exponent - order);
    }
    const int count = this->Count - order * this->One;
    Packet result = broadcast(1.0), base = this->Base;
    for (int n = std::abs(count); n > 0; n >>= 1)
    {
      result = n & 1 ? Packet(result * base) : result;
      base *= base;
    }
    return count < 0 ? Packet(factor / result) : Packet(factor * result);
  }

private:
  Packet X, Base;
  double Exponent;
  bool Few;
  int Count = 0, One = 1;
};
}

template <int Variables>
struct DualNumber
{
  static constexpr int variables = Variables;

  Packet value;
  Packet slope[Variables > 0 ? Variables : 1]; ///< unused without variables

  DualNumber() = default;
  /// A constant.
  DualNumber(double constant)
    : DualNumber(broadcast(constant))
  {
  }
  explicit DualNumber(Packet constant)
    : value(constant)
  {
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      this->slope[k] = Packet{};
    }
  }
  /// Variable k.
  static DualNumber variable(Packet x, int k)
  {
    DualNumber result(x);
    if (Variables > 0)
    {
      result.slope[k] = broadcast(1.0);
    }
    return result;
  }
  /// f(x) for given f and df/dx.
  static DualNumber chain(const DualNumber& x, Packet f, Packet derivative)
  {
    DualNumber result;
    result.value = f;
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      result.slope[k] = derivative * x.slope[k];
    }
    return result;
  }

  friend DualNumber operator+(const DualNumber& a, const DualNumber& b)
  {
    DualNumber result;
    result.value = a.value + b.value;
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      result.slope[k] = a.slope[k] + b.slope[k];
    }
    return result;
  }
  friend DualNumber operator-(const DualNumber& a, const DualNumber& b)
  {
    DualNumber result;
    result.value = a.value - b.value;
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      result.slope[k] = a.slope[k] - b.slope[k];
    }
    return result;
  }
  friend DualNumber operator*(const DualNumber& a, const DualNumber& b)
  {
    DualNumber result;
    result.value = a.value * b.value;
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      result.slope[k] = a.slope[k] * b.value + a.value * b.slope[k];
    }
    return result;
  }
  friend DualNumber operator/(const DualNumber& a, const DualNumber& b)
  {
    DualNumber result;
    const Packet inverse = 1.0 / b.value;
    result.value = a.value * inverse;
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      result.slope[k] = (a.slope[k] - result.value * b.slope[k]) * inverse;
    }
    return result;
  }
  // With constants: fewer operations.
  friend DualNumber operator+(const DualNumber& a, double b)
  {
    DualNumber result = a;
    result.value += b;
    return result;
  }
  friend DualNumber operator+(double a, const DualNumber& b)
  {
    return b + a;
  }
  friend DualNumber operator-(const DualNumber& a, double b)
  {
    return a + -b;
  }
  friend DualNumber operator-(double a, const DualNumber& b)
  {
    return chain(b, a - b.value, broadcast(-1.0));
  }
  friend DualNumber operator-(const DualNumber& a)
  {
    return 0.0 - a;
  }
  friend DualNumber operator*(const DualNumber& a, double b)
  {
    return chain(a, a.value * b, broadcast(b));
  }
  friend DualNumber operator*(double a, const DualNumber& b)
  {
    return b * a;
  }
  friend DualNumber operator/(const DualNumber& a, double b)
  {
    return a * (1.0 / b);
  }
  friend DualNumber operator/(double a, const DualNumber& b)
  {
    const Packet inverse = 1.0 / b.value;
    return chain(b, a * inverse, -a * inverse * inverse);
  }
  DualNumber& operator+=(const DualNumber& b)
  {
    this->value += b.value;
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      this->slope[k] += b.slope[k];
    }
    return *this;
  }
  DualNumber& operator-=(const DualNumber& b)
  {
    this->value -= b.value;
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      this->slope[k] -= b.slope[k];
    }
    return *this;
  }
  DualNumber& operator*=(const DualNumber& b)
  {
    return *this = *this * b;
  }
  DualNumber& operator/=(const DualNumber& b)
  {
    return *this = *this / b;
  }

  friend DualMask operator<(const DualNumber& a, const DualNumber& b)
  {
    return { a.value < b.value };
  }
  friend DualMask operator>(const DualNumber& a, const DualNumber& b)
  {
    return { a.value > b.value };
  }
  friend DualMask operator<=(const DualNumber& a, const DualNumber& b)
  {
    return { a.value <= b.value };
  }
  friend DualMask operator>=(const DualNumber& a, const DualNumber& b)
  {
    return { a.value >= b.value };
  }

  /// `yes` where the condition holds, otherwise `no`.
  friend DualNumber select(DualMask condition, const DualNumber& yes, const DualNumber& no)
  {
    DualNumber result;
    result.value = tautline::select(condition.mask, yes.value, no.value);
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      result.slope[k] = tautline::select(condition.mask, yes.slope[k], no.slope[k]);
    }
    return result;
  }
  friend DualNumber min(const DualNumber& a, const DualNumber& b)
  {
    return select(a < b, a, b);
  }
  friend DualNumber max(const DualNumber& a, const DualNumber& b)
  {
    return select(a > b, a, b);
  }
  friend DualNumber abs(const DualNumber& x)
  {
    return chain(x, tautline::abs(x.value), signOf(x.value));
  }
  friend DualNumber sqrt(const DualNumber& x)
  {
    const Packet root = tautline::sqrt(x.value);
    return chain(x, root, 0.5 / root);
  }
  friend DualNumber cbrt(const DualNumber& x)
  {
    const Packet inverse = inverseCbrt(tautline::abs(x.value)), square = inverse * inverse;
    const Mask finite = dual_number::isFinite(x.value);
    return chain(x, tautline::select(finite, x.value * square, x.value),
      tautline::select(finite, square * (1.0 / 3.0), Packet{}));
  }
  friend DualNumber exp(const DualNumber& x)
  {
    const Packet e = each(x.value, [](double v) { return std::exp(v); });
    return chain(x, e, e);
  }
  friend DualNumber log(const DualNumber& x)
  {
    return chain(x, tautline::log(x.value), 1.0 / x.value);
  }
  friend DualNumber sin(const DualNumber& x)
  {
    return chain(x, each(x.value, [](double v) { return std::sin(v); }),
      each(x.value, [](double v) { return std::cos(v); }));
  }
  friend DualNumber cos(const DualNumber& x)
  {
    return chain(x, each(x.value, [](double v) { return std::cos(v); }),
      each(x.value, [](double v) { return -std::sin(v); }));
  }
  /// In radians.
  friend DualNumber acos(const DualNumber& x)
  {
    return chain(x, each(x.value, [](double v) { return std::acos(v); }),
      -1.0 / tautline::sqrt(1.0 - x.value * x.value));
  }
  /// The angle of the vector (x, y), in radians.
  friend DualNumber atan2(const DualNumber& y, const DualNumber& x)
  {
    DualNumber result;
    const Packet perNorm2 = 1.0 / (x.value * x.value + y.value * y.value);
    for (int l = 0; l < PacketWidth; ++l)
    {
      result.value[l] = std::atan2(y.value[l], x.value[l]);
    }
#pragma GCC unroll 24
    for (int k = 0; k < Variables; ++k)
    {
      result.slope[k] = (x.value * y.slope[k] - y.value * x.slope[k]) * perNorm2;
    }
    return result;
  }
  /// x^exponent for x > 0, otherwise as std::pow(); multiples of 1/3 are fast.
  friend DualNumber pow(const DualNumber& x, double exponent)
  {
    const dual_number::Power power(x.value, exponent);
    return chain(x, power.lowered(0), Variables > 0 ? power.lowered(1) : Packet{});
  }
};

/// x y z of a point or vector. Its functions are always inlined; otherwise numbers would pass
/// through memory.
template <class Number>
using DualVector = std::array<Number, 3>;

template <int K>
inline __attribute__((always_inline)) DualVector<DualNumber<K>> operator-(
  const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

template <int K>
inline __attribute__((always_inline)) DualVector<DualNumber<K>> operator+(
  const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}

template <int K>
inline __attribute__((always_inline)) DualNumber<K> dot(
  const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <int K>
inline __attribute__((always_inline)) DualVector<DualNumber<K>> cross(
  const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

template <int K>
inline __attribute__((always_inline)) DualNumber<K> norm(const DualVector<DualNumber<K>>& a)
{
  return sqrt(dot(a, a));
}
}
#endif
