// SPDX-License-Identifier: BSD-3-Clause
// Published values of particular elements, and identities that tie the metrics to each other.
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr double rounding = 1e-13;
constexpr double degrees = 180 / M_PI;
const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);

using Corners = std::vector<Vec3>;

struct Expectation
{
  const char* metric;
  double value;
};

void checkCell(const char* name, CellType type, const Corners& corners,
  const std::vector<Expectation>& expectations)
{
  for (const Expectation& e : expectations)
  {
    const Context context(std::string(name) + ", " + e.metric);
    const MetricInfo* info = findMetric(e.metric);
    if (TAUTLINE_CHECK(info != nullptr))
    {
      TAUTLINE_CHECK_NEAR(
        valueOf(type, corners, info->metric), e.value, rounding * std::max(1.0, std::abs(e.value)));
    }
  }
}

TAUTLINE_PART(testTriangles)
{
  checkCell("equilateral", CellType::Triangle, idealCell(CellType::Triangle),
    { { "SI", 1 / (4 * root3) }, // dissertation 2.3: the upper end of its range
      { "SS", root3 / 4 },       // 1 / (4 R), R = 1 / sqrt 3
      { "rr", root2 },           // R = 2 r
      { "ss_scale_invariant", root3 / 4 } });
  const Corners rightIsosceles = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  checkCell("right isosceles", CellType::Triangle, rightIsosceles,
    { { "rr", std::sqrt(1 + root2) }, { "rr_normalized", (1 + root2) / 2 }, { "imr", 2 / root3 },
      { "mean_ratio", root3 / 2 }, { "SI", 1.0 / 8 }, { "SS", 1 / (4 * std::sqrt(0.5)) },
      { "edge_ratio", root2 }, { "aspect_ratio", root2 * (2 + root2) / (2 * root3) },
      { "width_ratio", 1 }, { "min_angle", 45 }, { "max_angle", 90 }, { "equiangle_skew", 0.25 },
      { "scaled_jacobian", std::sqrt(0.5) * 2 / root3 }, { "size", 0.5 } });
  // Dissertation 4.5 and Figure 4.7: the aspect ratio of a right triangle is the ratio of its legs.
  checkCell("legs 4 and 1", CellType::Triangle, { { 0, 0, 0 }, { 4, 0, 0 }, { 0, 1, 0 } },
    { { "W/w", 4 }, { "edge_ratio", std::sqrt(17.0) } });
  // Legs 3 and 4, hypotenuse 5: r = 1, R = 5/2.
  checkCell("3 4 5", CellType::Triangle, { { 0, 0, 0 }, { 4, 0, 0 }, { 0, 3, 0 } },
    { { "size", 6 }, { "rr", std::sqrt(2.5) }, { "SI", 6.0 / 50 }, { "SS", 6.0 / 60 },
      { "imr", 50 / (4 * root3 * 6) }, { "aspect_ratio", 5 / (2 * root3) } });
}

TAUTLINE_PART(testTetrahedra)
{
  checkCell("regular", CellType::Tetrahedron, idealCell(CellType::Tetrahedron),
    { { "SI", 2 * root2 * std::sqrt(root3) / 9 }, // dissertation Table 2.2 in 3D
      { "size", root2 / 12 }, { "rr", root3 },    // R = 3 r
      { "ss_scale_invariant", root2 / 12 * std::pow(root3 / 1.125, 0.75) },
      { "min_angle", 70.528779365509308 } });
  // The corner of a cube: R = sqrt 3 / 2, faces 1/2 1/2 1/2 and sqrt 3 / 2.
  const double surface = 1.5 + root3 / 2, r = 0.5 / surface;
  checkCell("cube corner", CellType::Tetrahedron,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    { { "size", 1.0 / 6 }, { "rr_normalized", (1 + root3) / 2 },
      { "mean_ratio", 12 * std::pow(0.5, 2.0 / 3) / 9 }, // Liu and Joe: 12 (3 V)^(2/3) / sum l^2
      { "min_angle", std::acos(1 / root3) * degrees }, { "max_angle", 90 }, { "edge_ratio", root2 },
      { "aspect_ratio", root2 / (2 * std::sqrt(6.0) * r) }, { "equiangle_skew", 0.25 },
      { "scaled_jacobian", 0.5 * root2 }, { "SI", 1.0 / 6 / std::pow(1.5 / 4, 0.75) },
      { "si_size", 4.0 / 9 },
      // pairs: 3 edges of length 1 with areas 1/2 sqrt3/2, 3 of length sqrt 2 with 1/2 1/2
      { "SS", surface / 6 / (3 * root3 / 4 + 3 * 0.5) } });
  // Four points round a square, alternately lifted by h = 1/2: a sliver with V = 2 h / 3.
  checkCell("sliver", CellType::Tetrahedron,
    { { 1, 0, 0 }, { 0, -1, 0.5 }, { 0, 1, 0.5 }, { -1, 0, 0 } },
    { { "size", 1.0 / 3 }, { "edge_ratio", 4 / 3.0 } });
}

