// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileRanges.h
 * @brief The records of a file, divided among the ranks: each reads and parses its own bytes only.
 *
 * Lines go to the rank in whose share of the bytes they begin. Ranks count the lines with a record
 * and add them up, so that each knows the number of its first record. What is not laid out that way
 * (several records in a line, a record in several lines, keywords inside of a line), and every
 * error, makes all ranks throw UnusualFile: the file is then read whole by each rank, which gives
 * the mesh or the message with its line.
 */
#ifndef tautline_FileRanges_h
#define tautline_FileRanges_h

#include "TextCursor.h"

#include "tautline/Core/RankGroup.h"

#include <functional>
#include <optional>

namespace tautline
{
/// Thrown on all ranks where ranges of a file cannot be read. Not an Error: the file may be fine.
struct UnusualFile
{
};

/// The lines of a section that a rank reads.
struct LineShare
{
  FileContent text;
  Index first = 0; ///< lines with a record before these, on lower ranks
  Index count = 0; ///< lines with a record
  Index total = 0; ///< of all ranks
};

/**
 * @class tautline::FileRanges
 * @brief Reads ranges of files on all ranks of a group. Methods are collective unless stated
 * otherwise, and throw UnusualFile on all ranks.
 */
class TAUTLINEREADERS_EXPORT FileRanges
{
public:
  /// Bytes of a set of files below which ranges do not pay: it is read in milliseconds.
  static constexpr Index SmallSet = Index(1) << 20;

  /// @param smallSet bytes below which expectLarge() throws
  explicit FileRanges(RankGroup& group, Index smallSet = SmallSet);

  RankGroup& group() const { return this->Group; }

  /**
   * @brief Does work that does not communicate. Where it throws on any rank, all ranks throw: what
   * an interruption throws on its own rank, Error on all where one is interrupted or has no memory,
   * UnusualFile for any other problem.
   */
  void together(const std::function<void()>& work) const;
  /// The same for work with a result.
  template <class Work>
  auto agreed(const Work& work) const
  {
    std::optional<decltype(work())> result;
    this->together([&] { result.emplace(work()); });
    return std::move(*result);
  }
  /// Throws UnusualFile unless the condition holds on all ranks.
  void require(bool condition) const;
  /// Ends all ranks where one is interrupted.
  void poll() const;

  /// Throws unless the files are there, of the same sizes on all ranks, and not small together.
  void expectLarge(const std::vector<std::string>& names) const;
  /// Whether the file is there; the ranks must agree.
  bool exists(const std::string& name) const;

  /// The first lines, of 64 KiB at most: headers, and the comments that readColumnNames() searches.
  FileContent head(const std::string& name) const;
  /// The last bytes, for SetCheck.
  FileContent tail(const std::string& name) const;

  /**
   * @brief This rank's share of the lines between two bytes of a file.
   * @param comment starts a comment, 0: none
   */
  LineShare lines(const std::string& name, Index begin, Index end, char comment) const;
  /// The same, where all ranks together must have so many records.
  LineShare lines(
    const std::string& name, Index begin, Index end, char comment, Index records) const;

  /// Where the first word of a line begins with a character that `accept` takes, for all lines of
  /// the file: on all ranks, in the order of the file. Throws if there are more than 100,000.
  std::vector<Index> lineStarts(const std::string& name, bool (*accept)(char)) const;

private:
  RankGroup& Group;
  Index Small;
};

/// Bytes of a file. Not collective; throws FileError.
Index fileSize(const std::string& name);
/// Whole lines from `begin` on, of 64 KiB at most and up to `end`. Not collective; throws
/// FileError.
FileContent firstLines(const std::string& name, Index begin, Index end);
}
#endif
