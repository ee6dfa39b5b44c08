// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryMatch.h"

#include "Outline.h"
#include "SurfaceProjection.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace tautline
{
namespace
{
/// The largest distances of mesh points from matching curves and corners, as fractions of the
/// shortest edge at a point. The limit grows with the offset of most boundary points from the
/// geometry, times `timesOffset`; points that are farther away belong to a neighboring row of
/// points.
constexpr double leastDistance = 0.02, largestDistance = 0.15;
constexpr double timesOffset = 3;
/// The quantile of the offsets of the points from the geometry that represents most of them.
constexpr double mostPoints = 0.9;
/// The same for sharp edges and corners of the mesh, which are unambiguous.
constexpr double largestOfSharp = 0.5;
/// A point within a curve of the mesh is a corner if it is nearer to one than this.
constexpr double cornerWithinCurve = 0.05;
/// Cosine of the angle between an edge and the curve that it follows: 30 degrees.
constexpr double along = 0.866;
/// A curve is matched if mesh edges cover at least this fraction of its length.
constexpr double leastShare = 0.5;
/// A curve with a free end that is shorter than this many mesh edges is noise.
constexpr double shortestCurve = 3;
/// A patch (curve) of the geometry belongs to one of the mesh if it is nearest to at least this
/// fraction of it.
constexpr double leastVotes = 0.1;
/// The largest median distance of the points from the geometry, relative to the diagonal of the
/// mesh.
constexpr double farthest = 0.5;

using Edge = std::array<Index, 2>;

/// The features of a geometry; for a planar mesh, of an outline.
Features featuresOf(const Mesh& mesh, const Mesh& geometry, double angle)
{
  const bool planar = mesh.dimension() == Dimension::Planar;
  if (planar && geometry.dimension() == Dimension::None)
  {
    return outlineFeatures(geometry.view(), angle);
  }
  FeatureOptions options;
  options.angle = angle;
  options.asSurface = !planar;
  return findFeatures(geometry, options);
}

/// An edge of the boundary of the mesh that may be on a curve.
struct BoundaryEdge
{
  Index a, b;
  bool sharp; ///< a feature of the mesh alone
};

class Matcher
{
public:
  Matcher(const Mesh& mesh, const FeatureOptions& options, const unsigned char* held,
    const Mesh& geometry)
    : TheMesh(mesh)
    , View(mesh.view())
    , Options(options)
    , Held(held)
    , Geometry(geometry)
    , Planar(mesh.dimension() == Dimension::Planar && !options.asSurface)
    , Own(findFeatures(mesh, options))
    , Theirs(featuresOf(mesh, geometry, options.angle))
  {
  }

  GeometryMatch run()
  {
    this->makeCurves();
    this->measure();
    this->matchEdges();
    this->matchCorners();
    this->labelMesh();
    this->makePatches();
    this->makeParts();
    this->placePoints();
    return std::move(this->Match);
  }

private:
  /// The curve that an edge follows, or -1, and its distance from the middle, relative to the
  /// length.
  struct Following
  {
    int curve;
    double off;
  };
  void makeCurves();
  void measure();
  std::vector<BoundaryEdge> boundaryEdges() const;
  Following curveAlong(const BoundaryEdge& edge) const;
  std::vector<int> curvesAlong(const std::vector<BoundaryEdge>& edges) const;
  void matchEdges();
  void leaveOut(std::vector<int>& curveOf, const std::vector<BoundaryEdge>& edges) const;
  bool isNoise(int curve, double edgeLength) const;
  void matchCorners();
  void labelMesh();
  void makePatches();
  void makeParts();
  void placePoints();
  Vec3 at(Index p) const { return pointOf(this->View, p); }
  bool stays(Index p) const { return this->Held && this->Held[p]; }
  signed char given(Index p) const
  {
    return this->Options.kinds ? this->Options.kinds[p] : static_cast<signed char>(DetectKind);
  }

  const Mesh& TheMesh;
  const MeshView& View;
  const FeatureOptions& Options;
  const unsigned char* Held;
  const Mesh& Geometry;
  bool Planar;
  Features Own, Theirs;
  SurfaceModel TheirModel;                  ///< of Theirs
  std::vector<SurfaceProjection> EachCurve; ///< of Theirs
  SurfaceProjection Curves;                 ///< of Theirs
  std::vector<double> CurveLength;          ///< of Theirs
  std::vector<char> FreeEnd;                ///< of the curves of Theirs
  double Offset = 0;                        ///< of most points from the geometry
  std::vector<double> Shortest;             ///< per point of the boundary, of its edges there
  std::vector<Edge> Matched;                ///< edges of the mesh on curves of the geometry, sorted
  std::vector<char> Represented;            ///< curves of the geometry that the mesh has
  std::vector<std::int32_t> CornerOf;       ///< per point of the mesh: index in Corners, or -1
  std::vector<Vec3> Corners;                ///< of the geometry
  SurfaceModel Patches;                     ///< of the geometry, divided by the matched curves
  GeometryMatch Match;
};

//------------------------------------------------------------------------------
/// The curves and corners of the geometry.
void Matcher::makeCurves()
{
  this->TheirModel = makeSurfaceModel(this->Geometry, this->Theirs, false);
  const int patches = this->TheirModel.patches;
  const int parts = static_cast<int>(this->TheirModel.parts.size());
  const auto empty = [](const SurfacePart& part) { return part.pieces.empty(); };
  const bool none =
    std::all_of(this->TheirModel.parts.begin(), this->TheirModel.parts.end(), empty);
  if (none || (patches == 0 && !this->Planar))
  {
    throw Error(this->Planar ? "The geometry has no lines and no border to slide on."
                             : "The geometry has no triangles or quadrilaterals to slide on.");
  }
  this->Curves = SurfaceProjection::ofParts(this->TheirModel, patches, parts, nullptr);
  for (int part = patches; part < parts; ++part)
  {
    this->EachCurve.emplace_back(this->TheirModel.parts[part], nullptr);
  }
  this->CurveLength.assign(this->Theirs.curves, 0.0);
  this->FreeEnd.assign(this->Theirs.curves, 0);
  const MeshView& view = this->Geometry.view();
  std::map<Index, int> ends; // edges that end at a corner
  for (const Features::Edge& e : this->Theirs.edges)
  {
    const double length = norm(pointOf(view, e.second) - pointOf(view, e.first));
    this->CurveLength[e.curve] += std::isfinite(length) ? length : 0;
    ++ends[e.first];
    ++ends[e.second];
  }
  for (const Features::Edge& e : this->Theirs.edges)
  {
    this->FreeEnd[e.curve] |= ends[e.first] == 1 || ends[e.second] == 1;
  }
  for (Index q = 0; q < view.numberOfPoints; ++q)
  {
    if (this->Theirs.kind[q] == CornerPoint)
    {
      this->Corners.push_back(pointOf(view, q));
    }
  }
}

//------------------------------------------------------------------------------
/// The edges of the facets, each once; of a planar mesh the edges of its boundary.
std::vector<BoundaryEdge> Matcher::boundaryEdges() const
{
  std::vector<Edge> sharp, all;
  const auto sorted = [](Index a, Index b) { return Edge{ std::min(a, b), std::max(a, b) }; };
  for (const Features::Edge& e : this->Own.edges)
  {
    sharp.push_back(sorted(e.first, e.second));
  }
  std::sort(sharp.begin(), sharp.end());
  for (const Features::Facet& facet : this->Own.facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      all.push_back(sorted(facet.nodes[k], facet.nodes[(k + 1) % facet.size]));
    }
  }
  all.insert(all.end(), sharp.begin(), sharp.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<BoundaryEdge> edges;
  for (const Edge& e : all)
  {
    const Vec3 d = this->at(e[1]) - this->at(e[0]);
    if (e[0] != e[1] && dot(d, d) > 0 && std::isfinite(dot(d, d)))
    {
      edges.push_back({ e[0], e[1], std::binary_search(sharp.begin(), sharp.end(), e) });
    }
  }
  return edges;
}

//------------------------------------------------------------------------------
/// The lengths of the edges at each point, and how far the points are from the geometry.
void Matcher::measure()
{
  this->Shortest.assign(this->View.numberOfPoints, HUGE_VAL);
  for (const BoundaryEdge& e : this->boundaryEdges())
  {
    const double length = norm(this->at(e.b) - this->at(e.a));
    this->Shortest[e.a] = std::min(this->Shortest[e.a], length);
    this->Shortest[e.b] = std::min(this->Shortest[e.b], length);
  }
  const SurfaceProjection whole = SurfaceProjection::ofFacets(this->TheirModel, nullptr);
  std::vector<double> offsets;
  Vec3 low = { HUGE_VAL, HUGE_VAL, HUGE_VAL }, high = -1.0 * low;
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    pollInterruption(p);
    if (this->Shortest[p] < HUGE_VAL)
    {
      const Vec3 x = this->at(p);
      for (int c = 0; c < 3; ++c)
      {
        low[c] = std::min(low[c], x[c]);
        high[c] = std::max(high[c], x[c]);
      }
      if (!this->stays(p))
      {
        offsets.push_back(norm(whole.closest(x) - x));
      }
    }
  }
  if (offsets.empty())
  {
    return;
  }
  const auto quantile = [&offsets](double share)
  {
    const auto at = offsets.begin() +
      static_cast<std::ptrdiff_t>(share * static_cast<double>(offsets.size() - 1));
    std::nth_element(offsets.begin(), at, offsets.end());
    return *at;
  };
  this->Offset = quantile(mostPoints);
  if (quantile(0.5) > farthest * norm(high - low))
  {
    throw Error("The geometry and the mesh are at different locations: half of the boundary "
                "points of the mesh are farther than " +
      std::to_string(static_cast<int>(100 * farthest)) +
      " % of the diagonal from it. Check its units and position.");
  }
}

//------------------------------------------------------------------------------
/// The curve of the geometry that an edge of the mesh follows, if any.
Matcher::Following Matcher::curveAlong(const BoundaryEdge& edge) const
{
  const Vec3 a = this->at(edge.a), b = this->at(edge.b), middle = 0.5 * (a + b);
  const double length = norm(b - a);
  const double largest = edge.sharp ? largestOfSharp : largestDistance;
  Vec3 direction = { 0, 0, 0 };
  const double off = norm(this->Curves.closest(middle, direction) - middle);
  const bool follows = off <= largest * length && std::abs(dot(direction, b - a)) >= along * length;
  const std::int32_t part = follows ? this->Curves.nearestPart(middle) : -1;
  // Its ends may be next to other curves.
  const auto isNear = [&](Index p)
  {
    const double limit = std::min(largest * this->Shortest[p],
      std::max(timesOffset * this->Offset, leastDistance * this->Shortest[p]));
    const Vec3 x = this->at(p);
    return norm(this->EachCurve[part - this->TheirModel.patches].closest(x) - x) <= limit;
  };
  const bool found = part >= 0 && isNear(edge.a) && isNear(edge.b);
  return { found ? part - this->TheirModel.patches : -1, off / length };
}

//------------------------------------------------------------------------------
bool Matcher::isNoise(int curve, double edgeLength) const
{
  return this->FreeEnd[curve] && this->CurveLength[curve] < shortestCurve * edgeLength;
}

//------------------------------------------------------------------------------
/// Leaves out the edges on curves that are noise or that the mesh covers too little.
void Matcher::leaveOut(std::vector<int>& curveOf, const std::vector<BoundaryEdge>& edges) const
{
  const auto curves = static_cast<std::size_t>(this->Theirs.curves);
  std::vector<double> length(curves, 0.0);
  std::vector<Index> count(curves, 0);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    if (curveOf[i] >= 0)
    {
      length[curveOf[i]] += norm(this->at(edges[i].b) - this->at(edges[i].a));
      ++count[curveOf[i]];
    }
  }
  for (int& curve : curveOf)
  {
    if (curve >= 0 &&
      (length[curve] < leastShare * this->CurveLength[curve] ||
        this->isNoise(curve, length[curve] / static_cast<double>(count[curve]))))
    {
      curve = -1;
    }
  }
}

