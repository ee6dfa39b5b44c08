// SPDX-License-Identifier: BSD-3-Clause
#include "Redistribution.h"

#include "Processes.h"
#include "tautline/Solvers/GraphPartition.h"

#include <dlfcn.h>

namespace tautline
{
namespace
{
/**
 * @brief partitionPoints() of the library TautlineSolvers. The library is loaded here on demand,
 * because filters without a linear system need nothing else from it and it depends on PETSc. Throws
 * NotDivided if the library is not installed.
 */
PartitionPoints loadPartitionPoints()
{
  // Called here, so that the run path of this library is searched, not VTK's.
  void* const library = dlopen(TAUTLINE_SOLVERS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  void* const found = library ? dlsym(library, partitionPointsSymbol) : nullptr;
  if (!found)
  {
    throw NotDivided(
      std::string("The library " TAUTLINE_SOLVERS_LIBRARY " cannot be loaded: ") + dlerror());
  }
  return reinterpret_cast<PartitionPoints (*)()>(found)();
}
}

//------------------------------------------------------------------------------
std::vector<int> ownersByGraph(
  RankGroup& group, const MeshPiece& piece, Redistribution& how, std::string& why)
{
  if (!group.communicator())
  {
    throw Error("PT-Scotch needs processes that communicate by MPI: use a k-d tree.");
  }
  // The k-d tree first, so that the graph is spread evenly while PT-Scotch divides it.
  MeshPiece spread = piece;
  spread.divideAnew = true;
  const DistributedMesh mesh(group, spread);
  std::vector<int> ofLocal = mesh.owners();
  try
  {
    group.agree();
    ofLocal = loadPartitionPoints()(mesh, group.communicator());
  }
  catch (const NotDivided& error) // on all processes: the owners by the k-d tree are kept
  {
    how = Redistribution::KdTree;
    why = std::string(" ") + error.what();
  }
  std::vector<int> owners;
  for (const Index local : mesh.localOfPiece())
  {
    owners.push_back(local < 0 ? -1 : ofLocal[local]);
  }
  return owners;
}

//------------------------------------------------------------------------------
std::string dividedSentence(const RankGroup& group, Redistribution how, const std::string& why)
{
  return how == Redistribution::None
    ? ""
    : "The mesh was redistributed among " + std::to_string(group.size()) + " processes" +
      (how == Redistribution::PtScotch ? " by PT-Scotch." : ".") + why;
}
}
