// SPDX-License-Identifier: BSD-3-Clause
#include "TetrahedronMesh.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <numeric>
#include <tuple>
#include <utility>

namespace tautline
{
namespace
{
/// Sorts three ids.
void sortKey(TriangleVertices& k)
{
  if (k[0] > k[1])
  {
    std::swap(k[0], k[1]);
  }
  if (k[1] > k[2])
  {
    std::swap(k[1], k[2]);
  }
  if (k[0] > k[1])
  {
    std::swap(k[0], k[1]);
  }
}
}

//------------------------------------------------------------------------------
TetrahedronMesh::TetrahedronMesh(std::vector<Vec3> points, const std::vector<TetVertices>& cells,
  const std::vector<std::int32_t>& regions, const QualityWeights& weights, int threads,
  std::vector<MetricTensor> metrics)
  : Points(std::move(points))
  , Weights(weights)
  , Metrics(std::move(metrics))
{
  const std::size_t n = cells.size();
  this->Tets.resize(n);
  this->Quality.resize(n);
  this->Origin.resize(n);
  this->Mark.assign(n, 0);
  this->Region = regions;
  this->Region.resize(n, 0);
  this->PointTet.assign(this->Points.size(), NoId);
  forEachChunk(static_cast<Index>(n), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index t = begin; t < end; ++t)
      {
        this->Tets[t].vertices = cells[t];
        this->Tets[t].neighbors.fill(NoId);
        this->Quality[t] = this->computeExactQuality(cells[t]);
        this->Origin[t] = static_cast<TetId>(t);
      }
    });
  for (std::size_t t = 0; t < n; ++t)
  {
    for (PointId v : cells[t])
    {
      this->PointTet[v] = static_cast<TetId>(t);
    }
  }
  this->Alive = static_cast<Index>(n);
  this->InputPoints = this->pointSlots();
  this->connect(threads);
}

TetrahedronMesh::TetrahedronMesh(TetrahedronArrays arrays)
  : Tets(std::move(arrays.tets))
  , Quality(std::move(arrays.quality))
  , Region(std::move(arrays.region))
  , Origin(std::move(arrays.origin))
  , Mark(Tets.size(), 0)
  , Points(std::move(arrays.points))
  , PointTet(Points.size(), NoId)
  , InputPoints(arrays.inputPoints)
  , Weights(arrays.weights)
  , Labels(std::move(arrays.labels))
  , Metrics(std::move(arrays.metrics))
{
  for (TetId t = this->slots() - 1; t >= 0; --t) // so that the first is used next
  {
    if (!this->alive(t))
    {
      this->FreeTets.push_back(t);
      continue;
    }
    ++this->Alive;
    for (PointId v : this->Tets[t].vertices)
    {
      this->PointTet[v] = t;
    }
  }
  // Slots of input points are not reused: their numbers identify them in the output.
  for (PointId v = this->pointSlots() - 1; v >= this->InputPoints; --v)
  {
    if (!this->used(v))
    {
      this->FreePoints.push_back(v);
    }
  }
}

TetrahedronArrays TetrahedronMesh::release()
{
  TetrahedronArrays arrays;
  arrays.tets = std::move(this->Tets);
  arrays.quality = std::move(this->Quality);
  arrays.region = std::move(this->Region);
  arrays.origin = std::move(this->Origin);
  arrays.points = std::move(this->Points);
  arrays.inputPoints = this->InputPoints;
  arrays.weights = this->Weights;
  arrays.labels = std::move(this->Labels);
  arrays.metrics = std::move(this->Metrics);
  return arrays;
}

