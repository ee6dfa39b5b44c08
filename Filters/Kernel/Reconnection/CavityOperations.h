// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CavityOperations.h
 * @brief The operations of reconnection on a mesh, each accepted only if it improves the
 * tetrahedra it affects.
 * Internal: not installed.
 *
 * Qualities of the affected tetrahedra are compared in increasing order, before and after: the
 * first that differs decides. Thus, the smallest quality of the mesh never decreases, nor do the
 * smallest dihedral angle and the mean ratio of the worst tetrahedra (`QualityFloor`). Operations
 * return whether the mesh changed; changed() then lists the tetrahedra to revisit.
 */
#ifndef tautline_CavityOperations_h
#define tautline_CavityOperations_h

#include "BoundarySurface.h"
#include "EdgeMetric.h"
#include "InputMetric.h"
#include "StarSmoothing.h"
#include "tautline/ReconnectionKernelExport.h"

#include <memory>

namespace tautline
{
/// The worst values of the input: no operation creates a tetrahedron that is worse in either.
struct QualityFloor
{
  double smallestAngle = 0; ///< degrees
  double meanRatio = 0;     ///< (mean ratio)^(3/2)
  /// Tetrahedra of at least this quality are above both.
  double sufficient = 0;
  /// the smallest quality; motions for the mean preserve it if it is based on a metric
  double quality = 0;
};

/// The numbers of accepted operations and point moves.
struct OperationCounts
{
  Index edgeRemovals = 0, faceRemovals = 0, boundarySwaps = 0;
  Index contractions = 0, insertions = 0, moves = 0;
};

/// The constraints of operations, and the freedom of points.
struct OperationRules
{
  /// One per point slot of the mesh; slots of new points are free.
  std::vector<PointFreedom> freedoms;
  /// The factor by which new edges may be longer or shorter, if the points have metrics.
  double edgeFactor = 2.0;
  bool inserts = true; ///< whether repairs may insert points
  /// whether facets may be improved by contractions and motions
  bool contracts = true, moves = true;
  bool sums = false; ///< whether ReconnectionObjective::Sum is used instead of the worst qualities
  QualityFloor floor;
  Index smallestSize = 0, largestSize = 0; ///< bounds of the number of tetrahedra
  /// Whether edges between coplanar facets may be removed, and facets and edges of the boundary
  /// divided.
  bool swapsBoundary = false;
  /// The sine of the largest angle between coplanar facets, or between equal directions.
  double flatTolerance = 0;
  /// For BoundaryMotion::OnSurface, otherwise null.
  std::shared_ptr<const BoundarySurface> surface;
  /// With qualities in the metric: the metric at any position; otherwise null.
  std::shared_ptr<const InputMetric> field;
  /// The class of each facet that may be labeled, from 1 on, by its label; others have class 0.
  /// Edges between facets of different classes are preserved.
  std::vector<std::int32_t> classes;
  /// Per point of the input: whether it is nonmanifold. An edge between two of these may have
  /// tetrahedra that are not connected through faces, and is not split.
  std::vector<char> nonManifold;
};

class TAUTLINE_RECONNECTIONKERNEL_EXPORT CavityOperations : public OperationRules
{
public:
  explicit CavityOperations(TetrahedronMesh& mesh)
    : Mesh(mesh)
  {
  }

  /// Removes the edge of vertices i and j of a tetrahedron: Klincsek's dynamic programming finds
  /// the triangulation of its ring that maximizes the worst tetrahedron.
  bool removeEdge(TetId t, int i, int j);
  /// Removes face i, and adjacent faces visible from the same two vertices, and connects these two
  /// vertices.
  bool removeFaces(TetId t, int i);
  /// Moves a vertex to maximize the smallest quality of its star.
  bool smooth(PointId v, int steps);
  /// Moves a vertex so that the sum of the inverse mean ratios around decreases without falling
  /// below the floor. @return the decrease
  /// @param least a smaller decrease is ignored
  double improveMean(PointId v, double least = 0.0);
  /// Sets the minimum gain of a motion; points that could not be moved are tried again.
  void setLeastGain(double gain)
  {
    this->Smoothing.leastGain = gain;
    this->SmoothedAt.assign(this->Mesh.pointSlots(), 0);
  }
  /// Contracts vertex i of a tetrahedron into vertex j, which removes the tetrahedra at their edge.
  bool contract(TetId t, int i, int j);
  /// Inserts a point into the tetrahedron or one of its faces or edges, and connects it to the
  /// faces of a cavity; the best point and cavity are determined before the mesh is changed.
  bool insert(TetId t);

