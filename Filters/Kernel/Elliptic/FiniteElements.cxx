// SPDX-License-Identifier: BSD-3-Clause
#include "FiniteElements.h"

#include "ElementMatrices.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/MeshElements.h"

#include <atomic>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
constexpr int linearPlaceBits = 3, quadraticPlaceBits = 4;
static_assert(1 << linearPlaceBits >= MaxNodes && 1 << quadraticPlaceBits >= MaxElementNodes,
  "a position in a cell takes this many bits");
constexpr Index widestSlot = std::numeric_limits<std::uint16_t>::max();

/// The lowest cell number reported by several threads.
class FirstCell
{
public:
  void report(Index cell)
  {
    Index least = this->Cell;
    while (cell < least && !this->Cell.compare_exchange_weak(least, cell))
    {
    }
  }
  bool any() const { return this->Cell != none; }
  std::string name() const { return "Cell " + std::to_string(this->Cell); }

private:
  static constexpr Index none = std::numeric_limits<Index>::max();
  std::atomic<Index> Cell{ none };
};

bool isFinite(const SymmetricTensor& c)
{
  return std::all_of(c.begin(), c.end(), [](double x) { return std::isfinite(x); });
}
}

//------------------------------------------------------------------------------
AssemblyPattern::AssemblyPattern(const Mesh& mesh, const AssemblyOptions& options)
  : Input(&mesh)
  , Threads(options.threads)
{
  requireElements(mesh, options.skip);
  const MeshView& view = mesh.view();
  this->Nodes.fill(0);
  const auto addType = [this](int vtkType, int nodes)
  {
    this->Nodes[vtkType] = static_cast<signed char>(nodes);
    this->Stride = std::max(this->Stride, nodes);
  };
  for (const CellBlock& block : mesh.blocks())
  {
    if (!isElement(mesh, block.type))
    {
      continue; // all cells are skipped
    }
    if (mesh.higherOrderCells() == 0)
    {
      addType(static_cast<int>(block.type), topology(block.type).nodes);
    }
    for (Index i = 0; mesh.higherOrderCells() > 0 && i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      if (!(options.skip && options.skip[cell]))
      {
        const ElementKind kind = elementKind(view, cell);
        addType(view.cellTypes[cell], tautline::nodesOf(kind));
        this->Quadratic = this->Quadratic || isQuadratic(kind);
      }
    }
  }
  this->PlaceBits = this->Quadratic ? quadraticPlaceBits : linearPlaceBits;
  const Index size = view.offsets[view.numberOfCells] - view.offsets[0];
  this->Uniform = mesh.blocks().size() == 1 && mesh.unsupportedCells() == 0 &&
    size == this->Stride * view.numberOfCells && !this->Quadratic;
  this->findUses(options.skip);
  this->findColumns();
}

//------------------------------------------------------------------------------
void AssemblyPattern::findUses(const unsigned char* skip)
{
  const MeshView& view = this->Input->view();
  const Index points = view.numberOfPoints;
  // Each part of the cells is counted separately and then written after the previous parts, so that
  // the uses of a point are in the order of the cells for any number of parts.
  constexpr Index maxParts = 8; // each takes four bytes per point
  const Index parts = std::max<Index>(1,
    std::min({ maxParts, static_cast<Index>(resolveThreads(this->Threads)),
      numberOfChunks(view.numberOfCells) }));
  std::vector<std::vector<std::uint32_t>> next(parts);
  const auto forEachUse = [&](Index part, const auto& visit)
  {
    const Index end = view.numberOfCells * (part + 1) / parts;
    for (Index cell = view.numberOfCells * part / parts; cell < end; ++cell)
    {
      const Index* node = view.connectivity + this->firstNode(cell);
      const int nodes = skip && skip[cell] ? 0 : this->nodesOf(cell);
      for (int k = 0; k < nodes; ++k)
      {
        visit(node[k], (cell << this->PlaceBits) + k);
      }
    }
  };
  runChunks(parts, this->Threads,
    [&](Index part)
    {
      next[part].assign(points, 0);
      forEachUse(part, [&](Index node, Index) { ++next[part][node]; });
    });
  // Convert the counts of the parts to positions after the previous parts.
  this->UseOffsets.assign(points + 1, 0);
  for (Index point = 0; point < points; ++point)
  {
    Index sum = 0;
    for (auto& counts : next)
    {
      const Index count = counts[point];
      counts[point] = static_cast<std::uint32_t>(sum);
      sum += count;
    }
    this->UseOffsets[point + 1] = this->UseOffsets[point] + sum;
  }
  this->Uses.resize(this->UseOffsets.back());
  runChunks(parts, this->Threads,
    [&](Index part)
    {
      forEachUse(part,
        [&](Index node, Index use) {
          this->Uses[this->UseOffsets[node] + next[part][node]++] = static_cast<std::uint32_t>(use);
        });
    });
}

