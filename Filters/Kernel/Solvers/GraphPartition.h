// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GraphPartition.h
 * @brief Parts of a mesh with few neighbouring cells in different parts, by PT-Scotch.
 */
#ifndef tautline_GraphPartition_h
#define tautline_GraphPartition_h

#include "tautline/Core/Communicator.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/SolversExport.h"

#include <vector>

namespace tautline
{
/// PETSc has no PT-Scotch, or PT-Scotch cannot divide a graph.
class TAUTLINE_SOLVERS_EXPORT NotDivided : public Error
{
public:
  using Error::Error;
};

/**
 * @brief Divides the graph of the cells, of which two are neighbours if they share an edge (2D) or
 * face (3D), into parts of about as many cells, so that few edges of the graph are cut. This
 * process does it alone.
 * @param parts at least 1, at most the number of cells
 * @return per cell, the number of its part, 0 to parts - 1
 *
 * The parts may differ from call to call, about as good: what PT-Scotch makes depends on its
 * version and on the order of messages. It works with one thread, unless the environment variable
 * SCOTCH_PTHREAD_NUMBER states another number.
 *
 * Throws Error for numbers of parts out of range and where PETSc has no PT-Scotch.
 *
 * Source: C. Chevalier, F. Pellegrini, PT-Scotch: a tool for efficient parallel graph ordering,
 * Parallel Computing 34 (2008), through PETSc's MatPartitioning.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<int> partitionGraph(const Mesh& mesh, int parts);

/**
 * @brief Divides the points of a mesh on several ranks among these, by the graph in which two
 * points are neighbours if an element has both: few points then have neighbours on another rank.
 * The weight of a point is the number of its elements, which is what a patch costs. All ranks
 * divide the graph together.
 * @param communicator of MPI, with the ranks of the mesh's group
 * @return per local point the rank that shall own it (MeshPiece::owners); that of now, if there are
 * fewer points than ranks
 *
 * The division may differ from call to call, as that of partitionGraph(). Throws NotDivided on all
 * ranks where PETSc has no PT-Scotch, or too few bits for the numbers. Collective.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<int> partitionPoints(
  const DistributedMesh& mesh, Communicator communicator);

/// The type of partitionPoints(), and the C function that returns it, for those who load this
/// library at run time.
using PartitionPoints = std::vector<int> (*)(const DistributedMesh&, Communicator);
constexpr const char* partitionPointsSymbol = "tautlinePartitionPoints";
}
#endif
