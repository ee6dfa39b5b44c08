// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessGroup.h
 * @brief Wraps the processes of VTK's global controller as ranks of the kernel.
 */
#ifndef tautline_ProcessGroup_h
#define tautline_ProcessGroup_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Core/RankGroup.h"

#include <memory>

namespace tautline
{
/// The processes of the global MPI controller, or this process alone if there is only one. Throws
/// Error if several processes do not communicate by MPI. Valid as long as the controller.
TAUTLINECORE_EXPORT std::unique_ptr<RankGroup> makeProcessGroup();
/// The same; null if there are several processes that do not communicate by MPI.
TAUTLINECORE_EXPORT std::unique_ptr<RankGroup> tryProcessGroup();

/**
 * @class tautline::Assistants
 * @brief On the first process, the processes that wait in GatheredRules::assist. call() starts
 * them; otherwise the destructor dismisses them.
 */
class TAUTLINECORE_EXPORT Assistants
{
public:
  /// @param group made by TakesPieces(); null if this process is the only one
  explicit Assistants(std::unique_ptr<RankGroup> group);
  ~Assistants();
  Assistants(const Assistants&) = delete;
  Assistants& operator=(const Assistants&) = delete;

  /// Starts them. @return the group to work with; this process alone if there are none
  RankGroup& call();
  /// On another process: waits for the call. @return whether there is work
  static bool areCalled(RankGroup& group);

private:
  std::unique_ptr<RankGroup> Group;
  SingleRank Alone;
  bool Called = false;
};
}
#endif
