// SPDX-License-Identifier: BSD-3-Clause
// 200,000 accepted operations on changing meshes, all checked after each.

#include "ReconnectionSteps.h"
#include "Registry.h"
#include "tautline/Core/Random.h"

using namespace tautline;

namespace
{
constexpr long AllWanted = 50000, FewWanted = 2500; // of each kind
constexpr long Attempts = 4000;                     // with one mesh

template <class Change>
void testOperations(const char* name, const Change& change)
{
  const Context context(name);
  const long wanted = slowParts() ? AllWanted : FewWanted;
  long accepted = 0;
  try
  {
    for (Index mesh = 0; accepted < wanted; ++mesh)
    {
      constexpr std::uint64_t Seed = 20261122;
      SplitMix random(Seed, 0, mesh);
      Choices choices = { [&] { return static_cast<std::uint32_t>(random.next() >> 32); },
        [] { return true; } };
      accepted += change(choices, Attempts);
    }
  }
  catch (const std::logic_error& violation)
  {
    std::cerr << violation.what() << " after " << accepted << " operations on former meshes\n";
    TAUTLINE_CHECK(!"the operations keep the mesh");
  }
  TAUTLINE_CHECK(accepted >= wanted);
}
}

TAUTLINE_TEST(TestReconnectionSteps)
{
  TAUTLINE_RUN(testOperations("triangles", changeTriangles));
  TAUTLINE_RUN(testOperations("tetrahedra", changeTetrahedra));
  TAUTLINE_RUN(testOperations("sliding boundary", changeSliding));
  TAUTLINE_RUN(testOperations("boundary on the surface", changeSurface));
}
