// SPDX-License-Identifier: BSD-3-Clause
#include "AbaqusFile.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>

namespace tautline
{
namespace
{
// In Abaqus's wedge the normal of nodes 1 2 3 points inward, in VTK's outward; the midside nodes of
// the edges are in the order bottom, top, vertical in both.
constexpr int AbaqusWedge[] = { 0, 2, 1, 3, 5, 4 };
constexpr int AbaqusWedge15[] = { 0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13 };
// node 21 is the center, 22 to 27 are on the faces
constexpr int AbaqusHexahedron27[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17,
  18, 19, 26, 24, 23, 25, 21, 22, 20 };
constexpr int AbaqusLine3[] = { 0, 2, 1 }; // the second node is the middle node

struct ElementRow
{
  int nodes;
  unsigned char type;
  const int* order;
};

constexpr ElementRow SolidRows[] = { { 4, FileTetrahedron, nullptr }, { 5, FilePyramid, nullptr },
  { 6, FileWedge, AbaqusWedge }, { 8, FileHexahedron, nullptr }, { 10, FileTetrahedron10, nullptr },
  { 13, FilePyramid13, nullptr }, { 15, FileWedge15, AbaqusWedge15 },
  { 20, FileHexahedron20, nullptr }, { 27, FileHexahedron27, AbaqusHexahedron27 } };
constexpr ElementRow SurfaceRows[] = { { 3, FileTriangle, nullptr },
  { 4, FileQuadrilateral, nullptr }, { 6, FileTriangle6, nullptr },
  { 8, FileQuadrilateral8, nullptr }, { 9, FileQuadrilateral9, nullptr } };
constexpr ElementRow LineRows[] = { { 2, FileLine, nullptr }, { 3, FileLine3, AbaqusLine3 } };

// Families, whose names are followed by the number of nodes and letters (C3D8R, S8R5).
constexpr const char* SolidFamilies[] = { "C3D", "CC3D", "DC3D", "DCC3D", "AC3D", "F3D", "EC3D",
  "PC3D", "Q3D", "SC", "CSS", "COH3D", "EMC3D" };
constexpr const char* SurfaceFamilies[] = { "CPS", "CPE", "CPEG", "CAX", "CGAX", "CAXA", "S", "DS",
  "STRI", "M3D", "R3D", "SFM3D", "DC2D", "DCC2D", "DCAX", "DCCAX", "AC2D", "ACAX", "EMC2D", "F2D" };
constexpr const char* LineFamilies[] = { "T2D", "T3D", "DC1D", "DCC1D", "AC1D", "R2D", "RAX" };
/// The number is the order, not the number of nodes.
constexpr const char* OrderFamilies[] = { "SAX", "DSAX", "MAX", "SFMAX" };
constexpr const char* BeamFamilies[] = { "B", "PIPE", "ELBOW", "FRAME" };
/// Elements without a volume, area or length, by the beginnings of their names.
constexpr const char* SizelessElements[] = { "MASS", "ROTARY", "SPRING", "DASHPOT", "CONN", "GAP",
  "ITS", "JOINT", "DCOUP", "HEATCAP", "ISL", "ITT", "IRS", "DGAP", "PSI", "LS", "FRIC" };

template <std::size_t N>
bool isOneOf(const char* const (&names)[N], std::string_view name)
{
  return std::any_of(
    std::begin(names), std::end(names), [&](const char* each) { return name == each; });
}

template <std::size_t N>
AbaqusElement withNodes(const ElementRow (&rows)[N], int nodes)
{
  const ElementRow* row = std::find_if(std::begin(rows), std::end(rows),
    [nodes](const ElementRow& each) { return each.nodes == nodes; });
  return row == std::end(rows) ? AbaqusElement{}
                               : AbaqusElement{ AbaqusElement::Cell, row->type, row->order };
}

bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}

/// B31, PIPE22: dimension of the space, then 1 (linear), 2 (quadratic) or 3 (cubic, two nodes).
AbaqusElement beamElement(std::string_view digits)
{
  if (digits.size() != 2 || (digits[0] != '2' && digits[0] != '3'))
  {
    return {};
  }
  return digits[1] == '1' || digits[1] == '3' ? withNodes(LineRows, 2)
    : digits[1] == '2'                        ? withNodes(LineRows, 3)
                                              : AbaqusElement{};
}
}

//------------------------------------------------------------------------------
AbaqusElement abaqusElement(std::string_view name)
{
  if (name == "STRI65")
  {
    return withNodes(SurfaceRows, 6);
  }
  // the family ends where the number of nodes begins, which is the last run of digits before
  // letters at the end: C3D8R, S8R5
  std::size_t end = name.size();
  const std::size_t five = name.size() > 2 && name.substr(name.size() - 2) == "R5" ? 2 : 0;
  end -= five;
  while (end > 0 && !isDigit(name[end - 1]))
  {
    --end;
  }
  std::size_t begin = end;
  while (begin > 0 && isDigit(name[begin - 1]))
  {
    --begin;
  }
  const std::string_view family = name.substr(0, begin), digits = name.substr(begin, end - begin);
  if (!digits.empty() && digits.size() <= 2)
  {
    const int nodes = std::stoi(std::string(digits));
    const AbaqusElement found = isOneOf(SolidFamilies, family) ? withNodes(SolidRows, nodes)
      : isOneOf(SurfaceFamilies, family)                       ? withNodes(SurfaceRows, nodes)
      : isOneOf(LineFamilies, family)                          ? withNodes(LineRows, nodes)
      : isOneOf(OrderFamilies, family)                         ? withNodes(LineRows, nodes + 1)
      : isOneOf(BeamFamilies, family)                          ? beamElement(digits)
                                                               : AbaqusElement{};
    if (found.kind == AbaqusElement::Cell)
    {
      return found;
    }
  }
  const bool other = std::any_of(std::begin(SizelessElements), std::end(SizelessElements),
    [&](const char* each)
    {
      const std::string_view start(each);
      return name == start || (start.size() > 2 && name.substr(0, start.size()) == start);
    });
  return other ? AbaqusElement{ AbaqusElement::NoCell, 0, nullptr } : AbaqusElement{};
}
}
