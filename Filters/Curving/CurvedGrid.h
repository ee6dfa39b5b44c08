// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedGrid.h
 * @brief Data sets as unstructured grids, and the result of curving with the data of its input.
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

/// The same with an unstructured grid for each data set that is none; throws Error for adaptive
/// grids (AMR), which cannot hold them.
vtkSmartPointer<vtkDataObject> asGrids(vtkDataObject* data);

/**
 * @brief Fills the output.
 * @param adapter of the input, in the frame of the result
 */
void writeCurved(const CurvingResult& curved, const MeshAdapter& adapter, vtkDataSet* input,
  vtkUnstructuredGrid* output);
}
#endif
