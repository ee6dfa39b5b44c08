// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Features.h
 * @brief The features of a geometry detected from a mesh: corners, curves (sharp edges, borders,
 * junctions) and patches.
 *
 * The facets are the cells of a surface mesh, or the boundary faces of a volume mesh; if cells have
 * regions, also the faces between two regions. For a planar mesh, they are the boundary edges (and
 * edges between regions), which are curves; it has no patches.
 */
#ifndef tautline_Features_h
#define tautline_Features_h

#include "Mesh.h"

namespace tautline
{
/// The kind of a point; the values of the point array `FeatureKind`.
enum PointKind : signed char
{
  DetectKind = -1, ///< for given kinds: as detected
  PatchPoint = 0,  ///< within a patch, or within the mesh
  CurvePoint = 1,  ///< on a curve, which passes through it smoothly
  CornerPoint = 2  ///< where curves end, meet or bend
};

struct FeatureOptions
{
  /// Facets (edges of a curve) whose normals (directions) differ by more than this many degrees
  /// meet at a feature; 0 to 180.
  double angle = 40.0;
  /// One per cell, or null: facets between cells of different regions are interfaces; the borders
  /// of regions on a surface are curves.
  const double* regions = nullptr;
  /**
   * @brief One PointKind per point, or null. No edge inside a surface is sharp at a point given as
   * PatchPoint; the two sharpest edges at a point given as CurvePoint are features if fewer than
   * two were found. Borders remain curves.
   */
  const signed char* kinds = nullptr;
  /// Treats a planar mesh as a surface in space: its cells are facets.
  bool asSurface = false;
  /**
   * @brief Whether edges, and points of curves, that bend by up to 1.5 times the angle are smooth
   * where the surface or curve continues to bend in the same direction on both sides, by at least a
   * third as much: on a cylinder with 6 to 8 facets around, but not at a chamfer.
   */
  bool coarse = false;
  /**
   * @brief The edges inside surfaces that are features, each with the smaller point first, sorted;
   * or null: the sharp edges. If given, points where two edges of one curve meet are corners only
   * if their kind says so, and the kinds do not change edges.
   */
  const std::vector<std::array<Index, 2>>* edges = nullptr;
  /**
   * @brief Sharp edges that form a curve with a free end and fewer edges than this are noise, and
   * smooth. So are the edges at a free end up to the first one that bends by 1.25 times the angle,
   * where a curve fades out, as on coarse curved surfaces (hysteresis as in J. Canny, "A
   * computational approach to edge detection", 1986). 0: neither rule. Does not apply to edges at
   * points given as CurvePoint or CornerPoint.
   */
  int shortestCurve = 4;
};

struct Features
{
  /// A facet with its nodes in the order of its cell; for an interface, of the cell in the region
  /// with the smaller number, so that the facets of an interface face the same way.
  struct Facet
  {
    std::array<Index, MaxFaceNodes> nodes;
    int size;
    int patch;
    bool interface; ///< between two cells of a volume mesh
  };
  /// An edge of a curve.
  struct Edge
  {
    Index first, second;
    int curve;
    bool interface; ///< between two cells of a planar mesh
  };

  std::vector<signed char> kind; ///< a PointKind per point
  /// Per point: the curve of a curve point, the patch of a point within a patch; otherwise -1.
  std::vector<int> curveOf, patchOf;
  std::vector<Facet> facets;    ///< for surface meshes, in the order of the cells of the blocks
  std::vector<int> patchOfCell; ///< per cell of a surface mesh, -1 for other cells; otherwise empty
  std::vector<Edge> edges;
  int patches = 0, curves = 0;
  Index corners = 0, curvePoints = 0;
};

/**
 * @brief Finds the features. Facets with (nearly) zero area do not make an edge sharp.
 *
 * A point on two feature edges is a curve point if these are the same kind of curve and differ by
 * at most the angle in direction; a point on any other number of them is a corner.
 * Throws Error for angles, regions or kinds out of range.
 */
TAUTLINE_KERNEL_EXPORT Features findFeatures(const Mesh& mesh, const FeatureOptions& options);
}
#endif
