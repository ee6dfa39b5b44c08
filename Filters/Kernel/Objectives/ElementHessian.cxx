#include "ElementHessian.h"

#include "ObjectiveSumState.h"

#include <cmath>

namespace tautline
{
namespace
{
/// Step of the differences, relative to the shortest edge: far below the height of a poor element,
/// far above rounding.
constexpr double relativeStep = 1e-6;

/// Rows of the Hessian of an element, and numbers in its lower triangle.
constexpr int rowsFor(int nodes)
{
  return 3 * (nodes - 1);
}
constexpr int entriesFor(int nodes)
{
  return rowsFor(nodes) * (rowsFor(nodes) + 1) / 2;
}
constexpr int entry(int row, int column)
{
  return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
}

Index batchesOf(const ElementSum::Chunk& chunk)
{
  return (chunk.length() + PacketWidth - 1) / PacketWidth;
}

/// Where the numbers of each chunk begin; the last is their total.
std::vector<Index> offsetsOf(const ElementSum& elements)
{
  std::vector<Index> offsets = { 0 };
  for (const ElementSum::Chunk& chunk : elements.chunks())
  {
    const int nodes = topology(elements.mesh().blocks()[chunk.block].type).nodes;
    offsets.push_back(offsets.back() + batchesOf(chunk) * entriesFor(nodes));
  }
  return offsets;
}

Packet shortestEdge(const CellTopology& topology, const Batch& batch)
{
  Packet shortest2 = broadcast(HUGE_VAL);
  for (int e = 0; e < topology.edges; ++e)
  {
    Packet edge[3];
    subtract(batch.points[topology.edgeNodes[e][1]], batch.points[topology.edgeNodes[e][0]], edge);
    shortest2 = min(shortest2, dot(edge, edge));
  }
  return sqrt(shortest2);
}

/// The lower triangles of a batch, by differences of the gradients of the terms.
template <int Nodes, class Slope>
void differences(
  const BatchContext& context, BatchEvaluator evaluate, const Slope& slope, Batch& batch, Packet* h)
{
  constexpr int rows = rowsFor(Nodes);
  // Relative to the first node: far from the origin the step would drown in rounding.
  for (int k = Nodes - 1; k >= 0; --k)
  {
    subtract(batch.points[k], batch.points[0], batch.points[k]);
  }
  const Packet step = relativeStep * shortestEdge(*context.topology, batch);
  Packet full[rows][rows];
  for (int j = 0; j < rows; ++j)
  {
    Packet& coordinate = batch.points[1 + j / 3][j % 3];
    const Packet start = coordinate, ahead = start + step, behind = start - step;
    const Packet over = finiteOrZero(1.0 / (ahead - behind));
    for (const double sign : { 1.0, -1.0 })
    {
      coordinate = sign > 0 ? ahead : behind;
      evaluate(context, batch);
      batch.value = finiteOrZero(batch.value);
      const Packet factor = sign * over * slope(context, batch);
      for (int i = 0; i < rows; ++i)
      {
        const Packet part = factor * finiteOrZero(batch.gradient[1 + i / 3][i % 3]);
        full[i][j] = sign > 0 ? part : Packet(full[i][j] + part);
      }
    }
    coordinate = start;
  }
  const bool mirrored = context.mesh->mirrored() && context.mesh->dimension() == Dimension::Volume;
  for (int i = 0; i < rows; ++i)
  {
    for (int j = 0; j <= i; ++j)
    {
      const bool turned = mirrored && (i % 3 == 0) != (j % 3 == 0);
      h[entry(i, j)] =
        onlyCells(batch, finiteOrZero((turned ? -0.5 : 0.5) * (full[i][j] + full[j][i])));
    }
  }
}

/**
 * @brief Turns rows and columns p and q of the symmetric matrices a so that a[p][q] becomes 0, and
 * the columns of v with them.
 */
template <int Rows>
void rotate(Packet (&a)[Rows][Rows], Packet (&v)[Rows][Rows], int p, int q)
{
  const Packet apq = a[p][q];
  const Packet theta = 0.5 * (a[q][q] - a[p][p]) / apq;
  const Packet signOfTheta = select(theta < 0.0, broadcast(-1.0), broadcast(1.0));
  // A vanishing entry, or one so small that theta overflows, needs no rotation.
  const Packet t = finiteOrZero(signOfTheta / (abs(theta) + sqrt(theta * theta + 1.0)));
  const Packet c = 1.0 / sqrt(t * t + 1.0), s = t * c;
  a[p][p] -= t * apq;
  a[q][q] += t * apq;
  a[p][q] = a[q][p] = select(t == 0.0, apq, Packet{});
  for (int k = 0; k < Rows; ++k)
  {
    if (k != p && k != q)
    {
      const Packet x = a[k][p], y = a[k][q];
      a[k][p] = a[p][k] = c * x - s * y;
      a[k][q] = a[q][k] = s * x + c * y;
    }
    const Packet vx = v[k][p], vy = v[k][q];
    v[k][p] = c * vx - s * vy;
    v[k][q] = s * vx + c * vy;
  }
}

/// Replaces the negative eigenvalues of each matrix of a batch by 0: cyclic Jacobi, all matrices
/// side by side.
template <int Rows>
void project(Packet* h)
{
  constexpr int maxSweeps = 12;
  constexpr double offDiagonal = 1e-8; // what is left beside the diagonal, relative to the whole
  Packet a[Rows][Rows], v[Rows][Rows] = {}, size2 = {};
  for (int i = 0; i < Rows; ++i)
  {
    v[i][i] = broadcast(1.0);
    for (int j = 0; j < Rows; ++j)
    {
      a[i][j] = h[entry(i, j)];
      size2 += a[i][j] * a[i][j];
    }
  }
  for (int sweep = 0; sweep < maxSweeps; ++sweep)
  {
    Packet rest2 = {};
    for (int i = 1; i < Rows; ++i)
    {
      for (int j = 0; j < i; ++j)
      {
        rest2 += a[i][j] * a[i][j];
      }
    }
    if (!any(rest2 > offDiagonal * offDiagonal * size2))
    {
      break;
    }
    // In rounds of pairs without common rows: the rotations of a round do not wait for each other.
    constexpr int others = Rows - 1 + Rows % 2;
    for (int round = 0; round < others; ++round)
    {
      if (others < Rows)
      {
        rotate<Rows>(a, v, round, others);
      }
      for (int i = 1; i <= others / 2; ++i)
      {
        rotate<Rows>(a, v, (round + i) % others, (round + others - i) % others);
      }
    }
  }
  // The columns of v are orthonormal however far the sweeps came: what they give is never
  // indefinite.
  Packet positive[Rows], smallest = {};
  for (int k = 0; k < Rows; ++k)
  {
    smallest = min(smallest, a[k][k]);
    positive[k] = max(a[k][k], Packet{});
  }
  const Mask indefinite = smallest < 0.0;
  for (int i = 0; i < Rows; ++i)
  {
    for (int j = 0; j <= i; ++j)
    {
      Packet sum = {};
      for (int k = 0; k < Rows; ++k)
      {
        sum += positive[k] * v[i][k] * v[j][k];
      }
      h[entry(i, j)] = select(indefinite, sum, h[entry(i, j)]);
    }
  }
}

/// The vectors of d from the first node to the others.
template <int Nodes>
void gatherVectors(const double* d, const BatchNodes& nodes, Packet* x)
{
  Packet first[3];
  for (int k = 0; k < Nodes; ++k)
  {
    const double* p[PacketWidth];
    for (int l = 0; l < PacketWidth; ++l)
    {
      p[l] = d + 3 * nodes[l][k];
    }
    if (k == 0)
    {
      loadPoints(p, first);
      continue;
    }
    loadPoints(p, x + 3 * (k - 1));
    subtract(x + 3 * (k - 1), first, x + 3 * (k - 1));
  }
}
}

struct ElementHessian::Storage
{
  std::vector<Index> offsets;
  std::vector<Packet> entries;

