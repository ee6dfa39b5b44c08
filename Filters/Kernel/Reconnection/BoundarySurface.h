// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundarySurface.h
 * @brief The input boundary, to which the boundary of a changing tetrahedral mesh stays close.
 * Internal: not installed.
 */
#ifndef tautline_BoundarySurface_h
#define tautline_BoundarySurface_h

#include "ReconnectionInput.h"
#include "ReconnectionResult.h"
#include "SmoothPart.h"
#include "StarSmoothing.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief Patches and curves (Features) of the outer boundary of the input, made of its facets.
 *
 * Points stay on their patch or curve; a facet belongs to the patch that all its points touch, and
 * stays within a distance and an angle of it; the input stays within 1.25 times this distance of
 * the facets. Corners closer to each other than the distance may be merged. Immutable after
 * construction, so that threads can share it.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT BoundarySurface
{
public:
  /// @param mesh with the points of `input` and the cells of the mesh it was converted from
  BoundarySurface(
    const Mesh& mesh, const TetrahedronMesh& changing, const ReconnectionOptions& options);

  /// Per point of the input: its freedom. Points between regions are fixed.
  const std::vector<PointFreedom>& freedoms() const { return this->Freedoms; }

  Vec3 closest(const Vec3& x, const PointFreedom& freedom) const
  {
    return this->Parts[freedom.part].closest(x);
  }
  /// The freedom of a point at x with the local direction: the normal of the patch or the tangent
  /// of the curve.
  PointFreedom at(const Vec3& x, PointFreedom freedom) const;
  /// The freedom of a point in a patch.
  PointFreedom inPatch(int patch) const;
  /// Whether the two touch a common patch.
  bool touches(const PointFreedom& freedom, int patch) const;
  /// Whether a point at x, on a corner or curve, may be contracted into a corner at y: both are
  /// corners of a group, or the curve point is near and the corner touches all its patches.
  bool joins(const Vec3& x, const PointFreedom& from, const Vec3& y, const PointFreedom& to) const;
  /// The patch of a boundary facet: the nearest of the patches that all three points touch; -1 if
  /// there is none.
  int patchOf(const std::array<Vec3, 3>& x, const std::array<PointFreedom, 3>& freedoms) const;
  /**
   * @brief Whether a facet, in the order of TetrahedronMesh::face(), is close to a patch at its
   * center and at the middles of its edges, and has the mean orientation of the patch there.
   */
  bool accepts(const std::array<Vec3, 3>& x, int patch) const;

  using Facet = std::array<Vec3, 3>;
  /**
   * @brief Whether facets may be replaced by others with the same border: samples of the input
   * boundary (corners, edge middles, centers) that are within a bound of the former facets must be
   * within it of the new ones. Thus, all samples stay within this bound: 1.25 times the distance.
   */
  bool keepsPoints(const std::vector<Facet>& former, const std::vector<Facet>& facets) const;

  /// The largest distance, in either direction, between the outer boundaries of the mesh and the
  /// input, at corners, edge middles and centers of facets.
  double distance(const TetrahedronMesh& changed) const;

private:
  /// Points in the cells of a grid.
  class PointGrid
  {
  public:
    void build(std::vector<Vec3> points);
    /// Calls visit(x) for the points in a box until it returns false. @return whether none did
    template <class Visit>
    bool all(const Vec3& low, const Vec3& high, const Visit& visit) const;

  private:
    std::array<Index, 3> cellOf(const Vec3& x) const;

    Vec3 Low = { 0, 0, 0 };
    double Size = 1; ///< of a cell
    std::array<Index, 3> Counts = { 0, 0, 0 };
    std::vector<Index> Starts; ///< per cell, of its points
    std::vector<Vec3> Points;
  };

  void groupCorners(const Features& features, const TetrahedronMesh& changing,
    std::vector<std::vector<std::int32_t>>& touched);

  std::vector<SmoothPart> Parts;        ///< first the patches, then the curves
  std::vector<SurfaceProjection> Whole; ///< one: the boundary
  PointGrid Kept;                       ///< samples that must stay near
  double Distance = 0.0;                ///< the largest distance of facets from the input
  int Patches = 0;
  std::vector<PointFreedom> Freedoms;
  std::vector<std::vector<std::int32_t>> Sets; ///< of patches; the first sets have one patch each
  double Cosine = 0;
  double Sense = 1; ///< -1: the facets of the patches are in the opposite order
};
}
#endif
