// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetForm.h
 * @brief The columns of A and of T = A W^-1 of an element in Bernstein form, and ideal elements.
 * Internal: not installed.
 */
#ifndef tautline_TargetForm_h
#define tautline_TargetForm_h

#include "ElementType.h"

namespace tautline
{
/// A matrix of up to 3 x 3 numbers, row by row.
using ElementMatrix = std::array<Vec3, 3>;

/// W^-1 of the ideal element with respect to the reference element; for a pyramid, to the one that
/// is not collapsed. In 2D, the leading 2 x 2 block.
ElementMatrix idealInverseOf(ElementShape shape);

/// det W^-1.
double idealDeterminantOf(ElementShape shape);

/// A space with the same factors and, for each factor, the larger degree.
BernsteinSpace unionOf(const BernsteinSpace& a, const BernsteinSpace& b);

/// Converts polynomials of one space to another space of at least the same degrees.
class BernsteinElevation
{
public:
  BernsteinElevation() = default;
  BernsteinElevation(const BernsteinSpace& from, const BernsteinSpace& to);

  /// @param scaled the coefficients times their multinomials
  /// @param coefficients in the larger space, not scaled
  void run(const double* scaled, double* coefficients) const;

private:
  BernsteinProduct Product;
  std::vector<double> One, Factors;
  int Size = 0;
  bool Same = false;
};

/// The derivatives of the map with respect to the coordinates of the reference element (for a
/// pyramid, the coordinates that are not collapsed), all in one space.
struct ColumnForm
{
  explicit ColumnForm(const ElementType& type);

  BernsteinSpace space;
  /// By coordinate: the matrix from nodes to coefficients.
  std::vector<std::vector<double>> columns;

  /// Linear combinations of the columns, scaled by the multinomials, as a matrix from nodes to
  /// coefficients.
  ControlMatrix combine(const Vec3& weights, int nodes) const;
};
}
#endif
