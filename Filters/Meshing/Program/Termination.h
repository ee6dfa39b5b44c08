// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Termination.h
 * @brief Termination of processes together with their parent.
 */
#ifndef tautline_Termination_h
#define tautline_Termination_h

#include <csignal>

#include <sys/types.h>

namespace tautline
{
/// Makes the system send this process a signal when its parent ends, and returns whether the parent
/// is still the given one.
bool endWithParent(pid_t parent, int signal);

/**
 * @class tautline::TerminationSignal
 * @brief While it exists, SIGTERM does not end the process but makes a file descriptor readable, so
 * that a child can be ended and files removed first.
 */
class TerminationSignal
{
public:
  /// Throws Error if the system has no file descriptor left.
  TerminationSignal();
  ~TerminationSignal();
  TerminationSignal(const TerminationSignal&) = delete;
  TerminationSignal& operator=(const TerminationSignal&) = delete;

  /// The file descriptor to poll.
  int file() const { return this->File; }
  /// In a forked child: restores the default, so that SIGTERM ends it.
  void release() const;

private:
  int File;
  sigset_t Before;
};
}
#endif
