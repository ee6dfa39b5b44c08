// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MfemSpace.h
 * @brief The finite element spaces of the nodes of MFEM's meshes.
 *
 * Internal: not installed.
 */
#ifndef tautline_MfemSpace_h
#define tautline_MfemSpace_h

#include "MfemFile.h"

#include <string_view>

namespace tautline
{
/// A space of nodes, by the name of its finite element collection.
struct MfemSpace
{
  enum Basis
  {
    GaussLegendre, ///< in MFEM's order
    GaussLobatto,
    Bernstein,
    OpenUniform,
    ClosedUniform,
    OpenHalfUniform
  };

  bool continuous = true; ///< H1: elements share nodes; otherwise L2
  int order = 1;
  Basis basis = GaussLobatto;
  bool isCubic = false; ///< the collection Cubic, whose nodes on the squares of volumes differ

  /**
   * @brief The space for a name such as H1_3D_P2, L2_T1_2D_P3, H1@U_2D_P4, Quadratic or Cubic.
   * Throws Error with the reason for an unknown name or an unsupported order.
   */
  static MfemSpace parse(std::string_view name, int dimension);

  /**
   * @brief The matrix that maps node values to values at positions in a shape.
   * @param places reference coordinates
   * @return the matrix by rows: a row for each position, columns in the order of
   * MfemShape::lattice(); empty if the nodes are evenly spaced
   */
  std::vector<double> evaluation(const MfemShape& shape, const std::vector<Vec3>& places) const;

  /**
   * @brief The inverse mapping, from values at the nodes of a cell to values of the space.
   * @param type VTK's type for the shape, with an order up to the order of the space; for Bernstein
   * polynomials, with this order and all nodes
   * @param nodes of the cell
   * @return the matrix by rows, with rows in the order of MfemShape::lattice()
   */
  std::vector<double> interpolation(const MfemShape& shape, unsigned char type, Index nodes) const;

  /// The name of the finite element collection.
  std::string name(int dimension) const;
};
}
#endif
