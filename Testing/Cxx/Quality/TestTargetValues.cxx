// SPDX-License-Identifier: BSD-3-Clause
// A second evaluation of the metrics of T = A W^-1, one corner at a time in plain double precision,
// from the matrix form the literature gives: |T - T^-t|^2 with an inverse, not with invariants.
#include "Matrix.h"
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr int cellsPerType = 300;
constexpr double tolerance = 1e-10; // relative, or of 1 for values near 0
using Corners = std::vector<Vec3>;

double squared(double x)
{
  return x * x;
}

/// Metrics of T at one corner, with the sign of tau where the registry has it.
double targetFormula(Metric metric, const Matrix& t, double size, const Parameters& p)
{
  const int n = t.n;
  const double tau = determinant(t), sign = tau < 0 ? -1 : 1, length = norm(t);
  const double root3 = std::sqrt(3.0), cubed = length * length * length;
  const Matrix one = identity(n), inverseT = inverse(t), adjT = transpose(adjugate(t));
  const double gram2 = squared(norm(transpose(t) * t));
  const double shapeSize = squared(norm(t - transpose(inverseT)));
  const double imr = sign * squared(length) / (n * std::pow(std::abs(tau), 2.0 / n));
  const double condition = sign * length * norm(inverseT) / n;
  switch (metric)
  {
    case Metric::InverseMeanRatio:
      return imr;
    case Metric::MeanRatio:
      return 1 / imr;
    case Metric::ConditionNumber:
      return condition;
    case Metric::UntangleBeta:
      return (std::abs(size - p.beta) - (size - p.beta)) / 2;
    case Metric::ShapeBarrier:
      return imr - 1;
    case Metric::ShapeNonBarrier:
      return n == 2 ? squared(length) - 2 * tau : cubed / (3 * root3) - tau;
    case Metric::ShapeCondition:
      return condition - 1;
    case Metric::ShapeConditionSquared:
      return squared(condition) - 1;
    case Metric::ShapeSquared:
      return gram2 / (2 * tau * tau) - 1;
    case Metric::ShapeProduct:
      return gram2 / (tau * tau) - 2 * squared(length) / tau + 2;
    case Metric::ShapeCubic:
      return cubed / (3 * root3 * tau) - 1;
    case Metric::ShapeSizeAdjugate:
      return squared(norm(t - adjT)) / (6 * tau);
    case Metric::ShapeSimilarity:
      return squared(norm((n == 2 ? 1 : length / root3) * t - adjT));
    case Metric::ShapeSizeBarrier:
      return shapeSize;
    case Metric::ShapeSizeWeighted:
      return tau * shapeSize;
    case Metric::ShapeSizeLogarithm:
      return cubed - 3 * root3 * std::log(std::abs(tau)) - 3 * root3;
    case Metric::SizeNonBarrier:
      return squared(tau - 1);
    case Metric::SizeBarrier:
      return (tau + 1 / tau) / 2 - 1;
    case Metric::SizeBarrierSquared:
      return squared(tau - 1 / tau) / 2;
    case Metric::SizeUntangle:
      return squared(tau - 1) - tau + std::sqrt(tau * tau + p.epsilon);
    case Metric::ShapeOrientation:
      return squared(norm(t - (length / std::sqrt(n)) * one));
    case Metric::ShapeOrientationBarrier:
      return (length - trace(t) / std::sqrt(n)) / (2 * tau);
    case Metric::ShapeSizeOrientation:
      return squared(norm(t - one));
    default: // ShapeSizeOrientationBarrier
      return squared(norm(t - one)) / tau;
  }
}

/// The mean, the worst or the power mean of corner values.
double combine(const MetricInfo& info, const std::vector<double>& q, const EvaluationOptions& o)
{
  const bool larger = info.direction == Direction::LargerIsBetter;
  if (o.combination == Combination::Mean)
  {
    return std::accumulate(q.begin(), q.end(), 0.0) / q.size();
  }
  if (o.combination == Combination::Worst)
  {
    return larger ? *std::min_element(q.begin(), q.end()) : *std::max_element(q.begin(), q.end());
  }
  const long double p = larger ? -o.power : o.power; // a larger range, for high powers
  long double sum = 0;
  for (long double value : q)
  {
    sum += std::pow(std::abs(value), p) / q.size();
  }
  return std::copysign(static_cast<double>(std::pow(sum, 1 / p)), q.front());
}

