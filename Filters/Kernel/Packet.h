/**
 * @file Packet.h
 * @brief A packet of doubles, one per element of a batch, with the functions metrics need.
 *
 * The width is that of the machine the kernel is compiled for: 8 (AVX-512), 4 (AVX) or 2. Arithmetic
 * and comparisons are the compiler's vector extensions. Internal to the kernel: not installed.
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
  // The masked form: the plain one reads an undefined register, which compilers warn of.
  return (Packet)_mm512_mask_sqrt_pd((__m512d)x, 0xff, (__m512d)x);
#elif defined(__AVX__)
  return (Packet)_mm256_sqrt_pd((__m256d)x);
#else
  return Packet{ std::sqrt(x[0]), std::sqrt(x[1]) };
#endif
}

/// Calls a scalar function for each element; for the functions no vector unit has.
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

/// x^(-1/3) for normal x > 0, to rounding; finite nonsense elsewhere.
inline Packet inverseCbrt(Packet x)
{
  // A guess within 3.5 % from the exponent bits, then three steps of order three:
  // y (1 + r/3 + 2 r^2/9) with r = 1 - x y^3.
  constexpr double third = 1.0 / 3.0;
  constexpr double guess = 6.14261265415795e18; // 4/3 of the bits of 1.0, less the mean error
  const Mask bits = reinterpret_cast<Mask>(x);
  const Packet scaled = guess - third * __builtin_convertvector(bits, Packet);
  Packet y = reinterpret_cast<Packet>(__builtin_convertvector(scaled, Mask));
  for (int step = 0; step < 3; ++step)
  {
    const Packet r = 1.0 - x * y * y * y;
    y += y * r * (third + (2.0 / 9.0) * r);
  }
  return y;
}

inline bool any(Mask mask)
{
  std::int64_t bits = 0;
  for (int l = 0; l < PacketWidth; ++l)
  {
    bits |= mask[l];
  }
  return bits != 0;
}
}
#endif
