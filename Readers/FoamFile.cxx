// SPDX-License-Identifier: BSD-3-Clause
#include "FoamFile.h"

#include "FileNames.h"
#include "GzipFileAdapter.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

namespace tautline
{
namespace
{
constexpr const char* Compressed = ".gz";
constexpr std::size_t LeastFace = 7;  // bytes of "3(0 1 2)" without one separator
constexpr std::size_t LeastPoint = 7; // bytes of "(0 0 0)"
constexpr int Corners = 3;            // number of corners of the smallest face

bool isBlank(char c)
{
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}

/// Whether a character can be in the name of a macro or directive.
bool isNamePart(char c)
{
  return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '.' ||
    c == ':';
}

bool isPunctuation(char c)
{
  return c == '(' || c == ')' || c == '{' || c == '}' || c == ';' || c == '"';
}

/// The number of bytes per value for a list type; 0 for types with text values.
std::size_t valueBytes(const std::string& type, const FoamHeader& header)
{
  const auto scalar = static_cast<std::size_t>(header.scalarBytes);
  const std::array<std::pair<const char*, std::size_t>, 8> known = { {
    { "List<label>", static_cast<std::size_t>(header.labelBytes) },
    { "List<bool>", 1 },
    { "List<scalar>", scalar },
    { "List<vector>", 3 * scalar },
    { "List<point>", 3 * scalar },
    { "List<sphericalTensor>", scalar },
    { "List<symmTensor>", 6 * scalar },
    { "List<tensor>", 9 * scalar },
  } };
  for (const auto& [name, bytes] : known)
  {
    if (type == name)
    {
      return bytes;
    }
  }
  return 0;
}

template <class T>
T loaded(const char* place, bool swapped)
{
  char bytes[sizeof(T)];
  std::memcpy(bytes, place, sizeof(T));
  if (swapped)
  {
    std::reverse(bytes, bytes + sizeof(T));
  }
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}
}

//------------------------------------------------------------------------------
std::string foamFileName(const std::string& name)
{
  return !fileExists(name) && fileExists(name + Compressed) ? name + Compressed : name;
}

//------------------------------------------------------------------------------
bool foamFileExists(const std::string& name)
{
  return fileExists(name) || fileExists(name + Compressed);
}

//------------------------------------------------------------------------------
FoamContent::FoamContent(const std::string& name, const std::string& why)
  : packed(foamFileName(name), why)
  , file(packed.name(), std::string_view())
  , compressed(packed.name() != name)
{
  if (this->compressed)
  {
    const std::string bytes = gunzipped(this->packed);
    this->file = FileContent(this->packed.name(), std::string_view(bytes));
  }
}

//------------------------------------------------------------------------------
FoamCursor::FoamCursor(const FileContent& file, FoamComplaint complaint)
  : TextCursor(file)
  , File(file)
  , Complaint(std::move(complaint))
{
  this->readHeader();
}

//------------------------------------------------------------------------------
bool FoamCursor::skipSpace()
{
  const char* at = this->place();
  const char* const stop = this->end();
  for (;;)
  {
    while (at < stop && isBlank(*at))
    {
      ++at;
    }
    if (stop - at < 2 || *at != '/' || (at[1] != '/' && at[1] != '*'))
    {
      break;
    }
    if (at[1] == '/')
    {
      const void* newline = std::memchr(at, '\n', static_cast<std::size_t>(stop - at));
      at = newline ? static_cast<const char*>(newline) : stop;
      continue;
    }
    const std::string_view rest(at, static_cast<std::size_t>(stop - at));
    const std::size_t close = rest.find("*/", 2);
    if (close == rest.npos)
    {
      this->failAt(at, "the comment has no end");
    }
    at += close + 2;
  }
  this->moveTo(at);
  return at < stop;
}

//------------------------------------------------------------------------------
bool FoamCursor::take(char c)
{
  if (!this->skipSpace() || *this->place() != c)
  {
    return false;
  }
  this->moveTo(this->place() + 1);
  return true;
}

//------------------------------------------------------------------------------
void FoamCursor::expect(char c, const char* after)
{
  if (!this->take(c))
  {
    this->failToken((std::string("'") + c + "'").c_str(), (std::string("after ") + after).c_str());
  }
}

//------------------------------------------------------------------------------
void FoamCursor::failToken(const char* expected, const char* what)
{
  constexpr std::ptrdiff_t Longest = 20;
  const bool more = this->skipSpace();
  std::string found;
  const char* stop = this->place() + std::min(Longest, this->end() - this->place());
  for (const char* at = this->place(); at < stop && !isBlank(*at); ++at)
  {
    found += *at > ' ' && *at <= '~' ? *at : '?';
  }
  this->fail(std::string("expected ") + expected + " (" + what + "), " +
    (more ? "found '" + found + "'" : "the file ends"));
}

//------------------------------------------------------------------------------
void FoamCursor::failByte(const char* place, const std::string& problem) const
{
  throw FileError(
    this->File.name() + ": byte " + std::to_string(place - this->File.begin()) + ": " + problem);
}

//------------------------------------------------------------------------------
void FoamCursor::checkComplaint(Index entry, const char* place) const
{
  if (entry == this->Complaint.entry)
  {
    if (this->Header.binary)
    {
      this->failByte(place, this->Complaint.problem);
    }
    this->failAt(place, this->Complaint.problem);
  }
}

//------------------------------------------------------------------------------
std::string FoamCursor::token(const char* what)
{
  if (!this->skipSpace())
  {
    this->failToken("a word", what);
  }
  if (*this->place() == '"')
  {
    return this->quoted(what);
  }
  const char* begin = this->place();
  if (*begin == '#' || *begin == '$')
  {
    std::string name(begin, 1);
    for (const char* at = begin + 1; at < this->end() && isNamePart(*at); ++at)
    {
      name += *at;
    }
    this->fail("'" + name + "' is a " + (*begin == '#' ? "directive" : "macro") +
      ", which only OpenFOAM evaluates: write its value instead, for example with foamDictionary "
      "-expand");
  }
  const char* at = begin;
  while (at < this->end() && !isBlank(*at) && !isPunctuation(*at) &&
    !(*at == '/' && at + 1 < this->end() && (at[1] == '/' || at[1] == '*')))
  {
    ++at;
  }
  if (at == begin)
  {
    this->failToken("a word", what);
  }
  this->moveTo(at);
  return std::string(begin, at);
}

//------------------------------------------------------------------------------
Index FoamCursor::label(const char* what, Index low, Index high)
{
  this->skipSpace();
  const char* begin = this->place();
  Index value = 0;
  const auto [end, error] = std::from_chars(begin, this->end(), value);
  const bool over =
    end == this->end() || isBlank(*end) || isPunctuation(*end) || *end == '/' || *end == ',';
  if (error == std::errc::result_out_of_range && over)
  {
    this->fail(std::string(what) + " has more digits than a label of 64 bits");
  }
  if (error != std::errc() || !over)
  {
    this->failToken("a whole number", what);
  }
  if (value < low || value > high)
  {
    this->fail(std::string(what) + " is " + std::to_string(value) +
      (high < low
          ? ", there are none"
          : ", from " + std::to_string(low) + " to " + std::to_string(high) + " are allowed"));
  }
  this->moveTo(end);
  return value;
}

//------------------------------------------------------------------------------
double FoamCursor::scalar(const char* what)
{
  this->skipSpace();
  const char* begin = this->place();
  const char* digits = begin + (begin < this->end() && *begin == '+');
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits, this->end(), value);
  const bool over = end == this->end() || isBlank(*end) || isPunctuation(*end) || *end == '/';
  if (error == std::errc::invalid_argument || !over)
  {
    this->failToken("a number", what);
  }
  if (error == std::errc::result_out_of_range)
  {
    value = std::strtod(std::string(digits, end).c_str(), nullptr);
  }
  if (!std::isfinite(value))
  {
    this->fail(std::string(what) + " is not a finite number: " + std::string(begin, end));
  }
  this->moveTo(end);
  return value;
}

