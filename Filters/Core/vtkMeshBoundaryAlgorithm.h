// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshBoundaryAlgorithm
 * @brief Base class of the filters whose boundary points may slide: the properties of the group
 * Boundary.
 *
 * Abstract. The boundary is the surface of a volume mesh, or the border of a planar mesh; of a
 * surface in space, all of it is the surface that points slide on.
 *
 * A boundary that slides ON_SURFACE is described by its features: corners stay, points on curves
 * (sharp edges, borders, junctions) slide along these, and others within their patch. With a
 * geometry, the features are those that the mesh and the geometry have in common: edges of the mesh
 * next to a curve of the geometry are on it, and sharp edges and corners that the geometry does not
 * have are smooth (see tautline/Boundary/GeometryMatch.h).
 *
 * Three input arrays can be chosen by SetInputArrayToProcess(), whose indices are in the
 * documentation of the filters: a point array of points that stay (where it is not 0), a point
 * array of feature kinds (0 patch, 1 curve, 2 corner, -1 as found), and a cell array of regions,
 * whose interfaces are part of the features.
 *
 * @sa vtkMeshOptimizer, vtkMeshUntangler
 */

#ifndef vtkMeshBoundaryAlgorithm_h
#define vtkMeshBoundaryAlgorithm_h

#include "TautlineCoreModule.h" // for export macro
#include "vtkMeshMotionAlgorithm.h"

namespace tautline
{
struct BoundaryProperties;
}

class TAUTLINECORE_EXPORT vtkMeshBoundaryAlgorithm : public vtkMeshMotionAlgorithm
{
public:
  vtkTypeMacro(vtkMeshBoundaryAlgorithm, vtkMeshMotionAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Boundaries
  {
    FIXED = 0,
    SLIDING = 1,
    FREE = 2,
    ON_SURFACE = 3
  };
  ///@{
  /**
   * What the points of the boundary do. FIXED: they stay. SLIDING: of a volume mesh those within a
   * flat part of the surface move in it, those on a straight edge along it, corners and curved
   * parts stay; of a mesh of 2D cells those on straight parts move along them (see FlatAngle).
   * ON_SURFACE: they slide on the boundary as it was, or on the geometry, along its curves
   * (see FeatureAngle), while corners stay. FREE: they move as all others.
   */
  vtkTautlineSetRangeMacro(Boundary, int, FIXED, ON_SURFACE);
  vtkGetMacro(Boundary, int);
  ///@}

  ///@{
  /**
   * Boundary facets whose normals differ by at most so many degrees are one plane (edges: one line)
   * to slide in. A part that bends by more in all, as a fine circle, is curved: where it bends,
   * its points stay. The default is 1.
   */
  vtkTautlineSetRangeMacro(FlatAngle, double, 0.0, 90.0);
  vtkGetMacro(FlatAngle, double);
  ///@}

  ///@{
  /**
   * Edges at which a surface, or the boundary, bends by more than so many degrees are sharp. The
   * default is 40.
   */
  vtkTautlineSetRangeMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * Keep the features of a surface in space, of the boundary (ON_SURFACE) and of interfaces of
   * regions: corners stay, points on curves slide along these and other points within their
   * patches. On a surface, points of the border then slide along it unless FIXED. Off: points of a
   * surface may go anywhere on it, and those on sharp edges of the boundary stay unless these are
   * straight. The default is on.
   */
  vtkSetMacro(KeepFeatures, bool);
  vtkGetMacro(KeepFeatures, bool);
  vtkBooleanMacro(KeepFeatures, bool);
  ///@}

  ///@{
  /**
   * With KeepFeatures, points slide on smooth patches and curves through the points of the input,
   * made of cubic triangles and arcs; off: on its facets and edges. The default is on.
   */
  vtkSetMacro(SmoothSurface, bool);
  vtkGetMacro(SmoothSurface, bool);
  vtkBooleanMacro(SmoothSurface, bool);
  ///@}

  ///@{
  /**
   * Of surfaces in space, and of the boundary ON_SURFACE: how far the new surface may be from the
   * old one, and the old one from the new one, as a fraction of the diagonal of the bounding box, 0
   * to 1; 0: any distance.
   * The same of interfaces of regions (with KeepFeatures), whatever the boundary does. Steps that
   * would take it farther are shortened or left out; the summary says how many points are held by
   * that. The distance is measured at the quarters of the edges of the boundary's triangles
   * (quadrilaterals are two), at the crossings of the lines between these, and at the centres.
   * With a geometry it is measured from the boundary to the geometry; what is farther at the start
   * may stay so. The points of a surface in space are on the geometry, whatever the tolerance. The
   * default is 0.001.
   */
  vtkTautlineSetRangeMacro(SurfaceTolerance, double, 0.0, 1.0);
  vtkGetMacro(SurfaceTolerance, double);
  ///@}

  ///@{
  /**
   * Add the features to the output: the point array `FeatureKind` (0 within a patch or the mesh, 1
   * on a curve, 2 corner) and `PatchId`, of the points within a patch and of the cells of a
   * surface (-1: none). The default is off.
   */
  vtkSetMacro(ShowFeatures, bool);
  vtkGetMacro(ShowFeatures, bool);
  vtkBooleanMacro(ShowFeatures, bool);
  ///@}

  ///@{
  /**
   * Free the points of the elements that are inverted or degenerate in the input, however they are
   * fixed, also on the boundary, which may change its shape there. A mesh on several processes is
   * gathered on the first one. Off.
   */
  vtkSetMacro(FreeInvalid, bool);
  vtkGetMacro(FreeInvalid, bool);
  vtkBooleanMacro(FreeInvalid, bool);
  ///@}

protected:
  /// @param fixedArray, kindArray, regionArray the indices of the input arrays
  vtkMeshBoundaryAlgorithm(int fixedArray, int kindArray, int regionArray);
  ~vtkMeshBoundaryAlgorithm() override;

  /// @param geometry what points slide on instead of the boundary of the input, or null
  tautline::BoundaryProperties GetBoundaryProperties(vtkDataObject* geometry);

  int Boundary = FIXED;
  double FlatAngle = 1.0;
  double FeatureAngle = 40.0;
  bool KeepFeatures = true;
  bool SmoothSurface = true;
  double SurfaceTolerance = 0.001;
  bool ShowFeatures = false;
  bool FreeInvalid = false;

private:
  vtkMeshBoundaryAlgorithm(const vtkMeshBoundaryAlgorithm&) = delete;
  void operator=(const vtkMeshBoundaryAlgorithm&) = delete;

  const int FixedIndex, KindIndex, RegionIndex;
};

#endif
