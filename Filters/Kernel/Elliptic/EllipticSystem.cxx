// SPDX-License-Identifier: BSD-3-Clause
#include "EllipticSystem.h"

#include "EllipticChecks.h"
#include "EllipticFields.h"
#include "FiniteElements.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"

#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// The results of checking a problem.
struct CheckedProblem
{
  std::vector<unsigned char> used, fixed; // per point: in cells, and fixed, on any rank
  int components = 1;
};

CheckedProblem check(const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part,
  const PointNumbering& all, int threads)
{
  const Index points = mesh.view().numberOfPoints;
  EllipticChecks checks(mesh, problem, part, all, threads);
  checks.everywhere([&]() { checks.requireCoefficients(); });
  checks.requireValidElements();
  CheckedProblem found;
  found.used = checks.usedPoints();
  found.fixed = problem.fixed
    ? std::vector<unsigned char>(problem.fixed, problem.fixed + points)
    : globalBoundaryPoints(mesh, part.communicator, part.globalIds, part.skip);
  all.either(found.fixed.data());
  checks.everywhere([&]() { checks.requireData(found.used, found.fixed); });
  checks.requireFixedParts(found.used, found.fixed);
  found.components = problem.pde == Pde::Elasticity ? checks.elasticUnknowns() : 1;
  return found;
}
}

//------------------------------------------------------------------------------
void requireSolvable(
  const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part, int threads)
{
  const PointNumbering all(part.communicator, mesh.view().numberOfPoints, part.globalIds);
  check(mesh, problem, part, all, threads);
}

//------------------------------------------------------------------------------
struct EllipticSystem::Implementation
{
  Implementation(
    const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part, int threads);

  void assemble();
  void reduce(const SparseMatrix& whole, const std::vector<double>& load);
  std::vector<double> source() const;
  /// Component k of a vector given at a point; for planar elasticity, along the axes of the frame.
  double component(const Vec3& v, int k) const;
  double given(Index point, int k) const;

  const Mesh* Input;
  EllipticProblem Problem;
  MeshPart Part;
  int Threads;
  int Components = 1;
  std::vector<unsigned char> Used; // points in cells, on any rank
  std::vector<Index> FreePoints;
  std::vector<Index> FreeIndex; // of a point, or -1
  std::unique_ptr<PointNumbering> Numbering;
  SparseMatrix Matrix;
  std::vector<double> RightHandSide;
  std::vector<double> Coordinates;
  double AssembleSeconds = 0.0;
};

//------------------------------------------------------------------------------
EllipticSystem::Implementation::Implementation(
  const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part, int threads)
  : Input(&mesh)
  , Problem(problem)
  , Part(part)
  , Threads(threads)
{
  const Index points = mesh.view().numberOfPoints;
  const PointNumbering all(part.communicator, points, part.globalIds);
  const CheckedProblem checked = check(mesh, this->Problem, part, all, threads);
  this->Used = checked.used;
  this->Components = checked.components;
  this->FreeIndex.assign(points, -1);
  // Points of cells get unknowns unless they are fixed.
  std::vector<Index> globalIds;
  for (Index point = 0; point < points; ++point)
  {
    if (this->Used[point] && !checked.fixed[point])
    {
      this->FreeIndex[point] = static_cast<Index>(this->FreePoints.size());
      this->FreePoints.push_back(point);
      if (part.globalIds)
      {
        globalIds.push_back(part.globalIds[point]);
      }
    }
  }
  this->Numbering = std::make_unique<PointNumbering>(part.communicator,
    static_cast<Index>(this->FreePoints.size()), part.globalIds ? globalIds.data() : nullptr);
  if (this->Numbering->globalSize() == 0)
  {
    throw Error(
      "No point is free: all points of the mesh are on its boundary, or fixed. Refine the "
      "mesh, or fix fewer points.");
  }
  EllipticChecks(mesh, this->Problem, part, all, threads).everywhere([&]() { this->assemble(); });

  // The rigid body modes follow from the coordinates along the components.
  for (Index point : this->FreePoints)
  {
    const Vec3 p = pointOf(mesh.view(), point);
    for (int k = 0; k < 3; ++k)
    {
      this->Coordinates.push_back(this->Components == 2 && k == 2 ? 0.0 : this->component(p, k));
    }
  }
}

