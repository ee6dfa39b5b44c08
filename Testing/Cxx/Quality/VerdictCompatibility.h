// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VerdictCompatibility.h
 * @brief What differs between vtkMeshQuality of VTK 9.1 and of 9.6, in one place.
 */
#ifndef tautline_VerdictCompatibility_h
#define tautline_VerdictCompatibility_h

#include "vtkMeshQuality.h"
#include "vtkVersionMacros.h"

#include <cstddef>

namespace tautline
{
/// A function of vtkMeshQuality, or none where this version of VTK lacks it.
class VerdictFunction
{
public:
  VerdictFunction(std::nullptr_t) {}
  VerdictFunction(double (*function)(vtkCell*))
    : Plain(function)
  {
  }
  /// Since 9.6; the second argument, false by default, makes curved cells linear.
  VerdictFunction(double (*function)(vtkCell*, bool))
    : Curved(function)
  {
  }

  bool exists() const { return this->Plain || this->Curved; }
  double operator()(vtkCell* cell) const
  {
    return this->Plain ? this->Plain(cell) : this->Curved(cell, false);
  }

private:
  double (*Plain)(vtkCell*) = nullptr;
  double (*Curved)(vtkCell*, bool) = nullptr;
};

/// The functions of vtkMeshQuality under the names of VTK 9.2.
struct VerdictFunctions : vtkMeshQuality
{
  /// The power of Tautline's mean ratio of a tetrahedron that is Verdict's, and whether Verdict
  /// takes the corners of a wedge the other way round than VTK does. Seen in 9.1, 9.2 and 9.6.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  static constexpr double tetMeanRatioPower = 1.5;
  static constexpr bool wedgesReversed = false;
#else
  static constexpr double tetMeanRatioPower = 1;
  static constexpr bool wedgesReversed = true;
#endif

#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 2, 0)
  static double QuadMaxEdgeRatio(vtkCell* cell)
  {
    return QuadMaxEdgeRatios(cell);
  }
  static constexpr std::nullptr_t TriangleEquiangleSkew = nullptr;
  static constexpr std::nullptr_t TriangleNormalizedInradius = nullptr;
  static constexpr std::nullptr_t QuadEquiangleSkew = nullptr;
  static constexpr std::nullptr_t TetMeanRatio = nullptr;
  static constexpr std::nullptr_t TetEquiangleSkew = nullptr;
  /// There it is the determinant at the center.
  static constexpr std::nullptr_t HexVolume = nullptr;
  static constexpr std::nullptr_t WedgeVolume = nullptr;
  static constexpr std::nullptr_t WedgeEdgeRatio = nullptr;
  static constexpr std::nullptr_t WedgeScaledJacobian = nullptr;
  static constexpr std::nullptr_t WedgeEquiangleSkew = nullptr;
  static constexpr std::nullptr_t PyramidVolume = nullptr;
  static constexpr std::nullptr_t PyramidEquiangleSkew = nullptr;
#endif
};

/// Makes a filter measure the mean ratio of tetrahedra, which VTK 9.1 has as Shape only.
inline void measureMeanRatio(vtkMeshQuality* filter)
{
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 2, 0)
  filter->SetTetQualityMeasureToShape();
#else
  filter->SetTetQualityMeasureToMeanRatio();
#endif
}
} // namespace tautline

#endif
