// SPDX-License-Identifier: BSD-3-Clause Sums over the simplices of an optimization, in packets, and
// the worst simplices.
#include "OptimizationProblem.h"

#include "PatchFunction.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// The contribution of a chunk of simplices to a record.
struct SimplexTotals
{
  double shape = 0, shape2 = 0, worst = 0, size = 0, size2 = 0, largest = 0;
  Index valid = 0, invalid = 0;

  void add(const SimplexTotals& t)
  {
    this->shape += t.shape;
    this->shape2 += t.shape2;
    this->worst = std::max(this->worst, t.worst);
    this->size += t.size;
    this->size2 += t.size2;
    this->largest = std::max(this->largest, t.largest);
    this->valid += t.valid;
    this->invalid += t.invalid;
  }
};

/// N and D of the packet of simplices starting at `first`, with `lanes` valid lanes.
template <int Dim>
void simplexInvariants(const SimplexMesh& mesh, std::int32_t first, int lanes, Packet& N, Packet& D)
{
  constexpr int corners = Dim + 1;
  const std::int32_t* ids = mesh.corners() + static_cast<std::size_t>(corners) * first;
  std::int32_t filled[corners * PacketWidth];
  // The last lanes repeat a simplex.
  if (lanes < PacketWidth)
  {
    for (int l = 0; l < PacketWidth; ++l)
    {
      std::copy_n(ids + corners * std::min(l, lanes - 1), corners, filled + corners * l);
    }
    ids = filled;
  }
  Packet x[corners][3];
  for (int k = 0; k < corners; ++k)
  {
    loadVertices(mesh.coordinates(), ids + k, corners, x[k]);
  }
  Packet weight[6], det;
  for (int e = 0; e < 6; ++e)
  {
    weight[e] = broadcast(mesh.target(first).edge[e]);
  }
  det = broadcast(mesh.target(first).det);
  for (int l = 0; l < PacketWidth && !mesh.uniform(); ++l)
  {
    const TargetSimplex& t = mesh.target(first + std::min(l, lanes - 1));
    for (int e = 0; e < 6; ++e)
    {
      weight[e][l] = t.edge[e];
    }
    det[l] = t.det;
  }
  N = Packet{};
  int e = 0;
  for (int i = 0; i < corners; ++i)
  {
    for (int j = i + 1; j < corners; ++j, ++e)
    {
      Packet d[3];
      subtract(x[j], x[i], d);
      N += weight[e] * dot(d, d);
    }
  }
  Packet a[3], b[3], ab[3];
  subtract(x[1], x[0], a);
  subtract(x[2], x[0], b);
  cross(a, b, ab);
  if (Dim == 3)
  {
    Packet c[3];
    subtract(x[corners - 1], x[0], c);
    D = det * dot(ab, c);
  }
  else
  {
    D = det * (mesh.surface() ? sqrt(dot(ab, ab)) : ab[2]);
  }
}

/// The inverse mean ratios of a packet of simplices; 0 for invalid ones.
template <int Dim>
Packet ratiosOf(const Packet& N, const Packet& D, Mask& valid)
{
  // As in Mesh::classifyCells(), with |T|^n instead of the product of the edges.
  valid = D > Mesh::degenerateTolerance() * (Dim == 2 ? N : N * sqrt(N));
  const Packet s = inverseCbrt(D);
  return select(valid, Dim == 2 ? 0.5 * N / D : (1.0 / 3.0) * N * s * s, Packet{});
}

/// Calls visit(chunk, simplex, ratio) for the valid simplices with a free vertex whose inverse mean
/// ratio exceeds bound(chunk); the simplices of a chunk in their order.
template <int Dim, class Bound, class Visit>
void forEachAbove(const SimplexMesh& mesh, int threads, const Bound& bound, const Visit& visit)
{
  constexpr int corners = Dim + 1;
  forEachChunk(mesh.simplices(), threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index i = begin; i < end; i += PacketWidth)
      {
        const int lanes = static_cast<int>(std::min<Index>(PacketWidth, end - i));
        Packet N, D;
        Mask valid;
        simplexInvariants<Dim>(mesh, static_cast<std::int32_t>(i), lanes, N, D);
        const Packet ratio = ratiosOf<Dim>(N, D, valid);
        if (!any(ratio > bound(chunk)))
        {
          continue;
        }
        for (int l = 0; l < lanes; ++l)
        {
          const std::int32_t* corner = mesh.corners() + corners * (i + l);
          if (ratio[l] > bound(chunk) &&
            std::any_of(corner, corner + corners,
              [&mesh](std::int32_t v) { return v < mesh.freeVertices(); }))
          {
            visit(chunk, static_cast<std::int32_t>(i + l), ratio[l]);
          }
        }
      }
    });
}

