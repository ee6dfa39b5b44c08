// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkTautlineSetRange.h
 * @brief A setter of a number with a range; a value outside the range is rejected with a message.
 *
 *     vtkTautlineSetRangeMacro(Threads, int, 0, 1024);
 *
 * Unlike vtkSetClampMacro, which silently clamps a value outside the range, the property keeps its
 * value, and an error reports the property, the value, the range and the value that is kept. NaN is
 * outside every range; infinity counts as the largest number, which is inside if there is no limit
 * (VTK_DOUBLE_MAX). GetThreadsMinValue() and GetThreadsMaxValue() return the range.
 */
#ifndef vtkTautlineSetRange_h
#define vtkTautlineSetRange_h

#include <limits>
#include <sstream>
#include <string>
#include <type_traits>

namespace tautline
{
/// The number nearest to a value, which may be infinite.
template <class T>
T nearestNumber(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    constexpr T Largest = std::numeric_limits<T>::max();
    return value > Largest ? Largest : value < -Largest ? -Largest : value;
  }
  return value;
}

/// The message about a value outside its range; empty for a value inside.
template <class T>
std::string rangeError(const char* name, T value, T low, T high, T kept)
{
  if (value >= low && value <= high)
  {
    return {};
  }
  std::ostringstream text;
  text << name << " is " << value << "; from " << low << " to " << high << " is allowed; " << kept
       << " is kept";
  return text.str();
}
}

#define vtkTautlineSetRangeMacro(name, type, low, high)                                        \
  virtual void Set##name(type given)                                                           \
  {                                                                                            \
    const type value = tautline::nearestNumber<type>(given);                                   \
    const std::string error = tautline::rangeError<type>(#name, value, low, high, this->name); \
    if (!error.empty())                                                                        \
    {                                                                                          \
      vtkErrorMacro(<< error);                                                                 \
    }                                                                                          \
    else if (this->name != value)                                                              \
    {                                                                                          \
      this->name = value;                                                                      \
      this->Modified();                                                                        \
    }                                                                                          \
  }                                                                                            \
  virtual type Get##name##MinValue()                                                           \
  {                                                                                            \
    return low;                                                                                \
  }                                                                                            \
  virtual type Get##name##MaxValue()                                                           \
  {                                                                                            \
    return high;                                                                               \
  }

#endif