//------------------------------------------------------------------------------
void AssemblyPattern::findColumns()
{
  const MeshView& view = this->Input->view();
  const Index points = view.numberOfPoints;
  this->Offsets.assign(points + 1, 0);
  this->Slots.resize(this->Uses.size() * this->Stride);
  std::vector<std::vector<std::int32_t>> chunks(numberOfChunks(points));
  // Each thread marks the points it visits with their position in the current row, and clears the
  // marks after each row.
  struct Marks
  {
    std::vector<std::int32_t> place, row;
  };
  ScratchPool<Marks> pool([points] { return Marks{ std::vector<std::int32_t>(points, -1), {} }; });
  parallelFor(static_cast<Index>(chunks.size()), 1, this->Threads, pool,
    [&](Marks& marks, Index chunk)
    {
      std::vector<std::int32_t>&place = marks.place, &row = marks.row;
      const Index end = std::min(points, (chunk + 1) * ChunkSize);
      for (Index point = chunk * ChunkSize; point < end; ++point)
      {
        row.clear();
        const Index firstUse = this->UseOffsets[point], lastUse = this->UseOffsets[point + 1];
        const auto forEachNode = [&](const auto& visit)
        {
          for (Index use = firstUse; use < lastUse; ++use)
          {
            const Index cell = this->cellOf(use);
            const Index* node = view.connectivity + this->firstNode(cell);
            const int nodes = this->nodesOf(cell);
            for (int k = 0; k < nodes; ++k)
            {
              visit(use * this->Stride + k, static_cast<std::int32_t>(node[k]));
            }
          }
        };
        // Add each neighbor once, in increasing order.
        forEachNode(
          [&](Index, std::int32_t node)
          {
            if (place[node] < 0)
            {
              place[node] = 0;
              row.push_back(node);
            }
          });
        std::sort(row.begin(), row.end());
        for (std::size_t k = 0; k < row.size(); ++k)
        {
          place[row[k]] = static_cast<std::int32_t>(k);
        }
        forEachNode([&](Index slot, std::int32_t node)
          { this->Slots[slot] = static_cast<std::uint16_t>(place[node]); });
        for (std::int32_t node : row)
        {
          place[node] = -1;
        }
        chunks[chunk].insert(chunks[chunk].end(), row.begin(), row.end());
        this->Offsets[point + 1] = static_cast<Index>(row.size());
      }
    });
  // Concatenate the rows of all chunks.
  std::partial_sum(this->Offsets.begin(), this->Offsets.end(), this->Offsets.begin());
  this->Columns.resize(this->Offsets.back());
  forEachChunk(points, this->Threads,
    [&](Index chunk, Index begin, Index)
    {
      std::copy(
        chunks[chunk].begin(), chunks[chunk].end(), this->Columns.begin() + this->Offsets[begin]);
    });
}

//------------------------------------------------------------------------------
void AssemblyPattern::expand(int components, SparseMatrix& matrix) const
{
  const Index points = this->Input->view().numberOfPoints;
  if (components * points > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh is too large for one process: distribute it over several ranks.");
  }
  matrix.size = components * points;
  if (components == 1)
  {
    matrix.offsets = this->Offsets;
    matrix.columns = this->Columns;
  }
  else
  {
    matrix.offsets.resize(matrix.size + 1);
    matrix.columns.resize(components * components * this->Columns.size());
    matrix.offsets[0] = 0;
    forEachChunk(points, this->Threads,
      [&](Index, Index begin, Index end)
      {
        for (Index point = begin; point < end; ++point)
        {
          const Index first = this->Offsets[point], width = this->Offsets[point + 1] - first;
          Index k = components * components * first;
          for (int a = 0; a < components; ++a)
          {
            // Each column becomes a block of columns.
            for (Index j = 0; j < width; ++j)
            {
              for (int b = 0; b < components; ++b)
              {
                matrix.columns[k++] = components * this->Columns[first + j] + b;
              }
            }
            matrix.offsets[components * point + a + 1] = k;
          }
        }
      });
  }
  matrix.values.assign(matrix.columns.size(), 0.0);
}

