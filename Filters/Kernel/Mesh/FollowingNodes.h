// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FollowingNodes.h
 * @brief The nodes of curved cells that are no corners: where they go when the corners move.
 * Internal: not installed.
 *
 * A node is where the straight cell has its reference coordinates, plus an offset: so much the cell
 * is curved there. When corners move, the node goes to that place of the new straight cell, plus
 * the offset as the affine map of the cell at the node takes it. An affine motion is exact, and a
 * curved cell that turns keeps its shape. Of a node of several cells the place in the straight cell
 * is the same in all of them, as it is on an edge or face that they share; their affine maps are
 * averaged with the sizes of the cells.
 */
#ifndef tautline_FollowingNodes_h
#define tautline_FollowingNodes_h

#include "Mesh.h"

#include <vector>

namespace tautline
{
/**
 * @class tautline::FollowingNodes
 * @brief Finds these nodes once, and places them for any positions of the corners.
 */
class TAUTLINE_KERNEL_EXPORT FollowingNodes
{
public:
  /**
   * @param mesh at rest, cells in VTK's order of nodes; only read here
   * @param degrees null, or the orders of Lagrange and Bezier cells, three numbers per cell
   * @param representative of each point: points with the same one are one, see CoincidentPoints;
   * nodes at one place between corners that are one are then one, too. Empty: none are.
   * Throws Error for curved cells that ElementType does not support.
   */
  explicit FollowingNodes(const Mesh& mesh, const double* degrees = nullptr,
    const std::vector<Index>& representative = {});

  /// The points that follow; of several that are one the first.
  const std::vector<Index>& points() const { return this->Points; }
  /// One flag per point: it follows, and lies on an edge (2D) or face (3D) that not exactly two
  /// cells share.
  const std::vector<unsigned char>& boundary() const { return this->Boundary; }
  /// Whether all, or any, of the corners that determine where the i-th of points() is in the
  /// straight cell have a flag that is not 0.
  bool allCorners(std::size_t i, const std::vector<unsigned char>& flags) const;
  bool anyCorner(std::size_t i, const std::vector<unsigned char>& flags) const;

  /**
   * @brief Writes the places of these nodes. A node that no corner of its cells moves stays where
   * it is, bitwise. The result does not depend on the number of threads.
   * @param before 3 coordinates per point of the mesh
   * @param points the same with moved corners; of points that are one that of the representative
   * counts
   */
  void place(const double* before, std::vector<double>& points, int threads = 0) const;

  /// Gives nodes that are one the place of the first of them.
  void unite(std::vector<double>& points) const;

private:
  /// The straight cell at a node of a curved one.
  struct Place
  {
    std::vector<double> value;                     ///< of the linear shape functions, per corner
    std::array<std::vector<double>, 3> derivative; ///< by the reference coordinates
  };
  /// Of cells of one type, number of nodes and orders.
  struct Kind
  {
    int dimension = 0, corners = 0;
    std::vector<Place> places; ///< per node behind the corners
  };
  struct Use
  {
    Index cell;
    int node; ///< behind the corners
  };

  void findKinds(const Mesh& mesh, const double* degrees);
  void mergeNodes(const Mesh& mesh, const std::vector<Index>& representative);
  void findUses(const Mesh& mesh);
  void findBoundary(const Mesh& mesh);
  const Place& placeOf(const Use& use) const
  {
    return this->Kinds[this->KindOfCell[use.cell]].places[use.node];
  }
  template <class Visit>
  void forEachCorner(const Use& use, const Visit& visit) const;

  std::vector<Kind> Kinds;
  std::vector<int> KindOfCell; ///< -1: a cell without such nodes
  std::vector<Index> Offsets, Connectivity;
  std::vector<Index> Points;
  std::vector<Index> UseOffsets; ///< of Points
  std::vector<Use> Uses;         ///< of cells of the highest dimension at the point
  std::vector<unsigned char> Boundary;
  std::vector<std::array<Index, 2>> Copies; ///< a point, and the first that is one with it
};
}
#endif
