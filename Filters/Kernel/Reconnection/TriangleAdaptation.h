// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleAdaptation.h
 * @brief Changes a triangle mesh until its edges have about length 1 in a metric field.
 * Internal: not installed.
 *
 * In rounds, edges longer than sqrt(2) are split, the longest first; edges shorter than 1 / sqrt(2)
 * contracted, the shortest first; edges flipped where the smaller quality of their triangles
 * increases; and points moved. Lengths are computed by edgeLength(), in the metrics of the ends.
 */
#ifndef tautline_TriangleAdaptation_h
#define tautline_TriangleAdaptation_h

#include "TriangleOperations.h"

namespace tautline
{
class TAUTLINE_RECONNECTIONKERNEL_EXPORT TriangleAdaptation
{
public:
  /// Edges at least this long are split, edges at most as long as the inverse contracted.
  static constexpr double LongestEdge = 1.4142135623730951;

  /**
   * @param mesh with qualities measured in metrics
   * @param operations of this mesh, with freedoms and a field
   */
  TriangleAdaptation(TriangleMesh& mesh, const TriangleInput& input, TriangleOperations& operations)
    : Mesh(mesh)
    , Input(input)
    , Operations(operations)
  {
  }

  /// The operations to use.
  bool splits = true, contracts = true, flips = true, moves = true;
  /// Called periodically; returns false to stop.
  std::function<bool()> proceed;

  /**
   * @brief One round.
   * @return false if ended by `proceed`
   */
  bool runRound();
  /// The fraction of the modifiable edges whose lengths are in between.
  double shareOfUnitEdges() const;

  ///@{ Single operations, with flips around. @return whether the mesh changed
  /// Splits edge i if none of the new edges is farther from length 1 than this one.
  bool split(TriId t, int i);
  /// Contracts edge i into the end that gives better triangles, if no new edge is too long and no
  /// triangle becomes bad.
  bool contract(TriId t, int i);
  /// Moves a point so that the surrounding triangles become closer to unit triangles.
  bool move(VertexId v);
  ///@}

private:
  struct Edge
  {
    double length;
    VertexId low, high;
    TriId triangle;
    int side;
  };
  /// The result of a contraction.
  struct Contraction
  {
    double quality = -1; ///< the smallest quality; negative: it is not possible
    double longest = 0;  ///< new edge
  };

  /// The lower bounds of qualities: absolute, and as a fraction of the smallest before.
  struct Bounds
  {
    double quality, part;
  };
  /// A point that divides an edge.
  struct Middle
  {
    Vec3 x;
    PointMetric metric;
    PointFreedom freedom;
  };

  template <class Wanted>
  void collect(const Wanted& wanted);
  template <class Less, class Wanted>
  void pushChanged(const Less& less, const Wanted& wanted);
  bool makeEdge(TriId t, int i, Edge& edge) const;
  bool isStill(const Edge& edge) const;
  bool splitAll();
  bool contractAll();
  bool flipAll();
  bool moveAll();
  void flipAround(VertexId p);
  bool mayMoveInto(TriId t, int i, int j) const;
  Contraction tryContraction(TriId t, int i, int j);
  bool contractAndMove(TriId t, int i, int j);
  template <class Change, class Unwanted>
  bool changeAndMove(
    const Change& change, const Unwanted& unwanted, const Bounds& bounds, Index& counter);
  template <class Unwanted>
  bool isGoodAround(VertexId p, const Unwanted& unwanted, const Bounds& bounds);
  Middle middleOf(TriId t, int i) const;
  double qualityOfHalves(TriId t, int i, const Middle& middle, double least) const;
  VertexId divide(TriId t, int i, const Middle& middle);
  double energyAround(VertexId v, const Vec3& x, const PointMetric& metric) const;
  bool goesOn();

  TriangleMesh& Mesh;
  const TriangleInput& Input;
  TriangleOperations& Operations;
  std::vector<Edge> Edges; ///< a heap
  std::vector<TriId> Around, Stack, Changed;
  std::vector<double> Before;
  std::vector<std::uint32_t> Still; ///< per point: the clock when it was last found optimal
  std::uint32_t Flipped = 0;        ///< the clock when all edges were last checked
  Index Steps = 0;
};
}
#endif