//------------------------------------------------------------------------------
/// The element matrices of the cells from firstCell to endCell, each in `entries` numbers of the
/// buffer.
template <class Element>
void AssemblyPattern::computeBatch(const Element& element, const MeshView& view, Index firstCell,
  Index endCell, Index entries, double* buffer) const
{
  forEachChunk(endCell - firstCell, this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Index cell = firstCell + i;
        if (this->nodesOf(cell) == 0)
        {
          continue;
        }
        const Index* node = view.connectivity + this->firstNode(cell);
        const ElementKind kind = elementKind(view, cell);
        withElement(kind,
          [&](auto nodesOfCell, auto dimensionOfCell)
          {
            constexpr int nodes = decltype(nodesOfCell)::value;
            constexpr int dimension = decltype(dimensionOfCell)::value;
            Vec3 p[nodes];
            for (int k = 0; k < nodes; ++k)
            {
              p[k] = pointOf(view, node[k]);
            }
            element.template compute<nodes, dimension>(cell, kind, p, &buffer[i * entries]);
          });
      }
    });
}

//------------------------------------------------------------------------------
/// Adds the rows of one use in an element matrix k to the rows of its point.
template <int Components>
void AssemblyPattern::addUse(
  Index use, Index firstColumn, Index width, const double* k, double* row) const
{
  const Index cell = this->cellOf(use);
  const int nodes = this->nodesOf(cell);
  for (int j = 0; j < nodes; ++j)
  {
    Index slot = this->Slots[use * this->Stride + j];
    if (width > widestSlot)
    {
      const auto column = this->Columns.begin() + firstColumn;
      const Index node = this->Input->view().connectivity[this->firstNode(cell) + j];
      slot = std::lower_bound(column, column + width, node) - column;
    }
    for (int a = 0; a < Components; ++a)
    {
      for (int b = 0; b < Components; ++b)
      {
        row[Components * (width * a + slot) + b] += k[Components * (nodes * a + j) + b];
      }
    }
  }
}

//------------------------------------------------------------------------------
/**
 * Cells are processed in batches: first the matrices of a batch are computed by cell; then every
 * row adds its entries of the batch, in increasing order of cells. Thus, no two threads write to
 * one row, the order of sums is fixed, and memory use stays small.
 */
template <class Element>
void AssemblyPattern::gather(
  const Element& element, SparseMatrix& matrix, const double* points) const
{
  constexpr int components = Element::Components;
  this->expand(components, matrix);
  MeshView view = this->Input->view();
  view.points = points ? points : view.points;
  const Index entries = components * components * this->Stride * this->Stride;
  // The buffer is not larger than the matrix itself, unless that is small. The number of batches is
  // small, since each visits all rows.
  constexpr Index smallest = 1 << 15;
  const Index batch = std::min(
    view.numberOfCells, std::max(smallest, static_cast<Index>(matrix.values.size()) / entries));
  std::vector<double> buffer(batch * entries);
  std::vector<std::int32_t> done(view.numberOfPoints, 0); // uses of each point
  FirstCell wrong;
  for (Index firstCell = 0; firstCell < view.numberOfCells; firstCell += batch)
  {
    const Index endCell = std::min(view.numberOfCells, firstCell + batch);
    this->computeBatch(element, view, firstCell, endCell, entries, buffer.data());
    forEachChunk(view.numberOfPoints, this->Threads,
      [&](Index, Index begin, Index end)
      {
        for (Index point = begin; point < end; ++point)
        {
          const Index lastUse = this->UseOffsets[point + 1];
          Index use = this->UseOffsets[point] + done[point];
          if (use == lastUse || this->cellOf(use) >= endCell)
          {
            continue;
          }
          const Index first = this->Offsets[point], width = this->Offsets[point + 1] - first;
          double* row = &matrix.values[components * components * first];
          for (; use < lastUse && this->cellOf(use) < endCell; ++use)
          {
            const Index cell = this->cellOf(use);
            const int nodes = this->nodesOf(cell), place = this->placeOf(use);
            const double* k =
              &buffer[(cell - firstCell) * entries + place * components * components * nodes];
            this->addUse<components>(use, first, width, k, row);
            // An entry that is not finite makes the diagonal of its row not finite.
            if (!std::isfinite(k[components * place]))
            {
              wrong.report(cell);
            }
          }
          done[point] = static_cast<std::int32_t>(use - this->UseOffsets[point]);
        }
      });
  }
  if (wrong.any())
  {
    throw Error(wrong.name() +
      " has a coordinate or a coefficient that is not finite, or so large that products overflow.");
  }
}

