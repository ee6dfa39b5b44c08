// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceConvention.h
 * @brief How the two OpenFOAMs compute the center of a face.
 */
#ifndef tautline_FaceConvention_h
#define tautline_FaceConvention_h

namespace tautline
{
/// How the triangles of a face weigh in its center. They differ for warped faces only.
enum class FaceConvention : int
{
  Esi = 0,       ///< by the magnitude of their area vectors: OpenFOAM of openfoam.com
  Foundation = 1 ///< by the component of these along S: OpenFOAM of openfoam.org
};
}
#endif
