/**
 * @file Warping.h
 * @brief Boundaries that move, for the tests of warping.
 */
#ifndef tautline_Warping_h
#define tautline_Warping_h

#include "Blocks.h"
#include "Check.h"

#include "tautline/Warp.h"

namespace tautline
{
using Field = std::function<Vec3(const Vec3&)>;

/// A displacement at every point: only those of prescribed points may count.
inline std::vector<double> displacements(const MeshData& data, const Field& motion)
{
  std::vector<double> result(data.points.size());
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 d = motion(data.point(i));
    std::copy(d.begin(), d.end(), &result[3 * i]);
  }
  return result;
}

inline Warping warped(const MeshData& data, const Field& motion, const WarpOptions& options)
{
  const Mesh mesh(data.view());
  return Warper(mesh, options).warp(displacements(data, motion).data());
}
}
#endif
