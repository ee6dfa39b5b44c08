// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Packet.h
 * @brief A packet of doubles, one per element of a batch, with the functions that metrics need.
 *
 * The width depends on the machine for which the kernel is compiled: 8 (AVX-512), 4 (AVX) or 2.
 * Arithmetic and comparisons use the vector extensions of the compiler. Packets are not passed to
 * or from the library: a user-defined metric (UserMetric.h) may be compiled for another width.
 */
#ifndef tautline_Packet_h
#define tautline_Packet_h

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace tautline
{
#if defined(__AVX512F__)
constexpr int PacketWidth = 8;
#elif defined(__AVX__)
constexpr int PacketWidth = 4;
#else
constexpr int PacketWidth = 2;
#endif

using Packet = double __attribute__((vector_size(PacketWidth * sizeof(double))));
/// All bits set where a comparison holds.
using Mask = std::int64_t __attribute__((vector_size(PacketWidth * sizeof(double))));

inline Packet broadcast(double x)
{
  return x - Packet{};
}

inline Packet select(Mask mask, Packet yes, Packet no)
{
  return mask ? yes : no;
}

inline Packet abs(Packet x)
{
  return reinterpret_cast<Packet>(reinterpret_cast<Mask>(x) & INT64_MAX);
}

/**
 * @brief A number that decreases from 1 to -1 as the angle with this sine (at least 0) and cosine
 * increases from 0 to pi; much cheaper than the angle. If both are 0, it is 1, as for the angle 0.
 * @tparam Number double or Packet
 */
template <class Number>
Number rankOfAngle(Number sine, Number cosine)
{
  const Number size = sine + (cosine < 0.0 ? -cosine : cosine);
  return size > 0.0 ? cosine / size : Number{} + 1.0;
}

/// -1, 0 or 1.
inline Packet signOf(Packet x)
{
  return select(x > 0.0, broadcast(1.0), select(x < 0.0, broadcast(-1.0), Packet{}));
}

inline Packet max(Packet a, Packet b)
{
  return select(a > b, a, b);
}

inline Packet min(Packet a, Packet b)
{
  return select(a < b, a, b);
}

inline Packet sqrt(Packet x)
{
#if defined(__AVX512F__)
  // The masked form: the plain form reads an undefined register, which causes compiler warnings.
  return (Packet)_mm512_mask_sqrt_pd((__m512d)x, 0xff, (__m512d)x);
#elif defined(__AVX__)
  return (Packet)_mm256_sqrt_pd((__m256d)x);
#else
  return Packet{ std::sqrt(x[0]), std::sqrt(x[1]) };
#endif
}

/// Calls a scalar function for each element; for functions without vector instructions.
template <class Function>
Packet each(Packet x, const Function& function)
{
  for (int l = 0; l < PacketWidth; ++l)
  {
    x[l] = function(x[l]);
  }
  return x;
}

inline Packet log(Packet x)
{
  return each(x, [](double v) { return std::log(v); });
}

inline Packet pow(Packet x, double exponent)
{
  return each(x, [=](double v) { return std::pow(v, exponent); });
}

/// A 32-bit integer per lane.
using HalfIntegers = std::int32_t __attribute__((vector_size(PacketWidth * sizeof(std::int32_t))));

/// The upper halves of the bits.
inline HalfIntegers upperHalves(Packet x)
{
  using Halves = std::int32_t __attribute__((vector_size(2 * PacketWidth * sizeof(std::int32_t))));
  const Halves all = reinterpret_cast<Halves>(x);
#if defined(__AVX512F__)
  return __builtin_shufflevector(all, all, 1, 3, 5, 7, 9, 11, 13, 15);
#elif defined(__AVX__)
  return __builtin_shufflevector(all, all, 1, 3, 5, 7);
#else
  return __builtin_shufflevector(all, all, 1, 3);
#endif
}

/// x^(-1/3) for normal x > 0, to rounding. Otherwise meaningless: finite for 0 and positive
/// subnormal x, NaN or infinite for negative and infinite x.
inline Packet inverseCbrt(Packet x)
{
  // A guess within 3.5 % from the exponent bits, then two steps of order four: y (1 + r/3 + 2 r^2/9
  // + 14 r^3/81) with r = 1 - x y^3. The guess needs only the upper halves of the bits, which most
  // machines convert in one instruction.
  constexpr double third = 1.0 / 3.0;
  constexpr double guess = 1430188458.0; // 4/3 of the upper bits of 1.0, minus the mean error
  constexpr int half = 32;
  const Packet scaled = guess - third * __builtin_convertvector(upperHalves(x), Packet);
  const Mask bits = __builtin_convertvector(__builtin_convertvector(scaled, HalfIntegers), Mask);
  Packet y = reinterpret_cast<Packet>(bits << half);
  for (int step = 0; step < 2; ++step)
  {
    const Packet r = 1.0 - (x * y) * (y * y); // short chains
    const Packet r2 = r * r;
    y += (y * r) * ((third + (2.0 / 9.0) * r) + (14.0 / 81.0) * r2);
  }
  return y;
}

/// The halves of packets of pairs: (a0 b0 a2 b2 ...) and (a1 b1 a3 b3 ...).
inline Packet evenPairs(Packet a, Packet b)
{
#if defined(__AVX512F__)
  return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
#elif defined(__AVX__)
  return __builtin_shufflevector(a, b, 0, 4, 2, 6);
#else
  return __builtin_shufflevector(a, b, 0, 2);
#endif
}

inline Packet oddPairs(Packet a, Packet b)
{
#if defined(__AVX512F__)
  return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
#elif defined(__AVX__)
  return __builtin_shufflevector(a, b, 1, 5, 3, 7);
#else
  return __builtin_shufflevector(a, b, 1, 3);
#endif
}

/// Two doubles, adjacent in memory.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

inline Pair loadPair(const double* p)
{
  Pair pair;
  std::memcpy(&pair, p, sizeof(pair));
  return pair;
}

inline void storePair(double* p, Pair pair)
{
  std::memcpy(p, &pair, sizeof(pair));
}

/// The pairs at p[0], p[2], p[4], ..., each `offset` further on.
inline Packet loadPairs(const double* const* p, int offset)
{
#if defined(__AVX__)
  const auto two = [=](int i)
  {
    return __builtin_shufflevector(
      loadPair(p[i] + offset), loadPair(p[i + 2] + offset), 0, 1, 2, 3);
  };
#if defined(__AVX512F__)
  return __builtin_shufflevector(two(0), two(4), 0, 1, 2, 3, 4, 5, 6, 7);
#else
  return two(0);
#endif
#else
  return loadPair(p[0] + offset);
#endif
}

/// Loads x y z of a point per lane. Always inlined: a call would cost as much as the loads.
inline __attribute__((always_inline)) void loadPoints(const double* const* p, Packet* xyz)
{
  // As pairs x y and y z, so that nothing beyond a point is read.
  const Packet even = loadPairs(p, 0), odd = loadPairs(p + 1, 0);
  xyz[0] = evenPairs(even, odd);
  xyz[1] = oddPairs(even, odd);
  xyz[2] = oddPairs(loadPairs(p, 1), loadPairs(p + 1, 1));
}

/// A vector x y z per lane, laid out so that each can be added to memory or stored separately.
class VectorLanes
{
public:
  void set(const Packet* xyz)
  {
    this->XY[0] = evenPairs(xyz[0], xyz[1]);
    this->XY[1] = oddPairs(xyz[0], xyz[1]);
    this->Z = xyz[2];
  }
  void addTo(double* p, int lane) const
  {
    storePair(p, loadPair(p) + this->xy(lane));
    p[2] += this->z(lane);
  }
  void storeTo(double* p, int lane) const
  {
    storePair(p, this->xy(lane));
    p[2] = this->z(lane);
  }

private:
  Pair xy(int lane) const
  {
    return loadPair(reinterpret_cast<const double*>(this->XY + lane % 2) + (lane & ~1));
  }
  double z(int lane) const { return reinterpret_cast<const double*>(&this->Z)[lane]; }

  Packet XY[2];
  Packet Z;
};

inline bool any(Mask mask)
{
  std::int64_t bits = 0;
  for (int l = 0; l < PacketWidth; ++l)
  {
    bits |= mask[l];
  }
  return bits != 0;
}

/// Packet vectors, used by the chain rules.
using PacketVec = Packet[3];

inline Packet dot(const Packet* a, const Packet* b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline void cross(const Packet* a, const Packet* b, Packet* result)
{
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
}

inline void subtract(const Packet* a, const Packet* b, Packet* result)
{
  for (int c = 0; c < 3; ++c)
  {
    result[c] = a[c] - b[c];
  }
}

/// Replaces nonfinite values by 0: the values and gradients of elements that overflow are 0.
inline Packet finiteOrZero(Packet x)
{
  return select(abs(x) <= 1.7976931348623157e308, x, Packet{});
}
}
#endif
