// SPDX-License-Identifier: BSD-3-Clause
#include "FileRanges.h"

#include "FileNames.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <exception>
#include <new>

#include <sys/stat.h>

namespace tautline
{
namespace
{
constexpr Index ReadAtOnce = Index(1) << 20; // bytes, of what is only searched
constexpr Index HeadBytes = 65536;           // as readColumnNames() searches
constexpr Index TailBytes = 4096;            // the last line, and blanks after it
constexpr std::size_t MostStarts = 100000;   // lines with keywords
constexpr char ByteOrderMark = '\xef';       // its first byte

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

/// Where the first line at or after a place begins; `end` if none does before it.
Index lineBegin(const std::string& name, Index place, Index begin, Index end)
{
  if (place <= begin || place >= end)
  {
    return std::clamp(place, begin, end);
  }
  const Index stop = std::min(end, place - 1 + ReadAtOnce);
  const FileContent bytes(name, place - 1, stop);
  const char* newline = std::find(bytes.begin(), bytes.end(), '\n');
  if (newline == bytes.end() && stop < end)
  {
    unusual(name, "a line is too long");
  }
  return newline == bytes.end() ? end : place + (newline - bytes.begin());
}

/// The bytes of the lines that begin in a rank's share of a range.
std::pair<Index, Index> shareOf(
  const RankGroup& group, const std::string& name, Index begin, Index end)
{
  const auto at = [&](int rank)
  {
    const Index length = end - begin, ranks = group.size();
    // not length * rank / ranks, which may overflow
    const Index place = begin + length / ranks * rank + length % ranks * rank / ranks;
    return lineBegin(name, place, begin, end);
  };
  return { at(group.rank()), at(group.rank() + 1) };
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
FileRanges::FileRanges(RankGroup& group, Index smallSet)
  : Group(group)
  , Small(smallSet)
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
void FileRanges::expectLarge(const std::vector<std::string>& names) const
{
  std::vector<Index> sizes;
  Index total = 0;
  for (const std::string& name : names)
  {
    const Index size = this->agreed([&] { return fileSize(name); });
    sizes.push_back(size);
    total += size;
  }
  const std::vector<std::vector<Index>> all = this->Group.gatherItems(sizes);
  this->require(total >= this->Small &&
    std::all_of(all.begin(), all.end(), [&](const auto& other) { return other == all[0]; }));
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
  return this->agreed([&] { return firstLines(name, 0, fileSize(name)); });
}

//------------------------------------------------------------------------------
FileContent FileRanges::tail(const std::string& name) const
{
  return this->agreed(
    [&]
    {
      const Index size = fileSize(name);
      FileContent bytes(name, std::max<Index>(0, size - TailBytes), size);
      if (std::string_view(bytes.begin(), static_cast<std::size_t>(bytes.end() - bytes.begin()))
            .find_first_not_of(" \t\r\n") == std::string_view::npos)
      {
        unusual(name, "the last line is far from the end");
      }
      return bytes;
    });
}

//------------------------------------------------------------------------------
LineShare FileRanges::lines(const std::string& name, Index begin, Index end, char comment) const
{
  LineShare share = this->agreed(
    [&]
    {
      const auto [from, to] = shareOf(this->Group, name, begin, end);
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
std::vector<Index> FileRanges::lineStarts(const std::string& name, bool (*accept)(char)) const
{
  const std::vector<Index> own = this->agreed(
    [&]
    {
      std::vector<Index> starts;
      const auto [from, to] = shareOf(this->Group, name, 0, fileSize(name));
      for (Index begin = from, end = from; begin < to; begin = end)
      {
        throwIfInterrupted();
        end = lineBegin(name, begin + ReadAtOnce, begin, to);
        const FileContent text(name, begin, end);
        for (const char* line = text.begin(); line < text.end();)
        {
          const char* word = line;
          while (word < text.end() && (*word == ' ' || *word == '\t' || *word == '\r'))
          {
            ++word;
          }
          if (word < text.end() && accept(*word))
          {
            starts.push_back(begin + (word - text.begin()));
          }
          const void* newline =
            std::memchr(word, '\n', static_cast<std::size_t>(text.end() - word));
          line = newline ? static_cast<const char*>(newline) + 1 : text.end();
        }
        if (starts.size() > MostStarts)
        {
          unusual(name, "too many keywords");
        }
      }
      return starts;
    });
  std::vector<Index> all;
  for (const std::vector<Index>& starts : this->Group.gatherItems(own))
  {
    all.insert(all.end(), starts.begin(), starts.end());
  }
  return all;
}

//------------------------------------------------------------------------------
Index fileSize(const std::string& name)
{
  struct stat status;
  if (stat(name.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
  {
    unusual(name, "is not a regular file");
  }
  return static_cast<Index>(status.st_size);
}

//------------------------------------------------------------------------------
FileContent firstLines(const std::string& name, Index begin, Index end)
{
  FileContent bytes(name, begin, std::min(end, begin + HeadBytes));
  if (end - begin <= HeadBytes)
  {
    return bytes;
  }
  std::string_view text(bytes.begin(), static_cast<std::size_t>(HeadBytes));
  return FileContent(name, text.substr(0, text.rfind('\n') + 1));
}
}
