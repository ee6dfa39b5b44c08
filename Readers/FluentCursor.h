// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FluentCursor.h
 * @brief A position in a Fluent file: nested parentheses, hexadecimal numbers, binary sections.
 * Internal: not installed.
 */
#ifndef tautline_FluentCursor_h
#define tautline_FluentCursor_h

#include "TextCursor.h"

namespace tautline
{
/// The beginning of a section: its number, and the properties that follow from its number type.
struct FluentSection
{
  const char* begin = nullptr;
  Index index = 0;           ///< as in the file: 10, 2010, 3010
  int kind = 0;              ///< the last three digits: 10
  bool binary = false;       ///< 2010, 3010
  std::size_t realBytes = 8; ///< 4 for 2010
};

class FluentCursor : public TextCursor
{
public:
  explicit FluentCursor(const FileContent& file)
    : TextCursor(file)
  {
  }

  /// Moves to the next character that is not a space; false at the end of the file.
  bool skipSpace();
  /// Moves past a character if it is the next one that is not a space.
  bool take(char c);
  /// The same, but throws if it is a different character.
  void expect(char c, const char* after);
  /// Text up to a space or parenthesis.
  std::string name();

  /// Starts the next section; false at the end of the file.
  bool nextSection(FluentSection& section);
  /// Hexadecimal numbers between parentheses, at least `fewest`.
  std::vector<Index> header(const char* what, std::size_t fewest);
  /// Starts the body after a header; false if there is none.
  bool openBody() { return this->take('('); }
  /// Ends the body, and the section.
  void closeBody(const FluentSection& section, const char* what)
  {
    this->expect(')', what);
    this->closeSection(section, what);
  }
  void closeSection(const FluentSection& section, const char* what);
  /// Ends a section, skipping the rest of it.
  void skipSection(const FluentSection& section);

  /// An integer within [low, high] in the body: hexadecimal text, or 4 bytes.
  Index whole(const FluentSection& section, const char* what, Index low, Index high)
  {
    return section.binary ? this->binaryWhole(what, low, high) : this->hex(what, low, high);
  }
  /// A finite coordinate in the body.
  double real(const FluentSection& section, const char* what);
  Index decimal(const char* what);

  /// Throws with the line, or, after the first binary section, with the byte.
  [[noreturn]] void failHere(const std::string& problem) const
  {
    this->failIn(this->place(), problem);
  }
  [[noreturn]] void failIn(const char* place, const std::string& problem) const;

private:
  const char* end() const { return this->place() + this->bytesLeft(); }
  Index number(const char* what, int base);
  Index hex(const char* what, Index low, Index high);
  Index binaryWhole(const char* what, Index low, Index high);
  Index within(const char* place, const char* what, Index value, Index low, Index high) const;
  void skipText(const FluentSection& section);
  void skipBinary(const FluentSection& section);

  const char* Start = this->place();
  const char* FirstBinary = nullptr;
};
}
#endif
