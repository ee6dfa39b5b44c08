// SPDX-License-Identifier: BSD-3-Clause
#include "SimplexMesh.h"

#include "tautline/Core/CountingSort.h"
#include "tautline/Core/LargeArray.h"

#include <algorithm>
#include <array>
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

/// The target of the mirrored simplex, with its first two vertices exchanged.
void swapFirstTwo(TargetSimplex& shape, int dimension)
{
  std::swap(shape.edge[1], shape.edge[dimension == 3 ? 3 : 2]);
  if (dimension == 3)
  {
    std::swap(shape.edge[2], shape.edge[4]);
  }
}

/// The simplices at the corners of the cells of a dimension: cell after cell, and corner after
/// corner.
template <int Dim>
class CornerSimplices
{
public:
  CornerSimplices(const Mesh& mesh, const std::vector<std::int32_t>& vertexOf)
    : View(mesh.view())
    , VertexOf(vertexOf)
  {
    for (const CellBlock& block : mesh.blocks())
    {
      const CellTopology& t = topology(block.type);
      if (t.dimension == Dim)
      {
        this->Parts.push_back({ &block, &t });
        this->OfType[topologyIndex(block.type)] = &t;
        this->Cells += block.count;
        this->Simplices += block.count * t.samples;
      }
    }
    this->AllSimplices = this->Parts.size() == 1 && this->Parts.front().topology->samples == 1;
    this->AllFinite = mesh.nonFinitePoints() == 0;
  }

  /// The number of cells of the dimension.
  Index cells() const { return this->Cells; }
  /// An upper bound, including simplices with nonfinite points.
  Index simplices() const { return this->Simplices; }

  /// Whether all cells are simplices, of one block and of finite points: one simplex per cell.
  bool isPlain() const { return this->AllSimplices && this->AllFinite; }

  /// The cell at a position, for plain cells.
  Index cellAt(Index place) const { return this->Parts.front().block->cell(place); }
  /// The topology of a cell of the dimension.
  const CellTopology& topologyOf(Index cell) const
  {
    return this->Parts.size() == 1
      ? *this->Parts.front().topology
      : *this->OfType[topologyIndex(cornerType(this->View.cellTypes[cell]))];
  }

  /// Calls visit(cell, corner, vertices) for each simplex with finite points of a cell, given by
  /// its position among the cells of the dimension.
  template <class Visit>
  void visit(Index place, const Visit& visit) const
  {
    if (this->AllSimplices) // the usual case: a simplex is its only corner
    {
      const Index cell = this->Parts.front().block->cell(place);
      const Index* node = this->View.connectivity + this->View.offsets[cell];
      std::int32_t v[Dim + 1], lowest = 0;
      for (int k = 0; k <= Dim; ++k)
      {
        v[k] = this->VertexOf[node[k]];
        lowest = std::min(lowest, v[k]);
      }
      if (lowest >= 0)
      {
        visit(cell, 0, v);
      }
      return;
    }
    auto part = this->Parts.begin();
    for (; place >= part->block->count; ++part)
    {
      place -= part->block->count;
    }
    const Index cell = part->block->cell(place);
    for (int s = 0; s < part->topology->samples; ++s)
    {
      std::int32_t v[Dim + 1];
      if (this->find(*part->topology, cell, s, v))
      {
        visit(cell, s, v);
      }
    }
  }

  /// The vertices of the simplex at a corner; false if one has no number.
  bool find(const CellTopology& t, Index cell, Index corner, std::int32_t* v) const
  {
    const Index* node = this->View.connectivity + this->View.offsets[cell];
    bool finite = true;
    for (int k = 0; k <= Dim; ++k)
    {
      v[k] = this->VertexOf[node[t.cornerNodes[corner][k]]];
      finite = finite && v[k] >= 0;
    }
    return finite;
  }

  /// The mean length of the first edge of every 16th simplex, which suffices for a scale; 1 if
  /// there is none.
  double meanLength(const std::vector<std::int32_t>& points, int threads) const
  {
    constexpr Index every = 16;
    Lengths lengths = this->firstEdges(every, points, threads);
    if (lengths.count == 0)
    {
      lengths = this->firstEdges(1, points, threads); // the sampled ones have nonfinite points
    }
    return lengths.count > 0 ? lengths.sum / static_cast<double>(lengths.count) : 1.0;
  }

private:
  struct Part
  {
    const CellBlock* block;
    const CellTopology* topology;
  };

  struct Lengths
  {
    double sum = 0;
    Index count = 0;
  };

  /// The first edges of the simplices with finite points among every `every`-th one.
  Lengths firstEdges(Index every, const std::vector<std::int32_t>& points, int threads) const
  {
    const Index samples = (this->Simplices + every - 1) / every;
    std::vector<Lengths> ofChunk(numberOfChunks(samples));
    forEachChunk(samples, threads,
      [&](Index chunk, Index begin, Index end)
      {
        for (Index sample = begin; sample < end; ++sample)
        {
          this->addFirstEdge(sample * every, points, ofChunk[chunk]);
        }
      });
    Lengths all;
    for (const Lengths& lengths : ofChunk)
    {
      all.sum += lengths.sum;
      all.count += lengths.count;
    }
    return all;
  }

