// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BernsteinSearch.h
 * @brief The sign and the minimum of a polynomial in Bernstein form, by branch and bound.
 *
 * A box of the domain whose smallest coefficient is inconclusive is bisected along the edge along
 * which the polynomial bends most; the box with the smallest coefficient is processed first. The
 * bounds converge with the square of the size of the boxes.
 */
#ifndef tautline_BernsteinSearch_h
#define tautline_BernsteinSearch_h

#include "BernsteinSpace.h"

#include <limits>
#include <memory>

namespace tautline
{
class BernsteinHalving;

enum class BernsteinSign : signed char
{
  Negative = -1, ///< somewhere below the negative of the noise
  Zero = 0,      ///< nowhere below that, but somewhere not above the noise
  Positive = 1   ///< above the noise everywhere
};

/// The tolerances for the bounds of a minimum.
struct MinimumTolerance
{
  /// The largest distance of the bounds over the largest absolute coefficient; at least 1e-12.
  double relative = 1e-4;
  /// The search also ends when the lower bound exceeds this level.
  double level = std::numeric_limits<double>::infinity();
};

/// Bounds of the minimum of a polynomial.
struct BernsteinMinimum
{
  double lower = 0;
  double upper = 0;      ///< a value of the polynomial
  Vec3 at = { 0, 0, 0 }; ///< the position of that value
};

/**
 * @class BernsteinSearch
 * @brief Searches polynomials of one space.
 *
 * Has its own memory, which grows up to a few megabytes in hard cases and is kept: use one object
 * per thread. The tables must outlive it.
 */
class TAUTLINE_KERNEL_EXPORT BernsteinSearch
{
public:
  BernsteinSearch(const BernsteinSpace& space, const std::vector<BernsteinBisection>& bisections,
    const std::vector<BernsteinCorner>& corners);
  ~BernsteinSearch();
  BernsteinSearch(BernsteinSearch&&) noexcept;

  /**
   * @param coefficients of the polynomial
   * @param noise bound of the error of each coefficient, at least 0
   */
  BernsteinSign sign(const double* coefficients, double noise);
  BernsteinMinimum minimum(const double* coefficients, const MinimumTolerance& tolerance);

  /// The number of bisections in the last search.
  int splits() const { return this->Splits; }
  /// Whether the last search was conclusive, that is, ended before MaxSplits bisections.
  bool decided() const { return this->Decided; }
  static constexpr int MaxSplits = 4000;

private:
  static constexpr int MaxVertexEntries = 12;
  static constexpr int MaxDirections = 6;

  struct Box
  {
    double least;
    int slot;                                      ///< in Pool
    std::array<double, MaxVertexEntries> vertices; ///< by factor, vertex and coordinate
    /// By direction, about the largest second difference of coefficients.
    std::array<double, MaxDirections> bends;
    int age; ///< bisections since the bends were measured
  };

  Box begin(const double* coefficients);
  void push(const Box& box);
  Box pop();
  void release(const Box& box) { this->Free.push_back(box.slot); }
  double* at(const Box& box) { return this->Pool.data() + box.slot * this->Size; }
  int newSlot();
  /// Halves a box and returns the other half.
  Box split(Box& box);
  void measureBends(Box& box);
  double smallest(const double* c) const;

  std::unique_ptr<BernsteinHalving> Halving;
  const std::vector<BernsteinCorner>& Corners;
  std::size_t Size;
  std::vector<double> Pool;
  std::vector<int> Free;
  std::vector<Box> Heap;
  int Slots = 0;
  int Splits = 0;
  bool Decided = true;
};
}
#endif
