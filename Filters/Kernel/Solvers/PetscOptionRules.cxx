// SPDX-License-Identifier: BSD-3-Clause
#include "PetscOptionRules.h"

#include "tautline/Core/Types.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>

namespace tautline
{
namespace
{
enum class Kind
{
  Flag,    // true or false; no value is true
  Integer, // in a range
  Real,    // in a range
  Reals,   // several, separated by commas
  Word     // one of a list
};

/// One option: its name and its permitted values.
struct Rule
{
  const char* name;
  Kind kind;
  double low, high;
  const char* words; // separated by spaces
};

constexpr double Infinite = std::numeric_limits<double>::infinity();
constexpr double LargestInteger = std::numeric_limits<int>::max();
// Limits on values that could make a single step take forever or exhaust the memory.
constexpr double InnerIterations = 10000, Sweeps = 100, Basis = 10000, Levels = 50;

constexpr Rule flag(const char* name)
{
  return { name, Kind::Flag, 0, 0, "" };
}
constexpr Rule integer(const char* name, double low, double high)
{
  return { name, Kind::Integer, low, high, "" };
}
constexpr Rule real(const char* name, double low, double high)
{
  return { name, Kind::Real, low, high, "" };
}
constexpr Rule reals(const char* name, double low, double high)
{
  return { name, Kind::Reals, low, high, "" };
}
constexpr Rule word(const char* name, const char* words)
{
  return { name, Kind::Word, 0, 0, words };
}

constexpr const char* Relaxations =
  "Jacobi sequential-Gauss-Seidel seqboundary-Gauss-Seidel SOR/Jacobi backward-SOR/Jacobi "
  "symmetric-SOR/Jacobi l1scaled-SOR/Jacobi Gaussian-elimination l1-Gauss-Seidel "
  "backward-l1-Gauss-Seidel Chebyshev FCF-Jacobi l1scaled-Jacobi";

// Ordered by family, then by name.
constexpr Rule rules[] = {
  // Krylov methods
  word("ksp_type",
    "bcgs bcgsl bicg cg cgls cgs cr fbcgs fbcgsr fcg fgmres gcr gmres groppcg ibcgs lcd "
    "lgmres lsqr minres pgmres pipecg pipecr pipefcg pipefgmres pipegcr preonly qmrcgs richardson "
    "symmlq tcqmr tfqmr"),
  real("ksp_rtol", 0, 1),
  real("ksp_atol", 0, Infinite),
  real("ksp_divtol", 0, Infinite),
  integer("ksp_max_it", 0, LargestInteger),
  word("ksp_norm_type", "none preconditioned unpreconditioned natural"),
  word("ksp_pc_side", "left right symmetric"),
  flag("ksp_diagonal_scale"),
  flag("ksp_diagonal_scale_fix"),
  flag("ksp_lag_norm"),
  integer("ksp_check_norm_iteration", -1, Basis),
  word("ksp_convergence_test", "default skip"),
  flag("ksp_converged_use_initial_residual_norm"),
  flag("ksp_converged_use_min_initial_residual_norm"),
  flag("ksp_converged_maxits"),
  integer("ksp_gmres_restart", 1, Basis),
  real("ksp_gmres_haptol", 0, 1),
  real("ksp_gmres_breakdown_tolerance", 0, Infinite),
  flag("ksp_gmres_preallocate"),
  flag("ksp_gmres_classicalgramschmidt"),
  flag("ksp_gmres_modifiedgramschmidt"),
  word("ksp_gmres_cgs_refinement_type", "refine_never refine_ifneeded refine_always"),
  integer("ksp_lgmres_augment", 0, Sweeps),
  flag("ksp_lgmres_constant"),
  flag("ksp_fgmres_modifypcnochange"),
  real("ksp_pipefgmres_shift", -Infinite, Infinite),
  integer("ksp_gcr_restart", 1, Basis),
  integer("ksp_lcd_restart", 1, Basis),
  real("ksp_lcd_haptol", 0, 1),
  integer("ksp_bcgsl_ell", 1, 20),
  flag("ksp_bcgsl_cxpoly"),
  flag("ksp_bcgsl_mrpoly"),
  flag("ksp_bcgsl_pinv"),
  real("ksp_bcgsl_xres", -1, Infinite),
  flag("ksp_cg_single_reduction"),
  integer("ksp_fcg_mmax", 1, Sweeps),
  integer("ksp_fcg_nprealloc", 1, Sweeps),
  word("ksp_fcg_truncation_type", "standard notay"),
  integer("ksp_pipefcg_mmax", 1, Sweeps),
  integer("ksp_pipefcg_nprealloc", 1, Sweeps),
  word("ksp_pipefcg_truncation_type", "standard notay"),
  integer("ksp_pipegcr_mmax", 1, Sweeps),
  integer("ksp_pipegcr_nprealloc", 1, Sweeps),
  word("ksp_pipegcr_truncation_type", "standard notay"),
  flag("ksp_pipegcr_unroll_w"),
  real("ksp_richardson_scale", 0, Infinite),
  flag("ksp_richardson_self_scale"),
  reals("ksp_chebyshev_eigenvalues", 0, Infinite),
  reals("ksp_chebyshev_esteig", 0, Infinite),
  integer("ksp_chebyshev_esteig_steps", 1, Sweeps),
  flag("ksp_chebyshev_esteig_noisy"),

  // preconditioners
  word("pc_type",
    "asm bjacobi cholesky eisenstat fieldsplit gamg gasm hypre icc ilu jacobi kaczmarz ksp lu none "
    "pbjacobi "
    "redundant sor svd telescope"),
  word("pc_jacobi_type", "diagonal rowmax rowsum"),
  flag("pc_jacobi_abs"),
  flag("pc_jacobi_fixdiagonal"),
  integer("pc_sor_its", 1, Sweeps),
  integer("pc_sor_lits", 1, Sweeps),
  real("pc_sor_omega", 0, 2),
  real("pc_sor_diagonal_shift", 0, Infinite),
  flag("pc_sor_symmetric"),
  flag("pc_sor_backward"),
  flag("pc_sor_forward"),
  flag("pc_sor_local_symmetric"),
  flag("pc_sor_local_backward"),
  flag("pc_sor_local_forward"),
  real("pc_eisenstat_omega", 0, 2),
  flag("pc_eisenstat_no_diagonal_scaling"),
  real("pc_kaczmarz_lambda", 0, 2),
  flag("pc_kaczmarz_symmetric"),
  integer("pc_factor_levels", 0, 20),
  real("pc_factor_fill", 1, 1000),
  flag("pc_factor_in_place"),
  flag("pc_factor_diagonal_fill"),
  word("pc_factor_shift_type", "none nonzero positive_definite inblocks"),
  real("pc_factor_shift_amount", 0, Infinite),
  real("pc_factor_zeropivot", 0, 1),
  real("pc_factor_column_pivot", 0, 1),
  flag("pc_factor_pivot_in_blocks"),
  real("pc_factor_nonzeros_along_diagonal", 0, 1),
  word("pc_factor_mat_ordering_type", "natural nd 1wd rcm qmd rowlength amd"),
  word("pc_factor_mat_solver_type", "petsc cholmod klu mumps superlu superlu_dist umfpack"),
  integer("pc_bjacobi_blocks", 1, LargestInteger),
  integer("pc_bjacobi_local_blocks", 1, LargestInteger),
  integer("pc_asm_blocks", 1, LargestInteger),
  integer("pc_asm_local_blocks", 1, LargestInteger),
  integer("pc_asm_overlap", 0, Sweeps),
  word("pc_asm_type", "basic restrict interpolate none"),
  word("pc_asm_local_type", "additive multiplicative"),
  integer("pc_gasm_overlap", 0, Sweeps),
  word("pc_gasm_type", "basic restrict interpolate none"),
  integer("pc_redundant_number", 1, LargestInteger),
  integer("pc_telescope_reduction_factor", 1, LargestInteger),
  real("pc_svd_zero_sing", 0, 1),
  integer("pc_svd_ess_rank", -1, LargestInteger),

  // fields: the components of a displacement
  word("pc_fieldsplit_type", "additive multiplicative symmetric_multiplicative"),

  // multigrid
  word("pc_mg_type", "additive multiplicative full kaskade"),
  word("pc_mg_cycle_type", "v w"),
  integer("pc_mg_multiplicative_cycles", 1, Sweeps),
  flag("pc_mg_distinct_smoothup"),
  word("pc_gamg_type", "agg classical"),
  integer("pc_gamg_agg_nsmooths", 0, 10),
  integer("pc_gamg_aggressive_coarsening", 0, 10),
  integer("pc_gamg_square_graph", 0, 10),
  reals("pc_gamg_threshold", -1, 1),
  real("pc_gamg_threshold_scale", 0, 1),
  integer("pc_gamg_coarse_eq_limit", 1, 100000),
  integer("pc_gamg_process_eq_limit", 1, LargestInteger),
  flag("pc_gamg_repartition"),
  flag("pc_gamg_asm_use_agg"),
  flag("pc_gamg_use_sa_esteig"),
  flag("pc_gamg_use_parallel_coarse_grid_solver"),
  flag("pc_gamg_reuse_interpolation"),
  real("pc_gamg_classical_interp_threshold", 0, 1),
  integer("pc_gamg_classical_nsmooths", 0, 10),
  word("pc_gamg_classical_type", "direct standard"),
  word("pc_hypre_type", "boomeramg euclid parasails pilut"),
  word("pc_hypre_boomeramg_cycle_type", "V W"),
  integer("pc_hypre_boomeramg_max_levels", 2, Levels),
  integer("pc_hypre_boomeramg_max_iter", 1, Sweeps),
  real("pc_hypre_boomeramg_tol", 0, 1),
  integer("pc_hypre_boomeramg_numfunctions", 1, 3),
  real("pc_hypre_boomeramg_truncfactor", 0, 1),
  integer("pc_hypre_boomeramg_P_max", 0, Sweeps),
  integer("pc_hypre_boomeramg_agg_nl", 0, Levels),
  integer("pc_hypre_boomeramg_agg_num_paths", 1, 10),
  real("pc_hypre_boomeramg_strong_threshold", 0, 1),
  real("pc_hypre_boomeramg_max_row_sum", 0, 1),
  integer("pc_hypre_boomeramg_grid_sweeps_all", 1, Sweeps),
  integer("pc_hypre_boomeramg_grid_sweeps_down", 1, Sweeps),
  integer("pc_hypre_boomeramg_grid_sweeps_up", 1, Sweeps),
  integer("pc_hypre_boomeramg_grid_sweeps_coarse", 1, Sweeps),
  word("pc_hypre_boomeramg_relax_type_all", Relaxations),
  word("pc_hypre_boomeramg_relax_type_down", Relaxations),
  word("pc_hypre_boomeramg_relax_type_up", Relaxations),
  word("pc_hypre_boomeramg_relax_type_coarse", Relaxations),
  real("pc_hypre_boomeramg_relax_weight_all", 0, 2),
  real("pc_hypre_boomeramg_outer_relax_weight_all", 0, 2),
  flag("pc_hypre_boomeramg_no_CF"),
  word("pc_hypre_boomeramg_measure_type", "local global"),
  word(
    "pc_hypre_boomeramg_coarsen_type", "CLJP Ruge-Stueben modifiedRuge-Stueben Falgout PMIS HMIS"),
  word("pc_hypre_boomeramg_interp_type",
    "classical direct multipass multipass-wts ext+i ext+i-cc standard standard-wts block block-wtd "
    "FF FF1 ext ad-wts ext-mm ext+i-mm ext+e-mm"),
  integer("pc_hypre_boomeramg_max_coarse_size", 1, 10000),
  integer("pc_hypre_boomeramg_min_coarse_size", 0, 10000),
  integer("pc_hypre_boomeramg_nodal_coarsen", 0, 6),
  integer("pc_hypre_boomeramg_vec_interp_variant", 0, 3),
  integer("pc_hypre_euclid_level", 0, 20),
  real("pc_hypre_euclid_droptolerance", 0, 1),
  flag("pc_hypre_euclid_bj"),
  integer("pc_hypre_parasails_nlevels", 0, 10),
  real("pc_hypre_parasails_thresh", 0, 1),
  real("pc_hypre_parasails_filter", 0, 1),
  word("pc_hypre_parasails_sym", "nonsymmetric SPD nonsymmetric,SPD"),
  integer("pc_hypre_pilut_maxiter", 1, 10000),
  real("pc_hypre_pilut_tol", 0, 1),
  integer("pc_hypre_pilut_factorrowsize", 1, 10000),

  // the direct solver MUMPS: ordering, pivots, refinement, and memory, but not output and files
  integer("mat_mumps_icntl_6", 0, 7),
  integer("mat_mumps_icntl_7", 0, 7),
  integer("mat_mumps_icntl_8", -2, 77),
  integer("mat_mumps_icntl_10", -10, 10),
  integer("mat_mumps_icntl_12", 0, 3),
  integer("mat_mumps_icntl_13", 0, 1),
  integer("mat_mumps_icntl_14", 0, 10000),
  integer("mat_mumps_icntl_24", 0, 1),
  integer("mat_mumps_icntl_35", 0, 3),
  real("mat_mumps_cntl_1", 0, 1),
  real("mat_mumps_cntl_3", -1, 1),
  real("mat_mumps_cntl_7", 0, 1),

  // eigensolvers of Condition Estimator
  real("eps_tol", 0, 1),
  integer("eps_max_it", 1, LargestInteger),
  integer("eps_ncv", 2, Basis),
  integer("eps_mpd", 1, Basis),
  integer("eps_lobpcg_blocksize", 1, Sweeps),
  real("eps_lobpcg_restart", 0.1, 1),
  real("eps_krylovschur_restart", 0.1, 0.9),
};

// Prefixes of the options of inner solvers: smoothers and the coarse solver of multigrid; solvers
// of blocks, fields, subdomains, and redundant copies; the solver of a spectral transformation.
constexpr const char* prefixes[] = { "mg_levels_", "mg_coarse_", "sub_", "fieldsplit_",
  "redundant_", "telescope_", "ksp_", "st_", "esteig_", "gamg_est_", "pc_gamg_esteig_" };

std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::vector<std::string> split(const std::string& text, char separator)
{
  std::vector<std::string> parts;
  std::istringstream stream(text);
  std::string part;
  while (std::getline(stream, part, separator))
  {
    parts.push_back(part);
  }
  return parts;
}

const Rule* ruleOf(const std::string& name)
{
  for (const Rule& rule : rules)
  {
    if (lower(rule.name) == name)
    {
      return &rule;
    }
  }
  return nullptr;
}

/// The rest of a name after a prefix, including the level number as in "mg_levels_2_"; or "".
std::string without(const std::string& prefix, const std::string& name)
{
  if (name.rfind(prefix, 0) != 0)
  {
    return "";
  }
  std::size_t begin = prefix.size();
  const std::size_t digits = name.find_first_not_of("0123456789", begin);
  if (digits != std::string::npos && digits > begin && name[digits] == '_')
  {
    begin = digits + 1;
  }
  return name.substr(begin);
}

/// The rule of an option in lower case, without the hyphen; null if it is not permitted.
const Rule* find(const std::string& name, int& depth)
{
  constexpr int deepest = 4; // nesting depth of solvers
  if (const Rule* rule = ruleOf(name))
  {
    return rule;
  }
  for (const char* prefix : prefixes)
  {
    const std::string rest = without(prefix, name);
    if (!rest.empty() && depth < deepest)
    {
      ++depth;
      if (const Rule* rule = find(rest, depth))
      {
        return rule;
      }
      --depth;
    }
  }
  return nullptr;
}

//------------------------------------------------------------------------------
/// The number of characters to insert, delete, or replace (Levenshtein).
std::size_t distance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
  {
    row[j] = j;
  }
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = std::exchange(row[j + 1], std::min({ row[j + 1] + 1, row[j] + 1, replaced }));
    }
  }
  return row[b.size()];
}

