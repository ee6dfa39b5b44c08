// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlaneState.h
 * @brief Plane strain or plane stress: the constraint on a 2D elastic body in the third direction.
 */
#ifndef tautline_PlaneState_h
#define tautline_PlaneState_h

namespace tautline
{
/// The constraint on a 2D elastic body in the third direction.
enum class PlaneState : int
{
  Strain = 0, ///< no strain: a slice of a long body
  Stress = 1  ///< no stress: a thin sheet
};
}
#endif
