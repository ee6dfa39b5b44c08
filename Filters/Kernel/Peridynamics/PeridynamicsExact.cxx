// SPDX-License-Identifier: BSD-3-Clause
/// The exact discretization: selection of the pairs of triangles, and storage of their integrals.
#include "PeridynamicsPair.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace tautline
{
namespace
{
/// A pair of triangles up to a translation, in units of the lattice to which coordinates are
/// rounded.
struct PairKey
{
  std::int32_t first, second; ///< shapes; without reuse, triangles
  /// from the first corner of one to the first corner of the other; without reuse, 0
  Index x, y;
  std::int32_t code; ///< which corners are shared

  bool operator==(const PairKey& o) const
  {
    return this->first == o.first && this->second == o.second && this->x == o.x && this->y == o.y &&
      this->code == o.code;
  }
};

std::uint64_t mix(std::uint64_t h, std::uint64_t value)
{
  h = (h ^ value) * 0x9fb21c651e98df25u;
  return h ^ (h >> 32);
}

std::uint64_t hashOf(const PairKey& key)
{
  std::uint64_t h =
    static_cast<std::uint64_t>(key.first) << 32 | static_cast<std::uint32_t>(key.second);
  h = mix(h, static_cast<std::uint64_t>(key.x));
  h = mix(h, static_cast<std::uint64_t>(key.y));
  return mix(h, static_cast<std::uint64_t>(key.code));
}

struct PairKeyHash
{
  std::size_t operator()(const PairKey& key) const { return hashOf(key); }
};

/// The surroundings of a triangle, up to a translation: two hashes of the keys of its pairs, in
/// order.
struct Signature
{
  std::uint64_t a = 0x243f6a8885a308d3u, b = 0x13198a2e03707344u;
  bool operator==(const Signature& o) const { return this->a == o.a && this->b == o.b; }
  void add(const PairKey& key)
  {
    const std::uint64_t h = hashOf(key);
    this->a = mix(this->a, h);
    this->b = (this->b << 7 | this->b >> 57) * 0xff51afd7ed558ccdu + h;
  }
};

struct SignatureHash
{
  std::size_t operator()(const Signature& s) const { return s.a; }
};

/// The location of the integrals of a pair, as seen from its first or its second triangle.
using Slot = std::int32_t; // 2 x block + 1 if seen from the second
}

//------------------------------------------------------------------------------
class PairIntegrals
{
public:
  explicit PairIntegrals(const PeridynamicWork& work);
  void integrate(Index slice, Index slices, const std::function<bool(double)>& proceed);

  Index integrated() const { return this->Integrated; }
  /// Whether all pairs are stored. Otherwise, only touching pairs are.
  bool complete() const { return this->Reuse; }

  /// The key of a pair seen from triangle t, and whether its two triangles are exchanged in it.
  PairKey key(Index t, Index other, bool& exchanged) const;
  TrianglePair pair(Index t, Index other, bool exchanged) const;
  bool touch(Index t, Index other) const;

  /// The slots of all pairs of a triangle, in the order of `near`.
  const std::vector<Slot>* slotsOf(Index t, const std::vector<std::int32_t>& near) const;
  /// The slot of a touching pair.
  Slot slotOf(Index t, Index other) const;
  /// The rows of the functions of the triangle from which a pair is seen: functions x 2 functions x
  /// components^2.
  const double* rows(Slot slot) const
  {
    return this->Rows.data() + static_cast<std::size_t>(slot) * this->RowSize;
  }
  int rowSize() const { return this->RowSize; }
  /// Converts the block of a pair to the rows as seen from its first and from its second triangle.
  void toRows(const TrianglePair& pair, const double* block, double* first, double* second) const;

private:
  void findShapes();
  void findPairs(const std::vector<char>& needed);
  void findTouching(const std::vector<char>& needed);
  Vec2 corner(Index t, int k, const std::array<Index, 2>& from) const;

  const PeridynamicWork& Work;
  int Functions, Components, RowSize;
  bool Reuse = false;
  Index Integrated = 0;
  std::vector<std::int32_t> Shapes; ///< per triangle
  Index NumberOfShapes = 0;
  struct Example
  {
    std::int32_t first, second; ///< triangles
  };
  std::unordered_map<PairKey, std::int32_t, PairKeyHash> Blocks;
  std::vector<Example> Examples; ///< per block
  std::unordered_map<Signature, std::vector<Slot>, SignatureHash> Surroundings;
  std::vector<double> Rows;
  struct Scratch
  {
    PairIntegrator integrator;
    std::vector<double> block;
  };
  ScratchPool<Scratch> Scratches;
};

//------------------------------------------------------------------------------
PairIntegrals::PairIntegrals(const PeridynamicWork& work)
  : Work(work)
  , Functions(work.space.perTriangle())
  , Components(isElastic(work.options.model) ? 2 : 1)
  , RowSize(2 * this->Functions * this->Functions * this->Components * this->Components)
  , Scratches(
      [this]
      {
        Scratch scratch{ PairIntegrator(this->Work.options, this->Functions), {} };
        scratch.block.resize(scratch.integrator.blockSize());
        return scratch;
      })
{
  this->findShapes();
  // Pairs only repeat in meshes with few shapes, such as structured ones.
  const Index few = std::max<Index>(64, work.triangles.size() / 16);
  this->Reuse = work.options.reuseCongruent && this->NumberOfShapes <= few;
  this->Reuse ? this->findPairs(work.needed) : this->findTouching(work.needed);
  const auto count = static_cast<Index>(this->Examples.size());
  this->Integrated = count;
  this->Rows.assign(static_cast<std::size_t>(2 * count) * this->RowSize, 0.0);
}

//------------------------------------------------------------------------------
void PairIntegrals::findShapes()
{
  const PlanarTriangles& mesh = this->Work.triangles;
  // Triangles with the same two edges are congruent up to a translation.
  std::map<std::array<Index, 4>, std::int32_t> shapes; // by two edges
  for (Index t = 0; t < mesh.size(); ++t)
  {
    const auto& a = mesh.lattice[mesh.triangles[t][0]];
    const auto& b = mesh.lattice[mesh.triangles[t][1]];
    const auto& c = mesh.lattice[mesh.triangles[t][2]];
    const auto next = static_cast<std::int32_t>(shapes.size());
    const std::array<Index, 4> edges = { b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1] };
    this->Shapes.push_back(shapes.emplace(edges, next).first->second);
  }
  this->NumberOfShapes = static_cast<Index>(shapes.size());
}