std::string listed(const std::vector<std::string>& names, const std::string& before = "")
{
  std::string text;
  for (const std::string& name : names)
  {
    text += (text.empty() ? "" : ", ") + before + name;
  }
  return text;
}

/// The permitted names most similar to one that is not permitted; if none is similar, the names of
/// its family.
std::string alternatives(const std::string& name)
{
  constexpr std::size_t near = 3;
  std::size_t nearest = near;
  std::vector<std::string> similar, family;
  const std::string begin = name.substr(0, name.find('_', name.find('_') + 1));
  for (const std::string& known : permittedPetscOptions())
  {
    const std::size_t far = distance(lower(known), name);
    if (far < nearest)
    {
      similar.clear();
      nearest = far;
    }
    if (far == nearest)
    {
      similar.push_back(known);
    }
    if (name.find('_') != std::string::npos && lower(known).rfind(begin, 0) == 0)
    {
      family.push_back(known);
    }
  }
  return !similar.empty() ? " Did you mean " + listed(similar, "-") + "?"
    : !family.empty()     ? " Permitted options: " + listed(family, "-") + "."
                          : "";
}

[[noreturn]] void refuse(const std::string& option)
{
  throw Error("The PETSc option " + option +
    " is not permitted. Permitted options choose and tune Krylov methods (-ksp_...), "
    "preconditioners (-pc_..., of multigrid -mg_levels_... and -mg_coarse_..., of blocks "
    "-sub_..., of the components of a displacement -fieldsplit_0_...), MUMPS (-mat_mumps_...) "
    "and eigensolvers (-eps_..., -st_...), and do not read, write, or display anything." +
    alternatives(lower(option.substr(1))));
}

