// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PetscOptionRules.h
 * @brief Which options of PETSc a user may give as text.
 * Internal: not installed.
 *
 * The text is read here, before PETSc sees it. Permitted are the options that choose and tune
 * Krylov methods, preconditioners and eigensolvers: those of a table, for the solver itself or,
 * with a prefix, for one inside it. Everything else is refused: what displays or monitors (it can
 * write files), what reads files (-options_file), loads code (-pc_type python, shell, hpddm),
 * needs data that only a program can give (-pc_type mg, composite), stops the process or attaches
 * a debugger, or is about PETSc as a whole. Values are checked against a type, a range or a list,
 * so that none can be the name of a file. -pc_type fieldsplit splits by component only
 * (-fieldsplit_0_... is the solver of the first): other splits need index sets.
 */
#ifndef tautline_PetscOptionRules_h
#define tautline_PetscOptionRules_h

#include "tautline/SolversExport.h"

#include <string>
#include <vector>

namespace tautline
{
/// An option as PETSc takes it.
struct PetscOption
{
  std::string name;  ///< with the hyphen and prefixes: "-mg_levels_pc_type"
  std::string value; ///< "" for one without a value
};

/**
 * @brief The options of a text "-name value -name value ...", checked.
 *
 * Throws Error that names the first option which is not permitted, with those of similar names, or
 * the value that is not possible, with those that are.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<PetscOption> parsePetscOptions(const std::string& text);

/// The names in the table, without hyphen and prefix, in alphabetical order.
TAUTLINE_SOLVERS_EXPORT std::vector<std::string> permittedPetscOptions();

/// Values that are possible for one of them whose values are words ("pc_type"); else empty.
TAUTLINE_SOLVERS_EXPORT std::vector<std::string> permittedPetscValues(const std::string& name);
}
#endif
