// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GmshFile.h
 * @brief Gmsh's .msh 1, 2, 4.0 and 4.1, text and binary, and FreeFem++'s .msh, which has the same
 * ending.
 *
 * Points keep the order of the file, numbers with gaps are closed. Elements up to second order are
 * read; of a 14-node pyramid the node in its base is left out. Elements of third and fourth order
 * are read as linear ones, without the nodes that are no corners, with a warning. `Reference` is
 * the physical tag (the first, where an entity has several), `Entity` the elementary one. $NodeData
 * and $ElementData become arrays (NaN where a node or element has no value), of several steps the
 * last one. Names of physical groups become the field arrays `PhysicalNames` and `PhysicalGroups`
 * (dimension, tag). A file that gives no dimension of a group: that of its elements; of no element,
 * 3.
 */
#ifndef tautline_GmshFile_h
#define tautline_GmshFile_h

#include "MeshFile.h"
#include "TextCursor.h"

#include <limits>
#include <unordered_map>

namespace tautline
{
/// Of the numbers and counts in a file.
constexpr Index LargestGmshNumber = std::numeric_limits<Index>::max();

class FileRanges;
struct MeshShare;

TAUTLINEREADERS_EXPORT MeshFile readGmsh(const std::string& name, bool lowerCells);

/**
 * @brief A rank's share of what readGmsh() reads of text of versions 2 to 4.1. Collective; throws
 * UnusualFile on all ranks for small files, binary files, version 1 and FreeFem++'s files, elements
 * of third and fourth order, names of groups without their dimension, text without a record per
 * line, and all errors.
 *
 * Numbers of nodes and elements that are not consecutive are looked up on the ranks among which
 * they are divided.
 */
TAUTLINEREADERS_EXPORT MeshShare shareGmsh(
  const FileRanges& ranges, const std::string& name, bool lowerCells);

/// Writes version 4.1, text or binary.
TAUTLINEREADERS_EXPORT std::vector<std::string> writeGmsh(
  const MeshFile& mesh, const std::string& name, bool binary);

/**
 * @brief Writes every array as a view of Gmsh's .pos, as text.
 *
 * An element has the values of its corners, or its own at each of them; one with a value that is
 * not finite is left out of the view. Arrays of 1, 3 and 9 components are a view each, of others
 * each component, NAME_0 and so on. Throws FileError if there is no array.
 *
 * @param warnings if given, gets a sentence for each view without all elements: how many are left
 * out, and which is the first
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeGmshViews(
  const MeshFile& mesh, const std::string& name, std::vector<std::string>* warnings = nullptr);

/// FreeFem++'s "points triangles edges" files in 2D and "points tetrahedra triangles" files in 3D.
MeshFile readFreeFem(const FileContent& file);

/// One of Gmsh's element types.
struct GmshCell
{
  int code;
  unsigned char type; ///< VTK's
  int nodes;          ///< in Gmsh; more than VTK's where one is left out
  /// Node i of VTK's cell is node order[i] of Gmsh's; null where they are the same.
  const int* order;
  bool onlyCorners = false; ///< of an element of higher order: the nodes after them are left out
};

/// Nodes of an element of Gmsh, at most.
constexpr int MaxGmshNodes = 128;

/// Null for an unknown code or type.
const GmshCell* gmshCellByCode(Index code);
const GmshCell* gmshCellByType(unsigned char type);

/// Numbers of nodes or elements to positions.
class GmshTags
{
public:
  /// Takes the number of a position one after the other; false if it was there before.
  void assign(std::vector<Index> tags);
  /// -1 for an unknown one.
  Index find(Index tag) const;
  /// Position of a number used twice, or -1.
  Index duplicate() const { return this->Duplicate; }

private:
  Index Low = 0;
  Index Duplicate = -1;
  std::vector<Index> Dense;
  std::unordered_map<Index, Index> Sparse;
};

/// What both versions of a file are read with.
struct GmshInput
{
  TextCursor cursor;
  bool binary = false;
  MeshFile mesh;
  GmshTags nodes;
  std::vector<Index> elementTags;
  std::vector<Index> references, entities;
  std::size_t dataBudget = 0; ///< bytes that $NodeData and $ElementData may still take
  double version = 0.0;
  Index elementsOfHighOrder = 0;
  std::vector<unsigned char> inner; ///< per point: a node of such an element, but no corner
  bool keepsTags = false;           ///< whether cells have numbers of nodes as they are in the file

  Index integer(const char* what, Index low, Index high); ///< text: in any line
  double coordinate(const char* what);
  std::size_t bytesPerInteger(std::size_t inBinary) const { return this->binary ? inBinary : 2; }
  /// Adds an element; `tags` are those of its nodes in Gmsh's order.
  void addElement(const GmshCell& cell, const Index* tags, const char* place);
  void setNodes(std::vector<Index> tags);
  /// Room for elements of about four nodes.
  void reserveElements(std::size_t count);
};

/// The tag of the physical group that an entity is in, per dimension.
using GmshPhysical = std::vector<std::unordered_map<Index, Index>>;

/// A physical group whose dimension a file does not give.
constexpr Index UnknownGmshDimension = -1;

/// The sections, from the line after their names on. A count is the first thing in some of them.
double readGmshFormat(GmshInput& input);
void readGmshPhysicalNames(GmshInput& input);
void readGmshNodes2(GmshInput& input);
void readGmshElements2(GmshInput& input);
Index readGmshCount2(GmshInput& input, const char* what);
/// As many nodes; numbers are appended.
void readGmshNodeRecords2(GmshInput& input, Index count, std::vector<Index>& tags);
void readGmshElementRecords2(GmshInput& input, Index count);
/// $ELM of version 1.
void readGmshElements1(GmshInput& input);

/// What $NodeData and $ElementData begin with.
struct GmshDataHeader
{
  std::string name;
  Index components = 0, count = 0;
  const char* place = nullptr; ///< for messages
};
GmshDataHeader readGmshDataHeader(GmshInput& input);
/// An array without values; takes its bytes from the budget, or fails.
MeshArray makeGmshData(GmshInput& input, const GmshDataHeader& header, Index tuples);
/// The number of a node or element, then its values.
Index readGmshDataNumber(GmshInput& input);
void readGmshDataValues(GmshInput& input, Index components, double* values);
/// Adds the array, instead of one of the same name.
void setGmshData(std::vector<MeshArray>& arrays, MeshArray array);

void readGmshEntities4(GmshInput& input, GmshPhysical& physical);
void readGmshNodes4(GmshInput& input);
void readGmshElements4(GmshInput& input, const GmshPhysical& physical);

/// What $Nodes and $Elements of version 4 begin with.
struct GmshHeader4
{
  Index blocks, count;
};
GmshHeader4 readGmshHeader4(GmshInput& input, bool nodes);
/// What a block of nodes or elements begins with.
struct GmshBlock4
{
  Index dimension, entity;
  Index kind; ///< of nodes 1 if they have parameters, of elements their type
  Index size; ///< nodes or elements
};
GmshBlock4 readGmshBlock4(GmshInput& input, bool nodes);
/// Whether a block has all numbers of nodes first, rather than each before its coordinates.
bool gmshNumbersAreApart(const GmshInput& input);
void readGmshNodeNumbers4(GmshInput& input, Index count, std::vector<Index>& tags);
/// Also reads the numbers where they are not apart.
void readGmshNodePoints4(
  GmshInput& input, const GmshBlock4& block, Index count, std::vector<Index>& tags);
void readGmshElementRecords4(
  GmshInput& input, const GmshBlock4& block, Index count, const GmshPhysical& physical);
}
#endif