//------------------------------------------------------------------------------
/// The curve of each edge, or -1. A point has at most two edges of a curve: first the sharp ones,
/// then the nearest. The other edges are chords or belong to the next row.
std::vector<int> Matcher::curvesAlong(const std::vector<BoundaryEdge>& edges) const
{
  std::vector<Following> following(edges.size(), Following{ -1, 0 });
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < edges.size() && !this->Curves.empty(); ++i)
  {
    pollInterruption(static_cast<Index>(i));
    const bool smooth =
      this->given(edges[i].a) == PatchPoint || this->given(edges[i].b) == PatchPoint;
    if (!smooth || this->Planar)
    {
      following[i] = this->curveAlong(edges[i]);
      order.push_back(i);
    }
  }
  std::sort(order.begin(), order.end(),
    [&](std::size_t i, std::size_t j)
    {
      const auto key = [&](std::size_t k)
      { return std::tuple(!edges[k].sharp, following[k].off, k); };
      return key(i) < key(j);
    });
  std::map<std::pair<Index, int>, int> count;
  std::vector<int> curves(edges.size(), -1);
  for (std::size_t i : order)
  {
    const int curve = following[i].curve;
    if (curve >= 0 && count[{ edges[i].a, curve }] < 2 && count[{ edges[i].b, curve }] < 2)
    {
      curves[i] = curve;
      ++count[{ edges[i].a, curve }];
      ++count[{ edges[i].b, curve }];
    }
  }
  return curves;
}

