// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Silhouette.h
 * @brief From an image to the outline of what it shows, and to a polygon close to that.
 *
 *     const tautline::Silhouette shape = tautline::traceSilhouette(image);
 *     const tautline::PolygonMesh mesh =
 *       tautline::triangulatePolygon(tautline::approximateOutline(shape.outline, 25.0));
 *
 * Lengths are pixels; the pixel in column i and row j has its centre at (i, j).
 */
#ifndef tautline_Silhouette_h
#define tautline_Silhouette_h

#include "tautline/Geometry/Polygon.h"
#include "tautline/ShapesKernelExport.h"

namespace tautline
{
/// Grey values, row after row; not owned.
struct ImageView
{
  const float* values = nullptr;
  Index width = 0;
  Index height = 0;

  float operator()(Index i, Index j) const { return this->values[j * this->width + i]; }
};

/// Which side of the threshold the shape is on.
enum class Foreground
{
  Automatic = 0, ///< the side that fewer pixels of the image's border are on; Bright at a tie
  Bright = 1,    ///< above the threshold
  Dark = 2       ///< at or below it
};

/// How the shape is separated from its surroundings.
struct SilhouetteOptions
{
  /// Grey value between the shape and its surroundings; NaN, the default: midway between the
  /// smallest and the largest value.
  double threshold = std::nan("");
  Foreground foreground = Foreground::Automatic;
};

/// The outline of the largest component, and figures of the rest.
struct Silhouette
{
  std::vector<Vec2> outline; ///< closed and simple, counter-clockwise, about a point per pixel
  Vec2 centre = {};          ///< centre of mass of the area inside the outline
  double maxDistance = 0;    ///< from the centre to the outline: the dissertation's d_max
  double area = 0;           ///< inside the outline, holes included
  double perimeter = 0;
  Index components = 0; ///< of the foreground; pixels that touch at a corner are connected
  Index holes = 0;      ///< in the largest component; they are ignored
  bool touchesBorder = false;
  double threshold = 0; ///< as used
  bool dark = false;    ///< as used
  /// 1 inside the outline and 0 elsewhere, holes filled, row after row.
  std::vector<float> mask;
  Index width = 0; ///< of the image
  Index height = 0;
};

/**
 * @brief Traces the largest component of the foreground, to sub-pixel by marching squares.
 *
 * Between two pixels the outline crosses where linear interpolation gives the threshold; midway in
 * a binary image. Beyond the border of the image is background. Of components of equal size, the
 * one that comes first in the image is taken.
 *
 * Throws Error on an empty image, on values that are not finite, on an image of one value, and if
 * nothing is on the foreground's side of the threshold or no background is left.
 */
TAUTLINE_SHAPESKERNEL_EXPORT Silhouette traceSilhouette(
  const ImageView& image, const SilhouetteOptions& options = {});

/**
 * @brief A simple polygon with vertices on an outline at nearly equal distances.
 *
 * Vertices are chosen among points a twentieth of the spacing apart so that the sum over the edges
 * of (length along the outline / spacing - 1)^2 + (largest distance of the outline from the edge /
 * spacing)^2 is minimal, with lengths from a half to one and a half spacings (dissertation
 * section 5.2.1; the sum is not in it). Where that polygon has less than 3 vertices or meets
 * itself, the spacing is reduced; where that does not help, as at thin parts, the outline itself is
 * simplified by reducePolygon().
 *
 * @param outline closed, in either direction; the result runs counter-clockwise
 * @param spacing the ideal distance, above 0; the dissertation's is 25 pixels
 * Throws Error on a spacing that is not above 0 and finite, and on an outline without area.
 */
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Vec2> approximateOutline(
  const std::vector<Vec2>& outline, double spacing);

/**
 * @brief A simple polygon with fewer vertices: those are removed whose triangle with their
 * neighbours is small and has no other vertex in it, so that it does not meet itself.
 * @param polygon simple
 * @param most vertices that are left at most; at least 3
 */
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Vec2> reducePolygon(std::vector<Vec2> polygon, Index most);

/// Points at equal distances along a closed outline, beginning at its first point.
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Vec2> resampleOutline(
  const std::vector<Vec2>& outline, Index count);
}
#endif
