// SPDX-License-Identifier: BSD-3-Clause
// The elements with a free vertex, by any metric: see SimplexTotals.cxx for the inverse mean ratio.
#include "OptimizationProblem.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/MeshElements.h"
#include "tautline/Quality/JudgedValues.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// An element below this fraction of the share of the worst element in a p-mean has no effect on
/// it.
constexpr double smallestShare = 1e-5;

/// The free vertex of each point, or -1.
std::vector<std::int32_t> vertexOfPoint(const SimplexMesh& simplices, Index points)
{
  std::vector<std::int32_t> vertices(points, -1);
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    vertices[simplices.point(v)] = v;
  }
  return vertices;
}

/// Calls visit(chunk, cell, points, nodes) for each element of a block, chunks in parallel.
template <class Visit>
void forEachElement(const Mesh& mesh, const CellBlock& block, int threads, const Visit& visit)
{
  const MeshView& view = mesh.view();
  const int nodes = topology(block.type).nodes;
  forEachChunk(isElement(mesh, block.type) ? block.count : 0, threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Index cell = block.cell(i);
        visit(chunk, cell, view.connectivity + view.offsets[cell], nodes);
      }
    });
}
}

//------------------------------------------------------------------------------
OptimizationProblem::Measured OptimizationProblem::measure(const Objective& judged) const
{
  const Mesh& mesh = *this->Moving;
  Measured measured;
  measured.values.resize(mesh.view().numberOfCells);
  measured.validity.resize(mesh.view().numberOfCells);
  mesh.classifyCells(measured.validity.data(), this->Options.threads);
  evaluateJudged(mesh, judged.metric, judged.evaluation, measured.values.data());
  return measured;
}

//------------------------------------------------------------------------------
double OptimizationProblem::worstMovable(const Objective& judged, const Measured& measured)
{
  const Mesh& mesh = *this->Moving;
  const std::vector<std::int32_t> vertex =
    vertexOfPoint(*this->Simplices, mesh.view().numberOfPoints);
  const bool larger = metricInfo(judged.metric).direction == Direction::LargerIsBetter;
  const auto worse = [larger](double a, double b)
  { return larger ? std::min(a, b) : std::max(a, b); };
  double worst = (larger ? 1 : -1) * std::numeric_limits<double>::infinity();
  for (const CellBlock& block : mesh.blocks())
  {
    std::vector<double> ofChunk(numberOfChunks(block.count), worst);
    forEachElement(mesh, block, this->Options.threads,
      [&](Index chunk, Index cell, const Index* points, int nodes)
      {
        const bool movable =
          std::any_of(points, points + nodes, [&](Index p) { return vertex[p] >= 0; });
        if (movable && measured.validity[cell] == Valid)
        {
          ofChunk[chunk] = worse(ofChunk[chunk], measured.values[cell]);
        }
      });
    worst = std::accumulate(ofChunk.begin(), ofChunk.end(), worst, worse);
  }
  return larger ? -this->TheRanks.maximum(-worst) : this->TheRanks.maximum(worst);
}

//------------------------------------------------------------------------------
std::vector<unsigned char> OptimizationProblem::verticesNear(
  const Objective& judged, const Measured& measured, double worst, double power) const
{
  const Mesh& mesh = *this->Moving;
  const std::vector<std::int32_t> vertex =
    vertexOfPoint(*this->Simplices, mesh.view().numberOfPoints);
  const bool larger = metricInfo(judged.metric).direction == Direction::LargerIsBetter;
  const double fraction = std::pow(smallestShare, 1.0 / power);
  std::vector<unsigned char> flags(this->Simplices->freeVertices(), 0);
  for (const CellBlock& block : mesh.blocks())
  {
    if (!metricInfo(judged.metric).definedOn(block.type))
    {
      continue;
    }
    forEachElement(mesh, block, this->Options.threads,
      [&](Index, Index cell, const Index* points, int nodes)
      {
        const double value = measured.values[cell];
        // A NaN value is treated as near.
        if (larger ? value * fraction > worst : std::abs(value) < fraction * std::abs(worst))
        {
          return;
        }
        for (int k = 0; k < nodes; ++k)
        {
          if (const std::int32_t v = vertex[points[k]]; v >= 0)
          {
            // Threads may write the same flag concurrently, but they write the same value.
            __atomic_store_n(&flags[v], static_cast<unsigned char>(1), __ATOMIC_RELAXED);
          }
        }
      });
  }
  return flags;
}
}
