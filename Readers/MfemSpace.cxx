// SPDX-License-Identifier: BSD-3-Clause
#include "MfemSpace.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tautline
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// The Legendre polynomial of a degree at least 1 at x in [-1, 1], and its derivative.
std::pair<double, double> legendre(int degree, double x)
{
  double before = 1.0, value = x, slope = 1.0, slopeBefore = 0.0;
  for (int k = 1; k < degree; ++k)
  {
    const double next = ((2 * k + 1) * x * value - k * before) / (k + 1);
    const double slopeNext = slopeBefore + (2 * k + 1) * value;
    before = value;
    slopeBefore = slope;
    value = next;
    slope = slopeNext;
  }
  return { value, slope };
}

constexpr int NewtonSteps = 20; // far more than the 5 needed to reach rounding

/// The zeros of a Legendre polynomial, in [0, 1].
double gaussLegendrePoint(int i, int count)
{
  double x = -std::cos(Pi * (i + 0.75) / (count + 0.5));
  for (int step = 0; step < NewtonSteps; ++step)
  {
    const auto [value, slope] = legendre(count, x);
    x -= value / slope;
  }
  return 0.5 * (1.0 + x);
}

/// The ends and the extrema of a Legendre polynomial, in [0, 1].
double gaussLobattoPoint(int i, int order)
{
  if (i == 0 || i == order)
  {
    return i == 0 ? 0.0 : 1.0;
  }
  double x = -std::cos(Pi * i / order);
  for (int step = 0; step < NewtonSteps; ++step)
  {
    // From Legendre's equation, (1 - x^2) P'' = 2 x P' - n (n + 1) P.
    const auto [value, slope] = legendre(order, x);
    const double curvature = (2.0 * x * slope - order * (order + 1) * value) / (1.0 - x * x);
    x -= slope / curvature;
  }
  return 2 * i == order ? 0.5 : 0.5 * (1.0 + x);
}

/// Node i of an edge.
double pointOn(MfemSpace::Basis basis, int i, int order)
{
  switch (basis)
  {
    case MfemSpace::GaussLegendre:
      return gaussLegendrePoint(i, order + 1);
    case MfemSpace::GaussLobatto:
      return gaussLobattoPoint(i, order);
    case MfemSpace::OpenUniform:
      return (i + 1.0) / (order + 2.0);
    case MfemSpace::OpenHalfUniform:
      return (i + 0.5) / (order + 1.0);
    default:
      return static_cast<double>(i) / order;
  }
}

/// The position of the node at a lattice point.
Vec3 nodeAt(const MfemShape& shape, MfemSpace::Basis basis, int order, const LatticePoint& place)
{
  Vec3 x = { 0.0, 0.0, 0.0 };
  double sum = 0.0;
  int left = order;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(shape.dimension); ++axis)
  {
    x[axis] = pointOn(basis, place[axis], order);
    sum += shape.simplexAxes[axis] ? x[axis] : 0.0;
    left -= shape.simplexAxes[axis] ? place[axis] : 0;
  }
  sum += pointOn(basis, left, order);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    x[axis] /= shape.simplexAxes[axis] ? sum : 1.0;
  }
  return x;
}

/// The space of a shape's Bernstein polynomials, in the order of its lattice.
BernsteinSpace bernsteinSpace(const MfemShape& shape, int order)
{
  const int simplex = shape.simplexAxes[0] + shape.simplexAxes[1] + shape.simplexAxes[2];
  std::vector<BernsteinFactor> factors;
  if (simplex > 0)
  {
    factors.push_back({ simplex, order });
  }
  factors.resize(
    factors.size() + static_cast<std::size_t>(shape.dimension - simplex), { 1, order });
  return BernsteinSpace(factors);
}

/// Removes a prefix from a text; false if the text does not start with it.
bool skip(std::string_view& text, std::string_view start)
{
  const bool found = text.substr(0, start.size()) == start;
  text.remove_prefix(found ? start.size() : 0);
  return found;
}

MfemSpace::Basis basisOfLetter(char letter)
{
  switch (letter)
  {
    case 'G':
      return MfemSpace::GaussLobatto;
    case 'P':
      return MfemSpace::Bernstein;
    case 'U':
      return MfemSpace::ClosedUniform;
    default:
      throw Error(std::string("nodes of the basis '") + letter + "' are not supported");
  }
}

/// Removes the number at the start of a text and returns it; -1 if there is none.
int number(std::string_view& text)
{
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return error == std::errc() ? value : -1;
}
}

