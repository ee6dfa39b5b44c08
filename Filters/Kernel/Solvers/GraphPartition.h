// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GraphPartition.h
 * @brief Parts of a mesh with few neighbouring cells in different parts, by PT-Scotch.
 */
#ifndef tautline_GraphPartition_h
#define tautline_GraphPartition_h

#include "tautline/Mesh/Mesh.h"
#include "tautline/SolversExport.h"

#include <vector>

namespace tautline
{
/**
 * @brief Divides the graph of the cells, of which two are neighbours if they share an edge (2D) or
 * face (3D), into parts of about as many cells, so that few edges of the graph are cut. This
 * process does it alone.
 * @param parts at least 1, at most the number of cells
 * @return per cell, the number of its part, 0 to parts - 1
 *
 * The parts are not reproducible: PT-Scotch works with threads, and two calls, also of two runs of
 * one program, give different parts, about as good.
 *
 * Throws Error for numbers of parts out of range and where PETSc has no PT-Scotch.
 *
 * Source: C. Chevalier, F. Pellegrini, PT-Scotch: a tool for efficient parallel graph ordering,
 * Parallel Computing 34 (2008), through PETSc's MatPartitioning.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<int> partitionGraph(const Mesh& mesh, int parts);
}
#endif
