#include "WarpCoefficients.h"

#include <Eigen/Dense>

namespace tautline
{
namespace
{
/// Sums below this fraction of the largest are rounding: nothing moves along their axis.
constexpr double rounding = 1e-12;

template <class Visit>
void forEachPrescribed(const std::vector<unsigned char>& prescribed, const double* displacement,
  const WarpRanks& ranks, const Visit& visit)
{
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    if (prescribed[i] && ranks.owns(static_cast<Index>(i)))
    {
      visit(Eigen::Map<const Eigen::Vector3d>(displacement + 3 * i));
    }
  }
}

/// Scales the largest sum to 1 and sets those that are rounding to 0. False if nothing moves.
bool normalize(Eigen::Vector3d& sums)
{
  const double largest = sums.maxCoeff();
  if (!(largest > 0))
  {
    return false;
  }
  for (int k = 0; k < 3; ++k)
  {
    sums[k] = sums[k] > rounding * largest ? sums[k] / largest : 0.0;
  }
  return true;
}
}

//------------------------------------------------------------------------------
SymmetricTensor displacementSums(
  const std::vector<unsigned char>& prescribed, const double* displacement, const WarpRanks& ranks)
{
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  forEachPrescribed(
    prescribed, displacement, ranks, [&sums](const auto& d) { sums += d.cwiseAbs(); });
  ranks.sum(sums.data(), sums.size());
  return normalize(sums) ? SymmetricTensor{ sums[0], sums[1], sums[2], 0, 0, 0 } : IdentityTensor;
}

//------------------------------------------------------------------------------
SymmetricTensor principalDirections(
  const std::vector<unsigned char>& prescribed, const double* displacement, const WarpRanks& ranks)
{
  // In units of the largest displacement, so that squares neither vanish nor overflow.
  double largest = 0;
  forEachPrescribed(prescribed, displacement, ranks,
    [&largest](const auto& d) { largest = std::max(largest, d.cwiseAbs().maxCoeff()); });
  largest = ranks.maximum(largest);
  if (!(largest > 0))
  {
    return IdentityTensor;
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  forEachPrescribed(prescribed, displacement, ranks,
    [&](const auto& d) { moments += (d / largest) * (d / largest).transpose(); });
  ranks.sum(moments.data(), moments.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  const Eigen::Vector3d values = solver.eigenvalues(); // ascending
  const Eigen::Matrix3d axes = solver.eigenvectors();

  // The average of |d . e| over the directions e of a plane is 2 / pi |d|, of space |d| / 2.
  constexpr double coincide = 1e-6;
  constexpr double average[4] = { 0, 1, 2 / Pi, 0.5 };
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (int first = 0; first < 3;)
  {
    int end = first + 1;
    while (end < 3 && values[end] - values[end - 1] <= coincide * values[2])
    {
      ++end;
    }
    double sum = 0;
    forEachPrescribed(prescribed, displacement, ranks,
      [&](const auto& d)
      {
        double length2 = 0;
        for (int k = first; k < end; ++k)
        {
          const double along = axes.col(k).dot(d) / largest;
          length2 += along * along;
        }
        sum += std::sqrt(length2);
      });
    sum = ranks.sum(sum);
    for (int k = first; k < end; ++k)
    {
      sums[k] = average[end - first] * sum;
    }
    first = end;
  }
  // An eigenvalue that is rounding has a square root that is not small: its sum is set to 0.
  for (int k = 0; k < 3; ++k)
  {
    sums[k] = values[k] > rounding * values[2] ? sums[k] : 0.0;
  }
  normalize(sums);
  const Eigen::Matrix3d tensor = axes * sums.asDiagonal() * axes.transpose();
  return { tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(1, 2), tensor(0, 2) };
}
}
