// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeDynamicProgram.h
 * @brief The placement of a polygon of minimum energy, by dynamic programming over its triangles.
 * Internal: not installed.
 */
#ifndef tautline_ShapeDynamicProgram_h
#define tautline_ShapeDynamicProgram_h

#include "ShapeEnergy.h"
#include "ShapeTarget.h"

#include <map>

namespace tautline
{
/// A placement problem: the locations of the vertices, and tables of the costs that depend on one
/// or two of them.
struct PlacementProblem
{
  const PolygonMesh* mesh = nullptr;
  ShapeEnergy energy;
  double delta = 1.0;                   ///< of the sizes of source and target
  std::vector<const LocationSet*> sets; ///< per vertex
  /// Cost of the boundary edge from each vertex to the next, over their sets.
  std::vector<const PairTable*> edges;
  bool symmetricEdges = false; ///< each table is its own transpose
  /// Cost per vertex over the slots of its set; empty if there is none.
  std::vector<std::vector<float>> vertices;
  bool bounds = true;
  /// The energy of a known placement; placements above it may be skipped. Unreachable: none.
  float limit = Unreachable;
  int threads = 0;
  /// Called with the fraction done, 0 to 1; returns whether to continue. May be empty.
  std::function<bool(double)> progress;
};

/**
 * @class tautline::PlacementSolver
 * @brief Solves a placement problem exactly, by dynamic programming over the elimination order of
 * the triangles (Felzenszwalb 2005).
 */
class PlacementSolver
{
public:
  explicit PlacementSolver(const PlacementProblem& problem);

  /// Fills the tables; false if progress() returned false.
  bool run();

  /// Least energies over the slots of the two last vertices.
  const PairTable& values() const { return this->Values; }

  /// The slots of the best placement for the given slots of the last two vertices.
  std::vector<Index> trace(Index p, Index q) const;

  /// The memory of the tables, in bytes.
  static double memory(const PlacementProblem& problem);

private:
  /// One elimination: vertex k, whose parents i and j are placed at p and q.
  struct Step
  {
    EliminationStep elimination;
    PairTable fromI; ///< cost of the part beyond edge i k, over p and r, with the cost of vertex k
    PairTable fromJ; ///< the same beyond edge j k, over q and r
    TriangleTerms terms;
  };
  void solveStep(std::size_t number, const Step& step, PairTable& out);
  void solveRows(std::size_t number, const Step& step, PairTable& out);
  void solveGrid(std::size_t number, const Step& step, PairTable& out);
  PairTable take(Index from, Index to);
  const PairTable& distances(const LocationSet* a, const LocationSet* b);
  bool report(double fraction);

  const PlacementProblem& Problem;
  std::vector<Step> Steps;
  std::map<std::pair<Index, Index>, PairTable> Pending; ///< of edges inside, by (from, to)
  std::map<std::pair<const LocationSet*, const LocationSet*>, PairTable> Distances;
  PairTable Values;
  /// A lower bound of all costs outside the current step.
  double Floor = 0.0;
  float StepLimit = Unreachable;
  bool Stopped = false;
};
}
#endif
