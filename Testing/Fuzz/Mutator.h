// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Mutator.h
 * @brief Runs a target on the files of a corpus and on seeded mutations of them.
 */
#ifndef tautline_Mutator_h
#define tautline_Mutator_h

#include "FuzzTargets.h"

#include <random>

namespace tautline
{
/// The contents of all files of a directory, in the order of their names.
std::vector<std::string> readCorpus(const std::string& folder);

/// One random change: bytes cut, inserted, repeated or replaced, digits, words of the formats.
void mutate(std::string& bytes, std::mt19937& random);

/**
 * @brief Runs every input of the corpus and then, for this many seconds or up to `most` runs,
 * mutations of 1 to 4 changes.
 *
 * Before a target runs, its input is written to `input`, so that it is there after a crash.
 * @return the number of runs. Passes on what the target throws.
 */
long runTarget(const FuzzTarget& target, const std::vector<std::string>& corpus, double seconds,
  unsigned seed, const std::string& input, long most = -1);
}
#endif
