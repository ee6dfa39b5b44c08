// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DualNumber.h
 * @brief A number with its derivatives: the formulas of a user's own metric are written in it.
 *
 * DualNumber<K> carries the derivatives by K variables through every operation (forward automatic
 * differentiation); DualNumber<0> is the value alone. It is a packet: one number for each of
 * several elements, so that a formula runs in the vector unit. That is why a comparison is no
 * `bool` and there is no `if` on a number: write select(x < y, a, b).
 *
 * Loops over entries or corners are best unrolled (`#pragma GCC unroll 3`): the derivatives that
 * are always 0 then cost nothing.
 *
 * Where a function is singular (1 / 0, sqrt of a negative number) value and derivatives are not
 * finite; the evaluation replaces such values by 0.
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

template <int Variables>
struct DualNumber
{
  static constexpr int variables = Variables;

  Packet value;
  Packet slope[Variables > 0 ? Variables : 1]; ///< unused where there are no variables

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
  /// f(x), of which f and df/dx are given.
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

  /// `yes` where the condition holds, else `no`.
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
    const Mask finite = DualNumber::isFinite(x.value);
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
  /// x^exponent for x > 0, as std::pow() elsewhere; thirds of whole numbers are fast.
  friend DualNumber pow(const DualNumber& x, double exponent)
  {
    const Packet f = powerOf(x.value, exponent);
    return chain(x, f, exponent * powerOf(x.value, exponent - 1.0));
  }

private:
  static Mask isFinite(Packet x)
  {
    return tautline::abs(x) <= std::numeric_limits<double>::max();
  }

  static Packet powerOf(Packet x, double exponent)
  {
    constexpr double largest = 12;
    const double thirds = 3 * exponent;
    const double whole = std::round(thirds);
    if (std::abs(thirds - whole) > 8 * std::numeric_limits<double>::epsilon() ||
      std::abs(whole) > largest)
    {
      return tautline::pow(x, exponent);
    }
    int n = static_cast<int>(std::abs(whole));
    Packet base = x;
    if (n % 3 == 0)
    {
      n /= 3;
    }
    else
    {
      const Packet inverse = inverseCbrt(x);
      base = tautline::select((x > 0.0) & DualNumber::isFinite(x), x * inverse * inverse,
        each(x, [](double v) { return v == 0 || v == HUGE_VAL ? v : NAN; }));
    }
    Packet result = broadcast(1.0);
    for (; n > 0; n >>= 1)
    {
      result = n & 1 ? Packet(result * base) : result;
      base *= base;
    }
    return exponent < 0 ? Packet(1.0 / result) : result;
  }
};

/// x y z of a point or vector.
template <class Number>
using DualVector = std::array<Number, 3>;

template <int K>
DualVector<DualNumber<K>> operator-(
  const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

template <int K>
DualVector<DualNumber<K>> operator+(
  const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}

template <int K>
DualNumber<K> dot(const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <int K>
DualVector<DualNumber<K>> cross(
  const DualVector<DualNumber<K>>& a, const DualVector<DualNumber<K>>& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

template <int K>
DualNumber<K> norm(const DualVector<DualNumber<K>>& a)
{
  return sqrt(dot(a, a));
}
}
#endif
