// SPDX-License-Identifier: BSD-3-Clause
#include "RankSweep.h"

#include "VertexOptimizer.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// Vertices that a thread moves in one go.
constexpr Index verticesPerChunk = 128;
/// x y z and whether the vertex moved.
constexpr int Sent = 4;
}

struct RankSweeper::Base
{
  virtual ~Base() = default;
  virtual void begin(const std::vector<double>& values) = 0;
  /// Moves the active ones of the vertices; `total` is what the objectives have changed by so far.
  virtual void move(const std::vector<std::int32_t>& vertices, const Scalarizer& scalarizer,
    const std::vector<double>& total) = 0;
  virtual void wake(std::int32_t v) = 0;
  virtual double objective(std::size_t i, double change) const = 0;

  std::vector<unsigned char> Active, Next;
  // Of the vertices that were moved last, in their order.
  std::vector<double> Gradients;
  std::vector<std::vector<double>> Changes; ///< per objective
  std::vector<unsigned char> Visited, Moved;
};

template <int Dim>
struct RankSweeper::Implementation : RankSweeper::Base
{
  Implementation(OptimizationProblem& problem, const SweepTerms& sweeps, int threads)
    : Simplices(problem.simplices())
    , Threads(threads)
    , Objectives(sweeps.terms.size())
    , Mover(problem.simplices(), problem.moving(), problem.points().data(), sweeps.terms,
        sweeps.options)
  {
    this->Active.assign(this->Simplices.freeVertices(), 1);
    this->Next.assign(this->Simplices.freeVertices(), 0);
    this->Changes.resize(this->Objectives);
  }

  void begin(const std::vector<double>& values) override { this->Mover.begin(values); }

  double objective(std::size_t i, double change) const override
  {
    return this->Mover.objective(i, change);
  }

  void move(const std::vector<std::int32_t>& vertices, const Scalarizer& scalarizer,
    const std::vector<double>& total) override
  {
    const std::size_t count = vertices.size();
    this->Gradients.assign(count, 0.0);
    this->Visited.assign(count, 0);
    this->Moved.assign(count, 0);
    for (std::vector<double>& changes : this->Changes)
    {
      changes.assign(count, 0.0);
    }
    ScratchPool<PatchWorker<Dim>> workers([&] { return this->Mover.makeWorker(); });
    parallelFor(static_cast<Index>(count), verticesPerChunk, this->Threads, workers,
      [&](PatchWorker<Dim>& w, Index i)
      {
        const std::int32_t v = vertices[i];
        if (!this->Active[v])
        {
          return;
        }
        this->Visited[i] = 1;
        w.change = total;
        this->Moved[i] = this->Mover.moveVertex(v, scalarizer, w, this->Gradients[i]);
        for (std::size_t k = 0; k < this->Objectives; ++k)
        {
          this->Changes[k][i] = w.change[k] - total[k];
        }
      });
  }

  void wake(std::int32_t v) override
  {
    this->Next[v] = 1;
    const std::int32_t* ids = this->Simplices.patchVertices();
    const std::size_t end = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v + 1);
    for (std::size_t i = static_cast<std::size_t>(Dim) * this->Simplices.patchStart(v); i < end;
         ++i)
    {
      if (ids[i] < this->Simplices.freeVertices())
      {
        this->Next[ids[i]] = 1;
      }
    }
  }

private:
  SimplexMesh& Simplices;
  int Threads;
  std::size_t Objectives;
  VertexOptimizer<Dim> Mover;
};

//------------------------------------------------------------------------------
RankSweeper::RankSweeper(const DistributedMesh& mesh, OptimizationProblem* problem,
  std::vector<int> sets, int threads, const SweepTerms* other)
  : TheMesh(mesh)
  , Problem(problem)
  , Sets(std::move(sets))
{
  RankGroup& group = mesh.group();
  const Index points = mesh.localPoints();
  const int highest =
    this->Sets.empty() ? -1 : *std::max_element(this->Sets.begin(), this->Sets.end());
  const auto numberOfSets = static_cast<int>(group.maximum(static_cast<Index>(highest))) + 1;
  this->VertexOf.assign(points, -1);
  this->Buffer.assign(Sent * points, 0.0);
  this->Own.resize(numberOfSets);
  for (std::int32_t v = 0; problem && v < problem->simplices().freeVertices(); ++v)
  {
    const Index p = problem->simplices().point(v);
    this->VertexOf[p] = v;
    if (mesh.owned(p) && this->Sets[p] >= 0)
    {
      this->Own[this->Sets[p]].push_back(v);
    }
  }
  if (problem)
  {
    const SweepTerms sweeps =
      other ? *other : SweepTerms{ problem->localTerms(), problem->localOptions() };
    if (problem->simplices().dimension() == 3)
    {
      this->Impl = std::make_unique<Implementation<3>>(*problem, sweeps, threads);
    }
    else
    {
      this->Impl = std::make_unique<Implementation<2>>(*problem, sweeps, threads);
    }
  }
  std::vector<unsigned char> flags(points);
  for (int set = 0; set < numberOfSets; ++set)
  {
    for (Index p = 0; p < points; ++p)
    {
      flags[p] = this->Sets[p] == set;
    }
    this->Halos.push_back(mesh.subset(flags));
  }
}

