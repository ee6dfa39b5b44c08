// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SelectionMarks.h
 * @brief Converts selections on the pieces of a mesh to arrays that can be joined, and back to a
 * selection on the whole mesh.
 */
#ifndef tautline_SelectionMarks_h
#define tautline_SelectionMarks_h

#include "TautlineCoreModule.h" // for export macro

#include "WholeMesh.h"

#include <vector>

class vtkDataObject;
class vtkDataSetAttributes;
class vtkSelection;

namespace tautline
{
/// Adds the marks of a piece as an array, zeros where nothing is selected.
/// @param marked the attributes with the array of markSelected(), or null
TAUTLINECORE_EXPORT void addMarks(
  vtkDataSetAttributes* marked, vtkIdType count, int port, vtkDataSetAttributes* result);

/// Selects a point of the whole mesh if it is selected in any piece.
TAUTLINECORE_EXPORT void uniteMarks(
  const std::vector<vtkDataSet*>& pieces, const WholeMesh& whole, int port);

/// Removes the marks of an input.
TAUTLINECORE_EXPORT void removeMarks(vtkDataObject* whole, int port);

/// A selection of the marked points or cells.
TAUTLINECORE_EXPORT vtkSmartPointer<vtkSelection> selectionOf(vtkDataObject* whole, int port);
}
#endif
