// SPDX-License-Identifier: BSD-3-Clause
/// The discretization of the dissertation, section 4.3: low-order rules, cut triangles by their
/// chords.
#include "PeridynamicsKernel.h"
#include "TriangleAssembler.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr double third = 1.0 / 3.0, sixth = 1.0 / 6.0;
using PrintedBarycentric = std::array<double, 3>;
constexpr PrintedBarycentric threePoints[3] = { { 4 * sixth, sixth, sixth },
  { sixth, 4 * sixth, sixth }, { sixth, sixth, 4 * sixth } };
constexpr PrintedBarycentric printedCentroid[1] = { { third, third, third } };

int outerPoints(RuleSet rules)
{
  return rules == RuleSet::Literal || rules == RuleSet::OneOne ? 1 : 3;
}

int innerPoints(RuleSet rules, PeridynamicBasis basis)
{
  switch (rules)
  {
    case RuleSet::Tables:
      return basis == PeridynamicBasis::Constant ? 3 : 1;
    case RuleSet::Literal:
    case RuleSet::ThreeThree:
      return 3;
    default:
      return 1;
  }
}

/// The points of an inner rule: first of whole triangles, then of the parts of cut ones.
struct InnerPoints
{
  std::vector<double> x, y, squares, weights, values;
  std::vector<PrintedBarycentric> at; ///< in the triangle
  std::vector<std::int32_t> triangle; ///< of the point, local
  void clear()
  {
    this->x.clear();
    this->y.clear();
    this->weights.clear();
    this->at.clear();
    this->triangle.clear();
  }
  void add(double px, double py, double weight, const PrintedBarycentric& b, std::int32_t t)
  {
    this->x.push_back(px);
    this->y.push_back(py);
    this->weights.push_back(weight);
    this->at.push_back(b);
    this->triangle.push_back(t);
  }
};

class DissertationAssembler : public TriangleAssembler
{
public:
  explicit DissertationAssembler(const PeridynamicWork& work)
    : Work(work)
    , Kernel(work.options.kernel, work.options.horizon)
    , Elastic(isElastic(work.options.model))
    , Functions(work.space.perTriangle())
    , Outer(outerPoints(work.options.rules))
    , Inner(innerPoints(work.options.rules, work.options.basis))
    , LocalOf(work.triangles.points.size(), -1)
  {
  }

  void assemble(Index t, const std::vector<std::int32_t>& near, RowSums& sums) override
  {
    this->gather(near);
    const PlanarTriangles& mesh = this->Work.triangles;
    for (int o = 0; o < this->Outer; ++o)
    {
      const PrintedBarycentric& at = this->Outer == 1 ? printedCentroid[0] : threePoints[o];
      Vec2 x = {};
      for (int k = 0; k < 3; ++k)
      {
        x = x + at[k] * mesh.corner(t, k);
      }
      this->collect(t, x, near);
      const double weight = mesh.areas[t] / this->Outer;
      this->Elastic ? this->addElastic(t, at, weight, x, near, sums)
                    : this->addScalar(t, at, weight, near, sums);
    }
  }

private:
  /// Copies the nearby corners, numbered locally, and triangles.
  void gather(const std::vector<std::int32_t>& near)
  {
    const PlanarTriangles& mesh = this->Work.triangles;
    for (const std::int32_t p : this->Points)
    {
      this->LocalOf[p] = -1;
    }
    this->Points.clear();
    this->Corners.resize(near.size());
    this->Px.clear();
    this->Py.clear();
    for (std::size_t i = 0; i < near.size(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        const std::int32_t p = mesh.triangles[near[i]][k];
        if (this->LocalOf[p] < 0)
        {
          this->LocalOf[p] = static_cast<std::int32_t>(this->Points.size());
          this->Points.push_back(p);
          this->Px.push_back(mesh.points[p][0]);
          this->Py.push_back(mesh.points[p][1]);
        }
        this->Corners[i][k] = this->LocalOf[p];
      }
    }
    this->Far.resize(this->Points.size());
  }

