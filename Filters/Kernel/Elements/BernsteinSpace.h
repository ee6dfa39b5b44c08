// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BernsteinSpace.h
 * @brief Polynomials in Bernstein form over products of simplices, with multiplication and
 * subdivision.
 *
 * The domain is a product of simplices, the *factors*: a triangle {2}, a square {1, 1}, a
 * tetrahedron {3}, a cube {1, 1, 1}, a wedge {2, 1}. The degree may differ by factor. The values of
 * a polynomial lie between its smallest and its largest Bernstein coefficient, and the coefficient
 * of a corner is its value there.
 */
#ifndef tautline_BernsteinSpace_h
#define tautline_BernsteinSpace_h

#include "tautline/Core/Types.h"

#include <vector>

namespace tautline
{
/// A simplex of dimension 1, 2 or 3 and the degree of the polynomials over it.
struct BernsteinFactor
{
  int dimension = 1;
  int degree = 0;
};

/// The exponents of a Bernstein polynomial by coordinate; for a simplex, without the last one,
/// which is the degree minus their sum.
using BernsteinExponents = std::array<int, 3>;

/**
 * @class BernsteinSpace
 * @brief The Bernstein polynomials of one degree per factor, in a fixed order.
 *
 * The exponent of the first coordinate runs fastest. Up to three coordinates in total.
 */
class TAUTLINE_KERNEL_EXPORT BernsteinSpace
{
public:
  BernsteinSpace() = default;
  explicit BernsteinSpace(std::vector<BernsteinFactor> factors);

  int size() const { return static_cast<int>(this->Exponents.size()); }
  /// The total number of coordinates.
  int dimension() const { return this->Dimension; }
  const std::vector<BernsteinFactor>& factors() const { return this->Factors; }
  /// The position of the first coordinate of a factor.
  int firstCoordinate(int factor) const { return this->First[factor]; }
  /// The number of polynomials over the previous factors: the stride of this factor.
  int stride(int factor) const { return this->Strides[factor]; }

  const BernsteinExponents& exponents(int k) const { return this->Exponents[k]; }
  int indexOf(const BernsteinExponents& exponents) const;
  /// The exponent of a vertex of a factor: the exponent of its coordinate or, for vertex 0 (the
  /// origin), the degree minus the sum of the others.
  int vertexExponent(int factor, int vertex, const BernsteinExponents& exponents) const;
  /// The product of the multinomial coefficients of the factors.
  double multinomial(int k) const { return this->Multinomials[k]; }

  /// The values of all polynomials at a point.
  std::vector<long double> valuesAt(const std::array<long double, 3>& at) const;

  /// The space of the products of polynomials of two spaces over the same factors.
  BernsteinSpace times(const BernsteinSpace& other) const;

private:
  std::vector<BernsteinFactor> Factors;
  std::vector<int> First, Strides;
  std::vector<BernsteinExponents> Exponents;
  std::vector<double> Multinomials;
  int Dimension = 0;
};

/**
 * @brief Where the products of scaled coefficients are added: the product of first[i] and second[j]
 * to targets(i)[j].
 *
 * A *scaled* coefficient is the coefficient times its multinomial; the product of two polynomials
 * is then the plain convolution of their scaled coefficients.
 */
class BernsteinProduct
{
public:
  BernsteinProduct() = default;
  BernsteinProduct(
    const BernsteinSpace& first, const BernsteinSpace& second, const BernsteinSpace& product);

  /// The targets of first[i], one per coefficient of the second space.
  const std::uint16_t* targets(int i) const { return this->Targets.data() + i * this->Second; }
  /// The largest number of products added to one coefficient.
  int terms() const { return this->Terms; }

private:
  std::vector<std::uint16_t> Targets;
  int Second = 0;
  int Terms = 0;
};

/**
 * @brief The lines of coefficients that de Casteljau's algorithm halves when a domain is bisected
 * at the middle of an edge of one of its factors.
 *
 * The vertices `from` and `to` of a factor are the ends of the edge. A line begins at a coefficient
 * with exponent 0 of `to`, and each step moves one from the exponent of `from` to the exponent of
 * `to`.
 */
struct BernsteinBisection
{
  int factor = 0;
  int from = 0, to = 1;
  /// The number of lines of equal length that are contiguous in memory: each entry of `lines`
  /// stands for this many.
  int width = 1;
  int longest = 0;          ///< coefficients of the longest line
  std::vector<int> begins;  ///< of line l: entries [begins[l], begins[l + 1]), longest lines first
  std::vector<int> entries; ///< positions of coefficients
};

/// One for each edge of each factor with a degree above 0.
TAUTLINE_KERNEL_EXPORT std::vector<BernsteinBisection> bisections(const BernsteinSpace& space);

/// A corner of the domain.
struct BernsteinCorner
{
  int coefficient = 0;
  std::array<int, 3> vertex = { 0, 0, 0 }; ///< by factor
};

TAUTLINE_KERNEL_EXPORT std::vector<BernsteinCorner> corners(const BernsteinSpace& space);
}
#endif
