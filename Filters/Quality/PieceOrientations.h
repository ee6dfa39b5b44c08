// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceOrientations.h
 * @brief Whether the pieces of a mesh on several processes tell which of its cells are reversed.
 */
#ifndef tautline_PieceOrientations_h
#define tautline_PieceOrientations_h

#include "tautline/Core/RankGroup.h"
#include "tautline/Mesh/Mesh.h"

#include <optional>
#include <vector>

class vtkDataObject;
class vtkDataSet;
class vtkMultiProcessController;

namespace tautline
{
/**
 * @class tautline::PieceOrientations
 * @brief The orientations of the pieces of each data set, and the space that it fills. A part of a
 * piece that is reversed may be inverted in the whole mesh, with neighbours on another process that
 * are not; a flat piece may be a part of a surface in space, which has no inverted cells.
 */
class PieceOrientations
{
public:
  /**
   * @brief Finds those of the data sets of all processes. Throws Error, on all, for a mesh that is
   * malformed. Collective.
   * @param group the processes; null: each piece is taken to fill the space that it is in
   */
  void find(vtkDataObject* input, int threads, RankGroup* group);
  /// Joins what the processes have found. Collective.
  void gather(vtkMultiProcessController* controller);
  /// Whether the reversed parts of the pieces of a data set are to be measured as they are: some
  /// pieces have such parts, others have not, and no neighbours disagree.
  bool ambiguous(unsigned int flatIndex) const;
  /// The space that all pieces of a data set fill; none if it is not known.
  std::optional<MeshSpace> space(unsigned int flatIndex) const;

private:
  void findPiece(vtkDataSet* data, int threads, RankGroup* group, unsigned int index);

  /// How many processes have such a piece of a data set.
  struct Pieces
  {
    int any = 0, withReversed = 0, withOthers = 0, disagreeing = 0;
  };
  std::vector<Pieces> Found;                    ///< by flat index
  std::vector<std::optional<MeshSpace>> Spaces; ///< by flat index
};
}
#endif
