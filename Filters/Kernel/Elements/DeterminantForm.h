// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeterminantForm.h
 * @brief The Jacobian determinant of an element in Bernstein form, as a product of polynomials.
 *
 * With x the map and u, v, w the reference coordinates, det = x_u . (x_v x x_w), and the normal of
 * a surface is x_u x x_v. The derivatives are differences of control points, and a product is a
 * convolution of scaled coefficients: all its weights are positive, so that rounding errors remain
 * small multiples of |x_u| |x_v| |x_w|.
 *
 * In the collapsed cube of a pyramid, x_u and x_v have the factor 1 - w, which is left out: in
 * scaled form, this only drops the coefficients at w = 1, which vanish. The determinant is then
 * taken with respect to the coordinates of the pyramid itself, and is bounded at the apex for each
 * direction of approach.
 *
 * A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite elements",
 * J. Comput. Phys. 233 (2013); A. Johnen, C. Geuzaine, "Geometrical validity of curvilinear
 * pyramidal finite elements", J. Comput. Phys. 299 (2015).
 */
#ifndef tautline_DeterminantForm_h
#define tautline_DeterminantForm_h

#include "BernsteinSpace.h"

namespace tautline
{
/// A sparse matrix in compressed rows.
struct ControlMatrix
{
  std::vector<int> offsets = { 0 };
  std::vector<int> columns;
  std::vector<double> values;
  double norm = 0; ///< largest sum of the absolute values of a row
  int longest = 0; ///< entries of the longest row

  int rows() const { return static_cast<int>(this->offsets.size()) - 1; }
};

/// A derivative of the map with respect to one coordinate.
struct DerivativeForm
{
  /// One coefficient: scaled = scale (control[high] - control[low]).
  struct Difference
  {
    int high, low;
    double scale;     ///< the multinomial
    double magnitude; ///< the coefficient itself, over that difference of control points
  };
  BernsteinSpace space;
  std::vector<Difference> differences;
};

struct DeterminantForm
{
  DeterminantForm() = default;
  /// @param pyramid whether the space belongs to a collapsed cube
  DeterminantForm(const BernsteinSpace& map, bool pyramid);

  std::vector<DerivativeForm> derivatives; ///< by coordinate
  BernsteinSpace cofactors;                ///< of x_v x x_w; in two dimensions not used
  BernsteinProduct cross;                  ///< x_v times x_w; in two dimensions x_u times x_v
  BernsteinProduct dot;                    ///< x_u times cofactors
  BernsteinSpace space;                    ///< of the determinant, or of the normal of a surface
  /// Converts the scaled product of the differences into coefficients: the degrees over the
  /// multinomials of `space`.
  std::vector<double> factors;
  std::vector<BernsteinBisection> bisections; ///< of `space`
  std::vector<BernsteinCorner> corners;       ///< of `space`
  /// Only for surfaces: the space of the squared normal.
  BernsteinSpace squareSpace;
  BernsteinProduct square;
  std::vector<BernsteinBisection> squareBisections;
  std::vector<BernsteinCorner> squareCorners;
  /// The number of roundings of one coefficient, for error bounds.
  int roundings = 0;
};
}
#endif
