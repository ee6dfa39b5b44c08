// SPDX-License-Identifier: BSD-3-Clause
#include "DegenerateCells.h"

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

namespace tautline
{
namespace
{
/// Fraction of the longest edge: the ends of a shorter edge coincide.
constexpr double ShortEdge = 1e-9;
/// Fraction of the longest edge: a point closer to another edge is on it.
constexpr double OnEdge = 1e-9;
/// The number of operations per degenerate input cell, after which the remaining ones are kept.
constexpr Index OperationsPerCell = 50;

using Nodes = std::array<Index, 4>; ///< for a triangle, the last one is -1
using Simplex = std::vector<Index>; ///< in increasing order

class CellRemover
{
public:
  CellRemover(const Mesh& mesh, const DegenerateOptions& options);
  DegenerateRemoval run();

private:
  bool has(Index cell, Index point) const;
  Vec3 at(Index point) const { return pointOf(this->TheMesh.view(), point); }
  Validity validityOf(const Nodes& nodes) const;
  Vec3 normalOf(const Nodes& nodes) const;
  Simplex sortedNodes(Index cell) const;
  Nodes replaced(Index cell, Index from, Index to) const;
  bool follows(Index cell, const Nodes& nodes, bool mayVanish) const;
  std::vector<Index> cellsAt(const Simplex& points) const;
  void add(const Nodes& nodes, Index origin);
  void remove(Index cell) { this->Alive[cell] = 0; }
  std::set<Simplex> linkOf(const Simplex& face) const;
  bool mayMerge(Index from, Index to) const;
  bool merge(Index from, Index to);
  bool divide(const Simplex& face, Index by);
  template <class Marks>
  static void divideMarks(const Simplex& face, Index by, Marks& marks, std::vector<Index>& origins);
  bool isOpen(Simplex facet) const;
  bool dropFlat(Index cell, const Simplex& edge);
  bool treat(Index cell);
  bool treatTriangle(const Nodes& nodes);
  bool treatTetrahedron(Index cell);
  bool divideEdge(const Nodes& nodes);
  bool divideFace(const Nodes& nodes);
  bool mergeShortest(const Nodes& nodes);
  bool treatAll();
  void collect(DegenerateRemoval& result);

