// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Materials.h
 * @brief The coefficients of diffusion and of linear elasticity.
 */
#ifndef tautline_Materials_h
#define tautline_Materials_h

#include "tautline/Core/PlaneState.h"
#include "tautline/Core/Types.h"

namespace tautline
{
/// A symmetric tensor: xx yy zz xy yz xz, the order of VTK's arrays of symmetric tensors.
using SymmetricTensor = std::array<double, 6>;

constexpr SymmetricTensor IdentityTensor = { 1, 1, 1, 0, 0, 0 };

/// The operator -div(C grad u) + a u, section 2.2 (2.3) and section 4.9 (4.11), (4.20).
struct DiffusionOperator
{
  /// C, in the coordinates of space; positive semidefinite. On triangles in space, only its
  /// tangential part acts.
  SymmetricTensor tensor = IdentityTensor;
  const double* tensors = nullptr; ///< 6 per cell, instead of tensor; or null
  double reaction = 0.0;           ///< a; if it is negative, the matrix may be indefinite
};

/// Linear elasticity (2.4): -div(lambda (div u) I + 2 mu eps(u)).
struct ElasticOperator
{
  double youngsModulus = 1.0; ///< E > 0
  /// nu, -1 to 0.5 (plane stress: 1), exclusive. Near 0.5, linear elements lock: they are too
  /// stiff.
  double poissonRatio = 0.3;
  const double* stiffening = nullptr;    ///< factors of E, one per cell, positive; or null
  PlaneState plane = PlaneState::Strain; ///< planar meshes only
};
}
#endif
