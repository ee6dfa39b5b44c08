// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointOrder.h
 * @brief The origin of the point order of a mesh that was assembled from pieces.
 */
#ifndef tautline_PointOrder_h
#define tautline_PointOrder_h

#include "TautlineCoreModule.h" // for export macro

class vtkDataSet;

namespace tautline
{
/// The origin of the point order of a mesh.
enum class PointOrder : int
{
  Given,       ///< the source of the mesh; always with one process
  ById,        ///< the global ids
  Coordinates, ///< assemble() without global ids: may differ from the serial order
  Shared       ///< the mesh passed to assemble() as `like`
};

/// Records the order of a mesh that assemble() has made. @param shared whether it is the order of
/// `like`
void setPointOrder(vtkDataSet* mesh, bool shared);

/// The origin of the point order as recorded by assemble(); otherwise Given.
TAUTLINECORE_EXPORT PointOrder pointOrder(vtkDataSet* mesh);

/**
 * @brief The common order of the points of two meshes: Given, by global ids, or Coordinates if
 * there is none. If the pieces of `other` were assembled like the pieces of the mesh (Shared), the
 * order counts as by ids, because only the numbers of points and cells are compared.
 */
TAUTLINECORE_EXPORT PointOrder commonOrder(vtkDataSet* mesh, vtkDataSet* other);
}
#endif
