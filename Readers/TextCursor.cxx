// SPDX-License-Identifier: BSD-3-Clause
#include "TextCursor.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/LoopProgress.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tautline
{
namespace
{
/// The start of the text at a position, in printable form.
std::string excerpt(const char* at, const char* end)
{
  constexpr std::ptrdiff_t Longest = 20;
  std::string text;
  const char* stop = at + std::min(end - at, Longest);
  for (; at < stop && *at != ' ' && *at != '\n' && *at != '\r' && *at != '\t'; ++at)
  {
    const bool printable = *at >= 0x20 && *at < 0x7f;
    char code[8];
    std::snprintf(code, sizeof(code), "\\x%02x", static_cast<unsigned char>(*at));
    text += printable ? std::string(1, *at) : std::string(code);
  }
  return text;
}

std::string found(const char* at, const char* end)
{
  if (at == end)
  {
    return "the file ends";
  }
  return *at == '\n' ? "the line ends" : "found '" + excerpt(at, end) + "'";
}
}

//------------------------------------------------------------------------------
OpenFile openFile(const std::string& name)
{
  // Without O_NONBLOCK, opening a pipe would wait for a writer.
  const int descriptor = open(name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  std::FILE* file = descriptor < 0 ? nullptr : fdopen(descriptor, "rb");
  if (descriptor >= 0 && !file)
  {
    close(descriptor);
  }
  return OpenFile(file, [](std::FILE* f) { return f ? std::fclose(f) : 0; });
}

//------------------------------------------------------------------------------
FileContent::FileContent(const std::string& name, const std::string& why)
  : Name(name)
{
  struct stat status;
  const OpenFile file = openFile(name);
  const std::string reason = why.empty() ? std::string() : " (" + why + ")";
  if (!file)
  {
    throw FileError(name + ": cannot be opened" + reason + ": " + std::strerror(errno));
  }
  if (fstat(fileno(file.get()), &status) != 0 || !S_ISREG(status.st_mode))
  {
    throw FileError(name + ": is not a regular file" + reason);
  }
  this->Size = static_cast<std::size_t>(status.st_size);
  this->allocate();
  this->Size = std::fread(this->Bytes.get(), 1, this->Size, file.get());
  std::memset(this->Bytes.get() + this->Size, 0, Padding);
  if (std::ferror(file.get()))
  {
    throw FileError(name + ": cannot be read: " + std::strerror(errno));
  }
}

//------------------------------------------------------------------------------
void FileContent::allocate()
{
  constexpr std::size_t LargePage = std::size_t{ 1 } << 21;
  const std::size_t size = (this->Size + Padding + LargePage - 1) / LargePage * LargePage;
  const bool large = this->Size >= LargePage;
  this->Bytes.reset(static_cast<char*>(
    large ? std::aligned_alloc(LargePage, size) : std::malloc(this->Size + Padding)));
  if (!this->Bytes)
  {
    throw std::bad_alloc();
  }
  if (large)
  {
    adviseLargePages(this->Bytes.get(), size);
  }
}

//------------------------------------------------------------------------------
FileContent::FileContent(std::string name, std::string_view bytes)
  : Name(std::move(name))
  , Size(bytes.size())
{
  this->allocate();
  std::copy(bytes.begin(), bytes.end(), this->Bytes.get());
  std::memset(this->Bytes.get() + this->Size, 0, Padding);
}

//------------------------------------------------------------------------------
TextCursor::TextCursor(const FileContent& file, char comment)
  : File(file)
  , At(file.begin())
  , End(file.end())
  , Comment(comment)
{
  if (this->bytesLeft() >= 3 && std::memcmp(this->At, "\xef\xbb\xbf", 3) == 0)
  {
    this->At += 3;
  }
}

//------------------------------------------------------------------------------
void TextCursor::failAt(const char* place, const std::string& problem) const
{
  const auto line = 1 + std::count(this->File.begin(), place, '\n');
  throw FileError(this->File.name() + ":" + std::to_string(line) + ": " + problem);
}

//------------------------------------------------------------------------------
void TextCursor::fail(const std::string& problem) const
{
  this->failAt(this->At, problem);
}

//------------------------------------------------------------------------------
void TextCursor::failNumber(const char* kind, const char* what) const
{
  this->fail(std::string("expected ") + kind + " (" + what + "), " + found(this->At, this->End));
}

//------------------------------------------------------------------------------
void TextCursor::failNotFinite(const char* start, const char* what) const
{
  this->failAt(start, std::string(what) + " is not a finite number: " + excerpt(start, this->End));
}

//------------------------------------------------------------------------------
void TextCursor::failRange(
  const char* start, const char* what, Index value, Index low, Index high) const
{
  const std::string allowed = high < low
    ? "there are none"
    : "from " + std::to_string(low) + " to " + std::to_string(high) + " are allowed";
  this->failAt(start, std::string(what) + " is " + std::to_string(value) + ", " + allowed);
}

//------------------------------------------------------------------------------
double TextCursor::unusualReal(const char* start, const char* what)
{
  const bool plus = start < this->End && *start == '+';
  const char* digits = start + plus;
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits, this->End, value);
  if (error == std::errc::invalid_argument || !this->endsToken(end) ||
    (plus && digits < this->End && *digits == '-'))
  {
    this->failNumber("a number", what);
  }
  if (error == std::errc::result_out_of_range)
  {
    // too small becomes 0 or subnormal, too large infinite
    value = std::strtod(std::string(digits, end).c_str(), nullptr);
  }
  this->At = end;
  return value;
}

//------------------------------------------------------------------------------
Index TextCursor::unusualInteger(const char* what)
{
  const char* start = this->At + (this->At < this->End && *this->At == '+');
  Index value = 0;
  const auto [end, error] = std::from_chars(start, this->End, value);
  if (error != std::errc() || !this->endsToken(end) || (start != this->At && value < 0))
  {
    this->failNumber("a whole number", what);
  }
  this->At = end;
  return value;
}

//------------------------------------------------------------------------------
void TextCursor::skipRestOfLine()
{
  const void* newline = std::memchr(this->At, '\n', this->bytesLeft());
  this->At = newline ? static_cast<const char*>(newline) : this->End;
}

//------------------------------------------------------------------------------
int TextCursor::tokensInLine()
{
  const char* start = this->At;
  int tokens = 0;
  for (; !this->lineIsOver() && tokens < std::numeric_limits<int>::max(); ++tokens)
  {
    this->word();
  }
  this->At = start;
  return tokens;
}

//------------------------------------------------------------------------------
void TextCursor::poll()
{
  this->Records = 0;
  throwIfInterrupted();
  const double read = static_cast<double>(this->At - this->File.begin());
  LoopProgress::at(read / (read + static_cast<double>(this->bytesLeft())));
}

//------------------------------------------------------------------------------
void TextCursor::expectLineEnd()
{
  this->countRecord();
  if (!this->lineIsOver())
  {
    this->fail("the line has more than it should: '" + excerpt(this->At, this->End) + "'");
  }
}

//------------------------------------------------------------------------------
void TextCursor::expectFileEnd(const char* what)
{
  if (this->skipToToken())
  {
    this->fail(std::string("the file continues after the last ") + what +
      " its header announces: '" + excerpt(this->At, this->End) + "'");
  }
}

//------------------------------------------------------------------------------
Index TextCursor::count(const char* what, std::size_t bytes)
{
  this->skipBlanks();
  const char* start = this->At;
  const Index value = this->integer(what);
  if (value < 0)
  {
    this->failAt(start, std::string(what) + " is negative: " + std::to_string(value));
  }
  this->expectRoom(value, bytes, what);
  return value;
}

//------------------------------------------------------------------------------
void TextCursor::expectRoom(Index records, std::size_t bytes, const char* what) const
{
  // the last record may lack its line end
  if (records < 0 || static_cast<std::size_t>(records) > (this->bytesLeft() + 1) / bytes)
  {
    this->fail(std::string(what) + " is " + std::to_string(records) +
      ", more than the rest of the file can hold");
  }
}

//------------------------------------------------------------------------------
std::string_view TextCursor::word()
{
  this->skipBlanks();
  const char* start = this->At;
  while (!this->endsToken(this->At))
  {
    ++this->At;
  }
  return std::string_view(start, static_cast<std::size_t>(this->At - start));
}

//------------------------------------------------------------------------------
std::string TextCursor::nextWord(const char* what)
{
  if (!this->skipToToken())
  {
    this->fail(std::string("the file ends before ") + what);
  }
  return std::string(this->word());
}

//------------------------------------------------------------------------------
std::string TextCursor::quoted(const char* what)
{
  this->skipBlanks();
  if (this->atEnd() || *this->At != '"')
  {
    this->failNumber("a text in double quotes", what);
  }
  const char* start = this->At + 1;
  const char* stop = start;
  while (stop < this->End && *stop != '"' && *stop != '\n')
  {
    ++stop;
  }
  if (stop == this->End || *stop != '"')
  {
    this->fail(std::string("no closing quote after ") + what);
  }
  this->At = stop + 1;
  return std::string(start, stop);
}

//------------------------------------------------------------------------------
void adviseLargePages(void* memory, std::size_t bytes)
{
  constexpr std::uintptr_t LargePage = std::uintptr_t{ 1 } << 21;
  const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t begin = (first + LargePage - 1) / LargePage * LargePage;
  const std::uintptr_t end = (first + bytes) / LargePage * LargePage;
  if (begin < end)
  {
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE); // failure is not an error
  }
}

