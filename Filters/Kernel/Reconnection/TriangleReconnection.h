// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleReconnection.h
 * @brief Improves the worst triangles of a planar mesh or a surface by changing its connectivity
 * and moving points.
 *
 * Operations on the worst triangles first: flips of edges, motion of points, contraction and
 * division of edges, insertion of points in triangles and at their circumcenters. Flips alone give
 * the Delaunay triangulation of the points of a planar mesh, whose smallest angle is the largest
 * (C. L. Lawson, "Software for C1 surface interpolation", 1977; R. Sibson, 1978).
 *
 * The quality of a triangle is the sine of its smallest angle. An operation is accepted if the
 * qualities of the triangles it affects, in increasing order, become larger lexicographically, and
 * no inverse mean ratio exceeds the worst of the input. Triangles of a planar mesh stay positive by
 * an exact predicate.
 *
 * With ReconnectionOptions::adapt, edges are first adapted to their target lengths
 * (TriangleAdaptation.h), and the quality is the mean ratio in the metric.
 *
 * Borders, edges between regions, given edges, fixed points and, on a surface in space, its sharp
 * edges and corners (Mesh/Features.h) are preserved. Other points of a surface stay on the smooth
 * surface through the input points (Boundary/SurfaceModel.h), and changed triangles stay close to
 * its facets.
 *
 * Example: all operations, with a fixed border.
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
 * In the result, `triangles` holds the cells; weights of interpolations end with a zero. In the
 * records, `tetrahedra` is the number of triangles, `edgeRemovals` is the number of flips, and
 * `faceRemovals` and `boundarySwaps` are 0.
 *
 * Throws Error, with a remedy, for cells that are not linear triangles, coordinates that are not
 * finite, degenerate triangles and, in planar meshes, inverted triangles and edges with three or
 * more triangles, or two on the same side. On surfaces, such edges are preserved.
 * @param mesh see Mesh::setMirrored() for reversed planar meshes; not changed
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT ReconnectionResult improveTriangles(
  const Mesh& mesh, const TriangleOptions& options);
}
#endif
