// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronMesh.h
 * @brief A tetrahedral mesh whose connectivity changes.
 * Internal: not installed.
 *
 * Every change replaces the tetrahedra of a cavity by others with the same outer faces. It is
 * checked before anything is touched: a replacement that does not fit leaves the mesh as it was.
 * Ids of tetrahedra and points that are not involved stay; those that become free are used again,
 * except the ids of the points of the input.
 * Memory: 64 bytes per tetrahedron, 40 per point; 16 more with labels, 48 more with metrics.
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
/// The region of tetrahedra around a part of a mesh, which are not changed.
constexpr std::int32_t OutsideRegion = -1;

/// The vertices of the face opposite each vertex, so that (vertex, face) is a positive order.
constexpr int OppositeFace[4][3] = { { 1, 2, 3 }, { 0, 3, 2 }, { 3, 0, 1 }, { 2, 1, 0 } };

/// A face without a label. A label is the number of a facet that is kept, from 1 on.
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
  /// NoId: nothing, or a tetrahedron through a face that is not manifold.
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

/// The tetrahedra round an edge. For an inner edge (closed) there are as many as ring vertices, and
/// (a, b, ring[i], ring[i + 1]) are positive; at a wall the ring is open and has one vertex more.
struct EdgeRing
{
  /// Longer rings are not removed: the number of triangulations grows too fast, the gain vanishes.
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
  /// Of `after`, where `before` are of several regions; else empty: all are of the first one's.
  std::vector<std::int32_t> regions;
  /// Of the faces of `after`, where labeled faces change; those of outer faces stay, whatever is
  /// given. Empty: no labeled face may change, except on the boundary, see boundaryLabel.
  std::vector<FaceLabels> labels;
  /// Whether faces of the boundary may be replaced by others.
  bool opensBoundary = false;
  /// With opensBoundary and without `labels`: of the new faces of the boundary. Faces of the
  /// boundary may be replaced that have this one, or none.
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

/// What a mesh is made of. Entries of the same tetrahedron, and of the same point, correspond.
struct TetrahedronArrays
{
  std::vector<Tetrahedron> tets; ///< also free slots
  std::vector<double> quality;
  std::vector<std::int32_t> region;
  std::vector<TetId> origin;
  std::vector<Vec3> points;
  PointId inputPoints = 0; ///< the first points are the input's: their ids are not used again
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
  /// Connected already: neighbours of all faces are as given.
  explicit TetrahedronMesh(TetrahedronArrays arrays);

  /// Moves everything out; the mesh must not be used afterwards but to be replaced.
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
  /// The input's tetrahedron a new one was made near; its own id for those of the input.
  TetId origin(TetId t) const { return this->Origin[t]; }
  const Vec3& point(PointId v) const { return this->Points[v]; }
  TetId tetOf(PointId v) const { return this->PointTet[v]; }

  PointId inputPoints() const { return this->InputPoints; }

  /// Whether both tetrahedra at face i are on the same side of it, by the order of their vertices.
  bool isTurned(TetId t, int i) const;
  /// Gives flat tetrahedra, whose order of vertices means nothing, the order of those around.
  void orientFlat();
  /// Faces that are used by three or more tetrahedra; these are walls on all sides.
  Index nonManifoldFaces() const { return this->NonManifoldFaces; }
  /**
   * @brief Labels faces with their number in the list plus 1, the first of equal ones. Labeled
   * faces between two tetrahedra are walls, whatever is around them. Triples that are no faces are
   * ignored. To be called before any replacement.
   * @param boundary whether faces of the boundary are labeled, too
   * @return how many between two tetrahedra
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
   * @param walls set to the walls at the edge: faces i of tetrahedra t, as 4 t + i, each from one
   * side, or from both
   */
  void fan(TetId t, int i, int j, std::vector<TetId>& tets, std::vector<std::int32_t>& walls) const;
  /// The tetrahedra round the edge of vertices i and j of a tetrahedron, up to walls.
  void ring(TetId t, int i, int j, EdgeRing& ring) const;

  /// A point without tetrahedra. The next replacement may use it; else release it.
  PointId addPoint(const Vec3& x, const MetricTensor& metric = {});
  /// The id that addPoint() will return; below pointSlots() if it was used before.
  PointId nextPoint() const
  {
    return this->FreePoints.empty() ? this->pointSlots() : this->FreePoints.back();
  }
  void releasePoint(PointId v);
  /// Takes a point back that a replacement has just freed, at its place as it was.
  void reclaimPoint(PointId v);
  /// Moves a vertex. @param tets its whole star
  /// @param qualities theirs afterwards; null: to be computed
  void movePoint(PointId v, const Vec3& x, const std::vector<TetId>& tets, const double* qualities);

  /**
   * @brief Replaces tetrahedra of one region by others with the same outer faces. Vertices that
   * lose all tetrahedra become free. Replacing the created ones by the former ones, the last
   * replacement first, restores all ids.
   * @param created set to the ids of `after`, in order
   * @return false if the faces do not match; nothing has changed then
   */
  bool replace(const Replacement& replacement, std::vector<TetId>& created);

  /**
   * @brief Divides an edge in two by a point, and each tetrahedron at it.
   * @param p a new point, from addPoint()
   * @param fan of the edge from a to b
   * @param qualities of the parts of each tetrahedron, that with a and that with b, in turn
   * @param created set to the ids of these
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
  // Of replace(), kept to save allocations.
  FaceTable Faces;
  std::vector<std::array<std::int32_t, 4>> Links;
  std::vector<FaceLabels> LinkLabels;
};
}
#endif
