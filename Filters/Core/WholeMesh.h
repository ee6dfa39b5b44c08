// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WholeMesh.h
 * @brief One mesh of its pieces, and pieces of a mesh.
 */
#ifndef tautline_WholeMesh_h
#define tautline_WholeMesh_h

#include "TautlineCoreModule.h" // for export macro

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

class vtkDataSet;

namespace tautline
{
/// Where the points and cells of a piece are in the whole mesh.
struct PieceNumbers
{
  std::vector<vtkIdType> points;
  std::vector<vtkIdType> cells; ///< of a ghost cell: the cell it is a copy of, -1 if there is none
};

/// A point or cell of a piece.
struct PieceItem
{
  int piece;
  vtkIdType id;
};

/// A mesh, the places of its pieces, and where its points and cells are taken from.
struct WholeMesh
{
  vtkSmartPointer<vtkDataSet> mesh;
  std::vector<PieceNumbers> pieces;
  std::vector<PieceItem> points, cells;
};

/**
 * @brief Puts pieces together. The result does not depend on how the mesh was divided.
 *
 * Points are identified by the global ids, if all pieces have some, and are in their order; places
 * of copies may differ by rounding, see areCopies(). Else
 * points with equal coordinates on several pieces are one, unless a piece has several points there
 * (a crack, a contact, a seam within the piece), which all stay apart; they are in the order of
 * their coordinates. Cells are in the order of their global ids, or else of the numbers of their
 * points. Ghost cells are left out, as copies of others. Arrays are those that all pieces with
 * points have. A single piece is taken as it is. Pieces of one image are an image, those of
 * vtkPolyData are vtkPolyData, others an unstructured grid.
 *
 * @param pieces without points or not; not null
 * @param like a mesh with as many pieces, points and cells, whose numbers are taken; or null
 *
 * Throws Error for global ids that points at different places or several cells have, and
 * images with gaps.
 */
TAUTLINECORE_EXPORT WholeMesh assemble(
  const std::vector<vtkDataSet*>& pieces, const WholeMesh* like = nullptr);

/// Whether the pieces have as many points and cells as those of a mesh and, where both have some,
/// the same global ids of points.
TAUTLINECORE_EXPORT bool matches(const std::vector<vtkDataSet*>& pieces, const WholeMesh& mesh);

/**
 * @brief The part of a mesh with the cells that are flagged, and their points.
 * @param flags one per cell
 * @param loose whether it has the points without cells, too
 */
TAUTLINECORE_EXPORT vtkSmartPointer<vtkDataSet> extractCells(
  vtkDataSet* mesh, const std::vector<char>& flags, bool loose);
}
#endif
