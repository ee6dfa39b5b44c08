// SPDX-License-Identifier: BSD-3-Clause
#include "Domains.h"

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>

namespace tautline
{
namespace
{
constexpr int Outer = 1;
constexpr int Inner = 2;
constexpr int Third = 3;
/// The domains have a size of about 1; a spacing below the smallest would need more cells than fit
/// into memory.
constexpr double SmallestPlanarSpacing = 1e-5;
constexpr double SmallestSolidSpacing = 1e-4;
constexpr double LargestSpacing = 1e3;

void requireSpacing(double spacing, double smallest)
{
  if (!(spacing >= smallest && spacing <= LargestSpacing))
  {
    std::ostringstream text;
    text << "the spacing of a boundary is " << spacing << "; it must be from " << smallest << " to "
         << LargestSpacing << " (inclusive)";
    throw Error(text.str());
  }
}

/// Draws closed outlines as segments of about one length.
class Pen
{
public:
  explicit Pen(double spacing)
    : Spacing(spacing)
  {
  }

  void moveTo(double x, double y)
  {
    this->First = static_cast<Index>(this->Result.points.size() / 2);
    this->add(x, y);
  }
  /// A curve p(t), t from 0 to 1, from the current point; `length` is its approximate length.
  void curve(const std::function<std::array<double, 2>(double)>& p, double length, int marker,
    int fewest = 1)
  {
    // A minimum number of segments preserves the shape of a curve at any spacing.
    const auto pieces = std::max<Index>(fewest, std::llround(length / this->Spacing));
    for (Index i = 1; i <= pieces; ++i)
    {
      const auto [x, y] = p(static_cast<double>(i) / static_cast<double>(pieces));
      this->add(x, y);
      const auto last = static_cast<Index>(this->Result.points.size() / 2) - 1;
      this->Result.segments.insert(this->Result.segments.end(), { last - 1, last });
      this->Result.markers.push_back(marker);
    }
  }
  void lineTo(double x, double y, int marker)
  {
    const double x0 = this->Result.points[this->Result.points.size() - 2];
    const double y0 = this->Result.points.back();
    this->curve(
      [=](double t) {
        return std::array{ x0 + t * (x - x0), y0 + t * (y - y0) };
      },
      std::hypot(x - x0, y - y0), marker);
  }
  void arc(double cx, double cy, double radius, double from, double to, int marker)
  {
    // At least about two segments per radian keep a hole round if the spacing exceeds its size.
    this->curve(
      [=](double t)
      {
        const double angle = from + t * (to - from);
        return std::array{ cx + radius * std::cos(angle), cy + radius * std::sin(angle) };
      },
      radius * std::abs(to - from), marker, 1 + static_cast<int>(2 * std::abs(to - from)));
  }
  /// Closes the outline: its last point is its first point.
  void close()
  {
    this->Result.points.resize(this->Result.points.size() - 2);
    this->Result.segments.back() = this->First;
  }
  void circle(double cx, double cy, double radius, int marker)
  {
    this->moveTo(cx + radius, cy);
    this->arc(cx, cy, radius, 0.0, 2 * Pi, marker);
    this->close();
  }
  void polygon(const std::vector<std::array<double, 2>>& corners, const std::vector<int>& markers)
  {
    this->moveTo(corners[0][0], corners[0][1]);
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      const auto& to = corners[(i + 1) % corners.size()];
      this->lineTo(to[0], to[1], markers[i % markers.size()]);
    }
    this->close();
  }
  void rectangle(double x0, double y0, double x1, double y1, int marker)
  {
    this->polygon({ { x0, y0 }, { x1, y0 }, { x1, y1 }, { x0, y1 } }, { marker });
  }
  void hole(double x, double y) { this->Result.holes.insert(this->Result.holes.end(), { x, y }); }
  void roundHole(double cx, double cy, double radius, int marker)
  {
    this->circle(cx, cy, radius, marker);
    this->hole(cx, cy);
  }

