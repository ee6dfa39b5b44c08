// SPDX-License-Identifier: BSD-3-Clause
// The plane of a mesh of 2D cells, also of one in pieces on ranks.
#include "CellExtent.h"
#include "RankPieces.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/**
 * @class PlaneSearch
 * @brief Determines whether the corners of cells lie in a plane. Other points and nonfinite points
 * are ignored.
 * @tparam Corners calls visitor(p) for every corner of every relevant cell, see run()
 */
template <class Corners>
class PlaneSearch
{
public:
  /// @param group ranks that each have a part of the corners; null: this process alone
  PlaneSearch(const Corners& corners, RankGroup* group)
    : ForEachCorner(corners)
    , Group(group)
  {
  }

  /// @param space the space of 2D cells; becomes Planar, with normal and frame, if there is a plane
  void run(MeshSpace& space);

private:
  /// A mesh is planar if no vertex is farther from its plane than this fraction of the diagonal.
  static constexpr double tolerance = 1e-6;

  Vec3 leastExtent(const Vec3& middle, double diagonal, Vec3& center);
  double sum(double value) const
  {
    return this->Group ? this->Group->orderlessSum({ value }) : value;
  }
  double maximum(double value) const { return this->Group ? this->Group->maximum(value) : value; }

  const Corners& ForEachCorner;
  RankGroup* Group;
};

//------------------------------------------------------------------------------
/// The principal direction in which the corners extend least, and their mean.
template <class Corners>
Vec3 PlaneSearch<Corners>::leastExtent(const Vec3& middle, double diagonal, Vec3& center)
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
    moments.data()[k] = this->sum(moments.data()[k]);
  }
  for (int k = 0; k < sum.size(); ++k)
  {
    sum[k] = this->sum(sum[k]);
  }
  const double count = this->sum(static_cast<double>(number));
  const Eigen::Vector3d mean = sum / count;
  moments = moments / count - mean * mean.transpose();
  const Eigen::Vector3d n =
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  center = middle + diagonal * Vec3{ mean[0], mean[1], mean[2] };
  return { n[0], n[1], n[2] };
}

//------------------------------------------------------------------------------
template <class Corners>
void PlaneSearch<Corners>::run(MeshSpace& space)
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
    low[c] = -this->maximum(-low[c]);
    high[c] = this->maximum(high[c]);
  }
  if (low[0] > high[0])
  {
    return;
  }
  const Vec3 extent = high - low;
  // Scaled by a power of two, so that squares neither overflow nor underflow.
  const double unit = unitOfExtent(std::max({ extent[0], extent[1], extent[2] }));
  const double diagonal = unit * norm((1 / unit) * extent);
  if (!(diagonal > 0) || !std::isfinite(diagonal))
  {
    return;
  }

  int axis = -1;
  for (int c = 0; c < 3; ++c)
  {
    // A plane perpendicular to an axis is represented exactly, without rounding in the frame.
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
    if (this->maximum(farthest) > tolerance * diagonal)
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
/// @param skip one flag per cell: nonzero to ignore it; may be null
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

/// Whether all points, which are finite, have the same third coordinate.
bool areLevel(const MeshView& view)
{
  const double level = view.numberOfPoints > 0 ? view.points[2] : 0.0;
  bool same = true;
  double sum = 0; // finite if all coordinates are; may also overflow for large coordinates
  for (Index p = 0; p < view.numberOfPoints && same; ++p)
  {
    const double* x = view.points + 3 * p;
    same = x[2] == level;
    sum += std::abs(x[0]) + std::abs(x[1]);
  }
  return same && std::isfinite(sum) && std::isfinite(level);
}

/// Two corners of cells at different positions; empty if there are none.
std::vector<Vec3> differentCorners(const MeshView& view, const std::vector<CellBlock>& blocks)
{
  std::vector<Vec3> found;
  for (const CellBlock& block : blocks)
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      for (int k = 0; k < nodes; ++k)
      {
        const Vec3 p = pointOf(view, node[k]);
        if (found.empty() || p != found[0])
        {
          found.push_back(p);
        }
        if (found.size() == 2)
        {
          return found;
        }
      }
    }
  }
  return {};
}
}

//------------------------------------------------------------------------------
void Mesh::findPlane()
{
  MeshSpace space = this->space();
  // For points at the same height, two corners determine the plane.
  const std::vector<Vec3> two =
    areLevel(this->View) ? differentCorners(this->View, this->Blocks) : std::vector<Vec3>();
  const auto corners = [&](const auto& visit)
  {
    if (two.empty())
    {
      forEachFiniteCorner(this->View, this->Blocks, nullptr, visit);
    }
    std::for_each(two.begin(), two.end(), visit);
  };
  PlaneSearch(corners, nullptr).run(space);
  this->setSpace(space);
}

//------------------------------------------------------------------------------
MeshSpace spaceOf(RankGroup& group, const std::vector<RankPiece>& pieces)
{
  int dimension = 0;
  for (const RankPiece& piece : pieces)
  {
    for (const CellBlock& block : piece.mesh->blocks())
    {
      dimension = std::max(dimension, topology(block.type).dimension);
    }
    dimension = piece.mesh->polyhedra() > 0 ? 3 : dimension;
  }
  dimension = static_cast<int>(group.maximum(static_cast<Index>(dimension)));
  MeshSpace space;
  space.dimension = dimension == 3 ? Dimension::Volume
    : dimension == 2               ? Dimension::Surface
                                   : Dimension::None;
  if (space.dimension == Dimension::Surface)
  {
    const auto corners = [&pieces](const auto& visit)
    {
      for (const RankPiece& piece : pieces)
      {
        forEachFiniteCorner(piece.mesh->view(), piece.mesh->blocks(), piece.ghosts, visit);
      }
    };
    PlaneSearch(corners, &group).run(space);
  }
  return space;
}
}