//------------------------------------------------------------------------------
double EllipticSystem::Implementation::component(const Vec3& v, int k) const
{
  return this->Components == 2 ? dot(v, this->Input->frame()[k]) : v[k];
}

double EllipticSystem::Implementation::given(Index point, int k) const
{
  const double* values = this->Problem.fixedValues;
  if (!values)
  {
    return 0.0;
  }
  return this->Components == 1
    ? values[point]
    : this->component({ values[3 * point], values[3 * point + 1], values[3 * point + 2] }, k);
}

//------------------------------------------------------------------------------
std::vector<double> EllipticSystem::Implementation::source() const
{
  const Index points = this->Input->view().numberOfPoints;
  std::vector<double> f(this->Components * points, 0.0);
  for (Index point = 0; point < points; ++point)
  {
    const double* at = this->Problem.sources;
    for (int k = 0; k < this->Components; ++k)
    {
      f[this->Components * point + k] = this->Components == 1
        ? (at ? at[point] : this->Problem.source[0])
        : this->component(
            at ? Vec3{ at[3 * point], at[3 * point + 1], at[3 * point + 2] } : this->Problem.source,
            k);
    }
  }
  return f;
}

//------------------------------------------------------------------------------
void EllipticSystem::Implementation::assemble()
{
  const Stopwatch time;
  SparseMatrix whole;
  std::vector<double> load;
  const Mesh& mesh = *this->Input;
  if (mesh.view().numberOfCells > 0) // a rank may have none
  {
    AssemblyOptions options;
    options.skip = this->Part.skip;
    options.threads = this->Threads;
    const AssemblyPattern pattern(mesh, options);
    if (this->Problem.pde == Pde::Elasticity)
    {
      pattern.assemble(this->Problem.elastic, whole);
    }
    else
    {
      const bool poisson = this->Problem.pde == Pde::Poisson;
      pattern.assemble(poisson ? DiffusionOperator() : this->Problem.diffusion, whole);
    }
    load = loadVector(mesh, this->source().data(), this->Components, options);
  }
  else
  {
    whole.size = this->Components * mesh.view().numberOfPoints;
    whole.offsets.assign(whole.size + 1, 0);
    load.assign(whole.size, 0.0);
  }
  this->reduce(whole, load);
  this->AssembleSeconds = time.seconds();
}

/// Keeps the rows and columns of the free points; given values at other points go to the right-hand
/// side.
void EllipticSystem::Implementation::reduce(
  const SparseMatrix& whole, const std::vector<double>& load)
{
  const int d = this->Components;
  const Index freePoints = static_cast<Index>(this->FreePoints.size());
  SparseMatrix& matrix = this->Matrix;
  matrix.size = d * freePoints;
  // First count the entries of the rows, then fill them.
  matrix.offsets.assign(matrix.size + 1, 0);
  const auto rowOf = [&](Index i) { return d * this->FreePoints[i / d] + i % d; };
  forEachChunk(matrix.size, this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Index row = rowOf(i);
        for (Index k = whole.offsets[row]; k < whole.offsets[row + 1]; ++k)
        {
          matrix.offsets[i + 1] += this->FreeIndex[whole.columns[k] / d] >= 0;
        }
      }
    });
  std::partial_sum(matrix.offsets.begin(), matrix.offsets.end(), matrix.offsets.begin());
  matrix.columns.resize(matrix.offsets.back());
  matrix.values.resize(matrix.offsets.back());
  this->RightHandSide.resize(matrix.size);
  forEachChunk(matrix.size, this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Index row = rowOf(i);
        Index to = matrix.offsets[i];
        double sum = load[row];
        for (Index k = whole.offsets[row]; k < whole.offsets[row + 1]; ++k)
        {
          const Index point = whole.columns[k] / d;
          const int component = static_cast<int>(whole.columns[k] % d);
          if (this->FreeIndex[point] >= 0)
          {
            matrix.columns[to] = static_cast<std::int32_t>(d * this->FreeIndex[point] + component);
            matrix.values[to++] = whole.values[k];
          }
          else
          {
            // Columns of given values move to the right-hand side.
            sum -= whole.values[k] * this->given(point, component);
          }
        }
        this->RightHandSide[i] = sum;
      }
    });
}