  PlanarBoundary Result;

private:
  void add(double x, double y)
  {
    this->Result.points.push_back(x);
    this->Result.points.push_back(y);
  }
  double Spacing;
  Index First = 0;
};

/// A ring with a hole, a handle, a head with open jaws.
void drawWrench(Pen& pen)
{
  constexpr double Ring = 1.0, Hole = 0.5, Half = 0.4, Head = 1.25, At = 5.2, Jaw = 0.55,
                   Depth = 0.1;
  // The angles at which the sides of handle and jaws meet the circles.
  const double a = std::asin(Half / Ring), b = std::asin(Half / Head), c = std::asin(Jaw / Head);
  pen.moveTo(Ring * std::cos(a), Half);
  pen.arc(0, 0, Ring, a, 2 * Pi - a, Outer);
  pen.lineTo(At - Head * std::cos(b), -Half, Outer);
  pen.arc(At, 0, Head, Pi + b, 2 * Pi - c, Outer);
  pen.lineTo(At - Depth, -Jaw, Third);
  pen.lineTo(At - Depth, Jaw, Third);
  pen.lineTo(At + Head * std::cos(c), Jaw, Third);
  pen.arc(At, 0, Head, c, Pi - b, Outer);
  pen.lineTo(Ring * std::cos(a), Half, Outer);
  pen.close();
  pen.roundHole(0, 0, Hole, Inner);
}

/// A leaf with knuckles, many holes and thin webs between them.
void drawHinge(Pen& pen)
{
  constexpr double Width = 5.0, Height = 5.4, Knuckle = 0.6, Reach = 1.0;
  std::vector<std::array<double, 2>> corners = { { 0, 0 }, { Width, 0 } };
  for (int i = 0; i < 9; ++i) // a knuckle, a gap, ..., a knuckle
  {
    const double x = i % 2 == 0 ? Width + Reach : Width;
    corners.push_back({ x, i * Knuckle });
    corners.push_back({ x, (i + 1) * Knuckle });
  }
  corners.push_back({ Width, Height });
  corners.push_back({ 0, Height });
  // the first and the last knuckle are flush with the leaf
  corners.erase(corners.begin() + 1);
  corners.erase(corners.end() - 2);
  pen.polygon(corners, { Outer });
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      pen.roundHole(0.7 + 1.2 * i, 0.75 + 1.3 * j, 0.54, Inner); // webs of 0.12
    }
  }
  for (int i = 0; i < 5; ++i)
  {
    pen.roundHole(Width + 0.55, Knuckle * (2 * i + 0.5), 0.22, Third);
  }
}

void drawBarrier(Pen& pen)
{
  pen.polygon({ { 0, 0 }, { 1.25, 0 }, { 1.25, 1.4 }, { 1.35, 1.4 }, { 1.35, 0 }, { 4, 0 },
                { 4, 2 }, { 2.75, 2 }, { 2.75, 0.6 }, { 2.65, 0.6 }, { 2.65, 2 }, { 0, 2 } },
    { Outer, Inner, Inner, Inner, Outer, Outer, Outer, Third, Third, Third, Outer, Outer });
}

/// A skull with a fissure and two horned ventricles, as wide as before the treatment.
void drawBrain(Pen& pen)
{
  pen.moveTo(0.8, 0);
  pen.curve(
    [](double t)
    {
      // The fissure at the top, at an angle of pi / 2, has the profile of a Gaussian.
      const double angle = 2 * Pi * t, away = std::abs(angle - Pi / 2);
      const double fissure = 1.0 - 0.08 * std::exp(-std::pow(away / 0.12, 2));
      return std::array{ 0.8 * fissure * std::cos(angle), 1.0 * fissure * std::sin(angle) };
    },
    5.8, Outer, 24);
  pen.close();
  for (const int side : { 1, -1 })
  {
    const auto ventricle = [side](double t)
    {
      const double s = std::sin(2 * Pi * t), c = std::cos(2 * Pi * t);
      return std::array{ side * (0.2 + 0.12 * c + 0.1 * s * s), 0.02 + 0.36 * s };
    };
    const auto start = ventricle(0.0);
    pen.moveTo(start[0], start[1]);
    pen.curve(ventricle, 1.7, side > 0 ? Inner : Third, 16);
    pen.close();
    pen.hole(side * 0.2, 0.02);
  }
}

const std::map<std::string, void (*)(Pen&)> Planar = {
  { "wrench", drawWrench },
  { "hinge", drawHinge },
  { "disk2d", [](Pen& pen) { pen.circle(0, 0, 1, Outer); } },
  { "barrier2d", drawBarrier },
  { "brain", drawBrain },
  { "cylinder",
    [](Pen& pen)
    {
      pen.rectangle(0, 0, 3, 1, Outer);
      pen.roundHole(0.8, 0.5, 0.15, Inner);
    } },
  { "bar",
    [](Pen& pen)
    {
      pen.rectangle(0, 0, 1, 1, Outer);
      pen.rectangle(0.3, 0.68, 0.7, 0.72, Inner);
      pen.hole(0.5, 0.7);
    } },
  { "gate",
    [](Pen& pen)
    {
      pen.polygon({ { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1.06, 1 }, { 1.03, 0.6 }, { 0.97, 0.6 },
                    { 0.94, 1 }, { 0, 1 } },
        { Outer, Outer, Outer, Inner, Inner, Inner, Outer, Outer });
    } },
  { "bending-bar",
    [](Pen& pen)
    {
      pen.rectangle(0, 0, 1, 1, Outer);
      pen.rectangle(0.15, 0.48, 0.85, 0.52, Inner);
      pen.hole(0.5, 0.5);
    } },
};

