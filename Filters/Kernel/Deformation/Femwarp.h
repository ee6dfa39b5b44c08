// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Femwarp.h
 * @brief FEMWARP and anisotropic FEMWARP, sections 4.8 and 4.9.1: the harmonic solve, the limit in
 * which a coefficient is 0, and the biharmonic equation.
 * Internal: not installed.
 */
#ifndef tautline_Femwarp_h
#define tautline_Femwarp_h

#include "WarpParts.h"
#include "WarpSystem.h"

namespace tautline
{
/**
 * @class tautline::Femwarp
 * @brief One scalar operator, solved for every coordinate of the displacements after their affine
 * part is subtracted.
 *
 * If C is singular, some points may not depend on any prescribed point: rows, chains of rows, and
 * whole layers of the matrix can decouple. For these points, the isotropic operator is solved
 * instead with all other points given, which does not affect the other points. If the motion with
 * such a C is still unbounded or the solver fails, a fraction of the isotropic operator is added
 * everywhere, the smallest of 1e-10, 1e-8, ... that suffices.
 */
class Femwarp
{
public:
  enum class Operator
  {
    Harmonic,
    Biharmonic ///< K M^-1 K with the lumped mass matrix M: no normal derivative at the boundary
  };

  /// Assembles and partitions.
  Femwarp(const Mesh& mesh, const WarpParts& parts, Operator kind, const SymmetricTensor& tensor,
    const double* tensors, WarpControl& control);

  /// Displacements of all points, 3 each; if stopped, the affine motions and the part already
  /// solved.
  std::vector<double> warp(const double* displacement, WarpControl& control);

private:
  double splitAffine(
    const double* displacement, std::vector<double>& rest, std::vector<double>& result) const;
  SparseMatrix assemble(double regularization, WarpControl& control) const;
  void partition(WarpControl& control);
  void findDecoupled(const SparseMatrix& matrix, WarpControl& control);

  const Mesh& Input;
  const WarpParts& Parts;
  Operator Kind;
  DiffusionOperator Pde;
  std::vector<unsigned char> Held; ///< given in the first solve, including decoupled points
  /// given in the second solve: all points except decoupled ones
  std::vector<unsigned char> Others;
  bool Singular = false; ///< C may be
  Index Decoupled = 0;
  double Regularization = 0;
  std::unique_ptr<WarpSystem> System, Second;
};
}
#endif
