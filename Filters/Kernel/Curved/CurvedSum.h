// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedSum.h
 * @brief Several energies of curved elements as one function of the points.
 * Internal: not installed.
 */
#ifndef tautline_CurvedSum_h
#define tautline_CurvedSum_h

#include "CurvedEnergy.h"

#include <functional>
#include <memory>

namespace tautline
{
/// One energy. Its value is E, or (E / totalWeight)^(1/p) for a p-mean.
template <int Dim>
struct CurvedTerm
{
  std::unique_ptr<CurvedEnergy<Dim>> energy;
  std::shared_ptr<const SampleFunction<Dim>> function;
  double power = 0; ///< p; 0: no mean
  double totalWeight = 1;

  double outer(double e) const
  {
    return this->power > 0 ? std::pow(e / this->totalWeight, 1 / this->power) : e;
  }
  double slope(double e) const
  {
    return this->power > 0 && e > 0 ? this->outer(e) / (this->power * e) : 1;
  }
};

/// F as a function of the values of the terms; also returns its derivatives if requested.
using CurvedScalarization =
  std::function<double(const std::vector<double>& values, std::vector<double>* slopes)>;

/**
 * @class CurvedSum
 * @brief F(E_1, E_2, ...). Its Hessian is approximated by the sum of the Hessians of the terms,
 * each times dF/dE.
 */
template <int Dim>
class CurvedSum
{
public:
  /// @param scalarize null: the sum
  explicit CurvedSum(std::vector<CurvedTerm<Dim>> terms, CurvedScalarization scalarize = nullptr);

  std::vector<CurvedTerm<Dim>>& terms() { return this->Terms; }

  double value(const std::vector<double>& x);
  double linearize(
    const std::vector<double>& x, std::vector<double>& gradient, std::vector<PointBlock>& diagonal);
  void apply(const std::vector<double>& d, std::vector<double>& product);
  /// The values of the terms at the last argument, for their first items only.
  std::vector<double> values(std::size_t items) const;
  double combined(const std::vector<double>& values) const;

private:
  std::vector<CurvedTerm<Dim>> Terms;
  CurvedScalarization Scalarize;
  std::vector<double> Slopes;
};
}
#endif