//------------------------------------------------------------------------------
bool PairIntegrals::touch(Index t, Index other) const
{
  const PlanarTriangles& mesh = this->Work.triangles;
  // Most pairs are ruled out by their boxes.
  if (mesh.low[t][0] > mesh.high[other][0] + mesh.unit ||
    mesh.low[other][0] > mesh.high[t][0] + mesh.unit ||
    mesh.low[t][1] > mesh.high[other][1] + mesh.unit ||
    mesh.low[other][1] > mesh.high[t][1] + mesh.unit)
  {
    return false;
  }
  for (const std::int32_t p : mesh.triangles[t])
  {
    for (const std::int32_t q : mesh.triangles[other])
    {
      if (mesh.lattice[p] == mesh.lattice[q])
      {
        return true;
      }
    }
  }
  return false;
}

//------------------------------------------------------------------------------
PairKey PairIntegrals::key(Index t, Index other, bool& exchanged) const
{
  const PlanarTriangles& mesh = this->Work.triangles;
  const auto& a = mesh.lattice[mesh.triangles[t][0]];
  const auto& b = mesh.lattice[mesh.triangles[other][0]];
  PairKey key = { this->Shapes[t], this->Shapes[other], b[0] - a[0], b[1] - a[1], 0 };
  // Use one of the two orders of a pair, independently of the triangle from which it is seen.
  exchanged = key.first != key.second ? key.first > key.second : key.x != 0 ? key.x < 0 : key.y < 0;
  if (exchanged)
  {
    std::swap(t, other);
    key = { key.second, key.first, -key.x, -key.y, 0 };
  }
  // Two bits per corner of the second triangle: the corner of the first that it shares.
  if (this->Work.space.basis == PeridynamicBasis::Linear && mesh.low[t][0] <= mesh.high[other][0] &&
    mesh.low[other][0] <= mesh.high[t][0] && mesh.low[t][1] <= mesh.high[other][1] &&
    mesh.low[other][1] <= mesh.high[t][1])
  {
    for (int k = 0; k < 3; ++k)
    {
      for (int l = 0; l < 3; ++l)
      {
        const bool same = mesh.triangles[t][l] == mesh.triangles[other][k];
        key.code += same ? (l + 1) << (2 * k) : 0;
      }
    }
  }
  return key;
}

//------------------------------------------------------------------------------
Vec2 PairIntegrals::corner(Index t, int k, const std::array<Index, 2>& from) const
{
  const PlanarTriangles& mesh = this->Work.triangles;
  const auto& p = mesh.lattice[mesh.triangles[t][k]];
  return { static_cast<double>(p[0] - from[0]) * mesh.unit,
    static_cast<double>(p[1] - from[1]) * mesh.unit };
}

