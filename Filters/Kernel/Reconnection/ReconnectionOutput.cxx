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
/// The maximum number of cells visited on the straight path to a point and in the search around its
/// end, and the negative weight within rounding.
constexpr std::size_t MaxWalked = 400, MaxSearched = 20000;
/// The maximum number of cells visited around the end of the path if any cell near the point
/// suffices.
constexpr std::size_t MaxNear = 60;
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
  // The weight of a corner is the volume of the tetrahedron of x and the opposite face, relative to
  // the sum.
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

/// Walks straight across the face that x is farthest beyond, as long as there is a neighbor.
/// @param crosses whether walls between regions are crossed
/// @param found set to whether the cell contains x
TetId InputLocator::walk(const Vec3& x, TetId start, bool crosses, bool& found) const
{
  TetId t = start;
  found = false;
  for (std::size_t i = 0; i < MaxWalked; ++i)
  {
    const std::array<double, 4> w = this->weights(x, t);
    const auto least = std::min_element(w.begin(), w.end());
    found = *least >= WeightTolerance;
    // The walk leaves the cell through the face opposite the corner with the smallest weight.
    const std::int32_t n = this->Neighbors[t][least - w.begin()];
    if (found || n == NoId || (!crosses && this->isWall(n, t)))
    {
      break;
    }
    t = n >> 2;
  }
  return t;
}

TetId InputLocator::locate(const Vec3& x, TetId start) const
{
  bool found;
  const TetId t = this->walk(x, start, false, found);
  return found ? t : this->search(x, start, false, MaxSearched);
}

TetId InputLocator::nearest(const Vec3& x, TetId start) const
{
  bool found;
  const TetId t = this->walk(x, start, true, found);
  return found ? t : this->search(x, t, true, MaxNear);
}

/// Searches the surrounding cells in turn, up to a maximum number.
TetId InputLocator::search(const Vec3& x, TetId start, bool crosses, std::size_t most) const
{
  std::vector<TetId> queue = { start };
  std::unordered_set<TetId> known = { start };
  TetId nearest = start;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < queue.size() && i < most; ++i)
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
      if (n != NoId && (crosses || !this->isWall(n, t)) && known.insert(n >> 2).second)
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
    // Input points that never belonged to a tetrahedron are kept; points that lost all of theirs
    // are not.
    if (!changed.used(v) && !(original && !inInput[v]))
    {
      continue;
    }
    numbers[v] = count++;
    const bool moved = !original || changed.point(v) != input.points[v];
    // Unmoved points keep their exact input coordinates; the others are scaled back by a power of
    // two.
    for (int k = 0; k < 3; ++k)
    {
      result.points.push_back(
        moved ? std::ldexp(changed.point(v)[k], input.exponent) : view.points[3 * v + k]);
    }
    result.originalPoints.push_back(original && !(moved && result.adapted) ? v : -1);
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
/// Per slot: the input cell that contains the centroid.
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
  for (TetId t = 0; t < changed.slots(); ++t)
  {
    pollInterruption(static_cast<Index>(t));
    if (!changed.alive(t))
    {
      continue;
    }
    TetVertices v = changed.tet(t).vertices;
    result.originalCells.push_back(originals[t]);
    // In a mirrored mesh, the exchange of two corners restores the orientation of the input.
    if (mesh.mirrored())
    {
      std::swap(v[2], v[3]);
    }
    for (PointId p : v)
    {
      result.tetrahedra.push_back(numbers[p]);
    }
  }
  for (PointId p = 0; p < changed.pointSlots(); ++p)
  {
    pollInterruption(static_cast<Index>(p));
    if (numbers[p] < 0 || result.originalPoints[numbers[p]] >= 0)
    {
      continue;
    }
    PointInterpolation place;
    place.point = numbers[p];
    const TetId cell = locator.locate(changed.point(p), changed.origin(changed.tetOf(p)));
    place.cell = cell;
    place.weights = locator.weights(changed.point(p), cell);
    // The weights follow the exchanged corners of the input cell.
    if (mesh.mirrored())
    {
      std::swap(place.weights[2], place.weights[3]);
    }
    result.interpolations.push_back(place);
  }
}

//------------------------------------------------------------------------------
void convertFacets(const ReconnectionInput& input, const ReconnectionOptions& options,
  bool mirrored, const TetrahedronMesh& changed, ReconnectionResult& result)
{
  if (!changed.hasLabels())
  {
    return;
  }
  // The output cells have the corners of the tetrahedra, in their order.
  std::vector<Index> numbers(changed.pointSlots(), -1);
  auto corner = result.tetrahedra.begin();
  for (TetId t = 0; t < changed.slots(); ++t)
  {
    if (changed.alive(t))
    {
      TetVertices v = changed.tet(t).vertices;
      if (mirrored)
      {
        std::swap(v[2], v[3]);
      }
      for (PointId p : v)
      {
        numbers[p] = *corner++;
      }
    }
  }
  for (TetId t = 0; t < changed.slots(); ++t)
  {
    for (int i = 0; i < 4 && changed.alive(t); ++i)
    {
      const std::int32_t n = changed.tet(t).neighbors[i], label = changed.label(t, i);
      // Each inner face is written once, by its tetrahedron with the smaller number.
      if (label == NoLabel || (n != NoId && n >> 2 < t))
      {
        continue;
      }
      TriangleVertices f = changed.face(t, i);
      // On the same side as the facet of the input.
      const std::array<Index, 3>& from = options.markedFacets[label - 1];
      const auto x = [&](int k) { return input.points[from[k]]; };
      const Vec3 former = cross(x(1) - x(0), x(2) - x(0));
      const Vec3 &a = changed.point(f[0]), &b = changed.point(f[1]), &c = changed.point(f[2]);
      if (dot(former, cross(b - a, c - a)) < 0.0)
      {
        std::swap(f[1], f[2]);
      }
      for (PointId p : f)
      {
        result.facets.push_back(numbers[p]);
      }
      result.originalFacets.push_back(label - 1);
    }
  }
}
}
