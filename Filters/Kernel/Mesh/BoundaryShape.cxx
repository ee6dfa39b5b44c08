// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryShape.h"

#include "FacetTable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tautline
{
namespace
{

/// The directions (normals of faces, or edges) of the facets around one point: two, or too many.
struct Directions
{
  Vec3 first = { 0, 0, 0 }, second = { 0, 0, 0 }; ///< unit: the first seen of each kind
  Vec3 firstSum = { 0, 0, 0 }, secondSum = { 0, 0, 0 };
  Vec3 sum = { 0, 0, 0 };
  double minCosine = 1; ///< between a facet and the sum
  double bend = 0;      ///< largest sine of the angle between a facet and the sum of its kind
  bool faulty = false;  ///< a facet without size, or of three cells
  int kinds = 0;        ///< 3: three or more, or sliding is not possible
  int facets = 0;
};

/// Adds a facet with the direction `area`, whose length is its weight.
void add(Directions& d, const Vec3& area, double cosine)
{
  const double length = norm(area);
  ++d.facets;
  if (!(length > 0) || !std::isfinite(length))
  {
    d.faulty = true;
    d.kinds = 3;
    return;
  }
  d.sum += area;
  if (d.kinds == 3)
  {
    return;
  }
  const Vec3 unit = (1 / length) * area;
  if (d.kinds > 0 && dot(unit, d.first) >= cosine)
  {
    d.firstSum += area;
  }
  else if (d.kinds > 1 && dot(unit, d.second) >= cosine)
  {
    d.secondSum += area;
  }
  else if (++d.kinds < 3)
  {
    (d.kinds == 1 ? d.first : d.second) = unit;
    (d.kinds == 1 ? d.firstSum : d.secondSum) = area;
  }
}

/// The nodes of a facet in the order its cell traverses it; returns their number.
int walk(Index smallest, const FacetUse& use, Index* nodes)
{
  nodes[0] = smallest;
  if (use.others[1] < 0)
  {
    nodes[1] = use.others[0];
    return 2;
  }
  const int size = use.others[2] < 0 ? 3 : 4;
  nodes[1] = use.others[use.forward ? 0 : 1];
  nodes[size - 1] = use.others[use.forward ? 1 : 0];
  if (size == 4)
  {
    nodes[2] = use.others[2];
  }
  return size;
}

/// The vector of an edge in the orientation of its cell, or the normal of a face times twice its
/// area.
Vec3 direction(const MeshView& view, const FacetUse& use, const Index* nodes, int size)
{
  const Vec3 a = pointOf(view, nodes[0]), b = pointOf(view, nodes[1]);
  if (size == 2)
  {
    return use.forward ? b - a : a - b;
  }
  const Vec3 c = pointOf(view, nodes[2]);
  return size == 3 ? cross(b - a, c - a) : cross(c - a, pointOf(view, nodes[3]) - b);
}

void set(std::vector<double>& all, Index point, const Vec3& v)
{
  const double length = norm(v);
  for (int c = 0; c < 3; ++c)
  {
    all[3 * point + c] = v[c] / length;
  }
}

/// Whether a point is smooth: no facet differs much from the mean.
bool isSmooth(const Directions& d, bool volume, double smoothCosine)
{
  return !d.faulty && (volume || d.facets == 2) && d.minCosine >= smoothCosine;
}

/// Sets whether a boundary point slides in a plane, along a line, on the surface, or is fixed.
void classify(Index i, const Directions& d, bool volume, double cosine, double smoothCosine,
  BoundaryShape& shape)
{
  const Vec3 shared = cross(d.firstSum, d.secondSum);
  if (volume && d.kinds == 1)
  {
    set(shape.planes, i, d.firstSum);
    ++shape.inPlanes;
  }
  else if (!volume && d.kinds == 1 && d.facets == 2)
  {
    set(shape.lines, i, d.firstSum);
    ++shape.onLines;
  }
  else if (isSmooth(d, volume, smoothCosine))
  {
    shape.surface[i] = 1;
    ++shape.onSurface;
  }
  else if (volume && d.kinds == 2 &&
    norm(shared) > std::sqrt(1 - cosine * cosine) * norm(d.firstSum) * norm(d.secondSum))
  {
    set(shape.lines, i, shared);
    ++shape.onLines;
  }
  else
  {
    shape.fixed[i] = 1;
  }
}

//------------------------------------------------------------------------------
/// The variation of the directions (normals or lines, of either sign) of points: a box around their
/// outer products.
struct DirectionBox
{
  std::array<double, 6> low = { HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL };
  std::array<double, 6> high = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };

  void add(const Vec3& d)
  {
    const std::array<double, 6> products = { d[0] * d[0], d[1] * d[1], d[2] * d[2], d[0] * d[1],
      d[1] * d[2], d[2] * d[0] };
    this->add(products, products);
  }
  void add(const std::array<double, 6>& from, const std::array<double, 6>& to)
  {
    for (std::size_t k = 0; k < from.size(); ++k)
    {
      this->low[k] = std::min(this->low[k], from[k]);
      this->high[k] = std::max(this->high[k], to[k]);
    }
  }
  /// The squared sine of the angle between two directions; for several, approximately the largest.
  double sine2() const
  {
    double sum = 0;
    for (std::size_t k = 0; k < this->low.size(); ++k)
    {
      const double width = this->high[k] - this->low[k];
      sum += (k < 3 ? 0.5 : 1.0) * width * width;
    }
    return sum;
  }
};

Vec3 vectorAt(const std::vector<double>& all, Index i)
{
  return { all[3 * i], all[3 * i + 1], all[3 * i + 2] };
}

/**
 * Classifies the boundary points of a mesh by the facets around them, and then by the parts of the
 * boundary in which they slide. A fine circle bends by less than a degree at every point, but
 * points must still not slide off it along its tangents.
 */
class ShapeFinder
{
public:
  ShapeFinder(const Mesh& mesh, double flatAngle, double featureAngle);

  BoundaryShape& shape() { return this->Shape; }
  /// One number per point: whether it is bent.
  std::vector<unsigned char> bent() const;
  /// Joins points of a facet that slide in nearly the same directions.
  /// @param counts whether to use a facet with these nodes
  template <class Counts>
  UnionFind joined(const Counts& counts);
  /// Holds the bent points of parts (one per point, or -1) whose directions differ too much.
  void holdBent(const std::vector<unsigned char>& bent, const std::vector<Index>& part,
    const std::vector<DirectionBox>& boxes);
  /// The direction in which, or perpendicular to which, a point slides; 0: neither.
  Vec3 directionOf(Index i) const
  {
    return vectorAt(this->Shape.planes, i) + vectorAt(this->Shape.lines, i);
  }

private:
  /// A facet that is not between two cells.
  struct Facet
  {
    Index nodes[MaxFaceNodes];
    int size;
    Vec3 along; ///< see direction()
    Index cells;
  };
  void findFacets(const Mesh& mesh);
  double smoothCosine() const { return this->Smooth ? this->SmoothCosine : HUGE_VAL; }

  const MeshView& View;
  std::vector<Facet> Facets;
  const bool Volume, Smooth;
  // The limits allow for rounding, which affects even the faces of a cube.
  const double Cosine, SmoothCosine, Sine2;
  std::vector<Directions> Around;
  BoundaryShape Shape;
};

double cosineOf(double flatAngle)
{
  return std::min(std::cos(flatAngle * Pi / 180), 1 - 1e-12);
}

ShapeFinder::ShapeFinder(const Mesh& mesh, double flatAngle, double featureAngle)
  : View(mesh.view())
  , Volume(mesh.dimension() == Dimension::Volume)
  , Smooth(featureAngle > 0 && mesh.dimension() != Dimension::Surface)
  , Cosine(cosineOf(flatAngle))
  , SmoothCosine(std::cos(0.5 * featureAngle * Pi / 180))
  , Sine2(1 - Cosine * Cosine)
  , Around(View.numberOfPoints)
{
  this->findFacets(mesh);
  for (const Facet& facet : this->Facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      Directions& here = this->Around[facet.nodes[k]];
      here.faulty = here.faulty || facet.cells > 2;
      here.kinds = facet.cells > 2 ? 3 : here.kinds;
      add(here, facet.along, this->Cosine);
    }
  }
  for (const Facet& facet : this->Facets)
  {
    const double length = norm(facet.along);
    for (int k = 0; k < facet.size; ++k)
    {
      Directions& here = this->Around[facet.nodes[k]];
      const auto sineTo = [&](const Vec3& sum)
      {
        const double lengths = length * norm(sum);
        return lengths > 0 ? norm(cross(facet.along, sum)) / lengths : 1.0;
      };
      here.bend = std::max(here.bend, std::min(sineTo(here.firstSum), sineTo(here.secondSum)));
      const double lengths = length * norm(here.sum);
      here.minCosine =
        std::min(here.minCosine, lengths > 0 ? dot(facet.along, here.sum) / lengths : -1.0);
    }
  }
  const Index points = this->View.numberOfPoints;
  this->Shape.fixed.assign(points, 0);
  this->Shape.planes.assign(3 * points, 0.0);
  this->Shape.lines.assign(3 * points, 0.0);
  this->Shape.surface.assign(points, 0);
  for (Index i = 0; i < points; ++i)
  {
    if (this->Around[i].facets > 0)
    {
      classify(i, this->Around[i], this->Volume, this->Cosine, this->smoothCosine(), this->Shape);
    }
  }
}