/// A planar boundary between z = 0 and z = height: side facets in layers, bottom and top with
/// holes. Sides have the markers of the segments; 4 is the bottom, 5 the top.
SolidBoundary extrude(const PlanarBoundary& plane, double height, double spacing)
{
  SolidBoundary solid;
  const auto count = static_cast<Index>(plane.points.size() / 2);
  const Index layers = std::max<Index>(1, std::llround(height / spacing));
  for (Index layer = 0; layer <= layers; ++layer)
  {
    const double z = height * static_cast<double>(layer) / static_cast<double>(layers);
    for (std::size_t i = 0; i < plane.points.size(); i += 2)
    {
      solid.points.insert(solid.points.end(), { plane.points[i], plane.points[i + 1], z });
    }
  }
  SolidFacet bottom, top;
  bottom.marker = 4;
  top.marker = 5;
  for (std::size_t s = 0; s < plane.markers.size(); ++s)
  {
    const Index a = plane.segments[2 * s], b = plane.segments[2 * s + 1];
    for (Index layer = 0; layer < layers; ++layer)
    {
      const Index low = layer * count, high = low + count;
      SolidFacet side;
      side.polygons = { { low + a, low + b, high + b, high + a } };
      side.marker = plane.markers[s];
      solid.facets.push_back(side);
    }
    // outlines are runs of consecutive points; an outline starts where a segment does not continue
    // the previous one
    if (s == 0 || plane.segments[2 * s - 1] != a)
    {
      bottom.polygons.emplace_back();
      top.polygons.emplace_back();
    }
    bottom.polygons.back().push_back(a);
    top.polygons.back().push_back(layers * count + a);
  }
  for (std::size_t i = 0; i < plane.holes.size(); i += 2)
  {
    bottom.holes.push_back({ plane.holes[i], plane.holes[i + 1], 0.0 });
    top.holes.push_back({ plane.holes[i], plane.holes[i + 1], height });
    solid.holes.insert(solid.holes.end(), { plane.holes[i], plane.holes[i + 1], 0.5 * height });
  }
  solid.facets.push_back(bottom);
  solid.facets.push_back(top);
  return solid;
}

/// The points of an icosahedron whose faces are cut into n x n triangles, on the unit sphere.
void addSphere(SolidBoundary& solid, const Vec3& center, double radius, Index n, int marker)
{
  // The corners of a regular icosahedron follow from the golden ratio g.
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  const Vec3 v[] = { { -1, g, 0 }, { 1, g, 0 }, { -1, -g, 0 }, { 1, -g, 0 }, { 0, -1, g },
    { 0, 1, g }, { 0, -1, -g }, { 0, 1, -g }, { g, 0, -1 }, { g, 0, 1 }, { -g, 0, -1 },
    { -g, 0, 1 } };
  const int faces[][3] = { { 0, 11, 5 }, { 0, 5, 1 }, { 0, 1, 7 }, { 0, 7, 10 }, { 0, 10, 11 },
    { 1, 5, 9 }, { 5, 11, 4 }, { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 }, { 3, 9, 4 }, { 3, 4, 2 },
    { 3, 2, 6 }, { 3, 6, 8 }, { 3, 8, 9 }, { 4, 9, 5 }, { 2, 4, 11 }, { 6, 2, 10 }, { 8, 6, 7 },
    { 9, 8, 1 } };
  // points are shared between faces, identified by their weights of the twelve corners
  std::map<std::array<std::pair<int, Index>, 3>, Index> known;
  const auto point = [&](const int* face, Index i, Index j)
  {
    const Index weights[] = { n - i - j, i, j };
    std::array<std::pair<int, Index>, 3> key;
    Vec3 p = { 0, 0, 0 };
    // Corners with weight 0 are removed from the key, so that adjacent faces find the same points
    // on their common edge.
    for (std::size_t k = 0; k < 3; ++k)
    {
      key[k] = { weights[k] > 0 ? face[k] : -1, weights[k] };
    }
    std::sort(key.begin(), key.end());
    for (const auto& [corner, weight] : key)
    {
      p += static_cast<double>(weight) * (corner < 0 ? Vec3{ 0, 0, 0 } : v[corner]);
    }
    const auto [entry, added] = known.insert({ key, static_cast<Index>(solid.points.size() / 3) });
    if (added)
    {
      p = center + (radius / norm(p)) * p;
      solid.points.insert(solid.points.end(), p.begin(), p.end());
    }
    return entry->second;
  };
  const auto triangle = [&](Index a, Index b, Index c)
  {
    SolidFacet facet;
    facet.polygons = { { a, b, c } };
    facet.marker = marker;
    solid.facets.push_back(facet);
  };
  for (const auto& face : faces)
  {
    for (Index i = 0; i < n; ++i)
    {
      for (Index j = 0; i + j < n; ++j)
      {
        triangle(point(face, i, j), point(face, i + 1, j), point(face, i, j + 1));
        if (i + j + 1 < n)
        {
          triangle(point(face, i + 1, j), point(face, i + 1, j + 1), point(face, i, j + 1));
        }
      }
    }
  }
}

