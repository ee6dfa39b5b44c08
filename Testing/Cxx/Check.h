// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Check.h
 * @brief Counts and prints failed checks, so that one run of a test shows all of them.
 */

#ifndef tautline_Check_h
#define tautline_Check_h

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iomanip>
#include <iostream>
#include <string>

namespace tautline
{

/**
 * The text that stands under an id in Testing/wording.json, the one place where tests have wording
 * of the product: an editor who changes a message changes it there. Throws for an unknown id.
 */
const char* wording(const char* id);

/** The number of failed checks of this program. */
inline int& failures()
{
  static int count = 0;
  return count;
}

inline bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

/** The number of checks of this program so far, including its threads. */
inline std::atomic<long>& checks()
{
  static std::atomic<long> count{ 0 };
  return count;
}

/** The subject of the checks in a scope; printed with each that fails. */
class Context
{
public:
  explicit Context(const std::string& text)
    : Length(all().size())
  {
    all() += "  [" + text + "]";
  }
  ~Context() { all().resize(this->Length); }
  Context(const Context&) = delete;
  void operator=(const Context&) = delete;
  static std::string& all()
  {
    static std::string text;
    return text;
  }

private:
  std::size_t Length;
};

/** Counts a failure and begins its line; further ones than the first hundred are only counted. */
inline std::ostream& fail(const char* file, int line)
{
  constexpr int printed = 100;
  static std::ostream silent(nullptr);
  std::ostream& out = ++failures() <= printed ? std::cerr : silent;
  return out << std::setprecision(17) << file << ":" << line << Context::all() << ": ";
}

inline bool check(bool holds, const char* expression, const char* file, int line)
{
  ++checks();
  if (!holds)
  {
    fail(file, line) << "not true: " << expression << "\n";
  }
  return holds;
}

template <class A, class B>
bool checkEqual(const A& actual, const B& expected, const char* what, const char* file, int line)
{
  ++checks();
  const bool holds = actual == expected;
  if (!holds)
  {
    fail(file, line) << what << " is " << actual << ", expected " << expected << "\n";
  }
  return holds;
}

inline bool checkNear(
  double actual, double expected, double tolerance, const char* what, const char* file, int line)
{
  ++checks();
  const bool holds = actual == expected || std::abs(actual - expected) <= tolerance;
  if (!holds)
  {
    fail(file, line) << what << " is " << actual << ", expected " << expected << ", difference "
                     << actual - expected << " > " << tolerance << "\n";
  }
  return holds;
}

template <class Statement>
void checkThrows(const Statement& statement, const std::string& part, const char* file, int line)
{
  ++checks();
  try
  {
    statement();
    fail(file, line) << "nothing thrown, expected an error with \"" << part << "\"\n";
  }
  catch (const std::exception& error)
  {
    if (!contains(error.what(), part))
    {
      fail(file, line) << "thrown \"" << error.what() << "\", expected \"" << part << "\"\n";
    }
  }
}

} // namespace tautline

#define TAUTLINE_CHECK(expression) tautline::check((expression), #expression, __FILE__, __LINE__)
#define TAUTLINE_CHECK_EQUAL(actual, expected) \
  tautline::checkEqual((actual), (expected), #actual, __FILE__, __LINE__)
/** Within an absolute tolerance; fails for a NaN. */
#define TAUTLINE_CHECK_NEAR(actual, expected, tolerance) \
  tautline::checkNear((actual), (expected), (tolerance), #actual, __FILE__, __LINE__)
/** Within a tolerance relative to the expected value. */
#define TAUTLINE_CHECK_RELATIVE(actual, expected, tolerance) \
  tautline::checkNear(                                       \
    (actual), (expected), (tolerance)*std::abs(expected), #actual, __FILE__, __LINE__)
/** The statement throws an exception whose message contains a text. */
#define TAUTLINE_CHECK_THROWS(statement, text) \
  tautline::checkThrows([&]() { statement; }, (text), __FILE__, __LINE__)
/** The same check for each element of a range, declared as in a for loop. */
#define TAUTLINE_EACH_OF(element, range, ...) \
  for (element : range)                       \
  {                                           \
    __VA_ARGS__;                              \
  }                                           \
  static_assert(true, "")
/** The same check for each index from 0 to a count. */
#define TAUTLINE_EACH(type, index, count, ...)   \
  for (type index = 0; index < (count); ++index) \
  {                                              \
    __VA_ARGS__;                                 \
  }                                              \
  static_assert(true, "")

#endif
