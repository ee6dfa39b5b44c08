// SPDX-License-Identifier: BSD-3-Clause
// Analytic gradients of every metric against fourth-order central differences.
//
// A cloud is a mesh of cells that share no point, so that node k of all of them is moved at once.
// For a function smooth on the scale of the stencil the forward and the backward difference agree,
// and so do the central ones with one and two steps. Where they do not, a kink (another edge, angle
// or corner becomes the extreme one) lies within the stencil and differences mean nothing: that
// component is skipped, and skips are counted and limited.
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr int cellsPerCloud = 24;
constexpr double step = 0x1p-13;
constexpr double tolerance = 1e-7;        // of the norm of the cell's gradient
constexpr double valueRounding = 1e-10;   // of the value: rounding of the differences
constexpr double kinkThreshold = 8e-7;    // disagreement of the differences that indicates a kink
constexpr double skippedFraction = 0.001; // of all components that may be skipped

struct Cloud
{
  std::string name;
  CellType type;
  bool valid;
  MeshData data;
  std::vector<Vec3> directions; ///< in which points may move: two in a plane, otherwise three
  Dimension dimension;
};

/// Corners anywhere, none of them nearly flat; valid ones all positive, others not.
std::vector<Vec3> randomCorners(CellType type, bool valid, double warp, Random& random)
{
  for (;;)
  {
    std::vector<Vec3> p = idealCell(type);
    for (Vec3& corner : p)
    {
      const Vec3 d = valid ? random.vector(-0.35, 0.35) : random.vector(-1, 1);
      corner[0] += d[0];
      corner[1] += d[1];
      corner[2] += topology(type).dimension == 3 ? d[2] : warp * d[2];
    }
    const Vec3 normal =
      p.size() == 3 ? cross(p[1] - p[0], p[2] - p[0]) : cross(p[2] - p[0], p[3] - p[1]);
    const bool surface = topology(type).dimension == 2 && warp > 0;
    const auto sines = cornerSines(type, p, surface ? normal : Vec3{ 0, 0, 1 });
    const bool flat =
      std::any_of(sines.begin(), sines.end(), [](double s) { return std::abs(s) < 0.2; });
    const bool negative = std::any_of(sines.begin(), sines.end(), [](double s) { return s < 0; });
    // A surface triangle has no sign.
    if (!flat && negative == (!valid && !(surface && p.size() == 3)))
    {
      return p;
    }
  }
}

Cloud makeCloud(
  const std::string& name, CellType type, bool valid, const std::string& situation, Random& random)
{
  const bool surface = situation == "surface" || situation == "surface in volume";
  Cloud cloud{ name, type, valid, {}, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    Dimension::Volume };
  for (int i = 0; i < cellsPerCloud; ++i)
  {
    std::vector<Vec3> corners = randomCorners(type, valid, surface ? 0.3 : 0, random);
    if (surface)
    {
      const Columns r = randomRotation(random);
      std::for_each(corners.begin(), corners.end(), [&](Vec3& p) { p = r * p; });
    }
    cloud.data.addCell(type, corners);
  }
  if (surface)
  {
    cloud.dimension = Dimension::Surface;
    if (situation == "surface in volume")
    {
      cloud.dimension = Dimension::Volume;
      cloud.data.addCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron));
    }
  }
  else if (topology(type).dimension == 2)
  {
    cloud.dimension = Dimension::Planar;
    // Less than 45 degrees, so that the plane's normal keeps its sign.
    const Columns r = rotation({ 2, 1, 0.5 }, situation == "tilted plane" ? 0.6 : 0.0);
    const Vec3 offset = { 0.3, -0.2, 0.7 };
    cloud.data.transform([&](const Vec3& p) { return r * p + offset; });
    cloud.directions = { r[0], r[1] };
  }
  return cloud;
}

std::vector<Cloud> makeClouds()
{
  Random random(1);
  std::vector<Cloud> clouds;
  for (CellType type : allTypes)
  {
    const std::vector<const char*> situations = topology(type).dimension == 3
      ? std::vector<const char*>{ "volume" }
      : std::vector<const char*>{ "plane", "tilted plane", "surface", "surface in volume" };
    for (const char* situation : situations)
    {
      for (bool valid : { true, false })
      {
        clouds.push_back(makeCloud(
          std::string(topology(type).name) + ", " + situation + (valid ? ", valid" : ", inverted"),
          type, valid, situation, random));
        const Mesh mesh(clouds.back().data.view());
        const Context context(clouds.back().name);
        TAUTLINE_CHECK(mesh.dimension() == clouds.back().dimension);
      }
    }
  }
  return clouds;
}

