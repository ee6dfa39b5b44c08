// SPDX-License-Identifier: BSD-3-Clause
#include "PieceMotion.h"

#include "MovableMesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
constexpr double NotGiven = std::numeric_limits<double>::infinity();

/// Takes the smallest of the values that the pieces give for a point.
/// @param given 3 per point of the piece
void takeLeast(
  const MovableMesh& mesh, const std::vector<double>& given, double amount, PieceMotion& motion)
{
  const Index points = mesh.distributed().localPoints();
  std::vector<double> component, negative;
  component.resize(given.size() / 3);
  negative.resize(component.size());
  motion.displacement.assign(3 * points, 0.0);
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t p = 0; p < component.size(); ++p)
    {
      component[p] = given[3 * p + c];
      negative[p] = component[p] == NotGiven ? NotGiven : -component[p];
    }
    const std::vector<double> least = mesh.leastOf(component, NotGiven);
    const std::vector<double> most = mesh.leastOf(negative, NotGiven);
    for (Index p = 0; p < points; ++p)
    {
      if (least[p] != NotGiven)
      {
        motion.farthest = std::max(motion.farthest, -most[p] - least[p]);
        motion.displacement[3 * p + c] = amount * least[p];
      }
    }
  }
  motion.farthest = mesh.group().maximum(motion.farthest);
}
}

//------------------------------------------------------------------------------
Index countOwned(const DistributedMesh& mesh, const PointFlags& flags)
{
  Index count = 0;
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    count += flags[p] != 0 && mesh.owned(p);
  }
  return mesh.group().sum(count);
}

//------------------------------------------------------------------------------
double diagonalOf(const DistributedMesh& mesh)
{
  const std::array<double, 6>& box = mesh.bounds();
  return norm({ box[3] - box[0], box[4] - box[1], box[5] - box[2] });
}

//------------------------------------------------------------------------------
PieceMotion motionOfPieces(const MovableMesh& mesh, const PointFlags& chosen, double amount,
  const std::function<Vec3(Index)>& displacementOf)
{
  const Index points = mesh.piece().numberOfPoints;
  const std::vector<Index>& localOf = mesh.distributed().localOfPiece();
  PieceMotion motion;
  std::vector<double> given;
  PointFlags broken;
  given.assign(3 * points, NotGiven);
  broken.assign(points, 0);
  for (Index p = 0; p < points; ++p)
  {
    if (localOf[p] < 0 || !chosen[localOf[p]])
    {
      continue;
    }
    const Vec3 d = displacementOf(p);
    broken[p] = !std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2]);
    std::copy(d.begin(), d.end(), &given[3 * p]);
  }
  motion.broken = countOwned(mesh.distributed(), mesh.anyOf(broken));
  if (motion.broken == 0)
  {
    takeLeast(mesh, given, amount, motion);
  }
  return motion;
}

//------------------------------------------------------------------------------
std::vector<double> localPoints(const MovableMesh& mesh, const std::vector<double>& ofPiece)
{
  const Index points = mesh.distributed().localPoints();
  std::vector<double> local, component;
  local.resize(3 * points);
  component.resize(ofPiece.size() / 3);
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t p = 0; p < component.size(); ++p)
    {
      component[p] = ofPiece[3 * p + c];
    }
    const std::vector<double> values = mesh.leastOf(component, NotGiven);
    for (Index p = 0; p < points; ++p)
    {
      local[3 * p + c] = values[p];
    }
  }
  return local;
}

//------------------------------------------------------------------------------
void PlacedPoints::exchange()
{
  std::swap_ranges(this->Other.begin(), this->Other.end(), this->Placed.points().begin());
}
}
