// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceModel.h"

#include "tautline/Core/UnionFind.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// Control points closer to the flat piece than this fraction of its edges are considered flat.
constexpr double flatness = 1e-10;
/// Cosine of the angle between an edge and the tangent at its end, from which on it is curved.
constexpr double minCosine = 0.5;

Vec3 unitOf(const Vec3& v)
{
  const double length = norm(v);
  return length > 0 && std::isfinite(length) ? (1 / length) * v : Vec3{ 0, 0, 0 };
}

/// The control point near `from` of a cubic from there to `to` that leaves in a given direction; on
/// a circular arc if both ends are symmetric.
Vec3 controlAt(const Vec3& from, const Vec3& to, const Vec3& direction)
{
  const Vec3 chord = to - from;
  const double length = norm(chord);
  const double cosine = length > 0 ? dot(chord, direction) / length : 0.0;
  if (!(cosine > minCosine))
  {
    return from + (1.0 / 3.0) * chord;
  }
  // |handle| = chord / (3 cos^2(angle / 2)), and cos^2(angle / 2) = (1 + cosine) / 2.
  return from + (2.0 * length / (3.0 * (1.0 + cosine))) * direction;
}

/// Facets whose normals differ by less than this many radians are coplanar. A part of at least this
/// many facets is a flat face, whose points have its normal, if it is this many times larger than
/// any adjacent part.
constexpr double flatAngle = 0.1 / DegreesPerRadian;
constexpr Index leastFlatFacets = 6;
constexpr double largerArea = 2;

/// Facets up to this times the radius of curvature are short: the surface is smooth there. Longer
/// ones, as CAD programs make along cylinders and fillets, do not show how it bends between them.
constexpr double longestFacet = 1.0;
/// Radians: edges that bend by less are smooth for any facet size. A cubic deviates from them by
/// about an eighth of this angle times their length.
constexpr double leastBend = 0.1;

/// An edge of a curve with the tangents at its ends, directed from the first to the second point.
struct CurveEdge
{
  Index a, b; ///< the smaller and the larger point
  int curve;
  Vec3 atA = { 0, 0, 0 }, atB = { 0, 0, 0 };
};

/// Two facets of a patch, and the points of their common edge.
struct Neighbors
{
  Index first, second;
  std::array<Index, 2> edge;
};

/// Coplanar facets.
struct FlatPart
{
  Index facets = 0;
  double area = 0, beside = 0; ///< twice their area, and the largest such value of an adjacent part
};

class ModelMaker
{
public:
  ModelMaker(const Mesh& mesh, const Features& features, bool smooth, bool coarse, double farthest)
    : View(mesh.view())
    , TheFeatures(features)
    , Smooth(smooth)
    , Coarse(coarse)
    , Farthest(farthest)
  {
  }

  SurfaceModel make()
  {
    this->Model.patches = this->TheFeatures.patches;
    this->Model.parts.resize(this->TheFeatures.patches + this->TheFeatures.curves);
    if (this->Smooth)
    {
      this->findDirections();
      this->findFacetsOfPoints();
      this->findNeighbors();
      if (this->Coarse)
      {
        this->findFlatFaces();
      }
      else if (std::isfinite(this->Farthest))
      {
        this->findStraightEdges();
      }
      this->Normal.assign(this->View.numberOfPoints, Vec3{ 0, 0, 0 });
    }
    this->addCurves();
    this->addPatches();
    this->addInterfaces();
    return std::move(this->Model);
  }

private:
  Vec3 at(Index p) const { return pointOf(this->View, p); }
  void findDirections();
  void findFacetsOfPoints();
  Vec3 areaOf(const Features::Facet& facet) const;
  double sizeOf(const Features::Facet& facet) const;
  void findNeighbors();
  double widthOf(Index f, const Vec3& middleOfEdge, const Vec3& axis) const;
  void findStraightEdges();
  void findFlatFaces();
  Vec3 flatNormal(Index point, int patch) const;
  void findNormals(const std::vector<Index>& facets);
  void chooseNormals(const std::vector<Index>& facets, const std::vector<Index>& points,
    const std::vector<Vec3>& fitted);
  Vec3 fitNormal(Index point, int patch, const Vec3& first) const;
  std::vector<Index> ringOf(Index point, int patch) const;
  const CurveEdge* edgeOf(Index a, Index b) const;
  Vec3 controlOf(Index from, Index to) const;
  void addCurves();
  void addPatches();
  void addInterfaces();
  void addTriangle(Index a, Index b, Index c, SurfacePart& part) const;

