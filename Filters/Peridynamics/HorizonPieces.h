// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HorizonPieces.h
 * @brief A planar mesh of triangles in pieces on several processes, for nonlocal models.
 */
#ifndef tautline_HorizonPieces_h
#define tautline_HorizonPieces_h

#include "HorizonInput.h"
#include "RankMesh.h"
#include "tautline/Core/RankGroup.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace tautline
{
/// What orders the triangles of the whole mesh: global ids, or the ids of the corners.
using TriangleKey = std::array<Index, 3>;

/**
 * @class tautline::HorizonPieces
 * @brief The triangles about the points that this process owns, and their places in the whole mesh.
 * All methods are collective but for const accessors.
 *
 * The whole mesh is the one that assemble() would make: its triangles are in the order of their
 * global ids, if all pieces have some, else in that of the ids of their points, or of the places of
 * these.
 */
class HorizonPieces
{
public:
  /**
   * @brief Null, on all processes, where the mesh has to be gathered: see takePieces(), and where
   * triangles are inverted or listed in opposite orders, occur twice, or are among cells of other
   * types; vertices and lines of poly data do no harm, as they come before its triangles. What is
   * wrong with the mesh is then found as with one process.
   *
   * Throws Error, on all processes, for cells that are no triangles, and for triangles with the
   * same global id.
   * @param mergePoints whether points with the same coordinates are one; else by global ids
   */
  static std::unique_ptr<HorizonPieces> take(vtkDataObject* input, bool mergePoints, int threads);

  RankGroup& group() const { return *this->Group; }
  const RankMesh& mesh() const { return *this->Pieces; }
  const MeshView& view() const { return this->Pieces->mesh().view(); }
  const HorizonPlane& plane() const { return this->Plane; }
  /// The local triangles that this process owns; every triangle is owned by one process.
  const std::vector<Index>& triangles() const { return this->Owned; }
  /// What identifies each local point in the whole mesh.
  const std::vector<Index>& pointIds() const { return this->PointIds; }
  TriangleKey keyOf(Index triangle) const;

  /**
   * @brief The cells of the whole mesh that triangles are.
   * @param keys of triangles of all processes, in increasing order; the same on all processes
   * @return one number per key, on the first process
   */
  std::vector<Index> cellNumbers(const std::vector<TriangleKey>& keys) const;

private:
  HorizonPieces() = default;
  void requireTriangles() const;
  bool isRegular(vtkDataObject* input) const;
  void order(vtkDataSet* input);
  void requireDistinctIds() const;

  std::unique_ptr<RankGroup> Group; // outlives the mesh
  std::unique_ptr<RankMesh> Pieces;
  HorizonPlane Plane;
  std::vector<Index> Owned, PointIds;
  std::vector<Index> CellIds; ///< per local triangle; empty: those of the points decide
  Index Before = 0;           ///< vertices and lines of poly data, which come before the triangles
  bool Single = false;        ///< all triangles are in one piece, whose order is kept
};

/// Whether points of all pieces have global ids. Collective.
bool havePointIds(vtkDataObject* input);
}
#endif
