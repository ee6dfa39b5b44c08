// SPDX-License-Identifier: BSD-3-Clause
#include "MetricCertifier.h"

#include "BernsteinQuotient.h"
#include "ElementPlacement.h"
#include "TargetForm.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr double smallestMetricTolerance = 1e-9;

/// The coefficients of a vector, scaled by their multinomials.
using VectorPolynomial = std::vector<DeterminantWork<double>::Vector>;
/// The same for a scalar.
using ScalarPolynomial = std::vector<double>;

/// The edges of a shape in terms of its coordinates, and the corners in terms of their edges.
struct CornerEdges
{
  std::vector<Vec3> edges;
  std::vector<std::vector<int>> corners;
  double factor; ///< scales the scaled Jacobian to 1 for the ideal element
};

CornerEdges cornerEdgesOf(ElementShape shape)
{
  const Vec3 u = { 1, 0, 0 }, v = { 0, 1, 0 }, w = { 0, 0, 1 };
  const double triangle = 2 / std::sqrt(3.0), tetrahedron = std::sqrt(2.0);
  switch (shape)
  {
    case ElementShape::Triangle:
      return { { u, v, v - u }, { { 0, 1 }, { 0, 2 }, { 1, 2 } }, triangle };
    case ElementShape::Quadrilateral:
      return { { u, v }, { { 0, 1 } }, 1 };
    case ElementShape::Tetrahedron:
      return { { u, v, w, v - u, w - u, w - v },
        { { 0, 1, 2 }, { 0, 3, 4 }, { 1, 3, 5 }, { 2, 4, 5 } }, tetrahedron };
    case ElementShape::Hexahedron:
      return { { u, v, w }, { { 0, 1, 2 } }, 1 };
    case ElementShape::Wedge:
      return { { u, v, v - u, w }, { { 0, 1, 3 }, { 0, 2, 3 }, { 1, 2, 3 } }, triangle };
    default:
      throw Error("A pyramid has no scaled Jacobian: choose the mean ratio.");
  }
}

QuotientDenominator denominatorOf(const ElementType& type, ElementMetric metric, bool surface)
{
  const bool flat = type.dimension() == 2;
  if (metric == ElementMetric::ScaledJacobian)
  {
    return surface ? QuotientDenominator::Itself
      : flat       ? QuotientDenominator::RootOfTwo
                   : QuotientDenominator::RootOfThree;
  }
  return flat                            ? QuotientDenominator::Itself
    : metric == ElementMetric::MeanRatio ? QuotientDenominator::ThreeHalves
                                         : QuotientDenominator::RootOfTwo;
}
}

//------------------------------------------------------------------------------
struct MetricCertifier::Work : ElementPlacement
{
  Work(const ElementType& elements, ElementMetric wanted, const Vec3& normal, bool mirror)
    : ElementPlacement(elements, normal, mirror)
    , type(elements)
    , metric(wanted)
    , determinant(elements, surface)
    , columnForm(elements)
    , inverse(idealInverseOf(elements.shape()))
    , squareSpace(columnForm.space.times(columnForm.space))
    , squareTargets(columnForm.space, columnForm.space, squareSpace)
    , square(squareSpace.size())
  {
    const int nodes = elements.nodes(), dimension = elements.dimension();
    if (metric == ElementMetric::ScaledJacobian)
    {
      edges = cornerEdgesOf(elements.shape());
      for (const Vec3& edge : edges.edges)
      {
        columns.push_back(columnForm.combine(edge, nodes));
      }
    }
    else
    {
      edges.corners = { {} };
      for (int c = 0; c < dimension; ++c)
      {
        columns.push_back(
          columnForm.combine({ inverse[0][c], inverse[1][c], inverse[2][c] }, nodes));
      }
    }
    polynomials.assign(columns.size(), VectorPolynomial(columnForm.space.size()));
    const DeterminantForm& form = elements.determinant();
    const bool adjugate = metric == ElementMetric::InverseCondition && dimension == 3;
    const bool fourth = adjugate || surface;
    if (fourth)
    {
      fourthSpace = squareSpace.times(squareSpace);
      fourthTargets = BernsteinProduct(squareSpace, squareSpace, fourthSpace);
      this->fourth.resize(fourthSpace.size());
      other.resize(squareSpace.size());
      normals.resize(squareSpace.size());
    }
    const BernsteinSpace& numerator = surface ? form.squareSpace : form.space;
    space = unionOf(numerator, fourth ? fourthSpace : squareSpace);
    numeratorElevation = BernsteinElevation(numerator, space);
    squareElevation = BernsteinElevation(squareSpace, space);
    if (fourth)
    {
      fourthElevation = BernsteinElevation(fourthSpace, space);
    }
    scaledNumerator.resize(numerator.size());
    bisections = tautline::bisections(space);
    corners = tautline::corners(space);
    searcher.reset(
      new BernsteinQuotient(denominatorOf(elements, metric, surface), space, bisections, corners));
  }

