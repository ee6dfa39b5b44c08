// SPDX-License-Identifier: BSD-3-Clause
#include "PetscSession.h"

#include "tautline/Core/Memory.h"

#include <slepcsys.h>

#include <atomic>
#include <cstdlib>
#include <regex>
#include <vector>

namespace tautline
{
namespace
{
std::recursive_mutex& sessionMutex()
{
  // Never destroyed: solvers may outlive static objects.
  static auto* mutex = new std::recursive_mutex;
  return *mutex;
}

/// The messages collected by the error handler; guarded by the mutex.
std::string& collected()
{
  static auto* text = new std::string;
  return *text;
}

/// How often PETSc has been shut down, and whether a callback is registered for the next shutdown.
int generation = 0;
bool watched = false;

/// The number of nested scopes of this thread.
thread_local int depth = 0;

/// Whether Tautline, rather than the host, has started MPI and PETSc.
std::atomic<bool> ownMpi{ false }, ownPetsc{ false };

/// Objects to destroy when PETSc is no longer in use; guarded by a separate mutex.
struct PutOff
{
  std::mutex Mutex;
  std::vector<std::pair<void*, void (*)(void*)>> Objects;
};

PutOff& putOff()
{
  static auto* list = new PutOff;
  return *list;
}

PetscErrorCode petscEnds()
{
  ++generation;
  watched = false;
  ownPetsc = false;
  return 0;
}

bool mpiFinalized()
{
  int finalized = 0;
  MPI_Finalized(&finalized);
  return finalized != 0;
}

/// MPI started here is finalized at process exit: otherwise, mpirun would report a crash.
void finalizeMpi()
{
  if (!mpiFinalized())
  {
    MPI_Finalize();
  }
}

/// Keeps the innermost message, which states the cause; does not print or terminate.
PetscErrorCode collectError(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
  PetscErrorType type, const char* message, void*)
{
  if (type == PETSC_ERROR_INITIAL || collected().empty())
  {
    const char* general = nullptr;
    PetscErrorMessage(code, &general, nullptr);
    collected() = std::string("PETSc: ") +
      (message && *message ? message
          : general        ? general
                           : "error") +
      " (" + (function ? function : "?") + ", error " + std::to_string(code) + ")";
  }
  return code;
}

void ensureMpi()
{
  if (mpiFinalized())
  {
    throw Error("MPI has been shut down: linear systems can no longer be solved in this process.");
  }
  int initialized = 0;
  MPI_Initialized(&initialized);
  if (!initialized)
  {
    // Open MPI terminates the process if there is not enough memory for its threads and shared
    // segments.
    constexpr double mpiAndPetsc = 256 * 1048576.0; // address space, measured
    requireMemory(mpiAndPetsc, "the start of MPI and PETSc",
      "raise the memory limit of the process, or close other programs");
    int provided = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
    {
      throw Error("MPI cannot be started: linear systems cannot be solved in this process.");
    }
    ownMpi = true;
    std::atexit(finalizeMpi);
  }
}

void ensurePetsc()
{
  ensureMpi();
  PetscBool initialized = PETSC_FALSE;
  PetscInitialized(&initialized);
  if (initialized)
  {
    return;
  }
  // On a communicator with one rank, nothing is collective: a filter may run on a single rank.
  // PETSc gets its own arguments, because it would read .petscrc otherwise; the program's arguments
  // are not passed on.
  static char program[] = "tautline", noFiles[] = "-skip_petscrc",
              noSignals[] = "-no_signal_handler";
  static char* list[] = { program, noFiles, noSignals, nullptr };
  static char** arguments = list;
  static int count = 3;
  const MPI_Comm chosen = PETSC_COMM_WORLD; // set by other code that is about to initialize PETSc
  const MPI_Comm world = chosen == MPI_COMM_NULL ? MPI_COMM_WORLD : chosen;
  PETSC_COMM_WORLD = MPI_COMM_SELF;
  const PetscErrorCode code = PetscInitialize(&count, &arguments, nullptr, nullptr);
  PETSC_COMM_WORLD = world;
  if (code != 0)
  {
    throw Error("PETSc cannot be initialized (error " + std::to_string(code) + ").");
  }
  // Other users of PETSc get the values they would have had.
  MPI_Comm_rank(world, &PetscGlobalRank);
  MPI_Comm_size(world, &PetscGlobalSize);
  ownPetsc = true;
  PetscOptionsClearValue(nullptr, noFiles);
  PetscOptionsClearValue(nullptr, noSignals);
}

/// Must be called within a scope.
void destroyPutOff()
{
  decltype(PutOff::Objects) objects;
  {
    const std::lock_guard<std::mutex> lock(putOff().Mutex);
    objects.swap(putOff().Objects);
  }
  // Destruction runs outside the lock, which other threads need to put objects off.
  for (const auto& [object, destroy] : objects)
  {
    destroy(object);
  }
}
}

//------------------------------------------------------------------------------
bool petscUsable()
{
  PetscBool initialized = PETSC_FALSE;
  return !mpiFinalized() && PetscInitialized(&initialized) == 0 && initialized;
}

int petscGeneration()
{
  return generation;
}

void ensureSlepc()
{
  PetscBool initialized = PETSC_FALSE;
  petsc(SlepcInitialized(&initialized));
  if (!initialized)
  {
    petsc(SlepcInitialize(nullptr, nullptr, nullptr, nullptr));
  }
}

PetscScope::PetscScope(PetscOptions database)
  : Lock(sessionMutex())
{
  ensurePetsc();
  // The callback detects that other code ends PETSc, which invalidates all its objects.
  if (!watched)
  {
    watched = PetscRegisterFinalize(petscEnds) == 0;
  }
  this->Generation = generation;
  if (!database)
  {
    if (PetscOptionsCreate(&this->Own) != 0)
    {
      throw Error("PETSc has no memory for its options.");
    }
    database = this->Own;
  }
  // Each nested scope collects its own messages.
  std::swap(this->Outer, collected());
  PetscPushErrorHandler(collectError, nullptr);
  PetscOptionsPush(database);
  ++depth;
}

PetscScope::~PetscScope()
{
  if (depth == 1)
  {
    destroyPutOff();
  }
  --depth;
  // In the meantime, another user of PETSc may have finalized it from a callback.
  if (petscUsable() && this->Generation == generation)
  {
    PetscOptionsPop();
    PetscPopErrorHandler();
    if (this->Own)
    {
      PetscOptionsDestroy(&this->Own);
    }
  }
  std::swap(this->Outer, collected());
}

//------------------------------------------------------------------------------
std::string explainPetsc(const PetscError& error, const std::string& subject)
{
  switch (error.code())
  {
    case OwnError:
      return error.what();
    case PETSC_ERR_MAT_LU_ZRPVT:
    case PETSC_ERR_MAT_CH_ZRPVT:
      return "A pivot is zero with " + subject +
        ": the matrix is singular, or not positive definite. Check that enough points are fixed "
        "and that the coefficients are positive, or choose Preconditioner = Jacobi or BoomerAMG.";
    case PETSC_ERR_MEM:
      return "Insufficient memory with " + subject +
        ": choose Preconditioner = Jacobi or SSOR, or a coarser mesh.";
    case PETSC_ERR_MISSING_FACTOR:
      return "No package of this PETSc can factorize this matrix with " + subject +
        ": choose another preconditioner or package; Solver = direct selects an available "
        "package.";
    default:
      break;
  }
  // Sentences with an option are advice on options that the user has not specified.
  static const std::regex advice("[^.;:]*\\s-[A-Za-z]+_[A-Za-z_]+[^.;]*[.;]?");
  return subject + " failed: " + std::regex_replace(std::string(error.what()), advice, "") +
    " Choose another preconditioner or solver.";
}

//------------------------------------------------------------------------------
bool petscWatchable(const WatchLimits& limits)
{
  if (depth > 0 || !(limits.any() || insideWatchedCall()))
  {
    return false;
  }
  if (!petscUsable())
  {
    const PetscScope scope; // starts MPI in this thread, which must also finalize it
  }
  int level = MPI_THREAD_SINGLE;
  // A host that started MPI may call it from its own threads at the same time.
  const int needed = ownMpi ? MPI_THREAD_SERIALIZED : MPI_THREAD_MULTIPLE;
  return ownPetsc && MPI_Query_thread(&level) == MPI_SUCCESS && level >= needed;
}

WatchResult watchPetsc(const WatchLimits& limits, const std::function<void(WatchedWork*)>& work)
{
  if (petscWatchable(limits))
  {
    return runWatched([work](WatchedWork& watched) { work(&watched); }, limits);
  }
  work(nullptr);
  return WatchResult::Finished;
}

void destroyInSession(void* object, void (*destroy)(void*))
{
  // After PETSc was shut down, there is nothing left to destroy, and it must not be restarted for
  // that.
  if (!petscUsable())
  {
    destroy(object);
    return;
  }
  if (const std::unique_lock<std::recursive_mutex> lock(sessionMutex(), std::try_to_lock); lock)
  {
    const PetscScope scope;
    destroy(object);
    return;
  }
  const std::lock_guard<std::mutex> lock(putOff().Mutex);
  putOff().Objects.emplace_back(object, destroy);
}

void keepForever(void* object)
{
  static std::mutex guard;
  static auto* const kept = new std::vector<void*>; // threads may outlive static objects
  const std::lock_guard<std::mutex> lock(guard);
  kept->push_back(object);
}

const std::string& petscMessage()
{
  return collected();
}
}
