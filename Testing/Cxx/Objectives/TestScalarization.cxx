// SPDX-License-Identifier: BSD-3-Clause
// Scalarizations: values against closed forms in long double, slopes against fourth-order
// differences, extreme values, errors.
#include "Registry.h"
#include "tautline/Objectives/Scalarization.h"

#include <limits>

using namespace tautline;

namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Scalarization methods[] = { Scalarization::ExponentialSum,
  Scalarization::ObjectiveProduct, Scalarization::EqualSum, Scalarization::WeightedSum,
  Scalarization::WeightedMinMax, Scalarization::ExponentialWeighted, Scalarization::Lexicographic,
  Scalarization::Rao };

using Values = std::vector<double>;

ScalarizationOptions optionsFor(Scalarization method)
{
  return TAUTLINE_CHANGED(ScalarizationOptions(), method = method);
}

/// The formula of the header, term by term, in long double.
long double closedForm(
  const ScalarizationOptions& o, double c, const Values& w, const Values& initial, const Values& f)
{
  long double sum = 0, product = 1;
  for (std::size_t i = 0; i < f.size(); ++i)
  {
    const long double u = o.utopia.empty() ? 0 : o.utopia[i];
    const long double z = (f[i] - u) / std::abs(initial[i] - u);
    switch (o.method)
    {
      case Scalarization::ExponentialSum:
        sum += std::exp(static_cast<long double>(f[i]) / c);
        break;
      case Scalarization::ObjectiveProduct:
        product *= f[i];
        break;
      case Scalarization::EqualSum:
        sum += f[i];
        break;
      case Scalarization::WeightedSum:
        sum += w[i] * f[i];
        break;
      case Scalarization::WeightedMinMax:
        sum += std::exp(w[i] * z / c);
        break;
      case Scalarization::ExponentialWeighted:
        sum += std::expm1(static_cast<long double>(o.exponent) * w[i]) * std::exp(o.exponent * z);
        break;
      case Scalarization::Lexicographic:
        sum += i == 0 ? f[0] : 0;
        break;
      case Scalarization::Rao:
        product *= 1 - z / 2;
        break;
    }
  }
  switch (o.method)
  {
    case Scalarization::ExponentialSum:
    case Scalarization::WeightedMinMax:
      return c * std::log(sum);
    case Scalarization::ExponentialWeighted:
      return std::log(sum) / o.exponent;
    case Scalarization::ObjectiveProduct:
      return product;
    case Scalarization::Rao:
      return -std::log(product);
    default:
      return sum;
  }
}

void testSlopes(const Scalarizer& scalarizer, const Values& f, double step = 3e-4)
{
  Values slopes;
  const double value = scalarizer.value(f, slopes);
  TAUTLINE_CHECK_EQUAL(scalarizer.value(f), value);
  for (std::size_t i = 0; i < f.size(); ++i)
  {
    auto at = [&](int s)
    {
      Values moved = f;
      moved[i] += s * step;
      return scalarizer.value(moved);
    };
    const double expected = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
    TAUTLINE_CHECK_NEAR(
      slopes[i], expected, 1e-8 * std::abs(expected) + 1e-13 * std::abs(value) / step);
    TAUTLINE_CHECK(slopes[i] >= 0);
  }
}

