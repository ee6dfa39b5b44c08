/**
 * @file LinearProgram.h
 * @brief Linear programs in a few variables (R. Seidel, "Small-dimensional linear programming and
 * convex hulls made easy", Discrete Comput. Geom. 6, 1991), and the widest place between
 * half-spaces. Internal: not installed.
 */
#ifndef tautline_LinearProgram_h
#define tautline_LinearProgram_h

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace tautline
{
/// a . x <= b
template <int K>
struct HalfSpace
{
  std::array<double, K> a;
  double b;
};

/**
 * @brief Maximises c . x over the half-spaces and the box |x_k| <= limit[k].
 * @param tolerance by which a half-space of unit normal may be violated
 * @return whether there is a feasible point
 */
template <int K>
bool maximize(const std::array<double, K>& c, const std::vector<HalfSpace<K>>& spaces,
  std::size_t count, const std::array<double, K>& limit, double tolerance, std::array<double, K>& x)
{
  if constexpr (K == 1)
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
      if (h.a[pivot] == 0)
      {
        return false;
      }
      // The optimum of the spaces up to here lies on the plane of this one: x[pivot] is eliminated.
      const double over = 1.0 / h.a[pivot];
      reduced.clear();
      const auto reduce = [&](const std::array<double, K>& a, double b)
      {
        HalfSpace<K - 1> r;
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
        reduced.push_back(r);
      };
      for (std::size_t j = 0; j < i; ++j)
      {
        reduce(spaces[j].a, spaces[j].b);
      }
      std::array<double, K> side{};
      side[pivot] = 1;
      reduce(side, limit[pivot]);
      side[pivot] = -1;
      reduce(side, limit[pivot]);
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
    }
    return true;
  }
}

/**
 * @brief The centre and radius of the largest ball between planes n . d <= b with unit normals,
 * within the ball's distance `reach` of the origin. A negative radius: no point satisfies all, by
 * so much.
 */
template <int Dim>
double widestPlace(
  const std::vector<HalfSpace<Dim>>& planes, double reach, std::array<double, Dim>& center)
{
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
  // A random order makes the expected time linear; a fixed seed makes it the same each time.
  std::uint64_t state = 1;
  for (std::size_t i = spaces.size(); i > 1; --i)
  {
    state = state * 6364136223846793005u + 1442695040888963407u;
    std::swap(spaces[i - 1], spaces[(state >> 33) % i]);
  }
  std::array<double, K> c{}, limit, x{};
  c[Dim] = 1.0;
  limit.fill(1.0);
  // Deep enough that some centre violates no plane by more.
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
}
#endif
