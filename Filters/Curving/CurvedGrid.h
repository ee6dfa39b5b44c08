// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedGrid.h
 * @brief Converts data sets to unstructured grids, and writes the result of curving with the data
 * of its input.
 */
#ifndef tautline_CurvedGrid_h
#define tautline_CurvedGrid_h

#include "vtkSmartPointer.h"

#include <vector>

class vtkDataObject;
class vtkDataSet;
class vtkUnstructuredGrid;

namespace tautline
{
class MeshAdapter;
struct CurvingResult;

/// Converts all data sets to unstructured grids; throws Error for adaptive grids (AMR), which
/// cannot hold them.
vtkSmartPointer<vtkDataObject> asGrids(vtkDataObject* data);

/**
 * @brief Fills the output.
 * @param adapter of the input, in the frame of the result
 */
void writeCurved(const CurvingResult& curved, const MeshAdapter& adapter, vtkDataSet* input,
  vtkUnstructuredGrid* output);
}
#endif
