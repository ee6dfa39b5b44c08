// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshBoundaryAlgorithm
 * @brief Base class of filters whose boundary points may slide; has the properties of the group
 * Boundary.
 *
 * Abstract. The boundary is the surface of a volume mesh, or the border of a planar mesh. For a
 * surface in space, the points slide on the whole surface.
 *
 * A boundary that slides ON_SURFACE is described by its features: corners stay, points on curves
 * (sharp edges, borders, junctions) slide along these, and others within their patch. With a
 * geometry, only features common to the mesh and the geometry count: edges of the mesh next to a
 * curve of the geometry are on it, and sharp edges and corners that the geometry does not have
 * count as smooth (see tautline/Boundary/GeometryMatch.h).
 *
 * Three input arrays can be chosen with SetInputArrayToProcess() (see the documentation of the
 * filters for the indices): a point array of fixed points (where it is not 0), a point array of
 * feature kinds (0 patch, 1 curve, 2 corner, -1 as detected), and a cell array of regions, whose
 * interfaces are features.
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
   * The motion of the boundary points. FIXED: they stay. SLIDING: in a volume mesh, points within a
   * flat part of the surface move in it, points on a straight edge move along it, and corners and
   * curved parts stay; in a mesh of 2D cells, points on straight parts move along them (see
   * FlatAngle). ON_SURFACE: they slide on the original boundary, or on the geometry, along its
   * curves (see FeatureAngle), while corners stay. FREE: they move like all other points.
   */
  vtkTautlineSetRangeMacro(Boundary, int, FIXED, ON_SURFACE);
  vtkGetMacro(Boundary, int);
  ///@}

  ///@{
  /**
   * Boundary facets whose normals differ by at most this many degrees form one plane (edges: one
   * line) to slide in. A part that bends by more in total, such as a finely divided circle, is
   * curved, and its points stay. The default is 1.
   */
  vtkTautlineSetRangeMacro(FlatAngle, double, 0.0, 90.0);
  vtkGetMacro(FlatAngle, double);
  ///@}

  ///@{
  /**
   * Edges at which a surface, or the boundary, bends by more than this angle, in degrees, are
   * sharp. The default is 40.
   */
  vtkTautlineSetRangeMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * Keep the features of a surface in space, of the boundary (ON_SURFACE) and of interfaces of
   * regions: corners stay, points on curves slide along these and other points within their
   * patches. On a surface, points of the border then slide along it unless FIXED. If off, points of
   * a surface may move anywhere on it, and points on sharp edges of the boundary stay unless the
   * edges are straight. The default is on.
   */
  vtkSetMacro(KeepFeatures, bool);
  vtkGetMacro(KeepFeatures, bool);
  vtkBooleanMacro(KeepFeatures, bool);
  ///@}

  ///@{
  /**
   * With KeepFeatures, points slide on smooth patches and curves through the points of the input,
   * made of cubic triangles and arcs; if off, on its facets and edges. The default is on.
   */
  vtkSetMacro(SmoothSurface, bool);
  vtkGetMacro(SmoothSurface, bool);
  vtkBooleanMacro(SmoothSurface, bool);
  ///@}

  ///@{
  /**
   * The largest distance between the new and the old surface, in both directions, as a fraction of
   * the diagonal of the bounding box, 0 to 1; 0 allows any distance. Applies to surfaces in space
   * and to the boundary with ON_SURFACE. It also applies to interfaces of regions (with
   * KeepFeatures), for any setting of Boundary. Steps that would exceed it are shortened or left
   * out; the summary reports the number of points held back. The distance is measured at the
   * quarter points of the edges of the boundary's triangles (a quadrilateral counts as two), at the
   * crossings of the lines between these, and at the centers. With a geometry it is measured from
   * the boundary to the geometry; parts that are farther away initially may stay so. The points of
   * a surface in space are on the geometry, whatever the tolerance. The default is 0.001.
   */
  vtkTautlineSetRangeMacro(SurfaceTolerance, double, 0.0, 1.0);
  vtkGetMacro(SurfaceTolerance, double);
  ///@}

  ///@{
  /**
   * Add the features to the output: the point array `FeatureKind` (0 within a patch or the mesh, 1
   * on a curve, 2 corner), and the array `PatchId` for points within a patch and for cells of a
   * surface (-1: none). The default is off.
   */
  vtkSetMacro(ShowFeatures, bool);
  vtkGetMacro(ShowFeatures, bool);
  vtkBooleanMacro(ShowFeatures, bool);
  ///@}

  ///@{
  /**
   * Free the points of elements that are inverted or degenerate in the input, whatever fixes them,
   * including boundary points, where the boundary may then change its shape. A mesh on several
   * processes is gathered on the first one. The default is off.
   */
  vtkSetMacro(FreeInvalid, bool);
  vtkGetMacro(FreeInvalid, bool);
  vtkBooleanMacro(FreeInvalid, bool);
  ///@}

protected:
  /// @param fixedArray, kindArray, regionArray the indices of the input arrays
  vtkMeshBoundaryAlgorithm(int fixedArray, int kindArray, int regionArray);
  ~vtkMeshBoundaryAlgorithm() override;

  /// @param geometry the surface that points slide on instead of the boundary of the input, or null
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
