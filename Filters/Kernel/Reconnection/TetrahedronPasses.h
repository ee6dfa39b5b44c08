// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronPasses.h
 * @brief The order in which reconnection works on tetrahedra: the worst first.
 * Internal: not installed.
 */
#ifndef tautline_TetrahedronPasses_h
#define tautline_TetrahedronPasses_h

#include "CavityOperations.h"
#include "ReconnectionProgress.h"

#include <functional>

namespace tautline
{
/// One pass: which tetrahedra are improved, and how.
struct PassOptions
{
  double target = 1;      ///< tetrahedra below this quality are worked on
  bool swap = true;       ///< removal of edges and faces
  bool smooth = true;     ///< motion of vertices
  bool skipsBound = true; ///< tetrahedra that their walls allow no better are left out
  bool contract = false;
  bool insert = false;
  bool facets = false;     ///< facets of the boundary are improved first
  bool compound = false;   ///< also insertions (and contractions) that pay only after smoothing
  Index maxFailures = 0;   ///< ends after so many tetrahedra tried in vain; 0: no limit
  int repairs = 0;         ///< see CavityOperations::repairs
  int smoothingSteps = 2;  ///< of a vertex, each time
  double leastGain = 2e-3; ///< a vertex is moved if its star's smallest quality gains so much
};

/// Works on tetrahedra below a target, worst first, until none of them can be improved.
class TetrahedronPasses
{
public:
  TetrahedronPasses(TetrahedronMesh& mesh, CavityOperations& operations)
    : Mesh(mesh)
    , Operations(operations)
  {
  }

  /// Called now and then with the number of operations so far; returns false to stop.
  std::function<bool()> proceed;

  /// One flag per point. A pass starts with the tetrahedra that have a point with it; empty: with
  /// all.
  std::vector<char> starts;
  /// One flag per point. Tetrahedra that have a point with it are only improved by what keeps the
  /// number of points; empty: none.
  std::vector<char> postponed;

  /// Runs a pass. @return the number of operations that were accepted, or -1 if stopped
  Index run(const PassOptions& options);

  /// Whether the last pass ended for PassOptions::maxFailures.
  bool exhausted() const { return this->Exhausted; }

  /// An upper bound of the quality a tetrahedron can have for the walls it has: their mean ratios
  /// and the angles between them.
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
  /// The last attempt in vain.
  struct Attempt
  {
    std::uint32_t clock = 0; ///< after it
    std::int16_t pass = 0;   ///< the number of the pass
    std::int16_t effort = 0; ///< which later passes need not repeat it
  };
  std::int16_t PassNumber = 0;
  std::vector<Attempt> Tried; ///< per slot
};
}
#endif
