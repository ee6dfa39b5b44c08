// SPDX-License-Identifier: BSD-3-Clause
#include "ElementContributions.h"

#include "ElementMatrices.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Solvers/ExtremeEigenvalues.h"
#include "tautline/Solvers/LinearSolverState.h"
#include "tautline/Solvers/SmallEigenvalues.h"

#include <limits>

namespace tautline
{
namespace
{
constexpr Index NotFree = -1;

/// The largest dimension of the active cells on all ranks.
int countedDimension(const EllipticSystem& system)
{
  const Mesh& mesh = system.mesh();
  const unsigned char* skip = system.part().skip;
  double dimension = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    for (Index i = 0; i < block.count && dimension < topology(block.type).dimension; ++i)
    {
      dimension = skip && skip[block.cell(i)] ? dimension : topology(block.type).dimension;
    }
  }
  return static_cast<int>(system.numbering().maximum(dimension));
}

/// The data that the loop over the cells reads and writes.
struct Work
{
  const EllipticSystem& System;
  const double* Vector; // an eigenvector, one number per unknown; or null
  int Threads;
  std::vector<Index> FreeIndex; // of each point
  ElementContributions& Result;
  std::vector<double> LowerBound; // of each chunk
  int Dimension;                  // of the active cells, on all ranks

  Work(
    const EllipticSystem& system, const double* vector, int threads, ElementContributions& result)
    : System(system)
    , Vector(vector)
    , Threads(threads)
    , FreeIndex(static_cast<std::size_t>(system.mesh().view().numberOfPoints), NotFree)
    , Result(result)
    , LowerBound(static_cast<std::size_t>(numberOfChunks(system.mesh().view().numberOfCells)), 0.0)
    , Dimension(countedDimension(system))
  {
    for (std::size_t i = 0; i < system.freePoints().size(); ++i)
    {
      this->FreeIndex[system.freePoints()[i]] = static_cast<Index>(i);
    }
  }

  /// Whether a cell is inactive.
  bool skipped(Index cell) const
  {
    return this->System.part().skip && this->System.part().skip[cell];
  }
  /// Whether an inactive cell has the dimension of the active cells: a copy of a cell on another
  /// rank.
  bool isCopy(Index cell) const
  {
    const CellType type = cornerType(this->System.mesh().view().cellTypes[cell]);
    return type != CellType::Unsupported && topology(type).dimension == this->Dimension;
  }
};

/// Processes one cell: its largest eigenvalue, the largest eigenvalue of its free part, and its
/// energy in the eigenvector.
template <int Nodes, int Dimension, class Element>
void visitCell(Work& work, const Element& element, Index cell, ElementKind kind, double& lowerBound)
{
  constexpr int components = Element::Components, rows = Nodes * components;
  const MeshView& view = work.System.mesh().view();
  const Index* node = view.connectivity + view.offsets[cell];
  Vec3 p[Nodes];
  for (int k = 0; k < Nodes; ++k)
  {
    p[k] = pointOf(view, node[k]);
  }
  double matrix[rows * rows] = {}, copy[rows * rows];
  element.template compute<Nodes, Dimension>(cell, kind, p, matrix);
  std::copy_n(matrix, rows * rows, copy);
  const double largest = largestEigenvalue(copy, rows);
  work.Result.largestEigenvalue[cell] = largest;

  int freeRows[rows] = {}, count = 0;
  double x[rows] = {}, energy = 0.0;
  for (int i = 0; i < rows; ++i)
  {
    const Index free = work.FreeIndex[node[i / components]];
    if (free != NotFree)
    {
      freeRows[count++] = i;
      x[i] = work.Vector ? work.Vector[components * free + i % components] : 0.0;
    }
  }
  for (int i = 0; i < count; ++i)
  {
    for (int j = 0; j < count; ++j)
    {
      const double entry = matrix[rows * freeRows[i] + freeRows[j]];
      copy[count * i + j] = entry;
      energy += x[freeRows[i]] * entry * x[freeRows[j]];
    }
  }
  if (work.Vector)
  {
    work.Result.share[cell] = energy;
  }
  // A part has no larger eigenvalue than the whole. Ghosts are complete on another rank.
  if (!work.skipped(cell) && count > 0 && largest > lowerBound)
  {
    lowerBound = std::max(lowerBound, count == rows ? largest : largestEigenvalue(copy, count));
  }
}

template <class Element>
void visitCells(Work& work, const Element& element)
{
  const MeshView& view = work.System.mesh().view();
  forEachChunk(view.numberOfCells, work.Threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index cell = begin; cell < end; ++cell)
      {
        const ElementKind kind = elementKind(view, cell);
        if (work.skipped(cell) && !work.isCopy(cell))
        {
          continue;
        }
        withElement(kind,
          [&](auto nodes, auto dimension)
          {
            visitCell<decltype(nodes)::value, decltype(dimension)::value>(
              work, element, cell, kind, work.LowerBound[chunk]);
          });
      }
    });
}

