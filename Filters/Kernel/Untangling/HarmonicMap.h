// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HarmonicMap.h
 * @brief The harmonic map of a mesh: every free vertex at the mean of its neighbors.
 * Internal: not installed.
 */
#ifndef tautline_HarmonicMap_h
#define tautline_HarmonicMap_h

#include "tautline/Patches/SimplexMesh.h"

namespace tautline
{
/**
 * @brief Places every free vertex at the mean of its neighbors, by conjugate gradients. In 2D with
 * a convex boundary, no element is inverted (W. T. Tutte, 1963). For Dim 2 and 3.
 * @param x VertexStride coordinates per vertex; coordinates of the free vertices change
 * @param tolerance of the residual, relative to the initial residual
 * @param iterations maximum number of iterations
 * @return false if nothing holds the mesh (no neighbor is fixed); x is then unchanged
 */
template <int Dim>
bool harmonicMap(const SimplexMesh& mesh, double* x, double tolerance, int iterations, int threads);
}
#endif
