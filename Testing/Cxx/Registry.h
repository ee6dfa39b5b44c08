// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Registry.h
 * @brief Registers the tests of the program TautlineTests and runs their parts one by one.
 *
 * A file TestName.cxx is one test. It consists of its parts:
 *
 *     TAUTLINE_PART(testValues)
 *     {
 *       ...
 *     }
 *     TAUTLINE_PART_SLOW(testLarge)
 *     ...
 *
 * Parts with arguments or a set-up that they share are called, before the others:
 *
 *     TAUTLINE_TEST(TestName)
 *     {
 *       const MeshData mesh = ...;
 *       TAUTLINE_RUN(testSums(mesh));
 *     }
 *
 * `TautlineTests TestName` runs all parts except the slow ones, `TautlineTests TestName/testValues`
 * the parts whose call contains that text. argv[1] is the directory Data, argv[2] a directory to
 * write to; what follows `--` on the command line begins at argv[3].
 */
#ifndef tautline_Registry_h
#define tautline_Registry_h

#include "Check.h"
#include "Loops.h"
#include "Set.h"

#include <chrono>

namespace tautline
{
using TestFunction = void (*)(int argc, char* argv[]);

enum class Pace
{
  Fast,
  Slow ///< runs with --slow only, or where it is named
};

/** A part of a test that is called without arguments. */
struct RegisteredPart
{
  const char* call;
  void (*run)();
  Pace pace;
};

struct RegisteredTest
{
  std::string name;
  TestFunction run = nullptr; ///< optional, before the parts
  std::vector<RegisteredPart> parts;
};

/** In the order of their first registration. */
inline std::vector<RegisteredTest>& registeredTests()
{
  static std::vector<RegisteredTest> tests;
  return tests;
}

/** Null if there is none. */
RegisteredTest* findTest(const std::string& name);

/** Registers the function of a test, or a part of the test of a file, when it is constructed. */
struct Registration
{
  Registration(const char* name, TestFunction run);
  Registration(const char* file, const RegisteredPart& part);
};

/** Which parts of a test run, and what became of them. */
struct PartChoice
{
  std::string text;   ///< that the call of a part contains
  bool slow = false;  ///< whether slow parts also run
  bool list = false;  ///< print the parts instead of running them
  bool times = false; ///< print how long each part takes
  bool count = false; ///< print how many checks each test makes
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

/** Ends a part of a test, with the reason: for data that are not part of the repository. The test
    counts as skipped if none of its other parts fails. */
[[noreturn]] void skipTest(const std::string& reason);

/** A folder of the data that are not part of the repository, in the directory that the environment
    variable TAUTLINE_TEST_DATA names; where it is absent, skipTest() is called. */
std::string externalData(const std::string& folder);
}

#define TAUTLINE_TEST(name)                                                   \
  static void name([[maybe_unused]] int argc, [[maybe_unused]] char* argv[]); \
  static const tautline::Registration registered##name(#name, name);          \
  static void name([[maybe_unused]] int argc, [[maybe_unused]] char* argv[])

#define TAUTLINE_PACED_PART(name, pace)                                                         \
  static void name();                                                                           \
  static const tautline::Registration registered##name(__FILE__, { #name "()", name, (pace) }); \
  static void name()
/** A part of the test of this file. */
#define TAUTLINE_PART(name) TAUTLINE_PACED_PART(name, tautline::Pace::Fast)
/** The same for a part that takes long: a large mesh, many random operations. */
#define TAUTLINE_PART_SLOW(name) TAUTLINE_PACED_PART(name, tautline::Pace::Slow)

#define TAUTLINE_RUN_CALL(call, pace, ...)             \
  do                                                   \
  {                                                    \
    const tautline::TestPart tautlinePart(call, pace); \
    if (tautlinePart.chosen())                         \
    {                                                  \
      try                                              \
      {                                                \
        __VA_ARGS__;                                   \
      }                                                \
      catch (const std::exception& tautlineError)      \
      {                                                \
        tautlinePart.failed(tautlineError);            \
      }                                                \
    }                                                  \
  } while (false)
#define TAUTLINE_RUN_PART(pace, ...) TAUTLINE_RUN_CALL(#__VA_ARGS__, pace, __VA_ARGS__)
/** Runs a call as a part of the test. */
#define TAUTLINE_RUN(...) TAUTLINE_RUN_PART(tautline::Pace::Fast, __VA_ARGS__)
#define TAUTLINE_RUN_SLOW(...) TAUTLINE_RUN_PART(tautline::Pace::Slow, __VA_ARGS__)

#endif
