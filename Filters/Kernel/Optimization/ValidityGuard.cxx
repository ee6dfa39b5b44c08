#include "ValidityGuard.h"

#include "tautline/Mesh/JacobianBounds.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
//------------------------------------------------------------------------------
void findValidityLevels(const Mesh& mesh, int threads, std::vector<signed char>& levels)
{
  levels.resize(mesh.view().numberOfCells);
  mesh.classifyCells(levels.data(), threads);
  for (std::size_t cell = 0; cell < levels.size(); ++cell)
  {
    const signed char validity = levels[cell];
    levels[cell] = validity == Valid ? ValidThroughout : InvalidCorners;
    if ((validity == Inverted || validity == Degenerate) &&
      cornerValidity(mesh, static_cast<Index>(cell)) == Valid)
    {
      levels[cell] = ValidCorners;
    }
  }
}

//------------------------------------------------------------------------------
ValidityGuard::ValidityGuard(OptimizationProblem& problem)
  : Problem(problem)
{
  const Mesh& mesh = problem.moving();
  this->Active = !problem.options().allowInversion &&
    std::any_of(mesh.blocks().begin(), mesh.blocks().end(),
      [](const CellBlock& block) { return hasInside(block.type); });
  if (!this->Active)
  {
    return;
  }
  this->VertexOf.assign(mesh.view().numberOfPoints, -1);
  for (std::int32_t v = 0; v < problem.simplices().freeVertices(); ++v)
  {
    this->VertexOf[problem.simplices().point(v)] = v;
  }
  findValidityLevels(mesh, problem.options().threads, this->Levels);
}

//------------------------------------------------------------------------------
/// The free vertices of the elements that are less valid than before.
std::vector<std::int32_t> ValidityGuard::worsened(const std::vector<signed char>& levels) const
{
  const MeshView& view = this->Problem.moving().view();
  std::vector<std::int32_t> vertices;
  for (std::size_t cell = 0; cell < levels.size(); ++cell)
  {
    if (levels[cell] < this->Levels[cell])
    {
      for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
      {
        const std::int32_t v = this->VertexOf[view.connectivity[n]];
        vertices.insert(vertices.end(), v >= 0 ? 1 : 0, v);
      }
    }
  }
  return vertices;
}

//------------------------------------------------------------------------------
Index ValidityGuard::restore(const std::vector<double>& before)
{
  if (!this->Active)
  {
    return 0;
  }
  // What goes back can fold the elements around it, which go back then; all of them after some
  // rounds.
  constexpr int maxRounds = 20;
  const int threads = this->Problem.options().threads;
  double* x = this->Problem.simplices().coordinates();
  std::vector<signed char> levels;
  Index restored = 0;
  for (int round = 0; round <= maxRounds; ++round)
  {
    findValidityLevels(this->Problem.moving(), threads, levels);
    std::vector<std::int32_t> vertices = this->worsened(levels);
    if (vertices.empty())
    {
      break;
    }
    if (round + 1 >= maxRounds)
    {
      vertices.resize(this->Problem.simplices().freeVertices());
      std::iota(vertices.begin(), vertices.end(), 0);
    }
    for (std::int32_t v : vertices)
    {
      const std::size_t i = VertexStride * static_cast<std::size_t>(v);
      restored += !std::equal(x + i, x + i + VertexStride, &before[i]);
      std::copy_n(&before[i], VertexStride, x + i);
    }
    this->Problem.store();
  }
  this->Levels = levels;
  return restored;
}
}
