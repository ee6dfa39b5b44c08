// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EigenCompatibility.h
 * @brief What differs between Eigen 3.4 and 5, in one place.
 * Internal: not installed.
 */
#ifndef tautline_EigenCompatibility_h
#define tautline_EigenCompatibility_h

#include <Eigen/Core>

#include <cstdlib>

namespace tautline
{
/**
 * @brief Makes the next solve of Eigen's BiCGSTAB take the same steps every time.
 *
 * Where Eigen 3.4 divides by nearly 0, Eigen 5 goes on from a random vector, of std::rand. There
 * is no other generator that it takes.
 */
inline void restartAlike()
{
#if EIGEN_VERSION_AT_LEAST(3, 4, 90)
  constexpr unsigned int seed = 1;
  std::srand(seed);
#endif
}
} // namespace tautline

#endif
