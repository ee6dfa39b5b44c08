// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleStar.h"

#include <limits>

namespace tautline
{
namespace
{
/// Functions that are larger than the smallest by more than this do not limit a step.
constexpr double Band = 0.3;
/// The maximum number of functions, the smallest ones.
constexpr std::size_t MaxFunctions = 24;
/// The number of weight exchanges between two functions, and the gap at which they end.
constexpr int Exchanges = 60;
constexpr double Balanced = 1e-7;
/// The weight of the square of the step times the square of the shortest edge: at first, and its
/// factors after a failed and a successful step.
constexpr double FirstStepWeight = 3.0, Harder = 4.0, Softer = 0.5;
constexpr int Trials = 5;

double signedArea2(const Vec3& c, const Vec3& normal)
{
  return dot(c, normal) < 0.0 ? -norm(c) : norm(c);
}
}

double TriangleStar::evaluate(const Vec3& p, const Vec3& normal) const
{
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < this->Metrics.size(); ++k)
  {
    const Vec3 u = this->Edges[k][0] - p, v = this->Edges[k][1] - p;
    smallest = std::min(smallest, planeMeanRatio({ u[0], u[1] }, { v[0], v[1] }, this->Metrics[k]));
  }
  if (!this->Metrics.empty())
  {
    return smallest;
  }
  for (const auto& [a, b] : this->Edges)
  {
    const Vec3 u = a - p, v = b - p, w = b - a;
    const double u2 = dot(u, u), v2 = dot(v, v), w2 = dot(w, w);
    const double product = u2 * v2 * w2;
    const double q = product > 0.0
      ? signedArea2(cross(u, v), normal) * std::sqrt(std::min({ u2, v2, w2 }) / product)
      : 0.0;
    smallest = std::min(smallest, q);
  }
  return smallest;
}

void TriangleStar::addFunction(double value, const Vec3& gradient, const Directions& directions)
{
  const double along = directions.count > 1 ? dot(gradient, directions.second) : 0.0;
  this->Functions.push_back({ value, { dot(gradient, directions.first), along }, 0.0 });
}

/// The sines of the angles: D / (u v), where D is twice the area.
void TriangleStar::linearizeSines(const Vec3& p, const Directions& directions)
{
  const Vec3 up = directions.normal();
  const auto add = [&](double value, const Vec3& gradient)
  { this->addFunction(value, gradient, directions); };
  for (const auto& [a, b] : this->Edges)
  {
    const Vec3 u = a - p, v = b - p, w = b - a;
    const double u1 = norm(u), v1 = norm(v), w1 = norm(w);
    const Vec3 c = cross(u, v);
    const double area2 = norm(c);
    if (!(u1 * v1 * w1 * area2 > 0.0))
    {
      continue;
    }
    const double d = signedArea2(c, up);
    const Vec3 gradD = cross((1.0 / area2) * c, w);
    // The gradients of u1 and v1 with respect to p are -u / u1 and -v / v1.
    const Vec3 toU = (1.0 / (u1 * u1)) * u, toV = (1.0 / (v1 * v1)) * v;
    const double atP = d / (u1 * v1), atA = d / (u1 * w1), atB = d / (v1 * w1);
    add(atP, (1.0 / (u1 * v1)) * gradD + atP * (toU + toV));
    add(atA, (1.0 / (u1 * w1)) * gradD + atA * toU);
    add(atB, (1.0 / (v1 * w1)) * gradD + atB * toV);
  }
}

/// The mean ratios c D / S with the sum S of the squared edges in the metrics.
void TriangleStar::linearizeMeanRatios(const Vec3& p, const Directions& directions)
{
  for (std::size_t k = 0; k < this->Metrics.size(); ++k)
  {
    const PlaneTensor& m = this->Metrics[k];
    const Vec3 u = this->Edges[k][0] - p, v = this->Edges[k][1] - p, w = v - u;
    const auto applied = [&m](const Vec3& e) {
      return Vec3{ m[0] * e[0] + m[1] * e[1], m[1] * e[0] + m[2] * e[1], 0.0 };
    };
    const Vec3 mu = applied(u), mv = applied(v);
    const double sum = dot(u, mu) + dot(v, mv) + dot(w, applied(w));
    const double unit =
      TriangleMeanRatioFactor * std::sqrt(std::max(m[0] * m[2] - m[1] * m[1], 0.0)) / sum;
    if (!(sum > 0.0))
    {
      continue;
    }
    const double value = unit * (u[0] * v[1] - u[1] * v[0]);
    const Vec3 gradient = unit * Vec3{ -w[1], w[0], 0.0 } + (2.0 * value / sum) * (mu + mv);
    this->addFunction(value, gradient, directions);
  }
}