//------------------------------------------------------------------------------
std::string range(const Rule& rule)
{
  std::ostringstream text;
  text.precision(10);
  text << (rule.low > -Infinite ? "at least " : "") << (rule.low > -Infinite ? rule.low : 0.0);
  std::string low = rule.low > -Infinite ? text.str() : "";
  text.str("");
  text << rule.high;
  const std::string high = rule.high < Infinite ? "at most " + text.str() : "";
  return low + (low.empty() || high.empty() ? "" : " and ") + high;
}

bool isNumber(const std::string& text, bool whole, double& number)
{
  // strtod() would also take hexadecimal numbers, infinities and NaN.
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos ||
    (whole && text.find_first_of(".eE") != std::string::npos))
  {
    return false;
  }
  char* end = nullptr;
  number = std::strtod(text.c_str(), &end);
  return *end == '\0' && std::isfinite(number);
}

/// The reason why a value is not permitted, or "".
std::string complaint(const Rule& rule, const std::string& value)
{
  const auto inRange = [&](double number) { return number >= rule.low && number <= rule.high; };
  double number = 0.0;
  switch (rule.kind)
  {
    case Kind::Flag:
    {
      const std::vector<std::string> words = { "", "true", "false", "yes", "no", "on", "off", "1",
        "0" };
      return std::count(words.begin(), words.end(), lower(value)) ? "" : "true or false";
    }
    case Kind::Integer:
      return isNumber(value, true, number) && inRange(number) ? ""
                                                              : "a whole number, " + range(rule);
    case Kind::Real:
      return isNumber(value, false, number) && inRange(number) ? "" : "a number, " + range(rule);
    case Kind::Reals:
      for (const std::string& part : split(value, ','))
      {
        if (!isNumber(part, false, number) || !inRange(number))
        {
          return "numbers separated by commas, each " + range(rule);
        }
      }
      return value.empty() ? "numbers separated by commas" : "";
    case Kind::Word:
      break;
  }
  const std::vector<std::string> words = split(rule.words, ' ');
  const bool known = std::any_of(words.begin(), words.end(),
    [&](const std::string& each) { return lower(each) == lower(value); });
  return known ? "" : "one of " + listed(words);
}

