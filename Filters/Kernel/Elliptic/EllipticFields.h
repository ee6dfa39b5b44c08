// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticFields.h
 * @brief Fields derived from the values of a solution: gradients and stresses.
 * Internal: not installed.
 */
#ifndef tautline_EllipticFields_h
#define tautline_EllipticFields_h

#include "ElementMatrices.h"
#include "EllipticProblem.h"
#include "EllipticSolution.h"
#include "tautline/Core/Parallel.h"

namespace tautline
{
/// A mesh and the problem on it.
struct EllipticDomain
{
  const Mesh& mesh;
  const EllipticProblem& problem;
  const MeshPart& part;
  int threads;
};

/// Values and gradients of a solution at a point of a cell: gradient[component] is a vector.
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

/// Calls work(cell, nodes, points, sample) at the quadrature points of every cell that is not
/// skipped, chunk by chunk.
template <class Work>
void forEachSample(
  const EllipticDomain& domain, const ElementRules& rules, bool ghosts, const Work& work)
{
  const MeshView& view = domain.mesh.view();
  const bool volume = domain.mesh.dimension() == Dimension::Volume;
  for (const CellBlock& block : domain.mesh.blocks())
  {
    // A skipped cell is either a ghost or a face of a volume.
    const bool face = volume && topology(block.type).dimension == 2;
    const unsigned char* skip = ghosts && !face ? nullptr : domain.part.skip;
    const auto visitCell = [&](Index cell, ElementKind kind, auto nodesOfCell, auto dimension)
    {
      constexpr int nodes = decltype(nodesOfCell)::value;
      const Index* node = view.connectivity + view.offsets[cell];
      Vec3 p[nodes];
      for (int k = 0; k < nodes; ++k)
      {
        p[k] = pointOf(view, node[k]);
      }
      for (const ReferencePoint& reference : rules[static_cast<int>(kind)])
      {
        ElementSample<nodes> sample;
        sampleElement<nodes, decltype(dimension)::value>(reference, p, sample);
        work(cell, node, p, sample);
      }
    };
    forEachChunk(block.count, domain.threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          const ElementKind kind = elementKind(view, cell);
          if (!(skip && skip[cell]))
          {
            withElement(
              kind, [&](auto nodes, auto dimension) { visitCell(cell, kind, nodes, dimension); });
          }
        }
      });
  }
}

/// Computes gradients or stresses from the values.
void differentiate(const EllipticDomain& domain, EllipticSolution& solution);
}
#endif
