// SPDX-License-Identifier: BSD-3-Clause
#include "RotationContinuation.h"

#include "HarmonicMap.h"
#include "tautline/Core/UnionFind.h"

namespace tautline
{
namespace
{
using Group = std::vector<std::int32_t>;

constexpr int Iterations = 1000; // of a harmonic map

double* vertex(std::vector<double>& x, std::int32_t v)
{
  return &x[VertexStride * static_cast<std::size_t>(v)];
}

/// The sum of the extents of a group's bounding box.
template <int Dim>
double extentOf(const Group& group, const double* x)
{
  double sum = 0;
  for (int c = 0; c < Dim; ++c)
  {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::int32_t v : group)
    {
      low = std::min(low, x[VertexStride * static_cast<std::size_t>(v) + c]);
      high = std::max(high, x[VertexStride * static_cast<std::size_t>(v) + c]);
    }
    sum += high - low;
  }
  return sum;
}

/// The fixed vertices in groups connected by edges, in descending order of extent; the members of a
/// group are in vertex order.
template <int Dim>
std::vector<Group> fixedGroups(const SimplexMesh& mesh, const double* x)
{
  const std::int32_t free = mesh.freeVertices(), fixed = mesh.vertices() - free;
  UnionFind sets(fixed);
  for (std::int32_t s = 0; s < mesh.simplices(); ++s)
  {
    const std::int32_t* corner = mesh.corners() + static_cast<std::size_t>(Dim + 1) * s;
    for (int k = 1, last = corner[0]; k <= Dim; ++k)
    {
      if (corner[k] >= free && last >= free)
      {
        sets.join(last - free, corner[k] - free);
      }
      last = corner[k] >= free ? corner[k] : last;
    }
  }
  std::vector<Group> groups;
  std::vector<std::int32_t> groupOf(fixed, -1);
  for (std::int32_t i = 0; i < fixed; ++i)
  {
    const Index root = sets.find(i);
    if (groupOf[root] < 0)
    {
      groupOf[root] = static_cast<std::int32_t>(groups.size());
      groups.emplace_back();
    }
    groups[groupOf[root]].push_back(free + i);
  }
  // In descending order of extent; equal ones in the order of their first vertex.
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    order.emplace_back(-extentOf<Dim>(groups[g], x), g);
  }
  std::sort(order.begin(), order.end());
  std::vector<Group> sorted;
  for (const auto& item : order)
  {
    sorted.push_back(std::move(groups[item.second]));
  }
  return sorted;
}

/// Per vertex: 1 in the group, 0 at the other fixed vertices, harmonic in between.
template <int Dim>
std::vector<double> weightsAround(
  const Group& group, const TangledMesh<Dim>& tangled, double tolerance)
{
  const SimplexMesh& mesh = tangled.mesh();
  std::vector<double> map(static_cast<std::size_t>(VertexStride) * mesh.vertices(), 0.0);
  for (std::int32_t v : group)
  {
    *vertex(map, v) = 1.0;
  }
  harmonicMap<Dim>(mesh, map.data(), tolerance, Iterations, tangled.threads());
  std::vector<double> weights(mesh.vertices());
  for (std::size_t v = 0; v < weights.size(); ++v)
  {
    weights[v] = map[VertexStride * v];
  }
  return weights;
}
}

//------------------------------------------------------------------------------
template <int Dim>
RotationContinuation<Dim>::RotationContinuation(
  const TangledMesh<Dim>& tangled, const double* x, double tolerance)
{
  constexpr std::size_t maxHoles = 8;
  constexpr int steps = Dim == 2 ? 12 : 6; // of a full turn
  const SimplexMesh& mesh = tangled.mesh();
  const std::vector<Group> groups = fixedGroups<Dim>(mesh, x);
  if (groups.size() < 2)
  {
    return;
  }
  std::vector<double> rotated(x, x + static_cast<std::size_t>(VertexStride) * mesh.vertices());
  std::vector<double> map;
  const auto countInvalid = [&](const std::vector<double>& from)
  {
    map = from;
    return harmonicMap<Dim>(mesh, map.data(), tolerance, Iterations, tangled.threads())
      ? tangled.examine(map.data()).invalid
      : std::numeric_limits<Index>::max();
  };
  Index fewest = countInvalid(rotated);
  this->Start = map;
  // The largest group is the outer boundary; the others are holes, tried one after the other.
  for (std::size_t g = 1; g < std::min(maxHoles + 1, groups.size()); ++g)
  {
    AxisRotation rotation;
    for (std::int32_t v : groups[g])
    {
      for (int c = 0; c < Dim; ++c)
      {
        rotation.center[c] +=
          x[VertexStride * static_cast<std::size_t>(v) + c] / static_cast<double>(groups[g].size());
      }
    }
    // Rotations about the center of the hole, in equal steps about each axis.
    AxisRotation chosen = rotation;
    const std::vector<double> before = rotated;
    for (rotation.axis = Dim == 2 ? 2 : 0; rotation.axis < 3; ++rotation.axis)
    {
      for (int step = 1; step < steps && fewest > 0; ++step)
      {
        rotation.angle = 2.0 * Pi * step / steps;
        rotation.angle -= rotation.angle > Pi ? 2.0 * Pi : 0.0;
        std::vector<double> trial = before;
        for (std::int32_t v : groups[g])
        {
          rotation.apply(1.0, vertex(trial, v));
        }
        const Index invalid = countInvalid(trial);
        if (invalid < fewest)
        {
          fewest = invalid;
          this->Start = map;
          rotated = trial;
          chosen = rotation;
        }
      }
    }
    if (chosen.angle != 0)
    {
      this->Holes.push_back({ chosen, weightsAround<Dim>(groups[g], tangled, tolerance) });
    }
  }
}

template <int Dim>
double RotationContinuation<Dim>::largestAngle() const
{
  double largest = 0;
  for (const HoleRotation& hole : this->Holes)
  {
    largest = std::max(largest, std::abs(hole.rotation.angle));
  }
  return largest;
}

template <int Dim>
void RotationContinuation<Dim>::advance(double fraction, double* x) const
{
  for (const HoleRotation& hole : this->Holes)
  {
    for (std::size_t v = 0; v < hole.weights.size(); ++v)
    {
      if (hole.weights[v] != 0)
      {
        hole.rotation.apply(-fraction * hole.weights[v], x + VertexStride * v);
      }
    }
  }
}

template class RotationContinuation<2>;
template class RotationContinuation<3>;
}