  /// Calls work(nodes of a cell, chunk number, batch, nodes, numbers of the batch) in the order of
  /// the elements.
  template <class Work>
  void forEachBatch(const ElementSum& elements, const Work& work)
  {
    elements.forEachChunk(
      [&](Index i)
      {
        const ElementSum::Chunk& chunk = elements.chunks()[i];
        const BatchContext context = elements.context(chunk);
        const Index* order = elements.order(chunk);
        withNodes(*context.topology,
          [&](auto nodesOfCell)
          {
            constexpr int Nodes = decltype(nodesOfCell)::value;
            Packet* numbers = this->entries.data() + this->offsets[i];
            Batch batch;
            BatchNodes nodes;
            for (Index begin = chunk.begin; begin < chunk.end; begin += PacketWidth)
            {
              const int count = static_cast<int>(std::min<Index>(PacketWidth, chunk.end - begin));
              locate(context, order, begin, count, batch, nodes);
              work(nodesOfCell, batch, nodes, numbers);
              numbers += entriesFor(Nodes);
            }
          });
      });
  }
};

//------------------------------------------------------------------------------
ElementHessian::ElementHessian(const ObjectiveSum& objective, bool project)
  : TheObjective(objective)
  , Project(project)
  , Values(std::make_unique<Storage>())
{
  this->Values->offsets = offsetsOf(objective.state().elements);
  this->Values->entries.assign(this->Values->offsets.back(), Packet{});
}

ElementHessian::~ElementHessian() = default;

std::size_t ElementHessian::memory(const ObjectiveSum& objective)
{
  const std::vector<Index> offsets = offsetsOf(objective.state().elements);
  return offsets.back() * sizeof(Packet) + offsets.size() * sizeof(Index);
}

//------------------------------------------------------------------------------
namespace
{
/**
 * @brief Calls work(nodes of a cell, batch, nodes, numbers) with the Hessians of each batch, which
 * are stored at place(chunk number, first cell in the chunk).
 */
template <class Place, class Work>
void makeHessians(const ObjectiveSum& objective, const Place& place, const Work& work)
{
  const ObjectiveSumState& sum = objective.state();
  const ElementSum& elements = sum.elements;
  const ObjectiveTemplate objectiveTemplate = sum.function.objectiveTemplate;
  const bool scaled = objectiveTemplate == ObjectiveTemplate::PowerMean ||
    objectiveTemplate == ObjectiveTemplate::Maximum;
  const double F = scaled ? objective.value() : 0.0;
  // Called through a pointer: one body for all templates.
  using SlopeOfTemplate =
    Packet (ElementFunction::*)(const BatchContext&, const Batch&, double) const;
  const SlopeOfTemplate slopeOfTemplate = withTemplate(objectiveTemplate,
    [](auto formOfSum) -> SlopeOfTemplate
    { return &ElementFunction::slope<decltype(formOfSum)::value>; });
  const auto slope = [&](const BatchContext& context, const Batch& batch)
  { return (sum.function.*slopeOfTemplate)(context, batch, F); };
  elements.forEachChunk(
    [&](Index i)
    {
      const ElementSum::Chunk& chunk = elements.chunks()[i];
      const BatchContext context = elements.context(chunk);
      const BatchEvaluator evaluate = elements.evaluator(chunk, true);
      withNodes(*context.topology,
        [&](auto nodesOfCell)
        {
          constexpr int Nodes = decltype(nodesOfCell)::value;
          Packet own[entriesFor(Nodes)];
          Batch batch;
          BatchNodes nodes;
          for (Index begin = chunk.begin; begin < chunk.end; begin += PacketWidth)
          {
            const int count = static_cast<int>(std::min<Index>(PacketWidth, chunk.end - begin));
            Packet* kept = place(i, (begin - chunk.begin) / PacketWidth * entriesFor(Nodes));
            Packet* h = kept ? kept : own;
            gather<Nodes>(context, elements.order(chunk), begin, count, batch, nodes);
            differences<Nodes>(context, evaluate, slope, batch, h);
            work(nodesOfCell, batch, nodes, h);
          }
        });
    });
}

/// Adds the diagonal blocks of the cells of a batch.
template <int Nodes>
void addBlocks(
  double scale, const Batch& batch, const BatchNodes& nodes, const Packet* h, double* blocks)
{
  // The first node's block is the sum of all blocks, of both triangles.
  Packet block[Nodes][6] = {};
  for (int k = 1; k < Nodes; ++k)
  {
    for (int m = 1; m < Nodes; ++m)
    {
      int position = 0;
      for (int r = 0; r < 3; ++r)
      {
        for (int c = r; c < 3; ++c, ++position)
        {
          const Packet value = scale * h[entry(3 * (k - 1) + r, 3 * (m - 1) + c)];
          block[0][position] += value;
          block[k][position] = k == m ? value : block[k][position];
        }
      }
    }
  }
  for (int l = 0; l < batch.count; ++l)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      for (int position = 0; position < 6; ++position)
      {
        blocks[6 * nodes[l][k] + position] += block[k][position][l];
      }
    }
  }
}
}

