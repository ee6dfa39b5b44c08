// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PacketFloat.h
 * @brief A packet of floats with the functions that shape matching needs; twice as wide as a packet
 * of doubles.
 *
 * Internal: not installed.
 */
#ifndef tautline_PacketFloat_h
#define tautline_PacketFloat_h

#include "Packet.h"

namespace tautline
{
constexpr int FloatWidth = 2 * PacketWidth;
using FloatPacket = float __attribute__((vector_size(FloatWidth * sizeof(float))));
using FloatMask = std::int32_t __attribute__((vector_size(FloatWidth * sizeof(float))));

inline FloatPacket broadcast(float x)
{
  return x - FloatPacket{};
}

inline FloatPacket loadFloats(const float* p)
{
  FloatPacket x;
  std::memcpy(&x, p, sizeof(x));
  return x;
}

inline void storeFloats(float* p, FloatPacket x)
{
  std::memcpy(p, &x, sizeof(x));
}

inline FloatPacket select(FloatMask mask, FloatPacket yes, FloatPacket no)
{
  return mask ? yes : no;
}

inline FloatPacket abs(FloatPacket x)
{
  return reinterpret_cast<FloatPacket>(reinterpret_cast<FloatMask>(x) & INT32_MAX);
}

inline FloatPacket max(FloatPacket a, FloatPacket b)
{
#if defined(__AVX512F__)
  return (FloatPacket)_mm512_mask_max_ps((__m512)a, 0xffff, (__m512)a, (__m512)b);
#elif defined(__AVX__)
  return (FloatPacket)_mm256_max_ps((__m256)a, (__m256)b);
#else
  return select(a > b, a, b);
#endif
}

inline FloatPacket min(FloatPacket a, FloatPacket b)
{
#if defined(__AVX512F__)
  return (FloatPacket)_mm512_mask_min_ps((__m512)a, 0xffff, (__m512)a, (__m512)b);
#elif defined(__AVX__)
  return (FloatPacket)_mm256_min_ps((__m256)a, (__m256)b);
#else
  return select(a < b, a, b);
#endif
}

inline FloatPacket sqrt(FloatPacket x)
{
#if defined(__AVX512F__)
  return (FloatPacket)_mm512_mask_sqrt_ps((__m512)x, 0xffff, (__m512)x);
#elif defined(__AVX__)
  return (FloatPacket)_mm256_sqrt_ps((__m256)x);
#else
  return FloatPacket{ std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]) };
#endif
}

/// The natural logarithm of normal x > 0, with an absolute error of about 2e-7 near 1 and rounding
/// error elsewhere.
inline FloatPacket log(FloatPacket x)
{
  // x = 2^e m with m in [sqrt(1/2), sqrt(2)); the polynomial for log(1 + f) is from Cephes.
  constexpr std::int32_t rootHalf = 0x3f3504f3;
  const FloatMask shifted = reinterpret_cast<FloatMask>(x) - rootHalf;
  const FloatMask exponent = shifted >> 23;
  const FloatMask mantissa = (shifted & 0x7fffff) + rootHalf;
  const FloatPacket f = reinterpret_cast<FloatPacket>(mantissa) - 1.0f;
  const FloatPacket f2 = f * f;
  // Estrin's scheme: short chains.
  const FloatPacket low =
    3.3333331174e-1f - 2.4999993993e-1f * f + f2 * (2.0000714765e-1f - 1.6668057665e-1f * f);
  const FloatPacket high = 1.4249322787e-1f - 1.2420140846e-1f * f +
    f2 * (1.1676998740e-1f - 1.1514610310e-1f * f + 7.0376836292e-2f * f2);
  const FloatPacket series = low + f2 * f2 * high;
  return 0.69314718056f * __builtin_convertvector(exponent, FloatPacket) +
    (f - 0.5f * f2 + f * f2 * series);
}

inline bool anyOf(FloatMask mask)
{
#if defined(__AVX512F__)
  return _mm512_test_epi32_mask((__m512i)mask, (__m512i)mask) != 0;
#elif defined(__AVX__)
  return _mm256_movemask_ps((__m256)mask) != 0;
#else
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
#endif
}

/// The smallest element.
inline float least(FloatPacket x)
{
#if defined(__AVX512F__)
  const __m256 eight = _mm256_min_ps((__m256)__builtin_shufflevector(x, x, 0, 1, 2, 3, 4, 5, 6, 7),
    (__m256)__builtin_shufflevector(x, x, 8, 9, 10, 11, 12, 13, 14, 15));
#elif defined(__AVX__)
  const __m256 eight = (__m256)x;
#endif
#if defined(__AVX__)
  __m128 four = _mm_min_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  four = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(four, _mm_shuffle_ps(four, four, 1)));
#else
  float value = x[0];
  for (int l = 1; l < FloatWidth; ++l)
  {
    value = x[l] < value ? x[l] : value;
  }
  return value;
#endif
}
}
#endif
