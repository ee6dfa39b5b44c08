// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PetscCompatibility.h
 * @brief The differences between PETSc 3.18 and 3.25, in one place.
 * Internal: not installed.
 */
#ifndef tautline_PetscCompatibility_h
#define tautline_PetscCompatibility_h

#include <petscksp.h>

#include <type_traits>

namespace tautline
{
/// The names of two reasons; the names before 3.24 have been deprecated since.
#if PETSC_VERSION_GE(3, 24, 0)
constexpr KSPConvergedReason ConvergedRelativeNormal = KSP_CONVERGED_RTOL_NORMAL_EQUATIONS;
constexpr KSPConvergedReason ConvergedAbsoluteNormal = KSP_CONVERGED_ATOL_NORMAL_EQUATIONS;
#else
constexpr KSPConvergedReason ConvergedRelativeNormal = KSP_CONVERGED_RTOL_NORMAL;
constexpr KSPConvergedReason ConvergedAbsoluteNormal = KSP_CONVERGED_ATOL_NORMAL;
#endif

/// The type of a function that destroys the context of a convergence test, from the function that
/// returns one.
template <class Function>
struct ContextDestructorOf;
template <class Solver, class Test, class Context, class Destructor>
struct ContextDestructorOf<PetscErrorCode(Solver, Test, Context, Destructor*)>
{
  using Type = Destructor;
};
using ContextDestructor =
  ContextDestructorOf<std::remove_pointer_t<decltype(&KSPGetAndClearConvergenceTest)>>::Type;

/**
 * @brief Calls the destructor of a context.
 *
 * Since 3.24, it takes the address of the context, with an argument of type void** or an alias of
 * void*; before, the context itself. With the wrong choice, the call compiles and crashes.
 */
template <class Argument>
PetscErrorCode destroyContext(PetscErrorCode (*destroy)(Argument), void*& context)
{
#if PETSC_VERSION_GE(3, 24, 0)
  constexpr bool byAddress = true;
#else
  constexpr bool byAddress = std::is_same_v<Argument, void**>;
#endif
  if constexpr (byAddress)
  {
    return destroy(reinterpret_cast<Argument>(&context));
  }
  else
  {
    return destroy(context);
  }
}

/**
 * @brief Lifts MINRES's bound on the length of the solution.
 *
 * Since 3.19, the method ends at 6.7e7 and reports convergence, which is wrong in units of
 * nanometers. User options that are read later override this bound.
 */
inline PetscErrorCode liftMinresRadius([[maybe_unused]] KSP solver)
{
#if PETSC_VERSION_GE(3, 19, 0)
  return KSPMINRESSetRadius(solver, PETSC_MAX_REAL);
#else
  return 0;
#endif
}
} // namespace tautline

#endif
