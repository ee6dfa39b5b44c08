#include "WarpBoundary.h"

#include "tautline/Geometry/Predicates.h"

#include <algorithm>
#include <limits>

namespace tautline
{
WarpBoundary::WarpBoundary(const Mesh& mesh, const std::vector<unsigned char>& prescribed)
  : Input(mesh)
  , Nodes(mesh.dimension() == Dimension::Volume ? 3 : 2)
{
  // Facets by their sorted nodes; a quadrilateral's largest node and the rest tell it from others.
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
  for (std::size_t i = 0, j = 0; i < facets.size(); i = j)
  {
    for (j = i + 1; j < facets.size() && facets[j].key == facets[i].key; ++j)
    {
    }
    if (j - i > 1)
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
/// The sign of the volume of a tetrahedron; 0 where it is no more than rounding.
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
}

WarpBoundary::Crossing WarpBoundary::crossings(const double* points) const
{
  const int dimension = this->Nodes;
  const std::size_t n = this->Facets.size();
  const auto at = [&](Index p) {
    return Vec3{ points[3 * p], points[3 * p + 1], points[3 * p + 2] };
  };
  const auto inPlane = [&](Index p) {
    return Vec2{ dot(this->Input.frame()[0], at(p)), dot(this->Input.frame()[1], at(p)) };
  };

  // A grid of boxes about as large as the facets; each facet is in all boxes its bounding box
  // reaches.
  struct Box
  {
    Vec3 low, high;
  };
  std::vector<Box> boxes(n);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low = { infinity, infinity, infinity }, high = { -infinity, -infinity, -infinity };
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    Box& box = boxes[i];
    box.low = { infinity, infinity, infinity };
    box.high = { -infinity, -infinity, -infinity };
    for (int k = 0; k < dimension; ++k)
    {
      const Vec3 x = at(this->Facets[i][k]);
      for (int c = 0; c < 3; ++c)
      {
        box.low[c] = std::min(box.low[c], x[c]);
        box.high[c] = std::max(box.high[c], x[c]);
      }
    }
    double extent = 0;
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], box.low[c]);
      high[c] = std::max(high[c], box.high[c]);
      extent = std::max(extent, box.high[c] - box.low[c]);
    }
    sum += extent;
  }
  Crossing result;
  if (n < 2 || !(sum > 0))
  {
    return result;
  }
  // Not too many boxes to a facet that is much larger than the others.
  constexpr double mostAlong = 512;
  const double longest = std::max({ high[0] - low[0], high[1] - low[1], high[2] - low[2] });
  const double size = std::max(2.0 * sum / static_cast<double>(n), longest / mostAlong);
  const auto place = [&](double x, int c)
  { return static_cast<std::int64_t>(std::floor((x - low[c]) / size)); };
  constexpr int bits = 21;
  const auto key = [](std::int64_t i, std::int64_t j, std::int64_t k)
  { return (i << (2 * bits)) | (j << bits) | k; };
  std::vector<std::pair<std::int64_t, std::int32_t>> entries;
  for (std::size_t i = 0; i < n; ++i)
  {
    std::int64_t first[3], last[3];
    for (int c = 0; c < 3; ++c)
    {
      first[c] = place(boxes[i].low[c], c);
      last[c] = place(boxes[i].high[c], c);
    }
    for (std::int64_t a = first[0]; a <= last[0]; ++a)
    {
      for (std::int64_t b = first[1]; b <= last[1]; ++b)
      {
        for (std::int64_t c = first[2]; c <= last[2]; ++c)
        {
          entries.emplace_back(key(a, b, c), static_cast<std::int32_t>(i));
        }
      }
    }
  }
  std::sort(entries.begin(), entries.end());

  const auto cross = [&](const std::array<Index, 3>& a, const std::array<Index, 3>& b)
  {
    for (int i = 0; i < dimension; ++i)
    {
      for (int j = 0; j < dimension; ++j)
      {
        if (a[i] == b[j])
        {
          return false;
        }
      }
    }
    if (dimension == 2)
    {
      return segmentsMeet(inPlane(a[0]), inPlane(a[1]), inPlane(b[0]), inPlane(b[1]));
    }
    const std::array<Vec3, 3> s = { at(a[0]), at(a[1]), at(a[2]) };
    const std::array<Vec3, 3> t = { at(b[0]), at(b[1]), at(b[2]) };
    for (int k = 0; k < 3; ++k)
    {
      if (pierces(s[k], s[(k + 1) % 3], t) || pierces(t[k], t[(k + 1) % 3], s))
      {
        return true;
      }
    }
    return false;
  };
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end)
  {
    for (end = begin; end < entries.size() && entries[end].first == entries[begin].first; ++end)
    {
    }
    for (std::size_t i = begin; i < end; ++i)
    {
      for (std::size_t j = i + 1; j < end; ++j)
      {
        const Box &a = boxes[entries[i].second], &b = boxes[entries[j].second];
        std::int64_t corner[3];
        bool apart = false;
        for (int c = 0; c < 3; ++c)
        {
          apart = apart || a.low[c] > b.high[c] || b.low[c] > a.high[c];
          corner[c] = place(std::max(a.low[c], b.low[c]), c);
        }
        // Each pair counts in one box only: that of the lower corner of what they share.
        if (apart || key(corner[0], corner[1], corner[2]) != entries[begin].first)
        {
          continue;
        }
        const auto &f = this->Facets[entries[i].second], &g = this->Facets[entries[j].second];
        if (cross(f, g))
        {
          if (result.pairs++ == 0)
          {
            result.first = { f[0], g[0] };
          }
        }
      }
    }
  }
  return result;
}
}
