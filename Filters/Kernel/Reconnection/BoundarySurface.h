// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundarySurface.h
 * @brief The boundary of the input that the boundary of a changing tetrahedral mesh stays close to.
 * Internal: not installed.
 */
#ifndef tautline_BoundarySurface_h
#define tautline_BoundarySurface_h

#include "ReconnectionInput.h"
#include "ReconnectionResult.h"
#include "StarSmoothing.h"
#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief Patches and curves (Features) of the outer boundary of the input, made of its facets.
 *
 * Points keep to their patch or curve; a facet has the patch that all its points touch, and stays
 * within a distance and an angle of it. Not changed after construction: threads share it.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT BoundarySurface
{
public:
  /// @param mesh with the points of `input` and the cells of the mesh it was converted from
  BoundarySurface(
    const Mesh& mesh, const TetrahedronMesh& changing, const ReconnectionOptions& options);

  /// Per point of the input: what it may do. Points between regions are fixed.
  const std::vector<PointFreedom>& freedoms() const { return this->Freedoms; }

  Vec3 closest(const Vec3& x, const PointFreedom& freedom) const
  {
    return this->Parts[freedom.part].closest(x);
  }
  /// The freedom of a point at x with the direction there: normal of the patch, tangent of a curve.
  PointFreedom at(const Vec3& x, PointFreedom freedom) const;
  /// That of a point in a patch.
  PointFreedom inPatch(int patch) const;
  /// Whether the two touch a common patch.
  bool touches(const PointFreedom& freedom, int patch) const;
  /// The patch of a facet on the boundary: at its place, of those that all three points touch; -1
  /// if there is none.
  int patchOf(const std::array<Vec3, 3>& x, const std::array<PointFreedom, 3>& freedoms) const;
  /**
   * @brief Whether a facet, in the order of TetrahedronMesh::face(), is close to a patch at its
   * centre and the middles of its edges, and turned as the patch is there on average.
   */
  bool accepts(const std::array<Vec3, 3>& x, int patch) const;

  /// The largest distance of the outer boundary of the mesh from that of the input, and back, at
  /// corners, middles of edges and centres of facets.
  double distance(const TetrahedronMesh& changed) const;

private:
  std::vector<SurfaceProjection> Parts; ///< first the patches, then the curves
  std::vector<SurfaceProjection> Whole; ///< one: the boundary
  int Patches = 0;
  std::vector<PointFreedom> Freedoms;
  std::vector<std::vector<std::int32_t>> Sets; ///< of patches; the first ones have one patch each
  double Distance = 0, Cosine = 0;
  double Sense = 1; ///< -1: the facets of the patches are in the other order
};
}
#endif
