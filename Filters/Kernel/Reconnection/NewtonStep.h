// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NewtonStep.h
 * @brief The step of a point to the minimum of a quadratic model.
 * Internal: not installed.
 */
#ifndef tautline_NewtonStep_h
#define tautline_NewtonStep_h

#include "StarSmoothing.h"

#include <Eigen/Dense>

namespace tautline
{
inline Eigen::Vector3d toEigen(const Vec3& v)
{
  return { v[0], v[1], v[2] };
}

inline Vec3 fromEigen(const Eigen::Vector3d& v)
{
  return { v[0], v[1], v[2] };
}

/// Newton's step in the free directions of a point; along the gradient if that is not a descent
/// direction.
inline Vec3 newtonStep(Eigen::Vector3d g, Eigen::Matrix3d h, const PointFreedom& freedom)
{
  using Eigen::Matrix3d;
  if (freedom.kind != PointFreedom::Free)
  {
    const Eigen::Vector3d n = toEigen(freedom.direction);
    const Matrix3d along = n * n.transpose();
    const Matrix3d allowed =
      freedom.kind == PointFreedom::OnLine ? along : Matrix3d(Matrix3d::Identity() - along);
    g = allowed * g;
    h = Matrix3d(allowed * h * allowed) +
      h.trace() * (Matrix3d::Identity() - allowed); // no step in the other directions
  }
  Eigen::Vector3d step = -h.ldlt().solve(g);
  if (!step.allFinite() || step.dot(g) >= 0.0)
  {
    step = -g / h.trace();
  }
  return freedom.project(fromEigen(step));
}
}
#endif
