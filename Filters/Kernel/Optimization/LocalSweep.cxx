// SPDX-License-Identifier: BSD-3-Clause
#include "LocalSweep.h"

#include "tautline/Core/Parallel.h"
#include "VertexOptimizer.h"

#include <cmath>
#include <utility>

namespace tautline
{
struct LocalSweeper::Base
{
  virtual ~Base() = default;
  virtual SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values) = 0;
  std::vector<unsigned char> Active;
};

template <int Dim>
struct LocalSweeper::Implementation : LocalSweeper::Base
{
  Implementation(SimplexMesh& simplices, const Mesh& mesh, double* points,
    const std::vector<LocalTerm>& terms, const LocalOptions& options)
    : Simplices(simplices)
    , Options(options)
    , Mover(simplices, mesh, points, terms, options)
  {
    this->Active.assign(simplices.freeVertices(), 1);
  }

  SweepResult sweep(const Scalarizer& scalarizer, std::vector<double>& values) override;

private:
  void wake(std::int32_t v, std::vector<unsigned char>& next) const;

  SimplexMesh& Simplices;
  LocalOptions Options;
  VertexOptimizer<Dim> Mover;
};

//------------------------------------------------------------------------------
template <int Dim>
void LocalSweeper::Implementation<Dim>::wake(std::int32_t v, std::vector<unsigned char>& next) const
{
  // Threads may write the same flag at once; they write the same.
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
  const VertexBlocks& blocks = this->Simplices.blocks();
  const std::size_t numberOfBlocks = blocks.byColour.size();
  // Results are kept per block and added in order: they do not depend on the number of threads.
  std::vector<double> gradient2(numberOfBlocks, 0.0), changes(n * numberOfBlocks, 0.0);
  std::vector<Index> visited(numberOfBlocks, 0), moved(numberOfBlocks, 0);
  std::vector<unsigned char> next(this->Simplices.freeVertices(), 0);
  std::vector<double> total(n, 0.0);
  ScratchPool<PatchWorker<Dim>> workers([&] { return this->Mover.makeWorker(); });
  const auto sweepBlock = [&](PatchWorker<Dim>& w, Index i)
  {
    // A block uses the changes of earlier colours, and its own.
    w.change = total;
    const std::int32_t begin = blocks.byColour[i] * blocks.size;
    const std::int32_t end = std::min(this->Simplices.freeVertices(), begin + blocks.size);
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
      changes[n * i + k] = w.change[k] - total[k];
    }
  };
  for (std::size_t colour = 0; colour + 1 < blocks.colourStarts.size(); ++colour)
  {
    const std::int32_t first = blocks.colourStarts[colour], last = blocks.colourStarts[colour + 1];
    parallelFor(last - first, 1, this->Options.threads, workers,
      [&](PatchWorker<Dim>& w, Index i) { sweepBlock(w, first + i); });
    for (std::int32_t i = first; i < last; ++i)
    {
      for (std::size_t k = 0; k < n; ++k)
      {
        total[k] += changes[n * i + k];
      }
    }
  }
  SweepResult result;
  double norm2 = 0;
  for (std::size_t i = 0; i < numberOfBlocks; ++i)
  {
    result.visited += visited[i];
    result.moved += moved[i];
    norm2 += gradient2[i];
  }
  result.gradientNorm = std::sqrt(norm2) / this->Simplices.scale();
  for (std::size_t i = 0; i < n; ++i)
  {
    values[i] = this->Mover.objective(i, total[i]);
  }
  // The next sweep visits the vertices that moved and their neighbours.
  if (this->Options.culling > 0)
  {
    this->Active.swap(next);
  }
  return result;
}

//------------------------------------------------------------------------------
LocalSweeper::LocalSweeper(SimplexMesh& simplices, const Mesh& mesh, double* points,
  const std::vector<LocalTerm>& terms, const LocalOptions& options)
{
  if (simplices.dimension() == 3)
  {
    this->Impl = std::make_unique<Implementation<3>>(simplices, mesh, points, terms, options);
  }
  else
  {
    this->Impl = std::make_unique<Implementation<2>>(simplices, mesh, points, terms, options);
  }
}

LocalSweeper::~LocalSweeper() = default;

SweepResult LocalSweeper::sweep(const Scalarizer& scalarizer, std::vector<double>& values)
{
  return this->Impl->sweep(scalarizer, values);
}

void LocalSweeper::wakeAll()
{
  std::fill(this->Impl->Active.begin(), this->Impl->Active.end(), 1);
}
void LocalSweeper::wakeOnly(std::vector<unsigned char> active)
{
  this->Impl->Active = std::move(active);
}
}
