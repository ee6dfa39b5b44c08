// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianBounds.h"

#include "tautline/Core/SmallCholesky.h"

#include <algorithm>
#include <vector>

namespace tautline
{
namespace
{
/// The number of subdivisions before a cell is treated as undecided.
constexpr int maxSplits = 2000;

/// The rounding error of determinants, relative to the longest edges in each direction.
constexpr double rounding = 1e-15;

constexpr int Axes = 3;
using Point = double[3];

/// A cell relative to its first vertex.
struct Cell
{
  const CellTopology& topology;
  Point p[MaxNodes];

  Cell(const CellTopology& t, const Vec3* vertices)
    : topology(t)
  {
    for (int k = 0; k < t.nodes; ++k)
    {
      bounds::difference(vertices[k].data(), vertices[0].data(), this->p[k]);
    }
  }

  template <int Nodes>
  bounds::Edges<double> coefficients(double* c) const
  {
    bounds::Edges<double> edges;
    bounds::coefficients<Nodes>(this->p, edges, c);
    return edges;
  }
};

/// The derivatives of the shape functions with respect to u, v, w; for a pyramid, of B(u, v) and of
/// apex - B.
void shapeDerivatives(const CellTopology& t, const Vec3& at, double (*d)[3])
{
  const double u[2] = { 1 - at[0], at[0] }, v[2] = { 1 - at[1], at[1] };
  const double w[2] = { 1 - at[2], at[2] };
  constexpr double sign[2] = { -1, 1 };
  if (t.type == CellType::Wedge)
  {
    const double triangle[3] = { 1 - at[0] - at[1], at[1], at[0] };
    constexpr double byU[3] = { -1, 0, 1 }, byV[3] = { -1, 1, 0 };
    for (int k = 0; k < 6; ++k)
    {
      d[k][0] = byU[k % 3] * w[k / 3];
      d[k][1] = byV[k % 3] * w[k / 3];
      d[k][2] = sign[k / 3] * triangle[k % 3];
    }
    return;
  }
  const bool pyramid = t.type == CellType::Pyramid;
  for (int n = 0; n < (pyramid ? 4 : 8); ++n)
  {
    const int i = n & 1, j = n >> 1 & 1, k = n >> 2;
    double* of = d[bounds::cubeNode[i][j][k]];
    const double height = pyramid ? 1.0 : w[k];
    of[0] = sign[i] * v[j] * height;
    of[1] = u[i] * sign[j] * height;
    of[2] = u[i] * v[j] * sign[k];
  }
  if (pyramid)
  {
    d[4][0] = d[4][1] = 0;
    d[4][2] = 1;
  }
}

/// The derivatives of the map with respect to u, v, w.
std::array<Vec3, 3> mapDerivatives(const Cell& cell, const Vec3& at)
{
  double d[MaxNodes][3];
  shapeDerivatives(cell.topology, at, d);
  std::array<Vec3, 3> x = {};
  for (int k = 0; k < cell.topology.nodes; ++k)
  {
    for (int a = 0; a < 3; ++a)
    {
      x[a] += d[k][a] * Vec3{ cell.p[k][0], cell.p[k][1], cell.p[k][2] };
    }
  }
  return x;
}

/// |x_u| |x_v| |x_w|
double scaleAt(const Cell& cell, const Vec3& at)
{
  const std::array<Vec3, 3> x = mapDerivatives(cell, at);
  return norm(x[0]) * norm(x[1]) * norm(x[2]);
}

//------------------------------------------------------------------------------
/// A polynomial of degree 2 in each coordinate on a part of the unit cube.
struct Box
{
  static constexpr int Corners = 8;

  double c[MaxCoefficients]; ///< Bernstein coefficients
  Vec3 low = { 0, 0, 0 }, size = { 1, 1, 1 };
  double least = 0; ///< of the coefficients

  /// The coefficient of a corner.
  static int corner(int k) { return 2 * (k & 1) + 6 * (k >> 1 & 1) + 18 * (k >> 2); }
  Vec3 cornerPoint(int k) const
  {
    Vec3 at = this->low;
    for (int a = 0; a < Axes; ++a)
    {
      at[a] += (k >> a & 1) * this->size[a];
    }
    return at;
  }
  void findLeast() { this->least = *std::min_element(this->c, this->c + MaxCoefficients); }

  /// Calls visit(first, stride) for the three coefficients of each line along an axis.
  template <class Visit>
  static void forEachLine(int axis, const Visit& visit)
  {
    constexpr int strides[3] = { 1, 3, 9 };
    for (int n = 0; n < MaxCoefficients; ++n)
    {
      if (n / strides[axis] % 3 == 0)
      {
        visit(n, strides[axis]);
      }
    }
  }