/// The totals of all simplices, excluding simplices of weight 0.
template <int Dim>
SimplexTotals totalsOf(const SimplexMesh& mesh, const std::vector<double>& weights, int threads)
{
  std::vector<SimplexTotals> ofChunk(numberOfChunks(mesh.simplices()));
  forEachChunk(mesh.simplices(), threads,
    [&](Index chunk, Index begin, Index end)
    {
      Packet shape = {}, shape2 = {}, worst = {}, size = {}, size2 = {}, largest = {};
      SimplexTotals& total = ofChunk[chunk];
      for (Index i = begin; i < end; i += PacketWidth)
      {
        const int lanes = static_cast<int>(std::min<Index>(PacketWidth, end - i));
        Packet N, D;
        simplexInvariants<Dim>(mesh, static_cast<std::int32_t>(i), lanes, N, D);
        Packet w = broadcast(1.0);
        for (int l = 0; l < PacketWidth && (lanes < PacketWidth || !weights.empty()); ++l)
        {
          w[l] = l >= lanes ? 0.0 : weights.empty() ? 1.0 : weights[i + l];
        }
        Mask valid;
        const Packet q = ratiosOf<Dim>(N, D, valid);
        if (any(~valid))
        {
          for (int l = 0; l < lanes; ++l)
          {
            total.invalid += valid[l] == 0;
          }
        }
        shape += select(w > 0.0, q, Packet{});
        shape2 += w * q * q;
        worst = max(worst, select(w > 0.0, q, Packet{}));
        const Packet V = select(w > 0.0, D, Packet{});
        size += V;
        size2 += w * V * V;
        largest = max(largest, V);
      }
      total.valid = end - begin - total.invalid;
      total.shape = sumOf(shape);
      total.shape2 = sumOf(shape2);
      total.worst = -minOf(-worst);
      total.size = sumOf(size);
      total.size2 = sumOf(size2);
      total.largest = -minOf(-largest);
    });
  SimplexTotals total;
  for (const SimplexTotals& t : ofChunk)
  {
    total.add(t);
  }
  return total;
}
}

//------------------------------------------------------------------------------
void OptimizationProblem::summarizeSimplices(IterationRecord& record) const
{
  std::vector<double> weights;
  if (!this->Weights[0].empty())
  {
    for (std::int32_t i = 0; i < this->Simplices->simplices(); ++i)
    {
      weights.push_back(this->Weights[0][this->Simplices->cell(i)]);
    }
  }
  const SimplexTotals t = this->Simplices->dimension() == 3
    ? totalsOf<3>(*this->Simplices, weights, this->Options.threads)
    : totalsOf<2>(*this->Simplices, weights, this->Options.threads);
  const double valid = static_cast<double>(std::max<Index>(1, t.valid));
  for (const LocalTerm& term : this->Terms)
  {
    const double size = std::sqrt(term.sizeSquared);
    record.objectives.push_back(term.shapePower == 2 ? t.shape2
        : term.shapePower == 1                       ? t.shape
                                                     : term.sizeSquared * t.size2);
    record.mean.push_back((term.shapePower > 0 ? t.shape : size * t.size) / valid);
    record.worst.push_back(term.shapePower > 0 ? t.worst : size * t.largest);
  }
  // The metric of a mean ratio is the reciprocal, whose mean cannot be derived from these sums.
  record.inverted = t.invalid;
}

//------------------------------------------------------------------------------
double OptimizationProblem::worstRatioMovable()
{
  const SimplexMesh& mesh = *this->Simplices;
  std::vector<double> worst(numberOfChunks(mesh.simplices()), 0.0);
  const auto bound = [&worst](Index chunk) { return worst[chunk]; };
  const auto visit = [&worst](Index chunk, std::int32_t, double ratio) { worst[chunk] = ratio; };
  mesh.dimension() == 3 ? forEachAbove<3>(mesh, this->Options.threads, bound, visit)
                        : forEachAbove<2>(mesh, this->Options.threads, bound, visit);
  return this->TheRanks.maximum(
    worst.empty() ? 0.0 : *std::max_element(worst.begin(), worst.end()));
}

//------------------------------------------------------------------------------
std::vector<unsigned char> OptimizationProblem::verticesAbove(double ratio) const
{
  const SimplexMesh& mesh = *this->Simplices;
  std::vector<unsigned char> flags(mesh.freeVertices(), 0);
  const auto bound = [ratio](Index) { return ratio; };
  const auto visit = [&](Index, std::int32_t simplex, double)
  {
    const int corners = mesh.dimension() + 1;
    const std::int32_t* corner = mesh.corners() + static_cast<std::size_t>(corners) * simplex;
    for (int k = 0; k < corners; ++k)
    {
      if (corner[k] < mesh.freeVertices())
      {
        // Threads may write the same flag concurrently, but they write the same value.
        __atomic_store_n(&flags[corner[k]], static_cast<unsigned char>(1), __ATOMIC_RELAXED);
      }
    }
  };
  mesh.dimension() == 3 ? forEachAbove<3>(mesh, this->Options.threads, bound, visit)
                        : forEachAbove<2>(mesh, this->Options.threads, bound, visit);
  return flags;
}
}
