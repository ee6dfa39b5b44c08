// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PetscObjects.h
 * @brief PETSc's matrix of a linear system, how this rank's unknowns map to it, and options.
 * Internal: not installed.
 *
 * Whoever uses these objects holds a PetscScope of their database.
 */
#ifndef tautline_PetscObjects_h
#define tautline_PetscObjects_h

#include "LinearSystem.h"
#include "PetscSession.h"

namespace tautline
{
/// A matrix in PETSc's format, and this rank's view of its vectors.
class PetscSystem
{
public:
  /**
   * @brief Throws Error as LinearSolver's constructor does; within a PetscScope.
   * @param copy on one rank: whether PETSc gets entries of its own, because it is going to change
   * them
   */
  explicit PetscSystem(const LinearSystem& system, bool copy = false);

  MPI_Comm communicator() const { return this->Comm; }
  int ranks() const { return this->Ranks; }
  Mat matrix() const { return this->Matrix; }
  /// Unknowns of this rank, shared ones too.
  Index localSize() const { return this->System.matrix->size; }
  /// Whether a condition holds on some rank.
  bool anywhere(bool condition) const;

  /// A vector of rows, and back: contributions are added up, values come from and go to all who
  /// share them.
  PetscVector createVector() const;
  void add(const double* contributions, Vec rows) const;
  void copyIn(const double* values, Vec rows) const;
  void copyOut(Vec rows, double* values) const;

private:
  std::string complaint() const;
  void borrowMatrix(bool copy);
  void distributeMatrix();
  void insertRows(const std::vector<PetscInt>& rowOf);
  void attachRigidBodyModes();

  LinearSystem System;
  MPI_Comm Comm = MPI_COMM_SELF;
  int Ranks = 1;
  std::vector<Index> Points; // of several ranks: this rank's points with a row, in increasing order
  std::vector<PetscInt> Offsets, Columns; // what PETSc cannot borrow
  PetscMatrix Matrix;
};

/// The options of one solver: a database of its own, and which of them a user gave.
class PetscOptionSet
{
public:
  /// Throws Error for text that is not a list of permitted options (PetscOptionRules.h).
  explicit PetscOptionSet(const std::string& text);
  PetscOptions database() const { return this->Database; }
  bool has(const std::string& name) const;
  /// Whether some option makes PETSc change the matrix it is given.
  bool changesMatrix() const;
  /// Sets one of Tautline's options, unless the user gave it.
  void setDefault(const std::string& name, const std::string& value);
  /**
   * @brief Throws Error that names the options nothing has read. Before the set-up those that only
   * an inner solver or a viewer reads are not yet missed.
   */
  void rejectUnused(bool afterSetUp) const;
  /// explainPetsc(); if the user gave options, with these and the error as it is.
  std::string explain(const PetscError& error, const std::string& subject) const;
  /// Runs a call that reads options; an error then quotes their text.
  template <class Call>
  void read(const Call& call) const
  {
    try
    {
      call();
    }
    catch (const PetscError& error)
    {
      this->rethrow(error);
    }
  }

private:
  [[noreturn]] void rethrow(const PetscError& error) const;

  std::string Text;
  PetscDatabase Database;
  std::vector<std::string> Given;
};

/**
 * @brief Makes a preconditioner a direct solver for a system; the name of the package.
 * @param prefix of the preconditioner's options, "" or "st_"
 */
std::string chooseFactorization(PC preconditioner, const LinearSystem& system, int ranks,
  PetscOptionSet& options, const std::string& prefix = "");
}
#endif
