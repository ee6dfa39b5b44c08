// SPDX-License-Identifier: BSD-3-Clause
#include "GraphPartition.h"

#include "PetscSession.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Mesh/FacetTable.h"
#include "tautline/Ranks/RankExchange.h"

#include <petscmat.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numeric>

namespace tautline
{
namespace
{
using PetscPartitioning = PetscHandle<MatPartitioning, MatPartitioningDestroy>;
using PetscIndices = PetscHandle<IS, ISDestroy>;

/// Pairs of cells with a common facet, in both orders.
std::vector<std::pair<Index, Index>> neighbours(const Mesh& mesh)
{
  std::vector<std::pair<Index, Index>> pairs;
  FacetTable facets(mesh);
  facets.forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
      // If more than two cells share a facet, edges between consecutive ones suffice to connect
      // them.
      for (Index i = 1; i < count; ++i)
      {
        pairs.emplace_back(uses[i - 1].cell, uses[i].cell);
        pairs.emplace_back(uses[i].cell, uses[i - 1].cell);
      }
    });
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// An array that PETSc takes over and frees.
PetscInt* petscArray(std::size_t size)
{
  PetscInt* array = nullptr;
  // An additional entry, because PETSc returns null for an empty array.
  petsc(PetscMalloc1(size + 1, &array));
  return array;
}

/// The graph in PETSc's format, whose arrays PETSc frees.
PetscMatrix graphOf(Index cells, const std::vector<std::pair<Index, Index>>& pairs)
{
  PetscInt *offsets = petscArray(cells + 1), *columns = petscArray(pairs.size());
  std::fill(offsets, offsets + cells + 1, 0);
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    ++offsets[pairs[i].first + 1];
    columns[i] = static_cast<PetscInt>(pairs[i].second);
  }
  std::partial_sum(offsets, offsets + cells + 1, offsets);
  PetscMatrix graph;
  const auto size = static_cast<PetscInt>(cells);
  petsc(MatCreateMPIAdj(PETSC_COMM_SELF, size, size, offsets, columns, nullptr, graph.out()));
  return graph;
}

/**
 * @brief Makes PT-Scotch use one thread from now on, unless the environment specifies a number.
 *
 * Its threads call MPI concurrently (when it divides copies of a graph, on four ranks or more),
 * which requires MPI_THREAD_MULTIPLE; ParaView's MPI has MPI_THREAD_SINGLE, and crashes or hangs.
 * PETSc has no option for this, so the environment variable that Scotch reads is set once.
 */
void useOneThread()
{
  static const bool done = setenv("SCOTCH_PTHREAD_NUMBER", "1", 0) == 0;
  if (!done)
  {
    throw Error("The environment variable SCOTCH_PTHREAD_NUMBER cannot be set: out of memory.");
  }
}

/// The parts of the vertices of this rank.
/// @param weights from petscArray(), or null: all are equal
std::vector<int> partsOf(
  MPI_Comm comm, const PetscMatrix& graph, Index vertices, PetscInt* weights, int parts)
{
  useOneThread();
  PetscPartitioning partitioning;
  petsc(MatPartitioningCreate(comm, partitioning.out()));
  if (weights) // taken over before anything can fail
  {
    petsc(MatPartitioningSetVertexWeights(partitioning, weights));
  }
  petsc(MatPartitioningSetAdjacency(partitioning, graph));
  petsc(MatPartitioningSetType(partitioning, MATPARTITIONINGPTSCOTCH));
  petsc(MatPartitioningSetNParts(partitioning, parts));
  PetscIndices found;
  petsc(MatPartitioningApply(partitioning, found.out()));
  const PetscInt* values = nullptr;
  petsc(ISGetIndices(found, &values));
  std::vector<int> result(values, values + vertices);
  petsc(ISRestoreIndices(found, &values));
  return result;
}

[[noreturn]] void throwNotDivided(const PetscError& error)
{
  throw NotDivided(std::string("PT-Scotch, through PETSc, failed to divide the mesh (") +
    error.what() + "): use a k-d tree, or a PETSc with PT-Scotch.");
}

/// The owned points, numbered consecutively over the ranks, and their neighbors.
struct PointGraph
{
  std::vector<Index> offsets = { 0 }, neighbours, weights;
};