void ElementHessian::assemble()
{
  makeHessians(
    this->TheObjective,
    [this](Index chunk, Index first)
    { return this->Values->entries.data() + this->Values->offsets[chunk] + first; },
    [this](auto nodesOfCell, const Batch&, const BatchNodes&, Packet* h)
    {
      if (this->Project)
      {
        project<rowsFor(decltype(nodesOfCell)::value)>(h);
      }
    });
}

//------------------------------------------------------------------------------
void ElementHessian::addTimes(double scale, const double* d, double* product) const
{
  this->Values->forEachBatch(this->TheObjective.state().elements,
    [=](auto nodesOfCell, const Batch& batch, const BatchNodes& nodes, const Packet* h)
    {
      constexpr int Nodes = decltype(nodesOfCell)::value;
      constexpr int rows = rowsFor(Nodes);
      Packet x[rows], y[rows] = {};
      gatherVectors<Nodes>(d, nodes, x);
      for (int i = 0; i < rows; ++i)
      {
        for (int j = 0; j < i; ++j)
        {
          const Packet a = h[entry(i, j)];
          y[i] += a * x[j];
          y[j] += a * x[i];
        }
        y[i] += h[entry(i, i)] * x[i];
      }
      VectorLanes lanes[Nodes];
      Packet first[3] = {};
      for (int k = 1; k < Nodes; ++k)
      {
        Packet* row = y + 3 * (k - 1);
        for (int c = 0; c < 3; ++c)
        {
          row[c] *= scale;
          first[c] -= row[c];
        }
        lanes[k].set(row);
      }
      lanes[0].set(first);
      for (int l = 0; l < batch.count; ++l)
      {
        for (int k = 0; k < Nodes; ++k)
        {
          lanes[k].addTo(product + 3 * nodes[l][k], l);
        }
      }
    });
}

