// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GraphPartition.h
 * @brief Partitions a mesh with few neighboring cells in different parts, by PT-Scotch.
 */
#ifndef tautline_GraphPartition_h
#define tautline_GraphPartition_h

#include "tautline/Core/Communicator.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/SolversExport.h"

#include <vector>

namespace tautline
{
/// Thrown if PETSc has no PT-Scotch, or if PT-Scotch cannot divide a graph.
class TAUTLINE_SOLVERS_EXPORT NotDivided : public Error
{
public:
  using Error::Error;
};

/**
 * @brief Divides the graph of the cells, in which two cells are neighbors if they share an edge
 * (2D) or face (3D), into parts with about equal numbers of cells, cutting few edges of the graph.
 * Runs on this process alone.
 * @param parts at least 1, at most the number of cells
 * @return per cell, the number of its part, 0 to parts - 1
 *
 * The parts may differ between calls, with similar quality: the result of PT-Scotch depends on its
 * version and on the order of messages. It uses one thread, unless the environment variable
 * SCOTCH_PTHREAD_NUMBER specifies another number.
 *
 * Throws Error for numbers of parts out of range, and if PETSc has no PT-Scotch.
 *
 * Source: C. Chevalier, F. Pellegrini, PT-Scotch: a tool for efficient parallel graph ordering,
 * Parallel Computing 34 (2008), through PETSc's MatPartitioning.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<int> partitionGraph(const Mesh& mesh, int parts);

/**
 * @brief Divides the points of a distributed mesh among its ranks, by the graph in which two points
 * are neighbors if an element contains both: few points then have neighbors on another rank. The
 * weight of a point is the number of its elements, which determines the cost of its patch. All
 * ranks divide the graph together.
 * @param communicator the MPI communicator, with the ranks of the mesh group
 * @return per local point: the rank that must own it (MeshPiece::owners), or its current owner if
 * there are fewer points than ranks
 *
 * As with partitionGraph(), the division may differ between calls. Throws NotDivided on all ranks
 * if PETSc has no PT-Scotch or too few bits for the numbers. Collective.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<int> partitionPoints(
  const DistributedMesh& mesh, Communicator communicator);

/// The type of partitionPoints(), and the C function that returns it, for loading this library at
/// run time.
using PartitionPoints = std::vector<int> (*)(const DistributedMesh&, Communicator);
constexpr const char* partitionPointsSymbol = "tautlinePartitionPoints";
}
#endif
