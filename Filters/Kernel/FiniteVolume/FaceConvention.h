// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceConvention.h
 * @brief The definitions of face centers in the two OpenFOAM variants.
 */
#ifndef tautline_FaceConvention_h
#define tautline_FaceConvention_h

namespace tautline
{
/// The weights of the triangles of a face in its center. They differ for warped faces only.
enum class FaceConvention : int
{
  Esi = 0,       ///< by the magnitude of their area vectors: OpenFOAM of openfoam.com
  Foundation = 1 ///< by the component of the area vectors along S: OpenFOAM of openfoam.org
};
}
#endif
