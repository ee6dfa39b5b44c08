// SPDX-License-Identifier: BSD-3-Clause
// The tables of the cell types, and every metric on the ideal cell of each.
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr double rounding = 1e-14;

/// W^-1 times the corner Jacobian of the ideal cell is I.
void testIdealInverse(const CellTopology& t)
{
  const std::vector<Vec3> ideal = idealCell(t.type);
  TAUTLINE_CHECK_EQUAL(t.nodes, static_cast<int>(ideal.size()));
  for (int c = 0; c < t.corners; ++c)
  {
    Columns w = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
    for (int k = 0; k < t.dimension; ++k)
    {
      w[k] = ideal[t.cornerNodes[c][k + 1]] - ideal[t.cornerNodes[c][0]];
    }
    for (int row = 0; row < 3; ++row)
    {
      const double* inverse = &t.idealInverse[c][3 * row];
      const Vec3 inverseRow = { inverse[0], inverse[1], inverse[2] };
      TAUTLINE_EACH(
        int, k, 3, TAUTLINE_CHECK_NEAR(dot(inverseRow, w[k]), row == k ? 1.0 : 0.0, rounding));
    }
  }
}

/// Edges, faces and corners fit together, and faces look outward.
void testIncidence(const CellTopology& t)
{
  const std::vector<Vec3> ideal = idealCell(t.type);
  std::set<std::set<int>> edges;
  for (int e = 0; e < t.edges; ++e)
  {
    edges.insert({ t.edgeNodes[e][0], t.edgeNodes[e][1] });
    TAUTLINE_CHECK_NEAR(norm(ideal[t.edgeNodes[e][1]] - ideal[t.edgeNodes[e][0]]), 1, rounding);
  }
  TAUTLINE_CHECK_EQUAL(static_cast<int>(edges.size()), t.edges);
  for (int c = 0; c < t.corners; ++c)
  {
    TAUTLINE_CHECK_EQUAL(t.cornerNodes[c][0], c);
    for (int k = 1; k <= t.dimension; ++k)
    {
      TAUTLINE_CHECK_EQUAL(edges.count({ c, t.cornerNodes[c][k] }), 1u);
    }
  }
  TAUTLINE_EACH_OF(double sine, cornerSines(t.type, ideal), TAUTLINE_CHECK(sine > 0.5));
  if (t.dimension == 2)
  {
    TAUTLINE_CHECK_EQUAL(t.faces, 0);
    return;
  }
  TAUTLINE_CHECK_EQUAL(t.nodes - t.edges + t.faces, 2); // Euler
  Vec3 middle = sumOf<Vec3>({ 0, 0, 0 }, ideal, [&](const Vec3& p) { return (1.0 / t.nodes) * p; });
  std::map<std::set<int>, std::set<int>> facesOfEdge;
  for (int f = 0; f < t.faces; ++f)
  {
    const int size = t.faceSizes[f];
    const auto& n = t.faceNodes[f];
    const Vec3 normal = cross(ideal[n[1]] - ideal[n[0]], ideal[n[2]] - ideal[n[0]]);
    TAUTLINE_CHECK(dot(normal, ideal[n[0]] - middle) > 0);
    for (int k = 0; k < size; ++k)
    {
      facesOfEdge[{ n[k], n[(k + 1) % size] }].insert(f);
    }
  }
  TAUTLINE_CHECK_EQUAL(static_cast<int>(facesOfEdge.size()), t.edges);
  for (int e = 0; e < t.edges; ++e)
  {
    const std::set<int> listed = { t.edgeFaces[e][0], t.edgeFaces[e][1] };
    TAUTLINE_CHECK(facesOfEdge[std::set<int>({ t.edgeNodes[e][0], t.edgeNodes[e][1] })] == listed);
    TAUTLINE_CHECK_EQUAL(listed.size(), 2u);
  }
}

/// Facts of elementary geometry on the ideal cells; the registry covers simplices only.
struct IdealFacts
{
  CellType type;
  double size, minimumAngle, maximumAngle, sizePerDeterminant;
};

constexpr double degrees = 180 / M_PI;
const IdealFacts idealFacts[] = {
  { CellType::Triangle, std::sqrt(3.0) / 4, 60, 60, 1.0 / 2 },
  { CellType::Quadrilateral, 1, 90, 90, 1 },
  { CellType::Tetrahedron, std::sqrt(2.0) / 12, std::acos(1.0 / 3) * degrees,
    std::acos(1.0 / 3) * degrees, 1.0 / 6 },
  { CellType::Hexahedron, 1, 90, 90, 1 },
  { CellType::Wedge, std::sqrt(3.0) / 4, 60, 90, 1.0 / 2 },
  { CellType::Pyramid, std::sqrt(2.0) / 6, 54.735610317245346, 109.47122063449069, 1.0 / 3 },
};