  const Mesh& TheMesh;
  const DegenerateOptions& Options;
  const CellTopology& T;
  int Corners;
  std::vector<Nodes> Cells;
  std::vector<char> Alive;
  std::vector<Index> Origins;
  std::vector<std::vector<Index>> CellsOf; ///< per point; including deleted cells
  std::vector<Index> MergedInto;
  std::vector<std::array<Index, 2>> Edges;
  std::vector<std::array<Index, 3>> Facets;
  std::vector<Index> EdgeOrigins, FacetOrigins;
  std::deque<Index> Waiting;
};

const CellTopology& simplexOf(const Mesh& mesh)
{
  return topology(
    mesh.dimension() == Dimension::Volume ? CellType::Tetrahedron : CellType::Triangle);
}

Simplex sorted(Simplex simplex)
{
  std::sort(simplex.begin(), simplex.end());
  return simplex;
}

//------------------------------------------------------------------------------
CellRemover::CellRemover(const Mesh& mesh, const DegenerateOptions& options)
  : TheMesh(mesh)
  , Options(options)
  , T(simplexOf(mesh))
  , Corners(T.nodes)
  , CellsOf(mesh.view().numberOfPoints)
  , MergedInto(mesh.view().numberOfPoints)
  , Edges(options.edges)
  , Facets(options.facets)
  , EdgeOrigins(options.edges.size())
  , FacetOrigins(options.facets.size())
{
  std::iota(this->EdgeOrigins.begin(), this->EdgeOrigins.end(), Index(0));
  std::iota(this->FacetOrigins.begin(), this->FacetOrigins.end(), Index(0));
  std::iota(this->MergedInto.begin(), this->MergedInto.end(), Index(0));
  const MeshView& view = mesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    Nodes nodes = { -1, -1, -1, -1 };
    std::copy_n(view.connectivity + view.offsets[cell], this->Corners, nodes.begin());
    this->add(nodes, cell);
  }
}

bool CellRemover::has(Index cell, Index point) const
{
  const auto begin = this->Cells[cell].begin(), end = begin + this->Corners;
  return std::find(begin, end, point) != end;
}

Validity CellRemover::validityOf(const Nodes& nodes) const
{
  Vec3 p[MaxNodes];
  for (int k = 0; k < this->Corners; ++k)
  {
    p[k] = this->at(nodes[k]);
  }
  return this->TheMesh.classifyCell(this->T, p);
}

Vec3 CellRemover::normalOf(const Nodes& nodes) const
{
  const Vec3 a = this->at(nodes[0]);
  return cross(this->at(nodes[1]) - a, this->at(nodes[2]) - a);
}

Simplex CellRemover::sortedNodes(Index cell) const
{
  return sorted(Simplex(this->Cells[cell].begin(), this->Cells[cell].begin() + this->Corners));
}

Nodes CellRemover::replaced(Index cell, Index from, Index to) const
{
  Nodes nodes = this->Cells[cell];
  std::replace(nodes.begin(), nodes.end(), from, to);
  return nodes;
}

/// Whether a cell may get other nodes: its orientation must not change.
/// @param mayVanish whether it may become degenerate
bool CellRemover::follows(Index cell, const Nodes& nodes, bool mayVanish) const
{
  const Validity before = this->validityOf(this->Cells[cell]), after = this->validityOf(nodes);
  if (before != Valid)
  {
    return after != Inverted;
  }
  if (after != Valid)
  {
    return after == Degenerate && mayVanish;
  }
  // A triangle in space has no sign: its normal must not turn by more than 90 degrees.
  return this->Corners == 4 || dot(this->normalOf(this->Cells[cell]), this->normalOf(nodes)) > 0;
}

/// The cells that contain all given points.
std::vector<Index> CellRemover::cellsAt(const Simplex& points) const
{
  std::vector<Index> cells;
  for (Index cell : this->CellsOf[points[0]])
  {
    if (this->Alive[cell] &&
      std::all_of(points.begin(), points.end(), [&](Index p) { return this->has(cell, p); }))
    {
      cells.push_back(cell);
    }
  }
  return cells;
}

void CellRemover::add(const Nodes& nodes, Index origin)
{
  const auto cell = static_cast<Index>(this->Cells.size());
  this->Cells.push_back(nodes);
  this->Alive.push_back(1);
  this->Origins.push_back(origin);
  for (int k = 0; k < this->Corners; ++k)
  {
    this->CellsOf[nodes[k]].push_back(cell);
  }
  if (this->validityOf(nodes) == Degenerate)
  {
    this->Waiting.push_back(cell);
  }
}

//------------------------------------------------------------------------------
/// Adds all faces of a simplex, including itself.
void addFaces(const Simplex& simplex, std::set<Simplex>& faces)
{
  // Each number from 1 on stands for a nonempty subset of the corners.
  for (unsigned chosen = 1; chosen < 1U << simplex.size(); ++chosen)
  {
    Simplex face;
    for (std::size_t k = 0; k < simplex.size(); ++k)
    {
      if ((chosen >> k & 1U) != 0)
      {
        face.push_back(simplex[k]);
      }
    }
    faces.insert(face);
  }
}

Simplex without(const Simplex& simplex, const Simplex& face)
{
  Simplex rest;
  std::set_difference(
    simplex.begin(), simplex.end(), face.begin(), face.end(), std::back_inserter(rest));
  return rest;
}

/// The link of a point or edge in the mesh extended by a cone over its boundary with apex -1.
std::set<Simplex> CellRemover::linkOf(const Simplex& face) const
{
  std::map<Simplex, int> facets;
  std::set<Simplex> link;
  for (Index cell : this->cellsAt(face))
  {
    const Simplex all = this->sortedNodes(cell), rest = without(all, face);
    addFaces(rest, link);
    for (Index opposite : rest)
    {
      ++facets[without(all, { opposite })];
    }
  }
  for (const auto& [facet, uses] : facets)
  {
    // Boundary facets are extended to the apex -1, so that the condition also protects the
    // boundary.
    if (uses == 1)
    {
      Simplex cone = without(facet, face);
      cone.insert(cone.begin(), -1);
      addFaces(cone, link);
    }
  }
  return link;
}

/// Whether the mesh keeps its topology (the link condition) and orientation.
bool CellRemover::mayMerge(Index from, Index to) const
{
  if (this->Options.fixed && this->Options.fixed[from])
  {
    return false;
  }
  const std::set<Simplex> one = this->linkOf({ from }), other = this->linkOf({ to });
  std::set<Simplex> both;
  std::set_intersection(
    one.begin(), one.end(), other.begin(), other.end(), std::inserter(both, both.begin()));
  // The link of the edge must be the intersection of the links of its ends (Dey et al., 1999).
  if (both != this->linkOf(sorted(Simplex{ from, to })))
  {
    return false;
  }
  const std::vector<Index> cells = this->cellsAt({ from });
  return std::all_of(cells.begin(), cells.end(),
    [&](Index cell)
    { return this->has(cell, to) || this->follows(cell, this->replaced(cell, from, to), false); });
}

bool CellRemover::merge(Index from, Index to)
{
  if (!this->mayMerge(from, to))
  {
    return false;
  }
  for (Index cell : this->cellsAt({ from }))
  {
    if (!this->has(cell, to))
    {
      this->add(this->replaced(cell, from, to), this->Origins[cell]);
    }
    this->remove(cell);
  }
  this->MergedInto[from] = to;
  const auto rename = [&](auto& marks)
  {
    for (auto& mark : marks)
    {
      std::replace(mark.begin(), mark.end(), from, to);
    }
  };
  rename(this->Edges);
  rename(this->Facets);
  return true;
}

//------------------------------------------------------------------------------
/// Divides the cells at an edge or a face by a point on it; cells that contain the point vanish.
bool CellRemover::divide(const Simplex& face, Index by)
{
  const std::vector<Index> cells = this->cellsAt(face);
  // All parts are checked first, so that a failure leaves the mesh unchanged.
  for (Index cell : cells)
  {
    for (Index corner : face)
    {
      if (!this->has(cell, by) && !this->follows(cell, this->replaced(cell, corner, by), true))
      {
        return false;
      }
    }
  }
  for (Index cell : cells)
  {
    for (Index corner : face)
    {
      if (!this->has(cell, by))
      {
        this->add(this->replaced(cell, corner, by), this->Origins[cell]);
      }
    }
    this->remove(cell);
  }
  divideMarks(face, by, this->Edges, this->EdgeOrigins);
  divideMarks(face, by, this->Facets, this->FacetOrigins);
  return true;
}

/// Marked edges or facets follow a division.
template <class Marks>
void CellRemover::divideMarks(
  const Simplex& face, Index by, Marks& marks, std::vector<Index>& origins)
{
  const std::size_t count = marks.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto mark = marks[i];
    const auto isIn = [&mark](Index p)
    { return std::find(mark.begin(), mark.end(), p) != mark.end(); };
    if (!std::all_of(face.begin(), face.end(), isIn) || isIn(by))
    {
      continue;
    }
    for (std::size_t k = 0; k < face.size(); ++k)
    {
      auto part = mark;
      std::replace(part.begin(), part.end(), face[k], by);
      if (k == 0)
      {
        marks[i] = part;
      }
      else
      {
        marks.push_back(part);
        origins.push_back(origins[i]);
      }
    }
  }
}

