/**
 * @file Unwind.h
 * @brief A start for untangling a mesh around holes that were turned: which energies lead into a
 * fold where the elements should wind around the hole. Internal: not installed.
 */
#ifndef tautline_Unwind_h
#define tautline_Unwind_h

#include "GlobalDescent.h"

#include <numeric>

namespace tautline
{
/**
 * @brief The fixed vertices in groups connected by edges, the largest in extent first; other
 * members of a group are in the order of the vertices.
 */
template <int Dim>
std::vector<std::vector<std::int32_t>> fixedGroups(const SimplexMesh& mesh, const double* x)
{
  const std::int32_t free = mesh.freeVertices(), fixed = mesh.vertices() - free;
  std::vector<std::int32_t> parent(fixed);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t i)
  {
    while (parent[i] != i)
    {
      i = parent[i] = parent[parent[i]];
    }
    return i;
  };
  for (std::int32_t s = 0; s < mesh.simplices(); ++s)
  {
    const std::int32_t* corner = mesh.corners() + static_cast<std::size_t>(Dim + 1) * s;
    for (int k = 1, last = corner[0]; k <= Dim; ++k)
    {
      if (corner[k] >= free && last >= free)
      {
        const std::int32_t a = root(last - free), b = root(corner[k] - free);
        parent[std::max(a, b)] = std::min(a, b);
      }
      last = corner[k] >= free ? corner[k] : last;
    }
  }
  std::vector<std::vector<std::int32_t>> groups;
  std::vector<std::int32_t> groupOf(fixed, -1);
  for (std::int32_t i = 0; i < fixed; ++i)
  {
    const std::int32_t r = root(i);
    if (groupOf[r] < 0)
    {
      groupOf[r] = static_cast<std::int32_t>(groups.size());
      groups.emplace_back();
    }
    groups[groupOf[r]].push_back(free + i);
  }
  const auto extent = [&](const std::vector<std::int32_t>& group)
  {
    double sum = 0;
    for (int c = 0; c < Dim; ++c)
    {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (std::int32_t v : group)
      {
        low = std::min(low, x[VertexStride * static_cast<std::size_t>(v) + c]);
        high = std::max(high, x[VertexStride * static_cast<std::size_t>(v) + c]);
      }
      sum += high - low;
    }
    return sum;
  };
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    order.emplace_back(-extent(groups[g]), g);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::vector<std::int32_t>> sorted;
  for (const auto& item : order)
  {
    sorted.push_back(std::move(groups[item.second]));
  }
  return sorted;
}

/// A turn about an axis of coordinates through a point.
struct Turn
{
  Vec3 center = { 0, 0, 0 };
  int axis = 2;
  double angle = 0;

  void apply(double part, double* p) const
  {
    const int a = (this->axis + 1) % 3, b = (this->axis + 2) % 3;
    const double cosine = std::cos(part * this->angle), sine = std::sin(part * this->angle);
    const double u = p[a] - this->center[a], v = p[b] - this->center[b];
    p[a] = this->center[a] + cosine * u - sine * v;
    p[b] = this->center[b] + sine * u + cosine * v;
  }
};

/// A mesh with its holes turned back, and the way from there to where they are.
template <int Dim>
class RotationContinuation
{
public:
  /**
   * @brief Finds for each hole how far its boundary is turned against the rest: the turn back with
   * which the harmonic map has the fewest bad simplices.
   * @param x of the input; not changed
   * @param tolerance of the harmonic maps
   */
  RotationContinuation(const TangledMesh<Dim>& tangled, const double* x, double tolerance);

  /// No turn is better than none.
  bool empty() const { return this->Turns.empty(); }
  /// All vertices, those of the holes turned back and the free ones at the harmonic map.
  const std::vector<double>& start() const { return this->Start; }
  double largestAngle() const
  {
    double largest = 0;
    for (const HoleTurn& hole : this->Turns)
    {
      largest = std::max(largest, std::abs(hole.turn.angle));
    }
    return largest;
  }
  /// Turns the holes, and the vertices around them less the farther away they are, by a part of the
  /// way.
  void advance(double part, double* x) const
  {
    for (const HoleTurn& hole : this->Turns)
    {
      for (std::size_t v = 0; v < hole.weights.size(); ++v)
      {
        if (hole.weights[v] != 0)
        {
          hole.turn.apply(-part * hole.weights[v], x + VertexStride * v);
        }
      }
    }
  }

private:
  struct HoleTurn
  {
    Turn turn;
    std::vector<double>
      weights; ///< per vertex: 1 on the hole, 0 on other fixed ones, harmonic between
  };
  std::vector<double> Start;
  std::vector<HoleTurn> Turns;
};

template <int Dim>
RotationContinuation<Dim>::RotationContinuation(
  const TangledMesh<Dim>& tangled, const double* x, double tolerance)
{
  constexpr int iterations = 1000;
  constexpr std::size_t mostHoles = 8;
  constexpr double pi = 3.14159265358979323846;
  constexpr int steps = Dim == 2 ? 12 : 6; // of a full turn
  const SimplexMesh& mesh = tangled.mesh();
  const auto groups = fixedGroups<Dim>(mesh, x);
  if (groups.size() < 2)
  {
    return;
  }
  std::vector<double> turned(x, x + static_cast<std::size_t>(VertexStride) * mesh.vertices());
  std::vector<double> map;
  const auto score = [&](const std::vector<double>& from)
  {
    map = from;
    return harmonicMap<Dim>(mesh, map.data(), tolerance, iterations, tangled.threads())
      ? tangled.examine(map.data()).bad
      : std::numeric_limits<Index>::max();
  };
  Index fewest = score(turned);
  this->Start = map;
  for (std::size_t g = 1; g < std::min(mostHoles + 1, groups.size()); ++g)
  {
    Turn turn;
    for (std::int32_t v : groups[g])
    {
      for (int c = 0; c < Dim; ++c)
      {
        turn.center[c] +=
          x[VertexStride * static_cast<std::size_t>(v) + c] / static_cast<double>(groups[g].size());
      }
    }
    Turn chosen = turn;
    const std::vector<double> before = turned;
    for (turn.axis = Dim == 2 ? 2 : 0; turn.axis < 3; ++turn.axis)
    {
      for (int step = 1; step < steps && fewest > 0; ++step)
      {
        turn.angle = 2.0 * pi * step / steps;
        turn.angle -= turn.angle > pi ? 2.0 * pi : 0.0;
        std::vector<double> trial = before;
        for (std::int32_t v : groups[g])
        {
          turn.apply(1.0, &trial[VertexStride * static_cast<std::size_t>(v)]);
        }
        const Index bad = score(trial);
        if (bad < fewest)
        {
          fewest = bad;
          this->Start = map;
          turned = trial;
          chosen = turn;
        }
      }
    }
    if (chosen.angle != 0)
    {
      std::fill(map.begin(), map.end(), 0.0);
      for (std::int32_t v : groups[g])
      {
        map[VertexStride * static_cast<std::size_t>(v)] = 1.0;
      }
      harmonicMap<Dim>(mesh, map.data(), tolerance, iterations, tangled.threads());
      std::vector<double> weights(mesh.vertices());
      for (std::size_t v = 0; v < weights.size(); ++v)
      {
        weights[v] = map[VertexStride * v];
      }
      this->Turns.push_back({ chosen, std::move(weights) });
    }
  }
}
}
#endif
