// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Optimizing.h
 * @brief Meshes to be optimized, and checks of the result.
 */
#ifndef tautline_Optimizing_h
#define tautline_Optimizing_h

#include "Blocks.h"
#include "Check.h"

#include "tautline/Optimization/Optimize.h"

namespace tautline
{
/// The mean of points, 3 numbers each.
inline Vec3 centerOf(const std::vector<double>& points)
{
  Vec3 sum = { 0, 0, 0 };
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    sum[i % 3] += points[i];
  }
  return (3.0 / static_cast<double>(points.size())) * sum;
}

/// Inner points moved at random; the boundary is a regular block's. All cells are valid.
inline MeshData perturbedBlock(CellType type, Index n, double amplitude, unsigned seed = 7)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  Random random(seed);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 d = random.vector(-amplitude, amplitude);
    if (!boundary[i])
    {
      data.setPoint(i, data.point(i) + Vec3{ d[0], d[1], flat ? 0.0 : d[2] });
    }
  }
  return data;
}

inline Index invalid(const MeshData& like, const std::vector<double>& points)
{
  MeshData moved = TAUTLINE_CHANGED(like, points = points);
  const std::vector<signed char> v = validityOf(moved);
  return std::count_if(v.begin(), v.end(), [](signed char s) { return s != Valid; });
}

inline double sumOfSquares(const MeshData& like, const std::vector<double>& points, Metric metric)
{
  MeshData moved = TAUTLINE_CHANGED(like, points = points);
  return sumOf<double>(0, valuesOf(moved, metric), [&](double q) { return q * q; });
}

/// For the cells with a vertex that is not on the boundary.
inline double worstMovable(const MeshData& like, const std::vector<double>& points)
{
  MeshData moved = TAUTLINE_CHANGED(like, points = points);
  const std::vector<char> boundary = Mesh(like.view()).boundary().isBoundaryPoint;
  const std::vector<double> q = valuesOf(moved, Metric::InverseMeanRatio);
  double worst = 0;
  for (Index c = 0; c < moved.numberOfCells(); ++c)
  {
    for (Index n = moved.offsets[c]; n < moved.offsets[c + 1]; ++n)
    {
      worst = boundary[moved.connectivity[n]] ? worst : std::max(worst, q[c]);
    }
  }
  return worst;
}

inline OptimizeResult run(const MeshData& data, const OptimizeOptions& options)
{
  return optimize(Mesh(data.view()), options);
}

/**
 * A smooth wave, which each sweep reduces by little steps of all vertices, and far from it a vertex
 * that the first sweep moves a long way and that stays there: with a culling threshold of
 * QuickCulling, the second sweep visits that one only.
 */
inline MeshData waveAndQuickVertex()
{
  constexpr Index n = 12;
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  data.transform(
    [](const Vec3& p)
    {
      const double turn = 2 * std::acos(-1.0) / n;
      return Vec3{ p[0] + 0.4 * std::sin(turn * p[0]), p[1] + 0.4 * std::sin(turn * p[1]), 0 };
    });
  constexpr double away = 2 * n;
  const Index middle = data.addPoint({ away + 0.7, away, 0 });
  constexpr Index around = 6;
  for (Index k = 0; k < around; ++k)
  {
    const double angle = 2 * std::acos(-1.0) * static_cast<double>(k) / around;
    data.addPoint({ away + std::cos(angle), away + std::sin(angle), 0 });
  }
  for (Index k = 0; k < around; ++k)
  {
    data.addCell(CellType::Triangle,
      std::vector<Index>{ middle, middle + 1 + k, middle + 1 + (k + 1) % around });
  }
  return data;
}
constexpr double QuickCulling = 0.1;

/// Whether a sweep gained less than a fraction of the objective, and a later one more.
inline bool wentOn(const std::vector<IterationRecord>& history, double fraction)
{
  bool little = false, more = false;
  for (std::size_t i = 1; i < history.size(); ++i)
  {
    const double gain = 1 - history[i].objective / history[i - 1].objective;
    more = more || (little && gain > fraction);
    little = little || gain < fraction;
  }
  return more;
}

/// How much one more sweep over all vertices lowers the objective, relative to it.
inline double nextGain(const MeshData& like, const std::vector<double>& points)
{
  MeshData moved = TAUTLINE_CHANGED(like, points = points);
  TAUTLINE_LET(OptimizeOptions, options, optimizer = Optimizer::LocalNewton,
    stopping.maximumIterations = 1, relaxation = 1, holdWorst = false);
  const OptimizeResult result = optimize(Mesh(moved.view()), options);
  return 1 - result.history.back().objective / result.history.front().objective;
}

/// A history whose objective never rises and agrees with the metric at the points.
inline void checkHistory(const MeshData& data, const OptimizeResult& result)
{
  for (std::size_t i = 1; i < result.history.size(); ++i)
  {
    TAUTLINE_CHECK(result.history[i].objective <= result.history[i - 1].objective * (1 + 1e-12));
    TAUTLINE_CHECK_EQUAL(result.history[i].iteration, static_cast<int>(i));
  }
  TAUTLINE_CHECK_EQUAL(result.iterations, static_cast<int>(result.history.size()) - 1);
  TAUTLINE_CHECK_RELATIVE(sumOfSquares(data, result.points, Metric::InverseMeanRatio),
    result.history.back().objective, 1e-10);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, invalid(data, result.points));
}
}
#endif
