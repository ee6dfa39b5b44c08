// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferMesh.h
 * @brief Meshes divided into simplices, for field transfer.
 *
 *     tautline::TransferMesh mesh(tautline::elementDimension(view));
 *     mesh.add(view, nullptr);
 */
#ifndef tautline_TransferMesh_h
#define tautline_TransferMesh_h

#include "tautline/Mesh/Mesh.h"

#include <array>
#include <vector>

namespace tautline
{
/// 3 if the mesh has a volume cell, otherwise 2 if it has a surface cell, otherwise 0.
TAUTLINE_KERNEL_EXPORT int elementDimension(const MeshView& view);

/**
 * @class tautline::TransferMesh
 * @brief The elements of one or several meshes, divided into triangles or tetrahedra.
 *
 * An element is divided from its point with the lowest number, and so are its faces, so that
 * neighbors match: a quadrilateral into two triangles, a hexahedron into six tetrahedra. Polygons
 * are divided by a constrained Delaunay triangulation. The division is exact for cells with
 * straight edges; only the corners of higher-order cells are used. Simplex sizes are absolute
 * values; simplices that are degenerate relative to their edges or have a coordinate beyond
 * FarthestCoordinate are left out.
 */
class TAUTLINE_KERNEL_EXPORT TransferMesh
{
public:
  static constexpr double FarthestCoordinate = 1e60;
  using Simplex = std::array<Index, 4>; ///< points; the last one of a triangle is -1

  /// @param dimension of the cells that are elements: 2 or 3
  explicit TransferMesh(int dimension);

  /**
   * @brief Adds the points and cells of a mesh, numbered after the existing ones.
   * @param skip one flag per cell, nonzero for cells that are not elements, such as ghosts; may be
   *   null
   *
   * Throws Error for an element with a point that is not finite or not in the mesh.
   */
  void add(const MeshView& view, const unsigned char* skip);

  int dimension() const { return this->Dim; }
  /// Corners of a simplex: 3 or 4.
  int corners() const { return this->Dim + 1; }
  const std::vector<Vec3>& points() const { return this->Points; }
  /// In the order of the cells.
  const std::vector<Simplex>& simplices() const { return this->Simplices; }
  /// The area or volume of each simplex, above 0.
  const std::vector<double>& sizes() const { return this->Sizes; }
  /// The cell of each simplex.
  const std::vector<Index>& cells() const { return this->Cells; }
  Index numberOfPoints() const { return static_cast<Index>(this->Points.size()); }
  Index numberOfCells() const { return static_cast<Index>(this->Starts.size()) - 1; }
  Index numberOfSimplices() const { return static_cast<Index>(this->Simplices.size()); }
  /// The simplices of cell i are starts()[i] .. starts()[i + 1] - 1; none if it is not an element.
  const std::vector<Index>& starts() const { return this->Starts; }
  /// The area or volume of a cell.
  double sizeOfCell(Index cell) const;
  /// The center of mass of a cell; the mean of its points if it is not an element or has no size.
  const Vec3& center(Index cell) const { return this->Centers[cell]; }
  /// The total area or volume.
  double size() const;

  /// Converts points and centers to coordinates along two unit vectors in a plane, with z = 0.
  void flatten(const Vec3& origin, const Vec3& first, const Vec3& second);

private:
  void divide(const MeshView& view, Index cell, Index firstPoint);
  void addSimplex(const Simplex& simplex, Index cell);

  int Dim;
  std::vector<Vec3> Points;
  std::vector<Simplex> Simplices;
  std::vector<double> Sizes;
  std::vector<Index> Cells, Starts = { 0 };
  std::vector<Vec3> Centers;
};
}
#endif
