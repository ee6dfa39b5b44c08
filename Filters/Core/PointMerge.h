// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointMerge.h
 * @brief Coincident points on the seams of a mesh in pieces: sentences that describe their
 * treatment, and common values for merged points.
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
 * @brief Sentences for the user on points that are treated as one, and on coincident points that
 * stay apart; "" if there are none.
 * @param mesh before its points were merged
 */
TAUTLINECORE_EXPORT std::string describeMerged(const CoincidentPoints& points, const Mesh& mesh);

/// A sentence on cells that are copies of other cells and are counted once, or "".
TAUTLINECORE_EXPORT std::string describeCopies(Index copies);

/**
 * @brief Throws Error if two cells are on the same side of a facet that no other cell has.
 * @param place of the first point, in the format of placeOf()
 */
TAUTLINECORE_EXPORT void requireNoOverlap(
  Index facets, Dimension dimension, const std::string& place, const std::string& remedy = "");

/// Sentences on copies of points that were joined by their global ids, and on copies that are too
/// far apart to be joined; or "".
TAUTLINECORE_EXPORT std::string describeJoined(const JoinedCopies& copies);

/// Sentences on coincident points of a mesh whose points are not merged: their number, the first
/// position, and the consequence.
TAUTLINECORE_EXPORT std::string describeSeams(const CoincidentPoints& points, const Mesh& mesh);

/**
 * @brief A sentence on facets that coincide with another one but stay apart, or "".
 * @param first the position of the first one
 */
TAUTLINECORE_EXPORT std::string describeApart(
  const CoincidentPoints& points, Dimension dimension, const std::string& first);

/// A sentence on points that nearly coincide with another one, or "".
/// @param first the position of the first one
TAUTLINECORE_EXPORT std::string describeNear(Index near, const std::string& first);

/// "point 17 at (0.5, 0, 1)"
TAUTLINECORE_EXPORT std::string placeOf(const MeshView& view, Index point);

/// Sets a flag for all points of a merged group if one of them has it.
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
 * @brief Throws Error if the values of merged points differ.
 * @param array a point array; may be null
 * @param values their name in the message, for example "displacements"
 */
TAUTLINECORE_EXPORT void requireEqualValues(
  vtkDataArray* array, const std::vector<Index>& representative, const char* values);

/**
 * @brief Throws Error if the mesh has duplicate cells (with the same points as another cell), which
 * would count twice.
 * @param skip one flag per cell, set for cells that do not count; may be null
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
