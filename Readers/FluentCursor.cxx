// SPDX-License-Identifier: BSD-3-Clause
#include "FluentCursor.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr std::string_view BinaryEnd = "End of Binary Section";

bool isSpace(char c)
{
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}
}

//------------------------------------------------------------------------------
void FluentCursor::failIn(const char* place, const std::string& problem) const
{
  if (this->FirstBinary && place > this->FirstBinary) // lines have no meaning there
  {
    this->failAt(this->FirstBinary,
      "byte " + std::to_string(place - this->Start) +
        " of the file, which is binary from here on: " + problem);
  }
  this->failAt(place, problem);
}

//------------------------------------------------------------------------------
bool FluentCursor::skipSpace()
{
  const char* at = this->place();
  const char* const end = this->end();
  while (at < end && isSpace(*at))
  {
    ++at;
  }
  this->moveTo(at);
  return at < end;
}

//------------------------------------------------------------------------------
bool FluentCursor::take(char c)
{
  if (!this->skipSpace() || *this->place() != c)
  {
    return false;
  }
  this->moveTo(this->place() + 1);
  return true;
}

//------------------------------------------------------------------------------
void FluentCursor::expect(char c, const char* after)
{
  if (!this->take(c))
  {
    this->failHere(std::string("expected '") + c + "' after " + after +
      (this->atEnd() ? ", the file ends: it is truncated" : ""));
  }
}

//------------------------------------------------------------------------------
std::string FluentCursor::name()
{
  this->skipSpace();
  const char* const begin = this->place();
  const char* const found =
    std::find_if(begin, this->end(), [](char c) { return isSpace(c) || c == '(' || c == ')'; });
  this->moveTo(found);
  return { begin, found };
}

//------------------------------------------------------------------------------
Index FluentCursor::number(const char* what, int base)
{
  this->skipSpace();
  Index value = 0;
  const auto [end, error] = std::from_chars(this->place(), this->end(), value, base);
  const bool ends = end == this->end() || isSpace(*end) || *end == '(' || *end == ')';
  if (error != std::errc() || !ends)
  {
    this->failHere(std::string("expected a whole number (") + what + ")" +
      (this->atEnd() ? ", the file ends: it is truncated" : ""));
  }
  this->moveTo(end);
  return value;
}

//------------------------------------------------------------------------------
Index FluentCursor::decimal(const char* what)
{
  constexpr int base = 10;
  return this->number(what, base);
}

//------------------------------------------------------------------------------
Index FluentCursor::within(
  const char* place, const char* what, Index value, Index low, Index high) const
{
  if (value < low || value > high)
  {
    this->failIn(place,
      std::string(what) + " is " + std::to_string(value) + ", from " + std::to_string(low) +
        " to " + std::to_string(high) + " are allowed");
  }
  return value;
}

//------------------------------------------------------------------------------
Index FluentCursor::hex(const char* what, Index low, Index high)
{
  constexpr int base = 16;
  this->skipSpace();
  const char* const begin = this->place();
  return this->within(begin, what, this->number(what, base), low, high);
}

//------------------------------------------------------------------------------
Index FluentCursor::binaryWhole(const char* what, Index low, Index high)
{
  const char* const begin = this->place();
  return this->within(begin, what, this->binary<std::int32_t>(what), low, high);
}

//------------------------------------------------------------------------------
double FluentCursor::real(const FluentSection& section, const char* what)
{
  const char* begin = this->place();
  double value = 0.0;
  if (section.binary)
  {
    value = section.realBytes == sizeof(float) ? static_cast<double>(this->binary<float>(what))
                                               : this->binary<double>(what);
  }
  else
  {
    this->skipSpace();
    begin = this->place();
    const char* const digits = begin + (begin < this->end() && *begin == '+');
    const auto [end, error] = std::from_chars(digits, this->end(), value);
    if (error == std::errc::result_out_of_range) // too small becomes 0, too large infinite
    {
      value = std::strtod(std::string(digits, end).c_str(), nullptr);
    }
    else if (error != std::errc())
    {
      this->failHere(std::string("expected a number (") + what + ")" +
        (this->atEnd() ? ", the file ends: it is truncated" : ""));
    }
    this->moveTo(end);
  }
  if (!std::isfinite(value))
  {
    this->failIn(begin, std::string(what) + " is not a finite number");
  }
  return value;
}

