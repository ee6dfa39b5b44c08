// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeTarget.h
 * @brief The tables that a target prepares for its matches.
 * Internal: not installed.
 */
#ifndef tautline_ShapeTarget_h
#define tautline_ShapeTarget_h

#include "ShapeDescriptors.h"
#include "ShapeModel.h"

namespace tautline
{
/**
 * @brief Locations for a vertex, in slots; rows of slots begin at multiples of the packet width.
 *
 * On a grid, a row is a row of the grid; otherwise, a row is one packet.
 */
struct LocationSet
{
  Index rows = 0;
  Index rowLength = 0; ///< slots per row, a multiple of the packet width
  Index columns = 0;   ///< number of used slots of a row, on a grid
  bool grid = false;   ///< whether this is a whole regular grid
  Vec2 step = {};      ///< of the grid
  std::vector<float> x, y;
  std::vector<Index> used;  ///< slots with a location, ascending
  std::vector<Index> slots; ///< slot of each location
  std::vector<Vec2> points; ///< of the locations

  Index size() const { return this->rows * this->rowLength; }
  Index locationOf(Index slot) const;
  static LocationSet list(const std::vector<Vec2>& points);
  static LocationSet lattice(const Vec2& first, const Vec2& step, Index columns, Index rows);
};

/// Rows of floats, one per slot of one set, over the slots of another.
struct PairTable
{
  Index rows = 0, columns = 0;
  std::vector<float> values;

  PairTable() = default;
  PairTable(Index rows, Index columns, float value)
    : rows(rows)
    , columns(columns)
    , values(static_cast<std::size_t>(rows * columns), value)
  {
  }
  float* row(Index i) { return this->values.data() + i * this->columns; }
  const float* row(Index i) const { return this->values.data() + i * this->columns; }
};

/// The data of a target that matches need, computed once.
struct ShapeTarget::Data
{
  ShapeEnergy energy;
  Index width = 0, height = 0;
  int threads = 0;
  std::vector<float> cost;      ///< 1 / (lambda + |grad I|) per pixel
  std::vector<float> gradientX; ///< for directed edges
  std::vector<float> gradientY;
  LocationSet locations;
  LocationSet coarse; ///< every third location
  PairTable edges;    ///< edge cost from slot to slot
  PairTable coarseEdges;
  std::vector<Descriptor> descriptors; ///< per location
  std::vector<double> arc;             ///< of contour locations, 0 to 1
  std::vector<Index> coarseOf;         ///< location number of each coarse one
  Vec2 centre = {};
  double maxDistance = 0;
  double perimeter = 0;
  Vec2 gridStep = {}; ///< spacing of the locations, for coarse to fine

  void computeCosts(const std::vector<float>& image);
  void chooseLocations(const Silhouette& shape, const LocationOptions& options);
  void chooseCoarse();
  /// The mean of the edge cost along the segment from p to q, in pixels.
  double edgeCost(const Vec2& p, const Vec2& q) const;
  /// The edge costs from each location of a to each one of b.
  PairTable edgeTable(const LocationSet& a, const LocationSet& b) const;
};
}
#endif