  /// Adds the length of the first edge of a simplex at a position, unless it has nonfinite points.
  void addFirstEdge(Index place, const std::vector<std::int32_t>& points, Lengths& lengths) const
  {
    auto part = this->Parts.begin();
    for (; place >= part->block->count * part->topology->samples; ++part)
    {
      place -= part->block->count * part->topology->samples;
    }
    const Index samples = part->topology->samples;
    std::int32_t v[Dim + 1];
    if (this->find(*part->topology, part->block->cell(place / samples), place % samples, v))
    {
      const double length =
        norm(pointOf(this->View, points[v[1]]) - pointOf(this->View, points[v[0]]));
      lengths.sum += std::isfinite(length) ? length : 0.0;
      ++lengths.count;
    }
  }

  const MeshView& View;
  const std::vector<std::int32_t>& VertexOf;
  std::vector<Part> Parts;
  std::array<const CellTopology*, NumberOfCellTypes> OfType = {};
  Index Cells = 0, Simplices = 0;
  bool AllSimplices = false; ///< all cells are simplices of one block
  bool AllFinite = false;    ///< whether all points are finite
};

/// The targets of the corners of the ideal cells, with the offsets of each type.
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
  const Targets* targets, const SimplexFrame* frame, int threads)
{
  this->Dim == 3 ? this->cutInto<3>(mesh, vertexOf, targets, frame, threads)
                 : this->cutInto<2>(mesh, vertexOf, targets, frame, threads);
}

//------------------------------------------------------------------------------
template <int Dim>
void SimplexMesh::cutInto(const Mesh& mesh, const std::vector<std::int32_t>& vertexOf,
  const Targets* targets, const SimplexFrame* frame, int threads)
{
  constexpr int corners = Dim + 1;
  const CornerSimplices<Dim> source(mesh, vertexOf);
  const auto first = [](const std::int32_t* v) { return *std::min_element(v, v + corners); };

  if (source.simplices() > std::numeric_limits<std::int32_t>::max() / corners)
  {
    throw Error(
      "The mesh has more elements than the optimizers support (about 500 million): split it.");
  }
  // Sort by the first vertex in the new numbering: each simplex goes to the next position of this
  // vertex. The vertices of plain cells are kept so that the position of a cell is known early.
  LargeArray<std::int32_t> kept(source.isPlain() ? corners * source.cells() : 0);
  CountingSort places(source.cells(), this->vertices(), threads,
    [&](Index cell, const auto& use)
    {
      source.visit(cell,
        [&](Index, int, const std::int32_t* v)
        {
          use(first(v));
          if (!kept.empty())
          {
            std::copy_n(v, corners, kept.data() + corners * cell);
          }
        });
    });
  this->Simplices = places.starts().back();
  this->Scale = frame ? frame->scale : powerOfTwo(source.meanLength(this->Point, threads));

  // The shapes of ideal corners are few; one for all simplices needs no index.
  std::vector<int> firstShape(NumberOfCellTypes, 0);
  if (targets)
  {
    this->Shapes.resize(this->Simplices);
  }
  else
  {
    this->Shapes = idealShapes(mesh, Dim, firstShape);
  }
  const bool several = targets || this->Shapes.size() > 1;
  this->Cell.resize(this->Simplices);
  this->Corners.resize(static_cast<std::size_t>(corners) * this->Simplices);
  this->Shape.resize(several ? this->Simplices : 0);
  // Cells are read in order and written to their final positions, because the processor waits for
  // reads but not for writes.
  const auto put = [&](Index cell, int s, const std::int32_t* v, std::int32_t place)
  {
    this->Cell[place] = static_cast<std::int32_t>(cell);
    std::int32_t* corner = this->Corners.data() + corners * static_cast<std::size_t>(place);
    std::copy_n(v, corners, corner);
    if (this->Mirrored)
    {
      std::swap(corner[0], corner[1]);
    }
    if (targets)
    {
      this->Shape[place] = place;
      this->Shapes[place] =
        targetFrom(targets->inverse.data() + 9 * (targets->offsets[cell] + s), Dim, this->Scale);
    }
    else if (several)
    {
      const CellTopology& t = source.topologyOf(cell);
      this->Shape[place] = firstShape[topologyIndex(t.type)] + s;
    }
  };
  if (!kept.empty())
  {
    const auto vertices = [&kept](Index cell) { return kept.data() + corners * cell; };
    places.place(
      [&](Index cell, const auto& placeOf)
      {
        const std::int32_t* v = vertices(cell);
        put(source.cellAt(cell), 0, v, placeOf(first(v)));
      },
      [&](Index cell, const auto& placeOf)
      {
        const std::int32_t place = placeOf(first(vertices(cell)));
        constexpr int toWrite = 1;
        __builtin_prefetch(this->Cell.data() + place, toWrite);
        __builtin_prefetch(
          this->Corners.data() + corners * static_cast<std::size_t>(place), toWrite);
      });
  }
  else
  {
    places.place(
      [&](Index cellPlace, const auto& placeOf)
      {
        source.visit(cellPlace,
          [&](Index cell, int s, const std::int32_t* v) { put(cell, s, v, placeOf(first(v))); });
      });
  }
  if (this->Mirrored && several)
  {
    for (TargetSimplex& shape : this->Shapes)
    {
      swapFirstTwo(shape, Dim);
    }
  }
}
}
