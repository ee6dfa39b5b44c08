// SPDX-License-Identifier: BSD-3-Clause
// Targets: an element that is its target has every target metric's ideal value, and only then.
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr double tolerance = 1e-11;
constexpr int cellsPerMesh = 20;

/// Valid cells without common points; 2D ones in one plane or, on a surface, each in its own.
MeshData randomMesh(CellType type, bool surface, Random& random)
{
  MeshData data;
  for (int i = 0; i < cellsPerMesh; ++i)
  {
    std::vector<Vec3> corners = validCell(type, 0.25, 0.3, random);
    const Columns turn = randomRotation(random);
    for (Vec3& p : corners)
    {
      p[2] += surface ? random.uniform(-0.1, 0.1) : 0;
      p = surface ? turn * p : p;
    }
    data.addCell(type, corners);
  }
  return data;
}

bool takesTargets(const MetricInfo& info)
{
  return info.family == MetricFamily::Target && info.metric != Metric::UntangleBeta;
}

/// The value at T = I; SizeUntangle is not 0 there.
double valueAtTarget(const MetricInfo& info, int dimension)
{
  return info.metric == Metric::SizeUntangle ? -1 + std::sqrt(1 + Parameters().epsilon)
                                             : info.ideal(dimension);
}

/// Every metric that `concerned` picks has its ideal value on every cell.
template <class Choice>
void checkIdeal(const Mesh& mesh, CellType type, const Targets& targets, const Choice& concerned)
{
  TAUTLINE_LET(EvaluationOptions, options, targets = &targets);
  for (const MetricInfo& info : elementMetrics())
  {
    if (!info.definedOn(type) || !takesTargets(info) || !concerned(info))
    {
      continue;
    }
    const Context context(info.name);
    TAUTLINE_EACH_OF(double value, valuesOf(mesh, info.metric, options),
      TAUTLINE_CHECK_NEAR(value, valueAtTarget(info, topology(type).dimension), tolerance));
  }
}

//------------------------------------------------------------------------------
void testReference(CellType type, bool surface)
{
  Random random(6);
  const MeshData data = randomMesh(type, surface, random);
  const Mesh mesh(data.view());
  const Targets same = referenceTargets(mesh, mesh);
  checkIdeal(
    mesh, type, same, [&](const MetricInfo& info) { return info.rotationInvariant || !surface; });

  // Turned and grown: shape stays, size is the square or cube.
  const double growth = 1.5;
  MeshData grown = data;
  const bool planar = topology(type).dimension == 2;
  const Columns turn = rotation(planar && !surface ? Vec3{ 0, 0, 1 } : Vec3{ 1, 2, 3 }, 0.8);
  grown.transform([&](const Vec3& p) { return growth * (turn * p); });
  const Mesh grownMesh(grown.view());
  const Targets targets = referenceTargets(grownMesh, mesh);
  checkIdeal(grownMesh, type, targets,
    [](const MetricInfo& info) { return info.scaleInvariant && info.rotationInvariant; });
  TAUTLINE_LET(EvaluationOptions, options, targets = &targets);
  const double tau = std::pow(growth, topology(type).dimension);
  TAUTLINE_EACH_OF(double value, valuesOf(grownMesh, Metric::SizeNonBarrier, options),
    TAUTLINE_CHECK_NEAR(value, (tau - 1) * (tau - 1), tolerance));

  // A mirrored pair is as good as the original pair.
  if (!surface)
  {
    const auto mirror = [&](const Vec3& p) {
      return planar ? Vec3{ p[1], p[0], p[2] } : Vec3{ -p[0], p[1], p[2] };
    };
    MeshData reversed = grown, reversedReference = data;
    reversed.transform(mirror);
    reversedReference.transform(mirror);
    Mesh reversedMesh(reversed.view()), referenceMesh(reversedReference.view());
    reversedMesh.setMirrored(true);
    TAUTLINE_CHECK_THROWS(referenceTargets(reversedMesh, referenceMesh), "Cell 0");
    referenceMesh.setMirrored(true);
    const Targets reversedTargets = referenceTargets(reversedMesh, referenceMesh);
    TAUTLINE_LET(EvaluationOptions, reversedOptions, targets = &reversedTargets);
    for (Metric metric : { Metric::InverseMeanRatio, Metric::ShapeSizeOrientation })
    {
      const std::vector<double> expected = valuesOf(grownMesh, metric, options);
      const std::vector<double> actual = valuesOf(reversedMesh, metric, reversedOptions);
      TAUTLINE_EACH(int, i, cellsPerMesh, TAUTLINE_CHECK_NEAR(actual[i], expected[i], tolerance));
    }
  }
}

