// SPDX-License-Identifier: BSD-3-Clause
#include "HarmonicMap.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/VectorAlgebra.h"

namespace tautline
{
namespace
{
/// The graph Laplacian of the free vertices: the number of neighbors minus their sum.
class GraphLaplacian
{
public:
  template <int Dim>
  static GraphLaplacian of(const SimplexMesh& mesh, int threads)
  {
    GraphLaplacian graph;
    const std::int32_t free = graph.Free = mesh.freeVertices();
    graph.Threads = threads;
    graph.Starts.assign(free + 1, 0);
    std::vector<std::int32_t>& neighbours = graph.Neighbours;
    neighbours.reserve(static_cast<std::size_t>(free) * (Dim == 3 ? 15 : 7));
    for (std::int32_t v = 0; v < free; ++v)
    {
      pollInterruption(v);
      // The patch lists each neighbor several times.
      const auto begin = static_cast<std::ptrdiff_t>(neighbours.size());
      neighbours.insert(neighbours.end(),
        mesh.patchVertices() + static_cast<std::size_t>(Dim) * mesh.patchStart(v),
        mesh.patchVertices() + static_cast<std::size_t>(Dim) * mesh.patchStart(v + 1));
      std::sort(neighbours.begin() + begin, neighbours.end());
      neighbours.erase(std::unique(neighbours.begin() + begin, neighbours.end()), neighbours.end());
      graph.Held =
        graph.Held || (neighbours.begin() + begin != neighbours.end() && neighbours.back() >= free);
      graph.Starts[v + 1] = static_cast<std::int32_t>(neighbours.size());
    }
    return graph;
  }

  /// Whether a neighbor is fixed.
  bool held() const { return this->Held; }

  /// r = sign L y, with fixed vertices of y treated as 0 unless `fixed`.
  void apply(const double* y, bool fixed, double sign, std::vector<double>& r) const
  {
    forEachChunk(this->Free, this->Threads,
      [&](Index, Index begin, Index end)
      {
        for (Index v = begin; v < end; ++v)
        {
          double sum[VertexStride] = {};
          for (std::int32_t i = this->Starts[v]; i < this->Starts[v + 1]; ++i)
          {
            const std::int32_t w = this->Neighbours[i];
            if (w < this->Free || fixed)
            {
              for (int c = 0; c < VertexStride; ++c)
              {
                sum[c] += y[VertexStride * static_cast<std::size_t>(w) + c];
              }
            }
          }
          const double degree = this->Starts[v + 1] - this->Starts[v];
          for (int c = 0; c < VertexStride; ++c)
          {
            r[VertexStride * v + c] = sign * (degree * y[VertexStride * v + c] - sum[c]);
          }
        }
      });
  }

  /// z = r divided by the numbers of neighbors.
  void precondition(const std::vector<double>& r, std::vector<double>& z) const
  {
    for (std::int32_t v = 0; v < this->Free; ++v)
    {
      const double over = 1.0 / std::max(1, this->Starts[v + 1] - this->Starts[v]);
      for (int c = 0; c < VertexStride; ++c)
      {
        z[VertexStride * static_cast<std::size_t>(v) + c] =
          over * r[VertexStride * static_cast<std::size_t>(v) + c];
      }
    }
  }

private:
  std::int32_t Free = 0;
  int Threads = 1;
  std::vector<std::int32_t> Starts, Neighbours; ///< neighbors of each free vertex, once each
  bool Held = false;
};
}

//------------------------------------------------------------------------------
template <int Dim>
bool harmonicMap(const SimplexMesh& mesh, double* x, double tolerance, int iterations, int threads)
{
  const GraphLaplacian graph = GraphLaplacian::of<Dim>(mesh, threads);
  if (!graph.held())
  {
    return false;
  }
  // Conjugate gradients for all coordinates at once.
  const std::size_t size = static_cast<std::size_t>(VertexStride) * mesh.freeVertices();
  const VectorAlgebra algebra(size, threads, LaneOrder::Halves);
  std::vector<double> r(size), z(size), p(size), Ap(size);
  graph.apply(x, true, -1.0, r);
  graph.precondition(r, z);
  p = z;
  double rz = algebra.dot(r.data(), z.data());
  const double first = rz;
  for (int iteration = 0; iteration < iterations && rz > tolerance * tolerance * first; ++iteration)
  {
    graph.apply(p.data(), false, 1.0, Ap);
    const double curvature = algebra.dot(p.data(), Ap.data());
    if (!(curvature > 0))
    {
      break;
    }
    const double alpha = rz / curvature;
    algebra.addScaled(x, alpha, p.data(), x);
    algebra.addScaled(r.data(), -alpha, Ap.data(), r.data());
    graph.precondition(r, z);
    const double next = algebra.dot(r.data(), z.data());
    algebra.addScaled(z.data(), next / rz, p.data(), p.data());
    rz = next;
  }
  return true;
}

template bool harmonicMap<2>(const SimplexMesh&, double*, double, int, int);
template bool harmonicMap<3>(const SimplexMesh&, double*, double, int, int);
}