  /// The power that converts the quotient to the metric.
  double power() const
  {
    return this->surface                                                        ? 0.5
      : this->metric == ElementMetric::MeanRatio && this->type.dimension() == 3 ? 2.0 / 3
                                                                                : 1.0;
  }

  /// The factor of the determinant in the quotient.
  double scale() const
  {
    const double dimension = this->type.dimension();
    const double ideal = idealDeterminantOf(this->type.shape());
    switch (this->metric)
    {
      case ElementMetric::ScaledJacobian:
        return this->edges.factor;
      case ElementMetric::MeanRatio:
        return dimension == 3 ? ideal : 2 * ideal;
      default:
        return dimension * ideal;
    }
  }

  void findColumns()
  {
    for (std::size_t c = 0; c < this->columns.size(); ++c)
    {
      const ControlMatrix& matrix = this->columns[c];
      for (int k = 0; k < matrix.rows(); ++k)
      {
        DeterminantWork<double>::Vector sum = {};
        for (int e = matrix.offsets[k]; e < matrix.offsets[k + 1]; ++e)
        {
          const double* node = this->determinant.nodes[matrix.columns[e]].c;
          for (int i = 0; i < 3; ++i)
          {
            sum.c[i] += matrix.values[e] * node[i];
          }
        }
        this->polynomials[c][k] = sum;
      }
    }
  }

  /// Adds the square of a vector.
  void addSquare(const VectorPolynomial& a, const BernsteinProduct& targets, ScalarPolynomial& sums)
  {
    const int size = static_cast<int>(a.size());
    for (int i = 0; i < size; ++i)
    {
      const double x = a[i].c[0], y = a[i].c[1], z = a[i].c[2];
      const std::uint16_t* target = targets.targets(i);
      sums[target[i]] += x * x + y * y + z * z;
      for (int j = i + 1; j < size; ++j)
      {
        const double* b = a[j].c;
        sums[target[j]] += 2 * (x * b[0] + y * b[1] + z * b[2]);
      }
    }
  }

