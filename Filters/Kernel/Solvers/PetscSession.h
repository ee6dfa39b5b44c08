// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PetscSession.h
 * @brief PETSc inside a process that may use it, too: initialized at first use, one thread at a
 * time, with options and an error handler that leave those of other users alone.
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
/// A failed call of PETSc or SLEPc, with its text; OwnError: Tautline's, for the user as it is.
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
 * @brief An error of PETSc in terms of what the user chose, with a remedy.
 * @param subject the choice: "Preconditioner = ILU(0)"
 *
 * Advice to set options of PETSc is left out.
 */
std::string explainPetsc(const PetscError& error, const std::string& subject);

/// MPI and PETSc are there and not yet shut down, so that objects can be destroyed.
bool petscUsable();

/// Counts how often PETSc has been shut down: what was made before is lost, memory and all.
int petscGeneration();

/// Initializes SLEPc if that has not been done; within a PetscScope.
void ensureSlepc();

/**
 * @class tautline::PetscScope
 * @brief Every use of PETSc happens within one.
 *
 * The first one of the process initializes PETSc (and MPI if it is not), not collectively, without
 * signal handler, without the program's arguments and without .petscrc (of the working directory
 * or of the home directory). PETSC_OPTIONS of the environment is read as in any program with PETSc;
 * of it only what is about PETSc as a whole has an effect here, not options of solvers. While a
 * scope lives, no other thread of Tautline uses PETSc, options are looked up in `database` alone,
 * and errors are collected rather than printed. Scopes nest.
 */
class PetscScope
{
public:
  /// Throws Error when MPI has been shut down already. A null database: an empty one.
  explicit PetscScope(PetscOptions database = nullptr);
  ~PetscScope();
  PetscScope(const PetscScope&) = delete;
  PetscScope& operator=(const PetscScope&) = delete;

private:
  std::unique_lock<std::recursive_mutex> Lock;
  PetscOptions Own = nullptr;
  int Generation = 0;
  std::string Outer; // what was collected outside
};

/**
 * @brief Runs work that uses PETSc, and nothing of whose time can be limited, under limits.
 *
 * Where petscWatchable() holds, the watchdog's thread does it, and `work` gets the object for its
 * calls back; else this thread does it, `work` gets null, the limits do not apply, and the result
 * is Finished. The work begins its own PetscScope.
 */
WatchResult watchPetsc(const WatchLimits& limits, const std::function<void(WatchedWork*)>& work);

/// The error where a limit is reached before the work could begin.
constexpr const char* BusyMessage =
  "An earlier computation that was given up at its limit still occupies PETSc: wait until it has "
  "ended, or restart the program.";

/**
 * @brief Whether watchPetsc() uses the watchdog's thread.
 *
 * It does if there are limits and if Tautline has started PETSc (else the host may use it beside
 * abandoned work), with MPI started by Tautline as MPI_THREAD_SERIALIZED or by the host as
 * MPI_THREAD_MULTIPLE (the host may call it beside abandoned work). It does not within a
 * PetscScope. pvserver, pvbatch and programs that call MPI_Init() have a lower level: there a limit
 * is checked after each set-up.
 */
bool petscWatchable(const WatchLimits& limits);

/// Destroys what owns objects of PETSc within a PetscScope; while another thread uses PETSc, that
/// is put off until it has finished.
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

/// The message of PETSc on the last failed call in this scope.
const std::string& petscMessage();

/// Throws PetscError unless the code is 0.
inline void petsc(PetscErrorCode code)
{
  if (code != 0)
  {
    throw PetscError(code, petscMessage());
  }
}

/// Keeps the address of an object that cannot be destroyed, so that it does not count as lost.
void keepForever(void* object);

/// Owns a PETSc object. Its destructor must run within a PetscScope; it does nothing once PETSc has
/// gone.
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
  /// For the function that creates the object.
  Object* out()
  {
    this->reset();
    this->Generation = petscGeneration();
    return &this->Held;
  }
  /// Gives up the object without destroying it: it is kept until the process ends.
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
