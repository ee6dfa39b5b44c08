// SPDX-License-Identifier: BSD-3-Clause
#include "Features.h"

#include "FacetTable.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace tautline
{
namespace
{
/// Facets whose area is below this fraction of their longest edge squared have no usable normal.
constexpr double flattest = 1e-4;
/// Rounding of the cosine of an angle that is exactly the limit.
constexpr double roundingOfCosine = 1e-9;

/// Facets of the same class can form one patch: the boundary of a region, or the interface between
/// two.
struct FacetClass
{
  double first, second;
  int uses; ///< cells at the facet
  bool operator!=(const FacetClass& o) const
  {
    return this->first != o.first || this->second != o.second || this->uses != o.uses;
  }
};

/// An edge of the facets.
struct Side
{
  Index a, b; ///< the smaller and the larger point
  Index facet;
  bool forward; ///< the facet goes from a to b
};

/// An edge that is, or can be made, a feature.
struct Candidate
{
  Index a, b;
  double cosine; ///< cosine between the two facets; -2 on a border or junction
  bool sharp;
  FacetClass of;
  std::array<Index, 2> facets = { -1, -1 }; ///< set if there are two facets of one class
};

constexpr double borderCosine = -2;

/// FeatureOptions::coarse: the largest bend that may be smooth, as a multiple of the angle, and the
/// minimum bend of the adjacent surface, as a fraction of the bend.
constexpr double coarsest = 1.5, alike = 1.0 / 3;

/// An edge at a free end of a curve is clearly sharp above this multiple of the angle.
constexpr double clearlySharp = 1.25;

/// The angle from one vector to another.
double angleBetween(const Vec3& from, const Vec3& to)
{
  return std::atan2(norm(cross(from, to)), dot(from, to));
}

class FeatureFinder
{
public:
  FeatureFinder(const Mesh& mesh, const FeatureOptions& options)
    : TheMesh(mesh)
    , View(mesh.view())
    , Options(options)
    , Limit(std::cos(options.angle * Pi / 180) - roundingOfCosine)
    , Planar(mesh.dimension() == Dimension::Planar && !options.asSurface)
    , OfCells(mesh.dimension() == Dimension::Surface ||
        (mesh.dimension() == Dimension::Planar && options.asSurface))
  {
  }

  Features find()
  {
    if (this->OfCells)
    {
      this->takeCells();
    }
    else if (this->TheMesh.dimension() != Dimension::None)
    {
      this->takeFaces();
    }
    if (!this->Planar)
    {
      this->judgeSides();
    }
    if (this->Options.coarse && !this->Planar)
    {
      this->relaxEdges();
    }
    if (!this->Options.edges)
    {
      this->obeyKinds();
      this->dropNoise();
    }
    this->classifyPoints();
    this->findCurves();
    this->findPatches();
    return std::move(this->Result);
  }

private:
  double regionOf(Index cell) const
  {
    return this->Options.regions ? this->Options.regions[cell] : 0;
  }

  void takeCells();
  void takeFaces();
  Vec3 normalOf(const Features::Facet& facet) const;
  std::vector<Side> sortedSides() const;
  void judgeSides();
  void adoptNormals(const std::vector<Side>& sides);
  bool adopt(const std::vector<Side>& sides, bool overLongest);
  double longestEdge(const Features::Facet& facet) const;
  void judge(const Side* sides, Index count);
  void relaxEdges();
  bool bendsOn(const Candidate& edge, int side) const;
  void findFacetsOfPoints();
  void obeyKinds();
  void dropNoise();
  void classifyPoints();
  void relaxPoints(const std::vector<std::array<Index, 2>>& edges, const std::vector<Index>& count);
  bool bends(Index point, const Candidate& e, const Candidate& f) const;
  void findCurves();
  void findPatches();

  const Mesh& TheMesh;
  const MeshView& View;
  const FeatureOptions& Options;
  double Limit;
  bool Planar;
  bool OfCells; ///< the facets are the cells
  Features Result;
  std::vector<FacetClass> Classes; ///< per facet
  std::vector<Vec3> Normals;       ///< per facet, zero if it has none
  std::vector<Index> CellOf;       ///< per facet of a surface mesh
  std::vector<Candidate> Candidates;
  std::vector<Index> Starts, FacetsAt; ///< facets of each point, for relaxEdges()
};

//------------------------------------------------------------------------------
void FeatureFinder::takeCells()
{
  for (const CellBlock& block : this->TheMesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == 2 && i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      Features::Facet facet = { {}, t.nodes, -1, false };
      std::copy_n(this->View.connectivity + this->View.offsets[cell], t.nodes, facet.nodes.begin());
      this->Result.facets.push_back(facet);
      this->Classes.push_back({ this->regionOf(cell), 0, 1 });
      this->CellOf.push_back(cell);
    }
  }
}

//------------------------------------------------------------------------------
/// The facets of the boundary and of interfaces; of planar meshes these are the curves.
void FeatureFinder::takeFaces()
{
  FacetTable table(this->TheMesh);
  table.forEachFacet(
    [&](Index smallest, const FacetUse* uses, Index count)
    {
      const double first = this->regionOf(uses[0].cell),
                   second = count > 1 ? this->regionOf(uses[1].cell) : first;
      if (count == 2 && first == second)
      {
        return;
      }
      const FacetClass facetClass = { std::min(first, second), std::max(first, second),
        static_cast<int>(std::min<Index>(count, 3)) };
      if (this->Planar)
      {
        this->Candidates.push_back({ smallest, uses->others[0], borderCosine, true, facetClass });
        return;
      }
      // Outward from the cell of the smallest region, so that all facets of an interface face the
      // same way.
      const FacetUse& use = *std::min_element(uses, uses + count,
        [this](const FacetUse& a, const FacetUse& b)
        { return this->regionOf(a.cell) < this->regionOf(b.cell); });
      Features::Facet facet = { {}, 0, -1, count > 1 };
      facet.size = use.others[2] < 0 ? 3 : 4;
      facet.nodes[0] = smallest;
      facet.nodes[1] = use.others[use.forward ? 0 : 1];
      facet.nodes[facet.size - 1] = use.others[use.forward ? 1 : 0];
      if (facet.size == 4)
      {
        facet.nodes[2] = use.others[2];
      }
      this->Result.facets.push_back(facet);
      this->Classes.push_back(facetClass);
    });
}

//------------------------------------------------------------------------------
/// The unit normal, or zero if the facet is too thin.
Vec3 FeatureFinder::normalOf(const Features::Facet& facet) const
{
  Vec3 p[MaxFaceNodes];
  double longest2 = 0;
  for (int k = 0; k < facet.size; ++k)
  {
    p[k] = pointOf(this->View, facet.nodes[k]);
    const Vec3 edge = k > 0 ? p[k] - p[k - 1] : Vec3{ 0, 0, 0 };
    longest2 = std::max(longest2, dot(edge, edge));
  }
  const Vec3 closing = p[0] - p[facet.size - 1];
  longest2 = std::max(longest2, dot(closing, closing));
  const Vec3 area =
    facet.size == 3 ? cross(p[1] - p[0], p[2] - p[0]) : cross(p[2] - p[0], p[3] - p[1]);
  const double length = norm(area);
  return length > flattest * longest2 && std::isfinite(length) ? (1 / length) * area
                                                               : Vec3{ 0, 0, 0 };
}

//------------------------------------------------------------------------------
/// The edges of all facets, grouped by their points.
std::vector<Side> FeatureFinder::sortedSides() const
{
  std::vector<Index> starts(this->View.numberOfPoints + 1, 0);
  const auto forEach = [&](const auto& visit)
  {
    for (std::size_t f = 0; f < this->Result.facets.size(); ++f)
    {
      const Features::Facet& facet = this->Result.facets[f];
      for (int k = 0; k < facet.size; ++k)
      {
        const Index a = facet.nodes[k], b = facet.nodes[(k + 1) % facet.size];
        visit(Side{ std::min(a, b), std::max(a, b), static_cast<Index>(f), a < b });
      }
    }
  };
  forEach([&](const Side& side) { ++starts[side.a + 1]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Side> sides(starts.back());
  std::vector<Index> next(starts.begin(), starts.end() - 1);
  forEach([&](const Side& side) { sides[next[side.a]++] = side; });
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    std::sort(sides.begin() + starts[p], sides.begin() + starts[p + 1],
      [](const Side& s, const Side& t) { return s.b != t.b ? s.b < t.b : s.facet < t.facet; });
  }
  return sides;
}

//------------------------------------------------------------------------------
double FeatureFinder::longestEdge(const Features::Facet& facet) const
{
  double longest = 0;
  for (int k = 0; k < facet.size; ++k)
  {
    longest = std::max(longest,
      norm(pointOf(this->View, facet.nodes[(k + 1) % facet.size]) -
        pointOf(this->View, facet.nodes[k])));
  }
  return longest;
}

//------------------------------------------------------------------------------
/// Assigns the normals of neighbors to facets without one; returns whether there were any.
/// @param overLongest only from neighbors at their longest edge
bool FeatureFinder::adopt(const std::vector<Side>& sides, bool overLongest)
{
  constexpr double rounding = 1e-9;
  struct Choice
  {
    double length;
    Vec3 normal;
  };
  std::map<Index, Choice> choices; // by facet
  const auto consider = [&](const Side& of, const Side& from)
  {
    const Vec3 &own = this->Normals[of.facet], &other = this->Normals[from.facet];
    if (dot(own, own) > 0 || !(dot(other, other) > 0))
    {
      return;
    }
    const double length = norm(pointOf(this->View, of.b) - pointOf(this->View, of.a));
    const double longest = this->longestEdge(this->Result.facets[of.facet]);
    if (overLongest && length < (1 - rounding) * longest)
    {
      return;
    }
    const auto at = choices.emplace(of.facet, Choice{ -1, other }).first;
    if (length > at->second.length)
    {
      at->second = { length, (of.forward == from.forward ? -1.0 : 1.0) * other };
    }
  };
  for (std::size_t i = 1; i < sides.size(); ++i)
  {
    if (sides[i].a == sides[i - 1].a && sides[i].b == sides[i - 1].b)
    {
      consider(sides[i], sides[i - 1]);
      consider(sides[i - 1], sides[i]);
    }
  }
  for (const auto& [facet, choice] : choices)
  {
    this->Normals[facet] = choice.normal;
  }
  return !choices.empty();
}

/// A facet without area belongs to the neighbor at its longest edge: if that edge is sharp, so are
/// its other edges.
void FeatureFinder::adoptNormals(const std::vector<Side>& sides)
{
  const auto hasNone = [](const Vec3& normal) { return !(dot(normal, normal) > 0); };
  while (std::any_of(this->Normals.begin(), this->Normals.end(), hasNone) &&
    (this->adopt(sides, true) || this->adopt(sides, false)))
  {
  }
}

//------------------------------------------------------------------------------
void FeatureFinder::judgeSides()
{
  for (const Features::Facet& facet : this->Result.facets)
  {
    this->Normals.push_back(this->normalOf(facet));
  }
  const std::vector<Side> sides = this->sortedSides();
  this->adoptNormals(sides);
  for (std::size_t i = 0; i < sides.size();)
  {
    std::size_t j = i + 1;
    while (j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b)
    {
      ++j;
    }
    if (sides[i].a != sides[i].b)
    {
      this->judge(&sides[i], static_cast<Index>(j - i));
    }
    i = j;
  }
}

//------------------------------------------------------------------------------
/// Decides whether the common edge of these facets is a feature.
void FeatureFinder::judge(const Side* sides, Index count)
{
  const FacetClass& first = this->Classes[sides[0].facet];
  // The regions on both sides, for any order of the facets.
  double low = first.first, high = first.first;
  for (Index k = 1; k < count; ++k)
  {
    low = std::min(low, this->Classes[sides[k].facet].first);
    high = std::max(high, this->Classes[sides[k].facet].first);
  }
  Candidate candidate = { sides[0].a, sides[0].b, borderCosine, true,
    { low, high, static_cast<int>(count) } };
  if (count == 2 && !(first != this->Classes[sides[1].facet]))
  {
    const Index other = sides[1].facet;
    // Facets that traverse the edge in the same direction have opposite orientations.
    const double sign = sides[0].forward == sides[1].forward ? -1 : 1;
    const Vec3 &m = this->Normals[sides[0].facet], &n = this->Normals[other];
    const bool known = dot(m, m) > 0 && dot(n, n) > 0;
    candidate.cosine = known ? sign * dot(m, n) : 1.0;
    candidate.facets = { sides[0].facet, other };
    candidate.sharp = this->Options.edges
      ? std::binary_search(this->Options.edges->begin(), this->Options.edges->end(),
          std::array<Index, 2>{ candidate.a, candidate.b })
      : candidate.cosine < this->Limit;
  }
  if (candidate.sharp || this->Options.kinds)
  {
    this->Candidates.push_back(candidate);
  }
}

//------------------------------------------------------------------------------
void FeatureFinder::findFacetsOfPoints()
{
  const auto forEach = [this](const auto& visit)
  {
    for (std::size_t f = 0; f < this->Result.facets.size(); ++f)
    {
      for (int k = 0; k < this->Result.facets[f].size; ++k)
      {
        visit(this->Result.facets[f].nodes[k], static_cast<Index>(f));
      }
    }
  };
  this->Starts.assign(this->View.numberOfPoints + 1, 0);
  forEach([this](Index p, Index) { ++this->Starts[p + 1]; });
  std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
  this->FacetsAt.resize(this->Starts.back());
  std::vector<Index> next(this->Starts.begin(), this->Starts.end() - 1);
  forEach([&](Index p, Index f) { this->FacetsAt[next[p]++] = f; });
}

//------------------------------------------------------------------------------
/// Whether the surface beyond one of the two facets of an edge continues to bend about the edge, by
/// a similar angle.
bool FeatureFinder::bendsOn(const Candidate& edge, int side) const
{
  const Vec3 &own = this->Normals[edge.facets[side]], &other = this->Normals[edge.facets[1 - side]];
  const Vec3 along = pointOf(this->View, edge.b) - pointOf(this->View, edge.a);
  const double bend = angleBetween(other, own);
  const Vec3 axis = (dot(cross(other, own), along) > 0 ? 1 : -1) / norm(along) * along;
  const Features::Facet& facet = this->Result.facets[edge.facets[side]];
  for (int k = 0; k < facet.size; ++k)
  {
    const Index p = facet.nodes[k];
    for (Index i = this->Starts[p]; p != edge.a && p != edge.b && i < this->Starts[p + 1]; ++i)
    {
      const Vec3& next = this->Normals[this->FacetsAt[i]];
      // Facets whose normal is along the edge, such as the end of a cylinder, are inconclusive.
      constexpr double least = 0.5;
      const Vec3 across = next - dot(next, axis) * axis;
      const double turn = std::atan2(dot(cross(own, across), axis), dot(own, across));
      if (norm(across) > least && turn >= alike * bend &&
        turn <= coarsest * this->Options.angle / DegreesPerRadian * (1 + roundingOfCosine))
      {
        return true;
      }
    }
  }
  return false;
}

//------------------------------------------------------------------------------
/// Marks edges as smooth that are sharp only because the mesh is coarse, see
/// FeatureOptions::coarse.
void FeatureFinder::relaxEdges()
{
  const double limit =
    std::cos(std::min(Pi, coarsest * this->Options.angle / DegreesPerRadian)) - roundingOfCosine;
  this->findFacetsOfPoints();
  std::vector<Candidate*> smooth;
  for (Candidate& edge : this->Candidates)
  {
    if (edge.sharp && edge.facets[0] >= 0 && edge.cosine >= limit && this->bendsOn(edge, 0) &&
      this->bendsOn(edge, 1))
    {
      smooth.push_back(&edge);
    }
  }
  for (Candidate* edge : smooth)
  {
    edge->sharp = false;
  }
}

//------------------------------------------------------------------------------
/// Marks edges as sharp or smooth according to the given kinds of their points.
void FeatureFinder::obeyKinds()
{
  const signed char* kinds = this->Options.kinds;
  if (!kinds || this->Planar)
  {
    return;
  }
  std::vector<std::vector<Index>> at(this->View.numberOfPoints);
  for (std::size_t i = 0; i < this->Candidates.size(); ++i)
  {
    Candidate& e = this->Candidates[i];
    const bool smooth = kinds[e.a] == PatchPoint || kinds[e.b] == PatchPoint;
    e.sharp = e.sharp && !(smooth && e.cosine != borderCosine);
    for (Index p : { e.a, e.b })
    {
      if (kinds[p] == CurvePoint && !(smooth && e.cosine != borderCosine))
      {
        at[p].push_back(static_cast<Index>(i));
      }
    }
  }
  for (std::vector<Index>& edges : at)
  {
    const auto byCosine = [&](Index e, Index f)
    {
      const Candidate &c = this->Candidates[e], &d = this->Candidates[f];
      return c.cosine != d.cosine ? c.cosine < d.cosine : e < f;
    };
    std::sort(edges.begin(), edges.end(), byCosine);
    for (std::size_t k = 0; k < std::min<std::size_t>(2, edges.size()); ++k)
    {
      this->Candidates[edges[k]].sharp = true;
    }
  }
}

//------------------------------------------------------------------------------
/// Removes the ends of curves that fade out and short curves with a free end, see
/// FeatureOptions::shortestCurve.
void FeatureFinder::dropNoise()
{
  const auto isGiven = [this](Index p)
  { return this->Options.kinds && this->Options.kinds[p] > PatchPoint; };
  std::vector<std::vector<Candidate*>> at(this->View.numberOfPoints);
  for (Candidate& edge : this->Candidates)
  {
    if (edge.sharp)
    {
      at[edge.a].push_back(&edge);
      at[edge.b].push_back(&edge);
    }
  }
  const auto countAt = [&at](Index p) {
    return std::count_if(at[p].begin(), at[p].end(), [](const Candidate* e) { return e->sharp; });
  };
  const double clear = std::cos(std::min(clearlySharp * this->Options.angle, 180.0) * Pi / 180);
  for (Index p = 0; p<this->View.numberOfPoints&& this->Options.shortestCurve> 0; ++p)
  {
    for (Index end = p; countAt(end) == 1 && !isGiven(end);)
    {
      Candidate* last =
        *std::find_if(at[end].begin(), at[end].end(), [](const Candidate* e) { return e->sharp; });
      if (last->cosine < clear)
      {
        break; // clearly sharp, or a border
      }
      last->sharp = false;
      end = last->a == end ? last->b : last->a;
    }
  }
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    // From a free end to the other end of the curve or to a junction.
    std::vector<Candidate*> curve;
    bool given = isGiven(p);
    Index end = p;
    while (static_cast<int>(curve.size()) < this->Options.shortestCurve && !given &&
      countAt(end) == (curve.empty() ? 1 : 2))
    {
      const auto next = std::find_if(at[end].begin(), at[end].end(),
        [&curve](const Candidate* e) { return e->sharp && (curve.empty() || e != curve.back()); });
      curve.push_back(*next);
      end = (*next)->a == end ? (*next)->b : (*next)->a;
      given = isGiven(end) || (*next)->cosine == borderCosine;
    }
    const bool isShort =
      static_cast<int>(curve.size()) < this->Options.shortestCurve && !curve.empty() && !given;
    for (Candidate* edge : curve)
    {
      edge->sharp = edge->sharp && !isShort;
    }
  }
}

//------------------------------------------------------------------------------
/// Whether the directions of two edges at a point differ by more than the angle, or the edges
/// belong to different curves.
bool FeatureFinder::bends(Index point, const Candidate& e, const Candidate& f) const
{
  if (this->Options.edges)
  {
    return e.of != f.of;
  }
  const Vec3 center = pointOf(this->View, point);
  const Vec3 in = center - pointOf(this->View, e.a == point ? e.b : e.a);
  const Vec3 out = pointOf(this->View, f.a == point ? f.b : f.a) - center;
  return e.of != f.of || !(dot(in, out) >= this->Limit * norm(in) * norm(out));
}

//------------------------------------------------------------------------------
void FeatureFinder::classifyPoints()
{
  this->Candidates.erase(std::remove_if(this->Candidates.begin(), this->Candidates.end(),
                           [](const Candidate& e) { return !e.sharp; }),
    this->Candidates.end());
  const Index n = this->View.numberOfPoints;
  std::vector<std::array<Index, 2>> edges(n, { -1, -1 });
  std::vector<Index> count(n, 0);
  for (std::size_t i = 0; i < this->Candidates.size(); ++i)
  {
    for (Index p : { this->Candidates[i].a, this->Candidates[i].b })
    {
      if (count[p] < 2)
      {
        edges[p][count[p]] = static_cast<Index>(i);
      }
      ++count[p];
    }
  }
  this->Result.kind.assign(n, PatchPoint);
  for (Index p = 0; p < n; ++p)
  {
    const int given = this->Options.kinds ? this->Options.kinds[p] : int(DetectKind);
    PointKind kind = count[p] == 0 ? PatchPoint : CornerPoint;
    if (count[p] == 2)
    {
      const bool corner = given != CurvePoint &&
        this->bends(p, this->Candidates[edges[p][0]], this->Candidates[edges[p][1]]);
      kind = corner ? CornerPoint : CurvePoint;
    }
    this->Result.kind[p] = static_cast<signed char>(given == CornerPoint ? CornerPoint : kind);
  }
  if (this->Options.coarse)
  {
    this->relaxPoints(edges, count);
  }
}

//------------------------------------------------------------------------------
/// Marks curve points as smooth that bend only because the mesh is coarse.
/// @param edges the first two of the `count` features at each point
void FeatureFinder::relaxPoints(
  const std::vector<std::array<Index, 2>>& edges, const std::vector<Index>& count)
{
  const double limit = coarsest * this->Options.angle / DegreesPerRadian * (1 + roundingOfCosine);
  const auto across = [this](Index edge, Index p)
  { return this->Candidates[edge].a == p ? this->Candidates[edge].b : this->Candidates[edge].a; };
  const auto step = [this](Index from, Index to)
  { return pointOf(this->View, to) - pointOf(this->View, from); };
  std::vector<Index> smooth;
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    const int given = this->Options.kinds ? this->Options.kinds[p] : int(DetectKind);
    if (this->Result.kind[p] != CornerPoint || count[p] != 2 || given == CornerPoint ||
      this->Candidates[edges[p][0]].of != this->Candidates[edges[p][1]].of)
    {
      continue;
    }
    int agree = 0, differ = 0;
    const Vec3 in = step(across(edges[p][0], p), p), out = step(p, across(edges[p][1], p));
    const double bend = angleBetween(in, out);
    for (int end = 0; end < 2; ++end)
    {
      const Index q = across(edges[p][end], p);
      if (count[q] != 2)
      {
        continue; // the end of the curve
      }
      const Index r = across(edges[q][0] == edges[p][end] ? edges[q][1] : edges[q][0], q);
      const Vec3 first = end == 0 ? step(r, q) : step(p, q),
                 second = end == 0 ? step(q, p) : step(q, r);
      const bool same = dot(cross(first, second), cross(in, out)) > 0;
      const double next = angleBetween(first, second);
      (same && next >= alike * bend && next <= limit ? agree : differ) += 1;
    }
    if (bend <= limit && agree > 0 && differ == 0)
    {
      smooth.push_back(p);
    }
  }
  for (Index p : smooth)
  {
    this->Result.kind[p] = CurvePoint;
  }
}

