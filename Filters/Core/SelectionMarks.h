// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SelectionMarks.h
 * @brief What is selected of the pieces of a mesh, as arrays that can be put together, and as a
 * selection of the whole.
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
/// @param marked the attributes with what markSelected() has set, or null
TAUTLINECORE_EXPORT void addMarks(
  vtkDataSetAttributes* marked, vtkIdType count, int port, vtkDataSetAttributes* result);

/// Selects a point of the whole mesh if it is selected in any piece.
TAUTLINECORE_EXPORT void uniteMarks(
  const std::vector<vtkDataSet*>& pieces, const WholeMesh& whole, int port);

/// Removes the marks of an input.
TAUTLINECORE_EXPORT void removeMarks(vtkDataObject* whole, int port);

/// A selection of what has marks.
TAUTLINECORE_EXPORT vtkSmartPointer<vtkSelection> selectionOf(vtkDataObject* whole, int port);
}
#endif