//------------------------------------------------------------------------------
void Matcher::matchEdges()
{
  const std::vector<BoundaryEdge> edges = this->boundaryEdges();
  std::vector<int> curveOf = this->curvesAlong(edges);
  if (!this->Planar)
  {
    this->leaveOut(curveOf, edges);
  }
  this->Represented.assign(this->Theirs.curves, 0);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    if (curveOf[i] >= 0)
    {
      this->Matched.push_back({ edges[i].a, edges[i].b });
      this->Represented[curveOf[i]] = 1;
    }
  }
  double meanEdge = 0;
  for (const BoundaryEdge& e : edges)
  {
    meanEdge += norm(this->at(e.b) - this->at(e.a)) / static_cast<double>(edges.size());
  }
  for (int curve = 0; curve < this->Theirs.curves; ++curve)
  {
    this->Match.curvesOfGeometry += this->Represented[curve] || !this->isNoise(curve, meanEdge);
    this->Match.curves += this->Represented[curve];
  }
}

//------------------------------------------------------------------------------
/// Gives each corner of the geometry the nearest point of the mesh that is on a curve.
void Matcher::matchCorners()
{
  this->CornerOf.assign(this->View.numberOfPoints, -1);
  this->Match.cornersOfGeometry = static_cast<Index>(this->Corners.size());
  std::vector<Index> count(this->View.numberOfPoints, 0);
  for (const Edge& e : this->Matched)
  {
    ++count[e[0]];
    ++count[e[1]];
  }
  std::vector<Index> candidates;
  std::vector<double> limits;
  double largest = 0;
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    const bool own = this->Own.kind[p] == CornerPoint;
    if ((count[p] == 0 && !own) || !std::isfinite(dot(this->at(p), this->at(p))))
    {
      continue;
    }
    const double cap = own ? largestOfSharp : largestDistance;
    const double least = count[p] == 2 && !own ? cornerWithinCurve : largestDistance;
    const double limit = std::min(
      cap * this->Shortest[p], std::max(timesOffset * this->Offset, least * this->Shortest[p]));
    candidates.push_back(p);
    limits.push_back(limit);
    largest = std::max(largest, limit);
  }
  // Candidates by their first coordinate: only candidates within the largest limit are tested for a
  // corner.
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto first = [&](std::size_t i) { return this->at(candidates[i])[0]; };
  std::sort(order.begin(), order.end(),
    [&](std::size_t i, std::size_t j)
    { return first(i) != first(j) ? first(i) < first(j) : i < j; });
  for (std::size_t c = 0; c < this->Corners.size(); ++c)
  {
    const Vec3& y = this->Corners[c];
    auto at = std::lower_bound(order.begin(), order.end(), y[0] - largest,
      [&](std::size_t i, double value) { return first(i) < value; });
    Index nearest = -1;
    double least = HUGE_VAL;
    for (; at != order.end() && first(*at) <= y[0] + largest; ++at)
    {
      const double d = norm(this->at(candidates[*at]) - y);
      if (d <= limits[*at] && d < least)
      {
        least = d;
        nearest = candidates[*at];
      }
    }
    if (nearest >= 0)
    {
      std::int32_t& of = this->CornerOf[nearest];
      const bool nearer = of < 0 || least < norm(this->at(nearest) - this->Corners[of]);
      this->Match.corners += of < 0;
      of = nearer ? static_cast<std::int32_t>(c) : of;
    }
  }
}

