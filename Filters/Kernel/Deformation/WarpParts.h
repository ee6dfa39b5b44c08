// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpParts.h
 * @brief The prescribed points of a mesh, its connected parts, and the affine motion of each.
 * Internal: not installed.
 */
#ifndef tautline_WarpParts_h
#define tautline_WarpParts_h

#include "WarpWalls.h"
#include "tautline/Mesh/Ranks.h"

#include <array>

namespace tautline
{
/// x -> offset + linear (x - center), a displacement.
struct AffineMotion
{
  Vec3 center = { 0, 0, 0 };
  Vec3 offset = { 0, 0, 0 };
  std::array<Vec3, 3> linear = {}; ///< derivatives along x, y, z

  Vec3 at(const Vec3& x) const
  {
    const Vec3 d = x - this->center;
    return this->offset + d[0] * this->linear[0] + d[1] * this->linear[1] + d[2] * this->linear[2];
  }
};

/// A point with a given displacement.
struct PrescribedPoint
{
  Index id;
  std::array<double, 3> place, displacement;
  WallPoint wall;
};

/**
 * @class tautline::WarpParts
 * @brief Classifies points as prescribed, free or held, and assigns them to parts of the mesh.
 * Parts are connected by cells and numbered by their smallest points.
 */
class WarpParts
{
public:
  /**
   * @param prescribed one flag per point; null, on one rank only: the points of the boundary
   * @param ranks counts are totals over all of them
   */
  WarpParts(const Mesh& mesh, const unsigned char* prescribed, const Ranks& ranks = {});

  const Ranks& ranks() const { return this->TheRanks; }
  /// The dimension of the whole mesh.
  Dimension dimension() const { return this->Dim; }

  const std::vector<unsigned char>& prescribed() const { return this->Prescribed; }
  /// The connected part of a point; -1 outside all cells.
  Index part(Index point) const { return this->Part[point]; }
  Index parts() const { return this->Count; }
  /// The number of parts without a prescribed point, which do not move.
  Index loose() const { return this->Loose; }
  Index prescribedPoints() const { return this->PrescribedPoints; }
  Index freePoints() const { return this->FreePoints; }
  /// 1 for points whose position is not an unknown: prescribed, outside all cells, or in a part
  /// that is loose.
  const std::vector<unsigned char>& held() const { return this->Held; }

  /// The prescribed points of several ranks, in the order of their ids. Collective.
  /// @param walls one per local point, see wallPoints(); or none
  std::vector<PrescribedPoint> prescribedOfAll(const MeshView& local, const double* displacement,
    const std::vector<WallPoint>& walls = {}) const;

  /// Whether each part has a prescribed point that moves at all.
  std::vector<char> moving(const double* displacement) const;

  /**
   * @brief For each part: the least-squares affine fit to the prescribed displacements; exact, up
   * to rounding, if they are affine. Derivatives in directions that the prescribed points do not
   * span are 0.
   * @param points of the mesh, 3 each
   */
  std::vector<AffineMotion> affine(const double* points, const double* displacement) const;

private:
  Ranks TheRanks;
  Dimension Dim;
  std::vector<unsigned char> Prescribed, Held;
  std::vector<Index> Part;
  Index Count = 0, Loose = 0, PrescribedPoints = 0, FreePoints = 0;
};
}
#endif
