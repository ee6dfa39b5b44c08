// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JacobianCertifier.h
 * @brief Certifies the validity of elements of any shape and order over the whole element.
 *
 * An element is valid if its Jacobian determinant is positive everywhere in the closed reference
 * element. The smallest Bernstein coefficient proves it for most elements, several of which are
 * processed at once; subdivision decides the others. Each verdict accounts for rounding errors:
 * values closer to 0 than the error bound are degenerate.
 *
 * A two-dimensional element lies either in a plane, where its determinant has a sign, or on a
 * surface in space. An element of a surface is valid if its normal does not vanish: if the normal
 * has a positive component along the mean normal everywhere or, failing that, if its square is
 * positive everywhere.
 */
#ifndef tautline_JacobianCertifier_h
#define tautline_JacobianCertifier_h

#include "BernsteinSearch.h"
#include "ElementType.h"

#include <memory>

namespace tautline
{
enum class ElementValidity : signed char
{
  Valid = 1,      ///< the determinant is positive everywhere
  Degenerate = 0, ///< it vanishes somewhere (up to rounding) and is negative nowhere
  Invalid = -1,   ///< it is negative somewhere
  NonFinite = -3  ///< a coordinate is NaN or infinite
};

/// The minimum of the Jacobian determinant over an element.
struct JacobianBound
{
  ElementValidity validity = ElementValidity::Valid;
  /// Bounds of the minimum; for a surface, of the component of the normal along the mean normal.
  double lower = 0, upper = 0;
  /// Reference coordinates where the determinant has the value `upper`, up to rounding; for a
  /// pyramid, in the collapsed cube.
  Vec3 at = { 0, 0, 0 };
};

/// The work of a certifier.
struct CertificateCounts
{
  Index elements = 0;
  Index searched = 0;  ///< elements that needed subdivision to determine the sign
  Index splits = 0;    ///< bisections in total
  Index undecided = 0; ///< degenerate only because a search ended after BernsteinSearch::MaxSplits
};

/**
 * @class JacobianCertifier
 * @brief Judges elements of one type.
 *
 * Has its own memory and allocates none per element: use one object per thread. The type must
 * outlive it.
 */
class TAUTLINE_KERNEL_EXPORT JacobianCertifier
{
public:
  /**
   * @param type of the elements
   * @param normal of planar elements: the unit normal for which counterclockwise elements are
   * valid; {0, 0, 0}, the default, for a surface. Not used for solids.
   * @param mirrored whether each element is treated as its mirror image, whose determinant has the
   * opposite sign; see orientationOf(). Ignored for surfaces.
   */
  explicit JacobianCertifier(
    const ElementType& type, const Vec3& normal = { 0, 0, 0 }, bool mirrored = false);
  ~JacobianCertifier();
  JacobianCertifier(JacobianCertifier&&) noexcept;
  JacobianCertifier(const JacobianCertifier&) = delete;
  void operator=(const JacobianCertifier&) = delete;

  /**
   * @brief Proves for each element whether it is valid.
   * @param points three coordinates each
   * @param elements the nodes of each element: type.nodes() point indices
   * @param count of the elements
   * @param validity the result, one per element
   */
  void classify(
    const double* points, const Index* const* elements, Index count, ElementValidity* validity);

  /// Bounds of the minimum of the determinant over one element, and its validity. If a coordinate
  /// is not finite, the bounds are NaN.
  JacobianBound minimum(const double* points, const Index* nodes,
    const MinimumTolerance& tolerance = MinimumTolerance());

  /// The mean of the coefficients of the determinant; for all elements except pyramids, the volume
  /// or area divided by the value for the reference element. For a surface, the length of the mean
  /// normal.
  double meanJacobian(const double* points, const Index* nodes);

  const CertificateCounts& counts() const { return this->Counts; }

private:
  struct Work;

  void classifyBatch(
    const double* points, const Index* const* elements, int count, ElementValidity* validity);
  ElementValidity search(const double* coefficients, double noise);
  ElementValidity searchSurface();
  ElementValidity searchSquare();

  std::unique_ptr<Work> Memory;
  CertificateCounts Counts;
};

/// The numbers of elements of a block with positive and negative mean Jacobians.
struct ElementOrientation
{
  Index positive = 0, negative = 0;

  /// Whether most elements are reversed, so that the block must be treated as its mirror image.
  bool mirrored() const { return this->negative > this->positive; }
};

/**
 * @brief The orientation of a block, by the signs of the mean Jacobians of its elements.
 *
 * Needed for wedges: files use two node orders, since VTK, up to version 9.6, draws the triangle 0
 * 1 2 of a wedge clockwise as seen from the other one but computes with it counterclockwise.
 *
 * @param normal as in JacobianCertifier
 */
TAUTLINE_KERNEL_EXPORT ElementOrientation orientationOf(const ElementType& type,
  const double* points, const Index* const* elements, Index count,
  const Vec3& normal = { 0, 0, 0 });
}
#endif
