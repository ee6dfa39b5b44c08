// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChordSamples.h
 * @brief How far the facets of a mesh are from the surface its points slide on, and that surface
 * from the facets.
 * Internal: not installed.
 */
#ifndef tautline_ChordSamples_h
#define tautline_ChordSamples_h

#include "ConstrainedPoints.h"

namespace tautline
{
/**
 * @class tautline::ChordSamples
 * @brief Places at which the distance of a boundary from a surface is measured, both ways.
 *
 * Points may be on the surface and the facets between them cut off its bends. From the mesh, places
 * on the edges and within the facets are measured to the patch that the points slide on, places on
 * edges along a curve to the curve. Places all over the surface are measured to the facet that was
 * the nearest last, and to its neighbors.
 *
 * Each sample may be as far as the samples about it were at the start, plus the tolerance.
 */
class TAUTLINE_KERNEL_EXPORT ChordSamples
{
public:
  /**
   * @param x the points of the start
   * All must outlive this. Without a model there are no samples.
   */
  ChordSamples(const Mesh& mesh, const ConstrainedPoints& constrained, const std::vector<Vec3>& x);

  /// A distance, by the points that it depends on: the derivative by point k is weights[k] times
  /// the direction.
  struct Distance
  {
    double value = 0;
    Vec3 direction = { 0, 0, 0 }; ///< unit, away from the surface; zero where the distance is 0
    int count = 0;
    std::array<Index, MaxFaceNodes> points = {};
    std::array<double, MaxFaceNodes> weights = {};
  };

  std::size_t size() const { return this->Forward.size() + this->Backward.size(); }
  Distance measure(std::size_t sample, const std::vector<Vec3>& x) const;
  /// How far a sample may be.
  double limit(std::size_t sample) const { return this->Limits[sample]; }
  /// The facet of the mesh that a sample is on, or that is the nearest.
  std::int32_t facet(std::size_t sample) const
  {
    return sample < this->Forward.size() ? this->Forward[sample].facet
                                         : this->Backward[sample - this->Forward.size()].facet;
  }
  const std::vector<SurfaceFacet>& facets() const { return this->Facets; }
  /// Goes on to the facet that is the nearest now, if the sample is of the surface.
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
  std::vector<std::int32_t> NeighborStarts, Neighbors; ///< of each facet, itself too
  std::vector<SurfaceProjection> Whole;                ///< one: all facets of the model
  std::vector<OfMesh> Forward;
  std::vector<OfSurface> Backward;
  std::vector<double> Limits;
  double MeanEdge = 0;
};
}
#endif
