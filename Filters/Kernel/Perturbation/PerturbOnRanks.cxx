// SPDX-License-Identifier: BSD-3-Clause
#include "PerturbOnRanks.h"

#include "Perturber.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Mesh/CoordinateFrame.h"

#include <algorithm>
#include <memory>
#include <numeric>

namespace tautline
{
namespace
{
/// The vertices that move, in the order that the others wait for.
class MovingOrder
{
public:
  MovingOrder(const DistributedMesh& mesh, const Perturber& perturber,
    const std::vector<unsigned char>& chosen);

  bool empty() const { return this->Ready.empty(); }
  Index next()
  {
    const Index vertex = this->Ready.back();
    this->Ready.pop_back();
    return vertex;
  }
  /// Those that wait for this vertex wait for one less.
  void done(Index vertex)
  {
    for (Index i = this->Offsets[vertex]; i < this->Offsets[vertex + 1]; ++i)
    {
      if (--this->Waiting[this->Later[i]] == 0)
      {
        this->Ready.push_back(this->Later[i]);
      }
    }
  }

private:
  std::vector<Index> Offsets;
  std::vector<std::int32_t> Later;   ///< own vertices that wait for each local one
  std::vector<std::int32_t> Waiting; ///< per local vertex: for how many
  std::vector<Index> Ready;
};

//------------------------------------------------------------------------------
MovingOrder::MovingOrder(
  const DistributedMesh& mesh, const Perturber& perturber, const std::vector<unsigned char>& chosen)
  : Offsets(mesh.localPoints() + 1, 0)
  , Waiting(mesh.localPoints(), 0)
{
  // Each own vertex that is chosen waits for the chosen ones of lower ids with which it has a cell.
  const MeshView& view = mesh.view();
  const VertexCells& cells = perturber.adjacency();
  std::vector<std::int32_t> all, around;
  std::vector<Index> own;
  for (const Index vertex : perturber.movable())
  {
    pollInterruption(vertex);
    if (!chosen[vertex] || !mesh.owned(vertex))
    {
      continue;
    }
    around.clear();
    for (Index i = cells.offsets[vertex]; i < cells.offsets[vertex + 1]; ++i)
    {
      const Index cell = cells.cells[i];
      for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
      {
        const Index other = view.connectivity[n];
        if (chosen[other] && perturber.idOf(other) < perturber.idOf(vertex))
        {
          around.push_back(static_cast<std::int32_t>(other));
        }
      }
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    all.insert(all.end(), around.begin(), around.end());
    own.push_back(vertex);
    this->Waiting[vertex] = static_cast<std::int32_t>(around.size());
    if (around.empty())
    {
      this->Ready.push_back(vertex);
    }
  }
  // The same by those that are waited for.
  for (const std::int32_t earlier : all)
  {
    ++this->Offsets[earlier + 1];
  }
  std::partial_sum(this->Offsets.begin(), this->Offsets.end(), this->Offsets.begin());
  this->Later.resize(all.size());
  std::vector<Index> at(this->Offsets.begin(), this->Offsets.end() - 1);
  auto earlier = all.begin();
  for (const Index vertex : own)
  {
    for (std::int32_t i = 0; i < this->Waiting[vertex]; ++i)
    {
      this->Later[at[*earlier++]++] = static_cast<std::int32_t>(vertex);
    }
  }
}

/**
 * @class PerturbationOnRanks
 * @brief The state of a run.
 */
class PerturbationOnRanks
{
public:
  PerturbationOnRanks(DistributedMesh& mesh, bool mirrored, const unsigned char* fixed,
    const PerturbOptions& options);
  Perturbation run();

private:
  std::vector<unsigned char> choose();
  void move(const std::vector<unsigned char>& chosen);
  Perturbation finish();

  DistributedMesh& TheMesh;
  RankGroup& Group;
  const PerturbOptions& Options;
  std::unique_ptr<Mesh> Local;
  std::unique_ptr<Perturber> Points; ///< null on a rank without cells
  std::vector<Index> Movable;        ///< own ones
  Index AllMovable = 0;
  bool Stopped = false;
};

//------------------------------------------------------------------------------
PerturbationOnRanks::PerturbationOnRanks(
  DistributedMesh& mesh, bool mirrored, const unsigned char* fixed, const PerturbOptions& options)
  : TheMesh(mesh)
  , Group(mesh.group())
  , Options(options)
{
  this->Group.together(
    [&]
    {
      if (options.tangledFraction > 0)
      {
        throw Error("Elements are inverted one after the other on one process only: gather the "
                    "mesh, in ParaView by Aggregate Dataset, or set the Tangled Fraction to 0.");
      }
      if (mesh.view().numberOfCells == 0)
      {
        return;
      }
      if (!options.ids)
      {
        throw Error("The points of a mesh on several ranks need ids, see coordinateOrder().");
      }
      this->Local = std::make_unique<Mesh>(mesh.view(), options.threads);
      this->Local->setMirrored(mirrored);
      checkPerturbation(*this->Local, options);
      requireOrdinaryScale(mesh.view(), "Perturbation");
      if (this->Local->dimension() == Dimension::Surface)
      {
        throw Error("Surfaces in space are perturbed on one process only: gather the mesh, in "
                    "ParaView by Aggregate Dataset.");
      }
      this->Points = std::make_unique<Perturber>(*this->Local, fixed, options);
      // About own points all cells are here; the edge of this part is not the boundary.
      for (const Index vertex : this->Points->movable())
      {
        if (mesh.owned(vertex))
        {
          this->Movable.push_back(vertex);
        }
      }
    });
  this->AllMovable = this->Group.sum(static_cast<Index>(this->Movable.size()));
}

//------------------------------------------------------------------------------
/// The vertices with the smallest random numbers, one flag per local point.
std::vector<unsigned char> PerturbationOnRanks::choose()
{
  const Index count = countToMove(this->AllMovable, this->Options);
  struct Key
  {
    std::uint64_t chance;
    Index id;
  };
  std::vector<Key> keys;
  for (const Index v : this->Movable)
  {
    const Index id = this->Points->idOf(v);
    keys.push_back({ SplitMix(this->Options.seed, ChooseVertex, id).next(), id });
  }
  const auto upTo = [&](std::uint64_t limit)
  {
    return this->Group.sum(static_cast<Index>(std::count_if(
      keys.begin(), keys.end(), [limit](const Key& key) { return key.chance <= limit; })));
  };
  // The largest random number that is still chosen, digit by digit.
  constexpr int digits = 64;
  std::uint64_t last = 0;
  for (int digit = digits - 1; count > 0 && digit >= 0; --digit)
  {
    const std::uint64_t middle = last + ((std::uint64_t(1) << digit) - 1);
    last = upTo(middle) < count ? middle + 1 : last;
  }
  // Of equal ones the lower ids.
  const Index before = count > 0 && last > 0 ? upTo(last - 1) : 0;
  std::vector<Index> equal, all;
  for (const Key& key : keys)
  {
    if (key.chance == last)
    {
      equal.push_back(key.id);
    }
  }
  for (const std::vector<Index>& list : this->Group.gatherItems(equal))
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min<std::size_t>(all.size(), static_cast<std::size_t>(count - before)));
  std::vector<unsigned char> chosen(this->TheMesh.localPoints(), 0);
  for (std::size_t i = 0; count > 0 && i < keys.size(); ++i)
  {
    chosen[this->Movable[i]] = keys[i].chance < last ||
      (keys[i].chance == last && std::binary_search(all.begin(), all.end(), keys[i].id));
  }
  this->TheMesh.exchange(chosen.data());
  return chosen;
}

//------------------------------------------------------------------------------
void PerturbationOnRanks::move(const std::vector<unsigned char>& chosen)
{
  const DistributedMesh& mesh = this->TheMesh;
  constexpr int components = 4; // the place, and whether it is the last one
  const DistributedMesh::Subset halo = mesh.subset(chosen);
  std::vector<double> sent(components * mesh.localPoints(), 0.0);
  std::unique_ptr<MovingOrder> order;
  Index left = 0, all = 1;
  for (const Index v : this->Movable)
  {
    left += chosen[v];
  }
  const Index first = std::max<Index>(1, this->Group.sum(left));
  for (bool begun = false; all > 0 && !this->Stopped; begun = true)
  {
    this->Group.together(
      [&]
      {
        if (!this->Points)
        {
          return;
        }
        if (!begun)
        {
          order = std::make_unique<MovingOrder>(mesh, *this->Points, chosen);
        }
        for (Index i = 0; !order->empty(); ++i, --left)
        {
          pollInterruption(i);
          const Index vertex = order->next();
          this->Points->moveVertex(vertex);
          std::copy_n(&this->Points->points()[3 * vertex], 3, &sent[components * vertex]);
          sent[components * vertex + 3] = 1;
          order->done(vertex);
        }
      });
    std::vector<double> before;
    for (const auto& neighbour : halo.neighbours)
    {
      for (const std::int32_t vertex : neighbour.received)
      {
        before.push_back(sent[components * vertex + 3]);
      }
    }
    mesh.exchange(halo, sent.data(), components);
    bool proceed = true;
    this->Group.together(
      [&]
      {
        std::size_t i = 0;
        for (const auto& neighbour : halo.neighbours)
        {
          for (const std::int32_t vertex : neighbour.received)
          {
            // A rank that owns no point has no cells either, but copies of points of others.
            if (before[i++] == 0 && sent[components * vertex + 3] != 0 && this->Points)
            {
              this->Points->follow(vertex, &sent[components * vertex]);
              order->done(vertex);
            }
          }
        }
        const double done = 1.0 - static_cast<double>(all) / static_cast<double>(first);
        proceed = !this->Options.progress || this->Options.progress(begun ? done : 0.0);
      });
    this->Stopped = this->Group.any(!proceed);
    all = this->Group.sum(left);
  }
}

//------------------------------------------------------------------------------
Perturbation PerturbationOnRanks::finish()
{
  const DistributedMesh& mesh = this->TheMesh;
  Perturbation result;
  result.points = mesh.points();
  result.movable = this->AllMovable;
  result.stopped = this->Stopped;
  this->Group.together(
    [&]
    {
      if (!this->Points)
      {
        return;
      }
      std::vector<signed char> before(mesh.view().numberOfCells);
      this->Local->classifyCells(before.data(), this->Options.threads);
      for (std::size_t cell = 0; cell < before.size(); ++cell)
      {
        const bool counts = mesh.ownedCells()[cell];
        result.elements += counts && before[cell] >= Inverted;
        result.invertedBefore += counts && before[cell] == Inverted;
        result.invertedAfter += counts && this->Points->states()[cell] == Inverted;
      }
      for (const Index v : this->Movable)
      {
        const double* p = &this->Points->points()[3 * v];
        const Vec3 now = { p[0], p[1], p[2] }, was = pointOf(mesh.view(), v);
        result.moved += now != was;
        result.largestDisplacement = std::max(result.largestDisplacement, norm(now - was));
        std::copy_n(p, 3, &result.points[3 * v]);
      }
    });
  mesh.exchange(result.points.data(), 3);
  for (Index* count :
    { &result.moved, &result.elements, &result.invertedBefore, &result.invertedAfter })
  {
    *count = this->Group.sum(*count);
  }
  result.largestDisplacement = this->Group.maximum(result.largestDisplacement);
  return result;
}

//------------------------------------------------------------------------------
Perturbation PerturbationOnRanks::run()
{
  const std::vector<unsigned char> chosen = this->choose();
  this->move(chosen);
  return this->finish();
}
}

//------------------------------------------------------------------------------
Perturbation perturbOnRanks(
  DistributedMesh& mesh, bool mirrored, const unsigned char* fixed, const PerturbOptions& options)
{
  std::vector<unsigned char> flags(mesh.localPoints(), 0);
  if (fixed)
  {
    std::copy_n(fixed, flags.size(), flags.begin());
  }
  mesh.exchange(flags.data());
  return PerturbationOnRanks(mesh, mirrored, flags.data(), options).run();
}
}