Index TetrahedronMesh::labelFaces(const std::vector<TriangleVertices>& faces, bool boundary)
{
  using Labeled = std::pair<TriangleVertices, std::int32_t>;
  std::vector<Labeled> known;
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    TriangleVertices key = faces[f];
    sortKey(key);
    known.emplace_back(key, static_cast<std::int32_t>(f + 1));
  }
  std::sort(known.begin(), known.end());
  Index sides = 0;
  for (TetId t = 0; t < this->slots() && !known.empty(); ++t)
  {
    pollInterruption(static_cast<Index>(t));
    for (int i = 0; i < 4; ++i)
    {
      const bool inside = this->Tets[t].neighbors[i] != NoId;
      TriangleVertices key = this->face(t, i);
      sortKey(key);
      const auto found = std::lower_bound(known.begin(), known.end(), Labeled(key, NoLabel));
      if ((inside || boundary) && found != known.end() && found->first == key)
      {
        this->Labels.resize(this->Tets.size(), { NoLabel, NoLabel, NoLabel, NoLabel });
        this->Labels[t][i] = found->second;
        sides += inside;
      }
    }
  }
  // Each inner face was found from both of its tetrahedra.
  return sides / 2;
}

bool TetrahedronMesh::isTurned(TetId t, int i) const
{
  const std::int32_t n = this->Tets[t].neighbors[i];
  if (n == NoId)
  {
    return false;
  }
  // As seen from its two sides, a face has opposite orientations.
  const TriangleVertices own = this->face(t, i), other = this->face(n >> 2, n & 3);
  const int at = other[0] == own[0] ? 0 : (other[1] == own[0] ? 1 : 2);
  return other[(at + 1) % 3] == own[1];
}

void TetrahedronMesh::orientFlat()
{
  for (TetId t = 0; t < this->slots(); ++t)
  {
    Tetrahedron& tet = this->Tets[t];
    const auto turned = [this, t](int i) { return this->isTurned(t, i); };
    if (this->Quality[t] > 0.0 || !(turned(0) || turned(1) || turned(2) || turned(3)))
    {
      continue;
    }
    // Exchanging the last two vertices also exchanges their opposite faces.
    std::swap(tet.vertices[2], tet.vertices[3]);
    std::swap(tet.neighbors[2], tet.neighbors[3]);
    for (int i = 2; i < 4; ++i)
    {
      if (tet.neighbors[i] != NoId)
      {
        this->Tets[tet.neighbors[i] >> 2].neighbors[tet.neighbors[i] & 3] = 4 * t + i;
      }
    }
  }
}

double TetrahedronMesh::metricQuality(const TetVertices& v) const
{
  const std::vector<Vec3>& x = this->Points;
  const std::vector<MetricTensor>& m = this->Metrics;
  // Any multiple of a metric gives the same shape: the sum serves as the mean.
  return metricShape(x[v[0]], x[v[1]], x[v[2]], x[v[3]], (m[v[0]] + m[v[1]]) + (m[v[2]] + m[v[3]]));
}

/// Finds the neighbors: faces are grouped by their smallest vertex, then compared.
void TetrahedronMesh::connect(int threads)
{
  struct Use
  {
    PointId middle, largest;
    std::int32_t code;
  };
  std::vector<std::int64_t> starts(this->Points.size() + 1, 0);
  const TetId n = this->slots();
  const auto keyOf = [&](TetId t, int i)
  {
    TriangleVertices key = this->face(t, i);
    sortKey(key);
    return key;
  };
  for (TetId t = 0; t < n; ++t)
  {
    pollInterruption(static_cast<Index>(t));
    for (int i = 0; i < 4; ++i)
    {
      const TriangleVertices f = this->face(t, i);
      ++starts[std::min(f[0], std::min(f[1], f[2])) + 1];
    }
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Use> uses(starts.back());
  std::vector<std::int64_t> next(starts.begin(), starts.end() - 1);
  for (TetId t = 0; t < n; ++t)
  {
    pollInterruption(static_cast<Index>(t));
    for (int i = 0; i < 4; ++i)
    {
      const TriangleVertices key = keyOf(t, i);
      uses[next[key[0]]++] = { key[1], key[2], 4 * t + i };
    }
  }
  // Each side of a face is listed at one vertex.
  const auto points = static_cast<Index>(this->Points.size());
  std::vector<Index> nonManifold(numberOfChunks(points), 0);
  const auto match = [&](std::int64_t first, std::int64_t last, Index& shared)
  {
    const auto begin = uses.begin() + first, end = uses.begin() + last;
    std::sort(begin, end,
      [](const Use& a, const Use& b)
      {
        return a.middle != b.middle
          ? a.middle < b.middle
          : (a.largest != b.largest ? a.largest < b.largest : a.code < b.code);
      });
    for (auto i = begin; i < end;)
    {
      auto j = i + 1;
      while (j < end && j->middle == i->middle && j->largest == i->largest)
      {
        ++j;
      }
      // Exactly two sides form an interior face; more make it nonmanifold.
      if (j - i == 2)
      {
        this->Tets[i->code >> 2].neighbors[i->code & 3] = (i + 1)->code;
        this->Tets[(i + 1)->code >> 2].neighbors[(i + 1)->code & 3] = i->code;
      }
      shared += j - i > 2;
      i = j;
    }
  };
  forEachChunk(points, threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index v = begin; v < end; ++v)
      {
        match(starts[v], starts[v + 1], nonManifold[chunk]);
      }
    });
  this->NonManifoldFaces = std::accumulate(nonManifold.begin(), nonManifold.end(), Index(0));
}