bool isName(const std::string& text)
{
  return text.size() > 1 && text[0] == '-' &&
    (text[1] == '-' || std::isalpha(static_cast<unsigned char>(text[1])));
}
}

//------------------------------------------------------------------------------
std::vector<PetscOption> parsePetscOptions(const std::string& text)
{
  std::vector<PetscOption> options;
  std::istringstream stream(text);
  std::string word;
  bool named = false; // whether the last word was a name
  while (stream >> word)
  {
    if (isName(word))
    {
      options.push_back({ word, "" });
    }
    else if (named)
    {
      options.back().value = word;
    }
    else
    {
      throw Error("PETSc options \"" + text + "\": \"" + word +
        "\" is not the name of an option; write -name value -name value ...");
    }
    named = isName(word);
  }
  for (const PetscOption& option : options)
  {
    int depth = 0;
    const Rule* rule = find(lower(option.name.substr(1)), depth);
    if (!rule)
    {
      refuse(option.name);
    }
    Rule inner = *rule;
    if (depth > 0 && std::string(rule->name) == "ksp_max_it")
    {
      // the time limit is checked between iterations of the outer solver
      inner.high = InnerIterations;
    }
    // Chebyshev's method requires positive eigenvalues, which is satisfied for smoothers; as the
    // solver of an indefinite system, it crashes.
    const bool smoother =
      depth > 0 && std::string(rule->name) == "ksp_type" && lower(option.value) == "chebyshev";
    const std::string possible = smoother ? "" : complaint(inner, option.value);
    if (!possible.empty())
    {
      throw Error("The PETSc option " + option.name +
        (option.value.empty() ? " has no value" : " cannot be \"" + option.value + "\"") +
        "; permitted: " + possible + ".");
    }
  }
  return options;
}

//------------------------------------------------------------------------------
std::vector<std::string> permittedPetscOptions()
{
  std::vector<std::string> names;
  for (const Rule& rule : rules)
  {
    names.push_back(rule.name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> permittedPetscValues(const std::string& name)
{
  const Rule* rule = ruleOf(lower(name));
  return rule && rule->kind == Kind::Word ? split(rule->words, ' ') : std::vector<std::string>();
}
}
