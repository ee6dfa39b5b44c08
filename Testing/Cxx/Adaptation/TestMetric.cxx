// SPDX-License-Identifier: BSD-3-Clause
// Metric tensors: algebra, recovery of derivatives, the L^p metric, curvature, distance, gradation;
// and the filter that computes them.
#include "Registry.h"
#include "Surfaces.h"
#include "VtkMeshes.h"
#include "tautline/Adaptation/CurvatureMetric.h"
#include "tautline/Adaptation/LpMetric.h"
#include "tautline/Adaptation/MakeMetric.h"
#include "tautline/Adaptation/MetricEllipsoids.h"
#include "vtkMeshMetric.h"

#include "vtkPartitionedDataSet.h"

using namespace tautline;

namespace
{
using Tensors = std::vector<MetricTensor>;
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr int PointArrays = vtkDataObject::FIELD_ASSOCIATION_POINTS;

/// Orthonormal axes.
std::array<Vec3, 3> randomAxes(Random& random)
{
  Vec3 a = random.vector(-1, 1);
  a = (1 / norm(a)) * a;
  Vec3 b = cross(a, random.vector(-1, 1));
  b = (1 / norm(b)) * b;
  return { a, b, cross(a, b) };
}

/// A metric with sizes between 0.01 and 10.
MetricTensor randomMetric(Random& random)
{
  MetricAxes axes;
  axes.axes = randomAxes(random);
  for (double& value : axes.values)
  {
    value = std::pow(10, random.uniform(-2, 4));
  }
  return tensorOf(axes);
}

MetricTensor scaled(double factor, MetricTensor m)
{
  for (double& entry : m)
  {
    entry *= factor;
  }
  return m;
}

/// The largest difference of entries, relative to the largest entry.
double difference(const MetricTensor& a, const MetricTensor& b)
{
  double largest = 0, different = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    largest = std::max({ largest, std::abs(a[k]), std::abs(b[k]) });
    different = std::max(different, std::abs(a[k] - b[k]));
  }
  return largest > 0 ? different / largest : 0;
}

double size(const MetricTensor& m, const Vec3& direction)
{
  return norm(direction) / std::sqrt(squaredLength(direction, m));
}

double determinant(const MetricTensor& m)
{
  const MetricAxes axes = principalAxes(m);
  return axes.values[0] * axes.values[1] * axes.values[2];
}

/// f at each point of an adaptation mesh.
template <class T = double, class Function>
std::vector<T> valuesAt(const AdaptationMesh& mesh, const Function& f)
{
  return collect<T>(mesh.numberOfPoints(), [&](Index p) { return f(mesh.point(p)); });
}

/// A square or cube of side 1.
MeshData unitBlock(CellType type, Index n)
{
  MeshData data = blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
  data.transform([n](const Vec3& p) { return (1.0 / double(n)) * p; });
  return data;
}

/// The metric at each point of a mesh as given.
Tensors tensorsOf(const MetricResult& result)
{
  Tensors tensors(result.tensors.size() / 6);
  for (std::size_t p = 0; p < tensors.size(); ++p)
  {
    std::copy_n(&result.tensors[6 * p], 6, tensors[p].begin());
  }
  return tensors;
}

MetricOptions hessianOptions(const std::vector<double>& field)
{
  TAUTLINE_LET(MetricOptions, options, source = MetricSource::Hessian, field = field.data());
  options.limits = { 0.0, 10.0, 1000.0 };
  return options;
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testAlgebra)
{
  Random random(1);
  for (int i = 0; i < 50; ++i)
  {
    const MetricTensor m = randomMetric(random);
    TAUTLINE_CHECK(isPositiveDefinite(m) && !isPositiveDefinite(scaled(-1, m)));
    TAUTLINE_CHECK(difference(tensorOf(principalAxes(m)), m) < 1e-14);
    const MetricTensor logarithm = functionOf(m, [](double v) { return std::log(v); });
    TAUTLINE_CHECK(
      difference(functionOf(logarithm, [](double v) { return std::exp(v); }), m) < 1e-9);
    MetricAxes signs = principalAxes(m);
    signs.values[0] *= -1;
    TAUTLINE_CHECK(!isPositiveDefinite(tensorOf(signs)));
    TAUTLINE_CHECK(
      difference(functionOf(tensorOf(signs), [](double v) { return std::abs(v); }), m) < 1e-12);
    // In other coordinates lengths are the same.
    const std::array<Vec3, 3> axes = randomAxes(random);
    const Vec3 e = random.vector(-1, 1);
    const Vec3 there = { dot(axes[0], e), dot(axes[1], e), dot(axes[2], e) };
    TAUTLINE_CHECK_RELATIVE(squaredLength(there, turned(m, axes)), squaredLength(e, m), 1e-9);
  }
  TAUTLINE_CHECK(!isPositiveDefinite({ 1, 1, 1, NAN, 0, 0 }));
  TAUTLINE_CHECK(!isPositiveDefinite({ 1, 1, Infinity, 0, 0, 0 }));
  TAUTLINE_CHECK(!isPositiveDefinite({ 1, 1, 0, 0, 0, 0 }) && !isPositiveDefinite({}));
  TAUTLINE_CHECK(isPositiveDefinite(isotropicMetric(1e-150)));
  // An edge whose size grows geometrically: the integral of its inverse.
  const double first = 0.1, last = 0.7, length = 3;
  double sum = 0;
  constexpr int steps = 100000;
  for (int i = 0; i < steps; ++i)
  {
    sum += length / steps / (first * std::pow(last / first, (i + 0.5) / steps));
  }
  const Vec3 e = { 0, length, 0 };
  TAUTLINE_CHECK_RELATIVE(edgeLength(e, isotropicMetric(first), isotropicMetric(last)), sum, 1e-8);
  TAUTLINE_CHECK_RELATIVE(
    edgeLength(e, isotropicMetric(first), isotropicMetric(first)), length / first, 1e-14);
  TAUTLINE_CHECK_RELATIVE(
    edgeLength(e, isotropicMetric(1), isotropicMetric(1 + 1e-6)), length * (1 - 0.5e-6), 1e-12);
  TAUTLINE_CHECK_EQUAL(edgeLength({ 0, 0, 0 }, isotropicMetric(1), isotropicMetric(2)), 0.0);
}

