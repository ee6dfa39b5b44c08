// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImprovedMesh.h
 * @brief Writes the output of Improve Mesh: the result of the kernel as a data set with the data of
 * the input.
 */
#ifndef tautline_ImprovedMesh_h
#define tautline_ImprovedMesh_h

#include "ImprovedCells.h"
#include "ReconnectableMesh.h"
#include "tautline/Reconnection/Reconnection.h"

namespace tautline
{
/**
 * @brief Gives the output the points and cells of the result, the data of the input, and the cell
 * arrays `min_angle`, `imr` and `OriginalCellId`. Points that were merged into another one are not
 * in the output.
 *
 * Points of the input keep their data; the data of inserted points, and after an adaptation also of
 * moved points, are interpolated. Marked edges and facets of an adaptation
 * (ReconnectionResult::lines, facets) become lines and triangles with the data of their original
 * cell. Cells have the data of the cell in OriginalCellId; with ReconnectionResult::overlaps, real
 * numbers are averages over the cells of the input that they overlap. Global ids are left out,
 * because they would not be unique. Points in single precision stay so unless a tetrahedron would
 * become invalid or, without an adaptation, the worst one would be worse than before.
 */
ImprovedCells writeImproved(const ReconnectableMesh& input, const ReconnectionResult& result,
  int threads, vtkPointSet* output);
}
#endif