  /// @{ With qualities in the metric: operations for the lengths of edges. Divides the edge of
  /// vertices i and j of a tetrahedron into two of equal length.
  bool splitEdge(TetId t, int i, int j);
  /// Contracts one of the vertices i and j into the other, if no edge becomes too long.
  bool contractEdge(TetId t, int i, int j);
  /// Moves a point to reduce the sum of the inverse mean ratios of the surrounding tetrahedra and
  /// of the squared logarithms of the lengths of its edges.
  bool relax(PointId v);
  ///@}

  /**
   * @brief Improves a facet of the outer boundary: swaps or contracts one of its edges, or moves
   * one of its points. The smallest mean ratio of the changed facets increases. The adjacent
   * tetrahedra may become worse, down to a fraction of the smallest quality around (Tolerated) but
   * not below the floor.
   */
  bool improveFacet(TetId t, int i);

  /// A change that may initially reduce qualities, and becomes an improvement after moving the
  /// surrounding vertices. If it does not, everything is restored.
  enum class Compound
  {
    Insertion,
    Contraction,
    Swap
  };
  bool tryCompound(TetId t, Compound kind);
  /// The largest number of swaps and insertions that follow a tentative change.
  int repairs = 0;
  /// Set if the bounds of the number of tetrahedra prevented an operation.
  bool countLimited = false;

  const std::vector<TetId>& changed() const { return this->Created; }
  const OperationCounts& counts() const { return this->Counts; }
  void addCounts(const OperationCounts& counts);
  /// Increases with each change near a point: moves of the point or of its neighbors.
  std::uint32_t stamp(PointId v) const { return this->Stamps[v]; }
  std::uint32_t clock() const { return this->Clock; }
  void prepareStamps()
  {
    this->Stamps.resize(this->Mesh.pointSlots(), 0);
    this->SmoothedAt.resize(this->Mesh.pointSlots(), 0);
    this->RelaxedAt.resize(this->Mesh.pointSlots(), 0);
  }

private:
  struct CavityFace
  {
    TetId tet;
    int face;
    double quality;
  };
  /// A cavity and the point to connect to its faces.
  struct Insertion
  {
    std::vector<TetId> tets;
    Vec3 point = { 0, 0, 0 };
    PointFreedom freedom; ///< of the point: not Free on the boundary
    /// On a curved boundary: the facets that the point divides, and their number.
    std::array<TriangleVertices, 2> opened = {};
    int openedCount = 0;
    double quality = -1;
  };

  /// A tentatively performed step: a replacement, the motion of a point (nothing before), or the
  /// use of a point for an insertion (nothing created).
  struct Step
  {
    std::vector<TetVertices> before;
    std::vector<TetId> created;
    std::vector<double> qualities; ///< of `before`; if a point was moved, of `created`
    bool opensBoundary = false;
    PointId point = NoId;
    Vec3 position = { 0, 0, 0 };
    bool isReused = false; ///< whether the point for an insertion existed
    PointFreedom freedom;  ///< its former freedom
    EdgeMetric metric = {};
  };

