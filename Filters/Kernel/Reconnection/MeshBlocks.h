// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshBlocks.h
 * @brief Cuts a large mesh into blocks that are changed independently, and joins them again.
 * Internal: not installed.
 *
 * A block is a separate mesh: its tetrahedra and, as a wall, the adjacent tetrahedra of the rest of
 * the mesh (OutsideRegion). The points of the latter are fixed, so that the faces between blocks
 * are preserved and the changed blocks fit together:
 *
 *        block 0   |   block 1            the points on the line | stay; in the next partition,
 *      ------------x------------          cut in other directions, they are inside a block
 *        block 2   |   block 3
 *
 * Partition, blocks and their numbering only depend on the mesh, not on threads.
 */
#ifndef tautline_MeshBlocks_h
#define tautline_MeshBlocks_h

#include "TetrahedronPasses.h"

#include <memory>

namespace tautline
{
/**
 * @brief The block of each slot of a mesh: planes recursively cut the mesh in halves, always
 * perpendicular to the longest extent in a frame.
 * @param frame 0, 1 or 2: the three directions of cuts, oblique to the directions of the other
 *   frames
 * @param levels there are 2^levels blocks
 */
std::vector<std::uint8_t> partition(
  const TetrahedronMesh& mesh, int frame, int levels, int threads);

/// A block with its operations and passes.
class MeshBlock
{
public:
  /**
   * @param own the tetrahedra of the block, in increasing order
   * @param blocks the block of each slot
   * @param rules of the whole mesh; the bounds of the size are shared among the blocks
   */
  MeshBlock(const TetrahedronMesh& whole, const OperationRules& rules, std::vector<TetId> own,
    const std::vector<std::uint8_t>& blocks);

  TetrahedronMesh& mesh() { return this->Mesh; }
  CavityOperations& operations() { return this->Operations; }
  TetrahedronPasses& passes() { return this->Passes; }
  /// The points of the whole mesh that the block has.
  const std::vector<PointId>& points() const { return this->Points; }
  /// For each of these points, whether it is on a face between blocks.
  const std::vector<char>& shared() const { return this->Shared; }

private:
  friend class BlockJoin;

  /// A face between the block and the rest.
  struct SharedFace
  {
    std::int32_t inside, outside; ///< codes in the whole mesh, before any change
    std::int32_t local;           ///< code of the outer side in this mesh
  };

  TetrahedronArrays extract(const TetrahedronMesh& whole, const std::vector<std::uint8_t>& blocks);
  void addOutside(const TetrahedronMesh& whole, const std::vector<std::uint8_t>& blocks,
    TetrahedronArrays& arrays);
  void numberPoints(const TetrahedronMesh& whole, TetrahedronArrays& arrays);

  std::vector<TetId> Own;
  std::vector<TetId> Outside;  ///< of the whole mesh; they follow the tetrahedra of the block
  std::vector<PointId> Points; ///< of the whole mesh
  std::vector<char> Shared;
  std::vector<SharedFace> Faces;
  TetrahedronMesh Mesh;
  CavityOperations Operations;
  TetrahedronPasses Passes;
};

using MeshBlockList = std::vector<std::unique_ptr<MeshBlock>>;

/// Cuts a mesh into blocks.
MeshBlockList cutIntoBlocks(
  const TetrahedronMesh& whole, const OperationRules& rules, int frame, int levels, int threads);

/**
 * @brief Puts the changed blocks back into the original mesh. Unchanged tetrahedra and points keep
 * their ids; new ones follow in the order of the blocks.
 * @param operations of the whole mesh: receives the counts and the freedoms of new points
 */
void joinBlocks(
  TetrahedronMesh& whole, CavityOperations& operations, MeshBlockList& blocks, int threads);
}
#endif
