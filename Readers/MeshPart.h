// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPart.h
 * @brief The part of a mesh file that one of several processes keeps.
 *
 * The parts are compact, since cells are divided by their places: the boxes of recursive bisection
 * along the longest side. Here a process has the whole mesh and finds its part without a message;
 * PartExchange.h gives the same parts of a mesh that is spread over the ranks.
 */
#ifndef tautline_MeshPart_h
#define tautline_MeshPart_h

#include "MeshFile.h"

#include <array>
#include <optional>

namespace tautline
{
/// An index of a vector.
inline std::size_t at(Index i)
{
  return static_cast<std::size_t>(i);
}

/// Number of a point in the file, from 0 (int64, in the arrays of the points).
constexpr const char* PartPointIds = "GlobalPointIds";
/// Number of a cell in the file, from 0 (int64, in the arrays of the cells).
constexpr const char* PartCellIds = "GlobalCellIds";
/// VTK's name for the flags of ghosts, 1 where a point or cell belongs to another part (uint8).
constexpr const char* PartGhosts = "vtkGhostType";

/// What a process wants of a mesh.
struct PartRequest
{
  int part = 0;        ///< from 0
  int parts = 1;       ///< at least 1
  int ghostLayers = 0; ///< layers of cells of other parts around this one; at least 0
};

/**
 * @brief The cells of one part with their points, all arrays, and the arrays named above.
 *
 * The numbers of cells of two parts differ by at most one. Each cell is in one part; a point is in
 * each part that has a cell with it, and a ghost only where none but ghost cells have it. Points
 * without a cell are in the first part. Own cells come first, then ghost cells, both in the order
 * of the file. Takes O(cells log parts) time and 16 bytes per cell beside the mesh.
 */
TAUTLINEREADERS_EXPORT MeshFile partOf(const MeshFile& mesh, const PartRequest& request);

// What both ways to divide a mesh share.

/// The mean of a cell's nodes along an axis.
inline double cellCentre(
  const std::vector<double>& points, const Index* begin, const Index* end, int axis)
{
  double sum = 0.0;
  for (const Index* node = begin; node != end; ++node)
  {
    sum += points[static_cast<std::size_t>(3 * *node + axis)];
  }
  return sum / static_cast<double>(end > begin ? end - begin : 1);
}

/// The axis along which a box is longest, the first of equal ones.
int longestAxis(const std::array<double, 3>& low, const std::array<double, 3>& high);

/// How a group of parts is halved: its first parts, and the number of cells that they get.
struct PartHalves
{
  int lowParts;
  Index lowCells;
  PartHalves(int parts, Index cells)
    : lowParts(parts / 2)
    , lowCells(static_cast<Index>(static_cast<std::size_t>(cells) *
        static_cast<std::size_t>(this->lowParts) / static_cast<std::size_t>(parts)))
  {
  }
};

/// The tuples of an array in the order of `ids`.
MeshArray gatherTuples(const MeshArray& array, const std::vector<Index>& ids);

/// Adds the ids, and the flags of ghosts where there are any, to the arrays of a part; arrays of
/// the same names are replaced.
void addPartArrays(std::vector<MeshArray>& arrays, const char* idName, std::vector<Index> ids,
  std::optional<MeshArray::Bytes> ghosts);
/// The flag of a point or cell.
constexpr unsigned char ghostFlag(bool ghost)
{
  constexpr unsigned char Duplicate = 1; // vtkDataSetAttributes::DUPLICATECELL and DUPLICATEPOINT
  return ghost ? Duplicate : 0;
}
}
#endif
