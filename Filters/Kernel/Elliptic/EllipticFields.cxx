// SPDX-License-Identifier: BSD-3-Clause
#include "EllipticFields.h"

#include <limits>

namespace tautline
{
namespace
{
/// The stress (2.4) of a displacement gradient; for a planar body, according to plane strain or
/// plane stress.
SymmetricTensor stressOf(
  const Mesh& mesh, const ElasticOperator& pde, double factor, const std::array<Vec3, 3>& gradient)
{
  const bool planar = mesh.dimension() == Dimension::Planar;
  const std::array<double, 2> lame = lameParameters(pde, planar);
  const double lambda = factor * lame[0], mu = factor * lame[1];
  const double divergence = gradient[0][0] + gradient[1][1] + gradient[2][2];
  double stress[3][3];
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      // The pressure acts only in the plane if the body is free in the normal direction.
      const bool free = planar && pde.plane == PlaneState::Stress;
      const double identity = (i == j) - (free ? mesh.normal()[i] * mesh.normal()[j] : 0.0);
      stress[i][j] = lambda * divergence * identity + mu * (gradient[i][j] + gradient[j][i]);
    }
  }
  return { stress[0][0], stress[1][1], stress[2][2], stress[0][1], stress[1][2], stress[0][2] };
}
}

//------------------------------------------------------------------------------
void differentiate(const EllipticDomain& domain, EllipticSolution& solution)
{
  const EllipticProblem& problem = domain.problem;
  const int size = solution.components == 1 ? 3 : 6;
  solution.gradients.assign(
    size * domain.mesh.view().numberOfCells, std::numeric_limits<double>::quiet_NaN());
  forEachSample(domain, elementRules(centerRule), true,
    [&](Index cell, const Index* node, const Vec3*, const auto& sample)
    {
      Vec3 value;
      std::array<Vec3, 3> gradient;
      interpolate(sample, solution, node, value, gradient);
      double* to = &solution.gradients[size * cell];
      if (size == 3)
      {
        std::copy_n(gradient[0].begin(), 3, to);
        return;
      }
      const double factor = problem.elastic.stiffening ? problem.elastic.stiffening[cell] : 1.0;
      const SymmetricTensor stress = stressOf(domain.mesh, problem.elastic, factor, gradient);
      std::copy(stress.begin(), stress.end(), to);
    });
}
}
