// SPDX-License-Identifier: BSD-3-Clause
#include "Unfold.h"

#include "tautline/Mesh/JacobianBounds.h"

#include <algorithm>

namespace tautline
{
namespace
{
// Determinants over the mean product of the edge lengths at a corner of an element: the target of a
// step, and the minimum that it must leave to every element it affects.
constexpr double target = 0.1, enough = 0.02;

/// An element with its smallest determinant.
struct Element
{
  Index cell = 0;
  const CellTopology* topology = nullptr;
  Vec3 p[MaxNodes];
  JacobianMinimum minimum;
  double scale = 0; ///< mean product of the lengths of the edges at a corner

  double relative() const { return this->scale > 0 ? this->minimum.value / this->scale : 0.0; }
};

class Unfolder
{
public:
  Unfolder(const Mesh& mesh, const std::vector<char>& free, std::vector<double>& points,
    std::vector<signed char>& validity)
    : TheMesh(mesh)
    , Free(free)
    , Points(points)
    , State(validity)
    , Cells(mesh.vertexCells())
    , Blocked(mesh.view().numberOfCells, 0)
  {
  }

  /// One pass; returns whether a step was taken and `proceed` returned true.
  bool pass(const std::function<bool()>& proceed)
  {
    bool moved = false;
    for (Index cell : this->poorCells())
    {
      if (!this->Blocked[cell])
      {
        if (!proceed())
        {
          return false;
        }
        this->Blocked[cell] = !this->improve(cell);
        moved = moved || !this->Blocked[cell];
      }
    }
    return moved;
  }

private:
  bool isVolume(Index cell) const
  {
    const CellType type = cornerType(this->TheMesh.view().cellTypes[cell]);
    return type != CellType::Unsupported && topology(type).dimension == 3;
  }
  const Index* nodes(Index cell) const
  {
    return this->TheMesh.view().connectivity + this->TheMesh.view().offsets[cell];
  }

  void vertices(Index cell, Vec3* p) const
  {
    const MeshView& view = this->TheMesh.view();
    for (Index n = view.offsets[cell], k = 0; n < view.offsets[cell + 1] && k < MaxNodes; ++n, ++k)
    {
      const double* at = &this->Points[3 * view.connectivity[n]];
      p[k] = { at[0], at[1], at[2] };
    }
  }
  bool cornersValid(Index cell) const
  {
    Vec3 p[MaxNodes];
    this->vertices(cell, p);
    const CellType type = cornerType(this->TheMesh.view().cellTypes[cell]);
    return this->TheMesh.classifyCorners(topology(type), p) == Valid;
  }
  Element element(Index cell) const;
  std::vector<Index> poorCells() const;
  std::vector<Index> cellsAt(const Index* nodes, int count) const;
  bool improve(Index cell);
  bool step(const Element& element, int only);
  bool tryStep(const Element& element, const Vec3* steps, const std::vector<Element>& around);

