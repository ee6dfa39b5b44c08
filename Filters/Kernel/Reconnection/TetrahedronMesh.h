// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronMesh.h
 * @brief A tetrahedral mesh whose connectivity changes.
 * Internal: not installed.
 *
 * Every change replaces the tetrahedra of a cavity by others with the same outer faces. It is
 * checked before any modification: a replacement that does not match leaves the mesh unchanged. Ids
 * of uninvolved tetrahedra and points stay the same; freed ids are reused, except the ids of input
 * points. Memory: 64 bytes per tetrahedron, 40 per point; 16 more with labels, 48 more with
 * metrics.
 */
#ifndef tautline_TetrahedronMesh_h
#define tautline_TetrahedronMesh_h

#include "TetrahedronQuality.h"
#include "tautline/ReconnectionKernelExport.h"

#include <cstdint>
#include <vector>

namespace tautline
{
using TetId = std::int32_t;
using PointId = std::int32_t;

constexpr std::int32_t NoId = -1;
/// The region number of the tetrahedra around a part of a mesh, which are not changed.
constexpr std::int32_t OutsideRegion = -1;

/// The vertices of the face opposite each vertex, so that (vertex, face) is a positive order.
constexpr int OppositeFace[4][3] = { { 1, 2, 3 }, { 0, 3, 2 }, { 3, 0, 1 }, { 2, 1, 0 } };

/// A face without a label. A label is the number of a kept facet, starting at 1.
constexpr std::int32_t NoLabel = 0;
/// One per face of a tetrahedron.
using FaceLabels = std::array<std::int32_t, 4>;

/// Vertices in VTK's order (positive volume).
using TetVertices = std::array<PointId, 4>;
using TriangleVertices = std::array<PointId, 3>;

struct Tetrahedron
{
  TetVertices vertices; ///< the first is NoId if the slot is free
  /// Face i of the tetrahedron meets face `n & 3` of the tetrahedron `n >> 2`, n = neighbors[i];
  /// NoId: nothing, or a tetrahedron across a nonmanifold face.
  std::array<std::int32_t, 4> neighbors;

  int indexOf(PointId v) const
  {
    for (int i = 0; i < 4; ++i)
    {
      if (this->vertices[i] == v)
      {
        return i;
      }
    }
    return NoId;
  }
};

/// The tetrahedra around an edge. An inner edge has a closed ring with as many tetrahedra as ring
/// vertices, and (a, b, ring[i], ring[i + 1]) are positive; at a wall, the ring is open and has one
/// more vertex.
struct EdgeRing
{
  /// Edges with longer rings are not removed: the number of triangulations grows too fast, and the
  /// gain vanishes.
  static constexpr int MaxSize = 12;
  PointId a = NoId, b = NoId;
  bool closed = false;
  int size = 0;      ///< number of tetrahedra
  int vertices = 0;  ///< number of ring vertices
  bool whole = true; ///< false: the ring is longer than MaxSize
  std::array<TetId, MaxSize> tets;
  std::array<PointId, MaxSize + 1> ring;
};

/// A replacement of some tetrahedra by others.
struct Replacement
{
  std::vector<TetId> before;
  std::vector<TetVertices> after;
  std::vector<double> qualities; ///< of `after`
  /// The regions of `after` if `before` has several regions; otherwise empty: all have the region
  /// of the first.
  std::vector<std::int32_t> regions;
  /// The labels of the faces of `after` if labeled faces change; labels of outer faces are always
  /// kept. Empty: no labeled face may change, except on the boundary, see boundaryLabel.
  std::vector<FaceLabels> labels;
  /// Whether boundary faces may be replaced by others.
  bool opensBoundary = false;
  /// With opensBoundary and without `labels`: the label of the new boundary faces. Boundary faces
  /// with this label or without a label may be replaced.
  std::int32_t boundaryLabel = NoLabel;

