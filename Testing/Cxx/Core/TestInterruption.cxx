// SPDX-License-Identifier: BSD-3-Clause
// Interruption.h and the limits of an execution: scopes nest and restore the handler of SIGINT, a
// loop, an iteration and a factorization of a linear solver end, filters end on abort and at the
// time limit, which blocks share.
#include "Registry.h"
#include "Systems.h"
#include "VtkMeshes.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/LoopInterruption.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"
#include "vtkElementQuality.h"
#include "vtkHorizonNeighbors.h"
#include "vtkInterruption.h"
#include "vtkMeshOptimizer.h"

#include <csignal>
#include <ctime>
#include <thread>

using namespace tautline;

namespace
{
/// The time that an interruption may take on a machine under load; the work would take much longer.
constexpr double Soon = 20.0;

std::atomic<int> Signals{ 0 };

void countSignal(int)
{
  ++Signals;
}

bool interrupts(const std::function<void()>& work)
{
  const Stopwatch time;
  bool interrupted = false;
  try
  {
    work();
  }
  catch (const Interrupted&)
  {
    interrupted = true;
  }
  std::cout << (interrupted ? "interrupted" : "ended") << " after " << time.seconds() << " s\n";
  TAUTLINE_CHECK(time.seconds() < Soon);
  return interrupted;
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testScopes)
{
  struct sigaction before = {}, own = {}, after = {};
  own.sa_handler = countSignal;
  sigaction(SIGINT, &own, &before);
  throwIfInterrupted(); // no scope: no effect
  InterruptScope::cancel();
  throwIfInterrupted();
  {
    const InterruptScope outer;
    TAUTLINE_CHECK(interruptible() && !InterruptScope::interrupted());
    {
      const InterruptScope inner;
      raise(SIGINT);
    }
    TAUTLINE_CHECK(InterruptScope::signalled()); // until the outermost scope ends
    TAUTLINE_CHECK(interrupts(throwIfInterrupted));
    bool elsewhere = true;
    std::thread([&] { elsewhere = InterruptScope::interrupted() || interruptible(); }).join();
    TAUTLINE_CHECK(!elsewhere);
  }
  TAUTLINE_CHECK(!interruptible() && !InterruptScope::interrupted());
  TAUTLINE_CHECK_EQUAL(Signals.load(), 0);
  raise(SIGINT);
  TAUTLINE_CHECK_EQUAL(Signals.load(), 1); // the handler is back
  {
    const InterruptScope next; // without the signal of the one before
    throwIfInterrupted();
    InterruptScope::cancel();
    TAUTLINE_CHECK(!InterruptScope::signalled() && InterruptScope::interrupted());
    TAUTLINE_CHECK(interrupts(throwIfInterrupted));
  }
  {
    const InterruptScope withoutSignal(false);
    raise(SIGINT);
    throwIfInterrupted();
  }
  TAUTLINE_CHECK_EQUAL(Signals.load(), 2);
  // Signals that the process ignores stay ignored.
  std::signal(SIGINT, SIG_IGN);
  {
    const InterruptScope scope;
    raise(SIGINT);
    throwIfInterrupted();
  }
  sigaction(SIGINT, nullptr, &after);
  TAUTLINE_CHECK(after.sa_handler == SIG_IGN);
  sigaction(SIGINT, &before, nullptr);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testPolls)
{
  int outer = 0, inner = 0;
  const auto compute = [] { parallelFor(1000, 1, 1, [](Index) { throwIfInterrupted(); }); };
  {
    const PollScope first([&] { ++outer; });
    const PollScope second(
      [&]
      {
        ++inner;
        compute(); // is not polled again
      });
    const Stopwatch time;
    while (outer < 3 && !time.reached(Soon))
    {
      compute();
    }
  }
  TAUTLINE_CHECK(outer >= 3);
  TAUTLINE_CHECK_EQUAL(inner, outer);
  const PollScope failing([] { throw Error("the time is over"); });
  const Stopwatch time;
  TAUTLINE_CHECK_THROWS(
    while (!time.reached(Soon)) { compute(); }, "the time is over");
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testLoop)
{
  for (int threads : { 1, 4 })
  {
    const InterruptScope scope;
    constexpr Index chunks = 10000000;
    std::atomic<Index> done{ 0 };
    TAUTLINE_CHECK(interrupts(
      [&]
      {
        parallelFor(chunks, 1, threads,
          [&](Index i)
          {
            ++done;
            if (i == 100)
            {
              raise(SIGINT);
            }
            std::this_thread::sleep_for(std::chrono::microseconds(10));
          });
      }));
    TAUTLINE_CHECK(done < chunks);
  }
}

//------------------------------------------------------------------------------
/// An iteration that would not end, and a factorization that takes much longer than the check.
TAUTLINE_PART(testSolver)
{
  const int n = 300;
  const SparseMatrix matrix = laplacian(n);
  const std::vector<double> b = someVector(matrix.size);
  std::vector<double> x(b.size());
  for (const bool watched : { false, true })
  {
    const InterruptScope scope;
    TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::None,
      relativeTolerance = 1e-300, absoluteTolerance = 0.0, maximumIterations = 100000000,
      maximumSeconds = watched ? 1000.0 : 0.0);
    options.observer = [](int iteration, double)
    {
      if (iteration == 20)
      {
        raise(SIGINT);
      }
      return true;
    };
    TAUTLINE_LET(
      LinearSystem, system, matrix = &matrix, symmetric = system.positiveDefinite = true);
    TAUTLINE_CHECK(interrupts(
      [&]
      {
        LinearSolver solver(system, options);
        solver.solve(b.data(), x.data());
      }));
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testAbort)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 30, 30, 30);
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(toGrid(data)), AddMetricByName("imr"),
    SetTimeLimit(1e-9));
  {
    const Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(wording("the-time-limit-of-1e-09-s")));
    TAUTLINE_CHECK_EQUAL(outputOf(filter)->GetNumberOfCells(), 0);
  }
  filter->SetTimeLimit(0);
  const auto tag = stopAt(filter, vtkInterruption::PollEvent);
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetAbortExecute(), 1);
  TAUTLINE_CHECK_EQUAL(outputOf(filter)->GetNumberOfCells(), 0);
  TAUTLINE_SET(filter, RemoveObserver(tag), SetAbortExecute(0), Modified(), Update());
  TAUTLINE_CHECK(outputOf(filter)->GetNumberOfCells() > 0);

  // Cancelled from a callback, as Python does; the next execution is not.
  const auto cancelling =
    observe(filter, vtkInterruption::PollEvent, [](vtkAlgorithm*) { vtkInterruption::Cancel(); });
  vtkInterruption::Begin(true);
  TAUTLINE_SET(filter, Modified(), Update());
  TAUTLINE_CHECK(vtkInterruption::IsInterrupted() && filter->GetAbortExecute());
  TAUTLINE_CHECK(!vtkInterruption::End());
  TAUTLINE_CHECK(!vtkInterruption::IsInterrupted());
  filter->RemoveObserver(cancelling);
}