TAUTLINE_PART(testBlocks)
{
  checkCell("rectangle", CellType::Quadrilateral,
    { { 0, 0, 0 }, { 3, 0, 0 }, { 3, 1, 0 }, { 0, 1, 0 } },
    { { "size", 3 }, { "edge_ratio", 3 }, { "aspect_ratio", 3 }, { "imr", (3 + 1.0 / 3) / 2 },
      { "condition_number", (3 + 1.0 / 3) / 2 }, { "scaled_jacobian", 1 }, { "min_angle", 90 },
      { "max_angle", 90 }, { "equiangle_skew", 0 }, { "mu_55", 4 },
      { "mu_56", (3 + 1.0 / 3) / 2 - 1 }, { "mu_77", (3 - 1.0 / 3) * (3 - 1.0 / 3) / 2 },
      { "mu_7", (3 - 1.0 / 3) * (3 - 1.0 / 3) }, { "mu_14", 4 }, { "mu_4", 4 } });
  checkCell("rhombus of 60 degrees", CellType::Quadrilateral,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1.5, root3 / 2, 0 }, { 0.5, root3 / 2, 0 } },
    { { "size", root3 / 2 }, { "min_angle", 60 }, { "max_angle", 120 },
      { "equiangle_skew", 1.0 / 3 }, { "scaled_jacobian", root3 / 2 }, { "imr", 2 / root3 },
      { "edge_ratio", 1 } });
  // A dart: its reflex corner is inverted and has the angle 270.
  checkCell("dart", CellType::Quadrilateral, { { 0, 0, 0 }, { 3, 0, 0 }, { 1, 1, 0 }, { 0, 3, 0 } },
    { { "max_angle", 360 - 2 * std::atan2(2, -1) * degrees + 90 }, { "size", 3 } });
  checkCell("box 1 2 3", CellType::Hexahedron,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 2, 0 }, { 0, 2, 0 }, { 0, 0, 3 }, { 1, 0, 3 }, { 1, 2, 3 },
      { 0, 2, 3 } },
    { { "size", 6 }, { "edge_ratio", 3 }, { "aspect_ratio", 3 }, { "scaled_jacobian", 1 },
      { "condition_number", std::sqrt(14.0) * std::sqrt(1 + 1.0 / 4 + 1.0 / 9) / 3 },
      { "imr", 14 / (3 * std::pow(6.0, 2.0 / 3)) }, { "mu_315", 25 }, { "max_angle", 90 } });
  checkCell("right wedge of height 2", CellType::Wedge,
    { { 0, 0, 0 }, { 0.5, root3 / 2, 0 }, { 1, 0, 0 }, { 0, 0, 2 }, { 0.5, root3 / 2, 2 },
      { 1, 0, 2 } },
    { { "size", root3 / 2 }, { "edge_ratio", 2 }, { "min_angle", 60 }, { "max_angle", 90 },
      { "imr", 6 / (3 * std::pow(2.0, 2.0 / 3)) }, { "scaled_jacobian", 1 },
      { "equiangle_skew", 0 } });
  // A pyramid of height 1/2 on the unit square is a sixth of a cube.
  checkCell("sixth of a cube", CellType::Pyramid,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0.5, 0.5 } },
    { { "size", 1.0 / 6 }, { "min_angle", 45 }, { "max_angle", 120 },
      { "edge_ratio", 2 / root3 } });
}