SolidBoundary sphereInCube(double spacing)
{
  Pen pen(1.0); // the faces of the cube are left to the mesher
  pen.rectangle(0, 0, 1, 1, Outer);
  SolidBoundary solid = extrude(pen.Result, 1.0, 1.0);
  for (SolidFacet& facet : solid.facets)
  {
    facet.marker = Outer;
  }
  constexpr double Radius = 0.15;
  const Vec3 center = { 0.5, 0.5, 0.35 };
  // An edge of the icosahedron spans an arc of 1.107 radii on the sphere.
  const auto n = std::max<Index>(2, std::llround(1.1 * Radius / spacing));
  addSphere(solid, center, Radius, n, Inner);
  solid.holes.insert(solid.holes.end(), center.begin(), center.end());
  return solid;
}

/// The space between two concentric cubes with parallel faces.
SolidBoundary boxInBox(double spacing)
{
  SolidBoundary solid;
  const auto addCube = [&](double low, double high, int marker)
  {
    Pen pen(spacing);
    pen.rectangle(low, low, high, high, marker);
    const auto first = static_cast<Index>(solid.points.size() / 3);
    SolidBoundary cube = extrude(pen.Result, high - low, spacing);
    for (std::size_t i = 2; i < cube.points.size(); i += 3)
    {
      cube.points[i] += low;
    }
    solid.points.insert(solid.points.end(), cube.points.begin(), cube.points.end());
    for (SolidFacet& facet : cube.facets)
    {
      facet.marker = marker;
      for (std::vector<Index>& polygon : facet.polygons)
      {
        for (Index& point : polygon)
        {
          point += first;
        }
      }
      solid.facets.push_back(facet);
    }
  };
  constexpr double Middle = 0.5, Half = 0.15;
  addCube(0, 1, Outer);
  addCube(Middle - Half, Middle + Half, Inner);
  solid.holes = { Middle, Middle, Middle };
  return solid;
}
}

//------------------------------------------------------------------------------
PlanarBoundary planarBoundary(const std::string& name, double spacing)
{
  const auto found = Planar.find(name == "cylinder-diagonal" ? "cylinder" : name);
  if (found == Planar.end())
  {
    throw Error("the domain '" + name + "' is not bounded by segments in the plane");
  }
  requireSpacing(spacing, SmallestPlanarSpacing);
  Pen pen(spacing);
  found->second(pen);
  return pen.Result;
}

//------------------------------------------------------------------------------
SolidBoundary solidBoundary(const std::string& name, double spacing)
{
  requireSpacing(spacing, SmallestSolidSpacing);
  if (name == "sphere")
  {
    return sphereInCube(spacing);
  }
  if (name == "box-in-box")
  {
    return boxInBox(spacing);
  }
  if (name == "disk3d")
  {
    return extrude(planarBoundary("disk2d", spacing), 0.5, spacing);
  }
  if (name == "barrier3d")
  {
    return extrude(planarBoundary("barrier2d", spacing), 1.0, spacing);
  }
  if (name == "bore")
  {
    Pen pen(spacing);
    pen.rectangle(0, 0, 2, 2, Outer);
    pen.roundHole(1, 1, 0.4, Inner);
    return extrude(pen.Result, 1.0, spacing);
  }
  throw Error("the domain '" + name + "' is not bounded by facets in space");
}
}
