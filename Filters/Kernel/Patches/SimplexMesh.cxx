// SPDX-License-Identifier: BSD-3-Clause
#include "SimplexMesh.h"

#include "tautline/Core/CountingSort.h"
#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Mesh/CornerPoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// Spreads the lower 16 bits so that two zeros follow each.
std::uint64_t spread(std::uint64_t x)
{
  x = (x | (x << 32)) & 0x001f00000000ffffu;
  x = (x | (x << 16)) & 0x001f0000ff0000ffu;
  x = (x | (x << 8)) & 0x100f00f00f00f00fu;
  x = (x | (x << 4)) & 0x10c30c30c30c30c3u;
  return (x | (x << 2)) & 0x1249249249249249u;
}

/// Sorts by the lower 48 bits of the keys; equal keys keep their order.
void radixSort(std::vector<std::pair<std::uint64_t, std::int32_t>>& items)
{
  constexpr int bits = 12, passes = 4;
  std::vector<std::pair<std::uint64_t, std::int32_t>> other(items.size());
  for (int pass = 0; pass < passes; ++pass)
  {
    std::vector<std::size_t> starts((1u << bits) + 1, 0);
    const auto digit = [=](std::uint64_t key)
    { return (key >> (pass * bits)) & ((1u << bits) - 1); };
    for (const auto& item : items)
    {
      ++starts[digit(item.first) + 1];
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    for (const auto& item : items)
    {
      other[starts[digit(item.first)]++] = item;
    }
    items.swap(other);
  }
}

int dimensionOf(const Mesh& mesh)
{
  return mesh.dimension() == Dimension::Volume ? 3 : 2;
}

bool isFinite(const MeshView& view, Index point)
{
  return std::isfinite(view.points[3 * point]) && std::isfinite(view.points[3 * point + 1]) &&
    std::isfinite(view.points[3 * point + 2]);
}

/// A pair of blocks that share a cell, sorted by the later one.
std::uint64_t blockPair(std::int32_t a, std::int32_t b)
{
  return static_cast<std::uint64_t>(std::max(a, b)) << 32 |
    static_cast<std::uint64_t>(std::min(a, b));
}

/// Recognizes most repeated pairs within a chunk, where neighbors are consecutive.
class RecentPairs
{
public:
  bool isNew(std::uint64_t pair)
  {
    // The later block, shifted by some bits, spreads pairs with the same earlier one.
    constexpr int later = 32, spread = 4;
    std::uint64_t& place = this->Places[(pair ^ (pair >> (later - spread))) % most];
    const bool other = place != pair;
    place = pair;
    return other;
  }

private:
  /// The later block of a pair is never block 0, so 0 means no pair.
  static constexpr std::size_t most = 256; ///< small compared with a chunk, and a power of two
  std::array<std::uint64_t, most> Places = {};
};

/// Even permutations of a simplex that bring each vertex to the front.
constexpr int toFront3[4][4] = { { 0, 1, 2, 3 }, { 1, 0, 3, 2 }, { 2, 3, 0, 1 }, { 3, 2, 1, 0 } };
constexpr int toFront2[3][3] = { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 } };

/// The points that may move: see the constructor of SimplexMesh.
/// @param corners one flag per point: nonzero if it belongs to a cell of the mesh dimension
std::vector<char> freePoints(
  const Mesh& mesh, const unsigned char* fixed, const std::vector<char>& corners, int threads)
{
  const MeshView& view = mesh.view();
  std::vector<char> free = corners;
  Index elements = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    elements += topology(block.type).dimension == dimensionOf(mesh) ? block.count : 0;
  }
  if (fixed)
  {
    for (Index p = 0; p < view.numberOfPoints; ++p)
    {
      free[p] &= !fixed[p];
    }
  }
  else
  {
    const std::vector<char> boundary = boundaryPoints(mesh, threads);
    for (Index p = 0; p < view.numberOfPoints; ++p)
    {
      free[p] &= !boundary[p];
    }
  }
  if (elements < view.numberOfCells || mesh.higherOrderCells() > 0)
  {
    // Points of other cells, and nodes of quadratic cells other than corners, are fixed.
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      const CellType type = cornerType(view.cellTypes[cell]);
      const bool element =
        type != CellType::Unsupported && topology(type).dimension == dimensionOf(mesh);
      for (Index n = view.offsets[cell] + (element ? topology(type).nodes : 0);
           n < view.offsets[cell + 1]; ++n)
      {
        const Index node = view.connectivity[n];
        if (node >= 0 && node < view.numberOfPoints)
        {
          free[node] = 0;
        }
      }
    }
  }
  if (mesh.nonFinitePoints() > 0)
  {
    for (Index p = 0; p < view.numberOfPoints; ++p)
    {
      free[p] &= isFinite(view, p);
    }
  }
  return free;
}
}

