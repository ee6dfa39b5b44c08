// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleOperations.h
 * @brief The operations of the reconnection of triangles, each accepted only if it improves the
 * triangles it affects.
 * Internal: not installed.
 *
 * Qualities of the affected triangles are compared in increasing order, before and after: the first
 * that differs decides. Operations return whether the mesh changed; changed() then lists the
 * triangles to revisit.
 */
#ifndef tautline_TriangleOperations_h
#define tautline_TriangleOperations_h

#include "StarSmoothing.h"
#include "TriangleInput.h"
#include "TriangleMesh.h"
#include "TriangleMetrics.h"
#include "TriangleStar.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
class TAUTLINE_RECONNECTIONKERNEL_EXPORT TriangleOperations
{
public:
  /// The numbers of accepted operations.
  struct Counts
  {
    Index flips = 0, contractions = 0, insertions = 0, moves = 0;
  };

  TriangleOperations(TriangleMesh& mesh, const TriangleInput& input)
    : Mesh(mesh)
    , Input(input)
  {
  }

  /// One per point slot of the mesh; freedoms of new points are set here.
  std::vector<PointFreedom> freedoms;
  double leastMeanRatio = 0;               ///< no operation creates a triangle with a smaller one
  Index smallestSize = 0, largestSize = 0; ///< bounds of the number of triangles
  /// If qualities are measured in metrics: the metric field. Null: qualities are Euclidean, and new
  /// points get the mean of the surrounding metrics.
  const TriangleMetrics* field = nullptr;
  double edgeFactor = 2.0;   ///< factor by which new edges may be longer or shorter in the metrics
  bool dividesWalls = false; ///< whether edges of walls may be divided
  /// The operations that follow insertions and contractions.
  bool flips = true, moves = true;
  /// minimum gain of the smallest quality by a motion or a compound change
  double leastGain = 1e-4;
  double target = 1; ///< the target quality of inserted points

  /// Replaces edge i by the other diagonal of its two triangles.
  bool flip(TriId t, int i);
  /// Moves a point to maximize the smallest quality of its star.
  bool smooth(VertexId v, int steps);
  /// Moves a point to reduce the sum of the surrounding inverse mean ratios without any quality
  /// falling below the minimum. @return the decrease
  double improveMean(VertexId v, double leastQuality);
  /**
   * @brief Moves points of curved parts of a closed surface along their normals, all by the same
   * distance, until it encloses the given volume. Points are restored where a quality falls below
   * the minimum or triangles are not accepted: then the volume may not be reached.
   */
  void keepVolume(double volume, double leastQuality);
  /// The volume that a closed surface encloses; negative if its triangles face inwards.
  double enclosedVolume() const;
  /// Contracts vertex i into vertex j, then flips edges and moves points around it.
  bool contract(TriId t, int i, int j);
  /// Inserts a point at one of several positions in or near the triangle, then flips edges and
  /// moves points around it.
  bool insert(TriId t);

  /// @{ For changes by other classes, which report them with touch(). Whether a triangle is
  /// acceptable: positive, above the floor, and on the surface.
  bool accepts(const Corners& v, TriId origin) const;
  /// Whether edge i may be divided; walls only with `dividesWalls`.
  bool mayDivide(TriId t, int i) const;
  /// The fraction of an edge before the point that halves its length in the metrics; 1/2 without
  /// metrics.
  double middleOf(VertexId a, VertexId b) const;
  /// The patch of a triangle on a surface.
  int patchOf(TriId t) const
  {
    return this->Input.planar ? 0 : this->Input.patches[this->Mesh.triangle(t).origin];
  }
  /// The directions in which a point with this star moves.
  TriangleStar::Directions directionsAt(VertexId v, const std::vector<TriId>& star) const;
  void touch(const std::vector<TriId>& triangles);
  Counts& counters() { return this->Count; }
  ///@}

  const std::vector<TriId>& changed() const { return this->Changed; }
  const Counts& counts() const { return this->Count; }
  /// Increases with each change near a point.
  std::uint32_t stamp(VertexId v) const
  {
    return v < static_cast<VertexId>(this->Stamps.size()) ? this->Stamps[v] : 0;
  }
  std::uint32_t clock() const { return this->Clock; }

private:
  template <class Operation>
  bool attempt(const Operation& operation, Index& counter);
  void setPoint(VertexId p, const PointFreedom& freedom, const std::vector<VertexId>& around);
  bool improves();
  bool isBetterFlip(TriId t, int i);
  bool applyMotion(VertexId v, int steps);
  double sumAround(double leastQuality) const;
  Vec3 bentArea() const;
  void tidy();
  VertexId divide(TriId t, int i);
  bool insertAt(TriId t, const Vec3& x);
  bool keepsLengths();
  double squaredLengthOf(VertexId v, VertexId w) const;
  bool maximizeAround(VertexId v, int steps, Vec3& x, double& before);
  bool maximizeInMetrics(VertexId v, int steps, Vec3& x, double& before);

  TriangleMesh& Mesh;
  const TriangleInput& Input;
  Counts Count;
  TriangleStar Star;
  /// The point of the operation whose edges must respect the target lengths, and from which side.
  VertexId Centre = NoNumber;
  bool IsInsertion = false;
  std::vector<TriId> Changed, Around, Near;
  std::vector<double> Before, After;
  std::vector<std::uint32_t> Stamps;
  std::uint32_t Clock = 0;
};
}
#endif
