// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InvariantNumber.h
 * @brief A number with its first and second derivatives with respect to |T|^2 and det T.
 *
 * Used to evaluate user formulas that only read T through norm2() and det(): sufficient for
 * Newton's method.
 */
#ifndef tautline_InvariantNumber_h
#define tautline_InvariantNumber_h

#include "DualNumber.h"

namespace tautline
{
/// Used instead of the number of variables.
constexpr int ByInvariants = -2;

/// Like the other dual numbers, see there.
template <>
struct DualNumber<ByInvariants>
{
  static constexpr int variables = ByInvariants;

  Packet value;
  Packet slope[2];     ///< with respect to |T|^2, det T
  Packet curvature[3]; ///< with respect to |T|^2 twice, |T|^2 and det T, det T twice

  DualNumber() = default;
  /// A constant.
  DualNumber(double constant)
    : DualNumber(broadcast(constant))
  {
  }
  explicit DualNumber(Packet constant)
    : value(constant)
    , slope{}
    , curvature{}
  {
  }
  /// |T|^2 (0) or det T (1).
  static DualNumber variable(Packet x, int k)
  {
    DualNumber result(x);
    result.slope[k] = broadcast(1.0);
    return result;
  }
  /// f(x) with df/dx and its derivative.
  static DualNumber chain(const DualNumber& x, Packet f, Packet first, Packet second)
  {
    DualNumber result;
    result.value = f;
    for (int i = 0; i < 2; ++i)
    {
      result.slope[i] = first * x.slope[i];
      const Packet bySecond = second * x.slope[i];
      for (int j = 0; j <= i; ++j)
      {
        result.curvature[i + j] = first * x.curvature[i + j] + bySecond * x.slope[j];
      }
    }
    return result;
  }

  friend DualNumber operator+(const DualNumber& a, const DualNumber& b)
  {
    return combine(a, b, [](Packet x, Packet y) { return x + y; });
  }
  friend DualNumber operator-(const DualNumber& a, const DualNumber& b)
  {
    return combine(a, b, [](Packet x, Packet y) { return x - y; });
  }
  friend DualNumber operator*(const DualNumber& a, const DualNumber& b)
  {
    DualNumber result;
    result.value = a.value * b.value;
    for (int i = 0; i < 2; ++i)
    {
      result.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
      for (int j = 0; j <= i; ++j)
      {
        result.curvature[i + j] = a.curvature[i + j] * b.value + a.value * b.curvature[i + j] +
          (a.slope[i] * b.slope[j] + a.slope[j] * b.slope[i]);
      }
    }
    return result;
  }
  friend DualNumber operator/(const DualNumber& a, const DualNumber& b) { return a * (1.0 / b); }
  friend DualNumber operator+(const DualNumber& a, double b)
  {
    DualNumber result = a;
    result.value += b;
    return result;
  }
  friend DualNumber operator+(double a, const DualNumber& b) { return b + a; }
  friend DualNumber operator-(const DualNumber& a, double b) { return a + -b; }
  friend DualNumber operator-(double a, const DualNumber& b)
  {
    return chain(b, a - b.value, broadcast(-1.0), Packet{});
  }
  friend DualNumber operator-(const DualNumber& a) { return 0.0 - a; }
  friend DualNumber operator*(const DualNumber& a, double b)
  {
    return chain(a, a.value * b, broadcast(b), Packet{});
  }
  friend DualNumber operator*(double a, const DualNumber& b) { return b * a; }
  friend DualNumber operator/(const DualNumber& a, double b) { return a * (1.0 / b); }
  friend DualNumber operator/(double a, const DualNumber& b)
  {
    const Packet inverse = 1.0 / b.value, first = -a * inverse * inverse;
    return chain(b, a * inverse, first, -2.0 * first * inverse);
  }
  DualNumber& operator+=(const DualNumber& b) { return *this = *this + b; }
  DualNumber& operator-=(const DualNumber& b) { return *this = *this - b; }
  DualNumber& operator*=(const DualNumber& b) { return *this = *this * b; }
  DualNumber& operator/=(const DualNumber& b) { return *this = *this / b; }

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