//------------------------------------------------------------------------------
/// The features of the mesh with the matched edges and corners.
void Matcher::labelMesh()
{
  std::vector<signed char> kinds(this->View.numberOfPoints);
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    const bool corner = this->CornerOf[p] >= 0 || this->given(p) == CornerPoint;
    kinds[p] = static_cast<signed char>(corner ? CornerPoint : DetectKind);
  }
  FeatureOptions options = this->Options;
  options.kinds = kinds.data();
  options.edges = &this->Matched;
  this->Match.features = findFeatures(this->TheMesh, options);
}

//------------------------------------------------------------------------------
/// The patches of the geometry, divided by the curves that the mesh also has.
void Matcher::makePatches()
{
  if (this->Planar)
  {
    return;
  }
  std::vector<Edge> edges;
  for (const Features::Edge& e : this->Theirs.edges)
  {
    if (this->Represented[e.curve])
    {
      edges.push_back({ std::min(e.first, e.second), std::max(e.first, e.second) });
    }
  }
  std::sort(edges.begin(), edges.end());
  FeatureOptions options;
  options.angle = this->Options.angle;
  options.asSurface = true;
  options.edges = &edges;
  const Features divided = findFeatures(this->Geometry, options);
  this->Patches = makeSurfaceModel(this->Geometry, divided, false);
  this->Patches.parts.resize(this->Patches.patches);
}

