// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChordSamples.h
 * @brief The distances between the facets of a mesh and the surface on which its points slide, in
 * both directions.
 * Internal: not installed.
 */
#ifndef tautline_ChordSamples_h
#define tautline_ChordSamples_h

#include "ConstrainedPoints.h"

namespace tautline
{
/**
 * @class tautline::ChordSamples
 * @brief Samples at which the distance between a boundary and a surface is measured, in both
 * directions.
 *
 * Even if points are on the surface, the facets between them may cut off its bends. From the mesh,
 * samples on edges and within facets are measured to the patch on which the points slide, and
 * samples on edges along a curve to the curve. Samples of the surface are measured to the last
 * nearest facet and to its neighbors.
 *
 * The limit of each sample is the initial distance of the samples around it plus the tolerance.
 */
class TAUTLINE_KERNEL_EXPORT ChordSamples
{
public:
  /**
   * @param x the initial points. All arguments must outlive this object. Without a model, there are
   * no samples.
   */
  ChordSamples(const Mesh& mesh, const ConstrainedPoints& constrained, const std::vector<Vec3>& x);

  /// A distance as a function of points: the derivative with respect to point k is weights[k] times
  /// the direction.
  struct Distance
  {
    double value = 0;
    Vec3 direction = { 0, 0, 0 }; ///< unit, away from the surface; zero if the distance is 0
    int count = 0;
    std::array<Index, MaxFaceNodes> points = {};
    std::array<double, MaxFaceNodes> weights = {};
  };

  std::size_t size() const { return this->Forward.size() + this->Backward.size(); }
  Distance measure(std::size_t sample, const std::vector<Vec3>& x) const;
  /// The largest allowed distance of a sample.
  double limit(std::size_t sample) const { return this->Limits[sample]; }
  /// The facet of the mesh that contains a sample, or the nearest one.
  std::int32_t facet(std::size_t sample) const
  {
    return sample < this->Forward.size() ? this->Forward[sample].facet
                                         : this->Backward[sample - this->Forward.size()].facet;
  }
  const std::vector<SurfaceFacet>& facets() const { return this->Facets; }
  /// Updates the nearest facet of a surface sample.
  void follow(std::size_t sample, const std::vector<Vec3>& x);

private:
  struct OfMesh
  {
    std::array<Index, MaxFaceNodes> points;
    std::array<double, MaxFaceNodes> weights;
    int count;
    std::int32_t part, facet; ///< part -1: any
  };
  struct OfSurface
  {
    Vec3 place;
    std::int32_t facet;
  };

  void findFacets(const Mesh& mesh);
  std::int32_t patchOf(const SurfaceFacet& facet, const std::vector<Vec3>& x) const;
  std::int32_t curveOf(Index a, Index b, const std::vector<Vec3>& x) const;
  void addForward(const std::vector<Vec3>& x);
  void addWithin(std::int32_t facet);
  void addBackward(const std::vector<Vec3>& x);
  void setLimits(const std::vector<Vec3>& x);
  double toFacet(
    std::int32_t facet, const Vec3& place, const std::vector<Vec3>& x, Distance& best) const;

  const ConstrainedPoints& Constrained;
  std::vector<SurfaceFacet> Facets;
  std::vector<std::int32_t> Patches;                   ///< of the facets
  std::vector<std::int32_t> NeighborStarts, Neighbors; ///< of each facet, including itself
  std::vector<SurfaceProjection> Whole;                ///< one: all facets of the model
  std::vector<OfMesh> Forward;
  std::vector<OfSurface> Backward;
  std::vector<double> Limits;
  double MeanEdge = 0;
};
}
#endif
