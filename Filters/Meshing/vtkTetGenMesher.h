// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTetGenMesher
 * @brief Generates quality tetrahedra in a closed surface with TetGen (AGPL).
 *
 * Input: triangles, quadrilaterals and polygons that share their points and enclose one or more
 * volumes (merge duplicate points with Clean to Grid first). Inner surfaces divide the volume.
 * Field arrays, as from vtkTetGenReader: `Holes` (a point x y z in each cavity), `Regions` (x y z,
 * reference, largest volume; negative for none), `FacetHoles`. Polygons with the same value of the
 * cell array `Facet` are one facet with holes.
 *
 * Output 0, vtkUnstructuredGrid: tetrahedra; the input's points come first. Point array
 * `BoundaryMarker`: the lowest marker of the facets of a point (cell array `BoundaryMarker` of the
 * input, otherwise 1), 0 inside. Cell array `Reference` with the region, if there are regions.
 * Output 1, vtkPolyData `Boundary`: the subdivided facets on the same points, with
 * `BoundaryMarker`.
 *
 * A self-intersecting surface is an error that names the facets. TetGen runs in a separate process:
 * any failure gives an error and an empty output, and an abort stops it. The result is
 * deterministic.
 *
 * Limitations: TetGen reports no progress, so the progress only shows that it is running.
 *
 * Method: H. Si, TetGen, a Delaunay-based quality tetrahedral mesh generator, ACM Transactions on
 * Mathematical Software 41 (2015).
 *
 * @sa vtkTriangleMesher vtkTetGenReader vtkDomainSource tautline::meshSolid
 */
#ifndef vtkTetGenMesher_h
#define vtkTetGenMesher_h

#include "TautlineMeshingModule.h" // for export macro
#include "vtkBoundaryMesher.h"
#include "vtkTautlineSetRange.h" // for the setters

class TAUTLINEMESHING_EXPORT vtkTetGenMesher : public vtkBoundaryMesher
{
public:
  static vtkTetGenMesher* New();
  vtkTypeMacro(vtkTetGenMesher, vtkBoundaryMesher);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Largest ratio of circumradius to shortest edge of a tetrahedron; smaller is better, but with
   * 1.1 or less TetGen seldom terminates; 0 means no bound. The default is 1.4.
   */
  vtkTautlineSetRangeMacro(RadiusEdgeRatio, double, 0.0, 100.0);
  vtkGetMacro(RadiusEdgeRatio, double);
  ///@}

  ///@{
  /**
   * Target for the smallest dihedral angle, in degrees. The default is 10.
   */
  vtkTautlineSetRangeMacro(MinimumDihedralAngle, double, 0.0, 60.0);
  vtkGetMacro(MinimumDihedralAngle, double);
  ///@}

  ///@{
  /**
   * Largest volume of a tetrahedron; 0 means no bound. The default is 0.
   */
  vtkTautlineSetRangeMacro(Volume, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Volume, double);
  ///@}

  ///@{
  /**
   * Whether to preserve the input's facets, without new points on them. The default is off.
   */
  vtkSetMacro(PreserveSurface, bool);
  vtkGetMacro(PreserveSurface, bool);
  vtkBooleanMacro(PreserveSurface, bool);
  ///@}

protected:
  vtkTetGenMesher() = default;
  ~vtkTetGenMesher() override = default;
  void Generate(vtkPointSet* input, vtkUnstructuredGrid* output, vtkPolyData* boundary) override;

  double RadiusEdgeRatio = 1.4;
  double MinimumDihedralAngle = 10.0;
  double Volume = 0.0;
  bool PreserveSurface = false;

private:
  vtkTetGenMesher(const vtkTetGenMesher&) = delete;
  void operator=(const vtkTetGenMesher&) = delete;
};

#endif
