// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "CellBatch.h"
#include "CoordinateFrame.h"
#include "JacobianBounds.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Products of edges of this length overflow.
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
  const Validity corners = this->classifyCorners(t, vertices, against);
  if (!hasInside(t.type) || (corners != Valid && corners != Degenerate))
  {
    return corners;
  }
  // Take the mirror image, as in loadNodes().
  const double perUnit = 1 / unitOfExtent(extentOf(t, vertices));
  Vec3 p[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    p[k] = perUnit * vertices[k];
    p[k][0] *= this->Mirrored ? -1.0 : 1.0;
  }
  return classifyInside(t, p, corners);
}

//------------------------------------------------------------------------------
Validity Mesh::classifyCorners(
  const CellTopology& t, const Vec3* vertices, const Vec3* against) const
{
  // Scale cells of extreme size, as in normalizeExtents().
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
    // A surface quadrilateral is classified relative to its own mean normal.
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
// Values near a limit are left to classifyCell().
constexpr double clearTolerance = 2 * Mesh::degenerateTolerance();
constexpr double smallestProduct = 1e-200, largestProduct = 1e200;

/// The cells of a batch whose corners are certainly valid.
Mask clearlyValidCorners(const Mesh& mesh, const CellTopology& t, const CellVertices& batch)
{
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
    valid &= (det > 0.0) & (det * det > clearTolerance * clearTolerance * lengths2) &
      (lengths2 > smallestProduct) & (lengths2 < largestProduct);
  }
  return valid;
}

/// The squares of the lengths of four edges, and the largest of them.
Packet squares(const Packet (&edges)[2][2][3], Packet (&of)[2][2])
{
  for (int n = 0; n < 4; ++n)
  {
    of[n >> 1][n & 1] = dot(edges[n >> 1][n & 1], edges[n >> 1][n & 1]);
  }
  return max(max(of[0][0], of[0][1]), max(of[1][0], of[1][1]));
}

/// The smallest coefficient, and the product of the squares of the longest edges in each direction.
template <int Nodes>
void boundDeterminant(const CellVertices& batch, Packet& least, Packet& lengths2)
{
  bounds::Edges<Packet> edges;
  Packet c[MaxCoefficients];
  const int count = bounds::coefficients<Nodes>(batch.points, edges, c);
  least = c[0];
  for (int n = 1; n < count; ++n)
  {
    least = min(least, c[n]);
  }
  // A wedge has two edges along u and v, and three along w; the others are repeated.
  if constexpr (Nodes == 6)
  {
    for (int k = 0; k < 3; ++k)
    {
      edges.u[1][0][k] = edges.u[1][1][k] = edges.u[0][0][k];
      edges.v[1][0][k] = edges.v[1][1][k] = edges.v[0][0][k];
      edges.w[1][1][k] = edges.w[0][0][k];
    }
  }
  Packet of[2][2];
  lengths2 = squares(edges.u, of);
  lengths2 *= squares(edges.v, of);
  lengths2 *= squares(edges.w, of);
}

/// The cells of a batch that are certainly valid.
template <int Nodes>
Mask clearlyValid(const Mesh& mesh, const CellTopology& t, const CellVertices& batch)
{
  Mask valid = clearlyValidCorners(mesh, t, batch);
  if constexpr (Nodes > 5)
  {
    Packet least, lengths2;
    boundDeterminant<Nodes>(batch, least, lengths2);
    valid &= (least > 0.0) & (least * least > clearTolerance * clearTolerance * lengths2);
  }
  return valid;
}
}

//------------------------------------------------------------------------------
Mask clearlyValidCells(const Mesh& mesh, const CellTopology& t, const CellVertices& batch)
{
  return t.nodes == 8 ? clearlyValid<8>(mesh, t, batch) : clearlyValid<6>(mesh, t, batch);
}

//------------------------------------------------------------------------------
void Mesh::classifyCells(signed char* validity, int threads) const
{
  if (this->Unsupported > 0)
  {
    std::fill(validity, validity + this->View.numberOfCells, NotMeasured);
  }
  // In a mesh of ordinary size, cells that are many times larger have a stray vertex.
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
              const Mask valid = surface ? Mask{} : clearlyValid<Nodes>(*this, t, batch);
              for (int l = 0; l < count; ++l)
              {
                if (valid[l])
                {
                  validity[batch.cells[l]] = Valid;
                  continue;
                }
                Vec3 p[MaxNodes];
                for (int k = 0; k < Nodes; ++k)
                {
                  p[k] = pointOf(this->View, nodes[l][k]);
                }
                const bool stray = ordinary && extentOf(t, p) > StrayExtent;
                validity[batch.cells[l]] = stray ? NonFinite : this->classifyCell(t, p);
              }
            }
          });
      });
  }
}

//------------------------------------------------------------------------------
void Mesh::classifyMovedCells(const double* points, signed char* validity, int threads) const
{
  for (const CellBlock& block : this->Blocks)
  {
    const CellTopology& t = topology(block.type);
    forEachChunk(block.count, threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          const Index* node = this->View.connectivity + this->View.offsets[cell];
          Vec3 p[MaxNodes];
          bool moved = false;
          for (int k = 0; k < t.nodes; ++k)
          {
            const double* to = points + 3 * node[k];
            p[k] = { to[0], to[1], to[2] };
            moved = moved || !std::equal(to, to + 3, this->View.points + 3 * node[k]);
          }
          if (moved)
          {
            validity[cell] = this->classifyCell(t, p);
          }
        }
      });
  }
}
}
