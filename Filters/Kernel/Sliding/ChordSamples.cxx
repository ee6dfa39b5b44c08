// SPDX-License-Identifier: BSD-3-Clause
#include "ChordSamples.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>
#include <set>

namespace tautline
{
namespace
{
/// An edge follows a curve if the distance of its middle is within this fraction of its length.
constexpr double alongCurve = 0.1;
/// The number of parts into which facet edges are divided for samples.
constexpr int divisions = 4;
/// Fraction of the mean facet edge: one sample of the surface in each cube of this size.
constexpr double spacing = 0.2;
/// Surface points farther from the mesh than this many mean edges do not belong to it.
constexpr double beyondMesh = 2.0;
/// Fraction of the tolerance: the rest is for positions between the samples.
constexpr double atSamples = 0.95;
/// The maximum number of parts into which edges of surface pieces are divided for samples.
constexpr int mostDivisions = 64;

Vec3 meanOf(const Index* points, int count, const std::vector<Vec3>& x)
{
  Vec3 sum = { 0, 0, 0 };
  for (int k = 0; k < count; ++k)
  {
    sum += x[points[k]];
  }
  return (1.0 / count) * sum;
}

/// The weights of the corners of a triangle, or of an edge with a repeated last corner, at a
/// position in it.
std::array<double, 3> weightsAt(const std::array<Vec3, 3>& corner, const Vec3& place)
{
  const auto& [a, b, c] = corner;
  const Vec3 n = cross(b - a, c - a);
  const double n2 = dot(n, n), length2 = dot(b - a, b - a);
  if (b == c || !(n2 > 0))
  {
    const double t = length2 > 0 ? std::clamp(dot(place - a, b - a) / length2, 0.0, 1.0) : 0.0;
    return { 1 - t, t, 0 };
  }
  const double v = dot(cross(place - a, c - a), n) / n2, w = dot(cross(b - a, place - a), n) / n2;
  return { 1 - v - w, v, w };
}
}

//------------------------------------------------------------------------------
ChordSamples::ChordSamples(
  const Mesh& mesh, const ConstrainedPoints& constrained, const std::vector<Vec3>& x)
  : Constrained(constrained)
{
  const SurfaceModel* model = constrained.constraints().model;
  if (!model)
  {
    return;
  }
  this->Whole.push_back(SurfaceProjection::ofFacets(*model, nullptr));
  this->findFacets(mesh);
  for (const SurfaceFacet& facet : this->Facets)
  {
    this->Patches.push_back(this->patchOf(facet, x));
  }
  this->addForward(x);
  this->addBackward(x);
  this->setLimits(x);
}

//------------------------------------------------------------------------------
/// Finds the facets, and the neighbors that share a point with each.
void ChordSamples::findFacets(const Mesh& mesh)
{
  const std::vector<SurfaceFacet>& interfaces = this->Constrained.constraints().model->interfaces;
  this->Facets = surfaceFacets(mesh);
  this->Facets.insert(this->Facets.end(), interfaces.begin(), interfaces.end());
  std::vector<std::vector<std::int32_t>> at(mesh.view().numberOfPoints);
  double length = 0;
  for (std::size_t f = 0; f < this->Facets.size(); ++f)
  {
    const SurfaceFacet& facet = this->Facets[f];
    for (int k = 0; k < facet.size; ++k)
    {
      at[facet.nodes[k]].push_back(static_cast<std::int32_t>(f));
    }
    length += norm(pointOf(mesh.view(), facet.nodes[1]) - pointOf(mesh.view(), facet.nodes[0]));
  }
  this->MeanEdge = length / static_cast<double>(std::max<std::size_t>(1, this->Facets.size()));
  this->NeighborStarts.push_back(0);
  std::vector<std::int32_t> near;
  for (const SurfaceFacet& facet : this->Facets)
  {
    near.clear();
    for (int k = 0; k < facet.size; ++k)
    {
      near.insert(near.end(), at[facet.nodes[k]].begin(), at[facet.nodes[k]].end());
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    this->Neighbors.insert(this->Neighbors.end(), near.begin(), near.end());
    this->NeighborStarts.push_back(static_cast<std::int32_t>(this->Neighbors.size()));
  }
}

//------------------------------------------------------------------------------
/// The part of a facet: the common part of its points; without any, the nearest to its middle; -1
/// if they differ.
std::int32_t ChordSamples::patchOf(const SurfaceFacet& facet, const std::vector<Vec3>& x) const
{
  const BoundaryConstraints& given = this->Constrained.constraints();
  const int patches = given.model->patches;
  const bool curves = patches == 0;
  std::int32_t found = -1;
  for (int k = 0; k < facet.size; ++k)
  {
    const std::int32_t part = given.parts[facet.nodes[k]];
    if (part < 0 || (!curves && part >= patches))
    {
      continue;
    }
    if (found >= 0 && part != found)
    {
      return -1;
    }
    found = part;
  }
  const Vec3 middle = meanOf(facet.nodes.data(), facet.size, x);
  double least = std::numeric_limits<double>::infinity();
  const int parts = static_cast<int>(given.model->parts.size());
  for (std::int32_t i = 0, end = found >= 0 ? 0 : (curves ? parts : patches); i < end; ++i)
  {
    std::int32_t piece = 0;
    const double distance = this->Constrained.facets(i).distanceOf(middle, 0.0, least, piece);
    if (distance < least)
    {
      least = distance;
      found = i;
    }
  }
  return found;
}

/// The curve that the edge between two points follows, or -1.
std::int32_t ChordSamples::curveOf(Index a, Index b, const std::vector<Vec3>& x) const
{
  const BoundaryConstraints& given = this->Constrained.constraints();
  const auto curveAt = [&](Index p)
  { return given.parts[p] >= given.model->patches ? given.parts[p] : -1; };
  const std::int32_t first = curveAt(a), second = curveAt(b);
  const std::int32_t curve = std::max(first, second);
  if (curve < 0 || (first >= 0 && second >= 0 && first != second))
  {
    return -1;
  }
  const auto isNear = [&](const Vec3& place)
  {
    std::int32_t piece = 0;
    const double most = alongCurve * norm(x[b] - x[a]);
    return this->Constrained.facets(curve).distanceOf(place, 0.0, most, piece) <= most;
  };
  return isNear(0.5 * (x[a] + x[b])) && isNear(x[a]) && isNear(x[b]) ? curve : -1;
}

//------------------------------------------------------------------------------
/// Adds the samples within a facet; for a quadrilateral, within its two triangles.
void ChordSamples::addWithin(std::int32_t index)
{
  const SurfaceFacet& facet = this->Facets[index];
  const std::int32_t part = this->Patches[index];
  constexpr double step = 1.0 / divisions;
  for (int k = 1; k + 1 < facet.size; ++k)
  {
    const std::array<Index, MaxFaceNodes> points = { facet.nodes[0], facet.nodes[k],
      facet.nodes[k + 1] };
    for (int i = 1; i < divisions; ++i)
    {
      for (int j = 1; i + j <= divisions; ++j)
      {
        // Only once on the diagonal.
        if (i + j < divisions)
        {
          this->Forward.push_back(
            { points, { 1 - step * (i + j), step * i, step * j }, 3, part, index });
        }
      }
      if (k > 1)
      {
        this->Forward.push_back(
          { { points[0], points[1] }, { 1 - step * i, step * i }, 2, part, index });
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Adds the samples on movable edges and facets.
void ChordSamples::addForward(const std::vector<Vec3>& x)
{
  const auto canMove = [&](Index p) { return this->Constrained.freedom(p) != Freedom::None; };
  std::set<std::array<Index, 2>> edges;
  for (std::size_t f = 0; f < this->Facets.size(); ++f)
  {
    pollInterruption(static_cast<Index>(f));
    const SurfaceFacet& facet = this->Facets[f];
    const auto index = static_cast<std::int32_t>(f);
    if (!std::any_of(facet.nodes.begin(), facet.nodes.begin() + facet.size, canMove))
    {
      continue;
    }
    if (facet.size > 2)
    {
      this->addWithin(index);
    }
    for (int k = 0; k < (facet.size > 2 ? facet.size : 1); ++k)
    {
      const Index a = facet.nodes[k], b = facet.nodes[(k + 1) % facet.size];
      if ((canMove(a) || canMove(b)) && edges.insert({ std::min(a, b), std::max(a, b) }).second)
      {
        const std::int32_t curve = this->curveOf(a, b, x);
        const std::int32_t part = curve >= 0 ? curve : this->Patches[f];
        for (int i = 1; i < divisions; ++i)
        {
          const double t = static_cast<double>(i) / divisions;
          this->Forward.push_back({ { a, b }, { 1 - t, t }, 2, part, index });
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Adds the samples of the surface, each starting at the nearest facet of its patch.
void ChordSamples::addBackward(const std::vector<Vec3>& x)
{
  const SurfaceModel& model = *this->Constrained.constraints().model;
  const int parts = static_cast<int>(model.parts.size());
  const int surfaces = model.patches > 0 ? model.patches : parts;
  const double apart = spacing * this->MeanEdge, most = beyondMesh * this->MeanEdge;
  std::set<std::array<Index, 3>> cubes;
  std::set<Vec3> corners;
  const auto cubeOf = [apart](const Vec3& place)
  {
    std::array<Index, 3> cube;
    for (int k = 0; k < 3; ++k)
    {
      cube[k] = static_cast<Index>(std::floor(place[k] / apart));
    }
    return cube;
  };
  for (int i = 0; i < surfaces; ++i)
  {
    // Use the facets of the patch, or all if it has none.
    SurfacePart pieces;
    std::vector<std::int32_t> facetOf;
    for (const bool all : { false, true })
    {
      for (std::size_t f = 0; f < this->Facets.size() && (!all || facetOf.empty()); ++f)
      {
        const SurfaceFacet& facet = this->Facets[f];
        const auto corner = [&](int k) { return x[facet.nodes[std::min(k, facet.size - 1)]]; };
        for (int k = 1; (all || this->Patches[f] == i) && k < std::max(2, facet.size - 1); ++k)
        {
          pieces.pieces.push_back({ corner(0), corner(k), corner(k + 1) });
          facetOf.push_back(static_cast<std::int32_t>(f));
        }
      }
    }
    const SurfaceProjection ofMesh(pieces, nullptr);
    const auto add = [&](const Vec3& place)
    {
      std::int32_t piece = 0;
      if (ofMesh.distanceOf(place, 0.0, most, piece) <= most)
      {
        this->Backward.push_back({ place, facetOf[ofMesh.source(piece)] });
      }
    };
    std::vector<Vec3> places;
    for (const auto& [a, b, c] : model.parts[i].pieces)
    {
      throwIfInterrupted();
      const double longest = std::max({ norm(b - a), norm(c - b), norm(a - c) });
      // Facets first deviate where the surface bends: at the corners of its pieces.
      for (const Vec3& corner : { a, b, c })
      {
        if (longest > apart && corners.insert(corner).second)
        {
          cubes.insert(cubeOf(corner));
          add(corner);
        }
      }
      const double parts = std::min<double>(std::ceil(longest / apart), mostDivisions);
      places.clear();
      addSamples({ a, b, c }, std::max(2, static_cast<int>(parts)), places);
      for (const Vec3& place : places)
      {
        if (cubes.insert(cubeOf(place)).second)
        {
          add(place);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
void ChordSamples::setLimits(const std::vector<Vec3>& x)
{
  std::vector<double> forward(this->Facets.size(), 0.0), backward(this->Facets.size(), 0.0);
  std::vector<std::int32_t> facets;
  for (std::size_t i = 0; i < this->size(); ++i)
  {
    const bool ofMesh = i < this->Forward.size();
    const std::int32_t facet =
      ofMesh ? this->Forward[i].facet : this->Backward[i - this->Forward.size()].facet;
    double& most = (ofMesh ? forward : backward)[facet];
    most = std::max(most, this->measure(i, x).value);
    facets.push_back(facet);
  }
  for (std::size_t i = 0; i < this->size(); ++i)
  {
    const std::vector<double>& before = i < this->Forward.size() ? forward : backward;
    double most = 0;
    for (std::int32_t k = this->NeighborStarts[facets[i]]; k < this->NeighborStarts[facets[i] + 1];
         ++k)
    {
      most = std::max(most, before[this->Neighbors[k]]);
    }
    this->Limits.push_back(most + atSamples * this->Constrained.tolerance());
  }
}

//------------------------------------------------------------------------------
/// The distance of a position from a facet; sets `best` if it is smaller.
double ChordSamples::toFacet(
  std::int32_t facet, const Vec3& place, const std::vector<Vec3>& x, Distance& best) const
{
  const SurfaceFacet& f = this->Facets[facet];
  double least = std::numeric_limits<double>::infinity();
  for (int k = 1; k < std::max(2, f.size - 1); ++k)
  {
    const int last = std::min(k + 1, f.size - 1);
    const std::array<Vec3, 3> corner = { x[f.nodes[0]], x[f.nodes[k]], x[f.nodes[last]] };
    const Vec3 at = closestOnTriangle(corner, place);
    const double distance = norm(at - place);
    least = std::min(least, distance);
    if (distance < best.value)
    {
      const std::array<double, 3> w = weightsAt(corner, at);
      best.value = distance;
      best.direction = distance > 0 ? (1.0 / distance) * (at - place) : Vec3{ 0, 0, 0 };
      best.count = last == k ? 2 : 3;
      best.points = { f.nodes[0], f.nodes[k], f.nodes[last] };
      best.weights = { w[0], w[1], w[2] };
    }
  }
  return least;
}

//------------------------------------------------------------------------------
ChordSamples::Distance ChordSamples::measure(std::size_t sample, const std::vector<Vec3>& x) const
{
  Distance result;
  if (sample < this->Forward.size())
  {
    const OfMesh& from = this->Forward[sample];
    Vec3 place = { 0, 0, 0 };
    for (int k = 0; k < from.count; ++k)
    {
      place += from.weights[k] * x[from.points[k]];
    }
    const SurfaceProjection& to =
      from.part < 0 ? this->Whole[0] : this->Constrained.facets(from.part);
    const Vec3 off = place - to.closest(place);
    result.value = norm(off);
    result.direction = result.value > 0 ? (1.0 / result.value) * off : Vec3{ 0, 0, 0 };
    result.count = from.count;
    result.points = from.points;
    result.weights = from.weights;
    return result;
  }
  const OfSurface& from = this->Backward[sample - this->Forward.size()];
  result.value = std::numeric_limits<double>::infinity();
  for (std::int32_t k = this->NeighborStarts[from.facet]; k < this->NeighborStarts[from.facet + 1];
       ++k)
  {
    this->toFacet(this->Neighbors[k], from.place, x, result);
  }
  return result;
}

//------------------------------------------------------------------------------
void ChordSamples::follow(std::size_t index, const std::vector<Vec3>& x)
{
  if (index < this->Forward.size())
  {
    return;
  }
  OfSurface& sample = this->Backward[index - this->Forward.size()];
  for (bool more = true; more;)
  {
    more = false;
    Distance best;
    best.value = std::numeric_limits<double>::infinity();
    double least = this->toFacet(sample.facet, sample.place, x, best);
    const std::int32_t from = sample.facet;
    for (std::int32_t k = this->NeighborStarts[from]; k < this->NeighborStarts[from + 1]; ++k)
    {
      const double distance = this->toFacet(this->Neighbors[k], sample.place, x, best);
      if (distance < least)
      {
        least = distance;
        sample.facet = this->Neighbors[k];
        more = true;
      }
    }
  }
}
}