TAUTLINE_PART(testIntersection)
{
  Random random(2);
  for (int i = 0; i < 50; ++i)
  {
    const MetricTensor a = randomMetric(random), b = randomMetric(random);
    const MetricTensor both = intersection(a, b);
    for (int k = 0; k < 20; ++k)
    {
      const Vec3 e = random.vector(-1, 1);
      const double larger = std::max(squaredLength(e, a), squaredLength(e, b));
      TAUTLINE_CHECK(squaredLength(e, both) >= (1 - 1e-8) * larger);
      TAUTLINE_CHECK(
        squaredLength(e, both) <= (1 + 1e-8) * (squaredLength(e, a) + squaredLength(e, b)));
    }
    TAUTLINE_CHECK(difference(intersection(b, a), both) < 1e-7);
    const std::array<Vec3, 3> axes = randomAxes(random);
    TAUTLINE_CHECK(
      difference(intersection(turned(a, axes), turned(b, axes)), turned(both, axes)) < 1e-7);
    // With a sphere the eigenvalues are the larger ones.
    const MetricTensor sphere = isotropicMetric(0.3);
    const MetricTensor larger = functionOf(a, [](double v) { return std::max(v, 1 / 0.09); });
    TAUTLINE_CHECK(difference(intersection(sphere, a), larger) < 1e-9);
    // One of them, where it is contained in the other.
    TAUTLINE_CHECK(intersection(a, a) == a && intersection(a, scaled(0.5, a)) == a);
    TAUTLINE_CHECK(intersection(a, scaled(4, a)) == scaled(4, a));
  }
  const MetricTensor mixed = intersection({ 1, 100, 4, 0, 0, 0 }, { 25, 9, 16, 0, 0, 0 });
  TAUTLINE_CHECK(difference(mixed, { 25, 100, 16, 0, 0, 0 }) < 1e-14);
}

TAUTLINE_PART(testMean)
{
  Random random(3);
  const MetricTensor a = randomMetric(random), b = randomMetric(random);
  const MetricTensor inverse = functionOf(a, [](double v) { return 1 / v; });
  TAUTLINE_CHECK(difference(logEuclideanMean({ a, inverse }, { 2, 2 }), isotropicMetric(1)) < 1e-9);
  TAUTLINE_CHECK(difference(logEuclideanMean({ a, b }, { 1, 0 }), a) < 1e-9);
  TAUTLINE_CHECK_RELATIVE(determinant(logEuclideanMean({ a, b }, { 1, 3 })),
    std::pow(determinant(a), 0.25) * std::pow(determinant(b), 0.75), 1e-8);
  const MetricTensor mean =
    logEuclideanMean({ isotropicMetric(0.1), isotropicMetric(0.4) }, { 1, 1 });
  TAUTLINE_CHECK(difference(mean, isotropicMetric(0.2)) < 1e-14);
}

TAUTLINE_PART(testLimits)
{
  const MetricTensor m = { 1 / 0.01, 1 / 4.0, 1 / 100.0, 0, 0, 0 }; // sizes 0.1, 2, 10
  const MetricTensor sizes = limited(m, { 0.5, 5, Infinity });
  TAUTLINE_CHECK(difference(sizes, { 4, 1 / 4.0, 1 / 25.0, 0, 0, 0 }) < 1e-14);
  const MetricTensor ratio = limited(m, { 0, Infinity, 10 });
  TAUTLINE_CHECK(difference(ratio, { 100, 1, 1, 0, 0, 0 }) < 1e-14);
  TAUTLINE_CHECK(limited(m, {}) == m);
  TAUTLINE_CHECK(difference(limited(ratio, { 0, Infinity, 10 }), ratio) < 1e-12);
  TAUTLINE_CHECK(difference(limited({}, { 0, 3, 10 }), isotropicMetric(3)) < 1e-14);
  // Along a normal, the larger of the other two sizes.
  Random random(4);
  const MetricTensor any = randomMetric(random);
  const std::array<Vec3, 3> axes = randomAxes(random);
  const MetricTensor flat = flattened(any, axes[2]);
  const MetricTensor before = turned(any, axes), after = turned(flat, axes);
  for (const int entry : { 0, 1, 3 })
  {
    TAUTLINE_CHECK_NEAR(after[entry], before[entry], 1e-9 * (before[0] + before[1]));
  }
  const std::array<double, 3> values = principalAxes(flat).values;
  TAUTLINE_CHECK_RELATIVE(values[1], values[0], 1e-6);
  TAUTLINE_CHECK_RELATIVE(size(flat, axes[2]), 1 / std::sqrt(values[0]), 1e-6);
  TAUTLINE_CHECK(difference(flattened(flat, axes[2]), flat) < 1e-12);
}

TAUTLINE_PART(testGrowth)
{
  const double rate = std::log(1.4);
  const Vec3 e = { 0.3, -0.2, 0.6 };
  const MetricTensor grown = grownMetric(principalAxes(isotropicMetric(0.05)), e, rate);
  TAUTLINE_CHECK(difference(grown, isotropicMetric(0.05 + rate * norm(e))) < 1e-13);
  Random random(5);
  for (int i = 0; i < 20; ++i)
  {
    const MetricTensor m = randomMetric(random);
    const MetricTensor larger = grownMetric(principalAxes(m), e, rate);
    TAUTLINE_CHECK(intersection(m, larger) == m); // no size becomes smaller
    const MetricAxes a = principalAxes(m), b = principalAxes(larger);
    TAUTLINE_CHECK(b.values[2] / b.values[0] < a.values[2] / a.values[0]);
    TAUTLINE_CHECK(grownMetric(a, e, 0.0) == tensorOf(a));
  }
}

//------------------------------------------------------------------------------
/// A quadratic with its derivatives.
struct Quadratic
{
  Vec3 slope = { 1, -2, 0.5 };
  MetricTensor second = { 2, -3, 1, 0.7, -0.4, 1.1 };
  double operator()(const Vec3& x) const
  {
    return 3 + dot(this->slope, x) + 0.5 * squaredLength(x, this->second);
  }
  Vec3 gradient(const Vec3& x) const
  {
    const MetricTensor& m = this->second;
    return this->slope +
      Vec3{ m[0] * x[0] + m[3] * x[1] + m[5] * x[2], m[3] * x[0] + m[1] * x[1] + m[4] * x[2],
        m[5] * x[0] + m[4] * x[1] + m[2] * x[2] };
  }
};