TAUTLINE_PART(testClosedForms)
{
  const Values weights = { 0.5, 2, 1 }, initial = { 3, 40, 7 };
  for (Scalarization method : methods)
  {
    for (bool utopia : { false, true })
    {
      for (double c : { 0.0, 5.0 })
      {
        const Context name("method " + std::to_string(static_cast<int>(method)));
        ScalarizationOptions options = TAUTLINE_CHANGED(optionsFor(method), c = c, exponent = 1.5);
        options.utopia = utopia ? Values{ 0.5, -10, 1 } : Values{};
        const Scalarizer scalarizer(options, weights, initial);
        for (const Values& f : { initial, Values{ 2, 31, 6.5 }, Values{ 1, 41, 0.25 } })
        {
          const double expected =
            static_cast<double>(closedForm(options, scalarizer.c(), weights, initial, f));
          TAUTLINE_CHECK_RELATIVE(scalarizer.value(f), expected, 1e-13);
          testSlopes(scalarizer, f);
        }
      }
    }
  }
  // One objective: the exponential sum and the smooth maximum are the objective itself.
  TAUTLINE_CHECK_EQUAL(
    Scalarizer(optionsFor(Scalarization::ExponentialSum), { 1 }, { 5 }).value({ 3.0 }), 3.0);
  // c chosen: a tenth of the largest value.
  TAUTLINE_CHECK_NEAR(
    Scalarizer(optionsFor(Scalarization::ExponentialSum), { 1, 1 }, { 5, -700 }).c(), 70, 1e-12);
  TAUTLINE_CHECK_EQUAL(
    Scalarizer(optionsFor(Scalarization::ExponentialSum), { 1, 1 }, { 0, 0 }).c(), 1.0);
  // The smooth maximum: a tenth of the largest weight.
  TAUTLINE_CHECK_RELATIVE(
    Scalarizer(optionsFor(Scalarization::WeightedMinMax), { 2, 5 }, { 7, 3 }).c(), 0.5, 1e-15);
}

TAUTLINE_PART(testExtremes)
{
  Values slopes;
  ScalarizationOptions options = optionsFor(Scalarization::ExponentialSum);
  options.c = 10;
  const Scalarizer exponential(options, { 1, 1 }, { 1, 1 });
  // F / c = 5000 and 4999.9: exp() of either overflows.
  TAUTLINE_CHECK_RELATIVE(
    exponential.value({ 50000, 49999 }, slopes), 50000 + 10 * std::log1p(std::exp(-0.1)), 1e-15);
  TAUTLINE_CHECK_RELATIVE(slopes[0], 1 / (1 + std::exp(-0.1)), 1e-14);
  testSlopes(exponential, { 50000, 49999 }, 0.1);
  testSlopes(exponential, { -80000, -80003 }, 0.1);
  TAUTLINE_CHECK_RELATIVE(exponential.value({ 0, 0 }), 10 * std::log(2.0), 1e-15);
  TAUTLINE_CHECK_EQUAL(exponential.value({ 1e300, -1e300 }, slopes), 1e300);
  TAUTLINE_CHECK(slopes[0] == 1 && slopes[1] == 0);

  const Scalarizer product(optionsFor(Scalarization::ObjectiveProduct), { 1, 1, 1 }, { 1, 1, 1 });
  TAUTLINE_CHECK_EQUAL(product.value({ 0, 3, 4 }, slopes), 0.0);
  TAUTLINE_CHECK(slopes == (Values{ 12, 0, 0 }));
  TAUTLINE_CHECK_EQUAL(product.value({ -1, -2, 3 }, slopes), infinity);
  TAUTLINE_CHECK(slopes == (Values{ 0, 0, 0 }));
  TAUTLINE_CHECK_RELATIVE(product.value({ 1e300, 1e300, 1e-300 }, slopes), 1e300, 1e-14);
  TAUTLINE_CHECK(slopes[2] == std::numeric_limits<double>::max() && slopes[0] == 1);

  options = TAUTLINE_CHANGED(optionsFor(Scalarization::ExponentialWeighted), exponent = 1000);
  const Scalarizer weighted(options, { 1, 5 }, { 2, 2 });
  TAUTLINE_CHECK_RELATIVE(weighted.value({ 8, 8 }), 9, 1e-14); // w_2 + z_2, both exp() overflow
  testSlopes(weighted, { 16.001, 8 }, 1e-5);
  options.exponent = 1e-8; // exp(p w) - 1 without cancellation: (1/p) ln(p (1 + 5)) at z = 0
  TAUTLINE_CHECK_RELATIVE(
    Scalarizer(options, { 1, 5 }, { 2, 2 }).value({ 0, 0 }), std::log(6e-8) * 1e8, 1e-8);

  for (Scalarization method : methods)
  {
    const Context name("method " + std::to_string(static_cast<int>(method)));
    const Scalarizer any(optionsFor(method), { 1, 2 }, { 3, 0 });
    for (double bad : { infinity, std::nan("") })
    {
      TAUTLINE_CHECK_EQUAL(any.value({ 1, bad }, slopes), infinity);
      TAUTLINE_CHECK(slopes == (Values{ 0, 0 }));
    }
    for (double f : { -infinity, -1e308, -1.0, 0.0, 1e-320, 1.0, 1e308 })
    {
      for (double g : { -infinity, -1e308, 0.0, 1e308 })
      {
        TAUTLINE_CHECK(!std::isnan(any.value({ f, g }, slopes)));
        TAUTLINE_CHECK(std::isfinite(slopes[0]) && std::isfinite(slopes[1]));
      }
    }
  }
}

