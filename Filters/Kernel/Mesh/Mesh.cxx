// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "CellExtent.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <atomic>
#include <limits>
#include <numeric>
#include <sstream>

namespace tautline
{
namespace
{
std::string cellMessage(Index cell, const std::string& what)
{
  return "Cell " + std::to_string(cell) + " " + what;
}

/// The cells sorted by type; counts the cells of higher order, the unsupported ones and, among
/// these, the polyhedra.
std::vector<CellBlock> sortByType(
  const MeshView& view, Index& higherOrder, Index& unsupported, Index& polyhedra)
{
  // One pass determines which of the 256 types occur, so that a mesh of one type needs no id lists.
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
  polyhedra = histogram[PolyhedronType];
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
          Index smallest = wrong; // the one with the smallest id is reported
          while (!good && (smallest < 0 || cell < smallest))
          {
            good = wrong.compare_exchange_weak(smallest, cell);
          }
        }
      });
    if (wrong >= 0)
    {
      throw Error(cellMessage(wrong,
        std::string("is not a valid ") + topology(block.type).name +
          ": it lists too few points or a point id that is not in the mesh. Check the file or the "
          "connectivity array."));
    }
  }
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

  this->Blocks = sortByType(view, this->HigherOrder, this->Unsupported, this->Polyhedra);
  checkConnectivity(view, this->Blocks, threads);
  this->findDimension();
}

//------------------------------------------------------------------------------
Mesh Mesh::at(const double* points) const
{
  Mesh result = *this;
  result.View.points = points;
  result.findDimension();
  return result;
}

//------------------------------------------------------------------------------
/// Determines the properties that depend on the points: nonfinite points and the plane.
void Mesh::findDimension()
{
  const MeshView& view = this->View;
  this->NonFinitePoints = 0;
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const Vec3 p = pointOf(view, i);
    this->NonFinitePoints += !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
  }

  this->Normal = { 0, 0, 0 };
  this->Frame = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 } };
  bool flat = false, solid = this->Polyhedra > 0;
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
Vec3 Mesh::center(Index cell, CellType type) const
{
  const Index first = this->View.offsets[cell];
  const Index nodes =
    type == CellType::Unsupported ? this->View.offsets[cell + 1] - first : topology(type).nodes;
  Vec3 sum = { 0, 0, 0 };
  for (Index k = first; k < first + nodes; ++k)
  {
    sum += pointOf(this->View, this->View.connectivity[k]);
  }
  return nodes > 0 ? (1.0 / static_cast<double>(nodes)) * sum : sum;
}

//------------------------------------------------------------------------------
double diagonalOf(const MeshView& view)
{
  const double infinity = std::numeric_limits<double>::infinity();
  Vec3 low = { infinity, infinity, infinity }, high = { -infinity, -infinity, -infinity };
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    pollInterruption(p);
    const Vec3 x = pointOf(view, p);
    for (int c = 0; c < 3 && std::isfinite(dot(x, x)); ++c)
    {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
  }
  return low[0] <= high[0] ? norm(high - low) : 0.0;
}
}
