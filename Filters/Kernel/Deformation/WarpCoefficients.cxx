// SPDX-License-Identifier: BSD-3-Clause
#include "WarpCoefficients.h"

#include "tautline/Core/Interruption.h"

#include <Eigen/Dense>

#include <algorithm>

namespace tautline
{
namespace
{
/// Sums below this fraction of the largest are rounding errors: there is no motion along their
/// axis.
constexpr double rounding = 1e-12;

/// Share of the isotropic operator in localGradients().
constexpr double isotropicShare = 1.0 / 20.0;
/// Directions in which a cell extends by less than this fraction have no gradient: the normal of
/// planar cells.
constexpr double flat = 1e-12;

/// The mean displacement of a cell's points, and the squared norm of the gradient.
struct CellMotion
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double gradient = 0.0;

  CellMotion(const MeshView& mesh, Index cell, const double* displacement)
  {
    const auto pointAt = [&mesh](Index at) { return mesh.connectivity[at]; };
    const Index first = mesh.offsets[cell], last = mesh.offsets[cell + 1];
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (Index i = first; i < last; ++i)
    {
      centre += Eigen::Map<const Eigen::Vector3d>(mesh.points + 3 * pointAt(i));
      this->mean += Eigen::Map<const Eigen::Vector3d>(displacement + 3 * pointAt(i));
    }
    const double count = static_cast<double>(std::max<Index>(1, last - first));
    centre /= count;
    this->mean /= count;
    Eigen::Matrix3d extent = Eigen::Matrix3d::Zero(), both = Eigen::Matrix3d::Zero();
    for (Index i = first; i < last; ++i)
    {
      const Eigen::Vector3d x =
        Eigen::Map<const Eigen::Vector3d>(mesh.points + 3 * pointAt(i)) - centre;
      const Eigen::Vector3d u =
        Eigen::Map<const Eigen::Vector3d>(displacement + 3 * pointAt(i)) - this->mean;
      extent += x * x.transpose();
      both += u * x.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(extent);
    for (int k = 0; k < 3; ++k)
    {
      const double size = axes.eigenvalues()[k];
      if (size > flat * axes.eigenvalues()[2])
      {
        this->gradient += (both * axes.eigenvectors().col(k) / size).squaredNorm();
      }
    }
  }
};

template <class Visit>
void forEachPrescribed(const std::vector<unsigned char>& prescribed, const double* displacement,
  const Ranks& ranks, const Visit& visit)
{
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    if (prescribed[i] && ranks.owns(static_cast<Index>(i)))
    {
      visit(Eigen::Map<const Eigen::Vector3d>(displacement + 3 * i));
    }
  }
}

/// Scales the largest sum to 1 and sets sums within the rounding error to 0. False if nothing
/// moves.
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
  const std::vector<unsigned char>& prescribed, const double* displacement, const Ranks& ranks)
{
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  forEachPrescribed(
    prescribed, displacement, ranks, [&sums](const auto& d) { sums += d.cwiseAbs(); });
  ranks.sum(sums.data(), sums.size());
  return normalize(sums) ? SymmetricTensor{ sums[0], sums[1], sums[2], 0, 0, 0 } : IdentityTensor;
}

//------------------------------------------------------------------------------
SymmetricTensor principalDirections(
  const std::vector<unsigned char>& prescribed, const double* displacement, const Ranks& ranks)
{
  // In units of the largest displacement, so that squares neither underflow nor overflow.
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
  const Eigen::Vector3d& values = solver.eigenvalues(); // ascending
  const Eigen::Matrix3d& axes = solver.eigenvectors();

  // The average of |d . e| over the directions e is 2 / pi |d| in a plane and |d| / 2 in space.
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
  // The square root of an eigenvalue within the rounding error is not small: its sum is set to 0.
  for (int k = 0; k < 3; ++k)
  {
    sums[k] = values[k] > rounding * values[2] ? sums[k] : 0.0;
  }
  normalize(sums);
  const Eigen::Matrix3d tensor = axes * sums.asDiagonal() * axes.transpose();
  return { tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(1, 2), tensor(0, 2) };
}

//------------------------------------------------------------------------------
std::vector<double> localGradients(
  const MeshView& mesh, const double* displacement, const Ranks& ranks)
{
  const Index n = mesh.numberOfCells;
  const Index all = ranks.several() ? ranks.mesh().globalCells() : n;
  std::vector<double> tensors(6 * n, 0.0), gradients(n, 0.0);
  double mean = 0.0;
  for (Index cell = 0; cell < n; ++cell)
  {
    pollInterruption(cell);
    const CellMotion motion(mesh, cell, displacement);
    double* t = &tensors[6 * cell];
    std::fill_n(t, 3, 1.0);
    const double length = motion.mean.norm();
    if (length > 0.0)
    {
      const Eigen::Vector3d d = motion.mean / length;
      for (int k = 0; k < 3; ++k)
      {
        t[k] = isotropicShare + d[k] * d[k];
      }
      t[3] = d[0] * d[1];
      t[4] = d[1] * d[2];
      t[5] = d[0] * d[2];
    }
    gradients[cell] = motion.gradient;
    mean += ranks.ownsCell(cell) ? motion.gradient / static_cast<double>(all) : 0.0;
  }
  mean = ranks.sum(mean);
  for (Index cell = 0; cell < n && mean > 0.0; ++cell)
  {
    const double factor = 1.0 + gradients[cell] / mean;
    std::for_each_n(&tensors[6 * cell], 6, [factor](double& x) { x *= factor; });
  }
  return tensors;
}
}
