// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WholeOnAll.h
 * @brief A data set in pieces as a whole on every process.
 */
#ifndef tautline_WholeOnAll_h
#define tautline_WholeOnAll_h

#include "TautlineCoreModule.h" // for export macro

#include "vtkSmartPointer.h"

#include <string>

class vtkDataSet;

namespace tautline
{
class RankGroup;

/**
 * @brief The whole of a data set in pieces, on every process, as assemble() puts it together. It is
 * in the memory of each of them. Of its arrays it has those of ghosts, the global ids and one more.
 * Collective; throws Error on all processes.
 * @param piece of this process; null: it has none. Some process has one.
 * @param array a name of a point array, or ""
 */
TAUTLINECORE_EXPORT vtkSmartPointer<vtkDataSet> assembleOnAll(
  RankGroup& group, vtkDataSet* piece, const std::string& array);
}
#endif
