// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ValidateInput.h
 * @brief Checks what VTK hands over before any filter or writer touches it.
 *
 * VTK does not verify data objects: arrays may be shorter than the mesh, cells may list points that
 * do not exist. Reading such data ends in wrong results or in a crash. The check is linear in the
 * size of the input, threaded, and reads each array of ids, offsets and types once (values of point
 * and cell arrays are not read).
 *
 * Checked are, for each data set:
 * - point and cell arrays: one tuple per point or cell; ghost arrays of the type VTK reads;
 * - cell arrays: offsets that ascend from 0 to the length of the connectivity, ids of existing
 *   points, one cell type per cell, numbers of points that fit the type;
 * - polyhedra: streams of faces that end where the array ends, ids of existing points;
 * - structured data: as many points as the dimensions say, finite spacing, origin and coordinates;
 * - where requested, finite points.
 */
#ifndef tautline_ValidateInput_h
#define tautline_ValidateInput_h

#include "TautlineCoreModule.h" // for export macro

#include <string>

class vtkAlgorithm;
class vtkDataObject;
class vtkSelection;

namespace tautline
{
/// What an input has to fulfil besides being consistent.
struct InputRules
{
  bool finitePoints = false; ///< NaN and infinite coordinates are refused
  int threads = 0;           ///< 0: one per core
};

/**
 * @brief The first defect of a data set, or of the data sets of composite data ("In block 3: ..."),
 * with the remedy; "" if there is none. Null is no defect, nor are leaves that are not data sets.
 */
TAUTLINECORE_EXPORT std::string inputProblem(vtkDataObject* data, const InputRules& rules = {});

/// Throws Error with inputProblem().
TAUTLINECORE_EXPORT void validateInput(vtkDataObject* data, const InputRules& rules = {});

/**
 * @brief A sentence, with the remedy, on data without points or cells; "" for others, for what is
 * no data set, and on all processes of a parallel server but the first, which may have no part.
 * @param needed "cells" or "points"
 */
TAUTLINECORE_EXPORT std::string emptyInput(vtkDataObject* data, const char* needed = "cells");

/// Reports emptyInput() as a warning of a filter, unless it is "".
TAUTLINECORE_EXPORT void warnOfEmptyInput(
  vtkAlgorithm* filter, vtkDataObject* data, const char* needed);

/// For filters that VTK executes once per block of composite data: a sentence on a block that is
/// not what they need ("mesh") and is left out.
TAUTLINECORE_EXPORT std::string leftOut(vtkDataObject* block, const char* needed);

/// Which leaves of composite data are not meshes and are left out, as a sentence, or "".
TAUTLINECORE_EXPORT std::string skippedLeaves(vtkDataObject* data);

/// What is wrong with a selection: ids that are not in the mesh, or a list that is not of ids.
TAUTLINECORE_EXPORT std::string selectionProblem(vtkSelection* selection, vtkDataObject* mesh);
}
#endif
