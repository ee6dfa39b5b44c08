// SPDX-License-Identifier: BSD-3-Clause
#include "PetscObjects.h"

#include "PetscOptionRules.h"

#include <algorithm>
#include <cctype>

#include "tautline/Ranks/PointNumbering.h"
#include "tautline/Ranks/RankExchange.h"

namespace tautline
{
namespace
{
constexpr Index None = -1;

/// The first invalid row: it has an entry that is not finite, or columns out of order or range.
Index firstBadRow(const SparseMatrix& matrix)
{
  for (Index row = 0; row < matrix.size; ++row)
  {
    std::int64_t previous = -1;
    for (Index k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
    {
      const bool good = matrix.columns[k] > previous && std::isfinite(matrix.values[k]);
      previous = matrix.columns[k];
      if (!good || previous >= matrix.size)
      {
        return row;
      }
    }
  }
  return None;
}

/// Options that are read only when an inner solver is set up.
bool readLater(const std::string& name, bool afterSetUp)
{
  for (const char* prefix : { "-sub_", "-mg_", "-mat_", "-redundant_", "-telescope_",
         "-fieldsplit_", "-gamg_est_", "-pc_gamg_esteig_", "-esteig_" })
  {
    if (!afterSetUp && name.rfind(prefix, 0) == 0)
    {
      return true;
    }
  }
  return false;
}
}

//------------------------------------------------------------------------------
PetscOptionSet::PetscOptionSet(const std::string& text)
  : Text(text)
{
  const std::vector<PetscOption> options = parsePetscOptions(text);
  petsc(PetscOptionsCreate(this->Database.out()));
  // One by one: PETSc would act on some names in a combined string.
  for (const PetscOption& option : options)
  {
    this->Given.push_back(option.name);
    this->read(
      [&]()
      {
        petsc(PetscOptionsSetValue(this->Database, option.name.c_str(),
          option.value.empty() ? nullptr : option.value.c_str()));
      });
  }
}

bool PetscOptionSet::has(const std::string& name) const
{
  PetscBool found = PETSC_FALSE;
  petsc(PetscOptionsHasName(this->Database, nullptr, name.c_str(), &found));
  return found;
}

bool PetscOptionSet::changesMatrix() const
{
  std::string lower = this->Text; // PETSc's names are not case-sensitive
  std::transform(lower.begin(), lower.end(), lower.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower.find("diagonal_scale") != std::string::npos ||
    lower.find("in_place") != std::string::npos;
}

void PetscOptionSet::setDefault(const std::string& name, const std::string& value)
{
  if (!this->has(name))
  {
    petsc(PetscOptionsSetValue(this->Database, name.c_str(), value.c_str()));
  }
}

void PetscOptionSet::rejectUnused(bool afterSetUp) const
{
  std::string unused;
  for (const std::string& name : this->Given)
  {
    PetscBool used = PETSC_FALSE;
    petsc(PetscOptionsUsed(this->Database, name.c_str() + 1, &used));
    if (!used && !readLater(name, afterSetUp))
    {
      unused += (unused.empty() ? "" : ", ") + name;
    }
  }
  if (!unused.empty())
  {
    throw Error("PETSc options \"" + this->Text + "\": unknown or without effect: " + unused +
      ". Check the spelling and whether the corresponding method or preconditioner is selected.");
  }
}

std::string PetscOptionSet::explain(const PetscError& error, const std::string& subject) const
{
  const std::string text = explainPetsc(error, subject);
  return this->Text.empty() || error.code() == OwnError
    ? text
    : text + " PETSc options \"" + this->Text + "\": " + error.what();
}

void PetscOptionSet::rethrow(const PetscError& error) const
{
  if (this->Text.empty())
  {
    throw error;
  }
  throw Error("PETSc options \"" + this->Text + "\": " + error.what());
}

//------------------------------------------------------------------------------
std::string chooseFactorization(PC preconditioner, const LinearSystem& system, int ranks,
  PetscOptionSet& options, const std::string& prefix)
{
  const MatFactorType kind = system.symmetric ? MAT_FACTOR_CHOLESKY : MAT_FACTOR_LU;
  const char* type = ranks > 1 ? MATMPIAIJ : MATSEQAIJ;
  petsc(PCSetType(preconditioner, system.symmetric ? PCCHOLESKY : PCLU));
  // CHOLMOD is the fastest but requires positive pivots; MUMPS supports any matrix and any number
  // of ranks.
  for (const char* package :
    { MATSOLVERCHOLMOD, MATSOLVERMUMPS, MATSOLVERSUPERLU_DIST, MATSOLVERPETSC })
  {
    const bool fits =
      package != std::string(MATSOLVERCHOLMOD) || (system.positiveDefinite && ranks == 1);
    PetscBool there = PETSC_FALSE, takesType = PETSC_FALSE;
    petsc(MatSolverTypeGet(package, type, kind, &there, &takesType, nullptr));
    if (fits && there && takesType)
    {
      petsc(PCFactorSetMatSolverType(preconditioner, package));
      // Its warnings go to the console; an indefinite matrix is reported as an error anyway.
      options.setDefault("-" + prefix + "mat_cholmod_print", "0");
      return package;
    }
  }
  throw Error(
    "This PETSc has no direct solver for a matrix on several ranks: use an iterative method.");
}

//------------------------------------------------------------------------------
PetscSystem::PetscSystem(const LinearSystem& system, bool copy)
  : System(system)
{
  if (system.numbering && system.numbering->ranks() > 1)
  {
    this->Comm = mpiOf(system.numbering->communicator());
    this->Ranks = system.numbering->ranks();
    const std::vector<Index>& rows = system.numbering->rows();
    for (std::size_t point = 0; point < rows.size(); ++point)
    {
      if (rows[point] >= 0)
      {
        this->Points.push_back(static_cast<Index>(point));
      }
    }
  }
  throwTogether(this->Comm, this->complaint());
  if (this->Ranks > 1)
  {
    this->distributeMatrix();
  }
  else
  {
    this->borrowMatrix(copy);
  }
  petsc(MatSetOption(this->Matrix, MAT_SYMMETRIC, system.symmetric ? PETSC_TRUE : PETSC_FALSE));
  petsc(MatSetOption(
    this->Matrix, MAT_SPD, system.symmetric && system.positiveDefinite ? PETSC_TRUE : PETSC_FALSE));
  if (!this->anywhere(!system.coordinates && this->localSize() > 0) &&
    (system.blockSize == 2 || system.blockSize == 3))
  {
    this->attachRigidBodyModes();
  }
}

bool PetscSystem::anywhere(bool condition) const
{
  return this->Ranks > 1 ? onAnyRank(this->Comm, condition) : condition;
}

/// A description of the error in the system, or "".
std::string PetscSystem::complaint() const
{
  const SparseMatrix* matrix = this->System.matrix;
  const Index unknowns = this->Ranks > 1 ? this->System.numbering->globalSize()
    : matrix                             ? matrix->size
                                         : 0;
  if (!matrix || unknowns == 0)
  {
    return "The linear system has no unknowns: there is nothing to solve for.";
  }
  const int block = this->System.blockSize;
  if (block < 1 || matrix->size % block != 0)
  {
    return "The linear system has " + std::to_string(matrix->size) +
      " unknowns, which is not a multiple of its block size " + std::to_string(block) + ".";
  }
  const auto points = static_cast<Index>(this->Points.size());
  if (this->Ranks > 1 && matrix->size != block * points)
  {
    return "The linear system has " + std::to_string(matrix->size) + " unknowns, but " +
      std::to_string(points) + " points of this MPI rank are numbered.";
  }
  const auto entries = static_cast<std::size_t>(matrix->nonzeros());
  if (matrix->offsets.size() != static_cast<std::size_t>(matrix->size) + 1 ||
    matrix->offsets.back() != matrix->nonzeros() || matrix->values.size() != entries)
  {
    return "The matrix of the linear system is incomplete: its offsets, columns and values "
           "differ in size.";
  }
  const Index limit = std::numeric_limits<PetscInt>::max();
  if (matrix->nonzeros() > limit || unknowns > limit / block)
  {
    return "The linear system is larger than this PETSc can number: use a smaller mesh, more MPI "
           "ranks, or a PETSc with "
           "64-bit indices.";
  }
  const Index bad = firstBadRow(*matrix);
  return bad == None ? ""
                     : "Row " + std::to_string(bad) +
      " of the matrix has an entry that is not finite, or columns that are not in increasing "
      "order.";
}

void PetscSystem::borrowMatrix(bool copy)
{
  const SparseMatrix& source = *this->System.matrix;
  const auto size = static_cast<PetscInt>(source.size);
  this->Offsets.assign(source.offsets.begin(), source.offsets.end());
  // PETSc only reads the arrays lent to it here; with 64-bit integers, it cannot use the columns
  // directly.
  auto* columns = reinterpret_cast<PetscInt*>(const_cast<std::int32_t*>(source.columns.data()));
  if (sizeof(PetscInt) != sizeof(std::int32_t))
  {
    this->Columns.assign(source.columns.begin(), source.columns.end());
    columns = this->Columns.data();
  }
  petsc(MatCreateSeqAIJWithArrays(this->Comm, size, size, this->Offsets.data(), columns,
    const_cast<double*>(source.values.data()), this->Matrix.out()));
  // Options that change the matrix in place must not modify the values of the caller.
  if (copy)
  {
    PetscMatrix own;
    petsc(MatDuplicate(this->Matrix, MAT_COPY_VALUES, own.out()));
    this->Matrix = std::move(own);
  }
  petsc(MatSetBlockSize(this->Matrix, this->System.blockSize));
}

void PetscSystem::distributeMatrix()
{
  const SparseMatrix& source = *this->System.matrix;
  const PointNumbering& numbering = *this->System.numbering;
  const int block = this->System.blockSize;
  std::vector<PetscInt> rowOf(static_cast<std::size_t>(source.size));
  for (std::size_t i = 0; i < rowOf.size(); ++i)
  {
    rowOf[i] = static_cast<PetscInt>(block * numbering.rows()[this->Points[i / block]] + i % block);
  }
  const auto owned = static_cast<PetscInt>(block * numbering.ownedRows());
  const auto all = static_cast<PetscInt>(block * numbering.globalSize());
  petsc(MatCreate(this->Comm, this->Matrix.out()));
  petsc(MatSetSizes(this->Matrix, owned, owned, all, all));
  petsc(MatSetType(this->Matrix, MATMPIAIJ));
  petsc(MatSetBlockSize(this->Matrix, block));
  if (this->System.wholeRows)
  {
    this->insertRows(rowOf);
    return;
  }
  // Every rank contributes the entries of its cells, also to rows of other ranks; PETSc sums them.
  std::vector<PetscInt> rows(source.columns.size()), columns(source.columns.size());
  for (Index row = 0; row < source.size; ++row)
  {
    for (Index k = source.offsets[row]; k < source.offsets[row + 1]; ++k)
    {
      rows[k] = rowOf[row];
      columns[k] = rowOf[source.columns[k]];
    }
  }
  petsc(MatSetPreallocationCOO(
    this->Matrix, static_cast<PetscCount>(rows.size()), rows.data(), columns.data()));
  petsc(MatSetValuesCOO(this->Matrix, source.values.data(), ADD_VALUES));
}

/// Rows that are complete on one rank do not need the arrays, twice as large as the matrix, that
/// PETSc uses to sum contributions.
void PetscSystem::insertRows(const std::vector<PetscInt>& rowOf)
{
  const SparseMatrix& source = *this->System.matrix;
  const PointNumbering& numbering = *this->System.numbering;
  const int block = this->System.blockSize;
  const auto owned = static_cast<PetscInt>(block * numbering.ownedRows());
  const auto all = static_cast<PetscInt>(block * numbering.globalSize());
  const auto first = static_cast<PetscInt>(block * numbering.firstRow());
  // The numbers of entries of each row in columns of its owner and of others; for a row sent to
  // another rank, the same number in both.
  const std::size_t points = numbering.rows().size();
  std::vector<double> counts(2 * static_cast<std::size_t>(block) * points, 0.0);
  const auto countsOf = [&](Index row)
  { return counts.data() + 2 * (block * this->Points[row / block] + row % block); };
  for (Index row = 0; row < source.size; ++row)
  {
    const bool here = numbering.owned(this->Points[row / block]);
    for (Index k = source.offsets[row]; k < source.offsets[row + 1]; ++k)
    {
      const PetscInt column = rowOf[source.columns[k]];
      const bool inside = column >= first && column < first + owned;
      countsOf(row)[0] += !here || inside;
      countsOf(row)[1] += !here || !inside;
    }
  }
  numbering.sum(counts.data(), 2 * block);
  std::vector<PetscInt> own(static_cast<std::size_t>(owned), 0), other = own;
  for (Index row = 0; row < source.size; ++row)
  {
    if (numbering.owned(this->Points[row / block]))
    {
      // The counts from several ranks may include an entry more than once, but not exceed the
      // number of columns.
      const auto at = static_cast<std::size_t>(rowOf[row] - first);
      own[at] = std::min(owned, static_cast<PetscInt>(countsOf(row)[0]));
      other[at] = std::min(all - owned, static_cast<PetscInt>(countsOf(row)[1]));
    }
  }
  petsc(MatMPIAIJSetPreallocation(this->Matrix, 0, own.data(), 0, other.data()));
  std::vector<PetscInt> columns;
  for (Index row = 0; row < source.size; ++row)
  {
    const Index begin = source.offsets[row], end = source.offsets[row + 1];
    columns.clear();
    for (Index k = begin; k < end; ++k)
    {
      columns.push_back(rowOf[source.columns[k]]);
    }
    if (!columns.empty())
    {
      petsc(MatSetValues(this->Matrix, 1, &rowOf[row], static_cast<PetscInt>(columns.size()),
        columns.data(), source.values.data() + begin, INSERT_VALUES));
    }
  }
  petsc(MatAssemblyBegin(this->Matrix, MAT_FINAL_ASSEMBLY));
  petsc(MatAssemblyEnd(this->Matrix, MAT_FINAL_ASSEMBLY));
}

void PetscSystem::attachRigidBodyModes()
{
  const int dimension = this->System.blockSize;
  // Smoothed aggregation builds its coarse spaces from the rigid body modes.
  PetscVector coordinates = this->createVector();
  petsc(VecSetBlockSize(coordinates, dimension));
  std::vector<double> values(static_cast<std::size_t>(this->localSize()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = this->System.coordinates[3 * (i / dimension) + i % dimension];
  }
  this->copyIn(values.data(), coordinates);
  PetscNullSpace modes;
  petsc(MatNullSpaceCreateRigidBody(coordinates, modes.out()));
  petsc(MatSetNearNullSpace(this->Matrix, modes));
}

//------------------------------------------------------------------------------
PetscVector PetscSystem::createVector() const
{
  PetscVector vector;
  petsc(MatCreateVecs(this->Matrix, vector.out(), nullptr));
  return vector;
}

void PetscSystem::add(const double* contributions, Vec rows) const
{
  if (this->Ranks == 1)
  {
    this->copyIn(contributions, rows);
    return;
  }
  const PointNumbering& numbering = *this->System.numbering;
  const auto block = static_cast<std::size_t>(this->System.blockSize);
  // By point, summed over the ranks, then by row again.
  std::vector<double> all(block * numbering.rows().size(), 0.0);
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    std::copy_n(contributions + block * i, block, &all[block * this->Points[i]]);
  }
  numbering.sum(all.data(), this->System.blockSize);
  std::vector<double> sums(block * this->Points.size());
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    std::copy_n(&all[block * this->Points[i]], block, &sums[block * i]);
  }
  this->copyIn(sums.data(), rows);
}

void PetscSystem::copyIn(const double* values, Vec rows) const
{
  double* target = nullptr;
  petsc(VecGetArrayWrite(rows, &target));
  if (this->Ranks == 1)
  {
    std::copy_n(values, this->localSize(), target);
  }
  // The rows owned by a rank are in the order of its points.
  const int block = this->System.blockSize;
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    if (this->System.numbering->owned(this->Points[i]))
    {
      target = std::copy_n(values + block * i, block, target);
    }
  }
  target = nullptr;
  petsc(VecRestoreArrayWrite(rows, &target));
}

void PetscSystem::copyOut(Vec rows, double* values) const
{
  const double* source = nullptr;
  petsc(VecGetArrayRead(rows, &source));
  if (this->Ranks == 1)
  {
    std::copy_n(source, this->localSize(), values);
  }
  else
  {
    // Values owned by other ranks are 0 in the sum over the ranks that have the point.
    const PointNumbering& numbering = *this->System.numbering;
    const auto block = static_cast<std::size_t>(this->System.blockSize);
    std::vector<double> all(block * numbering.rows().size(), 0.0);
    const double* next = source;
    for (const Index point : this->Points)
    {
      if (numbering.owned(point))
      {
        std::copy_n(next, block, &all[block * point]);
        next += block;
      }
    }
    numbering.sum(all.data(), this->System.blockSize);
    for (std::size_t i = 0; i < this->Points.size(); ++i)
    {
      std::copy_n(&all[block * this->Points[i]], block, values + block * i);
    }
  }
  petsc(VecRestoreArrayRead(rows, &source));
}
}