/// The eigenvector of the largest eigenvalue; empty if it was not found within the limits.
std::vector<double> topEigenvector(const EllipticSystem& system, const ConditionOptions& limits)
{
  const LinearSystem linear = system.linearSystem();
  const auto vector = std::make_shared<std::vector<double>>();
  ConditionOptions options;
  options.maximumSeconds = limits.maximumSeconds;
  options.cancelled = limits.cancelled;
  const WatchResult end = watchPetsc(hardLimits(limits.maximumSeconds, limits.cancelled, linear),
    [linear, vector, options](WatchedWork* work)
    {
      const PetscScope scope;
      PetscOptionSet optionSet("");
      const PetscScope own(optionSet.database());
      const PetscSystem objects(linear);
      EigensolverStoppingTest test(objects, options, work);
      const ExtremeEigenvalue found =
        slepcLargestEigenvalue(objects.matrix(), options, optionSet, test);
      if (found.found)
      {
        vector->resize(static_cast<std::size_t>(objects.localSize()));
        objects.copyOut(found.vector, vector->data());
      }
    });
  return end == WatchResult::Finished ? *vector : std::vector<double>();
}
}

//------------------------------------------------------------------------------
ElementContributions elementContributions(
  const EllipticSystem& system, bool shares, int threads, const ConditionOptions& limits)
{
  const Mesh& mesh = system.mesh();
  const MeshView& view = mesh.view();
  const PointNumbering& numbering = system.numbering();
  ElementContributions result;
  const auto cells = static_cast<std::size_t>(view.numberOfCells);
  result.largestEigenvalue.assign(cells, std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> vector =
    shares ? topEigenvector(system, limits) : std::vector<double>();
  // A rank without unknowns also has an empty vector.
  const bool found =
    shares && numbering.maximum(vector.empty() && !system.freePoints().empty() ? 1.0 : 0.0) == 0.0;
  result.share.assign(found ? cells : 0, 0.0);

  // Ranks without free points read nothing of the vector, but write shares.
  const double none = 0.0;
  Work work(system, found ? (vector.empty() ? &none : vector.data()) : nullptr, threads, result);
  const EllipticProblem& problem = system.problem();
  if (problem.pde == Pde::Elasticity && system.blockSize() == 2)
  {
    visitCells(work, ElasticElement<2>(problem.elastic, mesh.frame()));
  }
  else if (problem.pde == Pde::Elasticity)
  {
    visitCells(work, ElasticElement<3>(problem.elastic, mesh.frame()));
  }
  else
  {
    visitCells(work,
      DiffusionElement(problem.pde == Pde::Poisson ? DiffusionOperator() : problem.diffusion));
  }

  // x^T A x = sum x_e^T A_e x_e <= sum lambda_e |x_e|^2 = sum over points of |x_p|^2 times the sum
  // of their cells' lambda_e.
  std::vector<double> sums(system.freePoints().size(), 0.0);
  double total = 0.0;
  for (std::size_t cell = 0; cell < cells; ++cell)
  {
    const Index* node = view.connectivity + view.offsets[cell];
    const double largest = result.largestEigenvalue[cell];
    const bool counts = !std::isnan(largest) && !work.skipped(static_cast<Index>(cell));
    const Index nodes = !counts ? 0 : view.offsets[cell + 1] - view.offsets[cell];
    for (Index k = 0; k < nodes; ++k)
    {
      const Index free = work.FreeIndex[node[k]];
      if (free != NotFree)
      {
        sums[free] += largest;
      }
    }
    total += found && counts ? result.share[cell] : 0.0;
  }
  numbering.sum(sums.data(), 1);
  result.bound =
    numbering.maximum(sums.empty() ? 0.0 : *std::max_element(sums.begin(), sums.end()));
  result.lowerBound = numbering.maximum(work.LowerBound.empty()
      ? 0.0
      : *std::max_element(work.LowerBound.begin(), work.LowerBound.end()));
  total = numbering.sum(total);
  for (double& share : result.share)
  {
    share = total > 0.0 ? share / total : 0.0;
  }
  return result;
}
}
