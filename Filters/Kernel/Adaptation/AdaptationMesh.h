// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AdaptationMesh.h
 * @brief The elements of a mesh and the data that metric fields at their points need: neighbors,
 * volume shares, and normals.
 *
 * Points and elements are numbered by their coordinates. Sums, the order of neighbors, and
 * therefore the results do not depend on the numbering in the mesh (for the curvature: up to
 * rounding).
 */
#ifndef tautline_AdaptationMesh_h
#define tautline_AdaptationMesh_h

#include "MetricTensor.h"
#include "tautline/Mesh/Mesh.h"

#include <memory>

namespace tautline
{
class TAUTLINE_KERNEL_EXPORT AdaptationMesh
{
public:
  /**
   * @param mesh its cells of the highest dimension are the elements; only the corners of
   * higher-order cells are used. May be destroyed afterwards.
   * @param representative one per point: the first of the points merged with it; empty: no merged
   *   points
   * @param skip one flag per cell: the cell is excluded from volumes, for example a ghost; may be
   *   null
   *
   * Throws Error if there are no elements or a point of an element is not finite.
   */
  explicit AdaptationMesh(const Mesh& mesh, const std::vector<Index>& representative = {},
    const unsigned char* skip = nullptr, int threads = 0);
  AdaptationMesh(const AdaptationMesh&) = delete;
  AdaptationMesh& operator=(const AdaptationMesh&) = delete;

  /// The elements at the points of elements.
  const Mesh& mesh() const { return *this->Elements; }
  /// 3, or 2 for planar meshes and surfaces.
  int dimension() const { return this->Dim; }
  int threads() const { return this->Threads; }
  Index numberOfPoints() const { return static_cast<Index>(this->Origins.size()); }
  Vec3 point(Index p) const { return pointOf(this->Elements->view(), p); }
  /// The diagonal of the bounding box.
  double diagonal() const { return diagonalOf(this->Elements->view()); }

  /// Indices contiguous in memory.
  struct List
  {
    const Index *first, *last;
    const Index* begin() const { return this->first; }
    const Index* end() const { return this->last; }
  };
  /// The other points of the elements at a point, in increasing order.
  List neighbors(Index p) const
  {
    const Index* all = this->Neighbors.data();
    return { all + this->NeighborStarts[p], all + this->NeighborStarts[p + 1] };
  }
  /// The elements at a point, in increasing order.
  List elements(Index p) const
  {
    const Index* all = this->Around.cells.data();
    return { all + this->Around.offsets[p], all + this->Around.offsets[p + 1] };
  }

  /// Per element: its area or volume, at least 0 for either orientation.
  const std::vector<double>& sizes() const { return this->Sizes; }
  /// Per point: its share of the area or volume. Each element is divided equally among its points.
  const std::vector<double>& volumes() const { return this->Volumes; }
  /// The same, with each element size divided by the size of the ideal element with unit edges:
  /// sqrt(3)/4 for triangles, sqrt(2)/12 for tetrahedra, 1 for quadrilaterals and hexahedra,
  /// sqrt(3)/4 for wedges, sqrt(2)/6 for pyramids.
  const std::vector<double>& idealVolumes() const { return this->IdealVolumes; }
  /// Per point the unit normal of a planar mesh or surface; empty for a volume.
  const std::vector<Vec3>& normals() const { return this->Normals; }

  /// Converts values per point of the input mesh, `components` each, to values per point here.
  std::vector<double> taken(const double* values, int components) const;
  /// Converts metrics per point here to 6 numbers per point of the input mesh.
  /// @param other the value for points without an element
  std::vector<double> given(
    const std::vector<MetricTensor>& metrics, const MetricTensor& other) const;
  /// Per point here: its number in the input mesh.
  const std::vector<Index>& origins() const { return this->Origins; }
  /// Per point of the input mesh: its number here; -1: none.
  const std::vector<Index>& places() const { return this->Places; }

private:
  void takePoints(const Mesh& mesh, const std::vector<Index>& representative);
  void takeElements(const Mesh& mesh, const unsigned char* skip);
  void measure();
  void findNeighbors();
  void findNormals();

  int Dim, Threads;
  std::vector<Index> Places, Origins;
  std::vector<double> Coordinates;
  std::vector<unsigned char> Types, Skip;
  std::vector<Index> Offsets, Connectivity;
  std::unique_ptr<Mesh> Elements;
  VertexCells Around;
  std::vector<Index> NeighborStarts, Neighbors;
  std::vector<double> Sizes, Volumes, IdealVolumes;
  std::vector<Vec3> Normals;
};
}
#endif
