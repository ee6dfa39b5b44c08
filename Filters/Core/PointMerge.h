// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointMerge.h
 * @brief Coincident points on the seams of a mesh in pieces: what is done with them, in words, and
 * values for all of them.
 */
#ifndef tautline_PointMerge_h
#define tautline_PointMerge_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Mesh/CoincidentPoints.h"
#include "tautline/Mesh/PointCopies.h"

#include <algorithm>
#include <string>
#include <vector>

class vtkDataArray;

namespace tautline
{
/**
 * @brief Sentences for the user on points that are treated as one, and on those that coincide but
 * stay apart; "" if there are none.
 * @param mesh before its points were merged
 */
TAUTLINECORE_EXPORT std::string describeMerged(const CoincidentPoints& points, const Mesh& mesh);

/// A sentence on cells that are copies of other ones and count once with them, or "".
TAUTLINECORE_EXPORT std::string describeCopies(Index copies);

/**
 * @brief Throws Error if two cells are on one side of a facet that no other cell has.
 * @param place of the first point, as placeOf() gives it
 */
TAUTLINECORE_EXPORT void requireNoOverlap(
  Index facets, Dimension dimension, const std::string& place, const std::string& remedy = "");

/// Sentences on copies of points that were joined by their global ids, and on those that are too
/// far apart for it; or "".
TAUTLINECORE_EXPORT std::string describeJoined(const JoinedCopies& copies);

/// The same for a mesh whose points are not merged: how many, where, and what they do.
TAUTLINECORE_EXPORT std::string describeSeams(const CoincidentPoints& points, const Mesh& mesh);

/**
 * @brief A sentence on the facets that stay apart though they are at the place of another one, or
 * "".
 * @param first the place of the first
 */
TAUTLINECORE_EXPORT std::string describeApart(
  const CoincidentPoints& points, Dimension dimension, const std::string& first);

/// A sentence on points that nearly coincide with another one, or "".
/// @param first the place of the first
TAUTLINECORE_EXPORT std::string describeNear(Index near, const std::string& first);

/// "point 17 at (0.5, 0, 1)"
TAUTLINECORE_EXPORT std::string placeOf(const MeshView& view, Index point);

/// Sets a flag where one of the points that are one has it, for all of them.
template <class Flag>
void unite(std::vector<Flag>& flags, const std::vector<Index>& representative)
{
  for (std::size_t p = 0; p < representative.size(); ++p)
  {
    flags[representative[p]] |= flags[p];
  }
  for (std::size_t p = 0; p < representative.size(); ++p)
  {
    flags[p] = flags[representative[p]];
  }
}

/// Gives every point the values of its representative, `components` per point.
template <class Value>
void spread(
  std::vector<Value>& values, std::size_t components, const std::vector<Index>& representative)
{
  for (std::size_t p = 0; p < representative.size(); ++p)
  {
    const std::size_t from = static_cast<std::size_t>(representative[p]);
    if (from != p)
    {
      std::copy_n(&values[components * from], components, &values[components * p]);
    }
  }
}

/**
 * @brief Throws Error if the values of points that are one differ.
 * @param array of points; may be null
 * @param values what they are, for the message: "displacements"
 */
TAUTLINECORE_EXPORT void requireEqualValues(
  vtkDataArray* array, const std::vector<Index>& representative, const char* values);

/**
 * @brief Throws Error if the mesh has cells with the same points as another one: they would count
 * twice.
 * @param skip one flag per cell: it does not count; may be null
 */
TAUTLINECORE_EXPORT void requireDistinctCells(
  const Mesh& mesh, const unsigned char* skip = nullptr);

/// The number of duplicate cells. @param skip as for requireDistinctCells()
TAUTLINECORE_EXPORT Index countDuplicates(
  const std::vector<DuplicateCell>& found, const unsigned char* skip = nullptr);

/// A sentence on duplicate cells, or "". @param skip as for requireDistinctCells()
TAUTLINECORE_EXPORT std::string describeDuplicates(
  const std::vector<DuplicateCell>& found, const unsigned char* skip = nullptr);
}
#endif