//------------------------------------------------------------------------------
std::string firstWord(const std::string& name)
{
  const OpenFile file = openFile(name);
  char bytes[256];
  const std::size_t size = file ? std::fread(bytes, 1, sizeof(bytes), file.get()) : 0;
  const FileContent start(name, std::string_view(bytes, size));
  TextCursor cursor(start, '#');
  return cursor.skipToToken() ? std::string(cursor.word().substr(0, 40)) : std::string();
}

//------------------------------------------------------------------------------
std::vector<ColumnName> readColumnNames(const FileContent& file, std::string_view title)
{
  constexpr std::size_t Searched = 65536;
  const std::string_view head(
    file.begin(), std::min(Searched, static_cast<std::size_t>(file.end() - file.begin())));
  const std::string start = "# " + std::string(title);
  const std::size_t found = head.find(start);
  const std::size_t stop = found == head.npos ? head.npos : head.find('\n', found);
  if (stop == head.npos || (found > 0 && head[found - 1] != '\n'))
  {
    return {};
  }
  std::vector<ColumnName> columns;
  const FileContent line(
    file.name(), head.substr(found + start.size(), stop - found - start.size()));
  TextCursor cursor(line);
  while (!cursor.lineIsOver())
  {
    const std::string_view token = cursor.word();
    const std::size_t colon = token.size() < 5 ? token.npos : token.rfind(':', token.size() - 3);
    int components = 0;
    if (colon == token.npos || token[token.size() - 2] != ':' ||
      std::from_chars(token.data() + colon + 1, token.data() + token.size() - 2, components).ptr !=
        token.data() + token.size() - 2 ||
      components < 1 || components > 1000 || std::strchr("fiu", token.back()) == nullptr)
    {
      return {};
    }
    std::string name;
    for (std::size_t i = 0; i < colon; ++i)
    {
      const bool escaped = token[i] == '%' && i + 2 < colon;
      name += escaped
        ? static_cast<char>(std::strtol(std::string(token.substr(i + 1, 2)).c_str(), nullptr, 16))
        : token[i];
      i += escaped ? 2 : 0;
    }
    columns.push_back({ name, components, token.back() });
  }
  return columns;
}

