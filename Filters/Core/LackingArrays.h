// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LackingArrays.h
 * @brief Arrays that a mesh does not have because some of its pieces do not.
 */
#ifndef tautline_LackingArrays_h
#define tautline_LackingArrays_h

#include "TautlineCoreModule.h" // for export macro

#include <string>
#include <vector>

class vtkDataSet;

namespace tautline
{
/**
 * @brief Notes, of a mesh that was put together, the arrays that only some of its pieces have.
 * @param processes that have the pieces
 * @param several whether there are several processes: pieces are named by these, else by their
 * numbers as partitions
 */
TAUTLINECORE_EXPORT void noteLackingArrays(const std::vector<vtkDataSet*>& pieces,
  const std::vector<int>& processes, bool several, vtkDataSet* mesh);

/// The first piece that does not have an array of a mesh: " in process 1", " in partition 2"; "" if
/// none of them has it, or all.
TAUTLINECORE_EXPORT std::string lackingPiece(
  vtkDataSet* mesh, const std::string& array, bool ofCells);
}
#endif
