// SPDX-License-Identifier: BSD-3-Clause
// Invariance of values under motion, rotation, renumbering and scaling; and the effect of a mirror.
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr int cellsPerCloud = 24;
constexpr double tolerance = 1e-12; // relative; of values near 0 relative to 1

struct Cloud
{
  CellType type;
  int dimension;
  bool surface;
  MeshData data;
};

/// Valid cells without common points; of 2D cells all in the plane z = 0, or each in its own.
Cloud makeCloud(CellType type, bool surface)
{
  Random random(3);
  Cloud cloud{ type, topology(type).dimension, surface, {} };
  for (int i = 0; i < cellsPerCloud; ++i)
  {
    std::vector<Vec3> corners = validCell(type, 0.25, 0.3, random);
    const Columns turn = randomRotation(random);
    for (Vec3& p : corners)
    {
      p[2] += surface ? random.uniform(-0.1, 0.1) : 0;
      p = surface ? turn * p : p;
      for (double& x : p)
      {
        x = std::round(x * 0x1p30) * 0x1p-30; // so that moving is exact
      }
    }
    cloud.data.addCell(type, corners);
  }
  return cloud;
}

bool applies(const MetricInfo& info, const Cloud& cloud)
{
  return info.definedOn(cloud.type) && (info.rotationInvariant || !cloud.surface);
}

void checkSame(
  const std::vector<double>& actual, const std::vector<double>& expected, double factor = 1)
{
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const double value = factor * expected[i];
    TAUTLINE_CHECK_NEAR(
      actual[i], value, tolerance * std::max(std::abs(value), std::min(1.0, factor)));
  }
}

MeshData transformed(const MeshData& data, const std::function<Vec3(const Vec3&)>& f)
{
  MeshData result = data;
  result.transform(f);
  return result;
}

//------------------------------------------------------------------------------
void testMotion(const Cloud& cloud)
{
  const Vec3 shift = { 8, -4, 16 };
  const Columns spin = rotation({ 0, 0, 1 }, 0.7), turn = rotation({ 2, 1, 0.5 }, 0.6);
  const MeshData moved = transformed(cloud.data, [&](const Vec3& p) { return p + shift; });
  const MeshData spun = transformed(cloud.data, [&](const Vec3& p) { return spin * p + shift; });
  const MeshData turned = transformed(cloud.data, [&](const Vec3& p) { return turn * (spin * p); });
  for (const MetricInfo& info : elementMetrics())
  {
    if (!applies(info, cloud))
    {
      continue;
    }
    const Context context(info.name);
    const std::vector<double> values = valuesOf(cloud.data, info.metric);
    checkSame(valuesOf(moved, info.metric), values);
    if (info.rotationInvariant)
    {
      checkSame(valuesOf(spun, info.metric), values);
      checkSame(valuesOf(turned, info.metric), values);
    }
    else
    {
      // Turned by 40 degrees, a nearly ideal cell is worse.
      const std::vector<double> after = valuesOf(spun, info.metric);
      TAUTLINE_CHECK(after[0] > values[0] + 0.05);
    }
  }
}

//------------------------------------------------------------------------------
/// The renumberings of a cell that are rotations of the ideal one; in 2D within its plane.
std::vector<std::vector<int>> rotations(CellType type)
{
  const std::vector<Vec3> p = idealCell(type);
  const auto& corner = topology(type).cornerNodes[0];
  std::vector<std::vector<int>> found;
  std::vector<int> image;
  std::function<void()> extend = [&]()
  {
    const std::size_t n = image.size();
    if (n == p.size())
    {
      auto edge = [&](int k) { return p[image[corner[k]]] - p[image[corner[0]]]; };
      const Vec3 third = topology(type).dimension == 2 ? Vec3{ 0, 0, 1 } : edge(3);
      if (dot(cross(edge(1), edge(2)), third) > 0)
      {
        found.push_back(image);
      }
      return;
    }
    for (int candidate = 0; candidate < static_cast<int>(p.size()); ++candidate)
    {
      bool fits = true;
      for (std::size_t i = 0; i < n && fits; ++i)
      {
        const double distance = norm(p[candidate] - p[image[i]]);
        fits = candidate != image[i] && std::abs(distance - norm(p[n] - p[i])) < 1e-9;
      }
      if (fits)
      {
        image.push_back(candidate);
        extend();
        image.pop_back();
      }
    }
  };
  extend();
  return found;
}

