// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexMesh.h
 * @brief A mesh prepared for optimization: the simplices at the corners of its cells, renumbered
 * for the cache, with the patch of simplices around each free vertex.
 *
 * With T = A W^-1 of a simplex, N = |T|^2 is the sum of c_kl |x_k - x_l|^2 over its edges, and D =
 * det T a multiple of its volume. As a function of one vertex, N is quadratic (with a multiple of
 * the unit matrix as Hessian) and D is linear. All fast objectives are functions of N and D.
 * Internal: not installed.
 */
#ifndef tautline_SimplexMesh_h
#define tautline_SimplexMesh_h

#include "tautline/Core/LargeArray.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/Quality/Metrics.h"

#include <utility>
#include <vector>

namespace tautline
{
/// Coordinates are stored in groups of four, the last unused, so that a vertex is one aligned load.
constexpr int VertexStride = 4;

/// The target of a simplex: N = sum edge[e] |edge e|^2, D = det * (d! volume).
struct TargetSimplex
{
  /// 01 02 12 in 2D, 01 02 03 12 13 23 in 3D; -w_k . w_l, where w_k are the rows of W^-1, w_0 =
  /// -sum.
  double edge[6] = { 0, 0, 0, 0, 0, 0 };
  double det = 1; ///< of W^-1
};

/// Blocks of consecutive free vertices. No two blocks of one color share a cell, because most
/// metrics read all points of the cells at a vertex: blocks of one color can move concurrently.
struct VertexBlocks
{
  static constexpr std::int32_t size = 256; ///< block b has the vertices from b * size on
  std::vector<std::int32_t> byColour;       ///< the blocks, color by color
  std::vector<std::int32_t> colourStarts;   ///< into byColour, and its end
};

/// The data that determine the coordinates and the order of the vertices; the same for all parts of
/// a distributed mesh.
struct SimplexFrame
{
  Vec3 low = { 0, 0, 0 }, high = { 0, 0, 0 }; ///< bounds of the whole mesh
  double scale = 1;                           ///< a power of two near the mean edge
};

/// The power of two nearest to a length, so that scaling does not round; 1 if it is not a valid
/// length.
double powerOfTwo(double length);

class TAUTLINE_KERNEL_EXPORT SimplexMesh
{
public:
  /**
   * @param fixed one flag per point, or null for the boundary
   * @param targets or null for the ideal cells with edges of length scale(); metric roots are
   * ignored
   *
   * Vertices of cells that are not elements (lines, polygons, cells of another dimension) and
   * nonfinite points are also fixed; simplices with nonfinite points are left out.
   * @param frame of the whole mesh, if this is a part; null: from the mesh
   */
  SimplexMesh(const Mesh& mesh, const unsigned char* fixed, const Targets* targets, int threads,
    const SimplexFrame* frame = nullptr);

  int dimension() const { return this->Dim; }
  /// 2D cells in space, whose vertices keep all three coordinates.
  bool surface() const { return this->Surface; }
  std::int32_t vertices() const { return static_cast<std::int32_t>(this->Point.size()); }
  std::int32_t freeVertices() const { return this->Free; }
  std::int32_t simplices() const { return this->Simplices; }

  /// Free vertices come first: v < freeVertices(). In the order of a space-filling curve.
  std::int32_t point(std::int32_t v) const { return this->Point[v]; }
  /// VertexStride coordinates per vertex, shifted and scaled; a planar mesh lies in z = 0.
  double* coordinates() { return this->X.data(); }
  const double* coordinates() const { return this->X.data(); }
  /// The length that is 1 in these coordinates.
  double scale() const { return this->Scale; }

  /// dimension() + 1 vertices per simplex, positively oriented where the element is valid.
  const std::int32_t* corners() const { return this->Corners.data(); }
  /// The cell of which a simplex is a corner.
  Index cell(std::int32_t simplex) const
  {
    return this->Cell.empty() ? simplex : this->Cell[simplex];
  }

  /// Whether there is one target for all simplices, in the scaled coordinates; otherwise see
  /// target().
  bool uniform() const { return this->Shape.empty(); }
  const TargetSimplex& target(std::int32_t simplex) const
  {
    return this->Shapes[this->Shape.empty() ? 0 : this->Shape[simplex]];
  }

  /// Patches of free vertices: entries patchStart(v) .. patchStart(v + 1) - 1.
  std::int32_t patchStart(std::int32_t v) const { return this->PatchStarts[v]; }
  /// dimension() vertices per entry, so that (v, these) is an even permutation of the simplex.
  const std::int32_t* patchVertices() const { return this->PatchVertices.data(); }
  /// simplex * (dimension() + 1) + position of v in it, per entry; unless uniform(), or after
  /// indexPatches().
  const std::int32_t* patchCorners() const { return this->PatchCorners.data(); }
  void indexPatches();

  const VertexBlocks& blocks() const { return this->Blocks; }

  /// Sets the coordinates from 3 per point.
  void load(const double* points, int threads);
  /// The unit vector of one of these coordinates in mesh coordinates, times scale().
  Vec3 axis(int c) const { return this->Scale * this->Frame[c]; }
  /// A point of the mesh in these coordinates.
  Vec3 transform(const Vec3& point) const;
  /// Writes one vertex into 3 coordinates, which contain the previous point.
  void storeVertex(const double* x, double* p) const;
  /// Writes the free vertices, 3 coordinates per point; other points stay unchanged.
  void store(double* points, int threads) const { this->store(this->X.data(), points, threads); }
  void store(const double* coordinates, double* points, int threads) const;

private:
  /// @param corners one flag per point: of a cell of the mesh's dimension
  void number(const Mesh& mesh, const std::vector<char>& corners, const std::vector<char>& free,
    const SimplexFrame* frame, int threads);
  void cut(const Mesh& mesh, const std::vector<std::int32_t>& vertexOf, const Targets* targets,
    const SimplexFrame* frame, int threads);
  template <int Dim>
  void cutInto(const Mesh& mesh, const std::vector<std::int32_t>& vertexOf, const Targets* targets,
    const SimplexFrame* frame, int threads);
  void findPatches(int threads);
  template <int Dim>
  void findPatchesOf(int threads);
  std::vector<std::uint64_t> blocksAcross(
    const Mesh& mesh, const std::vector<std::int32_t>& vertexOf) const;
  template <int Dim>
  std::vector<std::vector<std::uint64_t>> blocksOfSimplices(int threads) const;
  void findBlocks(const Mesh& mesh, const std::vector<std::int32_t>& vertexOf, int threads);

  int Dim = 3;
  bool Surface = false;
  bool Mirrored = false;
  std::array<Vec3, 3> Frame;
  Vec3 Shift = { 0, 0, 0 };
  double Scale = 1;
  std::int32_t Free = 0;
  std::int32_t Simplices = 0;
  std::vector<std::int32_t> Point;
  std::vector<double> X;
  LargeArray<std::int32_t> Corners, Cell, Shape;
  std::vector<TargetSimplex> Shapes;
  std::vector<std::int32_t> PatchStarts;
  LargeArray<std::int32_t> PatchVertices, PatchCorners;
  VertexBlocks Blocks;
};

}
#endif