//------------------------------------------------------------------------------
EllipticSystem::EllipticSystem(
  const Mesh& mesh, const EllipticProblem& problem, const MeshPart& part, int threads)
  : Impl(std::make_shared<Implementation>(mesh, problem, part, threads))
{
}

EllipticSystem::~EllipticSystem() = default;

Index EllipticSystem::unknowns() const
{
  return this->Impl->Components * this->Impl->Numbering->globalSize();
}

int EllipticSystem::blockSize() const
{
  return this->Impl->Components;
}

double EllipticSystem::assembleSeconds() const
{
  return this->Impl->AssembleSeconds;
}

const SparseMatrix& EllipticSystem::matrix() const
{
  return this->Impl->Matrix;
}

const std::vector<double>& EllipticSystem::rightHandSide() const
{
  return this->Impl->RightHandSide;
}

const std::vector<Index>& EllipticSystem::freePoints() const
{
  return this->Impl->FreePoints;
}

const Mesh& EllipticSystem::mesh() const
{
  return *this->Impl->Input;
}

const EllipticProblem& EllipticSystem::problem() const
{
  return this->Impl->Problem;
}

const MeshPart& EllipticSystem::part() const
{
  return this->Impl->Part;
}

int EllipticSystem::threads() const
{
  return this->Impl->Threads;
}

const PointNumbering& EllipticSystem::numbering() const
{
  return *this->Impl->Numbering;
}

//------------------------------------------------------------------------------
LinearSystem EllipticSystem::linearSystem() const
{
  const Implementation& impl = *this->Impl;
  LinearSystem system;
  system.matrix = &impl.Matrix;
  system.blockSize = impl.Components;
  system.positiveDefinite =
    impl.Problem.pde != Pde::Elliptic || impl.Problem.diffusion.reaction >= 0;
  system.coordinates = impl.Components > 1 ? impl.Coordinates.data() : nullptr;
  system.numbering = impl.Part.communicator ? impl.Numbering.get() : nullptr;
  system.owner = this->Impl;
  return system;
}

//------------------------------------------------------------------------------
EllipticSolution EllipticSystem::solve(const SolverOptions& options) const
{
  LinearSolver solver(this->linearSystem(), options);
  std::vector<double> unknowns(this->Impl->Matrix.size, 0.0);
  const LinearSolution linear = solver.solve(this->Impl->RightHandSide.data(), unknowns.data());
  EllipticSolution solution = this->fields(unknowns);
  solution.linear = linear;
  return solution;
}

//------------------------------------------------------------------------------
EllipticSolution EllipticSystem::fields(const std::vector<double>& unknowns) const
{
  const Implementation& impl = *this->Impl;
  if (unknowns.size() != static_cast<std::size_t>(impl.Matrix.size))
  {
    throw Error("The solution has " + std::to_string(unknowns.size()) + " numbers for " +
      std::to_string(impl.Matrix.size) + " unknowns.");
  }
  const Index points = impl.Input->view().numberOfPoints;
  EllipticSolution solution;
  solution.components = impl.Components == 1 ? 1 : 3;
  // Points outside all cells have no value.
  solution.values.assign(solution.components * points, std::numeric_limits<double>::quiet_NaN());
  for (Index point = 0; point < points; ++point)
  {
    if (!impl.Used[point])
    {
      continue;
    }
    // Free points have unknowns, fixed ones their given values; planar components go back to space.
    Vec3 u = { 0, 0, 0 };
    for (int k = 0; k < impl.Components; ++k)
    {
      const Index i = impl.FreeIndex[point];
      u[k] = i >= 0 ? unknowns[impl.Components * i + k] : impl.given(point, k);
    }
    if (impl.Components == 2)
    {
      u = u[0] * impl.Input->frame()[0] + u[1] * impl.Input->frame()[1];
    }
    std::copy_n(u.begin(), solution.components, &solution.values[solution.components * point]);
  }
  differentiate({ *impl.Input, impl.Problem, impl.Part, impl.Threads }, solution);
  return solution;
}
}
