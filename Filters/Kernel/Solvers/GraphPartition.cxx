// SPDX-License-Identifier: BSD-3-Clause
#include "GraphPartition.h"

#include "PetscSession.h"
#include "tautline/Mesh/FacetTable.h"

#include <petscmat.h>

namespace tautline
{
namespace
{
using PetscPartitioning = PetscHandle<MatPartitioning, MatPartitioningDestroy>;
using PetscIndices = PetscHandle<IS, ISDestroy>;

/// Pairs of cells with a common facet, both ways.
std::vector<std::pair<Index, Index>> neighbours(const Mesh& mesh)
{
  std::vector<std::pair<Index, Index>> pairs;
  FacetTable facets(mesh);
  facets.forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
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

/// The graph in PETSc's format, whose arrays PETSc frees.
PetscMatrix graphOf(Index cells, const std::vector<std::pair<Index, Index>>& pairs)
{
  PetscInt *offsets = nullptr, *columns = nullptr;
  petsc(PetscMalloc1(cells + 1, &offsets));
  petsc(PetscMalloc1(pairs.size() + 1, &columns));
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
}

//------------------------------------------------------------------------------
std::vector<int> partitionGraph(const Mesh& mesh, int parts)
{
  const Index cells = mesh.view().numberOfCells;
  if (parts < 1 || parts > cells)
  {
    throw Error("A mesh of " + std::to_string(cells) + " cells cannot have " +
      std::to_string(parts) + " parts: from 1 to the number of cells is allowed.");
  }
  std::vector<int> partOfCell(cells, 0);
  if (parts == 1)
  {
    return partOfCell;
  }
  const auto pairs = neighbours(mesh);
  PetscScope scope;
  try
  {
    const PetscMatrix graph = graphOf(cells, pairs);
    PetscPartitioning partitioning;
    petsc(MatPartitioningCreate(PETSC_COMM_SELF, partitioning.out()));
    petsc(MatPartitioningSetAdjacency(partitioning, graph));
    petsc(MatPartitioningSetType(partitioning, MATPARTITIONINGPTSCOTCH));
    petsc(MatPartitioningSetNParts(partitioning, parts));
    PetscIndices found;
    petsc(MatPartitioningApply(partitioning, found.out()));
    const PetscInt* values = nullptr;
    petsc(ISGetIndices(found, &values));
    std::copy_n(values, cells, partOfCell.begin());
    petsc(ISRestoreIndices(found, &values));
  }
  catch (const PetscError& error)
  {
    throw Error(std::string("PT-Scotch, through PETSc, has not divided the mesh (") + error.what() +
      "): take a k-d tree, or a PETSc with PT-Scotch.");
  }
  return partOfCell;
}
}
