// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Angles.cxx
 * @brief The distribution of the angles of a mesh, counted in batches without a single arc cosine.
 */
#include "Statistics.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/CellBatch.h"

namespace tautline
{
namespace
{
constexpr int InnerEnds = static_cast<int>(angleBins.size()) - 2;

/// The counts of one chunk: the number of angles, and the number above each inner end of a bin.
struct AngleCounts
{
  Index angles = 0;
  Index beyond[InnerEnds] = {};
};

/// The same per lane of the batches of a chunk.
struct AngleCounter
{
  Mask angles = {};
  Mask beyond[InnerEnds] = {};
  Packet signedSquares[InnerEnds]; ///< cos |cos| of the inner ends

  AngleCounter()
  {
    for (int i = 0; i < InnerEnds; ++i)
    {
      const double c = std::cos(angleBins[i + 1] * Pi / 180);
      this->signedSquares[i] = broadcast(c * std::abs(c));
    }
  }

  /**
   * Counts the angle with this cosine times the root of lengths2 in the lanes of `use`; in the
   * lanes of `reflex`, it is beyond every end. An angle exceeds an end if its cosine, and therefore
   * its signed square, is smaller. (Set bits are -1.)
   */
  void add(Packet product, Packet lengths2, Mask use, Mask reflex)
  {
    const Packet square = product * abs(product);
    this->angles -= use;
    for (int i = 0; i < InnerEnds; ++i)
    {
      const Mask passed = square <= this->signedSquares[i] * lengths2;
      this->beyond[i] -= use & (passed | reflex);
    }
  }

  AngleCounts total() const
  {
    AngleCounts counts;
    for (int l = 0; l < PacketWidth; ++l)
    {
      counts.angles += this->angles[l];
      for (int i = 0; i < InnerEnds; ++i)
      {
        counts.beyond[i] += this->beyond[i][l];
      }
    }
    return counts;
  }
};

/// The normal of a face or of a 2D cell; for a quadrilateral, from its diagonals.
void faceNormal(const CellVertices& batch, const int* n, int size, Packet* normal)
{
  Packet u[3], v[3];
  subtract(batch.points[n[size == 3 ? 1 : 2]], batch.points[n[0]], u);
  subtract(batch.points[n[size == 3 ? 2 : 3]], batch.points[n[size == 3 ? 0 : 1]], v);
  cross(u, v, normal);
}

void countCorners(const CellTopology& t, const CellVertices& batch, Mask use, AngleCounter& counter)
{
  constexpr int all[MaxFaceNodes] = { 0, 1, 2, 3 };
  Packet area[3];
  faceNormal(batch, all, t.nodes, area);
  for (int c = 0; c < t.corners; ++c)
  {
    const auto& n = t.cornerNodes[c];
    Packet a[3], b[3], own[3];
    subtract(batch.points[n[1]], batch.points[n[0]], a);
    subtract(batch.points[n[2]], batch.points[n[0]], b);
    cross(a, b, own);
    // At a reflex corner, the normal of the corner is opposite to the area vector.
    counter.add(dot(a, b), dot(a, a) * dot(b, b), use, dot(own, area) < 0.0);
  }
}

void countDihedrals(
  const CellTopology& t, const CellVertices& batch, Mask use, AngleCounter& counter)
{
  Packet normals[MaxFaces][3], lengths2[MaxFaces];
  for (int f = 0; f < t.faces; ++f)
  {
    faceNormal(batch, t.faceNodes[f].data(), t.faceSizes[f], normals[f]);
    lengths2[f] = dot(normals[f], normals[f]);
  }
  for (int e = 0; e < t.edges; ++e)
  {
    const int f = t.edgeFaces[e][0], g = t.edgeFaces[e][1];
    // The angle between outward normals is 180 degrees minus the dihedral angle, hence the sign.
    counter.add(-dot(normals[f], normals[g]), lengths2[f] * lengths2[g], use, Mask{});
  }
}
}

//------------------------------------------------------------------------------
std::array<Index, angleBins.size() - 1> angleDistribution(
  const Mesh& mesh, const signed char* validity, const unsigned char* skip, int threads)
{
  AngleCounts total;
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != dimension)
    {
      continue;
    }
    const CellSource source = { &mesh, &block, &t };
    std::vector<AngleCounts> perChunk(numberOfChunks(block.count));
    withNodes(t,
      [&](auto nodesOfCell)
      {
        constexpr int Nodes = decltype(nodesOfCell)::value;
        forEachChunk(block.count, threads,
          [&](Index chunk, Index begin, Index end)
          {
            AngleCounter counter;
            CellVertices batch;
            BatchNodes nodes;
            for (Index i = begin; i < end; i += PacketWidth)
            {
              const int count = static_cast<int>(std::min<Index>(PacketWidth, end - i));
              gather<Nodes>(source, nullptr, i, count, batch, nodes);
              // With extents near 1, the powers of coordinates cannot overflow.
              normalizeExtents<Nodes>(batch);
              Mask use = {};
              for (int l = 0; l < count; ++l)
              {
                const Index cell = batch.cells[l];
                const bool counts = validity[cell] == Valid || validity[cell] == Inverted;
                use[l] = counts && !(skip && skip[cell]) ? -1 : 0;
              }
              dimension == 2 ? countCorners(t, batch, use, counter)
                             : countDihedrals(t, batch, use, counter);
            }
            perChunk[chunk] = counter.total();
          });
      });
    for (const AngleCounts& counts : perChunk)
    {
      total.angles += counts.angles;
      for (int i = 0; i < InnerEnds; ++i)
      {
        total.beyond[i] += counts.beyond[i];
      }
    }
  }
  std::array<Index, angleBins.size() - 1> bins{};
  // The counts are cumulative: their differences are the bins.
  for (int i = 0; i <= InnerEnds; ++i)
  {
    bins[i] = (i == 0 ? total.angles : total.beyond[i - 1]) - (i < InnerEnds ? total.beyond[i] : 0);
  }
  return bins;
}
}