//------------------------------------------------------------------------------
void FoamCursor::expectEnd(const char* list)
{
  if (this->skipSpace())
  {
    this->fail(std::string("the file continues after ") + list);
  }
}

//------------------------------------------------------------------------------
void FoamCursor::readHeader()
{
  if (!this->skipSpace() || this->token("the header") != "FoamFile")
  {
    this->fail("the file has no header FoamFile { ... }");
  }
  this->expect('{', "FoamFile");
  for (std::string key = this->keyword(); !key.empty(); key = this->keyword())
  {
    if (key == "format")
    {
      const std::string format = this->value("format");
      if (format != "ascii" && format != "binary")
      {
        this->fail("the format is '" + format + "', not ascii or binary");
      }
      this->Header.binary = format == "binary";
    }
    else if (key == "class")
    {
      this->Header.type = this->value("class");
    }
    else if (key == "arch")
    {
      const std::string arch = this->value("arch");
      constexpr bool Little = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;
      this->Header.swapped = arch.find(Little ? "MSB" : "LSB") != arch.npos;
      const auto bytes = [&arch](const char* kind, int usual)
      {
        const auto has = [&](const char* bits)
        { return arch.find(std::string(kind) + bits) != arch.npos; };
        return has("=64") ? 8 : has("=32") ? 4 : usual;
      };
      this->Header.labelBytes = bytes("label", this->Header.labelBytes);
      this->Header.scalarBytes = bytes("scalar", this->Header.scalarBytes);
    }
    else
    {
      this->skipValue();
    }
  }
}

