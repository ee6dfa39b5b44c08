// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HarmonicMap.h
 * @brief The harmonic map of a mesh: every free vertex at the mean of its neighbours.
 * Internal: not installed.
 */
#ifndef tautline_HarmonicMap_h
#define tautline_HarmonicMap_h

#include "tautline/Patches/SimplexMesh.h"

namespace tautline
{
/**
 * @brief Puts every free vertex at the mean of its neighbours, by conjugate gradients. In 2D and
 * with a convex boundary no element is inverted then (W. T. Tutte, 1963). For Dim 2 and 3.
 * @param x VertexStride coordinates per vertex; those of the free vertices change
 * @param tolerance of the residual, relative to the first
 * @param iterations at most
 * @return false if nothing holds the mesh (no neighbour is fixed); x is then unchanged
 */
template <int Dim>
bool harmonicMap(const SimplexMesh& mesh, double* x, double tolerance, int iterations, int threads);
}
#endif
