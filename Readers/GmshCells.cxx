// SPDX-License-Identifier: BSD-3-Clause
#include "GmshFile.h"

#include <algorithm>
#include <array>

namespace tautline
{
namespace
{
// Gmsh numbers the middle nodes of edges as its own list of edges goes, VTK by rings.
constexpr int Tetrahedron10[] = { 0, 1, 2, 3, 4, 5, 6, 7, 9, 8 };
constexpr int Hexahedron20[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14,
  15 };
constexpr int Hexahedron27[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14,
  15, 22, 23, 21, 24, 20, 25, 26 };
// VTK's wedge has 0 1 2 counter-clockwise seen from outside, Gmsh's from inside: 1 and 2 are
// exchanged.
constexpr int Wedge[] = { 0, 2, 1, 3, 5, 4 };
constexpr int Wedge15[] = { 0, 2, 1, 3, 5, 4, 7, 9, 6, 13, 14, 12, 8, 11, 10 };
constexpr int Wedge18[] = { 0, 2, 1, 3, 5, 4, 7, 9, 6, 13, 14, 12, 8, 11, 10, 16, 17, 15 };
constexpr int Pyramid13[] = { 0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12 };

constexpr std::array<GmshCell, 36> Cells = { {
  { 15, FileVertex, 1, nullptr },
  { 1, FileLine, 2, nullptr },
  { 2, FileTriangle, 3, nullptr },
  { 3, FileQuadrilateral, 4, nullptr },
  { 4, FileTetrahedron, 4, nullptr },
  { 5, FileHexahedron, 8, nullptr },
  { 6, FileWedge, 6, Wedge },
  { 7, FilePyramid, 5, nullptr },
  { 8, FileLine3, 3, nullptr },
  { 9, FileTriangle6, 6, nullptr },
  { 10, FileQuadrilateral9, 9, nullptr },
  { 11, FileTetrahedron10, 10, Tetrahedron10 },
  { 12, FileHexahedron27, 27, Hexahedron27 },
  { 13, FileWedge18, 18, Wedge18 },
  { 16, FileQuadrilateral8, 8, nullptr },
  { 17, FileHexahedron20, 20, Hexahedron20 },
  { 18, FileWedge15, 15, Wedge15 },
  { 19, FilePyramid13, 13, Pyramid13 },
  { 14, FilePyramid13, 14, Pyramid13 },
  // Third order, then fourth; corners come first.
  { 26, FileLine, 4, nullptr, true },
  { 20, FileTriangle, 9, nullptr, true },
  { 21, FileTriangle, 10, nullptr, true },
  { 36, FileQuadrilateral, 16, nullptr, true },
  { 39, FileQuadrilateral, 12, nullptr, true },
  { 29, FileTetrahedron, 20, nullptr, true },
  { 92, FileHexahedron, 64, nullptr, true },
  { 90, FileWedge, 40, Wedge, true },
  { 118, FilePyramid, 30, nullptr, true },
  { 27, FileLine, 5, nullptr, true },
  { 22, FileTriangle, 12, nullptr, true },
  { 23, FileTriangle, 15, nullptr, true },
  { 37, FileQuadrilateral, 25, nullptr, true },
  { 30, FileTetrahedron, 35, nullptr, true },
  { 93, FileHexahedron, 125, nullptr, true },
  { 91, FileWedge, 75, Wedge, true },
  { 119, FilePyramid, 55, nullptr, true },
} };
}

//------------------------------------------------------------------------------
const GmshCell* gmshCellByCode(Index code)
{
  const auto found =
    std::find_if(Cells.begin(), Cells.end(), [code](const GmshCell& c) { return c.code == code; });
  return found == Cells.end() ? nullptr : &*found;
}

//------------------------------------------------------------------------------
const GmshCell* gmshCellByType(unsigned char type)
{
  const auto found =
    std::find_if(Cells.begin(), Cells.end(), [type](const GmshCell& c) { return c.type == type; });
  return found == Cells.end() ? nullptr : &*found;
}

//------------------------------------------------------------------------------
void GmshTags::assign(std::vector<Index> tags)
{
  *this = GmshTags();
  if (tags.empty())
  {
    return;
  }
  const auto [low, high] = std::minmax_element(tags.begin(), tags.end());
  const auto count = static_cast<Index>(tags.size());
  this->Low = *low;
  // the difference of two tags may not fit a signed number
  const auto range = static_cast<std::uint64_t>(*high) - static_cast<std::uint64_t>(*low);
  if (range < static_cast<std::uint64_t>(4 * count + 1024))
  {
    this->Dense.assign(static_cast<std::size_t>(range) + 1, -1);
  }
  for (Index i = 0; i < count; ++i)
  {
    const Index tag = tags[static_cast<std::size_t>(i)];
    if (this->find(tag) >= 0)
    {
      this->Duplicate = i;
    }
    if (this->Dense.empty())
    {
      this->Sparse.emplace(tag, i);
    }
    else
    {
      this->Dense[static_cast<std::size_t>(tag - this->Low)] = i;
    }
  }
}

//------------------------------------------------------------------------------
Index GmshTags::find(Index tag) const
{
  if (this->Dense.empty())
  {
    const auto found = this->Sparse.find(tag);
    return found == this->Sparse.end() ? -1 : found->second;
  }
  const auto place = static_cast<std::uint64_t>(tag) - static_cast<std::uint64_t>(this->Low);
  return tag < this->Low || place >= this->Dense.size() ? -1 : this->Dense[place];
}

//------------------------------------------------------------------------------
void GmshInput::addElement(const GmshCell& cell, const Index* tags, const char* place)
{
  std::array<Index, 32> ids;
  const int size = cellNodes(cell.type);
  for (int i = 0; i < size; ++i)
  {
    const Index tag = tags[cell.order ? cell.order[i] : i];
    ids[static_cast<std::size_t>(i)] = this->nodes.find(tag);
    if (ids[static_cast<std::size_t>(i)] < 0)
    {
      this->cursor.failAt(
        place, "an element uses node " + std::to_string(tag) + ", which is not in $Nodes");
    }
  }
  this->mesh.addCell(cell.type, ids.data(), size);
  if (!cell.onlyCorners)
  {
    return;
  }
  ++this->elementsOfHighOrder;
  this->inner.resize(static_cast<std::size_t>(this->mesh.numberOfPoints()), 0);
  for (int i = size; i < cell.nodes; ++i)
  {
    if (const Index point = this->nodes.find(tags[i]); point >= 0)
    {
      this->inner[static_cast<std::size_t>(point)] = 1;
    }
  }
}

//------------------------------------------------------------------------------
void GmshInput::reserveElements(std::size_t count)
{
  reserveLarge(this->mesh.connectivity, 4 * count);
  reserveLarge(this->mesh.offsets, count + 1);
  reserveLarge(this->mesh.cellTypes, count);
  reserveLarge(this->elementTags, count);
  reserveLarge(this->references, count);
  reserveLarge(this->entities, count);
}

//------------------------------------------------------------------------------
void GmshInput::setNodes(std::vector<Index> tags)
{
  this->nodes.assign(tags);
  if (this->nodes.duplicate() >= 0)
  {
    this->cursor.fail("node number " +
      std::to_string(tags[static_cast<std::size_t>(this->nodes.duplicate())]) + " is given twice");
  }
}
}