/// The functions near the smallest one.
void TriangleStar::linearize(const Vec3& p, const Directions& directions)
{
  this->Functions.clear();
  if (this->Metrics.empty())
  {
    this->linearizeSines(p, directions);
  }
  else
  {
    this->linearizeMeanRatios(p, directions);
  }
  const auto less = [](const Function& f, const Function& g) { return f.value < g.value; };
  std::stable_sort(this->Functions.begin(), this->Functions.end(), less);
  std::size_t count = 0;
  while (count < std::min(this->Functions.size(), MaxFunctions) &&
    this->Functions[count].value <= this->Functions.front().value + Band)
  {
    ++count;
  }
  this->Functions.resize(count);
}

/// The step that maximizes the smallest linear function minus weight / 2 times its square: solves
/// the dual problem by exchanging the weights of two functions at a time.
Vec2 TriangleStar::solve(double weight)
{
  std::vector<Function>& f = this->Functions;
  for (Function& function : f)
  {
    function.weight = 0.0;
  }
  f.front().weight = 1.0;
  Vec2 step = (1.0 / weight) * f.front().gradient;
  for (int k = 0; k < Exchanges; ++k)
  {
    Function *low = nullptr, *high = nullptr;
    double lowest = std::numeric_limits<double>::max(), highest = -lowest;
    for (Function& function : f)
    {
      const double value = function.value + dot(function.gradient, step);
      if (value < lowest)
      {
        lowest = value;
        low = &function;
      }
      if (function.weight > 0.0 && value > highest)
      {
        highest = value;
        high = &function;
      }
    }
    const Vec2 difference = low->gradient - high->gradient;
    const double square = dot(difference, difference);
    if (low == high || highest - lowest < Balanced || !(square > 0.0))
    {
      break;
    }
    const double moved = std::min(high->weight, (highest - lowest) * weight / square);
    high->weight -= moved;
    low->weight += moved;
    step = step + (moved / weight) * difference;
  }
  return step;
}

double TriangleStar::maximize(
  Vec3& p, int steps, const Directions& directions, const std::function<Vec3(const Vec3&)>& project)
{
  const Vec3 up = directions.normal();
  double quality = this->evaluate(p, up);
  double length2 = std::numeric_limits<double>::max();
  for (const auto& [a, b] : this->Edges)
  {
    length2 = std::min(length2, dot(b - a, b - a));
  }
  double weight = FirstStepWeight;
  for (int accepted = 0; accepted < steps && length2 > 0.0; ++accepted)
  {
    this->linearize(p, directions);
    if (this->Functions.empty())
    {
      return quality;
    }
    bool moved = false;
    for (int trial = 0; trial < Trials && !moved; ++trial)
    {
      const Vec2 step = this->solve(weight / length2);
      Vec3 trialPoint = p + step[0] * directions.first;
      if (directions.count > 1)
      {
        trialPoint = trialPoint + step[1] * directions.second;
      }
      double trialQuality = this->evaluate(trialPoint, up);
      moved = trialQuality > quality + this->leastGain;
      if (project && moved) // a step without gain in the plane hardly gains off it
      {
        trialPoint = project(trialPoint);
        trialQuality = this->evaluate(trialPoint, up);
        moved = trialQuality > quality + this->leastGain;
      }
      if (moved)
      {
        p = trialPoint;
        quality = trialQuality;
      }
      weight *= moved ? Softer : Harder;
    }
    if (!moved)
    {
      break;
    }
  }
  return quality;
}
}
