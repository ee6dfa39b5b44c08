// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferPoints.h
 * @brief Transfers point values to another mesh by a limited L2 projection.
 * Internal: not installed.
 */
#ifndef tautline_TransferPoints_h
#define tautline_TransferPoints_h

#include "TransferOverlaps.h"
#include "TransferTotals.h"

#include <vector>

namespace tautline
{
/**
 * @class tautline::PointProjection
 * @brief Projects several components at once; see FieldTransfer.h. Both sides are integrated over
 * the intersection of the meshes, so that constants are exact even where it is only part of a
 * simplex.
 */
class PointProjection
{
public:
  /// @param fields per component one value per point of the source
  PointProjection(const TransferMesh& target, const TransferMesh& source,
    const TransferOverlaps& overlaps, const std::vector<std::vector<double>>& fields, int threads);

  /// The share of the intersection at each target point; 0: the point has no value.
  const std::vector<double>& common() const { return this->Common; }

  /// The values of a component; 0 where common() is 0.
  BoundedValues apply(std::size_t component) const;

private:
  template <int N>
  void integrate(Index simplex);
  void assemble();
  std::vector<double> solve(const std::vector<double>& side, std::vector<double> start) const;
  void limit(const std::vector<double>& high, BoundedValues& field) const;

  const TransferMesh &Target, &Source;
  const TransferOverlaps& Overlaps;
  const std::vector<std::vector<double>>& Fields;
  int Threads;
  /// Per simplex of the target: the matrix of masses, and for each field the right side and the
  /// extremes.
  std::vector<double> Masses, Sides, Lows, Highs;
  std::vector<Index> UseStarts, Uses; ///< per point of the target: corners + 1 times simplex + k
  std::vector<Index> Starts, Columns; ///< the mass matrix in rows
  std::vector<double> Entries, Common;
};

/// The area or volume that belongs to each point: an equal part of each of its simplices.
std::vector<double> sharesOfPoints(const TransferMesh& mesh);
}
#endif
