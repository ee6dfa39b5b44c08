// SPDX-License-Identifier: BSD-3-Clause
// Results are bitwise the same for any number of threads; sums over the mesh are what adding up its
// cells gives, with the gradient that finite differences give.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Mesh/MeshElements.h"

using namespace tautline;

namespace
{
constexpr int mostThreads = 4;
// Cubes along an edge of a block of tetrahedra of more than 16 chunks of 4096: renumbered at
// random, its cells are summed along a space-filling curve.
constexpr Index manyCubes = 25;
constexpr double powers[] = { 1, 2, -2, 0.5 };

/// A block whose inner points are moved by up to `amplitude`.
MeshData perturbedBlock(CellType type, Index n, double amplitude)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  Random random(23);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    Vec3 d = random.vector(-amplitude, amplitude);
    d[2] = flat ? 0 : d[2];
    data.setPoint(i, data.point(i) + d);
  }
  return data;
}

/// All types side by side, several chunks of most.
MeshData mixedBlocks()
{
  MeshData all;
  Index shift = 0;
  for (CellType type : { CellType::Hexahedron, CellType::Tetrahedron, CellType::Wedge,
         CellType::Pyramid, CellType::Triangle })
  {
    const MeshData part = perturbedBlock(type, topology(type).dimension == 2 ? 60 : 12, 0.15);
    for (Index i = 0; i < part.numberOfPoints(); ++i)
    {
      all.addPoint(part.point(i));
    }
    for (Index cell = 0; cell < part.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes = part.nodes(cell);
      std::for_each(nodes.begin(), nodes.end(), [&](Index& node) { node += shift; });
      all.addCell(type, nodes);
    }
    shift = all.numberOfPoints();
  }
  return all;
}

struct NamedMesh
{
  std::string name;
  MeshData data;
};

std::vector<NamedMesh> makeMeshes()
{
  std::vector<NamedMesh> meshes;
  meshes.push_back({ "tetrahedra", perturbedBlock(CellType::Tetrahedron, 13, 0.15) });
  meshes.push_back({ "tangled tetrahedra", perturbedBlock(CellType::Tetrahedron, 13, 0.6) });
  meshes.push_back({ "quadrilaterals", perturbedBlock(CellType::Quadrilateral, 100, 0.2) });
  meshes.push_back({ "mixed", mixedBlocks() });
  MeshData curved = perturbedBlock(CellType::Triangle, 70, 0.15);
  curved.transform(TAUTLINE_PLACE(p[0], p[1], std::sin(0.1 * p[0] * p[1])));
  meshes.push_back({ "surface", curved });
  return meshes;
}

bool applies(const MetricInfo& info, const Mesh& mesh)
{
  return info.rotationInvariant || mesh.dimension() != Dimension::Surface;
}

//------------------------------------------------------------------------------
void testEvaluation(const Mesh& mesh)
{
  std::vector<signed char> validity(mesh.view().numberOfCells), again = validity;
  mesh.classifyCells(validity.data(), 1);
  for (const MetricInfo& info : elementMetrics())
  {
    if (!applies(info, mesh))
    {
      continue;
    }
    const Context context(info.name);
    TAUTLINE_LET(EvaluationOptions, options, threads = 1);
    const std::vector<double> values = valuesOf(mesh, info.metric, options);
    const Gradients gradients = gradientsOf(mesh, info.metric, options);
    for (int threads : { 0, 2, 3, mostThreads })
    {
      options.threads = threads;
      TAUTLINE_CHECK(valuesOf(mesh, info.metric, options) == values);
      const Gradients other = gradientsOf(mesh, info.metric, options);
      TAUTLINE_CHECK(other.values == gradients.values && other.gradients == gradients.gradients);
    }
  }
  for (int threads = 0; threads <= mostThreads; ++threads)
  {
    mesh.classifyCells(again.data(), threads);
    TAUTLINE_CHECK(again == validity);
  }
}

//------------------------------------------------------------------------------
/// Sum of sign(q) |q|^p over the elements and its gradient, by hand.
double bruteSum(const MeshData& data, const Mesh& mesh, const Gradients& g, double p,
  std::vector<double>& gradient)
{
  gradient.assign(data.points.size(), 0.0);
  double sum = 0;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const double q = g.values[cell];
    if (q == 0 || !isElement(mesh, static_cast<CellType>(data.types[cell])))
    {
      continue;
    }
    sum += std::copysign(std::pow(std::abs(q), p), q);
    const double slope = p * std::pow(std::abs(q), p - 1);
    for (Index n = data.offsets[cell]; n < data.offsets[cell + 1]; ++n)
    {
      for (int c = 0; c < 3; ++c)
      {
        gradient[3 * data.connectivity[n] + c] += slope * g.gradients[3 * n + c];
      }
    }
  }
  return sum;
}

double largest(const std::vector<double>& values)
{
  return largestOf<double>(0, values, [&](double v) { return std::abs(v); });
}

const std::vector<Metric> summedMetrics = { Metric::InverseMeanRatio, Metric::Size,
  Metric::UntangleBeta, Metric::ScaledJacobian, Metric::ShapeNonBarrier };

