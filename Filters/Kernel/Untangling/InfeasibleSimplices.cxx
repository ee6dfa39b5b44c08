// SPDX-License-Identifier: BSD-3-Clause
#include "InfeasibleSimplices.h"

#include "LinearProgram.h"

namespace tautline
{
namespace
{
/// A free vertex and a simplex whose other vertices are fixed.
using Held = std::pair<std::int32_t, std::int32_t>;

/// The positions of a free vertex at which a simplex is valid, relative to the vertex.
template <int Dim>
struct ValidSide
{
  HalfSpace<Dim> space;
  std::int32_t simplex;
};

/// The simplices with one free vertex that is active, sorted by the vertex.
template <int Dim>
std::vector<Held> heldSimplices(
  const TangledMesh<Dim>& tangled, const std::vector<unsigned char>& active)
{
  const SimplexMesh& mesh = tangled.mesh();
  const std::int32_t free = mesh.freeVertices();
  std::vector<Held> held;
  for (std::int32_t s = 0; s < mesh.simplices(); ++s)
  {
    const std::int32_t* corner = mesh.corners() + static_cast<std::size_t>(Dim + 1) * s;
    std::int32_t v = -1;
    int others = 0;
    for (int k = 0; k <= Dim; ++k)
    {
      v = corner[k] < free ? corner[k] : v;
      others += corner[k] >= free;
    }
    if (others == Dim && active[v] && !tangled.infeasible(s))
    {
      held.emplace_back(v, s);
    }
  }
  std::sort(held.begin(), held.end());
  return held;
}

/// d! times the signed volume of a simplex with these corners.
template <int Dim>
double signedVolume(const double (&e)[Dim + 1][Dim])
{
  double a[3][3] = { {}, {}, { 0, 0, 1 } };
  for (int k = 0; k < Dim; ++k)
  {
    for (int c = 0; c < Dim; ++c)
    {
      a[k][c] = e[k + 1][c] - e[0][c];
    }
  }
  return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
    a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
    a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/**
 * @brief The half-space of positions of v, with a normal of length 1, in which the simplex is
 * valid.
 * @param reach becomes at least the largest coordinate of the corners relative to v
 * @return false if no position makes it valid: the fixed vertices are collinear or coplanar
 */
template <int Dim>
bool validSide(const SimplexMesh& mesh, const double* x, std::int32_t v, std::int32_t simplex,
  HalfSpace<Dim>& space, double& reach)
{
  const double* center = x + VertexStride * static_cast<std::size_t>(v);
  const std::int32_t* corner = mesh.corners() + static_cast<std::size_t>(Dim + 1) * simplex;
  double e[Dim + 1][Dim];
  int at = 0;
  for (int k = 0; k <= Dim; ++k)
  {
    at = corner[k] == v ? k : at;
    for (int c = 0; c < Dim; ++c)
    {
      e[k][c] = x[VertexStride * static_cast<std::size_t>(corner[k]) + c] - center[c];
      reach = std::max(reach, std::abs(e[k][c]));
    }
  }
  // The volume is linear in v: its values at v and at one step along each axis determine it.
  space.b = signedVolume<Dim>(e);
  double length = 0;
  for (int c = 0; c < Dim; ++c)
  {
    e[at][c] = 1.0;
    space.a[c] = space.b - signedVolume<Dim>(e);
    e[at][c] = 0.0;
    length += space.a[c] * space.a[c];
  }
  length = std::sqrt(length);
  if (!(length > 0))
  {
    return false;
  }
  space.b /= length;
  for (double& a : space.a)
  {
    a /= length;
  }
  return true;
}

/// Removes the most violated of contradicting half-spaces, until the rest is feasible.
template <int Dim>
void removeContradicting(
  std::vector<ValidSide<Dim>>& sides, double reach, std::vector<std::int32_t>& removed)
{
  constexpr double far = 100, noPlace = 1e-9;
  while (sides.size() > 1)
  {
    std::vector<HalfSpace<Dim>> spaces;
    for (const ValidSide<Dim>& side : sides)
    {
      spaces.push_back(side.space);
    }
    std::array<double, Dim> center;
    if (chebyshevCenter<Dim>(spaces, far * reach, center) > noPlace * reach)
    {
      break;
    }
    std::size_t worst = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < sides.size(); ++i)
    {
      double distance = sides[i].space.b;
      for (int c = 0; c < Dim; ++c)
      {
        distance -= sides[i].space.a[c] * center[c];
      }
      if (distance < smallest)
      {
        smallest = distance;
        worst = i;
      }
    }
    removed.push_back(sides[worst].simplex);
    sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}
}

//------------------------------------------------------------------------------
template <int Dim>
std::vector<std::int32_t> findInfeasible(
  const TangledMesh<Dim>& tangled, const double* x, const std::vector<unsigned char>& active)
{
  const std::vector<Held> held = heldSimplices<Dim>(tangled, active);
  std::vector<std::int32_t> infeasible;
  for (std::size_t begin = 0, end = 0; begin < held.size(); begin = end)
  {
    std::vector<ValidSide<Dim>> sides;
    double reach = 0;
    const std::int32_t v = held[begin].first;
    for (; end < held.size() && held[end].first == v; ++end)
    {
      ValidSide<Dim> side;
      side.simplex = held[end].second;
      if (validSide<Dim>(tangled.mesh(), x, v, side.simplex, side.space, reach))
      {
        sides.push_back(side);
      }
      else
      {
        infeasible.push_back(side.simplex);
      }
    }
    removeContradicting<Dim>(sides, reach, infeasible);
  }
  return infeasible;
}

template std::vector<std::int32_t> findInfeasible<2>(
  const TangledMesh<2>&, const double*, const std::vector<unsigned char>&);
template std::vector<std::int32_t> findInfeasible<3>(
  const TangledMesh<3>&, const double*, const std::vector<unsigned char>&);
}
