// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronPasses.h
 * @brief The order in which reconnection processes tetrahedra: worst first.
 * Internal: not installed.
 */
#ifndef tautline_TetrahedronPasses_h
#define tautline_TetrahedronPasses_h

#include "CavityOperations.h"
#include "ReconnectionProgress.h"

#include <functional>

namespace tautline
{
/// One pass: the tetrahedra to improve, and the operations.
struct PassOptions
{
  double target = 1;  ///< tetrahedra below this quality are processed
  bool swap = true;   ///< removal of edges and faces
  bool smooth = true; ///< motion of vertices
  /// whether to skip tetrahedra that cannot be better because of their walls
  bool skipsBound = true;
  bool contract = false;
  bool insert = false;
  bool facets = false; ///< whether boundary facets are improved first
  /// whether to try insertions (and contractions) that only pay off after smoothing
  bool compound = false;
  Index maxFailures = 0;  ///< ends after this many unsuccessful tetrahedra; 0: no limit
  int repairs = 0;        ///< see CavityOperations::repairs
  int smoothingSteps = 2; ///< of a vertex, each time
  /// a vertex is moved if the smallest quality of its star gains this much
  double leastGain = 2e-3;
};

/// Processes tetrahedra below a target, worst first, until none of them can be improved.
class TetrahedronPasses
{
public:
  TetrahedronPasses(TetrahedronMesh& mesh, CavityOperations& operations)
    : Mesh(mesh)
    , Operations(operations)
  {
  }

  /// Called periodically with the number of operations so far; returns false to stop.
  std::function<bool()> proceed;

  /// One flag per point. A pass starts with the tetrahedra that have a flagged point; empty: with
  /// all.
  std::vector<char> starts;
  /// One flag per point. Tetrahedra with a flagged point are only improved by operations that
  /// preserve the number of points; empty: none.
  std::vector<char> postponed;

  /// Runs a pass. @return the number of accepted operations, or -1 if stopped
  Index run(const PassOptions& options);

  /// Whether the last pass ended because of PassOptions::maxFailures.
  bool exhausted() const { return this->Exhausted; }

  /// An upper bound of the quality of a tetrahedron, given by the mean ratios of its walls and the
  /// angles between them.
  double bound(TetId t) const;
  bool isAtBound(TetId t) const;

private:
  void push(TetId t, double target);
  bool startsWith(TetId t) const;
  bool isFlagged(TetId t, const std::vector<char>& flags) const;
  bool improve(TetId t, const PassOptions& options);
  Index runFacets(double target);
  bool swap(TetId t);
  bool contract(TetId t);

  TetrahedronMesh& Mesh;
  CavityOperations& Operations;
  QualityQueue<TetId> Waiting;
  bool Exhausted = false;
  /// The last unsuccessful attempt.
  struct Attempt
  {
    std::uint32_t clock = 0; ///< after it
    std::int16_t pass = 0;   ///< the number of the pass
    std::int16_t effort = 0; ///< later passes with at most this effort need not repeat it
  };
  std::int16_t PassNumber = 0;
  std::vector<Attempt> Tried; ///< per slot
};
}
#endif
