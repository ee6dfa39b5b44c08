// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTriangleMesher
 * @brief Generates quality triangles in planar outlines with holes and inner constraints (CGAL,
 * GPL).
 *
 * Input: lines, polylines or polygons in a plane z = constant. Their edges are kept, subdivided
 * where the refinement requires it. Regions surrounded by an odd number of outlines are filled,
 * unless the field array `Holes` (points x y z, as from vtkTetGenReader) marks the empty regions;
 * then all others are filled. Points without cells inside the domain become points of the mesh.
 *
 * Output 0, vtkUnstructuredGrid: triangles, counterclockwise; the input's points come first. Point
 * array `BoundaryMarker`: lowest marker of the segments of a point (cell array `BoundaryMarker` of
 * the input, otherwise 1), 0 elsewhere. Output 1, vtkPolyData `Boundary`: the subdivided segments
 * on the same points, with the cell array `BoundaryMarker`.
 *
 * The result is deterministic. The filter reports progress and can be aborted; an aborted run gives
 * an empty output.
 *
 * Limitations: segments must not cross (the message names the first one that does). Angles between
 * segments below 60 degrees can leave smaller angles beside them. Other arrays are not carried
 * over.
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
   * Smallest angle of a triangle, in degrees. Up to 20.7 the refinement is guaranteed to terminate.
   * The default is 20.7.
   */
  vtkTautlineSetRangeMacro(MinimumAngle, double, 0.0, 35.0);
  vtkGetMacro(MinimumAngle, double);
  ///@}

  ///@{
  /**
   * Upper bound on the edge length; 0 means no bound. The default is 0.
   */
  vtkTautlineSetRangeMacro(Size, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Size, double);
  ///@}

  ///@{
  /**
   * With UseSizeArray, the bound on the edge length grows by this factor times the distance from
   * the input points. The default is 0.3.
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
