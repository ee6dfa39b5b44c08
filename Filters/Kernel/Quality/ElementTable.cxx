// SPDX-License-Identifier: BSD-3-Clause
#include "ElementTable.h"

#include "UserMetric.h"
#include "tautline/Mesh/MeshElements.h"

#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// A point or displacement in the coordinates of a user metric: in the plane of a planar mesh,
/// mirrored with the mesh.
Vec3 asSeen(const Mesh& mesh, const CellTopology& t, Vec3 p)
{
  if (t.dimension == 2 && mesh.dimension() == Dimension::Planar)
  {
    const auto& frame = mesh.frame();
    // Exchanging both axes mirrors the plane.
    return { dot(frame[mesh.mirrored() ? 1 : 0], p), dot(frame[mesh.mirrored() ? 0 : 1], p), 0 };
  }
  if (mesh.mirrored() && mesh.dimension() == Dimension::Volume)
  {
    p[0] = -p[0];
  }
  return p;
}

/// The elements of a block in the form required by the function.
class BlockValues
{
public:
  BlockValues(const Mesh& mesh, const MetricInfo& info, const CellBlock& block)
    : TheMesh(mesh)
    , Info(info)
    , Block(block)
    , Topology(topology(block.type))
    , Points(3 * static_cast<std::size_t>(Topology.nodes) * block.count)
    , Extents(block.count)
  {
    const MeshView& view = mesh.view();
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* nodes = view.connectivity + view.offsets[block.cell(i)];
      const Vec3 first = pointOf(view, nodes[0]);
      for (int k = 0; k < this->Topology.nodes; ++k)
      {
        const Vec3 p = pointOf(view, nodes[k]);
        const Vec3 seen = asSeen(mesh, this->Topology, p);
        std::copy(seen.begin(), seen.end(), this->corner(i, k));
        this->Extents[i] = std::max(this->Extents[i], norm(p - first));
      }
    }
  }

  std::vector<double> values() const
  {
    std::vector<double> found(this->Block.count);
    this->Info.user->evaluateElements(
      this->Block.type, this->Block.count, this->Points.data(), found.data());
    return found;
  }

  /// The derivatives with respect to coordinate c of corner k; 0 if there is no finite value
  /// nearby.
  std::vector<double> slopes(int k, int c, const std::vector<double>& here)
  {
    // A step of this fraction of the element size balances rounding and the third derivative.
    static const double fraction = std::cbrt(std::numeric_limits<double>::epsilon());
    Vec3 axis = { 0, 0, 0 };
    axis[c] = 1;
    const Vec3 seen = asSeen(this->TheMesh, this->Topology, axis);
    if (norm(seen) == 0)
    {
      return std::vector<double>(this->Block.count); // perpendicular to the plane of the mesh
    }
    std::vector<Vec3> kept(this->Block.count);
    for (Index i = 0; i < this->Block.count; ++i)
    {
      std::copy_n(this->corner(i, k), 3, kept[i].begin());
    }
    const auto valuesAt = [&](double way)
    {
      for (Index i = 0; i < this->Block.count; ++i)
      {
        for (int d = 0; d < 3; ++d)
        {
          this->corner(i, k)[d] = kept[i][d] + way * fraction * this->Extents[i] * seen[d];
        }
      }
      return this->values();
    };
    std::vector<double> found = valuesAt(1.0);
    const std::vector<double> back = valuesAt(-1.0);
    for (Index i = 0; i < this->Block.count; ++i)
    {
      std::copy(kept[i].begin(), kept[i].end(), this->corner(i, k));
      const double h = fraction * this->Extents[i];
      const double forth = found[i];
      // If only one of both sides has a finite value, the difference is one-sided.
      found[i] = std::isfinite(forth) && std::isfinite(back[i]) ? (forth - back[i]) / (2 * h)
        : std::isfinite(forth)                                  ? (forth - here[i]) / h
                                                                : (here[i] - back[i]) / h;
      found[i] = std::isfinite(found[i]) ? found[i] : 0.0;
    }
    return found;
  }

private:
  double* corner(Index i, int k)
  {
    return this->Points.data() + 3 * (this->Topology.nodes * i + k);
  }

  const Mesh& TheMesh;
  const MetricInfo& Info;
  const CellBlock& Block;
  const CellTopology& Topology;
  std::vector<double> Points;  ///< 3 per corner, element after element
  std::vector<double> Extents; ///< of each element
};

template <bool WithGradient>
void lookUp(const BatchContext& context, Batch& batch)
{
  const MeshView& view = context.mesh->view();
  const bool mirrored = context.mesh->mirrored() && context.mesh->dimension() == Dimension::Volume;
  for (int l = 0; l < PacketWidth; ++l)
  {
    const Index cell = batch.cells[l];
    batch.value[l] = context.table ? context.table->values[cell] : NaN;
    for (int k = 0; k < context.topology->nodes && WithGradient; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double slope =
          context.table ? context.table->slopes[3 * (view.offsets[cell] + k) + c] : 0.0;
        batch.gradient[k][c][l] = mirrored && c == 0 ? -slope : slope;
      }
    }
  }
  for (int k = 0; k < context.topology->nodes && WithGradient; ++k)
  {
    for (Packet& g : batch.gradient[k])
    {
      g = timesUnit(batch, g, 1); // scatter() divides by the unit of the cells
    }
  }
}
}

//------------------------------------------------------------------------------
ElementTable tabulate(const Mesh& mesh, const MetricInfo& info, bool withSlopes)
{
  const MeshView& view = mesh.view();
  ElementTable table;
  table.values.assign(view.numberOfCells, 0.0);
  if (withSlopes && view.numberOfCells > 0)
  {
    table.slopes.assign(3 * view.offsets[view.numberOfCells], 0.0);
  }
  for (const CellBlock& block : mesh.blocks())
  {
    if (!info.definedOn(block.type) || block.count == 0)
    {
      continue;
    }
    BlockValues elements(mesh, info, block);
    const std::vector<double> values = elements.values();
    for (Index i = 0; i < block.count; ++i)
    {
      table.values[block.cell(i)] = std::isfinite(values[i]) ? values[i] : NaN;
    }
    // facets of volumes are not elements
    const bool inSums = withSlopes && isElement(mesh, block.type);
    for (int j = 0; inSums && j < 3 * topology(block.type).nodes; ++j)
    {
      const std::vector<double> slopes = elements.slopes(j / 3, j % 3, values);
      for (Index i = 0; i < block.count; ++i)
      {
        table.slopes[3 * view.offsets[block.cell(i)] + j] = slopes[i];
      }
    }
  }
  return table;
}

//------------------------------------------------------------------------------
MetricCode tableMetricCode()
{
  return { lookUp<false>, lookUp<true>, lookUp<false>, lookUp<true> };
}
}
