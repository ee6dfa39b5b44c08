// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Anchors.h
 * @brief Mesh deformation by plain formulas, which the benchmark puts beside the methods of the
 * kernel: dense systems, or sums over all prescribed points.
 */
#ifndef tautline_Anchors_h
#define tautline_Anchors_h

#include "tautline/Deformation/WarpWalls.h"

#include <algorithm>
#include <functional>

namespace tautline
{
/// The points after the boundary has moved by the displacements, 3 each.
using Anchor = std::vector<double> (*)(const Mesh& mesh, const std::vector<double>& motion);

/// Solves a x = b for several right-hand sides, the last columns of the rows; partial pivoting.
inline void eliminate(std::vector<std::vector<double>>& rows)
{
  const std::size_t n = rows.size();
  for (std::size_t k = 0; k < n; ++k)
  {
    const auto larger = [k](const std::vector<double>& a, const std::vector<double>& b)
    { return std::abs(a[k]) < std::abs(b[k]); };
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(k);
    std::iter_swap(first, std::max_element(first, rows.end(), larger));
    const std::vector<double>& pivot = rows[k];
    for (std::size_t i = k + 1; i < n; ++i)
    {
      const double factor = rows[i][k] / pivot[k];
      for (std::size_t j = k; j < pivot.size(); ++j)
      {
        rows[i][j] -= factor * pivot[j];
      }
    }
  }
  for (std::size_t k = n; k-- > 0;)
  {
    for (std::size_t j = n; j < rows[k].size(); ++j)
    {
      for (std::size_t i = k + 1; i < n; ++i)
      {
        rows[k][j] -= rows[k][i] * rows[i][j];
      }
      rows[k][j] /= rows[k][k];
    }
  }
}

/// The common parts of the anchors.
struct AnchorProblem
{
  AnchorProblem(const Mesh& mesh, const std::vector<double>& given)
    : input(mesh)
    , motion(given)
    , moved(mesh.view().points, mesh.view().points + given.size())
  {
    const std::vector<char> flags = mesh.boundary().isBoundaryPoint;
    this->prescribed.assign(flags.begin(), flags.end());
    for (Index i = 0; i < mesh.view().numberOfPoints; ++i)
    {
      (flags[i] ? this->sources : this->free).push_back(i);
      this->move(i, flags[i] ? this->given(i) : Vec3{ 0, 0, 0 });
    }
  }
  Vec3 place(Index i) const { return pointOf(this->input.view(), i); }
  Vec3 given(Index i) const
  {
    return { this->motion[3 * i], this->motion[3 * i + 1], this->motion[3 * i + 2] };
  }
  void move(Index i, const Vec3& d)
  {
    for (Index c = 0; c < 3; ++c)
    {
      this->moved[3 * i + c] += d[c];
    }
  }

  const Mesh& input;
  const std::vector<double>& motion;
  std::vector<double> moved;
  std::vector<unsigned char> prescribed;
  std::vector<Index> sources, free;
};

/// Interpolation of all prescribed points by a radial function, with the first polynomial terms 1,
/// x, y, z.
inline std::vector<double> interpolate(
  AnchorProblem& problem, const std::function<double(double)>& function, std::size_t terms)
{
  const std::size_t n = problem.sources.size(), size = n + terms;
  const auto term = [](const Vec3& p, std::size_t k) { return k == 0 ? 1.0 : p[k - 1]; };
  std::vector<std::vector<double>> rows(size, std::vector<double>(size + 3, 0.0));
  for (std::size_t i = 0; i < n; ++i)
  {
    const Vec3 p = problem.place(problem.sources[i]), d = problem.given(problem.sources[i]);
    for (std::size_t j = 0; j < n; ++j)
    {
      rows[i][j] = function(norm(p - problem.place(problem.sources[j])));
    }
    for (std::size_t k = 0; k < terms; ++k)
    {
      rows[i][n + k] = rows[n + k][i] = term(p, k);
    }
    std::copy(d.begin(), d.end(), rows[i].end() - 3);
  }
  eliminate(rows);
  for (const Index free : problem.free)
  {
    const Vec3 p = problem.place(free);
    Vec3 sum = { 0, 0, 0 };
    for (std::size_t j = 0; j < size; ++j)
    {
      const double value =
        j < n ? function(norm(p - problem.place(problem.sources[j]))) : term(p, j - n);
      sum += value * Vec3{ rows[j][size], rows[j][size + 1], rows[j][size + 2] };
    }
    problem.move(free, sum);
  }
  return problem.moved;
}

/// Thin plate splines with an affine part: r^2 log r in the plane z = 0, r in space.
inline std::vector<double> thinPlateSplines(const Mesh& mesh, const std::vector<double>& motion)
{
  AnchorProblem problem(mesh, motion);
  const bool flat = mesh.dimension() == Dimension::Planar;
  return interpolate(
    problem, [flat](double r) { return !flat ? r
                                  : r > 0    ? r * r * std::log(r)
                                             : 0.0; },
    flat ? 3 : 4);
}

/// Wendland's C2 function with twice the extent of the mesh as radius.
inline std::vector<double> wendlandFunctions(const Mesh& mesh, const std::vector<double>& motion)
{
  AnchorProblem problem(mesh, motion);
  Vec3 low = problem.place(0), high = low;
  for (const Index i : problem.sources)
  {
    const Vec3 p = problem.place(i);
    for (std::size_t c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
  const double radius = 2 * norm(high - low);
  return interpolate(
    problem,
    [radius](double r)
    {
      const double rest = std::max(0.0, 1 - r / radius);
      return rest * rest * rest * rest * (4 * r / radius + 1);
    },
    0);
}

/// The weights of IDWarp by its default parameters (N. Secco et al., "Efficient mesh generation and
/// deformation for aerodynamic shape optimization", AIAA Journal 59, 2021): area times (L / d)^3 +
/// (0.25 L / d)^5, with the rotations of wallPoints().
inline std::vector<double> idwarpFormula(const Mesh& mesh, const std::vector<double>& motion)
{
  constexpr double alpha = 0.25;
  AnchorProblem problem(mesh, motion);
  const std::vector<WallPoint> walls = wallPoints(mesh, problem.prescribed, motion.data());
  Vec3 middle = { 0, 0, 0 };
  for (const Index i : problem.sources)
  {
    middle += (1 / static_cast<double>(problem.sources.size())) * problem.place(i);
  }
  double size = 0;
  for (const Index i : problem.sources)
  {
    size = std::max(size, norm(problem.place(i) - middle));
  }
  for (const Index free : problem.free)
  {
    const Vec3 p = problem.place(free);
    double weights = 0;
    Vec3 sum = { 0, 0, 0 };
    for (const Index i : problem.sources)
    {
      const Vec3 r = p - problem.place(i);
      const double far = size / norm(r), near = alpha * far, square = near * near;
      const double weight = walls[i].area * (far * far * far + square * square * near);
      Vec3 rigid = problem.given(i) - r;
      for (std::size_t k = 0; k < 3; ++k)
      {
        rigid += r[k] * walls[i].turn[k];
      }
      weights += weight;
      sum += weight * rigid;
    }
    problem.move(free, (1 / weights) * sum);
  }
  return problem.moved;
}
}
#endif
