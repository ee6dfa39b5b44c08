// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MesherProcess.h
 * @brief A process of the program tautline-mesher.
 * Internal: not installed.
 */
#ifndef tautline_MesherProcess_h
#define tautline_MesherProcess_h

#include "MesherMessages.h"

#include <functional>
#include <string>

#include <sys/types.h>

namespace tautline
{
/**
 * @class tautline::MesherProcess
 * @brief Starts the program, requests one mesh from it, and ends it.
 *
 * The program ends with this object, and whenever this process ends (also by SIGKILL). It is the
 * file given by the environment variable TAUTLINE_MESHER, or the one installed with this library
 * (libexec/tautline/tautline-mesher).
 */
class MesherProcess
{
public:
  /// Throws Error, with the name of its package, if the program is missing.
  MesherProcess();
  ~MesherProcess();
  MesherProcess(const MesherProcess&) = delete;
  MesherProcess& operator=(const MesherProcess&) = delete;

  /**
   * @brief The bytes of the Result of a request.
   * @param progress called with the number of points of each Progress (0 before the first), and
   * five times a second if there is none; returning false ends the process with Error "stopped"
   *
   * Throws Error with the text of a Failure, or if the process ends without a result;
   * std::bad_alloc for NoMemory; and as throwIfInterrupted() does.
   */
  std::vector<char> ask(MesherMessage request, const std::vector<char>& bytes,
    const std::function<bool(Index)>& progress);

private:
  void send(const void* bytes, std::size_t size);
  void receive(void* bytes, std::size_t size, const std::function<bool()>& proceed);
  [[noreturn]] void failEnded();

  std::string Program;
  pid_t Child = -1;
  int Socket = -1;
};
}
#endif
