// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UserMetric.h
 * @brief User metrics: written as a formula and registered by name.
 *
 * A registered metric is available wherever built-in ones are: evaluateMetric(), objectives of
 * every template, criteria, the filters, ParaView's menus, the shell and Python. There are three
 * kinds:
 *
 *  - a function of T = A W^-1, the Jacobian of a corner relative to the target (JacobianMetric). It
 *    supports targets and a combination of the corners, like the built-in target metrics;
 *  - a function of the corners of the element (CornerMetric);
 *  - a function of the corners of many elements at once, without derivatives (ElementsMetric): for
 *    measuring, coloring, and optimization with finite differences for all points at once, which is
 *    slow. Python metrics are of this kind.
 *
 * Example: the inverse mean ratio, for T. The derivatives come from automatic differentiation.
 *
 *     struct Ratio
 *     {
 *       template <class Number, int N>
 *       Number value(const tautline::CornerJacobian<Number, N>& T) const
 *       {
 *         return T.norm2() / (N * pow(T.det(), 2.0 / N));
 *       }
 *     };
 *
 *     tautline::MetricDescription facts;
 *     facts.name = "my_ratio";
 *     facts.label = "My ratio";
 *     facts.barrier = true;
 *     const tautline::Metric ratio = tautline::registerJacobianMetric(facts, Ratio());
 *
 * A struct that also has `template <class Number, int N> void slope(const CornerJacobian<Number,
 * N>& T, Number (&dT)[N][N]) const` provides its own derivatives; registration compares them with
 * finite differences. Testing/Install/metric_consumer is a complete example.
 *
 * A formula that only reads T through norm2() and det() is the fastest to optimize on triangles and
 * tetrahedra: it is evaluated for these two numbers, which are known functions of each vertex. The
 * formula is instantiated with several types of Number, so helper functions must also be templates.
 */
#ifndef tautline_UserMetric_h
#define tautline_UserMetric_h

