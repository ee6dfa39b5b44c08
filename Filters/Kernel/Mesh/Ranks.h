// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Ranks.h
 * @brief The ranks that work on a mesh together: sums over all ranks, and ownership of points.
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
 * @brief The ranks of a distributed mesh; by default this process alone, without communication and
 * with every sum returned bitwise unchanged.
 *
 * An algorithm takes the local mesh and the ranks. On several ranks the local mesh is
 * DistributedMesh::view(), which has all cells around the points that a rank owns. The results of
 * the methods are bitwise identical on all ranks, so that all ranks make the same decisions. All
 * methods except owns() and ownsCell() are collective.
 */
class TAUTLINE_KERNEL_EXPORT Ranks
{
public:
  Ranks() = default;
  /// The mesh and the ids, one per local point, must outlive this object; the communicator must
  /// have the ranks of the mesh.
  Ranks(DistributedMesh& mesh, const std::vector<Index>& ids, Communicator communicator)
    : Spread(&mesh)
    , Ids(ids.data())
    , Comm(communicator)
  {
  }
  /// Sums over few points use the order of their numbers in the mesh, which must outlive this
  /// object.
  explicit Ranks(DistributedMesh& mesh)
    : Ranks(mesh, mesh.numbers(), mesh.group().communicator())
  {
  }

  bool several() const { return this->Spread != nullptr; }
  /// Only for several ranks.
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
  /// The sum of the values of all ranks, rounded once, for any order; on one process, the values
  /// are added to the start one by one.
  double total(const std::vector<double>& values, double start = 0.0) const;
  double maximum(double value) const
  {
    return this->Spread ? this->Spread->group().maximum(value) : value;
  }
  bool any(bool value) const { return this->Spread ? this->Spread->group().any(value) : value; }
  /// The dimension of the whole mesh; a rank may have no cells.
  Dimension dimension(const Mesh& local) const;
  /// One flag per local point: nonzero on the boundary of the whole mesh.
  std::vector<unsigned char> boundary(const Mesh& local) const;
  /// The number of inverted and degenerate elements of the whole mesh: cells of the mesh dimension.
  /// @param validity of the local cells, from Mesh::classifyCells()
  Index countInvalid(const Mesh& local, const std::vector<signed char>& validity) const;
  /// The space of the whole mesh, on which all pieces with cells must agree.
  MeshSpace space(const Mesh& local) const;
  /// Does work that does not communicate; exceptions on one rank are thrown on all ranks.
  void together(const std::function<void()>& work) const;

  /// Does work that does not communicate. On several ranks, throws MemoryError on all ranks if one
  /// has not enough memory.
  void inMemory(const std::function<void()>& work, const char* message) const;

  /// Sends the values of owned points to all ranks that have these points.
  void exchange(double* values, int components) const;
  void exchange(unsigned char* flags) const;
  /// Combines flags over all ranks by logical or.
  void either(unsigned char* flags) const;

  /**
   * @brief Numbers sets of points, each of which may continue on other ranks: on several ranks, in
   * the order of their smallest points; on one rank, in the order of their first members.
   * Connections between two points must be available on the ranks that own them. The number of
   * rounds is the length of the chain of ranks in a set.
   * @param sets of local points: the local parts of the sets
   * @param member one flag per local point: nonzero for members; the others get -1
   * @param count the number of sets on all ranks
   * @return the number per local point; the number of the owner is used
   */
  std::vector<Index> numberSets(
    UnionFind& sets, const std::vector<unsigned char>& member, Index& count) const;

private:
  DistributedMesh* Spread = nullptr;
  const Index* Ids = nullptr;
  Communicator Comm = nullptr;
};

/// The local cells at the current points. @param mirrored see Mesh::setMirrored()
inline Mesh localMesh(const DistributedMesh& mesh, bool mirrored = false, int threads = 0)
{
  Mesh local(mesh.view(), threads);
  local.setMirrored(mirrored);
  return local;
}

/// One flag per local point: nonzero on the boundary of the whole mesh. Collective.
TAUTLINE_KERNEL_EXPORT std::vector<unsigned char> rankBoundary(const DistributedMesh& mesh);

/// Replaces members of items by their sums over all ranks.
/// @param members returns the addresses of the members of an item @param sizes of the members, in
///   numbers
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
