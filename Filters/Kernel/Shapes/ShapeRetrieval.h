// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeRetrieval.h
 * @brief Which of a set of labelled silhouettes are alike: all matches, the ranking and the
 * recognition rate.
 *
 *     const auto options = tautline::RetrievalOptions::highest();
 *     tautline::Retrieval result = tautline::retrieveShapes(shapes, labels, options);
 *     // result.recognition.rate: 1 if the 10 best matches of each are of its own class
 */
#ifndef tautline_ShapeRetrieval_h
#define tautline_ShapeRetrieval_h

#include "OutlineMatch.h"
#include "ShapeMatch.h"

#include "tautline/Core/RankGroup.h"
#include "tautline/ShapesKernelExport.h"

namespace tautline
{
/// What is matched with what.
enum class RetrievalMethod
{
  Image = 0,  ///< polygons with images: matchShape()
  Outline = 1 ///< polygons with outlines, all lengths relative to these: matchOutlines()
};

/// How shapes are compared.
struct RetrievalOptions
{
  RetrievalMethod method = RetrievalMethod::Image;
  OutlineOptions outline; ///< for the method Outline
  /// The sum of both energies of the method Outline is divided by this and the complexities of both
  /// outlines, as simple shapes differ by less. Above 0.
  double complexity = 0.3;
  /// Per shape, the number of others with the nearest signatures that it is matched with; also with
  /// those that have it among theirs. 0: all. For the method Outline.
  Index shortlist = 0;
  /// Distances are replaced by 1 - the shapes' affinity after diffusion over graphs of so many
  /// nearest neighbours (rerank()); 0: they are not. The result then depends on the whole set.
  Index neighbours = 0;
  double spacing = 25.0; ///< of the polygons' vertices, pixels, above 0
  LocationOptions locations;
  MatchOptions match; ///< its threads, timeLimit and progress are those of the whole run
  /// The distance of two shapes is E(a to b) / triangles of a + E(b to a) / triangles of b, rather
  /// than E(a to b): each must be found in the other.
  bool symmetric = false;
  Index best = 10; ///< matches per query that count, at least 1

  /// The dissertation's setting: spacing 25, 30 x 30 grid, a = 4 b, theta = d_max / 3.
  static RetrievalOptions dissertation() { return {}; }
  /// The same with Felzenszwalb's energy and without the centre of mass.
  TAUTLINE_SHAPESKERNEL_EXPORT static RetrievalOptions felzenszwalb();
  /// The setting with the highest recognition rate, and the fastest: outlines, both directions. The
  /// help page explains how it was chosen.
  TAUTLINE_SHAPESKERNEL_EXPORT static RetrievalOptions highest();
};

/// How many of the best matches are of the query's class.
struct Recognition
{
  double rate = 0; ///< hits / possible, 0 to 1
  Index hits = 0;
  Index possible = 0;         ///< per query the smaller of `best` and the others in its class
  std::vector<Index> hitsAt;  ///< queries whose k-th best match is of their class
  std::vector<Index> classes; ///< the labels there are, ascending
  /// Row after row: the fraction of the best matches of the queries of one class that is of each
  /// class.
  std::vector<double> confusion;
};

/// The distances of all shapes from each other, and their evaluation.
struct Retrieval
{
  Index count = 0;
  /// Row after row, the distance of a query (row) to a target; 0 to itself, -1 if it was not
  /// computed.
  std::vector<double> distances;
  /// Row after row, the other shapes in order of their distance: count - 1 each.
  std::vector<Index> ranking;
  Recognition recognition;
  std::vector<Index> vertices; ///< of each shape's polygon
  Index matches = 0;           ///< pairs that were matched, each direction counted
  MatchStop stop = MatchStop::Complete;
};

/// Why a shape cannot be matched with these options, as the message of an error, or "".
TAUTLINE_SHAPESKERNEL_EXPORT std::string problemOf(
  const Silhouette& shape, const RetrievalOptions& options);

/**
 * @brief Matches each of the shapes with each other one.
 *
 * @param labels the class of each shape
 * Throws Error on less than 2 shapes, on another number of labels, and on options out of range;
 * errors with a shape name its number.
 */
TAUTLINE_SHAPESKERNEL_EXPORT Retrieval retrieveShapes(const std::vector<Silhouette>& shapes,
  const std::vector<Index>& labels, const RetrievalOptions& options);

/**
 * @brief The same on ranks: of the pairs that are matched, each rank takes every n-th. Collective.
 * The first rank gets the result, which is that of one rank; the others learn why it ended.
 *
 * A time limit, a callback that returns false and an error of one rank end it on all, within
 * seconds.
 * @param shapes, labels, options the same on all ranks, but for threads, time limit and progress
 */
TAUTLINE_SHAPESKERNEL_EXPORT Retrieval retrieveShapes(RankGroup& group,
  const std::vector<Silhouette>& shapes, const std::vector<Index>& labels,
  const RetrievalOptions& options);

/// The shapes that the first rank has, on all ranks. Collective. @param own of the first rank;
/// those of others do not count
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Silhouette> shapesOfFirst(
  RankGroup& group, const std::vector<Silhouette>& own);

/**
 * @brief Distances after diffusion over the graphs of nearest neighbours (Yang, Koknar-Tezel,
 * Latecki, Locally constrained diffusion process, CVPR 2009).
 *
 * Affinities exp(-(d / s)^2), s from the mean distances to the neighbours of both shapes, are
 * passed on ten times among the neighbours. Uses no labels.
 * @param distances symmetric, row after row; -1 where not computed: no affinity
 * @param neighbours per shape, at least 1; itself is one of them
 */
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<double> rerank(
  const std::vector<double>& distances, Index count, Index neighbours);

/// The others in order of a row of distances; equal ones in their order, those not computed (-1)
/// last.
TAUTLINE_SHAPESKERNEL_EXPORT std::vector<Index> rankShapes(
  const std::vector<double>& distances, Index count);

/// Counts hits of a ranking of `count` shapes.
TAUTLINE_SHAPESKERNEL_EXPORT Recognition recognize(
  const std::vector<Index>& ranking, const std::vector<Index>& labels, Index best);
}
#endif
