// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferLocator.h
 * @brief The position in a mesh nearest to a point.
 * Internal: not installed.
 */
#ifndef tautline_TransferLocator_h
#define tautline_TransferLocator_h

#include "TransferMesh.h"

#include "tautline/Geometry/BoxTree.h"

#include <memory>
#include <vector>

namespace tautline
{
/// A position in a mesh.
struct TransferPlace
{
  Index simplex = -1;
  std::array<double, 4> weights = { 0, 0, 0, 0 }; ///< of its corners, at least 0, their sum is 1
};

/// Locates positions in the simplices of a mesh, and its points. The mesh must have a simplex and
/// outlive the locator.
class TransferLocator
{
public:
  explicit TransferLocator(const TransferMesh& mesh);

  /// The boxes of the simplices.
  const BoxTree& tree() const { return this->Tree; }
  /// The position nearest to x: x itself if it is inside the mesh.
  TransferPlace nearest(const Vec3& x) const;
  /// The point of a simplex nearest to x.
  Index nearestPoint(const Vec3& x) const;

private:
  double squaredDistance(Index simplex, const Vec3& x, Vec3& place) const;

  const TransferMesh& Mesh;
  BoxTree Tree;
  std::vector<Index> Used; ///< the points of simplices
  BoxTree Points;          ///< of these
};
}
#endif
