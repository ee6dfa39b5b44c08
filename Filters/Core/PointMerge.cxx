// SPDX-License-Identifier: BSD-3-Clause
#include "PointMerge.h"

#include "vtkDataArray.h"

#include <map>
#include <sstream>

namespace tautline
{
namespace
{
/// "1 point", "2 points"
std::string counted(Index count, const std::string& noun)
{
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Without a seam if only ghost cells have coincident points.
std::string onSeams(const CoincidentPoints& points)
{
  return points.seams > 0 ? " on " + counted(points.seams, "seam")
    : points.copies > 0   ? " of overlapping parts"
                          : " of ghost cells";
}

/// The duplicates without cells that do not count, for example ghosts, which duplicate their
/// originals.
std::vector<DuplicateCell> countedDuplicates(
  const std::vector<DuplicateCell>& duplicates, const unsigned char* skip)
{
  if (!skip)
  {
    return duplicates;
  }
  std::vector<DuplicateCell> counted;
  std::map<Index, Index> instead; // the first counted duplicate of an original that does not count
  for (const DuplicateCell& duplicate : duplicates)
  {
    if (skip[duplicate.cell])
    {
      continue;
    }
    Index original = duplicate.original;
    if (skip[original])
    {
      original = instead.emplace(original, duplicate.cell).first->second;
    }
    if (original != duplicate.cell)
    {
      counted.push_back({ duplicate.cell, original });
    }
  }
  return counted;
}

/// The reason why facets stay apart.
std::string describeApart(const CoincidentPoints& points, const Mesh& mesh)
{
  return points.apart() == 0
    ? ""
    : describeApart(points, mesh.dimension(), placeOf(mesh.view(), points.firstApart));
}
}

//------------------------------------------------------------------------------
std::string describeApart(
  const CoincidentPoints& points, Dimension dimension, const std::string& first)
{
  if (points.apart() == 0)
  {
    return "";
  }
  const std::string facet = dimension == Dimension::Volume ? "face" : "edge";
  std::string text = counted(points.apart(), facet) + " coincident with another one stay" +
    (points.apart() == 1 ? "s" : "") + " apart; the first is at " + first + ":";
  const auto add = [&text](Index count, const char* reason)
  { text += count > 0 ? " " + std::to_string(count) + " " + reason + "," : std::string(); };
  add(points.crowded, "would have three or more cells");
  add(points.overlapping, "have both cells on one side, so that they overlap");
  add(points.collapsing, "belong to a cell that would have a point twice");
  text.back() = '.';
  return text + " Repair the mesh there, or merge chosen points with Clean to Grid.";
}

//------------------------------------------------------------------------------
std::string describeNear(Index near, const std::string& first)
{
  return near == 0 ? ""
                   : counted(near, "point") +
      " of the boundary nearly coincide with another one; the first is " + first +
      ": the elements there are not connected; run Clean to Grid with a tolerance to merge such "
      "points.";
}

//------------------------------------------------------------------------------
std::string placeOf(const MeshView& view, Index point)
{
  std::ostringstream text;
  const Vec3 p = pointOf(view, point);
  text << "point " << point << " at (" << p[0] << ", " << p[1] << ", " << p[2] << ")";
  return text.str();
}

//------------------------------------------------------------------------------
std::string describeMerged(const CoincidentPoints& points, const Mesh& mesh)
{
  std::string text;
  if (points.merged > 0)
  {
    text = counted(points.merged, "coincident point") + onSeams(points) +
      (points.merged == 1 ? " was" : " were") +
      " treated as one with the point at the same position; the first is " +
      placeOf(mesh.view(), points.first) +
      "; switch Merge Coincident Points off to keep them apart.";
  }
  const std::string apart = describeApart(points, mesh);
  return text + (text.empty() || apart.empty() ? "" : " ") + apart;
}

//------------------------------------------------------------------------------
std::string describeCopies(Index copies)
{
  return copies == 0 ? ""
                     : counted(copies, "cell") + (copies == 1 ? " is a copy" : " are copies") +
      " of another one, for example where parts of the mesh overlap: " +
      (copies == 1 ? "it counts" : "they count") +
      " once, and their points move together. Run Clean Cells to Grid to remove such cells.";
}

//------------------------------------------------------------------------------
void requireNoOverlap(
  Index facets, Dimension dimension, const std::string& place, const std::string& remedy)
{
  if (facets == 0)
  {
    return;
  }
  throw Error(counted(facets, dimension == Dimension::Volume ? "face" : "edge") +
    (facets == 1 ? " has" : " have") + " two elements on the same side; the first is at " + place +
    ": parts of the mesh overlap, and the boundary between them cannot be found. Remove one of the "
    "parts, for example with Connectivity and Threshold" +
    remedy + ".");
}

//------------------------------------------------------------------------------
std::string describeJoined(const JoinedCopies& copies)
{
  std::ostringstream text;
  text.precision(2);
  if (copies.joined > 0)
  {
    text << counted(copies.joined, "point") << (copies.joined == 1 ? " has" : " have")
         << " copies with the same global id that are up to " << copies.farthest
         << " apart: they were joined.";
  }
  if (copies.apart > 0)
  {
    text
      << (copies.joined > 0 ? " " : "") << counted(copies.apart, "global id")
      << (copies.apart == 1 ? " is" : " are")
      << " at positions that are too far apart to be joined: if they are copies of one point, the "
         "mesh is open there. Make their coordinates equal, or run Generate Global Ids again.";
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::string describeSeams(const CoincidentPoints& points, const Mesh& mesh)
{
  std::string text;
  if (points.merged > 0)
  {
    text = counted(points.merged, "point") + onSeams(points) +
      (points.merged == 1 ? " coincides" : " coincide") + " with another one; the first is " +
      placeOf(mesh.view(), points.first) +
      ": the elements there are not connected. Filters whose result depends on it treat these "
      "points as one (Merge Coincident Points); Clean to Grid merges them.";
  }
  const std::string apart = describeApart(points, mesh);
  return text + (text.empty() || apart.empty() ? "" : " ") + apart;
}

//------------------------------------------------------------------------------
void requireEqualValues(
  vtkDataArray* array, const std::vector<Index>& representative, const char* values)
{
  if (!array)
  {
    return;
  }
  for (vtkIdType p = 0; p < static_cast<vtkIdType>(representative.size()); ++p)
  {
    const vtkIdType one = representative[p];
    for (int c = 0; one != p && c < array->GetNumberOfComponents(); ++c)
    {
      const double a = array->GetComponent(p, c), b = array->GetComponent(one, c);
      if (!(a == b) && (a == a || b == b))
      {
        throw Error("Points " + std::to_string(one) + " and " + std::to_string(p) +
          " coincide and are treated as one, but have different " + values + " (" +
          (array->GetName() ? array->GetName() : "") +
          "): make them equal, or switch Merge Coincident Points off.");
      }
    }
  }
}

//------------------------------------------------------------------------------
Index countDuplicates(const std::vector<DuplicateCell>& found, const unsigned char* skip)
{
  return static_cast<Index>(countedDuplicates(found, skip).size());
}

//------------------------------------------------------------------------------
std::string describeDuplicates(const std::vector<DuplicateCell>& found, const unsigned char* skip)
{
  constexpr std::size_t listed = 5;
  const std::vector<DuplicateCell> duplicates = countedDuplicates(found, skip);
  if (duplicates.empty())
  {
    return "";
  }
  std::string text = counted(static_cast<Index>(duplicates.size()), "duplicate cell") +
    (duplicates.size() == 1 ? " has" : " have") + " the same points as another one: ";
  for (std::size_t i = 0; i < duplicates.size() && i < listed; ++i)
  {
    text += (i > 0 ? ", " : "") + std::to_string(duplicates[i].cell) + " (same as " +
      std::to_string(duplicates[i].original) + ")";
  }
  return text + (duplicates.size() > listed ? ", ..." : "") + ".";
}

//------------------------------------------------------------------------------
void requireDistinctCells(const Mesh& mesh, const unsigned char* skip)
{
  const std::string duplicates = describeDuplicates(findSkin(mesh).duplicates, skip);
  if (!duplicates.empty())
  {
    throw Error(duplicates + " They would count twice: run Clean Cells to Grid first.");
  }
}
}
