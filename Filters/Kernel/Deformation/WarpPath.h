// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpPath.h
 * @brief The path of the prescribed points if only its end is given.
 * Internal: not installed.
 */
#ifndef tautline_WarpPath_h
#define tautline_WarpPath_h

#include "WarpParts.h"

namespace tautline
{
/**
 * @class tautline::WarpPath
 * @brief Moves each connected component of prescribed points by the rotation, stretch and
 * translation of the affine map that fits its displacements best; the residual moves along straight
 * lines. A rotating component keeps its shape, whereas straight paths would shrink it (to a point
 * at half a turn). If the map mirrors, or if its residual exceeds 5 % of the displacements (root
 * mean square, without the translation), all points move along straight lines.
 */
class WarpPath
{
public:
  WarpPath(const Mesh& mesh, const WarpParts& parts, const double* displacement);

  /// Displacements of the prescribed points at an amount of the motion, 0 to 1; exact at 1.
  /// Displacements of other points are 0. 3 per point.
  void at(double amount, double* displacement) const;

private:
  struct Piece
  {
    Vec3 center = { 0, 0, 0 };
    Vec3 shift = { 0, 0, 0 };
    bool turns = false;
    Vec3 axis = { 0, 0, 1 };
    double angle = 0;
    std::array<Vec3, 3> stretch = {}; ///< columns of U - I, the map is R U
  };
  Vec3 place(const Piece& piece, double amount, const Vec3& x) const;

  const Mesh& Input;
  std::vector<double> Displacement;
  std::vector<Index> PieceOf; ///< per point, -1 if it is not prescribed
  std::vector<Piece> Pieces;
};
}
#endif
