// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshFileAdapter.h
 * @brief A MeshFile as a VTK data set, and a VTK data set as a MeshFile.
 */
#ifndef tautline_MeshFileAdapter_h
#define tautline_MeshFileAdapter_h

#include "MeshFile.h"

class vtkDataSet;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace tautline
{
/// Fills an empty grid: points in double precision, 64-bit cells, all arrays. The large vectors
/// become the grid's without being copied.
TAUTLINEREADERS_EXPORT void toGrid(MeshFile mesh, vtkUnstructuredGrid* grid);

/// Fills an empty surface; cells are in the order VTK requires: vertices, lines, polygons.
TAUTLINEREADERS_EXPORT void toSurface(MeshFile mesh, vtkPolyData* surface);

/**
 * @brief Copies a data set. Pixels and voxels become quadrilaterals and hexahedra, ghost cells are
 * left out, arrays that are not numeric too.
 *
 * Throws Error, naming types and counts, on cells that the file formats do not have (strips,
 * polyhedra, ...).
 */
TAUTLINEREADERS_EXPORT MeshFile fromDataSet(vtkDataSet* input);
}
#endif
