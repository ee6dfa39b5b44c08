// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GmshFile.h
 * @brief Gmsh's .msh 1, 2, 4.0 and 4.1, text and binary, and FreeFem++'s .msh, which has the same
 * ending.
 *
 * Points keep the order of the file, numbers with gaps are closed. Complete elements of orders 1 to
 * 4 and the incomplete ones of second order (8, 13, 15 and 20 nodes) become VTK's cells: linear,
 * quadratic, of order 3 and 4 Lagrange cells. Of a 14-node pyramid the node in its base is left
 * out, with a warning. Refused by name, with the remedy: incomplete elements of order 3 and 4,
 * pyramids of these orders, and elements of order 5 and more. `Reference` is the physical tag (the
 * first, where an entity has several), `Entity` the elementary one. $NodeData
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

TAUTLINEREADERS_EXPORT MeshFile readGmsh(const std::string& name, bool lowerCells);

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
  int nodes;          ///< in Gmsh; one more than VTK's where it is left out
  /// Node i of VTK's cell is node order[i] of Gmsh's; empty where they are the same.
  std::vector<int> order;
};

/// Nodes of an element of Gmsh, at most.
constexpr int MaxGmshNodes = 128;

/// The cell that elements of a code are read as; null for an unknown code.
const GmshCell* gmshCellByCode(Index code);
/// Null for a cell that Gmsh does not have.
const GmshCell* gmshCellByType(unsigned char type, Index nodes);
/// Why elements of an unknown code are not read, and the remedy.
std::string gmshRefusal(Index code);

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
  Index basesLeftOut = 0; ///< pyramids of 14 nodes

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

void readGmshNodes2(GmshInput& input, bool parametric);
void readGmshElements2(GmshInput& input);
/// $ELM of version 1.
void readGmshElements1(GmshInput& input);
void readGmshEntities4(GmshInput& input, GmshPhysical& physical);
void readGmshNodes4(GmshInput& input);
void readGmshElements4(GmshInput& input, const GmshPhysical& physical);
}
#endif
