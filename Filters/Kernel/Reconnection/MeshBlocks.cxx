// SPDX-License-Identifier: BSD-3-Clause
#include "MeshBlocks.h"

#include "CuttingFrames.h"
#include "tautline/Core/BisectionTree.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// One of this many tetrahedra is sampled to determine the planes.
constexpr TetId SampleStep = 16;

Vec3 sumOfVertices(const TetrahedronMesh& mesh, TetId t)
{
  const TetVertices& v = mesh.tet(t).vertices;
  return mesh.point(v[0]) + mesh.point(v[1]) + mesh.point(v[2]) + mesh.point(v[3]);
}
}

std::vector<std::uint8_t> partition(const TetrahedronMesh& mesh, int frame, int levels, int threads)
{
  std::vector<Vec3> sample;
  for (TetId t = 0; t < mesh.slots(); t += SampleStep)
  {
    if (mesh.alive(t))
    {
      sample.push_back(sumOfVertices(mesh, t));
    }
  }
  // Planes through the medians of a sample divide the tetrahedra into blocks of about equal size.
  const BisectionTree<CuttingFrame> tree(CuttingFrame(frame), sample, 1 << levels);
  std::vector<std::uint8_t> blocks(mesh.slots(), 0);
  forEachChunk(mesh.slots(), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index t = begin; t < end; ++t)
      {
        const TetId id = static_cast<TetId>(t);
        blocks[t] =
          static_cast<std::uint8_t>(mesh.alive(id) ? tree.find(sumOfVertices(mesh, id)) : 0);
      }
    });
  return blocks;
}

//------------------------------------------------------------------------------
MeshBlock::MeshBlock(const TetrahedronMesh& whole, const OperationRules& rules,
  std::vector<TetId> own, const std::vector<std::uint8_t>& blocks)
  : Own(std::move(own))
  , Mesh(this->extract(whole, blocks))
  , Operations(this->Mesh)
  , Passes(this->Mesh, this->Operations)
{
  this->Operations.floor = rules.floor;
  this->Operations.edgeFactor = rules.edgeFactor;
  this->Operations.swapsBoundary = rules.swapsBoundary;
  this->Operations.flatTolerance = rules.flatTolerance;
  this->Operations.surface = rules.surface;
  this->Operations.sums = rules.sums;
  this->Operations.inserts = rules.inserts;
  const double share = static_cast<double>(this->Own.size()) / static_cast<double>(whole.size());
  // Each block gets its share of the permitted change of the count, rounded down, so that the total
  // is not exceeded.
  const auto shareOf = [share](Index count) {
    return static_cast<Index>(std::floor(share * static_cast<double>(std::max<Index>(count, 0))));
  };
  this->Operations.largestSize = this->Mesh.size() + shareOf(rules.largestSize - whole.size());
  this->Operations.smallestSize = this->Mesh.size() - shareOf(whole.size() - rules.smallestSize);
  this->Shared.assign(this->Points.size(), 0);
  // Points of outside tetrahedra belong to other blocks as well, so they stay fixed.
  for (std::size_t k = this->Own.size(); k < this->Own.size() + this->Outside.size(); ++k)
  {
    for (PointId v : this->Mesh.tet(static_cast<TetId>(k)).vertices)
    {
      this->Shared[v] = 1;
    }
  }
  for (std::size_t v = 0; v < this->Points.size(); ++v)
  {
    this->Operations.freedoms.push_back(rules.freedoms[this->Points[v]]);
    if (this->Shared[v])
    {
      this->Operations.freedoms.back().fix();
    }
  }
}

