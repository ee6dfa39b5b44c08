// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorNorms.h"

#include "EllipticFields.h"

#include <cmath>

namespace tautline
{
namespace
{
/// A unit normal of the plane that contains the gradients of the shape functions of a cell.
template <int Nodes>
Vec3 normalOf(const ElementSample<Nodes>& sample)
{
  const auto gradient = [&sample](int k) {
    return Vec3{ sample.gradient[0][k], sample.gradient[1][k], sample.gradient[2][k] };
  };
  Vec3 longest = { 0, 0, 0 };
  for (int k = 1; k < Nodes; ++k)
  {
    const Vec3 normal = cross(gradient(0), gradient(k));
    longest = dot(normal, normal) > dot(longest, longest) ? normal : longest;
  }
  const double length = std::sqrt(dot(longest, longest));
  return length > 0.0 ? (1.0 / length) * longest : longest;
}
}

//------------------------------------------------------------------------------
std::array<double, 2> errorNorms(const EllipticSystem& system, const EllipticSolution& solution,
  const std::function<void(const Vec3&, double* value, double* gradient)>& exact)
{
  constexpr int gaussPoints = 4, quadraticGaussPoints = 6;
  const auto rule = [](ElementKind kind)
  { return referenceRule(kind, isQuadratic(kind) ? quadraticGaussPoints : gaussPoints); };
  constexpr int oneThread = 1; // calls exact()
  const EllipticDomain domain = { system.mesh(), system.problem(), system.part(), oneThread };
  const bool surface = system.mesh().dimension() != Dimension::Volume;
  // One sum per cell, so that the sums are added in the order of the cells.
  std::vector<std::array<double, 2>> squares(system.mesh().view().numberOfCells);
  forEachSample(domain, elementRules(rule), false,
    [&](Index cell, const Index* node, const Vec3* p, const auto& sample)
    {
      Vec3 place = { 0, 0, 0 }, value;
      std::array<Vec3, 3> gradient;
      for (std::size_t k = 0; k < sample.gradient[0].size(); ++k)
      {
        place += sample.value[k] * p[k];
      }
      interpolate(sample, solution, node, value, gradient);
      double knownValue[3] = {}, knownGradient[9] = {};
      exact(place, knownValue, knownGradient);
      const Vec3 normal = surface ? normalOf(sample) : Vec3{ 0, 0, 0 };
      for (int c = 0; c < solution.components; ++c)
      {
        const double error = value[c] - knownValue[c];
        const double* g = knownGradient + 3 * c;
        const Vec3 known = { g[0], g[1], g[2] };
        const Vec3 slope = gradient[c] - known + dot(known, normal) * normal;
        squares[cell][0] += sample.weight * error * error;
        squares[cell][1] += sample.weight * dot(slope, slope);
      }
    });
  std::array<double, 2> sums = {};
  for (const auto& square : squares)
  {
    sums[0] += square[0];
    sums[1] += square[1];
  }
  return { std::sqrt(system.numbering().sum(sums[0])), std::sqrt(system.numbering().sum(sums[1])) };
}
}