  friend DualNumber select(DualMask condition, const DualNumber& yes, const DualNumber& no)
  {
    return combine(
      yes, no, [=](Packet y, Packet n) { return tautline::select(condition.mask, y, n); });
  }
  friend DualNumber min(const DualNumber& a, const DualNumber& b) { return select(a < b, a, b); }
  friend DualNumber max(const DualNumber& a, const DualNumber& b) { return select(a > b, a, b); }
  friend DualNumber abs(const DualNumber& x)
  {
    return chain(x, tautline::abs(x.value), signOf(x.value), Packet{});
  }
  friend DualNumber sqrt(const DualNumber& x)
  {
    const Packet root = tautline::sqrt(x.value), first = 0.5 / root;
    return chain(x, root, first, -0.5 * first / x.value);
  }
  friend DualNumber cbrt(const DualNumber& x)
  {
    const Packet inverse = inverseCbrt(tautline::abs(x.value)), square = inverse * inverse;
    const Mask finite = dual_number::isFinite(x.value);
    const Packet first = tautline::select(finite, square * (1.0 / 3.0), Packet{});
    return chain(x, tautline::select(finite, x.value * square, x.value), first,
      tautline::select(finite, (-2.0 / 3.0) * first / x.value, Packet{}));
  }
  friend DualNumber exp(const DualNumber& x)
  {
    const Packet e = each(x.value, [](double v) { return std::exp(v); });
    return chain(x, e, e, e);
  }
  friend DualNumber log(const DualNumber& x)
  {
    const Packet inverse = 1.0 / x.value;
    return chain(x, tautline::log(x.value), inverse, -inverse * inverse);
  }
  friend DualNumber sin(const DualNumber& x)
  {
    const Packet s = each(x.value, [](double v) { return std::sin(v); });
    return chain(x, s, each(x.value, [](double v) { return std::cos(v); }), -s);
  }
  friend DualNumber cos(const DualNumber& x)
  {
    const Packet c = each(x.value, [](double v) { return std::cos(v); });
    return chain(x, c, each(x.value, [](double v) { return -std::sin(v); }), -c);
  }
  friend DualNumber acos(const DualNumber& x)
  {
    const Packet inverse = 1.0 / (1.0 - x.value * x.value), root = tautline::sqrt(inverse);
    return chain(
      x, each(x.value, [](double v) { return std::acos(v); }), -root, -x.value * root * inverse);
  }
  friend DualNumber atan2(const DualNumber& y, const DualNumber& x)
  {
    DualNumber result;
    for (int l = 0; l < PacketWidth; ++l)
    {
      result.value[l] = std::atan2(y.value[l], x.value[l]);
    }
    const Packet perNorm2 = 1.0 / (x.value * x.value + y.value * y.value);
    const Packet c = x.value * perNorm2, s = y.value * perNorm2;
    const Packet square = 2.0 * c * s, difference = s * s - c * c;
    for (int i = 0; i < 2; ++i)
    {
      result.slope[i] = c * y.slope[i] - s * x.slope[i];
      for (int j = 0; j <= i; ++j)
      {
        result.curvature[i + j] = c * y.curvature[i + j] - s * x.curvature[i + j] +
          square * (x.slope[i] * x.slope[j] - y.slope[i] * y.slope[j]) +
          difference * (x.slope[i] * y.slope[j] + y.slope[i] * x.slope[j]);
      }
    }
    return result;
  }
  friend DualNumber pow(const DualNumber& x, double exponent)
  {
    const dual_number::Power power(x.value, exponent);
    return chain(x, power.lowered(0), power.lowered(1), power.lowered(2));
  }

private:
  /// Applies a function to each number.
  template <class Function>
  static DualNumber combine(const DualNumber& a, const DualNumber& b, const Function& function)
  {
    DualNumber result;
    result.value = function(a.value, b.value);
    for (int i = 0; i < 2; ++i)
    {
      result.slope[i] = function(a.slope[i], b.slope[i]);
    }
    for (int i = 0; i < 3; ++i)
    {
      result.curvature[i] = function(a.curvature[i], b.curvature[i]);
    }
    return result;
  }
};
}
#endif
