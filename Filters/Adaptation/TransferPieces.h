// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferPieces.h
 * @brief The data sets of the target and the source of a transfer. Not a public header.
 */
#ifndef tautline_TransferPieces_h
#define tautline_TransferPieces_h

#include "MeshAdapter.h"
#include "tautline/Adaptation/TransferMesh.h"

#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"

#include <memory>
#include <string>
#include <vector>

namespace tautline
{
/// A data set of the target or the source.
struct TransferPiece
{
  vtkDataSet* given;
  vtkDataSet* output; ///< null: of the source
  std::string name;   ///< of the block, or ""
  std::unique_ptr<MeshAdapter> adapter;
  vtkIdType first[2] = { 0, 0 }; ///< the number of its first point and cell among all
  JoinedCopies copies;

  vtkDataSetAttributes* data(int association) const
  {
    return this->given->GetAttributes(association);
  }
  vtkIdType count(int association) const { return this->given->GetNumberOfElements(association); }
};

/// The elements of pieces in one frame; sets the numbers of their first points and cells.
TransferMesh joinPieces(std::vector<TransferPiece>& pieces, const CoordinateFrame& frame);

/// Throws Error for polyhedra and cells of higher order. @param which "target" or "source"
void requireSupported(const TransferPiece& piece, const char* which);

/// The frame of the pieces of the target, in which the source is, too.
CoordinateFrame frameOf(const std::vector<TransferPiece>& pieces);

/// A sentence on inverted elements, or "". Lists cells in a consistent order.
std::string describeInverted(std::vector<TransferPiece>& pieces, const char* which);
}
#endif
