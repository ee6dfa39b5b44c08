// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTriangleMesher
 * @brief Quality triangles in planar outlines with holes and inner constraints (CGAL, GPL).
 *
 * Input: lines, polylines or polygons in a plane z = constant. Their edges are kept, subdivided
 * where the refinement needs it. What an odd number of outlines surrounds is filled, unless the
 * field array `Holes` (points x y z, as vtkTetGenReader gives it) marks what is not; then
 * everything else is. Points without cells inside of the domain stay points of the mesh.
 *
 * Output 0, vtkUnstructuredGrid: triangles, counter-clockwise; the input's points come first. Point
 * array `BoundaryMarker`: lowest marker of the segments a point is on (cell array `BoundaryMarker`
 * of the input, else 1), 0 elsewhere. Output 1, vtkPolyData `Boundary`: the subdivided segments on
 * the same points, with the cell array `BoundaryMarker`.
 *
 * Deterministic. Reports progress and can be aborted; an aborted run gives an empty output.
 *
 * Limits: segments must not cross (the message names the first that does). Angles between segments
 * below 60 degrees can leave smaller angles beside them. Other arrays are not carried over.
 *
 * Method: J. R. Shewchuk, Delaunay refinement algorithms for triangular mesh generation,
 * Computational Geometry 22 (2002); dissertation sections 2.7 and 5.2 use such meshes.
 *
 * @sa vtkTetGenMesher vtkDomainSource tautline::meshPlane
 */
#ifndef vtkTriangleMesher_h
#define vtkTriangleMesher_h

#include "TautlineMeshingModule.h" // for export macro
#include "vtkBoundaryMesher.h"
#include "vtkTautlineSetRange.h" // for the setters

class TAUTLINEMESHING_EXPORT vtkTriangleMesher : public vtkBoundaryMesher
{
public:
  static vtkTriangleMesher* New();
  vtkTypeMacro(vtkTriangleMesher, vtkBoundaryMesher);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Smallest angle of a triangle, degrees. Up to 20.7 the refinement ends for certain. The default
   * is 20.7.
   */
  vtkTautlineSetRangeMacro(MinimumAngle, double, 0.0, 35.0);
  vtkGetMacro(MinimumAngle, double);
  ///@}

  ///@{
  /**
   * Longest edge allowed; 0 is no bound. The default is 0.
   */
  vtkTautlineSetRangeMacro(Size, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Size, double);
  ///@}

  ///@{
  /**
   * With UseSizeArray, away from the input points the allowed edge grows by this times the
   * distance. The default is 0.3.
   */
  vtkTautlineSetRangeMacro(Gradation, double, 0.0, 10.0);
  vtkGetMacro(Gradation, double);
  ///@}

protected:
  vtkTriangleMesher() = default;
  ~vtkTriangleMesher() override = default;
  void Generate(vtkPointSet* input, vtkUnstructuredGrid* output, vtkPolyData* boundary) override;

  double MinimumAngle = 20.7;
  double Size = 0.0;
  double Gradation = 0.3;

private:
  vtkTriangleMesher(const vtkTriangleMesher&) = delete;
  void operator=(const vtkTriangleMesher&) = delete;
};

#endif
