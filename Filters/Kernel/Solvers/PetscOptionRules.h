// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PetscOptionRules.h
 * @brief The PETSc options that a user may specify as text.
 *
 * The text is parsed here, before it is passed to PETSc. Options that choose and tune Krylov
 * methods, preconditioners, and eigensolvers are permitted if they are in a table, for the solver
 * itself or, with a prefix, for an inner solver. All other options are rejected: options that
 * display or monitor (they can write files), read files (-options_file), load code (-pc_type
 * python, shell, hpddm), need data that only a program can provide (-pc_type mg, composite), stop
 * the process, attach a debugger, or affect PETSc as a whole. Values are checked against a type, a
 * range or a list, so that no value can be a file name. -pc_type fieldsplit splits by component
 * only (-fieldsplit_0_... is the solver of the first): other splits need index sets.
 * Internal: not installed.
 */
#ifndef tautline_PetscOptionRules_h
#define tautline_PetscOptionRules_h

#include "tautline/SolversExport.h"

#include <string>
#include <vector>

namespace tautline
{
/// An option in the form that PETSc expects.
struct PetscOption
{
  std::string name;  ///< with the hyphen and prefixes: "-mg_levels_pc_type"
  std::string value; ///< "" for one without a value
};

/**
 * @brief The options of a text "-name value -name value ...", checked.
 *
 * Throws Error with the first option that is not permitted and similar names, or with the value
 * that is not permitted and the permitted values.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<PetscOption> parsePetscOptions(const std::string& text);

/// The names in the table, without hyphens and prefixes, in alphabetical order.
TAUTLINE_SOLVERS_EXPORT std::vector<std::string> permittedPetscOptions();

/// The permitted values of an option whose values are words ("pc_type"); otherwise empty.
TAUTLINE_SOLVERS_EXPORT std::vector<std::string> permittedPetscValues(const std::string& name);
}
#endif
