// SPDX-License-Identifier: BSD-3-Clause
// The driver without libFuzzer: TautlineFuzzer TARGET CORPUS SECONDS SEED INPUT RUNS. The file
// INPUT has the bytes that failed; -1 RUNS are any number. TautlineFuzzer list prints the targets.

#include "Mutator.h"

#include "vtkObject.h"

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc == 2 && std::string(argv[1]) == "list")
  {
    for (const tautline::FuzzTarget& known : tautline::fuzzTargets())
    {
      std::cout << known.name << "\n";
    }
    return EXIT_SUCCESS;
  }
  const tautline::FuzzTarget* target = argc == 7 ? tautline::findFuzzTarget(argv[1]) : nullptr;
  if (!target)
  {
    std::cerr << "usage: " << argv[0] << " TARGET CORPUS SECONDS SEED INPUT RUNS\n";
    return EXIT_FAILURE;
  }
  vtkObject::GlobalWarningDisplayOff();
  try
  {
    const long runs = tautline::runTarget(*target, tautline::readCorpus(argv[2]),
      std::atof(argv[3]), static_cast<unsigned>(std::atoi(argv[4])), argv[5], std::atol(argv[6]));
    std::cout << runs << " runs\n";
  }
  catch (const std::exception& error)
  {
    std::cerr << argv[1] << ": " << error.what() << "; the input is in " << argv[5] << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