/// A filter that is none of vtkTautlineAlgorithm, with a scope of its own.
TAUTLINE_PART(testHorizonNeighbors)
{
  vtkNew<vtkHorizonNeighbors> filter;
  constexpr Index side = 300;
  filter->SetInputData(toGrid(blockMesh(CellType::Triangle, side, side, 0)));
  filter->SetHorizon(side);
  const auto outputs = [&filter]
  {
    return sumOf<vtkIdType>(0, filter->GetNumberOfOutputPorts(),
      [&](int port)
      { return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port))->GetNumberOfCells(); });
  };
  const auto tag = stopAt(filter, vtkInterruption::PollEvent);
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetAbortExecute(), 1);
  TAUTLINE_CHECK_EQUAL(outputs(), 0);
  TAUTLINE_SET(filter, RemoveObserver(tag), SetAbortExecute(0), Modified(), Update());
  TAUTLINE_CHECK(outputs() > side * side);
}

//------------------------------------------------------------------------------
/// The computing time of a thread between two polls counts, neither its waiting nor the polling.
TAUTLINE_PART(testMeasure)
{
  constexpr double span = 0.05; // seconds of CPU time
  const auto cpu = []
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const auto compute = [&](double seconds, bool poll)
  {
    for (const double end = cpu() + seconds; cpu() < end;)
    {
      if (poll)
      {
        throwIfInterrupted();
      }
    }
  };
  const auto measured = [&](const std::function<void()>& work)
  {
    measurePolls(true);
    {
      const InterruptScope scope(false);
      work();
    }
    const double longest = longestUnpolledSeconds();
    measurePolls(false);
    return longest;
  };
  const double polled = measured([&] { compute(4 * span, true); });
  const double waiting =
    measured([&] { std::this_thread::sleep_for(std::chrono::duration<double>(4 * span)); });
  TAUTLINE_CHECK(polled < span);
  TAUTLINE_CHECK(waiting < span);
  for (const bool last : { false, true })
  {
    const double unpolled = measured(
      [&]
      {
        compute(span, true);
        compute(2 * span, false);
        compute(span, !last); // or up to the end of the scope
      });
    TAUTLINE_CHECK(unpolled >= (last ? 3 : 2) * span);
    TAUTLINE_CHECK(unpolled < (last ? 4 : 3) * span);
  }
  // The code after an interruption frees the computed data, and cannot poll.
  TAUTLINE_CHECK(measured(
                   [&]
                   {
                     InterruptScope::cancel();
                     TAUTLINE_CHECK(interrupts(throwIfInterrupted));
                     compute(2 * span, false);
                   }) < span);
  // A scope without a measure leaves nothing behind, and outside of scopes nothing counts.
  measurePolls(true);
  compute(2 * span, false);
  TAUTLINE_CHECK(measured([] {}) < span);
}

