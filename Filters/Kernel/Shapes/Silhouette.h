// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Silhouette.h
 * @brief Extracts the outline of the shape in an image, and a polygon that approximates it.
 *
 *     const tautline::Silhouette shape = tautline::traceSilhouette(image);
 *     const tautline::PolygonMesh mesh =
 *       tautline::triangulatePolygon(tautline::approximateOutline(shape.outline, 25.0));
 *
 * Lengths are pixels; the pixel in column i and row j has its center at (i, j).
 */
#ifndef tautline_Silhouette_h
#define tautline_Silhouette_h

#include "tautline/Geometry/Polygon.h"
#include "tautline/ShapesKernelExport.h"

namespace tautline
{
/// Gray values, row by row; not owned.
struct ImageView
{
  const float* values = nullptr;
  Index width = 0;
  Index height = 0;

  float operator()(Index i, Index j) const { return this->values[j * this->width + i]; }
};

/// The side of the threshold on which the shape is.
enum class Foreground
{
  Automatic = 0, ///< the side with fewer pixels on the image border; Bright at a tie
  Bright = 1,    ///< above the threshold
  Dark = 2       ///< at or below it
};

/// The separation of the shape from its surroundings.
struct SilhouetteOptions
{
  /// The gray value between the shape and its surroundings; NaN, the default: midway between the
  /// smallest and the largest value.
  double threshold = std::nan("");
  Foreground foreground = Foreground::Automatic;
};

/// The outline of the largest component, and counts of the others.
struct Silhouette
{
  std::vector<Vec2> outline; ///< closed and simple, counterclockwise, about one point per pixel
  Vec2 centre = {};          ///< center of mass of the area inside the outline
  double maxDistance = 0;    ///< from the center to the outline: d_max in the dissertation
  double area = 0;           ///< inside the outline, including holes
  double perimeter = 0;
  Index components = 0; ///< of the foreground; pixels that touch at a corner are connected
  Index holes = 0;      ///< in the largest component; they are ignored
  bool touchesBorder = false;
  double threshold = 0; ///< as used
  bool dark = false;    ///< as used
  /// 1 inside the outline and 0 elsewhere, with holes filled, row by row.
  std::vector<float> mask;
  Index width = 0; ///< of the image
  Index height = 0;
};

/**
 * @brief Traces the largest component of the foreground with subpixel accuracy, by marching
 * squares.
 *
 * Between two pixels, the outline is where linear interpolation gives the threshold; midway in a
 * binary image. Everything beyond the image border is background. If components have equal size,
 * the first one in the image is used.
 *
 * Throws Error for an empty image, for values that are not finite, for an image with only one
 * value, and if there is no foreground or no background.
 */
TAUTLINE_SHAPESKERNEL_EXPORT Silhouette traceSilhouette(
  const ImageView& image, const SilhouetteOptions& options = {});

/**
 * @brief A simple polygon with vertices on an outline at nearly equal distances.
 *
 * Vertices are chosen among points a twentieth of the spacing apart so that the sum over the edges
 * of (length along the outline / spacing - 1)^2 + (largest distance of the outline from the edge /
 * spacing)^2 is minimal, with lengths from a half to one and a half spacings (dissertation section
 * 5.2.1; the sum is not in it). If that polygon has fewer than 3 vertices or intersects itself, the
 * spacing is reduced; if that does not help, as at thin parts, the outline itself is simplified by
 * reducePolygon().
 *
 * @param outline closed, in either direction; the result is counterclockwise
 * @param spacing the ideal distance, above 0; the dissertation uses 25 pixels. Throws Error for a
 * spacing that is not above 0 and finite, and for an outline without area.
 */
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Vec2> approximateOutline(
  const std::vector<Vec2>& outline, double spacing);

/**
 * @brief A simple polygon with fewer vertices: removes vertices whose triangle with their neighbors
 * is small and contains no other vertex, so that the polygon does not intersect itself.
 * @param polygon simple
 * @param most the maximum number of remaining vertices; at least 3
 */
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Vec2> reducePolygon(std::vector<Vec2> polygon, Index most);

/// Points at equal distances along a closed outline, beginning at its first point.
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Vec2> resampleOutline(
  const std::vector<Vec2>& outline, Index count);
}
#endif
