// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeRetrieval.h
 * @brief Compares a set of labeled silhouettes: all matches, the ranking and the recognition rate.
 *
 *     const auto options = tautline::RetrievalOptions::highest();
 *     tautline::Retrieval result = tautline::retrieveShapes(shapes, labels, options);
 *     // result.recognition.rate: 1 if the 10 best matches of each shape are in its own class
 */
#ifndef tautline_ShapeRetrieval_h
#define tautline_ShapeRetrieval_h

#include "OutlineMatch.h"
#include "ShapeMatch.h"

#include "tautline/Core/RankGroup.h"
#include "tautline/ShapesKernelExport.h"

namespace tautline
{
/// The objects that are matched.
enum class RetrievalMethod
{
  Image = 0,  ///< polygons with images: matchShape()
  Outline = 1 ///< polygons with outlines, with all lengths relative to the outline: matchOutlines()
};

/// The options of a comparison of shapes.
struct RetrievalOptions
{
  RetrievalMethod method = RetrievalMethod::Image;
  OutlineOptions outline; ///< for the method Outline
  /// The sum of both energies of the method Outline is divided by this plus the complexities of
  /// both outlines, because simple shapes differ less. Above 0.
  double complexity = 0.3;
  /// Per shape, the number of shapes with the nearest signatures with which it is matched; also
  /// with shapes that have it among theirs. 0: all. For the method Outline.
  Index shortlist = 0;
  /// Distances are replaced by 1 minus the affinity of the shapes after diffusion over graphs of
  /// this many nearest neighbors (rerank()), so that the result depends on the whole set; 0: no
  /// diffusion.
  Index neighbours = 0;
  double spacing = 25.0; ///< of the polygon vertices, in pixels, above 0
  LocationOptions locations;
  MatchOptions match; ///< its threads, timeLimit and progress apply to the whole run
  /// The distance of two shapes is E(a to b) / triangles of a + E(b to a) / triangles of b, instead
  /// of E(a to b): each must be found in the other.
  bool symmetric = false;
  Index best = 10; ///< evaluated matches per query, at least 1

  /// The settings of the dissertation: spacing 25, 30 x 30 grid, a = 4 b, theta = d_max / 3.
  static RetrievalOptions dissertation() { return {}; }
  /// The same with Felzenszwalb's energy and without the center of mass.
  TAUTLINE_SHAPESKERNEL_EXPORT static RetrievalOptions felzenszwalb();
  /// The settings with the highest recognition rate, which are also the fastest: outlines, both
  /// directions. The help page explains how it was chosen.
  TAUTLINE_SHAPESKERNEL_EXPORT static RetrievalOptions highest();
};

/// The number of best matches in the class of the query.
struct Recognition
{
  double rate = 0; ///< hits / possible, 0 to 1
  Index hits = 0;
  Index possible = 0;         ///< per query the smaller of `best` and the others in its class
  std::vector<Index> hitsAt;  ///< queries whose k-th best match is of their class
  std::vector<Index> classes; ///< the existing labels, ascending
  /// Row by row: the fractions of the best matches of the queries of one class in each class.
  std::vector<double> confusion;
};

/// The distances between all shapes, and their evaluation.
struct Retrieval
{
  Index count = 0;
  /// Row by row: the distance from a query (row) to a target; 0 to itself, -1 if it was not
  /// computed.
  std::vector<double> distances;
  /// Row by row: the other shapes in order of their distance, count - 1 each.
  std::vector<Index> ranking;
  Recognition recognition;
  std::vector<Index> vertices; ///< number of vertices of the polygon of each shape
  Index matches = 0;           ///< number of matched pairs, counting each direction
  MatchStop stop = MatchStop::Complete;
};

/// The reason why a shape cannot be matched with these options, as an error message, or "".
TAUTLINE_SHAPESKERNEL_EXPORT std::string problemOf(
  const Silhouette& shape, const RetrievalOptions& options);

/**
 * @brief Matches all pairs of shapes.
 *
 * @param labels the class of each shape. Throws Error for fewer than 2 shapes, for a different
 * number of labels, and for options out of range; errors for a shape state its number.
 */
TAUTLINE_SHAPESKERNEL_EXPORT Retrieval retrieveShapes(const std::vector<Silhouette>& shapes,
  const std::vector<Index>& labels, const RetrievalOptions& options);

/**
 * @brief The same on several ranks: each of the n ranks matches every n-th pair. Collective. The
 * first rank receives the result, which equals the serial result; the others receive the stop
 * reason.
 *
 * A time limit, a callback that returns false, or an error on one rank ends the run on all ranks
 * within seconds.
 * @param shapes, labels, options the same on all ranks, except threads, time limit and progress
 */
TAUTLINE_SHAPESKERNEL_EXPORT Retrieval retrieveShapes(RankGroup& group,
  const std::vector<Silhouette>& shapes, const std::vector<Index>& labels,
  const RetrievalOptions& options);

/// Broadcasts the shapes of the first rank to all ranks. Collective. @param own of the first rank;
/// ignored on other ranks
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Silhouette> shapesOfFirst(
  RankGroup& group, const std::vector<Silhouette>& own);

/**
 * @brief Distances after diffusion over the graphs of nearest neighbors (Yang, Koknar-Tezel,
 * Latecki, Locally constrained diffusion process, CVPR 2009).
 *
 * Affinities exp(-(d / s)^2), with s from the mean distances to the neighbors of both shapes, are
 * propagated ten times among the neighbors. Uses no labels.
 * @param distances symmetric, row by row; -1 if not computed: no affinity
 * @param neighbours per shape, at least 1, including the shape itself
 */
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<double> rerank(
  const std::vector<double>& distances, Index count, Index neighbours);

/// The other shapes in order of a row of distances; ties in their original order, missing distances
/// (-1) last.
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Index> rankShapes(
  const std::vector<double>& distances, Index count);

/// Counts hits of a ranking of `count` shapes.
TAUTLINE_SHAPESKERNEL_EXPORT Recognition recognize(
  const std::vector<Index>& ranking, const std::vector<Index>& labels, Index best);
}
#endif
