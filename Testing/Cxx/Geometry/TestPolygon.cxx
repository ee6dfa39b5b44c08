// SPDX-License-Identifier: BSD-3-Clause
// Constrained Delaunay triangulation of simple polygons: known ones, random ones, degenerate ones,
// rejected ones.

#include "Registry.h"
#include "tautline/Geometry/Polygon.h"

#include <limits>
#include <random>
#include <set>

using namespace tautline;

namespace
{
double cross(const Vec2& a, const Vec2& b, const Vec2& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// In-circle determinant, plainly; positive inside.
double circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
  long double m[3][3];
  const Vec2* p[3] = { &a, &b, &c };
  for (int i = 0; i < 3; ++i)
  {
    m[i][0] = static_cast<long double>((*p[i])[0]) - d[0];
    m[i][1] = static_cast<long double>((*p[i])[1]) - d[1];
    m[i][2] = m[i][0] * m[i][0] + m[i][1] * m[i][1];
  }
  return static_cast<double>(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
    m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
    m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}

void checkMesh(const std::vector<Vec2>& polygon, double tolerance)
{
  const PolygonMesh mesh = triangulatePolygon(polygon);
  const std::size_t n = polygon.size();
  TAUTLINE_CHECK_EQUAL(mesh.points.size(), n);
  TAUTLINE_CHECK_EQUAL(mesh.triangles.size(), n - 2);
  double area = 0.0;
  std::set<std::pair<Index, Index>> edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const auto& v = mesh.triangles[t];
    const double twice = cross(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]);
    TAUTLINE_CHECK(twice > 0.0);
    area += 0.5 * twice;
    for (int c = 0; c < 3; ++c)
    {
      TAUTLINE_CHECK(edges.insert({ v[c], v[(c + 1) % 3] }).second);
      const Index u = mesh.neighbours[t][c];
      if (u < 0)
      {
        TAUTLINE_CHECK_EQUAL((v[(c + 1) % 3] + 1) % static_cast<Index>(n), v[(c + 2) % 3]);
        continue;
      }
      // No vertex across an edge lies in the circle: Delaunay.
      for (Index w : mesh.triangles[u])
      {
        if (w != v[0] && w != v[1] && w != v[2])
        {
          TAUTLINE_CHECK(circle(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]],
                           mesh.points[w]) <= tolerance);
        }
      }
    }
  }
  TAUTLINE_CHECK_RELATIVE(area, std::abs(signedArea(polygon)), 1e-12);
  // Each vertex is eliminated once, when one triangle with it is left, but the last two.
  TAUTLINE_CHECK_EQUAL(mesh.elimination.size(), n - 2);
  std::set<Index> gone, triangles;
  for (const EliminationStep& step : mesh.elimination)
  {
    Index left = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
      const auto& v = mesh.triangles[t];
      left += !triangles.count(static_cast<Index>(t)) &&
        (v[0] == step.vertex || v[1] == step.vertex || v[2] == step.vertex);
    }
    TAUTLINE_CHECK_EQUAL(left, 1);
    TAUTLINE_CHECK(gone.insert(step.vertex).second);
    TAUTLINE_CHECK(!gone.count(step.parents[0]) && !gone.count(step.parents[1]));
    triangles.insert(step.triangle);
  }
}
}

TAUTLINE_TEST(TestPolygon)
{
  TAUTLINE_RUN(checkMesh({ { 0, 0 }, { 1, 0 }, { 0, 1 } }, 0));
  TAUTLINE_RUN(
    checkMesh({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, 0)); // cocircular: either diagonal
  TAUTLINE_RUN(checkMesh({ { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } }, 0));             // clockwise
  TAUTLINE_RUN(checkMesh({ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 2, 1 }, { 0, 4 } }, 0));   // concave
  TAUTLINE_RUN(checkMesh({ { 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 }, { 1.5, 1 } }, 0)); // collinear
  {
    // The flat quadrilateral: its short diagonal is the Delaunay one.
    const PolygonMesh mesh = triangulatePolygon({ { 0, 0 }, { 2, -0.2 }, { 4, 0 }, { 2, 0.2 } });
    TAUTLINE_EACH_OF(const auto& t, mesh.triangles,
      TAUTLINE_CHECK(
        std::count(t.begin(), t.end(), 1) == 1 && std::count(t.begin(), t.end(), 3) == 1));
  }
  // Stars with random radii, at usual and extreme places and sizes.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.2, 1.0);
  for (const double size : { 1.0, 1e-8, 1e8 })
  {
    for (int trial = 0; trial < 60; ++trial)
    {
      Context context("size " + std::to_string(size) + " trial " + std::to_string(trial));
      std::vector<Vec2> star;
      const int n = 3 + trial;
      for (int i = 0; i < n; ++i)
      {
        const double r = size * radius(random), angle = 6.283185307179586 * i / n;
        star.push_back({ r * std::cos(angle) + 3.0 * size, r * std::sin(angle) });
      }
      checkMesh(star, 1e-12 * size * size * size * size);
    }
  }
  // A nearly flat spike: exact signs keep every triangle positive.
  TAUTLINE_RUN(checkMesh({ { 0, 0 }, { 1, 1e-17 }, { 2, 0 }, { 1, 1 } }, 1e-12));

  TAUTLINE_CHECK_THROWS(triangulatePolygon({ { 0, 0 }, { 1, 0 } }), wording("at-least-3"));
  TAUTLINE_CHECK_THROWS(
    triangulatePolygon({ { 0, 0 }, { 2, 2 }, { 2, 0 }, { 0, 2 } }), wording("meets-itself"));
  TAUTLINE_CHECK_THROWS(
    triangulatePolygon({ { 0, 0 }, { 1, 0 }, { 1, 0 }, { 0, 1 } }), wording("meets-itself"));
  TAUTLINE_CHECK_THROWS(triangulatePolygon({ { 0, 0 }, { 1, 0 }, { 2, 0 } }), "");
  TAUTLINE_CHECK_THROWS(
    triangulatePolygon({ { 0, 0 }, { std::numeric_limits<double>::quiet_NaN(), 0 }, { 0, 1 } }),
    wording("not-finite"));

  const Vec2 centre = centreOfMass({ { 0, 0 }, { 6, 0 }, { 0, 3 } });
  TAUTLINE_CHECK_NEAR(centre[0], 2.0, 1e-14);
  TAUTLINE_CHECK_NEAR(centre[1], 1.0, 1e-14);
}