  const Mesh& TheMesh;
  const std::vector<char>& Free;
  std::vector<double>& Points;
  std::vector<signed char>& State;
  const VertexCells Cells;
  std::vector<char> Blocked; ///< per cell: no step helped, and no surrounding point has moved since
};

//------------------------------------------------------------------------------
/// The mirror image if the mesh is treated as mirrored.
Element Unfolder::element(Index cell) const
{
  Element e;
  e.cell = cell;
  e.topology = &topology(cornerType(this->TheMesh.view().cellTypes[cell]));
  const CellTopology& t = *e.topology;
  this->vertices(cell, e.p);
  for (int k = 0; k < t.nodes && this->TheMesh.mirrored(); ++k)
  {
    e.p[k][0] = -e.p[k][0];
  }
  e.minimum.value = HUGE_VAL;
  for (int c = 0; c < t.samples; ++c)
  {
    const auto& corner = t.cornerNodes[c];
    const Vec3 a = e.p[corner[1]] - e.p[corner[0]], b = e.p[corner[2]] - e.p[corner[0]];
    const Vec3 d = e.p[corner[3]] - e.p[corner[0]];
    e.scale += norm(a) * norm(b) * norm(d) / t.samples;
    e.minimum.value = std::min(e.minimum.value, dot(a, cross(b, d)));
  }
  if (hasInside(t.type))
  {
    e.minimum = minimumJacobian(t, e.p);
  }
  return e;
}

/// The cells at some nodes, each once.
std::vector<Index> Unfolder::cellsAt(const Index* nodes, int count) const
{
  std::vector<Index> cells;
  for (int k = 0; k < count; ++k)
  {
    if (this->Free[nodes[k]])
    {
      cells.insert(cells.end(), this->Cells.cells.begin() + this->Cells.offsets[nodes[k]],
        this->Cells.cells.begin() + this->Cells.offsets[nodes[k] + 1]);
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  cells.erase(
    std::remove_if(cells.begin(), cells.end(), [&](Index c) { return !isVolume(c); }), cells.end());
  return cells;
}

/// Cells that are valid only at the corners, and their neighbors that are poor enough to obstruct
/// them.
std::vector<Index> Unfolder::poorCells() const
{
  std::vector<Index> poor;
  const Index cells = this->TheMesh.view().numberOfCells;
  for (Index cell = 0; cell < cells; ++cell)
  {
    const signed char v = this->State[cell];
    if ((v != Inverted && v != Degenerate) || !this->isVolume(cell) || !this->cornersValid(cell))
    {
      continue;
    }
    poor.push_back(cell);
    const int count = topology(cornerType(this->TheMesh.view().cellTypes[cell])).nodes;
    for (Index next : this->cellsAt(this->nodes(cell), count))
    {
      const Element e = this->element(next);
      if (hasInside(e.topology->type) && e.relative() < enough)
      {
        poor.push_back(next);
      }
    }
  }
  std::sort(poor.begin(), poor.end());
  poor.erase(std::unique(poor.begin(), poor.end()), poor.end());
  return poor;
}

//------------------------------------------------------------------------------
/// Several steps of one element, by all its vertices or, if that fails, by single ones.
bool Unfolder::improve(Index cell)
{
  constexpr int steps = 10;
  bool moved = false;
  for (int i = 0; i < steps; ++i)
  {
    const Element e = this->element(cell);
    if (!hasInside(e.topology->type) || e.relative() >= target)
    {
      break;
    }
    bool improved = this->step(e, -1);
    for (int k = 0; k < e.topology->nodes && !improved; ++k)
    {
      improved = this->step(e, k);
    }
    if (!improved)
    {
      break;
    }
    moved = true;
  }
  return moved;
}

/// A step along the gradient of the smallest determinant, by all free vertices or one.
bool Unfolder::step(const Element& e, int only)
{
  constexpr double longest = 0.3; // relative to the mean edge length at a corner
  constexpr int halvings = 7;
  const CellTopology& t = *e.topology;
  Vec3 gradient[MaxNodes] = {};
  addJacobianGradient(t, e.p, e.minimum.at, 1.0, gradient);
  double length2 = 0, largest = 0;
  for (int k = 0; k < t.nodes; ++k)
  {
    const bool moves = this->Free[this->nodes(e.cell)[k]] && (only < 0 || only == k);
    gradient[k] = moves ? gradient[k] : Vec3{ 0, 0, 0 };
    length2 += dot(gradient[k], gradient[k]);
    largest = std::max(largest, norm(gradient[k]));
  }
  if (!(length2 > 0) || !std::isfinite(length2))
  {
    return false;
  }
  std::vector<Element> around;
  for (Index cell : this->cellsAt(this->nodes(e.cell), t.nodes))
  {
    around.push_back(this->element(cell));
  }
  double size = std::min(
    (target * e.scale - e.minimum.value) / length2, longest * std::cbrt(e.scale) / largest);
  for (int i = 0; i < halvings; ++i, size *= 0.5)
  {
    Vec3 steps[MaxNodes];
    for (int k = 0; k < t.nodes; ++k)
    {
      steps[k] = size * gradient[k];
      steps[k][0] *= this->TheMesh.mirrored() ? -1 : 1;
    }
    if (this->tryStep(e, steps, around))
    {
      return true;
    }
  }
  return false;
}

/// Accepts a step if it improves the element and leaves the required minimum to all others.
bool Unfolder::tryStep(const Element& e, const Vec3* steps, const std::vector<Element>& around)
{
  constexpr double worthwhile = 1e-3;
  const int count = e.topology->nodes;
  Vec3 before[MaxNodes];
  for (int k = 0; k < count; ++k)
  {
    double* p = &this->Points[3 * this->nodes(e.cell)[k]];
    before[k] = { p[0], p[1], p[2] };
    const Vec3 after = before[k] + steps[k];
    if (norm(steps[k]) > 0)
    {
      std::copy(after.begin(), after.end(), p);
    }
  }
  std::vector<signed char> verdicts;
  bool accepted = true;
  for (std::size_t i = 0; i < around.size() && accepted; ++i)
  {
    const Element& was = around[i];
    const Element is = this->element(was.cell);
    const double needed =
      was.cell == e.cell ? was.relative() + worthwhile * target : std::min(was.relative(), enough);
    accepted = is.relative() >= needed;
    if (accepted)
    {
      Vec3 p[MaxNodes];
      this->vertices(was.cell, p);
      verdicts.push_back(this->TheMesh.classifyCell(*is.topology, p));
      accepted = verdicts.back() >= this->State[was.cell];
    }
  }
  if (!accepted)
  {
    for (int k = 0; k < count; ++k)
    {
      std::copy(before[k].begin(), before[k].end(), &this->Points[3 * this->nodes(e.cell)[k]]);
    }
    return false;
  }
  for (std::size_t i = 0; i < around.size(); ++i)
  {
    this->State[around[i].cell] = verdicts[i];
    this->Blocked[around[i].cell] = 0;
  }
  return true;
}
}

//------------------------------------------------------------------------------
void unfold(const Mesh& mesh, const std::vector<char>& free, std::vector<double>& points,
  std::vector<signed char>& validity, const std::function<bool()>& proceed)
{
  constexpr int maxPasses = 30;
  Unfolder unfolder(mesh, free, points, validity);
  for (int pass = 0; pass < maxPasses && unfolder.pass(proceed); ++pass)
  {
  }
}
}
