// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::PieceFaces
 * @brief The faces of meshes in pieces, on processes or in partitions, with the cells across the
 * borders, and the checks of each whole mesh.
 */
#ifndef tautline_PieceFaces_h
#define tautline_PieceFaces_h

#include "FaceQuality.h"
#include "PieceOrientations.h"

#include <map>

namespace tautline
{
class PieceFaces
{
public:
  /**
   * @brief Finds the faces if metrics or cells need them, and runs the checks. Throws Error as
   * FaceMeshAdapter does. Collective.
   * @param orientations found before; must outlive this object
   * @param orient whether to reorder cells accordingly
   */
  void find(const PieceOrientations& orientations, RankGroup& group,
    const std::vector<Metric>& metrics, FaceConvention convention, bool orient, int threads);

  /// The faces of a data set of the input; null if there are none.
  FaceQuality* piece(vtkDataSet* data) const;
  /// The checks of each mesh that has faces, the same on all ranks.
  const std::vector<std::vector<MeshCheck>>& checks() const { return this->Checks; }

private:
  std::vector<std::unique_ptr<MeshAdapter>> Adapters;
  std::map<vtkDataSet*, std::unique_ptr<FaceQuality>> Pieces;
  std::vector<std::vector<MeshCheck>> Checks;
};
}
#endif
