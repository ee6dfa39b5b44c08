// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImprovedMesh.h
 * @brief The output of Improve Mesh: the result of the kernel as a data set with the data of the
 * input.
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
 * Points of the input keep their data; inserted ones interpolate, after an adaptation also those
 * that moved. Marked edges and facets of an adaptation (ReconnectionResult::lines, facets) become
 * lines and triangles with the data of the cell that they are a part of. Cells have the data of the
 * cell in OriginalCellId; with ReconnectionResult::overlaps, real numbers are averages over the
 * cells of the input that they overlap. Global ids are left out, as they would not be unique.
 * Points in single precision stay so unless a tetrahedron would not be valid, or, without an
 * adaptation, the worst one worse than before.
 */
ImprovedCells writeImproved(const ReconnectableMesh& input, const ReconnectionResult& result,
  int threads, vtkPointSet* output);
}
#endif
