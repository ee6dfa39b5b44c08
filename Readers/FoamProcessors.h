// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamProcessors.h
 * @brief The meshes of the processors of a decomposed case, put together or one after the other,
 * and a mesh divided into pieces as decomposePar divides it.
 * Internal: not installed.
 */
#ifndef tautline_FoamProcessors_h
#define tautline_FoamProcessors_h

#include "FoamCase.h"

namespace tautline
{
/// The numbers in the undecomposed mesh that decomposePar writes.
struct FoamAddresses
{
  std::vector<Index> points, cells;
  std::vector<Index> faces;   ///< number + 1, negative where the face runs the other way
  std::vector<Index> patches; ///< -1 for processor patches

  /// Whether there is a list for each of the entities.
  static bool exist(const std::string& folder);
  static FoamAddresses read(const std::string& folder);
};

struct FoamProcessor
{
  std::string folder;
  FoamMesh mesh;
  FoamAddresses addresses; ///< empty without the files
};

/**
 * @brief The mesh before the decomposition, from the addresses.
 * @return why the addresses do not give one mesh; empty if they do
 */
std::string composeByAddresses(const std::vector<FoamProcessor>& processors, FoamPiece& whole);

/// How joinProcessors() treats the patches between processors.
enum class FoamSeams
{
  Sewn, ///< their faces become internal faces
  Kept  ///< they stay patches
};

/// What has become of the entities of each processor.
struct FoamNumbers
{
  std::vector<std::vector<Index>> points, faces;
  std::vector<Index> firstCell; ///< of each processor
};

/**
 * @brief One mesh of those of the processors, whose cells follow each other.
 *
 * Patches of the same name become one. With sewn seams, the internal faces are in upper triangular
 * order; points on both sides of a seam are one point. Throws FileError if two sides of a seam do
 * not correspond.
 */
FoamNumbers joinProcessors(
  const std::vector<FoamProcessor>& processors, FoamSeams seams, FoamMesh& joined);

/// The cells of a piece with processor patches to its neighbors, and the numbers of its entities.
FoamPiece divideMesh(const FoamMesh& mesh, int piece, int pieces);

/// Adds the members of a zone to that of the same name, each once.
void addZone(std::vector<FoamZone>& zones, const std::string& name, std::vector<Index> members);
}
#endif