//------------------------------------------------------------------------------
void testSize(CellType type, bool surface)
{
  Random random(7);
  const MeshData data = randomMesh(type, surface, random);
  const Mesh mesh(data.view());
  EvaluationOptions options;
  // The ideal cell at its own size.
  MeshData ideal;
  std::vector<double> sizes;
  for (int i = 0; i < cellsPerMesh; ++i)
  {
    const double length = random.uniform(0.1, 10);
    std::vector<Vec3> corners = idealCell(type);
    for (Vec3& p : corners)
    {
      p = length * p;
    }
    ideal.addCell(type, corners);
    sizes.push_back(
      valueOf(type, idealCell(type), Metric::Size) * std::pow(length, topology(type).dimension));
  }
  const Mesh idealMesh(ideal.view());
  checkIdeal(
    idealMesh, type, sizeTargets(idealMesh, sizes.data()), [](const MetricInfo&) { return true; });

  // Sizes do not change shape metrics, and tau of a simplex is its size over the target size.
  const Targets targets = sizeTargets(mesh, sizes.data());
  options.targets = &targets;
  for (const MetricInfo& info : elementMetrics())
  {
    if (info.definedOn(type) && takesTargets(info) && info.scaleInvariant)
    {
      const std::vector<double> with = valuesOf(mesh, info.metric, options);
      const std::vector<double> without = valuesOf(mesh, info.metric);
      TAUTLINE_EACH(int, i, cellsPerMesh, TAUTLINE_CHECK_RELATIVE(with[i], without[i], tolerance));
    }
  }
  if (topology(type).samples == 1)
  {
    const std::vector<double> measured = valuesOf(mesh, Metric::Size);
    const std::vector<double> values = valuesOf(mesh, Metric::SizeBarrier, options);
    for (int i = 0; i < cellsPerMesh; ++i)
    {
      const double tau = measured[i] / sizes[i];
      TAUTLINE_CHECK_NEAR(values[i], (tau + 1 / tau) / 2 - 1, tolerance * (tau + 1 / tau));
    }
  }
}

//------------------------------------------------------------------------------
/// Stretches by `lengths` along the axes of a rotation: M^(-1/2), with M^(1/2) for the reciprocals.
Columns stretch(const Columns& axes, const Vec3& lengths)
{
  Columns result = {};
  for (int a = 0; a < 3; ++a)
  {
    for (int c = 0; c < 3; ++c)
    {
      result[c] += (lengths[a] * axes[a][c]) * axes[a];
    }
  }
  return result;
}

