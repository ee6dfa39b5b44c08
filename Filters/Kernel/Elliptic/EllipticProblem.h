// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticProblem.h
 * @brief The boundary value problems of chapter 2: Poisson (2.2), general second order (2.3),
 * linear elasticity (2.4).
 */
#ifndef tautline_EllipticProblem_h
#define tautline_EllipticProblem_h

#include "Materials.h"
#include "tautline/Core/Communicator.h"

namespace tautline
{
/// The equations; the numbers are stable: ParaView state files hold them.
enum class Pde : int
{
  Poisson = 0,   ///< -laplace u = f
  Elliptic = 1,  ///< -alpha u_xx - beta u_yy - gamma u_zz + a u = f
  Elasticity = 2 ///< -div tau(u) = f
};

/// An equation with its coefficients, right-hand side and Dirichlet data. Arrays are borrowed.
struct EllipticProblem
{
  Pde pde = Pde::Poisson;
  /// For Elliptic; Poisson ignores it. C must be positive definite in the plane of a planar mesh,
  /// in space otherwise.
  DiffusionOperator diffusion;
  ElasticOperator elastic; ///< Elasticity
  /// f, constant: the first component, or a vector in space for elasticity (for a planar mesh, in
  /// its plane).
  Vec3 source = { 1, 0, 0 };
  /// f at the points instead, 1 (elasticity: 3) per point, interpolated linearly; or null.
  const double* sources = nullptr;
  /// One flag per point, nonzero = its values are given; null: the boundary of the mesh (over all
  /// ranks).
  const unsigned char* fixed = nullptr;
  /// Given values at the points, 1 (elasticity: 3) per point; null: 0. Only the values of fixed
  /// points are read.
  const double* fixedValues = nullptr;
};

/// The part of a mesh on this rank; the default is the whole mesh in one process.
struct MeshPart
{
  Communicator communicator = nullptr;
  const Index* globalIds = nullptr;    ///< of the points
  const unsigned char* skip = nullptr; ///< of the cells: nonzero for ghosts
};
}
#endif
