// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ArrayIndex.h
 * @brief Converts numbers of points, cells and faces to indices of std::vector. Internal: not
 * installed.
 */
#ifndef tautline_ArrayIndex_h
#define tautline_ArrayIndex_h

#include "tautline/Core/Types.h"

#include <cstddef>

namespace tautline
{
inline std::size_t at(Index i)
{
  return static_cast<std::size_t>(i);
}
}
#endif