/// Where the ideal cell, in any rotation, has the size that M prescribes, edges have length 1 in M.
void testTensor(CellType type, bool surface)
{
  Random random(8);
  const bool planar = topology(type).dimension == 2 && !surface;
  MeshData data;
  std::vector<double> tensors;
  for (int i = 0; i < cellsPerMesh; ++i)
  {
    const Columns axes =
      planar ? rotation({ 0, 0, 1 }, random.uniform(0, 3)) : randomRotation(random);
    const Columns turn =
      planar ? rotation({ 0, 0, 1 }, random.uniform(0, 3)) : randomRotation(random);
    const double length = random.uniform(0.1, 2);
    const Vec3 lengths = surface ? Vec3{ length, length, length } : random.vector(0.1, 2);
    std::vector<Vec3> corners = idealCell(type);
    for (Vec3& p : corners)
    {
      p = stretch(axes, lengths) * (turn * p);
    }
    data.addCell(type, corners);
    const Columns m = stretch(
      axes, { std::pow(lengths[0], -2), std::pow(lengths[1], -2), std::pow(lengths[2], -2) });
    for (int entry = 0; entry < 9; ++entry)
    {
      tensors.push_back(m[entry % 3][entry / 3]);
    }
  }
  const Mesh mesh(data.view());
  const auto blindToTurning = [](const MetricInfo& info) { return info.rotationInvariant; };
  checkIdeal(mesh, type, tensorTargets(mesh, tensors.data()), blindToTurning);

  // The same, mirrored: x reversed, and the tensors with it.
  MeshData reversed = data;
  reversed.transform(TAUTLINE_PLACE(-p[0], p[1], p[2]));
  for (int i = 0; i < cellsPerMesh; ++i)
  {
    for (int entry : { 1, 2, 3, 6 })
    {
      tensors[9 * i + entry] *= -1;
    }
  }
  Mesh reversedMesh(reversed.view());
  reversedMesh.setMirrored(true);
  checkIdeal(reversedMesh, type, tensorTargets(reversedMesh, tensors.data()), blindToTurning);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRejections)
{
  Random random(9);
  const MeshData data = randomMesh(CellType::Quadrilateral, false, random);
  const Mesh mesh(data.view());
  std::vector<double> sizes(cellsPerMesh, 1.0);
  for (double bad : { 0.0, -1.0, std::nan(""), HUGE_VAL })
  {
    sizes[7] = bad;
    TAUTLINE_CHECK_THROWS(sizeTargets(mesh, sizes.data()), "Cell 7");
  }
  std::vector<double> tensors;
  for (int i = 0; i < cellsPerMesh; ++i)
  {
    tensors.insert(tensors.end(), { 1, 0, 0, 0, 1, 0, 0, 0, 1 });
  }
  for (double bad : { 0.0, -1.0, std::nan(""), HUGE_VAL })
  {
    tensors[9 * 11] = bad;
    TAUTLINE_CHECK_THROWS(tensorTargets(mesh, tensors.data()), "Cell 11");
  }
  tensors[9 * 11] = 2;
  const MeshData curved = randomMesh(CellType::Quadrilateral, true, random);
  TAUTLINE_CHECK_THROWS(tensorTargets(Mesh(curved.view()), tensors.data()), "Cell 11");

  MeshData other = data;
  std::swap(other.connectivity[4 * 5], other.connectivity[4 * 5 + 1]);
  TAUTLINE_CHECK_THROWS(referenceTargets(mesh, Mesh(other.view())), "Cell 5");
  const MeshData fewer = singleCell(CellType::Quadrilateral, idealCell(CellType::Quadrilateral));
  TAUTLINE_CHECK_THROWS(
    referenceTargets(mesh, Mesh(fewer.view())), wording("4-points-and-1-cells"));

  // Inverted and degenerate cells are no targets: reflex on a plane and on a surface, and flat.
  for (double height : { 0.0, 0.3 })
  {
    MeshData bad = height == 0 ? data : curved;
    const Vec3 p1 = bad.point(4 * 3 + 1), p3 = bad.point(4 * 3 + 3), p0 = bad.point(4 * 3);
    const Vec3 inside = 0.5 * (p1 + p3);
    bad.setPoint(4 * 3 + 2, inside + 0.5 * (p0 - inside));
    TAUTLINE_CHECK_EQUAL(static_cast<int>(validityOf(bad)[3]), static_cast<int>(Inverted));
    const Mesh target(height == 0 ? data.view() : curved.view());
    TAUTLINE_CHECK_THROWS(referenceTargets(target, Mesh(bad.view())), "Cell 3");
    bad.setPoint(4 * 3 + 2, bad.point(4 * 3 + 1));
    TAUTLINE_CHECK_THROWS(referenceTargets(target, Mesh(bad.view())), "Cell 3");
  }
}