struct Counts
{
  long compared = 0, skipped = 0;
};

/// Norm of the gradient of one cell.
double normOf(const Gradients& g, Index first, int nodes)
{
  double sum = 0;
  for (Index i = 3 * first; i < 3 * (first + nodes); ++i)
  {
    sum += g.gradients[i] * g.gradients[i];
  }
  return std::sqrt(sum);
}

void checkTranslation(const Cloud& cloud, const Mesh& mesh, const Gradients& g, int nodes)
{
  for (Index i = 0; i < cellsPerCloud; ++i)
  {
    const double size = normOf(g, i * nodes, nodes);
    Vec3 sum = { 0, 0, 0 };
    for (Index k = i * nodes; k < (i + 1) * nodes; ++k)
    {
      const Vec3 row = { g.gradients[3 * k], g.gradients[3 * k + 1], g.gradients[3 * k + 2] };
      sum += row;
      if (cloud.dimension == Dimension::Planar)
      {
        TAUTLINE_CHECK_NEAR(dot(row, mesh.normal()), 0, 1e-12 * size);
      }
    }
    TAUTLINE_CHECK_NEAR(norm(sum), 0, 1e-12 * size);
  }
}

void checkGradients(const Cloud& cloud, Metric metric, const EvaluationOptions& options, Counts& n)
{
  const Mesh mesh(cloud.data.view());
  const Gradients g = gradientsOf(mesh, metric, options);
  const std::vector<double> values = valuesOf(mesh, metric, options);
  const int nodes = topology(cloud.type).nodes;
  for (Index i = 0; i < cellsPerCloud; ++i)
  {
    // Two compilations of a formula round differently; a small square has fewer digits of its root.
    const double size = std::abs(values[i]);
    TAUTLINE_CHECK_NEAR(g.values[i], values[i], 1e-13 * size + 1e-15 * std::sqrt(size));
  }
  checkTranslation(cloud, mesh, g, nodes);

  constexpr int reach = 4;
  for (int k = 0; k < nodes; ++k)
  {
    for (const Vec3& direction : cloud.directions)
    {
      std::vector<double> at[2 * reach + 1];
      for (int s = -reach; s <= reach; ++s)
      {
        MeshData moved = cloud.data;
        for (Index i = 0; i < cellsPerCloud; ++i)
        {
          const Index node = i * nodes + k;
          moved.setPoint(node, moved.point(node) + (s * step) * direction);
        }
        at[reach + s] = valuesOf(moved, metric, options);
      }
      for (Index i = 0; i < cellsPerCloud; ++i)
      {
        auto f = [&](int s) { return at[reach + s][i]; };
        auto oneSided = [&](int s)
        {
          return s * (-25 * f(0) + 48 * f(s) - 36 * f(2 * s) + 16 * f(3 * s) - 3 * f(4 * s)) /
            (12 * step);
        };
        auto central = [&](int s)
        { return (8 * (f(s) - f(-s)) - (f(2 * s) - f(-2 * s))) / (12 * s * step); };
        const Vec3 row = { g.gradients[3 * (i * nodes + k)], g.gradients[3 * (i * nodes + k) + 1],
          g.gradients[3 * (i * nodes + k) + 2] };
        const double size = normOf(g, i * nodes, nodes);
        ++n.compared;
        const double disagreement =
          std::max(std::abs(oneSided(1) - oneSided(-1)), std::abs(central(1) - central(2)));
        if (disagreement > kinkThreshold * size + valueRounding * std::abs(f(0)))
        {
          ++n.skipped;
          continue;
        }
        TAUTLINE_CHECK_NEAR(
          dot(row, direction), central(1), tolerance * size + valueRounding * std::abs(f(0)));
      }
    }
  }
}

