// SPDX-License-Identifier: BSD-3-Clause
#include "Termination.h"

#include "tautline/Core/Types.h"

#include <cerrno>
#include <cstring>

#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace tautline
{
//------------------------------------------------------------------------------
bool endWithParent(pid_t parent, int signal)
{
  ::prctl(PR_SET_PDEATHSIG, signal);
  return ::getppid() == parent; // the parent may already have ended
}

//------------------------------------------------------------------------------
TerminationSignal::TerminationSignal()
{
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &set, &this->Before);
  this->File = ::signalfd(-1, &set, SFD_CLOEXEC);
  if (this->File < 0)
  {
    ::sigprocmask(SIG_SETMASK, &this->Before, nullptr);
    throw Error(std::string("no file for the end of TetGen: ") + std::strerror(errno));
  }
}

//------------------------------------------------------------------------------
TerminationSignal::~TerminationSignal()
{
  ::close(this->File);
  ::sigprocmask(SIG_SETMASK, &this->Before, nullptr);
}

//------------------------------------------------------------------------------
void TerminationSignal::release() const
{
  ::signal(SIGTERM, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &this->Before, nullptr);
}
}