//------------------------------------------------------------------------------
/// The location of the facets (edges) of a patch (curve) of the mesh.
struct Whereabouts
{
  std::map<std::int32_t, Index> votes; ///< of parts of the geometry, for the nearest
  double distance = 0, size = 0;       ///< sums of distances from it, and of sizes
  bool interface = true;               ///< all of them are between two cells

  void add(const SurfaceProjection& geometry, const Vec3& x, double itsSize, bool between)
  {
    const std::int32_t part = std::isfinite(dot(x, x)) ? geometry.nearestPart(x) : -1;
    if (part >= 0)
    {
      ++this->votes[part];
      this->distance += norm(geometry.closest(x) - x);
      this->size += itsSize;
      this->interface = this->interface && between;
    }
  }
  /// Whether the geometry, which covers only the outer surface, lacks this part.
  bool isElsewhere() const
  {
    return this->interface && this->distance > largestOfSharp * this->size;
  }
};

/// A part made of the pieces with a sufficient share of the votes, or with the most votes.
SurfacePart electedPart(const Whereabouts& place, const SurfaceModel& geometry, bool curve)
{
  Index all = 0, most = 0;
  for (const auto& [part, count] : place.votes)
  {
    all += count;
    most = std::max(most, count);
  }
  SurfacePart elected;
  elected.curve = curve;
  const double least = std::min(static_cast<double>(most), leastVotes * static_cast<double>(all));
  for (const auto& [part, count] : place.votes)
  {
    if (static_cast<double>(count) >= least)
    {
      const auto& pieces = geometry.parts[part].pieces;
      elected.pieces.insert(elected.pieces.end(), pieces.begin(), pieces.end());
    }
  }
  return elected;
}

