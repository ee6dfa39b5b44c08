// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticOutput.h
 * @brief Writes solutions, stresses and tables of linear systems as VTK arrays.
 */
#ifndef tautline_EllipticOutput_h
#define tautline_EllipticOutput_h

#include "tautline/Elliptic/EllipticSystem.h"

#include <string>

class vtkDataSet;

namespace tautline
{
class TableRows;

/**
 * @brief Adds an array to the points or cells and makes it active. Values that are not finite, as
 * at points outside all elements, become 0.
 * @return the number of such tuples
 */
Index addArray(vtkDataSet* output, bool ofCells, const std::string& name,
  const std::vector<double>& values, int components);

/// Adds the stress and its von Mises equivalent to the cells.
void addStress(vtkDataSet* output, const std::vector<double>& stresses);

/// "converged to ..." as a sentence: "Converged to ....".
std::string sentence(std::string text);

/**
 * @brief Adds a row per iteration: `Block` (if there is one), `Log10 residual` (relative to the
 * first; 1e-16 of it at least), `N residual`, the norm.
 */
void addResiduals(TableRows& rows, const std::vector<double>& residuals, const std::string& block);
}
#endif
