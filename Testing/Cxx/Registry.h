// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Registry.h
 * @brief Registers the tests of the program TautlineTests and runs their parts one by one.
 *
 * A file TestName.cxx has one test, which calls its parts:
 *
 *     TAUTLINE_TEST(TestName)
 *     {
 *       const MeshData mesh = ...;         // set-up that the parts share
 *       TAUTLINE_RUN(testValues(mesh));
 *       TAUTLINE_RUN_SLOW(testLarge(mesh));
 *     }
 *
 * `TautlineTests TestName` runs all parts except the slow ones, `TautlineTests TestName/testValues`
 * the parts whose call contains that text. argv[1] is the directory Data, argv[2] a directory to
 * write to; what follows `--` on the command line begins at argv[3].
 */
#ifndef tautline_Registry_h
#define tautline_Registry_h

#include "Check.h"

#include <chrono>
#include <string>
#include <vector>

namespace tautline
{
using TestFunction = void (*)(int argc, char* argv[]);

struct RegisteredTest
{
  RegisteredTest(const char* name, TestFunction run)
    : name(name)
    , run(run)
  {
    all().push_back(*this);
  }
  static std::vector<RegisteredTest>& all()
  {
    static std::vector<RegisteredTest> tests;
    return tests;
  }

  const char* name;
  TestFunction run;
};

/** Which parts of a test run, and what became of them. */
struct PartChoice
{
  std::string text;   ///< that the call of a part contains
  bool slow = false;  ///< whether slow parts run, too
  bool list = false;  ///< print the parts instead of running them
  bool times = false; ///< print how long each part takes
  int run = 0, skipped = 0;
};

inline PartChoice& partChoice()
{
  static PartChoice choice;
  return choice;
}

/** Whether slow parts run, for those who choose a number of random cases by it. */
inline bool slowParts()
{
  return partChoice().slow;
}

enum class Pace
{
  Fast,
  Slow ///< runs with --slow only, or where it is named
};

/** A part of a test, from its construction to its end. */
class TestPart
{
public:
  TestPart(const char* call, Pace pace);
  ~TestPart();
  TestPart(const TestPart&) = delete;
  void operator=(const TestPart&) = delete;

  bool chosen() const { return this->Chosen; }
  /** Counts an exception as a failure. On several MPI ranks it is thrown again: the others would
      wait for this one for ever. */
  void failed(const std::exception& error) const;

private:
  std::string Name;
  bool Chosen;
  std::chrono::steady_clock::time_point Start;
};

/** Ends a test as skipped, with the reason: for data that are not part of the repository. */
[[noreturn]] void skipTest(const std::string& reason);

/** A folder of the data that are not part of the repository, in the directory that the environment
    variable TAUTLINE_TEST_DATA names; where it is absent, the test is skipped. */
std::string externalData(const std::string& folder);
}

#define TAUTLINE_TEST(name)                                                   \
  static void name([[maybe_unused]] int argc, [[maybe_unused]] char* argv[]); \
  static const tautline::RegisteredTest registered##name(#name, name);        \
  static void name([[maybe_unused]] int argc, [[maybe_unused]] char* argv[])

#define TAUTLINE_RUN_PART(pace, ...)                           \
  do                                                           \
  {                                                            \
    const tautline::TestPart tautlinePart(#__VA_ARGS__, pace); \
    if (tautlinePart.chosen())                                 \
    {                                                          \
      try                                                      \
      {                                                        \
        __VA_ARGS__;                                           \
      }                                                        \
      catch (const std::exception& tautlineError)              \
      {                                                        \
        tautlinePart.failed(tautlineError);                    \
      }                                                        \
    }                                                          \
  } while (false)
/** Runs a call as a part of the test. */
#define TAUTLINE_RUN(...) TAUTLINE_RUN_PART(tautline::Pace::Fast, __VA_ARGS__)
/** The same for a part that takes long: a large mesh, many random operations. */
#define TAUTLINE_RUN_SLOW(...) TAUTLINE_RUN_PART(tautline::Pace::Slow, __VA_ARGS__)

#endif
