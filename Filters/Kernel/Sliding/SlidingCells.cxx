// SPDX-License-Identifier: BSD-3-Clause
#include "SlidingCells.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
SlidingCells::SlidingCells(const Mesh& mesh, const ConstrainedPoints& constrained)
  : Normal(mesh.normal())
  , Sign(mesh.mirrored() ? -1.0 : 1.0)
{
  const MeshView& view = mesh.view();
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  this->Starts.assign(view.numberOfPoints + 1, 0);
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == dimension && i < block.count; ++i)
    {
      pollInterruption(i);
      const Index* nodes = view.connectivity + view.offsets[block.cell(i)];
      bool moves = false, finite = true;
      for (int k = 0; k < t.nodes; ++k)
      {
        const Vec3 x = pointOf(view, nodes[k]);
        moves = moves || constrained.freedom(nodes[k]) != Freedom::None;
        finite = finite && std::isfinite(dot(x, x));
      }
      if (moves && finite)
      {
        this->Cells.push_back({ &t, nodes, block.cell(i) });
        std::for_each(nodes, nodes + t.nodes, [&](Index p) { ++this->Starts[p + 1]; });
      }
    }
  }
  for (std::size_t p = 0; p + 1 < this->Starts.size(); ++p)
  {
    this->Starts[p + 1] += this->Starts[p];
  }
  this->CellsOf.resize(this->Starts.back());
  std::vector<std::int32_t> next(this->Starts.begin(), this->Starts.end() - 1);
  for (std::size_t c = 0; c < this->Cells.size(); ++c)
  {
    const Cell& cell = this->Cells[c];
    std::for_each(cell.nodes, cell.nodes + cell.t->nodes,
      [&](Index p) { this->CellsOf[next[p]++] = static_cast<std::int32_t>(c); });
  }
}

//------------------------------------------------------------------------------
std::vector<double> SlidingCells::shortestEdges(const std::vector<Vec3>& x) const
{
  constexpr double ofMean = 0.1;
  std::vector<double> shortest(x.size(), -1.0);
  double sum = 0;
  Index count = 0;
  for (const Cell& cell : this->Cells)
  {
    for (int e = 0; e < cell.t->edges; ++e)
    {
      const Index a = cell.nodes[cell.t->edgeNodes[e][0]], b = cell.nodes[cell.t->edgeNodes[e][1]];
      const double length = norm(x[b] - x[a]);
      sum += length;
      ++count;
      for (const Index p : { a, b })
      {
        shortest[p] = shortest[p] < 0 ? length : std::min(shortest[p], length);
      }
    }
  }
  const double least = ofMean * sum / static_cast<double>(std::max<Index>(1, count));
  for (double& length : shortest)
  {
    length = std::max(length, least);
  }
  return shortest;
}

//------------------------------------------------------------------------------
void SlidingCells::flagCells(const std::vector<char>& points, std::vector<char>& cells) const
{
  cells.assign(this->Cells.size(), 0);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const Cell& cell = this->Cells[c];
    cells[c] =
      std::any_of(cell.nodes, cell.nodes + cell.t->nodes, [&](Index p) { return points[p] != 0; });
  }
}

void SlidingCells::flagPoints(const std::vector<char>& cells, std::vector<char>& points) const
{
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const Cell& cell = this->Cells[c];
    for (int k = 0; cells[c] && k < cell.t->nodes; ++k)
    {
      points[cell.nodes[k]] = 1;
    }
  }
}

//------------------------------------------------------------------------------
std::vector<Vec3> pointsOf(const double* points, Index count)
{
  std::vector<Vec3> x(count);
  for (Index p = 0; p < count; ++p)
  {
    x[p] = { points[3 * p], points[3 * p + 1], points[3 * p + 2] };
  }
  return x;
}

void storeMovedPoints(const std::vector<Vec3>& start, const std::vector<Vec3>& x, double* points)
{
  for (std::size_t p = 0; p < x.size(); ++p)
  {
    if (x[p] != start[p])
    {
      std::copy(x[p].begin(), x[p].end(), points + 3 * p);
    }
  }
}
}