TAUTLINE_PART(testQuadraticFit)
{
  const Quadratic f;
  for (const CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const AdaptationMesh mesh(Mesh(movedBlock(type, 4, 0.2).view()));
    const std::vector<double> values = valuesAt(mesh, f);
    const std::vector<Vec3> gradients = recoverGradients(mesh, values);
    const Tensors hessians = recoverHessians(mesh, values, HessianRecovery::QuadraticFit);
    const bool flat = mesh.dimension() == 2;
    const MetricTensor expected = flat ? MetricTensor{ 2, -3, 0, 0.7, 0, 0 } : f.second;
    for (Index p = 0; p < mesh.numberOfPoints(); ++p)
    {
      Vec3 gradient = f.gradient(mesh.point(p));
      gradient[2] = flat ? 0 : gradient[2];
      TAUTLINE_CHECK_NEAR(norm(gradients[p] - gradient), 0, 1e-8);
      TAUTLINE_CHECK(difference(hessians[p], expected) < 1e-8);
    }
  }
  // Stretched cells, in a tilted plane: the derivatives along it.
  MeshData data = movedBlock(CellType::Triangle, 5, 0.2);
  const Vec3 normal = { 0.6, 0, 0.8 };
  data.transform(TAUTLINE_PLACE(0.8 * p[0], 1e-3 * p[1], -0.6 * p[0]));
  const AdaptationMesh mesh(Mesh(data.view()));
  const Tensors hessians = recoverHessians(mesh, valuesAt(mesh, f), HessianRecovery::QuadraticFit);
  const std::array<Vec3, 3> axes = { Vec3{ 0.8, 0, -0.6 }, Vec3{ 0, 1, 0 }, normal };
  const MetricTensor expected = turned(f.second, axes);
  for (const MetricTensor& hessian : hessians)
  {
    const MetricTensor found = turned(hessian, axes);
    TAUTLINE_CHECK_NEAR(found[0], expected[0], 1e-6);
    TAUTLINE_CHECK_NEAR(found[1], expected[1], 1e-3); // the field varies by 1e-6 along y
    TAUTLINE_CHECK_NEAR(found[3], expected[3], 1e-4);
    TAUTLINE_CHECK_NEAR(std::abs(found[2]) + std::abs(found[4]) + std::abs(found[5]), 0, 1e-6);
  }
  // One layer of cells does not determine the derivatives across it: they are 0, the others exact.
  const AdaptationMesh layer(Mesh(blockMesh(CellType::Hexahedron, 4, 4, 1).view()));
  const auto plane = [](const Vec3& x) { return x[0] * x[0] - 2 * x[0] * x[1] + x[2]; };
  const Tensors ofLayer =
    recoverHessians(layer, valuesAt(layer, plane), HessianRecovery::QuadraticFit);
  TAUTLINE_EACH_OF(
    const MetricTensor& m, ofLayer, TAUTLINE_CHECK(difference(m, { 2, 0, 0, -2, 0, 0 }) < 1e-8));
  const AdaptationMesh single(
    Mesh(singleCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron)).view()));
  const Tensors ofSingle = recoverHessians(single,
    valuesAt(single, [](const Vec3& x) { return x[0] - x[2]; }), HessianRecovery::QuadraticFit);
  TAUTLINE_EACH_OF(const MetricTensor& m, ofSingle,
    TAUTLINE_CHECK(largestOf(0.0, m, [](double entry) { return std::abs(entry); }) < 1e-12));
}

/// The root mean square error of the Hessian of a wave in the middle of a smoothly graded square or
/// cube, relative.
double projectionError(CellType type, Index n)
{
  MeshData data = unitBlock(type, n);
  data.transform(
    [](const Vec3& p)
    {
      const double shift = 0.1 * std::sin(Pi * p[0]) * std::sin(Pi * p[1]);
      return p + Vec3{ shift, -shift, 0 };
    });
  const AdaptationMesh mesh(Mesh(data.view()));
  const Tensors found = recoverHessians(mesh,
    valuesAt(mesh, [](const Vec3& x) { return std::sin(2 * x[0]) * std::cos(x[1]); }),
    HessianRecovery::DoubleProjection);
  double error = 0, total = 0;
  for (Index p = 0; p < mesh.numberOfPoints(); ++p)
  {
    const Vec3 x = mesh.point(p);
    const double s = std::sin(2 * x[0]), c = std::cos(2 * x[0]);
    const MetricTensor exact = { -4 * s * std::cos(x[1]), -s * std::cos(x[1]), 0,
      -2 * c * std::sin(x[1]), 0, 0 };
    const bool middle = std::all_of(
      x.begin(), x.begin() + mesh.dimension(), [](double y) { return y > 0.25 && y < 0.75; });
    for (std::size_t k = 0; middle && k < exact.size(); ++k)
    {
      error += (found[p][k] - exact[k]) * (found[p][k] - exact[k]);
      total += exact[k] * exact[k];
    }
  }
  return std::sqrt(error / total);
}

TAUTLINE_PART(testProjection)
{
  for (const auto& [type, n] :
    { std::pair(CellType::Triangle, Index(16)), std::pair(CellType::Tetrahedron, Index(8)) })
  {
    const double coarse = projectionError(type, n), fine = projectionError(type, 2 * n);
    TAUTLINE_CHECK(fine < 0.6 * coarse); // first order is 0.5
    TAUTLINE_CHECK(fine < 0.1);
  }
  // Also on the boundary, a quadratic has one Hessian where the mesh is regular.
  const AdaptationMesh mesh(Mesh(unitBlock(CellType::Triangle, 8).view()));
  const Tensors found =
    recoverHessians(mesh, valuesAt(mesh, Quadratic()), HessianRecovery::DoubleProjection);
  TAUTLINE_CHECK(difference(found[0], { 2, -3, 0, 0.7, 0, 0 }) < 1e-9);
  const AdaptationMesh hexahedra(Mesh(unitBlock(CellType::Hexahedron, 2).view()));
  TAUTLINE_CHECK_THROWS(
    recoverHessians(hexahedra, std::vector<double>(27, 0.0), HessianRecovery::DoubleProjection),
    wording("the-double-projection-takes"));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testLpMetric)
{
  const AdaptationMesh mesh(Mesh(unitBlock(CellType::Triangle, 8).view()));
  const auto count = static_cast<std::size_t>(mesh.numberOfPoints());
  // A constant Hessian has a constant metric of the same shape, with any norm.
  const Tensors constant(count, { 2, 8, 2, 0, 0, 0 });
  for (const double norm : { 1.0, 2.0, Infinity })
  {
    const LpMetric metric(mesh, constant, norm, {});
    const Tensors found = metric.at(metric.factorFor(mesh.volumes(), 400));
    TAUTLINE_CHECK_RELATIVE(complexity(mesh, found), 400, 1e-9);
    TAUTLINE_CHECK_RELATIVE(expectedElements(mesh, found), 400 * 4 / std::sqrt(3.0), 1e-9);
    TAUTLINE_CHECK(difference(found[0], { 200, 800, 200, 0, 0, 0 }) < 1e-9);
  }
  // Where the Hessian is 16 times as large, the size is 16^(p / (2 p + d)) times as small.
  Tensors two(count, isotropicMetric(1));
  two[0] = scaled(16, two[0]);
  for (const auto& [norm, expected] :
    { std::pair(1.0, 2.0), std::pair(2.0, std::pow(16, 1 / 3.0)), std::pair(Infinity, 4.0) })
  {
    const Tensors found = LpMetric(mesh, two, norm, {}).at(1.0);
    TAUTLINE_CHECK_RELATIVE(std::sqrt(found[0][0] / found[1][0]), expected, 1e-9);
  }
  // With limits, the target follows from the limited metric.
  Random random(6);
  Tensors any(count);
  std::generate(any.begin(), any.end(),
    [&] {
      return flattened(randomMetric(random), { 0, 0, 1 });
    });
  const MetricLimits limits = { 0.01, 0.3, 5 };
  const LpMetric metric(mesh, any, 2, limits);
  const Tensors found = metric.at(metric.factorFor(mesh.volumes(), 300));
  TAUTLINE_CHECK_RELATIVE(complexity(mesh, found), 300, 1e-9);
  const MetricExtremes extremes = extremesOf(mesh, found);
  TAUTLINE_CHECK(extremes.smallest >= 0.01 * (1 - 1e-9) && extremes.largest <= 0.3 * (1 + 1e-9));
  TAUTLINE_CHECK(extremes.ratio <= 5 * (1 + 1e-9));
  const Tensors most = metric.at(metric.factorFor(mesh.volumes(), 1e30));
  TAUTLINE_CHECK_RELATIVE(complexity(mesh, most), 1 / (0.01 * 0.01), 1e-9);
  const Tensors least = metric.at(metric.factorFor(mesh.volumes(), 1e-30));
  TAUTLINE_CHECK_RELATIVE(complexity(mesh, least), 1 / (0.3 * 0.3), 1e-9);
}

