// SPDX-License-Identifier: BSD-3-Clause
// Assembly and condition number of nonlocal matrices, h = 1/N, delta = 0.2: CPU seconds of one
// thread, the best of several turns, and wall seconds of one and of two. Lines `key<tab>number`.
//
// usage: BenchmarkPeridynamics [N [TURNS]]

#include "tautline/Peridynamics/Peridynamics.h"
#include "tautline/Solvers/Lanczos.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace tautline;

namespace
{
double cpuSeconds()
{
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Times
{
  double cpu = 1e300, wall = 1e300, condition = 0.0;
};

Times measure(const HorizonMesh& mesh, PeridynamicOptions options, int threads, int turns)
{
  options.threads = threads;
  LanczosOptions lanczos;
  lanczos.threads = threads;
  Times best;
  for (int turn = 0; turn < turns; ++turn)
  {
    const double cpu = cpuSeconds();
    const auto wall = std::chrono::steady_clock::now();
    const PeridynamicSystem system = assemblePeridynamics(mesh, options);
    best.condition = extremeEigenvalues(system.matrix, lanczos).condition;
    best.cpu = std::min(best.cpu, cpuSeconds() - cpu);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - wall;
    best.wall = std::min(best.wall, passed.count());
  }
  return best;
}
}

int main(int argc, char* argv[])
{
  const int n = argc > 1 ? std::atoi(argv[1]) : 40, turns = argc > 2 ? std::atoi(argv[2]) : 3;
  const HorizonMesh mesh = horizonSquare(1.0 / n, 1.0, 0.2);
  struct Case
  {
    const char* name;
    Discretization discretization;
    PeridynamicBasis basis;
    double p;
  };
  const Case cases[] = {
    { "dissertation linear p=1", Discretization::Dissertation, PeridynamicBasis::Linear, 1.0 },
    { "exact linear p=1", Discretization::Exact, PeridynamicBasis::Linear, 1.0 },
    { "exact linear p=2.5", Discretization::Exact, PeridynamicBasis::Linear, 2.5 },
    { "dissertation constant p=1", Discretization::Dissertation, PeridynamicBasis::Constant, 1.0 },
    { "exact constant p=1", Discretization::Exact, PeridynamicBasis::Constant, 1.0 },
  };
  for (const Case& c : cases)
  {
    PeridynamicOptions options;
    options.discretization = c.discretization;
    options.basis = c.basis;
    options.kernel.exponent = c.p;
    const Times one = measure(mesh, options, 1, turns), two = measure(mesh, options, 2, turns);
    std::printf("peridynamics %s cpu\t%.6g\n", c.name, one.cpu);
    std::printf("peridynamics %s wall 1\t%.6g\n", c.name, one.wall);
    std::printf("peridynamics %s wall 2\t%.6g\n", c.name, two.wall);
    std::printf("peridynamics %s condition\t%.10g\n", c.name, one.condition);
  }
  return EXIT_SUCCESS;
}
