// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshGroups.h
 * @brief The meshes of a data object, each of which may be in pieces.
 */
#ifndef tautline_MeshGroups_h
#define tautline_MeshGroups_h

#include "TautlineCoreModule.h" // for export macro

#include "vtkSmartPointer.h"

#include <functional>
#include <vector>

class vtkDataObject;
class vtkDataSet;

namespace tautline
{
/// A data set that is a mesh, or a piece of one.
struct GroupedPiece
{
  int group; ///< the number of the mesh
  vtkDataSet* data;
};

/**
 * @brief Lists the data sets. A data set is a mesh, and so is each block of a multiblock data set;
 * the partitions of a partitioned or multipiece data set are pieces of one mesh. Throws Error for
 * other composite data.
 * @param groups set to the number of meshes, including null ones
 */
TAUTLINECORE_EXPORT std::vector<GroupedPiece> listPieces(vtkDataObject* data, int& groups);

/// Whether a mesh is in several partitions that have cells.
TAUTLINECORE_EXPORT bool hasPartitions(vtkDataObject* data);

/**
 * @brief A data object of the same structure with other data sets.
 * @param make returns the replacement of a piece, or null; its argument is null if there is no
 * piece
 * @param merge whether a mesh in partitions becomes one partition: make() is called once for each
 * mesh, with null for partitions
 */
TAUTLINECORE_EXPORT vtkSmartPointer<vtkDataObject> rebuild(vtkDataObject* like, bool merge,
  const std::function<vtkSmartPointer<vtkDataSet>(int group, vtkDataSet* piece)>& make);
}
#endif
