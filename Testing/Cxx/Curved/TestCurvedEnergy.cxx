// SPDX-License-Identifier: BSD-3-Clause
// The sums over samples of curved elements: the quadratures are exact, gradients and Hessians agree
// with differences.
#include "CurvedBlocks.h"
#include "Registry.h"
#include "tautline/Curved/OptimizeCurved.h"
#include "tautline/Curved/SamplePlaces.h"
#include "tautline/Quality/Metrics.h"

using namespace tautline;

namespace
{
struct Shape
{
  CellType type;
  int order;
};

constexpr std::array<Shape, 9> shapes = { Shape{ CellType::Triangle, 2 },
  Shape{ CellType::Triangle, 4 }, Shape{ CellType::Quadrilateral, 2 },
  Shape{ CellType::Quadrilateral, 3 }, Shape{ CellType::Tetrahedron, 2 },
  Shape{ CellType::Tetrahedron, 3 }, Shape{ CellType::Hexahedron, 2 }, Shape{ CellType::Wedge, 2 },
  Shape{ CellType::Pyramid, 2 } };

std::vector<double> moved(const std::vector<double>& x, const std::vector<double>& d, double step)
{
  std::vector<double> result = x;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    result[i] += step * d[i];
  }
  return result;
}

double product(const std::vector<double>& a, const std::vector<double>& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<double> randomVector(std::size_t size, int dimension, unsigned seed)
{
  Random random(seed);
  std::vector<double> d(size);
  for (std::size_t i = 0; i < size; ++i)
  {
    const double entry = random.uniform(-1, 1);
    d[i] = static_cast<int>(i % 3) < dimension ? entry : 0;
  }
  return d;
}

/// The slope and the Hessian along a random vector.
void testDerivatives(
  const MeshData& data, const CurvedObjective& objective, int dimension, bool second = true)
{
  const auto at = [&](const std::vector<double>& x, const double* direction)
  {
    MeshView view = data.view();
    view.points = x.data();
    return evaluateCurvedObjective(Mesh(view), {}, objective, direction);
  };
  const std::vector<double>& x = data.points;
  const std::vector<double> d = randomVector(x.size(), dimension, 3);
  const CurvedObjectiveValue here = at(x, d.data());
  constexpr double step = 1e-6;
  const CurvedObjectiveValue up = at(moved(x, d, step), nullptr);
  const CurvedObjectiveValue down = at(moved(x, d, -step), nullptr);
  const double scale = 10 * std::sqrt(product(here.gradient, here.gradient));
  TAUTLINE_CHECK(std::isfinite(here.value) && scale > 0);
  TAUTLINE_CHECK_NEAR(
    product(here.gradient, d), (up.value - down.value) / (2 * step), 1e-5 * scale);
  double largest = 0;
  for (const double entry : here.product)
  {
    largest = std::max(largest, std::abs(entry));
  }
  for (std::size_t i = 0; second && i < x.size(); ++i)
  {
    TAUTLINE_CHECK_NEAR(
      here.product[i], (up.gradient[i] - down.gradient[i]) / (2 * step), 1e-4 * largest);
  }
}

void testMetrics(const MeshData& data, int dimension)
{
  for (const MetricInfo& info : elementMetrics())
  {
    const bool defined = dimension == 2 ? info.in2D : info.in3D;
    if (!defined || info.family != MetricFamily::Target || info.user ||
      info.metric == Metric::UntangleBeta)
    {
      continue;
    }
    const Context context(info.name);
    CurvedObjective objective;
    objective.objective.metric = info.metric;
    testDerivatives(data, objective, dimension);
  }
  CurvedObjective objective;
  objective.objective.objectiveTemplate = ObjectiveTemplate::PowerMean;
  testDerivatives(data, objective, dimension, false); // its Hessian equals the sum's within

  const std::vector<double> sizes(data.numberOfCells(), 0.3);
  std::vector<double> tensors;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    for (const double entry : { 2.0, 0.3, 0.0, 0.3, 1.0, 0.2, 0.0, 0.2, 1.5 })
    {
      tensors.push_back(entry);
    }
  }
  MeshData reference = data;
  reference.transform(TAUTLINE_PLACE(1.1 * p[0] + 0.1 * p[1], p[1] - 0.1 * p[0], p[2]));
  for (const auto& [target, values] :
    { std::make_pair(TargetType::Size, sizes.data()),
      std::make_pair(TargetType::Tensor, static_cast<const double*>(tensors.data())),
      std::make_pair(TargetType::Reference, static_cast<const double*>(reference.points.data())) })
  {
    const Context context("target " + std::to_string(static_cast<int>(target)));
    CurvedObjective own;
    own.objective.metric = Metric::ShapeSizeBarrier;
    own.target = target;
    own.data = values;
    testDerivatives(data, own, dimension);
  }
}

