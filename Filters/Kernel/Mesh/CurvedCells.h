// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedCells.h
 * @brief The validity and the smallest Jacobian determinant of cells of quadratic and higher order,
 * certified for the whole cell and not for its corners only.
 * Internal: not installed.
 */
#ifndef tautline_CurvedCells_h
#define tautline_CurvedCells_h

#include "Mesh.h"

namespace tautline
{
class ElementType;

/// What a mesh does not have about its curved cells.
struct CurvedCellFacts
{
  /// Null, or three numbers per cell: the orders of Lagrange and Bezier cells (VTK's cell array
  /// HigherOrderDegrees).
  const double* degrees = nullptr;
  /// Null, or a flag per cell: its corners are listed in the opposite order, by reverseCell(), and
  /// its other nodes are not.
  const unsigned char* reversed = nullptr;
  /// Whether the corners 1 and 2, and 4 and 5, of Lagrange and Bezier wedges are exchanged in the
  /// mesh, so that their orientation is that of linear wedges.
  bool wedgesTurned = false;
  /// Whether Bezier cells have weights of their own: these are not certified.
  bool rational = false;
};

/// Cells of one type and order, with their nodes in the order of the file.
class CurvedGroup
{
public:
  CurvedGroup(const Mesh& mesh, int vtkType, const ElementType& type, std::vector<Index> cells,
    const CurvedCellFacts& facts);

  const ElementType& type() const { return *this->Type; }
  Index count() const { return static_cast<Index>(this->Cells.size()); }
  Index cell(Index i) const { return this->Cells[i]; }
  const Index* nodes(Index i) const { return this->Nodes[i]; }
  /// Whether an element is taken for its mirror image.
  bool mirrored(Index i) const { return this->Mirrored != this->reversed(this->Cells[i]); }
  /// The normal of a mesh in a plane, for JacobianCertifier.
  const Vec3& normal() const { return this->Normal; }

private:
  bool reversed(Index cell) const { return this->Reversed && this->Reversed[cell]; }
  bool changed(Index cell) const { return this->Turned || this->reversed(cell); }
  void restore(CellType corners, Index cell, Index* nodes) const;

  const ElementType* Type;
  std::vector<Index> Cells;
  const unsigned char* Reversed;
  bool Turned;
  Vec3 Normal;
  bool Mirrored;
  std::vector<const Index*> Nodes; ///< by position in Cells
  std::vector<Index> Restored;     ///< nodes of reversed cells
};

/**
 * @brief The cells of quadratic and higher order that ElementType supports, by type and order;
 * wedges of one type and order are taken for their mirror images where most of them are reversed.
 * @param linear whether linear cells are groups, too
 */
TAUTLINE_KERNEL_EXPORT std::vector<CurvedGroup> curvedGroups(
  const Mesh& mesh, const CurvedCellFacts& facts, bool linear = false);

/**
 * @brief Replaces the validity, and the smallest determinant, of the cells of quadratic and higher
 * order.
 *
 * The determinant refers to the same reference cells as the metric min_jacobian. In a plane its
 * sign is that of Mesh::normal(); a cell of a surface is valid if its normal vanishes nowhere.
 * Wedges of one type and order are taken for their mirror images where most of them are reversed:
 * files have them in two orders. Cells that ElementType does not support are left as they are.
 *
 * @param validity of each cell
 * @param minimum of each cell; may be null. 0 where a coordinate is not finite.
 * @return the number of cells that were certified
 */
TAUTLINE_KERNEL_EXPORT Index certifyCurvedCells(const Mesh& mesh, const CurvedCellFacts& facts,
  signed char* validity, double* minimum, int threads = 0);
}
#endif
