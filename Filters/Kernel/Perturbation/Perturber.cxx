// SPDX-License-Identifier: BSD-3-Clause
#include "Perturber.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Mesh/BoundaryPoints.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
constexpr int DirectionsTried = 4;
constexpr int HalvingsTried = 30;
constexpr int TanglePasses = 16;
constexpr Index VerticesPerReport = 1024;
constexpr double Never = std::numeric_limits<double>::infinity();

double determinant(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return dot(a, cross(b, c));
}

/// Volatile, because GCC 12 vectorizes a plain round trip over an array away (seen at -O2).
double roundedToFloat(double x)
{
  volatile float rounded = static_cast<float>(x);
  return rounded;
}
}

//------------------------------------------------------------------------------
Perturber::Perturber(const Mesh& mesh, const unsigned char* fixed, const PerturbOptions& options)
  : TheMesh(mesh)
  , Options(options)
  , Adjacency(mesh.vertexCells())
  , Surface(mesh.dimension() == Dimension::Surface)
{
  const MeshView& view = mesh.view();
  this->Result.points.assign(view.points, view.points + 3 * view.numberOfPoints);
  this->States.resize(view.numberOfCells);
  mesh.classifyCells(this->States.data(), options.threads);
  if (this->Surface)
  {
    this->findNormals();
  }
  this->findMovable(fixed);
}

//------------------------------------------------------------------------------
void Perturber::findNormals()
{
  const MeshView& view = this->TheMesh.view();
  this->Normals.assign(view.numberOfCells, Vec3{ 0, 0, 0 });
  for (const CellBlock& block : this->TheMesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      Vec3 p[MaxNodes];
      for (int k = 0; k < t.nodes; ++k)
      {
        p[k] = pointOf(view, node[k]);
      }
      const Vec3 normal = vectorArea(t, p);
      const double length = norm(normal);
      this->Normals[cell] = length > 0 ? (1.0 / length) * normal : normal;
    }
  }
}

//------------------------------------------------------------------------------
void Perturber::findMovable(const unsigned char* fixed)
{
  const MeshView& view = this->TheMesh.view();
  const int dimension = this->TheMesh.dimension() == Dimension::Volume ? 3 : 2;
  // Fixed: the boundary, and the points of cells that are not elements or have no finite shape.
  std::vector<char> stays = boundaryPoints(this->TheMesh, this->Options.threads);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const CellType type = cornerType(view.cellTypes[cell]);
    const bool element = type != CellType::Unsupported && topology(type).dimension == dimension;
    const signed char state = this->States[cell];
    this->Result.elements += element && state >= Inverted;
    this->Result.invertedBefore += element && state == Inverted;
    if (!element || state < Inverted)
    {
      for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
      {
        const Index node = view.connectivity[n];
        if (node >= 0 && node < view.numberOfPoints)
        {
          stays[node] = 1;
        }
      }
    }
  }
  this->Result.invertedAfter = this->Result.invertedBefore;
  for (Index v = 0; v < view.numberOfPoints; ++v)
  {
    const bool used = this->Adjacency.offsets[v] < this->Adjacency.offsets[v + 1];
    if (used && !stays[v] && !(fixed && fixed[v]))
    {
      this->Movable.push_back(v);
    }
  }
  if (this->Options.ids)
  {
    std::sort(this->Movable.begin(), this->Movable.end(),
      [this](Index a, Index b) { return this->idOf(a) < this->idOf(b); });
  }
  this->Result.movable = static_cast<Index>(this->Movable.size());
}