//------------------------------------------------------------------------------
std::string FoamCursor::keyword()
{
  return this->take('}') ? std::string() : this->token("a keyword");
}

//------------------------------------------------------------------------------
void FoamCursor::skipValue()
{
  int depth = 0;
  bool dictionary = false, begins = true;
  for (;; begins = false)
  {
    if (!this->skipSpace())
    {
      this->fail("the file ends inside a dictionary");
    }
    const char c = *this->place();
    if (c == '"')
    {
      this->quoted("a text");
      continue;
    }
    if (isPunctuation(c))
    {
      const bool closes = c == ')' || c == '}';
      dictionary |= begins && c == '{';
      if (closes && depth == 0)
      {
        this->fail("the previous value has no ';'");
      }
      this->moveTo(this->place() + 1);
      depth += closes ? -1 : c == '(' || c == '{' ? 1 : 0;
      if (depth == 0 && (c == ';' || (dictionary && c == '}')))
      {
        return;
      }
      continue;
    }
    const std::string word = this->token("a value");
    if (valueBytes(word, this->Header) > 0 && this->Header.binary)
    {
      this->skipList(word);
    }
  }
}

//------------------------------------------------------------------------------
void FoamCursor::skipList(const std::string& type)
{
  const std::size_t bytes = valueBytes(type, this->Header);
  const Index entries = this->count("a list", std::numeric_limits<Index>::max());
  if (!this->take('('))
  {
    return; // empty, or n{value}, which is text
  }
  this->expectBytes(entries, bytes, "a list");
  this->moveTo(this->place() + static_cast<std::size_t>(entries) * bytes);
  this->expect(')', "a list");
}

//------------------------------------------------------------------------------
std::string FoamCursor::value(const char* keyword)
{
  const std::string found = this->token(keyword);
  this->skipValue();
  return found;
}

//------------------------------------------------------------------------------
Index FoamCursor::labelValue(const char* keyword, Index low, Index high)
{
  this->skipSpace();
  if (!this->atEnd() && (*this->place() == '$' || *this->place() == '#'))
  {
    this->token(keyword); // throws
  }
  const Index found = this->label(keyword, low, high);
  this->expect(';', keyword);
  return found;
}

