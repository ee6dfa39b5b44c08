// SPDX-License-Identifier: BSD-3-Clause
#include "WarpPointwise.h"

#include "WarpBatches.h"
#include "tautline/Core/Memory.h"
#include "tautline/Geometry/PointTree.h"

#include <algorithm>
#include <functional>

namespace tautline
{
namespace
{
/// The default radius of the functions, in extents of the prescribed points.
constexpr double DefaultRadius = 2.0;
/// Points are chosen among this many evenly spread ones and the points with the largest residuals.
constexpr std::size_t FirstCandidates = 4000;
constexpr std::size_t MoreCandidates = 1000; ///< each time
/// The maximum number of chosen points: their matrix is dense.
constexpr std::size_t MaxCenters = 3000;
/// A candidate within this (squared) distance of the span of the chosen ones adds only rounding
/// errors.
constexpr double Independence = 1e-12;
/// Residuals within this of each other, relatively, are equal up to rounding.
constexpr double Tie = 1e-9;
/// At most this many ties are chosen together: the images of a point by the symmetries of a cube.
constexpr std::size_t MaxTied = 48;
constexpr std::size_t RadialBasisLeafSize = 32;
/// The number of products from which a choice uses several threads.
constexpr Index ParallelWork = 200000;
constexpr Index ProductsPerChunk = 30000; ///< of such a choice
/// The number of chosen points between two checks of the limits.
constexpr std::size_t ClockInterval = 16;

/// The ratio of a residual to its tolerance, which may be 0; above 1 if the residual is too large.
double relativeTo(double tolerance, double residual)
{
  return residual / std::max(tolerance, std::numeric_limits<double>::min());
}

/// Wendland's C2 function of the distance over the radius.
double wendland(double ratio)
{
  const double rest = std::max(0.0, 1.0 - ratio), square = rest * rest;
  return square * square * (4.0 * ratio + 1.0);
}

/**
 * @brief Chooses centers among candidates, always at the largest residual.
 *
 * Row i of the basis holds, for candidate i, the values of Newton's basis of the functions chosen:
 * columns of a Cholesky factor that grows with the pivot. A choice costs one product with each row.
 */
class GreedyFit
{
public:
  GreedyFit(double radius, int threads)
    : Radius(radius)
    , Threads(threads)
  {
  }

  /// @param tolerance of the residual at this point
  void add(const Vec3& point, const Vec3& value, double tolerance)
  {
    this->Points.push_back(point);
    this->Tolerances.push_back(tolerance);
    this->Residuals.push_back(value);
    this->Powers.push_back(1.0);
    this->Rows.emplace_back();
  }

  /// Extends the rows of newly added candidates to the current length.
  void catchUp(std::size_t from)
  {
    const auto count = static_cast<Index>(this->Points.size());
    constexpr Index grain = 16;
    parallelFor(count - static_cast<Index>(from), grain, this->Threads,
      [&](Index i)
      {
        for (std::size_t k = 0; k < this->Chosen.size(); ++k)
        {
          this->append(from + static_cast<std::size_t>(i), k);
        }
      });
  }

  /// Chooses until all residuals are within their tolerances; false if the control stopped it.
  bool choose(WarpControl& control)
  {
    for (std::vector<std::size_t> next = this->worst();
         !next.empty() && this->Chosen.size() < MaxCenters; next = this->worst())
    {
      for (const std::size_t i : next)
      {
        if (this->Powers[i] <= Independence || this->Chosen.size() == MaxCenters)
        {
          continue;
        }
        if (this->Chosen.size() % ClockInterval == 0 &&
          !control.watch(0.5 * static_cast<double>(this->Chosen.size()) / MaxCenters))
        {
          return false;
        }
        this->take(i);
      }
    }
    return true;
  }

  std::size_t chosen() const { return this->Chosen.size(); }
  const Vec3& center(std::size_t k) const { return this->Points[this->Chosen[k]]; }

  /// The coefficients of the functions: back substitution with the transposed factor.
  std::vector<Vec3> coefficients() const
  {
    std::vector<Vec3> result = this->Weights;
    for (std::size_t k = result.size(); k-- > 0;)
    {
      const std::vector<double>& row = this->Rows[this->Chosen[k]];
      result[k] = (1 / this->Pivots[k]) * result[k];
      for (std::size_t j = 0; j < k; ++j)
      {
        result[j] -= row[j] * result[k];
      }
    }
    return result;
  }

private:
  /// The candidates with the largest residual over its tolerance: all that tie up to rounding, such
  /// as images under a symmetry, or the first if there are too many; none if all are within
  /// tolerance.
  std::vector<std::size_t> worst() const
  {
    std::vector<double> sizes(this->Points.size(), 0.0);
    double most = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      const double size = relativeTo(this->Tolerances[i], norm(this->Residuals[i]));
      if (size > 1 && this->Powers[i] > Independence)
      {
        sizes[i] = size;
        most = std::max(most, size);
      }
    }
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < sizes.size() && most > 0; ++i)
    {
      if (sizes[i] >= (1 - Tie) * most)
      {
        result.push_back(i);
      }
    }
    result.resize(result.size() > MaxTied ? 1 : result.size());
    return result;
  }

