// SPDX-License-Identifier: BSD-3-Clause
#include "MetricField.h"

#include "tautline/Core/LoopProgress.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tautline
{
namespace
{
/// The length of the first edge, or the area of the first face minus the rounding error for
/// collinear points, in a unit that neither overflows nor underflows. NaN or 0 if it is degenerate.
double sizeOfBase(const Vec3& a, const Vec3& b, bool flat)
{
  double extent = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    extent = std::max({ extent, std::abs(a[c]), flat ? 0.0 : std::abs(b[c]) });
  }
  if (!(extent > 0) || !std::isfinite(extent))
  {
    return 0.0;
  }
  Vec3 u, v;
  // Scaling by a power of two is exact.
  for (int c = 0; c < 3; ++c)
  {
    u[c] = std::ldexp(a[c], -std::ilogb(extent));
    v[c] = std::ldexp(b[c], -std::ilogb(extent));
  }
  constexpr double rounding = 1e-12;
  return flat ? norm(u) : norm(cross(u, v)) - rounding * norm(u) * norm(v);
}
}

//------------------------------------------------------------------------------
MetricField::MetricField(CellType type, const std::array<Vec3, 3>& fixed)
  : Type(type)
  , Origin(fixed[0])
  , Fixed(fixed)
{
  if (type != CellType::Triangle && type != CellType::Tetrahedron)
  {
    throw Error("A metric field requires a triangle or a tetrahedron.");
  }
  const bool flat = type == CellType::Triangle;
  // Relative to the first vertex, coordinates far from the origin keep their precision.
  for (Vec3& p : this->Fixed)
  {
    p = p - this->Origin;
    p[2] = flat ? 0.0 : p[2];
  }
  // Without a base, no element is valid.
  const double size = sizeOfBase(this->Fixed[1], this->Fixed[2], flat);
  if (!(size > 0) || !std::isfinite(size))
  {
    throw Error(flat ? "The two fixed vertices coincide or are not finite: move one of them."
                     : "The three fixed vertices are collinear or not finite: move one of them.");
  }
}

//------------------------------------------------------------------------------
template <class Visit>
void MetricField::forEachSlice(const FieldGrid& grid, int threads, const Visit& visit) const
{
  // One mesh of cells that share their fixed vertices; between slices, only the free ones move.
  const Index cells = grid.size[0] * grid.size[1];
  if (cells == 0)
  {
    return;
  }
  // The last vertex of each cell is the free one.
  const int fixed = topology(this->Type).nodes - 1;
  std::vector<double> points(3 * (cells + fixed));
  std::vector<unsigned char> types(cells, static_cast<unsigned char>(this->Type));
  std::vector<Index> offsets(cells + 1), connectivity(cells * (fixed + 1));
  for (int k = 0; k < fixed; ++k)
  {
    std::copy(this->Fixed[k].begin(), this->Fixed[k].end(), points.begin() + 3 * (cells + k));
  }
  for (Index i = 0; i < cells; ++i)
  {
    offsets[i + 1] = (i + 1) * (fixed + 1);
    for (int k = 0; k < fixed; ++k)
    {
      connectivity[offsets[i] + k] = cells + k;
    }
    connectivity[offsets[i] + fixed] = i;
  }
  MeshView view;
  view.numberOfPoints = cells + fixed;
  view.points = points.data();
  view.numberOfCells = cells;
  view.cellTypes = types.data();
  view.offsets = offsets.data();
  view.connectivity = connectivity.data();
  for (Index k = 0; k < grid.size[2]; ++k)
  {
    // If there are many slices, the loops of one are too short to report.
    std::optional<LoopProgress::Nested> nested;
    if (grid.size[2] > 1)
    {
      LoopProgress::at(static_cast<double>(k) / static_cast<double>(grid.size[2]));
      nested.emplace();
    }
    for (Index i = 0; i < cells; ++i)
    {
      const std::array<Index, 3> at = { i % grid.size[0], i / grid.size[0], k };
      for (int c = 0; c < 3; ++c)
      {
        points[3 * i + c] = (grid.origin[c] - this->Origin[c]) +
          static_cast<double>(grid.first[c] + at[c]) * grid.spacing[c];
      }
      if (this->Type == CellType::Triangle)
      {
        points[3 * i + 2] = 0.0;
      }
    }
    visit(Mesh(view, threads), k * cells);
  }
}

//------------------------------------------------------------------------------
void MetricField::evaluate(
  const FieldGrid& grid, Metric metric, const EvaluationOptions& options, double* values) const
{
  const MetricInfo& info = metricInfo(metric);
  if (!info.definedOn(this->Type))
  {
    throw Error(std::string(info.label) + " is not defined on " + topology(this->Type).plural +
      ": deselect it or choose the other cell.");
  }
  Index beyond = 0;
  this->forEachSlice(grid, options.threads,
    [&](const Mesh& mesh, Index first)
    { beyond += evaluateMetric(mesh, metric, options, values + first); });
  requireInRange(info, beyond);
}

//------------------------------------------------------------------------------
void MetricField::classify(const FieldGrid& grid, signed char* validity, int threads) const
{
  this->forEachSlice(grid, threads,
    [&](const Mesh& mesh, Index first) { mesh.classifyCells(validity + first, threads); });
}
}
