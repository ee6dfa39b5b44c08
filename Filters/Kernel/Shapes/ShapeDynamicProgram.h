/**
 * @file ShapeDynamicProgram.h
 * @brief Dynamic programming over the triangles of a polygon. Internal to the kernel: not
 * installed.
 */
#ifndef tautline_ShapeDynamicProgram_h
#define tautline_ShapeDynamicProgram_h

#include "ShapeEnergy.h"
#include "ShapeTarget.h"

#include <map>

namespace tautline
{
/// A placement problem: the vertices' locations, and tables for what depends on one or two of them.
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
  /// An energy that some placement has; placements above it may be left out. Unreachable: none.
  float limit = Unreachable;
  int threads = 0;
  /// Called with the part done; returns whether to go on. May be empty.
  std::function<bool(double)> progress;
};

/// The tables of a solved problem.
class PlacementSolver
{
public:
  explicit PlacementSolver(const PlacementProblem& problem);

  /// Fills the tables; false if progress() said to stop.
  bool run();

  /// Energies over the slots of the two vertices that are left.
  const PairTable& values() const { return this->Values; }

  /// The slots of the best placement with the last two vertices at these slots.
  std::vector<Index> trace(Index p, Index q) const;

  /// Memory the tables take, in bytes.
  static double memory(const PlacementProblem& problem);

private:
  /// One elimination: vertex k, whose parents i and j go to p and q.
  struct Step
  {
    EliminationStep elimination;
    PairTable fromI; ///< cost of the part beyond edge i k, over p and r, with the cost of vertex k
    PairTable fromJ; ///< beyond edge j k, over q and r
    TriangleTerms terms;
  };
  void solveStep(std::size_t number, const Step& step, PairTable& out);
  void solveRows(std::size_t number, const Step& step, PairTable& out);
  void solveGrid(std::size_t number, const Step& step, PairTable& out);
  PairTable take(Index from, Index to);
  const PairTable& distances(const LocationSet* a, const LocationSet* b);
  bool going(double part);

  const PlacementProblem& Problem;
  std::vector<Step> Steps;
  std::map<std::pair<Index, Index>, PairTable> Pending; ///< of edges inside, by (from, to)
  std::map<std::pair<const LocationSet*, const LocationSet*>, PairTable> Distances;
  PairTable Values;
  /// A bound from below of all that is not part of the step at hand: what can still be saved on it.
  double Floor = 0.0;
  float StepLimit = Unreachable;
  bool Stopped = false;
};
}
#endif
