// SPDX-License-Identifier: BSD-3-Clause
#include "TransferOverlaps.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr Index SimplicesPerChunk = 128;
/// Overlaps below this fraction of the smaller simplex are rounding errors.
constexpr double RoundingOverlap = 1e-13;
/// Simplices covered by at least this fraction count as covered and are scaled to the whole. On
/// surfaces, the fraction allows for projection.
constexpr double CoveredPart = 1.0 - 1e-9, CoveredPartOfSurface = 0.7;
/// The smallest cosine of the angle of two normals, and the largest distance of surfaces, relative
/// to the sum of their longest edges.
constexpr double SteepestCosine = 0.5, FarthestHeight = 0.25;

Vec3 normalOf(const TransferMesh& mesh, Index simplex)
{
  const TransferMesh::Simplex& s = mesh.simplices()[simplex];
  const Vec3& a = mesh.points()[s[0]];
  const Vec3 n = cross(mesh.points()[s[1]] - a, mesh.points()[s[2]] - a);
  return (1.0 / norm(n)) * n;
}

/// A source simplex that a target simplex overlaps; sides are only for surfaces.
struct FoundOverlap
{
  TransferOverlap overlap;
  bool behind;
};

template <int N>
void overlapsOf(const TransferMesh& target, Index simplex, const BoxTree& tree,
  const TransferMesh& source, TransferSpace space, std::vector<FoundOverlap>& found)
{
  const TransferView<N> view(target, simplex, space);
  const bool surface = space == TransferSpace::Surface;
  const double longest = surface ? longestEdge(target, simplex) : 0.0;
  BoundingBox box = boxOf(target, simplex);
  // Surfaces may be a fraction of an edge apart, so the box is widened.
  box.widen(FarthestHeight * longest);
  const auto first = static_cast<std::ptrdiff_t>(found.size());
  Index pass = 0;
  tree.forEachMeeting(box,
    [&](Index s)
    {
      pollInterruption(++pass);
      const int side = surface ? view.side(source, s) : 1;
      if (side == 0)
      {
        return;
      }
      double size = 0.0, height = 0.0;
      view.with(source, s).forEachPiece(
        [&](const auto&, const auto& inSource, double piece)
        {
          size += piece;
          if (surface)
          {
            std::array<double, N> mean;
            for (int k = 0; k < N; ++k)
            {
              mean[k] = 0.0;
              for (int i = 0; i < N; ++i)
              {
                mean[k] += inSource(i, k) / N;
              }
            }
            height += piece * view.heightOf(source, s, mean);
          }
        });
      const double least = RoundingOverlap * std::min(target.sizes()[simplex], source.sizes()[s]);
      const bool near =
        !surface || std::abs(height) <= FarthestHeight * (longest + longestEdge(source, s)) * size;
      if (size > least && near)
      {
        found.push_back({ { s, size }, side < 0 });
      }
    });
  // The result does not depend on the order in which the tree is traversed.
  std::sort(found.begin() + first, found.end(),
    [](const FoundOverlap& a, const FoundOverlap& b)
    { return a.overlap.simplex < b.overlap.simplex; });
}

/// The overlaps of the simplices in a chunk.
struct OverlapChunk
{
  std::vector<FoundOverlap> found;
  std::vector<Index> counts;
};

/// Whether most overlaps are seen from behind.
bool mostlyBehind(const std::vector<OverlapChunk>& chunks)
{
  double front = 0.0, behind = 0.0;
  for (const OverlapChunk& chunk : chunks)
  {
    for (const FoundOverlap& each : chunk.found)
    {
      (each.behind ? behind : front) += each.overlap.size;
    }
  }
  return behind > front;
}

/// Lists the overlaps; on surfaces, only on the side of the majority.
void collectOverlaps(const std::vector<OverlapChunk>& chunks, TransferOverlaps& result)
{
  const bool behind = result.space == TransferSpace::Surface && mostlyBehind(chunks);
  result.starts = { 0 };
  for (const OverlapChunk& chunk : chunks)
  {
    auto next = chunk.found.begin();
    for (const Index count : chunk.counts)
    {
      for (Index k = 0; k < count; ++k, ++next)
      {
        if (next->behind == behind)
        {
          result.overlaps.push_back(next->overlap);
        }
      }
      result.starts.push_back(static_cast<Index>(result.overlaps.size()));
    }
  }
}

