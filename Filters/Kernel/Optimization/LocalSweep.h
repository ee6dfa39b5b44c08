// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalSweep.h
 * @brief Sweeps over the free vertices that move one after the other, given where the others are by
 * then. Internal: not installed.
 */
#ifndef tautline_LocalSweep_h
#define tautline_LocalSweep_h

#include "LocalOptions.h"
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

class TAUTLINE_KERNEL_EXPORT LocalSweeper
{
public:
  /**
   * @param points 3 per point of `mesh`, kept up to date with the simplex mesh if a term needs it;
   * `mesh` is a mesh whose view has these points
   */
  LocalSweeper(SimplexMesh& simplices, const Mesh& mesh, double* points,
    const std::vector<LocalTerm>& terms, const LocalOptions& options);
  ~LocalSweeper();

  /**
   * @brief One sweep. Objective values in `values` are those of the mesh before and, up to
   * rounding, after. A step is taken if it reduces the scalarized objective.
   */
  SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values);

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
