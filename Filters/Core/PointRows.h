// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointRows.h
 * @brief Sends the point data of a mesh in pieces to the processes that need them.
 */
#ifndef tautline_PointRows_h
#define tautline_PointRows_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Core/RankGroup.h"

#include "vtkSmartPointer.h"

#include <vector>

class vtkPointData;

namespace tautline
{
/// Keeps only the arrays that all pieces with points have with the same type and number of
/// components. Collective. @param points of this piece
TAUTLINECORE_EXPORT void keepCommonArrays(RankGroup& group, vtkPointData* data, Index points);

/**
 * @brief The values of points, one row each, from the pieces that have them. Collective.
 *
 * If several pieces have a point, the values come from the lowest rank.
 * @param data of this piece: the same arrays on all ranks with points, see keepCommonArrays()
 * @param numbers per point of the piece, the same on all ranks for the same point; negative if it
 * is not requested
 * @param wanted requested numbers of points of the pieces, in increasing order
 * @return the arrays of `data`, in their order
 */
TAUTLINECORE_EXPORT vtkSmartPointer<vtkPointData> pointRows(RankGroup& group, vtkPointData* data,
  const std::vector<Index>& numbers, const std::vector<Index>& wanted);
}
#endif
