// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "CellExtent.h"
#include "tautline/Core/Parallel.h"

#include <Eigen/Eigenvalues>

#include <atomic>
#include <limits>
#include <numeric>
#include <sstream>

namespace tautline
{
namespace
{
/// A mesh is planar when no vertex leaves its plane by more than this fraction of the diagonal.
constexpr double planarTolerance = 1e-6;

std::string cellMessage(Index cell, const std::string& what)
{
  return "Cell " + std::to_string(cell) + " " + what;
}

/// The cells sorted by type; adds to the numbers of those of higher order and of unsupported ones.
std::vector<CellBlock> sortByType(const MeshView& view, Index& higherOrder, Index& unsupported)
{
  // One pass finds which of the 256 types occur, so that a mesh of one type needs no id lists.
  std::array<Index, 256> histogram{};
  for (Index i = 0; i < view.numberOfCells; ++i)
  {
    if (view.offsets[i] < 0 || view.offsets[i + 1] < view.offsets[i])
    {
      throw Error(cellMessage(i, "has no proper place in the connectivity: its offsets descend."));
    }
    ++histogram[view.cellTypes[i]];
  }
  std::array<Index, NumberOfCellTypes> counts{};
  std::array<int, 256> blockOfType;
  for (int type = 0; type < 256; ++type)
  {
    blockOfType[type] = topologyIndex(cornerType(type));
    if (blockOfType[type] >= 0)
    {
      counts[blockOfType[type]] += histogram[type];
      higherOrder += isHigherOrder(type) ? histogram[type] : 0;
    }
    else
    {
      unsupported += histogram[type];
    }
  }
  std::vector<CellBlock> blocks;
  for (int b = 0; b < NumberOfCellTypes; ++b)
  {
    if (counts[b] == 0)
    {
      continue;
    }
    CellBlock block;
    block.type = topologies()[b].type;
    block.count = counts[b];
    if (counts[b] < view.numberOfCells)
    {
      block.cells.reserve(counts[b]);
      for (Index i = 0; i < view.numberOfCells; ++i)
      {
        if (blockOfType[view.cellTypes[i]] == b)
        {
          block.cells.push_back(i);
        }
      }
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// Throws Error on a cell with too few nodes or with node ids out of range.
void checkConnectivity(const MeshView& view, const std::vector<CellBlock>& blocks, int threads)
{
  for (const CellBlock& block : blocks)
  {
    const int nodes = topology(block.type).nodes;
    std::atomic<Index> wrong{ -1 };
    forEachChunk(block.count, threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          const Index first = view.offsets[cell];
          bool good = first >= 0 && view.offsets[cell + 1] - first >= nodes;
          for (int k = 0; good && k < nodes; ++k)
          {
            const Index node = view.connectivity[first + k];
            good = node >= 0 && node < view.numberOfPoints;
          }
          Index smallest = wrong; // of several the one with the smallest id is reported
          while (!good && (smallest < 0 || cell < smallest))
          {
            good = wrong.compare_exchange_weak(smallest, cell);
          }
        }
      });
    if (wrong >= 0)
    {
      throw Error(cellMessage(wrong,
        std::string("is not a proper ") + topology(block.type).name +
          ": it lists too few points or a point id that is not in the mesh. Check the file or the "
          "connectivity array."));
    }
  }
}

/// Calls visit(p) for the finite nodes of the cells, once per cell.
template <class Visit>
void forEachCorner(const MeshView& view, const std::vector<CellBlock>& blocks, const Visit& visit)
{
  for (const CellBlock& block : blocks)
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      for (int k = 0; k < nodes; ++k)
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

/// The principal direction in which the corners extend least, and their mean.
Vec3 leastExtent(const MeshView& view, const std::vector<CellBlock>& blocks, const Vec3& middle,
  double diagonal, Vec3& center)
{
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Index count = 0;
  forEachCorner(view, blocks,
    [&](const Vec3& p)
    {
      const Vec3 r = (1.0 / diagonal) * (p - middle);
      const Eigen::Vector3d v(r[0], r[1], r[2]);
      moments += v * v.transpose();
      sum += v;
      ++count;
    });
  const Eigen::Vector3d mean = sum / static_cast<double>(count);
  moments = moments / static_cast<double>(count) - mean * mean.transpose();
  const Eigen::Vector3d n =
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  center = middle + diagonal * Vec3{ mean[0], mean[1], mean[2] };
  return { n[0], n[1], n[2] };
}
}

//------------------------------------------------------------------------------
Mesh::Mesh(const MeshView& view, int threads)
  : View(view)
{
  if (view.numberOfPoints < 0 || view.numberOfCells < 0 ||
    (view.numberOfPoints > 0 && !view.points) ||
    (view.numberOfCells > 0 && (!view.cellTypes || !view.offsets || !view.connectivity)))
  {
    throw Error("The mesh view is incomplete: points, cell types, offsets and connectivity are "
                "all needed.");
  }

  this->Blocks = sortByType(view, this->HigherOrder, this->Unsupported);
  checkConnectivity(view, this->Blocks, threads);
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const Vec3 p = pointOf(view, i);
    this->NonFinitePoints += !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
  }

  bool flat = false, solid = false;
  for (const CellBlock& block : this->Blocks)
  {
    (topology(block.type).dimension == 2 ? flat : solid) = true;
  }
  this->Dim = solid ? Dimension::Volume : flat ? Dimension::Surface : Dimension::None;
  if (this->Dim == Dimension::Surface)
  {
    this->findPlane();
  }
}

//------------------------------------------------------------------------------
void Mesh::findPlane()
{
  const MeshView& view = this->View;
  // Principal directions of the corners of the cells; unused and non-finite points do not count.
  Vec3 low, high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(-std::numeric_limits<double>::max());
  forEachCorner(view, this->Blocks,
    [&](const Vec3& p)
    {
      for (int c = 0; c < 3; ++c)
      {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
    });
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
    if (extent[c] <= planarTolerance * diagonal)
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
    normal = leastExtent(view, this->Blocks, middle, diagonal, center);
    double farthest = 0.0;
    forEachCorner(view, this->Blocks,
      [&](const Vec3& p) { farthest = std::max(farthest, std::abs(dot(p - center, normal))); });
    if (farthest > planarTolerance * diagonal)
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
  this->Dim = Dimension::Planar;
  this->Normal = normal;
  this->Frame = { first, cross(normal, first) };
}

//------------------------------------------------------------------------------
Vec3 Mesh::center(Index cell, CellType type) const
{
  const int nodes = topology(type).nodes;
  const Index* node = this->View.connectivity + this->View.offsets[cell];
  Vec3 sum = { 0, 0, 0 };
  for (int k = 0; k < nodes; ++k)
  {
    sum += pointOf(this->View, node[k]);
  }
  return (1.0 / nodes) * sum;
}
}
