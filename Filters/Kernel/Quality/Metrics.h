// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Metrics.h
 * @brief Element quality metrics: the list of metrics, their meaning, and their evaluation.
 *
 * Example: inverse mean ratio of every cell of a mesh (see Mesh.h for the mesh).
 *
 *     std::vector<double> imr(mesh.view().numberOfCells);
 *     tautline::evaluateMetric(mesh, tautline::Metric::InverseMeanRatio, {}, imr.data());
 *
 * Values are always finite. Cells of extreme size (below 2^-64 or above 2^64) are scaled by powers
 * of two before they are measured, so that unitless metrics are correct for edges between 1e-300
 * and 1e300. A value with a unit, or relative to a target, that double precision cannot hold is 0,
 * and evaluateMetric() counts it. The value is 0 for a degenerate element if the metric is singular
 * there, and for a cell on which the metric is undefined; Mesh::classifyCells() distinguishes them.
 */
#ifndef tautline_Metrics_h
#define tautline_Metrics_h

#include "tautline/Mesh/Mesh.h"

#include <memory>
#include <vector>

namespace tautline
{
/// The metrics. The numbers are stable: they are stored in ParaView state files. Add at the end.
enum class Metric : int
{
  InverseMeanRatio = 0,
  MeanRatio = 1,
  RadiusRatio = 2,
  NormalizedRadiusRatio = 3,
  ConditioningScaleInvariant = 4,
  ConditioningSizeShape = 5,
  InterpolationSizeShape = 6,
  InterpolationScaleInvariant = 7,
  Size = 8,
  UntangleBeta = 9,
  EdgeRatio = 10,
  AspectRatio = 11,
  WidthRatio = 12,
  MinimumAngle = 13,
  MaximumAngle = 14,
  EquiangleSkew = 15,
  ConditionNumber = 16,
  ScaledJacobian = 17,
  ShapeBarrier = 18,
  ShapeNonBarrier = 19,
  ShapeCondition = 20,
  ShapeConditionSquared = 21,
  ShapeSquared = 22,
  ShapeProduct = 23,
  ShapeCubic = 24,
  ShapeSizeAdjugate = 25,
  ShapeSimilarity = 26,
  ShapeSizeBarrier = 27,
  ShapeSizeWeighted = 28,
  ShapeSizeLogarithm = 29,
  SizeNonBarrier = 30,
  SizeBarrier = 31,
  SizeBarrierSquared = 32,
  SizeUntangle = 33,
  ShapeOrientation = 34,
  ShapeOrientationBarrier = 35,
  ShapeSizeOrientation = 36,
  ShapeSizeOrientationBarrier = 37,
  MinimumJacobian = 38,
  NonOrthogonality = 39,
  FaceSkewness = 40,
  InternalSkewness = 41,
  BoundarySkewness = 42,
  OrthogonalQuality = 43,
  FaceWeight = 44,
  VolumeRatio = 45,
  PyramidVolume = 46,
  FaceArea = 47,
  FaceFlatness = 48,
  FaceConcavity = 49,
  FaceTwist = 50,
  CenterTetQuality = 51,
  FanTetQuality = 52,
  CellVolume = 53,
  Openness = 54,
  CellAspectRatio = 55,
  CellDeterminant = 56,
  AreaDeterminant = 57,
  CellConcavity = 58
};

/// The direction of improvement of a metric.
enum class Direction
{
  SmallerIsBetter,
  LargerIsBetter,
  Neutral ///< neither: a size
};

/// The value of an inverted element.
enum class InvertedValue
{
  Negative, ///< below zero, while every valid element is above
  Larger,   ///< finite and worse than for a valid element: the metric can untangle
  Unsigned  ///< in the range of valid elements; only `Validity` differs
};

/// The construction of a metric, which determines its options.
enum class MetricFamily
{
  Target,  ///< a function of T = A W^-1 at each corner; takes targets and a combination
  Simplex, ///< a function of the edges and faces of a triangle or tetrahedron
  Cell,    ///< a function of the whole cell: its angles and lengths, its corners
  /// a finite-volume metric of the faces of a cell and the cells across; see FaceMeasures.h
  Faces
};

class UserMetric;

/// Parameters of the few metrics that need them.
struct Parameters
{
  /**
   * @brief Beta of UntangleBeta: the minimum area or volume that every element should have. The
   * default is 0, which requires that no element be inverted; the dissertation uses a positive
   * value.
   */
  double beta = 0.0;
  /// Epsilon of mu_211 and mu_311, above 0; the rounding of their kink at tau = 0.
  double epsilon = 1e-4;
};

/// A closed interval of values; infinite ends are infinite.
struct Range
{
  double low;
  double high;
};

/// The facts about a metric. Used by the documentation, the ParaView menus and the tests.
struct MetricInfo
{
  Metric metric;
  const char* name;    ///< short, lower case, stable: the name of the cell array, e.g. "imr"
  const char* label;   ///< for menus, e.g. "Inverse mean ratio"
  const char* symbol;  ///< e.g. "IMR", "mu_2 / mu_303"
  const char* aliases; ///< other names, comma-separated: "mu_2,mu_303"
  const char* formula; ///< text; n is the dimension
  const char* source;  ///< paper and section
  MetricFamily family;
  bool in2D, in3D;
  /// Cell types as bits 1 << topologyIndex(type).
  unsigned cellTypes;
  Range full2D, full3D;             ///< of valid elements
  Range acceptable2D, acceptable3D; ///< of elements suitable for most solvers
  double ideal2D, ideal3D;          ///< of the ideal element; NaN if it depends on size
  Direction direction;
  InvertedValue inverted;
  bool barrier;           ///< tends to infinity as the element degenerates from the valid side
  bool differentiable;    ///< everywhere on valid elements; otherwise almost everywhere
  bool scaleInvariant;    ///< with the default target
  bool rotationInvariant; ///< false: depends on the orientation in space; needs Planar or Volume
  const char* unit;       ///< "", "degrees", "length^n", ...
  /// Evaluates a metric that was registered (UserMetric.h); null: a built-in one.
  const UserMetric* user = nullptr;
  /// The range for one dimension.
  const Range& full(int dimension) const { return dimension == 2 ? full2D : full3D; }
  const Range& acceptable(int dimension) const
  {
    return dimension == 2 ? acceptable2D : acceptable3D;
  }
  double ideal(int dimension) const { return dimension == 2 ? ideal2D : ideal3D; }
  /// The power of the length in the unit of the metric: n of "length^n", -1 of "1/length",
  /// otherwise 0.
  TAUTLINE_KERNEL_EXPORT int lengthPower(int dimension) const;
  bool definedOn(CellType type) const { return (cellTypes >> topologyIndex(type)) & 1u; }
};

/**
 * @brief Every metric: the built-in ones in the order of their numbers, then the registered ones in
 * the order of registration. The returned list does not change when another one is registered.
 */
TAUTLINE_KERNEL_EXPORT const std::vector<MetricInfo>& metricRegistry();

/// The metrics that are functions of one element, which this header evaluates: all except
/// MetricFamily::Faces.
TAUTLINE_KERNEL_EXPORT std::vector<MetricInfo> elementMetrics();

/// The number of built-in metrics; their numbers are below it.
TAUTLINE_KERNEL_EXPORT int numberOfBuiltInMetrics();

/// The facts of one metric.
TAUTLINE_KERNEL_EXPORT const MetricInfo& metricInfo(Metric metric);

/**
 * @brief Finds a metric by name, label, symbol or alias, without regard to case.
 * @return its facts, or nullptr.
 */
TAUTLINE_KERNEL_EXPORT const MetricInfo* findMetric(const std::string& name);

/**
 * @brief The facts of a metric as one line of text, tab-separated fields in the order of
 * metricFields(): for scripts and documentation.
 */
TAUTLINE_KERNEL_EXPORT std::string describeMetric(const MetricInfo& info);

/**
 * @brief The metrics registered in this process, one per line: number, label and the other facts,
 * tab-separated, for the menus of a client and for mirrorUserMetrics().
 */
TAUTLINE_KERNEL_EXPORT std::string listUserMetrics();

/**
 * @brief Registers the facts of the metrics of a server, as listed there by listUserMetrics(), in
 * its client, including for criteria. Evaluating them here throws Error. A metric of the same name
 * that is registered here is kept.
 */
TAUTLINE_KERNEL_EXPORT void mirrorUserMetrics(const std::string& list);

/// The reason why a metric cannot be the objective of an optimization, or "".
TAUTLINE_KERNEL_EXPORT std::string objectiveProblem(Metric metric);

/// Whether a metric is evaluated for many elements at once, without analytic derivatives, such as a
/// Python metric (MetricArgument::Elements): global optimizers use differences.
TAUTLINE_KERNEL_EXPORT bool needsDifferences(Metric metric);

/**
 * @brief The error message for the number of a user metric that is not registered in this process,
 * for example from a state file or another process. "" for all others.
 */
TAUTLINE_KERNEL_EXPORT std::string missingMetric(int number);

/// The names of the fields of describeMetric(), tab-separated.
TAUTLINE_KERNEL_EXPORT std::string metricFields();

/// How the corner values of a target metric are combined for a cell with several corners.
enum class Combination : int
{
  Mean = 0,     ///< arithmetic mean
  Worst = 1,    ///< the largest value, or the smallest if larger is better
  PowerMean = 2 ///< (mean of |q|^p)^(1/p); p is negated if larger is better
};

/**
 * @brief W^-1 at every sample of every cell; made by the functions of Targets.h.
 * The nine entries of sample s of cell i (row by row, 2D in the leading 2 x 2) start at
 * 9 * (offsets[i] + s).
 */
struct Targets
{
  std::vector<Index> offsets;
  std::vector<double> inverse;
  /**
   * @brief M^(1/2) of each cell, 9 entries as above, or empty: then T = M^(1/2) A W^-1, the element
   * in the metric tensor M.
   */
  std::vector<double> metricRoots;
  /// Set by the functions of Targets.h if entries are outside 2^-64 to 2^64: they are then scaled.
  bool extreme = false;
};

/// How to evaluate a metric.
struct EvaluationOptions
{
  Parameters parameters;
  /**
   * @brief For cells with several corners. If some corners are inverted, only these are combined
   * (not for metrics that order inverted elements, InvertedValue::Larger).
   */
  Combination combination = Combination::Mean;
  double power = 2.0;               ///< p of PowerMean, at least 1
  const Targets* targets = nullptr; ///< null: the ideal cell of each type
  int threads = 0;                  ///< 0: all cores. The result does not depend on it.
};

/**
 * @brief Writes one value per cell of the mesh. Cells of unsupported types, or on which the metric
 * is undefined, get 0. Throws Error for a metric of MetricFamily::Faces, here and below.
 * @return the number of valid or inverted cells with a value beyond the range of double precision
 * (a volume of 1e-450, a size of 1e-150 relative to a target of 1 cubed); they get 0
 */
TAUTLINE_KERNEL_EXPORT Index evaluateMetric(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values);

/// Throws Error, with the metric and a remedy, if evaluateMetric() returned more than 0.
TAUTLINE_KERNEL_EXPORT void requireInRange(const MetricInfo& info, Index beyond);

/**
 * @brief Values as above and the gradient of each with respect to the vertices of its cell.
 * @param gradients entry (offsets[i] + k) * 3 + c is the derivative of the value of cell i with
 * respect to coordinate c of its k-th node; 3 x the size of the connectivity. Nodes beyond the
 * corners get 0.
 * @return as evaluateMetric()
 */
TAUTLINE_KERNEL_EXPORT Index evaluateMetricGradient(const Mesh& mesh, Metric metric,
  const EvaluationOptions& options, double* values, double* gradients);

class ElementSum;

/**
 * @brief Sums a power of a metric over the mesh, with its gradient: the workhorse of optimization.
 *
 * The sum runs over |q|^p with the sign of q, so that inverted elements of a signed metric reduce
 * it; classify the elements first if this matters. Elements are added in an order fixed by the
 * mesh, so that the sum and the gradient are bitwise the same for any number of threads.
 */
class TAUTLINE_KERNEL_EXPORT MetricSum
{
public:
  /// Prepares the chunks and their colors: chunks of one color share no vertex.
  MetricSum(const Mesh& mesh, Metric metric, const EvaluationOptions& options, double power);

  /// The sum over all cells on which the metric is defined.
  double value() const;
  /// The sum, and its gradient in 3 x numberOfPoints entries, which are overwritten.
  double valueAndGradient(double* gradient) const;

private:
  template <bool WithGradient>
  double run(double* gradient) const;

  std::shared_ptr<const ElementSum> Elements;
  double Power;
};
}
#endif