//------------------------------------------------------------------------------
bool CellRemover::mergeShortest(const Nodes& nodes)
{
  double shortest = HUGE_VAL, longest = 0;
  std::array<Index, 2> ends = { -1, -1 };
  for (int e = 0; e < this->T.edges; ++e)
  {
    const Index a = nodes[this->T.edgeNodes[e][0]], b = nodes[this->T.edgeNodes[e][1]];
    const double length = norm(this->at(b) - this->at(a));
    longest = std::max(longest, length);
    if (length < shortest)
    {
      shortest = length;
      ends = { a, b };
    }
  }
  return shortest <= ShortEdge * longest &&
    (this->merge(ends[0], ends[1]) || this->merge(ends[1], ends[0]));
}

/// In a triangle, the point opposite its longest edge is on this edge.
bool CellRemover::treatTriangle(const Nodes& nodes)
{
  int longest = 0;
  double length = 0;
  for (int k = 0; k < 3; ++k)
  {
    const double own = norm(this->at(nodes[(k + 1) % 3]) - this->at(nodes[k]));
    longest = own > length ? k : longest;
    length = std::max(length, own);
  }
  return this->divide({ nodes[longest], nodes[(longest + 1) % 3] }, nodes[(longest + 2) % 3]);
}

/// In a tetrahedron, a point on the edge between two others.
bool CellRemover::divideEdge(const Nodes& nodes)
{
  double longest = 0;
  for (int e = 0; e < this->T.edges; ++e)
  {
    longest = std::max(longest,
      norm(this->at(nodes[this->T.edgeNodes[e][0]]) - this->at(nodes[this->T.edgeNodes[e][1]])));
  }
  for (Index by : nodes)
  {
    for (int e = 0; e < this->T.edges; ++e)
    {
      const Index a = nodes[this->T.edgeNodes[e][0]], b = nodes[this->T.edgeNodes[e][1]];
      const Vec3 along = this->at(b) - this->at(a), to = this->at(by) - this->at(a);
      const double s = dot(to, along), length2 = dot(along, along);
      if (a != by && b != by && s > 0 && s < length2 &&
        norm(cross(along, to)) <= OnEdge * longest * std::sqrt(length2) &&
        this->divide({ a, b }, by))
      {
        return true;
      }
    }
  }
  return false;
}