void testSums(const MeshData& data, const std::vector<Metric>& metrics)
{
  const Mesh mesh(data.view());
  for (Metric metric : metrics)
  {
    const Context context(metricInfo(metric).name);
    const Gradients cells = gradientsOf(mesh, metric);
    for (double power : powers)
    {
      const Context name("power " + std::to_string(power));
      std::vector<double> expectedGradient;
      const double expected = bruteSum(data, mesh, cells, power, expectedGradient);
      double size = 0; // of the terms, which may cancel
      for (double q : cells.values)
      {
        size += q == 0 ? 0 : std::pow(std::abs(q), power);
      }
      std::vector<double> first;
      double firstValue = 0, firstSum = 0;
      for (int threads = 1; threads <= mostThreads; ++threads)
      {
        TAUTLINE_LET(EvaluationOptions, options, threads = threads);
        const MetricSum sum(mesh, metric, options, power);
        std::vector<double> gradient(data.points.size(), -1.0); // to be overwritten
        const double value = sum.value(), again = sum.valueAndGradient(gradient.data());
        if (threads == 1)
        {
          first = gradient;
          firstValue = value;
          firstSum = again;
          TAUTLINE_CHECK_NEAR(value, expected, 1e-12 * size);
          TAUTLINE_CHECK_NEAR(again, expected, 1e-12 * size);
          const double slack = 1e-12 * largest(expectedGradient);
          TAUTLINE_EACH(std::size_t, i, gradient.size(),
            TAUTLINE_CHECK_NEAR(gradient[i], expectedGradient[i], slack));
        }
        TAUTLINE_CHECK(value == firstValue && again == firstSum && gradient == first);
      }
    }
  }
}

/// The gradient of a sum along random directions against central differences.
TAUTLINE_PART(testDifferences)
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 6, 0.1);
  Random random(25);
  for (Metric metric : { Metric::InverseMeanRatio, Metric::MeanRatio, Metric::ShapeNonBarrier })
  {
    const Context context(metricInfo(metric).name);
    for (double power : powers)
    {
      const Mesh mesh(data.view());
      std::vector<double> gradient(data.points.size()), direction(data.points.size());
      MetricSum(mesh, metric, {}, power).valueAndGradient(gradient.data());
      std::generate(direction.begin(), direction.end(), [&]() { return random.uniform(-1, 1); });
      constexpr double step = 1e-4;
      auto at = [&](int s)
      {
        MeshData moved = data;
        for (std::size_t i = 0; i < direction.size(); ++i)
        {
          moved.points[i] += s * step * direction[i];
        }
        const Mesh movedMesh(moved.view());
        return MetricSum(movedMesh, metric, {}, power).value();
      };
      const double slope = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
      const double length =
        std::sqrt(std::inner_product(gradient.begin(), gradient.end(), gradient.begin(), 0.0));
      TAUTLINE_CHECK_NEAR(
        std::inner_product(gradient.begin(), gradient.end(), direction.begin(), 0.0), slope,
        1e-7 * length);
    }
  }
}

/// Cells that are not finite add nothing, wherever they are along the space-filling curve.
TAUTLINE_PART_SLOW(testNonFinite)
{
  const MeshData good = shuffled(perturbedBlock(CellType::Tetrahedron, manyCubes, 0.1), 26);
  MeshData bad = good;
  bad.transform([](const Vec3& p) { return p + Vec3{ 1e6, 0, 0 }; });
  const Index odd = bad.addPoint({ std::nan(""), HUGE_VAL, 0 });
  const Mesh goodMesh(good.view());
  bad.addCell(CellType::Tetrahedron, { odd, 1, 2, 3 });
  const Mesh badMesh(bad.view());
  std::vector<double> expected(good.points.size()), gradient(bad.points.size());
  const double sum =
    MetricSum(goodMesh, Metric::InverseMeanRatio, {}, 2).valueAndGradient(expected.data());
  TAUTLINE_CHECK_RELATIVE(
    MetricSum(badMesh, Metric::InverseMeanRatio, {}, 2).valueAndGradient(gradient.data()), sum,
    1e-8);
  TAUTLINE_EACH(std::size_t, i, expected.size(),
    TAUTLINE_CHECK_NEAR(gradient[i], expected[i], 1e-6 * largest(expected)));
}

/// A fan with more triangles than a coloring can have colors is rejected with a message.
TAUTLINE_PART(testExtremeVertex)
{
  constexpr Index triangles = 65 * 4096 + 1; // one more than 65 chunks of 4096
  TAUTLINE_LET(MeshData, fan, addPoint({ 0, 0, 0 }));
  for (Index i = 0; i <= triangles; ++i)
  {
    const double angle = 2 * M_PI * i / (triangles + 1);
    fan.addPoint({ std::cos(angle), std::sin(angle), 0 });
  }
  for (Index i = 0; i < triangles; ++i)
  {
    fan.addCell(CellType::Triangle, { 0, i + 1, i + 2 });
  }
  const Mesh mesh(fan.view());
  TAUTLINE_CHECK_THROWS(MetricSum(mesh, Metric::Size, {}, 1), wording("extreme-number-of-cells"));
}
}

TAUTLINE_TEST(TestThreads)
{
  for (const NamedMesh& mesh : makeMeshes())
  {
    const Context context(mesh.name);
    TAUTLINE_RUN(testEvaluation(Mesh(mesh.data.view())));
    TAUTLINE_RUN(testSums(mesh.data, summedMetrics));
    const Context order("shuffled");
    TAUTLINE_RUN(testSums(shuffled(mesh.data, 24), summedMetrics));
  }
  TAUTLINE_RUN(testSums(shuffled(perturbedBlock(CellType::Tetrahedron, manyCubes, 0.15), 27),
    { Metric::InverseMeanRatio }));
}