  /// The axis along which the polynomial bends most: only bending separates it from the smallest
  /// coefficient.
  int bentAxis() const
  {
    int best = 0;
    double most = -1;
    for (int axis = 0; axis < Axes; ++axis)
    {
      double bend = 0;
      forEachLine(axis,
        [&](int n, int s)
        { bend = std::max(bend, std::abs(this->c[n] - 2 * this->c[n + s] + this->c[n + 2 * s])); });
      best = bend > most ? axis : best;
      most = std::max(most, bend);
    }
    return best;
  }

  /// Halves this box, by de Casteljau's algorithm; returns the upper half.
  Box split(int axis)
  {
    Box upper = *this;
    forEachLine(axis,
      [&](int n, int s)
      {
        const double left = 0.5 * (this->c[n] + this->c[n + s]);
        const double right = 0.5 * (this->c[n + s] + this->c[n + 2 * s]);
        const double middle = 0.5 * (left + right);
        this->c[n + s] = left;
        this->c[n + 2 * s] = upper.c[n] = middle;
        upper.c[n + s] = right;
      });
    this->size[axis] *= 0.5;
    upper.size[axis] = this->size[axis];
    upper.low[axis] += this->size[axis];
    this->findLeast();
    upper.findLeast();
    return upper;
  }
};

/// The remaining boxes, the one with the smallest coefficient first.
class BoxQueue
{
public:
  bool empty() const { return this->Boxes.empty(); }
  const Box& front() const { return this->Boxes.front(); }
  void push(const Box& box)
  {
    this->Boxes.push_back(box);
    std::push_heap(this->Boxes.begin(), this->Boxes.end(), later);
  }
  Box pop()
  {
    std::pop_heap(this->Boxes.begin(), this->Boxes.end(), later);
    const Box box = this->Boxes.back();
    this->Boxes.pop_back();
    return box;
  }

private:
  static bool later(const Box& a, const Box& b) { return a.least > b.least; }

  std::vector<Box> Boxes;
};

/// The longest of four edges.
double longest(const double (&edges)[2][2][3])
{
  double longest2 = 0;
  for (int n = 0; n < 4; ++n)
  {
    const double* e = edges[n >> 1][n & 1];
    longest2 = std::max(longest2, bounds::product(e, e));
  }
  return std::sqrt(longest2);
}

//------------------------------------------------------------------------------
/// The sign of the determinant of a hexahedron.
class SignSearch
{
public:
  SignSearch(const Cell& cell, Validity corners)
    : TheCell(cell)
    , Verdict(corners)
  {
  }

  Validity run()
  {
    Box root;
    const auto edges = this->TheCell.coefficients<8>(root.c);
    const double largest = longest(edges.u) * longest(edges.v) * longest(edges.w);
    this->Clear = tolerance * largest;
    this->Noise = rounding * largest;
    root.findLeast();
    BoxQueue queue;
    if (this->undecided(root))
    {
      queue.push(root);
    }
    for (int splits = 0; !queue.empty(); ++splits)
    {
      if (splits == maxSplits)
      {
        return std::min(this->Verdict, Degenerate);
      }
      Box lower = queue.pop();
      Box upper = lower.split(lower.bentAxis());
      for (const Box* half : { &lower, &upper })
      {
        if (this->negativeAtCorner(*half))
        {
          return Inverted;
        }
        if (this->undecided(*half))
        {
          queue.push(*half);
        }
      }
    }
    return this->Verdict;
  }

private:
  static constexpr double tolerance = Mesh::degenerateTolerance();

  /// Whether the polynomial is negative at a corner of a box; if it vanishes there, the verdict is
  /// updated.
  bool negativeAtCorner(const Box& box)
  {
    for (int k = 0; k < Box::Corners; ++k)
    {
      const double value = box.c[Box::corner(k)];
      if (value > this->Clear)
      {
        continue;
      }
      const double least =
        std::max(tolerance * scaleAt(this->TheCell, box.cornerPoint(k)), this->Noise);
      if (value < -least)
      {
        return true;
      }
      this->Verdict = value <= least ? std::min(this->Verdict, Degenerate) : this->Verdict;
    }
    return false;
  }