void testRenumbering(const Cloud& cloud)
{
  const std::vector<std::vector<int>> group = rotations(cloud.type);
  const std::size_t orders[] = { 3, 4, 12, 24, 6, 4 }; // of the rotation groups
  TAUTLINE_CHECK_EQUAL(group.size(), orders[topologyIndex(cloud.type)]);
  const Index nodes = topology(cloud.type).nodes;
  for (const std::vector<int>& image : group)
  {
    MeshData renumbered = cloud.data;
    for (Index i = 0; i < cellsPerCloud * nodes; ++i)
    {
      renumbered.connectivity[i] = cloud.data.connectivity[i - i % nodes + image[i % nodes]];
    }
    for (const MetricInfo& info : elementMetrics())
    {
      if (!applies(info, cloud) || !info.rotationInvariant)
      {
        continue;
      }
      for (Combination combination :
        { Combination::Mean, Combination::Worst, Combination::PowerMean })
      {
        TAUTLINE_LET(EvaluationOptions, options, combination = combination);
        const Context context(info.name);
        const Gradients before = gradientsOf(Mesh(cloud.data.view()), info.metric, options);
        const Gradients after = gradientsOf(Mesh(renumbered.view()), info.metric, options);
        checkSame(after.values, before.values);
        for (Index i = 0; i < cellsPerCloud * nodes; ++i)
        {
          const Index old = i - i % nodes + image[i % nodes];
          for (int c = 0; c < 3; ++c)
          {
            const double expected = before.gradients[3 * old + c];
            TAUTLINE_CHECK_NEAR(after.gradients[3 * i + c], expected,
              100 * tolerance * std::max(1.0, std::abs(expected)));
          }
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The power of length a metric of the ideal targets grows with; NaN if it is no power.
double powerOfLength(Metric metric, int dimension)
{
  switch (metric)
  {
    case Metric::Size:
    case Metric::UntangleBeta:
      return dimension;
    case Metric::ConditioningSizeShape:
    case Metric::InterpolationSizeShape:
      return -1;
    case Metric::ShapeNonBarrier:
      return dimension;
    case Metric::ShapeSimilarity:
      return dimension == 2 ? 2 : 4;
    case Metric::ShapeOrientation:
      return 2;
    case Metric::ShapeOrientationBarrier:
      return 1 - dimension;
    default:
      return metricInfo(metric).scaleInvariant ? 0 : std::nan("");
  }
}

void testScale(const Cloud& cloud)
{
  // For metrics that are no power of length, a reference mesh that is scaled along.
  MeshData reference = makeCloud(cloud.type, cloud.surface).data;
  reference.transform(TAUTLINE_PLACE(2 * p[0], p[1], 0.5 * p[2]));
  for (double scale : { 1e-8, 1e8 })
  {
    const auto times = [&](const Vec3& p) { return scale * p; };
    const MeshData scaled = transformed(cloud.data, times);
    const MeshData scaledReference = transformed(reference, times);
    const Mesh mesh(cloud.data.view()), scaledMesh(scaled.view());
    const std::vector<signed char> validity = validityOf(scaledMesh);
    TAUTLINE_CHECK_EQUAL(std::count(validity.begin(), validity.end(), Valid), cellsPerCloud);
    const Targets targets = referenceTargets(mesh, Mesh(reference.view()));
    const Targets scaledTargets = referenceTargets(scaledMesh, Mesh(scaledReference.view()));
    for (const MetricInfo& info : elementMetrics())
    {
      if (!applies(info, cloud))
      {
        continue;
      }
      const Context context(info.name + std::string(scale < 1 ? ", small" : ", large"));
      EvaluationOptions options, scaledOptions;
      options.parameters.beta = 0.5;
      scaledOptions.parameters.beta = 0.5 * std::pow(scale, cloud.dimension);
      const double power = powerOfLength(info.metric, cloud.dimension);
      TAUTLINE_CHECK(!info.scaleInvariant || power == 0);
      if (!std::isnan(power))
      {
        const double factor = std::pow(scale, power);
        const Gradients before = gradientsOf(mesh, info.metric, options);
        const Gradients after = gradientsOf(scaledMesh, info.metric, scaledOptions);
        checkSame(after.values, before.values, factor);
        TAUTLINE_EACH(std::size_t, i, before.gradients.size(),
          TAUTLINE_CHECK_NEAR(after.gradients[i] * scale / factor, before.gradients[i],
            100 * tolerance * std::max(1.0, std::abs(before.gradients[i]))));
      }
      if (info.family == MetricFamily::Target)
      {
        options.targets = &targets;
        scaledOptions.targets = &scaledTargets;
        checkSame(valuesOf(scaledMesh, info.metric, scaledOptions),
          valuesOf(mesh, info.metric, options),
          info.metric == Metric::UntangleBeta ? std::pow(scale, cloud.dimension) : 1);
      }
    }
  }
}

//------------------------------------------------------------------------------
void checkInvertedValue(const MetricInfo& info, double valid, double mirrored)
{
  switch (info.inverted)
  {
    case InvertedValue::Negative:
      TAUTLINE_CHECK(valid > 0);
      TAUTLINE_CHECK(mirrored < 0);
      break;
    case InvertedValue::Larger:
      TAUTLINE_CHECK(mirrored > valid);
      break;
    case InvertedValue::Unsigned:
      if (info.metric == Metric::ShapeProduct)
      {
        // r (r - 2) with r = |T|^2 / tau, at least 2 in size: no value determines the sign of r.
        TAUTLINE_CHECK(mirrored >= valid + 8);
        break;
      }
      TAUTLINE_CHECK_NEAR(mirrored, valid, tolerance * std::max(1.0, std::abs(valid)));
      break;
  }
}

void testMirror(const Cloud& cloud)
{
  // The kernel's reflection: x reversed in space, the axes exchanged in a plane.
  const auto reflect = [&](const Vec3& p)
  {
    return cloud.dimension == 2 && !cloud.surface ? Vec3{ p[1], p[0], p[2] }
                                                  : Vec3{ -p[0], p[1], p[2] };
  };
  const MeshData data = transformed(cloud.data, reflect);
  const Mesh original(cloud.data.view());
  Mesh mirror(data.view());
  const bool hasSign = !cloud.surface;
  const std::vector<signed char> reversed = validityOf(mirror);
  TAUTLINE_CHECK_EQUAL(
    std::count(reversed.begin(), reversed.end(), hasSign ? Inverted : Valid), cellsPerCloud);
  mirror.setMirrored(true);
  TAUTLINE_CHECK(validityOf(mirror) == validityOf(original));
  for (const MetricInfo& info : elementMetrics())
  {
    if (!applies(info, cloud))
    {
      continue;
    }
    const Context context(info.name);
    const Gradients before = gradientsOf(original, info.metric);
    mirror.setMirrored(false);
    const std::vector<double> inverted = valuesOf(mirror, info.metric);
    mirror.setMirrored(true);
    const Gradients after = gradientsOf(mirror, info.metric);
    for (Index i = 0; i < cellsPerCloud; ++i)
    {
      if (hasSign)
      {
        checkInvertedValue(info, before.values[i], inverted[i]);
      }
      else
      {
        TAUTLINE_CHECK_NEAR(
          inverted[i], before.values[i], tolerance * std::max(1.0, std::abs(inverted[i])));
      }
    }
    checkSame(after.values, before.values);
    for (std::size_t i = 0; i < before.gradients.size(); i += 3)
    {
      const Vec3 expected =
        reflect({ before.gradients[i], before.gradients[i + 1], before.gradients[i + 2] });
      TAUTLINE_EACH(int, c, 3,
        TAUTLINE_CHECK_NEAR(after.gradients[i + c], expected[c],
          100 * tolerance * std::max(1.0, std::abs(expected[c]))));
    }
  }
}
}

TAUTLINE_TEST(TestMetricInvariance)
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
      const Cloud cloud = makeCloud(type, surface);
      TAUTLINE_RUN(testMotion(cloud));
      TAUTLINE_RUN(testRenumbering(cloud));
      TAUTLINE_RUN(testScale(cloud));
      TAUTLINE_RUN(testMirror(cloud));
    }
  }
}
