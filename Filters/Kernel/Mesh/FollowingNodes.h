// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FollowingNodes.h
 * @brief The nodes of curved cells other than corners, and how they follow the motion of the
 * corners.
 *
 * The position of a node is its position in the straight cell plus an offset, which describes the
 * curvature of the cell. When the corners move, the node moves to its position in the new straight
 * cell plus the offset mapped by the affine map of the cell at the node. Affine motions are exact,
 * and a rotating curved cell keeps its shape. If a node belongs to several cells, its position in
 * the straight cell is the same in all of them, because it lies on a shared edge or face; their
 * affine maps are averaged with the cell sizes as weights.
 * Internal: not installed.
 */
#ifndef tautline_FollowingNodes_h
#define tautline_FollowingNodes_h

#include "Mesh.h"

#include <vector>

namespace tautline
{
/**
 * @class tautline::FollowingNodes
 * @brief Finds these nodes once and computes their positions for any positions of the corners.
 */
class TAUTLINE_KERNEL_EXPORT FollowingNodes
{
public:
  /**
   * @param mesh at rest, cells in VTK's node order; only read here
   * @param degrees null, or the orders of Lagrange and Bezier cells, three numbers per cell
   * @param representative of each point: points with the same representative are merged, see
   * CoincidentPoints; coincident nodes between merged corners are then also merged. Empty: no
   * merged points. Throws Error for curved cells that ElementType does not support.
   */
  explicit FollowingNodes(const Mesh& mesh, const double* degrees = nullptr,
    const std::vector<Index>& representative = {});

  /// The following points; the first of merged points.
  const std::vector<Index>& points() const { return this->Points; }
  /// One flag per point: nonzero if it follows and lies on an edge (2D) or face (3D) that is not
  /// shared by exactly two cells.
  const std::vector<unsigned char>& boundary() const { return this->Boundary; }
  /// Whether all, or any, of the corners that determine the position of the i-th of points() in the
  /// straight cell have a nonzero flag.
  bool allCorners(std::size_t i, const std::vector<unsigned char>& flags) const;
  bool anyCorner(std::size_t i, const std::vector<unsigned char>& flags) const;

  /**
   * @brief Writes the positions of these nodes. A node does not change, bitwise, if no corner of
   * its cells moves. The result does not depend on the number of threads.
   * @param before 3 coordinates per point of the mesh
   * @param points the same with moved corners; of merged points, the position of the representative
   * is used
   */
  void place(const double* before, std::vector<double>& points, int threads = 0) const;

  /// Moves merged nodes to the position of the first one.
  void unite(std::vector<double>& points) const;

private:
  /// The straight cell at a node of a curved one.
  struct Place
  {
    /// values of the linear shape functions, per corner
    std::vector<double> value;
    std::array<std::vector<double>, 3> derivative; ///< with respect to the reference coordinates
  };
  /// Data for cells of one type, number of nodes and orders.
  struct Kind
  {
    int dimension = 0, corners = 0;
    std::vector<Place> places; ///< per node after the corners
  };
  struct Use
  {
    Index cell;
    int node; ///< after the corners
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
  std::vector<std::array<Index, 2>> Copies; ///< a point, and the first point merged with it
};
}
#endif