std::uint32_t TetrahedronMesh::nextMark()
{
  // After 2^32 marks, old values could be mistaken for new ones.
  if (++this->CurrentMark == 0)
  {
    std::fill(this->Mark.begin(), this->Mark.end(), 0);
    this->CurrentMark = 1;
  }
  return this->CurrentMark;
}

//------------------------------------------------------------------------------
void TetrahedronMesh::star(PointId v, std::vector<TetId>& tets)
{
  tets.clear();
  const std::uint32_t mark = this->nextMark();
  tets.push_back(this->PointTet[v]);
  this->Mark[tets[0]] = mark;
  for (std::size_t i = 0; i < tets.size(); ++i)
  {
    const Tetrahedron& t = this->Tets[tets[i]];
    for (int k = 0; k < 4; ++k)
    {
      const std::int32_t n = t.neighbors[k];
      // Only the faces at v lead to other tetrahedra of its star.
      if (t.vertices[k] != v && n != NoId && this->Mark[n >> 2] != mark)
      {
        this->Mark[n >> 2] = mark;
        tets.push_back(n >> 2);
      }
    }
  }
}

void TetrahedronMesh::ring(TetId t, int i, int j, EdgeRing& ring) const
{
  const Tetrahedron& first = this->Tets[t];
  ring.a = first.vertices[i];
  ring.b = first.vertices[j];
  ring.closed = false;
  ring.whole = true;
  ring.size = 0;
  int k = 0;
  while (k == i || k == j)
  {
    ++k;
  }
  int l = 6 - i - j - k;
  // (i, j, k, l) must be a positive order: the order of the face opposite i, rotated so that j
  // comes first.
  const int* f = OppositeFace[i];
  const int at = f[0] == j ? 0 : (f[1] == j ? 1 : 2);
  k = f[(at + 1) % 3];
  l = f[(at + 2) % 3];
  PointId back = first.vertices[k], front = first.vertices[l];
  ring.ring[0] = back;
  TetId current = t;
  // Walk forward from t across the faces opposite the previous ring vertex.
  while (true)
  {
    if (ring.size == EdgeRing::MaxSize)
    {
      ring.whole = false;
      return;
    }
    ring.tets[ring.size++] = current;
    const int leave = this->Tets[current].indexOf(back);
    if (this->isWall(current, leave))
    {
      ring.ring[ring.size] = front;
      break;
    }
    const TetId across = this->Tets[current].neighbors[leave] >> 2;
    if (across == t)
    {
      ring.closed = true;
      ring.vertices = ring.size;
      return;
    }
    ring.ring[ring.size] = front;
    const TetVertices& v = this->Tets[across].vertices;
    // The exclusive or cancels the edge and the shared ring vertex, and leaves the new one.
    const PointId next = v[0] ^ v[1] ^ v[2] ^ v[3] ^ ring.a ^ ring.b ^ front;
    current = across;
    back = front;
    front = next;
  }
  // The ring is open: walk backward from t to its other wall, then reorder.
  current = t;
  back = first.vertices[k];
  front = first.vertices[l];
  while (true)
  {
    const int leave = this->Tets[current].indexOf(front);
    if (this->isWall(current, leave))
    {
      break;
    }
    if (ring.size == EdgeRing::MaxSize)
    {
      ring.whole = false;
      return;
    }
    const TetId across = this->Tets[current].neighbors[leave] >> 2;
    const TetVertices& v = this->Tets[across].vertices;
    const PointId previous = v[0] ^ v[1] ^ v[2] ^ v[3] ^ ring.a ^ ring.b ^ back;
    std::move_backward(
      ring.tets.begin(), ring.tets.begin() + ring.size, ring.tets.begin() + ring.size + 1);
    std::move_backward(
      ring.ring.begin(), ring.ring.begin() + ring.size + 1, ring.ring.begin() + ring.size + 2);
    ++ring.size;
    ring.tets[0] = current = across;
    ring.ring[0] = previous;
    front = back;
    back = previous;
  }
  ring.vertices = ring.size + 1;
}

