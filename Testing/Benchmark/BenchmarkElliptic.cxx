// SPDX-License-Identifier: BSD-3-Clause
// Assembly of finite element matrices: seconds, the best of several turns, CPU time on one thread
// and wall time on one and on two; what BoomerAMG takes for its set-up on the same matrix; and what
// small solves take with and without a time limit, for which they run in another thread.
// Lines `key<tab>number`.
//
// usage: BenchmarkElliptic [CELLS [TURNS]]

#include "Clocks.h"
#include "KuhnMesh.h"

#include "tautline/Elliptic/EllipticSystem.h"
#include "tautline/Elliptic/FiniteElements.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace tautline;

namespace
{
struct Times
{
  double cpu = 1e300, wall = 1e300;
};

template <class Work>
Times measure(int turns, const Work& work)
{
  Times best;
  for (int turn = 0; turn < turns; ++turn)
  {
    const double cpu = processTime(), wall = wallTime();
    work();
    best.cpu = std::min(best.cpu, processTime() - cpu);
    best.wall = std::min(best.wall, wallTime() - wall);
  }
  return best;
}

template <class Operator>
void assembly(const char* name, const Mesh& mesh, const Operator& pde, int turns)
{
  for (int threads = 1; threads <= 2; ++threads)
  {
    AssemblyOptions options;
    options.threads = threads;
    SparseMatrix matrix;
    const Times all = measure(turns, [&]() { matrix = stiffnessMatrix(mesh, pde, options); });
    const AssemblyPattern pattern(mesh, options);
    // Another operator on the same mesh: the pattern is there.
    const Times again = measure(turns, [&]() { pattern.assemble(pde, matrix); });
    if (threads == 1)
    {
      std::printf("assembly %s cpu\t%.6g\n", name, all.cpu);
      std::printf("assembly %s again cpu\t%.6g\n", name, again.cpu);
    }
    std::printf("assembly %s wall %d\t%.6g\n", name, threads, all.wall);
    std::printf("assembly %s again wall %d\t%.6g\n", name, threads, again.wall);
  }
}

/// CPU seconds of BoomerAMG's set-up on the matrix of the free points.
void multigrid(const char* name, const Mesh& mesh, Pde pde, int turns)
{
  EllipticProblem problem;
  problem.pde = pde;
  const EllipticSystem system(mesh, problem, {}, 1);
  const Times all = measure(turns, [&]() { const EllipticSystem again(mesh, problem, {}, 1); });
  double best = 1e300;
  for (int turn = 0; turn < turns; ++turn)
  {
    LinearSolver solver(system.linearSystem(), {});
    const double before = processTime();
    solver.setUp();
    best = std::min(best, processTime() - before);
  }
  std::printf("multigrid %s cpu\t%.6g\n", name, best);
  std::printf("system %s cpu\t%.6g\n", name, all.cpu);
}

/// CPU seconds of all threads per small solve with its set-up, and again with the same solver. The
/// solves with and without a limit take turns, so that both meet the same machine.
void smallSolves(const Mesh& mesh, int turns)
{
  constexpr int solves = 200;
  constexpr double hour = 3600.0;
  const EllipticSystem system(mesh, {}, {}, 1);
  std::vector<double> x(system.freePoints().size());
  Times solve[2], again[2];
  for (int turn = 0; turn < turns; ++turn)
  {
    for (const bool watched : { false, true })
    {
      SolverOptions options;
      options.preconditioner = Preconditioner::Jacobi;
      options.maximumSeconds = watched ? hour : 0.0;
      const auto best = [turn](Times& kept, const Times& now)
      { kept.cpu = turn == 0 ? now.cpu : std::min(kept.cpu, now.cpu); };
      best(solve[watched],
        measure(1,
          [&]()
          {
            for (int i = 0; i < solves; ++i)
            {
              LinearSolver solver(system.linearSystem(), options);
              solver.solve(system.rightHandSide().data(), x.data());
            }
          }));
      LinearSolver solver(system.linearSystem(), options);
      best(again[watched],
        measure(1,
          [&]()
          {
            for (int i = 0; i < solves; ++i)
            {
              std::fill(x.begin(), x.end(), 0.0);
              solver.solve(system.rightHandSide().data(), x.data());
            }
          }));
    }
  }
  std::printf("small solves unknowns\t%zu\n", x.size());
  std::printf("small solves cpu\t%.6g\n", solve[0].cpu / solves);
  std::printf("small solves again cpu\t%.6g\n", again[0].cpu / solves);
  std::printf("small solves with limit over without\t%.6g\n", solve[1].cpu / solve[0].cpu);
  std::printf("small solves again with limit over without\t%.6g\n", again[1].cpu / again[0].cpu);
}
}

int main(int argc, char* argv[])
{
  const double cells = argc > 1 ? std::atof(argv[1]) : 1e6;
  const int turns = argc > 2 ? std::atoi(argv[2]) : 5;
  const Index flat = std::max<Index>(2, std::lround(std::sqrt(cells / 2)));
  const Index solid = std::max<Index>(2, std::lround(std::cbrt(cells / 6)));
  const MeshData triangles = movedBlock(CellType::Triangle, flat, 0.1);
  const MeshData tetrahedra =
    cutIntoTetrahedra(movedBlock(CellType::Hexahedron, solid, 0.1), solid);
  const MeshData scattered = shuffled(triangles, 7);
  const Mesh planar(triangles.view()), volume(tetrahedra.view()), random(scattered.view());
  DiffusionOperator anisotropic;
  anisotropic.tensor = { 2, 1, 1, 0.5, 0, 0 };
  std::printf("triangles\t%lld\n", static_cast<long long>(planar.view().numberOfCells));
  std::printf("tetrahedra\t%lld\n", static_cast<long long>(volume.view().numberOfCells));
  assembly("triangles poisson", planar, DiffusionOperator(), turns);
  assembly("triangles anisotropic", planar, anisotropic, turns);
  assembly("triangles in random order poisson", random, DiffusionOperator(), turns);
  assembly("triangles elasticity", planar, ElasticOperator(), turns);
  assembly("tetrahedra poisson", volume, DiffusionOperator(), turns);
  assembly("tetrahedra elasticity", volume, ElasticOperator(), turns);
  multigrid("triangles poisson", planar, Pde::Poisson, turns);
  multigrid("triangles in random order poisson", random, Pde::Poisson, turns);
  multigrid("tetrahedra poisson", volume, Pde::Poisson, turns);
  constexpr Index small = 10;
  const MeshData few = movedBlock(CellType::Triangle, small, 0.1);
  smallSolves(Mesh(few.view()), turns);
  return EXIT_SUCCESS;
}
