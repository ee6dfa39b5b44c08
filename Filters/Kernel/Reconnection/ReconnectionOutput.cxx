// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectionOutput.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <limits>
#include <unordered_set>

namespace tautline
{
namespace
{
/// Cells visited on the straight way to a point and in the search around, and the negative weight
/// that is rounding.
constexpr std::size_t MaxWalked = 400, MaxSearched = 20000;
constexpr double WeightTolerance = -1e-12;
}

InputLocator::InputLocator(const TetrahedronMesh& mesh, const ReconnectionInput& input)
  : Input(input)
  , Neighbors(mesh.slots())
{
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    this->Neighbors[t] = mesh.tet(t).neighbors;
  }
}

bool InputLocator::isWall(std::int32_t neighbor, TetId t) const
{
  return neighbor == NoId ||
    (!this->Input.regions.empty() && this->Input.regions[neighbor >> 2] != this->Input.regions[t]);
}

std::array<double, 4> InputLocator::weights(const Vec3& x, TetId cell) const
{
  const TetVertices& v = this->Input.cells[cell];
  const auto p = [&](int k) { return this->Input.points[v[k]]; };
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
  { return dot(cross(b - a, c - a), d - a); };
  std::array<double, 4> w;
  double sum = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    const int* f = OppositeFace[i];
    w[i] = volume(x, p(f[0]), p(f[1]), p(f[2]));
    sum += w[i];
  }
  for (double& weight : w)
  {
    weight /= sum;
  }
  return w;
}

TetId InputLocator::locate(const Vec3& x, TetId start) const
{
  // Straight on, over the face that x is farthest beyond, as long as there is a neighbour.
  TetId t = start;
  for (std::size_t i = 0; i < MaxWalked; ++i)
  {
    const std::array<double, 4> w = this->weights(x, t);
    const auto least = std::min_element(w.begin(), w.end());
    if (*least >= WeightTolerance)
    {
      return t;
    }
    const std::int32_t n = this->Neighbors[t][least - w.begin()];
    if (this->isWall(n, t))
    {
      break;
    }
    t = n >> 2;
  }
  return this->search(x, start);
}

/// Looks at the cells around in turn.
TetId InputLocator::search(const Vec3& x, TetId start) const
{
  std::vector<TetId> queue = { start };
  std::unordered_set<TetId> known = { start };
  TetId nearest = start;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < queue.size() && i < MaxSearched; ++i)
  {
    const TetId t = queue[i];
    const std::array<double, 4> w = this->weights(x, t);
    const double least = *std::min_element(w.begin(), w.end());
    if (least > best)
    {
      best = least;
      nearest = t;
      if (best >= WeightTolerance)
      {
        break;
      }
    }
    for (std::int32_t n : this->Neighbors[t])
    {
      if (!this->isWall(n, t) && known.insert(n >> 2).second)
      {
        queue.push_back(n >> 2);
      }
    }
  }
  return nearest;
}

//------------------------------------------------------------------------------
namespace
{
/// Numbers the points of the output and writes them; returns the new number per slot, or -1.
std::vector<Index> writePoints(const Mesh& mesh, const ReconnectionInput& input,
  const TetrahedronMesh& changed, ReconnectionResult& result)
{
  const MeshView& view = mesh.view();
  std::vector<char> inInput(view.numberOfPoints, 0);
  for (const TetVertices& cell : input.cells)
  {
    for (PointId v : cell)
    {
      inInput[v] = 1;
    }
  }
  std::vector<Index> numbers(changed.pointSlots(), -1);
  Index count = 0;
  for (PointId v = 0; v < changed.pointSlots(); ++v)
  {
    pollInterruption(static_cast<Index>(v));
    const bool original = v < view.numberOfPoints;
    if (!changed.used(v) && !(original && !inInput[v]))
    {
      continue;
    }
    numbers[v] = count++;
    const bool moved = !original || changed.point(v) != input.points[v];
    for (int k = 0; k < 3; ++k)
    {
      result.points.push_back(
        moved ? std::ldexp(changed.point(v)[k], input.exponent) : view.points[3 * v + k]);
    }
    result.originalPoints.push_back(original ? v : -1);
  }
  return numbers;
}
}

bool isUnchanged(const ReconnectionInput& input, const TetrahedronMesh& changed, TetId t)
{
  if (t >= static_cast<TetId>(input.cells.size()) || changed.tet(t).vertices != input.cells[t])
  {
    return false;
  }
  const TetVertices& v = input.cells[t];
  return std::all_of(
    v.begin(), v.end(), [&](PointId p) { return changed.point(p) == input.points[p]; });
}

namespace
{
/// Per slot the cell of the input that the centroid is in.
std::vector<TetId> findOriginals(const ReconnectionInput& input, const TetrahedronMesh& changed,
  const InputLocator& locator, int threads)
{
  std::vector<TetId> originals(changed.slots());
  const auto find = [&](TetId t)
  {
    if (!changed.alive(t) || isUnchanged(input, changed, t))
    {
      return t;
    }
    const TetVertices& v = changed.tet(t).vertices;
    const Vec3 centroid = 0.25 *
      (changed.point(v[0]) + changed.point(v[1]) + changed.point(v[2]) + changed.point(v[3]));
    return locator.locate(centroid, changed.origin(t));
  };
  forEachChunk(changed.slots(), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index t = begin; t < end; ++t)
      {
        originals[t] = find(static_cast<TetId>(t));
      }
    });
  return originals;
}
}

//------------------------------------------------------------------------------
void convertOutput(const Mesh& mesh, const ReconnectionInput& input, const TetrahedronMesh& changed,
  const InputLocator& locator, int threads, ReconnectionResult& result)
{
  const std::vector<TetId> originals = findOriginals(input, changed, locator, threads);
  const std::vector<Index> numbers = writePoints(mesh, input, changed, result);
  const PointId inputPoints = static_cast<PointId>(mesh.view().numberOfPoints);
  for (TetId t = 0; t < changed.slots(); ++t)
  {
    pollInterruption(static_cast<Index>(t));
    if (!changed.alive(t))
    {
      continue;
    }
    TetVertices v = changed.tet(t).vertices;
    result.originalCells.push_back(originals[t]);
    if (mesh.mirrored())
    {
      std::swap(v[2], v[3]);
    }
    for (PointId p : v)
    {
      result.tetrahedra.push_back(numbers[p]);
    }
  }
  for (PointId p = inputPoints; p < changed.pointSlots(); ++p)
  {
    pollInterruption(static_cast<Index>(p));
    if (numbers[p] < 0)
    {
      continue;
    }
    PointInterpolation place;
    place.point = numbers[p];
    const TetId cell = locator.locate(changed.point(p), changed.origin(changed.tetOf(p)));
    place.cell = cell;
    place.weights = locator.weights(changed.point(p), cell);
    if (mesh.mirrored())
    {
      std::swap(place.weights[2], place.weights[3]);
    }
    result.interpolations.push_back(place);
  }
}
}
