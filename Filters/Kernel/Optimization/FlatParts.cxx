// SPDX-License-Identifier: BSD-3-Clause
#include "FlatParts.h"

#include "tautline/Boundary/FlatPart.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tautline
{
namespace
{
/// Looks up points by their coordinates.
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

/// Sets the planes, lines and flags of the points on the parts of the model made from the mesh.
void addModel(const Mesh& mesh, const OptimizeOptions& options, PointSlides& slides)
{
  const MeshView& view = mesh.view();
  const std::vector<SurfacePart>& parts = options.model->parts;
  std::vector<char> flat;
  std::vector<Vec3> directions(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    flat.push_back(isFlatPart(parts[i], options.surfaceTolerance, directions[i]));
  }
  // A curve next to a curved patch is held: otherwise the patch would not cover the same region.
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
