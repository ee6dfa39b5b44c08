// SPDX-License-Identifier: BSD-3-Clause
#include "Registry.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <map>

namespace tautline
{
namespace
{
struct SkippedTest
{
  std::string reason;
};

/// Exit codes. 77 is SKIP_RETURN_CODE of ctest.
enum ExitCode
{
  Passed = EXIT_SUCCESS,
  Failed = EXIT_FAILURE,
  WrongArguments = 2,
  Skipped = 77
};

bool onSeveralRanks()
{
  const char* ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
  return ranks && std::atoi(ranks) > 1;
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string environment(const char* name, const char* otherwise)
{
  const char* value = std::getenv(name);
  return value ? value : otherwise;
}
}

//------------------------------------------------------------------------------
const char* wording(const char* id)
{
  static const std::map<std::string, std::string> texts =
    nlohmann::json::parse(std::ifstream(TAUTLINE_WORDING));
  const auto found = texts.find(id);
  if (found == texts.end())
  {
    throw std::logic_error(std::string("There is no text \"") + id + "\" in " + TAUTLINE_WORDING);
  }
  return found->second.c_str();
}

//------------------------------------------------------------------------------
RegisteredTest* findTest(const std::string& name)
{
  auto& tests = registeredTests();
  const auto found =
    std::find_if(tests.begin(), tests.end(), [&](const auto& test) { return name == test.name; });
  return found == tests.end() ? nullptr : &*found;
}

namespace
{
RegisteredTest& testCalled(const std::string& name)
{
  if (!findTest(name))
  {
    registeredTests().push_back({ name, nullptr, {} });
  }
  return *findTest(name);
}
}

Registration::Registration(const char* name, TestFunction run)
{
  testCalled(name).run = run;
}

Registration::Registration(const char* file, const RegisteredPart& part)
{
  testCalled(std::filesystem::path(file).stem().string()).parts.push_back(part);
}

//------------------------------------------------------------------------------
TestPart::TestPart(const char* call, Pace pace)
  : Name(call + Context::all())
{
  PartChoice& choice = partChoice();
  const bool named = this->Name.find(choice.text) != std::string::npos;
  const bool wanted = pace == Pace::Fast || choice.slow || !choice.text.empty();
  this->Chosen = named && wanted && !choice.list;
  if (choice.list && named)
  {
    std::cout << "  " << this->Name << (pace == Pace::Slow ? "  (slow)" : "") << "\n";
  }
  choice.run += this->Chosen;
  choice.skipped += named && !wanted;
  this->Start = std::chrono::steady_clock::now();
}

TestPart::~TestPart()
{
  if (this->Chosen && partChoice().times)
  {
    std::cout << std::fixed << std::setprecision(3) << secondsSince(this->Start) << " s  "
              << this->Name << std::defaultfloat << std::endl;
  }
}

void TestPart::failed(const std::exception& error) const
{
  fail(this->Name.c_str(), 0) << "exception: " << error.what() << "\n";
  if (onSeveralRanks())
  {
    throw;
  }
}

void skipTest(const std::string& reason)
{
  throw SkippedTest{ reason };
}

std::string externalData(const std::string& folder)
{
  const char* top = std::getenv("TAUTLINE_TEST_DATA");
  const std::string directory = std::string(top ? top : "") + "/" + folder;
  if (!top || !std::filesystem::is_directory(directory))
  {
    skipTest(top ? "There is no " + directory + "." : "TAUTLINE_TEST_DATA is not set.");
  }
  return directory;
}

namespace
{
void printUsage()
{
  std::cout << "usage: TautlineTests [--slow] [--list] [--times] [--count] TEST[/PART]... [-- "
               "ARGUMENT...]\n"
               "Runs tests; of TEST/PART the parts whose call contains the text PART.\n"
               "  --slow   also the slow parts; TAUTLINE_SLOW_TESTS=1 does the same\n"
               "  --list   print the tests, or the parts of the tests that are named\n"
               "  --times  print how long each part takes\n"
               "  --count  print how many checks each test makes\n";
}

int runTest(const RegisteredTest& test, std::vector<char*> arguments)
{
  arguments[0] = const_cast<char*>(test.name.c_str());
  PartChoice& choice = partChoice();
  choice.run = choice.skipped = 0;
  const int before = failures();
  const long checked = checks();
  // Parts without data are left out; the other parts run, and their failures count.
  bool leftOut = false;
  const auto unlessSkipped = [&](const auto& run)
  {
    try
    {
      run();
    }
    catch (const SkippedTest& skipped)
    {
      std::cout << test.name << ": skipped: " << skipped.reason << "\n";
      leftOut = true;
    }
  };
  try
  {
    if (test.run)
    {
      unlessSkipped([&] { test.run(static_cast<int>(arguments.size()) - 1, arguments.data()); });
    }
    for (const RegisteredPart& part : test.parts)
    {
      unlessSkipped([&] { TAUTLINE_RUN_CALL(part.call, part.pace, part.run()); });
    }
  }
  catch (const std::exception& error)
  {
    fail(test.name.c_str(), 0) << "exception: " << error.what() << "\n";
    if (onSeveralRanks())
    {
      throw;
    }
  }
  if (!choice.text.empty() && !choice.list && choice.run == 0)
  {
    std::cerr << test.name << ": no part contains \"" << choice.text << "\"; --list prints them\n";
    return WrongArguments;
  }
  if (choice.skipped > 0 && !choice.list)
  {
    std::cout << test.name << ": " << choice.skipped << " slow parts left out, --slow runs them\n";
  }
  if (choice.count)
  {
    std::cout << test.name << ": " << checks() - checked << " checks\n";
  }
  return failures() != before ? Failed : leftOut ? Skipped : Passed;
}
}
}

//------------------------------------------------------------------------------
int main(int argc, char* argv[])
{
  using namespace tautline;
  PartChoice& choice = partChoice();
  choice.slow = environment("TAUTLINE_SLOW_TESTS", "0") == "1";
  std::string data = environment("TAUTLINE_DATA_DIR", TAUTLINE_DATA_DIR),
              output = environment("TAUTLINE_TEST_DIR", TAUTLINE_TEST_DIR);
  std::vector<std::string> names;
  std::vector<char*> arguments{ argv[0], data.data(), output.data() };
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--")
    {
      arguments.insert(arguments.end(), argv + i + 1, argv + argc);
      break;
    }
    bool* const flag = word == "--slow" ? &choice.slow
      : word == "--list"                ? &choice.list
      : word == "--times"               ? &choice.times
      : word == "--count"               ? &choice.count
                                        : nullptr;
    if (flag)
    {
      *flag = true;
    }
    else if (word.rfind('-', 0) == 0)
    {
      printUsage();
      return word == "--help" || word == "-h" ? Passed : WrongArguments;
    }
    else
    {
      names.push_back(word);
    }
  }
  arguments.push_back(nullptr);
  if (names.empty())
  {
    if (!choice.list)
    {
      printUsage();
      return WrongArguments;
    }
    for (const RegisteredTest& test : registeredTests())
    {
      std::cout << test.name << "\n";
    }
    return Passed;
  }
  int result = Passed;
  for (const std::string& name : names)
  {
    const std::size_t slash = name.find('/');
    const RegisteredTest* const test = findTest(name.substr(0, slash));
    if (!test)
    {
      std::cerr << "There is no test " << name.substr(0, slash) << "; --list prints the names.\n";
      return WrongArguments;
    }
    choice.text = slash == std::string::npos ? "" : name.substr(slash + 1);
    const int code = runTest(*test, arguments);
    result = result == Passed || code == Failed ? code : result;
  }
  return result;
}
