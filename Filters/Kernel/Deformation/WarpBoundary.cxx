// SPDX-License-Identifier: BSD-3-Clause
#include "WarpBoundary.h"

#include "tautline/Geometry/Predicates.h"

#include <algorithm>
#include <limits>
#include <map>

namespace tautline
{
WarpBoundary::WarpBoundary(
  const Mesh& mesh, const std::vector<unsigned char>& prescribed, const Ranks& ranks)
  : Input(mesh)
  , TheRanks(ranks)
  , Nodes(ranks.dimension(mesh) == Dimension::Volume ? 3 : 2)
{
  // Equal facets have equal keys: their sorted nodes.
  struct Facet
  {
    std::array<Index, 4> key;
    std::array<Index, 4> nodes;
    int size;
  };
  std::vector<Facet> facets;
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != this->Nodes)
    {
      continue;
    }
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      int count = 0;
      for (int k = 0; k < t.nodes; ++k)
      {
        count += prescribed[node[k]] != 0;
      }
      for (int f = 0; count >= this->Nodes && f < (t.dimension == 3 ? t.faces : t.edges); ++f)
      {
        Facet facet = { { -1, -1, -1, -1 }, { -1, -1, -1, -1 }, 2 };
        facet.size = t.dimension == 3 ? t.faceSizes[f] : 2;
        bool all = true;
        for (int k = 0; k < facet.size; ++k)
        {
          facet.nodes[k] = node[t.dimension == 3 ? t.faceNodes[f][k] : t.edgeNodes[f][k]];
          all = all && prescribed[facet.nodes[k]];
        }
        if (all)
        {
          facet.key = facet.nodes;
          std::sort(facet.key.begin(), facet.key.begin() + facet.size);
          facets.push_back(facet);
        }
      }
    }
  }
  std::sort(
    facets.begin(), facets.end(), [](const Facet& a, const Facet& b) { return a.key < b.key; });
  // Keep facets of one cell only; a quadrilateral becomes two triangles.
  for (std::size_t i = 0, j = 0; i < facets.size(); i = j)
  {
    for (j = i + 1; j < facets.size() && facets[j].key == facets[i].key; ++j)
    {
    }
    // For facets at an owned point, all cells are local.
    if (j - i > 1 || !ranks.owns(facets[i].key[0]))
    {
      continue;
    }
    const std::array<Index, 4>& n = facets[i].nodes;
    this->Facets.push_back({ n[0], n[1], n[2] });
    if (facets[i].size == 4)
    {
      this->Facets.push_back({ n[0], n[2], n[3] });
    }
  }
}

//------------------------------------------------------------------------------
namespace
{
/// The sign of the volume of a tetrahedron; 0 if it is within the rounding error.
int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  constexpr double rounding = 1e-12;
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double volume = dot(cross(u, v), w);
  const double size = norm(u) * norm(v) * norm(w);
  return volume > rounding * size ? 1 : volume < -rounding * size ? -1 : 0;
}

/// Whether the segment goes through the inside of the triangle.
bool pierces(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t)
{
  if (side(t[0], t[1], t[2], p) * side(t[0], t[1], t[2], q) >= 0)
  {
    return false;
  }
  const int s = side(p, q, t[0], t[1]);
  return s != 0 && side(p, q, t[1], t[2]) == s && side(p, q, t[2], t[0]) == s;
}

/// A grid of cubes about as large as the facets; each facet is in all cubes that its bounding box
/// meets.
class FacetGrid
{
public:
  struct Box
  {
    Vec3 low, high;
  };

