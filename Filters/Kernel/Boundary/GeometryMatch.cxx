// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryMatch.h"

#include "SurfaceProjection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// Curves and corners correspond if they are nearer than this fraction of an edge.
constexpr double matchingDistance = 0.5;
/// Facets (edges) of a patch (curve) that its distance from others is measured at, at most.
constexpr std::size_t maxSamples = 64;

class Matcher
{
public:
  Matcher(const Mesh& mesh, const Features& features, const std::vector<unsigned char>& slides,
    const Mesh& geometry, const Features& geometryFeatures)
    : View(mesh.view())
    , TheFeatures(features)
    , Slides(slides)
    , Geometry(geometry.view())
    , OfGeometry(geometryFeatures)
  {
    for (Index q = 0; q < this->Geometry.numberOfPoints; ++q)
    {
      if (this->OfGeometry.kind[q] == CornerPoint)
      {
        this->Corners.push_back(pointOf(this->Geometry, q));
      }
    }
    this->Match.model = makeSurfaceModel(geometry, geometryFeatures, false);
    for (const SurfacePart& part : this->Match.model.parts)
    {
      this->Parts.emplace_back(part, nullptr);
    }
  }

  GeometryMatch run()
  {
    this->Match.partOfPatch = this->matchPatches();
    this->Match.partOfCurve = this->matchCurves();
    this->Match.parts.assign(this->View.numberOfPoints, -1);
    this->Match.points.assign(this->View.points, this->View.points + 3 * this->View.numberOfPoints);
    for (Index p = 0; p < this->View.numberOfPoints; ++p)
    {
      const signed char kind = this->TheFeatures.kind[p];
      const int patch = this->TheFeatures.patchOf[p], curve = this->TheFeatures.curveOf[p];
      if (!this->Slides[p] || (kind == PatchPoint && patch < 0))
      {
        continue;
      }
      if (kind == CornerPoint)
      {
        this->place(p, this->cornerFor(p));
        continue;
      }
      const int part =
        kind == CurvePoint ? this->Match.partOfCurve[curve] : this->Match.partOfPatch[patch];
      this->Match.parts[p] = part;
      this->place(p, this->Parts[part].closest(pointOf(this->View, p)));
    }
    return std::move(this->Match);
  }

private:
  void place(Index p, const Vec3& x) { std::copy(x.begin(), x.end(), &this->Match.points[3 * p]); }
  double distance2(int part, const Vec3& x) const
  {
    const Vec3 d = this->Parts[part].closest(x) - x;
    return dot(d, d);
  }
  /// The part in a range whose sum of squared distances from some places is the smallest.
  std::pair<int, double> nearestPart(const std::vector<Vec3>& places, int begin, int end) const
  {
    std::pair<int, double> best = { -1, HUGE_VAL };
    const std::size_t step = 1 + places.size() / maxSamples;
    for (int part = begin; part < end; ++part)
    {
      double sum = 0;
      for (std::size_t i = 0; i < places.size() && sum < best.second; i += step)
      {
        sum += this->distance2(part, places[i]);
      }
      best = sum < best.second ? std::pair(part, sum) : best;
    }
    const auto samples = static_cast<double>((places.size() + step - 1) / step);
    return { best.first, std::sqrt(best.second / samples) };
  }
  /// The nearest patch; the nearest curve of a geometry without patches.
  int nearestSurface(const std::vector<Vec3>& places) const
  {
    const int patches = this->Match.model.patches;
    const int end = patches > 0 ? patches : static_cast<int>(this->Parts.size());
    return this->nearestPart(places, 0, end).first;
  }
  std::vector<int> matchPatches() const;
  std::vector<int> matchCurves();
  Vec3 cornerFor(Index p);

  const MeshView& View;
  const Features& TheFeatures;
  const std::vector<unsigned char>& Slides;
  const MeshView& Geometry;
  const Features& OfGeometry;
  std::vector<Vec3> Corners; ///< of the geometry
  std::vector<SurfaceProjection> Parts;
  std::vector<double> ShortestEdge; ///< per point, of the edges of curves
  GeometryMatch Match;
};

//------------------------------------------------------------------------------
std::vector<int> Matcher::matchPatches() const
{
  std::vector<std::vector<Vec3>> centers(this->TheFeatures.patches);
  for (const Features::Facet& facet : this->TheFeatures.facets)
  {
    Vec3 center = { 0, 0, 0 };
    for (int k = 0; k < facet.size; ++k)
    {
      center += (1.0 / facet.size) * pointOf(this->View, facet.nodes[k]);
    }
    if (std::isfinite(dot(center, center)))
    {
      centers[facet.patch].push_back(center);
    }
  }
  std::vector<int> found;
  for (const std::vector<Vec3>& places : centers)
  {
    found.push_back(std::max(0, this->nearestSurface(places)));
  }
  return found;
}

//------------------------------------------------------------------------------
std::vector<int> Matcher::matchCurves()
{
  std::vector<std::vector<Vec3>> places(this->TheFeatures.curves);
  std::vector<double> length(this->TheFeatures.curves, 0.0);
  this->ShortestEdge.assign(this->View.numberOfPoints, HUGE_VAL);
  for (const Features::Edge& e : this->TheFeatures.edges)
  {
    const Vec3 a = pointOf(this->View, e.first), b = pointOf(this->View, e.second);
    const double edge = norm(b - a);
    places[e.curve].push_back(0.5 * (a + b));
    length[e.curve] += edge;
    for (Index p : { e.first, e.second })
    {
      this->ShortestEdge[p] = std::min(this->ShortestEdge[p], edge);
    }
  }
  const int patches = this->Match.model.patches;
  const int parts = static_cast<int>(this->Parts.size());
  std::vector<int> found;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const auto [curve, distance] = this->nearestPart(places[i], patches, parts);
    const double edge = length[i] / static_cast<double>(places[i].size());
    const bool matched = curve >= 0 && distance <= matchingDistance * edge;
    this->Match.curves += matched;
    found.push_back(matched ? curve : std::max(0, this->nearestSurface(places[i])));
  }
  return found;
}

//------------------------------------------------------------------------------
/// The corner of the geometry near a corner of the mesh, or the closest point of a patch.
Vec3 Matcher::cornerFor(Index p)
{
  const Vec3 x = pointOf(this->View, p);
  Vec3 best = x;
  double best2 = HUGE_VAL;
  for (const Vec3& y : this->Corners)
  {
    const double d2 = dot(y - x, y - x);
    if (d2 < best2)
    {
      best = y;
      best2 = d2;
    }
  }
  const double limit = matchingDistance * this->ShortestEdge[p];
  if (best2 <= limit * limit)
  {
    ++this->Match.corners;
    return best;
  }
  const int part = this->nearestSurface({ x });
  return part < 0 ? x : this->Parts[part].closest(x);
}
}

//------------------------------------------------------------------------------
GeometryMatch matchGeometry(const Mesh& mesh, const Features& features,
  const std::vector<unsigned char>& slides, const Mesh& geometry, const Features& geometryFeatures)
{
  const auto empty = [](const SurfacePart& part) { return part.pieces.empty(); };
  Matcher matcher(mesh, features, slides, geometry, geometryFeatures);
  const bool outline = features.patches == 0 && geometryFeatures.curves > 0;
  GeometryMatch match = geometryFeatures.patches > 0 || outline ? matcher.run() : GeometryMatch();
  if (match.model.parts.empty() ||
    std::all_of(match.model.parts.begin(), match.model.parts.end(), empty))
  {
    throw Error("The geometry has no triangles or quadrilaterals to slide on.");
  }
  return match;
}
}
