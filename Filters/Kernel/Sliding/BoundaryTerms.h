// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryTerms.h
 * @brief The energy that keeps points in their bands, and facets and surface close to each other.
 * Internal: not installed.
 */
#ifndef tautline_BoundaryTerms_h
#define tautline_BoundaryTerms_h

#include "ChordSamples.h"

namespace tautline
{
/**
 * @class tautline::BoundaryTerms
 * @brief A sum of squares of the excesses of distances over their bounds, in units of a tenth of
 * the tolerance: for points beyond half of the tolerance, and for samples near their limit.
 *
 * For each term, an upper bound of the distance is kept: as long as this plus the motion since then
 * is within the bound, nothing is measured.
 */
class TAUTLINE_KERNEL_EXPORT BoundaryTerms
{
public:
  /// The constraints must outlive this object. @param x the initial points, which set the limits
  BoundaryTerms(const Mesh& mesh, const ConstrainedPoints& constrained, const std::vector<Vec3>& x);

  /// moveTo() sets the current points; value() evaluates other, nearby points.
  void moveTo(const std::vector<Vec3>& x);
  /// The energy of all terms whose points may move, see select().
  double value(const std::vector<Vec3>& x) const;
  /// Adds the terms at the points to a model. @param local the number of a point in the model, or
  /// -1
  void add(const std::vector<std::int32_t>& local, QuadraticModel& model) const;

  /// Selects the terms of flagged points from now on.
  void select(const std::vector<char>& flags);
  /// Flags the points in a band beyond the cost-free distance, and the points of samples beyond
  /// their limits.
  void flagBeyond(std::vector<char>& flags) const;
  /// Prepares allows() and moveOne().
  void indexSamples();
  /// Whether the samples of a point are acceptable at x, where only this point has moved: within
  /// their limits, or not farther than now.
  bool allows(Index p, const std::vector<Vec3>& x) const;
  /// The same as moveTo() if only this point has moved.
  void moveOne(Index p, const std::vector<Vec3>& x);
  /// Whether all terms are within their bounds: samples within their limits, points within the
  /// distance at the start and the tolerance.
  bool isWithin() const;
  /// The largest distance of a point from its part in excess of the initial distance; at least 0.
  double farthestPoint() const;

  /// From now on, samples beyond their limits may keep their distance, but not increase it.
  void allowWhatIs();
  /// Multiplies the energy from now on.
  void strengthen(double factor) { this->Weight *= factor; }
  void setWeight(double weight) { this->Weight = weight; }
  double weight() const { return this->Weight; }
  const ChordSamples& samples() const { return this->Samples; }

private:
  /// A point in its band.
  struct Banded
  {
    Index point;
    double atStart, upper;
  };
  double stiffness() const;
  double freeBand() const;
  double bound(std::size_t sample) const;
  void findMotion(const std::vector<Vec3>& x, std::vector<double>& ofFacets) const;
  Vec3 offPart(Index p, const std::vector<Vec3>& x) const;

  const ConstrainedPoints& Constrained;
  ChordSamples Samples;
  std::vector<Vec3> X;
  std::vector<Banded> Bands;
  std::vector<double> Upper; ///< per sample
  /// per sample: its limit, or its current distance
  std::vector<double> Allowed;
  std::vector<std::size_t> Points;                 ///< selected: indices in Bands
  std::vector<std::size_t> Chords;                 ///< selected samples
  std::vector<std::int32_t> Facets;                ///< selected
  std::vector<std::vector<std::size_t>> ChordsAt;  ///< of each facet, for allows()
  std::vector<std::vector<std::int32_t>> FacetsAt; ///< of each point
  std::vector<Index> BandAt;                       ///< of each point: index in Bands, or -1
  double Weight = 1;
};
}
#endif