void ShapeFinder::findFacets(const Mesh& mesh)
{
  FacetTable table(mesh);
  table.forEachFacet(
    [this](Index smallest, const FacetUse* uses, Index count)
    {
      if (count != 2)
      {
        Facet facet;
        facet.size = walk(smallest, *uses, facet.nodes);
        facet.along = direction(this->View, *uses, facet.nodes, facet.size);
        facet.cells = count;
        this->Facets.push_back(facet);
      }
    });
}

std::vector<unsigned char> ShapeFinder::bent() const
{
  // Sine; above the rounding of double-precision coordinates, and below the bend of a circle of a
  // hundred thousand edges.
  constexpr double straight = 1e-5;
  std::vector<unsigned char> result;
  for (const Directions& here : this->Around)
  {
    result.push_back(here.bend > straight);
  }
  return result;
}

template <class Counts>
UnionFind ShapeFinder::joined(const Counts& counts)
{
  UnionFind sets(this->View.numberOfPoints);
  for (const Facet& facet : this->Facets)
  {
    for (int k = 0; k < facet.size && counts(facet.nodes, facet.size); ++k)
    {
      for (int l = 0; l < k; ++l)
      {
        const Index a = facet.nodes[k], b = facet.nodes[l];
        const double planes = dot(vectorAt(this->Shape.planes, a), vectorAt(this->Shape.planes, b));
        const double lines = dot(vectorAt(this->Shape.lines, a), vectorAt(this->Shape.lines, b));
        if (planes >= this->Cosine || std::abs(lines) >= this->Cosine)
        {
          sets.join(a, b);
        }
      }
    }
  }
  return sets;
}