  explicit FacetGrid(std::vector<Box> boxes)
    : Boxes(std::move(boxes))
  {
    Vec3 high = { -Infinity, -Infinity, -Infinity };
    this->Low = { Infinity, Infinity, Infinity };
    double sum = 0;
    for (const Box& box : this->Boxes)
    {
      double extent = 0;
      for (int c = 0; c < 3; ++c)
      {
        this->Low[c] = std::min(this->Low[c], box.low[c]);
        high[c] = std::max(high[c], box.high[c]);
        extent = std::max(extent, box.high[c] - box.low[c]);
      }
      sum += extent;
    }
    if (this->Boxes.size() < 2 || !(sum > 0))
    {
      return;
    }
    // Cubes are at least twice the mean extent, with few along the whole box, so that a facet much
    // larger than the others does not meet too many.
    constexpr double maxAlong = 512;
    const Vec3 extent = high - this->Low;
    const double longest = std::max({ extent[0], extent[1], extent[2] });
    this->Size = std::max(2.0 * sum / static_cast<double>(this->Boxes.size()), longest / maxAlong);
    this->enter();
  }

  static Box emptyBox()
  {
    return { { Infinity, Infinity, Infinity }, { -Infinity, -Infinity, -Infinity } };
  }

  /// Calls visit(i, j) once for each pair of facets whose boxes meet.
  template <class Visit>
  void forEachPair(const Visit& visit) const
  {
    for (std::size_t begin = 0, end = 0; begin < this->Entries.size(); begin = end)
    {
      const std::int64_t key = this->Entries[begin].first;
      for (end = begin; end < this->Entries.size() && this->Entries[end].first == key; ++end)
      {
      }
      for (std::size_t i = begin; i < end; ++i)
      {
        for (std::size_t j = i + 1; j < end; ++j)
        {
          const std::int32_t a = this->Entries[i].second, b = this->Entries[j].second;
          // Each pair is visited in one cube only: the cube of the lower corner of the box
          // intersection.
          if (this->keyOfOverlap(this->Boxes[a], this->Boxes[b]) == key)
          {
            visit(a, b);
          }
        }
      }
    }
  }

private:
  static constexpr double Infinity = std::numeric_limits<double>::infinity();
  static constexpr std::int64_t Apart = -1;

  std::int64_t place(double x, int c) const
  {
    return static_cast<std::int64_t>(std::floor((x - this->Low[c]) / this->Size));
  }
  static std::int64_t key(std::int64_t i, std::int64_t j, std::int64_t k)
  {
    constexpr int bits = 21;
    return (i << (2 * bits)) | (j << bits) | k;
  }
  std::int64_t keyOfOverlap(const Box& a, const Box& b) const
  {
    std::int64_t corner[3];
    for (int c = 0; c < 3; ++c)
    {
      if (a.low[c] > b.high[c] || b.low[c] > a.high[c])
      {
        return Apart;
      }
      corner[c] = this->place(std::max(a.low[c], b.low[c]), c);
    }
    return key(corner[0], corner[1], corner[2]);
  }
  void enter()
  {
    for (std::size_t i = 0; i < this->Boxes.size(); ++i)
    {
      std::int64_t first[3], last[3];
      for (int c = 0; c < 3; ++c)
      {
        first[c] = this->place(this->Boxes[i].low[c], c);
        last[c] = this->place(this->Boxes[i].high[c], c);
      }
      for (std::int64_t a = first[0]; a <= last[0]; ++a)
      {
        for (std::int64_t b = first[1]; b <= last[1]; ++b)
        {
          for (std::int64_t c = first[2]; c <= last[2]; ++c)
          {
            this->Entries.emplace_back(key(a, b, c), static_cast<std::int32_t>(i));
          }
        }
      }
    }
    std::sort(this->Entries.begin(), this->Entries.end());
  }

  std::vector<Box> Boxes;
  Vec3 Low = { 0, 0, 0 };
  double Size = 1;
  std::vector<std::pair<std::int64_t, std::int32_t>> Entries; ///< (cube, facet), sorted
};

bool triangleEdgesPierce(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t)
{
  for (int k = 0; k < 3; ++k)
  {
    if (pierces(s[k], s[(k + 1) % 3], t) || pierces(t[k], t[(k + 1) % 3], s))
    {
      return true;
    }
  }
  return false;
}
}

