// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizationOnRanks.h
 * @brief The state of an optimization of a mesh on several ranks. Internal: not installed.
 */
#ifndef tautline_OptimizationOnRanks_h
#define tautline_OptimizationOnRanks_h

#include "OptimizationProblem.h"
#include "Optimize.h"
#include "SweepControl.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/Objectives/RankRows.h"

#include <limits>
#include <memory>
#include <vector>

namespace tautline
{
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The local part with other points.
inline Mesh movedMesh(
  const DistributedMesh& mesh, bool mirrored, const std::vector<double>& points, int threads)
{
  MeshView view = mesh.view();
  view.points = points.data();
  Mesh moved(view, threads);
  moved.setMirrored(mirrored);
  return moved;
}

/**
 * @class tautline::OptimizationOnRanks
 * @brief The state of a run: the local problem, and sums over the whole mesh.
 */
class OptimizationOnRanks
{
public:
  OptimizationOnRanks(DistributedMesh& mesh, bool mirrored, const OptimizeOptions& options);
  OptimizeResult run();

private:
  void agree();
  void untangle();
  bool stage();
  void makeProblem();
  void move(const IterationRecord& first, bool& repaired);
  StopReason sweep(Slowness* slow, bool& failed, bool& repaired);
  // All vertices at once: GlobalOnRanks.cxx.
  const RankRows& rows();
  StopReason minimizeAll(Optimizer method);
  bool startsWithNewton(const IterationRecord& first);
  void takeHarmonicStart(const std::vector<double>& start);
  void useNewton(Slowness slow, const std::vector<double>& start, bool& failed, bool& repaired);
  IterationRecord record(int iteration);
  void addObjective(
    std::size_t i, const std::vector<signed char>& validity, IterationRecord& record);
  bool report(const IterationRecord& record);
  bool outOfTime() const
  {
    return this->Group.any(this->Clock.reached(this->Options.stopping.maximumSeconds));
  }
  void store();
  void load(const std::vector<double>& points);
  Index restoreWorst();
  void keepInput(const IterationRecord& first);
  double judge(const std::vector<double>& points, std::vector<double>& values,
    std::vector<signed char>& validity) const;

  DistributedMesh& TheMesh;
  RankGroup& Group;
  bool Mirrored;
  int Coordinates = 3; ///< of a point: 2 in a plane
  OptimizeOptions Options;
  Stopwatch Clock;
  std::unique_ptr<Mesh> Start; ///< null on a rank without cells
  std::vector<double> Points;
  std::unique_ptr<OptimizationProblem> Problem; ///< the same
  std::vector<Objective> Resolved;
  std::vector<unsigned char> Free; ///< per local point
  std::vector<int> Sets;
  std::unique_ptr<RankRows> Rows; ///< made on first use
  std::unique_ptr<Scalarizer> TheScalarizer;
  StoppingTest Watch;
  OptimizeResult Result;
  // The worst element of the input.
  Objective Judged;
  bool HoldsWorst = false, ValidInput = false;
  double Worst = 0;
};
}
#endif
