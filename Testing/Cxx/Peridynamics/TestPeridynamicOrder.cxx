// SPDX-License-Identifier: BSD-3-Clause
// The nonlocal matrix and the strains do not depend on the order of points, triangles and corners.
#include "HorizonMeshes.h"
#include "Registry.h"
#include "tautline/Peridynamics/Dilatation.h"

using namespace tautline;

namespace
{
constexpr int Elements = 6; // along a side
constexpr double Rounding = 1e-14;

/// A mesh with its points, triangles and corners listed in a random order.
struct Relabelled
{
  HorizonMesh mesh;
  std::vector<Index> pointOf;  ///< per point of the first mesh
  std::vector<Index> cornerOf; ///< per corner (3 x triangle + corner) of the first mesh

  /// @param reversed whether all triangles get the other orientation
  Relabelled(const HorizonMesh& first, unsigned seed, bool reversed)
    : mesh(first)
  {
    Random random(seed);
    this->pointOf = random.permutation(first.numberOfPoints());
    this->cornerOf.resize(first.triangles.size());
    for (Index i = 0; i < first.numberOfPoints(); ++i)
    {
      std::copy_n(&first.points[2 * i], 2, &this->mesh.points[2 * this->pointOf[i]]);
    }
    const std::vector<Index> triangleOf = random.permutation(first.numberOfTriangles());
    for (Index t = 0; t < first.numberOfTriangles(); ++t)
    {
      this->mesh.layer[triangleOf[t]] = first.layer[t];
      const Index turn = random.integer(3);
      for (Index k = 0; k < 3; ++k)
      {
        const Index to = 3 * triangleOf[t] + (turn + (reversed ? 3 - k : k)) % 3;
        this->cornerOf[3 * t + k] = to;
        this->mesh.triangles[to] = this->pointOf[first.triangles[3 * t + k]];
      }
    }
  }

  Index function(PeridynamicBasis basis, Index f) const
  {
    return basis == PeridynamicBasis::Linear ? this->pointOf[f]
      : basis == PeridynamicBasis::Constant  ? this->cornerOf[3 * f] / 3
                                             : this->cornerOf[f];
  }
};

/// The square without its middle, so that bonds are cut.
HorizonMesh withHole(const HorizonMesh& mesh)
{
  HorizonMesh result = mesh;
  result.triangles.clear();
  result.layer.clear();
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    double x = 0.0, y = 0.0;
    for (Index k = 0; k < 3; ++k)
    {
      x += mesh.points[2 * mesh.triangles[3 * t + k]] / 3.0;
      y += mesh.points[2 * mesh.triangles[3 * t + k] + 1] / 3.0;
    }
    if (std::max(std::abs(x - 0.5), std::abs(y - 0.5)) > 0.2)
    {
      const auto from = mesh.triangles.begin() + 3 * t;
      result.triangles.insert(result.triangles.end(), from, from + 3);
      result.layer.push_back(mesh.layer[t]);
    }
  }
  return result;
}

/// Turned: points of one line have coordinates that differ by rounding.
HorizonMesh turned(const HorizonMesh& mesh, double angle)
{
  HorizonMesh result = mesh;
  for (Index i = 0; i < mesh.numberOfPoints(); ++i)
  {
    const double x = mesh.points[2 * i], y = mesh.points[2 * i + 1];
    result.points[2 * i] = std::cos(angle) * x - std::sin(angle) * y;
    result.points[2 * i + 1] = std::sin(angle) * x + std::cos(angle) * y;
  }
  return result;
}

double largest(const std::vector<double>& values)
{
  return std::abs(*std::max_element(
    values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

void compare(const HorizonMesh& mesh, const PeridynamicOptions& options)
{
  const Index components = isElastic(options.model) ? 2 : 1;
  const Index functions = numberOfFunctions(mesh, options.basis);
  std::vector<double> given(components * functions);
  Random random(9);
  for (double& value : given)
  {
    value = random.uniform(-1, 1);
  }
  const PeridynamicSystem one = assemblePeridynamics(mesh, options, &given);
  const double size = largest(one.matrix.values), load = largest(one.constraintLoad);
  for (const bool reversed : { false, true })
  {
    const Context context(reversed ? "reversed" : "relabelled");
    const Relabelled other(mesh, reversed ? 4 : 3, reversed);
    std::vector<double> moved(given.size());
    for (Index f = 0; f < functions; ++f)
    {
      std::copy_n(
        &given[components * f], components, &moved[components * other.function(options.basis, f)]);
    }
    const PeridynamicSystem two = assemblePeridynamics(other.mesh, options, &moved);
    TAUTLINE_CHECK_EQUAL(two.matrix.nonzeros(), one.matrix.nonzeros());
    TAUTLINE_CHECK_EQUAL(two.integratedPairs, one.integratedPairs);
    const auto rowOf = [&](Index row)
    {
      const Index f = one.functionOf[row / components];
      return components * two.unknownOf[other.function(options.basis, f)] + row % components;
    };
    double difference = 0.0, ofLoad = 0.0;
    for (Index row = 0; row < one.matrix.size; ++row)
    {
      const Index there = rowOf(row);
      for (Index k = one.matrix.offsets[row]; k < one.matrix.offsets[row + 1]; ++k)
      {
        const double value = two.matrix.at(there, rowOf(one.matrix.columns[k]));
        difference = std::max(difference, std::abs(value - one.matrix.values[k]));
      }
      ofLoad = std::max(ofLoad, std::abs(two.constraintLoad[there] - one.constraintLoad[row]));
    }
    TAUTLINE_CHECK(difference <= Rounding * size);
    TAUTLINE_CHECK(ofLoad <= Rounding * load);
    if (components == 1)
    {
      continue;
    }
    const PeridynamicStrain strain = peridynamicStrain(mesh, options, given);
    const PeridynamicStrain again = peridynamicStrain(other.mesh, options, moved);
    double ofStrain = 0.0, ofEnergy = 0.0;
    for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
    {
      const Index there = other.function(PeridynamicBasis::Constant, t);
      ofStrain = std::max(ofStrain, std::abs(again.dilatation[there] - strain.dilatation[t]));
      ofEnergy = std::max(ofEnergy, std::abs(again.energyDensity[there] - strain.energyDensity[t]));
    }
    TAUTLINE_CHECK(ofStrain <= Rounding * largest(strain.dilatation));
    TAUTLINE_CHECK(ofEnergy <= Rounding * largest(strain.energyDensity));
  }
}
}

TAUTLINE_TEST(TestPeridynamicOrder)
{
  for (const NonlocalCase& each : nonlocalCases)
  {
    const Context context(each.name);
    TAUTLINE_LET(PeridynamicOptions, options, basis = each.basis, model = each.model,
      discretization = each.discretization, horizon = 0.25);
    options.allowThinLayer = true; // around the hole
    TAUTLINE_SET(options, tolerance = 1e-3, poissonRatio = 0.3);
    const auto layers = static_cast<int>(std::ceil(Elements * interactionReach(options)));
    const HorizonMesh shaken = shakenSquare(Elements, layers, 0.2);
    {
      const Context mesh("shaken");
      compare(shaken, options);
    }
    {
      const Context mesh("with a hole");
      compare(withHole(shaken), options);
    }
    {
      const Context mesh("turned");
      compare(turned(shakenSquare(Elements, layers, 0.0), M_PI / 6.0), options);
    }
  }
}
