// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleMesh.h
 * @brief A triangle mesh whose connectivity changes.
 * Internal: not installed.
 *
 * Every triangle stores its three neighbors, and every point one of its triangles, so that the
 * triangles around an edge are found in constant time, and the triangles around a point in time
 * proportional to their number. Edges on the border, edges between regions and given edges are
 * walls: they are never swapped.
 *
 *         v[0]
 *         /  \         edge i is opposite vertex i: it joins
 *     e2 /    \ e1     v[i + 1] and v[i + 2] (modulo 3)
 *       /______\
 *     v[1] e0  v[2]
 *
 * A transaction records its changes and can be undone: begin(), changes, commit() or undo(). Ids of
 * uninvolved triangles and points stay the same; freed ids are reused after the transaction, except
 * the ids of input points.
 *
 * Points may have metrics, in which target lengths of edges are 1. Qualities are Euclidean, or the
 * mean ratios in the metrics (setMetrics()).
 * Memory: 64 bytes per triangle, 32 per point, and 56 per point with metrics.
 */
#ifndef tautline_TriangleMesh_h
#define tautline_TriangleMesh_h

#include "TriangleQuality.h"
#include "tautline/Adaptation/MetricTensor.h"
#include "tautline/ReconnectionKernelExport.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tautline
{
using TriId = std::int32_t;
using VertexId = std::int32_t;
using Corners = std::array<VertexId, 3>;

constexpr std::int32_t NoNumber = -1;

/// The vertex after k, and the one before it.
constexpr int Next[3] = { 1, 2, 0 }, Previous[3] = { 2, 0, 1 };

struct Triangle
{
  Corners vertices = { NoNumber, NoNumber, NoNumber }; ///< the first is -1: the slot is free
  /// Per edge: 4 times the neighbor plus its edge; -1 if there is none.
  std::array<std::int32_t, 3> neighbors = { NoNumber, NoNumber, NoNumber };
  TriId origin = NoNumber; ///< a triangle of the input nearby, of the same region and patch
  std::int32_t region = 0;
  std::array<std::int32_t, 3> lines = { NoNumber, NoNumber, NoNumber }; ///< given walls, or -1
  std::uint8_t walls = 0;                                               ///< bit i: edge i is a wall
  double quality = 0;
};

/// The metric at a point, in which target lengths of edges are 1.
struct PointMetric
{
  MetricTensor tensor = {};
  TriId place = NoNumber; ///< the triangle of the input that contains the point, or one near it
};

class TAUTLINE_RECONNECTIONKERNEL_EXPORT TriangleMesh
{
public:
  /**
   * @param regions one per triangle, or empty: one region
   * @param walls pairs of points: edges that are kept; Triangle::lines are their numbers
   * @param planar whether the points are in the xy plane, and the triangles have signs
   *
   * Edges of three or more triangles, and of two with opposite orientations, are borders of each.
   */
  TriangleMesh(std::vector<Vec3> points, const std::vector<Corners>& cells,
    const std::vector<std::int32_t>& regions, const std::vector<std::array<Index, 2>>& walls,
    bool planar);

  TriId slots() const { return static_cast<TriId>(this->Triangles.size()); }
  VertexId pointSlots() const { return static_cast<VertexId>(this->Points.size()); }
  bool alive(TriId t) const { return this->Triangles[t].vertices[0] != NoNumber; }
  bool used(VertexId v) const { return this->PointTriangle[v] != NoNumber; }
  Index size() const { return this->Alive; }
  bool planar() const { return this->Planar; }

  const Triangle& triangle(TriId t) const { return this->Triangles[t]; }
  double quality(TriId t) const { return this->Triangles[t].quality; }
  const Vec3& point(VertexId v) const { return this->Points[v]; }
  TriId triangleOf(VertexId v) const { return this->PointTriangle[v]; }
  bool isWall(TriId t, int i) const { return (this->Triangles[t].walls >> i & 1) != 0; }
  bool isBorder(TriId t, int i) const { return this->Triangles[t].neighbors[i] == NoNumber; }
  /// The number of edges that do not have one triangle or two triangles of the same orientation.
  Index nonManifoldEdges() const { return this->NonManifoldEdges; }
  /// Whether the triangles at a point form more than one fan. Such points must be kept.
  bool isNonManifold(VertexId v) const
  {
    return v < static_cast<VertexId>(this->NonManifold.size()) && this->NonManifold[v] != 0;
  }
  double qualityOf(const Corners& v) const;
  /// The quality of a triangle with any positions, with metrics if qualities are measured in them.
  double qualityOf(
    const std::array<Vec3, 3>& x, const std::array<const MetricTensor*, 3>& metrics) const;

  ///@{ Metrics of points.
  /// @param metrics one per point, or none
  /// @param measure whether qualities are mean ratios in them
  void setMetrics(std::vector<PointMetric> metrics, bool measure);
  bool measuresInMetrics() const { return this->InMetrics; }
  bool hasMetrics() const { return !this->Metrics.empty(); }
  const PointMetric& metric(VertexId v) const { return this->Metrics[v]; }
  /// For a point without triangles, or if qualities are not measured in the metrics.
  void setMetric(VertexId v, const PointMetric& metric);
  /// The length of an edge in the metrics of its ends, see edgeLength().
  double length(VertexId v, VertexId w) const
  {
    return edgeLength(
      this->Points[w] - this->Points[v], this->Metrics[v].tensor, this->Metrics[w].tensor);
  }
  /// @} The index of a vertex in the triangle, 0 to 2.
  int indexOf(TriId t, VertexId v) const
  {
    const Corners& c = this->Triangles[t].vertices;
    return c[0] == v ? 0 : (c[1] == v ? 1 : 2);
  }

  /// The triangles at a point, in cyclic order; at a border, from one end to the other.
  void star(VertexId v, std::vector<TriId>& triangles) const;
  bool areNeighbors(VertexId v, VertexId w) const;

  ///@{ Transactions; without one, changes are final.
  void begin();
  void commit();
  void undo();
  bool inTransaction() const { return this->Open; }
  /// The triangles that the transaction created or modified, and the qualities of the triangles
  /// they replace.
  void compare(std::vector<TriId>& triangles, std::vector<double>& qualitiesBefore) const;
  ///@}

  /// @{ Changes. They return whether the connectivity allows them; otherwise nothing is changed.
  /// Replaces an edge by the other diagonal of its two triangles, which keep their ids.
  bool flip(TriId t, int i);
  /// Divides an edge, including walls. @param metric null: none, or set later @return the new point
  VertexId splitEdge(TriId t, int i, const Vec3& x, const PointMetric* metric = nullptr);
  /// Divides a triangle into three. @return the new point
  VertexId splitTriangle(TriId t, const Vec3& x);
  /// Contracts vertex i of a triangle into vertex j, which removes the triangles at their edge.
  bool contract(TriId t, int i, int j);
  /// @param triangles its star
  /// @param metric null: it keeps its metric
  void movePoint(VertexId v, const Vec3& x, const std::vector<TriId>& triangles,
    const PointMetric* metric = nullptr);
  /// Sets Triangle::origin, to a triangle of the same region and patch.
  void setOrigin(TriId t, TriId origin) { this->Triangles[t].origin = origin; }
  ///@}

  /// Checks adjacency, links of points, signs and stored qualities; the first violation, or "".
  std::string findViolation() const;
  /// The same for some triangles only.
  std::string findViolation(const std::vector<TriId>& triangles) const;

private:
  struct SavedTriangle
  {
    TriId id;
    Triangle before;
  };
  struct SavedPoint
  {
    VertexId id;
    Vec3 position;
    TriId triangle;
    PointMetric metric;
  };

  void connect(const std::vector<std::array<Index, 2>>& walls);
  void findNonManifoldPoints();
  Triangle& change(TriId t);
  void savePoint(VertexId v);
  TriId addTriangle(const Triangle& triangle);
  VertexId addPoint(const Vec3& x, const PointMetric* metric = nullptr);
  void removeTriangle(TriId t);
  void removePoint(VertexId v);
  void attach(TriId t);
  void link(std::int32_t side, std::int32_t other);
  void setVertices(TriId t, const Corners& v);
  bool isOpen(VertexId v, const std::vector<TriId>& around) const;
  bool canContract(TriId t, int edge, VertexId v, VertexId w) const;
  void close(TriId t, VertexId v, VertexId w);
  std::string violationOf(TriId t) const;

  bool Planar;
  std::vector<Triangle> Triangles;
  std::vector<Vec3> Points;
  std::vector<TriId> PointTriangle;
  std::vector<PointMetric> Metrics; ///< per point, or empty
  bool InMetrics = false;           ///< whether qualities are measured in the metrics
  std::vector<char> NonManifold;
  std::vector<TriId> FreeTriangles;
  std::vector<VertexId> FreePoints;
  VertexId InputPoints = 0;
  Index Alive = 0, NonManifoldEdges = 0;
  std::vector<TriId> Around, Others; ///< work space of contract(), kept to save allocations
  mutable std::vector<TriId> Scratch;
  // The state of a transaction.
  bool Open = false;
  std::uint32_t Transaction = 0;
  std::vector<std::uint32_t> TriangleSaved, PointSaved;
  std::vector<SavedTriangle> OldTriangles;
  std::vector<SavedPoint> OldPoints;
  std::vector<TriId> TakenTriangles, ReleasedTriangles;
  std::vector<VertexId> TakenPoints, ReleasedPoints;
  TriId OldSlots = 0;
  VertexId OldPointSlots = 0;
  Index OldAlive = 0;
};
}
#endif