RankSweeper::~RankSweeper() = default;

//------------------------------------------------------------------------------
void RankSweeper::wakeAll()
{
  if (this->Impl)
  {
    std::fill(this->Impl->Active.begin(), this->Impl->Active.end(), 1);
  }
}

void RankSweeper::wakeOnly(std::vector<unsigned char> active)
{
  this->Impl->Active = std::move(active);
}

//------------------------------------------------------------------------------
/// Sends where the own vertices of a set are now, and puts those of the halo there.
void RankSweeper::exchangeSet(int set)
{
  const std::vector<std::int32_t>& own = this->Own[set];
  double* x = this->Problem ? this->Problem->simplices().coordinates() : nullptr;
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    double* to = &this->Buffer[Sent * this->Problem->simplices().point(own[i])];
    std::copy_n(x + VertexStride * static_cast<std::size_t>(own[i]), 3, to);
    to[3] = i < this->Impl->Moved.size() && this->Impl->Moved[i] ? 1.0 : 0.0;
    if (to[3] != 0)
    {
      this->Impl->wake(own[i]);
    }
  }
  this->TheMesh.exchange(this->Halos[set], this->Buffer.data(), Sent);
  for (const auto& neighbour : this->Halos[set].neighbours)
  {
    for (const std::int32_t p : neighbour.received)
    {
      const std::int32_t v = this->VertexOf[p];
      if (v < 0)
      {
        continue; // a point of the piece without a cell here
      }
      const double* from = &this->Buffer[Sent * static_cast<std::size_t>(p)];
      double* at = x + VertexStride * static_cast<std::size_t>(v);
      // Where a vertex stays, its owner has the point as it was, which is not stored and rounded.
      if (!std::equal(from, from + 3, at))
      {
        std::copy_n(from, 3, at);
        this->Problem->simplices().storeVertex(
          at, this->Problem->points().data() + 3 * static_cast<std::size_t>(p));
      }
      if (from[3] != 0)
      {
        this->Impl->wake(v);
      }
    }
  }
}

//------------------------------------------------------------------------------
SweepResult RankSweeper::sweep(const Scalarizer& scalarizer, const std::vector<double>& values)
{
  RankGroup& group = this->TheMesh.group();
  std::exception_ptr failure;
  // What a rank throws is kept until all of them are there.
  const auto attempt = [&](const std::function<void()>& work)
  {
    try
    {
      if (this->Impl && !failure)
      {
        work();
      }
    }
    catch (...)
    {
      failure = std::current_exception();
      this->Impl->Moved.clear();
      this->Impl->Gradients.clear();
    }
  };
  attempt([&] { this->Impl->begin(values); });
  const std::size_t n = values.size();
  std::vector<double> total(n, 0.0), gradients;
  Index visited = 0, moved = 0;
  for (std::size_t set = 0; set < this->Halos.size(); ++set)
  {
    attempt(
      [&]
      {
        this->Impl->move(this->Own[set], scalarizer, total);
        visited += std::count(this->Impl->Visited.begin(), this->Impl->Visited.end(), 1);
        moved += std::count(this->Impl->Moved.begin(), this->Impl->Moved.end(), 1);
        gradients.insert(
          gradients.end(), this->Impl->Gradients.begin(), this->Impl->Gradients.end());
      });
    this->exchangeSet(static_cast<int>(set));
    for (std::size_t k = 0; n > 1 && k < n; ++k)
    {
      total[k] +=
        group.orderlessSum(this->Impl && !failure ? this->Impl->Changes[k] : std::vector<double>());
    }
  }
  if (failure)
  {
    std::rethrow_exception(failure);
  }
  SweepResult result;
  result.visited = group.sum(visited);
  result.moved = group.sum(moved);
  const double scale = group.maximum(this->Problem ? this->Problem->simplices().scale() : 0.0);
  result.gradientNorm =
    std::sqrt(std::max(0.0, group.orderlessSum(gradients))) / (scale > 0 ? scale : 1.0);
  if (this->Impl && this->Problem->options().culling > 0)
  {
    this->Impl->Active.swap(this->Impl->Next);
    std::fill(this->Impl->Next.begin(), this->Impl->Next.end(), 0);
  }
  return result;
}
}
