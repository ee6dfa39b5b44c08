// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizationOnRanks.h
 * @brief The state of an optimization of a mesh on several ranks. Internal: not installed.
 */
#ifndef tautline_OptimizationOnRanks_h
#define tautline_OptimizationOnRanks_h

#include "AutomaticMethod.h"
#include "OptimizationProblem.h"
#include "Optimize.h"
#include "RankGuard.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/Objectives/MatrixRows.h"

#include <limits>
#include <memory>
#include <vector>

namespace tautline
{
constexpr double infinity = std::numeric_limits<double>::infinity();

/**
 * @class tautline::OptimizationOnRanks
 * @brief The state of a run: the local problem, and sums over the whole mesh.
 */
class OptimizationOnRanks : private OptimizationSteps
{
public:
  OptimizationOnRanks(DistributedMesh& mesh, bool mirrored, const OptimizeOptions& options);
  OptimizeResult run();

private:
  StopReason minimizeTogether(Optimizer method);
  void agree();
  bool untangle();
  bool stage();
  void makeProblem();
  void rescaleUntangling();
  StopReason sweep(Slowness* slow, bool& failed, bool& repaired) override;
  // All vertices at once: GlobalOnRanks.cxx.
  const MatrixRows& rows();
  StopReason minimizeAll(Optimizer method) override;
  bool hasManyCorners() const override;
  bool hasConvexPart() override;
  bool hasConstraintsOrTargets() const override;
  bool slidesOnSurface() const override { return false; } // such meshes are gathered
  bool holdsPoints() override
  {
    return this->Group.any(this->Problem && this->Problem->someAtLimit());
  }
  bool findHarmonicPoints(std::vector<double>& points) override;
  void shiftPoints(double part, std::vector<double>& points) override;
  IterationRecord record(int iteration) override;
  bool report(const IterationRecord& record);
  bool outOfTime() const override
  {
    return this->Group.any(this->Clock.reached(this->Options.stopping.maximumSeconds));
  }
  void checkWeights(const std::vector<unsigned char>& closed);
  const std::vector<double>& stored() const override { return this->Points; }
  void store() override;
  void restart(const std::vector<double>& points) override;
  // The guards: RankGuards.cxx.
  class StepsOfWorst;
  void settleWorst();
  Index restoreWorst();
  void keepInput(const IterationRecord& first);

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
  std::unique_ptr<MatrixRows> Rows; ///< made on first use
  std::unique_ptr<Scalarizer> TheScalarizer;
  StoppingTest Watch;
  OptimizeResult Result;
  std::unique_ptr<RankGuard> Guard; ///< of the worst element of the input
};
}
#endif
