// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ContentStamp.h
 * @brief Tests whether two data objects have the same content, without comparing values.
 */
#ifndef tautline_ContentStamp_h
#define tautline_ContentStamp_h

#include "TautlineCoreModule.h" // for export macro

#include "vtkType.h"

#include <vector>

class vtkDataObject;

namespace tautline
{
/// The modification times of the points, cells and arrays of all data sets.
using ContentStamp = std::vector<vtkMTimeType>;

/**
 * @brief The stamp of the inputs of a filter; inputs may be null.
 *
 * A shallow copy has the stamp of its original, though its own modification time is later: ParaView
 * copies the input of a filter at each time step. Equal stamps mean equal content, because no two
 * modifications in a process have the same time. A data set that is not an unstructured grid or
 * polygonal data counts with its own time.
 */
TAUTLINECORE_EXPORT ContentStamp contentStamp(const std::vector<vtkDataObject*>& inputs);
}
#endif