//------------------------------------------------------------------------------
SimplexMesh::SimplexMesh(const Mesh& mesh, const unsigned char* fixed, const Targets* targets,
  int threads, const SimplexFrame* frame)
  : Dim(dimensionOf(mesh))
  , Surface(mesh.dimension() == Dimension::Surface)
  , Mirrored(mesh.mirrored() && mesh.dimension() != Dimension::Surface)
  , Frame{ Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } }
{
  if (mesh.view().numberOfPoints > std::numeric_limits<std::int32_t>::max())
  {
    throw Error(
      "The mesh has more than 2,147,483,647 points, the maximum of the optimizers: split it.");
  }
  if (mesh.dimension() == Dimension::Planar)
  {
    this->Frame = { mesh.frame()[0], mesh.frame()[1], mesh.normal() };
  }
  const std::vector<char> corners = cornerPoints(mesh, this->Dim, threads);
  this->number(mesh, corners, freePoints(mesh, fixed, corners, threads), frame, threads);
  std::vector<std::int32_t> vertexOf(mesh.view().numberOfPoints, -1);
  for (std::int32_t v = 0; v < this->vertices(); ++v)
  {
    vertexOf[this->Point[v]] = v;
  }
  this->cut(mesh, vertexOf, targets, frame, threads);
  this->load(mesh.view().points, threads);
  this->findPatches(threads);
  this->findBlocks(mesh, vertexOf, threads);
}

