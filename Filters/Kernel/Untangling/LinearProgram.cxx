// SPDX-License-Identifier: BSD-3-Clause
#include "LinearProgram.h"

#include <cmath>
#include <cstdint>
#include <utility>

namespace tautline
{
namespace
{
/**
 * @brief Maximizes c . x over half-spaces and the box |x_k| <= limit[k]. The expected time is
 * linear in their number if their order is random.
 * @param count number of leading half-spaces to use; their normals have length 1 or 0
 * @param tolerance by which a half-space may be violated
 * @param x the maximizer, if there is one
 * @return whether there is a feasible point
 */
template <int K>
bool maximize(const std::array<double, K>& c, const std::vector<HalfSpace<K>>& spaces,
  std::size_t count, const std::array<double, K>& limit, double tolerance,
  std::array<double, K>& x);

/// The program with one variable: an interval.
bool maximizeOnLine(const std::array<double, 1>& c, const std::vector<HalfSpace<1>>& spaces,
  std::size_t count, const std::array<double, 1>& limit, double tolerance, std::array<double, 1>& x)
{
  double low = -limit[0], high = limit[0];
  for (std::size_t i = 0; i < count; ++i)
  {
    const double a = spaces[i].a[0], b = spaces[i].b;
    if (a > 0)
    {
      high = std::min(high, b / a);
    }
    else if (a < 0)
    {
      low = std::max(low, b / a);
    }
    else if (b < -tolerance)
    {
      return false;
    }
  }
  x[0] = c[0] >= 0 ? high : low;
  return low <= high + tolerance;
}

/// The half-space a . x <= b in the plane h.a . x = h.b, from which x[pivot] is eliminated.
template <int K>
HalfSpace<K - 1> restrictToPlane(
  const std::array<double, K>& a, double b, const HalfSpace<K>& h, int pivot)
{
  HalfSpace<K - 1> r;
  const double over = 1.0 / h.a[pivot];
  const double factor = a[pivot] * over;
  double length = 0;
  for (int k = 0, j = 0; k < K; ++k)
  {
    if (k != pivot)
    {
      r.a[j] = a[k] - factor * h.a[k];
      length += r.a[j] * r.a[j];
      ++j;
    }
  }
  r.b = b - factor * h.b;
  constexpr double parallel = 1e-12;
  length = std::sqrt(length);
  if (length > parallel)
  {
    for (double& v : r.a)
    {
      v /= length;
    }
    r.b /= length;
  }
  else
  {
    r.a.fill(0.0);
  }
  return r;
}

/// Solves the program of the first `count` half-spaces in the plane h, which has one variable less.
template <int K>
bool maximizeOnPlane(const std::array<double, K>& c, const std::vector<HalfSpace<K>>& spaces,
  std::size_t count, const std::array<double, K>& limit, double tolerance, const HalfSpace<K>& h,
  int pivot, std::vector<HalfSpace<K - 1>>& reduced, std::array<double, K>& x)
{
  const double over = 1.0 / h.a[pivot];
  reduced.clear();
  for (std::size_t j = 0; j < count; ++j)
  {
    reduced.push_back(restrictToPlane<K>(spaces[j].a, spaces[j].b, h, pivot));
  }
  // The limits of the eliminated variable also become half-spaces.
  std::array<double, K> side{};
  side[pivot] = 1;
  reduced.push_back(restrictToPlane<K>(side, limit[pivot], h, pivot));
  side[pivot] = -1;
  reduced.push_back(restrictToPlane<K>(side, limit[pivot], h, pivot));
  std::array<double, K - 1> c1, limit1, x1;
  for (int k = 0, j = 0; k < K; ++k)
  {
    if (k != pivot)
    {
      c1[j] = c[k] - c[pivot] * over * h.a[k];
      limit1[j++] = limit[k];
    }
  }
  if (!maximize<K - 1>(c1, reduced, reduced.size(), limit1, tolerance, x1))
  {
    return false;
  }
  double rest = h.b;
  for (int k = 0, j = 0; k < K; ++k)
  {
    if (k != pivot)
    {
      x[k] = x1[j++];
      rest -= h.a[k] * x[k];
    }
  }
  x[pivot] = rest * over;
  return true;
}

//------------------------------------------------------------------------------
template <int K>
bool maximize(const std::array<double, K>& c, const std::vector<HalfSpace<K>>& spaces,
  std::size_t count, const std::array<double, K>& limit, double tolerance, std::array<double, K>& x)
{
  if constexpr (K == 1)
  {
    return maximizeOnLine(c, spaces, count, limit, tolerance, x);
  }
  else
  {
    for (int k = 0; k < K; ++k)
    {
      x[k] = c[k] >= 0 ? limit[k] : -limit[k];
    }
    std::vector<HalfSpace<K - 1>> reduced;
    for (std::size_t i = 0; i < count; ++i)
    {
      const HalfSpace<K>& h = spaces[i];
      double value = -h.b;
      int pivot = 0;
      for (int k = 0; k < K; ++k)
      {
        value += h.a[k] * x[k];
        pivot = std::abs(h.a[k]) > std::abs(h.a[pivot]) ? k : pivot;
      }
      if (value <= tolerance)
      {
        continue;
      }
      // The optimum of the half-spaces so far lies on the plane of this one.
      if (h.a[pivot] == 0 ||
        !maximizeOnPlane<K>(c, spaces, i, limit, tolerance, h, pivot, reduced, x))
      {
        return false;
      }
    }
    return true;
  }
}
}

//------------------------------------------------------------------------------
template <int Dim>
double chebyshevCenter(
  const std::vector<HalfSpace<Dim>>& planes, double reach, std::array<double, Dim>& center)
{
  // The radius is an additional variable: a . x + r <= b, in units of the reach and with unit
  // normals.
  constexpr int K = Dim + 1;
  std::vector<HalfSpace<K>> spaces;
  spaces.reserve(planes.size());
  for (const HalfSpace<Dim>& plane : planes)
  {
    HalfSpace<K> h;
    std::copy(plane.a.begin(), plane.a.end(), h.a.begin());
    h.a[Dim] = 1.0;
    h.b = plane.b / reach;
    for (double& v : h.a)
    {
      v *= std::sqrt(0.5);
    }
    h.b *= std::sqrt(0.5);
    spaces.push_back(h);
  }
  // A random order makes the expected time linear; a fixed seed makes it reproducible.
  std::uint64_t state = 1;
  for (std::size_t i = spaces.size(); i > 1; --i)
  {
    state = state * 6364136223846793005u + 1442695040888963407u;
    std::swap(spaces[i - 1], spaces[(state >> 33) % i]);
  }
  std::array<double, K> c{}, limit, x{};
  c[Dim] = 1.0;
  limit.fill(1.0);
  // Large enough that some center violates no plane by more than this.
  double deepest = 1.0;
  for (const HalfSpace<K>& h : spaces)
  {
    deepest = std::max(deepest, 2.0 * std::abs(h.b) + Dim);
  }
  limit[Dim] = deepest;
  constexpr double tolerance = 1e-12;
  if (!maximize<K>(c, spaces, spaces.size(), limit, tolerance, x))
  {
    center.fill(0.0);
    return -deepest * reach;
  }
  for (int k = 0; k < Dim; ++k)
  {
    center[k] = reach * x[k];
  }
  return reach * x[Dim];
}

template double chebyshevCenter<2>(
  const std::vector<HalfSpace<2>>&, double, std::array<double, 2>&);
template double chebyshevCenter<3>(
  const std::vector<HalfSpace<3>>&, double, std::array<double, 3>&);
}