//------------------------------------------------------------------------------
void AssemblyPattern::assemble(
  const DiffusionOperator& pde, SparseMatrix& matrix, const double* points) const
{
  if (!std::isfinite(pde.reaction) || (!pde.tensors && !isFinite(pde.tensor)))
  {
    throw Error("The coefficients of the differential operator are not finite.");
  }
  this->gather(DiffusionElement(pde), matrix, points);
}

//------------------------------------------------------------------------------
void AssemblyPattern::assemble(
  const ElasticOperator& pde, SparseMatrix& matrix, const double* points) const
{
  const bool planar = elasticComponents(*this->Input) == 2;
  const double nu = pde.poissonRatio;
  const double limit = planar && pde.plane == PlaneState::Stress ? 1.0 : 0.5;
  if (!(pde.youngsModulus > 0) || !std::isfinite(pde.youngsModulus))
  {
    throw Error("Young's modulus must be positive and finite.");
  }
  if (!(nu > -1 && nu < limit))
  {
    throw Error("Poisson's ratio must be between -1 and " +
      std::string(limit < 1
          ? "0.5: a body with 0.5 is incompressible, which linear elements cannot represent."
          : "1."));
  }
  if (pde.stiffening)
  {
    for (Index cell = 0; cell < this->Input->view().numberOfCells; ++cell)
    {
      const bool positive = pde.stiffening[cell] > 0 && std::isfinite(pde.stiffening[cell]);
      if (this->nodesOf(cell) > 0 && !positive)
      {
        throw Error("The stiffening factor of cell " + std::to_string(cell) +
          " is not a positive, finite number.");
      }
    }
  }
  if (planar)
  {
    this->gather(ElasticElement<2>(pde, this->Input->frame()), matrix, points);
  }
  else
  {
    this->gather(ElasticElement<3>(pde, this->Input->frame()), matrix, points);
  }
}

//------------------------------------------------------------------------------
SparseMatrix stiffnessMatrix(
  const Mesh& mesh, const DiffusionOperator& pde, const AssemblyOptions& options)
{
  return AssemblyPattern(mesh, options).assemble(pde);
}

//------------------------------------------------------------------------------
SparseMatrix stiffnessMatrix(
  const Mesh& mesh, const ElasticOperator& pde, const AssemblyOptions& options)
{
  return AssemblyPattern(mesh, options).assemble(pde);
}

//------------------------------------------------------------------------------
int elasticComponents(const Mesh& mesh)
{
  if (mesh.dimension() == Dimension::Surface)
  {
    throw Error("Linear elasticity needs a planar mesh or a volume mesh; this is a surface in "
                "space, a shell.");
  }
  return mesh.dimension() == Dimension::Planar ? 2 : 3;
}

//------------------------------------------------------------------------------
std::vector<double> loadVector(
  const Mesh& mesh, const double* f, int components, const AssemblyOptions& options)
{
  requireElements(mesh, options.skip);
  const MeshView& view = mesh.view();
  std::vector<double> load(components * view.numberOfPoints, 0.0);
  const ElementRules rules = elementRules(elementRule);
  const auto addCell = [&](Index cell, ElementKind kind, auto nodesOfCell, auto dimensionOfCell)
  {
    constexpr int nodes = decltype(nodesOfCell)::value;
    constexpr int dimension = decltype(dimensionOfCell)::value;
    const Index* node = view.connectivity + view.offsets[cell];
    Vec3 p[nodes];
    for (int k = 0; k < nodes; ++k)
    {
      p[k] = pointOf(view, node[k]);
    }
    double mass[nodes][nodes] = {};
    for (const ReferencePoint& reference : rules[static_cast<int>(kind)])
    {
      ElementSample<nodes> s;
      sampleElement<nodes, dimension>(reference, p, s);
      for (int a = 0; a < nodes; ++a)
      {
        for (int b = 0; b < nodes; ++b)
        {
          // On a linear simplex the integrals of the products have closed forms.
          mass[a][b] += s.weight *
            (nodes == dimension + 1 ? (a == b ? 2.0 : 1.0) / (nodes * (nodes + 1))
                                    : s.value[a] * s.value[b]);
        }
      }
    }
    for (int a = 0; a < nodes; ++a)
    {
      for (int b = 0; b < nodes; ++b)
      {
        for (int c = 0; c < components; ++c)
        {
          load[components * node[a] + c] += mass[a][b] * f[components * node[b] + c];
        }
      }
    }
  };
  for (const CellBlock& block : mesh.blocks())
  {
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const ElementKind kind = elementKind(view, cell);
      if (!(options.skip && options.skip[cell]))
      {
        withElement(
          kind, [&](auto nodes, auto dimension) { addCell(cell, kind, nodes, dimension); });
      }
    }
  }
  return load;
}
}
