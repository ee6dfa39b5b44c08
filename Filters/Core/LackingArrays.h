// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LackingArrays.h
 * @brief Arrays that are missing in a mesh because some of its pieces lack them.
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
 * @brief Records, in a joined mesh, the arrays that only some of its pieces have.
 * @param processes that have the pieces
 * @param several whether there are several processes: pieces are then named by process, otherwise
 * by partition number
 */
TAUTLINECORE_EXPORT void noteLackingArrays(const std::vector<vtkDataSet*>& pieces,
  const std::vector<int>& processes, bool several, vtkDataSet* mesh);

/// The first piece that lacks an array of a mesh: " in process 1", " in partition 2"; "" if all or
/// none of the pieces have it.
TAUTLINECORE_EXPORT std::string lackingPiece(
  vtkDataSet* mesh, const std::string& array, bool ofCells);
}
#endif