  const MeshView& View;
  const Features& TheFeatures;
  bool Smooth, Coarse;
  double Farthest; ///< of control points from the straight edges
  SurfaceModel Model;
  std::vector<CurveEdge> Edges;        ///< sorted by points
  std::vector<Index> Starts, FacetsAt; ///< facets of each point
  std::vector<Neighbors> Beside;       ///< pairs of facets of one patch with a common edge
  std::vector<std::array<Index, 2>> StraightEdges; ///< of long facets, sorted, as their points
  std::vector<Index> FlatFace;     ///< per facet: the first facet that is flat with it
  std::vector<FlatPart> FlatFaces; ///< indexed by their first facets
  std::vector<Vec3> Normal;        ///< of the points of the patch that is being made
};

//------------------------------------------------------------------------------
/// The tangents of curves: of the circle through a point and its two neighbors.
void ModelMaker::findDirections()
{
  std::vector<std::array<Index, 2>> around(this->View.numberOfPoints, { -1, -1 });
  for (const Features::Edge& e : this->TheFeatures.edges)
  {
    this->Edges.push_back({ std::min(e.first, e.second), std::max(e.first, e.second), e.curve });
    for (const auto& [p, q] : { std::pair(e.first, e.second), std::pair(e.second, e.first) })
    {
      around[p][around[p][0] < 0 ? 0 : 1] = q;
    }
  }
  const auto tangent = [&](Index p, Index from, Index to)
  {
    // From `from` through p to `to`: the weights are exact for a circle.
    const Vec3 in = this->at(p) - this->at(from), out = this->at(to) - this->at(p);
    return unitOf((1 / dot(in, in)) * in + (1 / dot(out, out)) * out);
  };
  for (CurveEdge& e : this->Edges)
  {
    const Vec3 chord = unitOf(this->at(e.b) - this->at(e.a));
    const auto other = [&](Index p, Index q)
    { return around[p][0] == q ? around[p][1] : around[p][0]; };
    const bool smoothA = this->TheFeatures.kind[e.a] == CurvePoint && other(e.a, e.b) >= 0,
               smoothB = this->TheFeatures.kind[e.b] == CurvePoint && other(e.b, e.a) >= 0;
    e.atA = smoothA ? tangent(e.a, other(e.a, e.b), e.b) : chord;
    e.atB = smoothB ? tangent(e.b, e.a, other(e.b, e.a)) : chord;
    // At the end of a curve: the tangent of the circle through the other tangent.
    const auto reflected = [&](const Vec3& t) { return 2 * dot(t, chord) * chord - t; };
    e.atA = !smoothA && smoothB ? reflected(e.atB) : e.atA;
    e.atB = !smoothB && smoothA ? reflected(e.atA) : e.atB;
  }
  std::sort(this->Edges.begin(), this->Edges.end(),
    [](const CurveEdge& e, const CurveEdge& f)
    { return std::pair(e.a, e.b) < std::pair(f.a, f.b); });
}

//------------------------------------------------------------------------------
void ModelMaker::findFacetsOfPoints()
{
  const auto& facets = this->TheFeatures.facets;
  this->Starts.assign(this->View.numberOfPoints + 1, 0);
  for (const Features::Facet& facet : facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      ++this->Starts[facet.nodes[k] + 1];
    }
  }
  for (std::size_t p = 0; p + 1 < this->Starts.size(); ++p)
  {
    this->Starts[p + 1] += this->Starts[p];
  }
  this->FacetsAt.resize(this->Starts.back());
  std::vector<Index> next(this->Starts.begin(), this->Starts.end() - 1);
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    for (int k = 0; k < facets[f].size; ++k)
    {
      this->FacetsAt[next[facets[f].nodes[k]]++] = static_cast<Index>(f);
    }
  }
}