//------------------------------------------------------------------------------
/// Joins the edges at curve points.
void FeatureFinder::findCurves()
{
  Features& result = this->Result;
  const auto edges = static_cast<Index>(this->Candidates.size());
  UnionFind joined(edges);
  std::vector<Index> last(this->View.numberOfPoints, -1);
  for (Index i = 0; i < edges; ++i)
  {
    for (Index p : { this->Candidates[i].a, this->Candidates[i].b })
    {
      if (result.kind[p] == CurvePoint && last[p] >= 0)
      {
        joined.join(last[p], i);
      }
      last[p] = i;
    }
  }
  std::map<Index, int> number;
  result.curveOf.assign(this->View.numberOfPoints, -1);
  for (Index i = 0; i < edges; ++i)
  {
    const int curve = number.emplace(joined.find(i), static_cast<int>(number.size())).first->second;
    const Candidate& e = this->Candidates[i];
    result.edges.push_back({ e.a, e.b, curve, this->Planar && e.of.uses > 1 });
    for (Index p : { e.a, e.b })
    {
      result.curveOf[p] = result.kind[p] == CurvePoint ? curve : -1;
    }
  }
  result.curves = static_cast<int>(number.size());
}

//------------------------------------------------------------------------------
/// Joins the facets across edges that are not features.
void FeatureFinder::findPatches()
{
  Features& result = this->Result;
  // Candidates that are not features were removed: the remaining ones are found by their points.
  std::vector<std::array<Index, 2>> sharp;
  for (const Features::Edge& e : result.edges)
  {
    sharp.push_back({ e.first, e.second });
  }
  UnionFind joined(static_cast<Index>(result.facets.size()));
  std::size_t next = 0; // edges and sides are in the same order
  std::sort(sharp.begin(), sharp.end());
  std::vector<Side> sides;
  if (!this->Planar)
  {
    sides = this->sortedSides();
  }
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
  {
    const std::array<Index, 2> here = { sides[i].a, sides[i].b };
    while (next < sharp.size() && sharp[next] < here)
    {
      ++next;
    }
    const bool feature = next < sharp.size() && sharp[next] == here;
    if (!feature && sides[i + 1].a == here[0] && sides[i + 1].b == here[1])
    {
      joined.join(sides[i].facet, sides[i + 1].facet);
    }
  }
  std::map<Index, int> number;
  result.patchOf.assign(this->View.numberOfPoints, -1);
  if (this->OfCells)
  {
    result.patchOfCell.assign(this->View.numberOfCells, -1);
  }
  for (std::size_t f = 0; f < result.facets.size(); ++f)
  {
    Features::Facet& facet = result.facets[f];
    facet.patch =
      number.emplace(joined.find(static_cast<Index>(f)), static_cast<int>(number.size()))
        .first->second;
    if (!this->CellOf.empty())
    {
      result.patchOfCell[this->CellOf[f]] = facet.patch;
    }
    for (int k = 0; k < facet.size; ++k)
    {
      const Index p = facet.nodes[k];
      // A point where two patches touch is a corner.
      if (result.kind[p] == PatchPoint && result.patchOf[p] >= 0 &&
        result.patchOf[p] != facet.patch)
      {
        result.kind[p] = CornerPoint;
      }
      result.patchOf[p] = result.kind[p] == PatchPoint ? facet.patch : -1;
    }
  }
  result.patches = static_cast<int>(number.size());
  for (signed char kind : result.kind)
  {
    result.corners += kind == CornerPoint;
    result.curvePoints += kind == CurvePoint;
  }
}
}

//------------------------------------------------------------------------------
Features findFeatures(const Mesh& mesh, const FeatureOptions& options)
{
  if (!(options.angle >= 0 && options.angle <= 180))
  {
    throw Error("The angle above which an edge is sharp is " + std::to_string(options.angle) +
      " degrees; it must be between 0 and 180.");
  }
  for (Index i = 0; options.kinds && i < mesh.view().numberOfPoints; ++i)
  {
    if (options.kinds[i] < DetectKind || options.kinds[i] > CornerPoint)
    {
      throw Error("The feature kind of point " + std::to_string(i) + " is " +
        std::to_string(options.kinds[i]) +
        "; it must be 0 (patch), 1 (curve), 2 (corner) or -1 (as detected).");
    }
  }
  for (Index i = 0; options.regions && i < mesh.view().numberOfCells; ++i)
  {
    if (std::isnan(options.regions[i]))
    {
      throw Error("The region of cell " + std::to_string(i) +
        " is NaN: assign a region number to every cell.");
    }
  }
  return FeatureFinder(mesh, options).find();
}
}