TAUTLINE_PART(testHessianSource)
{
  // x^2 varies along x only: along y the size is the largest one.
  const MeshData data = unitBlock(CellType::Triangle, 10);
  const auto field = [&data](const auto& f)
  { return collect<double>(data.numberOfPoints(), [&](Index p) { return f(data.point(p)); }); };
  const std::vector<double> square = field([](const Vec3& x) { return x[0] * x[0]; });
  const Mesh mesh(data.view());
  MetricOptions options = hessianOptions(square);
  TAUTLINE_SET(options, limits.largest = 0.5, target = MetricTarget::Complexity, targetValue = 100);
  for (const MetricTensor& m : tensorsOf(makeMetric(mesh, options)))
  {
    TAUTLINE_CHECK_RELATIVE(m[0], 50.0 * 50.0, 1e-4);
    TAUTLINE_CHECK_RELATIVE(m[1], 4.0, 1e-4);
    TAUTLINE_CHECK_NEAR(m[3], 0, 1e-2);
  }
  // Errors of x^2 + y^2 and x^2 + y^2 + z^2, by each norm.
  const auto sum = [](const Vec3& x) { return dot(x, x); };
  const auto sizeFor = [&](CellType type, double norm, double error)
  {
    const MeshData block = unitBlock(type, 4);
    const std::vector<double> values =
      collect<double>(block.numberOfPoints(), [&](Index p) { return sum(block.point(p)); });
    TAUTLINE_LET(MetricOptions, o, source = MetricSource::Hessian, field = values.data(),
      norm = norm, target = MetricTarget::Error, targetValue = error);
    o.limits = { 0, 10, 1000 };
    return makeMetric(Mesh(block.view()), o).extremes.smallest;
  };
  TAUTLINE_CHECK_RELATIVE(sizeFor(CellType::Triangle, Infinity, 0.01), std::sqrt(0.03), 1e-6);
  TAUTLINE_CHECK_RELATIVE(sizeFor(CellType::Triangle, 2, 0.01), std::sqrt(0.04), 1e-6);
  TAUTLINE_CHECK_RELATIVE(
    sizeFor(CellType::Tetrahedron, Infinity, 0.01), std::sqrt(0.08 / 3), 1e-6);
  TAUTLINE_CHECK_RELATIVE(sizeFor(CellType::Hexahedron, 2, 0.01), std::sqrt(0.1 / 3), 1e-6);

  // The target holds after the gradation; the unit of the field and rotations do not matter.
  const auto front = [](const Vec3& x) { return std::tanh(8 * (x[0] - 0.4 * x[1] - 0.3)); };
  const std::vector<double> steep = field(front),
                            large = field([&](const Vec3&x) { return 1e200 * front(x); });
  options = hessianOptions(steep);
  TAUTLINE_SET(options, gradation = 1.5, targetValue = 3000);
  options.limits = { 1e-4, 0.3, 100 };
  const MetricResult result = makeMetric(mesh, options);
  TAUTLINE_CHECK_RELATIVE(result.elements, 3000, 0.011);
  TAUTLINE_CHECK(result.extremes.ratio > 3 && result.gradation.complete && result.note.empty());
  const Tensors tensors = tensorsOf(result);
  options.field = large.data();
  const Tensors other = tensorsOf(makeMetric(mesh, options));
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  MeshData rotated = data;
  rotated.transform(TAUTLINE_PLACE(c * p[0] - s * p[1] + 5, s * p[0] + c * p[1], 0.0));
  // The gradation takes neighbors in the order of their coordinates, which changes.
  TAUTLINE_SET(options, field = steep.data(), gradation = 0);
  const Tensors plain = tensorsOf(makeMetric(mesh, options));
  const Tensors turnedTensors = tensorsOf(makeMetric(Mesh(rotated.view()), options));
  const std::array<Vec3, 3> back = { Vec3{ c, s, 0 }, Vec3{ -s, c, 0 }, Vec3{ 0, 0, 1 } };
  for (std::size_t p = 0; p < tensors.size(); ++p)
  {
    TAUTLINE_CHECK(difference(tensors[p], other[p]) < 1e-5);
    TAUTLINE_CHECK(difference(plain[p], turned(turnedTensors[p], back)) < 1e-4);
  }
  // A linear field, also with rounding, has the largest size; several components are intersected.
  const std::vector<double> linear = field([](const Vec3& x) { return 1e6 + x[0] - x[1]; });
  options.field = linear.data();
  const MetricResult flat = makeMetric(mesh, options);
  TAUTLINE_CHECK_RELATIVE(flat.extremes.smallest, 0.3, 1e-9);
  TAUTLINE_CHECK(contains(flat.note, wording("the-field-is-linear")));
  std::vector<double> both;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 x = data.point(p);
    both.insert(both.end(), { x[0] * x[0], x[1] * x[1] });
  }
  options = hessianOptions(both);
  TAUTLINE_SET(options, fieldComponents = 2, target = MetricTarget::Complexity, targetValue = 100);
  TAUTLINE_EACH_OF(const MetricTensor& m, tensorsOf(makeMetric(mesh, options)),
    TAUTLINE_CHECK(difference(m, isotropicMetric(0.1)) < 1e-6));
}