//------------------------------------------------------------------------------
/// Without targets, tetrahedra have formulas of their own: the same numbers as with the ideal
/// tetrahedron given as the target of each, inverted and flat ones included, and for metrics that
/// do not depend on the size ones of extreme size.
TAUTLINE_PART(testGivenIdeal)
{
  const std::vector<Vec3> ideal = idealCell(CellType::Tetrahedron);
  Random random(8);
  MeshData data, reference;
  const std::vector<double> sizes = { 1e-150, 1e-30, 1e-8, 0.1, 1.0, 30.0, 1e8, 1e30 };
  const auto isExtreme = [](double size) { return size < 1e-19 || size > 1e19; };
  for (double size : sizes)
  {
    for (int i = 0; i < cellsPerMesh; ++i)
    {
      auto corners = collect<Vec3>(4, [&](int) { return size * random.vector(-1, 1); });
      if (i == 0 && size == 1)
      {
        corners[3] = corners[1]; // flat: of larger ones rounding decides the determinant
      }
      data.addCell(CellType::Tetrahedron, corners);
      reference.addCell(CellType::Tetrahedron, ideal);
    }
  }
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(data);
  TAUTLINE_CHECK(std::count(validity.begin(), validity.end(), Inverted) > cellsPerMesh);
  const Targets targets = referenceTargets(mesh, Mesh(reference.view()));
  const std::size_t cells = validity.size(), numbers = 3 * data.connectivity.size();
  for (const MetricInfo& info : elementMetrics())
  {
    if (!info.definedOn(CellType::Tetrahedron) || info.family != MetricFamily::Target)
    {
      continue;
    }
    const Context context(info.name);
    std::vector<double> values[2], gradients[2];
    for (const bool given : { false, true })
    {
      TAUTLINE_LET(EvaluationOptions, options, targets = given ? &targets : nullptr);
      values[given].resize(cells);
      gradients[given].resize(numbers);
      evaluateMetricGradient(
        mesh, info.metric, options, values[given].data(), gradients[given].data());
      const std::vector<double> alone = valuesOf(mesh, info.metric, options);
      for (std::size_t cell = 0; cell < cells; ++cell)
      {
        const double value = values[given][cell];
        TAUTLINE_CHECK_NEAR(alone[cell], value, tolerance * std::abs(value));
      }
    }
    for (std::size_t cell = 0; cell < cells; ++cell)
    {
      if (isExtreme(sizes[cell / cellsPerMesh]) && !info.scaleInvariant)
      {
        continue;
      }
      const double value = values[true][cell];
      TAUTLINE_CHECK_NEAR(values[false][cell], value, tolerance * std::abs(value));
      // Relative to the largest component of the cell.
      const auto first = gradients[true].begin() + static_cast<std::ptrdiff_t>(12 * cell);
      double largest = 0;
      std::for_each(first, first + 12, [&](double g) { largest = std::max(largest, std::abs(g)); });
      for (std::size_t k = 12 * cell; k < 12 * (cell + 1); ++k)
      {
        TAUTLINE_CHECK_NEAR(gradients[false][k], gradients[true][k], tolerance * largest);
      }
    }
  }
}
}

TAUTLINE_TEST(TestTargets)
{
  for (CellType type : allTypes)
  {
    for (bool surface : { false, true })
    {
      if (surface && topology(type).dimension == 3)
      {
        continue;
      }
      const Context context(topology(type).name + std::string(surface ? ", surface" : ""));
      TAUTLINE_RUN(testReference(type, surface));
      TAUTLINE_RUN(testSize(type, surface));
      TAUTLINE_RUN(testTensor(type, surface));
    }
  }
}