/// In a flat tetrahedron, a point in the face of the others: the areas with their edges have the
/// same orientation.
bool CellRemover::divideFace(const Nodes& nodes)
{
  for (int k = 0; k < 4; ++k)
  {
    const Index by = nodes[k], a = nodes[(k + 1) % 4], b = nodes[(k + 2) % 4],
                c = nodes[(k + 3) % 4];
    const Vec3 n = cross(this->at(b) - this->at(a), this->at(c) - this->at(a));
    const auto part = [&](Index from, Index to)
    { return dot(n, cross(this->at(from) - this->at(by), this->at(to) - this->at(by))); };
    if (part(a, b) > 0 && part(b, c) > 0 && part(c, a) > 0 && this->divide({ a, b, c }, by))
    {
      return true;
    }
  }
  return false;
}

/// Whether a facet has one cell, and is not marked.
bool CellRemover::isOpen(Simplex facet) const
{
  facet = sorted(facet);
  const bool marked = std::any_of(this->Facets.begin(), this->Facets.end(),
    [&facet](const std::array<Index, 3>& mark)
    { return sorted(Simplex(mark.begin(), mark.end())) == facet; });
  return !marked && this->cellsAt(facet).size() == 1;
}

/// Drops a flat tetrahedron with two boundary facets at an edge; the boundary stays in place, with
/// the opposite edge.
bool CellRemover::dropFlat(Index cell, const Simplex& edge)
{
  const Simplex others = without(this->sortedNodes(cell), edge);
  const Vec3 a = this->at(edge[0]), b = this->at(edge[1]), c = this->at(others[0]),
             d = this->at(others[1]);
  const Vec3 n = cross(b - a, d - c);
  const auto parts = [&n](const Vec3& from, const Vec3& to, const Vec3& p, const Vec3& q)
  { return dot(n, cross(to - from, p - from)) * dot(n, cross(to - from, q - from)) < 0; };
  // The two opposite edges must cross each other in the projection: the tetrahedron is a flat
  // quadrilateral.
  if (!parts(a, b, c, d) || !parts(c, d, a, b) || this->cellsAt(edge).size() != 1 ||
    !this->isOpen({ edge[0], edge[1], others[0] }) ||
    !this->isOpen({ edge[0], edge[1], others[1] }))
  {
    return false;
  }
  this->remove(cell);
  return true;
}

