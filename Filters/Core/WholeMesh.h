// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WholeMesh.h
 * @brief Assembles a mesh from its pieces, and extracts pieces from a mesh.
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
/// The indices of the points and cells of a piece in the whole mesh.
struct PieceNumbers
{
  std::vector<vtkIdType> points;
  std::vector<vtkIdType> cells; ///< for a ghost cell, its original, or -1 if there is none
};

/// A point or cell of a piece.
struct PieceItem
{
  int piece;
  vtkIdType id;
};

/// A mesh, the numbering of its pieces, and the origins of its points and cells.
struct WholeMesh
{
  vtkSmartPointer<vtkDataSet> mesh;
  std::vector<PieceNumbers> pieces;
  std::vector<PieceItem> points, cells;
};

/**
 * @brief Assembles pieces. The result does not depend on the division of the mesh.
 *
 * If all pieces have global ids, these identify the points and define their order; positions of
 * copies may differ by rounding, see areCopies(). Otherwise points with equal coordinates on
 * several pieces are merged, unless a piece has several points there (a crack, a contact, a seam
 * within the piece), which all stay apart; they are in the order of their coordinates. Cells are in
 * the order of their global ids, or otherwise of their point numbers. Ghost cells are left out as
 * copies of other cells. Only arrays of all pieces with points are kept. A single piece is used as
 * it is. Pieces of one image give an image, pieces of vtkPolyData give vtkPolyData, and other
 * pieces an unstructured grid.
 *
 * @param pieces may have no points; must not be null
 * @param like a mesh with the same numbers of pieces, points and cells, whose numbering is used; or
 * null
 *
 * Throws Error if points at different positions or several cells share a global id, and for images
 * with gaps.
 */
TAUTLINECORE_EXPORT WholeMesh assemble(
  const std::vector<vtkDataSet*>& pieces, const WholeMesh* like = nullptr);

/// Whether the pieces match the pieces of a mesh in the numbers of points and cells and, if both
/// have them, in the global ids of points.
TAUTLINECORE_EXPORT bool matches(const std::vector<vtkDataSet*>& pieces, const WholeMesh& mesh);

/**
 * @brief The part of a mesh with the flagged cells and their points.
 * @param flags one per cell
 * @param loose whether to include points without cells
 */
TAUTLINECORE_EXPORT vtkSmartPointer<vtkDataSet> extractCells(
  vtkDataSet* mesh, const std::vector<char>& flags, bool loose);
}
#endif
