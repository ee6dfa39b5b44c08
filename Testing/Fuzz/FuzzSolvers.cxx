// SPDX-License-Identifier: BSD-3-Clause
// Option strings for PETSc: what is permitted neither names a file nor displays anything, a solver
// rejects the rest before PETSc sees it, and whatever it takes ends with a checked solution or an
// error.

#include "FuzzTargets.h"
#include "Solvers/PetscOptionRules.h"
#include "Systems.h"

#include "tautline/Solvers/LinearSolver.h"

#include <cctype>
#include <cmath>
#include <filesystem>

namespace tautline
{
namespace
{
namespace fs = std::filesystem;
constexpr int MaxOptions = 6; // of one string
constexpr int MaxIterations = 30;
constexpr double MaxSeconds = 5.0;

std::string lowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// An empty directory that is the working directory meanwhile: where PETSc would write files
/// without a path.
class EmptyDirectory
{
public:
  EmptyDirectory()
    : Before(fs::current_path())
    , Own(fs::absolute(fuzzFolder()) / "petsc-options")
  {
    fs::create_directories(this->Own);
    fs::current_path(this->Own);
  }
  ~EmptyDirectory() { fs::current_path(this->Before); }
  bool empty() const { return fs::is_empty(this->Own); }

private:
  fs::path Before, Own;
};

/// Options from bytes: names in the table with and without prefixes, and names that must not pass.
std::string optionsFrom(ByteReader& input)
{
  const std::vector<std::string> names = permittedPetscOptions();
  const char* const prefixes[] = { "", "", "", "mg_levels_", "mg_coarse_", "sub_", "mg_levels_1_",
    "ksp_", "st_", "redundant_", "telescope_", "mg_levels_esteig_", "fieldsplit_0_", "SUB_" };
  const char* const others[] = { "options_file", "ksp_view", "pc_view", "mat_view", "ksp_monitor",
    "log_view", "info", "history", "dll_append", "pc_python_type", "malloc_dump", "prefix_push",
    "mat_mumps_icntl_1", "mat_mumps_ooc_tmpdir", "on_error_abort", "options_left", "KSP_VIEW" };
  const char* const values[] = { "", "1", "0", "-1", "2.5", "1e-8", "1e300", "nan", "true", "0.5,2",
    "ascii:written.txt", "binary:written.bin", "ascii:written.txt::append", "./lib.so:create",
    "/etc/passwd", "python", "shell", "mg", "fieldsplit", "99999999999" };
  std::string text;
  for (int i = 0; i < MaxOptions && !input.atEnd(); ++i)
  {
    const int kind = input.choice(8);
    const std::string& name = names[input.next<std::uint16_t>() % names.size()];
    const std::vector<std::string> words = permittedPetscValues(name);
    text += std::string(" -") + prefixes[input.choice(std::size(prefixes))];
    text += kind == 0 ? others[input.choice(std::size(others))] : name;
    const int value = input.choice(256);
    const bool known = kind > 1 && !words.empty();
    text += " " +
      (known ? words[static_cast<std::size_t>(value) % words.size()]
             : std::string(values[static_cast<std::size_t>(value) % std::size(values)]));
  }
  return text;
}

/// Whether the end of a name, behind prefixes, is in the table.
bool isPermitted(const std::string& name, std::string& inTable)
{
  const std::string lower = lowerCase(name);
  for (const std::string& permitted : permittedPetscOptions())
  {
    const std::string end = lowerCase(permitted);
    if (lower.size() > end.size() && lower.compare(lower.size() - end.size(), end.size(), end) == 0)
    {
      inTable = permitted;
      return true;
    }
  }
  return false;
}

void checkAccepted(const PetscOption& option)
{
  std::string inTable;
  expectThat(isPermitted(option.name, inTable), "an accepted option is in the table");
  for (const char* part : { "view", "monitor", "file", "python", "shell", "dll", "log_", "history",
         "malloc", "debugger", "trace", "dump", "tmpdir", "load" })
  {
    expectThat(lowerCase(option.name).find(part) == std::string::npos,
      "an accepted option displays, reads and loads nothing");
  }
  for (const std::string& word : permittedPetscValues(inTable))
  {
    if (lowerCase(word) == lowerCase(option.value))
    {
      return;
    }
  }
  expectThat(option.value.find_first_of("/:\\$") == std::string::npos,
    "an accepted value names no file and no function");
}
}

//------------------------------------------------------------------------------
void fuzzPetscOptions(std::string_view bytes)
{
  // The first byte decides: the text itself, or options made from the bytes.
  ByteReader input(bytes);
  const bool literal = input.choice(4) == 0;
  const std::string text = literal
    ? std::string(bytes.substr(std::min<std::size_t>(1, bytes.size())))
    : optionsFrom(input);
  bool accepted = true;
  try
  {
    for (const PetscOption& option : parsePetscOptions(text))
    {
      checkAccepted(option);
    }
  }
  catch (const Error&)
  {
    accepted = false;
  }

  const EmptyDirectory directory;
  const SparseMatrix a = laplacian(4);
  const std::vector<double> b = someVector(a.size);
  std::vector<double> x(b.size(), 0.0);
  LinearSystem system;
  system.matrix = &a;
  SolverOptions options;
  options.preconditioner = Preconditioner::Jacobi;
  options.maximumIterations = MaxIterations;
  options.maximumSeconds = MaxSeconds;
  options.petscOptions = text;
  bool solved = false;
  LinearSolution solution;
  try
  {
    LinearSolver solver(system, options);
    solution = solver.solve(b.data(), x.data());
    solved = true;
  }
  catch (const Error&)
  {
    // rejected by name
  }
  expectThat(accepted || !solved, "a rejected option does not reach a solver");
  expectThat(directory.empty(), "no file is written");
  if (solved)
  {
    expectThat(std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); }),
      "the solution is finite");
    const double residual = relativeResidual(a, x, b);
    expectThat(std::abs(solution.trueResidual - residual) <= 1e-10 + 1e-6 * residual,
      "the residual belongs to the solution");
    expectThat(!converged(solution.reason) || residual <= 1.0, "a solution is better than none");
  }
}
}