void TetrahedronMesh::fan(
  TetId t, int i, int j, std::vector<TetId>& tets, std::vector<std::int32_t>& walls) const
{
  tets.clear();
  walls.clear();
  const Tetrahedron& first = this->Tets[t];
  const PointId a = first.vertices[i], b = first.vertices[j];
  int k = 0;
  while (k == i || k == j)
  {
    ++k;
  }
  const int l = 6 - i - j - k;
  tets.push_back(t);
  // Walk repeatedly across the face opposite one of the other vertices, then in the other direction
  // unless the first walk has returned to the start.
  for (const auto& [start, other] : { std::array<int, 2>{ k, l }, std::array<int, 2>{ l, k } })
  {
    TetId current = t;
    PointId leave = first.vertices[start], stay = first.vertices[other];
    while (true)
    {
      const int face = this->Tets[current].indexOf(leave);
      const std::int32_t n = this->Tets[current].neighbors[face];
      if (this->isWall(current, face))
      {
        walls.push_back(4 * current + face);
      }
      if (n == NoId)
      {
        break;
      }
      current = n >> 2;
      if (current == t)
      {
        return;
      }
      tets.push_back(current);
      const TetVertices& v = this->Tets[current].vertices;
      // The exclusive or of all known vertices yields the new one.
      leave = std::exchange(stay, v[0] ^ v[1] ^ v[2] ^ v[3] ^ a ^ b ^ stay);
    }
  }
}

//------------------------------------------------------------------------------
PointId TetrahedronMesh::addPoint(const Vec3& x, const MetricTensor& metric)
{
  PointId v = this->pointSlots();
  if (!this->FreePoints.empty())
  {
    v = this->FreePoints.back();
    this->FreePoints.pop_back();
    this->Points[v] = x;
  }
  else
  {
    this->Points.push_back(x);
    this->PointTet.push_back(NoId);
  }
  if (this->hasMetrics())
  {
    this->Metrics.resize(this->Points.size());
    this->Metrics[v] = metric;
  }
  return v;
}

void TetrahedronMesh::releasePoint(PointId v)
{
  this->FreePoints.push_back(v);
}

void TetrahedronMesh::reclaimPoint(PointId v)
{
  const auto at = std::find(this->FreePoints.rbegin(), this->FreePoints.rend(), v);
  if (at != this->FreePoints.rend())
  {
    this->FreePoints.erase(std::next(at).base());
  }
}

void TetrahedronMesh::movePoint(
  PointId v, const Vec3& x, const std::vector<TetId>& tets, const double* qualities)
{
  this->Points[v] = x;
  for (std::size_t i = 0; i < tets.size(); ++i)
  {
    this->Quality[tets[i]] =
      qualities ? qualities[i] : this->computeQuality(this->Tets[tets[i]].vertices);
  }
}

//------------------------------------------------------------------------------
void TetrahedronMesh::FaceTable::reset(std::size_t faces)
{
  std::size_t size = 64;
  // At most half of the entries are filled, which keeps the probe sequences short.
  while (size < 2 * faces)
  {
    size *= 2;
  }
  if (size > this->Entries.size())
  {
    this->Entries.assign(size, { { NoId, NoId, NoId }, NoId, NoLabel, false });
  }
  else
  {
    // Most operations are small: clearing the whole table would dominate their cost.
    for (std::int32_t i : this->Filled)
    {
      this->Entries[i].key[0] = NoId;
    }
  }
  this->Filled.clear();
}

