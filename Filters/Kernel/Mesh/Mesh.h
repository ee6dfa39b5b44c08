// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Mesh.h
 * @brief A view of the caller's mesh and the data that the kernel derives from it.
 *
 * Example: the validity of the tetrahedra of a mesh in plain arrays.
 *
 *     tautline::MeshView view;
 *     view.numberOfPoints = n;   view.points = xyz.data();
 *     view.numberOfCells = m;    view.cellTypes = types.data();
 *     view.offsets = offsets.data();   view.connectivity = connectivity.data();
 *     tautline::Mesh mesh(view);
 *     std::vector<signed char> validity(m);
 *     mesh.classifyCells(validity.data());
 */
#ifndef tautline_Mesh_h
#define tautline_Mesh_h

#include "CellTopology.h"

#include <vector>

namespace tautline
{
/**
 * @brief Borrowed arrays that describe a mesh; the caller must keep them alive and unchanged.
 *
 * Cell i has the nodes connectivity[offsets[i]] .. connectivity[offsets[i + 1] - 1] and the VTK
 * type cellTypes[i]. Coordinates are x y z per point; a planar 2D mesh has a constant third
 * coordinate or lies in any other plane.
 */
struct MeshView
{
  Index numberOfPoints = 0;
  const double* points = nullptr; ///< 3 x numberOfPoints
  Index numberOfCells = 0;
  const unsigned char* cellTypes = nullptr; ///< numberOfCells, VTK codes
  const Index* offsets = nullptr;           ///< numberOfCells + 1
  const Index* connectivity = nullptr;      ///< offsets[numberOfCells]
};

/// The kind of space that the cells fill.
enum class Dimension
{
  None,    ///< no cell of a supported type
  Planar,  ///< 2D cells, all in one plane: signed
  Surface, ///< 2D cells in space (or next to volume cells): measured in their own tangent planes
  Volume   ///< 3D cells
};

/// The space that the cells of a mesh fill.
struct MeshSpace
{
  Dimension dimension = Dimension::None;
  Vec3 normal = { 0, 0, 0 };                                        ///< see Mesh::normal()
  std::array<Vec3, 2> frame = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 } }; ///< see Mesh::frame()
};

/// Whether an element is valid; the values of the cell array `Validity`.
enum Validity : signed char
{
  Valid = 1,        ///< the Jacobian determinant is positive everywhere in the element
  Degenerate = 0,   ///< it vanishes somewhere (relative to its edges) and is negative nowhere
  Inverted = -1,    ///< it is negative somewhere
  NotMeasured = -2, ///< an unsupported cell type
  NonFinite = -3    ///< a coordinate is NaN or infinite, or beyond 1e100 in a mesh of ordinary size
};

/// Whether an element is measured and not valid.
inline bool isInvalid(signed char validity)
{
  return validity == Inverted || validity == Degenerate;
}

/// Cells of one type, in increasing order of id.
struct CellBlock
{
  CellType type;
  std::vector<Index> cells; ///< empty if the block is the range [0, count)
  Index count = 0;
  Index cell(Index i) const { return this->cells.empty() ? i : this->cells[i]; }
};

/// The orientation of a mesh; found by Mesh::orientation().
struct Orientation
{
  enum State
  {
    Consistent, ///< neighbors agree and every part has a positive size (or is a surface)
    Reversed,   ///< neighbors agree and every part has a negative area or volume
    Mixed       ///< some neighbors disagree, or some parts are reversed and others are not
  };
  State state = Consistent;
  Index positiveCells = 0;
  Index negativeCells = 0;
  Index disagreeing = 0; ///< interior edges (2D) or faces (3D) whose two cells disagree
  Index parts = 0;       ///< connected parts; 0 if they did not have to be determined
  /// Parts whose signed area or volume is negative. If there are other parts, parts with some
  /// positive cells or with few cells are not counted: their cells are inverted.
  Index reversedParts = 0;
};

/// Vertex-to-cell adjacency in compressed rows: the cells of vertex v are
/// cells[offsets[v]] .. cells[offsets[v + 1] - 1], in increasing order.
struct VertexCells
{
  std::vector<Index> offsets;
  std::vector<Index> cells;
};

/// The boundary: edges of 2D cells and faces of 3D cells used by exactly one cell.
struct Boundary
{
  std::vector<char> isBoundaryPoint; ///< one flag per point
  Index facets = 0;                  ///< boundary edges or faces
  Index nonManifold = 0;             ///< edges or faces used by three or more cells
};

/**
 * @brief A mesh view sorted by cell type, with its dimension and plane.
 *
 * The constructor checks the invariants of all later loops: offsets ascend, each supported cell has
 * the nodes that its type needs, and node ids are in range. Violations throw Error.
 */
class TAUTLINE_KERNEL_EXPORT Mesh
{
public:
  explicit Mesh(const MeshView& view, int threads = 0);
  /**
   * @brief The same cells with other points, 3 coordinates per point of the view; mirrored like
   * this mesh. Dimension and plane are determined again: setSpace() is not kept. The points and the
   * arrays of view() must outlive the result. Cheaper than another construction: the cells have
   * been checked.
   */
  Mesh at(const double* points) const;

