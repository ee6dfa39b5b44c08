// SPDX-License-Identifier: BSD-3-Clause
#include "PlanarDelaunay.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/LoopProgress.h"

#include <algorithm>
#include <deque>
#include <numeric>

namespace tautline
{
namespace
{
using Real = long double; // for signs that double does not resolve

struct DelaunayTriangle
{
  std::array<Index, 3> points;
  std::array<Index, 3> beside; ///< the triangle across the edge opposite a corner, -1 outside
};

class Triangulation
{
public:
  explicit Triangulation(const std::vector<double>& points);
  void insert(Index p);
  void recover(Index a, Index b);
  std::vector<std::array<Index, 3>> result() const;
  std::vector<Index> order() const;

private:
  /// Twice the area of a triangle, positive if counterclockwise.
  Real area(Index a, Index b, Index c) const
  {
    const Real ux = Real(this->X[b]) - this->X[a], uy = Real(this->Y[b]) - this->Y[a];
    const Real vx = Real(this->X[c]) - this->X[a], vy = Real(this->Y[c]) - this->Y[a];
    return ux * vy - uy * vx;
  }
  bool onLine(Index a, Index b, Index c) const;
  bool inCircle(Index a, Index b, Index c, Index p) const;
  Index locate(Index p);
  int cornerOf(Index t, Index p) const;
  void link(Index t, Index other, Index formerly);
  void flip(Index t, int corner);
  void legalize(std::vector<std::pair<Index, Index>>& edges, Index p);
  bool hasEdge(Index a, Index b, Index& triangle) const;

  std::vector<double> X, Y;
  std::vector<DelaunayTriangle> Triangles;
  std::vector<Index> TriangleOf; ///< one at each point
  Index Count;
  Index Last = 0;
};

//------------------------------------------------------------------------------
Triangulation::Triangulation(const std::vector<double>& points)
  : Count(static_cast<Index>(points.size()) / 2)
{
  double low[2] = { 1e300, 1e300 }, high[2] = { -1e300, -1e300 };
  for (Index i = 0; i < this->Count; ++i)
  {
    this->X.push_back(points[2 * i]);
    this->Y.push_back(points[2 * i + 1]);
    for (int c = 0; c < 2; ++c)
    {
      low[c] = std::min(low[c], points[2 * i + c]);
      high[c] = std::max(high[c], points[2 * i + c]);
    }
  }
  // A large triangle around all points.
  const double size = std::max(high[0] - low[0], high[1] - low[1]);
  const double x = 0.5 * (low[0] + high[0]), y = 0.5 * (low[1] + high[1]);
  const double far = 50.0 * size;
  for (const auto& [dx, dy] : { std::pair{ -1.0, -0.7 }, { 1.1, -0.8 }, { 0.1, 1.2 } })
  {
    this->X.push_back(x + far * dx);
    this->Y.push_back(y + far * dy);
  }
  this->Triangles.push_back({ { this->Count, this->Count + 1, this->Count + 2 }, { -1, -1, -1 } });
  this->TriangleOf.assign(this->Count + 3, 0);
}

/// Orders points in rows of alternating direction, so that each is near the previous one.
std::vector<Index> Triangulation::order() const
{
  const auto rows =
    std::max<Index>(1, static_cast<Index>(std::sqrt(static_cast<double>(this->Count) / 2.0)));
  const auto [low, high] = std::minmax_element(this->Y.begin(), this->Y.begin() + this->Count);
  // The factor slightly above 1 keeps the highest point in the last row.
  const double height = std::max(*high - *low, 1e-300) * (1.0 + 1e-9) / static_cast<double>(rows);
  std::vector<Index> ids(this->Count), row(this->Count);
  std::iota(ids.begin(), ids.end(), Index(0));
  for (Index i = 0; i < this->Count; ++i)
  {
    row[i] = static_cast<Index>((this->Y[i] - *low) / height);
  }
  std::sort(ids.begin(), ids.end(),
    [&](Index a, Index b)
    {
      if (row[a] != row[b])
      {
        return row[a] < row[b];
      }
      if (this->X[a] != this->X[b])
      {
        return row[a] % 2 == 0 ? this->X[a] < this->X[b] : this->X[a] > this->X[b];
      }
      return a < b;
    });
  return ids;
}

bool Triangulation::onLine(Index a, Index b, Index c) const
{
  const double dx = this->X[b] - this->X[a], dy = this->Y[b] - this->Y[a];
  const double ex = this->X[c] - this->X[a], ey = this->Y[c] - this->Y[a];
  const double size = std::sqrt((dx * dx + dy * dy) * (ex * ex + ey * ey));
  return std::abs(this->area(a, b, c)) <= 1e-13 * size;
}

bool Triangulation::inCircle(Index a, Index b, Index c, Index p) const
{
  const auto row = [&](Index i)
  {
    const Real x = Real(this->X[i]) - this->X[p], y = Real(this->Y[i]) - this->Y[p];
    return std::array<Real, 3>{ x, y, x * x + y * y };
  };
  const auto u = row(a), v = row(b), w = row(c);
  const Real terms[3] = { u[2] * (v[0] * w[1] - v[1] * w[0]), v[2] * (w[0] * u[1] - w[1] * u[0]),
    w[2] * (u[0] * v[1] - u[1] * v[0]) };
  // Require clearly inside, so that cocircular points do not flip back and forth.
  return terms[0] + terms[1] + terms[2] >
    1e-15L * (std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]));
}