//------------------------------------------------------------------------------
std::vector<Index> FoamCursor::labelsValue(const char* keyword, Index low, Index high, Index most)
{
  this->skipSpace();
  if (!this->atEnd() && !isDigit(*this->place()) && *this->place() != '(')
  {
    const std::string type = this->token(keyword);
    if (type != "List<label>")
    {
      this->fail(std::string(keyword) + " is a list of labels, not '" + type + "'");
    }
  }
  std::vector<Index> found = this->labels(keyword, low, high, most);
  this->expect(';', keyword);
  return found;
}

//------------------------------------------------------------------------------
Index FoamCursor::count(const char* what, Index most)
{
  this->skipSpace();
  const char* begin = this->place();
  const Index found = this->label("the number of entries", 0, std::numeric_limits<Index>::max());
  if (found > most)
  {
    this->failAt(begin,
      std::string("there are ") + std::to_string(found) + " entries of " + what + "; at most " +
        std::to_string(most) + " are possible");
  }
  return found;
}

//------------------------------------------------------------------------------
Index FoamCursor::openList(const char* what)
{
  if (this->take('('))
  {
    return -1;
  }
  const Index entries = this->count(what, std::numeric_limits<Index>::max());
  if (entries > 0)
  {
    this->skipSpace();
    if (!this->atEnd() && *this->place() == '{')
    {
      this->fail(std::string(what) + " cannot all be equal, as in n{value}");
    }
    this->expect('(', "the number of entries");
  }
  else if (this->take('('))
  {
    this->expect(')', "an empty list");
  }
  return entries;
}

//------------------------------------------------------------------------------
void FoamCursor::expectBytes(Index entries, std::size_t bytes, const char* what) const
{
  if (static_cast<std::size_t>(entries) > this->bytesLeft() / bytes)
  {
    const std::string problem = std::string(what) + ": the file is truncated: the list has " +
      std::to_string(entries) + " entries, and " + std::to_string(this->bytesLeft()) +
      " bytes follow";
    if (this->Header.binary)
    {
      this->failByte(this->place(), problem);
    }
    this->fail(problem);
  }
}

//------------------------------------------------------------------------------
template <class T>
void FoamCursor::binaryLabels(
  const char* what, Index low, Index high, Index entries, std::vector<Index>& values)
{
  this->expectBytes(entries, sizeof(T), what);
  const std::size_t before = values.size();
  if (before == 0)
  {
    reserveLarge(values, static_cast<std::size_t>(entries));
  }
  values.resize(before + static_cast<std::size_t>(entries));
  const char* at = this->place();
  for (Index i = 0; i < entries; ++i, at += sizeof(T))
  {
    pollInterruption(i);
    const Index value = loaded<T>(at, this->Header.swapped);
    if (value < low || value > high)
    {
      this->failByte(at,
        std::string(what) + " " + std::to_string(i) + " is " + std::to_string(value) + ", from " +
          std::to_string(low) + " to " + std::to_string(high) + " are allowed");
    }
    this->checkComplaint(i, at);
    values[before + static_cast<std::size_t>(i)] = value;
  }
  this->moveTo(at);
  if (this->atEnd() || *at != ')')
  {
    this->failByte(at,
      std::string(what) + ": the list does not end after its " + std::to_string(entries) +
        " entries of " + std::to_string(sizeof(T)) + " bytes");
  }
  this->moveTo(at + 1);
}

