/**
 * @file Batch.h
 * @brief Evaluation of one metric on batches of cells of one type. Internal: not installed.
 */
#ifndef tautline_Batch_h
#define tautline_Batch_h

#include "Metrics.h"
#include "Packet.h"

#include <type_traits>

namespace tautline
{
/// Everything a batch evaluator needs that is the same for all batches of a block.
struct BatchContext
{
  const Mesh* mesh = nullptr;
  const CellBlock* block = nullptr;
  const CellTopology* topology = nullptr;
  const EvaluationOptions* options = nullptr;
  bool largerIsBetter = false;
};

/// One batch: the cells, their gathered vertices, and what the evaluator makes of them.
struct Batch
{
  Index cells[PacketWidth]; ///< the last one repeated to fill the batch
  int count = 0;
  Packet points[MaxNodes][3];
  Packet value;
  Packet gradient[MaxNodes][3];
};

using BatchEvaluator = void (*)(const BatchContext&, Batch&);

/// The evaluators of a metric; null where it is not defined.
struct MetricCode
{
  BatchEvaluator value2D = nullptr;
  BatchEvaluator gradient2D = nullptr;
  BatchEvaluator value3D = nullptr;
  BatchEvaluator gradient3D = nullptr;
};

MetricCode targetMetricCode(Metric metric);
MetricCode simplexMetricCode(Metric metric);
MetricCode cellMetricCode(Metric metric);

/// Packet vectors, used by the chain rules.
using PacketVec = Packet[3];

inline Packet dot(const Packet* a, const Packet* b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline void cross(const Packet* a, const Packet* b, Packet* result)
{
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
}

inline void subtract(const Packet* a, const Packet* b, Packet* result)
{
  for (int c = 0; c < 3; ++c)
  {
    result[c] = a[c] - b[c];
  }
}

/// Finite or zero: the values and gradients of elements beyond arithmetic are 0.
inline Packet finiteOrZero(Packet x)
{
  return select(abs(x) <= 1.7976931348623157e308, x, Packet{});
}

/// Calls work(N) with the number of nodes as a compile-time constant, so that loops over it unroll.
template <class Work>
void withNodes(const CellTopology& topology, const Work& work)
{
  switch (topology.nodes)
  {
    case 3:
      return work(std::integral_constant<int, 3>());
    case 4:
      return work(std::integral_constant<int, 4>());
    case 5:
      return work(std::integral_constant<int, 5>());
    case 6:
      return work(std::integral_constant<int, 6>());
    default:
      static_assert(MaxNodes == 8, "a case for each number of nodes");
      return work(std::integral_constant<int, 8>());
  }
}

/// The nodes of each cell of a batch, in the connectivity.
using BatchNodes = const Index* [PacketWidth];

/// Finds the nodes of cells [begin, begin + count) of a block; order maps positions if not null.
inline void locate(const BatchContext& context, const Index* order, Index begin, int count,
  Batch& batch, BatchNodes& nodes)
{
  const MeshView& view = context.mesh->view();
  for (int l = 0; l < PacketWidth; ++l)
  {
    const Index position = begin + (l < count ? l : count - 1);
    const Index cell = context.block->cell(order ? order[position] : position);
    batch.cells[l] = cell;
    nodes[l] = view.connectivity + view.offsets[cell];
  }
  batch.count = count;
}

/// Loads the vertices of the cells of a batch, of which `nodes` has the numbers.
template <int Nodes, class Numbers>
void loadNodes(
  const BatchContext& context, const double* points, const Numbers& nodes, Batch& batch)
{
  for (int k = 0; k < Nodes; ++k)
  {
    const double* p[PacketWidth];
    for (int l = 0; l < PacketWidth; ++l)
    {
      p[l] = points + 3 * static_cast<Index>(nodes[l][k]);
    }
    loadPoints(p, batch.points[k]);
  }
  if (context.mesh->mirrored() && context.mesh->dimension() == Dimension::Volume)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      batch.points[k][0] = -batch.points[k][0];
    }
  }
}

/// Loads the vertices of the cells that locate() finds.
template <int Nodes>
void gather(const BatchContext& context, const Index* order, Index begin, int count, Batch& batch,
  BatchNodes& nodes)
{
  locate(context, order, begin, count, batch, nodes);
  loadNodes<Nodes>(context, context.mesh->view().points, nodes, batch);
}
}
#endif