PointGraph pointGraph(const DistributedMesh& mesh)
{
  Index own = 0, first = 0;
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    own += mesh.owned(p);
  }
  // PETSc requires that the owned points are numbered consecutively, rank by rank.
  const auto counts = mesh.group().gatherItems(std::vector<Index>{ own });
  for (int rank = 0; rank < mesh.group().rank(); ++rank)
  {
    first += counts[rank][0];
  }
  // Halo exchanges send doubles, which represent these integers exactly.
  std::vector<double> numbers(mesh.localPoints(), 0.0);
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    numbers[p] = mesh.owned(p) ? static_cast<double>(first++) : 0.0;
  }
  mesh.exchange(numbers.data(), 1);
  PointGraph graph;
  mesh.group().together(
    [&]
    {
      const MeshView& view = mesh.view();
      const VertexCells cells = Mesh(view).vertexCells();
      std::vector<Index> around;
      for (Index p = 0; p < mesh.localPoints(); ++p)
      {
        pollInterruption(p);
        if (!mesh.owned(p))
        {
          continue;
        }
        around.clear();
        for (Index i = cells.offsets[p]; i < cells.offsets[p + 1]; ++i)
        {
          const Index cell = cells.cells[i];
          const int corners = topology(cornerType(view.cellTypes[cell])).nodes;
          for (Index n = view.offsets[cell]; n < view.offsets[cell] + corners; ++n)
          {
            if (view.connectivity[n] != p)
            {
              around.push_back(static_cast<Index>(numbers[view.connectivity[n]]));
            }
          }
        }
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        graph.neighbours.insert(graph.neighbours.end(), around.begin(), around.end());
        graph.offsets.push_back(static_cast<Index>(graph.neighbours.size()));
        // The work of a point is about proportional to the number of its cells.
        graph.weights.push_back(cells.offsets[p + 1] - cells.offsets[p]);
      }
    });
  // PT-Scotch sums neighbors and weights over all ranks.
  constexpr Index most = std::numeric_limits<PetscInt>::max();
  const Index weight = std::accumulate(graph.weights.begin(), graph.weights.end(), Index(0));
  if (std::max({ mesh.globalPoints(), mesh.group().sum(graph.offsets.back()),
        mesh.group().sum(weight) }) > most)
  {
    throw NotDivided("The mesh is too large for PETSc's 32-bit numbers: use a k-d tree, or a PETSc "
                     "with 64-bit indices.");
  }
  return graph;
}
}

//------------------------------------------------------------------------------
std::vector<int> partitionGraph(const Mesh& mesh, int parts)
{
  const Index cells = mesh.view().numberOfCells;
  if (parts < 1 || parts > cells)
  {
    throw Error("A mesh of " + std::to_string(cells) + " cells cannot have " +
      std::to_string(parts) + " parts: choose from 1 to the number of cells.");
  }
  if (parts == 1)
  {
    return std::vector<int>(cells, 0);
  }
  const auto pairs = neighbours(mesh);
  PetscScope scope;
  try
  {
    return partsOf(PETSC_COMM_SELF, graphOf(cells, pairs), cells, nullptr, parts);
  }
  catch (const PetscError& error)
  {
    throwNotDivided(error);
  }
}

//------------------------------------------------------------------------------
std::vector<int> partitionPoints(const DistributedMesh& mesh, Communicator communicator)
{
  const int ranks = mesh.group().size();
  if (ranks == 1 || mesh.globalPoints() < ranks)
  {
    return mesh.owners();
  }
  const PointGraph points = pointGraph(mesh);
  const auto own = static_cast<Index>(points.weights.size());
  std::vector<int> parts;
  // A failure on one rank before PETSc communicates fails on all.
  std::unique_ptr<PetscScope> scope;
  PetscInt *offsets = nullptr, *neighbours = nullptr, *weights = nullptr;
  mesh.group().together(
    [&]
    {
      scope = std::make_unique<PetscScope>();
      useOneThread();
      const auto petscCopy = [](const std::vector<Index>& numbers)
      {
        PetscInt* array = petscArray(numbers.size());
        std::transform(numbers.begin(), numbers.end(), array,
          [](Index number) { return static_cast<PetscInt>(number); });
        return array;
      };
      offsets = petscCopy(points.offsets);
      neighbours = petscCopy(points.neighbours);
      weights = petscCopy(points.weights);
    });
  try
  {
    const MPI_Comm comm = mpiOf(communicator);
    PetscMatrix graph;
    petsc(MatCreateMPIAdj(comm, static_cast<PetscInt>(own),
      static_cast<PetscInt>(mesh.globalPoints()), offsets, neighbours, nullptr, graph.out()));
    parts = partsOf(comm, graph, own, weights, ranks);
  }
  catch (const PetscError& error)
  {
    throwNotDivided(error);
  }
  std::vector<double> owners(mesh.localPoints(), 0.0);
  // The parts have the order of the owned points.
  auto part = parts.begin();
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    owners[p] = mesh.owned(p) ? *part++ : 0.0;
  }
  mesh.exchange(owners.data(), 1);
  return { owners.begin(), owners.end() };
}
}

extern "C" TAUTLINE_SOLVERS_EXPORT tautline::PartitionPoints tautlinePartitionPoints();
tautline::PartitionPoints tautlinePartitionPoints()
{
  return tautline::partitionPoints;
}
