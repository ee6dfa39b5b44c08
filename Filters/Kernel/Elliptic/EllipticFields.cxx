#include "EllipticChecks.h"

#include "ElementMatrices.h"
#include "Parallel.h"

#include <limits>

namespace tautline
{
namespace
{
/// Values and gradients of a solution at a place of a cell: gradient[component] is a vector.
template <int Nodes>
void interpolate(const ElementSample<Nodes>& sample, const EllipticSolution& solution,
  const Index* node, Vec3& value, std::array<Vec3, 3>& gradient)
{
  value = {};
  gradient = {};
  for (int k = 0; k < Nodes; ++k)
  {
    for (int c = 0; c < solution.components; ++c)
    {
      const double u = solution.values[solution.components * node[k] + c];
      value[c] += u * sample.value[k];
      gradient[c] +=
        u * Vec3{ sample.gradient[0][k], sample.gradient[1][k], sample.gradient[2][k] };
    }
  }
}

/// Calls work(cell, nodes, sample) at the places of a rule in every cell that is not skipped, chunk by chunk.
template <class Work>
void forEachSample(
  const EllipticSystem& system, int pointsPerDirection, bool ghosts, const Work& work)
{
  const MeshView& view = system.mesh().view();
  const bool volume = system.mesh().dimension() == Dimension::Volume;
  for (const CellBlock& block : system.mesh().blocks())
  {
    // What is skipped is either a ghost or a face of a volume.
    const bool face = volume && topology(block.type).dimension == 2;
    const unsigned char* skip = ghosts && !face ? nullptr : system.part().skip;
    std::vector<ReferencePoint> rule = referenceRule(block.type, pointsPerDirection);
    withElement(block.type,
      [&](auto nodesOfCell, auto dimensionOfCell)
      {
        constexpr int nodes = decltype(nodesOfCell)::value;
        forEachChunk(block.count, system.threads(),
          [&](Index, Index begin, Index end)
          {
            for (Index i = begin; i < end; ++i)
            {
              const Index cell = block.cell(i);
              const Index* node = view.connectivity + view.offsets[cell];
              if (skip && skip[cell])
              {
                continue;
              }
              Vec3 p[nodes];
              for (int k = 0; k < nodes; ++k)
              {
                p[k] = pointOf(view, node[k]);
              }
              for (const ReferencePoint& reference : rule)
              {
                ElementSample<nodes> sample;
                sampleElement<nodes, decltype(dimensionOfCell)::value>(reference, p, sample);
                work(cell, node, p, sample);
              }
            }
          });
      });
  }
}

/// The stress (2.4) of a displacement gradient; a planar body's is that of its plane, and of what holds it across.
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
      // Pressure acts in the plane only when nothing holds the body across it.
      const bool free = planar && pde.plane == PlaneState::Stress;
      const double identity = (i == j) - (free ? mesh.normal()[i] * mesh.normal()[j] : 0.0);
      stress[i][j] = lambda * divergence * identity + mu * (gradient[i][j] + gradient[j][i]);
    }
  }
  return { stress[0][0], stress[1][1], stress[2][2], stress[0][1], stress[1][2], stress[0][2] };
}
}

//------------------------------------------------------------------------------
void differentiate(const EllipticSystem& system, EllipticSolution& solution)
{
  const EllipticProblem& problem = system.problem();
  const int size = solution.components == 1 ? 3 : 6;
  solution.gradients.assign(
    size * system.mesh().view().numberOfCells, std::numeric_limits<double>::quiet_NaN());
  forEachSample(system, 1, true,
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
      const SymmetricTensor stress = stressOf(system.mesh(), problem.elastic, factor, gradient);
      std::copy(stress.begin(), stress.end(), to);
    });
}

//------------------------------------------------------------------------------
std::array<double, 2> errorNorms(const EllipticSystem& system, const EllipticSolution& solution,
  const std::function<void(const Vec3&, double* value, double* gradient)>& exact)
{
  constexpr int gaussPoints = 4;
  // One sum per cell, so that their order is that of the cells.
  std::vector<std::array<double, 2>> squares(system.mesh().view().numberOfCells);
  forEachSample(system, gaussPoints, false,
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
      for (int c = 0; c < solution.components; ++c)
      {
        const double error = value[c] - knownValue[c];
        const double* g = knownGradient + 3 * c;
        const Vec3 slope = gradient[c] - Vec3{ g[0], g[1], g[2] };
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