/// Walks from the last triangle toward p.
Index Triangulation::locate(Index p)
{
  Index t = this->Last;
  for (std::size_t step = 0; step < 4 * this->Triangles.size() + 10; ++step)
  {
    const DelaunayTriangle& triangle = this->Triangles[t];
    Index next = -1;
    for (int k = 0; k < 3 && next < 0; ++k)
    {
      const int side = static_cast<int>((k + step) % 3); // prevents endless cycles
      const Index a = triangle.points[(side + 1) % 3], b = triangle.points[(side + 2) % 3];
      if (this->area(a, b, p) < 0.0L && triangle.beside[side] >= 0 && !this->onLine(a, b, p))
      {
        next = triangle.beside[side];
      }
    }
    if (next < 0)
    {
      return t;
    }
    t = next;
  }
  throw Error("a point could not be located: points coincide or the mesh overlaps itself");
}

int Triangulation::cornerOf(Index t, Index p) const
{
  const auto& points = this->Triangles[t].points;
  return points[0] == p ? 0 : points[1] == p ? 1 : 2;
}

/// Replaces a triangle in the list of a neighbor.
void Triangulation::link(Index t, Index other, Index formerly)
{
  if (other >= 0)
  {
    auto& beside = this->Triangles[other].beside;
    *std::find(beside.begin(), beside.end(), formerly) = t;
  }
}

/// Exchanges the diagonal of the two triangles that share the edge opposite a corner.
void Triangulation::flip(Index t, int corner)
{
  const Index u = this->Triangles[t].beside[corner];
  const DelaunayTriangle old = this->Triangles[t], other = this->Triangles[u];
  const int far =
    static_cast<int>(std::find(other.beside.begin(), other.beside.end(), t) - other.beside.begin());
  const Index p = old.points[corner], a = old.points[(corner + 1) % 3],
              b = old.points[(corner + 2) % 3];
  const Index q = other.points[far];
  const Index besideB = old.beside[(corner + 1) % 3], besideA = old.beside[(corner + 2) % 3];
  const Index otherA = other.beside[(far + 1) % 3], otherB = other.beside[(far + 2) % 3];
  // `other` is q, b, a: its neighbor opposite b is across q-a, opposite a across q-b.
  this->Triangles[t] = { { p, a, q }, { otherA, u, besideA } };
  this->Triangles[u] = { { p, q, b }, { otherB, besideB, t } };
  this->link(t, otherA, u);
  this->link(u, besideB, t);
  for (const Index v : { p, a, q })
  {
    this->TriangleOf[v] = t;
  }
  this->TriangleOf[b] = u;
}

