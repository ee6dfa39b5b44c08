// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PetscObjects.h
 * @brief PETSc's matrix of a linear system, how this rank's unknowns map to it, and options.
 * Internal: not installed.
 *
 * Users of these objects must hold a PetscScope of their database.
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
   * @brief Throws Error as LinearSolver's constructor does. Must be called within a PetscScope.
   * @param copy on one rank: whether PETSc gets its own copy of the entries because it will change
   * them
   */
  explicit PetscSystem(const LinearSystem& system, bool copy = false);

  MPI_Comm communicator() const { return this->Comm; }
  int ranks() const { return this->Ranks; }
  Mat matrix() const { return this->Matrix; }
  /// Unknowns of this rank, including shared ones.
  Index localSize() const { return this->System.matrix->size; }
  /// Whether a condition holds on any rank.
  bool anywhere(bool condition) const;

  /// Conversions to a vector of rows and back: contributions are summed; values are exchanged
  /// between all ranks that share them.
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
  std::vector<Index> Points; // on several ranks: this rank's points with a row, in increasing order
  std::vector<PetscInt> Offsets, Columns; // arrays that PETSc cannot use directly
  PetscMatrix Matrix;
};

/// The options of one solver: its own database, and which of them the user specified.
class PetscOptionSet
{
public:
  /// Throws Error if the text is not a list of permitted options (PetscOptionRules.h).
  explicit PetscOptionSet(const std::string& text);
  PetscOptions database() const { return this->Database; }
  bool has(const std::string& name) const;
  /// Whether an option makes PETSc change the matrix passed to it.
  bool changesMatrix() const;
  /// Sets one of Tautline's options unless the user specified it.
  void setDefault(const std::string& name, const std::string& value);
  /**
   * @brief Throws Error with the names of options that have not been read. Before the setup,
   * options that only an inner solver or a viewer reads are not yet reported.
   */
  void rejectUnused(bool afterSetUp) const;
  /// explainPetsc(); if the user specified options, with these and the original error.
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
 * @brief Configures a preconditioner as a direct solver for a system; returns the name of the
 * package.
 * @param prefix prefix of the preconditioner's options, "" or "st_"
 */
std::string chooseFactorization(PC preconditioner, const LinearSystem& system, int ranks,
  PetscOptionSet& options, const std::string& prefix = "");
}
#endif
