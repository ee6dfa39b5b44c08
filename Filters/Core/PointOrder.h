// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointOrder.h
 * @brief What is known of the order of points after a mesh was put together of its pieces.
 */
#ifndef tautline_PointOrder_h
#define tautline_PointOrder_h

#include "TautlineCoreModule.h" // for export macro

class vtkDataSet;

namespace tautline
{
/// Where the order of the points of a mesh is from.
enum class PointOrder : int
{
  Given,       ///< the source of the mesh, also with one process
  ById,        ///< the global ids
  Coordinates, ///< assemble() without global ids: one process may have another order
  Shared       ///< the mesh that assemble() got as `like`
};

/// Notes the order of a mesh that assemble() has put together. @param shared that of `like`
void setPointOrder(vtkDataSet* mesh, bool shared);

/// Where the order of the points is from: as assemble() has made the mesh, else Given.
TAUTLINECORE_EXPORT PointOrder pointOrder(vtkDataSet* mesh);

/**
 * @brief What points of two meshes with the same number have in common: Given, or the global ids,
 * or, Coordinates, nothing. Pieces of `other` that were put together as those of the mesh (Shared)
 * count as if by ids, as only their numbers of points and cells are compared.
 */
TAUTLINECORE_EXPORT PointOrder commonOrder(vtkDataSet* mesh, vtkDataSet* other);
}
#endif
