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
  constexpr int iterations = 50; // a few suffice from this start
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

/// The product of (1 - r or r) over the directions; the bits of a corner are in the order of
/// `corners`.
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

constexpr int simplexEdges[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };

/// Quadratic shape functions of a simplex: 2 l^2 - l at corners, 4 l m on edges, of barycentric
/// coordinates.
void quadratic(int dimension, const std::array<double, 4>& lambda, ReferencePoint& at)
{
  const auto slope = [](int d, int corner) { return corner == 0 ? -1.0 : corner == d + 1; };
  const int corners = dimension + 1, edges = dimension == 2 ? 3 : 6;
  for (int k = 0; k < corners; ++k)
  {
    at.value[k] = lambda[k] * (2 * lambda[k] - 1);
    for (int d = 0; d < dimension; ++d)
    {
      at.derivative[d][k] = (4 * lambda[k] - 1) * slope(d, k);
    }
  }
  for (int e = 0; e < edges; ++e)
  {
    const int a = simplexEdges[e][0], b = simplexEdges[e][1];
    at.value[corners + e] = 4 * lambda[a] * lambda[b];
    for (int d = 0; d < dimension; ++d)
    {
      at.derivative[d][corners + e] = 4 * (lambda[a] * slope(d, b) + lambda[b] * slope(d, a));
    }
  }
}

/// Adds the node at the center of a triangle, whose function 27 l m n vanishes on the boundary, and
/// subtracts from the other functions their values there: -1/9 and 4/9.
void addBubble(const std::array<double, 4>& l, ReferencePoint& at)
{
  const double bubble = l[0] * l[1] * l[2];
  const double slope[2] = { l[2] * (l[0] - l[1]), l[1] * (l[0] - l[2]) };
  constexpr double factors[7] = { 3, 3, 3, -12, -12, -12, 27 };
  for (int k = 0; k < 7; ++k)
  {
    at.value[k] += factors[k] * bubble;
    at.derivative[0][k] += factors[k] * slope[0];
    at.derivative[1][k] += factors[k] * slope[1];
  }
}

/// The shape functions of a quadratic simplex at reference coordinates.
void quadraticSimplex(ElementKind kind, double r, double s, double t, ReferencePoint& at)
{
  const int dimension = kind == ElementKind::QuadraticTetrahedron ? 3 : 2;
  const std::array<double, 4> lambda = { 1 - r - s - t, r, s, t };
  quadratic(dimension, lambda, at);
  if (kind == ElementKind::BubbleTriangle)
  {
    addBubble(lambda, at);
  }
}

/// Shape functions at a point of the unit cube, which is collapsed to the cell; the weight includes
/// the factor of the collapse.
void evaluateShapes(ElementKind kind, const double* u, ReferencePoint& at)
{
  switch (kind)
  {
    case ElementKind::Quadrilateral:
      return multilinear(cubeCorners, 4, 2, u, at);
    case ElementKind::Hexahedron:
      return multilinear(cubeCorners, 8, 3, u, at);
    case ElementKind::Pyramid:
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
    case ElementKind::Triangle:
    case ElementKind::Wedge:
    {
      const double s = u[1], r = u[0] * (1 - s);
      const double lambda[3] = { 1 - r - s, r, s }, slope[2][3] = { { -1, 1, 0 }, { -1, 0, 1 } };
      at.weight *= 1 - s;
      const int layers = kind == ElementKind::Wedge ? 2 : 1;
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
    case ElementKind::QuadraticTriangle:
    case ElementKind::BubbleTriangle:
      at.weight *= 1 - u[1];
      return quadraticSimplex(kind, u[0] * (1 - u[1]), u[1], 0, at);
    default:
    {
      const double t = u[2], s = u[1] * (1 - t), r = u[0] * (1 - u[1]) * (1 - t);
      at.weight *= (1 - u[1]) * (1 - t) * (1 - t);
      if (kind == ElementKind::QuadraticTetrahedron)
      {
        return quadraticSimplex(kind, r, s, t, at);
      }
      at.value = { 1 - r - s - t, r, s, t };
      at.derivative = { { { -1, 1, 0, 0 }, { -1, 0, 1, 0 }, { -1, 0, 0, 1 } } };
    }
  }
}

/// Points of a simplex rule in barycentric coordinates: one coordinate differs (or two, for pairs
/// on a tetrahedron), in all positions.
class SimplexRule
{
public:
  explicit SimplexRule(ElementKind kind)
    : Kind(kind)
    , Dimension(kind == ElementKind::QuadraticTetrahedron ? 3 : 2)
  {
  }

  /// @param weight of a reference cell of size 1
  void addCenter(double weight) { this->add(weight, { 1, 1, 1, 1 }); }

  /// All coordinates except one are `value`.
  void addCorners(double weight, double value)
  {
    for (int k = 0; k <= this->Dimension; ++k)
    {
      std::array<double, 4> lambda = { value, value, value, value };
      lambda[k] = 1 - this->Dimension * value;
      this->add(weight, lambda);
    }
  }

  /// Two of four coordinates are `value`, the others are 1/2 - `value`.
  void addEdges(double weight, double value)
  {
    for (const auto& edge : simplexEdges)
    {
      std::array<double, 4> lambda = { value, value, value, value };
      lambda[edge[0]] = lambda[edge[1]] = 0.5 - value;
      this->add(weight, lambda);
    }
  }

  std::vector<ReferencePoint> points;

private:
  void add(double weight, std::array<double, 4> lambda)
  {
    const bool solid = this->Dimension == 3;
    lambda[3] = solid ? lambda[3] : 0.0;
    const double sum = lambda[0] + lambda[1] + lambda[2] + lambda[3];
    ReferencePoint at{};
    at.weight = weight / (solid ? 6 : 2);
    quadraticSimplex(this->Kind, lambda[1] / sum, lambda[2] / sum, lambda[3] / sum, at);
    this->points.push_back(at);
  }

  ElementKind Kind;
  int Dimension;
};

constexpr struct
{
  int nodes, dimension;
} kindFacts[NumberOfElementKinds] = { { 3, 2 }, { 4, 2 }, { 4, 3 }, { 8, 3 }, { 6, 3 }, { 5, 3 },
  { 6, 2 }, { 7, 2 }, { 10, 3 } };
}