WarpBoundary::Crossing WarpBoundary::crossings(const double* points) const
{
  if (!this->TheRanks.several())
  {
    return this->crossingsAmong(this->Facets, points);
  }
  // Send the facets to the first rank with cells, whose mesh defines the plane of a planar mesh.
  struct Corner
  {
    Index number;
    Vec3 place;
  };
  const DistributedMesh& mesh = this->TheRanks.mesh();
  RankGroup& group = mesh.group();
  const bool any = this->Input.dimension() != Dimension::None;
  const Index last = group.size() - 1;
  const Index root = last - group.maximum(any ? last - group.rank() : Index(0));
  std::vector<std::vector<Corner>> sent(group.size());
  for (const std::array<Index, 3>& facet : this->Facets)
  {
    for (int k = 0; k < this->Nodes; ++k)
    {
      const double* p = points + 3 * facet[k];
      sent[root].push_back({ mesh.numbers()[facet[k]], { p[0], p[1], p[2] } });
    }
  }
  std::vector<Corner> corners;
  for (const std::vector<Corner>& list : group.exchangeItems(sent))
  {
    corners.insert(corners.end(), list.begin(), list.end());
  }
  Crossing result;
  this->TheRanks.together(
    [&]
    {
      std::map<Index, Index> known; // by number
      std::vector<double> places;
      FacetList facets(corners.size() / this->Nodes);
      for (std::size_t i = 0; i < corners.size(); ++i)
      {
        const auto [at, fresh] = known.emplace(corners[i].number, static_cast<Index>(known.size()));
        if (fresh)
        {
          places.insert(places.end(), corners[i].place.begin(), corners[i].place.end());
        }
        facets[i / this->Nodes][i % this->Nodes] = at->second;
      }
      result = this->crossingsAmong(facets, places.data());
    });
  result.pairs = group.sum(result.pairs);
  return result;
}

//------------------------------------------------------------------------------
WarpBoundary::Crossing WarpBoundary::crossingsAmong(
  const FacetList& facets, const double* points) const
{
  const int nodes = this->Nodes;
  const auto at = [&](Index p) {
    return Vec3{ points[3 * p], points[3 * p + 1], points[3 * p + 2] };
  };
  const auto inPlane = [&](Index p) {
    return Vec2{ dot(this->Input.frame()[0], at(p)), dot(this->Input.frame()[1], at(p)) };
  };
  std::vector<FacetGrid::Box> boxes(facets.size(), FacetGrid::emptyBox());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    for (int k = 0; k < nodes; ++k)
    {
      const Vec3 x = at(facets[i][k]);
      for (int c = 0; c < 3; ++c)
      {
        boxes[i].low[c] = std::min(boxes[i].low[c], x[c]);
        boxes[i].high[c] = std::max(boxes[i].high[c], x[c]);
      }
    }
  }
  const auto cross = [&](const std::array<Index, 3>& a, const std::array<Index, 3>& b)
  {
    const auto inB = [&](Index p)
    { return std::find(b.begin(), b.begin() + nodes, p) != b.begin() + nodes; };
    if (std::any_of(a.begin(), a.begin() + nodes, inB))
    {
      return false;
    }
    return nodes == 2
      ? segmentsMeet(inPlane(a[0]), inPlane(a[1]), inPlane(b[0]), inPlane(b[1]))
      : triangleEdgesPierce({ at(a[0]), at(a[1]), at(a[2]) }, { at(b[0]), at(b[1]), at(b[2]) });
  };
  Crossing result;
  FacetGrid(std::move(boxes))
    .forEachPair(
      [&](std::int32_t i, std::int32_t j)
      {
        const auto &f = facets[i], &g = facets[j];
        if (cross(f, g) && result.pairs++ == 0)
        {
          result.first = { f[0], g[0] };
        }
      });
  return result;
}
}
