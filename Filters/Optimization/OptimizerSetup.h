// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizerSetup.h
 * @brief Translates the properties of Optimize Mesh into options of the kernel for one data set,
 * and keeps the data of a run.
 */
#ifndef tautline_OptimizerSetup_h
#define tautline_OptimizerSetup_h

#include "BeforeAfter.h"
#include "Blocks.h"
#include "BoundarySetup.h"
#include "MovableMesh.h"
#include "TargetChoice.h"
#include "tautline/Optimization/Optimize.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;

namespace tautline
{
/// The name in the menu.
constexpr const char* OptimizerName = "Optimize Mesh";
constexpr const char* BoundaryRemedy = "choose another Boundary";
/// Input ports besides the mesh.
namespace OptimizerPorts
{
constexpr int Reference = 1, Selection = 2, Geometry = 3;
}

/// An objective of CUSTOM.
struct ObjectiveRow
{
  int metric = static_cast<int>(Metric::InverseMeanRatio);
  int objectiveTemplate = static_cast<int>(ObjectiveTemplate::Default);
  double weight = 1.0; ///< above 0
  TargetType target = TargetType::Ideal;
};

/// The properties of the filter that do not depend on a data set.
struct OptimizerSettings
{
  Preset preset = Preset::Custom;
  std::vector<ObjectiveRow> objectives; ///< of CUSTOM
  double power = 8.0;                   ///< of the templates p-mean and maximum
  double beta = 0.0;                    ///< of the untangling metric
  Combination combination = Combination::Mean;
  BoundaryProperties boundary;      ///< and the filter whose input arrays are chosen
  double maximumDisplacement = 0.0; ///< 0: any distance
  bool mergePoints = true;          ///< whether coincident points on seams are one
  /// All options that need no data set; for CUSTOM also the options that a preset replaces.
  OptimizeOptions options;
  /// The point or cell array for a target, by index; the default is the active scalars.
  std::function<ChosenArray(int, vtkDataSet*)> targetArray;
};

/// Indices of SetInputArrayToProcess().
enum OptimizerArrays
{
  SizeArray = 0,
  TensorArray = 1,
  FixedArray = 2,
  LimitArray = 3,
  WeightArray = 4,
  KindArray = 5,
  RegionArray = 6
};

struct OptimizerRun;
struct RoundedResult;

/**
 * @class tautline::OptimizerSetup
 * @brief The options of the kernel for one data set, with the data that they point to. Throws Error
 * for arrays that are missing or do not fit.
 */
class OptimizerSetup
{
public:
  /// @param mesh of the block, framed; must outlive the setup. Collective if it is in pieces.
  OptimizerSetup(const OptimizerSettings& settings, const InputBlock& block, MovableMesh& mesh);
  OptimizerSetup(const OptimizerSetup&) = delete;
  OptimizerSetup& operator=(const OptimizerSetup&) = delete;

  /// The features, and the initial mesh of the optimization.
  const BoundarySetup& boundary() const { return this->Boundary; }
  OptimizeOptions& options() { return this->Options; }
  /// Optimizes from start().
  OptimizeResult run();
  /// The metrics to measure on the cells of the input.
  std::vector<MeasuredMetric> metrics() const;
  /**
   * @brief Rounds the points of a result to the output precision (single precision if the input has
   * it), and measures the rounded result. If this would violate the guarantees of optimize(), the
   * points are given in double precision; if that is not sufficient this far from the origin, the
   * points of the input are returned.
   */
  void round(OptimizerRun& run) const;

private:
  void setLimits(const OptimizerSettings& settings, const InputBlock& block);
  void setObjectives(const OptimizerSettings& settings, const InputBlock& block);
  void setUnit(Objective& objective) const;
  void keepTotalSize();
  void setWeights(const OptimizerSettings& settings, const InputBlock& block);
  RoundedResult measureAt(const std::vector<double>& points,
    const std::vector<signed char>& validity, OptimizeResult& result) const;
  const Targets* target(
    const OptimizerSettings& settings, const InputBlock& block, TargetType type);

  MovableMesh& TheMesh;
  BoundarySetup Boundary;
  std::array<Targets, 4> MadeTargets;    ///< by type, for the optimized cells
  std::array<Targets, 4> TargetsOfPiece; ///< the same for the cells of the input, if in pieces
  std::array<bool, 4> HasTargets = {};
  std::vector<double> Weights, Limits;
  OptimizeOptions Options;
};

/**
 * @brief The reason why settings need the whole mesh on one process, if they do; `what` is a
 * plural.
 * @param features whether feature kinds or regions are chosen, on any process
 * @param animation whether iterations are kept
 */
NeedOfWholeMesh needOfWholeMesh(const OptimizerSettings& settings, bool features, bool animation);

/// The objectives of CUSTOM, without targets; at least one.
std::vector<Objective> customObjectives(const OptimizerSettings& settings);
/// For the preset UniformSize with a free boundary: compares sizes with the mean size of the valid
/// elements, because the sum of their squares would shrink the mesh to a point. Throws Error if no
/// element is valid.
void compareSizesWith(
  const Mesh& mesh, double total, Index valid, Targets& mean, OptimizeOptions& options);

/// The result for one data set.
struct OptimizerRun
{
  struct Frame
  {
    int iteration;
    std::vector<double> points;
  };
  OptimizeResult result;
  std::vector<Frame> frames; ///< for the animation, every stride-th iteration
  int stride = 1;
  int iterations = 0;
  bool single = false; ///< whether the points of the result are written in single precision
  std::string note;    ///< a sentence if they are not although the input is, or ""
  std::string warning; ///< a sentence if the input's points are kept instead, or ""
  std::string moved;   ///< a sentence if the surface has moved unexpectedly, or ""
  std::string summary;

  /// Keeps the points of an iteration; drops every second frame when the memory is used up.
  void keep(const IterationState& state, std::size_t coordinates, double megabytes);

  /// The points at a time; before the first kept iteration, the input's points.
  std::vector<double> at(double time, const MeshView& input) const;
};
}
#endif
