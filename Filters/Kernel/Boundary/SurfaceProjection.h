// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceProjection.h
 * @brief The closest point of a surface mesh.
 * Internal: not installed.
 */
#ifndef tautline_SurfaceProjection_h
#define tautline_SurfaceProjection_h

#include "SurfaceModel.h"
#include "tautline/Patches/SimplexMesh.h"

namespace tautline
{
/// The cells of a surface mesh, or the boundary facets of a volume or planar mesh.
TAUTLINE_KERNEL_EXPORT std::vector<SurfaceFacet> surfaceFacets(const Mesh& mesh);

/// The point closest to x of a triangle, or of an edge, which repeats the last corner.
TAUTLINE_KERNEL_EXPORT Vec3 closestOnTriangle(const std::array<Vec3, 3>& corner, const Vec3& x);

/**
 * @brief Adds the sample points for distances of a triangle or an edge: the corners of the parts
 * into which its edges are divided, and the center.
 * @param divisions of each edge
 */
void addSamples(const std::array<Vec3, 3>& corner, int divisions, std::vector<Vec3>& places);

/**
 * @brief Triangles in a bounding volume hierarchy. Quadrilaterals become two triangles; edges
 * become degenerate triangles.
 *
 * On a smooth part (see SurfaceModel), the closest point is found from the flat pieces: S maps the
 * closest point of a flat piece to the curved one, and y, with S(y) closest to x, is found by a
 * fixed-point iteration, in which the tangential part of x - S(y) is added to y.
 */
class TAUTLINE_KERNEL_EXPORT SurfaceProjection
{
public:
  SurfaceProjection() = default;
  /// The facets of a mesh, see surfaceFacets(), in the coordinates of `simplices` (see
  /// SimplexMesh::transform()).
  SurfaceProjection(const Mesh& mesh, const SimplexMesh& simplices);

  /// Some facets of a mesh, in the coordinates of `simplices`.
  SurfaceProjection(
    const Mesh& mesh, const std::vector<SurfaceFacet>& facets, const SimplexMesh& simplices);

  /// A patch or curve in the coordinates of `simplices`; null: of the model.
  SurfaceProjection(const SurfacePart& part, const SimplexMesh* simplices);

  /// All pieces of a model as facets, for distances: its patches, or its curves if it has no
  /// patches.
  static SurfaceProjection ofFacets(const SurfaceModel& model, const SimplexMesh* simplices);
  /// The same for a range of its parts, which nearestPart() distinguishes.
  static SurfaceProjection ofParts(
    const SurfaceModel& model, int begin, int end, const SimplexMesh* simplices);

  /// Whether it consists of edges.
  bool isCurve() const { return this->Curve; }
  bool empty() const { return this->Pieces.empty(); }

  /// The point of the surface closest to x.
  Vec3 closest(const Vec3& x) const;
  /// The same with the unit normal there (for a curve, the unit tangent); zero if there is none.
  Vec3 closest(const Vec3& x, Vec3& direction) const;
  /**
   * @brief The same, but faster for a sequence of nearby points.
   * @param piece where the search begins: -1, or the result for a point near x; set to the nearest
   *   piece
   */
  Vec3 closest(const Vec3& x, Vec3& direction, std::int32_t& piece) const;
  Vec3 direction(const Vec3& x) const;
  /// The part of the model that the closest facet belongs to; -1 without facets.
  std::int32_t nearestPart(const Vec3& x) const;

  /**
   * @brief The distance of x from the facets, or any number up to `enough` if it is at most
   * `enough`, or any number above `most` if it exceeds `most`. Infinite without facets.
   * @param piece where the search begins: 0, or the result for a point near x; set to the nearest
   *   piece
   */
  double distanceOf(const Vec3& x, double enough, double most, std::int32_t& piece) const;

  /// The number of a piece returned by distanceOf(), in the order of the part or the facets.
  std::int32_t source(std::int32_t piece) const { return this->Pieces[piece].source; }

  /// The samples of the facets, see addSamples(), each once.
  std::vector<Vec3> samples(int divisions) const;
  /// The largest distance of the samples from another surface.
  double distanceTo(const SurfaceProjection& other, int threads = 1, int divisions = 2) const;

private:
  /// A triangle, or an edge that repeats the last corner.
  struct Piece
  {
    std::array<Vec3, 3> corner;
    std::int32_t controls;   ///< index in Controls; -1: flat
    std::int32_t part = 0;   ///< of the model, see ofParts()
    std::int32_t source = 0; ///< its number as given
  };
  struct Node
  {
    Vec3 low, high;
    std::int32_t first, count; ///< count 0: children are first and first + 1
  };
  struct Ball
  {
    Vec3 center;
    double radius;
  };
  /// A point of the curved surface with the normal, or tangent, there.
  struct Place
  {
    Vec3 point, direction;
  };

  void add(const SurfacePart& part, const SimplexMesh* simplices, std::int32_t number = 0);
  void build();
  void build(std::int32_t node, std::int32_t first, std::int32_t count);
  std::int32_t nearest(const Vec3& x, Vec3& point, std::int32_t first = -1) const;
  Vec3 closestOf(std::int32_t piece, const Vec3& x) const
  {
    return closestOnTriangle(this->Pieces[piece].corner, x);
  }
  bool isOver(std::int32_t piece, const Vec3& x, Vec3& foot) const;
  Place lift(std::int32_t piece, const Vec3& foot) const;
  Place find(const Vec3& x, std::int32_t& piece) const;

  std::vector<Piece> Pieces;
  std::vector<Ball> Balls; ///< around the pieces
  std::vector<CubicControls> Controls;
  std::vector<Node> Nodes;
  bool Curve = false;
};
}
#endif
