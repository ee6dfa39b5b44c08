// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalSweep.h
 * @brief Sweeps over the free vertices, which move one after the other given the current positions
 * of the others.
 * Internal: not installed.
 */
#ifndef tautline_LocalSweep_h
#define tautline_LocalSweep_h

#include "LocalOptions.h"
#include "tautline/Mesh/Ranks.h"
#include "tautline/Objectives/Scalarization.h"

#include <memory>

namespace tautline
{
struct SweepResult
{
  Index visited = 0;
  Index moved = 0;
  double gradientNorm =
    /// norm of the gradients at the time of each visit, over the visited vertices; per length of
    /// the mesh
    0;
};

/**
 * @brief The order in which a sweep moves the vertices: sets of groups, one set after the other.
 * The groups of a set move concurrently, the vertices of a group one after the other.
 *
 * On one process, the groups are colored blocks (VertexBlocks). On several ranks, they are single
 * owned vertices, in sets without a common cell (DistributedMesh::independentSets()): the order
 * does not depend on the decomposition.
 */
class TAUTLINE_KERNEL_EXPORT SweepOrder
{
public:
  /// Collective.
  explicit SweepOrder(const SimplexMesh& simplices, const Ranks& ranks = {});

private:
  friend class LocalSweeper;
  void findSets(const SimplexMesh& simplices);

  Ranks TheRanks;
  std::vector<std::int32_t> Begins; ///< the first vertex of each group
  /// number of vertices of a group, except the last one
  std::int32_t Size = 1;
  Index GroupsPerTask = 1;                    ///< number of groups that a thread moves at a time
  std::vector<std::int32_t> SetStarts;        ///< into Begins, and its end
  std::vector<DistributedMesh::Subset> Halos; ///< of each set
  std::vector<std::int32_t> VertexOf;         ///< per local point; -1: not free
};

class TAUTLINE_KERNEL_EXPORT LocalSweeper
{
public:
  /**
   * @param points 3 per point of `mesh`, kept up to date with the simplex mesh if a term needs it;
   * `mesh` is a mesh whose view has these points
   * @param order null: the order of a single process
   */
  LocalSweeper(SimplexMesh& simplices, const Mesh& mesh, double* points,
    const std::vector<LocalTerm>& terms, const LocalOptions& options,
    const SweepOrder* order = nullptr);
  ~LocalSweeper();

  /**
   * @brief One sweep over the whole mesh. `values` has the objective values of the mesh before and,
   * up to rounding, after; on several ranks, a single value is not updated. A step is accepted if
   * it reduces the scalarized objective.
   */
  SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values);

  /// Sets the number of steps at each vertex in the next sweeps.
  void setPatchIterations(int count);
  /// Reactivates all vertices, including culled ones.
  void wakeAll();
  /// The next sweep only visits the vertices with a nonzero flag, one per free vertex; later sweeps
  /// also visit the vertices that culling adds.
  void wakeOnly(std::vector<unsigned char> active);

private:
  struct Base;
  template <int Dim>
  struct Implementation;
  std::unique_ptr<Base> Impl;
};
}
#endif
