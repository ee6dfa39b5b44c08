// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Mesh.h
 * @brief A view of a caller's mesh and what the kernel derives from it.
 *
 * Example: the number of inverted tetrahedra of a mesh kept in plain arrays.
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
 * @brief Borrowed arrays that describe a mesh; the caller keeps them alive and unchanged.
 *
 * Cell i has the nodes connectivity[offsets[i]] .. connectivity[offsets[i + 1] - 1] and the VTK
 * type cellTypes[i]. Coordinates are x y z per point; a 2D mesh has a constant third coordinate or
 * lies in any other plane.
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

/// What kind of space the cells fill.
enum class Dimension
{
  None,    ///< no cell of a supported type
  Planar,  ///< 2D cells, all in one plane: they have a sign
  Surface, ///< 2D cells in space (or beside volume cells): measured in their own tangent planes
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
  NotMeasured = -2, ///< a cell type Tautline does not compute with
  NonFinite = -3    ///< a coordinate is NaN or infinite, or beyond 1e100 in a mesh of ordinary size
};

/// Whether an element is measured, and not valid.
inline bool isInvalid(signed char validity)
{
  return validity == Inverted || validity == Degenerate;
}

/// Cells of one type, in increasing order of id.
struct CellBlock
{
  CellType type;
  std::vector<Index> cells; ///< empty when the block is the range [0, count)
  Index count = 0;
  Index cell(Index i) const { return this->cells.empty() ? i : this->cells[i]; }
};

/// What is known of the mesh's orientation; found by Mesh::orientation().
struct Orientation
{
  enum State
  {
    Consistent, ///< neighbours agree and every part has a positive size (or is a surface)
    Reversed,   ///< neighbours agree and every part has a negative area or volume
    Mixed       ///< some neighbours disagree, or some parts are reversed and others are not
  };
  State state = Consistent;
  Index positiveCells = 0;
  Index negativeCells = 0;
  Index disagreeing = 0; ///< interior edges (2D) or faces (3D) whose two cells disagree
  Index parts = 0;       ///< connected parts; 0 when they did not have to be found
  /// Parts whose signed area or volume is negative. Beside others these do not count where some of
  /// their cells are positive or they are few: then the cells are inverted.
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
 * Construction checks what every later loop relies on: offsets ascend, each supported cell has the
 * nodes its type needs, and node ids are in range. Violations throw Error.
 */
class TAUTLINE_KERNEL_EXPORT Mesh
{
public:
  explicit Mesh(const MeshView& view, int threads = 0);
  /**
   * @brief The same cells at other points, 3 coordinates per point of the view; mirrored as this
   * mesh is. Dimension and plane are found anew: setSpace() is not kept. The points and the arrays
   * of view() must outlive the result. Cheaper than another construction: the cells have been
   * checked.
   */
  Mesh at(const double* points) const;

  const MeshView& view() const { return this->View; }
  const std::vector<CellBlock>& blocks() const { return this->Blocks; }
  Dimension dimension() const { return this->Dim; }

  MeshSpace space() const { return { this->Dim, this->Normal, this->Frame }; }
  /// Makes the mesh a piece of one that fills a space, see spaceOf(): cells of the piece are
  /// measured as they are in the whole, though they may lie in a plane and others not.
  void setSpace(const MeshSpace& space)
  {
    this->Dim = space.dimension;
    this->Normal = space.normal;
    this->Frame = space.frame;
  }

  /// Cells no block holds (vertices, lines, polygons, polyhedra, ...).
  Index unsupportedCells() const { return this->Unsupported; }
  /// Polyhedra, which no block holds but which make the dimension Volume.
  Index polyhedra() const { return this->Polyhedra; }
  /// Cells of a quadratic or higher type, reduced to their corners.
  Index higherOrderCells() const { return this->HigherOrder; }
  /// Points with a NaN or infinite coordinate.
  Index nonFinitePoints() const { return this->NonFinitePoints; }

  /**
   * @brief Unit normal of a planar mesh, chosen so that its largest component is positive: +z for
   * a mesh in an xy plane, where counter-clockwise cells are positive. Zero unless Planar.
   */
  const Vec3& normal() const { return this->Normal; }
  /// Orthonormal frame e1, e2 with e1 x e2 = normal(); x and y for a mesh in an xy plane.
  const std::array<Vec3, 2>& frame() const { return this->Frame; }

  /**
   * @brief Treats the mesh as its mirror image, for one that is reversed throughout: every sign and
   * every metric is then that of the cells listed in the opposite order. Gradients stay those with
   * respect to the actual coordinates. Metrics that depend on orientation in space use a volume
   * mirrored in x. Off by default.
   */
  void setMirrored(bool mirrored) { this->Mirrored = mirrored; }
  bool mirrored() const { return this->Mirrored; }

  /**
   * @brief Writes a Validity per cell, by the Jacobian determinant in the whole element: of
   * hexahedra and wedges by bounds that hold between the corners, too (Johnen, Weill, Remacle
   * 2017); of the other types the smallest value is at a corner. A determinant counts as vanishing
   * when it is at most degenerateTolerance() times the product of the lengths of the derivatives,
   * at corners the lengths of the edges. An element whose smallest determinant cannot be told from
   * this limit is Degenerate.
   */
  void classifyCells(signed char* validity, int threads = 0) const;
  /**
   * @brief Classifies the cells that have a moved point; the values of the others are kept.
   * @param points 3 coordinates per point of the view; a point that differs from the view has moved
   */
  void classifyMovedCells(const double* points, signed char* validity, int threads = 0) const;
  /**
   * @brief The same for one cell with the given vertices, which need not be those of the view.
   * @param against a unit normal that determines the sign of a cell of a surface, instead of its
   * own (and of a planar mesh, instead of normal()); may be null
   */
  Validity classifyCell(
    const CellTopology& t, const Vec3* vertices, const Vec3* against = nullptr) const;
  /// The same by the determinants at the corners alone, which is what a simplex mesh of the corners
  /// has; never worse than classifyCell().
  Validity classifyCorners(
    const CellTopology& t, const Vec3* vertices, const Vec3* against = nullptr) const;
  static constexpr double degenerateTolerance() { return 1e-13; }

  /// Checks the signs given by classifyCells() and, where they differ, whether neighbours agree.
  Orientation orientation(const signed char* validity) const;

  VertexCells vertexCells() const;
  Boundary boundary() const;

  /// Mean of the vertices of a cell; of one of CellType::Unsupported, of the points it lists.
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

/// Normal of a 2D cell, twice as long as its area: of a quadrilateral, of its diagonals.
inline Vec3 vectorArea(const CellTopology& t, const Vec3* p)
{
  return t.nodes == 3 ? cross(p[1] - p[0], p[2] - p[0]) : cross(p[2] - p[0], p[3] - p[1]);
}

inline Vec3 pointOf(const MeshView& view, Index id)
{
  return { view.points[3 * id], view.points[3 * id + 1], view.points[3 * id + 2] };
}

/// The diagonal of the bounding box of the finite points; 0 without one.
TAUTLINE_KERNEL_EXPORT double diagonalOf(const MeshView& view);
}
#endif
