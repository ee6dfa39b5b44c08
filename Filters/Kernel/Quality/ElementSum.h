// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementSum.h
 * @brief Sums a function of a metric over the elements of a mesh, with its gradient.
 * Internal: not installed.
 *
 * The elements are divided into chunks, which are colored: chunks of one color share no vertex, so
 * that threads add to the gradient without locks and in an order that only depends on the mesh.
 *
 * If the numbering of the mesh has no locality, the cells are visited along a space-filling curve.
 * Sums use copies of the connectivity in that order and, unless they fit into the cache, of the
 * coordinates and the gradient in the order in which the cells visit the points; otherwise all
 * would be accessed randomly.
 */
#ifndef tautline_ElementSum_h
#define tautline_ElementSum_h

#include "ElementTable.h"
#include "tautline/Core/Parallel.h"

#include <atomic>
#include <cstdint>
#include <memory>

namespace tautline
{
/// The evaluators of any metric.
TAUTLINE_KERNEL_EXPORT MetricCode metricCode(Metric metric);

/// Throws Error for a metric that is undefined in the dimension of the mesh, and for options out of
/// range.
void checkEvaluation(const Mesh& mesh, const MetricInfo& info, const EvaluationOptions& options);

/// Throws Error for a metric without analytic derivatives, see needsDifferences().
TAUTLINE_KERNEL_EXPORT void requireDerivatives(const MetricInfo& info);

/// The evaluator of a metric on a block, or null if the metric is undefined.
TAUTLINE_KERNEL_EXPORT BatchEvaluator evaluatorFor(const Mesh& mesh, Metric metric,
  const MetricCode& code, const CellBlock& block, bool withGradient);

/// Like evaluatorFor(), but null for cells that are not elements: the facets of a volume mesh,
/// which are measured but not summed.
BatchEvaluator elementEvaluatorFor(const Mesh& mesh, Metric metric, const MetricCode& code,
  const CellBlock& block, bool withGradient);

TAUTLINE_KERNEL_EXPORT BatchContext contextFor(
  const Mesh& mesh, const CellBlock& block, Metric metric, const EvaluationOptions& options);

/// Undoes the mirroring of gather(), removes nonfinite numbers, multiplies by a factor and passes
/// the gradient at node k of cell l of the batch to put(lanes, l, k), cell by cell.
template <int Nodes, class Put>
void scatter(const BatchContext& context, const Batch& batch, Packet factor, const Put& put)
{
  const bool mirrored = context.mesh->mirrored() && context.mesh->dimension() == Dimension::Volume;
  VectorLanes lanes[Nodes];
  factor = timesUnit(batch, factor, context.lengthPower - 1);
  Packet g[Nodes][3], zero = {}; // 0 unless a number is not finite
  for (int k = 0; k < Nodes; ++k)
  {
    for (int c = 0; c < 3; ++c)
    {
      g[k][c] = factor * batch.gradient[k][c];
      zero += 0.0 * g[k][c];
    }
  }
  const bool finite = !any(zero != 0.0);
  for (int k = 0; k < Nodes; ++k)
  {
    for (int c = 0; c < 3 && !finite; ++c)
    {
      g[k][c] = finiteOrZero(g[k][c]);
    }
    g[k][0] = mirrored ? -g[k][0] : g[k][0];
    lanes[k].set(g[k]);
  }
  for (int l = 0; l < batch.count; ++l)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      put(lanes[k], l, k);
    }
  }
}

/// x with 0 in padding lanes.
inline Packet onlyCells(const Batch& batch, Packet x)
{
  for (int l = batch.count; l < PacketWidth; ++l)
  {
    x[l] = 0;
  }
  return x;
}

/// The sums of a chunk: one per lane.
struct LaneSums
{
  Packet lanes = {};
  double sum() const
  {
    double total = 0;
    for (int l = 0; l < PacketWidth; ++l)
    {
      total += this->lanes[l];
    }
    return total;
  }
};

class ElementSum
{
public:
  struct Chunk
  {
    int block;
    Index begin, end;
    Index length() const { return this->end - this->begin; }
  };

  /// Prepares the chunks and their colors. The mesh must outlive the sum.
  ElementSum(const Mesh& mesh, Metric metric, const EvaluationOptions& options);

  const Mesh& mesh() const { return this->TheMesh; }
  const EvaluationOptions& options() const { return this->Options; }
  const std::vector<Chunk>& chunks() const { return this->Chunks; }
  bool empty() const { return this->Chunks.empty(); }

  /// The evaluator of a chunk, and the order of its cells (or null).
  BatchEvaluator evaluator(const Chunk& chunk, bool withGradient) const
  {
    return elementEvaluatorFor(this->TheMesh, this->TheMetric, metricCode(this->TheMetric),
      this->TheMesh.blocks()[chunk.block], withGradient);
  }
  BatchContext context(const Chunk& chunk) const
  {
    return contextFor(
      this->TheMesh, this->TheMesh.blocks()[chunk.block], this->TheMetric, this->Options);
  }
  const Index* order(const Chunk& chunk) const
  {
    return this->Order[chunk.block].empty() ? nullptr : this->Order[chunk.block].data();
  }

  /// The values of a metric that is evaluated for many elements at once; null for the others.
  std::unique_ptr<ElementTable> tabulated(bool withSlopes) const;

  /// Calls work(i) for each chunk; concurrently only for chunks that share no vertex, and in a
  /// fixed order for each vertex.
  template <class Work>
  void forEachChunk(const Work& work) const
  {
    for (std::size_t colour = 0; colour + 1 < this->ColourStarts.size(); ++colour)
    {
      const Index first = this->ColourStarts[colour], last = this->ColourStarts[colour + 1];
      runChunks(last - first, this->Options.threads, [&](Index i) { work(first + i); });
    }
  }