double expectedIdeal(const MetricInfo& info, const CellTopology& t, const IdealFacts& facts)
{
  switch (info.metric)
  {
    case Metric::Size:
      return facts.size;
    case Metric::MinimumAngle:
      return facts.minimumAngle;
    case Metric::MaximumAngle:
      return facts.maximumAngle;
    case Metric::ConditioningSizeShape: // V / A_rms^2
      return std::sqrt(2.0) / 12 / (3.0 / 16);
    case Metric::InterpolationSizeShape: // A / s^3, and V 4 A / (6 A^2)
      return t.dimension == 2 ? std::sqrt(3.0) / 4 : std::sqrt(2.0) / 12 * 8 / (3 * std::sqrt(3.0));
    case Metric::MinimumJacobian:
      return facts.size / facts.sizePerDeterminant;
    case Metric::SizeUntangle: // tau = 1
      return -1 + std::sqrt(1 + Parameters().epsilon);
    case Metric::WidthRatio:
      return 2 / std::sqrt(3.0);
    default:
      return info.ideal(t.dimension);
  }
}

void testIdealValues(const CellTopology& t, const IdealFacts& facts)
{
  TAUTLINE_CHECK_NEAR(t.sizePerDeterminant, facts.sizePerDeterminant, 0);
  const std::vector<Vec3> ideal = idealCell(t.type);
  for (const MetricInfo& info : elementMetrics())
  {
    const Context context(info.name);
    const double value = valueOf(t.type, ideal, info.metric);
    if (!info.definedOn(t.type))
    {
      TAUTLINE_CHECK_EQUAL(value, 0.0);
      continue;
    }
    for (Combination combination :
      { Combination::Mean, Combination::Worst, Combination::PowerMean })
    {
      TAUTLINE_LET(EvaluationOptions, options, combination = combination);
      TAUTLINE_CHECK_NEAR(valueOf(t.type, ideal, info.metric, options),
        expectedIdeal(info, t, facts), 200 * rounding); // angles are up to 110
    }
    // The registry's own statement, wherever it makes one that holds for this type.
    const bool angle = info.metric == Metric::MinimumAngle || info.metric == Metric::MaximumAngle;
    if (!std::isnan(info.ideal(t.dimension)) && !(angle && t.samples > 1))
    {
      TAUTLINE_CHECK_NEAR(value, info.ideal(t.dimension), 200 * rounding);
    }
  }
}

TAUTLINE_PART(testTypeCodes)
{
  TAUTLINE_CHECK_EQUAL(topologies().size(), 6u);
  const int codes[] = { 5, 9, 10, 12, 13, 14 };
  for (int i = 0; i < NumberOfCellTypes; ++i)
  {
    const CellTopology& t = topologies()[i];
    TAUTLINE_CHECK_EQUAL(static_cast<int>(t.type), codes[i]);
    TAUTLINE_CHECK_EQUAL(topologyIndex(t.type), i);
    TAUTLINE_CHECK_EQUAL(topology(t.type).name, t.name);
    TAUTLINE_CHECK(cornerType(codes[i]) == t.type);
    TAUTLINE_CHECK(!isHigherOrder(codes[i]));
  }
  TAUTLINE_CHECK_EQUAL(topologyIndex(CellType::Unsupported), -1);
  TAUTLINE_CHECK_THROWS(topology(CellType::Unsupported), wording("triangles-quadrilaterals"));
  for (int none : { 0, 1, 2, 3, 4, 6, 7, 8, 11, 15, 16, 21, 35, 41, 42, 68, 255 })
  {
    TAUTLINE_CHECK(cornerType(none) == CellType::Unsupported);
    TAUTLINE_CHECK(!isHigherOrder(none));
  }
}
}

TAUTLINE_TEST(TestTopology)
{
  for (const IdealFacts& facts : idealFacts)
  {
    const CellTopology& t = topology(facts.type);
    const Context context(t.name);
    TAUTLINE_RUN(testIdealInverse(t));
    TAUTLINE_RUN(testIncidence(t));
    TAUTLINE_RUN(testIdealValues(t, facts));
  }
}