//------------------------------------------------------------------------------
/// Identities on random valid cells.
void testIdentities(CellType type)
{
  Random random(10);
  MeshData data;
  constexpr int cells = 200;
  for (int i = 0; i < cells; ++i)
  {
    data.addCell(type, validCell(type, 0.4, 0.05, random));
  }
  const Mesh mesh(data.view());
  auto values = [&](Metric metric) { return valuesOf(mesh, metric); };
  const int n = topology(type).dimension;
  const bool simplex = topology(type).samples == 1;
  const auto imr = values(Metric::InverseMeanRatio), mr = values(Metric::MeanRatio);
  const auto condition = values(Metric::ConditionNumber), mu2 = values(Metric::ShapeBarrier);
  const auto rr = values(Metric::RadiusRatio), rrn = values(Metric::NormalizedRadiusRatio);
  const auto si = values(Metric::ConditioningScaleInvariant);
  const auto ss = values(Metric::InterpolationSizeShape);
  const auto mu301 = values(Metric::ShapeCondition), mu302 = values(Metric::ShapeConditionSquared);
  const auto mu304 = values(Metric::ShapeCubic), mu50 = values(Metric::ShapeSquared);
  const auto mu58 = values(Metric::ShapeProduct), mu4 = values(Metric::ShapeNonBarrier);
  const auto tmp = values(Metric::ShapeSimilarity), mu7 = values(Metric::ShapeSizeBarrier);
  const auto mu9 = values(Metric::ShapeSizeWeighted), size = values(Metric::Size);
  for (int i = 0; i < cells; ++i)
  {
    auto same = [&](double actual, double expected)
    { TAUTLINE_CHECK_NEAR(actual, expected, 1e-11 * std::max(1.0, std::abs(expected))); };
    same(mu2[i], imr[i] - 1); // mu_2 in 2D, mu_303 in 3D
    if (n == 2)
    {
      same(condition[i], imr[i]);
      same(tmp[i], 2 * mu4[i]); // |T - adj^t|^2 = 2 (|T|^2 - 2 tau)
    }
    else
    {
      same(mu301[i], condition[i] - 1);
      TAUTLINE_CHECK(condition[i] >= 1 - rounding);
    }
    if (!simplex)
    {
      continue; // the rest is of single corners, not of their means
    }
    same(mr[i] * imr[i], 1);
    same(rr[i] * rr[i], n * rrn[i]);
    if (n == 2)
    {
      const Vec3 a = data.point(3 * i), b = data.point(3 * i + 1), c = data.point(3 * i + 2);
      const double product = norm(b - a) * norm(c - b) * norm(a - c);
      same(ss[i], 1 / (4 * (product / (4 * size[i])))); // 1 / (4 R)
      same(si[i], 1 / (4 * root3 * imr[i]));            // |T|^2 is sum s^2 / 3 * 2 here
      same(mu50[i], 2 * imr[i] * imr[i] - 2);
      same(mu58[i], 4 * imr[i] * (imr[i] - 1));
      const double tau = size[i] / (root3 / 4);
      same(mu9[i], tau * mu7[i]);
    }
    else
    {
      same(mu302[i], condition[i] * condition[i] - 1);
      same(mu304[i], std::pow(imr[i], 1.5) - 1);
      // Euler: R >= n r; and the mean ratio bounds the radius ratio from both sides (Liu and Joe
      // 1994: eta^3 <= rho <= (27^(1/4) / 2) eta^(3/4)).
      const double rho = 1 / rrn[i], eta = mr[i];
      TAUTLINE_CHECK(rho <= 1 + rounding);
      TAUTLINE_CHECK(std::pow(eta, 3) <= rho * (1 + rounding));
      TAUTLINE_CHECK(rho <= std::pow(27.0, 0.25) / 2 * std::pow(eta, 0.75) * (1 + rounding));
    }
  }
}
}

TAUTLINE_TEST(TestMetricIdentities)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    TAUTLINE_RUN(testIdentities(type));
  }
}
