// SPDX-License-Identifier: BSD-3-Clause
#include "LocalSweep.h"

#include "VertexOptimizer.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tautline
{
namespace
{
/// The numbers sent per vertex: x y z, and whether it has moved.
constexpr int Sent = 4;
}

//------------------------------------------------------------------------------
SweepOrder::SweepOrder(const SimplexMesh& simplices, const Ranks& ranks)
  : TheRanks(ranks)
{
  if (ranks.several())
  {
    this->findSets(simplices);
    return;
  }
  const VertexBlocks& blocks = simplices.blocks();
  this->Size = VertexBlocks::size;
  this->SetStarts = blocks.colourStarts;
  for (const std::int32_t block : blocks.byColour)
  {
    this->Begins.push_back(block * VertexBlocks::size);
  }
}

//------------------------------------------------------------------------------
void SweepOrder::findSets(const SimplexMesh& simplices)
{
  constexpr Index verticesPerTask = 128;
  const DistributedMesh& mesh = this->TheRanks.mesh();
  const Index points = mesh.localPoints();
  this->GroupsPerTask = verticesPerTask;
  this->VertexOf.assign(points, -1);
  std::vector<unsigned char> flags(points, 0);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    this->VertexOf[simplices.point(v)] = v;
    flags[simplices.point(v)] = 1;
  }
  const std::vector<int> sets = mesh.independentSets(flags);
  const int highest = sets.empty() ? -1 : *std::max_element(sets.begin(), sets.end());
  const Index count = mesh.group().maximum(static_cast<Index>(highest)) + 1;
  this->SetStarts.assign(1, 0);
  for (Index set = 0; set < count; ++set)
  {
    for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
    {
      const Index p = simplices.point(v);
      if (sets[p] == set && mesh.owned(p))
      {
        this->Begins.push_back(v);
      }
    }
    this->SetStarts.push_back(static_cast<std::int32_t>(this->Begins.size()));
    std::transform(sets.begin(), sets.end(), flags.begin(), [set](int of) { return of == set; });
    this->Halos.push_back(mesh.subset(flags));
  }
}

//------------------------------------------------------------------------------
struct LocalSweeper::Base
{
  Base(SimplexMesh& simplices, double* points, const SweepOrder* order)
    : Simplices(simplices)
    , Points(points)
    , Own(order ? nullptr : std::make_unique<SweepOrder>(simplices))
    , Order(order ? *order : *Own)
    , Buffer(Sent * Order.VertexOf.size())
    , Active(simplices.freeVertices(), 1)
  {
  }
  virtual ~Base() = default;
  virtual SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values) = 0;
  virtual void setPatchIterations(int count) = 0;
  template <class Visit>
  void exchange(std::size_t set, const std::vector<Index>& moved, const Visit& visitMoved);

  SimplexMesh& Simplices;
  double* Points;
  std::unique_ptr<SweepOrder> Own;
  const SweepOrder& Order;
  std::vector<double> Buffer;
  std::vector<unsigned char> Active;
};

//------------------------------------------------------------------------------
/**
 * @brief Sends the positions of the owned vertices of a set to other ranks, and updates the halo
 * vertices.
 * @param moved per group: the number of vertices that have moved
 * @param visitMoved called with each vertex of the halo that has moved
 */
