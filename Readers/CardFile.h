// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CardFile.h
 * @brief Common parts of the readers of Abaqus and Nastran files: lines, included files, cells by
 * node number.
 */
#ifndef tautline_CardFile_h
#define tautline_CardFile_h

#include "MeshFile.h"
#include "TextCursor.h"

#include <deque>
#include <limits>
#include <string_view>
#include <unordered_map>

namespace tautline
{
constexpr Index LargestCardNumber = std::numeric_limits<Index>::max();
constexpr double CardDegree = 0.017453292519943295; ///< in radians

/// A line of a file, for messages.
struct CardPlace
{
  const TextCursor* cursor = nullptr;
  const char* at = nullptr;
  [[noreturn]] void fail(const std::string& problem) const { this->cursor->failAt(at, problem); }
};

/// A file and all included files; stays in memory for messages.
class CardText
{
public:
  /// A file and the position in it.
  struct Source
  {
    Source(const std::string& name, const std::string& why)
      : content(name, why)
      , cursor(content)
    {
    }
    FileContent content;
    TextCursor cursor;
  };

  explicit CardText(const std::string& name);
  /// The next line, without its end; false at the end of the last file.
  bool next(std::string_view& line);
  /// The position of the last line from next().
  CardPlace place() const { return this->Last; }
  /// Makes next() return the same line again.
  void putBack() { this->Again = true; }
  /// Continues with another file, whose name is relative to the first one, and then with this one.
  /// Fails if the other file cannot be read or is already being read.
  void include(const std::string& name);
  [[noreturn]] void fail(const std::string& problem) const { this->Last.fail(problem); }

private:
  std::string Folder;
  std::deque<Source> Sources; ///< all opened files
  std::vector<Source*> Open;
  CardPlace Last;
  std::string_view Line;
  bool Again = false;
};

/// The text without leading and trailing blanks.
std::string_view trimmed(std::string_view text);
/// The text in uppercase.
std::string upperCase(std::string_view text);
/// The parts between commas, trimmed.
std::vector<std::string_view> splitAtCommas(std::string_view line);

/// Cells whose nodes are given by numbers, which may come later in the file.
struct NumberedCells
{
  std::vector<unsigned char> types;
  std::vector<Index> numbers; ///< the numbers of the cells
  std::vector<Index> offsets = { 0 };
  std::vector<Index> nodes; ///< their numbers, in VTK's order
  std::vector<CardPlace> places;

  /// `order[i]` is the position of node i of VTK's cell in the file's cell; null if both orders
  /// agree.
  void add(
    unsigned char type, Index number, const Index* fileNodes, const int* order, CardPlace place);
};

/// Nodes by number, with their coordinates.
struct NumberedNodes
{
  std::unordered_map<Index, Index> positions;
  std::vector<Index> numbers;
  std::vector<double> coordinates;

  /// Fails if the number was used before with other coordinates.
  void add(Index number, const double* point, CardPlace place);
  /// The position of a number; fails for an unknown one.
  Index find(Index number, CardPlace place) const;
};

/// Appends cells; node i of `nodes` is the point firstPoint + i of the mesh.
void appendCells(
  MeshFile& mesh, const NumberedCells& cells, const NumberedNodes& nodes, Index firstPoint);
}
#endif
