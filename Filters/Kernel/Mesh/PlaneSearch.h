// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlaneSearch.h
 * @brief The plane that the 2D cells of a mesh lie in, of one mesh or of one in pieces on several
 * ranks. Internal: not installed.
 */
#ifndef tautline_PlaneSearch_h
#define tautline_PlaneSearch_h

#include "CellExtent.h"
#include "Mesh.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>

namespace tautline
{
/// Of one process: nothing is added to its sums and maxima.
struct OneProcessTotals
{
  double sum(double value) const { return value; }
  double maximum(double value) const { return value; }
};

/**
 * @class tautline::PlaneSearch
 * @brief Finds out whether the corners of cells lie in a plane. Points that are no corner, and
 * those that are not finite, do not count.
 * @tparam Corners calls visitor(p) for every corner of every cell that counts, see run()
 * @tparam Totals sum() and maximum() over all ranks
 */
template <class Corners, class Totals>
class PlaneSearch
{
public:
  PlaneSearch(const Corners& corners, Totals& totals)
    : ForEachCorner(corners)
    , All(totals)
  {
  }

  /// @param space of 2D cells; becomes Planar, with normal and frame, if there is a plane
  void run(MeshSpace& space);

private:
  /// A mesh is planar when no vertex leaves its plane by more than this fraction of the diagonal.
  static constexpr double tolerance = 1e-6;

  Vec3 leastExtent(const Vec3& middle, double diagonal, Vec3& center);

  const Corners& ForEachCorner;
  Totals& All;
};

//------------------------------------------------------------------------------
/// The principal direction in which the corners extend least, and their mean.
template <class Corners, class Totals>
Vec3 PlaneSearch<Corners, Totals>::leastExtent(const Vec3& middle, double diagonal, Vec3& center)
{
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Index number = 0;
  this->ForEachCorner(
    [&](const Vec3& p)
    {
      const Vec3 r = (1.0 / diagonal) * (p - middle);
      const Eigen::Vector3d v(r[0], r[1], r[2]);
      moments += v * v.transpose();
      sum += v;
      ++number;
    });
  for (int k = 0; k < moments.size(); ++k)
  {
    moments.data()[k] = this->All.sum(moments.data()[k]);
  }
  for (int k = 0; k < sum.size(); ++k)
  {
    sum[k] = this->All.sum(sum[k]);
  }
  const double count = this->All.sum(static_cast<double>(number));
  const Eigen::Vector3d mean = sum / count;
  moments = moments / count - mean * mean.transpose();
  const Eigen::Vector3d n =
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  center = middle + diagonal * Vec3{ mean[0], mean[1], mean[2] };
  return { n[0], n[1], n[2] };
}

//------------------------------------------------------------------------------
template <class Corners, class Totals>
void PlaneSearch<Corners, Totals>::run(MeshSpace& space)
{
  Vec3 low, high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(-std::numeric_limits<double>::max());
  this->ForEachCorner(
    [&](const Vec3& p)
    {
      for (int c = 0; c < 3; ++c)
      {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
    });
  for (int c = 0; c < 3; ++c)
  {
    low[c] = -this->All.maximum(-low[c]);
    high[c] = this->All.maximum(high[c]);
  }
  if (low[0] > high[0])
  {
    return;
  }
  const Vec3 extent = high - low;
  // Scaled by a power of two, so that squares neither overflow nor vanish.
  const double unit = unitOfExtent(std::max({ extent[0], extent[1], extent[2] }));
  const double diagonal = unit * norm((1 / unit) * extent);
  if (!(diagonal > 0) || !std::isfinite(diagonal))
  {
    return;
  }

  int axis = -1;
  for (int c = 0; c < 3; ++c)
  {
    // A plane at right angles to an axis is taken exactly, without rounding in the frame.
    if (extent[c] <= tolerance * diagonal)
    {
      axis = c;
    }
  }
  Vec3 normal = { 0, 0, 0 };
  if (axis >= 0)
  {
    normal[axis] = 1.0;
  }
  else
  {
    const Vec3 middle = 0.5 * (low + high);
    Vec3 center;
    normal = this->leastExtent(middle, diagonal, center);
    double farthest = 0.0;
    this->ForEachCorner(
      [&](const Vec3& p) { farthest = std::max(farthest, std::abs(dot(p - center, normal))); });
    if (this->All.maximum(farthest) > tolerance * diagonal)
    {
      return;
    }
  }

  int largest = 0;
  for (int c = 1; c < 3; ++c)
  {
    largest = std::abs(normal[c]) > std::abs(normal[largest]) ? c : largest;
  }
  if (normal[largest] < 0)
  {
    normal = -1.0 * normal;
  }
  Vec3 first = { 0, 0, 0 };
  first[(largest + 1) % 3] = 1.0;
  first -= dot(first, normal) * normal;
  first = (1.0 / norm(first)) * first;
  space.dimension = Dimension::Planar;
  space.normal = normal;
  space.frame = { first, cross(normal, first) };
}

/// Calls visit(p) for the finite nodes of the cells, once per cell.
/// @param skip one flag per cell: it does not count; may be null
template <class Visit>
void forEachFiniteCorner(const MeshView& view, const std::vector<CellBlock>& blocks,
  const unsigned char* skip, const Visit& visit)
{
  for (const CellBlock& block : blocks)
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      for (int k = 0; k < nodes && !(skip && skip[cell]); ++k)
      {
        const Vec3 p = pointOf(view, node[k]);
        if (std::isfinite(p[0] + p[1] + p[2]))
        {
          visit(p);
        }
      }
    }
  }
}
}
#endif
