// SPDX-License-Identifier: BSD-3-Clause
// The targets of the fuzzers on their corpus, which holds every input that once failed, and on
// seeded mutations of it for TAUTLINE_FUZZ_SECONDS (0.3 by default) each.

#include "Mutator.h"
#include "Registry.h"
#include "vtkObject.h"

#include <filesystem>

using namespace tautline;

TAUTLINE_TEST(TestFuzzTargets)
{
  const std::string folder = std::string(argv[2]) + "/fuzz-targets";
  std::filesystem::create_directories(folder);
  setenv("TAUTLINE_FUZZ_DIR", folder.c_str(), 1);
  vtkObject::GlobalWarningDisplayOff();
  const char* given = std::getenv("TAUTLINE_FUZZ_SECONDS");
  const double seconds = given ? std::atof(given) : 0.3;
  constexpr unsigned Seed = 20261121;
  for (const FuzzTarget& target : fuzzTargets())
  {
    const Context context(target.name);
    const auto corpus = readCorpus(std::string(argv[1]) + "/../Testing/Fuzz/Corpus/" + target.name);
    TAUTLINE_CHECK(corpus.size() >= 3);
    try
    {
      const long runs = runTarget(target, corpus, seconds, Seed, folder + "/input");
      TAUTLINE_CHECK(runs > static_cast<long>(corpus.size()));
    }
    catch (const std::exception& error)
    {
      std::cerr << error.what() << "; the input is " << folder << "/input\n";
      TAUTLINE_CHECK(!"the target holds");
      break;
    }
  }
}
