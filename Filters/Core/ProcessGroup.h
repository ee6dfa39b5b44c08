// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessGroup.h
 * @brief The processes of VTK's global controller as the ranks of the kernel.
 */
#ifndef tautline_ProcessGroup_h
#define tautline_ProcessGroup_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Core/RankGroup.h"

#include <memory>

namespace tautline
{
/// The processes of the global controller by MPI; this process alone if there is one only. Throws
/// Error if there are several that do not communicate by MPI. Valid as long as the controller.
TAUTLINECORE_EXPORT std::unique_ptr<RankGroup> makeProcessGroup();
/// The same; null if there are several processes that do not communicate by MPI.
TAUTLINECORE_EXPORT std::unique_ptr<RankGroup> tryProcessGroup();

/**
 * @class tautline::Assistants
 * @brief On the first process: those that wait in GatheredRules::assist. They are called,
 * or else told by the destructor that there is nothing to do.
 */
class TAUTLINECORE_EXPORT Assistants
{
public:
  /// @param group made by TakesPieces(); null where this process is the only one
  explicit Assistants(std::unique_ptr<RankGroup> group);
  ~Assistants();
  Assistants(const Assistants&) = delete;
  Assistants& operator=(const Assistants&) = delete;

  /// Calls them. @return the group to work with, this process alone without any
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