/// The integral of u^a v^b w^c over a simplex of a dimension, divided by its size.
double simplexMean(int a, int b, int c, int dimension)
{
  const double factorials = std::tgamma(a + 1) * std::tgamma(b + 1) * std::tgamma(c + 1);
  return factorials * std::tgamma(dimension + 1) / std::tgamma(a + b + c + dimension + 1);
}

double lineMean(int a)
{
  return 1.0 / (a + 1);
}
}

TAUTLINE_PART(testQuadratures)
{
  for (const Shape& shape : shapes)
  {
    const MeshData data = raised(singleCell(shape.type, idealCell(shape.type)), shape.order);
    const ElementType& type =
      ElementType::ofVtk(data.types[0], static_cast<int>(data.connectivity.size()));
    const std::vector<SamplePlace> places = quadrature(type);
    const Context context(topology(shape.type).name + std::to_string(shape.order));
    constexpr int degree = 2;
    for (int a = 0; a <= degree; ++a)
    {
      for (int b = 0; b + a <= degree; ++b)
      {
        for (int c = 0; c + b + a <= degree && (c == 0 || type.dimension() == 3); ++c)
        {
          double sum = 0;
          for (const SamplePlace& place : places)
          {
            TAUTLINE_CHECK(place.weight > 0);
            const Vec3& at = place.at;
            sum += place.weight * std::pow(at[0], a) * std::pow(at[1], b) * std::pow(at[2], c);
          }
          const double base = shape.type == CellType::Wedge || shape.type == CellType::Triangle
            ? simplexMean(a, b, 0, 2)
            : lineMean(a) * lineMean(b);
          // The sections of a pyramid have the weight (1 - w)^2.
          const double height = shape.type == CellType::Pyramid
            ? 3 * std::tgamma(c + 1) * std::tgamma(3) / std::tgamma(c + 4)
            : lineMean(c);
          const double expected =
            shape.type == CellType::Tetrahedron ? simplexMean(a, b, c, 3) : base * height;
          TAUTLINE_CHECK_NEAR(sum, expected, 1e-12);
        }
      }
    }
  }
}

TAUTLINE_PART(testGradients)
{
  for (const Shape& shape : shapes)
  {
    const Context context(topology(shape.type).name + std::to_string(shape.order));
    const double amplitude = shape.type == CellType::Pyramid ? 0.01 : 0.03;
    const MeshData data = movedCurvedBlock(shape.type, shape.order, 2, amplitude);
    testMetrics(data, topology(shape.type).dimension);
  }
}

TAUTLINE_PART(testErrors)
{
  const MeshData data = movedCurvedBlock(CellType::Tetrahedron, 2, 2, 0);
  const Mesh mesh(data.view());
  CurvedObjective objective;
  objective.objective.metric = Metric::MinimumAngle;
  TAUTLINE_CHECK_THROWS(evaluateCurvedObjective(mesh, {}, objective, nullptr),
    wording("that-is-a-function-of-the-jacobian"));
  CurvedObjective maximum;
  maximum.objective.objectiveTemplate = ObjectiveTemplate::Maximum;
  TAUTLINE_CHECK_THROWS(
    evaluateCurvedObjective(mesh, {}, maximum, nullptr), wording("choose-p-mean"));
}
