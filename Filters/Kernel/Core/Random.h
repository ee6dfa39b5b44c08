// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Random.h
 * @brief Random numbers that are the same on all systems.
 *
 * SplitMix64 (Steele, Lea and Flood, 2014): the state is a counter, and the random number is its
 * hash. A generator is made from a seed, a stream and an item (for example a vertex), so that the
 * numbers of one item are independent of all others. Real numbers use the upper 53 bits, and
 * directions use rejection, with only + - * / and the square root: the distributions and
 * mathematical functions of the standard library differ between systems.
 * Internal: not installed.
 */
#ifndef tautline_Random_h
#define tautline_Random_h

#include "Types.h"

namespace tautline
{
class SplitMix
{
public:
  SplitMix(std::uint64_t seed, std::uint64_t stream, Index item)
    : State(hash(hash(hash(seed) ^ stream) ^ static_cast<std::uint64_t>(item)))
  {
  }

  std::uint64_t next()
  {
    this->State += Increment;
    return hash(this->State);
  }

  /// In [0, 1).
  double uniform() { return unit(this->next()); }

  /// In [-1, 1).
  double symmetric() { return 2.0 * this->uniform() - 1.0; }

  /// A unit vector, uniformly distributed on the unit circle spanned by two orthonormal vectors.
  Vec3 direction(const Vec3& e1, const Vec3& e2)
  {
    for (;;)
    {
      const double x = this->symmetric(), y = this->symmetric();
      const double r2 = x * x + y * y;
      if (r2 > 0.01 && r2 <= 1.0)
      {
        return (1.0 / std::sqrt(r2)) * (x * e1 + y * e2);
      }
    }
  }

  /// A unit vector, uniformly distributed on the sphere.
  Vec3 direction()
  {
    for (;;)
    {
      const Vec3 v = { this->symmetric(), this->symmetric(), this->symmetric() };
      const double r2 = dot(v, v);
      if (r2 > 0.01 && r2 <= 1.0)
      {
        return (1.0 / std::sqrt(r2)) * v;
      }
    }
  }

  /// The increment of the counter, and the hash that turns it into a random number.
  static constexpr std::uint64_t Increment = 0x9e3779b97f4a7c15u;
  static std::uint64_t hash(std::uint64_t z)
  {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// A hash that is not 0 for 0.
  static std::uint64_t mixed(std::uint64_t z) { return hash(z + Increment); }
  /// A hash as a number in [0, 1).
  static double unit(std::uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1p-53; }

private:
  std::uint64_t State;
};
}
#endif