  /// The inner points that belong to the outer point x of triangle t, with their weights times k.
  void collect(Index t, Vec2 x, const std::vector<std::int32_t>& near)
  {
    const double square = this->Work.options.horizon * this->Work.options.horizon;
    for (std::size_t i = 0; i < this->Points.size(); ++i)
    {
      const double dx = this->Px[i] - x[0], dy = this->Py[i] - x[1];
      this->Far[i] = dx * dx + dy * dy - square; // not above 0 in the disk
    }
    InnerPoints& points = this->Found;
    points.clear();
    const bool skipOwn = this->Functions == 1; // a constant does not change in its own triangle
    for (std::size_t i = 0; i < near.size(); ++i)
    {
      const auto& c = this->Corners[i];
      const bool in[3] = { this->Far[c[0]] <= 0.0, this->Far[c[1]] <= 0.0, this->Far[c[2]] <= 0.0 };
      const int inside = in[0] + in[1] + in[2];
      if (inside == 0 || (skipOwn && near[i] == t))
      {
        continue;
      }
      const auto local = static_cast<std::int32_t>(i);
      const PrintedBarycentric all[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
      const double area = this->Work.triangles.areas[near[i]];
      if (inside == 3)
      {
        this->addRule(local, all[0], all[1], all[2], area);
      }
      else
      {
        this->addCut(local, in, inside, area);
      }
    }
    const auto count = static_cast<Index>(points.x.size());
    points.squares.resize(count);
    points.values.resize(count);
    for (Index i = 0; i < count; ++i)
    {
      points.x[i] -= x[0];
      points.y[i] -= x[1];
      points.squares[i] = points.x[i] * points.x[i] + points.y[i] * points.y[i];
    }
    // Evaluate all kernel values at once, for vectorization.
    this->Kernel.evaluate(points.squares.data(), points.values.data(), count);
    for (Index i = 0; i < count; ++i)
    {
      points.values[i] *= points.weights[i];
    }
  }

  /// The rule on a part of a triangle.
  void addRule(std::int32_t local, const PrintedBarycentric& a, const PrintedBarycentric& b,
    const PrintedBarycentric& c, double area)
  {
    const auto& ids = this->Corners[local];
    for (int q = 0; q < this->Inner; ++q)
    {
      const PrintedBarycentric& w = this->Inner == 1 ? printedCentroid[0] : threePoints[q];
      const PrintedBarycentric at = { w[0] * a[0] + w[1] * b[0] + w[2] * c[0],
        w[0] * a[1] + w[1] * b[1] + w[2] * c[1], w[0] * a[2] + w[1] * b[2] + w[2] * c[2] };
      const double x =
        at[0] * this->Px[ids[0]] + at[1] * this->Px[ids[1]] + at[2] * this->Px[ids[2]];
      const double y =
        at[0] * this->Py[ids[0]] + at[1] * this->Py[ids[1]] + at[2] * this->Py[ids[2]];
      this->Found.add(x, y, area / this->Inner, at, local);
    }
  }

  /// A cut triangle: one piece (one corner inside, case 3 of Figure 4.4) or two (case 2,
  /// Figure 4.5).
  void addCut(std::int32_t local, const bool* in, int inside, double area)
  {
    int first = 0; // the inner corner, or the first of the two
    while (inside == 1 ? !in[first] : in[(first + 2) % 3])
    {
      ++first;
    }
    const int a = first, b = (first + 1) % 3, c = (first + 2) % 3;
    PrintedBarycentric atA = {}, atB = {}, onAC = {}, other = {};
    atA[a] = 1.0;
    atB[b] = 1.0;
    const double t = this->exit(local, a, c);
    onAC[a] = 1.0 - t;
    onAC[c] = t;
    if (inside == 1)
    {
      const double u = this->exit(local, a, b);
      other[a] = 1.0 - u;
      other[b] = u;
      this->addRule(local, atA, other, onAC, area * t * u);
    }
    else
    {
      const double u = this->exit(local, b, c);
      other[b] = 1.0 - u;
      other[c] = u;
      this->addRule(local, atA, atB, onAC, area * t);
      this->addRule(local, atB, other, onAC, area * u * (1.0 - t));
    }
  }

  /// The fraction of its length at which the edge from a corner inside to one outside leaves the
  /// disk.
  double exit(std::int32_t local, int inner, int outer) const
  {
    const std::int32_t p = this->Corners[local][inner], q = this->Corners[local][outer];
    const double ex = this->Px[q] - this->Px[p], ey = this->Py[q] - this->Py[p];
    // |p|^2 and |q|^2 minus the squared radius give the middle coefficient without the center.
    const double alpha = ex * ex + ey * ey, gamma = this->Far[p];
    const double beta = 0.5 * (this->Far[q] - gamma - alpha);
    return (-beta + std::sqrt(std::max(0.0, beta * beta - alpha * gamma))) / alpha;
  }

  void addScalar(Index t, const PrintedBarycentric& at, double weight,
    const std::vector<std::int32_t>& near, RowSums& sums)
  {
    const FunctionSpace& space = this->Work.space;
    const PlanarTriangles& mesh = this->Work.triangles;
    const InnerPoints& points = this->Found;
    double total = 0.0;
    if (this->Functions == 1)
    {
      for (std::size_t i = 0; i < points.x.size(); ++i)
      {
        total += points.values[i];
        const Index f = space.function(mesh, near[points.triangle[i]], 0);
        *sums.at(0, f) -= weight * points.values[i];
      }
      *sums.at(0, space.function(mesh, t, 0)) += weight * total;
      return;
    }
    // Sums by local corner (continuous) or by corner of each triangle, then once per function.
    const bool continuous = space.basis == PeridynamicBasis::Linear;
    this->ByFunction.assign(continuous ? this->Points.size() : 3 * near.size(), 0.0);
    for (std::size_t i = 0; i < points.x.size(); ++i)
    {
      const std::int32_t local = points.triangle[i];
      total += points.values[i];
      for (int k = 0; k < 3; ++k)
      {
        this->ByFunction[continuous ? this->Corners[local][k] : 3 * local + k] +=
          points.values[i] * points.at[i][k];
      }
    }
    for (int a = 0; a < 3; ++a)
    {
      const double factor = weight * at[a];
      for (std::size_t i = 0; i < this->ByFunction.size(); ++i)
      {
        const Index f =
          continuous ? this->Points[i] : space.function(mesh, near[i / 3], static_cast<int>(i % 3));
        *sums.at(a, f) -= factor * this->ByFunction[i];
      }
      for (int k = 0; k < 3; ++k)
      {
        *sums.at(a, space.function(mesh, t, k)) += factor * total * at[k];
      }
    }
  }

  void addElastic(Index t, const PrintedBarycentric& at, double weight, Vec2,
    const std::vector<std::int32_t>& near, RowSums& sums)
  {
    const FunctionSpace& space = this->Work.space;
    const PlanarTriangles& mesh = this->Work.triangles;
    const InnerPoints& points = this->Found;
    const auto add = [](double* to, double factor, const double* tensor)
    {
      to[0] += factor * tensor[0];
      to[1] += factor * tensor[1];
      to[2] += factor * tensor[1];
      to[3] += factor * tensor[2];
    };
    const bool constant = this->Functions == 1;
    double total[3] = {};
    for (std::size_t i = 0; i < points.x.size(); ++i)
    {
      const double v = points.values[i], x = points.x[i], y = points.y[i];
      const double tensor[3] = { v * x * x, v * x * y, v * y * y };
      for (int k = 0; k < 3; ++k)
      {
        total[k] += tensor[k];
      }
      for (int a = 0; a < this->Functions; ++a)
      {
        const double factor = -weight * (constant ? 1.0 : at[a]);
        for (int k = 0; k < this->Functions; ++k)
        {
          add(sums.at(a, space.function(mesh, near[points.triangle[i]], k)),
            factor * (constant ? 1.0 : points.at[i][k]), tensor);
        }
      }
    }
    for (int a = 0; a < this->Functions; ++a)
    {
      for (int k = 0; k < this->Functions; ++k)
      {
        add(
          sums.at(a, space.function(mesh, t, k)), weight * (constant ? 1.0 : at[a] * at[k]), total);
      }
    }
  }

  const PeridynamicWork& Work;
  RadialKernel Kernel;
  bool Elastic;
  int Functions, Outer, Inner;
  /// local numbers of points, and the points of the local numbers
  std::vector<std::int32_t> LocalOf, Points;
  std::vector<std::array<std::int32_t, 3>> Corners;
  std::vector<double> Px, Py, Far, ByFunction;
  InnerPoints Found;
};
}

//------------------------------------------------------------------------------
std::unique_ptr<TriangleAssembler> makeDissertationAssembler(const PeridynamicWork& work)
{
  return std::make_unique<DissertationAssembler>(work);
}
}
