// SPDX-License-Identifier: BSD-3-Clause
#include "FileRanges.h"

#include "FileNames.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <array>
#include <exception>
#include <new>

#include <sys/stat.h>

namespace tautline
{
namespace
{
constexpr Index LongestLine = Index(1) << 20; // bytes
constexpr Index TailBytes = 4096;             // the last line, and blanks after it
constexpr char ByteOrderMark = '\xef';        // its first byte

/// What became of a rank's work, from the least to the worst.
enum Outcome : Index
{
  Done,
  Unusual,
  OutOfMemory,
  Stopped
};

[[noreturn]] void unusual(const std::string& name, const char* problem)
{
  throw FileError(name + ": " + problem);
}

/// The size and the time of modification.
std::array<Index, 3> stateOf(const std::string& name)
{
  struct stat status;
  if (stat(name.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
  {
    unusual(name, "is not a regular file");
  }
  return { static_cast<Index>(status.st_size), static_cast<Index>(status.st_mtim.tv_sec),
    static_cast<Index>(status.st_mtim.tv_nsec) };
}

/// FNV-1a of 64 bits.
std::uint64_t hashOf(std::string_view text)
{
  constexpr std::uint64_t begin = 0xcbf29ce484222325u, prime = 0x100000001b3u;
  std::uint64_t hash = begin;
  for (const char c : text)
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  }
  return hash;
}

Index countRecords(const FileContent& text, char comment)
{
  TextCursor cursor(text, comment);
  Index count = 0;
  for (; cursor.skipToToken(); ++count)
  {
    cursor.skipRestOfLine();
    cursor.countRecord();
  }
  return count;
}
}

//------------------------------------------------------------------------------
FileRanges::FileRanges(RankGroup& group, const RangeLimits& limits)
  : Group(group)
  , Limits(limits)
{
}

//------------------------------------------------------------------------------
void FileRanges::together(const std::function<void()>& work) const
{
  Index outcome = Done;
  std::exception_ptr thrown;
  try
  {
    work();
  }
  catch (const std::bad_alloc&)
  {
    outcome = OutOfMemory;
  }
  catch (const UnusualFile&)
  {
    outcome = Unusual;
  }
  catch (const std::exception&)
  {
    outcome = Unusual;
  }
  catch (...) // an interruption
  {
    outcome = Stopped;
    thrown = std::current_exception();
  }
  const Index worst = this->Group.maximum(outcome);
  if (thrown)
  {
    std::rethrow_exception(thrown);
  }
  if (worst == Stopped)
  {
    throw Error("Another rank was interrupted while it read its part of the file.");
  }
  if (worst == OutOfMemory)
  {
    throw Error("A rank has too little memory for its part of the file: take more ranks.");
  }
  if (worst == Unusual)
  {
    throw UnusualFile();
  }
}

//------------------------------------------------------------------------------
void FileRanges::require(bool condition) const
{
  if (this->Group.any(!condition))
  {
    throw UnusualFile();
  }
}

//------------------------------------------------------------------------------
void FileRanges::poll() const
{
  this->together(throwIfInterrupted);
}

//------------------------------------------------------------------------------
void FileRanges::expectSame(std::string_view found) const
{
  const std::vector<std::vector<std::uint64_t>> all =
    this->Group.gatherItems(std::vector<std::uint64_t>{ hashOf(found) });
  this->require(
    std::all_of(all.begin(), all.end(), [&](const auto& other) { return other == all[0]; }));
}

//------------------------------------------------------------------------------
void FileRanges::expectLarge(const std::vector<std::string>& names) const
{
  Index total = 0;
  const std::string found = this->agreed(
    [&]
    {
      std::string states;
      for (const std::string& name : names)
      {
        const std::array<Index, 3> state = stateOf(name);
        total += state[0];
        for (const Index number : state)
        {
          states += std::to_string(number) + " ";
        }
      }
      return states;
    });
  this->expectSame(found);
  this->require(total >= this->Limits.smallSet);
}

//------------------------------------------------------------------------------
bool FileRanges::exists(const std::string& name) const
{
  const bool here = fileExists(name), anywhere = this->Group.any(here);
  this->require(here == anywhere);
  return here;
}

//------------------------------------------------------------------------------
FileContent FileRanges::head(const std::string& name) const
{
  FileContent lines = this->agreed([&] { return firstLines(name, 0, fileSize(name)); });
  this->expectSame(viewOf(lines));
  return lines;
}

//------------------------------------------------------------------------------
FileContent FileRanges::tail(const std::string& name) const
{
  FileContent end = this->agreed(
    [&]
    {
      const Index size = fileSize(name);
      FileContent bytes(name, std::max<Index>(0, size - TailBytes), size);
      if (viewOf(bytes).find_first_not_of(" \t\r\n") == std::string_view::npos)
      {
        unusual(name, "the last line is far from the end");
      }
      return bytes;
    });
  this->expectSame(viewOf(end));
  return end;
}

//------------------------------------------------------------------------------
/// Where the first line at or after a place begins; `end` if none does before it.
Index FileRanges::lineBegin(const std::string& name, Index place, Index begin, Index end) const
{
  if (place <= begin || place >= end)
  {
    return std::clamp(place, begin, end);
  }
  for (Index from = place - 1, stop = from; from < end; from = stop)
  {
    stop = std::min(end, from + this->Limits.readAtOnce);
    const FileContent bytes(name, from, stop);
    const char* newline = std::find(bytes.begin(), bytes.end(), '\n');
    if (newline != bytes.end())
    {
      return from + (newline - bytes.begin()) + 1;
    }
    if (stop - place >= LongestLine)
    {
      unusual(name, "a line is too long");
    }
  }
  return end;
}

//------------------------------------------------------------------------------
/// The bytes of the lines that begin in a rank's share of a range.
std::pair<Index, Index> FileRanges::shareOf(const std::string& name, Index begin, Index end) const
{
  const auto at = [&](int rank)
  {
    const Index length = end - begin, ranks = this->Group.size();
    // not length * rank / ranks, which may overflow
    const Index place = begin + length / ranks * rank + length % ranks * rank / ranks;
    return this->lineBegin(name, place, begin, end);
  };
  return { at(this->Group.rank()), at(this->Group.rank() + 1) };
}

//------------------------------------------------------------------------------
LineShare FileRanges::lines(const std::string& name, Index begin, Index end, char comment) const
{
  LineShare share = this->agreed(
    [&]
    {
      const auto [from, to] = this->shareOf(name, begin, end);
      LineShare result{ FileContent(name, from, to) };
      if (from < to && *result.text.begin() == ByteOrderMark)
      {
        unusual(name, "a byte order mark"); // which a cursor skips, but only a file may have
      }
      result.count = countRecords(result.text, comment);
      return result;
    });
  int rank = 0;
  for (const auto& counts : this->Group.gatherItems(std::vector<Index>{ share.count }))
  {
    share.first += rank++ < this->Group.rank() ? counts[0] : 0;
    share.total += counts[0];
  }
  return share;
}

//------------------------------------------------------------------------------
LineShare FileRanges::lines(
  const std::string& name, Index begin, Index end, char comment, Index records) const
{
  LineShare share = this->lines(name, begin, end, comment);
  this->require(share.total == records);
  return share;
}

//------------------------------------------------------------------------------
std::vector<Index> FileRanges::lineStarts(
  const std::string& name, bool (*accept)(std::string_view line)) const
{
  constexpr std::string_view blanks = " \t\r";
  const auto most = static_cast<std::size_t>(this->Limits.starts);
  const std::vector<Index> own = this->agreed(
    [&]
    {
      std::vector<Index> starts;
      const auto [from, to] = this->shareOf(name, 0, fileSize(name));
      for (Index begin = from, end = from; begin < to && starts.size() <= most; begin = end)
      {
        throwIfInterrupted();
        end = this->lineBegin(name, begin + this->Limits.readAtOnce, begin, to);
        const FileContent text(name, begin, end);
        for (const char* line = text.begin(); line < text.end() && starts.size() <= most;)
        {
          const void* newline =
            std::memchr(line, '\n', static_cast<std::size_t>(text.end() - line));
          const char* lineEnd = newline ? static_cast<const char*>(newline) : text.end();
          const std::string_view all(line, static_cast<std::size_t>(lineEnd - line));
          const std::size_t first = all.find_first_not_of(blanks);
          if (first != all.npos && accept(all.substr(first)))
          {
            starts.push_back(begin + (line - text.begin()) + static_cast<Index>(first));
          }
          line = newline ? lineEnd + 1 : text.end();
        }
      }
      return starts;
    });
  std::vector<Index> all;
  for (const std::vector<Index>& starts : this->Group.gatherItems(own))
  {
    all.insert(all.end(), starts.begin(), starts.end());
  }
  this->require(all.size() <= most);
  return all;
}

//------------------------------------------------------------------------------
Index fileSize(const std::string& name)
{
  return stateOf(name)[0];
}

//------------------------------------------------------------------------------
FileContent firstLines(const std::string& name, Index begin, Index end, Index most)
{
  FileContent bytes(name, begin, std::min(end, begin + most));
  if (end - begin <= most)
  {
    return bytes;
  }
  const std::string_view text = viewOf(bytes);
  return FileContent(name, text.substr(0, text.rfind('\n') + 1));
}

//------------------------------------------------------------------------------
void expectColumns(const std::string& name, const LineShare& lines, Index columns)
{
  const Index bytes = lines.text.end() - lines.text.begin() + 1; // the last line may have no end
  if (lines.count > bytes / (2 * std::max<Index>(columns, 1)))
  {
    unusual(name, "lines are too short for their columns");
  }
}
}