/// The tetrahedra that touch the block, once each, and the faces between them.
void MeshBlock::addOutside(
  const TetrahedronMesh& whole, const std::vector<std::uint8_t>& blocks, TetrahedronArrays& arrays)
{
  const std::uint8_t block = blocks[this->Own[0]];
  for (TetId t : this->Own)
  {
    for (int i = 0; i < 4; ++i)
    {
      const std::int32_t n = whole.tet(t).neighbors[i];
      if (n != NoId && blocks[n >> 2] != block)
      {
        this->Faces.push_back({ 4 * t + i, n, NoId });
        this->Outside.push_back(n >> 2);
      }
    }
  }
  std::sort(this->Outside.begin(), this->Outside.end());
  this->Outside.erase(std::unique(this->Outside.begin(), this->Outside.end()), this->Outside.end());
  const auto localOf = [](const std::vector<TetId>& ids, TetId t)
  { return static_cast<TetId>(std::lower_bound(ids.begin(), ids.end(), t) - ids.begin()); };
  const TetId own = static_cast<TetId>(this->Own.size());
  for (TetId t : this->Outside)
  {
    arrays.tets.push_back({ whole.tet(t).vertices, { NoId, NoId, NoId, NoId } });
    arrays.quality.push_back(whole.quality(t));
    arrays.region.push_back(OutsideRegion);
    arrays.origin.push_back(NoId);
    if (whole.hasLabels())
    {
      arrays.labels.push_back(whole.labels(t));
    }
  }
  // A face is coded as 4 t + i; both sides of a cut face are linked to each other in local numbers.
  for (SharedFace& f : this->Faces)
  {
    const TetId inside = localOf(this->Own, f.inside >> 2);
    const TetId outside = own + localOf(this->Outside, f.outside >> 2);
    f.local = 4 * outside + (f.outside & 3);
    arrays.tets[inside].neighbors[f.inside & 3] = f.local;
    arrays.tets[outside].neighbors[f.outside & 3] = 4 * inside + (f.inside & 3);
  }
}

/// Numbers the points of the block: first input points, then inserted ones.
void MeshBlock::numberPoints(const TetrahedronMesh& whole, TetrahedronArrays& arrays)
{
  for (const Tetrahedron& t : arrays.tets)
  {
    this->Points.insert(this->Points.end(), t.vertices.begin(), t.vertices.end());
  }
  std::sort(this->Points.begin(), this->Points.end());
  this->Points.erase(std::unique(this->Points.begin(), this->Points.end()), this->Points.end());
  const auto localOf = [&](PointId v)
  {
    return static_cast<PointId>(
      std::lower_bound(this->Points.begin(), this->Points.end(), v) - this->Points.begin());
  };
  for (Tetrahedron& t : arrays.tets)
  {
    std::transform(t.vertices.begin(), t.vertices.end(), t.vertices.begin(), localOf);
  }
  for (PointId v : this->Points)
  {
    arrays.points.push_back(whole.point(v));
    if (whole.hasMetrics())
    {
      arrays.metrics.push_back(whole.metric(v));
    }
  }
  arrays.inputPoints = localOf(whole.inputPoints());
}

TetrahedronArrays MeshBlock::extract(
  const TetrahedronMesh& whole, const std::vector<std::uint8_t>& blocks)
{
  TetrahedronArrays arrays;
  arrays.weights = whole.weights();
  std::vector<std::int32_t> locals(this->Own.back() - this->Own.front() + 1, NoId);
  for (std::size_t k = 0; k < this->Own.size(); ++k)
  {
    locals[this->Own[k] - this->Own.front()] = static_cast<std::int32_t>(k);
  }
  const std::uint8_t block = blocks[this->Own[0]];
  for (TetId t : this->Own)
  {
    Tetrahedron tet = whole.tet(t);
    for (std::int32_t& n : tet.neighbors)
    {
      // Faces to other blocks are cut; addOutside() attaches the tetrahedra behind them.
      const bool inside = n != NoId && blocks[n >> 2] == block;
      n = inside ? 4 * locals[(n >> 2) - this->Own.front()] + (n & 3) : NoId;
    }
    arrays.tets.push_back(tet);
    arrays.quality.push_back(whole.quality(t));
    arrays.region.push_back(whole.region(t));
    arrays.origin.push_back(whole.origin(t));
    if (whole.hasLabels())
    {
      arrays.labels.push_back(whole.labels(t));
    }
  }
  this->addOutside(whole, blocks, arrays);
  this->numberPoints(whole, arrays);
  return arrays;
}