  void clear()
  {
    this->before.clear();
    this->after.clear();
    this->qualities.clear();
    this->regions.clear();
    this->labels.clear();
    this->opensBoundary = false;
    this->boundaryLabel = NoLabel;
  }
  void add(const TetVertices& vertices, double quality)
  {
    this->after.push_back(vertices);
    this->qualities.push_back(quality);
  }
};

/// The arrays of a mesh. Entries of the same tetrahedron, and of the same point, correspond.
struct TetrahedronArrays
{
  std::vector<Tetrahedron> tets; ///< including free slots
  std::vector<double> quality;
  std::vector<std::int32_t> region;
  std::vector<TetId> origin;
  std::vector<Vec3> points;
  /// the number of input points, which come first: their ids are not reused
  PointId inputPoints = 0;
  QualityWeights weights;
  std::vector<FaceLabels> labels;    ///< see TetrahedronMesh::labelFaces(); empty: none
  std::vector<MetricTensor> metrics; ///< one per point; empty: none
};

class TAUTLINE_RECONNECTIONKERNEL_EXPORT TetrahedronMesh
{
public:
  /**
   * @param cells positive tetrahedra
   * @param regions one per tetrahedron, or empty: one region
   * @param weights of all qualities
   * @param metrics one per point, or empty
   */
  TetrahedronMesh(std::vector<Vec3> points, const std::vector<TetVertices>& cells,
    const std::vector<std::int32_t>& regions = {}, const QualityWeights& weights = {},
    int threads = 1, std::vector<MetricTensor> metrics = {});
  /// For arrays that are already connected: the neighbors of all faces are given.
  explicit TetrahedronMesh(TetrahedronArrays arrays);

  /// Moves all arrays out; afterwards, the mesh may only be reassigned.
  TetrahedronArrays release();

  ///@{ Slots, some of which may be free.
  TetId slots() const { return static_cast<TetId>(this->Tets.size()); }
  PointId pointSlots() const { return static_cast<PointId>(this->Points.size()); }
  bool alive(TetId t) const { return this->Tets[t].vertices[0] != NoId; }
  /// Whether a tetrahedron uses the point.
  bool used(PointId v) const { return this->PointTet[v] != NoId; }
  ///@}
  Index size() const { return this->Alive; }

  const Tetrahedron& tet(TetId t) const { return this->Tets[t]; }
  double quality(TetId t) const { return this->Quality[t]; }
  std::int32_t region(TetId t) const { return this->Region[t]; }
  /// The input tetrahedron near which a new one was created; for an input tetrahedron, its own id.
  TetId origin(TetId t) const { return this->Origin[t]; }
  const Vec3& point(PointId v) const { return this->Points[v]; }
  TetId tetOf(PointId v) const { return this->PointTet[v]; }

  PointId inputPoints() const { return this->InputPoints; }

  /// Whether both tetrahedra at face i are on the same side of it, by the order of their vertices.
  bool isTurned(TetId t, int i) const;
  /// Orients flat tetrahedra, whose vertex order is meaningless, like their neighbors.
  void orientFlat();
  /// The number of faces used by three or more tetrahedra; these are walls on all sides.
  Index nonManifoldFaces() const { return this->NonManifoldFaces; }
  /**
   * @brief Labels faces with their number in the list plus 1, the first of equal ones. Labeled
   * faces between two tetrahedra are always walls. Triples that are not faces are ignored. Must be
   * called before any replacement.
   * @param boundary whether boundary faces are also labeled
   * @return the number of labeled faces between two tetrahedra
   */
  Index labelFaces(const std::vector<TriangleVertices>& faces, bool boundary);
  bool hasLabels() const { return !this->Labels.empty(); }
  std::int32_t label(TetId t, int i) const
  {
    return this->Labels.empty() ? NoLabel : this->Labels[t][i];
  }
  FaceLabels labels(TetId t) const
  {
    return this->Labels.empty() ? FaceLabels{ NoLabel, NoLabel, NoLabel, NoLabel }
                                : this->Labels[t];
  }

  /// Whether face i is on the boundary, between two regions, or labeled.
  bool isWall(TetId t, int i) const
  {
    const std::int32_t n = this->Tets[t].neighbors[i];
    return n == NoId || this->Region[n >> 2] != this->Region[t] || this->label(t, i) != NoLabel;
  }
  TriangleVertices face(TetId t, int i) const
  {
    const TetVertices& v = this->Tets[t].vertices;
    const int* f = OppositeFace[i];
    return { v[f[0]], v[f[1]], v[f[2]] };
  }
  double computeQuality(const TetVertices& v) const
  {
    const std::vector<Vec3>& x = this->Points;
    return this->Weights.inMetric
      ? this->metricQuality(v)
      : roundedQuality(x[v[0]], x[v[1]], x[v[2]], x[v[3]], this->Weights);
  }
  double computeExactQuality(const TetVertices& v) const
  {
    const std::vector<Vec3>& x = this->Points;
    return exactSign(this->computeQuality(v), x[v[0]], x[v[1]], x[v[2]], x[v[3]]);
  }
  const QualityWeights& weights() const { return this->Weights; }

