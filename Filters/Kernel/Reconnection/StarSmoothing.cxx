// SPDX-License-Identifier: BSD-3-Clause
#include "StarSmoothing.h"

namespace tautline
{
namespace
{
/// Functions within this of the smallest value are linearized.
constexpr double Window = 0.12;
/// A step is kept if it gains this fraction of the predicted gain.
constexpr double SufficientFraction = 0.1;
/// Weight of the square of a step (in units of the shortest edge) at the start, its bounds, and its
/// factors after a failure and a success.
constexpr double FirstWeight = 2.0, LastWeight = 200.0, Tighten = 4.0, Relax = 0.5;
/// The number of weight exchanges in the dual problem, and the gap at which it is solved.
constexpr int DualSteps = 24;
/// The number of exchanges before a step without the minimum gain is treated as convergence.
constexpr int LastDualSteps = 60;
constexpr double DualGap = 5e-4;
}

bool StarSmoothing::addFace(const Vec3& a, const Vec3& b, const Vec3& c)
{
  if (this->Size == MaxFaces)
  {
    return false;
  }
  const int i = this->Size++;
  if (this->weights.metric)
  {
    this->Faces[i] = { a, b, c };
  }
  const Vec3 ab = b - a, ac = c - a, bc = c - b, n = cross(ab, ac);
  for (int k = 0; k < 3; ++k)
  {
    this->Corners[k][i] = a[k];
    this->Corners[3 + k][i] = b[k];
    this->Corners[6 + k][i] = c[k];
    this->Normal[k][i] = n[k];
  }
  this->Normal[3][i] = dot(n, n);
  const double e[3] = { dot(ab, ab), dot(bc, bc), dot(ac, ac) };
  for (int k = 0; k < 3; ++k)
  {
    this->Edges[k][i] = e[k];
  }
  this->Edges[3][i] = e[0] + e[1] + e[2];
  const double shortest = std::min(e[0], std::min(e[1], e[2]));
  this->Length2 = i == 0 ? shortest : std::min(this->Length2, shortest);
  return true;
}

double StarSmoothing::evaluate(const Vec3& p)
{
  double smallest = 1.0;
  const int n = this->Size;
  if (this->weights.metric)
  {
    this->weights.metric->evaluate(p, this->Faces.data(), n, this->Values, nullptr);
    return n > 0 ? std::min(smallest, *std::min_element(this->Values, this->Values + n)) : smallest;
  }
  const double px = p[0], py = p[1], pz = p[2];
  const double sineWeight = this->weights.sine,
               ratioFactor = this->weights.meanRatio * MeanRatioFactor;
#pragma omp simd reduction(min : smallest)
  for (int i = 0; i < n; ++i)
  {
    const double ux = this->Corners[0][i] - px, uy = this->Corners[1][i] - py,
                 uz = this->Corners[2][i] - pz;
    const double vx = this->Corners[3][i] - px, vy = this->Corners[4][i] - py,
                 vz = this->Corners[5][i] - pz;
    const double wx = this->Corners[6][i] - px, wy = this->Corners[7][i] - py,
                 wz = this->Corners[8][i] - pz;
    const double ax = vy * wz - vz * wy, ay = vz * wx - vx * wz, az = vx * wy - vy * wx;
    const double bx = wy * uz - wz * uy, by = wz * ux - wx * uz, bz = wx * uy - wy * ux;
    const double cx = uy * vz - uz * vy, cy = uz * vx - ux * vz, cz = ux * vy - uy * vx;
    const double a2 = ax * ax + ay * ay + az * az, b2 = bx * bx + by * by + bz * bz,
                 c2 = cx * cx + cy * cy + cz * cz, o2 = this->Normal[3][i];
    const double u2 = ux * ux + uy * uy + uz * uz, v2 = vx * vx + vy * vy + vz * vz,
                 w2 = wx * wx + wy * wy + wz * wz;
    const double d = ux * ax + uy * ay + uz * az;
    const double sum = u2 + v2 + w2 + this->Edges[3][i];
    // A sine is d l / (|n1| |n2|) with the normals at the edge: due to the common denominator, one
    // square root serves all six.
    double s = u2 * a2 * o2;
    s = std::min(s, v2 * b2 * o2);
    s = std::min(s, w2 * c2 * o2);
    s = std::min(s, this->Edges[0][i] * a2 * b2);
    s = std::min(s, this->Edges[1][i] * b2 * c2);
    s = std::min(s, this->Edges[2][i] * c2 * a2);
    const double factor = std::min(sineWeight * std::sqrt(s / std::max(a2 * b2 * c2 * o2, 1e-300)),
      ratioFactor / (sum * std::sqrt(sum)));
    const double q = d * factor;
    this->Values[i] = q;
    smallest = std::min(smallest, q);
  }
  return smallest;
}

/// Values and gradients of the functions below a bound, with lengths in units of sqrt(Length2).
void StarSmoothing::linearize(const Vec3& p, double below)
{
  this->Functions = 0;
  const double unit = std::sqrt(this->Length2);
  if (this->weights.metric)
  {
    std::array<Vec3, MaxFaces> gradients;
    this->weights.metric->evaluate(
      p, this->Faces.data(), this->Size, this->Values, gradients.data());
    for (int i = 0; i < this->Size && this->Functions < MaxFunctions; ++i)
    {
      if (this->Values[i] < below)
      {
        this->F[this->Functions] = this->Values[i];
        this->G[this->Functions++] = unit * gradients[i];
      }
    }
    return;
  }
  for (int i = 0; i < this->Size; ++i)
  {
    if (!(this->Values[i] < below))
    {
      continue;
    }
    const auto corner = [&](int k)
    {
      return Vec3{ this->Corners[3 * k][i], this->Corners[3 * k + 1][i],
        this->Corners[3 * k + 2][i] };
    };
    const Vec3 a = corner(0), b = corner(1), c = corner(2);
    const Vec3 u = a - p, v = b - p, w = c - p;
    const Vec3 na = cross(v, w), nb = cross(w, u), nc = cross(u, v);
    const Vec3 n0 = { this->Normal[0][i], this->Normal[1][i], this->Normal[2][i] };
    const double a2 = dot(na, na), b2 = dot(nb, nb), c2 = dot(nc, nc), o2 = this->Normal[3][i];
    const double u2 = dot(u, u), v2 = dot(v, v), w2 = dot(w, w), d = dot(u, na);
    const double sum = u2 + v2 + w2 + this->Edges[3][i];
    // Gradients of the logarithms of d and of the lengths of the normals.
    const Vec3 gd = (-1.0 / d) * n0;
    const Vec3 ga = (1.0 / a2) * cross(b - c, na), gb = (1.0 / b2) * cross(c - a, nb),
               gc = (1.0 / c2) * cross(a - b, nc);
    const auto add = [&](double value, const Vec3& logGradient)
    {
      if (value < below && this->Functions < MaxFunctions)
      {
        this->F[this->Functions] = value;
        this->G[this->Functions++] = (value * unit) * logGradient;
      }
    };
    // Each function is added separately: their minimum is not smooth where several are equal.
    const double ds = this->weights.sine * d;
    add(this->weights.meanRatio * MeanRatioFactor * d / (sum * std::sqrt(sum)),
      gd + (3.0 / sum) * (u + v + w));
    add(ds * std::sqrt(u2 / (b2 * c2)), gd - (1.0 / u2) * u - gb - gc);
    add(ds * std::sqrt(v2 / (c2 * a2)), gd - (1.0 / v2) * v - gc - ga);
    add(ds * std::sqrt(w2 / (a2 * b2)), gd - (1.0 / w2) * w - ga - gb);
    add(ds * std::sqrt(this->Edges[0][i] / (c2 * o2)), gd - gc);
    add(ds * std::sqrt(this->Edges[1][i] / (a2 * o2)), gd - ga);
    add(ds * std::sqrt(this->Edges[2][i] / (b2 * o2)), gd - gb);
  }
}

/// The step D that maximizes min(F + G . D) - weight / 2 |D|^2, from its dual: the convex
/// combination of the functions that is smallest at its own best step. Returns min(F + G . D). More
/// exchanges are made while this is below `wanted`: too few may miss an existing gain.
double StarSmoothing::solve(double weight, double wanted, Vec3& step)
{
  const int n = this->Functions;
  Vec3 sum = { 0, 0, 0 };
  double mean = 0.0; // of F
  for (int i = 0; i < n; ++i)
  {
    sum += this->Lambda[i] * this->G[i];
    mean += this->Lambda[i] * this->F[i];
  }
  double predicted = 0.0;
  for (int k = 0; k < DualSteps || (predicted < wanted && k < LastDualSteps); ++k)
  {
    // For fixed multipliers, the best step is the combined gradient divided by the weight.
    step = (1.0 / weight) * sum;
    int low = 0, high = -1;
    double lowest = 0.0, highest = 0.0;
    for (int i = 0; i < n; ++i)
    {
      const double c = this->F[i] + dot(this->G[i], step);
      if (i == 0 || c < lowest)
      {
        low = i;
        lowest = c;
      }
      if (this->Lambda[i] > 0.0 && (high < 0 || c > highest))
      {
        high = i;
        highest = c;
      }
    }
    predicted = lowest;
    const bool hopeless = k >= DualSteps && mean + dot(sum, step) < wanted;
    if (high < 0 || highest - lowest < DualGap || hopeless)
    {
      break;
    }
    // The dual function is quadratic along an exchange of two multipliers: its minimum is exact,
    // unless one multiplier reaches 0 before.
    const Vec3 difference = this->G[low] - this->G[high];
    const double curvature = dot(difference, difference) / weight;
    const double moved = curvature * this->Lambda[high] > highest - lowest
      ? (highest - lowest) / curvature
      : this->Lambda[high];
    this->Lambda[high] -= moved;
    this->Lambda[low] += moved;
    sum += moved * difference;
    mean += moved * (this->F[low] - this->F[high]);
  }
  return predicted;
}

double StarSmoothing::maximize(
  Vec3& p, int steps, const PointFreedom& freedom, const std::function<Vec3(const Vec3&)>& project)
{
  double smallest = this->evaluate(p);
  if (freedom.kind == PointFreedom::Fixed || !(smallest > 0.0))
  {
    return smallest;
  }
  const double unit = std::sqrt(this->Length2);
  double weight = FirstWeight;
  bool current = true; // Values are up to date at p
  for (int k = 0; k < steps && weight <= LastWeight; ++k)
  {
    this->linearize(p, smallest + Window);
    int low = 0;
    for (int i = 0; i < this->Functions; ++i)
    {
      // Components along which the point may not move must not contribute to the predicted gain.
      this->G[i] = freedom.project(this->G[i]);
      low = this->F[i] < this->F[low] ? i : low;
    }
    // The dual problem starts with the worst function alone.
    std::fill(this->Lambda, this->Lambda + this->Functions, 0.0);
    this->Lambda[low] = 1.0;
    bool moved = false;
    while (!moved && weight <= LastWeight)
    {
      Vec3 step;
      const double gain = this->solve(weight, smallest + this->leastGain, step) - smallest;
      if (gain < this->leastGain)
      {
        weight = 2.0 * LastWeight; // converged
        break;
      }
      const Vec3 x = project ? project(p + unit * step) : p + unit * step;
      const double value = this->evaluate(x);
      moved = value > smallest + SufficientFraction * gain;
      current = moved;
      weight *= moved ? Relax : Tighten;
      if (moved)
      {
        p = x;
        smallest = value;
      }
    }
  }
  // A rejected last trial has overwritten the values.
  if (!current)
  {
    smallest = this->evaluate(p);
  }
  return smallest;
}
}
