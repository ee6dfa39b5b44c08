// SPDX-License-Identifier: BSD-3-Clause
// From images to outlines and polygons: known areas, sub-pixel places, what is ignored or rejected.

#include "Registry.h"
#include "Shapes.h"

#include <limits>

using namespace tautline;

namespace
{
TAUTLINE_PART(testDisc)
{
  const Picture picture = disc(101, 48.3, 51.6, 30.0);
  const Silhouette shape = traceSilhouette(picture.view());
  TAUTLINE_CHECK_RELATIVE(shape.area, 3.14159265 * 900, 0.01);
  TAUTLINE_CHECK_NEAR(shape.centre[0], 48.3, 0.1);
  TAUTLINE_CHECK_NEAR(shape.centre[1], 51.6, 0.1);
  TAUTLINE_CHECK_NEAR(shape.maxDistance, 30.0, 1.0);
  TAUTLINE_CHECK_EQUAL(shape.components, 1);
  TAUTLINE_CHECK_EQUAL(shape.holes, 0);
  TAUTLINE_CHECK(!shape.touchesBorder && !shape.dark);
  TAUTLINE_CHECK(signedArea(shape.outline) > 0.0 && isSimple(shape.outline));
  const std::vector<Vec2> polygon = approximateOutline(shape.outline, 10.0);
  TAUTLINE_CHECK(isSimple(polygon) && signedArea(polygon) > 0.0);
  TAUTLINE_CHECK(polygon.size() >= 15 && polygon.size() <= 25);
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double length = std::hypot(a[0] - b[0], a[1] - b[1]);
    TAUTLINE_CHECK(length > 5.0 && length < 15.0);
    TAUTLINE_CHECK_NEAR(std::hypot(a[0] - 48.3, a[1] - 51.6), 30.0, 1.0);
  }
}

TAUTLINE_PART(testSubPixel)
{
  // A gray ramp across an edge at x = 20.25: linear interpolation finds it exactly.
  Picture picture = paint(60, 40, [](double, double) { return -1.0; });
  for (Index j = 10; j < 30; ++j)
  {
    for (Index i = 10; i < 40; ++i)
    {
      picture.at(i, j) = static_cast<float>(
        std::min(100.0, std::max(0.0, 40.0 * (static_cast<double>(i) - 20.25) + 50.0)));
    }
  }
  const Silhouette shape = traceSilhouette(picture.view());
  double left = 1e9;
  for (const Vec2& p : shape.outline)
  {
    left = p[1] > 12 && p[1] < 28 ? std::min(left, p[0]) : left;
  }
  TAUTLINE_CHECK_NEAR(left, 20.25, 1e-5);
}

TAUTLINE_PART(testPolarityAndComponents)
{
  Picture picture = disc(80, 40, 40, 20);
  const double area = traceSilhouette(picture.view()).area;
  Picture dark = picture;
  for (float& value : dark.values)
  {
    value = 255.0f - value;
  }
  const Silhouette negative = traceSilhouette(dark.view());
  TAUTLINE_CHECK(negative.dark);
  TAUTLINE_CHECK_RELATIVE(negative.area, area, 1e-9);
  // A smaller component and a hole are counted and ignored.
  for (Index j = 2; j < 8; ++j)
  {
    for (Index i = 2; i < 8; ++i)
    {
      picture.at(i, j) = 255.0f;
      picture.at(i + 36, j + 36) = 0.0f;
    }
  }
  const Silhouette shape = traceSilhouette(picture.view());
  TAUTLINE_CHECK_EQUAL(shape.components, 2);
  TAUTLINE_CHECK_EQUAL(shape.holes, 1);
  TAUTLINE_CHECK_RELATIVE(shape.area, area, 1e-9);
  double filled = sumOf<double>(0.0, shape.mask, [&](float value) { return value; });
  TAUTLINE_CHECK_NEAR(filled, area, 80.0); // half a pixel along the outline
  // Pixels that touch at a corner are one component, with a simple outline.
  Picture corner = paint(12, 12, [](double, double) { return -1.0; });
  for (Index i = 2; i < 8; ++i)
  {
    corner.at(i, i) = 1.0f;
  }
  const Silhouette chain = traceSilhouette(corner.view());
  TAUTLINE_CHECK_EQUAL(chain.components, 1);
  TAUTLINE_CHECK(isSimple(chain.outline));
}

TAUTLINE_PART(testExtremes)
{
  // At the border, one pixel, a thin line, all but one pixel.
  const Silhouette whole =
    traceSilhouette(paint(40, 30, [](double x, double) { return 20.5 - x; }).view(),
      { std::nan(""), Foreground::Bright });
  TAUTLINE_CHECK(whole.touchesBorder);
  TAUTLINE_CHECK_NEAR(whole.area, 21.0 * 30.0, 1.0);
  Picture dot = paint(9, 9, [](double, double) { return -1.0; });
  dot.at(4, 4) = 1.0f;
  const Silhouette pixel = traceSilhouette(dot.view());
  TAUTLINE_CHECK_NEAR(pixel.area, 0.5, 1e-6);
  const ShapeSource smallest = makeShapeSource(pixel, 25.0);
  TAUTLINE_CHECK(smallest.mesh.points.size() >= 3);
  Picture line =
    paint(60, 9, [](double x, double y) { return x > 4 && x < 55 && y == 4 ? 1.0 : -1.0; });
  const ShapeSource thin = makeShapeSource(traceSilhouette(line.view()), 25.0);
  TAUTLINE_CHECK(thin.mesh.triangles.size() >= 1);
  Picture huge = disc(3000, 1500, 1500, 1200);
  const ShapeSource large = makeShapeSource(traceSilhouette(huge.view()), 100.0);
  TAUTLINE_CHECK(large.mesh.points.size() > 60 && large.mesh.points.size() < 90);
  Picture single = paint(1, 1, [](double, double) { return 1.0; });
  TAUTLINE_CHECK_THROWS(traceSilhouette(single.view()), wording("one-value"));
}

TAUTLINE_PART(testRejected)
{
  TAUTLINE_CHECK_THROWS(traceSilhouette(ImageView{}), "empty");
  Picture white = paint(10, 10, [](double, double) { return 1.0; });
  TAUTLINE_CHECK_THROWS(traceSilhouette(white.view()), wording("one-value"));
  Picture picture = disc(40, 20, 20, 10);
  TAUTLINE_CHECK_THROWS(
    traceSilhouette(picture.view(), { 300.0, Foreground::Bright }), wording("no-pixel"));
  TAUTLINE_CHECK_THROWS(
    traceSilhouette(picture.view(), { 300.0, Foreground::Dark }), wording("every-pixel"));
  TAUTLINE_CHECK_THROWS(traceSilhouette(picture.view(),
                          { std::numeric_limits<double>::infinity(), Foreground::Bright }),
    wording("not-finite"));
  const Silhouette shape = traceSilhouette(picture.view());
  for (double spacing : { 0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity() })
  {
    TAUTLINE_CHECK_THROWS(approximateOutline(shape.outline, spacing), "spacing");
  }
  TAUTLINE_CHECK_THROWS(approximateOutline({ { 0, 0 }, { 1, 0 } }, 1.0), wording("no-area"));
  picture.at(3, 3) = std::nanf("");
  TAUTLINE_CHECK_THROWS(traceSilhouette(picture.view()), wording("not-finite"));
}
}