TetrahedronMesh::FaceEntry& TetrahedronMesh::FaceTable::find(TriangleVertices& key)
{
  sortKey(key);
  constexpr std::uint32_t p0 = 73856093u, p1 = 19349663u, p2 = 83492791u; // large primes
  const std::uint32_t hash = static_cast<std::uint32_t>(key[0]) * p0 ^
    static_cast<std::uint32_t>(key[1]) * p1 ^ static_cast<std::uint32_t>(key[2]) * p2;
  const std::size_t mask = this->Entries.size() - 1;
  // The mask keeps only low bits: the high bits are mixed in first.
  std::size_t i = (hash ^ (hash >> 15)) & mask;
  while (this->Entries[i].key[0] != NoId && this->Entries[i].key != key)
  {
    i = (i + 1) & mask;
  }
  if (this->Entries[i].key[0] == NoId)
  {
    this->Filled.push_back(static_cast<std::int32_t>(i));
  }
  return this->Entries[i];
}

/// Finds the neighbor and the label of each face of the new tetrahedra; neighbors among the new
/// ones are coded as -2 - (4 * position + face).
bool TetrahedronMesh::match(const Replacement& replacement)
{
  const std::uint32_t mark = this->nextMark();
  for (TetId t : replacement.before)
  {
    this->Mark[t] = mark;
  }
  const bool changesLabels = !replacement.labels.empty();
  this->Faces.reset(4 * (replacement.before.size() + replacement.after.size()));
  for (TetId t : replacement.before)
  {
    for (int i = 0; i < 4; ++i)
    {
      const std::int32_t n = this->Tets[t].neighbors[i];
      if (n != NoId && this->Mark[n >> 2] == mark)
      {
        if (this->label(t, i) != NoLabel && !changesLabels)
        {
          return false; // a face that is kept
        }
        continue;
      }
      TriangleVertices key = this->face(t, i);
      FaceEntry& entry = this->Faces.find(key);
      if (entry.key[0] != NoId)
      {
        return false; // a face that is not manifold
      }
      entry = { key, n, this->label(t, i), false };
    }
  }
  const std::size_t outer = this->Faces.filled().size();
  this->Links.resize(replacement.after.size());
  this->LinkLabels.resize(replacement.after.size());
  for (std::size_t k = 0; k < replacement.after.size(); ++k)
  {
    const TetVertices& v = replacement.after[k];
    for (int i = 0; i < 4; ++i)
    {
      const int* f = OppositeFace[i];
      TriangleVertices key = { v[f[0]], v[f[1]], v[f[2]] };
      FaceEntry& entry = this->Faces.find(key);
      const std::int32_t own = static_cast<std::int32_t>(4 * k) + i;
      const std::int32_t given = changesLabels ? replacement.labels[k][i] : NoLabel;
      this->LinkLabels[k][i] = given;
      if (entry.key[0] == NoId)
      {
        // An inner face of the replacement is linked when its second side is found.
        entry = { key, -2 - own, given, false };
        this->Links[k][i] = NoId;
        continue;
      }
      if (entry.matched)
      {
        // A third side would make the face nonmanifold.
        return false;
      }
      entry.matched = true;
      this->Links[k][i] = entry.code;
      this->LinkLabels[k][i] = entry.label;
      if (entry.code <= -2)
      {
        const std::int32_t other = -2 - entry.code;
        this->Links[other >> 2][other & 3] = -2 - own;
      }
    }
  }
  return this->matchBoundary(replacement, outer);
}

/// Whether the unmatched faces are on the boundary and may be replaced. Sets the labels of the new
/// faces.
/// @param outer the number of faces of the cavity, which come first
bool TetrahedronMesh::matchBoundary(const Replacement& replacement, std::size_t outer)
{
  for (std::size_t i = 0; i < this->Faces.filled().size(); ++i)
  {
    const FaceEntry& entry = this->Faces.at(this->Faces.filled()[i]);
    if (entry.matched)
    {
      continue;
    }
    const bool removed = i < outer;
    if (!replacement.opensBoundary || (removed && entry.code != NoId))
    {
      return false;
    }
    if (!replacement.labels.empty())
    {
      continue;
    }
    if (removed && entry.label != NoLabel && replacement.boundaryLabel == NoLabel)
    {
      return false; // a labeled face that would be lost
    }
    if (!removed)
    {
      const std::int32_t own = -2 - entry.code;
      this->LinkLabels[own >> 2][own & 3] = replacement.boundaryLabel;
    }
  }
  return true;
}