//------------------------------------------------------------------------------
void SimplexMesh::number(const Mesh& mesh, const std::vector<char>& corners,
  const std::vector<char>& free, const SimplexFrame* frame, int threads)
{
  const MeshView& view = mesh.view();
  Vec3 low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  Index count = 0, numberOfFree = 0;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (corners[p] && isFinite(view, p))
    {
      ++count;
      numberOfFree += free[p];
      for (int c = 0; c < 3; ++c)
      {
        low[c] = std::min(low[c], view.points[3 * p + c]);
        high[c] = std::max(high[c], view.points[3 * p + c]);
      }
    }
  }
  if (count == 0)
  {
    return;
  }
  low = frame ? frame->low : low;
  high = frame ? frame->high : high;
  // The grid of the Morton curve: 16 bits per axis.
  constexpr double cells = 65535.0;
  double extent = 0;
  for (int c = 0; c < 3; ++c)
  {
    extent = std::max(extent, high[c] - low[c]);
    this->Shift[c] = 0.5 * low[c] + 0.5 * high[c];
  }
  const double perLength = extent > 0 && std::isfinite(extent) ? cells / extent : 0.0;

  // Free vertices come first, each group along a Morton curve.
  std::vector<std::pair<std::uint64_t, std::int32_t>> order(numberOfFree),
    rest(count - numberOfFree);
  Index nextFree = 0, nextFixed = 0;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (corners[p] && isFinite(view, p))
    {
      (free[p] ? order[nextFree++] : rest[nextFixed++]).second = static_cast<std::int32_t>(p);
    }
  }
  for (auto* some : { &order, &rest })
  {
    forEachChunk(static_cast<Index>(some->size()), threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          auto& [key, point] = (*some)[i];
          const double* x = view.points + 3 * static_cast<Index>(point);
          for (int c = 0; c < 3; ++c)
          {
            key |= spread(static_cast<std::uint64_t>(perLength * (x[c] - low[c]))) << c;
          }
        }
      });
  }
  radixSort(order);
  radixSort(rest);
  this->Free = static_cast<std::int32_t>(numberOfFree);
  this->Point.reserve(count);
  for (const auto& item : order)
  {
    this->Point.push_back(item.second);
  }
  for (const auto& item : rest)
  {
    this->Point.push_back(item.second);
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void SimplexMesh::findPatchesOf(int threads)
{
  constexpr int corners = Dim + 1;
  const auto cornersOf = [this](Index simplex) { return this->Corners.data() + corners * simplex; };
  // The patches of the free vertices by a counting sort: count the simplices of each vertex, then
  // place them.
  CountingSort entries(this->Simplices, this->Free, threads,
    [&](Index simplex, const auto& use)
    {
      const std::int32_t* corner = cornersOf(simplex);
      for (int k = 0; k < corners; ++k)
      {
        if (corner[k] < this->Free)
        {
          use(corner[k]);
        }
      }
    });
  this->PatchStarts = std::move(entries.starts());
  const std::size_t count = this->PatchStarts[this->Free];
  this->PatchVertices.resize(count * Dim);
  this->PatchCorners.resize(this->uniform() ? 0 : count);
  entries.place(
    [&](Index simplex, const auto& placeOf)
    {
      const std::int32_t* corner = cornersOf(simplex);
      for (int k = 0; k < corners; ++k)
      {
        if (corner[k] >= this->Free)
        {
          continue;
        }
        const auto entry = static_cast<std::size_t>(placeOf(corner[k]));
        const int* front = Dim == 3 ? toFront3[k] : toFront2[k];
        for (int l = 0; l < Dim; ++l)
        {
          this->PatchVertices[entry * Dim + l] = corner[front[l + 1]];
        }
        if (!this->uniform())
        {
          this->PatchCorners[entry] = static_cast<std::int32_t>(simplex) * corners + k;
        }
      }
    });
}

//------------------------------------------------------------------------------
void SimplexMesh::findPatches(int threads)
{
  this->Dim == 3 ? this->findPatchesOf<3>(threads) : this->findPatchesOf<2>(threads);
}

//------------------------------------------------------------------------------
void SimplexMesh::indexPatches()
{
  const int corners = this->Dim + 1;
  this->PatchCorners.resize(this->PatchStarts[this->Free]);
  std::vector<std::int32_t> next(this->PatchStarts.begin(), this->PatchStarts.end() - 1);
  for (std::int32_t i = 0; i < corners * this->Simplices; ++i)
  {
    pollInterruption(i);
    const std::int32_t v = this->Corners[i];
    if (v < this->Free)
    {
      this->PatchCorners[next[v]++] = i;
    }
  }
}

//------------------------------------------------------------------------------
/// The pairs with vertices that are opposite in a hexahedron, which no simplex of it contains
/// together.
std::vector<std::uint64_t> SimplexMesh::blocksAcross(
  const Mesh& mesh, const std::vector<std::int32_t>& vertexOf) const
{
  std::vector<std::uint64_t> pairs;
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    for (Index i = 0; block.type == CellType::Hexahedron && i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      for (int k = 0; k < 4; ++k)
      {
        const std::int32_t a = vertexOf[node[k]], b = vertexOf[node[4 + (k + 2) % 4]];
        if (a < 0 || b < 0 || a >= this->Free || b >= this->Free)
        {
          continue;
        }
        const std::int32_t first = a / VertexBlocks::size, second = b / VertexBlocks::size;
        if (first != second)
        {
          pairs.push_back(blockPair(first, second));
        }
      }
    }
  }
  return pairs;
}

//------------------------------------------------------------------------------
/// The pairs with vertices of one simplex, chunk by chunk.
template <int Dim>
std::vector<std::vector<std::uint64_t>> SimplexMesh::blocksOfSimplices(int threads) const
{
  constexpr int corners = Dim + 1;
  constexpr std::int32_t none = -1;
  std::vector<std::vector<std::uint64_t>> ofChunk(numberOfChunks(this->Simplices));
  forEachChunk(this->Simplices, threads,
    [&](Index chunk, Index begin, Index end)
    {
      std::vector<std::uint64_t>& pairs = ofChunk[chunk];
      RecentPairs recent;
      for (Index i = begin; i < end; ++i)
      {
        const std::int32_t* corner = this->Corners.data() + corners * i;
        std::int32_t block[corners];
        for (int k = 0; k < corners; ++k)
        {
          block[k] = corner[k] < this->Free ? corner[k] / VertexBlocks::size : none;
        }
        if (std::all_of(block + 1, block + corners, [&](std::int32_t b) { return b == block[0]; }))
        {
          continue;
        }
        for (int k = 0; k < corners; ++k)
        {
          for (int l = k + 1; l < corners; ++l)
          {
            if (block[k] != block[l] && block[k] != none && block[l] != none)
            {
              const std::uint64_t pair = blockPair(block[k], block[l]);
              if (recent.isNew(pair))
              {
                pairs.push_back(pair);
              }
            }
          }
        }
      }
    });
  return ofChunk;
}

