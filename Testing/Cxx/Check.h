/**
 * @file Check.h
 * @brief Counts and prints failed checks, so that one run of a test shows all of them.
 */

#ifndef tautline_Check_h
#define tautline_Check_h

#include <cstdlib>
#include <iostream>

namespace tautline
{

/** The number of failed checks of this program; a test returns exitCode(). */
inline int& failures()
{
  static int count = 0;
  return count;
}

inline int exitCode()
{
  return failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

inline void check(bool holds, const char* expression, const char* file, int line)
{
  if (!holds)
  {
    ++failures();
    std::cerr << file << ":" << line << ": not true: " << expression << "\n";
  }
}

} // namespace tautline

#define TAUTLINE_CHECK(expression) tautline::check((expression), #expression, __FILE__, __LINE__)

#endif
