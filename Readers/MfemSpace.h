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

  bool continuous = true; ///< H1: elements share nodes; else L2
  int order = 1;
  Basis basis = GaussLobatto;
  bool isCubic = false; ///< the collection Cubic, whose nodes on the squares of volumes differ

  /**
   * @brief The space of a name such as H1_3D_P2, L2_T1_2D_P3, H1@U_2D_P4, Quadratic or Cubic.
   * Throws Error with the reason for a name that is not known or an order that is not read.
   */
  static MfemSpace parse(std::string_view name, int dimension);

  /**
   * @brief How the values at places of a shape follow from those of the nodes.
   * @param places reference coordinates
   * @return a matrix, row by row: a row for each place, its columns in the order of
   * MfemShape::lattice(); empty where the nodes are evenly spaced
   */
  std::vector<double> evaluation(const MfemShape& shape, const std::vector<Vec3>& places) const;

  /**
   * @brief How the values of the space follow from those at the nodes of a cell: the other way.
   * @param type VTK's, of the shape and of an order up to the one of the space; with Bernstein
   * polynomials of this order, with all nodes
   * @param nodes of the cell
   * @return a matrix, row by row, its rows in the order of MfemShape::lattice()
   */
  std::vector<double> interpolation(const MfemShape& shape, unsigned char type, Index nodes) const;

  /// The name of the finite element collection.
  std::string name(int dimension) const;
};
}
#endif
