// SPDX-License-Identifier: BSD-3-Clause
// Objectives: every metric by every template against sums by hand, their gradients against
// fourth-order differences; weights, scales, elements at fault, threads, moving points, errors.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Mesh/MeshElements.h"
#include "tautline/Objectives/ObjectiveSum.h"

using namespace tautline;

namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double valueTolerance = 1e-11;
constexpr double differenceTolerance = 1e-6;
constexpr double kinkThreshold = 1e-5; // disagreement of two differences that indicates a kink
constexpr ObjectiveTemplate templates[] = { ObjectiveTemplate::SumOfSquares,
  ObjectiveTemplate::SumOfSquaredReciprocals, ObjectiveTemplate::SumOfReciprocals,
  ObjectiveTemplate::Sum, ObjectiveTemplate::PowerMean, ObjectiveTemplate::Maximum };

struct NamedMesh
{
  std::string name;
  MeshData data;
};

void append(MeshData& all, const MeshData& part)
{
  const Index shift = all.numberOfPoints();
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (Index cell = 0; cell < part.numberOfCells(); ++cell)
  {
    std::vector<Index> nodes = part.nodes(cell);
    std::for_each(nodes.begin(), nodes.end(), [=](Index& node) { node += shift; });
    all.addCell(static_cast<int>(part.types[cell]), nodes);
  }
}

std::vector<NamedMesh> makeMeshes(double amplitude)
{
  std::vector<NamedMesh> meshes;
  for (CellType type :
    { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron, CellType::Hexahedron })
  {
    meshes.push_back({ topology(type).plural,
      movedBlock(type, topology(type).dimension == 2 ? 4 : 2, amplitude) });
  }
  MeshData surface = movedBlock(CellType::Triangle, 3, amplitude);
  append(surface, movedBlock(CellType::Quadrilateral, 3, amplitude));
  surface.transform(
    [](const Vec3& p) {
      return p + Vec3{ 0, 0, 0.3 * std::sin(p[0]) * std::cos(p[1]) };
    });
  meshes.push_back({ "surface", surface });
  MeshData mixed;
  for (CellType type : { CellType::Tetrahedron, CellType::Wedge, CellType::Pyramid,
         CellType::Hexahedron, CellType::Triangle })
  {
    append(mixed, movedBlock(type, topology(type).dimension == 2 ? 2 : 1, amplitude));
  }
  meshes.push_back({ "mixed", mixed });
  return meshes;
}

/// Whether the metric is defined on some cell of the mesh and the template fits its direction.
bool applies(const MetricInfo& info, ObjectiveTemplate objectiveTemplate, const Mesh& mesh)
{
  bool defined = false;
  for (const CellBlock& block : mesh.blocks())
  {
    const bool oriented = info.rotationInvariant || topology(block.type).dimension == 3 ||
      mesh.dimension() == Dimension::Planar;
    defined |= isElement(mesh, block.type) && info.definedOn(block.type) && oriented;
  }
  const bool larger = info.direction == Direction::LargerIsBetter;
  const bool smaller = info.direction == Direction::SmallerIsBetter;
  const bool reciprocal = objectiveTemplate == ObjectiveTemplate::SumOfSquaredReciprocals ||
    objectiveTemplate == ObjectiveTemplate::SumOfReciprocals;
  return defined &&
    (objectiveTemplate == ObjectiveTemplate::SumOfSquares ? !larger : !reciprocal || !smaller);
}

Objective make(Metric metric, ObjectiveTemplate objectiveTemplate)
{
  return TAUTLINE_CHANGED(Objective(), metric = metric, objectiveTemplate = objectiveTemplate,
    evaluation.parameters.beta = 0.3, evaluation.threads = 1);
}

