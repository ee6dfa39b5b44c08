// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Metrics.h
 * @brief Element quality metrics: what there is, what each means, and how to evaluate it.
 *
 * Example: inverse mean ratio of every cell of a mesh (see Mesh.h for the mesh).
 *
 *     std::vector<double> imr(mesh.view().numberOfCells);
 *     tautline::evaluateMetric(mesh, tautline::Metric::InverseMeanRatio, {}, imr.data());
 *
 * Values are always finite. Cells of extreme size (below 2^-64 or above 2^64) are scaled by powers
 * of two before they are measured, so that metrics without a unit are right for edges between
 * 1e-300 and 1e300. A value with a unit, or relative to a target, that double precision cannot hold
 * is 0, and evaluateMetric() counts it. A degenerate element has the value 0 of every metric that
 * is singular there, and so has a cell the metric is not defined on; Mesh::classifyCells()
 * distinguishes them.
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

/// Which way a metric points.
enum class Direction
{
  SmallerIsBetter,
  LargerIsBetter,
  Neutral ///< neither: a size
};

/// What the value of an inverted element is.
enum class InvertedValue
{
  Negative, ///< below zero, where every valid element is above
  Larger,   ///< finite and worse than that of a valid element: the metric can untangle
  Unsigned  ///< in the range of valid elements; only `Validity` differs
};

/// How a metric is built, which determines its options.
enum class MetricFamily
{
  Target,  ///< a function of T = A W^-1 at each corner; takes targets and a combination
  Simplex, ///< a function of the edges and faces of a triangle or tetrahedron
  Cell,    ///< a function of the whole cell: its angles and lengths, its corners
  Faces    ///< of finite volumes: of the faces of a cell and the cells across; see FaceMeasures.h
};

class UserMetric;

/// Parameters of the few metrics that have any.
struct Parameters
{
  /**
   * @brief Beta of UntangleBeta: the area or volume every element should at least have. The default
   * is 0, which requires that no element be inverted; the dissertation uses a positive value.
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

/// What is known of a metric. Feeds the documentation, ParaView's menus and the tests.
struct MetricInfo
{
  Metric metric;
  const char* name;    ///< short, lower case, stable: the name of the cell array, e.g. "imr"
  const char* label;   ///< for menus, e.g. "Inverse mean ratio"
  const char* symbol;  ///< e.g. "IMR", "mu_2 / mu_303"
  const char* aliases; ///< other names it is found by, comma separated: "mu_2,mu_303"
  const char* formula; ///< text; n is the dimension
  const char* source;  ///< paper and section
  MetricFamily family;
  bool in2D, in3D;
  /// Cell types as bits 1 << topologyIndex(type).
  unsigned cellTypes;
  Range full2D, full3D;             ///< of valid elements
  Range acceptable2D, acceptable3D; ///< of elements suitable for most solvers
  double ideal2D, ideal3D;          ///< of the ideal element; NaN where it depends on size
  Direction direction;
  InvertedValue inverted;
  bool barrier;           ///< tends to infinity as the element degenerates from the valid side
  bool differentiable;    ///< everywhere on valid elements; else almost everywhere
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
  /// The power of the length in the unit of the metric: n of "length^n", -1 of "1/length", else 0.
  TAUTLINE_KERNEL_EXPORT int lengthPower(int dimension) const;
  bool definedOn(CellType type) const { return (cellTypes >> topologyIndex(type)) & 1u; }
};

/**
 * @brief Every metric: the built-in ones in the order of their numbers, then the registered ones in
 * the order of registration. What is returned stays as it is when another one is registered.
 */
TAUTLINE_KERNEL_EXPORT const std::vector<MetricInfo>& metricRegistry();

/// Those that are functions of one element, which are what this header evaluates: all but
/// MetricFamily::Faces.
TAUTLINE_KERNEL_EXPORT std::vector<MetricInfo> elementMetrics();

/// How many metrics are built in; their numbers are those below it.
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
 * @brief The metrics that are registered in this process, a line each: number, label and the other
 * facts, tab-separated, for the menus of a client and for mirrorUserMetrics().
 */
TAUTLINE_KERNEL_EXPORT std::string listUserMetrics();

/**
 * @brief Makes the metrics of a server, as listUserMetrics() has them there, known in its client:
 * their facts, also for criteria. They are not evaluated here: that throws Error. A metric of the
 * same name that is registered here stays.
 */
TAUTLINE_KERNEL_EXPORT void mirrorUserMetrics(const std::string& list);

/// Why a metric cannot be the objective of an optimization, or "".
TAUTLINE_KERNEL_EXPORT std::string objectiveProblem(Metric metric);

/// Whether a metric is evaluated for many elements at once, without derivatives of its own, such as
/// a metric of Python (MetricArgument::Elements): global optimizers take differences.
TAUTLINE_KERNEL_EXPORT bool needsDifferences(Metric metric);

/**
 * @brief What is wrong with the number of a user's metric that is not registered in this process: a
 * state file or another process may have it. "" for all others.
 */
TAUTLINE_KERNEL_EXPORT std::string missingMetric(int number);

/// The names of the fields of describeMetric(), tab-separated.
TAUTLINE_KERNEL_EXPORT std::string metricFields();

/// How a target metric's corner values become one value of a cell with several corners.
enum class Combination : int
{
  Mean = 0,     ///< arithmetic mean
  Worst = 1,    ///< the largest value, or the smallest where larger is better
  PowerMean = 2 ///< (mean of |q|^p)^(1/p); p is negated where larger is better
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
  /// Set by the functions of Targets.h where entries are beyond 2^-64 to 2^64: they are scaled.
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
 * is not defined, get 0. Throws Error for a metric of MetricFamily::Faces, here and below.
 * @return how many valid or inverted cells have a value beyond the range of double precision (a
 * volume of 1e-450, a size of 1e-150 against a target of 1 cubed); they get 0
 */
TAUTLINE_KERNEL_EXPORT Index evaluateMetric(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values);

/// Throws Error that names the metric and the remedy if evaluateMetric() returned more than 0.
TAUTLINE_KERNEL_EXPORT void requireInRange(const MetricInfo& info, Index beyond);

/**
 * @brief Values as above and the gradient of each with respect to the vertices of its cell.
 * @param gradients entry (offsets[i] + k) * 3 + c is the derivative of the value of cell i by
 * coordinate c of its k-th node; 3 x the size of the connectivity. Nodes beyond the corners get 0.
 * @return as evaluateMetric()
 */
TAUTLINE_KERNEL_EXPORT Index evaluateMetricGradient(const Mesh& mesh, Metric metric,
  const EvaluationOptions& options, double* values, double* gradients);

class ElementSum;

/**
 * @brief Sums a power of a metric over the mesh, with its gradient: the workhorse of optimization.
 *
 * The sum runs over |q|^p with the sign of q, so that inverted elements of a signed metric reduce
 * it; classify the elements first where this matters. Elements are added in an order fixed by the
 * mesh, and so the sum and the gradient are bitwise the same for any number of threads.
 */
class TAUTLINE_KERNEL_EXPORT MetricSum
{
public:
  /// Prepares the chunks and their colours: chunks of one colour share no vertex.
  MetricSum(const Mesh& mesh, Metric metric, const EvaluationOptions& options, double power);

  /// The sum over all cells the metric is defined on.
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
