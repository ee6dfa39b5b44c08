#include "SimplexMesh.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
TargetSimplex targetFrom(const double* inverse, int dimension, double scale)
{
  double rows[4][3] = {};
  for (int k = 0; k < dimension; ++k)
  {
    for (int c = 0; c < dimension; ++c)
    {
      rows[k + 1][c] = scale * inverse[3 * k + c];
      rows[0][c] -= rows[k + 1][c];
    }
  }
  TargetSimplex target;
  int e = 0;
  for (int k = 0; k <= dimension; ++k)
  {
    for (int l = k + 1; l <= dimension; ++l)
    {
      target.edge[e++] =
        -(rows[k][0] * rows[l][0] + rows[k][1] * rows[l][1] + rows[k][2] * rows[l][2]);
    }
  }
  const double(*m)[3] = rows + 1;
  target.det = dimension == 2 ? m[0][0] * m[1][1] - m[0][1] * m[1][0]
                              : m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
      m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
      m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return target;
}

/// The target of the simplex whose first two vertices are exchanged, as in a mirror.
void swapFirstTwo(TargetSimplex& shape, int dimension)
{
  std::swap(shape.edge[1], shape.edge[dimension == 3 ? 3 : 2]);
  if (dimension == 3)
  {
    std::swap(shape.edge[2], shape.edge[4]);
  }
}

/// Calls visit(topology, cell, corner, vertices) for each simplex of finite points at the corners
/// of the cells of a dimension.
template <class Visit>
void visitSimplices(
  const Mesh& mesh, int dimension, const std::vector<std::int32_t>& vertexOf, const Visit& visit)
{
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != dimension)
    {
      continue;
    }
    for (Index i = 0; i < block.count; ++i)
    {
      pollInterruption(i);
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      for (int s = 0; s < t.samples; ++s)
      {
        std::int32_t v[4] = {};
        bool finite = true;
        for (int k = 0; k <= dimension; ++k)
        {
          v[k] = vertexOf[node[t.cornerNodes[s][k]]];
          finite = finite && v[k] >= 0;
        }
        if (finite)
        {
          visit(t, cell, s, v);
        }
      }
    }
  }
}

/// The targets of the corners of the ideal cells, and where those of each type begin.
std::vector<TargetSimplex> idealShapes(
  const Mesh& mesh, int dimension, std::vector<int>& firstShape)
{
  std::vector<TargetSimplex> shapes;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension == dimension)
    {
      firstShape[topologyIndex(block.type)] = static_cast<int>(shapes.size());
      for (int s = 0; s < t.samples; ++s)
      {
        shapes.push_back(targetFrom(t.idealInverse[s].data(), dimension, 1.0));
      }
    }
  }
  return shapes;
}
}

//------------------------------------------------------------------------------
double powerOfTwo(double length)
{
  return length > 0 && std::isfinite(length) ? std::exp2(std::round(std::log2(length))) : 1.0;
}

//------------------------------------------------------------------------------
void SimplexMesh::cut(const Mesh& mesh, const std::vector<std::int32_t>& vertexOf,
  const Targets* targets, const SimplexFrame* frame)
{
  const MeshView& view = mesh.view();
  const int corners = this->Dim + 1;

  const auto forEachSimplex = [&](const auto& visit)
  { visitSimplices(mesh, this->Dim, vertexOf, visit); };

  // Sorted by their first vertex in the new numbering.
  std::vector<std::int32_t> starts(this->vertices() + 1, 0);
  Index total = 0;
  double lengths = 0;
  forEachSimplex(
    [&](const CellTopology&, Index, int, const std::int32_t* v)
    {
      ++starts[*std::min_element(v, v + corners) + 1];
      ++total;
      constexpr Index every = 16; // a sample of the edges is enough for a scale
      if (total % every == 1)
      {
        const double length =
          norm(pointOf(view, this->Point[v[1]]) - pointOf(view, this->Point[v[0]]));
        lengths += std::isfinite(length) ? length : 0.0;
      }
    });
  if (total > std::numeric_limits<std::int32_t>::max() / corners)
  {
    throw Error(
      "The mesh has more elements than the optimizers take (about 500 million): split it.");
  }
  this->Simplices = static_cast<std::int32_t>(total);
  this->Scale = frame
    ? frame->scale
    : powerOfTwo(total > 0 ? lengths / static_cast<double>((total + 15) / 16) : 1.0);

  // The shapes of ideal corners are few; one for all simplices needs no index.
  std::vector<int> firstShape(NumberOfCellTypes, 0);
  if (targets)
  {
    this->Shapes.resize(this->Simplices);
  }
  else
  {
    this->Shapes = idealShapes(mesh, this->Dim, firstShape);
  }
  const bool several = targets || this->Shapes.size() > 1;

  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  // A counting sort: each simplex goes to the next place of its first vertex.
  this->Corners.resize(static_cast<std::size_t>(corners) * this->Simplices);
  this->Cell.resize(this->Simplices);
  this->Shape.resize(several ? this->Simplices : 0);
  forEachSimplex(
    [&](const CellTopology& t, Index cell, int s, const std::int32_t* v)
    {
      const std::int32_t place = starts[*std::min_element(v, v + corners)]++;
      std::int32_t* corner = this->Corners.data() + static_cast<std::size_t>(corners) * place;
      std::copy_n(v, corners, corner);
      if (this->Mirrored)
      {
        std::swap(corner[0], corner[1]);
      }
      this->Cell[place] = static_cast<std::int32_t>(cell);
      if (targets)
      {
        this->Shape[place] = place;
        this->Shapes[place] = targetFrom(
          targets->inverse.data() + 9 * (targets->offsets[cell] + s), this->Dim, this->Scale);
      }
      else if (several)
      {
        this->Shape[place] = firstShape[topologyIndex(t.type)] + s;
      }
    });
  if (this->Mirrored && several)
  {
    for (TargetSimplex& shape : this->Shapes)
    {
      swapFirstTwo(shape, this->Dim);
    }
  }
}
}