MeshBlockList cutIntoBlocks(
  const TetrahedronMesh& whole, const OperationRules& rules, int frame, int levels, int threads)
{
  const std::vector<std::uint8_t> blocks = partition(whole, frame, levels, threads);
  std::vector<std::vector<TetId>> own(std::size_t(1) << levels);
  for (TetId t = 0; t < whole.slots(); ++t)
  {
    pollInterruption(t);
    if (whole.alive(t))
    {
      own[blocks[t]].push_back(t);
    }
  }
  own.erase(std::remove_if(
              own.begin(), own.end(), [](const std::vector<TetId>& tets) { return tets.empty(); }),
    own.end());
  MeshBlockList list(own.size());
  parallelFor(static_cast<Index>(own.size()), 1, threads,
    [&](Index b) { list[b].reset(new MeshBlock(whole, rules, std::move(own[b]), blocks)); });
  return list;
}

//------------------------------------------------------------------------------
/// Joins blocks: assigns ids to new items, and matches the faces between the blocks.
class BlockJoin
{
public:
  BlockJoin(TetrahedronMesh& whole, MeshBlockList& blocks)
    : Blocks(blocks)
    , Arrays(whole.release())
  {
    std::size_t tets = this->Arrays.tets.size(), points = this->Arrays.points.size();
    // Existing items keep their ids; the new ones of each block get a range behind all others.
    for (const auto& block : blocks)
    {
      this->FirstTets.push_back(static_cast<TetId>(tets));
      this->FirstPoints.push_back(static_cast<PointId>(points));
      tets += block->Mesh.slots() - this->knownTets(*block);
      points += block->Mesh.pointSlots() - block->Points.size();
    }
    this->Arrays.tets.resize(tets, { { NoId, NoId, NoId, NoId }, { NoId, NoId, NoId, NoId } });
    this->Arrays.quality.resize(tets, 0.0);
    this->Arrays.region.resize(tets, 0);
    this->Arrays.origin.resize(tets, NoId);
    this->Arrays.points.resize(points);
    if (!this->Arrays.labels.empty())
    {
      this->Arrays.labels.resize(tets, { NoLabel, NoLabel, NoLabel, NoLabel });
    }
    if (!this->Arrays.metrics.empty())
    {
      this->Arrays.metrics.resize(points);
    }
  }

  /// Finds the current outer side of each face between blocks, after all blocks were changed.
  void matchFaces()
  {
    for (std::size_t b = 0; b < this->Blocks.size(); ++b)
    {
      const MeshBlock& block = *this->Blocks[b];
      for (const MeshBlock::SharedFace& f : block.Faces)
      {
        // The outside tetrahedron has not changed, but its neighbor in the block may be a new one.
        const std::int32_t now = block.Mesh.tet(f.local >> 2).neighbors[f.local & 3];
        this->Now.push_back({ f.inside, 4 * this->tetOf(b, now >> 2) + (now & 3) });
      }
    }
    std::sort(this->Now.begin(), this->Now.end());
  }