void TetrahedronMesh::detachPoints(const Replacement& replacement)
{
  for (TetId t : replacement.before)
  {
    for (PointId v : this->Tets[t].vertices)
    {
      this->PointTet[v] = NoId;
    }
  }
}

/// A slot for a tetrahedron: a free slot or a new one.
TetId TetrahedronMesh::takeSlot()
{
  if (!this->FreeTets.empty())
  {
    const TetId t = this->FreeTets.back();
    this->FreeTets.pop_back();
    return t;
  }
  this->Tets.emplace_back();
  this->Quality.push_back(0.0);
  this->Region.push_back(0);
  this->Origin.push_back(NoId);
  this->Mark.push_back(0);
  if (this->hasLabels())
  {
    this->Labels.push_back({ NoLabel, NoLabel, NoLabel, NoLabel });
  }
  return this->slots() - 1;
}

bool TetrahedronMesh::replace(const Replacement& replacement, std::vector<TetId>& created)
{
  created.clear();
  const std::size_t before = replacement.before.size(), after = replacement.after.size();
  if (before == 0 || after == 0 || !this->match(replacement))
  {
    return false;
  }
  // Per region: a nearby input cell; most replacements have one region.
  using Place = std::pair<std::int32_t, TetId>;
  const TetId first = replacement.before[0];
  const Place only = { this->Region[first], this->Origin[first] };
  std::vector<Place> places;
  for (std::size_t k = 0; k < replacement.regions.size(); ++k)
  {
    const std::int32_t region = replacement.regions[k];
    const TetId near = *std::find_if(replacement.before.begin(), replacement.before.end(),
      [&](TetId t) { return this->Region[t] == region; });
    places.emplace_back(region, this->Origin[near]);
  }
  this->detachPoints(replacement);
  // Reuse free ids, starting with the cavity's.
  for (std::size_t k = 0; k < after; ++k)
  {
    if (k < before)
    {
      created.push_back(replacement.before[k]);
    }
    else
    {
      created.push_back(this->takeSlot());
    }
  }
  // The ids of lost input points are not reused.
  std::vector<PointId>& lost = this->FreePoints;
  const std::ptrdiff_t known = static_cast<std::ptrdiff_t>(lost.size());
  for (std::size_t k = 0; k < after; ++k)
  {
    for (PointId v : replacement.after[k])
    {
      this->PointTet[v] = created[k];
    }
  }
  for (TetId t : replacement.before)
  {
    for (PointId v : this->Tets[t].vertices)
    {
      if (this->PointTet[v] == NoId && v >= this->InputPoints &&
        std::find(lost.begin() + known, lost.end(), v) == lost.end())
      {
        lost.push_back(v);
      }
    }
  }
  for (std::size_t k = before; k > after; --k) // so that the first is used next
  {
    this->Tets[replacement.before[k - 1]].vertices.fill(NoId);
    this->FreeTets.push_back(replacement.before[k - 1]);
  }
  for (std::size_t k = 0; k < after; ++k)
  {
    const TetId id = created[k];
    this->Quality[id] = replacement.qualities[k];
    std::tie(this->Region[id], this->Origin[id]) = places.empty() ? only : places[k];
    this->Tets[id].vertices = replacement.after[k];
    if (this->hasLabels())
    {
      this->Labels[id] = this->LinkLabels[k];
    }
    for (int i = 0; i < 4; ++i)
    {
      const std::int32_t link = this->Links[k][i];
      const std::int32_t inner = -2 - link;
      this->Tets[id].neighbors[i] = link <= -2 ? 4 * created[inner >> 2] + (inner & 3) : link;
      if (link >= 0)
      {
        this->Tets[link >> 2].neighbors[link & 3] = 4 * id + i;
      }
    }
  }
  this->Alive += static_cast<Index>(after) - static_cast<Index>(before);
  return true;
}