//------------------------------------------------------------------------------
void SimplexMesh::findBlocks(
  const Mesh& mesh, const std::vector<std::int32_t>& vertexOf, int threads)
{
  const std::int32_t blocks = (this->Free + VertexBlocks::size - 1) / VertexBlocks::size;
  std::vector<std::uint64_t> pairs = this->blocksAcross(mesh, vertexOf);
  const auto ofSimplices =
    this->Dim == 3 ? this->blocksOfSimplices<3>(threads) : this->blocksOfSimplices<2>(threads);
  for (const std::vector<std::uint64_t>& ofChunk : ofSimplices)
  {
    pairs.insert(pairs.end(), ofChunk.begin(), ofChunk.end());
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  // Each block gets the first color that no earlier block sharing a cell has.
  auto pair = pairs.begin();
  std::vector<std::int32_t> colour(blocks, -1);
  std::vector<char> taken;
  std::int32_t colours = 0;
  for (std::int32_t b = 0; b < blocks; ++b)
  {
    pollInterruption(b);
    taken.assign(colours + 1, 0);
    for (; pair != pairs.end() && static_cast<std::int32_t>(*pair >> 32) == b; ++pair)
    {
      taken[colour[static_cast<std::uint32_t>(*pair)]] = 1;
    }
    colour[b] = static_cast<std::int32_t>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
    colours = std::max(colours, colour[b] + 1);
  }
  this->Blocks.colourStarts.assign(colours + 1, 0);
  for (std::int32_t c : colour)
  {
    ++this->Blocks.colourStarts[c + 1];
  }
  std::partial_sum(this->Blocks.colourStarts.begin(), this->Blocks.colourStarts.end(),
    this->Blocks.colourStarts.begin());
  std::vector<std::int32_t> next = this->Blocks.colourStarts;
  this->Blocks.byColour.resize(blocks);
  for (std::int32_t b = 0; b < blocks; ++b)
  {
    this->Blocks.byColour[next[colour[b]]++] = b;
  }
}

//------------------------------------------------------------------------------
Vec3 SimplexMesh::transform(const Vec3& point) const
{
  const Vec3 d = point - this->Shift;
  Vec3 x = { 0, 0, 0 };
  for (int c = 0; c < this->Dim + this->Surface; ++c)
  {
    x[c] = dot(d, this->Frame[c]) / this->Scale;
  }
  return x;
}

//------------------------------------------------------------------------------
void SimplexMesh::load(const double* points, int threads)
{
  this->X.assign(static_cast<std::size_t>(VertexStride) * this->vertices(), 0.0);
  forEachChunk(this->vertices(), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index v = begin; v < end; ++v)
      {
        const double* p = points + 3 * static_cast<Index>(this->Point[v]);
        const Vec3 x = this->transform({ p[0], p[1], p[2] });
        std::copy(x.begin(), x.end(), this->X.data() + VertexStride * v);
      }
    });
}

//------------------------------------------------------------------------------
void SimplexMesh::storeVertex(const double* x, double* p) const
{
  Vec3 d = this->Scale * (x[0] * this->Frame[0] + x[1] * this->Frame[1]);
  // Keep the offset of a point from the plane of a planar mesh (rounding).
  const bool planar = this->Dim == 2 && !this->Surface;
  const double height =
    planar ? dot(Vec3{ p[0], p[1], p[2] } - this->Shift, this->Frame[2]) : this->Scale * x[2];
  d += height * this->Frame[2];
  for (int c = 0; c < 3; ++c)
  {
    p[c] = this->Shift[c] + d[c];
  }
}

//------------------------------------------------------------------------------
void SimplexMesh::store(const double* coordinates, double* points, int threads) const
{
  forEachChunk(this->Free, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index v = begin; v < end; ++v)
      {
        this->storeVertex(
          coordinates + VertexStride * v, points + 3 * static_cast<Index>(this->Point[v]));
      }
    });
}
}