//------------------------------------------------------------------------------
/// After the first block the time is over: the others get one iteration at most.
TAUTLINE_PART(testBlocksShareTheTime)
{
  const MeshData data = movedBlock(CellType::Tetrahedron, 24, 0.1);
  constexpr unsigned blocks = 4;
  vtkNew<vtkMultiBlockDataSet> input;
  for (unsigned i = 0; i < blocks; ++i)
  {
    MeshData moved = data;
    moved.transform(TAUTLINE_PLACE(p[0] + 100.0 * i, p[1], p[2]));
    input->SetBlock(i, toGrid(moved));
  }
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(input), SetPreset(0),
    AddObjectiveByName("imr", -1, 1.0, 0), SetRelativeChange(0.0), SetGradientNorm(0.0),
    SetTimeLimit(0.2), Update());
  vtkTable* history = filter->GetHistory();
  const vtkIdType rows = history->GetNumberOfRows();
  vtkIdType ofLast = 0; // the input, and an iteration
  while (ofLast < rows &&
    history->GetValueByName(rows - 1 - ofLast, "Block") ==
      history->GetValueByName(rows - 1, "Block"))
  {
    ++ofLast;
  }
  std::cout << ofLast << " of " << rows << " rows of the history are of the last block\n";
  TAUTLINE_CHECK(ofLast >= 1 && ofLast <= 2);
}

/// A caller that waits for a long chunk of a worker is interrupted, and the worker sees it. Returns
/// whether a worker came.
bool interruptsWaitingCaller()
{
  const InterruptScope scope;
  const std::thread::id caller = std::this_thread::get_id();
  constexpr double glance = 1e-3, patience = 0.2;
  std::atomic<bool> begun{ false }, seen{ false }, thrown{ false };
  const Stopwatch time;
  bool interrupted = false;
  const auto sleepWhile = [&](double longest, const auto& condition)
  {
    const Stopwatch asleep;
    while (condition() && !asleep.reached(longest))
    {
      std::this_thread::sleep_for(std::chrono::duration<double>(glance));
    }
  };
  try
  {
    // On a crowded machine a worker is asked once the loop has turned out to be long.
    constexpr Index chunks = 6;
    runChunks(chunks, 2,
      [&](Index)
      {
        if (std::this_thread::get_id() == caller)
        {
          sleepWhile(patience, [&] { return !begun; });
          return;
        }
        if (begun.exchange(true))
        {
          return;
        }
        std::this_thread::sleep_for(std::chrono::duration<double>(patience)); // the caller waits
        std::raise(SIGINT);
        sleepWhile(2 * Soon, [] { return !callerIsInterrupted(); });
        seen = callerIsInterrupted();
        try
        {
          pollInterruption(0);
        }
        catch (const Interrupted&)
        {
          thrown = true;
          throw; // as the chunks of workers do
        }
      });
  }
  catch (const Interrupted&)
  {
    interrupted = true;
  }
  TAUTLINE_CHECK_EQUAL(seen.load(), begun.load());
  TAUTLINE_CHECK_EQUAL(thrown.load(), begun.load());
  TAUTLINE_CHECK_EQUAL(interrupted, begun.load());
  TAUTLINE_CHECK(time.seconds() < Soon);
  return begun;
}

TAUTLINE_PART(testWaitingCaller)
{
  constexpr int attempts = 20; // a worker may come too late on a crowded machine
  bool came = resolveThreads(0) == 1;
  for (int i = 0; i < attempts && !came; ++i)
  {
    // In a thread of its own: what loops of this one have measured decides whether workers come.
    std::thread([&came] { came = interruptsWaitingCaller(); }).join();
  }
  TAUTLINE_CHECK(came);
}
}
