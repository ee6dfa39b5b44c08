/**
 * @file WarpPath.h
 * @brief The way the prescribed points take to their places, where only the places are known.
 * Internal: not installed.
 */
#ifndef tautline_WarpPath_h
#define tautline_WarpPath_h

#include "WarpParts.h"

namespace tautline
{
/**
 * @class tautline::WarpPath
 * @brief Lets each connected piece of prescribed points turn, stretch and shift as the affine map
 * does that fits its displacements best, and what this leaves of them go straight. A piece that
 * turns does so rigidly, where straight ways would shrink it: half a turn would take it through a
 * point. Where the map mirrors, or leaves more than 5 % of the displacements (root mean square,
 * without the shift), all go straight.
 */
class WarpPath
{
public:
  WarpPath(const Mesh& mesh, const WarpParts& parts, const double* displacement);

  /// Displacements of the prescribed points after a part of the motion, 0 to 1; exact at 1. Others
  /// are 0.
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
  std::vector<Index> PieceOf; ///< per point, -1 where nothing is prescribed
  std::vector<Piece> Pieces;
};
}
#endif
