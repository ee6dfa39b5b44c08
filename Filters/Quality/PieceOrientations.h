// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceOrientations.h
 * @brief What the pieces of meshes on several processes have to know of the whole to be measured.
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
 * @brief What is found of the orders of the cells, in sentences for the user, or "".
 * @param mode a value of vtkElementQuality::SetReversedMesh()
 */
std::string describeOrder(const RankOrder& found, Dimension dimension, int mode);

/// What a process knows of the whole of a mesh.
struct WholeOrientation
{
  MeshSpace space;
  RankOrder order; ///< for the pieces of this process
};

/// A piece of a mesh of which something is known.
struct OrientedPiece
{
  const WholeOrientation* whole;
  std::size_t number; ///< of the piece in RankOrder::reverse
};

/**
 * @class tautline::PieceOrientations
 * @brief Of each mesh in pieces, on processes or in partitions, the space that it fills, the order
 * of its cells, and remarks. A part of a piece that is reversed may be inverted in the whole mesh,
 * with neighbours in another piece that are not; a flat piece may be a part of a surface in space,
 * which has no inverted cells.
 */
class PieceOrientations
{
public:
  /**
   * @brief Finds that of the meshes of all processes. Throws Error, on all, for a mesh that is
   * malformed. Collective.
   * @param mode as for describeOrder() @param elements as for findingsOf()
   */
  void find(vtkDataObject* input, int threads, RankGroup& group, int mode, bool elements);
  /// The data sets of this process of each mesh; as many meshes on all processes.
  const std::vector<std::vector<vtkDataSet*>>& meshes() const { return this->Meshes; }
  /// Of a data set of the input; null before find(), and of one without cells.
  const OrientedPiece* piece(vtkDataSet* data) const;
  /// On the first process the remarks on all meshes, in sentences; "" on the others.
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