  void write(std::size_t b)
  {
    const MeshBlock& block = *this->Blocks[b];
    const TetId known = this->knownTets(block);
    for (TetId t = 0; t < block.Mesh.slots(); ++t)
    {
      if (t < known && t >= static_cast<TetId>(block.Own.size()))
      {
        continue; // outside
      }
      const TetId id = this->tetOf(b, t);
      Tetrahedron& tet = this->Arrays.tets[id];
      tet = block.Mesh.tet(t);
      if (!block.Mesh.alive(t))
      {
        continue;
      }
      for (PointId& v : tet.vertices)
      {
        v = this->pointOf(b, v);
      }
      for (std::int32_t& n : tet.neighbors)
      {
        // Links to other blocks follow in connect(), when all blocks are written.
        const bool isOutside =
          n != NoId && n >> 2 < known && n >> 2 >= static_cast<TetId>(block.Own.size());
        n = n == NoId || isOutside ? NoId : 4 * this->tetOf(b, n >> 2) + (n & 3);
      }
      this->Arrays.quality[id] = block.Mesh.quality(t);
      this->Arrays.region[id] = block.Mesh.region(t);
      this->Arrays.origin[id] = block.Mesh.origin(t);
      if (block.Mesh.hasLabels())
      {
        this->Arrays.labels[id] = block.Mesh.labels(t);
      }
    }
    for (PointId v = 0; v < block.Mesh.pointSlots(); ++v)
    {
      // Shared points have not moved, and several blocks would write them at the same time.
      if (v >= static_cast<PointId>(block.Points.size()) || !block.Shared[v])
      {
        const PointId p = this->pointOf(b, v);
        this->Arrays.points[p] = block.Mesh.point(v);
        if (block.Mesh.hasMetrics())
        {
          this->Arrays.metrics[p] = block.Mesh.metric(v);
        }
      }
    }
  }

  /// Connects the blocks, after all of them were written.
  void connect()
  {
    for (const auto& block : this->Blocks)
    {
      for (const MeshBlock::SharedFace& f : block->Faces)
      {
        const std::int32_t own = this->faceNow(f.inside);
        this->Arrays.tets[own >> 2].neighbors[own & 3] = this->faceNow(f.outside);
      }
    }
  }

  /// Sets the freedoms of the new points, and adds the counts.
  void finish(TetrahedronMesh& whole, CavityOperations& operations)
  {
    operations.freedoms.resize(this->Arrays.points.size());
    for (std::size_t b = 0; b < this->Blocks.size(); ++b)
    {
      CavityOperations& own = this->Blocks[b]->Operations;
      operations.addCounts(own.counts());
      for (std::size_t v = this->Blocks[b]->Points.size(); v < own.freedoms.size(); ++v)
      {
        const PointId p = this->pointOf(b, static_cast<PointId>(v));
        operations.freedoms[p] = own.freedoms[v];
      }
    }
    whole = TetrahedronMesh(std::move(this->Arrays));
    operations.prepareStamps();
  }

private:
  static TetId knownTets(const MeshBlock& block)
  {
    return static_cast<TetId>(block.Own.size() + block.Outside.size());
  }
  TetId tetOf(std::size_t b, TetId t) const
  {
    const MeshBlock& block = *this->Blocks[b];
    return t < static_cast<TetId>(block.Own.size())
      ? block.Own[t]
      : this->FirstTets[b] + t - this->knownTets(block);
  }
  PointId pointOf(std::size_t b, PointId v) const
  {
    const std::vector<PointId>& points = this->Blocks[b]->Points;
    const PointId known = static_cast<PointId>(points.size());
    return v < known ? points[v] : this->FirstPoints[b] + v - known;
  }
  std::int32_t faceNow(std::int32_t before) const
  {
    return std::lower_bound(this->Now.begin(), this->Now.end(),
      std::make_pair(before, std::numeric_limits<std::int32_t>::min()))
      ->second;
  }

  MeshBlockList& Blocks;
  TetrahedronArrays Arrays;
  std::vector<TetId> FirstTets;     ///< id of the first new tetrahedron of each block
  std::vector<PointId> FirstPoints; ///< the same for points
  std::vector<std::pair<std::int32_t, std::int32_t>> Now; ///< codes of faces between blocks
};

void joinBlocks(
  TetrahedronMesh& whole, CavityOperations& operations, MeshBlockList& blocks, int threads)
{
  BlockJoin join(whole, blocks);
  join.matchFaces();
  parallelFor(static_cast<Index>(blocks.size()), 1, threads,
    [&](Index b) { join.write(static_cast<std::size_t>(b)); });
  join.connect();
  join.finish(whole, operations);
}
}
