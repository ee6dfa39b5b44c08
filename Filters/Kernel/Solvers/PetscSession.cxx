#include "PetscSession.h"

#include "tautline/Core/Memory.h"

#include <slepcsys.h>

#include <cstdlib>

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

/// What the error handler has collected; guarded by the mutex.
std::string& collected()
{
  static auto* text = new std::string;
  return *text;
}

/// How often PETSc has been shut down, and whether a callback is registered for the next time.
int generation = 0;
bool watched = false;

PetscErrorCode petscEnds()
{
  ++generation;
  watched = false;
  return 0;
}

bool mpiFinalized()
{
  int finalized = 0;
  MPI_Finalized(&finalized);
  return finalized != 0;
}

/// MPI started here ends with the process: mpirun would report a crash otherwise.
void finalizeMpi()
{
  if (!mpiFinalized())
  {
    MPI_Finalize();
  }
}

/// Keeps the innermost message, which names the cause; neither prints nor terminates.
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
    // Open MPI ends the process where memory does not suffice for its threads and shared segments.
    constexpr double mpiAndPetsc = 256 * 1048576.0; // address space, measured
    requireMemory(mpiAndPetsc, "the start of MPI and PETSc",
      "raise the limit on the memory of the process, or end other programs");
    int provided = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
    {
      throw Error("MPI cannot be started: linear systems cannot be solved in this process.");
    }
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
  // On a communicator of one rank nothing is collective: a filter may run on one rank alone. PETSc
  // gets arguments of its own, or it would read .petscrc; those of the program are not passed on.
  static char program[] = "tautline", noFiles[] = "-skip_petscrc",
              noSignals[] = "-no_signal_handler";
  static char* list[] = { program, noFiles, noSignals, nullptr };
  static char** arguments = list;
  static int count = 3;
  const MPI_Comm chosen = PETSC_COMM_WORLD; // by other code that is about to initialize PETSc
  const MPI_Comm world = chosen == MPI_COMM_NULL ? MPI_COMM_WORLD : chosen;
  PETSC_COMM_WORLD = MPI_COMM_SELF;
  const PetscErrorCode code = PetscInitialize(&count, &arguments, nullptr, nullptr);
  PETSC_COMM_WORLD = world;
  if (code != 0)
  {
    throw Error("PETSc cannot be initialized (error " + std::to_string(code) + ").");
  }
  // Other users of PETSc find what they would have got.
  MPI_Comm_rank(world, &PetscGlobalRank);
  MPI_Comm_size(world, &PetscGlobalSize);
  PetscOptionsClearValue(nullptr, noFiles);
  PetscOptionsClearValue(nullptr, noSignals);
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
  std::swap(this->Outer, collected());
  PetscPushErrorHandler(collectError, nullptr);
  PetscOptionsPush(database);
}

PetscScope::~PetscScope()
{
  // Another user of PETSc may have ended it meanwhile, from a callback.
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

const std::string& petscMessage()
{
  return collected();
}
}