void scaleOverlaps(const TransferMesh& target, const TransferMesh& source, TransferOverlaps& result)
{
  const double part = result.space == TransferSpace::Surface ? CoveredPartOfSurface : CoveredPart;
  const auto sources = static_cast<std::size_t>(source.numberOfSimplices());
  const auto targets = static_cast<std::size_t>(target.numberOfSimplices());
  result.coveredSource.assign(sources, 0.0);
  for (const TransferOverlap& each : result.overlaps)
  {
    result.coveredSource[each.simplex] += each.size;
  }
  result.scales.assign(sources, 1.0);
  result.sourceIsCovered.assign(sources, 0);
  for (std::size_t s = 0; s < sources; ++s)
  {
    const double size = source.sizes()[s];
    // Rounding and the tolerances of overlaps must not change integrals over a covered source
    // simplex.
    if (result.coveredSource[s] >= part * size)
    {
      result.scales[s] = size / result.coveredSource[s];
      result.coveredSource[s] = size;
      result.sourceIsCovered[s] = 1;
    }
  }
  result.coveredTarget.assign(targets, 0.0);
  result.targetIsCovered.assign(targets, 0);
  for (std::size_t t = 0; t < targets; ++t)
  {
    for (Index k = result.starts[t]; k < result.starts[t + 1]; ++k)
    {
      TransferOverlap& each = result.overlaps[k];
      each.size *= result.scales[each.simplex];
      result.coveredTarget[t] += each.size;
    }
    result.targetIsCovered[t] = result.coveredTarget[t] >= part * target.sizes()[t];
  }
}
}

//------------------------------------------------------------------------------
double longestEdge(const TransferMesh& mesh, Index simplex)
{
  const TransferMesh::Simplex& s = mesh.simplices()[simplex];
  double longest = 0.0;
  for (int i = 0; i < mesh.corners(); ++i)
  {
    for (int k = 0; k < i; ++k)
    {
      longest = std::max(longest, norm(mesh.points()[s[i]] - mesh.points()[s[k]]));
    }
  }
  return longest;
}

//------------------------------------------------------------------------------
BoundingBox boxOf(const TransferMesh& mesh, Index simplex)
{
  BoundingBox box;
  for (int k = 0; k < mesh.corners(); ++k)
  {
    box.add(mesh.points()[mesh.simplices()[simplex][k]]);
  }
  return box;
}

//------------------------------------------------------------------------------
template <int N>
TransferView<N>::TransferView(const TransferMesh& target, Index simplex, TransferSpace space)
  : Space(space)
{
  if (space == TransferSpace::Surface)
  {
    const TransferMesh::Simplex& s = target.simplices()[simplex];
    const Vec3 edge = target.points()[s[1]] - target.points()[s[0]];
    this->Origin = target.points()[s[0]];
    this->Normal = normalOf(target, simplex);
    this->First = (1.0 / norm(edge)) * edge;
    this->Second = cross(this->Normal, this->First);
  }
  this->Corners = this->project(target, simplex);
}

//------------------------------------------------------------------------------
template <int N>
SimplexCorners<N> TransferView<N>::project(const TransferMesh& mesh, Index simplex) const
{
  SimplexCorners<N> corners;
  for (int k = 0; k < N; ++k)
  {
    const Vec3& p = mesh.points()[mesh.simplices()[simplex][k]];
    if constexpr (N == 4)
    {
      corners[k] = p;
    }
    else
    {
      const Vec3 d = p - this->Origin;
      corners[k] = { dot(d, this->First), dot(d, this->Second) };
    }
  }
  return corners;
}

//------------------------------------------------------------------------------
template <int N>
SimplexOverlap<N> TransferView<N>::with(const TransferMesh& source, Index simplex) const
{
  return SimplexOverlap<N>(this->Corners, this->project(source, simplex));
}

//------------------------------------------------------------------------------
template <int N>
int TransferView<N>::side(const TransferMesh& source, Index simplex) const
{
  const double cosine = dot(this->Normal, normalOf(source, simplex));
  return std::abs(cosine) < SteepestCosine ? 0 : cosine < 0.0 ? -1 : 1;
}

//------------------------------------------------------------------------------
template <int N>
double TransferView<N>::heightOf(
  const TransferMesh& source, Index simplex, const std::array<double, N>& coordinates) const
{
  double height = 0.0;
  for (int k = 0; k < N; ++k)
  {
    const Vec3& p = source.points()[source.simplices()[simplex][k]];
    height += coordinates[k] * dot(this->Normal, p - this->Origin);
  }
  return height;
}

template class TransferView<3>;
template class TransferView<4>;

//------------------------------------------------------------------------------
TransferOverlaps findOverlaps(const TransferMesh& target, const BoxTree& tree,
  const TransferMesh& source, TransferSpace space, int threads)
{
  TransferOverlaps result;
  result.space = space;
  const Index count = target.numberOfSimplices();
  std::vector<OverlapChunk> chunks((count + SimplicesPerChunk - 1) / SimplicesPerChunk);
  runChunks(static_cast<Index>(chunks.size()), threads,
    [&](Index number)
    {
      OverlapChunk& chunk = chunks[number];
      const Index end = std::min(count, (number + 1) * SimplicesPerChunk);
      for (Index t = number * SimplicesPerChunk; t < end; ++t)
      {
        const auto before = static_cast<Index>(chunk.found.size());
        space == TransferSpace::Volume ? overlapsOf<4>(target, t, tree, source, space, chunk.found)
                                       : overlapsOf<3>(target, t, tree, source, space, chunk.found);
        chunk.counts.push_back(static_cast<Index>(chunk.found.size()) - before);
      }
    });
  // Chunks are joined in their order: the result does not depend on the number of threads.
  collectOverlaps(chunks, result);
  scaleOverlaps(target, source, result);
  return result;
}
}