//------------------------------------------------------------------------------
/// Twice the area, along the normal.
Vec3 ModelMaker::areaOf(const Features::Facet& facet) const
{
  const auto at = [&](int k) { return this->at(facet.nodes[k]); };
  return facet.size == 3 ? cross(at(1) - at(0), at(2) - at(0))
                         : cross(at(2) - at(0), at(3) - at(1));
}

//------------------------------------------------------------------------------
/// The longest edge or diagonal.
double ModelMaker::sizeOf(const Features::Facet& facet) const
{
  double longest = 0;
  for (int k = 0; k < facet.size; ++k)
  {
    for (int j = 0; j < k; ++j)
    {
      longest = std::max(longest, norm(this->at(facet.nodes[k]) - this->at(facet.nodes[j])));
    }
  }
  return longest;
}

//------------------------------------------------------------------------------
void ModelMaker::findNeighbors()
{
  const auto& facets = this->TheFeatures.facets;
  const auto add = [&](Index f, Index g, Index from)
  {
    Neighbors found = { f, g, {} };
    int count = 0;
    const auto end = facets[g].nodes.begin() + facets[g].size;
    for (int k = 0; k < facets[f].size; ++k)
    {
      if (std::find(facets[g].nodes.begin(), end, facets[f].nodes[k]) != end)
      {
        found.edge[std::min(count++, 1)] = facets[f].nodes[k];
      }
    }
    if (count > 1 && from == std::min(found.edge[0], found.edge[1])) // once
    {
      this->Beside.push_back(found);
    }
  };
  for (std::size_t p = 0; p + 1 < this->Starts.size(); ++p)
  {
    for (Index i = this->Starts[p]; i < this->Starts[p + 1]; ++i)
    {
      for (Index j = this->Starts[p]; j < i; ++j)
      {
        const Index f = this->FacetsAt[i], g = this->FacetsAt[j];
        if (facets[f].patch == facets[g].patch)
        {
          add(f, g, static_cast<Index>(p));
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The width of a facet measured from one of its edges, perpendicular to an axis: for a thin
/// triangle in a strip, the length of the strip.
double ModelMaker::widthOf(Index f, const Vec3& middleOfEdge, const Vec3& axis) const
{
  const Features::Facet& facet = this->TheFeatures.facets[f];
  Vec3 center = { 0, 0, 0 };
  for (int k = 0; k < facet.size; ++k)
  {
    center += (1.0 / facet.size) * this->at(facet.nodes[k]);
  }
  const Vec3 d = center - middleOfEdge;
  // The center is at a third of the height of a triangle, and at half the height of a
  // quadrilateral.
  return (facet.size == 3 ? 3.0 : 2.0) * norm(d - dot(d, axis) * axis);
}

//------------------------------------------------------------------------------
/**
 * @brief The edges of facets that are long compared with the radius of curvature, see longestFacet.
 *
 * The curvature at an edge between two facets is the angle between their normals over the smaller
 * one of their widths across the axis of the turn: where a large flat face passes into a fillet,
 * the fillet bends, the face does not.
 */
void ModelMaker::findStraightEdges()
{
  const auto& facets = this->TheFeatures.facets;
  std::vector<double> curvature(facets.size(), 0.0);
  for (const Neighbors& pair : this->Beside)
  {
    const Vec3 a = this->areaOf(facets[pair.first]), b = this->areaOf(facets[pair.second]);
    const Vec3 turn = cross(a, b);
    const double angle = std::atan2(norm(turn), dot(a, b));
    if (!(angle > leastBend))
    {
      continue;
    }
    const Vec3 axis = unitOf(turn);
    const Vec3 middle = 0.5 * (this->at(pair.edge[0]) + this->at(pair.edge[1]));
    const double least =
      std::min(this->widthOf(pair.first, middle, axis), this->widthOf(pair.second, middle, axis));
    const double bend = least > 0 ? angle / least : 0.0;
    for (Index f : { pair.first, pair.second })
    {
      curvature[f] = std::max(curvature[f], bend);
    }
  }
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    const Features::Facet& facet = facets[f];
    const bool isLong = this->sizeOf(facet) * curvature[f] > longestFacet;
    for (int k = 0; isLong && k < facet.size; ++k)
    {
      for (int j = 0; j < k; ++j) // including a diagonal
      {
        const Index p = facet.nodes[k], q = facet.nodes[j];
        this->StraightEdges.push_back({ std::min(p, q), std::max(p, q) });
      }
    }
  }
  std::sort(this->StraightEdges.begin(), this->StraightEdges.end());
}

//------------------------------------------------------------------------------
/// Joins facets of a patch that share an edge and the normal.
void ModelMaker::findFlatFaces()
{
  const auto& facets = this->TheFeatures.facets;
  UnionFind joined(static_cast<Index>(facets.size()));
  for (const auto& [f, g, edge] : this->Beside)
  {
    const Vec3 a = this->areaOf(facets[f]), b = this->areaOf(facets[g]);
    if (std::atan2(norm(cross(a, b)), dot(a, b)) < flatAngle)
    {
      joined.join(f, g);
    }
  }
  this->FlatFace.resize(facets.size());
  this->FlatFaces.assign(facets.size(), {});
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    const Index face = this->FlatFace[f] = joined.find(static_cast<Index>(f));
    ++this->FlatFaces[face].facets;
    this->FlatFaces[face].area += norm(this->areaOf(facets[f]));
  }
  for (const auto& [f, g, edge] : this->Beside)
  {
    FlatPart &a = this->FlatFaces[this->FlatFace[f]], &b = this->FlatFaces[this->FlatFace[g]];
    a.beside = &a != &b ? std::max(a.beside, b.area) : a.beside;
    b.beside = &a != &b ? std::max(b.beside, a.area) : b.beside;
  }
}

//------------------------------------------------------------------------------
/// The normal of the flat face of a patch that a point is on, as where a fillet begins; zero if
/// there is none, or if an adjacent one is about as large, as on the strips of a cylinder.
Vec3 ModelMaker::flatNormal(Index point, int patch) const
{
  Index best = -1;
  Vec3 normal = { 0, 0, 0 };
  for (Index i = this->Starts[point]; i < this->Starts[point + 1]; ++i)
  {
    const Features::Facet& facet = this->TheFeatures.facets[this->FacetsAt[i]];
    const Index face = this->FlatFace[this->FacetsAt[i]];
    const FlatPart& part = this->FlatFaces[face];
    if (facet.patch != patch || part.facets < leastFlatFacets ||
      part.area < largerArea * part.beside)
    {
      continue;
    }
    if (best < 0 || part.area > this->FlatFaces[best].area)
    {
      best = face;
      normal = { 0, 0, 0 };
    }
    normal += face == best ? this->areaOf(facet) : Vec3{ 0, 0, 0 };
  }
  return unitOf(normal);
}

//------------------------------------------------------------------------------
/// The neighbors of a point within a patch, and their neighbors.
std::vector<Index> ModelMaker::ringOf(Index point, int patch) const
{
  std::vector<Index> ring = { point };
  for (int round = 0; round < 2; ++round)
  {
    const std::vector<Index> inner = ring;
    for (Index p : inner)
    {
      for (Index i = this->Starts[p]; i < this->Starts[p + 1]; ++i)
      {
        const Features::Facet& facet = this->TheFeatures.facets[this->FacetsAt[i]];
        if (facet.patch == patch)
        {
          ring.insert(ring.end(), facet.nodes.begin(), facet.nodes.begin() + facet.size);
        }
      }
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  }
  ring.erase(std::find(ring.begin(), ring.end(), point));
  return ring;
}

//------------------------------------------------------------------------------
/**
 * @brief The normal of the cubic height field through a point that fits the two rings of neighbors
 * best; of a quadric if there are few neighbors, as on borders; `first` if they do not determine a
 * quadric.
 */
Vec3 ModelMaker::fitNormal(Index point, int patch, const Vec3& first) const
{
  constexpr int quadric = 5, cubic = 9;
  constexpr std::size_t enoughForCubic = 12; // the fit is to smooth, not to interpolate
  const std::vector<Index> ring = this->ringOf(point, patch);
  if (ring.size() < quadric)
  {
    return first;
  }
  const Vec3 axis = std::abs(first[0]) < 0.5 ? Vec3{ 1, 0, 0 } : Vec3{ 0, 1, 0 };
  const Vec3 u = unitOf(cross(first, axis)), v = cross(first, u), center = this->at(point);
  double size = 0;
  for (Index p : ring)
  {
    size += norm(this->at(p) - center) / static_cast<double>(ring.size());
  }
  Eigen::MatrixXd rows(ring.size(), cubic);
  Eigen::VectorXd heights(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i)
  {
    const Vec3 d = (1 / size) * (this->at(ring[i]) - center);
    const double x = dot(d, u), y = dot(d, v), weight = 1 / std::max(norm(d), 1e-3);
    const double terms[cubic] = { x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y,
      y * y * y };
    const auto row = static_cast<Eigen::Index>(i);
    for (int k = 0; k < cubic; ++k)
    {
      rows(row, k) = weight * terms[k];
    }
    heights[row] = weight * dot(d, first);
  }
  // Few rows of neighbors, as on a border, do not determine a cubic.
  for (int unknowns : { cubic, quadric })
  {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(rows.leftCols(unknowns));
    solver.setThreshold(1e-3);
    if (solver.rank() == unknowns && (unknowns == quadric || ring.size() >= enoughForCubic))
    {
      const Eigen::VectorXd c = solver.solve(heights);
      const Vec3 fitted = unitOf(first - c[0] * u - c[1] * v);
      return dot(fitted, first) > minCosine ? fitted : first;
    }
  }
  return first;
}

//------------------------------------------------------------------------------
void ModelMaker::findNormals(const std::vector<Index>& facets)
{
  std::vector<Index> points;
  for (Index f : facets)
  {
    const Features::Facet& facet = this->TheFeatures.facets[f];
    for (int k = 0; k < facet.size; ++k)
    {
      this->Normal[facet.nodes[k]] = { 0, 0, 0 };
    }
  }
  for (Index f : facets)
  {
    const Features::Facet& facet = this->TheFeatures.facets[f];
    for (int k = 0; k < facet.size; ++k)
    {
      const Index p = facet.nodes[k];
      const Vec3 out = this->at(facet.nodes[(k + 1) % facet.size]) - this->at(p);
      const Vec3 back = this->at(facet.nodes[(k + facet.size - 1) % facet.size]) - this->at(p);
      const double weight = dot(out, out) * dot(back, back);
      if (weight > 0 && std::isfinite(weight))
      {
        this->Normal[p] += (1 / weight) * cross(out, back);
      }
      points.push_back(p);
    }
  }
  for (Index f : facets)
  {
    const Features::Facet& facet = this->TheFeatures.facets[f];
    for (int k = 0; k < facet.size; ++k)
    {
      this->Normal[facet.nodes[k]] = unitOf(this->Normal[facet.nodes[k]]);
    }
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const int patch = facets.empty() ? -1 : this->TheFeatures.facets[facets[0]].patch;
  std::vector<Vec3> fitted(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    fitted[i] = this->fitNormal(points[i], patch, this->Normal[points[i]]);
  }
  this->chooseNormals(facets, points, fitted);
}

//------------------------------------------------------------------------------
/**
 * @brief Uses the fitted normal of a point where it agrees clearly better with the neighboring
 * normals than the facet normal does; on the border of a patch, where the facet normal is biased,
 * always, unless the mesh is coarse. Afterwards, points on flat faces get the normals of the faces.
 *
 * Along a circular arc, a chord d is at the same angle to both normals, d . (n + n') = 0; on any
 * smooth surface this is of the third order of |d|. The facets' normals are exact on spheres and
 * where the mesh is regular, the fitted normals are of higher order elsewhere.
 */
void ModelMaker::chooseNormals(const std::vector<Index>& facets, const std::vector<Index>& points,
  const std::vector<Vec3>& fitted)
{
  const int patch = facets.empty() ? -1 : this->TheFeatures.facets[facets[0]].patch;
  constexpr double clearly = 0.5; // both include the change of curvature along the chords
  const auto place = [&](Index p)
  { return std::lower_bound(points.begin(), points.end(), p) - points.begin(); };
  std::vector<double> ofFacets(points.size(), 0.0), ofFit(points.size(), 0.0);
  for (Index f : facets)
  {
    const Features::Facet& facet = this->TheFeatures.facets[f];
    for (int k = 0; k < facet.size; ++k)
    {
      const Index p = facet.nodes[k], q = facet.nodes[(k + 1) % facet.size];
      const auto i = place(p), j = place(q);
      const Vec3 chord = this->at(q) - this->at(p);
      const double perLength2 = 1 / dot(chord, chord);
      const double a = dot(chord, this->Normal[p] + this->Normal[q]) * perLength2,
                   b = dot(chord, fitted[i] + fitted[j]) * perLength2;
      for (const auto end : { i, j })
      {
        ofFacets[end] += a * a;
        ofFit[end] += b * b;
      }
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Index p = points[i];
    const bool border = this->TheFeatures.kind[p] != PatchPoint;
    if ((border && !this->Coarse) || ofFit[i] < clearly * ofFacets[i])
    {
      this->Normal[p] = fitted[i];
    }
    const Vec3 flat = this->Coarse ? this->flatNormal(p, patch) : Vec3{ 0, 0, 0 };
    this->Normal[p] = dot(flat, flat) > 0 ? flat : this->Normal[p];
  }
}

//------------------------------------------------------------------------------
/// The edge of a curve between two points, or null.
const CurveEdge* ModelMaker::edgeOf(Index a, Index b) const
{
  if (this->TheFeatures.kind[a] == PatchPoint || this->TheFeatures.kind[b] == PatchPoint)
  {
    return nullptr;
  }
  const std::pair<Index, Index> key = { std::min(a, b), std::max(a, b) };
  const auto found = std::lower_bound(this->Edges.begin(), this->Edges.end(), key,
    [](const CurveEdge& e, const std::pair<Index, Index>& k) { return std::pair(e.a, e.b) < k; });
  return found != this->Edges.end() && std::pair(found->a, found->b) == key ? &*found : nullptr;
}

//------------------------------------------------------------------------------
/// The control point near `from` on the edge of a piece.
Vec3 ModelMaker::controlOf(Index from, Index to) const
{
  const Vec3 a = this->at(from), b = this->at(to);
  const std::array<Index, 2> key = { std::min(from, to), std::max(from, to) };
  if (std::binary_search(this->StraightEdges.begin(), this->StraightEdges.end(), key))
  {
    return a + (1.0 / 3.0) * (b - a);
  }
  const Vec3 chord = b - a, straight = a + (1.0 / 3.0) * chord;
  const CurveEdge* e = this->edgeOf(from, to);
  const Vec3 n = e ? Vec3{ 0, 0, 0 } : this->Normal[from];
  const Vec3 control = e ? controlAt(a, b, from == e->a ? e->atA : -1.0 * e->atB)
                         : controlAt(a, b, unitOf(chord - dot(chord, n) * n));
  // Pieces then deviate nowhere farther and stay joined at their edges: the middle control point,
  // up to 1.5 times as far, has a weight of at most 6/27.
  const Vec3 off = control - straight;
  const double length = norm(off);
  return length > this->Farthest ? straight + (this->Farthest / length) * off : control;
}

//------------------------------------------------------------------------------
void ModelMaker::addCurves()
{
  for (std::size_t i = 0; i < this->TheFeatures.edges.size(); ++i)
  {
    const Features::Edge& e = this->TheFeatures.edges[i];
    SurfacePart& part = this->Model.parts[this->Model.patches + e.curve];
    part.curve = true;
    const Vec3 a = this->at(e.first), b = this->at(e.second);
    if (!std::isfinite(dot(a, a) + dot(b, b)))
    {
      continue;
    }
    part.pieces.push_back({ a, b, b });
    if (!this->Smooth)
    {
      continue;
    }
    CubicControls controls = {};
    controls[0] = this->controlOf(e.first, e.second);
    controls[1] = this->controlOf(e.second, e.first);
    const Vec3 off = controls[0] - a - (1.0 / 3.0) * (b - a),
               offB = controls[1] - b + (1.0 / 3.0) * (b - a);
    const bool straight = std::max(norm(off), norm(offB)) <= flatness * norm(b - a);
    part.controlsOf.push_back(straight ? -1 : static_cast<std::int32_t>(part.controls.size()));
    if (!straight)
    {
      part.controls.push_back(controls);
    }
  }
}

//------------------------------------------------------------------------------
void ModelMaker::addPatches()
{
  std::vector<std::vector<Index>> ofPatch(this->Model.patches);
  for (std::size_t f = 0; f < this->TheFeatures.facets.size(); ++f)
  {
    ofPatch[this->TheFeatures.facets[f].patch].push_back(static_cast<Index>(f));
  }
  for (int patch = 0; patch < this->Model.patches; ++patch)
  {
    if (this->Smooth)
    {
      this->findNormals(ofPatch[patch]);
    }
    for (Index f : ofPatch[patch])
    {
      const Features::Facet& facet = this->TheFeatures.facets[f];
      for (int k = 2; k < facet.size; ++k)
      {
        this->addTriangle(
          facet.nodes[0], facet.nodes[k - 1], facet.nodes[k], this->Model.parts[patch]);
      }
    }
  }
}

//------------------------------------------------------------------------------
void ModelMaker::addInterfaces()
{
  for (const Features::Facet& facet : this->TheFeatures.facets)
  {
    if (facet.interface)
    {
      this->Model.interfaces.push_back({ facet.nodes, facet.size });
    }
  }
  for (const Features::Edge& edge : this->TheFeatures.edges)
  {
    if (edge.interface)
    {
      SurfaceFacet facet = { {}, 2 };
      facet.nodes.fill(-1);
      facet.nodes[0] = edge.first;
      facet.nodes[1] = edge.second;
      this->Model.interfaces.push_back(facet);
    }
  }
}

//------------------------------------------------------------------------------
void ModelMaker::addTriangle(Index a, Index b, Index c, SurfacePart& part) const
{
  const Index ids[4] = { a, b, c, a };
  const std::array<Vec3, 3> corner = { this->at(a), this->at(b), this->at(c) };
  if (!std::isfinite(
        dot(corner[0], corner[0]) + dot(corner[1], corner[1]) + dot(corner[2], corner[2])))
  {
    return;
  }
  part.pieces.push_back(corner);
  if (!this->Smooth)
  {
    return;
  }
  CubicControls controls;
  Vec3 sum = { 0, 0, 0 }, corners = { 0, 0, 0 };
  double off = 0, longest = 0;
  for (int k = 0; k < 3; ++k)
  {
    const Vec3 &p = corner[k], &q = corner[(k + 1) % 3], third = (1.0 / 3.0) * (q - p);
    controls[2 * k] = this->controlOf(ids[k], ids[k + 1]);
    controls[2 * k + 1] = this->controlOf(ids[k + 1], ids[k]);
    off =
      std::max({ off, norm(controls[2 * k] - p - third), norm(controls[2 * k + 1] - q + third) });
    longest = std::max(longest, norm(q - p));
    sum += controls[2 * k] + controls[2 * k + 1];
    corners += p;
  }
  // Vlachos et al.: the middle control point extends the mean of the edge control points by half of
  // its distance from the mean of the corners.
  controls[6] = (1.0 / 4.0) * sum - (1.0 / 6.0) * corners;
  const bool flat = off <= flatness * longest;
  part.controlsOf.push_back(flat ? -1 : static_cast<std::int32_t>(part.controls.size()));
  if (!flat)
  {
    part.controls.push_back(controls);
  }
}
}

//------------------------------------------------------------------------------
SurfaceModel makeSurfaceModel(
  const Mesh& mesh, const Features& features, bool smooth, bool coarse, double farthest)
{
  return ModelMaker(mesh, features, smooth, coarse, farthest).make();
}

//------------------------------------------------------------------------------
std::vector<std::int32_t> partsOfPoints(const Features& features)
{
  std::vector<std::int32_t> parts(features.kind.size(), -1);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    parts[p] = features.kind[p] == CurvePoint ? features.patches + features.curveOf[p]
      : features.kind[p] == PatchPoint        ? features.patchOf[p]
                                              : -1;
  }
  return parts;
}
}
