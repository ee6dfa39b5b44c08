// SPDX-License-Identifier: BSD-3-Clause
// Memory and messages of ranks that read ranges of files: lack of memory is an error of all ranks,
// no header takes more than its lines have, numbers of nodes are divided evenly, and parts do not
// depend on how much is sent or read at once.

#include "Registry.h"
#include "RangeChecks.h"
#include "SharedTags.h"

#include "vtkGmshReader.h"
#include "vtkNew.h"
#include "vtkObject.h"

#include <cstdlib>
#include <new>

namespace
{
constexpr std::size_t LargeBytes = 8192; // larger than any message of these tests
constexpr int NeverFails = -1;

thread_local int largeBeforeFailure = NeverFails; // allocations
thread_local bool hasFailed = false;
thread_local std::size_t bytesTaken = 0;
}

// Not inlined: compilers warn of free() where they see only one of the two.
__attribute__((noinline)) void* operator new(std::size_t bytes)
{
  bytesTaken += bytes;
  if (bytes > LargeBytes && largeBeforeFailure != NeverFails && largeBeforeFailure-- == 0)
  {
    hasFailed = true;
    largeBeforeFailure = NeverFails;
    throw std::bad_alloc();
  }
  if (void* memory = std::malloc(bytes > 0 ? bytes : 1))
  {
    return memory;
  }
  throw std::bad_alloc();
}
__attribute__((noinline)) void operator delete(void* memory) noexcept
{
  std::free(memory);
}
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

using namespace tautline;

namespace
{
constexpr Index SmallMessages = 2048; // bytes

/// Writes a mesh with arrays in each format; returns the names.
std::vector<std::string> writeSamples(Index n)
{
  const std::string stem = output + "/range-memory";
  MeshFile mesh = sample(n);
  writeText(stem + ".msh", gmsh2(mesh, [](Index i) { return i * i; }));
  mesh.cellArrays.push_back(MeshArray::make("Energy", 1, 'f', mesh.cellTypes.size()));
  writeMedit(mesh, stem + ".mesh");
  mesh.cellArrays.pop_back();
  writeTetGen(mesh, stem + ".node");
  return { stem + ".msh", stem + ".mesh", stem + ".node" };
}

//------------------------------------------------------------------------------
/// Lets one large allocation of a rank fail after the other.
void testFailures()
{
  constexpr int ranks = 3, failing = 1, fewest = 20;
  for (const std::string& name : writeSamples(8))
  {
    const Context file(name);
    int failures = 0;
    for (int allocation = 0, more = 1; more; ++allocation)
    {
      std::atomic<int> errors = 0;
      std::atomic<bool> failed = false;
      onRanks(ranks,
        [&](RankGroup& group)
        {
          const FileRanges ranges(group, { 0, 1 << 20, SmallMessages });
          hasFailed = false;
          largeBeforeFailure = group.rank() == failing ? allocation : NeverFails;
          try
          {
            exchangeParts(ranges, shareByName(ranges, name, false), 1);
          }
          catch (const Error& error)
          {
            TAUTLINE_CHECK(
              std::string(error.what()).find(wording("too-little-memory")) != std::string::npos);
            ++errors;
          }
          largeBeforeFailure = NeverFails;
          if (group.rank() == failing)
          {
            failed = hasFailed;
          }
        });
      TAUTLINE_CHECK(errors == (failed ? ranks : 0));
      more = failed;
      failures += failed;
    }
    std::cout << name << ": " << failures << " failures of memory\n";
    TAUTLINE_CHECK(failures > fewest);
  }
}

/// Who reads the whole file gets the message of the reader: more processes do not help.
void testWhole()
{
  const std::string name = writeSamples(8)[0];
  vtkNew<vtkGmshReader> reader;
  reader->SetFileName(name.c_str());
  vtkObject::GlobalWarningDisplayOff();
  largeBeforeFailure = 0;
  reader->UpdatePiece(1, 3, 1);
  largeBeforeFailure = NeverFails;
  vtkObject::GlobalWarningDisplayOn();
  TAUTLINE_CHECK(hasFailed);
  TAUTLINE_CHECK(reader->GetErrorText() ==
    name + ": Not enough memory: read it where there is more, or a part of the mesh.");
  TAUTLINE_CHECK(!reader->GetReadByRanges());
  reader->UpdatePiece(0, 3, 1);
  TAUTLINE_CHECK(std::string(reader->GetErrorText()).empty());
}

//------------------------------------------------------------------------------
/// The most bytes that a rank takes.
std::size_t mostTaken(const std::string& name, bool readable)
{
  constexpr int ranks = 3;
  std::atomic<std::size_t> most = 0;
  std::atomic<int> read = 0;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const std::size_t before = bytesTaken;
      try
      {
        const FileRanges ranges(group, { 0 });
        shareByName(ranges, name, true);
        ++read;
      }
      catch (const UnusualFile&)
      {
      }
      const std::size_t taken = bytesTaken - before;
      for (std::size_t known = most; known < taken && !most.compare_exchange_weak(known, taken);)
      {
      }
    });
  TAUTLINE_CHECK(read == (readable ? ranks : 0));
  return most;
}

