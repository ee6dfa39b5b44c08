// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceMotion.h
 * @brief Displacements and points of pieces as those of the points of one mesh.
 */
#ifndef tautline_PieceMotion_h
#define tautline_PieceMotion_h

#include "MovedBoundary.h"
#include "tautline/Mesh/DistributedMesh.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tautline
{
class MovableMesh;

/// A motion of the points here.
struct PieceMotion
{
  std::vector<double> displacement; ///< 3 per local point, at the amount; 0 where none is chosen
  Index broken = 0;                 ///< points of the mesh with one that is not finite
  double farthest = 0; ///< the largest difference between what pieces give for one point
};

/// The points of all processes whose flag (one per local point) is set. Collective.
Index countOwned(const DistributedMesh& mesh, const PointFlags& flags);

/// The length of the diagonal of the box around a mesh.
double diagonalOf(const DistributedMesh& mesh);

/**
 * @brief The displacements of local points from those of the piece's. Of points that several pieces
 * have, of each component the least, which does not depend on the processes. Empty if one is
 * broken. Collective.
 * @param chosen one flag per local point: others are not asked for
 * @param displacementOf what a point of the piece moves by
 */
PieceMotion motionOfPieces(const MovableMesh& mesh, const PointFlags& chosen, double amount,
  const std::function<Vec3(Index)>& displacementOf);

/// Coordinates of local points from those of the pieces, which are the same for one point on all of
/// them, as MovableMesh::ofPiece() gives them. Collective.
std::vector<double> localPoints(const MovableMesh& mesh, const std::vector<double>& ofPiece);

/// A mesh with other points, in place, as views of it read them; until the end of its life.
class PlacedPoints
{
public:
  PlacedPoints(DistributedMesh& mesh, std::vector<double> points)
    : Placed(mesh)
    , Other(std::move(points))
  {
    this->exchange();
  }
  ~PlacedPoints() { this->exchange(); }
  PlacedPoints(const PlacedPoints&) = delete;
  PlacedPoints& operator=(const PlacedPoints&) = delete;

private:
  void exchange();

  DistributedMesh& Placed;
  std::vector<double> Other;
};
}
#endif