bool CellRemover::treatTetrahedron(Index cell)
{
  const Nodes nodes = this->Cells[cell];
  if (this->divideEdge(nodes) || this->divideFace(nodes))
  {
    return true;
  }
  for (int e = 0; e < this->T.edges; ++e)
  {
    if (this->dropFlat(
          cell, sorted(Simplex{ nodes[this->T.edgeNodes[e][0]], nodes[this->T.edgeNodes[e][1]] })))
    {
      return true;
    }
  }
  return false;
}

bool CellRemover::treat(Index cell)
{
  const Simplex points = this->sortedNodes(cell);
  if (std::adjacent_find(points.begin(), points.end()) != points.end())
  {
    this->remove(cell); // its two neighbors have the same facet
    return true;
  }
  const Nodes nodes = this->Cells[cell];
  return this->mergeShortest(nodes) ||
    (this->Corners == 3 ? this->treatTriangle(nodes) : this->treatTetrahedron(cell));
}

//------------------------------------------------------------------------------
/// Treats all cells once; returns whether anything changed.
bool CellRemover::treatAll()
{
  Index operations = OperationsPerCell * static_cast<Index>(this->Waiting.size());
  bool changed = false;
  // Some cells can only be removed after others.
  for (bool again = true; again && operations > 0;)
  {
    again = false;
    std::deque<Index> kept;
    while (!this->Waiting.empty() && operations-- > 0)
    {
      const Index cell = this->Waiting.front();
      this->Waiting.pop_front();
      if (this->Alive[cell] && this->treat(cell))
      {
        again = changed = true;
      }
      else if (this->Alive[cell])
      {
        kept.push_back(cell);
      }
    }
    this->Waiting.insert(this->Waiting.end(), kept.begin(), kept.end());
  }
  return changed;
}

/// The parts of a cell take its position; the other cells keep their order.
void CellRemover::collect(DegenerateRemoval& result)
{
  std::vector<Index> order;
  for (Index cell = 0; cell < static_cast<Index>(this->Cells.size()); ++cell)
  {
    if (this->Alive[cell])
    {
      order.push_back(cell);
    }
  }
  std::stable_sort(order.begin(), order.end(),
    [this](Index a, Index b) { return this->Origins[a] < this->Origins[b]; });
  for (Index cell : order)
  {
    const Nodes& nodes = this->Cells[cell];
    result.cells.insert(result.cells.end(), nodes.begin(), nodes.begin() + this->Corners);
    result.originalCells.push_back(this->Origins[cell]);
  }
  // Points may have been merged into points that were merged later.
  for (Index& to : this->MergedInto)
  {
    while (this->MergedInto[to] != to)
    {
      to = this->MergedInto[to];
    }
  }
  result.mergedInto = std::move(this->MergedInto);
  result.edges = std::move(this->Edges);
  result.facets = std::move(this->Facets);
  result.originalEdges = std::move(this->EdgeOrigins);
  result.originalFacets = std::move(this->FacetOrigins);
}

DegenerateRemoval CellRemover::run()
{
  DegenerateRemoval result;
  result.degenerate = static_cast<Index>(this->Waiting.size());
  const bool changed = this->treatAll();
  result.left = std::count_if(this->Waiting.begin(), this->Waiting.end(),
    [this](Index cell) { return this->Alive[cell] != 0; });
  if (changed)
  {
    this->collect(result);
  }
  return result;
}
}

//------------------------------------------------------------------------------
DegenerateRemoval removeDegenerateCells(const Mesh& mesh, const DegenerateOptions& options)
{
  const bool simplices = mesh.blocks().size() == 1 && mesh.unsupportedCells() == 0 &&
    mesh.higherOrderCells() == 0 && mesh.blocks()[0].type == simplexOf(mesh).type;
  if (!simplices || mesh.nonFinitePoints() > 0)
  {
    return {};
  }
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data());
  if (std::find(validity.begin(), validity.end(), Degenerate) == validity.end())
  {
    return {};
  }
  return CellRemover(mesh, options).run();
}
}