#include "MetricArguments.h"
#include "Metrics.h"

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace tautline
{
/// The facts about a metric that registration needs; the counterpart of MetricInfo.
struct MetricDescription
{
  /// The name of the cell array: lower-case letters, digits and underscores, starting with a
  /// letter.
  std::string name;
  std::string label;   ///< for menus; the default is the name
  std::string symbol;  ///< the default is the name
  std::string aliases; ///< other names, comma-separated
  std::string formula;
  std::string source;
  std::string unit;              ///< "", "degrees", "length^n", "1/length", ...
  bool in2D = true, in3D = true; ///< triangles and quadrilaterals; other types
  unsigned cellTypes = allTypes; ///< within these dimensions: bits 1 << topologyIndex(type)
  Range full = { 0, infinity };  ///< values of valid elements
  Range acceptable = { 0, infinity };
  double ideal = std::numeric_limits<double>::quiet_NaN(); ///< NaN: depends on the size
  Direction direction = Direction::SmallerIsBetter;
  /**
   * @brief The value of an inverted element. For functions of T, unless it is Larger: a degenerate
   * corner has the value 0, and in an element with inverted corners, only these are combined.
   */
  InvertedValue inverted = InvertedValue::Unsigned;
  /// Tends to infinity as an element degenerates: objectives are infinite unless all are valid.
  bool barrier = false;
  bool differentiable = true;    ///< everywhere on valid elements; otherwise almost everywhere
  bool scaleInvariant = false;   ///< with the default target; checked
  bool rotationInvariant = true; ///< checked

  static constexpr unsigned allTypes = (1u << NumberOfCellTypes) - 1;
  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// The argument of a user metric.
enum class MetricArgument
{
  Jacobian, ///< T at a corner, row by row: n^2 numbers
  Corners,  ///< x y z of the corners: 3 numbers each
  Elements  ///< like Corners, without derivatives
};

/// Evaluates a user metric. The templates below implement it; it must be thread-safe.
class TAUTLINE_KERNEL_EXPORT UserMetric
{
public:
  explicit UserMetric(MetricArgument argument)
    : Argument(argument)
  {
  }
  virtual ~UserMetric();
  MetricArgument argument() const { return this->Argument; }
  bool hasDerivatives() const { return this->Argument != MetricArgument::Elements; }

  /**
   * @brief Evaluates several elements (or corners) of one type.
   * @param count their number
   * @param stride argument k of element i is at arguments[k * stride + i]; at least count
   * @param values stride numbers
   * @param slopes derivatives with respect to the arguments, with the same layout; null: not
   *   computed
   */
  virtual void evaluate(CellType type, int count, int stride, const double* arguments,
    double* values, double* slopes) const = 0;

  /**
   * @brief Evaluates any number of elements of one type, from the calling thread.
   * @param points x y z of the corners of each element, one element after another
   */
  virtual void evaluateElements(
    CellType type, Index count, const double* points, double* values) const;

  /**
   * @brief Evaluates several elements with the derivatives with respect to the displacement d of
   * one vertex of each.
   * @param along for Jacobian: n numbers w, T becomes T + d w^t. For Corners: one number per
   * corner, which moves by this times d. With the layout of the arguments
   * @param slopes derivatives with respect to d: n numbers for Jacobian, 3 for Corners
   *
   * Unless overridden, all derivatives are evaluated.
   */
  virtual void evaluateAlong(CellType type, int count, int stride, const double* arguments,
    const double* along, double* values, double* slopes) const;

  /**
   * @brief Evaluates a metric that only depends on |T|^2 and det T.
   * @param arguments |T|^2, then det T; with the layout of evaluate()
   * @param derivatives with respect to |T|^2 and det T, then second derivatives: |T|^2 twice, one
   * each, det T twice; with the layout of the arguments. Null: not computed
   * @return false, without values, if the metric is not such a function, or this is not overridden
   */
  virtual bool evaluateInvariants(CellType type, int count, int stride, const double* arguments,
    double* values, double* derivatives) const;

private:
  MetricArgument Argument;
};

namespace user_metric
{
/// Loads the arguments of elements [first, first + PacketWidth); the last one fills the packet.
template <int Count>
inline __attribute__((always_inline)) void load(
  const double* arguments, int first, int count, int stride, Packet* to)
{
  for (int k = 0; k < Count; ++k)
  {
    const double* from = arguments + k * stride;
    if (first + PacketWidth <= stride)
    {
      std::memcpy(to + k, from + first, sizeof(Packet));
      continue;
    }
    Packet lanes = {};
    for (int l = 0; l < PacketWidth; ++l)
    {
      lanes[l] = from[first + l < count ? first + l : count - 1];
    }
    to[k] = lanes;
  }
}

/// Stores as much of a packet as fits.
inline void store(Packet x, int first, int stride, double* to)
{
  const int room = stride - first;
  if (room >= PacketWidth)
  {
    std::memcpy(to + first, &x, sizeof(Packet)); // of fixed length: no call
    return;
  }
  std::memcpy(to + first, &x, room * sizeof(double));
}

/// Whether a function provides its derivatives.
template <class Function, class Argument, class Slopes, class = void>
struct HasSlope : std::false_type
{
};
template <class Function, class Argument, class Slopes>
struct HasSlope<Function, Argument, Slopes,
  std::void_t<decltype(std::declval<const Function&>().slope(
    std::declval<const Argument&>(), std::declval<Slopes&>()))>> : std::true_type
{
};
}

/// A metric that is a function of T.
template <class Function>
class JacobianMetric : public UserMetric
{
public:
  explicit JacobianMetric(Function function)
    : UserMetric(MetricArgument::Jacobian)
    , Formula(std::move(function))
  {
  }
  void evaluate(CellType type, int count, int stride, const double* arguments, double* values,
    double* slopes) const override
  {
    isFlat(type) ? this->evaluateIn<2>(count, stride, arguments, values, slopes)
                 : this->evaluateIn<3>(count, stride, arguments, values, slopes);
  }
  void evaluateAlong(CellType type, int count, int stride, const double* arguments,
    const double* along, double* values, double* slopes) const override
  {
    if constexpr (!derives<2> || !derives<3>)
    {
      UserMetric::evaluateAlong(type, count, stride, arguments, along, values, slopes);
    }
    else if (isFlat(type))
    {
      this->evaluateAlongIn<2>(count, stride, arguments, along, values, slopes);
    }
    else
    {
      this->evaluateAlongIn<3>(count, stride, arguments, along, values, slopes);
    }
  }
  bool evaluateInvariants(CellType type, int count, int stride, const double* arguments,
    double* values, double* derivatives) const override
  {
    if constexpr (derives<2> && derives<3>)
    {
      return isFlat(type)
        ? this->evaluateInvariantsIn<2>(count, stride, arguments, values, derivatives)
        : this->evaluateInvariantsIn<3>(count, stride, arguments, values, derivatives);
    }
    return false;
  }

private:
  static bool isFlat(CellType type)
  {
    return type == CellType::Triangle || type == CellType::Quadrilateral;
  }
  /// Whether the derivatives are computed here instead of by the formula.
  template <int N>
  static constexpr bool derives =
    !user_metric::HasSlope<Function, CornerJacobian<DualNumber<0>, N>, DualNumber<0>[N][N]>::value;

  template <int N>
  void evaluateAlongIn(int count, int stride, const double* arguments, const double* along,
    double* values, double* slopes) const
  {
    for (int first = 0; first < count; first += PacketWidth)
    {
      Packet t[N][N], w[N];
      user_metric::load<N * N>(arguments, first, count, stride, &t[0][0]);
      user_metric::load<N>(along, first, count, stride, w);
      const auto q = this->Formula.value(CornerJacobian<DualNumber<N>, N>(t, w));
      user_metric::store(q.value, first, stride, values);
      for (int k = 0; k < N; ++k)
      {
        user_metric::store(q.slope[k], first, stride, slopes + k * stride);
      }
    }
  }

  template <int N>
  bool evaluateInvariantsIn(
    int count, int stride, const double* arguments, double* values, double* derivatives) const
  {
    for (int first = 0; first < count; first += PacketWidth)
    {
      Packet invariants[2];
      user_metric::load<2>(arguments, first, count, stride, invariants);
      if (!derivatives)
      {
        const CornerJacobian<DualNumber<0>, N> plain(invariants);
        const Packet value = this->Formula.value(plain).value;
        if (plain.readsMore())
        {
          return false;
        }
        user_metric::store(value, first, stride, values);
        continue;
      }
      const CornerJacobian<DualNumber<ByInvariants>, N> T(invariants);
      const auto q = this->Formula.value(T);
      if (T.readsMore())
      {
        return false;
      }
      user_metric::store(q.value, first, stride, values);
      for (int k = 0; k < 2; ++k)
      {
        user_metric::store(q.slope[k], first, stride, derivatives + k * stride);
      }
      for (int k = 0; k < 3; ++k)
      {
        user_metric::store(q.curvature[k], first, stride, derivatives + (2 + k) * stride);
      }
    }
    return true;
  }

  template <int N>
  void evaluateIn(
    int count, int stride, const double* arguments, double* values, double* slopes) const
  {
    for (int first = 0; first < count; first += PacketWidth)
    {
      Packet t[N][N];
      user_metric::load<N * N>(arguments, first, count, stride, &t[0][0]);
      const CornerJacobian<DualNumber<0>, N> plain(t);
      if (!slopes)
      {
        user_metric::store(this->Formula.value(plain).value, first, stride, values);
        continue;
      }
      using Slopes = DualNumber<0>[N][N];
      if constexpr (user_metric::HasSlope<Function, CornerJacobian<DualNumber<0>, N>,
                      Slopes>::value)
      {
        Slopes own;
        this->Formula.slope(plain, own);
        user_metric::store(this->Formula.value(plain).value, first, stride, values);
        for (int k = 0; k < N * N; ++k)
        {
          user_metric::store(own[k / N][k % N].value, first, stride, slopes + k * stride);
        }
      }
      else
      {
        const auto q = this->Formula.value(CornerJacobian<DualNumber<N * N>, N>(t));
        user_metric::store(q.value, first, stride, values);
        for (int k = 0; k < N * N; ++k)
        {
          user_metric::store(q.slope[k], first, stride, slopes + k * stride);
        }
      }
    }
  }

  Function Formula;
};

/// A metric that is a function of the corners of the element.
template <class Function>
class CornerMetric : public UserMetric
{
public:
  explicit CornerMetric(Function function)
    : UserMetric(MetricArgument::Corners)
    , Formula(std::move(function))
  {
  }
  void evaluate(CellType type, int count, int stride, const double* arguments, double* values,
    double* slopes) const override
  {
    withNodes(type,
      [&](auto nodes) {
        this->evaluateOn<decltype(nodes)::value>(type, count, stride, arguments, values, slopes);
      });
  }
  void evaluateAlong(CellType type, int count, int stride, const double* arguments,
    const double* along, double* values, double* slopes) const override
  {
    withNodes(type,
      [&](auto nodesOfType)
      {
        constexpr int Nodes = decltype(nodesOfType)::value;
        if constexpr (user_metric::HasSlope<Function, ElementCorners<DualNumber<0>, Nodes>,
                        DualNumber<0>[Nodes][3]>::value)
        {
          UserMetric::evaluateAlong(type, count, stride, arguments, along, values, slopes);
        }
        else
        {
          this->evaluateAlongOn<Nodes>(type, count, stride, arguments, along, values, slopes);
        }
      });
  }

private:
  /// Calls work with the number of corners as a constant.
  template <class Work>
  static void withNodes(CellType type, const Work& work)
  {
    switch (type)
    {
      case CellType::Triangle:
        return work(std::integral_constant<int, 3>());
      case CellType::Quadrilateral:
      case CellType::Tetrahedron:
        return work(std::integral_constant<int, 4>());
      case CellType::Pyramid:
        return work(std::integral_constant<int, 5>());
      case CellType::Wedge:
        return work(std::integral_constant<int, 6>());
      default:
        return work(std::integral_constant<int, 8>());
    }
  }

  template <int Nodes>
  void evaluateAlongOn(CellType type, int count, int stride, const double* arguments,
    const double* along, double* values, double* slopes) const
  {
    for (int first = 0; first < count; first += PacketWidth)
    {
      Packet points[Nodes][3], moves[Nodes];
      user_metric::load<3 * Nodes>(arguments, first, count, stride, &points[0][0]);
      user_metric::load<Nodes>(along, first, count, stride, moves);
      const auto q = this->Formula.value(ElementCorners<DualNumber<3>, Nodes>(type, points, moves));
      user_metric::store(q.value, first, stride, values);
      for (int c = 0; c < 3; ++c)
      {
        user_metric::store(q.slope[c], first, stride, slopes + c * stride);
      }
    }
  }

  template <int Nodes>
  void evaluateOn(CellType type, int count, int stride, const double* arguments, double* values,
    double* slopes) const
  {
    for (int first = 0; first < count; first += PacketWidth)
    {
      Packet points[Nodes][3];
      user_metric::load<3 * Nodes>(arguments, first, count, stride, &points[0][0]);
      const ElementCorners<DualNumber<0>, Nodes> plain(type, points);
      if (!slopes)
      {
        user_metric::store(this->Formula.value(plain).value, first, stride, values);
        continue;
      }
      using Slopes = DualNumber<0>[Nodes][3];
      if constexpr (user_metric::HasSlope<Function, ElementCorners<DualNumber<0>, Nodes>,
                      Slopes>::value)
      {
        Slopes own;
        this->Formula.slope(plain, own);
        user_metric::store(this->Formula.value(plain).value, first, stride, values);
        for (int k = 0; k < 3 * Nodes; ++k)
        {
          user_metric::store(own[k / 3][k % 3].value, first, stride, slopes + k * stride);
        }
      }
      else
      {
        const auto q =
          this->Formula.value(ElementCorners<DualNumber<3 * Nodes>, Nodes>(type, points));
        user_metric::store(q.value, first, stride, values);
        for (int k = 0; k < 3 * Nodes; ++k)
        {
          user_metric::store(q.slope[k], first, stride, slopes + k * stride);
        }
      }
    }
  }

  Function Formula;
};

/**
 * @brief Values of elements of one type: `points` has x y z of the corners of each of `count`
 * elements, one after another; `values` receives one number each. Nonfinite values become 0.
 */
using ElementsFunction =
  std::function<void(CellType type, Index count, const double* points, double* values)>;

/**
 * @brief Registers a metric, for the rest of the process. Its number is derived from its name: it
 * is the same in every session, independent of other registrations.
 *
 * The metric is tested first: its values must be finite on elements near the ideal one, and its
 * derivatives and invariances must be as declared. @throws Error for failed tests, for a name or
 * label already in use, or for contradictory facts.
 */
TAUTLINE_KERNEL_EXPORT Metric registerMetric(
  const MetricDescription& description, std::unique_ptr<const UserMetric> metric);

/// Registers a function of T: a struct with a template `value` (and `slope`), see above.
template <class Function>
Metric registerJacobianMetric(const MetricDescription& description, Function function)
{
  return registerMetric(
    description, std::make_unique<const JacobianMetric<Function>>(std::move(function)));
}

/// Registers a function of the corners.
template <class Function>
Metric registerCornerMetric(const MetricDescription& description, Function function)
{
  return registerMetric(
    description, std::make_unique<const CornerMetric<Function>>(std::move(function)));
}

/// Registers a function of the corners of many elements.
TAUTLINE_KERNEL_EXPORT Metric registerElementsMetric(
  const MetricDescription& description, ElementsFunction function);

/**
 * @brief Removes a registered metric from the lists; the number remains valid for running
 * evaluations, and the name can be registered again. @throws Error if no user metric has the name.
 */
TAUTLINE_KERNEL_EXPORT void unregisterMetric(const std::string& name);

/**
 * @brief Loads a shared library that registers metrics (MetricRegistration). The libraries in the
 * environment variable TAUTLINE_METRICS, separated by colons, are loaded when metrics are first
 * looked up; see metricLoadErrors() for their errors.
 * @throws Error if it cannot be loaded, or a registration in it failed
 */
TAUTLINE_KERNEL_EXPORT void loadMetrics(const std::string& library);

/// The errors of registrations made while a library was loaded, one per line; or "".
TAUTLINE_KERNEL_EXPORT std::string metricLoadErrors();

/// A registration as a static object of a library: it does not throw, see metricLoadErrors().
class MetricRegistration
{
public:
  template <class Register>
  explicit MetricRegistration(const Register& work)
  {
    try
    {
      work();
    }
    catch (const std::exception& error)
    {
      addError(error.what());
    }
  }
  TAUTLINE_KERNEL_EXPORT static void addError(const std::string& message);
};
}
#endif