//------------------------------------------------------------------------------
TrianglePair PairIntegrals::pair(Index t, Index other, bool exchanged) const
{
  if (exchanged)
  {
    std::swap(t, other);
  }
  const PlanarTriangles& mesh = this->Work.triangles;
  const auto& origin = mesh.lattice[mesh.triangles[t][0]];
  TrianglePair pair;
  pair.identical = t == other;
  for (int k = 0; k < 3; ++k)
  {
    pair.first[k] = this->corner(t, k, origin);
    pair.second[k] = this->corner(other, k, origin);
    for (int l = 0; l < 3; ++l)
    {
      const std::int32_t p = mesh.triangles[t][l], q = mesh.triangles[other][k];
      if (this->Work.space.basis == PeridynamicBasis::Linear && p == q)
      {
        pair.shared[k] = l;
      }
      if (mesh.lattice[p] == mesh.lattice[q])
      {
        pair.touching[k] = l;
      }
    }
  }
  return pair;
}

//------------------------------------------------------------------------------
void PairIntegrals::findPairs(const std::vector<char>& needed)
{
  const PlanarTriangles& mesh = this->Work.triangles;
  // Collect new surroundings by chunk of triangles; then, in order, their pairs.
  std::vector<std::vector<std::pair<Signature, Index>>> found(numberOfChunks(mesh.size()));
  forEachChunk(mesh.size(), this->Work.options.threads,
    [&](Index chunk, Index begin, Index end)
    {
      std::unordered_map<Signature, char, SignatureHash> seen;
      std::vector<std::int32_t> near;
      for (Index t = begin; t < end; ++t)
      {
        if (!needed[t])
        {
          continue;
        }
        this->Work.neighboursOf(t, near);
        // Triangles with equal surroundings have the same rows, up to a translation.
        Signature signature;
        for (const std::int32_t other : near)
        {
          bool exchanged;
          signature.add(this->key(t, other, exchanged));
        }
        if (seen.emplace(signature, 1).second)
        {
          found[chunk].emplace_back(signature, t);
        }
      }
    });
  std::vector<std::int32_t> near;
  for (const auto& chunk : found)
  {
    for (const auto& [signature, t] : chunk)
    {
      std::vector<Slot>& slots = this->Surroundings[signature];
      if (!slots.empty())
      {
        continue;
      }
      this->Work.neighboursOf(t, near);
      for (const std::int32_t other : near)
      {
        bool exchanged;
        const PairKey key = this->key(t, other, exchanged);
        const auto next = static_cast<std::int32_t>(this->Examples.size());
        const auto [place, fresh] = this->Blocks.emplace(key, next);
        if (fresh)
        {
          this->Examples.push_back({ static_cast<std::int32_t>(exchanged ? other : t),
            static_cast<std::int32_t>(exchanged ? t : other) });
        }
        slots.push_back(2 * place->second + (exchanged ? 1 : 0));
      }
    }
  }
}

//------------------------------------------------------------------------------
void PairIntegrals::findTouching(const std::vector<char>& needed)
{
  const PlanarTriangles& mesh = this->Work.triangles;
  std::vector<std::int32_t> near;
  for (Index t = 0; t < mesh.size(); ++t)
  {
    this->Work.grid.near(mesh.low[t], mesh.high[t], mesh.unit, near);
    std::sort(near.begin(), near.end());
    for (const std::int32_t other : near)
    {
      if (other >= t && (needed[t] || needed[other]) && (other == t || this->touch(t, other)))
      {
        const auto next = static_cast<std::int32_t>(this->Examples.size());
        this->Blocks.emplace(PairKey{ static_cast<std::int32_t>(t), other, 0, 0, 0 }, next);
        this->Examples.push_back({ static_cast<std::int32_t>(t), other });
      }
    }
  }
}

//------------------------------------------------------------------------------
const std::vector<Slot>* PairIntegrals::slotsOf(
  Index t, const std::vector<std::int32_t>& near) const
{
  Signature signature;
  for (const std::int32_t other : near)
  {
    bool exchanged;
    signature.add(this->key(t, other, exchanged));
  }
  return &this->Surroundings.at(signature);
}

//------------------------------------------------------------------------------
Slot PairIntegrals::slotOf(Index t, Index other) const
{
  const bool exchanged = other < t;
  const PairKey key = { static_cast<std::int32_t>(exchanged ? other : t),
    static_cast<std::int32_t>(exchanged ? t : other), 0, 0, 0 };
  return 2 * this->Blocks.at(key) + (exchanged ? 1 : 0);
}

