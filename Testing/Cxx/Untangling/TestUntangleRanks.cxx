// SPDX-License-Identifier: BSD-3-Clause
// Untangling on ranks: what fails on one rank only is an error on all of them, and none waits.
#include "Optimization/OptimizingRanks.h"
#include "Registry.h"
#include "tautline/Core/Memory.h"

using namespace tautline;

namespace
{
constexpr int ranks = 3;
constexpr double tooFew = 1000; // bytes
const double NaN = std::numeric_limits<double>::quiet_NaN();

/// The change of a rank before all untangle.
using Change = std::function<void(const DistributedMesh& mesh, UntangleOptions& options)>;

/// The message of each rank; "" where it had no error.
std::vector<std::string> messagesOf(const Change& change, double memoryOfFirst = HUGE_VAL)
{
  const MeshData whole = jittered(CellType::Tetrahedron, 5, 0.45);
  const auto rankOf = cutBy(whole, Cut::Slabs, ranks);
  std::vector<std::string> messages(ranks);
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(whole, group.rank(), rankOf);
      DistributedMesh mesh(group, { part.data.view(), nullptr, nullptr });
      const std::vector<unsigned char> fixed = rankBoundary(mesh);
      UntangleOptions options;
      options.fixed = fixed.data();
      const AllowedMemory memory(group.rank() == 0 ? memoryOfFirst : HUGE_VAL);
      change(mesh, options);
      try
      {
        untangle(Mesh(mesh.view()), options, Ranks(mesh));
      }
      catch (const Error& error)
      {
        messages[group.rank()] = error.what();
      }
    });
  return messages;
}

void testFailures()
{
  for (int wrong = 0; wrong < ranks; ++wrong)
  {
    const Context context("rank " + std::to_string(wrong));
    const auto check = [&](const Change& change, const std::string& text)
    {
      const Context inner(text);
      for (const std::string& message : messagesOf(change))
      {
        TAUTLINE_CHECK_EQUAL(message, "In process " + std::to_string(wrong) + ": " + text);
      }
    };
    check(
      [=](const DistributedMesh& mesh, UntangleOptions& options)
      {
        const bool here = mesh.group().rank() == wrong;
        options.observer = [=](const IterationState&)
        {
          if (here)
          {
            throw Error("The observer has failed.");
          }
          return true;
        };
      },
      "The observer has failed.");
    check([=](const DistributedMesh& mesh, UntangleOptions& options)
      { options.fixed = mesh.group().rank() == wrong ? nullptr : options.fixed; },
      "The fixed points of a mesh on several ranks must be specified, see rankBoundary().");
  }
}

/// Points of the piece of one rank that are not finite, whichever: all reject the mesh.
void testNotFinite()
{
  const MeshData whole = jittered(CellType::Tetrahedron, 5, 0.45);
  const auto rankOf = cutBy(whole, Cut::Slabs, ranks);
  for (int wrong = 0; wrong < ranks; ++wrong)
  {
    int errors = 0;
    std::mutex mutex;
    onRanks(ranks,
      [&](RankGroup& group)
      {
        RankPart part = partOf(whole, group.rank(), rankOf);
        part.data.points[7] = group.rank() == wrong ? NaN : part.data.points[7];
        const std::string expected =
          "In process " + std::to_string(wrong) + ": Point 2 has a coordinate that is not finite";
        try
        {
          DistributedMesh mesh(group, { part.data.view(), nullptr, nullptr });
        }
        catch (const Error& error)
        {
          const std::lock_guard<std::mutex> lock(mutex);
          errors += std::string(error.what()).find(expected) == 0;
        }
      });
    TAUTLINE_CHECK_EQUAL(errors, ranks);
  }
}

/// Points of one rank that became NaN: the mesh stays invalid there, and all ranks report it.
void testBrokenLater()
{
  const MeshData whole = jittered(CellType::Tetrahedron, 5, 0.45);
  const Run run = moveOnRanks<Found>(whole, Cut::Slabs, ranks,
    [&](DistributedMesh& mesh, Found& result)
    {
      const std::vector<unsigned char> fixed = rankBoundary(mesh);
      for (Index p = 0; p < mesh.localPoints(); ++p)
      {
        // One point inside, by its owner, who sends it to the others.
        const bool here = mesh.owned(p) && mesh.numbers()[p] == mesh.globalPoints() / 2;
        mesh.points()[3 * p] = here ? NaN : mesh.points()[3 * p];
      }
      mesh.exchange(mesh.points().data(), 3);
      untangleInto(mesh, fixed, result);
    });
  for (const Found& found : run.results)
  {
    TAUTLINE_CHECK(found.invertedAfter > 0);
    TAUTLINE_CHECK_EQUAL(found.invertedAfter, run.result.invertedAfter);
    TAUTLINE_CHECK_EQUAL(static_cast<Index>(found.remaining), found.invertedAfter);
    TAUTLINE_CHECK(found.reason == run.result.reason);
  }
}

/// The first rank has not the memory that the whole mesh takes.
void testMemory()
{
  const std::vector<std::string> messages =
    messagesOf([](const DistributedMesh&, UntangleOptions& options)
      { options.method = UntangleMethod::Simultaneous; },
      tooFew);
  for (const std::string& message : messages)
  {
    TAUTLINE_CHECK(message.find(wording("choose-the-effort-local")) != std::string::npos);
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestUntangleRanks)
{
  TAUTLINE_RUN(testFailures());
  TAUTLINE_RUN(testNotFinite());
  TAUTLINE_RUN(testBrokenLater());
  TAUTLINE_RUN(testMemory());
}
