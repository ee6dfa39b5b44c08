// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeMatch.h
 * @brief Finds a deformable shape in an image: the placement of a triangulated polygon with the
 * minimum energy.
 *
 * The source is a triangulated polygon (Polygon.h), the target an image with a finite set of
 * locations for its vertices. The energy of a placement is a sum over the triangles (dissertation
 * equation 5.1),
 *
 *     E = sum_i  E_edge,i + a E_def,i + b E_dis,i
 *
 *     E_edge  mean of 1 / (lambda + |grad I|) along each boundary edge of the triangle
 *     E_def   log(alpha / beta)^2, with the singular values of the map of the triangle
 *     E_dis   |log(gamma / delta)|, gamma the larger ratio of the sums of edge lengths,
 *             delta the ratio of d_max
 *
 * and the global minimum is found by dynamic programming: exactly, without a starting point.
 *
 *     tautline::ShapeSource source = tautline::makeShapeSource(traceSilhouette(a), 25.0);
 *     tautline::ShapeTarget target(traceSilhouette(b), {});
 *     tautline::ShapeMatch match = tautline::matchShape(source, target, {});
 *     // match.points: the positions of the vertices of source.mesh
 *
 * Sources: J. Kim, dissertation, chapter 5; P. Felzenszwalb, Representation and detection of
 * deformable shapes, IEEE PAMI 27 (2005). Choices that the dissertation leaves open are stated
 * below and in the help page.
 */
#ifndef tautline_ShapeMatch_h
#define tautline_ShapeMatch_h

#include "ShapeModel.h"
#include "tautline/ShapesKernelExport.h"

namespace tautline
{
/**
 * @brief The placement of minimum energy, exact unless coarseToFine or stopped.
 *
 * The tables are in single precision; the returned energies are recomputed in double precision.
 * Ties are resolved by the first location.
 *
 * Throws Error for options out of range or not finite, and if the tables would need more than 4
 * GiB.
 */
TAUTLINE_SHAPESKERNEL_EXPORT ShapeMatch matchShape(
  const ShapeSource& source, const ShapeTarget& target, const MatchOptions& options);

/// Evaluates a placement; `points` has one point per vertex of the source.
TAUTLINE_SHAPESKERNEL_EXPORT ShapeMatch evaluatePlacement(const ShapeSource& source,
  const ShapeTarget& target, const ShapeEnergy& energy, const std::vector<Vec2>& points);
}
#endif