//------------------------------------------------------------------------------
void PairIntegrals::toRows(
  const TrianglePair& pair, const double* block, double* first, double* second) const
{
  const int f = this->Functions, n = 2 * f, c = this->Components;
  // As seen from each triangle, the columns are its functions, then the functions of the other.
  for (const bool exchanged : { false, true })
  {
    double* to = exchanged ? second : first;
    for (int a = 0; a < f; ++a)
    {
      const bool sharedByOther = f == 3 && !pair.identical &&
        (exchanged ? pair.shared[a] >= 0
                   : pair.shared[0] == a || pair.shared[1] == a || pair.shared[2] == a);
      const int row = !exchanged ? a : f == 3 && pair.shared[a] >= 0 ? pair.shared[a] : f + a;
      const double half = sharedByOther ? 0.5 : 1.0; // both triangles add to its row
      for (int b = 0; b < n; ++b)
      {
        const int column = exchanged ? (b + f) % n : b;
        for (int i = 0; i < c; ++i)
        {
          for (int j = 0; j < c; ++j)
          {
            const int from = (row * n + column) * (c == 2 ? 3 : 1) + i + j;
            *to++ = half * block[from];
          }
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Integrates one of several parts of the pairs.
void PairIntegrals::integrate(Index slice, Index slices, const std::function<bool(double)>& proceed)
{
  const auto count = static_cast<Index>(this->Examples.size());
  const Index begin = count * slice / slices, end = count * (slice + 1) / slices;
  constexpr Index grain = 4;
  parallelFor(
    end - begin, grain, this->Work.options.threads, this->Scratches,
    [&](Scratch& scratch, Index k)
    {
      const Index i = begin + k;
      const TrianglePair pair =
        this->pair(this->Examples[i].first, this->Examples[i].second, false);
      scratch.integrator.integrate(pair, scratch.block.data());
      this->toRows(pair, scratch.block.data(), this->Rows.data() + 2 * i * this->RowSize,
        this->Rows.data() + (2 * i + 1) * this->RowSize);
    },
    [&](double fraction)
    { return proceed((static_cast<double>(slice) + fraction) / static_cast<double>(slices)); });
}

//------------------------------------------------------------------------------
namespace
{
class ExactAssembler : public TriangleAssembler
{
public:
  ExactAssembler(const PeridynamicWork& work, const PairIntegrals& integrals)
    : Work(work)
    , Integrals(integrals)
    , Integrator(work.options, work.space.perTriangle())
    , Block(this->Integrator.blockSize())
    , First(integrals.rowSize())
    , Second(integrals.rowSize())
  {
  }

  void assemble(Index t, const std::vector<std::int32_t>& near, RowSums& sums) override
  {
    const std::vector<Slot>* slots =
      this->Integrals.complete() ? this->Integrals.slotsOf(t, near) : nullptr;
    for (std::size_t i = 0; i < near.size(); ++i)
    {
      const Index other = near[i];
      if (slots || other == t || this->Integrals.touch(t, other))
      {
        const Slot slot = slots ? (*slots)[i] : this->Integrals.slotOf(t, other);
        this->add(t, other, this->Integrals.rows(slot), sums);
        continue;
      }
      // Pairs that do not touch are smooth and cheap: integrate them here without storing.
      const bool exchanged = other < t;
      const TrianglePair pair = this->Integrals.pair(t, other, exchanged);
      this->Integrator.integrate(pair, this->Block.data());
      this->Integrals.toRows(pair, this->Block.data(), this->First.data(), this->Second.data());
      this->add(t, other, exchanged ? this->Second.data() : this->First.data(), sums);
    }
  }

private:
  void add(Index t, Index other, const double* rows, RowSums& sums)
  {
    const int functions = this->Work.space.perTriangle();
    const int c = isElastic(this->Work.options.model) ? 4 : 1;
    for (int a = 0; a < functions; ++a)
    {
      for (int b = 0; b < 2 * functions; ++b)
      {
        const Index f =
          this->Work.space.function(this->Work.triangles, b < functions ? t : other, b % functions);
        double* to = sums.at(a, f);
        for (int k = 0; k < c; ++k)
        {
          to[k] += *rows++;
        }
      }
    }
  }

  const PeridynamicWork& Work;
  const PairIntegrals& Integrals;
  PairIntegrator Integrator;
  std::vector<double> Block, First, Second;
};
}

//------------------------------------------------------------------------------
std::shared_ptr<PairIntegrals> makePairIntegrals(const PeridynamicWork& work)
{
  return std::make_shared<PairIntegrals>(work);
}

//------------------------------------------------------------------------------
void integratePairs(
  PairIntegrals& integrals, Index slice, Index slices, const std::function<bool(double)>& proceed)
{
  integrals.integrate(slice, slices, proceed);
}

Index numberOfIntegratedPairs(const PairIntegrals& integrals)
{
  return integrals.integrated();
}

std::unique_ptr<TriangleAssembler> makeExactAssembler(
  const PeridynamicWork& work, const PairIntegrals& integrals)
{
  return std::make_unique<ExactAssembler>(work, integrals);
}
}
