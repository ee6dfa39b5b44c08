// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointMotion.h
 * @brief Motions of points along their exact paths: an arc for a rotation, a screw for a rigid
 * motion, decreasing radii for a bend. For parts of a boundary that a mesh follows (Warp.h).
 *
 * Example: the marked points, after a third of a rotation about an axis through their center.
 *
 *     tautline::PointMotion motion;
 *     motion.kind = tautline::MotionKind::Rotation;
 *     motion.angle = 90; // degrees
 *     std::vector<double> d = tautline::displacements(motion, 1.0 / 3, n, xyz, marks);
 */
#ifndef tautline_PointMotion_h
#define tautline_PointMotion_h

#include "tautline/Core/Types.h"
#include "tautline/SolversExport.h"

#include <vector>

namespace tautline
{
/// The kinds of motion; the numbers are stable: ParaView state files hold them.
enum class MotionKind : int
{
  /**
   * @brief Any affine map without reflection: stretch about the center of the points, then a
   * rotation and a translation along a screw. For points in one plane, only the in-plane effect is
   * used.
   */
  Matrix = 0,
  Translation = 1,
  Rotation = 2, ///< by `angle` about `axis` through the center
  Scaling = 3,  ///< by `factors` along the coordinate axes, from the center
  /**
   * @brief A bar along `direction` becomes an arc of `angle` about `axis`; the line through the
   * center keeps its length. The bar is clamped where the points begin (ownCenter), or at the
   * center; points before this position do not move.
   */
  Bending = 4
};

/// A motion; each kind uses the members mentioned in its description.
struct PointMotion
{
  MotionKind kind = MotionKind::Matrix;
  std::array<double, 16> matrix = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }; ///< by rows
  Vec3 translation = { 0, 0, 0 };
  double angle = 0.0; ///< degrees; any value, including more than a full turn
  Vec3 axis = { 0, 0, 1 };
  Vec3 factors = { 1, 1, 1 };
  Vec3 direction = { 1, 0, 0 }; ///< of a bar to bend; its component along the axis is ignored
  bool ownCenter = true; ///< use the center of the box around the moved points instead of `center`
  Vec3 center = { 0, 0, 0 };
};

/**
 * @brief Displacements of the points with a nonzero flag, 3 per point; 0 for the others.
 * @param amount 0 is the start, 1 the whole motion; larger values continue it
 * @param points 3 coordinates per point
 * @param moved one flag per point
 *
 * Throws Error for numbers that are not finite, an axis or a direction of length 0, factors that
 * are not positive, and matrices that mirror, flatten or are not affine.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> displacements(const PointMotion& motion, double amount,
  Index numberOfPoints, const double* points, const unsigned char* moved);
}
#endif