  bool commit();
  bool applyChange();
  bool isValidChange();
  bool smoothAround(double above);
  void cleanAffected();
  bool repair(TetId t);
  bool repairAround(double above);
  bool finishCompound(double above);
  void undo();
  void restorePoint(const Step& step);
  bool findInsertion(TetId t, Insertion& best, std::vector<Insertion>* all = nullptr);
  bool applyInsertion(const Insertion& best);
  bool prepareEdgeRemoval(TetId t, int i, int j, double above);
  bool prepareFaceRemoval(TetId t, int i, double above);
  bool tryInsertions(TetId t, double above);
  template <class Operation>
  bool attempt(double above, const Operation& operation);
  bool prepareContraction(TetId t, int i, int j, double above);
  bool improves();
  bool aboveFloor(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, double q) const;
  bool loadStar(PointId v, StarSmoothing& star);
  void touch(const std::vector<TetId>& tets);
  // In the metric.
  std::int32_t classOf(std::int32_t label) const
  {
    return label == NoLabel ? 0 : this->classes[label];
  }
  bool smoothInMetric(PointId v, int steps);
  bool acceptMotion(PointId v, const Vec3& p, double least);
  TetId cellNear(PointId v) const;
  bool isNonManifold(PointId v) const
  {
    return v < static_cast<PointId>(this->nonManifold.size()) && this->nonManifold[v];
  }
  bool splitAt(PointId a, PointId b, const Vec3& x, const PointFreedom& freedom);
  bool freedomOfSplit(PointId a, PointId b, PointFreedom& freedom) const;
  bool curvedSplit(PointId a, PointId b, Vec3& x, PointFreedom& freedom) const;
  bool canContractInMetric(TetId t, int i, int j);
  double prepareContractionInMetric(PointId v, PointId w);
  bool labelBoundarySwap(const EdgeRing& ring);
  bool isFlat(const EdgeRing& ring) const;
  bool canSwapBoundary(const EdgeRing& ring);
  double triangulate(const EdgeRing& ring, double above);
  bool improveSum(PointId v);
  bool decreasesSum() const;
  bool canTriangulateForSum(const EdgeRing& ring);
  double excess(const TetVertices& v) const;
  /// The bound that tetrahedra must exceed when a tetrahedron of this quality is replaced.
  double leastOf(TetId t) const { return this->sums ? 0.0 : this->Mesh.quality(t); }
  // For facets.
  bool swapFacet(TetId t, int i, int j);
  bool contractFacet(TetId t, int i, int j, double ratio);
  bool moveFacet(PointId v, double ratio);
  double tolerated(const std::vector<TetId>& tets) const;
  double facetRatio(const TriangleVertices& f) const;
  double smallestFacetRatio(PointId v, const Vec3& p) const;
  void addTriangles(const EdgeRing& ring, int i, int j);
  double extendFaces(PointId a, PointId b, TetId above, PointId u, PointId w, int depth);
  void grow(Insertion& insertion);
  void addToCavity(TetId t);
  bool startInsertion(const std::vector<TetId>& start, Insertion trial, Insertion& best);
  bool isOpened(const CavityFace& face, const Insertion& insertion) const;
  PointFreedom freedomOnEdge(const EdgeRing& ring) const;
  bool isOuter(const EdgeRing& ring) const;
  bool keepsLengths(PointId v, const std::vector<PointId>& others, bool isInsertion) const;
  EdgeMetric meanMetric(const std::vector<PointId>& points) const;
  bool canContract(PointId v, PointId w, const EdgeRing& ring);
  // On a curved boundary.
  PointFreedom freedomAt(PointId v) const;
  std::function<Vec3(const Vec3&)> projectionOf(const PointFreedom& freedom) const;
  std::array<Vec3, 3> facetOf(const TriangleVertices& facet) const;
  int patchOf(const TriangleVertices& facet) const;
  bool keepsSurface(const TriangleVertices& facet) const;
  bool keepsSurface(PointId v, const Vec3& p) const;
  bool keepsSurface();
  bool canSwapCurved(const EdgeRing& ring);
  bool canContractCurved(PointId v, PointId w, const EdgeRing& ring);
  bool prepareInsertion(const TriangleVertices& facet, Insertion& insertion) const;
  bool prepareInsertion(const EdgeRing& ring, Insertion& insertion) const;

  TetrahedronMesh& Mesh;
  OperationCounts Counts;
  std::vector<std::uint32_t> Stamps;
  std::vector<std::uint32_t> SmoothedAt; ///< clock at the last unsuccessful motion, per point
  std::vector<std::uint32_t> RelaxedAt;  ///< the same for relax()
  std::uint32_t Clock = 0;
  Replacement Change;
  std::vector<TetId> Created, Star, OtherStar, Fan;
  std::vector<std::int32_t> Walls;
  std::vector<TetId> Cells; ///< of the input, per point slot: a nearby cell; NoId: unknown
  std::vector<double> Before, After;
  StarSmoothing Smoothing;
  EdgeRing Ring;
  std::array<std::array<double, EdgeRing::MaxSize + 1>, EdgeRing::MaxSize + 1> Best;
  std::array<std::array<int, EdgeRing::MaxSize + 1>, EdgeRing::MaxSize + 1> Middle;
  std::vector<CavityFace> CavityFaces;
  std::vector<TetId> Cavity;
  // Whether a compound operation is in progress.
  bool Tentative = false;
  bool OfFacets = false; ///< whether the facets of a change decide instead of its tetrahedra
  std::vector<Step> Steps;
  std::vector<TetId> Affected;
};
}
#endif
