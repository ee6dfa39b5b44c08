// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ValidateInput.h
 * @brief Checks input from VTK before a filter or writer uses it.
 *
 * VTK does not verify data objects: arrays may be shorter than the mesh, cells may list points that
 * do not exist. Reading such data leads to wrong results or a crash. The check is linear in the
 * size of the input, threaded, and reads each array of ids, offsets and types once (values of point
 * and cell arrays are not read).
 *
 * For each data set, it checks
 * - point and cell arrays: one tuple per point or cell; ghost arrays have the type that VTK reads;
 * - cell arrays: offsets that ascend from 0 to the length of the connectivity, ids of existing
 *   points, one cell type per cell, numbers of points that fit the type;
 * - polyhedra: face streams that end where the array ends, ids of existing points;
 * - structured data: number of points according to the dimensions, finite spacing, origin and
 *   coordinates;
 * - on request, finite points.
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
/// Requirements on an input beyond consistency.
struct InputRules
{
  bool finitePoints = false; ///< reject NaN and infinite coordinates
  int threads = 0;           ///< 0: one per core
};

/**
 * @brief The first defect of a data set, or of the data sets of composite data ("In block 3: ..."),
 * with the remedy; "" if there is none. Null and leaves that are not data sets are not defects.
 */
TAUTLINECORE_EXPORT std::string inputProblem(vtkDataObject* data, const InputRules& rules = {});

/// Throws Error with inputProblem().
TAUTLINECORE_EXPORT void validateInput(vtkDataObject* data, const InputRules& rules = {});

/**
 * @brief A sentence, with the remedy, on data without points or cells; "" for other data, for
 * objects that are not data sets, and on processes of a parallel server other than the first, which
 * may have no part.
 * @param needed "cells" or "points"
 */
TAUTLINECORE_EXPORT std::string emptyInput(vtkDataObject* data, const char* needed = "cells");

/// Reports emptyInput() as a warning of a filter, unless it is "".
TAUTLINECORE_EXPORT void warnOfEmptyInput(
  vtkAlgorithm* filter, vtkDataObject* data, const char* needed);

/// For filters that VTK executes once per block of composite data: a sentence on a block that is
/// left out because it is not of the kind they need ("mesh").
TAUTLINECORE_EXPORT std::string leftOut(vtkDataObject* block, const char* needed);

/// A sentence on the leaves of composite data that are left out because they are not meshes, or "".
TAUTLINECORE_EXPORT std::string skippedLeaves(vtkDataObject* data);

/// The defect of a selection: ids that are not in the mesh, or a list that does not hold ids.
TAUTLINECORE_EXPORT std::string selectionProblem(vtkSelection* selection, vtkDataObject* mesh);
}
#endif
