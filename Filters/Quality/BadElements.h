// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BadElements.h
 * @brief Collects the bad elements of volume meshes, which may be hidden inside the mesh.
 */

#ifndef tautline_BadElements_h
#define tautline_BadElements_h

#include "tautline/Quality/Metrics.h"

#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <vector>

class vtkDataSet;

namespace tautline
{

/**
 * @brief The elements that are inverted or degenerate, failed by the criteria (array `Grade`) or,
 * without criteria, outside the acceptable range of a metric.
 */
class BadElements
{
public:
  /**
   * @brief Adds the bad elements of a volume mesh.
   * @param output the mesh with the cell arrays of the metrics and, with criteria, `Grade`
   * @param validity a value per cell
   * @param skip null, or a value per cell: cells with 1 are left out
   * @param metrics whose acceptable ranges are used
   */
  void add(vtkDataSet* output, const signed char* validity, const unsigned char* skip,
    const std::vector<Metric>& metrics);

  /// The elements of all blocks, with the arrays that all of them have.
  void copyTo(vtkUnstructuredGrid* grid) const;

private:
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> Blocks;
};

} // namespace tautline

#endif
