// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BernsteinHalving.h
 * @brief Bisects boxes of the domain of Bernstein polynomials and chooses the directions.
 * Internal: not installed.
 */
#ifndef tautline_BernsteinHalving_h
#define tautline_BernsteinHalving_h

#include "BernsteinSpace.h"
#include "ElementShape.h"

namespace tautline
{
/**
 * @class BernsteinHalving
 * @brief De Casteljau's algorithm on the coefficients of one space, and the geometry of the halves.
 *
 * A *direction* is an edge of a factor. Immutable; the tables must outlive it.
 */
class BernsteinHalving
{
public:
  BernsteinHalving(const BernsteinSpace& space, const std::vector<BernsteinBisection>& bisections);

  static constexpr int MaxDirections = 6;
  static constexpr int MaxVertexEntries = 12;
  /// The vertices of a box by factor, vertex and coordinate.
  using Vertices = std::array<double, MaxVertexEntries>;
  /// A measure by direction.
  using Measures = std::array<double, MaxDirections>;

  int directions() const { return static_cast<int>(this->Directions.size()); }
  /// The degree of the polynomials along a direction.
  int degree(int direction) const;
  /// The vertices of the whole domain.
  const Vertices& domain() const { return this->Domain; }
  Vec3 place(const Vertices& vertices, const BernsteinCorner& corner) const;

  /// Halves coefficients: `c` keeps the half at the vertex `from`, `other` receives the other half.
  void halve(int direction, double* c, double* other) const;
  void halve(int direction, Vertices& kept, Vertices& other) const;

  /// The largest absolute second difference of coefficients along a direction.
  double bend(int direction, const double* c) const;
  /// The largest absolute difference of neighboring coefficients along a direction.
  double slope(int direction, const double* c) const;
  /// Estimates measures that are quadratic in the size for both halves of a box with the measures
  /// `kept`.
  void estimate(int direction, Measures& kept, Measures& other) const;

private:
  static constexpr int Lanes = 8;

  /// Lines that are halved together, one per lane, longest first.
  struct Group
  {
    int length;                  ///< of the longest line
    std::size_t entries;         ///< in Entries: Lanes per row, positions of coefficients
    std::size_t mirrored;        ///< in Entries: the same from the other end of each line
    std::size_t counts;          ///< in Entries: by row, the number of lines that are that long
    std::array<int, Lanes> last; ///< the last row of each line
  };
  /// One edge of a factor.
  struct Direction
  {
    const BernsteinBisection* lines;
    std::vector<Group> groups; ///< where the lines are not wide
    int vertices;              ///< where the vertices of the factor begin in Vertices
    int dimension;             ///< of the factor
  };

  void addGroups(Direction& direction);
  template <int Reach, class Difference>
  double largest(const Direction& direction, const double* c, const Difference& difference) const;
  void estimateOne(const Direction& halved, Measures& measures, int kept, int moved) const;
  static void halveRows(const BernsteinBisection& lines, double* c, double* other);
  void halveGroup(const Group& group, double* c, double* other) const;

  const BernsteinSpace& Space;
  std::vector<Direction> Directions;
  std::vector<int> Entries;
  Vertices Domain = {};
  std::vector<int> FirstVertex; ///< by factor
};
}
#endif
