// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TextCursor.h
 * @brief A file in memory and a position in it, with checked reads of numbers, words, lines and raw
 * bytes.
 *
 * Every read that fails throws FileError "file:line: problem"; lines are counted only then, without
 * a cost for valid files. Numbers are parsed with std::from_chars. Nothing is read past the end,
 * and a count in a file is not used before the file is known to have the required number of bytes.
 */
#ifndef tautline_TextCursor_h
#define tautline_TextCursor_h

#include "MeshFile.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

namespace tautline
{
using OpenFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
/// Opens a file for reading; null on failure. Never waits, whatever the kind of file.
OpenFile openFile(const std::string& name);

/// The bytes of a file, read as a whole.
class FileContent
{
public:
  /// Throws FileError if the file cannot be read; `why` is the purpose ("the companion of ...").
  explicit FileContent(const std::string& name, const std::string& why = std::string());
  /// The bytes of a string.
  FileContent(std::string name, std::string_view bytes);

  const std::string& name() const { return this->Name; }
  const char* begin() const { return this->Bytes.get(); }
  const char* end() const { return this->Bytes.get() + this->Size; }
  static constexpr std::size_t Padding =
    8; ///< zero bytes after the end, so that eight can be loaded

private:
  std::string Name;
  struct Release
  {
    void operator()(char* bytes) const { std::free(bytes); }
  };
  void allocate();

  std::unique_ptr<char[], Release> Bytes; ///< Size and Padding
  std::size_t Size = 0;
};

class TextCursor
{
public:
  /// Starts after a UTF-8 byte order mark. If `comment` is set, this character and the rest of its
  /// line count as blank.
  explicit TextCursor(const FileContent& file, char comment = '\0');

  /// Throws FileError with the current file and line.
  [[noreturn]] void fail(const std::string& problem) const;
  [[noreturn]] void failAt(const char* place, const std::string& problem) const;

  const char* place() const { return this->At; }
  void moveTo(const char* place) { this->At = place; }
  std::size_t bytesLeft() const { return static_cast<std::size_t>(this->End - this->At); }
  bool atEnd() const { return this->At == this->End; }

  /// Skips spaces, tabs and carriage returns, not line ends.
  void skipBlanks()
  {
    while (this->At < this->End && (*this->At == ' ' || *this->At == '\t' || *this->At == '\r'))
    {
      ++this->At;
    }
    if (this->At < this->End && *this->At == this->Comment && this->Comment)
    {
      this->skipRestOfLine();
    }
  }
  /// Whether only blanks and a comment are left in this line.
  bool lineIsOver()
  {
    this->skipBlanks();
    return this->At == this->End || *this->At == '\n';
  }
  /// Moves to the next number or word, across lines; false at the end of the file.
  bool skipToToken()
  {
    for (; this->lineIsOver(); ++this->At)
    {
      if (this->At == this->End)
      {
        return false;
      }
    }
    return true;
  }
  /// Moves to the '\n' (or the end) of this line.
  void skipRestOfLine();
  /// The number of tokens between here and the end of the line.
  int tokensInLine();
  /// Throws unless the line is over; counts a record.
  void expectLineEnd();
  /// For records that are not lines: polls and reports progress at each 4096th record.
  void countRecord()
  {
    constexpr int recordsPerPoll = 4096;
    if (++this->Records == recordsPerPoll)
    {
      this->poll();
    }
  }
  /// Throws unless only blanks and comments are left; `what` names the last thing read.
  void expectFileEnd(const char* what);

  /// A number in this line; `what` names it in the message.
  double real(const char* what);
  /// A finite number.
  double coordinate(const char* what)
  {
    this->skipBlanks();
    const char* start = this->At;
    const double value = this->real(what);
    if (!std::isfinite(value))
    {
      this->failNotFinite(start, what);
    }
    return value;
  }
  /// An integer in this line.
  Index integer(const char* what);
  /// An integer within [low, high].
  Index integer(const char* what, Index low, Index high)
  {
    this->skipBlanks();
    const char* start = this->At;
    const Index value = this->integer(what);
    if (value < low || value > high)
    {
      this->failRange(start, what, value, low, high);
    }
    return value;
  }
  /// A count of records of at least `bytes` bytes each, which must fit into the rest of the file.
  Index count(const char* what, std::size_t bytes);
  /// Throws unless `records` records of at least `bytes` bytes can be in the rest of the file.
  void expectRoom(Index records, std::size_t bytes, const char* what) const;
  /// The text up to the next blank or line end; empty at the end of the line.
  std::string_view word();
  /// The next word in this or a later line; `what` names it in the message if the file ends first.
  std::string nextWord(const char* what);
  /// The next token in this or a later line, an integer within [low, high].
  Index nextInteger(const char* what, Index low, Index high)
  {
    this->skipToToken();
    return this->integer(what, low, high);
  }
  /// The text between double quotes.
  std::string quoted(const char* what);

