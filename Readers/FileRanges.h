// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileRanges.h
 * @brief The records of a file, divided among the ranks: each reads and parses its own bytes only.
 *
 * Lines go to the rank in whose share of the bytes they begin. Ranks count the lines with a record
 * and add them up, so that each knows the number of its first record. What is not laid out that way
 * (several records in a line, a record in several lines, keywords inside of a line), and every
 * problem of a file, makes all ranks throw UnusualFile: the file is then read whole by each rank,
 * which gives the mesh or the message with its line. Lack of memory on a rank makes all ranks throw
 * Error. An interruption ends its own rank as it does elsewhere, and is an Error on the others.
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

/// How much is done at once.
struct RangeLimits
{
  Index smallSet = Index(1) << 20;   ///< bytes of a set of files: one below is read in milliseconds
  Index readAtOnce = Index(1) << 20; ///< bytes, where lines are only searched
  Index sendAtOnce = Index(1) << 22; ///< bytes that a rank sends in a round, to all ranks together
  Index starts = 500;                ///< lines with keywords, each of which every rank reads
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
 * otherwise, and throw on all ranks: UnusualFile, or Error for lack of memory and interruption.
 */
class TAUTLINEREADERS_EXPORT FileRanges
{
public:
  explicit FileRanges(RankGroup& group, const RangeLimits& limits = {});

  RankGroup& group() const { return this->Group; }
  const RangeLimits& limits() const { return this->Limits; }

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

  /// Throws UnusualFile unless all ranks have found the same.
  void expectSame(std::string_view found) const;
  /// Throws unless the files are there, with the same sizes and times of modification on all ranks,
  /// and not small together.
  void expectLarge(const std::vector<std::string>& names) const;
  /// Whether the file is there; the ranks must agree.
  bool exists(const std::string& name) const;

  /// The first lines, of 64 KiB at most: headers, and the comments that readColumnNames() searches.
  /// The same on all ranks, as is what follows from it.
  FileContent head(const std::string& name) const;
  /// The last bytes, for SetCheck; the same on all ranks.
  FileContent tail(const std::string& name) const;

  /**
   * @brief This rank's share of the lines between two bytes of a file.
   * @param comment starts a comment, 0: none
   */
  LineShare lines(const std::string& name, Index begin, Index end, char comment) const;
  /// The same, where all ranks together must have so many records.
  LineShare lines(
    const std::string& name, Index begin, Index end, char comment, Index records) const;

  /// Where the first word of a line begins, for all lines of the file that `accept` takes, which
  /// gets them from this word on: on all ranks, in the order of the file. Throws if there are more
  /// than limits().starts.
  std::vector<Index> lineStarts(
    const std::string& name, bool (*accept)(std::string_view line)) const;

private:
  std::pair<Index, Index> shareOf(const std::string& name, Index begin, Index end) const;
  Index lineBegin(const std::string& name, Index place, Index begin, Index end) const;

  RankGroup& Group;
  RangeLimits Limits;
};

/// Bytes of a file. Not collective; throws FileError.
Index fileSize(const std::string& name);
/// Most bytes of the begin of a file or section that are read for its header.
constexpr Index HeadBytes = 65536; // as readColumnNames() searches
/// Whole lines from `begin` on, of `most` bytes at most and up to `end`. Not collective; throws
/// FileError.
FileContent firstLines(const std::string& name, Index begin, Index end, Index most = HeadBytes);
/// The bytes as a string.
inline std::string_view viewOf(const FileContent& text)
{
  return { text.begin(), static_cast<std::size_t>(text.end() - text.begin()) };
}
/// Throws FileError unless the bytes of some lines suffice for their records of so many columns
/// each: before memory for these is taken. Not collective.
void expectColumns(const std::string& name, const LineShare& lines, Index columns);
}
#endif
