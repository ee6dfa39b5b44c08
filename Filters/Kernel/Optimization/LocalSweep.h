// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalSweep.h
 * @brief Sweeps over the free vertices that move one after the other, given where the others are by
 * then.
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
    0; ///< of the gradients each vertex saw, over those visited; per length of the mesh
};

/**
 * @brief The order in which a sweep moves the vertices: sets of groups, one set after the other.
 * The groups of a set move at the same time, the vertices of a group one after the other.
 *
 * On one process the groups are coloured blocks (VertexBlocks). On several ranks they are single
 * vertices that a rank owns, in sets without a common cell (DistributedMesh::independentSets()):
 * the order does not depend on how the mesh is cut.
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
  std::vector<std::int32_t> Begins;           ///< the first vertex of each group
  std::int32_t Size = 1;                      ///< vertices of a group, except the last one
  Index GroupsPerTask = 1;                    ///< that a thread moves at a time
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
   * @param order null: that of this process alone
   */
  LocalSweeper(SimplexMesh& simplices, const Mesh& mesh, double* points,
    const std::vector<LocalTerm>& terms, const LocalOptions& options,
    const SweepOrder* order = nullptr);
  ~LocalSweeper();

  /**
   * @brief One sweep, of the whole mesh. Objective values in `values` are those of the mesh before
   * and, up to rounding, after; on several ranks a single one is not updated. A step is taken if it
   * reduces the scalarized objective.
   */
  SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values);

  /// Sets how many steps the next sweeps make at each vertex.
  void setPatchIterations(int count);
  /// Lets all vertices move again, whatever was culled.
  void wakeAll();
  /// The next sweep visits the vertices with a flag other than 0 only, one per free vertex; those
  /// after it also what culling adds.
  void wakeOnly(std::vector<unsigned char> active);

private:
  struct Base;
  template <int Dim>
  struct Implementation;
  std::unique_ptr<Base> Impl;
};
}
#endif
