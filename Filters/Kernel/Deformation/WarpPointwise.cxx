// SPDX-License-Identifier: BSD-3-Clause
#include "WarpPointwise.h"

#include "tautline/Core/Parallel.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace tautline
{
namespace
{
/// Second moments of the prescribed points below this fraction of the largest are treated as 0: the
/// points lie in a plane or on a line.
constexpr double RankTolerance = 1e-14;
/// Relative to the largest displacement: a residual below this is rounding error of an affine
/// motion.
constexpr double AffineTolerance = 1e-14;
}

//------------------------------------------------------------------------------
PrescribedMotion::PrescribedMotion(const Mesh& mesh, const std::vector<unsigned char>& prescribed,
  const double* displacement, int threads, std::vector<WallPoint> walls)
  : Input(mesh)
  , Displacement(displacement)
  , Threads(threads)
  , Walls(std::move(walls))
{
  const MeshView& view = mesh.view();
  for (Index id = 0; id < view.numberOfPoints; ++id)
  {
    (prescribed[static_cast<std::size_t>(id)] ? this->Prescribed : this->Free).push_back(id);
  }
  std::sort(this->Prescribed.begin(), this->Prescribed.end(),
    [this](Index a, Index b)
    {
      const Vec3 p = pointOf(this->Input.view(), a), q = pointOf(this->Input.view(), b);
      return p != q ? p < q : this->displacementOf(a) < this->displacementOf(b);
    });
  const std::size_t n = this->Prescribed.size();
  if (n == 0)
  {
    return;
  }

  this->measure();
  this->fitAffine();
  this->Rest.resize(n);
  double largestRest = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    const Index id = this->Prescribed[i];
    this->Rest[i] = this->displacementOf(id) - this->affineAt(this->local(id));
    largestRest = std::max(largestRest, norm(this->Rest[i]));
  }
  this->Affine = largestRest <= AffineTolerance * this->Largest;
}

//------------------------------------------------------------------------------
/// The unit of length, the extent of the prescribed points, and the origin, their mean.
void PrescribedMotion::measure()
{
  const MeshView& view = this->Input.view();
  const Vec3 first = pointOf(view, this->Prescribed[0]);
  Vec3 low = first, high = first, sum = { 0, 0, 0 };
  for (const Index id : this->Prescribed)
  {
    const Vec3 p = pointOf(view, id);
    sum += p - first;
    for (std::size_t k = 0; k < 3; ++k)
    {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
    this->Largest = std::max(this->Largest, norm(this->displacementOf(id)));
  }
  this->Center = first + (1.0 / static_cast<double>(this->Prescribed.size())) * sum;
  const double extent = norm(high - low);
  this->Scale = extent > 0 ? extent : 1.0;
}

//------------------------------------------------------------------------------
/// Least squares with the pseudo-inverse of the second moments: if the points do not determine an
/// affine motion, this gives the smallest one.
void PrescribedMotion::fitAffine()
{
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Index id : this->Prescribed)
  {
    const Vec3 x = this->local(id);
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        moments(i, j) += x[static_cast<std::size_t>(i)] * x[static_cast<std::size_t>(j)];
      }
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments);
  std::array<Vec3, 3> inverse = {};
  for (int k = 0; k < 3; ++k)
  {
    if (eigen.eigenvalues()[k] > RankTolerance * eigen.eigenvalues()[2])
    {
      const Vec3 v = { eigen.eigenvectors()(0, k), eigen.eigenvectors()(1, k),
        eigen.eigenvectors()(2, k) };
      for (std::size_t i = 0; i < 3; ++i)
      {
        inverse[i] += (v[i] / eigen.eigenvalues()[k]) * v;
      }
    }
  }
  // The second pass corrects the rounding error of the first.
  for (int pass = 0; pass < 2; ++pass)
  {
    std::array<Vec3, 4> sums = {};
    for (const Index id : this->Prescribed)
    {
      const Vec3 x = this->local(id), r = this->displacementOf(id) - this->affineAt(x);
      sums[0] += r;
      for (std::size_t k = 0; k < 3; ++k)
      {
        sums[k + 1] += x[k] * r;
      }
    }
    this->Map[0] += (1.0 / static_cast<double>(this->Prescribed.size())) * sums[0];
    for (std::size_t k = 0; k < 3; ++k)
    {
      for (std::size_t l = 0; l < 3; ++l)
      {
        this->Map[k + 1] += inverse[k][l] * sums[l + 1];
      }
    }
  }
}

//------------------------------------------------------------------------------
Vec3 PrescribedMotion::local(Index id) const
{
  return (1 / this->Scale) * (pointOf(this->Input.view(), id) - this->Center);
}

//------------------------------------------------------------------------------
Vec3 PrescribedMotion::displacementOf(Index id) const
{
  const double* d = this->Displacement + 3 * id;
  return { d[0], d[1], d[2] };
}

//------------------------------------------------------------------------------
Vec3 PrescribedMotion::affineAt(const Vec3& local) const
{
  return this->Map[0] + local[0] * this->Map[1] + local[1] * this->Map[2] + local[2] * this->Map[3];
}

//------------------------------------------------------------------------------
std::vector<double> PrescribedMotion::displacements(const std::vector<Vec3>& rest) const
{
  std::vector<double> result(3 * static_cast<std::size_t>(this->Input.view().numberOfPoints));
  const auto put = [&](Index id, const Vec3& d) { std::copy(d.begin(), d.end(), &result[3 * id]); };
  for (const Index id : this->Prescribed)
  {
    std::copy_n(this->Displacement + 3 * id, 3, &result[3 * id]);
  }
  forEachChunk(static_cast<Index>(this->Free.size()), this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Index id = this->Free[i];
        put(id, this->affineAt(this->local(id)) + (rest.empty() ? Vec3{ 0, 0, 0 } : rest[i]));
      }
    });
  return result;
}
}
