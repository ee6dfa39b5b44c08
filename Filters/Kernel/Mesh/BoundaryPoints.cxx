#include "BoundaryPoints.h"

#include <algorithm>
#include <cstdint>

namespace tautline
{
namespace
{
/// A well-mixed number for each id (the finaliser of SplitMix64).
inline std::uint64_t mix(std::uint64_t z)
{
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// What the facets of a cell leave at its nodes.
template <class Marks>
void addMarks(const CellTopology& t, const Index* node, Marks&& marks)
{
  std::uint64_t number[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    number[k] = mix(static_cast<std::uint64_t>(node[k]));
  }
  const int facets = t.dimension == 3 ? t.faces : t.edges;
  std::uint64_t sum[MaxNodes] = {};
  for (int f = 0; f < facets; ++f)
  {
    const int size = t.dimension == 3 ? t.faceSizes[f] : 2;
    const int* member = t.dimension == 3 ? t.faceNodes[f].data() : t.edgeNodes[f].data();
    std::uint64_t facet = 0; // the same for each order of the nodes
    for (int k = 0; k < size; ++k)
    {
      facet += number[member[k]];
    }
    facet = mix(facet);
    for (int k = 0; k < size; ++k)
    {
      sum[member[k]] ^= facet;
    }
  }
  for (int k = 0; k < t.nodes; ++k)
  {
    marks[node[k]] ^= sum[k];
  }
}

int dimensionOf(const Mesh& mesh)
{
  return mesh.dimension() == Dimension::Volume ? 3 : 2;
}
}

//------------------------------------------------------------------------------
std::vector<char> boundaryPoints(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  std::vector<std::uint64_t> marks(view.numberOfPoints, 0);
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != dimensionOf(mesh))
    {
      continue;
    }
    if (block.type == CellType::Tetrahedron)
    {
      // The same, unrolled: a face's number is that of the sum of its nodes.
      for (Index i = 0; i < block.count; ++i)
      {
        const Index* node = view.connectivity + view.offsets[block.cell(i)];
        std::uint64_t a[4], face[4];
        for (int k = 0; k < 4; ++k)
        {
          a[k] = mix(static_cast<std::uint64_t>(node[k]));
        }
        for (int k = 0; k < 4; ++k)
        {
          face[k] = mix(a[(k + 1) & 3] + a[(k + 2) & 3] + a[(k + 3) & 3]);
        }
        const std::uint64_t all = face[0] ^ face[1] ^ face[2] ^ face[3];
        for (int k = 0; k < 4; ++k)
        {
          marks[node[k]] ^= all ^ face[k];
        }
      }
      continue;
    }
    for (Index i = 0; i < block.count; ++i)
    {
      addMarks(t, view.connectivity + view.offsets[block.cell(i)], marks);
    }
  }
  std::vector<char> boundary(view.numberOfPoints);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    boundary[p] = marks[p] != 0;
  }
  if (std::find(boundary.begin(), boundary.end(), 1) == boundary.end())
  {
    return mesh.boundary().isBoundaryPoint;
  }
  return boundary;
}
}