//------------------------------------------------------------------------------
bool FluentCursor::nextSection(FluentSection& section)
{
  constexpr Index firstBinary = 1000, firstDouble = 3000;
  if (!this->skipSpace())
  {
    return false;
  }
  section.begin = this->place();
  if (!this->take('('))
  {
    this->failHere("expected '(', with which each section of a Fluent file begins");
  }
  section.index = this->decimal("the number of a section");
  section.binary = section.index >= firstBinary;
  section.kind = static_cast<int>(section.index % firstBinary);
  section.realBytes = section.index >= firstDouble ? sizeof(double) : sizeof(float);
  if (section.binary && !this->FirstBinary)
  {
    this->FirstBinary = section.begin;
  }
  return true;
}

//------------------------------------------------------------------------------
std::vector<Index> FluentCursor::header(const char* what, std::size_t fewest)
{
  constexpr Index most = std::numeric_limits<std::int32_t>::max();
  std::vector<Index> numbers;
  this->expect('(', what);
  while (!this->take(')'))
  {
    numbers.push_back(this->hex(what, 0, most));
  }
  if (numbers.size() < fewest)
  {
    this->failHere(std::string(what) + " has " + std::to_string(numbers.size()) + " numbers, " +
      std::to_string(fewest) + " are needed");
  }
  return numbers;
}

//------------------------------------------------------------------------------
void FluentCursor::closeSection(const FluentSection& section, const char* what)
{
  if (section.binary && this->skipSpace() && *this->place() != ')')
  {
    if (this->bytesLeft() < BinaryEnd.size() ||
      std::string_view(this->place(), BinaryEnd.size()) != BinaryEnd)
    {
      this->failHere(std::string("expected the end of a binary section after ") + what);
    }
    this->moveTo(this->place() + BinaryEnd.size());
    this->decimal("the number of a section");
  }
  this->expect(')', what);
}

//------------------------------------------------------------------------------
void FluentCursor::skipSection(const FluentSection& section)
{
  if (section.binary)
  {
    this->skipBinary(section);
  }
  else
  {
    this->skipText(section);
  }
}

//------------------------------------------------------------------------------
void FluentCursor::skipText(const FluentSection& section)
{
  const char* const end = this->end();
  int open = 1;
  bool quoted = false;
  for (const char* at = this->place(); at < end; ++at)
  {
    this->countRecord();
    if (quoted)
    {
      const bool escaped = *at == '\\';
      at += escaped ? 1 : 0;
      quoted = escaped || *at != '"';
    }
    else
    {
      quoted = *at == '"';
      open += *at == '(' ? 1 : *at == ')' ? -1 : 0;
    }
    if (open == 0)
    {
      this->moveTo(at + 1);
      return;
    }
  }
  this->failIn(section.begin,
    "section " + std::to_string(section.index) + " is not closed: the file is truncated");
}

//------------------------------------------------------------------------------
void FluentCursor::skipBinary(const FluentSection& section)
{
  const std::string_view rest(this->place(), this->bytesLeft());
  for (std::size_t at = rest.find(BinaryEnd); at != std::string_view::npos;
       at = rest.find(BinaryEnd, at + 1))
  {
    this->moveTo(rest.data() + at + BinaryEnd.size());
    if (this->skipSpace() && *this->place() >= '0' && *this->place() <= '9' &&
      this->decimal("the number of a section") == section.index && this->take(')'))
    {
      return;
    }
  }
  this->failIn(section.begin,
    "section " + std::to_string(section.index) + " has no end: the file is truncated");
}
}
