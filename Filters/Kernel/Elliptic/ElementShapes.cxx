// SPDX-License-Identifier: BSD-3-Clause
#include "ElementShapes.h"

#include <cmath>

namespace tautline
{
namespace
{
/// Gauss points and weights of [0, 1]: zeros of the Legendre polynomial by Newton's method.
std::vector<std::array<double, 2>> gaussRule(int n)
{
  std::vector<std::array<double, 2>> rule(n);
  constexpr int iterations = 50; // from this start a handful suffice
  for (int i = 0; i < n; ++i)
  {
    double x = std::cos(Pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int iteration = 0; iteration < iterations; ++iteration)
    {
      double previous = 1, value = x;
      for (int k = 2; k <= n; ++k)
      {
        const double next = ((2 * k - 1) * x * value - (k - 1) * previous) / k;
        previous = value;
        value = next;
      }
      slope = n * (x * value - previous) / (x * x - 1);
      x -= value / slope;
    }
    rule[i] = { 0.5 * (1 + x), 1 / ((1 - x * x) * slope * slope) };
  }
  return rule;
}

/// Product of (1 - r or r) over the directions, the bits of a corner in the order of `corners`.
void multilinear(
  const int (*corners)[3], int nodes, int dimension, const double* r, ReferencePoint& at)
{
  for (int k = 0; k < nodes; ++k)
  {
    at.value[k] = 1;
    for (int d = 0; d < dimension; ++d)
    {
      at.value[k] *= corners[k][d] ? r[d] : 1 - r[d];
      at.derivative[d][k] = corners[k][d] ? 1 : -1;
      for (int e = 0; e < dimension; ++e)
      {
        at.derivative[d][k] *= e == d ? 1 : corners[k][e] ? r[e] : 1 - r[e];
      }
    }
  }
}

constexpr int cubeCorners[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

/// Shape functions at a place of the unit cube, which is collapsed to the cell; the weight gets the
/// factor of that.
void evaluateShapes(CellType type, const double* u, ReferencePoint& at)
{
  switch (type)
  {
    case CellType::Quadrilateral:
      return multilinear(cubeCorners, 4, 2, u, at);
    case CellType::Hexahedron:
      return multilinear(cubeCorners, 8, 3, u, at);
    case CellType::Pyramid:
    {
      // The upper face of the cube shrinks to the apex; that factor is in the Jacobian itself.
      multilinear(cubeCorners, 4, 2, u, at);
      for (int k = 0; k < 4; ++k)
      {
        at.derivative[2][k] = -at.value[k];
        at.derivative[0][k] *= 1 - u[2];
        at.derivative[1][k] *= 1 - u[2];
        at.value[k] *= 1 - u[2];
      }
      at.value[4] = u[2];
      at.derivative[0][4] = at.derivative[1][4] = 0;
      at.derivative[2][4] = 1;
      return;
    }
    case CellType::Triangle:
    case CellType::Wedge:
    {
      const double s = u[1], r = u[0] * (1 - s);
      const double lambda[3] = { 1 - r - s, r, s }, slope[2][3] = { { -1, 1, 0 }, { -1, 0, 1 } };
      at.weight *= 1 - s;
      const int layers = type == CellType::Wedge ? 2 : 1;
      for (int k = 0; k < 3 * layers; ++k)
      {
        const double along = layers == 1 ? 1 : k < 3 ? 1 - u[2] : u[2];
        at.value[k] = lambda[k % 3] * along;
        at.derivative[0][k] = slope[0][k % 3] * along;
        at.derivative[1][k] = slope[1][k % 3] * along;
        at.derivative[2][k] = layers == 1 ? 0 : k < 3 ? -lambda[k % 3] : lambda[k % 3];
      }
      return;
    }
    default:
    {
      const double t = u[2], s = u[1] * (1 - t), r = u[0] * (1 - u[1]) * (1 - t);
      at.weight *= (1 - u[1]) * (1 - t) * (1 - t);
      at.value = { 1 - r - s - t, r, s, t };
      at.derivative = { { { -1, 1, 0, 0 }, { -1, 0, 1, 0 }, { -1, 0, 0, 1 } } };
    }
  }
}
}

//------------------------------------------------------------------------------
std::vector<ReferencePoint> referenceRule(CellType type, int pointsPerDirection)
{
  const auto gauss = gaussRule(pointsPerDirection);
  const int dimension = topology(type).dimension, n = pointsPerDirection;
  std::vector<ReferencePoint> rule;
  for (int k = 0; k < (dimension == 3 ? n : 1); ++k)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        ReferencePoint at{};
        const double u[3] = { gauss[i][0], gauss[j][0], dimension == 3 ? gauss[k][0] : 0.0 };
        at.weight = gauss[i][1] * gauss[j][1] * (dimension == 3 ? gauss[k][1] : 1.0);
        evaluateShapes(type, u, at);
        rule.push_back(at);
      }
    }
  }
  return rule;
}
}