//------------------------------------------------------------------------------
/// The movable vertices in a random order that only depends on the seed and the stream.
std::vector<Index> Perturber::sortedByChance(std::uint64_t stream) const
{
  std::vector<Key> keys;
  keys.reserve(this->Movable.size());
  for (Index v : this->Movable)
  {
    keys.push_back(
      { SplitMix(this->Options.seed, stream, this->idOf(v)).next(), this->idOf(v), v });
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> sorted;
  sorted.reserve(keys.size());
  for (const Key& key : keys)
  {
    sorted.push_back(key.vertex);
  }
  return sorted;
}

//------------------------------------------------------------------------------
bool Perturber::report(double done)
{
  this->Result.stopped = this->Options.progress && !this->Options.progress(done);
  return !this->Result.stopped;
}

//------------------------------------------------------------------------------
/// On a surface, a cell is also inverted if it has rotated by 90 degrees.
Validity Perturber::stateOf(const Neighbour& n) const
{
  const Validity own = this->TheMesh.classifyCell(*n.topology, n.points);
  return this->Surface
    ? std::min(own, this->TheMesh.classifyCell(*n.topology, n.points, &this->Normals[n.cell]))
    : own;
}

//------------------------------------------------------------------------------
/// Copies the cells around a vertex.
void Perturber::gather(Index vertex)
{
  const MeshView& view = this->TheMesh.view();
  const double* points = this->Result.points.data();
  auto at = [&](Index node) {
    return Vec3{ points[3 * node], points[3 * node + 1], points[3 * node + 2] };
  };
  this->Center = at(vertex);
  this->Radius = 0;
  this->Star.clear();
  for (Index i = this->Adjacency.offsets[vertex]; i < this->Adjacency.offsets[vertex + 1]; ++i)
  {
    Neighbour n;
    n.cell = this->Adjacency.cells[i];
    n.topology = &topology(cornerType(view.cellTypes[n.cell]));
    const Index* node = view.connectivity + view.offsets[n.cell];
    for (int k = 0; k < n.topology->nodes; ++k)
    {
      n.points[k] = at(node[k]);
      n.moves[k] = node[k] == vertex;
      this->Radius = std::max(this->Radius, norm(n.points[k] - this->Center));
    }
    this->Star.push_back(n);
  }
}

//------------------------------------------------------------------------------
/// A random unit vector: in space, in the plane, or in the tangent plane at the vertex.
Vec3 Perturber::direction(SplitMix& random) const
{
  if (this->TheMesh.dimension() == Dimension::Volume)
  {
    return random.direction();
  }
  if (!this->Surface)
  {
    return random.direction(this->TheMesh.frame()[0], this->TheMesh.frame()[1]);
  }
  Vec3 normal = { 0, 0, 0 };
  for (const Neighbour& n : this->Star)
  {
    normal += vectorArea(*n.topology, n.points);
  }
  const double length = norm(normal);
  if (!(length > 0))
  {
    return { 0, 0, 0 };
  }
  normal = (1.0 / length) * normal;
  Vec3 axis = { 0, 0, 0 };
  axis[std::abs(normal[0]) < 0.6 ? 0 : 1] = 1.0;
  Vec3 e1 = cross(normal, axis);
  e1 = (1.0 / norm(e1)) * e1;
  return random.direction(e1, cross(normal, e1));
}

//------------------------------------------------------------------------------
/// The determinant at a corner of a cell as a linear function of the distance moved.
Line Perturber::line(const Neighbour& n, int corner, const Vec3& along) const
{
  const auto& node = n.topology->cornerNodes[corner];
  // A 2D corner has the normal as its third edge.
  const Vec3 none = { 0, 0, 0 };
  const Vec3 normal = this->Surface ? this->Normals[n.cell] : this->TheMesh.normal();
  Vec3 edge[3] = { none, none, normal }, change[3] = { none, none, none };
  for (int k = 0; k < n.topology->dimension; ++k)
  {
    edge[k] = n.points[node[k + 1]] - n.points[node[0]];
    change[k] = (double(n.moves[node[k + 1]]) - double(n.moves[node[0]])) * along;
  }
  const double value = determinant(edge[0], edge[1], edge[2]);
  const double scale = norm(edge[0]) * norm(edge[1]) * norm(edge[2]);
  // A corner that vanishes has no sign to change.
  return { std::abs(value) <= Mesh::degenerateTolerance() * scale ? 0.0 : value,
    determinant(change[0], edge[1], edge[2]) + determinant(edge[0], change[1], edge[2]) +
      determinant(edge[0], edge[1], change[2]) };
}

//------------------------------------------------------------------------------
double Perturber::distanceToInversion(const Vec3& along) const
{
  double nearest = this->Radius;
  for (const Neighbour& n : this->Star)
  {
    for (int c = 0; c < n.topology->samples; ++c)
    {
      const Line det = this->line(n, c, along);
      if (det.value * det.slope < 0)
      {
        nearest = std::min(nearest, -det.value / det.slope);
      }
    }
  }
  return nearest;
}

//------------------------------------------------------------------------------
Vec3 Perturber::position(double distance, const Vec3& along) const
{
  Vec3 p = this->Center + distance * along;
  if (this->Options.singlePrecision)
  {
    for (double& x : p)
    {
      x = roundedToFloat(x);
    }
  }
  return p;
}

//------------------------------------------------------------------------------
void Perturber::place(const Vec3& p)
{
  for (Neighbour& n : this->Star)
  {
    for (int k = 0; k < n.topology->nodes; ++k)
    {
      n.points[k] = n.moves[k] ? p : n.points[k];
    }
  }
}

//------------------------------------------------------------------------------
bool Perturber::findStates()
{
  // Whether no cell is worse than before; the new states are complete only in this case.
  this->NewStates.clear();
  for (const Neighbour& n : this->Star)
  {
    this->NewStates.push_back(this->stateOf(n));
    if (this->NewStates.back() < this->States[n.cell])
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// Keeps the new position and the new states of the cells.
void Perturber::accept(Index vertex, const Vec3& p)
{
  std::copy(p.begin(), p.end(), this->Result.points.begin() + 3 * vertex);
  for (std::size_t i = 0; i < this->Star.size(); ++i)
  {
    signed char& state = this->States[this->Star[i].cell];
    this->Result.invertedAfter += (this->NewStates[i] == Inverted) - (state == Inverted);
    state = this->NewStates[i];
  }
}

//------------------------------------------------------------------------------
void Perturber::moveVertex(Index vertex)
{
  this->gather(vertex);
  SplitMix random(this->Options.seed, MoveVertex, this->idOf(vertex));
  for (int i = 0; i < DirectionsTried; ++i)
  {
    this->place(this->Center);
    const Vec3 along = this->direction(random);
    double distance = this->Options.fraction * random.uniform() * this->distanceToInversion(along);
    // The first step is correct except for rounding, warped cells of a surface, and degenerate
    // cells.
    for (int halving = 0; halving < HalvingsTried; ++halving, distance *= 0.5)
    {
      const Vec3 p = this->position(distance, along);
      if (p == this->Center)
      {
        break;
      }
      this->place(p);
      if (this->findStates())
      {
        this->accept(vertex, p);
        return;
      }
    }
  }
}

//------------------------------------------------------------------------------
void Perturber::move()
{
  const double share = this->Options.percentage / 100.0 * static_cast<double>(this->Result.movable);
  const Index count = this->Options.fraction > 0 ? static_cast<Index>(share + 0.5) : 0;
  if (count == 0)
  {
    return;
  }
  std::vector<Index> chosen = this->sortedByChance(ChooseVertex);
  chosen.resize(count);
  std::sort(chosen.begin(), chosen.end(),
    [this](Index a, Index b) { return this->idOf(a) < this->idOf(b); });
  for (Index i = 0; i < count; ++i)
  {
    if (i % VerticesPerReport == 0 && !this->report(static_cast<double>(i) / count))
    {
      return;
    }
    this->moveVertex(chosen[i]);
  }
}

//------------------------------------------------------------------------------
Index Perturber::gain(Index limit)
{
  // The number of additionally inverted elements; no value if it exceeds the limit or creates a
  // degenerate cell.
  this->NewStates.clear();
  Index more = 0;
  for (const Neighbour& n : this->Star)
  {
    const signed char before = this->States[n.cell], after = this->stateOf(n);
    this->NewStates.push_back(after);
    if (after < Inverted || (after == Degenerate && before != Degenerate))
    {
      return 0;
    }
    more += (after == Inverted) - (before == Inverted);
  }
  return more <= limit ? more : 0;
}

//------------------------------------------------------------------------------
Index Perturber::tangleVertex(Index vertex, int pass, Index target, Index limit)
{
  this->gather(vertex);
  SplitMix random(this->Options.seed, TangleVertex + pass, this->idOf(vertex));
  Index best = 0;
  Vec3 bestPoint = this->Center;
  for (int i = 0; i < DirectionsTried && best != target; ++i)
  {
    this->place(this->Center);
    const Vec3 along = this->direction(random);
    // The states of the cells are constant between two sign changes.
    this->Crossings.clear();
    for (const Neighbour& n : this->Star)
    {
      for (int c = 0; c < n.topology->samples; ++c)
      {
        const Line det = this->line(n, c, along);
        const double at = det.value * det.slope < 0 ? -det.value / det.slope : Never;
        if (at < this->Radius)
        {
          this->Crossings.push_back(at);
        }
      }
    }
    this->Crossings.push_back(this->Radius);
    std::sort(this->Crossings.begin(), this->Crossings.end());
    for (std::size_t k = 0; k + 1 < this->Crossings.size() && best != target; ++k)
    {
      // Not too close to either end, where a cell is degenerate.
      const double from = this->Crossings[k], to = this->Crossings[k + 1];
      const double distance = from + (0.25 + 0.5 * random.uniform()) * (to - from);
      const Vec3 p = this->position(distance, along);
      this->place(p);
      const Index more = this->gain(limit);
      if (more > 0 && (best == 0 || std::abs(more - target) < std::abs(best - target)))
      {
        best = more;
        bestPoint = p;
      }
    }
  }
  if (best > 0)
  {
    this->place(bestPoint);
    this->gain(limit);
    this->accept(vertex, bestPoint);
  }
  return best;
}

//------------------------------------------------------------------------------
/// Several passes over the vertices, until enough elements are inverted or none can be added.
void Perturber::tangle()
{
  const double share = this->Options.tangledFraction * static_cast<double>(this->Result.elements);
  const Index target = static_cast<Index>(share + 0.5);
  if (this->Result.stopped || this->Result.invertedAfter >= target)
  {
    return;
  }
  const std::vector<Index> order = this->sortedByChance(OrderTangling);
  for (int pass = 0; pass < TanglePasses; ++pass)
  {
    const Index before = this->Result.invertedAfter;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      const Index missing = target - this->Result.invertedAfter;
      if (missing == 0 ||
        (i % VerticesPerReport == 0 &&
          !this->report(1.0 - static_cast<double>(missing) / static_cast<double>(target))))
      {
        return;
      }
      // Distribute over the remaining vertices.
      const Index left = static_cast<Index>(order.size() - i);
      this->tangleVertex(order[i], pass, (missing + left - 1) / left, missing);
    }
    if (this->Result.invertedAfter == before)
    {
      return;
    }
  }
}

//------------------------------------------------------------------------------
Perturbation Perturber::finish()
{
  const MeshView& view = this->TheMesh.view();
  for (Index v : this->Movable)
  {
    const double* p = this->Result.points.data() + 3 * v;
    const Vec3 now = { p[0], p[1], p[2] }, before = pointOf(view, v);
    this->Result.moved += now != before;
    this->Result.largestDisplacement =
      std::max(this->Result.largestDisplacement, norm(now - before));
  }
  return std::move(this->Result);
}

//------------------------------------------------------------------------------
void checkPerturbation(const Mesh& mesh, const PerturbOptions& options)
{
  auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!within(options.percentage, 0, 100) || !within(options.fraction, 0, 1) ||
    !within(options.tangledFraction, 0, 1))
  {
    throw Error("The percentage must be between 0 and 100, the fraction and the tangled fraction "
                "between 0 and 1.");
  }
  if (mesh.higherOrderCells() > 0)
  {
    throw Error("The mesh has " + std::to_string(mesh.higherOrderCells()) +
      " cells of quadratic or higher order, whose midpoints would stay behind: run Tessellate "
      "first.");
  }
}
}