/// Flips edges until the triangles around p are Delaunay.
void Triangulation::legalize(std::vector<std::pair<Index, Index>>& open, Index p)
{
  // Triangles at p whose edge opposite p may have to be flipped.
  while (!open.empty())
  {
    const Index t = open.back().first;
    open.pop_back();
    const int corner = this->cornerOf(t, p);
    const Index u = this->Triangles[t].beside[corner];
    if (u < 0)
    {
      continue;
    }
    const auto& other = this->Triangles[u];
    const int far = static_cast<int>(
      std::find(other.beside.begin(), other.beside.end(), t) - other.beside.begin());
    if (this->inCircle(other.points[0], other.points[1], other.points[2], p))
    {
      const Index q = other.points[far], a = this->Triangles[t].points[(corner + 1) % 3],
                  b = this->Triangles[t].points[(corner + 2) % 3];
      // Only the diagonal of a convex quadrilateral can be exchanged without inverting a triangle.
      if (this->area(p, a, q) > 0.0L && this->area(p, q, b) > 0.0L)
      {
        this->flip(t, corner);
        // Both triangles still have p as a corner, and new edges opposite to it that must be
        // checked.
        open.emplace_back(t, 0);
        open.emplace_back(u, 0);
      }
    }
  }
}

/// Adds the point p to the triangle or the edge it lies in.
void Triangulation::insert(Index p)
{
  const Index t = this->locate(p);
  const DelaunayTriangle old = this->Triangles[t];
  int edge = -1;
  for (int k = 0; k < 3; ++k)
  {
    const Index corner = old.points[k];
    if (this->X[corner] == this->X[p] && this->Y[corner] == this->Y[p])
    {
      throw Error("two boundary points of the mesh coincide: clean the mesh first");
    }
    if (this->onLine(old.points[(k + 1) % 3], old.points[(k + 2) % 3], p))
    {
      edge = k;
    }
  }
  std::vector<std::pair<Index, Index>> open;
  const auto next = static_cast<Index>(this->Triangles.size());
  if (edge < 0 || old.beside[edge] < 0)
  {
    const auto [a, b, c] = old.points;
    const auto [atA, atB, atC] = old.beside;
    this->Triangles[t] = { { p, a, b }, { atC, next, next + 1 } };
    this->Triangles.push_back({ { p, b, c }, { atA, next + 1, t } });
    this->Triangles.push_back({ { p, c, a }, { atB, t, next } });
    this->link(next, atA, t);
    this->link(next + 1, atB, t);
    this->TriangleOf[a] = this->TriangleOf[b] = this->TriangleOf[p] = t;
    this->TriangleOf[c] = next;
    open = { { t, 0 }, { next, 0 }, { next + 1, 0 } };
  }
  else
  {
    // On the edge a-b of c-a-b and d-b-a: four triangles around p.
    const Index u = old.beside[edge];
    const DelaunayTriangle other = this->Triangles[u];
    const int far = static_cast<int>(
      std::find(other.beside.begin(), other.beside.end(), t) - other.beside.begin());
    const Index c = old.points[edge], a = old.points[(edge + 1) % 3],
                b = old.points[(edge + 2) % 3];
    const Index d = other.points[far];
    const Index bc = old.beside[(edge + 1) % 3], ca = old.beside[(edge + 2) % 3];
    const Index ad = other.beside[(far + 1) % 3], db = other.beside[(far + 2) % 3];
    const Index v = next, w = next + 1;
    this->Triangles[t] = { { p, c, a }, { ca, u, v } };
    this->Triangles[u] = { { p, a, d }, { ad, w, t } };
    this->Triangles.push_back({ { p, b, c }, { bc, t, w } });
    this->Triangles.push_back({ { p, d, b }, { db, v, u } });
    this->link(v, bc, t);
    this->link(w, db, u);
    this->TriangleOf[p] = this->TriangleOf[c] = this->TriangleOf[a] = t;
    this->TriangleOf[d] = u;
    this->TriangleOf[b] = v;
    open = { { t, 0 }, { u, 0 }, { v, 0 }, { w, 0 } };
  }
  this->legalize(open, p);
  this->Last = this->TriangleOf[p];
}

