// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PetscSession.h
 * @brief PETSc inside a process that may also use it: initialized at first use, used by one thread
 * at a time, with separate options and error handler that do not affect other users.
 * Internal: not installed.
 */
#ifndef tautline_PetscSession_h
#define tautline_PetscSession_h

#include "Watchdog.h"

#include "tautline/Core/Types.h"

#include <petscksp.h>

#include <exception>
#include <functional>
#include <mutex>
#include <utility>

namespace tautline
{
/// A failed call of PETSc or SLEPc, with its text; OwnError: an error of Tautline, passed to the
/// user unchanged.
constexpr PetscErrorCode OwnError = -1;
class PetscError : public Error
{
public:
  PetscError(PetscErrorCode code, const std::string& text)
    : Error(text)
    , Code(code)
  {
  }
  PetscErrorCode code() const { return this->Code; }

private:
  PetscErrorCode Code;
};

/**
 * @brief A PETSc error in terms of the user's choices, with a remedy.
 * @param subject the choice: "Preconditioner = ILU(0)"
 *
 * Advice to set PETSc options is omitted.
 */
std::string explainPetsc(const PetscError& error, const std::string& subject);

/// Whether MPI and PETSc are initialized and not yet shut down, so that objects can be destroyed.
bool petscUsable();

/// Counts how often PETSc has been shut down: objects created before are lost, including their
/// memory.
int petscGeneration();

/// Initializes SLEPc if necessary. Must be called within a PetscScope.
void ensureSlepc();

/**
 * @class tautline::PetscScope
 * @brief Required around every use of PETSc.
 *
 * The first scope of the process initializes PETSc (and MPI if necessary), not collectively,
 * without a signal handler, without the program's arguments, and without .petscrc (in the working
 * directory or the home directory). The environment variable PETSC_OPTIONS is read as in any
 * program with PETSc, but only options that affect PETSc as a whole take effect here, not options
 * of solvers. While a scope exists, no other thread of Tautline uses PETSc, options are looked up
 * in `database` alone, and errors are collected rather than printed. Scopes can be nested.
 */
class PetscScope
{
public:
  /// Throws Error if MPI has already been shut down. A null database means an empty one.
  explicit PetscScope(PetscOptions database = nullptr);
  ~PetscScope();
  PetscScope(const PetscScope&) = delete;
  PetscScope& operator=(const PetscScope&) = delete;

private:
  std::unique_lock<std::recursive_mutex> Lock;
  PetscOptions Own = nullptr;
  int Generation = 0;
  std::string Outer; // messages collected outside this scope
};

/**
 * @brief Runs work that uses PETSc and cannot be interrupted, under limits.
 *
 * If petscWatchable() returns true, the watchdog's thread runs the work, and `work` receives the
 * object for its callbacks; otherwise this thread runs it, `work` receives null, the limits do not
 * apply, and the result is Finished. The work must create its own PetscScope.
 */
WatchResult watchPetsc(const WatchLimits& limits, const std::function<void(WatchedWork*)>& work);

/// The error if a limit is reached before the work could begin.
constexpr const char* BusyMessage =
  "An earlier computation that was abandoned at its limit still occupies PETSc: wait until it "
  "has ended, or restart the program.";

/**
 * @brief Whether watchPetsc() uses the watchdog's thread.
 *
 * It does if there are limits and Tautline has started PETSc (otherwise the host may use it
 * concurrently with abandoned work), with MPI started by Tautline as MPI_THREAD_SERIALIZED or by
 * the host as MPI_THREAD_MULTIPLE (the host may call it concurrently with abandoned work). It does
 * not within a PetscScope. pvserver, pvbatch, and programs that call MPI_Init() have a lower level:
 * there, a limit is checked after each setup.
 */
bool petscWatchable(const WatchLimits& limits);

/// Destroys an owner of PETSc objects within a PetscScope; while another thread uses PETSc, this is
/// deferred until it has finished.
void destroyInSession(void* object, void (*destroy)(void*));

/// destroyInSession() as the deleter of a pointer.
template <class Owner>
struct PetscDelete
{
  void operator()(Owner* owner) const
  {
    destroyInSession(owner, [](void* object) { delete static_cast<Owner*>(object); });
  }
};

/// PETSc's message for the last failed call in this scope.
const std::string& petscMessage();

/// Throws PetscError unless the code is 0.
inline void petsc(PetscErrorCode code)
{
  if (code != 0)
  {
    throw PetscError(code, petscMessage());
  }
}

/// Keeps the address of an object that cannot be destroyed, so that it is not reported as a leak.
void keepForever(void* object);

/// Owns a PETSc object. Its destructor must run within a PetscScope; it does nothing after PETSc
/// was shut down.
template <class Object, PetscErrorCode (*Destroy)(Object*)>
class PetscHandle
{
public:
  PetscHandle() = default;
  ~PetscHandle() { this->reset(); }
  PetscHandle(PetscHandle&& other) noexcept { *this = std::move(other); }
  PetscHandle& operator=(PetscHandle&& other) noexcept
  {
    std::swap(this->Held, other.Held);
    std::swap(this->Generation, other.Generation);
    return *this;
  }
  PetscHandle(const PetscHandle&) = delete;
  PetscHandle& operator=(const PetscHandle&) = delete;

  operator Object() const { return this->Held; }
  /// The address to pass to the function that creates the object.
  Object* out()
  {
    this->reset();
    this->Generation = petscGeneration();
    return &this->Held;
  }
  /// Releases the object without destroying it: it is kept until the process ends.
  void leak()
  {
    keepForever(this->Held);
    this->Held = nullptr;
  }
  void reset()
  {
    if (this->Held && petscUsable() && this->Generation == petscGeneration())
    {
      Destroy(&this->Held);
    }
    this->Held = nullptr;
  }

private:
  Object Held = nullptr;
  int Generation = 0;
};

using PetscMatrix = PetscHandle<Mat, MatDestroy>;
using PetscVector = PetscHandle<Vec, VecDestroy>;
using PetscSolver = PetscHandle<KSP, KSPDestroy>;
using PetscNullSpace = PetscHandle<MatNullSpace, MatNullSpaceDestroy>;
using PetscDatabase = PetscHandle<PetscOptions, PetscOptionsDestroy>;
}
#endif