TAUTLINE_PART(testSources)
{
  const MeshData data = unitBlock(CellType::Triangle, 4);
  const Mesh mesh(data.view());
  std::vector<double> sizes(data.numberOfPoints(), 0.2);
  MetricOptions options;
  options.source = MetricSource::Sizes;
  options.sizes = { sizes.data(), 1 };
  options.limits = { 0, 1, 10 };
  TAUTLINE_CHECK_RELATIVE(makeMetric(mesh, options).complexity, 25, 1e-9);
  // The metric of others is intersected, and the limits come after it.
  const std::vector<double> others(data.numberOfPoints(), 0.05);
  options.others = { others.data(), 1 };
  TAUTLINE_CHECK_RELATIVE(makeMetric(mesh, options).extremes.largest, 0.05, 1e-9);
  options.limits.smallest = 0.1;
  TAUTLINE_CHECK_RELATIVE(makeMetric(mesh, options).extremes.largest, 0.1, 1e-9);
  const auto rejected = [&](const char* text, const auto& change)
  {
    MetricOptions wrong = options;
    change(wrong);
    TAUTLINE_CHECK_THROWS(makeMetric(mesh, wrong), text);
  };
  rejected(wording("the-largest-size-is"), [](MetricOptions& o) { o.limits.largest = 0; });
  rejected(wording("the-smallest-size-is"), [](MetricOptions& o) { o.limits.smallest = 2; });
  rejected(
    wording("the-largest-ratio-of-sizes-is"), [](MetricOptions& o) { o.limits.ratio = NAN; });
  rejected(
    wording("the-growth-factor-of-the-gradation"), [](MetricOptions& o) { o.gradation = 0.5; });
  rejected(wording("sizes-are-needed"), [](MetricOptions& o) { o.sizes = {}; });
  rejected(
    wording("a-field-is-needed"), [](MetricOptions& o) { o.source = MetricSource::Hessian; });
  for (const double wrong : { 0.0, -1.0, Infinity, double(NAN) })
  {
    sizes[3] = wrong;
    TAUTLINE_CHECK_THROWS(makeMetric(mesh, options), wording("sizes-are-not-positive-numbers"));
  }
  std::vector<double> tensors(6 * data.numberOfPoints(), 1.0);
  options.sizes = { tensors.data(), 6 };
  options.others = {};
  TAUTLINE_CHECK_THROWS(
    makeMetric(mesh, options), wording("metric-tensors-are-not-positive-definite"));
  MeshData lines;
  lines.addPoints({ { 0, 0, 0 }, { 1, 0, 0 } });
  lines.addCell(3, { 0, 1 });
  TAUTLINE_CHECK_THROWS(AdaptationMesh(Mesh(lines.view())), wording("there-is-no-element-give"));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testCurvature)
{
  const double error = 1e-3, largest = 2;
  const double ofUnit = std::sqrt(8 * error);
  for (const CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    const AdaptationMesh sphere(Mesh(sphereSurface(type, 16).view()));
    const Tensors metrics = curvatureMetrics(sphere, error, 40, largest);
    for (Index p = 0; p < sphere.numberOfPoints(); ++p)
    {
      const Vec3 n = sphere.point(p);
      for (const Vec3& t : { cross(n, Vec3{ 1, 0.3, 0 }), cross(n, Vec3{ 0, 0.2, 1 }) })
      {
        TAUTLINE_CHECK_RELATIVE(size(metrics[p], t), ofUnit, 0.03);
      }
    }
  }
  // A cylinder of radius 1 and height 2: flat along its axis and on its ends.
  const AdaptationMesh cylinder(Mesh(cylinderSurface(48, 16).view()));
  const Tensors ofCylinder = curvatureMetrics(cylinder, error, 40, largest);
  for (Index p = 0; p < cylinder.numberOfPoints(); ++p)
  {
    const Vec3 x = cylinder.point(p), radial = { x[0], x[1], 0 };
    const bool onSide = norm(radial) > 0.99, inside = x[2] > 0.01 && x[2] < 1.99;
    if (onSide)
    {
      TAUTLINE_CHECK_RELATIVE(size(ofCylinder[p], cross(radial, { 0, 0, 1 })), ofUnit, 0.03);
    }
    if (onSide && inside)
    {
      TAUTLINE_CHECK(size(ofCylinder[p], { 0, 0, 1 }) > 3 * ofUnit);
    }
    if (!onSide)
    {
      TAUTLINE_CHECK(difference(ofCylinder[p], isotropicMetric(largest)) < 1e-9);
    }
  }
  // A quarter of a pipe of the radii 1 and 2, a volume: inside it the largest size.
  MeshData data = blockMesh(CellType::Hexahedron, 4, 12, 4);
  data.transform(
    [](const Vec3& p)
    {
      const double r = 1 + p[0] / 4, a = Pi / 2 * p[1] / 12;
      return Vec3{ r * std::cos(a), r * std::sin(a), p[2] / 4 };
    });
  const AdaptationMesh pipe(Mesh(data.view()));
  const Tensors ofPipe = curvatureMetrics(pipe, error, 40, largest);
  for (Index p = 0; p < pipe.numberOfPoints(); ++p)
  {
    const Vec3 x = pipe.point(p), radial = { x[0], x[1], 0 };
    const double r = norm(radial);
    const bool curved = r < 1.01 || r > 1.99;
    const double expected = curved ? std::sqrt(8 * error * r) : largest;
    TAUTLINE_CHECK_RELATIVE(size(ofPipe[p], cross(radial, { 0, 0, 1 })), expected, 0.06);
    TAUTLINE_CHECK(size(ofPipe[p], { 0, 0, 1 }) > 0.3);
  }
  // The border of a planar ring, where the circle through three points is exact.
  MeshData ring = blockMesh(CellType::Quadrilateral, 36, 3, 0);
  ring.transform(
    [](const Vec3& p)
    {
      const double a = Pi * p[0] / 36, r = 1 + p[1] / 3;
      return Vec3{ r * std::cos(a), r * std::sin(a), 0 };
    });
  const AdaptationMesh half(Mesh(ring.view()));
  const Tensors ofHalf = curvatureMetrics(half, error, 40, largest);
  for (Index p = 0; p < half.numberOfPoints(); ++p)
  {
    const Vec3 x = half.point(p);
    const double r = norm(x);
    const bool curved = (r < 1.01 || r > 1.99) && x[1] > 0.01;
    TAUTLINE_CHECK_RELATIVE(
      size(ofHalf[p], cross(x, { 0, 0, 1 })), curved ? std::sqrt(8 * error * r) : largest, 1e-9);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testDistance)
{
  // A slab of 10 x 4 x 4: the distance from x = 0, and from all sides.
  for (const CellType type : { CellType::Hexahedron, CellType::Tetrahedron })
  {
    const AdaptationMesh mesh(Mesh(blockMesh(type, 10, 4, 4).view()));
    std::vector<unsigned char> marks;
    for (Index p = 0; p < mesh.numberOfPoints(); ++p)
    {
      marks.push_back(mesh.point(p)[0] == 0);
    }
    const std::vector<double> distances = wallDistances(mesh, marks), all = wallDistances(mesh, {});
    const LayerSizes sizes = { 0.01, 1.2, 50 };
    const Tensors metrics = distanceMetrics(mesh, distances, sizes);
    for (Index p = 0; p < mesh.numberOfPoints(); ++p)
    {
      const Vec3 x = mesh.point(p);
      TAUTLINE_CHECK_NEAR(distances[p], x[0], 1e-12);
      TAUTLINE_CHECK_NEAR(
        all[p], std::min({ x[0], 10 - x[0], x[1], 4 - x[1], x[2], 4 - x[2] }), 1e-12);
      const double across = 0.01 + 0.2 * x[0], along = std::max(0.5, across);
      TAUTLINE_CHECK_RELATIVE(size(metrics[p], { 1, 0, 0 }), across, 1e-6);
      TAUTLINE_CHECK_RELATIVE(size(metrics[p], { 0, 1, 0 }), along, 1e-6);
      TAUTLINE_CHECK_RELATIVE(size(metrics[p], { 0, 0, 1 }), along, 1e-6);
    }
    TAUTLINE_CHECK_THROWS(wallDistances(mesh, std::vector<unsigned char>(marks.size(), 0)),
      wording("no-facet-of-the-boundary"));
  }
  const AdaptationMesh closed(Mesh(sphereSurface(CellType::Triangle, 3).view()));
  TAUTLINE_CHECK_THROWS(wallDistances(closed, {}), wording("the-mesh-is-closed"));
  // On a surface the border counts.
  MeshData data = unitBlock(CellType::Triangle, 6);
  data.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[0] * p[0]));
  const AdaptationMesh surface(Mesh(data.view()));
  TAUTLINE_CHECK_NEAR(
    smallestOf(1.0, wallDistances(surface, {}), [](double d) { return d; }), 0, 1e-12);
  TAUTLINE_CHECK(largestOf(0.0, wallDistances(surface, {}), [](double d) { return d; }) > 0.4);
}

