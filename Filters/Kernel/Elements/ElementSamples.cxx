// SPDX-License-Identifier: BSD-3-Clause
#include "ElementSamples.h"

#include "TargetForm.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
namespace
{
struct LinePoint
{
  double x, weight;
};

/// Gauss points of [0, 1]: the zeros of a Legendre polynomial, by Newton's method.
std::vector<LinePoint> gaussPoints(int n)
{
  std::vector<LinePoint> points;
  for (int i = 0; i < n; ++i)
  {
    double x = std::cos(Pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step)
    {
      double p = 1, before = 0;
      for (int k = 0; k < n; ++k)
      {
        const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    points.push_back({ 0.5 * (1 - x), 1 / ((1 - x * x) * slope * slope) });
  }
  return points;
}

/// Adds the points whose barycentric coordinates are the permutations of some numbers.
void addOrbit(ElementRule& rule, std::vector<double> barycentric, double weight)
{
  std::sort(barycentric.begin(), barycentric.end());
  do
  {
    Vec3 place = { 0, 0, 0 };
    std::copy(barycentric.begin() + 1, barycentric.end(), place.begin());
    rule.places.push_back(place);
    rule.weights.push_back(weight);
  } while (std::next_permutation(barycentric.begin(), barycentric.end()));
}

ElementRule triangleRule(int points)
{
  ElementRule rule;
  const auto two = [&](double a, double weight) { addOrbit(rule, { a, a, 1 - 2 * a }, weight); };
  switch (points)
  {
    case 3:
      two(1.0 / 6, 1.0 / 3);
      break;
    case 6:
      two(0.44594849091596488632, 0.22338158967801146570);
      two(0.09157621350977074346, 0.10995174365532186764);
      break;
    default:
      two(0.24928674517091042129, 0.11678627572637936603);
      two(0.06308901449150222834, 0.05084490637020681692);
      addOrbit(rule, { 0.05314504984481694735, 0.31035245103378440542, 0.63650249912139864723 },
        0.08285107561837357519);
  }
  return rule;
}

ElementRule tetrahedronRule(int points)
{
  ElementRule rule;
  const auto three = [&](double a, double weight) {
    addOrbit(rule, { a, a, a, 1 - 3 * a }, weight);
  };
  if (points == 4)
  {
    three(0.13819660112501051518, 0.25);
    return rule;
  }
  constexpr double pair = 0.04550370412564964949;
  three(0.31088591926330060980, 0.11268792571801585080);
  three(0.09273525031089122640, 0.07349304311636194934);
  addOrbit(rule, { pair, pair, 0.5 - pair, 0.5 - pair }, 0.04254602077708146643);
  return rule;
}

/// The tensor product of a rule and the points of another axis.
ElementRule extend(const ElementRule& rule, const std::vector<LinePoint>& line, int axis)
{
  ElementRule result;
  for (const LinePoint& point : line)
  {
    for (std::size_t i = 0; i < rule.places.size(); ++i)
    {
      result.places.push_back(rule.places[i]);
      result.places.back()[axis] = point.x;
      result.weights.push_back(rule.weights[i] * point.weight);
    }
  }
  return result;
}

/// @param the number of Gauss points along an axis beyond its order
ElementRule ruleOf(const ElementType& type, int triangle, int tetrahedron, int more)
{
  ElementRule rule = { { { 0, 0, 0 } }, { 1 } };
  const auto line = [&](int axis) { return gaussPoints(type.orders()[axis] + more); };
  switch (type.shape())
  {
    case ElementShape::Triangle:
      return triangleRule(triangle);
    case ElementShape::Tetrahedron:
      return tetrahedronRule(tetrahedron);
    case ElementShape::Wedge:
      return extend(triangleRule(triangle), line(2), 2);
    default:
      for (int axis = 0; axis < type.dimension(); ++axis)
      {
        rule = extend(rule, line(axis), axis);
      }
  }
  if (type.shape() == ElementShape::Pyramid)
  {
    // The volume element of the collapsed cube is (1 - w)^2.
    double sum = 0;
    for (std::size_t i = 0; i < rule.places.size(); ++i)
    {
      const double h = 1 - rule.places[i][2];
      rule.weights[i] *= h * h;
      sum += rule.weights[i];
    }
    for (double& weight : rule.weights)
    {
      weight /= sum;
    }
  }
  return rule;
}

ElementRule equalWeights(std::vector<Vec3> places)
{
  const std::size_t count = places.size();
  return { std::move(places), std::vector<double>(count, 1.0 / static_cast<double>(count)) };
}
}

//------------------------------------------------------------------------------
ElementRule quadratureOf(const ElementType& type)
{
  return ruleOf(type, 12, 14, 2);
}

//------------------------------------------------------------------------------
ElementRule integrationPoints(const ElementType& type)
{
  const bool quadratic = *std::max_element(type.orders().begin(), type.orders().end()) <= 2;
  const bool pyramid = type.shape() == ElementShape::Pyramid;
  return ruleOf(type, quadratic ? 3 : 6, quadratic ? 4 : 14, pyramid ? 0 : 1);
}

//------------------------------------------------------------------------------
ElementRule cornersOf(const ElementType& type)
{
  std::vector<Vec3> places;
  for (const Vec3& place : type.coordinates())
  {
    const auto isEnd = [](double x) { return x == 0 || x == 1; };
    const bool corner = std::all_of(place.begin(), place.end(), isEnd);
    if (corner && !(type.shape() == ElementShape::Pyramid && place[2] == 1))
    {
      places.push_back(place);
    }
  }
  return equalWeights(std::move(places));
}

//------------------------------------------------------------------------------
ElementRule nodesOf(const ElementType& type)
{
  std::vector<Vec3> places;
  for (const Vec3& place : type.coordinates())
  {
    if (!(type.shape() == ElementShape::Pyramid && place[2] == 1))
    {
      places.push_back(place);
    }
  }
  return equalWeights(std::move(places));
}

//------------------------------------------------------------------------------
ElementSamples::ElementSamples(const ElementType& type, ElementRule rule)
  : Rule(std::move(rule))
  , Dimension(type.dimension())
  , Nodes(type.nodes())
  , Form(new ColumnForm(type))
{
  for (const Vec3& place : this->Rule.places)
  {
    const std::vector<Vec3> gradients = this->gradientsAt(place);
    this->Gradients.insert(this->Gradients.end(), gradients.begin(), gradients.end());
  }
}

//------------------------------------------------------------------------------
std::vector<Vec3> ElementSamples::gradientsAt(const Vec3& at) const
{
  const std::vector<long double> values = this->Form->space.valuesAt({ at[0], at[1], at[2] });
  std::vector<Vec3> gradients(this->Nodes, Vec3{ 0, 0, 0 });
  for (int c = 0; c < this->Dimension; ++c)
  {
    for (std::size_t k = 0; k < values.size(); ++k)
    {
      const double* row = this->Form->columns[c].data() + k * this->Nodes;
      for (int node = 0; node < this->Nodes; ++node)
      {
        gradients[node][c] += static_cast<double>(values[k]) * row[node];
      }
    }
  }
  return gradients;
}

//------------------------------------------------------------------------------
std::array<Vec3, 3> ElementSamples::columns(
  const Vec3* gradients, const double* points, const Index* nodes) const
{
  // Relative to the first node, to preserve the precision of small elements far from the origin.
  const double* first = points + 3 * nodes[0];
  std::array<Vec3, 3> columns = { Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 } };
  for (int k = 0; k < this->Nodes; ++k)
  {
    const double* p = points + 3 * nodes[k];
    for (int i = 0; i < 3; ++i)
    {
      const double x = p[i] - first[i];
      for (int c = 0; c < this->Dimension; ++c)
      {
        columns[c][i] += gradients[k][c] * x;
      }
    }
  }
  return columns;
}

//------------------------------------------------------------------------------
std::array<Vec3, 3> ElementSamples::columns(int s, const double* points, const Index* nodes) const
{
  const std::size_t first = static_cast<std::size_t>(s) * this->Nodes;
  return this->columns(this->Gradients.data() + first, points, nodes);
}

//------------------------------------------------------------------------------
std::array<Vec3, 3> ElementSamples::columnsAt(
  const Vec3& at, const double* points, const Index* nodes) const
{
  return this->columns(this->gradientsAt(at).data(), points, nodes);
}

//------------------------------------------------------------------------------
void ElementSamples::determinants(
  const double* points, const Index* nodes, const Vec3& normal, bool mirrored, double* result) const
{
  const bool surface = this->Dimension == 2 && norm(normal) == 0;
  const double sign = mirrored && !surface ? -1 : 1;
  std::vector<Vec3> normals;
  Vec3 mean = normal;
  for (int s = 0; s < this->count(); ++s)
  {
    const std::array<Vec3, 3> a = this->columns(s, points, nodes);
    const Vec3 n = cross(a[0], a[1]);
    if (surface)
    {
      normals.push_back(n);
      mean += this->Rule.weights[s] * n;
    }
    result[s] = sign * (this->Dimension == 3 ? dot(n, a[2]) : dot(n, normal));
  }
  const double length = norm(mean);
  for (std::size_t s = 0; s < normals.size(); ++s)
  {
    result[s] = length > 0 ? dot(normals[s], mean) / length : 0;
  }
}

//------------------------------------------------------------------------------
Vec3 pointOfElement(
  const ElementType& type, const double* points, const Index* nodes, const Vec3& at)
{
  const std::vector<double> values = type.shapeFunctions(at);
  Vec3 point = { 0, 0, 0 };
  for (int k = 0; k < type.nodes(); ++k)
  {
    const double* p = points + 3 * nodes[k];
    point += values[k] * Vec3{ p[0], p[1], p[2] };
  }
  return point;
}

//------------------------------------------------------------------------------
double referenceSizeOf(ElementShape shape)
{
  switch (shape)
  {
    case ElementShape::Triangle:
    case ElementShape::Wedge:
      return 0.5;
    case ElementShape::Tetrahedron:
      return 1.0 / 6;
    case ElementShape::Pyramid:
      return 1.0 / 3;
    default:
      return 1;
  }
}
}
