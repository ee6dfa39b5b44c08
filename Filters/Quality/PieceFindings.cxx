// SPDX-License-Identifier: BSD-3-Clause
#include "PieceFindings.h"

#include "PointMerge.h"

#include <algorithm>

namespace tautline
{
namespace
{
void add(std::string& text, const std::string& sentence)
{
  text += (text.empty() || sentence.empty() ? "" : " ") + sentence;
}

/// A position without the point number, which is local to its piece.
std::string withoutNumber(const std::string& place)
{
  const std::size_t at = place.find(" at ");
  return at == std::string::npos ? place : "the point" + place.substr(at + 3);
}

/// The findings of all pieces of this rank.
PieceFindings joined(const std::vector<PieceFindings>& pieces)
{
  PieceFindings all;
  const auto first = [](std::string& text, const std::string& other)
  { text = text.empty() ? other : text; };
  for (const PieceFindings& one : pieces)
  {
    all.dimension = std::max(all.dimension, one.dimension);
    all.remarks.higherOrderCells += one.remarks.higherOrderCells;
    all.remarks.nonFinitePoints += one.remarks.nonFinitePoints;
    all.seams.crowded += one.seams.crowded;
    all.seams.overlapping += one.seams.overlapping;
    all.seams.collapsing += one.seams.collapsing;
    all.near += one.near;
    all.duplicates += one.duplicates;
    for (const auto& [type, cells] : one.remarks.notMeasured)
    {
      all.remarks.notMeasured[type] += cells;
    }
    for (const auto& [key, cells] : one.remarks.collapsed)
    {
      all.remarks.collapsed[key] += cells;
    }
    first(all.remarks.coarseness, one.remarks.coarseness);
    first(all.firstApart, one.firstApart);
    first(all.firstNear, one.firstNear);
    first(all.text, one.text);
  }
  return all;
}
}

//------------------------------------------------------------------------------
PieceFindings findingsOf(const MeshAdapter& adapter, const unsigned char* reversed,
  const unsigned char* skip, Index curved, bool elements)
{
  const Mesh& mesh = adapter.mesh();
  PieceFindings found;
  found.dimension = mesh.dimension();
  found.remarks = adapter.remarks(false);
  MeshRemarks remarks = adapter.remarks();
  if (!elements)
  {
    found.remarks.notMeasured.clear();
    remarks.notMeasured.clear();
  }
  const MeshSkin skin = findSkin(mesh);
  Index first = 0;
  found.near = countNearPoints(mesh, skin.boundaryPoints, &first);
  found.firstNear = found.near > 0 ? placeOf(mesh.view(), first) : "";
  found.seams = findCoincidentPoints(mesh, reversed, 1, adapter.ghostCells());
  found.seams.representative.clear();
  found.firstApart = found.seams.apart() > 0 ? placeOf(mesh.view(), found.seams.firstApart) : "";
  found.duplicates = countDuplicates(skin.duplicates, skip);
  remarks.higherOrderCells = std::max<Index>(0, remarks.higherOrderCells - curved);
  found.text = describe(remarks);
  add(found.text, describeSeams(found.seams, mesh));
  add(found.text, describeNear(found.near, found.firstNear));
  add(found.text, describeDuplicates(skin.duplicates, skip));
  return found;
}

//------------------------------------------------------------------------------
std::string describeFindings(RankGroup& group, const std::vector<PieceFindings>& own)
{
  PieceFindings all = joined(own);
  const Index pieces = group.sum(static_cast<Index>(own.size()));
  const bool none = all.text.empty();
  if (pieces < 2 || !group.any(!none))
  {
    const std::string text = firstText(group, all.text);
    return group.rank() == 0 ? text : "";
  }
  all.dimension =
    static_cast<Dimension>(group.maximum(static_cast<Index>(static_cast<int>(all.dimension))));
  for (Index* number : { &all.seams.crowded, &all.seams.overlapping, &all.seams.collapsing,
         &all.near, &all.duplicates })
  {
    *number = group.sum(*number);
  }
  all.remarks = joinRemarks(group, all.remarks);
  const std::string apart = firstText(group, all.firstApart);
  const std::string near = firstText(group, all.firstNear);
  std::string text = describe(all.remarks);
  add(text, describeApart(all.seams, all.dimension, withoutNumber(apart)));
  add(text, describeNear(all.near, withoutNumber(near)));
  if (all.duplicates > 0)
  {
    add(text,
      std::to_string(all.duplicates) +
        (all.duplicates == 1 ? " duplicate cell has" : " duplicate cells have") +
        " the same points as another one.");
  }
  return group.rank() == 0 ? text : "";
}
}