//------------------------------------------------------------------------------
/// Whether the metrics of neighbors differ at most by the growth.
void checkGraded(const AdaptationMesh& mesh, const Tensors& metrics, double growth)
{
  Random random(7);
  const double rate = std::log(growth);
  for (Index p = 0; p < mesh.numberOfPoints(); ++p)
  {
    for (const Index q : mesh.neighbors(p))
    {
      MetricTensor grown =
        grownMetric(principalAxes(metrics[q]), mesh.point(p) - mesh.point(q), rate);
      grown = mesh.dimension() == 2 ? flattened(grown, mesh.normals()[p]) : grown;
      const Vec3 e = random.vector(-1, 1);
      TAUTLINE_CHECK(squaredLength(e, grown) <= (1 + 1e-6) * squaredLength(e, metrics[p]));
    }
  }
}

TAUTLINE_PART(testGradation)
{
  // Sizes along a strip grow from its left end by the logarithm of the factor.
  const AdaptationMesh strip(Mesh(blockMesh(CellType::Triangle, 40, 1, 0).view()));
  Tensors metrics = valuesAt<MetricTensor>(
    strip, [](const Vec3& x) { return isotropicMetric(x[0] == 0 ? 0.1 : 100.0); });
  const GradationResult result = gradeMetrics(strip, 1.3, metrics);
  TAUTLINE_CHECK(result.complete && result.rounds == 40);
  for (Index p = 0; p < strip.numberOfPoints(); ++p)
  {
    const double expected = 0.1 + std::log(1.3) * strip.point(p)[0];
    TAUTLINE_CHECK(difference(metrics[p], isotropicMetric(expected)) < 1e-6);
  }
  // Random metrics of a cube and of a surface.
  const MeshData data = movedBlock(CellType::Tetrahedron, 4, 0.2);
  for (const MeshData& each : { data, sphereSurface(CellType::Triangle, 6) })
  {
    const AdaptationMesh mesh(Mesh(each.view()));
    Random random(8);
    Tensors given(mesh.numberOfPoints());
    std::generate(given.begin(), given.end(), [&] { return randomMetric(random); });
    limitMetrics(mesh, { 0.01, 10, 100 }, given);
    Tensors graded = given;
    const GradationResult first = gradeMetrics(mesh, 1.5, graded);
    TAUTLINE_CHECK(first.complete && first.rounds > 1);
    checkGraded(mesh, graded, 1.5);
    TAUTLINE_CHECK(extremesOf(mesh, graded).smallest >= 0.9 * extremesOf(mesh, given).smallest);
    Index changed = 0;
    for (std::size_t p = 0; p < given.size(); ++p)
    {
      changed += graded[p] != given[p];
      for (int k = 0; k < 5; ++k)
      {
        const Vec3 e = random.vector(-1, 1);
        TAUTLINE_CHECK(squaredLength(e, graded[p]) >= (1 - 1e-8) * squaredLength(e, given[p]));
      }
    }
    TAUTLINE_CHECK(changed > 10);
    Tensors again = graded;
    TAUTLINE_CHECK_EQUAL(gradeMetrics(mesh, 1.5, again).rounds, 0);
    TAUTLINE_CHECK(again == graded);
  }
  Tensors any(strip.numberOfPoints(), isotropicMetric(1));
  TAUTLINE_CHECK_THROWS(
    gradeMetrics(strip, 1.0, any), wording("the-growth-factor-of-the-gradation"));
}