void ShapeFinder::holdBent(const std::vector<unsigned char>& bent, const std::vector<Index>& part,
  const std::vector<DirectionBox>& boxes)
{
  for (std::size_t i = 0; i < part.size(); ++i)
  {
    if (part[i] < 0 || !bent[i] || boxes[part[i]].sine2() <= this->Sine2)
    {
      continue;
    }
    // The part as a whole bends too much: its bent points leave their planes and lines, and either
    // slide on the surface or stay fixed.
    const bool inPlane = norm(vectorAt(this->Shape.planes, i)) > 0;
    --(inPlane ? this->Shape.inPlanes : this->Shape.onLines);
    std::fill_n(this->Shape.planes.begin() + 3 * i, 3, 0.0);
    std::fill_n(this->Shape.lines.begin() + 3 * i, 3, 0.0);
    const bool smooth = isSmooth(this->Around[i], this->Volume, this->smoothCosine());
    this->Shape.surface[i] = smooth;
    this->Shape.onSurface += smooth;
    this->Shape.fixed[i] = !smooth;
  }
}
}

//------------------------------------------------------------------------------
BoundaryShape boundaryShape(
  const Mesh& mesh, double flatAngle, double featureAngle, const Ranks& ranks)
{
  if (!(flatAngle >= 0 && flatAngle <= 90))
  {
    throw Error("The angle up to which the boundary is treated as flat is " +
      std::to_string(flatAngle) + " degrees; it must be between 0 and 90.");
  }
  if (!(featureAngle >= 0 && featureAngle <= 180))
  {
    throw Error("The angle above which an edge of the boundary is sharp is " +
      std::to_string(featureAngle) + " degrees; it must be between 0 and 180.");
  }
  const Index points = mesh.view().numberOfPoints;
  ShapeFinder finder(mesh, flatAngle, featureAngle);
  // All facets of the owned points are on this rank; the other points are classified by their
  // owners.
  BoundaryShape& shape = finder.shape();
  ranks.exchange(shape.fixed.data());
  ranks.exchange(shape.planes.data(), 3);
  ranks.exchange(shape.lines.data(), 3);
  // Each rank joins the facets that have an owned point; numberSets() then combines the sets of all
  // ranks.
  UnionFind sets = finder.joined([&](const Index* nodes, int size)
    { return std::any_of(nodes, nodes + size, [&](Index node) { return ranks.owns(node); }); });
  std::vector<unsigned char> slides(points, 0);
  for (Index i = 0; i < points; ++i)
  {
    slides[i] = norm(finder.directionOf(i)) > 0;
  }
  Index count = 0;
  const std::vector<Index> part = ranks.numberSets(sets, slides, count);
  std::vector<DirectionBox> boxes(count);
  for (Index i = 0; i < points; ++i)
  {
    if (part[i] >= 0 && ranks.owns(i))
    {
      boxes[part[i]].add(finder.directionOf(i));
    }
  }
  // A part may extend over several ranks, so its directions are united.
  if (ranks.several())
  {
    for (const std::vector<DirectionBox>& list : ranks.mesh().group().gatherItems(boxes))
    {
      for (std::size_t k = 0; k < list.size(); ++k)
      {
        boxes[k].add(list[k].low, list[k].high);
      }
    }
  }
  finder.holdBent(finder.bent(), part, boxes);
  ranks.exchange(shape.fixed.data());
  return shape;
}
}