//------------------------------------------------------------------------------
MfemSpace MfemSpace::parse(std::string_view name, int dimension)
{
  const std::string full(name.substr(0, 40));
  constexpr std::string_view closed[] = { "Linear", "Quadratic", "Cubic" };
  const auto* found = std::find(std::begin(closed), std::end(closed), name);
  if (found != std::end(closed))
  {
    return { true, static_cast<int>(found - closed) + 1, ClosedUniform, name == "Cubic" };
  }
  MfemSpace space;
  space.continuous = skip(name, "H1");
  bool known = space.continuous || skip(name, "L2");
  space.basis = space.continuous ? GaussLobatto : GaussLegendre;
  if (space.continuous && skip(name, "Pos"))
  {
    space.basis = Bernstein;
  }
  else if (space.continuous && name.size() > 1 && skip(name, "@"))
  {
    space.basis = basisOfLetter(name[0]);
    name.remove_prefix(1);
  }
  known = known && skip(name, "_");
  if (known && !space.continuous && skip(name, "T"))
  {
    const int kind = number(name);
    known = kind >= GaussLegendre && kind <= OpenHalfUniform && skip(name, "_");
    space.basis = known ? static_cast<Basis>(kind) : space.basis;
  }
  known = known && number(name) == dimension && skip(name, "D_P");
  space.order = known ? number(name) : -1;
  if (space.order < 0 || !name.empty())
  {
    throw Error("nodes of the collection '" + full +
      "' are not supported: give the mesh H1 or L2 nodes using SetCurvature()");
  }
  if (space.order < 1 || space.order > MaxMfemOrder)
  {
    throw Error("nodes of order " + std::to_string(space.order) + " are not supported; 1 to " +
      std::to_string(MaxMfemOrder) + " are");
  }
  return space;
}

//------------------------------------------------------------------------------
std::vector<double> MfemSpace::evaluation(
  const MfemShape& shape, const std::vector<Vec3>& places) const
{
  // Up to order 2 the closed points are also evenly spaced.
  constexpr int largestAlike = 2;
  const bool linearLike = this->basis == Bernstein && this->order == 1;
  if (this->basis == ClosedUniform || linearLike ||
    (this->basis == GaussLobatto && this->order <= largestAlike))
  {
    return {};
  }
  std::vector<double> matrix;
  const auto addRow = [&](const auto& row) { matrix.insert(matrix.end(), row.begin(), row.end()); };
  if (this->basis == Bernstein)
  {
    const BernsteinSpace polynomials = bernsteinSpace(shape, this->order);
    for (const Vec3& place : places)
    {
      addRow(polynomials.valuesAt({ place[0], place[1], place[2] }));
    }
    return matrix;
  }
  std::vector<Vec3> nodes;
  for (const LatticePoint& place : shape.lattice(this->order))
  {
    nodes.push_back(nodeAt(shape, this->basis, this->order, place));
  }
  const ElementType element(
    shape.shape, { this->order, this->order, shape.dimension > 2 ? this->order : 0 }, nodes);
  for (const Vec3& place : places)
  {
    addRow(element.shapeFunctions(place));
  }
  return matrix;
}

//------------------------------------------------------------------------------
std::vector<double> MfemSpace::interpolation(
  const MfemShape& shape, unsigned char type, Index nodes) const
{
  std::vector<double> matrix;
  const auto addRow = [&](const auto& row) { matrix.insert(matrix.end(), row.begin(), row.end()); };
  if (this->basis == Bernstein)
  {
    std::vector<Vec3> places;
    for (const LatticePoint& place : cellPlaces(type, nodes))
    {
      const double step = 1.0 / this->order;
      places.push_back({ step * place[0], step * place[1], step * place[2] });
    }
    const ElementType element(
      shape.shape, { this->order, this->order, shape.dimension > 2 ? this->order : 0 }, places);
    const ControlMatrix& controls = element.controls();
    for (int row = 0; row < controls.rows(); ++row)
    {
      std::vector<double> entries(static_cast<std::size_t>(nodes));
      for (int i = controls.offsets[static_cast<std::size_t>(row)];
           i < controls.offsets[static_cast<std::size_t>(row) + 1]; ++i)
      {
        const auto entry = static_cast<std::size_t>(i);
        entries[static_cast<std::size_t>(controls.columns[entry])] = controls.values[entry];
      }
      addRow(entries);
    }
    return matrix;
  }
  const ElementType& element = ElementType::ofVtk(type, static_cast<int>(nodes));
  // VTK's linear and quadratic wedges list a triangle in the opposite order.
  const bool mirrored = shape.shape == ElementShape::Wedge && type != FileLagrangeWedge;
  for (const LatticePoint& place : shape.lattice(this->order))
  {
    Vec3 at = nodeAt(shape, this->basis, this->order, place);
    if (mirrored)
    {
      std::swap(at[0], at[1]);
    }
    addRow(element.shapeFunctions(at));
  }
  return matrix;
}

//------------------------------------------------------------------------------
std::string MfemSpace::name(int dimension) const
{
  const std::string size = std::to_string(dimension) + "D_P" + std::to_string(this->order);
  return this->continuous ? "H1_" + size
                          : "L2_T" + std::to_string(static_cast<int>(this->basis)) + "_" + size;
}
}