//------------------------------------------------------------------------------
void ElementHessian::addDiagonal(double scale, double* blocks) const
{
  this->Values->forEachBatch(this->TheObjective.state().elements,
    [=](auto nodesOfCell, const Batch& batch, const BatchNodes& nodes, const Packet* h)
    { addBlocks<decltype(nodesOfCell)::value>(scale, batch, nodes, h, blocks); });
}

void addDiagonalBlocks(const ObjectiveSum& objective, double scale, double* blocks)
{
  makeHessians(
    objective, [](Index, Index) -> Packet* { return nullptr; },
    [=](auto nodesOfCell, const Batch& batch, const BatchNodes& nodes, const Packet* h)
    { addBlocks<decltype(nodesOfCell)::value>(scale, batch, nodes, h, blocks); });
}

//------------------------------------------------------------------------------
void invertBlocks(double* blocks, Index count, int threads)
{
  constexpr double flattest = 1e-3; // smallest eigenvalue, relative to the largest
  constexpr int sweeps = 5;
  constexpr int position[3][3] = { { 0, 1, 2 }, { 1, 3, 4 }, { 2, 4, 5 } };
  forEachChunk(count, threads,
    [=](Index, Index begin, Index end)
    {
      for (Index first = begin; first < end; first += PacketWidth)
      {
        const int lanes = static_cast<int>(std::min<Index>(PacketWidth, end - first));
        Packet a[3][3], v[3][3] = {};
        for (int r = 0; r < 3; ++r)
        {
          v[r][r] = broadcast(1.0);
          for (int c = 0; c < 3; ++c)
          {
            a[r][c] = Packet{};
            for (int l = 0; l < lanes; ++l)
            {
              a[r][c][l] = blocks[6 * (first + l) + position[r][c]];
            }
          }
        }
        for (int sweep = 0; sweep < sweeps; ++sweep)
        {
          rotate<3>(a, v, 0, 1);
          rotate<3>(a, v, 0, 2);
          rotate<3>(a, v, 1, 2);
        }
        const Packet largest = max(max(abs(a[0][0]), abs(a[1][1])), abs(a[2][2]));
        Packet inverse[3];
        for (int k = 0; k < 3; ++k)
        {
          inverse[k] = 1.0 / max(abs(a[k][k]), flattest * largest);
          // A point without elements, or beyond arithmetic, is left as it is.
          inverse[k] =
            select((largest > 0.0) & (inverse[k] < HUGE_VAL), inverse[k], broadcast(1.0));
        }
        for (int r = 0; r < 3; ++r)
        {
          for (int c = r; c < 3; ++c)
          {
            Packet sum = {};
            for (int k = 0; k < 3; ++k)
            {
              sum += inverse[k] * v[r][k] * v[c][k];
            }
            for (int l = 0; l < lanes; ++l)
            {
              blocks[6 * (first + l) + position[r][c]] = sum[l];
            }
          }
        }
      }
    });
}

void applyBlocks(const double* blocks, Index count, int threads, const double* r, double* z)
{
  forEachChunk(count, threads,
    [=](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const double *b = blocks + 6 * i, *x = r + 3 * i;
        const double x0 = x[0], x1 = x[1], x2 = x[2];
        z[3 * i] = b[0] * x0 + b[1] * x1 + b[2] * x2;
        z[3 * i + 1] = b[1] * x0 + b[3] * x1 + b[4] * x2;
        z[3 * i + 2] = b[2] * x0 + b[4] * x1 + b[5] * x2;
      }
    });
}
}
