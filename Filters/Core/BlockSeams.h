// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockSeams.h
 * @brief Seams between the data sets of composite data: coincident points on matching boundaries.
 */
#ifndef tautline_BlockSeams_h
#define tautline_BlockSeams_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Core/Types.h"

#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;

namespace tautline
{
/// The result of findBlockSeams().
struct BlockSeams
{
  /// One per data set: the smallest number among the data sets that seams connect it with, or its
  /// own.
  std::vector<int> group;
  Index points = 0;  ///< points of a data set that coincide with one of another data set
  std::string first; ///< "point 3 at (0, 0.5, 1) of block 2"
};

/**
 * @brief Finds the seams between data sets; seams within a data set do not count.
 * @param names of the data sets, for `first`
 *
 * Throws Error if a mesh is malformed.
 */
TAUTLINECORE_EXPORT BlockSeams findBlockSeams(
  const std::vector<vtkDataSet*>& data, const std::vector<std::string>& names, int threads);

/**
 * @brief A sentence on the seams between the data sets of composite data, which a filter treats
 * separately, with the remedy; "" if there are none.
 */
TAUTLINECORE_EXPORT std::string describeBlockSeams(vtkDataObject* input, int threads);
}
#endif