//------------------------------------------------------------------------------
std::string writeColumnNames(std::string_view title, const std::vector<ColumnName>& columns)
{
  std::string line = "# " + std::string(title);
  for (const ColumnName& column : columns)
  {
    line += ' ';
    for (const char c : column.name)
    {
      char code[4];
      std::snprintf(code, sizeof(code), "%%%02x", static_cast<unsigned char>(c));
      const bool plain = c > 0x20 && c < 0x7f && c != '%' && c != '#';
      line += plain ? std::string(1, c) : std::string(code);
    }
    line += ":" + std::to_string(column.components) + ":" + column.code;
  }
  return line + "\n";
}

//------------------------------------------------------------------------------
void setValue(MeshArray& array, std::size_t i, double value)
{
  if (auto* doubles = std::get_if<MeshArray::Doubles>(&array.values))
  {
    (*doubles)[i] = value;
  }
  else if (auto* integers = std::get_if<MeshArray::Integers>(&array.values))
  {
    constexpr double Limit = 9.2e18;
    (*integers)[i] =
      std::isnan(value) ? 0 : static_cast<Index>(std::max(-Limit, std::min(Limit, value)));
  }
  else
  {
    std::get<MeshArray::Bytes>(array.values)[i] =
      std::isnan(value) ? 0 : static_cast<unsigned char>(std::max(0.0, std::min(255.0, value)));
  }
}
}
