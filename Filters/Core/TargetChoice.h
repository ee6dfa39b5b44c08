// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetChoice.h
 * @brief The targets of a filter, from a reference mesh or from arrays of its input.
 */
#ifndef tautline_TargetChoice_h
#define tautline_TargetChoice_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Quality/Targets.h"

#include <vector>

class vtkDataArray;
class vtkDataSet;

namespace tautline
{
/// An array and its association, points or cells (vtkDataObject::FIELD_ASSOCIATION_...).
struct ChosenArray
{
  vtkDataArray* array = nullptr;
  int association = 0;
};

/// The target element and the data that define it; only the data for the type are used.
struct TargetChoice
{
  TargetType type = TargetType::Ideal;
  vtkDataSet* reference = nullptr;
  ChosenArray size;   ///< area or volume, one component
  ChosenArray tensor; ///< metric tensor, 6 (xx yy zz xy yz xz) or 9 components
};

/**
 * @brief The chosen targets; none for TargetType::Ideal. Values of point arrays are averaged over
 * each cell. A reference mesh that is reversed throughout is treated as its mirror image. Throws
 * Error if data are missing or do not fit.
 */
TAUTLINECORE_EXPORT Targets makeTargets(const Mesh& mesh, const TargetChoice& choice, int threads);

/// The values behind the targets of TargetType::Size and Tensor: one size, or a 3 x 3 matrix, per
/// cell of the view. Throws Error as makeTargets().
TAUTLINECORE_EXPORT std::vector<double> targetValues(
  const MeshView& view, const TargetChoice& choice);
/// The number of values per cell.
constexpr int targetComponents(TargetType type)
{
  return type == TargetType::Size ? 1 : 9;
}
/// The targets of these types from their values.
TAUTLINECORE_EXPORT Targets targetsOf(
  const Mesh& mesh, TargetType type, const std::vector<double>& values);
}
#endif
