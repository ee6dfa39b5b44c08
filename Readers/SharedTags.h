// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SharedTags.h
 * @brief Numbers of nodes or elements, which the ranks have, to positions.
 */
#ifndef tautline_SharedTags_h
#define tautline_SharedTags_h

#include "FileRanges.h"

namespace tautline
{
/**
 * @class tautline::SharedTags
 * @brief Finds the positions of numbers that the ranks have. Those that are not consecutive are
 * divided among the ranks by a hash, so that gaps leave no rank with more than its share; each rank
 * answers for its numbers. Methods are collective unless stated otherwise, and throw as those of
 * FileRanges.
 */
class TAUTLINEREADERS_EXPORT SharedTags
{
public:
  /// @param ranges is kept by reference
  /// @param tags of the own ones; ranks in their order have consecutive positions. Negative ones
  /// and those that are there twice throw UnusualFile.
  SharedTags(const FileRanges& ranges, const std::vector<Index>& tags);

  /// Where the positions of each rank begin, and the end. Not collective.
  const std::vector<Index>& begins() const { return this->Begins; }

  /// How many numbers this rank answers for; 0 where they are consecutive. Not collective.
  std::size_t answers() const { return this->Own.size(); }

  /// Replaces numbers by positions; throws UnusualFile unless all are known.
  void find(std::vector<Index>& tags) const;

private:
  /// A number and its position.
  struct TagPlace
  {
    Index tag, place;
    bool operator<(const TagPlace& other) const { return this->tag < other.tag; }
  };

  std::size_t rankOfTag(Index tag) const;

  const FileRanges& Ranges;
  std::vector<Index> Begins;
  Index Low = 0, High = 0;
  bool Consecutive = false;
  std::vector<TagPlace> Own; ///< that this rank answers for, in order of the numbers
};
}
#endif
