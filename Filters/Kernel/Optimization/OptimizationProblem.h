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
/// Mesh::classifyCorners() for a cell at its current points; NotMeasured for an unsupported type.
Validity cornerValidity(const Mesh& mesh, Index cell);

class TAUTLINE_KERNEL_EXPORT OptimizationProblem
{
public:
  /**
   * @param points the start of the optimization; moved in place
   * @param clock started with the run; the time limit counts from there
   * @param ranks each has a part of the mesh. Methods that are not const are then collective, as is
   * outOfTime(); records refer to the whole mesh. The options have been checked, see
   * checkOptions().
   */
  OptimizationProblem(const Mesh& mesh, const OptimizeOptions& options, std::vector<double>& points,
    const Stopwatch& clock, const Ranks& ranks = {});

  const Ranks& ranks() const { return this->TheRanks; }

  const Mesh& moving() const { return *this->Moving; }
  SimplexMesh& simplices() { return *this->Simplices; }
  const SimplexMesh& simplices() const { return *this->Simplices; }
  /// The facets of the surface on which points are kept, or null.
  const SurfaceProjection* surface() const { return this->Surface.get(); }
  /// The distance of the surface and interfaces at the stored points from the original surface and
  /// the interfaces of the model, see OptimizeOptions.
  double surfaceError() const;
  /// Whether surfaceError() is within the tolerance, if there is one; a geometry may have been
  /// farther away.
  bool isWithinTolerance() const;
  /// Sets the fraction of the surface tolerance that steps may use from now on, 0 to 1.
  void shareTolerance(double share);
  /// Lets points, one flag each, leave the surface; only the surface tolerance constrains them.
  void loosen(std::vector<unsigned char> points) { this->Loose = std::move(points); }
  /// The number of points held by the surface tolerance: their last steps were rejected, at the
  /// surface or, otherwise, at the interfaces.
  Index heldOnSurface() const;
  Index heldOnInterfaces() const;
  std::size_t objectives() const { return this->Resolved.size(); }
  /// The objectives with their templates, and weights of 0 for excluded cells.
  const std::vector<Objective>& resolved() const { return this->Resolved; }
  const Scalarizer& scalarizer() const { return *this->TheScalarizer; }
  Scalarizer& scalarizer() { return *this->TheScalarizer; }
  /// The objective sums, created on first use.
  const ObjectiveSum& sum(std::size_t objective);
  std::vector<LocalTerm> localTerms();
  LocalOptions localOptions() const;

  /// The order of the sweeps.
  const SweepOrder& order();
  /// The free points as rows of a matrix.
  const MatrixRows& rows();
  /// The number of free points of the whole mesh.
  Index freePoints() const;

  /// Writes the simplices' coordinates to the points.
  void store();
  /// Must be called after the coordinates of the simplices have changed other than by sweeps.
  void coordinatesChanged();
  /// Restarts from the given points.
  void restart(const std::vector<double>& points);
  /// Whether there is one objective in closed form for every element of this rank.
  bool isSimple() const
  {
    return this->AllFast && this->Resolved.size() == 1 && this->LeftOut.empty() &&
      this->Resolved[0].metric == Metric::InverseMeanRatio;
  }
  /// Whether an element that an objective excluded because of an inverted corner has valid corners
  /// at the stored points.
  bool someRepaired();
  /// The record of the current points; sets the objectives and counts the inverted elements.
  IterationRecord record(int iteration);
  /// The same before anything has moved, from the data of the constructor.
  IterationRecord firstRecord(int iteration);
  /// Whether the objective is the sum of the squared values of a metric.
  bool isSumOfSquaresOf(const Objective& judged) const;
  /// The values of a metric on all cells at the stored points, and their validity.
  struct Measured
  {
    std::vector<double> values;
    std::vector<signed char> validity;
  };
  Measured measure(const Objective& judged) const;
  /// The worst value of a metric among the valid elements with a free vertex.
  double worstMovable(const Objective& judged, const Measured& measured);
  /// The worst inverse mean ratio, for simplices only: at the current coordinates, stored or not.
  double worstRatioMovable();
  /// One flag per free vertex: nonzero if it has a simplex whose inverse mean ratio exceeds a
  /// bound.
  std::vector<unsigned char> verticesAbove(double ratio) const;
  /// The same: nonzero if it has an element with a relevant share in the p-mean of a metric,
  /// compared with the worst value. @param power p of the mean
  std::vector<unsigned char> verticesNear(
    const Objective& judged, const Measured& measured, double worst, double power) const;
  /// Prepares the scalarization with the initial objectives.
  void start(const IterationRecord& first);
  /// Whether the time limit is reached.
  bool outOfTime() const;
  const OptimizeOptions& options() const { return this->Options; }
  std::vector<double>& points() { return this->Points; }
  /// The constraints that global methods satisfy, see slidesOf(). Computed on first use.
  const PointSlides& slides();
  /// The largest allowed distance of a point from its start, or infinity.
  double limitOf(std::size_t point) const;
  /// The points of the input, 3 numbers each.
  const double* start() const { return this->TheMesh.view().points; }
  /// Whether any point is at its limit.
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
  /// of the model, in their original position; or null
  std::unique_ptr<SurfaceProjection> Interfaces;
  std::unique_ptr<SurfaceLimit> Limit, BetweenLimit; ///< of steps on the surface and the interfaces
  std::vector<SurfaceProjection> Parts;              ///< of the model
  std::vector<unsigned char> Loose;                  ///< per point, or empty
  std::vector<Objective> Resolved;
  /// of each objective; the metric sum is only set after its first use
  std::vector<LocalTerm> Terms;
  bool AllFast = false;
  std::vector<std::unique_ptr<ObjectiveSum>> Sums;
  std::vector<Index> LeftOut;               ///< cells whose corners were not valid at first
  std::vector<std::vector<double>> Weights; ///< of each objective, if not all 1
  std::unique_ptr<Scalarizer> TheScalarizer;
  std::unique_ptr<PointSlides> Slides;
  std::unique_ptr<SweepOrder> Order;
  std::unique_ptr<MatrixRows> Rows;
  IterationRecord AtStart; ///< sums of the simplices at the start; not computed without objectives
  Stopwatch Clock;
};
}
#endif
