// SPDX-License-Identifier: BSD-3-Clause
/// Pictures of meshes: where cells are, which are in front, which are seen through others.
#include "MeshPicture.h"
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr Color Red = { 1, 0, 0 }, Green = { 0, 1, 0 };
constexpr int Width = 200, Height = 150;

std::array<int, 3> pixel(const Picture& picture, int x, int y)
{
  const std::size_t at = 3 * (static_cast<std::size_t>(y) * picture.width + x);
  return { picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2] };
}

/// The share of pixels that are not white.
double covered(const Picture& picture)
{
  int count = 0;
  for (int y = 0; y < picture.height; ++y)
  {
    for (int x = 0; x < picture.width; ++x)
    {
      count += pixel(picture, x, y) != std::array<int, 3>{ 255, 255, 255 };
    }
  }
  return static_cast<double>(count) / (picture.width * picture.height);
}

/// Two squares beside each other, the left one red: 184 pixels wide with the margin of 4 %.
void testPlane(double scale, const Vec3& shift)
{
  MeshData data;
  const auto at = [&](double x, double y) { return scale * Vec3{ x, y, 0 } + shift; };
  TAUTLINE_SET(data,
    addCell(CellType::Quadrilateral, std::vector<Vec3>{ at(0, 0), at(1, 0), at(1, 1), at(0, 1) }),
    addCell(CellType::Quadrilateral, std::vector<Vec3>{ at(1, 0), at(2, 0), at(2, 1), at(1, 1) }));
  const Mesh mesh(data.view());
  const Picture picture = drawMeshes({ { &mesh, { Red, Green }, {} } }, Width, Height);
  TAUTLINE_CHECK((pixel(picture, 60, 70) == std::array<int, 3>{ 255, 0, 0 }));
  TAUTLINE_CHECK((pixel(picture, 140, 80) == std::array<int, 3>{ 0, 255, 0 }));
  TAUTLINE_CHECK((pixel(picture, 100, 10) == std::array<int, 3>{ 255, 255, 255 }));
  TAUTLINE_CHECK((pixel(picture, 4, 75) == std::array<int, 3>{ 255, 255, 255 }));
  TAUTLINE_CHECK_NEAR(covered(picture), 184.0 * 92 / (Width * Height), 0.02);
  // The edge between them is dark; the diagonals are no edges.
  TAUTLINE_CHECK(pixel(picture, 100, 75)[0] + pixel(picture, 100, 75)[1] < 200);
  TAUTLINE_CHECK((pixel(picture, 54, 75) == std::array<int, 3>{ 255, 0, 0 }));
}

/// Two squares one behind the other, seen along the direction of view: only the front one shows.
void testFront(bool frontFirst)
{
  MeshData data;
  const Vec3 behind = -2.0 * Vec3{ 0.75, -1.0, 0.55 };
  const std::vector<Vec3> corners = { { 0, -1, 0 }, { 1, -1, 0 }, { 1, -1, 1 }, { 0, -1, 1 } };
  for (const bool front : { frontFirst, !frontFirst })
  {
    std::vector<Vec3> square = corners;
    for (Vec3& p : square)
    {
      p += front ? Vec3{ 0, 0, 0 } : behind;
    }
    data.addCell(CellType::Quadrilateral, square);
  }
  const Mesh mesh(data.view());
  const std::vector<Color> colors =
    frontFirst ? std::vector<Color>{ Red, Green } : std::vector<Color>{ Green, Red };
  const Picture picture = drawMeshes({ { &mesh, colors, {} } }, Width, Height);
  int red = 0, green = 0;
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      const auto rgb = pixel(picture, x, y);
      red += rgb[0] > rgb[1];
      green += rgb[1] > rgb[0];
    }
  }
  TAUTLINE_CHECK(red > 0.9 * covered(picture) * Width * Height);
  TAUTLINE_CHECK(green < 0.01 * red); // rounding at the margin
}

/// The cell in the middle of a cube of 3 x 3 x 3 hexahedra is hidden until it is highlighted.
TAUTLINE_PART(testInside)
{
  MeshData data;
  for (int i = 0; i < 64; ++i)
  {
    data.addPoint({ double(i % 4), double(i / 4 % 4), double(i / 16) });
  }
  for (int i = 0; i < 27; ++i)
  {
    const Index p = i % 3 + 4 * (i / 3 % 3) + 16 * (i / 9);
    data.addCell(CellType::Hexahedron,
      std::vector<Index>{ p, p + 1, p + 5, p + 4, p + 16, p + 17, p + 21, p + 20 });
  }
  const Mesh mesh(data.view());
  std::vector<Color> colors(27, Green);
  colors[13] = Red;
  const auto isRed = [](const std::array<int, 3>& rgb) { return rgb[0] > 120 && rgb[1] < 20; };
  const Picture hidden = drawMeshes({ { &mesh, colors, {} } }, Width, Height);
  std::vector<char> highlighted(27, 0);
  highlighted[13] = 1;
  const Picture seen = drawMeshes({ { &mesh, colors, highlighted } }, Width, Height);
  int before = 0, after = 0;
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      before += isRed(pixel(hidden, x, y));
      after += isRed(pixel(seen, x, y));
    }
  }
  TAUTLINE_CHECK_EQUAL(before, 0);
  // A ninth of the picture of the cube, except for the edges.
  TAUTLINE_CHECK_RELATIVE(after / (covered(seen) * Width * Height), 1.0 / 9, 0.25);
  TAUTLINE_CHECK(isRed(pixel(seen, Width / 2, Height / 2 + 8)));
  TAUTLINE_CHECK(!isRed(pixel(hidden, Width / 2, Height / 2 + 8)));
}

TAUTLINE_PART(testLimits)
{
  TAUTLINE_CHECK_EQUAL(covered(drawMeshes({}, Width, Height)), 0);
  TAUTLINE_LET(MeshData, data,
    addCell(CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }),
    addCell(
      CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, std::nan(""), 0 } }));
  const Mesh mesh(data.view());
  // The second cell has a point that is not finite: the first is as large as fits.
  TAUTLINE_CHECK(covered(drawMeshes({ { &mesh, { Red, Green }, {} } }, Width, Height)) > 0.2);
  TAUTLINE_CHECK_THROWS(drawMeshes({}, 8, Height), wording("16-to-4096-pixels"));
  TAUTLINE_CHECK_THROWS(drawMeshes({}, Width, 5000), wording("16-to-4096-pixels"));
  TAUTLINE_CHECK_THROWS(
    drawMeshes({ { &mesh, { Red }, {} } }, Width, Height), wording("one-colour-per-cell"));
  TAUTLINE_CHECK_THROWS(drawMeshes({ {} }, Width, Height), wording("one-colour-per-cell"));
  // A mesh without extent is no division by zero.
  MeshData flat;
  flat.addCell(CellType::Triangle, std::vector<Vec3>{ { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } });
  const Mesh point(flat.view());
  TAUTLINE_CHECK_EQUAL(covered(drawMeshes({ { &point, { Red }, {} } }, Width, Height)), 0);
}
}

TAUTLINE_TEST(TestMeshPicture)
{
  TAUTLINE_RUN(testPlane(1, { 0, 0, 0 }));
  TAUTLINE_RUN(testPlane(1e-200, { 0, 0, 0 }));
  TAUTLINE_RUN(testPlane(1e200, { 0, 0, 0 }));
  TAUTLINE_RUN(testPlane(3, { -70, 20, 5 }));
  TAUTLINE_RUN(testFront(true));
  TAUTLINE_RUN(testFront(false));
}