  /// Raw bytes in the file's byte order.
  template <class T>
  T binary(const char* what)
  {
    T value;
    if (this->bytesLeft() < sizeof(T))
    {
      this->fail(std::string("the file ends before ") + what);
    }
    char bytes[sizeof(T)];
    std::memcpy(bytes, this->At, sizeof(T));
    for (std::size_t i = 0; this->Swap && i < sizeof(T) / 2; ++i)
    {
      std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    }
    std::memcpy(&value, bytes, sizeof(T));
    this->At += sizeof(T);
    return value;
  }
  /// Whether binary() reverses the bytes.
  void setSwap(bool swap) { this->Swap = swap; }

private:
  void poll();
  [[noreturn]] void failNumber(const char* kind, const char* what) const;
  [[noreturn]] void failNotFinite(const char* start, const char* what) const;
  [[noreturn]] void failRange(
    const char* start, const char* what, Index value, Index low, Index high) const;
  bool endsToken(const char* place) const
  {
    return place == this->End || *place == ' ' || *place == '\n' || *place == '\r' ||
      *place == '\t' || (this->Comment && *place == this->Comment);
  }
  double unusualReal(const char* start, const char* what);
  Index unusualInteger(const char* what);
  static constexpr bool LittleEndian = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;

  const FileContent& File;
  const char* At;
  const char* End;
  char Comment;
  bool Swap = false;
  int Records = 0; ///< since the last poll
};

//------------------------------------------------------------------------------
inline double TextCursor::real(const char* what)
{
  this->skipBlanks();
  double value;
  const auto [end, error] = std::from_chars(this->At, this->End, value);
  if (error != std::errc() || !this->endsToken(end))
  {
    return this->unusualReal(this->At, what);
  }
  this->At = end;
  return value;
}

//------------------------------------------------------------------------------
inline Index TextCursor::integer(const char* what)
{
  this->skipBlanks();
  // Parses up to seven digits at once: loads eight bytes into a register, moves the digits to its
  // upper end, then combines pairs, fours and eights of digits. (The content ends with eight bytes
  // of padding.)
  std::uint64_t bytes;
  std::memcpy(&bytes, this->At, sizeof(bytes));
  bytes ^= 0x3030303030303030u;
  const std::uint64_t others = ((bytes + 0x7676767676767676u) | bytes) & 0x8080808080808080u;
  const int digits = others ? __builtin_ctzll(others) / 8 : 8;
  if (digits == 0 || digits == 8 || !LittleEndian)
  {
    return this->unusualInteger(what);
  }
  bytes <<= 64 - 8 * digits;
  bytes = (bytes * 2561) >> 8;
  bytes = ((bytes & 0x00ff00ff00ff00ffu) * 6553601) >> 16;
  bytes = ((bytes & 0x0000ffff0000ffffu) * 42949672960001u) >> 32;
  if (!this->endsToken(this->At + digits))
  {
    this->failNumber("a whole number", what);
  }
  this->At += digits;
  return static_cast<Index>(bytes);
}

/// Requests large pages from the system: with ordinary pages, the first access to a large new array
/// takes as long as filling it.
void adviseLargePages(void* memory, std::size_t bytes);

/// Reserves memory for `size` values in total, in large pages if available.
template <class Vector>
void reserveLarge(Vector& values, std::size_t size)
{
  if (values.capacity() < size)
  {
    values.reserve(size);
    adviseLargePages(values.data(), size * sizeof(typename Vector::value_type));
  }
}

/// resize(), in large pages.
template <class Vector>
void resizeLarge(Vector& values, std::size_t size)
{
  reserveLarge(values, size);
  values.resize(size);
}

/// The first word of a file, of at most 40 bytes; empty if it cannot be read.
std::string firstWord(const std::string& name);

/// A column in a comment in which Tautline's writers store array names: "Velocity:3:f ...".
struct ColumnName
{
  std::string name;
  int components;
  char code; ///< f, i or u
};

/// Finds the line "# <title> ..." in the first kilobytes; empty if it is missing or malformed.
std::vector<ColumnName> readColumnNames(const FileContent& file, std::string_view title);
/// The line for readColumnNames(), with its line end.
std::string writeColumnNames(std::string_view title, const std::vector<ColumnName>& columns);
/// Stores a number in an array of any type.
void setValue(MeshArray& array, std::size_t i, double value);
}
#endif