  /**
   * @brief Evaluates every cell and calls function(context, batch, total, slope) for each batch: it
   * adds to `total`, and sets `slope`, by which the metric gradient is multiplied before it is
   * added to `gradient`.
   * @param numbered whether the function reads Batch::cells, as weights do; with targets they are
   * set anyway
   * @return the totals, one per chunk, in a fixed order
   */
  template <bool WithGradient, class Total, class Function>
  std::vector<Total> run(const Function& function, double* gradient, bool numbered) const
  {
    const std::unique_ptr<ElementTable> table = this->tabulated(WithGradient);
    numbered = numbered || this->Options.targets || table;
    std::vector<Total> totals(this->Chunks.size());
    const Scratch scratch(*this);
    const bool renumbered = !this->PackedPoints.empty();
    const double* const coordinates =
      renumbered ? this->packedCoordinates(scratch.use().coordinates) : this->TheMesh.view().points;
    std::vector<double>& packedGradient = scratch.use().gradient;
    packedGradient.assign(WithGradient ? 3 * this->PackedPoints.size() : 0, 0.0);
    double* const gradientThere = renumbered ? packedGradient.data() : gradient;
    this->forEachChunk(
      [&](Index i)
      {
        const Chunk& chunk = this->Chunks[i];
        const BatchEvaluator evaluate = this->evaluator(chunk, WithGradient);
        BatchContext context = this->context(chunk);
        context.table = table.get();
        Total total;
        withNodes(*context.topology,
          [&](auto nodesOfCell)
          {
            constexpr int Nodes = decltype(nodesOfCell)::value;
            // Local copies, which stores to the gradient cannot modify.
            const double* const points = coordinates;
            double* const sums = gradientThere;
            const Index* const order = this->order(chunk);
            const std::int32_t* const connectivity = this->PackedConnectivity[chunk.block].data();
            const Index end = chunk.end;
            Batch batch;
            std::fill(std::begin(batch.cells), std::end(batch.cells), Index(-1));
            PackedNodes nodes;
            for (Index begin = chunk.begin; begin < end; begin += PacketWidth)
            {
              const int count = static_cast<int>(std::min<Index>(PacketWidth, end - begin));
              if (numbered)
              {
                findCells(context, order, begin, count, batch);
              }
              gatherPacked<Nodes>(context, connectivity, points, begin, count, batch, nodes);
              evaluate(context, batch);
              replaceNonFinite(context, batch);
              Packet slope = {};
              function(context, batch, total, slope);
              if constexpr (WithGradient)
              {
                scatter<Nodes>(context, batch, slope,
                  [&](const VectorLanes& lanes, int l, int k)
                  { lanes.addTo(sums + 3 * static_cast<Index>(nodes[l][k]), l); });
              }
            }
          });
        totals[i] = total;
      });
    if (WithGradient && renumbered)
    {
      this->addUnpacked(packedGradient, gradient);
    }
    return totals;
  }

private:
  /// The nodes of each cell of a batch, as positions in PackedPoints or as points.
  using PackedNodes = const std::int32_t* [PacketWidth];

  /// 3 per packed point.
  struct Buffers
  {
    std::vector<double> coordinates, gradient;
  };

  /// The buffers kept between calls, or new ones while another thread uses them.
  class Scratch
  {
  public:
    explicit Scratch(const ElementSum& sum)
      : Sum(sum)
      , Kept(!sum.Busy.test_and_set(std::memory_order_acquire))
    {
    }
    ~Scratch()
    {
      if (this->Kept)
      {
        this->Sum.Busy.clear(std::memory_order_release);
      }
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    Buffers& use() const { return this->Kept ? this->Sum.KeptBuffers : this->Own; }

  private:
    const ElementSum& Sum;
    const bool Kept;
    mutable Buffers Own;
  };

  void pack();
  /// Fills the array with the coordinates of the packed points.
  const double* packedCoordinates(std::vector<double>& coordinates) const;
  void addUnpacked(const std::vector<double>& packedGradient, double* gradient) const;

  /// The numbers of the cells of a batch, only computed if needed.
  static void findCells(
    const BatchContext& context, const Index* order, Index begin, int count, Batch& batch)
  {
    for (int l = 0; l < PacketWidth; ++l)
    {
      const Index position = begin + (l < count ? l : count - 1);
      batch.cells[l] = context.block->cell(order ? order[position] : position);
    }
  }

  /// Like gather(), from packed connectivity and coordinates.
  template <int Nodes>
  static inline __attribute__((always_inline)) void gatherPacked(const BatchContext& context,
    const std::int32_t* connectivity, const double* coordinates, Index begin, int count,
    Batch& batch, PackedNodes& nodes)
  {
    for (int l = 0; l < PacketWidth; ++l)
    {
      const Index position = begin + (l < count ? l : count - 1);
      nodes[l] = connectivity + Nodes * position;
    }
    batch.count = count;
    loadNodes<Nodes>(context, coordinates, nodes, batch);
  }

  const Mesh& TheMesh;
  Metric TheMetric;
  EvaluationOptions Options;
  std::vector<std::vector<Index>> Order; ///< per block: positions in cache-friendly order, or empty
  std::vector<Chunk> Chunks;             ///< sorted by color
  /// points in the order in which cells visit them; empty: original order
  std::vector<Index> PackedPoints;
  std::vector<std::vector<std::int32_t>> PackedConnectivity; ///< per block, in its Order
  mutable Buffers KeptBuffers;
  mutable std::atomic_flag Busy = ATOMIC_FLAG_INIT;
  std::vector<Index> ColourStarts;
};
}
#endif
