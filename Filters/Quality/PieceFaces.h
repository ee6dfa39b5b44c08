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
   * @brief Finds the faces where metrics or cells need them, and makes the checks. Throws Error as
   * FaceMeshAdapter does. Collective.
   * @param orientations found; it must outlive this
   * @param orient whether cells are turned as it says
   */
  void find(const PieceOrientations& orientations, RankGroup& group,
    const std::vector<Metric>& metrics, FaceConvention convention, bool orient, int threads);

  /// Of a data set of the input; null if there are none.
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
