// SPDX-License-Identifier: BSD-3-Clause
// Values of cells, from the pieces to the processes that have the cells as their local ones.
#include "MovableMesh.h"

#include "tautline/Mesh/CellTopology.h"
#include "tautline/Mesh/DistributedMesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace tautline
{
namespace
{
/// The numbers of a cell's points in increasing order, after some -1: they identify the cell.
using CellKey = std::array<Index, MaxNodes>;

/// @param numberOf of a point of the view, by its index
template <class NumberOf>
CellKey keyOf(const MeshView& view, Index cell, const NumberOf& numberOf)
{
  CellKey key;
  key.fill(-1);
  const Index begin = view.offsets[cell], end = view.offsets[cell + 1];
  std::transform(view.connectivity + begin, view.connectivity + end, key.begin(), numberOf);
  std::sort(key.begin(), key.end());
  return key;
}

/// Sorts the rows of a table by key, and rows with equal keys by value.
std::vector<Index> orderOf(
  const std::vector<CellKey>& keys, const std::vector<double>& values, int components)
{
  std::vector<Index> order(keys.size());
  std::iota(order.begin(), order.end(), Index(0));
  const auto rowOf = [&](Index i) { return values.data() + components * i; };
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      return keys[a] != keys[b] ? keys[a] < keys[b]
                                : std::lexicographical_compare(rowOf(a), rowOf(a) + components,
                                    rowOf(b), rowOf(b) + components);
    });
  return order;
}
}

//------------------------------------------------------------------------------
std::vector<double> MovableMesh::ofCells(const std::vector<double>& ofPiece, int components) const
{
  const DistributedMesh& mesh = this->distributed();
  const MeshView& piece = this->piece();
  const auto ranks = static_cast<std::size_t>(this->group().size());
  std::vector<std::vector<CellKey>> sentKeys(ranks);
  std::vector<std::vector<double>> sentValues(ranks);
  const bool any = this->Spread->dimension > 0 && !ofPiece.empty();
  for (Index cell = 0; any && cell < piece.numberOfCells; ++cell)
  {
    if (this->Skip[cell] && (this->Spread->copied.empty() || !this->Spread->copied[cell]))
    {
      continue;
    }
    const auto local = [&](Index p) { return mesh.localOfPiece()[p]; };
    const CellKey key = keyOf(piece, cell, [&](Index p) { return mesh.numbers()[local(p)]; });
    // All processes that own a point of the cell have the cell.
    const Index begin = piece.offsets[cell], end = piece.offsets[cell + 1];
    std::array<int, MaxNodes> owners;
    owners.fill(mesh.owners()[local(piece.connectivity[begin])]);
    std::transform(piece.connectivity + begin, piece.connectivity + end, owners.begin(),
      [&](Index p) { return mesh.owners()[local(p)]; });
    std::sort(owners.begin(), owners.end());
    const auto last = std::unique(owners.begin(), owners.end());
    for (auto owner = owners.begin(); owner != last; ++owner)
    {
      sentKeys[*owner].push_back(key);
      const double* values = ofPiece.data() + components * cell;
      sentValues[*owner].insert(sentValues[*owner].end(), values, values + components);
    }
  }
  std::vector<CellKey> keys;
  for (const auto& list : this->group().exchangeItems(sentKeys))
  {
    keys.insert(keys.end(), list.begin(), list.end());
  }
  std::vector<double> values;
  for (const auto& list : this->group().exchangeItems(sentValues))
  {
    values.insert(values.end(), list.begin(), list.end());
  }
  const MeshView& view = mesh.view();
  std::vector<double> result(components * view.numberOfCells);
  const std::vector<Index> order = orderOf(keys, values, components);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellKey key = keyOf(view, cell, [&](Index p) { return mesh.numbers()[p]; });
    const auto at = std::lower_bound(order.begin(), order.end(), key,
      [&](Index row, const CellKey& wanted) { return keys[row] < wanted; });
    if (at == order.end() || keys[*at] != key)
    {
      throw Error("A cell has no value on any process: all pieces need the array.");
    }
    std::copy_n(values.data() + components * *at, components, result.data() + components * cell);
  }
  return result;
}
//------------------------------------------------------------------------------
/// Marks the cells of the piece that are copies of another one, here or on another process, so that
/// each is counted once: all but the first in the order of processes and ids.
void MovableMesh::skipCopies()
{
  const DistributedMesh& mesh = this->distributed();
  if (mesh.droppedCells() == 0)
  {
    return;
  }
  struct Candidate
  {
    CellKey key;
    Index cell, rank;
    bool operator<(const Candidate& other) const
    {
      return std::tie(this->key, this->rank, this->cell) <
        std::tie(other.key, other.rank, other.cell);
    }
  };
  const MeshView& piece = this->piece();
  const auto ranks = static_cast<std::size_t>(this->group().size());
  std::vector<std::vector<Candidate>> sent(ranks);
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    const Index begin = piece.offsets[cell], end = piece.offsets[cell + 1];
    if (!this->Skip[cell] && begin < end)
    {
      const auto local = [&](Index p) { return mesh.localOfPiece()[p]; };
      const Index* least = std::min_element(piece.connectivity + begin, piece.connectivity + end,
        [&](Index a, Index b) { return local(a) < local(b); }); // in the order of the numbers
      const CellKey key = keyOf(piece, cell, [&](Index p) { return mesh.numbers()[local(p)]; });
      sent[mesh.owners()[local(*least)]].push_back({ key, cell, this->group().rank() });
    }
  }
  std::vector<Candidate> all;
  for (const std::vector<Candidate>& list : this->group().exchangeItems(sent))
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end());
  std::vector<std::vector<Index>> answers(ranks);
  for (std::size_t i = 1; i < all.size(); ++i)
  {
    if (all[i].key == all[i - 1].key)
    {
      answers[static_cast<std::size_t>(all[i].rank)].push_back(all[i].cell);
    }
  }
  this->Spread->copied.assign(piece.numberOfCells, 0);
  for (const std::vector<Index>& list : this->group().exchangeItems(answers))
  {
    for (const Index cell : list)
    {
      this->Skip[cell] = this->Spread->copied[cell] = 1;
    }
  }
}
}
