// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceOrientations.h
 * @brief Whether the pieces of a mesh on several processes tell which of its cells are reversed.
 */
#ifndef tautline_PieceOrientations_h
#define tautline_PieceOrientations_h

#include <vector>

class vtkDataObject;
class vtkMultiProcessController;

namespace tautline
{
/**
 * @class tautline::PieceOrientations
 * @brief The orientations of the pieces of each data set. A part of a piece that is reversed may be
 * inverted in the whole mesh, with neighbours on another process that are not.
 */
class PieceOrientations
{
public:
  /// Adds the data sets of this process. Throws Error for a mesh that is malformed.
  void find(vtkDataObject* input, int threads);
  /// Joins what the processes have found. Collective.
  void gather(vtkMultiProcessController* controller);
  /// Whether the reversed parts of the pieces of a data set are to be measured as they are: some
  /// pieces have such parts, others have not, and no neighbours disagree.
  bool ambiguous(unsigned int flatIndex) const;

private:
  /// How many processes have such a piece of a data set.
  struct Pieces
  {
    int any = 0, withReversed = 0, withOthers = 0, disagreeing = 0;
  };
  std::vector<Pieces> Found; ///< by flat index
};
}
#endif
