// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Termination.h
 * @brief How processes end with the one that started them.
 */
#ifndef tautline_Termination_h
#define tautline_Termination_h

#include <csignal>

#include <sys/types.h>

namespace tautline
{
/// Lets the system send this process a signal when its parent ends, and returns whether the parent
/// is still the given one.
bool endWithParent(pid_t parent, int signal);

/**
 * @class tautline::TerminationSignal
 * @brief While it exists, SIGTERM does not end the process but makes a file readable: so that a
 * child is ended and files are removed first.
 */
class TerminationSignal
{
public:
  /// Throws Error where the system has no file left.
  TerminationSignal();
  ~TerminationSignal();
  TerminationSignal(const TerminationSignal&) = delete;
  TerminationSignal& operator=(const TerminationSignal&) = delete;

  /// To be polled.
  int file() const { return this->File; }
  /// In a forked child: SIGTERM ends it.
  void release() const;

private:
  int File;
  sigset_t Before;
};
}
#endif