/// Whether the edge exists; also gives a triangle at a that has it, or whose opposite edge the
/// segment crosses.
bool Triangulation::hasEdge(Index a, Index b, Index& triangle) const
{
  triangle = -1;
  const Index first = this->TriangleOf[a];
  Index t = first;
  for (std::size_t step = 0; step <= this->Triangles.size(); ++step)
  {
    const int corner = this->cornerOf(t, a);
    const Index u = this->Triangles[t].points[(corner + 1) % 3];
    const Index v = this->Triangles[t].points[(corner + 2) % 3];
    if (u == b || v == b)
    {
      triangle = t;
      return true;
    }
    if (this->area(a, u, b) > 0.0L && this->area(a, b, v) > 0.0L)
    {
      triangle = t;
    }
    t = this->Triangles[t].beside[(corner + 1) % 3]; // counterclockwise around a
    if (t < 0 || t == first)
    {
      break;
    }
  }
  return false;
}

/// Flips edges until the segment a-b is one.
void Triangulation::recover(Index a, Index b)
{
  Index t;
  // Each turn flips one of the edges the segment crosses; concave pairs wait for others.
  std::size_t turns = 0;
  while (!this->hasEdge(a, b, t))
  {
    if (t < 0)
    {
      throw Error("a boundary point of the mesh lies on a boundary edge: clean the mesh first");
    }
    // Walk along the segment to the first edge whose two triangles are convex.
    int corner = this->cornerOf(t, a);
    bool flipped = false;
    for (std::size_t step = 0; step <= this->Triangles.size() && !flipped; ++step)
    {
      const Index u = this->Triangles[t].beside[corner];
      const DelaunayTriangle& other = this->Triangles[u];
      const int far = static_cast<int>(
        std::find(other.beside.begin(), other.beside.end(), t) - other.beside.begin());
      const Index p = this->Triangles[t].points[corner], q = other.points[far];
      const Index c = this->Triangles[t].points[(corner + 1) % 3],
                  d = this->Triangles[t].points[(corner + 2) % 3];
      const bool convex = this->area(p, c, q) > 0.0L && this->area(p, q, d) > 0.0L;
      // A flip helps if the new edge p-q no longer crosses the segment; occasionally flip anyway.
      const Real sideP = p == a ? 0.0L : this->area(a, b, p),
                 sideQ = q == b ? 0.0L : this->area(a, b, q);
      const bool helps = sideP * sideQ >= 0.0L || (turns + step) % 3 == 2;
      if (convex && helps)
      {
        this->flip(t, corner);
        flipped = true;
      }
      else if (q == b)
      {
        break;
      }
      else
      {
        // Continue to the edge through which the segment leaves the next triangle.
        const bool left = sideQ > 0.0L; // q is left of a-b: the edge on its right side is crossed
        const Index leaving = left ? d : c;
        t = u;
        corner = this->cornerOf(u, leaving);
      }
    }
    if (++turns > 20 * this->Triangles.size() + 1000)
    {
      throw Error(
        "a boundary edge of the mesh could not be preserved: does the boundary intersect itself?");
    }
  }
}

std::vector<std::array<Index, 3>> Triangulation::result() const
{
  std::vector<std::array<Index, 3>> triangles;
  for (const DelaunayTriangle& t : this->Triangles)
  {
    if (t.points[0] < this->Count && t.points[1] < this->Count && t.points[2] < this->Count)
    {
      triangles.push_back(t.points);
    }
  }
  return triangles;
}
}

//------------------------------------------------------------------------------
std::vector<std::array<Index, 3>> constrainedDelaunay(
  const std::vector<double>& points, const std::vector<std::pair<Index, Index>>& segments)
{
  Triangulation triangulation(points);
  const std::vector<Index> order = triangulation.order();
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    throwIfInterrupted();
    LoopProgress::atPass(static_cast<Index>(i), static_cast<Index>(order.size()));
    triangulation.insert(order[i]);
  }
  for (const auto& [a, b] : segments)
  {
    throwIfInterrupted();
    triangulation.recover(a, b);
  }
  return triangulation.result();
}
}