  /// Whether the coefficients do not exclude a worse verdict in this box.
  bool undecided(const Box& box) const
  {
    if (box.least > this->Clear)
    {
      return false;
    }
    // The derivatives are multilinear: they are longest at corners.
    Vec3 lengths = { 0, 0, 0 };
    for (int k = 0; k < Box::Corners; ++k)
    {
      const std::array<Vec3, 3> x = mapDerivatives(this->TheCell, box.cornerPoint(k));
      for (int a = 0; a < 3; ++a)
      {
        lengths[a] = std::max(lengths[a], norm(x[a]));
      }
    }
    const double limit = std::max(tolerance * lengths[0] * lengths[1] * lengths[2], this->Noise);
    return this->Verdict == Valid ? box.least <= limit : box.least < -limit;
  }

  const Cell& TheCell;
  Validity Verdict;
  double Clear = 0; ///< values above this are certainly positive
  double Noise = 0; ///< values below this are rounding errors
};

//------------------------------------------------------------------------------
/// The position in [0, 1] of the minimum of a quadratic polynomial with Bernstein coefficients c.
double minimumPoint(const double* c)
{
  const double bend = c[0] - 2 * c[1] + c[2];
  if (c[1] < c[0] && c[1] < c[2] && bend > 0)
  {
    return (c[0] - c[1]) / bend;
  }
  return c[2] < c[0] ? 1.0 : 0.0;
}

/// The minima of a wedge along each of its three edges.
std::array<JacobianMinimum, 3> wedgeMinima(const Cell& cell, double* noise = nullptr)
{
  double c[9];
  const auto e = cell.coefficients<6>(c);
  if (noise)
  {
    const auto longer = [](const double* a, const double* b)
    { return std::max(bounds::product(a, a), bounds::product(b, b)); };
    const double w2 = bounds::product(e.w[1][0], e.w[1][0]);
    *noise = rounding *
      std::sqrt(longer(e.u[0][0], e.u[0][1]) * longer(e.v[0][0], e.v[0][1]) *
        std::max(w2, longer(e.w[0][0], e.w[0][1])));
  }
  std::array<JacobianMinimum, 3> minima;
  for (int k = 0; k < 3; ++k)
  {
    const double* q = c + 3 * k;
    const double w = minimumPoint(q);
    minima[k].at = { k == 2 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, w };
    // Exact if c0 c2 = c1^2, unlike the sum of the three terms.
    const bool inside = w > 0 && w < 1;
    minima[k].value = inside ? (q[0] * q[2] - q[1] * q[1]) / (q[0] - 2 * q[1] + q[2])
      : w > 0                ? q[2]
                             : q[0];
  }
  return minima;
}

/// The smallest determinant at the corners of the base.
JacobianMinimum pyramidMinimum(const Cell& cell)
{
  JacobianMinimum minimum;
  for (int n = 0; n < 4; ++n)
  {
    const Vec3 at = { double(n & 1), double(n >> 1), 0.0 };
    const std::array<Vec3, 3> x = mapDerivatives(cell, at);
    const double det = dot(x[0], cross(x[1], x[2]));
    if (n == 0 || det < minimum.value)
    {
      minimum = { det, at };
    }
  }
  return minimum;
}

//------------------------------------------------------------------------------
/// The value of a polynomial at a point, its gradient and Hessian.
double evaluate(const double* c, const Vec3& at, Vec3& gradient, double (&hessian)[Axes][Axes])
{
  double basis[3][3][3]; // by axis, order of the derivative, function
  for (int a = 0; a < Axes; ++a)
  {
    const double x = at[a], y = 1 - x;
    const double rows[3][3] = { { y * y, 2 * x * y, x * x }, { -2 * y, 2 * (y - x), 2 * x },
      { 2, -4, 2 } };
    std::copy(&rows[0][0], &rows[0][0] + 9, &basis[a][0][0]);
  }
  const auto derivative = [&](int first, int second)
  {
    double sum = 0;
    for (int n = 0; n < MaxCoefficients; ++n)
    {
      double term = c[n];
      for (int a = 0, index = n; a < Axes; ++a, index /= 3)
      {
        term *= basis[a][(a == first) + (a == second)][index % 3];
      }
      sum += term;
    }
    return sum;
  };
  for (int a = 0; a < Axes; ++a)
  {
    gradient[a] = derivative(a, -1);
    for (int b = 0; b < Axes; ++b)
    {
      hessian[a][b] = derivative(a, b);
    }
  }
  return derivative(-1, -1);
}

/// Newton's method inside the cube, from a point near the minimum.
void polish(const double* c, JacobianMinimum& minimum)
{
  constexpr int steps = 5;
  double hessian[Axes][Axes];
  Vec3 gradient = { 0, 0, 0 };
  evaluate(c, minimum.at, gradient, hessian);
  for (int step = 0; step < steps; ++step)
  {
    double x[Axes];
    for (int a = 0; a < Axes; ++a)
    {
      // Coordinates at an active bound are excluded.
      const bool held = gradient[a] >= 0 ? minimum.at[a] <= 0 : minimum.at[a] >= 1;
      for (int b = 0; b < Axes && held; ++b)
      {
        hessian[a][b] = hessian[b][a] = a == b;
      }
      x[a] = held ? 0.0 : gradient[a];
    }
    using Factor = SmallCholesky<Axes, CholeskyDiagonal::Root>;
    double factor[Factor::Entries];
    if (!Factor::factor(hessian, 0.0, 0.0, factor))
    {
      return;
    }
    Factor::solve(factor, x);
    JacobianMinimum next = minimum;
    for (int a = 0; a < Axes; ++a)
    {
      next.at[a] = std::clamp(minimum.at[a] - x[a], 0.0, 1.0);
    }
    next.value = evaluate(c, next.at, gradient, hessian);
    if (!(next.value < minimum.value))
    {
      return;
    }
    minimum = next;
  }
}

/// Branch and bound.
JacobianMinimum searchMinimum(const Cell& cell)
{
  constexpr double relativeGap = 1e-9; // Newton steps are exact from there
  Box root;
  cell.coefficients<8>(root.c);
  root.findLeast();
  double largest = 0;
  for (double c : root.c)
  {
    largest = std::max(largest, std::abs(c));
  }
  const double gap = relativeGap * largest;
  JacobianMinimum minimum;
  minimum.value = root.c[0];
  const auto lookAtCorners = [&](const Box& box)
  {
    for (int k = 0; k < Box::Corners; ++k)
    {
      const double value = box.c[Box::corner(k)];
      if (value < minimum.value)
      {
        minimum = { value, box.cornerPoint(k) };
      }
    }
  };
  lookAtCorners(root);
  if (!(root.least < minimum.value - gap))
  {
    return minimum;
  }
  BoxQueue queue;
  queue.push(root);
  for (int splits = 0; splits < maxSplits && !queue.empty(); ++splits)
  {
    if (!(queue.front().least < minimum.value - gap))
    {
      break;
    }
    Box lower = queue.pop();
    Box upper = lower.split(lower.bentAxis());
    for (const Box* half : { &lower, &upper })
    {
      lookAtCorners(*half);
      if (half->least < minimum.value - gap)
      {
        queue.push(*half);
      }
    }
  }
  polish(root.c, minimum);
  return minimum;
}
}

//------------------------------------------------------------------------------
Validity classifyInside(const CellTopology& t, const Vec3* vertices, Validity corners)
{
  const Cell cell(t, vertices);
  if (t.type == CellType::Hexahedron)
  {
    return SignSearch(cell, corners).run();
  }
  Validity verdict = corners;
  double noise = 0;
  for (const JacobianMinimum& minimum : wedgeMinima(cell, &noise))
  {
    if (minimum.at[2] > 0 && minimum.at[2] < 1)
    {
      const double least = std::max(Mesh::degenerateTolerance() * scaleAt(cell, minimum.at), noise);
      const Validity own = minimum.value > least ? Valid
        : minimum.value < -least                 ? Inverted
                                                 : Degenerate;
      verdict = std::min(verdict, own);
    }
  }
  return verdict;
}

//------------------------------------------------------------------------------
JacobianMinimum minimumJacobian(const CellTopology& t, const Vec3* vertices)
{
  const Cell cell(t, vertices);
  if (t.type == CellType::Hexahedron)
  {
    return searchMinimum(cell);
  }
  if (t.type == CellType::Pyramid)
  {
    return pyramidMinimum(cell);
  }
  const std::array<JacobianMinimum, 3> minima = wedgeMinima(cell);
  return *std::min_element(minima.begin(), minima.end(),
    [](const JacobianMinimum& a, const JacobianMinimum& b) { return a.value < b.value; });
}

//------------------------------------------------------------------------------
void addJacobianGradient(
  const CellTopology& t, const Vec3* vertices, const Vec3& at, double factor, Vec3* gradient)
{
  const Cell cell(t, vertices);
  const std::array<Vec3, 3> x = mapDerivatives(cell, at);
  const Vec3 cofactor[3] = { cross(x[1], x[2]), cross(x[2], x[0]), cross(x[0], x[1]) };
  double d[MaxNodes][3];
  shapeDerivatives(t, at, d);
  for (int k = 0; k < t.nodes; ++k)
  {
    for (int a = 0; a < 3; ++a)
    {
      gradient[k] += (factor * d[k][a]) * cofactor[a];
    }
  }
}
}
