// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferOverlaps.h
 * @brief Which simplices of two meshes overlap, and by how much.
 * Internal: not installed.
 */
#ifndef tautline_TransferOverlaps_h
#define tautline_TransferOverlaps_h

#include "TransferMesh.h"

#include "tautline/Geometry/BoxTree.h"
#include "tautline/Geometry/SimplexOverlap.h"

#include <vector>

namespace tautline
{
/// The common space of two meshes.
enum class TransferSpace
{
  Plane,   ///< triangles in the plane of x and y
  Surface, ///< triangles in space
  Volume
};

/// The overlap of a source simplex with a target simplex.
struct TransferOverlap
{
  Index simplex; ///< of the source
  double size;   ///< area or volume in common
};

/**
 * @brief A target simplex and its intersections with source simplices; on surfaces, in projection
 * along its normal.
 * @tparam N 3 or 4 corners
 */
template <int N>
class TransferView
{
public:
  TransferView(const TransferMesh& target, Index simplex, TransferSpace space);

  /// The intersection with a source simplex.
  SimplexOverlap<N> with(const TransferMesh& source, Index simplex) const;
  /// 1, or -1 if a simplex of a surface is seen from behind, or 0 if it is too steep.
  int side(const TransferMesh& source, Index simplex) const;
  /// The height of a surface simplex along the normal at the given barycentric coordinates.
  double heightOf(
    const TransferMesh& source, Index simplex, const std::array<double, N>& coordinates) const;

private:
  SimplexCorners<N> project(const TransferMesh& mesh, Index simplex) const;

  TransferSpace Space;
  Vec3 Origin = { 0, 0, 0 }, First = { 1, 0, 0 }, Second = { 0, 1, 0 }, Normal = { 0, 0, 1 };
  SimplexCorners<N> Corners;
};

struct TransferOverlaps
{
  TransferSpace space = TransferSpace::Volume;
  std::vector<Index> starts; ///< of the overlaps of each simplex of the target, and the end
  /// In increasing order of the source simplices. If the target covers a source simplex, its
  /// overlap sizes are scaled by `scales` so that they sum to its size.
  std::vector<TransferOverlap> overlaps;
  std::vector<double> scales;        ///< per simplex of the source
  std::vector<double> coveredTarget; ///< per simplex: the sum of the sizes, scaled
  std::vector<double> coveredSource; ///< per simplex, scaled
  /// Whether a simplex is covered, up to rounding; on surfaces, up to the curvature.
  std::vector<unsigned char> sourceIsCovered, targetIsCovered;
};

/// The longest edge of a simplex.
double longestEdge(const TransferMesh& mesh, Index simplex);

BoundingBox boxOf(const TransferMesh& mesh, Index simplex);

/**
 * @brief All overlaps of two meshes of the same dimension; in the plane both have z = 0. The result
 * does not depend on the number of threads.
 *
 * On surfaces, a source triangle overlaps a target triangle if their normals differ by at most 60
 * degrees, it is on the side of most overlaps (so that the two sides of a plate are not mixed), and
 * its distance along the normal is at most a quarter of their longest edges.
 */
TransferOverlaps findOverlaps(const TransferMesh& target, const BoxTree& tree,
  const TransferMesh& source, TransferSpace space, int threads);
}
#endif
