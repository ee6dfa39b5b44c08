// SPDX-License-Identifier: BSD-3-Clause
#include "FlatParts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tautline
{
namespace
{
/// How far a flat part may be from its plane, or a straight one from its line: of its size, and of
/// the surface tolerance.
constexpr double ofSize = 1e-6, ofTolerance = 1e-3;

/// Calls visit(x) with the corners and control points of all pieces of a part.
template <class Visit>
void forEachPoint(const SurfacePart& part, const Visit& visit)
{
  for (const auto& piece : part.pieces)
  {
    std::for_each(piece.begin(), piece.end(), visit);
  }
  constexpr int ofArc = 2;
  for (const CubicControls& controls : part.controls)
  {
    std::for_each(controls.begin(), part.curve ? controls.begin() + ofArc : controls.end(), visit);
  }
}

/// The normal of a flat patch, or the direction of a straight curve; false if it is neither.
bool isFlat(const SurfacePart& part, double surfaceTolerance, Vec3& direction)
{
  const auto directionOf = [&part](const std::array<Vec3, 3>& piece)
  {
    const auto& [a, b, c] = piece;
    return part.curve ? b - a : cross(b - a, c - a);
  };
  Vec3 largest = { 0, 0, 0 };
  for (const auto& piece : part.pieces)
  {
    const Vec3 d = directionOf(piece);
    largest = dot(d, d) > dot(largest, largest) ? d : largest;
  }
  // Their sum has less of the rounding of coordinates than one, whatever the order of the corners.
  Vec3 origin = { 0, 0, 0 };
  direction = { 0, 0, 0 };
  for (const auto& piece : part.pieces)
  {
    const Vec3 d = directionOf(piece);
    direction += (dot(d, largest) < 0 ? -1.0 : 1.0) * d;
    origin += (1.0 / static_cast<double>(part.pieces.size())) * piece[0];
  }
  const double length = norm(direction);
  if (!(length > 0))
  {
    return false;
  }
  direction = (1.0 / length) * direction;
  double size = 0, off = 0;
  forEachPoint(part,
    [&](const Vec3& x)
    {
      const Vec3 d = x - origin;
      size = std::max(size, norm(d));
      off = std::max(off, part.curve ? norm(cross(d, direction)) : std::abs(dot(d, direction)));
    });
  const double most = ofSize * size;
  return off <= (surfaceTolerance > 0 ? std::min(most, ofTolerance * surfaceTolerance) : most);
}

/// Points by their coordinates.
class PointFinder
{
public:
  explicit PointFinder(const MeshView& view)
    : View(view)
  {
  }
  void add(Index p) { this->Items.emplace_back(pointOf(this->View, p), p); }
  void sort() { std::sort(this->Items.begin(), this->Items.end()); }
  template <class Visit>
  void forEachAt(const Vec3& x, const Visit& visit) const
  {
    for (auto item =
           std::lower_bound(this->Items.begin(), this->Items.end(), std::pair(x, Index(0)));
         item != this->Items.end() && item->first == x; ++item)
    {
      visit(item->second);
    }
  }

private:
  const MeshView& View;
  std::vector<std::pair<Vec3, Index>> Items;
};

/// Sets the planes, lines and flags of the points on the parts of the mesh's own model.
void addModel(const Mesh& mesh, const OptimizeOptions& options, PointSlides& slides)
{
  const MeshView& view = mesh.view();
  const std::vector<SurfacePart>& parts = options.model->parts;
  std::vector<char> flat;
  std::vector<Vec3> directions(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    flat.push_back(isFlat(parts[i], options.surfaceTolerance, directions[i]));
  }
  // A curve beside a curved patch is held: the patch would not cover the same places.
  PointFinder onCurves(view);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const std::int32_t part = options.parts[p];
    slides.held[p] |= part >= 0 && !flat[part];
    const Vec3 x = pointOf(view, p);
    if (part >= 0 && parts[part].curve && std::isfinite(dot(x, x)))
    {
      onCurves.add(p);
    }
  }
  onCurves.sort();
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    for (std::size_t k = 0; !parts[i].curve && !flat[i] && k < parts[i].pieces.size(); ++k)
    {
      for (const Vec3& x : parts[i].pieces[k])
      {
        onCurves.forEachAt(x, [&](Index p) { slides.held[p] = 1; });
      }
    }
  }
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const std::int32_t part = options.parts[p];
    if (part >= 0 && !slides.held[p])
    {
      std::vector<double>& ofPoints = parts[part].curve ? slides.lines : slides.planes;
      std::copy(directions[part].begin(), directions[part].end(), ofPoints.begin() + 3 * p);
    }
  }
}
}

//------------------------------------------------------------------------------
PointSlides slidesOf(const Mesh& mesh, const OptimizeOptions& options)
{
  const Index points = mesh.view().numberOfPoints;
  const auto copyOf = [&](const double* directions)
  {
    return directions ? std::vector<double>(directions, directions + 3 * points)
                      : std::vector<double>();
  };
  PointSlides slides{ copyOf(options.slidePlanes), copyOf(options.slideLines), {} };
  if (!options.model && !options.slideSurface)
  {
    return slides;
  }
  slides.held.assign(points, 0);
  if (options.model && !options.onGeometry)
  {
    slides.planes.resize(3 * points, 0.0);
    slides.lines.resize(3 * points, 0.0);
    addModel(mesh, options, slides);
    return slides;
  }
  for (Index p = 0; p < points; ++p)
  {
    slides.held[p] = options.model ? options.parts[p] >= 0 : options.slideSurface[p] != 0;
  }
  return slides;
}
}