//------------------------------------------------------------------------------
std::vector<Index> FoamCursor::labels(const char* what, Index low, Index high, Index most)
{
  std::vector<Index> values;
  if (this->take('('))
  {
    for (Index i = 0; !this->take(')'); ++i)
    {
      pollInterruption(i);
      this->skipSpace();
      const char* begin = this->place();
      values.push_back(this->label(what, low, high));
      if (i == most)
      {
        this->failAt(begin,
          std::string("there are more entries of ") + what + " than " + std::to_string(most));
      }
      this->checkComplaint(i, begin);
    }
    return values;
  }
  const Index entries = this->count(what, most);
  if (this->take('{'))
  {
    const char* begin = this->place();
    values.assign(static_cast<std::size_t>(entries), this->label(what, low, high));
    if (this->Complaint.entry >= 0 && this->Complaint.entry < entries)
    {
      this->checkComplaint(this->Complaint.entry, begin);
    }
    this->expect('}', what);
    return values;
  }
  if (entries == 0)
  {
    if (this->take('('))
    {
      this->expect(')', "an empty list");
    }
    return values;
  }
  this->expect('(', "the number of entries");
  if (this->Header.binary)
  {
    this->Header.labelBytes == 8
      ? this->binaryLabels<std::int64_t>(what, low, high, entries, values)
      : this->binaryLabels<std::int32_t>(what, low, high, entries, values);
    return values;
  }
  constexpr std::size_t LeastLabel = 2; // a digit and a blank or the parenthesis
  this->expectBytes(entries, LeastLabel, what);
  reserveLarge(values, static_cast<std::size_t>(entries));
  for (Index i = 0; i < entries; ++i)
  {
    this->countRecord();
    this->skipSpace();
    const char* begin = this->place();
    values.push_back(this->label(what, low, high));
    this->checkComplaint(i, begin);
  }
  this->expect(')', "the last entry its list announces");
  return values;
}

//------------------------------------------------------------------------------
template <class T>
void FoamCursor::binaryScalars(const char* what, Index entries, std::vector<double>& values)
{
  constexpr std::size_t Width = 3 * sizeof(T);
  this->expectBytes(entries, Width, what);
  const auto count = 3 * static_cast<std::size_t>(entries);
  resizeLarge(values, count);
  const char* at = this->place();
  for (std::size_t i = 0; i < count; ++i, at += sizeof(T))
  {
    pollInterruption(static_cast<Index>(i));
    const T value = loaded<T>(at, this->Header.swapped);
    if (!std::isfinite(value))
    {
      this->failByte(at,
        "coordinate " + std::to_string(i % 3) + " of point " + std::to_string(i / 3) +
          " is not a finite number");
    }
    values[i] = value;
  }
  if (at == this->end() || *at != ')')
  {
    this->failByte(at,
      "the list of points does not end after its " + std::to_string(entries) + " points of " +
        std::to_string(Width) + " bytes");
  }
  this->moveTo(at + 1);
}

//------------------------------------------------------------------------------
FoamCursor::Places FoamCursor::openPoints()
{
  Places places;
  places.count = this->openList("points");
  places.first = this->place();
  if (places.count > 0)
  {
    this->expectBytes(places.count,
      this->Header.binary ? 3 * static_cast<std::size_t>(this->Header.scalarBytes) : LeastPoint,
      "points");
  }
  return places;
}

//------------------------------------------------------------------------------
double FoamCursor::coordinate()
{
  return this->scalar("coordinate");
}

//------------------------------------------------------------------------------
std::vector<double> FoamCursor::points()
{
  std::vector<double> values;
  const Index entries = this->openPoints().count;
  if (entries > 0 && this->Header.binary)
  {
    this->Header.scalarBytes == 8 ? this->binaryScalars<double>("points", entries, values)
                                  : this->binaryScalars<float>("points", entries, values);
    return values;
  }
  reserveLarge(values, 3 * static_cast<std::size_t>(std::max<Index>(entries, 0)));
  for (Index i = 0; entries < 0 ? !this->take(')') : i < entries; ++i)
  {
    this->countRecord();
    this->openVector();
    for (int axis = 0; axis < 3; ++axis)
    {
      values.push_back(this->coordinate());
    }
    this->closeVector();
  }
  if (entries > 0)
  {
    this->expect(')', "the last point its list announces");
  }
  return values;
}

