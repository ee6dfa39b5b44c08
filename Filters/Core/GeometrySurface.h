// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GeometrySurface.h
 * @brief Converts the Geometry of a filter (the surface or outline that a mesh is placed on) to a
 * mesh of the kernel.
 */
#ifndef tautline_GeometrySurface_h
#define tautline_GeometrySurface_h

#include "TautlineCoreModule.h" // for export macro

#include "MeshAdapter.h"

namespace tautline
{
/**
 * @class tautline::GeometrySurface
 * @brief Triangles and quadrilaterals; for a planar mesh lines, or cells in its plane. The data set
 * must outlive it.
 */
class TAUTLINECORE_EXPORT GeometrySurface
{
public:
  /**
   * @param geometry the input; throws Error if it is null, has no cells, or has volume cells
   * @param frame of the mesh that is placed on it
   * @param outline whether that mesh is planar
   */
  GeometrySurface(vtkDataSet* geometry, const CoordinateFrame& frame, bool outline, int threads);

  /// In the frame, with coincident points merged.
  const Mesh& mesh() const { return *this->Surface; }

private:
  std::unique_ptr<MeshAdapter> Adapter;
  std::vector<double> Points;
  std::unique_ptr<Mesh> Surface;
};
}
#endif
