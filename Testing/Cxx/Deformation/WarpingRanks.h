// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpingRanks.h
 * @brief Warp Mesh on processes and on one of them, for tests.
 */
#ifndef tautline_WarpingRanks_h
#define tautline_WarpingRanks_h

#include "../Core/MotionRanks.h"
#include "WarpingMeshes.h"

namespace tautline
{
/// A block with a hole, whose points inside are moved at random; the hole turns.
inline MeshData blockWithHole(CellType type)
{
  const bool flat = topology(type).dimension == 2;
  const Index n = flat ? 7 : 5;
  MeshData data = holedBlock(type, n);
  const std::vector<int> parts = partsOf(data, n);
  Random random(5);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 d = random.vector(-0.1, 0.1);
    if (parts[i] == 0)
    {
      data.setPoint(i, data.point(i) + Vec3{ d[0], d[1], flat ? 0 : d[2] });
    }
  }
  return data;
}

inline void turn(vtkMeshWarp* filter, double angle)
{
  TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(angle));
}

/// The result of one process, without the others.
template <class Set>
std::vector<double> alone(
  vtkMPIController* controller, const MeshData& whole, const Set& set, vtkMeshWarp* filter)
{
  vtkMultiProcessController::SetGlobalController(nullptr);
  const auto all = [](Index) { return 0; };
  std::vector<double> points = pointsOf(whole, partOf(whole, 0, all), set, filter);
  vtkMultiProcessController::SetGlobalController(controller);
  return points;
}

inline double farthest(const std::vector<double>& here, const std::vector<double>& expected)
{
  double far = 0;
  for (std::size_t i = 0; i < here.size(); ++i)
  {
    far = here[i] == HUGE_VAL ? far : std::max(far, std::abs(here[i] - expected[i]));
  }
  return far;
}
}
#endif
