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

/// Without a seam, where only ghost cells have coincident points.
std::string onSeams(const CoincidentPoints& points)
{
  return points.seams > 0 ? " on " + counted(points.seams, "seam")
    : points.copies > 0   ? " of overlapping parts"
                          : " of ghost cells";
}

/// The duplicates without those of cells that do not count, as a ghost is one of its original.
std::vector<DuplicateCell> countedDuplicates(
  const std::vector<DuplicateCell>& duplicates, const unsigned char* skip)
{
  if (!skip)
  {
    return duplicates;
  }
  std::vector<DuplicateCell> counted;
  std::map<Index, Index> instead; // the first cell that counts, of an original that does not
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

/// Why facets stay apart.
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
  std::string text = counted(points.apart(), facet) + " at the place of another one stay" +
    (points.apart() == 1 ? "s" : "") + " apart, the first at " + first + ":";
  const auto add = [&text](Index count, const char* reason)
  { text += count > 0 ? " " + std::to_string(count) + " " + reason + "," : std::string(); };
  add(points.crowded, "would have three or more cells");
  add(points.overlapping, "have both cells on one side, which overlap");
  add(points.collapsing, "are of a cell that would have a point twice");
  text.back() = '.';
  return text + " Repair the mesh there, or choose the points to merge by Clean to Grid.";
}

//------------------------------------------------------------------------------
std::string describeNear(Index near, const std::string& first)
{
  return near == 0 ? ""
                   : counted(near, "point") +
      " of the boundary nearly coincide with another one, the first is " + first +
      ": the elements there are not connected; Clean to Grid with a tolerance merges such points.";
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
      " treated as one with the point at the same place, the first is " +
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
      " of another one, as where parts of the mesh overlap: " +
      (copies == 1 ? "it counts" : "they count") +
      " once, and their points move alike. Clean Cells to Grid removes such cells.";
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
    (facets == 1 ? " has" : " have") + " two elements on the same side, the first at " + place +
    ": parts of the mesh overlap, and the boundary between them cannot be found. Remove one of the "
    "parts, for example by Connectivity and Threshold" +
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
    text << (copies.joined > 0 ? " " : "") << counted(copies.apart, "global id")
         << (copies.apart == 1 ? " is" : " are")
         << " at places that are too far apart to be joined: where they are copies of one point, "
            "the mesh is open there. Make their places equal, or run Generate Global Ids again.";
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
      (points.merged == 1 ? " is" : " are") + " at the place of another one, the first is " +
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
          " are at the same place and are treated as one, but have different " + values + " (" +
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
    text += (i > 0 ? ", " : "") + std::to_string(duplicates[i].cell) + " (those of " +
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
