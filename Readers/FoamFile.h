// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamFile.h
 * @brief One file of an OpenFOAM mesh: its header, lists of labels, faces and points, dictionaries.
 * Internal: not installed.
 *
 * Files are text or binary, with labels and scalars of 4 or 8 bytes in either byte order, plain or
 * compressed with gzip (`points.gz`; a plain file is preferred, as in OpenFOAM). Lists are written
 * as `n(...)`, `n{value}` or `(...)`. Comments are skipped. Directives (`#include`) and macros
 * (`$name`), which OpenFOAM evaluates, are not supported.
 *
 * A count in a file is not used before the file is known to have the required number of bytes.
 * Errors are FileError: "file:line: problem", in binary lists "file: byte 123: problem".
 */
#ifndef tautline_FoamFile_h
#define tautline_FoamFile_h

#include "TextCursor.h"

namespace tautline
{
/// The contents of the dictionary FoamFile at the beginning of a file.
struct FoamHeader
{
  std::string type; ///< the class: vectorField, faceList, faceCompactList, ...
  bool binary = false;
  bool swapped = false; ///< numbers are in the opposite byte order
  int labelBytes = 4;   ///< 4 or 8
  int scalarBytes = 8;
};

/// An error in an entry of a list that is detected after the list was read.
struct FoamComplaint
{
  Index entry = -1; ///< from 0; -1 for none
  std::string problem;
};

/// The name of a file or, if only the compressed file exists, the name of that.
std::string foamFileName(const std::string& name);
/// Whether a file of this name exists, plain or compressed.
bool foamFileExists(const std::string& name);

/// The content of a file, which may be compressed.
struct FoamContent
{
  /// Throws FileError; `why` is the purpose.
  explicit FoamContent(const std::string& name, const std::string& why = std::string());

  FileContent packed; ///< as it is on the disk
  FileContent file;   ///< expanded, if it is compressed; otherwise empty
  bool compressed;
  const FileContent& text() const { return this->compressed ? this->file : this->packed; }
};

/// A position in a file, after its header.
class FoamCursor : public TextCursor
{
public:
  /// Reads the header. With a complaint, the list fails at the entry concerned.
  explicit FoamCursor(const FileContent& file, FoamComplaint complaint = FoamComplaint());

  const FoamHeader& header() const { return this->Header; }

  /// Moves to the next token, across line ends and comments; false at the end of the file.
  bool skipSpace();
  /// Moves past a character if it is the next token.
  bool take(char c);
  /// The same, but throws if it is a different character.
  void expect(char c, const char* after);
  /// A word, or the text of a quoted string; directives and macros throw.
  std::string token(const char* what);
  Index label(const char* what, Index low, Index high);
  double scalar(const char* what);
  /// Throws if anything other than comments follows.
  void expectEnd(const char* list);

  /// A list of labels within [low, high], of at most `most` entries.
  std::vector<Index> labels(const char* what, Index low, Index high, Index most);
  /// The points of a vectorField, which are finite.
  std::vector<double> points();
  /// A faceList or faceCompactList: the points of face i start at offsets[i]. Faces have at least
  /// three points, all different and below `pointCount`.
  void faces(Index pointCount, std::vector<Index>& offsets, std::vector<Index>& points);

  /// Calls entry(name) for each dictionary `name { ... }` of a list, after its brace.
  template <class Entry>
  void dictionaries(const char* what, const Entry& entry)
  {
    const Index count = this->openList(what);
    Index found = 0;
    for (; count < 0 ? !this->take(')') : found < count; ++found)
    {
      const std::string name = this->token("the name of an entry");
      this->expect('{', name.c_str());
      entry(name);
    }
    if (count > 0)
    {
      this->expect(')', "the last entry");
    }
  }
  /// The next keyword of a dictionary; empty at its end.
  std::string keyword();
  /// The first token of the value of a keyword; the rest is skipped.
  std::string value(const char* keyword);
  /// An integer value.
  Index labelValue(const char* keyword, Index low, Index high);
  /// Skips a value or a dictionary.
  void skipValue();
  /// A value that is a list of labels, with or without the word List<label> before it.
  std::vector<Index> labelsValue(const char* keyword, Index low, Index high, Index most);

  /// The layout of the rest of a binary or text list of points, for the writer of points.
  struct Places
  {
    Index count = 0;
    const char* first = nullptr; ///< of the first coordinate, in binary files
  };
  /// Reads the beginning of a list of points, which must have the form n(...) or (...). In text
  /// files the cursor is then after the parenthesis.
  Places openPoints();
  /// The coordinate at the current position, in text; moves past it.
  double coordinate();
  void openVector() { this->expect('(', "the list of points"); }
  void closeVector() { this->expect(')', "a point"); }

private:
  const char* end() const { return this->place() + this->bytesLeft(); }
  void readHeader();
  /// Reads the count of a list and its parenthesis; -1 if it begins without a count.
  Index openList(const char* what);
  Index count(const char* what, Index most);
  void expectBytes(Index entries, std::size_t bytes, const char* what) const;
  void skipList(const std::string& type);
  [[noreturn]] void failToken(const char* expected, const char* what);
  [[noreturn]] void failByte(const char* place, const std::string& problem) const;
  void checkComplaint(Index entry, const char* place) const;
  template <class T>
  void binaryLabels(
    const char* what, Index low, Index high, Index entries, std::vector<Index>& values);
  template <class T>
  void binaryScalars(const char* what, Index entries, std::vector<double>& values);
  void checkFace(Index face, const std::vector<Index>& offsets, const std::vector<Index>& points,
    const char* place);
  void compactFaces(Index pointCount, std::vector<Index>& offsets, std::vector<Index>& points);

  const FileContent& File;
  FoamHeader Header;
  FoamComplaint Complaint;
  std::vector<Index> LastFace; ///< for each point, for faces with many points
};
}
#endif
