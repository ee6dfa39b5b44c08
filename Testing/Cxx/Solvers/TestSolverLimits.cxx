// SPDX-License-Identifier: BSD-3-Clause
// Time limits and cancelling of work that cannot be interrupted: the watchdog itself, and set-ups
// and factorizations that are given up. The process ends while one is still running.
#include "Registry.h"
#include "Systems.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Solvers/ConditionEstimate.h"
#include "tautline/Solvers/Watchdog.h"

#include <memory>
#include <stdexcept>
#include <thread>

using namespace tautline;

namespace
{
/// The 7-point Laplacian on n^3 points of a cube: its factors are large.
SparseMatrix cubeLaplacian(int n)
{
  TAUTLINE_LET(SparseMatrix, a, size = static_cast<Index>(n) * n * n);
  for (Index i = 0; i < a.size; ++i)
  {
    const Index x = i % n, y = i / n % n, z = i / n / n;
    const auto add = [&](bool inside, Index column, double value)
    {
      if (inside)
      {
        a.columns.push_back(static_cast<std::int32_t>(column));
        a.values.push_back(value);
      }
    };
    add(z > 0, i - n * n, -1.0);
    add(y > 0, i - n, -1.0);
    add(x > 0, i - 1, -1.0);
    add(true, i, 6.0);
    add(x + 1 < n, i + 1, -1.0);
    add(y + 1 < n, i + n, -1.0);
    add(z + 1 < n, i + n * n, -1.0);
    a.offsets.push_back(a.nonzeros());
  }
  return a;
}

void sleepFor(double seconds)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

//------------------------------------------------------------------------------
void testWatchdog()
{
  const std::thread::id caller = std::this_thread::get_id();
  // Finished work: in another thread, with calls back to this one.
  struct Shared
  {
    std::thread::id worker, called;
    std::atomic<int> done{ 0 };
  };
  const auto shared = std::make_shared<Shared>();
  WatchResult result = runWatched(
    [shared](WatchedWork& work)
    {
      shared->worker = std::this_thread::get_id();
      const bool made = work.inCaller([&]() { shared->called = std::this_thread::get_id(); });
      shared->done = made && !work.abandoned();
    },
    {});
  TAUTLINE_CHECK(result == WatchResult::Finished);
  TAUTLINE_CHECK(shared->worker != caller && shared->called == caller);
  TAUTLINE_CHECK_EQUAL(shared->done.load(), 1);

  // Exceptions, of the work and of a call, which the work may catch.
  TAUTLINE_CHECK_THROWS(
    runWatched([](WatchedWork&) { throw std::runtime_error("of the work"); }, {}),
    wording("of-the-work"));
  bool caught = false;
  runWatched(
    [&caught](WatchedWork& work)
    {
      try
      {
        work.inCaller([]() { throw std::runtime_error("of a call"); });
      }
      catch (const std::runtime_error&)
      {
        caught = true;
      }
    },
    {});
  TAUTLINE_CHECK(caught);

  // Work given from within a call is done, and so is what it gives in turn.
  int depth = 0;
  std::function<void(int)> nest = [&](int more)
  {
    const WatchResult inner = runWatched(
      [&, more](WatchedWork& work)
      {
        ++depth;
        work.inCaller(
          [&]()
          {
            TAUTLINE_CHECK(insideWatchedCall());
            if (more > 0)
            {
              nest(more - 1);
            }
          });
      },
      { 10.0, nullptr });
    TAUTLINE_CHECK(inner == WatchResult::Finished);
  };
  nest(3);
  TAUTLINE_CHECK_EQUAL(depth, 4);
  TAUTLINE_CHECK(!insideWatchedCall());

  // A time limit; the next work waits for the running one, and also stops, or has its turn.
  const auto going = std::make_shared<std::atomic<bool>>(false);
  Stopwatch time;
  result = runWatched(
    [going](WatchedWork& work)
    {
      sleepFor(1.5);
      TAUTLINE_CHECK(work.abandoned());
      *going = !work.inCaller([]() { TAUTLINE_CHECK(false); });
    },
    { 0.2, nullptr });
  TAUTLINE_CHECK(result == WatchResult::TimeLimit);
  TAUTLINE_CHECK(time.seconds() >= 0.2 && time.seconds() < 1.2);
  bool ran = false;
  result = runWatched([&ran](WatchedWork&) { ran = true; }, { 0.1, nullptr });
  TAUTLINE_CHECK(result == WatchResult::TimeLimit);
  TAUTLINE_CHECK(!ran);
  int asked = 0;
  result = runWatched([&ran](WatchedWork&) { ran = true; }, { 0.0, [&]() { return ++asked > 2; } });
  TAUTLINE_CHECK(result == WatchResult::Cancelled);
  TAUTLINE_CHECK(!ran && asked == 3);
  result = runWatched([&ran](WatchedWork&) { ran = true; }, {});
  TAUTLINE_CHECK(result == WatchResult::Finished);
  TAUTLINE_CHECK(ran && *going);
  TAUTLINE_CHECK(time.seconds() >= 1.5);

  // Work that has called back may end by itself after it is cancelled, within CancelGrace.
  for (const double needed : { 4 * WatchInterval, 3 * CancelGrace })
  {
    const auto called = std::make_shared<std::atomic<bool>>(false);
    result = runWatched(
      [called, needed](WatchedWork& work)
      {
        work.inCaller([&]() { *called = true; });
        sleepFor(needed);
      },
      { 0.0, [called]() { return called->load(); } });
    TAUTLINE_CHECK(
      result == (needed < CancelGrace ? WatchResult::Finished : WatchResult::Cancelled));
  }

  // An exception of the cancelling function ends the waiting.
  TAUTLINE_CHECK_THROWS(runWatched([](WatchedWork&) { sleepFor(0.4); },
                          { 0.0, []() -> bool { throw std::runtime_error("of the user"); } }),
    wording("of-the-user"));

  // Several threads at once.
  std::atomic<int> sum{ 0 };
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
  {
    threads.emplace_back(
      [&]()
      {
        for (int k = 0; k < 50; ++k)
        {
          runWatched(
            [&sum](WatchedWork& work) { work.inCaller([&sum]() { ++sum; }); }, { 60.0, nullptr });
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  TAUTLINE_CHECK_EQUAL(sum.load(), 200);
}

/// A small system solved under a limit that allows for the end of what was given up.
void checkSolves()
{
  const SparseMatrix a = laplacian(30);
  const std::vector<double> b = someVector(a.size);
  std::vector<double> x(b.size());
  TAUTLINE_LET(SolverOptions, options, maximumSeconds = 100.0);
  LinearSolver solver(systemOf(a), options);
  const LinearSolution solution = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK(converged(solution.reason));
  TAUTLINE_CHECK(relativeResidual(a, x, b) < 1e-3);
}

/// Time and text of a solve that is given up, and that the solver is used up then.
void testGivenUp(const SolverOptions& options, SolveReason reason, double longest,
  const std::string& part, int size)
{
  auto matrix = std::make_unique<SparseMatrix>(cubeLaplacian(size));
  const std::vector<double> b = someVector(matrix->size);
  std::vector<double> x(b.size(), 1.0);
  const Stopwatch time;
  LinearSolver solver(systemOf(*matrix), options);
  const LinearSolution solution = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK(solution.reason == reason);
  TAUTLINE_CHECK(time.seconds() < longest);
  TAUTLINE_CHECK(contains(solution.message, part));
  TAUTLINE_CHECK_EQUAL(x[0], 0.0);
  TAUTLINE_CHECK_EQUAL(solution.trueResidual, 1.0);
  std::fill(x.begin(), x.end(), 1.0);
  const LinearSolution again = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK(again.reason == reason);
  TAUTLINE_CHECK_EQUAL(x[0], 0.0);
  TAUTLINE_CHECK_EQUAL(again.trueResidual, 1.0);
  // With an initial guess it is that which is returned, and its residual.
  std::fill(x.begin(), x.end(), 1.0);
  solver.options().initialGuess = true;
  TAUTLINE_CHECK_RELATIVE(
    solver.solve(b.data(), x.data()).trueResidual, relativeResidual(*matrix, x, b), 1e-12);
  TAUTLINE_CHECK_EQUAL(x[0], 1.0);
  TAUTLINE_CHECK_EQUAL(solver.setUp(), 0.0);
  // The work goes on without the matrix it was given.
  matrix.reset();
}

void testSetUps()
{
  // Some seconds each without a limit.
  constexpr int size = 34;
  constexpr double limit = 0.2, longest = 4.0;
  TAUTLINE_LET(SolverOptions, direct, method = KrylovMethod::Direct, maximumSeconds = limit);
  testGivenUp(direct, SolveReason::TimeLimit, longest, "The factorization", size);
  {
    // While it goes on, a limit is kept; without destroying anything that it uses.
    const SparseMatrix a = laplacian(5);
    TAUTLINE_LET(SolverOptions, options, maximumSeconds = 0.1);
    const Stopwatch time;
    try
    {
      const std::vector<double> b = someVector(a.size);
      std::vector<double> x(b.size());
      LinearSolver solver(systemOf(a), options);
      solver.solve(b.data(), x.data()); // the factorization may have ended by now
    }
    catch (const Error& error)
    {
      TAUTLINE_CHECK(contains(error.what(), wording("still-occupies")));
    }
    TAUTLINE_CHECK(time.seconds() < 3.0);
  }
  checkSolves();

  TAUTLINE_LET(SolverOptions, incomplete, preconditioner = Preconditioner::ILU,
    petscOptions = "-pc_factor_levels 8");
  const Stopwatch sinceStart;
  incomplete.cancelled = [&]() { return sinceStart.seconds() > 0.2; };
  testGivenUp(incomplete, SolveReason::Aborted, longest, "", size);
  checkSolves();
}

void testCondition()
{
  const SparseMatrix a = cubeLaplacian(30); // shift-invert by a factorization
  TAUTLINE_LET(ConditionOptions, options, tolerance = 1e-14, maximumSeconds = 0.05);
  const Stopwatch time;
  const ConditionEstimate estimate = estimateCondition(systemOf(a), options);
  TAUTLINE_CHECK(!estimate.converged);
  TAUTLINE_CHECK(time.seconds() < 3.0);
  TAUTLINE_CHECK(contains(estimate.message, wording("time-limit")));
  checkSolves();
  int calls = 0;
  options.maximumSeconds = 0.0;
  options.cancelled = [&]() { return ++calls > 0; };
  const ConditionEstimate cancelled = estimateCondition(systemOf(a), options);
  TAUTLINE_CHECK(!cancelled.converged);
  TAUTLINE_CHECK(contains(cancelled.message, "user"));
  checkSolves();
}

/// Limits change neither the solution nor what the observer gets.
void testSame()
{
  const SparseMatrix a = laplacian(60);
  const std::vector<double> b = someVector(a.size);
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<double> without, with;
  for (std::vector<double>* x : { &without, &with })
  {
    TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::Jacobi,
      maximumSeconds = x == &with ? 100.0 : 0.0);
    int calls = 0;
    options.observer = [&](int iteration, double norm)
    {
      TAUTLINE_CHECK_EQUAL(iteration, calls);
      TAUTLINE_CHECK(norm > 0.0 && std::this_thread::get_id() == caller);
      ++calls;
      return true;
    };
    x->resize(b.size());
    LinearSolver solver(systemOf(a), options);
    const LinearSolution solution = solver.solve(b.data(), x->data());
    TAUTLINE_CHECK_EQUAL(calls, solution.iterations); // not in the one that converges
    // Now and then only.
    calls = 0;
    solver.options().observer = [&](int, double) { return ++calls > 0; };
    solver.options().observerSeconds = 100.0;
    solver.solve(b.data(), x->data());
    TAUTLINE_CHECK_EQUAL(calls, 1);
    solver.options().observer = [](int, double) -> bool { throw std::runtime_error("seen"); };
    std::vector<double> other(b.size());
    TAUTLINE_CHECK_THROWS(solver.solve(b.data(), other.data()), "seen");
    solver.options().observer = [&](int iteration, double) { return iteration < 7; };
    solver.options().observerSeconds = 0.0;
    const LinearSolution stopped = solver.solve(b.data(), other.data());
    TAUTLINE_CHECK(stopped.reason == SolveReason::Aborted);
    TAUTLINE_CHECK_EQUAL(stopped.iterations, 7);
    // A solver within the observer of another.
    solver.options().observer = [&](int, double)
    {
      checkSolves();
      return true;
    };
    solver.options().maximumIterations = 3;
    TAUTLINE_CHECK_EQUAL(solver.solve(b.data(), other.data()).iterations, 3);
  }
  TAUTLINE_CHECK(without == with);
}

/// Left running at the end of the process, which must neither wait nor crash.
void leaveRunning()
{
  TAUTLINE_LET(SolverOptions, direct, method = KrylovMethod::Direct, maximumSeconds = 0.1);
  testGivenUp(direct, SolveReason::TimeLimit, 4.0, "The factorization", 34);
}
}

TAUTLINE_TEST(TestSolverLimits)
{
  TAUTLINE_RUN(testWatchdog());
  TAUTLINE_RUN(testSame());
  TAUTLINE_RUN_SLOW(testSetUps());
  TAUTLINE_RUN(testCondition());
  leaveRunning();
}
