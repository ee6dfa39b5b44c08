// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GmshFile.h
 * @brief Reads and writes Gmsh's .msh 1, 2, 4.0 and 4.1, text and binary, and reads FreeFem++'s
 * .msh, which has the same extension.
 *
 * Points keep the order of the file, and gaps in the numbering are closed. Complete elements of
 * orders 1 to 4 and incomplete elements of second order (8, 13, 15 and 20 nodes) become VTK's
 * linear, quadratic and, for orders 3 and 4, Lagrange cells. The base node of a 14-node pyramid is
 * left out, with a warning. Incomplete elements of order 3 and 4, pyramids of these orders, and
 * elements of order 5 and higher are an error with the remedy. `Reference` is the physical tag (the
 * first, if an entity has several), `Entity` the elementary tag. $NodeData and $ElementData become
 * arrays (NaN where a node or element has no value), using the last of several steps. Names of
 * physical groups become the field arrays `PhysicalNames` and `PhysicalGroups` (dimension, tag). If
 * the file gives no dimension of a group, the dimension of its elements is used, or 3 if it has
 * none.
 */
#ifndef tautline_GmshFile_h
#define tautline_GmshFile_h

#include "MeshFile.h"
#include "TextCursor.h"

#include <limits>
#include <unordered_map>

namespace tautline
{
/// The upper bound on numbers and counts in a file.
constexpr Index LargestGmshNumber = std::numeric_limits<Index>::max();

TAUTLINEREADERS_EXPORT MeshFile readGmsh(const std::string& name, bool lowerCells);

/// Writes version 4.1, text or binary.
TAUTLINEREADERS_EXPORT std::vector<std::string> writeGmsh(
  const MeshFile& mesh, const std::string& name, bool binary);

/**
 * @brief Writes every array as a view of Gmsh's .pos format, as text.
 *
 * An element has the values at its corners, or its own value at each of them; elements with a value
 * that is not finite are left out of the view. Each array of 1, 3 or 9 components is a view; other
 * arrays have one view per component, NAME_0 and so on. Throws FileError if there is no array.
 *
 * @param warnings if given, receives a sentence for each view that lacks elements, with their
 * number and the first one
 */
TAUTLINEREADERS_EXPORT std::vector<std::string> writeGmshViews(
  const MeshFile& mesh, const std::string& name, std::vector<std::string>* warnings = nullptr);

/// Reads FreeFem++'s "points triangles edges" files in 2D and "points tetrahedra triangles" files
/// in 3D.
MeshFile readFreeFem(const FileContent& file);

/// One of Gmsh's element types.
struct GmshCell
{
  int code;
  unsigned char type; ///< VTK's type
  int nodes;          ///< in Gmsh; one more than in VTK if one is left out
  /// Node i of VTK's cell is node order[i] of Gmsh's; empty if the orders agree.
  std::vector<int> order;
};

/// Maximum number of nodes of a Gmsh element.
constexpr int MaxGmshNodes = 128;

/// The cell for elements with a code; null for an unknown code.
const GmshCell* gmshCellByCode(Index code);
/// The Gmsh element for a cell; null if Gmsh does not have it.
const GmshCell* gmshCellByType(unsigned char type, Index nodes);
/// The reason why elements of an unknown code are not supported, and the remedy.
std::string gmshRefusal(Index code);

/// Maps numbers of nodes or elements to positions.
class GmshTags
{
public:
  /// Assigns the numbers to consecutive positions.
  void assign(std::vector<Index> tags);
  /// The position of a number; -1 for an unknown one.
  Index find(Index tag) const;
  /// Position of a number used twice, or -1.
  Index duplicate() const { return this->Duplicate; }

private:
  Index Low = 0;
  Index Duplicate = -1;
  std::vector<Index> Dense;
  std::unordered_map<Index, Index> Sparse;
};

/// The common input of the readers of both format versions.
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
  /// Adds an element; `tags` are the tags of its nodes in Gmsh's order.
  void addElement(const GmshCell& cell, const Index* tags, const char* place);
  void setNodes(std::vector<Index> tags);
  /// Reserves memory for elements of about four nodes.
  void reserveElements(std::size_t count);
};

/// The tag of the physical group of an entity, per dimension.
using GmshPhysical = std::vector<std::unordered_map<Index, Index>>;

void readGmshNodes2(GmshInput& input, bool parametric);
void readGmshElements2(GmshInput& input);
/// Reads $ELM of version 1.
void readGmshElements1(GmshInput& input);
void readGmshEntities4(GmshInput& input, GmshPhysical& physical);
void readGmshNodes4(GmshInput& input);
void readGmshElements4(GmshInput& input, const GmshPhysical& physical);
}
#endif