  void addProduct(const ScalarPolynomial& a, const ScalarPolynomial& b, ScalarPolynomial& sums)
  {
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      const std::uint16_t* target = this->fourthTargets.targets(static_cast<int>(i));
      for (std::size_t j = 0; j < b.size(); ++j)
      {
        sums[target[j]] += a[i] * b[j];
      }
    }
  }

  /// |adj T|^2: the squares of the cross products of two columns.
  void findAdjugate()
  {
    std::fill(this->fourth.begin(), this->fourth.end(), 0.0);
    for (int c = 0; c < 3; ++c)
    {
      const VectorPolynomial &a = this->polynomials[c], &b = this->polynomials[(c + 1) % 3];
      std::fill(this->normals.begin(), this->normals.end(), DeterminantWork<double>::Vector{});
      for (std::size_t i = 0; i < a.size(); ++i)
      {
        const double x = a[i].c[0], y = a[i].c[1], z = a[i].c[2];
        const std::uint16_t* target = this->squareTargets.targets(static_cast<int>(i));
        for (std::size_t j = 0; j < b.size(); ++j)
        {
          const double* d = b[j].c;
          double* sum = this->normals[target[j]].c;
          sum[0] += y * d[2] - z * d[1];
          sum[1] += z * d[0] - x * d[2];
          sum[2] += x * d[1] - y * d[0];
        }
      }
      this->addSquare(this->normals, this->fourthTargets, this->fourth);
    }
  }

  /// The square of the length of a combination of derivatives.
  const ScalarPolynomial& squareOf(int column)
  {
    std::fill(this->square.begin(), this->square.end(), 0.0);
    this->addSquare(this->polynomials[column], this->squareTargets, this->square);
    return this->square;
  }

  void findNumerator()
  {
    const DeterminantForm& form = this->type.determinant();
    if (this->surface)
    {
      this->determinant.runNormals();
      this->scaledNormals = this->determinant.normals;
      for (int k = 0; k < form.space.size(); ++k)
      {
        for (double& x : this->scaledNormals[k].c)
        {
          x *= form.space.multinomial(k);
        }
      }
      std::fill(this->scaledNumerator.begin(), this->scaledNumerator.end(), 0.0);
      this->addSquare(this->scaledNormals, form.square, this->scaledNumerator);
      return;
    }
    this->determinant.run();
    for (int k = 0; k < form.space.size(); ++k)
    {
      this->scaledNumerator[k] =
        form.space.multinomial(k) * this->determinant.coefficients[k].value;
    }
  }

  /// Fills the search for a corner of the scaled Jacobian; for other metrics, corner 0 only.
  void fill(int corner)
  {
    const double factor = this->surface ? this->scale() * this->scale() : this->scale();
    double* d = this->searcher->coefficients(0);
    this->numeratorElevation.run(this->scaledNumerator.data(), d);
    for (int k = 0; k < this->space.size(); ++k)
    {
      d[k] *= factor;
    }
    if (this->metric == ElementMetric::ScaledJacobian)
    {
      this->fillEdges(this->edges.corners[corner]);
      return;
    }
    std::fill(this->square.begin(), this->square.end(), 0.0);
    for (const VectorPolynomial& column : this->polynomials)
    {
      this->addSquare(column, this->squareTargets, this->square);
    }
    if (this->surface)
    {
      std::fill(this->fourth.begin(), this->fourth.end(), 0.0);
      this->addProduct(this->square, this->square, this->fourth);
      this->fourthElevation.run(this->fourth.data(), this->searcher->coefficients(1));
      return;
    }
    this->squareElevation.run(this->square.data(), this->searcher->coefficients(1));
    if (this->metric == ElementMetric::InverseCondition && this->type.dimension() == 3)
    {
      this->findAdjugate();
      this->fourthElevation.run(this->fourth.data(), this->searcher->coefficients(2));
    }
  }

  void fillEdges(const std::vector<int>& own)
  {
    if (this->surface)
    {
      this->other = this->squareOf(own[0]);
      std::fill(this->fourth.begin(), this->fourth.end(), 0.0);
      this->addProduct(this->other, this->squareOf(own[1]), this->fourth);
      this->fourthElevation.run(this->fourth.data(), this->searcher->coefficients(1));
      return;
    }
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      this->squareElevation.run(
        this->squareOf(own[i]).data(), this->searcher->coefficients(static_cast<int>(i) + 1));
    }
  }

  const ElementType& type;
  ElementMetric metric;
  DeterminantWork<double> determinant;
  ColumnForm columnForm;
  ElementMatrix inverse;
  BernsteinSpace squareSpace; ///< of the product of two columns
  BernsteinProduct squareTargets;
  ScalarPolynomial square;
  CornerEdges edges;
  std::vector<ControlMatrix> columns;        ///< of T, or the edges
  std::vector<VectorPolynomial> polynomials; ///< the same for the loaded element
  BernsteinSpace fourthSpace;
  BernsteinProduct fourthTargets;
  ScalarPolynomial fourth, other, scaledNumerator;
  VectorPolynomial normals, scaledNormals;
  BernsteinSpace space; ///< of the search
  BernsteinElevation numeratorElevation, squareElevation, fourthElevation;
  std::vector<BernsteinBisection> bisections;
  std::vector<BernsteinCorner> corners;
  std::unique_ptr<BernsteinQuotient> searcher;
  Index splits = 0;
};