/// Ideal, reference, size and tensor targets for a cloud; the first is null.
std::vector<std::pair<std::string, Targets>> makeTargets(const Cloud& cloud, const Mesh& mesh)
{
  Random random(2);
  std::vector<std::pair<std::string, Targets>> targets = { { "ideal", {} } };
  MeshData reference = cloud.data;
  const int nodes = topology(cloud.type).nodes;
  const Vec3 origin = cloud.dimension == Dimension::Planar ? cloud.data.point(0) : Vec3{ 0, 0, 0 };
  for (Index i = 0; i < cellsPerCloud; ++i)
  {
    const std::vector<Vec3> corners = validCell(cloud.type, 0.2, 0.5, random);
    for (int k = 0; k < nodes; ++k)
    {
      const Vec3& p = corners[k];
      Vec3 placed = p;
      if (cloud.dimension == Dimension::Planar)
      {
        placed = origin + p[0] * cloud.directions[0] + p[1] * cloud.directions[1];
      }
      reference.setPoint(i * nodes + k, placed);
    }
  }
  targets.emplace_back("reference", referenceTargets(mesh, Mesh(reference.view())));

  std::vector<double> sizes, tensors;
  for (Index i = 0; i < cloud.data.numberOfCells(); ++i)
  {
    sizes.push_back(random.uniform(0.2, 2));
    const double stretch = random.uniform(0.5, 3);
    Columns m = { Vec3{ stretch, 0, 0 }, Vec3{ 0, stretch, 0 }, Vec3{ 0, 0, stretch } };
    const bool isotropic =
      topology(cloud.type).dimension == 2 && cloud.dimension != Dimension::Planar;
    const Vec3 v = isotropic ? Vec3{ 0, 0, 0 } : random.vector(-1, 1);
    for (int r = 0; r < 3; ++r)
    {
      for (int c = 0; c < 3; ++c)
      {
        tensors.push_back(m[c][r] + v[r] * v[c]);
      }
    }
  }
  targets.emplace_back("size", sizeTargets(mesh, sizes.data()));
  targets.emplace_back("tensor", tensorTargets(mesh, tensors.data()));
  return targets;
}

void testMetric(const MetricInfo& info, const Cloud& cloud, Counts& total)
{
  if (!info.definedOn(cloud.type))
  {
    return;
  }
  const Mesh mesh(cloud.data.view());
  EvaluationOptions options;
  options.parameters.beta = 0.1;     // some elements on either side of the kink
  options.parameters.epsilon = 1e-2; // a bend the differences can follow
  options.power = 3;
  const bool target = info.family == MetricFamily::Target;
  if (!info.rotationInvariant && topology(cloud.type).dimension == 2 &&
    cloud.dimension != Dimension::Planar)
  {
    if (cloud.dimension == Dimension::Surface)
    {
      TAUTLINE_CHECK_THROWS(valuesOf(mesh, info.metric), "orientation");
    }
    else
    {
      // Beside volume cells the 2D cells are left out.
      const Gradients g = gradientsOf(mesh, info.metric, options);
      TAUTLINE_CHECK(std::all_of(
        g.values.begin(), g.values.begin() + cellsPerCloud, [](double v) { return v == 0; }));
    }
    return;
  }
  for (const auto& targets : makeTargets(cloud, mesh))
  {
    const bool ideal = targets.first == "ideal";
    if (!target && !ideal)
    {
      break;
    }
    options.targets = ideal ? nullptr : &targets.second;
    for (Combination combination :
      { Combination::Mean, Combination::Worst, Combination::PowerMean })
    {
      if ((!target || topology(cloud.type).samples == 1) && combination != Combination::Mean)
      {
        break;
      }
      options.combination = combination;
      const Context context(std::string(info.name) + ", " + targets.first + ", combination " +
        std::to_string(static_cast<int>(combination)));
      Counts n;
      checkGradients(cloud, info.metric, options, n);
      if (info.differentiable && combination != Combination::Worst)
      {
        TAUTLINE_CHECK_EQUAL(n.skipped, 0);
      }
      total.compared += n.compared;
      total.skipped += n.skipped;
    }
  }
}
}

TAUTLINE_TEST(TestMetricGradients)
{
  Counts total;
  for (const Cloud& cloud : makeClouds())
  {
    const Context context(cloud.name);
    for (const MetricInfo& info : elementMetrics())
    {
      TAUTLINE_RUN(testMetric(info, cloud, total));
    }
  }
  std::cout << total.compared << " components compared, " << total.skipped << " skipped at kinks\n";
  TAUTLINE_CHECK(total.skipped < skippedFraction * total.compared);
}