/// Cells the metric is defined on, with the cells of the mesh sorted as the kernel does.
std::vector<char> definedCells(const MetricInfo& info, const Mesh& mesh)
{
  std::vector<char> defined(mesh.view().numberOfCells, 0);
  for (const CellBlock& block : mesh.blocks())
  {
    const bool oriented = info.rotationInvariant || topology(block.type).dimension == 3 ||
      mesh.dimension() == Dimension::Planar;
    for (Index i = 0; i < block.count; ++i)
    {
      defined[block.cell(i)] =
        isElement(mesh, block.type) && info.definedOn(block.type) && oriented;
    }
  }
  return defined;
}

/// The formulas of Objective.h in long double.
struct ByHand
{
  double value = 0;
  std::vector<double> gradient;
  ByHand(const MeshData& data, const Mesh& mesh, const Objective& o)
    : gradient(data.points.size(), 0.0)
  {
    const MetricInfo& info = metricInfo(o.metric);
    const Gradients cells = gradientsOf(mesh, o.metric, o.evaluation);
    const std::vector<signed char> validity = validityOf(mesh);
    const std::vector<char> defined = definedCells(info, mesh);
    const bool larger = info.direction == Direction::LargerIsBetter;
    const long double s = larger ? -1 : 1, p = o.power;
    auto weight = [&](Index i) -> long double
    { return defined[i] ? (o.elementWeights ? o.elementWeights[i] : 1.0) : 0.0; };

    using T = ObjectiveTemplate;
    long double sum = 0, total = 0, largest = -infinity;
    for (Index i = 0; i < data.numberOfCells(); ++i)
    {
      const double q = cells.values[i];
      total += weight(i);
      largest = weight(i) > 0 ? std::max<long double>(largest, p * s * q) : largest;
      const bool fault = (info.barrier && validity[i] != Valid) ||
        (q <= 0 &&
          (o.objectiveTemplate == T::SumOfSquaredReciprocals ||
            (o.objectiveTemplate == T::PowerMean && larger))) ||
        (q == 0 && o.objectiveTemplate == T::SumOfReciprocals);
      if (weight(i) > 0 && fault)
      {
        this->value = infinity;
        return;
      }
    }
    for (int pass = 0; pass < 2; ++pass)
    {
      const long double mean = std::pow(sum / total, 1 / p), scaled = sum;
      sum = 0;
      for (Index i = 0; i < data.numberOfCells(); ++i)
      {
        const long double w = weight(i), q = cells.values[i];
        if (w == 0)
        {
          continue;
        }
        long double slope = 0;
        switch (o.objectiveTemplate)
        {
          case T::SumOfSquares:
            sum += w * q * q;
            slope = 2 * q;
            break;
          case T::SumOfSquaredReciprocals:
            sum += w / (q * q);
            slope = -2 / (q * q * q);
            break;
          case T::SumOfReciprocals:
            sum += w / q;
            slope = -1 / (q * q);
            break;
          case T::Sum:
            sum += w * s * q;
            slope = s;
            break;
          case T::PowerMean:
            sum += w * std::pow(std::abs(q), s * p);
            slope = q == 0 ? 0
                           : s * std::pow(std::abs(q), s * p - 1) * std::pow(mean, 1 - p) / total *
                (q < 0 ? -1 : 1);
            break;
          default:
            sum += w * std::exp(p * s * q - largest);
            slope = s * std::exp(p * s * q - largest) / scaled;
        }
        if (pass == 1)
        {
          for (Index n = data.offsets[i]; n < data.offsets[i + 1]; ++n)
          {
            for (int c = 0; c < 3; ++c)
            {
              this->gradient[3 * data.connectivity[n] + c] +=
                static_cast<double>(w * slope * cells.gradients[3 * n + c]);
            }
          }
        }
      }
    }
    this->value =
      static_cast<double>(o.objectiveTemplate == T::PowerMean ? std::pow(sum / total, 1 / p)
          : o.objectiveTemplate == T::Maximum                 ? (largest + std::log(sum)) / p
                                                              : sum);
  }
};