//------------------------------------------------------------------------------
MetricCertifier::MetricCertifier(
  const ElementType& type, ElementMetric metric, const Vec3& normal, bool mirrored)
  : Memory(new Work(type, metric, normal, mirrored))
{
}

MetricCertifier::~MetricCertifier() = default;
MetricCertifier::MetricCertifier(MetricCertifier&&) noexcept = default;

//------------------------------------------------------------------------------
MetricBound MetricCertifier::minimum(const double* points, const Index* nodes, double tolerance)
{
  Work& work = *this->Memory;
  work.load(work.determinant, points, nodes);
  work.findNumerator();
  MetricBound bound;
  if (!std::isfinite(work.determinant.noise))
  {
    bound.lower = bound.upper = std::numeric_limits<double>::quiet_NaN();
    return bound;
  }
  work.findColumns();
  const double gap = std::max(tolerance, smallestMetricTolerance);
  bound.lower = bound.upper = std::numeric_limits<double>::infinity();
  const auto take = [&](const QuotientMinimum& found)
  {
    if (found.upper < bound.upper)
    {
      bound.upper = found.upper;
      bound.at = found.at;
    }
  };
  // Start with the corner with the smallest scaled Jacobian; the others only need to be above the
  // smallest value so far.
  const int corners = static_cast<int>(work.edges.corners.size());
  int first = 0;
  for (int corner = 0; corner < corners; ++corner)
  {
    work.fill(corner);
    const QuotientMinimum found = work.searcher->atCorners(work.power());
    first = found.upper < bound.upper ? corner : first;
    take(found);
  }
  for (int i = 0; i < corners && !(bound.upper < 0); ++i)
  {
    if (corners > 1)
    {
      work.fill((first + i) % corners);
    }
    const QuotientMinimum found =
      work.searcher->minimum(work.power(), gap, std::max(bound.upper - gap, 0.0));
    work.splits += work.searcher->splits();
    bound.lower = std::min(bound.lower, found.lower);
    take(found);
  }
  bound.lower = bound.upper < 0 ? -std::numeric_limits<double>::infinity() : bound.lower;
  return bound;
}

//------------------------------------------------------------------------------
double MetricCertifier::valueAt(const double* points, const Index* nodes, const Vec3& at)
{
  Work& work = *this->Memory;
  work.load(work.determinant, points, nodes);
  work.findNumerator();
  work.findColumns();
  const std::vector<long double> values = work.space.valuesAt({ at[0], at[1], at[2] });
  const auto valueOf = [&](int i)
  {
    const double* c = work.searcher->coefficients(i);
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k)
    {
      sum += static_cast<double>(values[k]) * c[k];
    }
    return sum;
  };
  const QuotientDenominator kind = denominatorOf(work.type, work.metric, work.surface);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t corner = 0; corner < work.edges.corners.size(); ++corner)
  {
    work.fill(static_cast<int>(corner));
    double denominator = valueOf(1);
    for (int i = 2; i <= polynomialsOf(kind); ++i)
    {
      denominator *= valueOf(i);
    }
    denominator = kind == QuotientDenominator::Itself ? denominator
      : kind == QuotientDenominator::ThreeHalves      ? std::pow(denominator / 3, 1.5)
                                                      : std::sqrt(denominator);
    const double quotient = valueOf(0) / denominator;
    const double value = std::copysign(std::pow(std::abs(quotient), work.power()), quotient);
    least = std::min(least, std::isfinite(value) ? value : 0.0);
  }
  return least;
}

//------------------------------------------------------------------------------
Index MetricCertifier::splits() const
{
  return this->Memory->splits;
}
}