  /// Adds a candidate as the next center.
  void take(std::size_t candidate)
  {
    const std::size_t k = this->Chosen.size();
    const double pivot = std::sqrt(this->Powers[candidate]);
    this->Chosen.push_back(candidate);
    this->Pivots.push_back(pivot);
    this->Weights.push_back((1 / pivot) * this->Residuals[candidate]);
    const auto count = static_cast<Index>(this->Points.size());
    const bool worthIt = count * static_cast<Index>(k) > ParallelWork;
    const Index grain = 1 + ProductsPerChunk / (1 + static_cast<Index>(k));
    // Its own row last: the others read it.
    parallelFor(count, grain, worthIt ? this->Threads : 1,
      [&](Index i)
      {
        if (static_cast<std::size_t>(i) != candidate)
        {
          this->append(static_cast<std::size_t>(i), k);
        }
      });
    this->append(candidate, k);
  }

private:
  /// Computes the value of basis function k at candidate i, and updates the residual there.
  void append(std::size_t i, std::size_t k)
  {
    const std::size_t at = this->Chosen[k];
    std::vector<double>& row = this->Rows[i];
    const std::vector<double>& pivotRow = this->Rows[at];
    double value = wendland(norm(this->Points[i] - this->Points[at]) / this->Radius);
    double sums[8] = {};
    std::size_t j = 0;
    for (; j + 8 <= k; j += 8)
    {
      for (std::size_t l = 0; l < 8; ++l)
      {
        sums[l] += row[j + l] * pivotRow[j + l];
      }
    }
    for (; j < k; ++j)
    {
      value -= row[j] * pivotRow[j];
    }
    for (const double sum : sums)
    {
      value -= sum;
    }
    value /= this->Pivots[k];
    row.push_back(value);
    this->Residuals[i] -= value * this->Weights[k];
    this->Powers[i] -= value * value;
  }

  double Radius;
  int Threads;
  std::vector<Vec3> Points, Residuals;
  std::vector<double> Tolerances;
  std::vector<double> Powers; ///< squared distance of a candidate's function from the span
  std::vector<std::vector<double>> Rows;
  std::vector<std::size_t> Chosen; ///< candidates
  std::vector<double> Pivots;
  std::vector<Vec3> Weights; ///< of Newton's basis
};

/// The sum of the functions, evaluated over the centers within the radius.
class Interpolant
{
public:
  Interpolant(const GreedyFit& fit, double radius)
    : Radius(radius)
    , Tree(centers(fit), RadialBasisLeafSize)
  {
    const std::vector<Vec3> coefficients = fit.coefficients();
    for (const std::size_t k : this->Tree.order())
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        this->Centers[c].push_back(fit.center(k)[c]);
        this->Coefficients[c].push_back(coefficients[k][c]);
      }
    }
  }

  Vec3 at(const Vec3& y) const
  {
    const std::vector<PointTree::Node>& nodes = this->Tree.nodes();
    Vec3 sum = { 0, 0, 0 };
    for (std::size_t n = 0; n < nodes.size();)
    {
      const PointTree::Node& node = nodes[n];
      const double distance = norm(y - node.center);
      const bool beyond = distance - node.radius >= this->Radius;
      if (!beyond && !node.leaf && distance + node.radius > this->Radius)
      {
        ++n; // some may be within the radius
        continue;
      }
      if (!beyond)
      {
        this->add(node.begin, node.end, y, sum);
      }
      n = node.next;
    }
    return sum;
  }

private:
  static std::vector<Vec3> centers(const GreedyFit& fit)
  {
    std::vector<Vec3> points(fit.chosen());
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      points[k] = fit.center(k);
    }
    return points;
  }

  void add(std::size_t begin, std::size_t end, const Vec3& y, Vec3& sum) const
  {
    const double *x0 = this->Centers[0].data(), *x1 = this->Centers[1].data(),
                 *x2 = this->Centers[2].data(), *c0 = this->Coefficients[0].data(),
                 *c1 = this->Coefficients[1].data(), *c2 = this->Coefficients[2].data();
    const double inverse = 1 / this->Radius;
    double s0 = 0, s1 = 0, s2 = 0;
#pragma omp simd reduction(+ : s0, s1, s2)
    for (std::size_t k = begin; k < end; ++k)
    {
      const double d0 = y[0] - x0[k], d1 = y[1] - x1[k], d2 = y[2] - x2[k];
      const double f = wendland(inverse * std::sqrt(d0 * d0 + d1 * d1 + d2 * d2));
      s0 += f * c0[k];
      s1 += f * c1[k];
      s2 += f * c2[k];
    }
    sum += { s0, s1, s2 };
  }

  double Radius;
  PointTree Tree;
  std::array<std::vector<double>, 3> Centers, Coefficients; ///< in the order of the tree
};

