// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Warp.h
 * @brief Deforms the interior of a mesh to follow a prescribed boundary motion: FEMWARP,
 * anisotropic FEMWARP, the hybrid algorithm of section 4.9, and the methods they are compared with.
 *
 * Example: the boundary has moved, the interior follows.
 *
 *     tautline::Warper warper(mesh, options);             // keeps what can be reused
 *     tautline::WarpResult result = warper.warp(displacement); // 3 per point
 */
#ifndef tautline_Warp_h
#define tautline_Warp_h

#include "WarpOptions.h"
#include "tautline/Core/Communicator.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/SolversExport.h"

#include <functional>
#include <memory>

namespace tautline
{
/**
 * @class tautline::Warper
 * @brief Deforms a mesh; keeps matrices, preconditioners and previous solutions for the next
 * boundary position.
 */
class TAUTLINE_SOLVERS_EXPORT Warper
{
public:
  /**
   * @brief The mesh and the arrays of the options must outlive this object. On a surface in space,
   * an element is inverted if it is folded over its neighbors; untangling runs on one rank and is
   * not followed by optimization. Throws Error for invalid elements (stating their number and the
   * first), curved cells (which vtkMeshWarp supports), no prescribed point, and options out of
   * range.
   */
  Warper(const Mesh& mesh, const WarpOptions& options);

  /**
   * @brief The same for a mesh on several ranks. Collective, as is warp() then. Points,
   * displacements and flags are local, and a prescribed point must be prescribed, with the same
   * displacement, on all ranks that have it. The numbers in the result refer to the whole mesh.
   * Untangling and optimization use untangle() and optimize() on several ranks, whose order does
   * not depend on the ranks.
   * @param mesh must outlive this object; a volume, or planar and perpendicular to an axis; all
   * cells of one dimension. Its points are modified within warp() and restored when it returns.
   * @param mirrored all elements are reversed, see Mesh::setMirrored(); the same on all ranks
   * @param communicator the MPI communicator with the ranks of the mesh
   * @param ids one per local point: the pointwise methods use the prescribed points in this order
   * @param options prescribed is required; tensors refer to local cells and are the same on all
   * ranks that have a cell
   */
  Warper(DistributedMesh& mesh, bool mirrored, std::vector<Index> ids, Communicator communicator,
    const WarpOptions& options);
  ~Warper();

  /**
   * @brief The positions of all points after the prescribed ones have moved by `displacement` (3
   * per point of the mesh; only prescribed points are read). Throws Error for displacements that
   * are not finite (stating their number and the first point) or lead out of the plane of a planar
   * mesh.
   */
  WarpResult warp(const double* displacement);

  /**
   * @brief The same for a boundary that does not move along straight lines: `motion(amount,
   * displacement)` writes the displacements of the prescribed points from the mesh at an amount of
   * the motion, 0 < amount <= 1. Only matters with more than one step.
   */
  WarpResult warp(const std::function<void(double amount, double* displacement)>& motion);

  /// Replaces the time limit of the options, for subsequent calls; 0: none.
  void setMaximumSeconds(double seconds);

private:
  struct Local;
  struct Implementation;
  std::unique_ptr<Local> Here; ///< null on one rank
  std::unique_ptr<Implementation> Impl;
};
}
#endif