/// A cell's value from its corners. Where some are inverted, only these count for the metrics that
/// cannot be evaluated across tau = 0.
double targetValue(const MetricInfo& info, CellType type, const Corners& p, const Matrix* inverseW,
  const EvaluationOptions& o)
{
  const CellTopology& t = topology(type);
  std::vector<double> all, inverted;
  for (int c = 0; c < t.samples; ++c)
  {
    const auto& node = t.cornerNodes[c];
    const Matrix a =
      makeMatrix(t.dimension, [&](int r, int k) { return p[node[k + 1]][r] - p[node[0]][r]; });
    const double size = t.sizePerDeterminant * determinant(a);
    all.push_back(targetFormula(info.metric, a * inverseW[c], size, o.parameters));
    if (size < 0)
    {
      inverted.push_back(all.back());
    }
  }
  const bool finite = info.inverted == InvertedValue::Larger;
  return combine(info, inverted.empty() || finite ? all : inverted, o);
}

/// Random W^-1 with positive determinants, different at each sample of each cell.
Targets randomTargets(const MeshData& data, int samples, int n, Random& random)
{
  TAUTLINE_LET(Targets, targets, offsets = { 0 });
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    for (int s = 0; s < samples; ++s)
    {
      const Matrix w = makeMatrix(
        n, [&](int r, int c) { return (r == c ? 1.2 : 0.0) + random.uniform(-0.4, 0.4); });
      for (int entry = 0; entry < 9; ++entry)
      {
        targets.inverse.push_back(w.m[entry / 3][entry % 3]);
      }
    }
    targets.offsets.push_back(targets.offsets.back() + samples);
  }
  return targets;
}

void testMetric(const MetricInfo& info, CellType type, const Mesh& mesh,
  const std::vector<Corners>& cells, const EvaluationOptions& options)
{
  const CellTopology& t = topology(type);
  const std::vector<double> values = valuesOf(mesh, info.metric, options);
  for (int i = 0; i < cellsPerType; ++i)
  {
    Matrix inverseW[MaxNodes];
    for (int s = 0; s < t.samples; ++s)
    {
      const double* w = options.targets ? &options.targets->inverse[9 * (i * t.samples + s)]
                                        : t.idealInverse[s].data();
      inverseW[s] = makeMatrix(t.dimension, [&](int r, int c) { return w[3 * r + c]; });
    }
    const double expected = targetValue(info, type, cells[i], inverseW, options);
    TAUTLINE_CHECK_NEAR(values[i], expected, tolerance * std::max(1.0, std::abs(expected)));
  }
}

void testType(CellType type, bool surface)
{
  const CellTopology& t = topology(type);
  Random random(5);
  std::vector<Corners> cells;
  const MeshData data = scatteredCells(type, surface, cellsPerType, random, cells);
  const Targets targets = randomTargets(data, t.samples, t.dimension, random);
  const Mesh mesh(data.view());
  for (const MetricInfo& info : elementMetrics())
  {
    if (!info.definedOn(type) || info.family != MetricFamily::Target ||
      (surface && !info.rotationInvariant))
    {
      continue;
    }
    for (Combination combination :
      { Combination::Mean, Combination::Worst, Combination::PowerMean })
    {
      const Context context(
        info.name + (", combination " + std::to_string(static_cast<int>(combination))));
      TAUTLINE_LET(EvaluationOptions, options, combination = combination, parameters.beta = 0.3,
        parameters.epsilon = 0.01);
      options.power = 200; // overflows unless values are scaled
      testMetric(info, type, mesh, cells, options);
      TAUTLINE_SET(options, power = 3, targets = &targets);
      testMetric(info, type, mesh, cells, options);
    }
  }
}
}

TAUTLINE_TEST(TestTargetValues)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    TAUTLINE_RUN(testType(type, false));
    if (topology(type).dimension == 2)
    {
      const Context surface("surface");
      TAUTLINE_RUN(testType(type, true));
    }
  }
}
