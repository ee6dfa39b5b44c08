// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizationProblem.h
 * @brief The state of an optimization: the moving points, the objectives on them, and their records
 * in the history.
 * Internal: not installed.
 */
#ifndef tautline_OptimizationProblem_h
#define tautline_OptimizationProblem_h

#include "FlatParts.h"
#include "LocalSweep.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Objectives/MatrixRows.h"

#include <memory>

namespace tautline
{
/// Mesh::classifyCorners() of a cell where it is now; NotMeasured for an unsupported type.
Validity cornerValidity(const Mesh& mesh, Index cell);

class TAUTLINE_KERNEL_EXPORT OptimizationProblem
{
public:
  /**
   * @param points where the optimization starts; moved in place
   * @param clock started with the run; the time limit counts from there
   * @param ranks of which each has a part of the mesh. Methods that are not const are then
   * collective, and so is outOfTime(); records are of the whole mesh.
   * The options have been checked, see checkOptions().
   */
  OptimizationProblem(const Mesh& mesh, const OptimizeOptions& options, std::vector<double>& points,
    const Stopwatch& clock, const Ranks& ranks = {});

  const Ranks& ranks() const { return this->TheRanks; }

  const Mesh& moving() const { return *this->Moving; }
  SimplexMesh& simplices() { return *this->Simplices; }
  const SimplexMesh& simplices() const { return *this->Simplices; }
  /// The facets of the surface that points are kept on, or null.
  const SurfaceProjection* surface() const { return this->Surface.get(); }
  /// The distance between it, or the interfaces of the model, and the surface, or the interfaces,
  /// at the stored points, see OptimizeOptions.
  double surfaceError() const;
  /// Whether that is within the tolerance, if there is one; a geometry may have been farther.
  bool isWithinTolerance() const;
  /// How much of the surface tolerance steps may use from now on, 0 to 1.
  void shareTolerance(double share);
  /// Lets points, one flag each, leave what they slide on; only the surface tolerance holds them.
  void loosen(std::vector<unsigned char> points) { this->Loose = std::move(points); }
  /// Points that the surface tolerance holds: their last steps were refused, at the surface or, if
  /// not there, at the interfaces.
  Index heldOnSurface() const;
  Index heldOnInterfaces() const;
  std::size_t objectives() const { return this->Resolved.size(); }
  /// The objectives with their templates, and weights of 0 for the cells that are left out.
  const std::vector<Objective>& resolved() const { return this->Resolved; }
  const Scalarizer& scalarizer() const { return *this->TheScalarizer; }
  Scalarizer& scalarizer() { return *this->TheScalarizer; }
  /// The objective sums, made on first use.
  const ObjectiveSum& sum(std::size_t objective);
  std::vector<LocalTerm> localTerms();
  LocalOptions localOptions() const;

  /// The order of the sweeps.
  const SweepOrder& order();
  /// The free points as rows of a matrix.
  const MatrixRows& rows();
  /// Free points of the whole mesh.
  Index freePoints() const;

  /// Writes the simplices' coordinates to the points.
  void store();
  /// To be called where the coordinates of the simplices have changed other than by sweeps.
  void coordinatesChanged();
  /// Goes back to other points.
  void restart(const std::vector<double>& points);
  /// One objective in closed form, of every element of this rank.
  bool isSimple() const
  {
    return this->AllFast && this->Resolved.size() == 1 && this->LeftOut.empty() &&
      this->Resolved[0].metric == Metric::InverseMeanRatio;
  }
  /// Whether an element that an objective leaves out because a corner was inverted has valid
  /// corners at the stored points.
  bool someRepaired();
  /// The record of the points as they are; sets the objectives and counts the inverted elements.
  IterationRecord record(int iteration);
  /// The same before anything has moved, from what the constructor has found.
  IterationRecord firstRecord(int iteration);
  /// Whether the objective is the sum of the squares of the values that a metric has.
  bool isSumOfSquaresOf(const Objective& judged) const;
  /// The values of a metric on all cells at the stored points, and which of them are valid.
  struct Measured
  {
    std::vector<double> values;
    std::vector<signed char> validity;
  };
  Measured measure(const Objective& judged) const;
  /// The worst value of a metric among the valid elements with a free vertex.
  double worstMovable(const Objective& judged, const Measured& measured);
  /// That of the inverse mean ratio, of simplices alone: where the coordinates are, stored or not.
  double worstRatioMovable();
  /// One flag per free vertex: it has a simplex whose inverse mean ratio exceeds a bound.
  std::vector<unsigned char> verticesAbove(double ratio) const;
  /// The same: it has an element with a share in the p-mean of a metric, beside that of the worst
  /// value. @param power p of the mean
  std::vector<unsigned char> verticesNear(
    const Objective& judged, const Measured& measured, double worst, double power) const;
  /// Prepares the scalarization with the objectives of the start.
  void start(const IterationRecord& first);
  /// Whether the time limit is reached.
  bool outOfTime() const;
  const OptimizeOptions& options() const { return this->Options; }
  std::vector<double>& points() { return this->Points; }
  /// What methods that move all points at once keep, see slidesOf(). Found on first use.
  const PointSlides& slides();
  /// How far a point may go from its start, infinite for any distance.
  double limitOf(std::size_t point) const;
  /// The points of the input, 3 numbers each.
  const double* start() const { return this->TheMesh.view().points; }
  /// Whether a point is as far from its start as a limit lets it.
  bool someAtLimit();

private:
  void agreeOnForms();
  std::vector<double> largestValues() const;
  void rescaleUntangling(const std::vector<double>& largest);
  void makeSurface();
  void makeInterfaces();
  double distanceOf(const SurfaceProjection& now, const SurfaceProjection& before) const;
  double errorOfBoundary() const;
  double errorOfInterfaces() const;
  LocalTerm fastTerm(const Objective& objective) const;
  void leaveOut(std::vector<signed char> validity);
  bool hasSimplexTotals() const;
  void summarizeSimplices(IterationRecord& record) const;
  void summarizeCells(IterationRecord& record);

  const Mesh& TheMesh;
  Ranks TheRanks;
  OptimizeOptions Options;
  std::vector<double>& Points;
  std::unique_ptr<Mesh> Moving;
  std::unique_ptr<SimplexMesh> Simplices;
  std::unique_ptr<SurfaceProjection> Surface;
  std::unique_ptr<SurfaceProjection> Interfaces;     ///< of the model, as they were; or null
  std::unique_ptr<SurfaceLimit> Limit, BetweenLimit; ///< of steps on these two
  std::vector<SurfaceProjection> Parts;              ///< of the model
  std::vector<unsigned char> Loose;                  ///< per point, or empty
  std::vector<Objective> Resolved;
  std::vector<LocalTerm> Terms; ///< of each objective; with the metric's sum only once it was used
  bool AllFast = false;
  std::vector<std::unique_ptr<ObjectiveSum>> Sums;
  std::vector<Index> LeftOut;               ///< cells whose corners were not valid at first
  std::vector<std::vector<double>> Weights; ///< of each objective, if not all 1
  std::unique_ptr<Scalarizer> TheScalarizer;
  std::unique_ptr<PointSlides> Slides;
  std::unique_ptr<SweepOrder> Order;
  std::unique_ptr<MatrixRows> Rows;
  IterationRecord AtStart; ///< sums of the simplices there; without objectives: not found
  Stopwatch Clock;
};
}
#endif