  const MeshView& view() const { return this->View; }
  const std::vector<CellBlock>& blocks() const { return this->Blocks; }
  Dimension dimension() const { return this->Dim; }

  MeshSpace space() const { return { this->Dim, this->Normal, this->Frame }; }
  /// Makes the mesh a piece of a mesh that fills a space, see spaceOf(): cells of the piece are
  /// measured as in the whole mesh, even if they lie in a plane and others do not.
  void setSpace(const MeshSpace& space)
  {
    this->Dim = space.dimension;
    this->Normal = space.normal;
    this->Frame = space.frame;
  }

  /// Cells that no block holds (vertices, lines, polygons, polyhedra, ...).
  Index unsupportedCells() const { return this->Unsupported; }
  /// Polyhedra, which no block holds but which make the dimension Volume.
  Index polyhedra() const { return this->Polyhedra; }
  /// Cells of a quadratic or higher type, reduced to their corners.
  Index higherOrderCells() const { return this->HigherOrder; }
  /// Points with a NaN or infinite coordinate.
  Index nonFinitePoints() const { return this->NonFinitePoints; }

  /**
   * @brief Unit normal of a planar mesh, chosen so that its largest component is positive: +z for a
   * mesh in an xy plane, where counterclockwise cells are positive. Zero unless Planar.
   */
  const Vec3& normal() const { return this->Normal; }
  /// Orthonormal frame e1, e2 with e1 x e2 = normal(); x and y for a mesh in an xy plane.
  const std::array<Vec3, 2>& frame() const { return this->Frame; }

  /**
   * @brief Treats the mesh as its mirror image, for a fully reversed mesh: every sign and metric is
   * then computed for the cells in the opposite order. Gradients still refer to the actual
   * coordinates. Metrics that depend on orientation in space use a volume mirrored in x. Off by
   * default.
   */
  void setMirrored(bool mirrored) { this->Mirrored = mirrored; }
  bool mirrored() const { return this->Mirrored; }

  /**
   * @brief Writes a Validity per cell, by the Jacobian determinant in the whole element: for
   * hexahedra and wedges, by bounds that also hold between the corners (Johnen, Weill, Remacle
   * 2017); for the other types, the smallest value is at a corner. A determinant vanishes if it is
   * at most degenerateTolerance() times the product of the lengths of the derivatives (at corners:
   * of the edges). An element whose smallest determinant cannot be distinguished from this limit is
   * Degenerate.
   */
  void classifyCells(signed char* validity, int threads = 0) const;
  /**
   * @brief Classifies the cells that have a moved point; the values of the others are kept.
   * @param points 3 coordinates per point of the view; a point that differs from the view has moved
   */
  void classifyMovedCells(const double* points, signed char* validity, int threads = 0) const;
  /**
   * @brief The same for one cell with the given vertices, which may differ from the view.
   * @param against a unit normal that determines the sign of a cell of a surface, instead of its
   * own normal (for a planar mesh, instead of normal()); may be null
   */
  Validity classifyCell(
    const CellTopology& t, const Vec3* vertices, const Vec3* against = nullptr) const;
  /// The same from the determinants at the corners only, as in a simplex mesh of the corners; never
  /// worse than classifyCell().
  Validity classifyCorners(
    const CellTopology& t, const Vec3* vertices, const Vec3* against = nullptr) const;
  static constexpr double degenerateTolerance() { return 1e-13; }

  /// Checks the signs from classifyCells() and, if they differ, whether neighbors agree.
  Orientation orientation(const signed char* validity) const;

  VertexCells vertexCells() const;
  Boundary boundary() const;

  /// The mean of the vertices of a cell; for CellType::Unsupported, of the points that it lists.
  Vec3 center(Index cell, CellType type) const;

private:
  void findDimension();
  void findPlane();

  MeshView View;
  std::vector<CellBlock> Blocks;
  Dimension Dim = Dimension::None;
  Vec3 Normal = { 0, 0, 0 };
  std::array<Vec3, 2> Frame = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 } };
  Index Unsupported = 0;
  Index Polyhedra = 0;
  Index HigherOrder = 0;
  Index NonFinitePoints = 0;
  bool Mirrored = false;
};

/// The normal of a 2D cell, with twice its area as length; for a quadrilateral, from its diagonals.
inline Vec3 vectorArea(const CellTopology& t, const Vec3* p)
{
  return t.nodes == 3 ? cross(p[1] - p[0], p[2] - p[0]) : cross(p[2] - p[0], p[3] - p[1]);
}

inline Vec3 pointOf(const MeshView& view, Index id)
{
  return { view.points[3 * id], view.points[3 * id + 1], view.points[3 * id + 2] };
}

/// The diagonal of the bounding box of the finite points; 0 if there are none.
TAUTLINE_KERNEL_EXPORT double diagonalOf(const MeshView& view);
}
#endif