//------------------------------------------------------------------------------
void TetrahedronMesh::splitEdge(PointId a, PointId b, PointId p, const std::vector<TetId>& fan,
  const std::vector<double>& qualities, std::vector<TetId>& created)
{
  created.clear();
  // The part with a keeps the slot, the part with b gets a new one.
  for (TetId t : fan)
  {
    created.push_back(t);
    created.push_back(this->takeSlot());
  }
  const auto otherOf = [&](TetId t)
  { return created[2 * (std::find(fan.begin(), fan.end(), t) - fan.begin()) + 1]; };
  std::vector<std::array<std::int32_t, 4>> former;
  for (TetId t : fan)
  {
    former.push_back(this->Tets[t].neighbors);
  }
  for (std::size_t k = 0; k < fan.size(); ++k)
  {
    const TetId near = fan[k], far = created[2 * k + 1];
    const int i = this->Tets[near].indexOf(a), j = this->Tets[near].indexOf(b);
    this->Tets[far] = this->Tets[near];
    this->Tets[near].vertices[j] = p;
    this->Tets[far].vertices[i] = p;
    for (int f = 0; f < 4; ++f)
    {
      const std::int32_t n = former[k][f];
      if (f != i && f != j && n != NoId)
      {
        this->Tets[far].neighbors[f] = 4 * otherOf(n >> 2) + (n & 3);
      }
    }
    // The face between both parts, and the face opposite a.
    this->Tets[near].neighbors[i] = 4 * far + j;
    this->Tets[far].neighbors[j] = 4 * near + i;
    if (former[k][i] != NoId)
    {
      this->Tets[former[k][i] >> 2].neighbors[former[k][i] & 3] = 4 * far + i;
    }
    if (this->hasLabels())
    {
      this->Labels[far] = this->Labels[near];
      this->Labels[near][i] = this->Labels[far][j] = NoLabel;
    }
    this->Quality[near] = qualities[2 * k];
    this->Quality[far] = qualities[2 * k + 1];
    this->Region[far] = this->Region[near];
    this->Origin[far] = this->Origin[near];
    this->PointTet[b] = far;
    this->PointTet[p] = far;
    this->PointTet[a] = near;
  }
  for (TetId t : fan) // corners that are in both parts
  {
    for (PointId v : this->Tets[t].vertices)
    {
      this->PointTet[v] = t;
    }
  }
  this->Alive += static_cast<Index>(fan.size());
}

//------------------------------------------------------------------------------
std::string TetrahedronMesh::findViolation() const
{
  const auto at = [](const char* what, TetId t) { return what + std::to_string(t); };
  Index alive = 0;
  for (TetId t = 0; t < this->slots(); ++t)
  {
    if (!this->alive(t))
    {
      continue;
    }
    ++alive;
    const Tetrahedron& tet = this->Tets[t];
    if (this->computeExactQuality(tet.vertices) <= 0.0)
    {
      return at("not positive: tetrahedron ", t);
    }
    if (std::abs(this->computeQuality(tet.vertices) - this->Quality[t]) > CertainQuality)
    {
      return at("wrong quality of tetrahedron ", t);
    }
    for (int i = 0; i < 4; ++i)
    {
      const PointId v = tet.vertices[i];
      if (this->PointTet[v] < 0 || this->Tets[this->PointTet[v]].indexOf(v) == NoId)
      {
        return at("wrong tetrahedron of a point of tetrahedron ", t);
      }
      const std::int32_t n = tet.neighbors[i];
      if (n == NoId)
      {
        continue;
      }
      TriangleVertices own = this->face(t, i), other = this->face(n >> 2, n & 3);
      sortKey(own);
      sortKey(other);
      if (!this->alive(n >> 2) || own != other ||
        this->Tets[n >> 2].neighbors[n & 3] != 4 * t + i ||
        this->label(n >> 2, n & 3) != this->label(t, i))
      {
        return at("wrong neighbor of tetrahedron ", t);
      }
    }
  }
  return alive == this->Alive ? "" : "wrong number of tetrahedra";
}
}
