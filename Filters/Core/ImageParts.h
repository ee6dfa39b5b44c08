// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageParts.h
 * @brief Handles the parts of an image on several processes.
 */
#ifndef tautline_ImageParts_h
#define tautline_ImageParts_h

#include "vtkType.h"

#include <vector>

class vtkDataSet;

namespace tautline
{
/// Whether all pieces are parts of one image. @param pieces at least one
bool areOneImage(const std::vector<vtkDataSet*>& pieces);

/// The ids of a part of an image in the whole image, by their extents.
/// @param unit 0 for points, 1 for cells
std::vector<vtkIdType> idsOfPart(const int* part, const int* all, int unit);
}
#endif