TAUTLINE_PART(testLexicographic)
{
  ScalarizationOptions options = optionsFor(Scalarization::Lexicographic);
  options.tolerance = 0.1;
  Scalarizer scalarizer(options, { 1, 1, 1 }, { 10, 20, 30 });
  TAUTLINE_CHECK_EQUAL(scalarizer.stage(), 0);
  TAUTLINE_CHECK_EQUAL(scalarizer.value({ 4, 1000, -5 }), 4.0);
  TAUTLINE_CHECK(scalarizer.next({ 4, 50, 30 }));
  TAUTLINE_CHECK_EQUAL(scalarizer.stage(), 1);
  TAUTLINE_CHECK_EQUAL(scalarizer.value({ 4, 50, 30 }), 50.0);
  TAUTLINE_CHECK_EQUAL(scalarizer.value({ 3, 40, 30 }), 40.0);
  TAUTLINE_CHECK_RELATIVE(scalarizer.value({ 4.2, 40, 30 }), 40 + 0.01 * 50 * 0.5, 1e-13);
  testSlopes(scalarizer, { 4.2, 40, 30 });
  TAUTLINE_CHECK_EQUAL(scalarizer.value({ 4.4000001, 40, 30 }), infinity);
  TAUTLINE_CHECK(scalarizer.next({ 4.3, 20, 30 }));
  testSlopes(scalarizer, { 4.3, 21, 12 });
  TAUTLINE_CHECK_EQUAL(scalarizer.value({ 4, 22.1, 12 }), infinity);
  TAUTLINE_CHECK(!scalarizer.next({ 4, 20, 3 }));
  TAUTLINE_CHECK_EQUAL(scalarizer.stage(), 2);

  options.tolerance = 0;
  Scalarizer strict(options, { 1, 1 }, { 10, 20 });
  strict.next({ 4, 20 });
  TAUTLINE_CHECK_EQUAL(strict.value({ 4, 7 }), 7.0);
  TAUTLINE_CHECK_EQUAL(strict.value({ std::nextafter(4.0, 5.0), 7 }), infinity);
  TAUTLINE_CHECK(
    !Scalarizer(optionsFor(Scalarization::EqualSum), { 1, 1 }, { 1, 1 }).next({ 1, 1 }));
}

TAUTLINE_PART(testErrors)
{
  const ScalarizationOptions good;
  TAUTLINE_CHECK_THROWS(Scalarizer(good, {}, {}), wording("no-objective"));
  TAUTLINE_CHECK_THROWS(Scalarizer(good, { 1 }, { 1, 2 }), wording("one-weight"));
  TAUTLINE_CHECK_THROWS(Scalarizer(good, { 1, 0 }, { 1, 2 }), wording("weight-of-objective-2"));
  TAUTLINE_CHECK_THROWS(
    Scalarizer(good, { std::nan(""), 1 }, { 1, 2 }), wording("weight-of-objective-1"));
  TAUTLINE_CHECK_THROWS(Scalarizer(good, { 1, 1 }, { 1, infinity }), "Untangle");
  TAUTLINE_CHECK_THROWS(Scalarizer(good, { 1 }, { 1 }).value({ 1, 2 }), "2 values");
#define REJECTED(change, text) \
  TAUTLINE_CHECK_THROWS(Scalarizer(TAUTLINE_CHANGED(good, change), { 1 }, { 1 }), text)
  REJECTED(c = -1, wording("c-of-the-exponential-sum"));
  REJECTED(c = infinity, wording("c-of-the-exponential-sum"));
  REJECTED(exponent = 0, "exponent");
  REJECTED(tolerance = -0.1, "tolerance");
  REJECTED(utopia = (std::vector<double>{ 1, 2 }), "utopia");
  REJECTED(utopia = { infinity }, "utopia");
  REJECTED(method = static_cast<Scalarization>(8), "number 8");
}
}
