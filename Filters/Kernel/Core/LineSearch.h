// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LineSearch.h
 * @brief Definitions shared by all line searches of the kernel.
 * Internal: not installed.
 */
#ifndef tautline_LineSearch_h
#define tautline_LineSearch_h

namespace tautline
{
/**
 * @brief The constant c of Armijo's condition f(x + t d) <= f(x) + c t (g . d): a step must reach
 * this fraction of the decrease that the slope predicts. The value follows J. Nocedal and S. J.
 * Wright, "Numerical Optimization", 2nd ed. 2006, section 3.1.
 */
constexpr double ArmijoConstant = 1e-4;
}
#endif
