// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EigenCompatibility.h
 * @brief The differences between Eigen 3.4 and 5.
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
 * Where Eigen 3.4 divides by nearly 0, Eigen 5 restarts from a random vector made by std::rand, and
 * accepts no other generator.
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
