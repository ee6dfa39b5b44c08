// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronAdaptation.h
 * @brief Adapts the edges of a tetrahedral mesh to their target lengths.
 *
 * Rounds of splits (the longest edges first), contractions (the shortest first), swaps and motions,
 * see A. Loseille and F. Alauzet, "Optimal 3D highly anisotropic mesh adaptation based on the
 * continuous mesh framework" (IMR 2009), until hardly any edge changes.
 * Internal: not installed.
 */
#ifndef tautline_TetrahedronAdaptation_h
#define tautline_TetrahedronAdaptation_h

#include "TetrahedronPasses.h"

#include <functional>

namespace tautline
{
/// The number of edges, and the number with a length in the metric from 1 / sqrt(2) to sqrt(2).
struct EdgeShare
{
  Index edges = 0, inRange = 0;
  double deviation = 0; ///< the mean of the absolute logarithms of the lengths
  double share() const
  {
    return this->edges > 0 ? static_cast<double>(this->inRange) / static_cast<double>(this->edges)
                           : 1.0;
  }
};

/// Excludes the surroundings of a part of a mesh.
EdgeShare shareOfEdges(const TetrahedronMesh& mesh);

class TetrahedronAdaptation
{
public:
  /// @param operations with `field`; must outlive this object, as must `passes`
  TetrahedronAdaptation(
    TetrahedronMesh& mesh, CavityOperations& operations, TetrahedronPasses& passes)
    : Mesh(mesh)
    , Operations(operations)
    , Passes(passes)
  {
  }

  /// The operations to use.
  bool swaps = true, moves = true, contracts = true, splits = true;
  int threads = 0;
  /// Called periodically; returns false to stop.
  std::function<bool()> proceed;
  /// Called after each round with the fraction of the work done, 0 to 1, and the share of edges in
  /// range; returns false to stop.
  std::function<bool(double fraction, double share)> record;

  /// Runs rounds until hardly any edge changes. @return false if stopped
  bool run();

private:
  struct SizedEdge
  {
    double length;
    PointId a, b;
  };

  bool round(bool& busy);
  std::vector<SizedEdge> edges(bool tooLong) const;
  bool changeEdges(bool tooLong, Index& changed);
  bool swap(double target);
  bool relax(int sweeps);
  bool finish();
  bool isPoll();

  TetrahedronMesh& Mesh;
  CavityOperations& Operations;
  TetrahedronPasses& Passes;
  Index Polls = 0;
};
}
#endif
