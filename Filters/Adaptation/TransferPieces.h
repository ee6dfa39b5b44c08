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
  vtkDataSet* output; ///< null for the source
  std::string name;   ///< name of the block, or ""
  std::unique_ptr<MeshAdapter> adapter;
  vtkIdType first[2] = { 0, 0 }; ///< global number of its first point and first cell
  JoinedCopies copies;

  vtkDataSetAttributes* data(int association) const
  {
    return this->given->GetAttributes(association);
  }
  vtkIdType count(int association) const { return this->given->GetNumberOfElements(association); }
};

/// Joins the elements of all pieces in one frame; sets the numbers of their first points and cells.
TransferMesh joinPieces(std::vector<TransferPiece>& pieces, const CoordinateFrame& frame);

/// Throws Error for polyhedra and cells of higher order. @param which "target" or "source"
void requireSupported(const TransferPiece& piece, const char* which);

/// The frame of the target, which is also used for the source.
CoordinateFrame frameOf(const std::vector<TransferPiece>& pieces);

/// Makes the order of the cells consistent; returns a sentence on inverted elements, or "".
std::string describeInverted(std::vector<TransferPiece>& pieces, const char* which);
}
#endif
