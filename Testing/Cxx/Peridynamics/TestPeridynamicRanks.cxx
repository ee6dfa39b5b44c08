// SPDX-License-Identifier: BSD-3-Clause
// Nonlocal matrices assembled by ranks that are threads equal the matrix of one rank, bitwise; an
// error or an interruption of one rank ends all.
#include "HorizonMeshes.h"
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Core/Interruption.h"

using namespace tautline;

namespace
{
PeridynamicOptions optionsOf(const NonlocalCase& each)
{
  return TAUTLINE_CHANGED(PeridynamicOptions(), basis = each.basis, model = each.model,
    discretization = each.discretization, horizon = 0.2, tolerance = 1e-4, threads = 1,
    poissonRatio = 0.3);
}

constexpr int Elements = 10; // along a side

HorizonMesh meshFor(const PeridynamicOptions& options, double shake)
{
  const auto layers = static_cast<int>(std::lround(Elements * interactionReach(options)));
  return shakenSquare(Elements, layers, shake);
}

TAUTLINE_PART_SLOW(testEqual)
{
  for (const bool shaken : { false, true })
  {
    for (const NonlocalCase& each : nonlocalCases)
    {
      const PeridynamicOptions options = optionsOf(each);
      // Shaken, no two pairs of triangles are alike.
      const HorizonMesh mesh = meshFor(options, shaken ? 0.1 : 0.0);
      const Index components = options.model == PeridynamicModel::Scalar ? 1 : 2;
      std::vector<double> given(components * numberOfFunctions(mesh, options.basis));
      Random random(9);
      for (double& value : given)
      {
        value = random.uniform(-1, 1);
      }
      const PeridynamicSystem one = assemblePeridynamics(mesh, options, &given);
      for (const int size : { 2, 3, 5 })
      {
        const Context context(
          std::string(each.name) + (shaken ? ", shaken, " : ", ") + std::to_string(size));
        std::vector<PeridynamicSystem> systems(size);
        onRanks(size,
          [&](RankGroup& group)
          {
            const HorizonMesh here = meshOfFirst(group, group.rank() == 0 ? mesh : HorizonMesh());
            PeridynamicOptions own = TAUTLINE_CHANGED(options, threads = 1 + group.rank() % 2);
            systems[group.rank()] = assemblePeridynamics(group, here, own, &given);
          });
        const PeridynamicSystem& all = systems[0];
        TAUTLINE_CHECK(all.matrix.offsets == one.matrix.offsets);
        TAUTLINE_CHECK(all.matrix.columns == one.matrix.columns);
        TAUTLINE_CHECK(all.matrix.values == one.matrix.values);
        TAUTLINE_CHECK(all.constraintLoad == one.constraintLoad);
        TAUTLINE_CHECK_EQUAL(all.asymmetry, one.asymmetry);
        TAUTLINE_CHECK(all.functionOf == one.functionOf);
        TAUTLINE_CHECK(all.integratedPairs >= one.integratedPairs);
        // Without repeated pairs, only those near the planes are integrated by several ranks.
        TAUTLINE_CHECK(!shaken || all.integratedPairs <= 2 * one.integratedPairs);
        for (int rank = 1; rank < size; ++rank)
        {
          TAUTLINE_CHECK_EQUAL(systems[rank].matrix.size, 0);
          TAUTLINE_CHECK(systems[rank].unknownOf == one.unknownOf);
        }
      }
    }
  }
}

TAUTLINE_PART(testEnds)
{
  const PeridynamicOptions options = optionsOf(nonlocalCases[0]);
  const HorizonMesh mesh = meshFor(options, 0.0);
  const auto run = [&](int rank, const auto& change)
  {
    onRanks(3,
      [&](RankGroup& group)
      {
        PeridynamicOptions own = options;
        HorizonMesh here = mesh;
        if (group.rank() == rank)
        {
          change(own, here);
        }
        assemblePeridynamics(group, here, own);
      });
  };
  TAUTLINE_CHECK_THROWS(
    run(0,
      [](PeridynamicOptions& own, HorizonMesh&) { own.progress = [](double) { return false; }; }),
    wording("stopped-by-the-user"));
  TAUTLINE_CHECK_THROWS(run(2, [](PeridynamicOptions& own, HorizonMesh&) { own.timeLimit = 1e-9; }),
    wording("in-process-2-the-time-limit"));
  TAUTLINE_CHECK_THROWS(
    run(1, [](PeridynamicOptions& own, HorizonMesh&) { own.memoryLimit = 1000; }),
    wording("in-process-1-the-matrix"));
  TAUTLINE_CHECK_THROWS(run(0, [](PeridynamicOptions& own, HorizonMesh&) { own.horizon = 0.5; }),
    wording("interaction-layer"));
  // An interruption, which is no error, on one rank; the others do not wait for it.
  std::vector<std::string> ends(3);
  onRanks(3,
    [&](RankGroup& group)
    {
      const PollScope scope(
        [&]
        {
          if (group.rank() == 1)
          {
            throw Interrupted();
          }
        });
      try
      {
        assemblePeridynamics(group, mesh, options);
      }
      catch (const Interrupted&)
      {
        ends[group.rank()] = "interrupted";
      }
      catch (const Error& error)
      {
        ends[group.rank()] = error.what();
      }
    });
  TAUTLINE_CHECK(ends ==
    (std::vector<std::string>{ "In process 1: the computation was interrupted", "interrupted",
      "In process 1: the computation was interrupted" }));
  // Progress that is asked for only after the start.
  TAUTLINE_CHECK_THROWS(run(1,
                          [](PeridynamicOptions& own, HorizonMesh&)
                          { own.progress = [](double part) { return part < 0.8; }; }),
    wording("stopped-by-the-user"));
}

/// A rank that stops while pairs are integrated, the first half of the work, ends the others soon.
TAUTLINE_PART(testSoon)
{
  constexpr double stop = 0.1, soon = 0.15;
  const PeridynamicOptions options = optionsOf(nonlocalCases[0]);
  const HorizonMesh mesh = meshFor(options, 0.1);
  std::vector<double> farthest(3, 0.0);
  TAUTLINE_CHECK_THROWS(onRanks(3,
                          [&](RankGroup& group)
                          {
                            PeridynamicOptions own = options;
                            own.progress = [&](double part)
                            {
                              double& here = farthest[group.rank()];
                              here = std::max(here, part);
                              return group.rank() != 0 || part < stop;
                            };
                            assemblePeridynamics(group, mesh, own);
                          }),
    wording("stopped-by-the-user"));
  TAUTLINE_EACH_OF(const double part, farthest, TAUTLINE_CHECK(part > 0 && part < soon));
}
}