/// Results are the same with any number of threads, and in any order of points and cells.
TAUTLINE_PART(testOrder)
{
  const MeshData data = movedBlock(CellType::Tetrahedron, 5, 0.2);
  constexpr unsigned seed = 9;
  const MeshData other = shuffled(data, seed);
  const std::vector<Index> newId = Random(seed).permutation(data.numberOfPoints());
  const auto field = [](const MeshData& mesh)
  {
    return collect<double>(mesh.numberOfPoints(),
      [&](Index p)
      {
        const Vec3 x = mesh.point(p);
        return std::tanh(x[0] + 0.3 * x[1] - 2) + 0.01 * x[2] * x[2];
      });
  };
  const std::vector<double> values = field(data), shuffledValues = field(other);
  for (const MetricSource source :
    { MetricSource::Hessian, MetricSource::Curvature, MetricSource::Distance })
  {
    MetricOptions options = hessianOptions(values);
    TAUTLINE_SET(options, source = source, gradation = 1.4, chordError = 0.01, threads = 1);
    options.layers = { 0.05, 1.3, 10 };
    const Tensors one = tensorsOf(makeMetric(Mesh(data.view()), options));
    TAUTLINE_CHECK(
      std::any_of(one.begin(), one.end(), [&](const MetricTensor& m) { return m != one[0]; }));
    options.threads = 4;
    TAUTLINE_CHECK(tensorsOf(makeMetric(Mesh(data.view()), options)) == one);
    options.field = shuffledValues.data();
    const Tensors shuffledTensors = tensorsOf(makeMetric(Mesh(other.view()), options));
    for (std::size_t p = 0; p < one.size(); ++p)
    {
      const MetricTensor& same = shuffledTensors[newId[p]];
      TAUTLINE_CHECK(
        source == MetricSource::Curvature ? difference(same, one[p]) < 1e-9 : same == one[p]);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testEllipsoids)
{
  std::vector<double> places;
  std::vector<Index> numbers;
  for (Index i = 0; i < 30 * 30; ++i)
  {
    places.insert(places.end(), { double(i % 30), double(i / 30), 0 });
    numbers.push_back(i);
  }
  TAUTLINE_CHECK(spreadPoints(places.data(), numbers, 900) == numbers);
  const std::vector<Index> some = spreadPoints(places.data(), numbers, 100);
  TAUTLINE_CHECK(some.size() > 50 && some.size() <= 100);
  TAUTLINE_CHECK_EQUAL(spreadPoints(places.data(), numbers, 1).size(), 1u);
  TAUTLINE_CHECK(spreadPoints(places.data(), numbers, 0).empty());
  MetricEllipsoids ellipsoids;
  const MetricTensor m = { 100, 25, 4, 0, 0, 0 }; // sizes 0.1, 0.2, 0.5
  addEllipsoid(7, { 1, 2, 3 }, m, nullptr, 2, ellipsoids);
  TAUTLINE_CHECK_RELATIVE(ellipsoids.sizes[0], std::cbrt(0.01), 1e-12);
  TAUTLINE_CHECK_RELATIVE(ellipsoids.ratios[0], 5, 1e-12);
  TAUTLINE_CHECK_EQUAL(ellipsoids.centers[0], 7);
  MetricEllipsoids extreme;
  addEllipsoid(0, { 0, 0, 0 }, isotropicMetric(1e120), nullptr, 1, extreme);
  TAUTLINE_CHECK_RELATIVE(extreme.sizes[0], 1e120, 1e-12);
  for (std::size_t i = 0; i < ellipsoids.points.size(); i += 3)
  {
    const Vec3 e =
      Vec3{ ellipsoids.points[i], ellipsoids.points[i + 1], ellipsoids.points[i + 2] } -
      Vec3{ 1, 2, 3 };
    TAUTLINE_CHECK_RELATIVE(squaredLength(e, m), 4, 1e-9); // twice the length 1
  }
  // A flat one lies along the plane.
  const Vec3 normal = { 0, 0, 1 };
  MetricEllipsoids flat;
  addEllipsoid(0, { 0, 0, 0 }, flattened(m, normal), &normal, 1, flat);
  const double high =
    largestOf(0.0, flat.points.size() / 3, [&](std::size_t i) { return flat.points[3 * i + 2]; });
  TAUTLINE_CHECK(high > 0.005 && high <= 0.01 * (1 + 1e-9));
  TAUTLINE_CHECK_RELATIVE(flat.sizes[0], std::sqrt(0.02), 1e-12);
  TAUTLINE_CHECK_EQUAL(flat.pointsOfEach(), ellipsoids.pointsOfEach());
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnstructuredGrid> gridWithField(const MeshData& data, int type = VTK_DOUBLE)
{
  const auto grid = toGrid(data, type);
  const auto field = [&data](const auto& f)
  { return [&data, f](Index p) { return f(data.point(p)); }; };
  const Index count = data.numberOfPoints();
  TAUTLINE_SET(grid->GetPointData(),
    AddArray(filledArray<vtkDoubleArray>(
      "u", count, field([](const Vec3& x) { return std::tanh(9 * (x[0] - 0.5)); }))),
    AddArray(filledArray<vtkDoubleArray>(
      "size", count, field([](const Vec3& x) { return 0.05 + 0.1 * x[0]; }))),
    AddArray(
      filledArray<vtkIntArray>("wall", count, field([](const Vec3& x) { return x[0] == 0; }))));
  TAUTLINE_NEW(vtkDoubleArray, vectors, SetName("V"), SetNumberOfComponents(3),
    SetNumberOfTuples(count), Fill(1.0));
  grid->GetPointData()->AddArray(vectors);
  return grid;
}

MetricTensor tensorAt(vtkAlgorithm* filter, Index p, const char* name = "Metric")
{
  MetricTensor m;
  for (int c = 0; c < 6; ++c)
  {
    m[c] = component(outputOf<>(filter)->GetPointData(), name, p, c);
  }
  return m;
}

TAUTLINE_PART(testFilter)
{
  const MeshData data = unitBlock(CellType::Triangle, 12);
  const auto grid = gridWithField(data);
  TAUTLINE_NEW(vtkMeshMetric, filter, SetInputData(grid), SetSource(vtkMeshMetric::HESSIAN),
    SetInputArrayToProcess(1, 0, 0, PointArrays, "u"), SetTargetValue(2000),
    SetMaximumEllipsoids(40));
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_RELATIVE(filter->GetElements(), 2000, 0.011);
  TAUTLINE_CHECK_RELATIVE(
    filter->GetComplexity(), filter->GetElements() * std::sqrt(3.0) / 4, 1e-9);
  TAUTLINE_CHECK(filter->GetSmallestFound() < 0.05 && filter->GetLargestFound() <= 0.142);
  vtkDataArray* tensors = outputOf<>(filter)->GetPointData()->GetTensors();
  TAUTLINE_CHECK(tensors && std::string(tensors->GetName()) == "Metric");
  TAUTLINE_CHECK_EQUAL(tensors->GetNumberOfComponents(), 6);
  TAUTLINE_CHECK(outputOf<>(filter)->GetPointData()->GetArray("u"));
  vtkPolyData* ellipsoids = filter->GetEllipsoids();
  TAUTLINE_CHECK(ellipsoids->GetNumberOfPoints() > 0 && ellipsoids->GetNumberOfCells() > 0);
  std::set<double> centers;
  for (vtkIdType p = 0; p < ellipsoids->GetNumberOfPoints(); ++p)
  {
    centers.insert(component(ellipsoids->GetPointData(), "PointId", p));
  }
  TAUTLINE_CHECK(centers.size() > 15 && centers.size() <= 40);
  // Chained: the metric of sizes is intersected with the metric of the Hessian.
  TAUTLINE_NEW(vtkMeshMetric, chained, SetInputConnection(filter->GetOutputPort()),
    SetSource(vtkMeshMetric::SIZES), SetInputArrayToProcess(0, 0, 0, PointArrays, "size"),
    SetInputArrayToProcess(4, 0, 0, PointArrays, "Metric"), SetGradation(0), Update());
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const MetricTensor expected =
      intersection(isotropicMetric(0.05 + 0.1 * data.point(p)[0]), tensorAt(filter, p));
    const MetricTensor found = tensorAt(chained, p);
    for (const int k : { 0, 1, 3 })
    {
      TAUTLINE_CHECK_NEAR(found[k], expected[k], 1e-6 * (expected[0] + expected[1]));
    }
  }
  // Walls by marks, and the name of the array.
  TAUTLINE_NEW(vtkMeshMetric, walls, SetInputData(grid), SetSource(vtkMeshMetric::DISTANCE),
    SetInputArrayToProcess(3, 0, 0, PointArrays, "wall"), SetWallSize(0.01), SetWallGrowth(1.25),
    SetGradation(0), SetArrayName("Layers"), Update());
  TAUTLINE_CHECK_RELATIVE(size(tensorAt(walls, 6, "Layers"), { 1, 0, 0 }), 0.01 + 0.25 * 0.5, 1e-6);
}

/// Blocks, partitions, precision and the unit of length.
TAUTLINE_PART(testFilterData)
{
  const MeshData data = unitBlock(CellType::Tetrahedron, 4);
  const auto make = [](vtkDataObject* input)
  {
    return TAUTLINE_CHANGED(vtkSmartPointer<vtkMeshMetric>::New(), SetInputDataObject(0, input),
      SetSource(vtkMeshMetric::DISTANCE), SetTangentialRatio(8), Update());
  };
  const auto whole = make(gridWithField(data));
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, gridWithField(data)),
    SetBlock(2, gridWithField(data)));
  const auto two = make(blocks);
  TAUTLINE_CHECK_RELATIVE(two->GetElements(), 2 * whole->GetElements(), 1e-12);
  TAUTLINE_CHECK(contains(two->GetSummary(), "In block 3: "));
  TAUTLINE_CHECK_EQUAL(two->GetSmallestFound(), whole->GetSmallestFound());
  const auto single = make(gridWithField(data, VTK_FLOAT));
  TAUTLINE_CHECK(difference(tensorAt(single, 31), tensorAt(whole, 31)) < 1e-4);
  MeshData tiny = data;
  const double unit = std::ldexp(1.0, -100);
  tiny.transform([unit](const Vec3& p) { return unit * p; });
  const auto small = make(toGrid(tiny));
  TAUTLINE_CHECK(difference(scaled(unit * unit, tensorAt(small, 31)), tensorAt(whole, 31)) < 1e-9);
  TAUTLINE_CHECK_RELATIVE(small->GetElements(), whole->GetElements(), 1e-9);
  TAUTLINE_CHECK_RELATIVE(small->GetSmallestFound(), unit * whole->GetSmallestFound(), 1e-9);
  tiny.transform([](const Vec3& p) { return 1e-140 * p; });
  vtkNew<vtkMeshMetric> extreme;
  extreme->SetInputDataObject(0, toGrid(tiny));
  TAUTLINE_CHECK(contains(errorOf(extreme), wording("beyond-the-range-of-double")));
  // Halves with points of their own on the seam are one mesh, and have the same metric.
  vtkNew<vtkPartitionedDataSet> halves;
  for (unsigned int half = 0; half < 2; ++half)
  {
    MeshData part;
    std::map<Index, Index> numbers;
    for (Index cell = 0; cell < data.numberOfCells(); ++cell)
    {
      const std::vector<Index> nodes = data.nodes(cell);
      const double x = sumOf(0.0, nodes, [&](Index p) { return data.point(p)[0] / 4; });
      if ((x > 0.5) == (half == 1))
      {
        part.addCell(CellType::Tetrahedron,
          collect<Index>(nodes,
            [&](Index p)
            {
              const auto [found, added] = numbers.emplace(p, part.numberOfPoints());
              added ? part.addPoint(data.point(p)) : 0;
              return found->second;
            }));
      }
    }
    halves->SetPartition(half, toGrid(part));
  }
  const auto joined = make(halves);
  TAUTLINE_CHECK_RELATIVE(joined->GetElements(), whole->GetElements(), 1e-9);
  TAUTLINE_CHECK_RELATIVE(joined->GetLargestFound(), whole->GetLargestFound(), 1e-9);
}