//------------------------------------------------------------------------------
ElementKind elementKind(int vtkType, Index nodes)
{
  // VTK's codes; Lagrange cells have the nodes of linear and quadratic ones in the same order.
  constexpr int quadraticTriangle = 22, quadraticTetrahedron = 24, biquadraticTriangle = 34,
                lagrangeTriangle = 69, lagrangeTetrahedron = 71;
  switch (vtkType)
  {
    case quadraticTriangle:
    case biquadraticTriangle:
    case lagrangeTriangle:
      return nodes == 3 && vtkType == lagrangeTriangle ? ElementKind::Triangle
        : nodes == 6 && vtkType != biquadraticTriangle ? ElementKind::QuadraticTriangle
        : nodes == 7 && vtkType != quadraticTriangle   ? ElementKind::BubbleTriangle
                                                       : ElementKind::None;
    case quadraticTetrahedron:
    case lagrangeTetrahedron:
      return nodes == 4 && vtkType == lagrangeTetrahedron ? ElementKind::Tetrahedron
        : nodes == 10                                     ? ElementKind::QuadraticTetrahedron
                                                          : ElementKind::None;
    default:
      return isHigherOrder(vtkType)
        ? ElementKind::None
        : static_cast<ElementKind>(topologyIndex(static_cast<CellType>(vtkType)));
  }
}

//------------------------------------------------------------------------------
int nodesOf(ElementKind kind)
{
  return kind == ElementKind::None ? 0 : kindFacts[static_cast<int>(kind)].nodes;
}

//------------------------------------------------------------------------------
std::vector<ReferencePoint> elementRule(ElementKind kind)
{
  SimplexRule rule(kind);
  switch (kind)
  {
    case ElementKind::Triangle:
    case ElementKind::Tetrahedron:
    {
      std::vector<ReferencePoint> one = referenceRule(kind, 1);
      one[0].weight = topologies()[static_cast<int>(kind)].sizePerDeterminant;
      return one;
    }
    case ElementKind::QuadraticTriangle:
    {
      const double root = std::sqrt(15.0);
      rule.addCenter(9.0 / 40);
      rule.addCorners((155 - root) / 1200, (6 - root) / 21);
      rule.addCorners((155 + root) / 1200, (6 + root) / 21);
      return rule.points;
    }
    case ElementKind::QuadraticTetrahedron:
      rule.addCorners(0.11268792571801585, 0.3108859192633006);
      rule.addCorners(0.07349304311636194, 0.09273525031089123);
      rule.addEdges(0.04254602077708147, 0.04550370412564965);
      return rule.points;
    case ElementKind::BubbleTriangle:
      return referenceRule(kind, 4);
    default:
      return referenceRule(kind, 2);
  }
}

//------------------------------------------------------------------------------
std::vector<ReferencePoint> centerRule(ElementKind kind)
{
  if (!isQuadratic(kind))
  {
    return referenceRule(kind, 1);
  }
  SimplexRule rule(kind);
  rule.addCenter(1);
  return rule.points;
}

//------------------------------------------------------------------------------
std::vector<ReferencePoint> referenceRule(ElementKind kind, int pointsPerDirection)
{
  const auto gauss = gaussRule(pointsPerDirection);
  const int dimension = kindFacts[static_cast<int>(kind)].dimension, n = pointsPerDirection;
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
        evaluateShapes(kind, u, at);
        rule.push_back(at);
      }
    }
  }
  return rule;
}
}