//------------------------------------------------------------------------------
void FoamCursor::checkFace(Index face, const std::vector<Index>& offsets,
  const std::vector<Index>& points, const char* place)
{
  constexpr std::ptrdiff_t FewPoints = 8;
  const auto begin = points.begin() + offsets[static_cast<std::size_t>(face)];
  const auto end = points.begin() + offsets[static_cast<std::size_t>(face) + 1];
  const auto refuse = [&](const std::string& problem)
  {
    const std::string text = "face " + std::to_string(face) + " " + problem;
    if (this->Header.binary)
    {
      this->failByte(place, text);
    }
    this->failAt(place, text);
  };
  if (end - begin < Corners)
  {
    refuse("has " + std::to_string(end - begin) + " points; at least 3 are needed");
  }
  const auto repeats = [&](Index point)
  { refuse("has point " + std::to_string(point) + " more than once"); };
  if (end - begin > FewPoints)
  {
    const Index most = *std::max_element(begin, end);
    if (static_cast<Index>(this->LastFace.size()) <= most)
    {
      this->LastFace.resize(static_cast<std::size_t>(most) + 1, -1);
    }
    for (auto p = begin; p != end; ++p)
    {
      Index& last = this->LastFace[static_cast<std::size_t>(*p)];
      if (std::exchange(last, face) == face)
      {
        repeats(*p);
      }
    }
    return;
  }
  for (auto p = begin; p != end; ++p)
  {
    if (std::find(begin, p, *p) != p)
    {
      repeats(*p);
    }
  }
}

//------------------------------------------------------------------------------
void FoamCursor::compactFaces(
  Index pointCount, std::vector<Index>& offsets, std::vector<Index>& points)
{
  const auto most = static_cast<Index>(this->bytesLeft());
  // the complaint refers to a face, which is an entry of the first list
  const char* begin = this->place();
  offsets = this->labels("the start of a face", 0, most, most);
  const std::string ordered = "the starts of the faces do not ascend from 0";
  if (offsets.empty())
  {
    offsets = { 0 };
  }
  if (offsets.front() != 0 || !std::is_sorted(offsets.begin(), offsets.end()))
  {
    this->failAt(begin, ordered);
  }
  const FoamComplaint complaint = std::exchange(this->Complaint, FoamComplaint());
  this->skipSpace();
  const char* second = this->place();
  points = this->labels("a point of a face", 0, pointCount - 1, offsets.back());
  this->Complaint = complaint;
  if (static_cast<Index>(points.size()) != offsets.back())
  {
    this->failAt(second,
      "there are " + std::to_string(points.size()) + " points of faces; the faces need " +
        std::to_string(offsets.back()));
  }
  const auto faces = static_cast<Index>(offsets.size()) - 1;
  for (Index i = 0; i < faces; ++i)
  {
    pollInterruption(i);
    this->checkFace(i, offsets, points, second);
  }
}

//------------------------------------------------------------------------------
void FoamCursor::faces(Index pointCount, std::vector<Index>& offsets, std::vector<Index>& points)
{
  this->skipSpace();
  if (this->Header.type == "faceCompactList")
  {
    this->compactFaces(pointCount, offsets, points);
    return;
  }
  const Index entries = this->openList("faces");
  offsets = { 0 };
  if (entries > 0)
  {
    this->expectBytes(entries, LeastFace, "faces");
    reserveLarge(offsets, static_cast<std::size_t>(entries) + 1);
  }
  for (Index i = 0; entries < 0 ? !this->take(')') : i < entries; ++i)
  {
    this->countRecord();
    this->skipSpace();
    const char* begin = this->place();
    this->checkComplaint(i, begin);
    const Index corners = this->count("a face", pointCount);
    if (corners > 0)
    {
      this->expect('(', "the number of points of a face");
      if (this->Header.binary)
      {
        const FoamComplaint complaint = std::exchange(this->Complaint, FoamComplaint());
        this->Header.labelBytes == 8
          ? this->binaryLabels<std::int64_t>("point of a face", 0, pointCount - 1, corners, points)
          : this->binaryLabels<std::int32_t>("point of a face", 0, pointCount - 1, corners, points);
        this->Complaint = complaint;
      }
      for (Index k = 0; !this->Header.binary && k < corners; ++k)
      {
        points.push_back(this->label("a point of a face", 0, pointCount - 1));
      }
      if (!this->Header.binary)
      {
        this->expect(')', "the last point of a face");
      }
    }
    offsets.push_back(static_cast<Index>(points.size()));
    this->checkFace(i, offsets, points, begin);
  }
  if (entries > 0)
  {
    this->expect(')', "the last face its list announces");
  }
}
}