TAUTLINE_PART(testFilterErrors)
{
  const auto grid = gridWithField(unitBlock(CellType::Triangle, 4));
  const auto rejected = [&](const char* text, const auto& change)
  {
    vtkNew<vtkMeshMetric> filter;
    filter->SetInputData(grid);
    change(filter.Get());
    TAUTLINE_CHECK(contains(errorOf(filter), text));
    TAUTLINE_CHECK(outputOf<>(filter)->GetNumberOfPoints() == 0 && filter->GetElements() == 0);
    TAUTLINE_CHECK(std::string(filter->GetSummary()).empty());
  };
  const auto array = [](vtkMeshMetric* filter, int source, int index, const char* name)
  {
    TAUTLINE_SET(filter, SetSource(source), SetInputArrayToProcess(index, 0, 0, PointArrays, name));
  };
  using Metric = vtkMeshMetric;
  rejected(wording("a-field-is-needed"), [](Metric* f) { f->SetSource(Metric::HESSIAN); });
  rejected(wording("sizes-are-needed"), [](Metric* f) { f->SetSource(Metric::SIZES); });
  rejected(wording("there-is-no-point-array-nothing"),
    [&](Metric* f) { array(f, Metric::HESSIAN, 1, "nothing"); });
  rejected(
    wording("the-array-of-sizes-has-3"), [&](Metric* f) { array(f, Metric::SIZES, 0, "V"); });
  rejected(wording("the-array-of-distances-has-3"),
    [&](Metric* f) { array(f, Metric::DISTANCE, 2, "V"); });
  rejected(wording("the-array-to-intersect-with-has-3"),
    [&](Metric* f) { array(f, Metric::CURVATURE, 4, "V"); });
  rejected(wording("target-value-is-0"),
    [&](Metric* f)
    {
      array(f, Metric::HESSIAN, 1, "u");
      f->SetTargetValue(0);
    });
  rejected(wording("norm-is-below-1"),
    [&](Metric* f)
    {
      array(f, Metric::HESSIAN, 1, "u");
      f->SetNorm(0.5);
    });
  rejected(wording("gradation-is-at-most-1"), [](Metric* f) { f->SetGradation(0.9); });
  rejected(wording("smallest-size-is-above-largest"),
    [](Metric* f) { TAUTLINE_SET(f, SetSmallestSize(2), SetLargestSize(1)); });
  rejected(wording("array-name-is-empty"), [](Metric* f) { f->SetArrayName(""); });
  rejected(wording("ellipsoid-scale-is-0"), [](Metric* f) { f->SetEllipsoidScale(0); });
  grid->GetPointData()->GetArray("size")->SetComponent(3, 0, -1.0);
  grid->GetPointData()->GetArray("u")->SetComponent(3, 0, NAN);
  rejected(wording("sizes-are-not-positive-numbers"),
    [&](Metric* f) { array(f, Metric::SIZES, 0, "size"); });
  rejected(wording("values-of-the-field-are-not-finite"),
    [&](Metric* f) { array(f, Metric::HESSIAN, 1, "u"); });
}
}
