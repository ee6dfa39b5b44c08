// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceMotion.h
 * @brief Converts displacements and points of pieces to the points of one mesh.
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
  std::vector<double> displacement; ///< 3 per local point, scaled; 0 where not chosen
  Index broken = 0;                 ///< points of the mesh with a displacement that is not finite
  double farthest = 0;              ///< largest difference between the pieces' values for one point
};

/// The number of points, on all processes, whose flag (one per local point) is set. Collective.
Index countOwned(const DistributedMesh& mesh, const PointFlags& flags);

/// The length of the diagonal of the box around a mesh.
double diagonalOf(const DistributedMesh& mesh);

/**
 * @brief The displacements of local points, from the displacements of the piece's points. For
 * points of several pieces the smallest value of each component is used, which does not depend on
 * the processes. Empty if a displacement is not finite. Collective.
 * @param chosen one flag per local point; others are not evaluated
 * @param displacementOf returns the displacement of a point of the piece
 */
PieceMotion motionOfPieces(const MovableMesh& mesh, const PointFlags& chosen, double amount,
  const std::function<Vec3(Index)>& displacementOf);

/// Coordinates of local points from the coordinates of the pieces, which agree for shared points,
/// as returned by MovableMesh::ofPiece(). Collective.
std::vector<double> localPoints(const MovableMesh& mesh, const std::vector<double>& ofPiece);

/// Replaces the points of a mesh in place, also for its views, for the lifetime of this object.
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