/// Headers whose columns the lines do not have.
void testColumns()
{
  const std::vector<std::string> names = writeSamples(8);
  const std::string stem = output + "/range-memory", nodes = readText(stem + ".node");
  const std::size_t good = mostTaken(stem + ".node", true);
  const std::string header = " 3 4 1\n"; // dimension, attributes, markers
  TAUTLINE_CHECK(nodes.find(header) != std::string::npos);
  writeText(stem + ".node", replaced(nodes, header, " 3 10000 0\n"));
  const std::size_t bad = mostTaken(stem + ".node", false);
  std::cout << "vertices: " << good << " bytes, with a wrong header " << bad << "\n";
  TAUTLINE_CHECK(bad < good);

  const std::string gmsh = readText(stem + ".msh");
  const std::size_t goodData = mostTaken(stem + ".msh", true);
  const std::string from = "\n3\n0\n3\n", to = "\n3\n0\n1000\n"; // components
  TAUTLINE_CHECK(gmsh.find(from) != std::string::npos);
  writeText(stem + ".msh", replaced(gmsh, from, to));
  const std::size_t badData = mostTaken(stem + ".msh", false);
  std::cout << "node data: " << goodData << " bytes, with a wrong header " << badData << "\n";
  TAUTLINE_CHECK(badData < goodData);
}

//------------------------------------------------------------------------------
/// Ranks answer for about as many numbers each, whatever the gaps between these.
void testTags()
{
  constexpr int ranks = 4;
  constexpr Index perRank = 1000, huge = 1000000000000;
  constexpr double even = 1.2;
  const std::function<Index(Index)> numberings[] = { [&](Index i)
    { return i == 17 ? huge : 3 * i + 1; },
    [](Index i) { return 1024 * i; }, [](Index i) { return i * i * i; },
    [](Index i) { return 4 * (ranks * perRank - i); } };
  for (const auto& number : numberings)
  {
    std::atomic<std::size_t> all = 0;
    onRanks(ranks,
      [&](RankGroup& group)
      {
        const FileRanges ranges(group, { 0 });
        std::vector<Index> own, asked, expected;
        for (Index i = 0; i < perRank; ++i)
        {
          own.push_back(number(group.rank() * perRank + i));
          expected.push_back(7 * i % (ranks * perRank));
          asked.push_back(number(expected.back()));
        }
        const SharedTags tags(ranges, own);
        TAUTLINE_CHECK(static_cast<double>(tags.answers()) < even * perRank);
        all += tags.answers();
        tags.find(asked);
        TAUTLINE_CHECK(asked == expected);
        asked = { number(0), 2 };
        try
        {
          tags.find(asked);
          TAUTLINE_CHECK(false);
        }
        catch (const UnusualFile&)
        {
        }
      });
    TAUTLINE_CHECK(all == ranks * perRank);
  }
}

//------------------------------------------------------------------------------
/// Many rounds of sending and searching.
void testRounds()
{
  constexpr Index tiny = 48; // bytes
  for (const std::string& name : writeSamples(2))
  {
    expectSame(name, { 0, tiny, tiny });
  }
}
}

TAUTLINE_TEST(TestRangeMemory)
{
  data = argv[1];
  output = argv[2];
  TAUTLINE_RUN(testWhole());
  TAUTLINE_RUN(testTags());
  TAUTLINE_RUN(testColumns());
  TAUTLINE_RUN_SLOW(testRounds());
  TAUTLINE_RUN(testFailures());
}