//------------------------------------------------------------------------------
/// The parts of the geometry for the patches and curves of the mesh.
void Matcher::makeParts()
{
  const Features& features = this->Match.features;
  const SurfaceProjection patches =
    SurfaceProjection::ofParts(this->Patches, 0, this->Patches.patches, nullptr);
  std::vector<Whereabouts> ofPatch(features.patches), ofCurve(features.curves),
    ofBorder(features.curves);
  for (const Features::Facet& facet : features.facets)
  {
    Vec3 center = { 0, 0, 0 };
    for (int k = 0; k < facet.size; ++k)
    {
      center += (1.0 / facet.size) * this->at(facet.nodes[k]);
    }
    const double size = norm(this->at(facet.nodes[1]) - this->at(facet.nodes[0]));
    ofPatch[facet.patch].add(patches, center, size, facet.interface);
  }
  for (const Features::Edge& e : features.edges)
  {
    const Edge edge = { std::min(e.first, e.second), std::max(e.first, e.second) };
    const bool onCurve =
      this->Planar || std::binary_search(this->Matched.begin(), this->Matched.end(), edge);
    const Vec3 a = this->at(e.first), b = this->at(e.second);
    (onCurve ? ofCurve : ofBorder)[e.curve].add(
      onCurve ? this->Curves : patches, 0.5 * (a + b), norm(b - a), e.interface);
  }
  const SurfaceModel own = makeSurfaceModel(this->TheMesh, features, false);
  std::vector<SurfacePart>& parts = this->Match.model.parts;
  for (const Whereabouts& place : ofPatch)
  {
    parts.push_back(
      place.isElsewhere() ? own.parts[parts.size()] : electedPart(place, this->Patches, false));
  }
  this->Match.model.patches = features.patches;
  for (int curve = 0; curve < features.curves; ++curve)
  {
    const Whereabouts& place = ofCurve[curve];
    parts.push_back(place.isElsewhere() ? own.parts[parts.size()]
        : place.votes.empty()           ? electedPart(ofBorder[curve], this->Patches, false)
                                        : electedPart(place, this->TheirModel, true));
  }
}

//------------------------------------------------------------------------------
void Matcher::placePoints()
{
  const Features& features = this->Match.features;
  std::vector<SurfaceProjection> projections;
  for (const SurfacePart& part : this->Match.model.parts)
  {
    projections.emplace_back(part, nullptr);
  }
  // The parts that meet at a corner: its curves or, if it has none, its patches.
  std::map<Index, std::set<std::int32_t>> meeting;
  for (const Features::Edge& e : features.edges)
  {
    for (Index p : { e.first, e.second })
    {
      if (features.kind[p] == CornerPoint)
      {
        meeting[p].insert(features.patches + e.curve);
      }
    }
  }
  std::set<Index> hasCurve;
  for (const auto& [p, curves] : meeting)
  {
    hasCurve.insert(p);
  }
  for (const Features::Facet& facet : features.facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      const Index p = facet.nodes[k];
      if (features.kind[p] == CornerPoint && hasCurve.count(p) == 0)
      {
        meeting[p].insert(facet.patch);
      }
    }
  }
  this->Match.parts = partsOfPoints(features);
  this->Match.points.assign(this->View.points, this->View.points + 3 * this->View.numberOfPoints);
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    pollInterruption(p);
    std::int32_t& part = this->Match.parts[p];
    const Vec3 x = this->at(p);
    Vec3 y = x;
    if (this->stays(p))
    {
      part = -1;
    }
    else if (this->CornerOf[p] >= 0)
    {
      y = this->Corners[this->CornerOf[p]];
    }
    else if (part >= 0)
    {
      y = projections[part].closest(x);
    }
    else if (features.kind[p] == CornerPoint)
    {
      double least = HUGE_VAL;
      for (std::int32_t other : meeting[p])
      {
        const Vec3 z = projections[other].closest(x);
        const double d = projections[other].empty() ? HUGE_VAL : norm(z - x);
        y = d < least ? z : y;
        least = std::min(least, d);
      }
    }
    std::copy(y.begin(), y.end(), &this->Match.points[3 * p]);
  }
}
}

//------------------------------------------------------------------------------
GeometryMatch matchGeometry(
  const Mesh& mesh, const FeatureOptions& options, const unsigned char* held, const Mesh& geometry)
{
  return Matcher(mesh, options, held, geometry).run();
}
}