/// Keeps the points with the largest errors; more than MoreCandidates in case of ties.
void keepWorst(const std::vector<double>& errors, std::vector<std::size_t>& missed)
{
  std::vector<double> sizes;
  for (const std::size_t i : missed)
  {
    sizes.push_back(errors[i]);
  }
  const auto last = sizes.begin() + (MoreCandidates - 1);
  std::nth_element(sizes.begin(), last, sizes.end(), std::greater<>());
  const double least = (1 - Tie) * *last;
  missed.erase(
    std::remove_if(missed.begin(), missed.end(), [&](std::size_t i) { return errors[i] < least; }),
    missed.end());
  missed.resize(std::min(missed.size(), 2 * MoreCandidates));
}

/**
 * @brief Chooses centers until every prescribed point is fitted. The first candidates are evenly
 * spread; each further round adds the points with the largest residuals, in the order of
 * prescribed(). A residual is small enough if it is below the fit tolerance times the height of the
 * cells there.
 * @return false if the control stopped it
 */
bool fitGreedily(
  const PrescribedMotion& motion, double radius, WarpControl& control, GreedyFit& fit)
{
  const std::vector<Index>& all = motion.prescribed();
  const std::size_t stride = (all.size() + FirstCandidates - 1) / FirstCandidates;
  std::vector<double> tolerances(all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    // Points outside all cells have no height: their tolerance is relative to the largest
    // displacement.
    tolerances[i] =
      control.options().fitTolerance * std::min(motion.wall(i).height, motion.largest());
  }
  std::vector<char> isCandidate(all.size(), 0);
  std::size_t candidates = 0;
  const auto add = [&](std::size_t i)
  {
    isCandidate[i] = 1;
    fit.add(motion.local(all[i]), motion.rest(i), tolerances[i]);
    ++candidates;
  };
  for (std::size_t i = 0; i < all.size(); i += stride)
  {
    add(i);
  }
  const auto require = [](std::size_t more)
  {
    requireMemory(static_cast<double>(more * MaxCenters * sizeof(double)),
      "the dense system of radial functions",
      "prescribe the motion of fewer points, or choose another method");
  };
  require(candidates);
  std::vector<double> errors(all.size());
  while (fit.choose(control))
  {
    if (candidates == all.size() || fit.chosen() >= MaxCenters)
    {
      return true;
    }
    const Interpolant interpolant(fit, radius);
    forEachChunk(static_cast<Index>(all.size()), control.options().threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          errors[i] = isCandidate[i]
            ? 0
            : relativeTo(
                tolerances[i], norm(motion.rest(i) - interpolant.at(motion.local(all[i]))));
        }
      });
    std::vector<std::size_t> missed;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      if (errors[i] > 1)
      {
        missed.push_back(i);
      }
    }
    if (missed.empty())
    {
      return true;
    }
    if (missed.size() > MoreCandidates)
    {
      keepWorst(errors, missed);
    }
    require(missed.size());
    const std::size_t from = candidates;
    for (const std::size_t i : missed)
    {
      add(i);
    }
    fit.catchUp(from);
  }
  return false;
}
}

//------------------------------------------------------------------------------
std::vector<double> warpByRadialBasis(const PrescribedMotion& motion, WarpControl& control)
{
  const WarpOptions& options = control.options();
  if (!(options.supportRadius >= 0 && std::isfinite(options.supportRadius)))
  {
    throw Error("the support radius is " + std::to_string(options.supportRadius) +
      "; it must be positive, or 0 for an automatic radius");
  }
  if (!(options.fitTolerance >= 0 && options.fitTolerance < 1))
  {
    throw Error("the tolerance of the fit is " + std::to_string(options.fitTolerance) +
      "; it must be at least 0 and below 1");
  }
  if (motion.affine())
  {
    return motion.displacements({});
  }
  const double radius =
    options.supportRadius > 0 ? options.supportRadius / motion.scale() : DefaultRadius;
  GreedyFit fit(radius, options.threads);
  if (!fitGreedily(motion, radius, control, fit))
  {
    return {};
  }
  const Interpolant interpolant(fit, radius);
  std::vector<Vec3> rest(motion.free().size(), Vec3{ 0, 0, 0 });
  const bool complete = forEachBatch(motion.free().size(), 0.5, control,
    [&](std::size_t i) { rest[i] = interpolant.at(motion.local(motion.free()[i])); });
  return complete ? motion.displacements(rest) : std::vector<double>();
}
}
