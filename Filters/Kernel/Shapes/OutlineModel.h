// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutlineModel.h
 * @brief The outline of a silhouette, independent of its size, with descriptors along it, for
 * matchOutlines().
 */
#ifndef tautline_OutlineModel_h
#define tautline_OutlineModel_h

#include "Silhouette.h"
#include "tautline/ShapesKernelExport.h"

#include <vector>

namespace tautline
{
/**
 * @brief The energy of outlines and their sampling. All lengths are fractions of the outline
 * length.
 *
 * Vertices are placed on the locations of the other outline in order: every edge advances by 1 /
 * stretch to stretch times its own length.
 */
struct OutlineOptions
{
  double spacing = 0.04;    ///< of the polygon's vertices, 0.01 to 0.25
  Index locations = 64;     ///< on the outline for the vertices, 16 to 512
  double smoothing = 0.003; ///< standard deviation of the Gaussian along the outline, above 0
  double stretch = 2.0;     ///< bound on the growth of the outline part of an edge, above 1
  double deformation = 2.0; ///< weight of log(alpha / beta)^2 of the triangles, at least 0
  double distortion = 1.0;  ///< weight of |log| of the growth of their edge lengths, at least 0
  double ordering = 1.0;    ///< weight of |log(advance / expected)| of the edges, at least 0
  double descriptor = 60.0; ///< weight of the differences of descriptors, at least 0
  double region = 0.25;     ///< share of the disks in a descriptor, the rest are heights; 0 to 1
  bool mirrored = true;     ///< whether to use the better of a shape and its mirror image
  /// Whether to use bounds that skip placements that cannot be the best. The result is the same
  /// without them.
  bool bounds = true;
};

/// An outline to match. Vertices run counterclockwise; locations are equidistant.
struct OutlineModel
{
  /// A triangulated polygon with descriptors along its edges.
  struct Polygon
  {
    PolygonMesh mesh;
    std::vector<double> advance;    ///< of each edge, in locations
    std::vector<float> descriptors; ///< DescriptorSamples per edge
  };
  Polygon polygon, mirror;      ///< its mirror image, for `mirrored`
  std::vector<float> x, y;      ///< of the locations, in units of the outline length; twice around
  std::vector<float> distances; ///< by advance, then by start: rows as long as x
  /// At the locations and midway between them: first number at all positions, then the next.
  std::vector<float> descriptors;
  /// Mean standard deviation of the heights, relative to their maximum: small for a disk.
  double complexity = 0;
  std::vector<float> signature; ///< for a shortlist: quantiles of the descriptors
};

/// The numbers in a descriptor: 19 heights of the outline above its tangent, areas in 4 disks, and
/// the distance from the center of mass.
constexpr Index OutlineHeights = 19, OutlineRegions = 5;
constexpr Index OutlineChannels = OutlineHeights + OutlineRegions;
/// Points of each edge of a polygon at which descriptors are compared.
constexpr Index DescriptorSamples = 3;

/**
 * @brief Prepares a silhouette: smooths the outline, scales its length to 1, starts it at the point
 * farthest from the center of mass, and places the polygon vertices and the locations.
 *
 * The heights are measured for the other points of the outline above the tangent at a point, in
 * order along the outline, averaged over twentieths of it and relative to their maximum (Wang, Bai,
 * You, Liu, Latecki, Shape matching and classification using height functions, Pattern Recognition
 * Letters 33, 2012). The heights and the disks do not change if the shape is moved, rotated or
 * scaled.
 *
 * Throws Error for options out of range and for an outline without area.
 */
TAUTLINE_SHAPESKERNEL_EXPORT OutlineModel prepareOutline(
  const Silhouette& shape, const OutlineOptions& options);

/// A distance of signatures, for shortlists: a sum of |differences|, at negligible cost. Symmetric.
TAUTLINE_SHAPESKERNEL_EXPORT double signatureDistance(const OutlineModel& a, const OutlineModel& b);
}
#endif
