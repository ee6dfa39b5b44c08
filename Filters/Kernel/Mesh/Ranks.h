// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Ranks.h
 * @brief The ranks that work on a mesh together: sums over all of them, and who counts a point.
 */
#ifndef tautline_Ranks_h
#define tautline_Ranks_h

#include "DistributedMesh.h"
#include "tautline/Core/Communicator.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace tautline
{
/**
 * @class tautline::Ranks
 * @brief The ranks of a distributed mesh; by default this process alone, where nothing is
 * communicated and every sum is bitwise the caller's.
 *
 * An algorithm takes the local mesh and the ranks. On several ranks the local mesh is
 * DistributedMesh::view(), which has all cells around the points that a rank owns. What the methods
 * return is bitwise the same on all ranks, so that they take the same decisions. All methods but
 * owns() and ownsCell() are collective.
 */
class TAUTLINE_KERNEL_EXPORT Ranks
{
public:
  Ranks() = default;
  /// Mesh and ids, one per local point, stay alive; the communicator has the ranks of the mesh.
  Ranks(DistributedMesh& mesh, const std::vector<Index>& ids, Communicator communicator)
    : Spread(&mesh)
    , Ids(ids.data())
    , Comm(communicator)
  {
  }
  /// Sums over few points are in the order of their numbers in the mesh, which stays alive.
  explicit Ranks(DistributedMesh& mesh)
    : Ranks(mesh, mesh.numbers(), mesh.group().communicator())
  {
  }

  bool several() const { return this->Spread != nullptr; }
  /// Of several ranks.
  DistributedMesh& mesh() const { return *this->Spread; }
  /// Null: this process alone.
  RankGroup* group() const { return this->Spread ? &this->Spread->group() : nullptr; }
  Communicator communicator() const { return this->Comm; }
  /// The order of points in sums over few of them, which reproduce the serial sums bitwise.
  Index id(Index point) const { return this->Ids[point]; }
  bool owns(Index point) const { return !this->Spread || this->Spread->owned(point); }
  bool ownsCell(Index cell) const { return !this->Spread || this->Spread->ownedCells()[cell]; }

  /// Replaces numbers by their sums, added in the order of the ranks.
  void sum(double* values, Index count) const;
  double sum(double value) const
  {
    this->sum(&value, 1);
    return value;
  }
  Index sum(Index value) const { return this->Spread ? this->Spread->group().sum(value) : value; }
  /// The sum of the values of all ranks, rounded once, whatever their order; on one process added
  /// one by one to the start.
  double total(const std::vector<double>& values, double start = 0.0) const;
  double maximum(double value) const
  {
    return this->Spread ? this->Spread->group().maximum(value) : value;
  }
  bool any(bool value) const { return this->Spread ? this->Spread->group().any(value) : value; }
  /// Of the whole mesh; a rank may have no cells.
  Dimension dimension(const Mesh& local) const;
  /// One flag per local point: on the boundary of the whole mesh.
  std::vector<unsigned char> boundary(const Mesh& local) const;
  /// Inverted and degenerate elements of the whole mesh: cells of its own dimension.
  /// @param validity of the local cells, as Mesh::classifyCells() gives it
  Index countInvalid(const Mesh& local, const std::vector<signed char>& validity) const;
  /// The space of the whole mesh, whose pieces with cells agree on it.
  MeshSpace space(const Mesh& local) const;
  /// Does work that does not communicate; what it throws on one rank is thrown on all.
  void together(const std::function<void()>& work) const;

  /// Does work that does not communicate. On several ranks, if it has not enough memory on one,
  /// throws MemoryError on all.
  void inMemory(const std::function<void()>& work, const char* message) const;

  /// The values of the points that this rank owns, to all that have them.
  void exchange(double* values, int components) const;
  void exchange(unsigned char* flags) const;
  /// Flags that are set on any rank.
  void either(unsigned char* flags) const;

  /**
   * @brief Numbers sets of points, each of which may go on on other ranks: on several ranks in the
   * order of their smallest points, on one in that of their first members. What joins two points
   * must be known to the ranks that own them. Takes as many rounds as a set has ranks one after
   * the other.
   * @param sets of local points: the parts of the sets here
   * @param member one flag per local point; the others get -1
   * @param count the number of sets on all ranks
   * @return the number per local point; the owner's counts
   */
  std::vector<Index> numberSets(
    UnionFind& sets, const std::vector<unsigned char>& member, Index& count) const;

private:
  DistributedMesh* Spread = nullptr;
  const Index* Ids = nullptr;
  Communicator Comm = nullptr;
};

/// The local cells, where the points are. @param mirrored see Mesh::setMirrored()
inline Mesh localMesh(const DistributedMesh& mesh, bool mirrored = false, int threads = 0)
{
  Mesh local(mesh.view(), threads);
  local.setMirrored(mirrored);
  return local;
}

/// One flag per local point: on the boundary of the whole mesh. Collective.
TAUTLINE_KERNEL_EXPORT std::vector<unsigned char> rankBoundary(const DistributedMesh& mesh);

/// Replaces members of items by their sums over all ranks.
/// @param members the addresses of an item's members @param sizes of these, in numbers
template <class Item, class Members, std::size_t Count>
void addUp(const Ranks& ranks, std::vector<Item>& items, const Members& members,
  const std::size_t (&sizes)[Count])
{
  if (!ranks.several())
  {
    return;
  }
  std::vector<double> values;
  for (Item& item : items)
  {
    const auto from = members(item);
    for (std::size_t m = 0; m < Count; ++m)
    {
      values.insert(values.end(), from[m], from[m] + sizes[m]);
    }
  }
  ranks.sum(values.data(), static_cast<Index>(values.size()));
  auto next = values.begin();
  for (Item& item : items)
  {
    const auto to = members(item);
    for (std::size_t m = 0; m < Count; ++m)
    {
      std::copy_n(next, sizes[m], to[m]);
      next += static_cast<std::ptrdiff_t>(sizes[m]);
    }
  }
}
}
#endif
