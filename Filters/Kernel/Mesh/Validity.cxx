#include "Mesh.h"

#include "CellBatch.h"
#include "CoordinateFrame.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Products of edges of such length overflow.
constexpr double StrayExtent = 1e100;

/// The longest distance of a vertex from the first along an axis.
double extentOf(const CellTopology& t, const Vec3* vertices)
{
  double extent = 0;
  for (int k = 1; k < t.nodes; ++k)
  {
    for (int c = 0; c < 3; ++c)
    {
      extent = std::max(extent, std::abs(vertices[k][c] - vertices[0][c]));
    }
  }
  return extent;
}
}

//------------------------------------------------------------------------------
Validity Mesh::classifyCell(const CellTopology& t, const Vec3* vertices, const Vec3* against) const
{
  // Cells of extreme size are scaled, as normalizeExtents() does.
  const double perUnit = 1 / unitOfExtent(extentOf(t, vertices));
  Vec3 p[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    p[k] = perUnit * vertices[k];
  }
  const bool surface = t.dimension == 2 && this->Dim != Dimension::Planar;
  const double sign = this->Mirrored && !surface ? -1.0 : 1.0;
  Vec3 normal = against ? *against : this->Normal;
  if (surface && !against)
  {
    // A surface quadrilateral is judged against its own mean normal.
    normal = vectorArea(t, p);
    const double length = norm(normal);
    normal = length > 0 ? (1.0 / length) * normal : normal;
  }
  // The worst corner determines the validity.
  Validity verdict = Valid;
  for (int c = 0; c < t.samples; ++c)
  {
    const auto& corner = t.cornerNodes[c];
    const Vec3 a = p[corner[1]] - p[corner[0]];
    const Vec3 b = p[corner[2]] - p[corner[0]];
    double det = 0, scale = norm(a) * norm(b);
    if (t.dimension == 2)
    {
      det = dot(cross(a, b), normal);
    }
    else
    {
      const Vec3 d = p[corner[3]] - p[corner[0]];
      det = dot(a, cross(b, d));
      scale *= norm(d);
    }
    det *= sign;
    if (!std::isfinite(scale))
    {
      return NonFinite;
    }
    if (std::abs(det) <= degenerateTolerance() * scale)
    {
      verdict = std::min(verdict, Degenerate);
    }
    else if (det < 0)
    {
      verdict = Inverted;
    }
  }
  return verdict;
}

namespace
{
/// Whether all cells of a batch are valid beyond doubt; what is near a limit is left to
/// classifyCell().
bool clearlyValid(const Mesh& mesh, const CellTopology& t, const CellVertices& batch)
{
  constexpr double margin = 2, smallest = 1e-200, largest = 1e200;
  constexpr double tolerance = margin * Mesh::degenerateTolerance();
  Packet normal[3];
  for (int c = 0; c < 3; ++c)
  {
    normal[c] = broadcast((mesh.mirrored() ? -1.0 : 1.0) * mesh.normal()[c]);
  }
  Mask valid = ~Mask{};
  for (int s = 0; s < t.samples; ++s)
  {
    const auto& corner = t.cornerNodes[s];
    Packet a[3], b[3], d[3], ab[3];
    subtract(batch.points[corner[1]], batch.points[corner[0]], a);
    subtract(batch.points[corner[2]], batch.points[corner[0]], b);
    cross(a, b, ab);
    Packet det = dot(ab, normal), lengths2 = dot(a, a) * dot(b, b);
    if (t.dimension == 3)
    {
      subtract(batch.points[corner[3]], batch.points[corner[0]], d);
      det = dot(ab, d);
      lengths2 *= dot(d, d);
    }
    valid &= (det > 0.0) & (det * det > tolerance * tolerance * lengths2) & (lengths2 > smallest) &
      (lengths2 < largest);
  }
  return !any(~valid);
}
}

//------------------------------------------------------------------------------
void Mesh::classifyCells(signed char* validity, int threads) const
{
  if (this->Unsupported > 0)
  {
    std::fill(validity, validity + this->View.numberOfCells, NotMeasured);
  }
  // In a mesh of ordinary size, cells that are many times larger have a vertex astray.
  const bool ordinary = unitOfExtent(coordinateRange(this->View).extent) == 1;
  for (const CellBlock& block : this->Blocks)
  {
    const CellTopology& t = topology(block.type);
    const CellSource source = { this, &block, &t };
    const bool surface = t.dimension == 2 && this->Dim != Dimension::Planar;
    withNodes(t,
      [&](auto nodesOfCell)
      {
        constexpr int Nodes = decltype(nodesOfCell)::value;
        forEachChunk(block.count, threads,
          [&](Index, Index begin, Index end)
          {
            CellVertices batch;
            BatchNodes nodes;
            for (Index i = begin; i < end; i += PacketWidth)
            {
              const int count = static_cast<int>(std::min<Index>(PacketWidth, end - i));
              gather<Nodes>(source, nullptr, i, count, batch, nodes);
              const bool allValid = !surface && clearlyValid(*this, t, batch);
              for (int l = 0; l < count; ++l)
              {
                Vec3 p[MaxNodes];
                for (int k = 0; !allValid && k < Nodes; ++k)
                {
                  p[k] = pointOf(this->View, nodes[l][k]);
                }
                const bool stray = ordinary && !allValid && extentOf(t, p) > StrayExtent;
                validity[batch.cells[l]] = allValid ? Valid
                  : stray                           ? NonFinite
                                                    : this->classifyCell(t, p);
              }
            }
          });
      });
  }
}
}
