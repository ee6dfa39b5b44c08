// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedGuard.h
 * @brief Certifies curved elements while their points move.
 * Internal: not installed.
 */
#ifndef tautline_CurvedGuard_h
#define tautline_CurvedGuard_h

#include "CurvedEnergy.h"
#include "tautline/Elements/JacobianCertifier.h"

#include <map>

namespace tautline
{
/// A location in an element where the Jacobian determinant is too small.
struct WeakPlace
{
  Index element;
  Vec3 at;
};

class CurvedGuard
{
public:
  /// @param elements must outlive this object
  CurvedGuard(const std::vector<CurvedElement>& elements, int dimension, int threads);

  /// The locations of the smallest determinants of the invalid elements.
  std::vector<WeakPlace> invalid(const std::vector<double>& x) const;

  /**
   * @brief The locations of the smallest determinants that the samples do not represent: at most 0,
   * or below LeastShare times the minimum over the samples of the element.
   * @param sampled by element, see CurvedEnergy::leastJacobians()
   * @param lower null, or receives a lower bound of the smallest determinant of each element
   */
  std::vector<WeakPlace> notRepresented(const std::vector<double>& x,
    const std::vector<double>& sampled, std::vector<double>* lower = nullptr) const;
  static constexpr double LeastShare = 0.2;
  /// The weight of an added sample location, as a fraction of its element.
  static constexpr double PlaceShare = 0.2;

private:
  template <class Judge>
  std::vector<WeakPlace> find(const std::vector<double>& x, const Judge& judge) const;

  const std::vector<CurvedElement>& Elements;
  int Threads;
  Vec3 Normal;
  std::map<std::pair<const ElementType*, bool>, std::vector<Index>> Groups;
};
}
#endif
