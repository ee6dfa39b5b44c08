// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GlobalDescent.h
 * @brief Limited-memory BFGS on all free vertices of a tangled mesh, preconditioned by the Hessian
 * blocks of the vertices.
 * Internal: not installed.
 */
#ifndef tautline_GlobalDescent_h
#define tautline_GlobalDescent_h

#include "TangledMesh.h"
#include "tautline/Core/LimitedMemory.h"
#include "tautline/Core/SmallCholesky.h"
#include "tautline/Patches/Energies.h"

namespace tautline
{
/// The minimization of the regularized shape energy of a mesh of dimension Dim, 2 or 3.
template <int Dim>
class GlobalDescent
{
public:
  /// `tangled` must outlive this object.
  explicit GlobalDescent(const TangledMesh<Dim>& tangled);

  /// Discards the previous steps and evaluates the energy at x with this regularization, at least
  /// 0.
  void start(const double* x, double eps);

  /**
   * @brief One step of the minimization.
   * @param x VertexStride coordinates per vertex, from start() or the last step; the free ones
   * change
   * @return false if no step reduces the energy
   */
  bool step(double* x);

  /// The energy after start() or the last step.
  double energy() const { return this->Value; }

private:
  using Block = SmallCholesky<Dim, CholeskyDiagonal::InverseRoot>;

  double evaluate(const double* x);
  void addEnergy(std::int32_t v, Patch<Dim>& patch, double& energy) const;
  void precondition(std::vector<double>& q) const;

  const TangledMesh<Dim>& Tangled;
  SimplexMesh& Mesh;
  VectorAlgebra Algebra; ///< VertexStride entries per free vertex, of which the last is zero
  LimitedMemory Memory;
  RegularizedShapeEnergy<Dim> Energy;
  double Value = 0;
  std::vector<double> Gradient, Before, Direction;
  std::vector<double> Blocks; ///< factors of the Hessian blocks
  std::vector<double> Next;   ///< coordinates of all vertices
};
}
#endif
