// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankSweep.h
 * @brief Sweeps over the free vertices of a mesh on several ranks, in an order that does not depend
 * on how it is cut. Internal: not installed.
 */
#ifndef tautline_RankSweep_h
#define tautline_RankSweep_h

#include "OptimizationProblem.h"
#include "tautline/Mesh/DistributedMesh.h"

#include <memory>

namespace tautline
{
/// What sweeps minimize instead of the objectives of the problem, and how.
struct SweepTerms
{
  std::vector<LocalTerm> terms;
  LocalOptions options;
};

/**
 * @class tautline::RankSweeper
 * @brief Independent sets of vertices (DistributedMesh::independentSets()) move one after the
 * other; after each, the ranks exchange the coordinates of the set. All methods are collective.
 */
class TAUTLINE_KERNEL_EXPORT RankSweeper
{
public:
  /**
   * @param problem of the local part, with a SimplexFrame that all ranks have; null on a rank
   * without cells
   * @param sets per local point the number of its set, or -1 for a point that is fixed
   * @param other null: the objectives of the problem
   */
  RankSweeper(const DistributedMesh& mesh, OptimizationProblem* problem, std::vector<int> sets,
    int threads, const SweepTerms* other = nullptr);
  ~RankSweeper();

  /// One sweep of the whole mesh. `values` are the objectives before it; see LocalSweeper.
  SweepResult sweep(const Scalarizer& scalarizer, const std::vector<double>& values);
  /// Lets all vertices move again, whatever was culled.
  void wakeAll();
  /// The next sweep visits the vertices with a flag other than 0 only, one per free vertex. Not
  /// collective, not on a rank without a problem.
  void wakeOnly(std::vector<unsigned char> active);

private:
  struct Base;
  template <int Dim>
  struct Implementation;

  void exchangeSet(int set);

  const DistributedMesh& TheMesh;
  OptimizationProblem* Problem;
  std::vector<int> Sets;
  std::vector<DistributedMesh::Subset> Halos; ///< per set
  std::vector<std::vector<std::int32_t>> Own; ///< per set: the vertices that this rank moves
  std::vector<std::int32_t> VertexOf;         ///< per local point, -1: not free
  std::vector<double> Buffer;                 ///< x y z in the simplices' coordinates, moved
  std::unique_ptr<Base> Impl;
};
}
#endif