template <class Visit>
void LocalSweeper::Base::exchange(
  std::size_t set, const std::vector<Index>& moved, const Visit& visitMoved)
{
  double* x = this->Simplices.coordinates();
  for (std::int32_t i = this->Order.SetStarts[set]; i < this->Order.SetStarts[set + 1]; ++i)
  {
    const std::int32_t v = this->Order.Begins[i];
    double* to = &this->Buffer[static_cast<std::size_t>(Sent) * this->Simplices.point(v)];
    std::copy_n(x + VertexStride * static_cast<std::size_t>(v), 3, to);
    to[3] = static_cast<double>(moved[i]);
  }
  const DistributedMesh::Subset& halo = this->Order.Halos[set];
  this->Order.TheRanks.mesh().exchange(halo, this->Buffer.data(), Sent);
  for (const auto& neighbour : halo.neighbours)
  {
    for (const std::int32_t p : neighbour.received)
    {
      const std::int32_t v = this->Order.VertexOf[p];
      if (v < 0)
      {
        continue; // a point of the piece without a local cell
      }
      const double* from = &this->Buffer[Sent * static_cast<std::size_t>(p)];
      double* at = x + VertexStride * static_cast<std::size_t>(v);
      // If a vertex does not move, its owner keeps the original point without storing a rounded
      // one.
      if (!std::equal(from, from + 3, at))
      {
        std::copy_n(from, 3, at);
        this->Simplices.storeVertex(at, this->Points + 3 * static_cast<std::size_t>(p));
      }
      if (from[3] != 0)
      {
        visitMoved(v);
      }
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
struct LocalSweeper::Implementation : LocalSweeper::Base
{
  Implementation(SimplexMesh& simplices, const Mesh& mesh, double* points,
    const std::vector<LocalTerm>& terms, const LocalOptions& options, const SweepOrder* order)
    : Base(simplices, points, order)
    , Options(options)
    , Mover(simplices, mesh, points, terms, options)
  {
  }

  SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values) override;
  void setPatchIterations(int count) override { this->Mover.setPatchIterations(count); }

private:
  void wake(std::int32_t v, std::vector<unsigned char>& next) const;

  LocalOptions Options;
  VertexOptimizer<Dim> Mover;
};

//------------------------------------------------------------------------------
template <int Dim>
void LocalSweeper::Implementation<Dim>::wake(std::int32_t v, std::vector<unsigned char>& next) const
{
  // Threads may write the same flag concurrently, but they write the same value.
  __atomic_store_n(&next[v], static_cast<unsigned char>(1), __ATOMIC_RELAXED);
  const std::int32_t* ids = this->Simplices.patchVertices();
  const std::size_t end = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v + 1);
  for (std::size_t i = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v); i < end; ++i)
  {
    if (ids[i] < this->Simplices.freeVertices())
    {
      __atomic_store_n(&next[ids[i]], static_cast<unsigned char>(1), __ATOMIC_RELAXED);
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
SweepResult LocalSweeper::Implementation<Dim>::sweep(
  const Scalarizer& scalarizer, std::vector<double>& values)
{
  const std::size_t n = values.size();
  this->Mover.begin(values);
  const SweepOrder& order = this->Order;
  const Ranks& ranks = order.TheRanks;
  const std::size_t groups = order.Begins.size();
  // Results are stored per group and added in order, so that they do not depend on the number of
  // threads.
  std::vector<double> gradient2(groups, 0.0);
  std::vector<Index> visited(groups, 0), moved(groups, 0);
  std::vector<std::vector<double>> ofSet(n);
  std::vector<unsigned char> next(this->Simplices.freeVertices(), 0);
  std::vector<double> total(n, 0.0);
  ScratchPool<PatchWorker<Dim>> workers([&] { return this->Mover.makeWorker(); });
  const auto moveGroup = [&](PatchWorker<Dim>& w, std::size_t i, std::size_t place)
  {
    // A group uses the changes of earlier sets and its own changes.
    w.change = total;
    const std::int32_t begin = order.Begins[i];
    const std::int32_t end = std::min(this->Simplices.freeVertices(), begin + order.Size);
    for (std::int32_t v = begin; v < end; ++v)
    {
      if (this->Active[v])
      {
        ++visited[i];
        if (this->Mover.moveVertex(v, scalarizer, w, gradient2[i]))
        {
          ++moved[i];
          this->wake(v, next);
        }
      }
    }
    for (std::size_t k = 0; k < n; ++k)
    {
      ofSet[k][place] = w.change[k] - total[k];
    }
  };
  for (std::size_t set = 0; set + 1 < order.SetStarts.size(); ++set)
  {
    const std::int32_t first = order.SetStarts[set], last = order.SetStarts[set + 1];
    for (std::vector<double>& ofGroups : ofSet)
    {
      ofGroups.assign(last - first, 0.0);
    }
    parallelFor(last - first, order.GroupsPerTask, this->Options.threads, workers,
      [&](PatchWorker<Dim>& w, Index i) { moveGroup(w, first + i, i); });
    if (ranks.several())
    {
      this->exchange(set, moved, [&](std::int32_t v) { this->wake(v, next); });
    }
    for (std::size_t k = 0; k < n && (n > 1 || !ranks.several()); ++k)
    {
      total[k] = ranks.total(ofSet[k], total[k]);
    }
  }
  SweepResult result;
  result.visited = ranks.sum(std::accumulate(visited.begin(), visited.end(), Index(0)));
  result.moved = ranks.sum(std::accumulate(moved.begin(), moved.end(), Index(0)));
  result.gradientNorm = std::sqrt(ranks.total(gradient2)) / this->Simplices.scale();
  for (std::size_t i = 0; i < n; ++i)
  {
    values[i] = this->Mover.objective(i, total[i]);
  }
  // The next sweep visits the vertices that moved and their neighbors.
  if (this->Options.culling > 0)
  {
    this->Active.swap(next);
  }
  return result;
}

//------------------------------------------------------------------------------
LocalSweeper::LocalSweeper(SimplexMesh& simplices, const Mesh& mesh, double* points,
  const std::vector<LocalTerm>& terms, const LocalOptions& options, const SweepOrder* order)
{
  if (simplices.dimension() == 3)
  {
    this->Impl =
      std::make_unique<Implementation<3>>(simplices, mesh, points, terms, options, order);
  }
  else
  {
    this->Impl =
      std::make_unique<Implementation<2>>(simplices, mesh, points, terms, options, order);
  }
}

LocalSweeper::~LocalSweeper() = default;

SweepResult LocalSweeper::sweep(const Scalarizer& scalarizer, std::vector<double>& values)
{
  return this->Impl->sweep(scalarizer, values);
}

//------------------------------------------------------------------------------
void LocalSweeper::setPatchIterations(int count)
{
  this->Impl->setPatchIterations(count);
}

//------------------------------------------------------------------------------
void LocalSweeper::wakeAll()
{
  std::fill(this->Impl->Active.begin(), this->Impl->Active.end(), 1);
}
void LocalSweeper::wakeOnly(std::vector<unsigned char> active)
{
  this->Impl->Active = std::move(active);
}
}
