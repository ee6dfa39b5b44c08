// SPDX-License-Identifier: BSD-3-Clause
// Summaries of a metric against sums done by hand and by brute force.
#include "Meshes.h"
#include "Registry.h"
#include "tautline/Quality/Statistics.h"

using namespace tautline;

namespace
{
const MetricInfo& imr =
  metricInfo(Metric::InverseMeanRatio);                      // smaller is better, inverted negative
const MetricInfo& meanRatio = metricInfo(Metric::MeanRatio); // larger is better
const MetricInfo& size = metricInfo(Metric::Size);           // neutral
const MetricInfo& untangle = metricInfo(Metric::UntangleBeta); // orders inverted elements

constexpr unsigned char triangle = 5, tetrahedron = 10, line = 3, quadraticTriangle = 22;

/// Values of cells with their validity and type.
struct Cells
{
  std::vector<double> values;
  std::vector<signed char> validity;
  std::vector<unsigned char> types, skip;
  void add(double value, signed char v = Valid, unsigned char type = triangle, bool skipped = false)
  {
    this->values.push_back(value);
    this->validity.push_back(v);
    this->types.push_back(type);
    this->skip.push_back(skipped);
  }
  CellValues view(bool withSkip = true) const
  {
    return { static_cast<Index>(this->values.size()), this->values.data(), this->validity.data(),
      this->types.data(), withSkip ? this->skip.data() : nullptr };
  }
};

//------------------------------------------------------------------------------
TAUTLINE_PART(testMeasured)
{
  Cells cells;
  cells.add(1);
  cells.add(-2, Inverted);
  cells.add(0, Degenerate);
  cells.add(0, NotMeasured, line);
  cells.add(7, NonFinite);
  cells.add(3, Valid, triangle, true);
  cells.add(4, Valid, quadraticTriangle);
  cells.add(5, Valid, tetrahedron);
  TAUTLINE_CHECK((measuredValues(imr, cells.view()) == std::vector<double>{ 1, -2, 4, 5 }));
  TAUTLINE_CHECK((measuredValues(imr, cells.view(false)) == std::vector<double>{ 1, -2, 3, 4, 5 }));
  TAUTLINE_CHECK((measuredValues(untangle, cells.view()) == std::vector<double>{ 1, -2, 4, 5 }));
  // W/w is of triangles only.
  const MetricInfo& width = metricInfo(Metric::WidthRatio);
  TAUTLINE_CHECK((measuredValues(width, cells.view()) == std::vector<double>{ 1, -2, 4 }));

  const ValidityCounts counts = countValidity(cells.validity.data(), cells.skip.data(), 8);
  TAUTLINE_CHECK_EQUAL(counts.valid, 3);
  TAUTLINE_CHECK_EQUAL(counts.inverted, 1);
  TAUTLINE_CHECK_EQUAL(counts.degenerate, 1);
  TAUTLINE_CHECK_EQUAL(counts.notMeasured, 1);
  TAUTLINE_CHECK_EQUAL(counts.nonFinite, 1);
  TAUTLINE_CHECK_EQUAL(countValidity(cells.validity.data(), nullptr, 8).valid, 4);
}

/// The worst value is one of the measured ones: of an inverted element if there are any, otherwise
/// the extreme in the direction of the metric.
TAUTLINE_PART(testWorstValue)
{
  const auto worst = [](const MetricInfo& info, const Cells& cells)
  {
    const CellValues data = cells.view();
    return worstValue(
      info, summarize(info, 2, measuredValues(info, data)), worstElements(info, data));
  };
  Cells cells;
  TAUTLINE_CHECK_EQUAL(worst(imr, cells), 0.0);
  cells.add(2);
  cells.add(0.5);
  cells.add(0, Degenerate);
  cells.add(9, Valid, triangle, true);
  TAUTLINE_CHECK_EQUAL(worst(imr, cells), 2.0);
  TAUTLINE_CHECK_EQUAL(worst(meanRatio, cells), 0.5);
  TAUTLINE_CHECK_EQUAL(worst(size, cells), 0.5);
  cells.add(-0.25, Inverted);
  cells.add(-3, Inverted);
  TAUTLINE_CHECK_EQUAL(worst(imr, cells), -0.25);
  TAUTLINE_CHECK_EQUAL(worst(meanRatio, cells), -3.0);
  TAUTLINE_CHECK_EQUAL(worst(size, cells), -3.0);
}

TAUTLINE_PART(testByHand)
{
  std::vector<double> values = { 4, 1, 3, 2 };
  const MetricStatistics s = summarize(imr, 2, values); // acceptable: 1 to 3
  TAUTLINE_CHECK_EQUAL(s.measured, 4);
  TAUTLINE_CHECK_EQUAL(s.minimum, 1.0);
  TAUTLINE_CHECK_EQUAL(s.maximum, 4.0);
  TAUTLINE_CHECK_NEAR(s.mean, 2.5, 1e-15);
  TAUTLINE_CHECK_NEAR(s.rms, std::sqrt(7.5), 1e-15);
  TAUTLINE_CHECK_NEAR(s.standardDeviation, std::sqrt(1.25), 1e-15);
  TAUTLINE_CHECK_EQUAL(s.outsideAcceptable, 1);
  // Quantiles at 3 x fraction between the sorted values.
  const double expected[] = { 1.03, 1.15, 1.75, 2.5, 3.25, 3.85, 3.97 };
  TAUTLINE_EACH(std::size_t, i, quantileFractions.size(),
    TAUTLINE_CHECK_NEAR(s.quantiles[i], expected[i], 1e-14));

  const MetricStatistics without = summarize(imr, 2, values, false);
  TAUTLINE_CHECK(without.quantiles == decltype(without.quantiles){});
  TAUTLINE_CHECK_EQUAL(without.mean, s.mean);
  TAUTLINE_CHECK_EQUAL(without.rms, s.rms);
  TAUTLINE_CHECK_EQUAL(without.standardDeviation, s.standardDeviation);
  TAUTLINE_CHECK_EQUAL(without.outsideAcceptable, s.outsideAcceptable);

  std::vector<double> none, one = { 2 };
  const MetricStatistics empty = summarize(imr, 2, none), single = summarize(imr, 2, one);
  TAUTLINE_CHECK_EQUAL(empty.measured, 0);
  TAUTLINE_CHECK_EQUAL(empty.mean, 0.0);
  TAUTLINE_CHECK_EQUAL(single.mean, 2.0);
  TAUTLINE_CHECK_EQUAL(single.standardDeviation, 0.0);
  TAUTLINE_CHECK_EQUAL(single.quantiles[0], 2.0);
  TAUTLINE_CHECK_EQUAL(single.quantiles[6], 2.0);
  // The acceptable range depends on the dimension: minimum angles down to 20 or to 15 degrees.
  std::vector<double> angles = { 10, 17, 30 };
  const MetricInfo& angle = metricInfo(Metric::MinimumAngle);
  TAUTLINE_CHECK_EQUAL(summarize(angle, 2, angles).outsideAcceptable, 2);
  TAUTLINE_CHECK_EQUAL(summarize(angle, 3, angles).outsideAcceptable, 1);
}

TAUTLINE_PART(testRandom)
{
  Random random(19);
  for (int n : { 2, 3, 7, 100, 101, 4999 })
  {
    std::vector<double> values;
    for (int i = 0; i < n; ++i)
    {
      // Many equals among them.
      values.push_back(i % 3 ? random.uniform(0, 10) : static_cast<double>(random.integer(5)));
    }
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    long double sum = 0, squares = 0;
    for (double v : values)
    {
      sum += v;
      squares += static_cast<long double>(v) * v;
    }
    const double mean = static_cast<double>(sum / n);
    const double variance = static_cast<double>(squares / n - (sum / n) * (sum / n));
    const MetricStatistics s = summarize(size, 3, values);
    TAUTLINE_CHECK_EQUAL(s.minimum, sorted.front());
    TAUTLINE_CHECK_EQUAL(s.maximum, sorted.back());
    TAUTLINE_CHECK_RELATIVE(s.mean, mean, 1e-13);
    TAUTLINE_CHECK_RELATIVE(s.rms, std::sqrt(static_cast<double>(squares / n)), 1e-13);
    TAUTLINE_CHECK_RELATIVE(s.standardDeviation, std::sqrt(variance), 1e-12);
    for (std::size_t i = 0; i < quantileFractions.size(); ++i)
    {
      const double position = quantileFractions[i] * (n - 1);
      const int below = static_cast<int>(position);
      const double part = position - below;
      const double expected =
        (1 - part) * sorted[below] + part * sorted[std::min(n - 1, below + 1)];
      TAUTLINE_CHECK_NEAR(s.quantiles[i], expected, 1e-13);
    }
  }
}

TAUTLINE_PART(testMagnitudes)
{
  for (double unit : { 1e-300, 1e-200, 1e200, 1e300 })
  {
    std::vector<double> values = { 1 * unit, 2 * unit, 3 * unit, 4 * unit };
    const MetricStatistics s = summarize(size, 3, values);
    TAUTLINE_CHECK_RELATIVE(s.mean, 2.5 * unit, 1e-14);
    TAUTLINE_CHECK_RELATIVE(s.rms, std::sqrt(7.5) * unit, 1e-14);
    TAUTLINE_CHECK_RELATIVE(s.standardDeviation, std::sqrt(1.25) * unit, 1e-14);
    TAUTLINE_CHECK_RELATIVE(s.quantiles[3], 2.5 * unit, 1e-14);
    const Histogram h = histogram(values, 3);
    TAUTLINE_CHECK((h.counts == std::vector<Index>{ 1, 1, 2 }));
  }
  // Values that differ in the last digits only.
  std::vector<double> near(1000, 1.0);
  for (std::size_t i = 0; i < near.size(); i += 2)
  {
    near[i] += 1e-13;
  }
  TAUTLINE_CHECK_NEAR(summarize(size, 3, near).standardDeviation, 0.5e-13, 1e-15);
  std::vector<double> same(1000, 0.1);
  TAUTLINE_CHECK_NEAR(summarize(size, 3, same).standardDeviation, 0, 1e-16);
  // The ends of the range of double precision.
  constexpr double most = std::numeric_limits<double>::max();
  std::vector<double> extremes = { -most, most };
  const MetricStatistics s = summarize(size, 3, extremes);
  TAUTLINE_CHECK_NEAR(s.mean, 0, 0);
  TAUTLINE_CHECK_RELATIVE(s.rms, most, 1e-14);
  TAUTLINE_CHECK_RELATIVE(s.standardDeviation, most, 1e-14);
  TAUTLINE_EACH_OF(double quantile, s.quantiles, TAUTLINE_CHECK(std::isfinite(quantile)));
  const Histogram h = histogram(extremes, 4);
  TAUTLINE_CHECK((h.counts == std::vector<Index>{ 1, 0, 0, 1 }));
  TAUTLINE_CHECK(h.edges.front() == -most && h.edges.back() == most && h.edges[2] == 0);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testHistogram)
{
  // The upper end belongs to the last bin, every other edge to the bin above it.
  const Histogram h = histogram({ 0, 0.5, 1, 1.5, 2, 3, 4, 4 }, 4);
  TAUTLINE_CHECK((h.edges == std::vector<double>{ 0, 1, 2, 3, 4 }));
  TAUTLINE_CHECK((h.counts == std::vector<Index>{ 2, 2, 1, 3 }));
  const Histogram equal = histogram({ 2, 2, 2 }, 5);
  TAUTLINE_CHECK_EQUAL(std::accumulate(equal.counts.begin(), equal.counts.end(), Index(0)), 3);
  const Histogram none = histogram({}, 3);
  TAUTLINE_CHECK(none.edges.front() == 0 && none.edges.back() == 1);
  TAUTLINE_CHECK((none.counts == std::vector<Index>{ 0, 0, 0 }));
  TAUTLINE_CHECK_THROWS(histogram({ 1 }, 0), wording("at-least-one-bin"));

  Random random(20);
  auto values = collect<double>(10000, [&](int) { return random.uniform(-3, 5); });
  const Histogram r = histogram(values, 37);
  for (std::size_t bin = 0; bin < r.counts.size(); ++bin)
  {
    const auto inside = std::count_if(values.begin(), values.end(),
      [&](double v)
      { return v >= r.edges[bin] && (v < r.edges[bin + 1] || bin + 1 == r.counts.size()); });
    TAUTLINE_CHECK_EQUAL(r.counts[bin], inside);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testAcceptableHistogram)
{
  // The acceptable inverse mean ratios are 1 to 3: one extreme value does not widen the bins.
  const AcceptableHistogram h =
    acceptableHistogram(imr, 3, { 1, 1.2, 1.6, 2.9, 3, 3 + 1e-13, 3.1, 99.9 }, 4);
  TAUTLINE_CHECK((h.edges == std::vector<double>{ 1, 1.5, 2, 2.5, 3 }));
  TAUTLINE_CHECK((h.counts == std::vector<Index>{ 2, 1, 0, 3 }));
  TAUTLINE_CHECK_EQUAL(h.below, 0);
  TAUTLINE_CHECK_EQUAL(h.above, 2);
  // Where larger is better, the unacceptable values are below: 1/3 to 1.
  const AcceptableHistogram larger = acceptableHistogram(meanRatio, 2, { 0.1, 0.2, 0.4, 1 }, 2);
  TAUTLINE_CHECK_EQUAL(larger.below, 2);
  TAUTLINE_CHECK((larger.counts == std::vector<Index>{ 1, 1 }));
  TAUTLINE_CHECK_EQUAL(larger.above, 0);
  // The values take the place of an end that is not bounded, or of a range without width.
  const AcceptableHistogram unbounded = acceptableHistogram(size, 3, { 1, 4 }, 3);
  TAUTLINE_CHECK((unbounded.counts == std::vector<Index>{ 1, 0, 1 }));
  TAUTLINE_CHECK_EQUAL(unbounded.edges.back(), 4);
  const AcceptableHistogram flat = acceptableHistogram(untangle, 3, { -2, 0, 2 }, 2);
  TAUTLINE_CHECK((flat.counts == std::vector<Index>{ 1, 2 }));
  TAUTLINE_CHECK_EQUAL(flat.below + flat.above, 0);
  const AcceptableHistogram none = acceptableHistogram(imr, 3, {}, 2);
  TAUTLINE_CHECK((none.edges == std::vector<double>{ 1, 2, 3 }));
  TAUTLINE_CHECK_THROWS(acceptableHistogram(imr, 3, { 1 }, 0), wording("at-least-one-bin"));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testWorst)
{
  Cells cells;
  cells.add(1.5);
  cells.add(9);
  cells.add(0, Degenerate);
  cells.add(-3, Inverted);
  cells.add(9);
  cells.add(100, NonFinite);
  cells.add(0, NotMeasured, line);
  cells.add(50, Valid, triangle, true);
  auto ids = [&](const MetricInfo& info)
  {
    return collect<Index>(worstElements(info, cells.view()),
      [&](const WorstElement& e)
      {
        TAUTLINE_CHECK_EQUAL(e.value, cells.values[e.cell]);
        TAUTLINE_CHECK_EQUAL(int(e.validity), int(cells.validity[e.cell]));
        return e.cell;
      });
  };
  TAUTLINE_CHECK((ids(imr) == std::vector<Index>{ 3, 2, 1, 4, 0 }));
  TAUTLINE_CHECK((ids(meanRatio) == std::vector<Index>{ 3, 2, 0, 1, 4 }));
  TAUTLINE_CHECK((ids(size) == std::vector<Index>{ 3, 2, 0, 1, 4 }));

  // Ten of many, against sorting all.
  Random random(21);
  Cells many;
  for (int i = 0; i < 3000; ++i)
  {
    const Index kind = random.integer(500);
    many.add(random.integer(40) / 4.0, kind == 0 ? Inverted : kind == 1 ? Degenerate : Valid);
  }
  for (const MetricInfo* info : { &imr, &meanRatio, &size, &untangle })
  {
    std::vector<WorstElement> all;
    for (Index i = 0; i < 3000; ++i)
    {
      all.push_back({ i, many.values[i], many.validity[i] });
    }
    const double sign = info->direction == Direction::SmallerIsBetter ? -1 : 1;
    std::sort(all.begin(), all.end(),
      [&](const WorstElement& a, const WorstElement& b)
      {
        return std::make_tuple(a.validity, sign * a.value, a.cell) <
          std::make_tuple(b.validity, sign * b.value, b.cell);
      });
    const std::vector<WorstElement> worst = worstElements(*info, many.view());
    TAUTLINE_CHECK_EQUAL(worst.size(), static_cast<std::size_t>(WorstCount));
    TAUTLINE_EACH(std::size_t, i, worst.size(), TAUTLINE_CHECK_EQUAL(worst[i].cell, all[i].cell));
  }
}

//------------------------------------------------------------------------------
using Counts = std::array<Index, angleBins.size() - 1>;

Counts distributionOf(const MeshData& data, const std::vector<unsigned char>& skip = {})
{
  const Mesh mesh(data.view());
  return angleDistribution(mesh, validityOf(mesh).data(), skip.empty() ? nullptr : skip.data());
}

/// The bins of Table 2.7: up to 20, 40, 80, 100 and 180 degrees.
TAUTLINE_PART(testAngles)
{
  // A triangle of 10, 30 and 140 degrees, and one of 90, 60 and 30.
  auto withAngles = [](double first, double second)
  {
    const double a = first * M_PI / 180, b = second * M_PI / 180;
    const double side = std::sin(b) / std::sin(a + b);
    return std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 },
      { side * std::cos(a), side * std::sin(a), 0 } };
  };
  TAUTLINE_LET(MeshData, data, addCell(CellType::Triangle, withAngles(10, 30)));
  TAUTLINE_CHECK((distributionOf(data) == Counts{ 1, 1, 0, 0, 1 }));
  data.addCell(CellType::Triangle, withAngles(90, 60));
  TAUTLINE_CHECK((distributionOf(data) == Counts{ 1, 2, 1, 1, 1 }));
  TAUTLINE_CHECK((distributionOf(data, { 1, 0 }) == Counts{ 0, 1, 1, 1, 0 }));
  // Reversed ones count, flat and non-finite ones do not.
  data.addCell(CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 } });
  data.addCell(CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } });
  data.addCell(
    CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, std::nan(""), 0 } });
  TAUTLINE_CHECK((distributionOf(data) == Counts{ 1, 2, 3, 2, 1 }));
  // A dart: 90, 2 twice, and a reflex corner of 266, listed either way round.
  const std::vector<Vec3> dart = { { 0, 0, 0 }, { 3, 0, 0 }, { 0.1, 0.1, 0 }, { 0, 3, 0 } };
  const MeshData darts[] = { singleCell(CellType::Quadrilateral, dart),
    singleCell(CellType::Quadrilateral, { dart[0], dart[3], dart[2], dart[1] }) };
  TAUTLINE_CHECK((distributionOf(darts[0]) == Counts{ 2, 0, 0, 1, 1 }));
  TAUTLINE_CHECK((distributionOf(darts[1]) == Counts{ 2, 0, 0, 1, 1 }));
  // In a volume mesh the dihedral angles of the cells with a volume: 6 x 70.5, and 12 x 90.
  data.addCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron));
  TAUTLINE_CHECK((distributionOf(data) == Counts{ 0, 0, 6, 0, 0 }));
  data.addCell(CellType::Hexahedron, idealCell(CellType::Hexahedron));
  TAUTLINE_CHECK((distributionOf(data) == Counts{ 0, 0, 6, 12, 0 }));
  data.addCell(CellType::Pyramid, idealCell(CellType::Pyramid)); // 4 x 54.7, 4 x 109.5
  data.addCell(CellType::Wedge, idealCell(CellType::Wedge));     // 3 x 60, 6 x 90
  TAUTLINE_CHECK((distributionOf(data) == Counts{ 0, 0, 13, 18, 4 }));

  // Against brute force, for any number of threads.
  Random random(22);
  MeshData many;
  Counts expected = {};
  for (int i = 0; i < 20000; ++i)
  {
    const std::vector<Vec3> p = validCell(CellType::Triangle, 0.6, 0.01, random);
    many.addCell(CellType::Triangle, p);
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      const double angle = std::acos(dot(a, b) / (norm(a) * norm(b))) * 180 / M_PI;
      ++expected[std::upper_bound(angleBins.begin() + 1, angleBins.end() - 1, angle) -
        angleBins.begin() - 1];
    }
  }
  const Mesh mesh(many.view());
  const std::vector<signed char> validity = validityOf(mesh);
  for (int threads : { 1, 2, 3 })
  {
    TAUTLINE_CHECK(angleDistribution(mesh, validity.data(), nullptr, threads) == expected);
  }
}
}
