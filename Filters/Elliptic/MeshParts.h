// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshParts.h
 * @brief The meshes in a data object on this process, each with its ghost cells, its global point
 * ids, and its partitions joined.
 */
#ifndef tautline_MeshParts_h
#define tautline_MeshParts_h

#include "ProcessGroup.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;

namespace tautline
{
/// A mesh to solve on, or this process's part of it, which may be empty.
struct LocalMesh
{
  std::string name;                     ///< "block 3", or "" if there is only one mesh
  int number = 0;                       ///< index among the meshes
  int meshes = 1;                       ///< number of meshes
  vtkSmartPointer<vtkDataSet> input;    ///< never null
  vtkSmartPointer<vtkDataSet> selected; ///< the same with the marks of markSelected(), or null
  vtkSmartPointer<vtkDataSet> output;   ///< a shallow copy of the input, gets the results
  std::vector<Index> globalIds; ///< of the points, without repetition; empty with one process
  std::string notice;           ///< remarks for the user on points that are treated as one, or ""
};

/**
 * @brief Calls visit for each mesh with a cell on any process; other meshes are passed on
 * unchanged. Collective.
 *
 * A data set is a mesh, and so is each block of a multiblock data set. The partitions of a
 * partitioned or multipiece data set are one mesh, on all processes together. Points on several
 * processes or partitions are identified by the global point ids of the input, or otherwise by
 * equal coordinates. Throws Error if points of one partition cannot be distinguished: with
 * mergePoints, if they share a global id but not the position.
 *
 * With mergePoints, coincident points of a data set are merged according to findCoincidentPoints(),
 * if they share a global id, and, on several processes without ids, if another piece is at the same
 * position; and blocks with a seam between them are one mesh, on any process. Merged points have
 * the array values of the first of them.
 *
 * @param selected the result of markSelected()
 * @param output of the class of the input; gets its structure
 */
void forEachMesh(vtkDataObject* input, vtkDataObject* selected, vtkDataObject* output,
  bool mergePoints, RankGroup& processes, const std::function<void(LocalMesh&)>& visit);
}
#endif