  ///@{ The metrics of the points, in which target lengths of edges are 1.
  bool hasMetrics() const { return !this->Metrics.empty(); }
  const MetricTensor& metric(PointId v) const { return this->Metrics[v]; }
  void setMetric(PointId v, const MetricTensor& metric) { this->Metrics[v] = metric; }
  ///@}

  /// The tetrahedra with vertex v that are connected with tetOf(v) through faces, walls included.
  void star(PointId v, std::vector<TetId>& tets);
  /**
   * @brief All tetrahedra at the edge of vertices i and j of a tetrahedron, across walls.
   * @param walls set to the walls at the edge: faces i of tetrahedra t, as 4 t + i, from one or
   * both sides
   */
  void fan(TetId t, int i, int j, std::vector<TetId>& tets, std::vector<std::int32_t>& walls) const;
  /// The tetrahedra around the edge of vertices i and j of a tetrahedron, up to walls.
  void ring(TetId t, int i, int j, EdgeRing& ring) const;

  /// Adds a point without tetrahedra. The next replacement may use it; otherwise release it.
  PointId addPoint(const Vec3& x, const MetricTensor& metric = {});
  /// The id that addPoint() will return; below pointSlots() if it is a reused id.
  PointId nextPoint() const
  {
    return this->FreePoints.empty() ? this->pointSlots() : this->FreePoints.back();
  }
  void releasePoint(PointId v);
  /// Restores a point that a replacement has just freed, at its former position.
  void reclaimPoint(PointId v);
  /// Moves a vertex. @param tets its whole star
  /// @param qualities their qualities afterwards; null: compute them
  void movePoint(PointId v, const Vec3& x, const std::vector<TetId>& tets, const double* qualities);

  /**
   * @brief Replaces tetrahedra of one region by others with the same outer faces. Vertices that
   * lose all tetrahedra become free. Undoing replacements in reverse order restores all ids.
   * @param created set to the ids of `after`, in order
   * @return false if the faces do not match; nothing has changed then
   */
  bool replace(const Replacement& replacement, std::vector<TetId>& created);

  /**
   * @brief Divides an edge by a point, and each tetrahedron at it.
   * @param p a new point, from addPoint()
   * @param fan of the edge from a to b
   * @param qualities of the two parts of each tetrahedron, first with a, then with b
   * @param created set to the ids of these parts
   */
  void splitEdge(PointId a, PointId b, PointId p, const std::vector<TetId>& fan,
    const std::vector<double>& qualities, std::vector<TetId>& created);

  /// Checks adjacency, orientation and links of points; the first violation as text, or "".
  std::string findViolation() const;

private:
  struct FaceEntry
  {
    TriangleVertices key;
    std::int32_t code = NoId;
    std::int32_t label = NoLabel;
    bool matched = false;
  };
  /// A small hash table of the faces of a cavity.
  class FaceTable
  {
  public:
    void reset(std::size_t faces);
    /// The entry of a face, or a new one with key[0] = NoId.
    FaceEntry& find(TriangleVertices& key);
    const std::vector<std::int32_t>& filled() const { return this->Filled; }
    FaceEntry& at(std::int32_t i) { return this->Entries[i]; }

  private:
    std::vector<FaceEntry> Entries;
    std::vector<std::int32_t> Filled;
  };

  void connect(int threads);
  std::uint32_t nextMark();
  double metricQuality(const TetVertices& v) const;
  TetId takeSlot();
  bool match(const Replacement& replacement);
  bool matchBoundary(const Replacement& replacement, std::size_t outer);
  void detachPoints(const Replacement& replacement);

  std::vector<Tetrahedron> Tets;
  std::vector<double> Quality;
  std::vector<std::int32_t> Region;
  std::vector<TetId> Origin;
  std::vector<std::uint32_t> Mark;
  std::vector<TetId> FreeTets;
  std::vector<Vec3> Points;
  std::vector<TetId> PointTet;
  std::vector<PointId> FreePoints;
  std::uint32_t CurrentMark = 0;
  Index Alive = 0;
  PointId InputPoints = 0;
  Index NonManifoldFaces = 0;
  QualityWeights Weights;
  std::vector<FaceLabels> Labels;    ///< empty: none
  std::vector<MetricTensor> Metrics; ///< empty: none
  // Work space of replace(), kept to save allocations.
  FaceTable Faces;
  std::vector<std::array<std::int32_t, 4>> Links;
  std::vector<FaceLabels> LinkLabels;
};
}
#endif
