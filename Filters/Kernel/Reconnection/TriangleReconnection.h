// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleReconnection.h
 * @brief Improves the worst triangles of a planar mesh or a surface by changing its connectivity
 * and moving points.
 *
 * Operations on the worst triangles first: flips of edges, motion of points, contraction and
 * division of edges, insertion of points in triangles and at the centres of their circumcircles.
 * Flips alone give the Delaunay triangulation of the points of a planar mesh, whose smallest angle
 * is the largest (C. L. Lawson, "Software for C1 surface interpolation", 1977; R. Sibson, 1978).
 *
 * The quality of a triangle is the sine of its smallest angle. An operation is accepted if the
 * qualities of the triangles it affects, in increasing order, become larger lexicographically, and
 * no inverse mean ratio exceeds the worst of the input. Triangles of a planar mesh stay positive by
 * an exact predicate.
 *
 * With ReconnectionOptions::adapt, edges first get their target lengths (TriangleAdaptation.h), and
 * the quality is the mean ratio in the metric.
 *
 * Kept are borders, edges between regions, given edges, fixed points and, on a surface in space,
 * its sharp edges and corners (Mesh/Features.h). Other points of a surface stay on the smooth
 * surface through the points of the input (Boundary/SurfaceModel.h), and changed triangles close to
 * its facets.
 *
 * Example: every operation, the border kept.
 *
 *     tautline::TriangleOptions options;
 *     tautline::ReconnectionResult result = tautline::improveTriangles(mesh, options);
 *     // result.points, result.triangles; result.history.back().smallestAngle
 */
#ifndef tautline_TriangleReconnection_h
#define tautline_TriangleReconnection_h

#include "ReconnectionResult.h"
#include "TriangleOptions.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief Improves the connectivity and the points of a triangle mesh. One thread; the result is the
 * same in every run, unless a limit ends it. Memory: about 400 bytes per triangle with the result.
 *
 * Of the result, `triangles` holds the cells; weights of interpolations have a zero at the end. In
 * the records, `tetrahedra` is the number of triangles, `edgeRemovals` that of flips, and
 * `faceRemovals` and `boundarySwaps` are 0.
 *
 * Throws Error, with a remedy, for cells that are not linear triangles, coordinates that are not
 * finite, degenerate triangles, and of planar meshes for inverted triangles and edges with three or
 * more triangles, or two on the same side. Such edges of surfaces are kept.
 * @param mesh see Mesh::setMirrored() for planar meshes that are reversed; not changed
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT ReconnectionResult improveTriangles(
  const Mesh& mesh, const TriangleOptions& options);
}
#endif
