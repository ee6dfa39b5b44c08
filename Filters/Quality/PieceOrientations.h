// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceOrientations.h
 * @brief Data on whole meshes that is needed to measure their pieces on several processes.
 */
#ifndef tautline_PieceOrientations_h
#define tautline_PieceOrientations_h

#include "tautline/Core/RankGroup.h"
#include "tautline/Mesh/CellOrder.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;

namespace tautline
{
/**
 * @brief The findings on the order of the cells, as sentences for the user, or "".
 * @param mode a value of vtkElementQuality::SetReversedMesh()
 */
std::string describeOrder(const RankOrder& found, Dimension dimension, int mode);

/// The data on a whole mesh on each process.
struct WholeOrientation
{
  MeshSpace space;
  RankOrder order; ///< for the pieces of this process
};

/// A piece of a mesh with known orientation.
struct OrientedPiece
{
  const WholeOrientation* whole;
  std::size_t number; ///< the number of the piece in RankOrder::reverse
};

/**
 * @class tautline::PieceOrientations
 * @brief For each mesh in pieces, on processes or in partitions: the space that it fills, the order
 * of its cells, and remarks. A reversed part of a piece may be inverted in the whole mesh, if its
 * neighbors in another piece are not reversed; a flat piece may be part of a surface in space,
 * which has no inverted cells.
 */
class PieceOrientations
{
public:
  /**
   * @brief Finds these data for the meshes of all processes. Throws Error, on all, if a mesh is
   * malformed. Collective.
   * @param mode as for describeOrder() @param elements as for findingsOf()
   */
  void find(vtkDataObject* input, int threads, RankGroup& group, int mode, bool elements);
  /// The data sets of this process for each mesh; the number of meshes is the same on all
  /// processes.
  const std::vector<std::vector<vtkDataSet*>>& meshes() const { return this->Meshes; }
  /// The data for a data set of the input; null before find() and for a data set without cells.
  const OrientedPiece* piece(vtkDataSet* data) const;
  /// On the first process, the remarks on all meshes, as sentences; "" on the others.
  const std::string& notice() const { return this->Notice; }

private:
  void findMesh(
    const std::vector<vtkDataSet*>& data, int threads, RankGroup& group, int mode, bool elements);

  std::vector<std::unique_ptr<WholeOrientation>> Found;
  std::vector<std::vector<vtkDataSet*>> Meshes;
  std::map<vtkDataSet*, OrientedPiece> Pieces;
  std::string Notice;
};
}
#endif
