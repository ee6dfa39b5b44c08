// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicOutput.h
 * @brief Writes numbers per row of a nonlocal matrix as VTK arrays, tables and pictures.
 */
#ifndef tautline_PeridynamicOutput_h
#define tautline_PeridynamicOutput_h

#include "HorizonInput.h"

#include "tautline/Solvers/Lanczos.h"

#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkImageData;
class vtkTable;

namespace tautline
{
/// A system with its mesh and basis.
struct PeridynamicResult
{
  const HorizonInput& input;
  PeridynamicBasis basis;
  const PeridynamicSystem& system;
};

/// Adds `Unknown`, `Neighbors`, `RowSum` and `Diagonal` to the points or cells of the basis.
void addRowData(const PeridynamicResult& result, vtkDataSet* output);

/**
 * @brief Adds a vector over the rows as an array: on points (continuous linear) or on cells, with a
 * component per function; for the elastic model, vectors in space.
 * @param given values of functions that are not unknown; null for 0
 */
void addRowVector(const PeridynamicResult& result, const std::vector<double>& values,
  const char* name, const std::vector<double>* given, vtkDataSet* output);

/// Adds `Dilatation` and `EnergyDensity` of the solution of an elastic model to the cells.
void addStrain(const PeridynamicResult& result, const PeridynamicOptions& options,
  const std::vector<double>& solution, const std::vector<double>* given, vtkDataSet* output);

/// Values of an array on the functions of the basis, `components` each; for vectors in space, the
/// in-plane components.
std::vector<double> onFunctions(const HorizonInput& input, PeridynamicBasis basis, Index components,
  vtkDataArray* array, bool onPoints);

/// Values of an array per point or per triangle, `components` each.
std::vector<double> onMesh(
  const HorizonInput& input, Index components, vtkDataArray* array, bool onPoints);

/// Fills one row with the data of the matrix and, if there is one, of its spectrum.
void fillSpectrum(const PeridynamicSystem& system, const Spectrum* spectrum, vtkTable* table);

/// Adds columns on the solution process; zeros if there is no solution.
void addSolveReport(const SolveReport& report, vtkTable* table);

/// Entries per pixel, rows from top to bottom (Figure 4.2); at most `pixels` each way.
void drawSparsity(const SparseMatrix& matrix, int pixels, vtkImageData* image);
}
#endif