double largestSize(const std::vector<double>& values)
{
  return largestOf<double>(0, values, [&](double v) { return std::abs(v); });
}

template <class Work>
void forEachObjective(const Mesh& mesh, const Work& work)
{
  for (const MetricInfo& info : elementMetrics())
  {
    for (ObjectiveTemplate objectiveTemplate : templates)
    {
      if (applies(info, objectiveTemplate, mesh))
      {
        const Context name(std::string(info.name) + ", template " +
          std::to_string(static_cast<int>(objectiveTemplate)));
        work(make(info.metric, objectiveTemplate), info);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Values and gradients by hand, with and without weights, valid and tangled, for 1, 2 and 4
/// threads.
void testByHand(const MeshData& data, bool tangled, int& infinite)
{
  const Mesh mesh(data.view());
  Random random(32);
  std::vector<double> weights(data.numberOfCells());
  std::generate(weights.begin(), weights.end(), [&]() { return random.uniform(-0.3, 2); });
  std::replace_if(
    weights.begin(), weights.end(), [](double w) { return w < 0; }, 0.0);
  forEachObjective(mesh,
    [&](Objective objective, const MetricInfo&)
    {
      for (const double* w :
        { static_cast<const double*>(nullptr), static_cast<const double*>(weights.data()) })
      {
        objective.elementWeights = w;
        const ByHand expected(data, mesh, objective);
        const ObjectiveSum sum(mesh, objective);
        const double value = sum.value();
        std::vector<double> gradient(data.points.size(), 1.0);
        const double again = sum.addGradient(-2, gradient.data());
        TAUTLINE_CHECK_NEAR(again, value, valueTolerance * std::abs(value));
        if (expected.value == infinity)
        {
          ++infinite;
          TAUTLINE_CHECK_EQUAL(value, infinity);
          TAUTLINE_CHECK(std::all_of(
            gradient.begin(), gradient.end(), [](double g) { return std::isfinite(g); }));
          TAUTLINE_CHECK(tangled);
          continue;
        }
        const double slack = largestSize(expected.gradient);
        TAUTLINE_CHECK_NEAR(
          value, expected.value, valueTolerance * (std::abs(expected.value) + slack));
        TAUTLINE_EACH(std::size_t, i, gradient.size(),
          TAUTLINE_CHECK_NEAR(
            (1 - gradient[i]) / 2, expected.gradient[i], valueTolerance * (slack + 1)));
      }
    });
}

/// Gradients along a random direction against differences, where points of the view move.
void testDifferences(MeshData data, double scale, int& compared, int& skipped)
{
  data.transform([=](const Vec3& p) { return scale * p; });
  const Mesh mesh(data.view());
  const std::vector<double> start = data.points;
  Random random(33);
  std::vector<double> direction(start.size());
  for (std::size_t i = 0; i < direction.size(); ++i)
  {
    const bool flat = i % 3 == 2 && mesh.dimension() == Dimension::Planar;
    direction[i] = flat ? 0.0 : random.uniform(-1, 1);
  }
  forEachObjective(mesh,
    [&](Objective objective, const MetricInfo&)
    {
      objective.evaluation.parameters.beta *=
        std::pow(scale, topology(mesh.blocks()[0].type).dimension);
      if (objective.objectiveTemplate == ObjectiveTemplate::Maximum)
      {
        objective.power =
          8 / std::max(1e-300, largestSize(valuesOf(mesh, objective.metric, objective.evaluation)));
      }
      const ObjectiveSum sum(mesh, objective);
      std::vector<double> gradient(start.size(), 0.0);
      const double value = sum.addGradient(1, gradient.data());
      if (!TAUTLINE_CHECK(std::isfinite(value)))
      {
        return;
      }
      const double step = 1e-4 * scale;
      auto at = [&](int s)
      {
        for (std::size_t i = 0; i < start.size(); ++i)
        {
          data.points[i] = start[i] + s * step * direction[i];
        }
        const double result = sum.value();
        data.points = start;
        return result;
      };
      const double near = (at(1) - at(-1)) / (2 * step), far = (at(2) - at(-2)) / (4 * step);
      const double slope = (4 * near - far) / 3;
      const double length =
        std::sqrt(std::inner_product(gradient.begin(), gradient.end(), gradient.begin(), 0.0));
      const double rounding = 1e-11 * std::abs(value) / scale;
      if (std::abs(near - far) > kinkThreshold * length + rounding)
      {
        ++skipped;
        return;
      }
      ++compared;
      TAUTLINE_CHECK_NEAR(
        std::inner_product(gradient.begin(), gradient.end(), direction.begin(), 0.0), slope,
        differenceTolerance * length + rounding);
    });
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testThreads)
{
  MeshData data = movedBlock(CellType::Tetrahedron, 12, 0.1);
  append(data, movedBlock(CellType::Hexahedron, 17, 0.1));
  for (const MeshData& mesh : { data, shuffled(data, 34) })
  {
    const Mesh view(mesh.view());
    for (Metric metric : { Metric::InverseMeanRatio, Metric::ConditioningScaleInvariant,
           Metric::ScaledJacobian, Metric::UntangleBeta, Metric::SizeBarrierSquared })
    {
      for (ObjectiveTemplate objectiveTemplate : templates)
      {
        if (!applies(metricInfo(metric), objectiveTemplate, view))
        {
          continue;
        }
        const Objective objective = make(metric, objectiveTemplate);
        std::vector<double> first(mesh.points.size(), 0.0);
        const ObjectiveSum one(view, objective, 1);
        const double value = one.addGradient(1, first.data()), firstValue = one.value();
        for (int threads : { 2, 4 })
        {
          std::vector<double> gradient(mesh.points.size(), 0.0);
          const ObjectiveSum sum(view, objective, threads);
          TAUTLINE_CHECK_EQUAL(sum.addGradient(1, gradient.data()), value);
          TAUTLINE_CHECK_EQUAL(sum.value(), firstValue);
          TAUTLINE_CHECK(gradient == first);
        }
      }
    }
  }
}

/// The rules of the header for inverted and degenerate elements.
TAUTLINE_PART(testFaults)
{
  auto value =
    [](const std::vector<Vec3>& corners, Metric metric, ObjectiveTemplate objectiveTemplate)
  {
    const MeshData data = singleCell(CellType::Tetrahedron, corners);
    const Mesh mesh(data.view());
    return ObjectiveSum(mesh, make(metric, objectiveTemplate)).value();
  };
  using T = ObjectiveTemplate;
  const std::vector<Vec3> ideal = idealCell(CellType::Tetrahedron);
  std::vector<Vec3> inverted = ideal, flat = ideal, broken = ideal;
  std::swap(inverted[0], inverted[1]);
  flat[3] = { 0.5, 0.3, 0 };
  broken[3][1] = std::nan("");
  for (Metric metric : { Metric::InverseMeanRatio, Metric::SizeBarrier, Metric::ShapeSizeBarrier,
         Metric::SizeBarrierSquared, Metric::ShapeSizeLogarithm, Metric::ShapeCubic })
  {
    const Context name(metricInfo(metric).name);
    for (T objectiveTemplate : { T::SumOfSquares, T::Sum, T::PowerMean, T::Maximum })
    {
      // The ideal element of some has q = 0 up to rounding, and is not at fault.
      TAUTLINE_CHECK(std::isfinite(value(ideal, metric, objectiveTemplate)));
      for (const auto& bad : { inverted, flat, broken })
      {
        TAUTLINE_CHECK_EQUAL(value(bad, metric, objectiveTemplate), infinity);
      }
    }
  }
  const double si = valueOf(CellType::Tetrahedron, ideal, Metric::ConditioningScaleInvariant);
  TAUTLINE_CHECK_RELATIVE(
    value(inverted, Metric::ConditioningScaleInvariant, T::SumOfReciprocals), -1 / si, 1e-14);
  TAUTLINE_CHECK_EQUAL(
    value(flat, Metric::ConditioningScaleInvariant, T::SumOfReciprocals), infinity);
  TAUTLINE_CHECK_EQUAL(
    value(inverted, Metric::ConditioningScaleInvariant, T::SumOfSquaredReciprocals), infinity);
  TAUTLINE_CHECK_EQUAL(value(inverted, Metric::MeanRatio, T::PowerMean), infinity);
  TAUTLINE_CHECK_RELATIVE(value(inverted, Metric::MeanRatio, T::Sum), 1.0, 1e-14);

  // An objective that can untangle is finite, and larger the more an element is inverted.
  int untangling = 0;
  for (const MetricInfo& info : elementMetrics())
  {
    for (T objectiveTemplate : templates)
    {
      const Objective objective = make(info.metric, objectiveTemplate);
      if (!canUntangle(objective) || !info.definedOn(CellType::Tetrahedron))
      {
        continue;
      }
      const Context name(
        std::string(info.name) + " " + std::to_string(static_cast<int>(objectiveTemplate)));
      ++untangling;
      double last = -infinity;
      for (double height : { 0.7, 0.0, -0.2, -0.5 })
      {
        std::vector<Vec3> corners = ideal;
        corners[3][2] = height;
        const double now = value(corners, info.metric, objectiveTemplate);
        TAUTLINE_CHECK(std::isfinite(now) && now > last);
        last = now;
      }
    }
  }
  TAUTLINE_CHECK(untangling >= 20);
  TAUTLINE_CHECK(!canUntangle(make(Metric::InverseMeanRatio, T::Default)));
  TAUTLINE_CHECK(!canUntangle(make(Metric::ConditioningScaleInvariant, T::Default)));
  TAUTLINE_CHECK(!canUntangle(make(Metric::Size, T::Default)));
  TAUTLINE_CHECK(canUntangle(make(Metric::UntangleBeta, T::Default)));

  TAUTLINE_CHECK(defaultTemplate(Metric::ConditioningScaleInvariant) == T::SumOfReciprocals);
  TAUTLINE_CHECK(defaultTemplate(Metric::InterpolationSizeShape) == T::SumOfSquaredReciprocals);
  for (Metric metric : { Metric::InverseMeanRatio, Metric::Size, Metric::UntangleBeta })
  {
    TAUTLINE_CHECK(defaultTemplate(metric) == T::SumOfSquares);
  }
}

/// Bounds and limits of the mean and the smooth maximum, with powers that overflow by themselves.
TAUTLINE_PART(testStability)
{
  const MeshData data = movedBlock(CellType::Tetrahedron, 4, 0.1);
  const Mesh mesh(data.view());
  std::vector<double> q = valuesOf(mesh, Metric::InverseMeanRatio);
  const double worst = *std::max_element(q.begin(), q.end());
  const double count = static_cast<double>(q.size());
  for (double power : { 1.0, 7.5, 2000.0, 1e6 })
  {
    const Context name("power " + std::to_string(power));
    Objective objective = make(Metric::InverseMeanRatio, ObjectiveTemplate::Maximum);
    objective.power = power;
    const double maximum = ObjectiveSum(mesh, objective).value();
    TAUTLINE_CHECK(
      maximum >= worst * (1 - 1e-14) && maximum <= worst + std::log(count) / power * (1 + 1e-14));
    objective.objectiveTemplate = ObjectiveTemplate::PowerMean;
    std::vector<double> gradient(data.points.size(), 0.0);
    const double mean = ObjectiveSum(mesh, objective).addGradient(1, gradient.data());
    TAUTLINE_CHECK(
      mean <= worst * (1 + 1e-14) && mean >= worst * std::pow(count, -1 / power) * (1 - 1e-14));
    TAUTLINE_CHECK(std::isfinite(largestSize(gradient)) && largestSize(gradient) > 0);
  }
}

TAUTLINE_PART(testErrors)
{
  using T = ObjectiveTemplate;
  const MeshData tets = movedBlock(CellType::Tetrahedron, 1, 0),
                 quads = movedBlock(CellType::Quadrilateral, 2, 0);
  const Mesh mesh(tets.view()), flat(quads.view());
  auto make1 = [&](Metric metric, T objectiveTemplate, double power = 8)
  {
    Objective objective = TAUTLINE_CHANGED(make(metric, objectiveTemplate), power = power);
    ObjectiveSum(mesh, objective);
  };
  TAUTLINE_CHECK_THROWS(make1(Metric::WidthRatio, T::Sum), wording("not-defined-on-any-cell"));
  TAUTLINE_CHECK_THROWS(
    ObjectiveSum(flat, make(Metric::RadiusRatio, T::Default)), wording("not-defined-on-any-cell"));
  const MeshData nothing;
  TAUTLINE_CHECK_THROWS(
    ObjectiveSum(Mesh(nothing.view()), Objective{}), wording("not-defined-on-any-cell"));
  TAUTLINE_CHECK_THROWS(make1(Metric::MeanRatio, T::SumOfSquares), wording("sum-of-reciprocals"));
  TAUTLINE_CHECK_THROWS(
    make1(Metric::InverseMeanRatio, T::SumOfReciprocals), wording("sum-of-squares"));
  TAUTLINE_CHECK_THROWS(make1(Metric::InverseMeanRatio, static_cast<T>(6)), "number 6");
  TAUTLINE_CHECK_THROWS(make1(Metric::InverseMeanRatio, T::PowerMean, 0.5), wording("at-least-1"));
  TAUTLINE_CHECK_THROWS(make1(Metric::InverseMeanRatio, T::Maximum, 0), "above 0");
  TAUTLINE_CHECK_THROWS(make1(Metric::InverseMeanRatio, T::Maximum, std::nan("")), "above 0");
  Objective objective;
  std::vector<double> weights(tets.numberOfCells(), 1.0);
  objective.elementWeights = weights.data();
  for (double bad : { -1.0, std::nan(""), infinity })
  {
    weights[3] = bad;
    TAUTLINE_CHECK_THROWS(ObjectiveSum(mesh, objective), wording("weight-of-cell-3"));
  }
  std::fill(weights.begin(), weights.end(), 0.0);
  TAUTLINE_CHECK_THROWS(ObjectiveSum(mesh, objective), wording("all-elements-are-0"));
  TAUTLINE_SET(objective, elementWeights = nullptr, weight = 0);
  TAUTLINE_CHECK_THROWS(ObjectiveSum(mesh, objective), wording("weight-of-an-objective"));
}
}

TAUTLINE_TEST(TestObjectives)
{
  int infinite = 0, compared = 0, skipped = 0;
  for (bool tangled : { false, true })
  {
    for (const NamedMesh& mesh : makeMeshes(tangled ? 0.7 : 0.12))
    {
      const Context name(mesh.name + (tangled ? ", tangled" : ""));
      TAUTLINE_RUN(testByHand(mesh.data, tangled, infinite));
    }
  }
  TAUTLINE_CHECK(infinite > 100);
  for (double scale : { 1.0, 1e-8, 1e8 })
  {
    const Context size("scale " + std::to_string(scale));
    for (const NamedMesh& mesh : makeMeshes(0.12))
    {
      const Context name(mesh.name);
      TAUTLINE_RUN(testDifferences(mesh.data, scale, compared, skipped));
    }
  }
  std::cout << compared << " gradients compared, " << skipped << " skipped at kinks\n";
  TAUTLINE_CHECK(skipped * 20 < compared);
}
