// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamProcessors.h
 * @brief Joins the meshes of the processors of a decomposed case, with or without their seams, and
 * divides a mesh into pieces as decomposePar does. Internal: not installed.
 */
#ifndef tautline_FoamProcessors_h
#define tautline_FoamProcessors_h

#include "FoamCase.h"

namespace tautline
{
/// The numbers in the undecomposed mesh, as written by decomposePar.
struct FoamAddresses
{
  std::vector<Index> points, cells;
  std::vector<Index> faces;   ///< number + 1, negative if the face is reversed
  std::vector<Index> patches; ///< -1 for processor patches

  /// Whether there is a list for each kind of entity.
  static bool exist(const std::string& folder);
  static FoamAddresses read(const std::string& folder);
};

struct FoamProcessor
{
  std::string folder;
  FoamMesh mesh;
  FoamAddresses addresses; ///< empty if the files are missing
};

/**
 * @brief The mesh before the decomposition, from the addresses.
 * @return the reason why the addresses do not define one mesh; empty if they do
 */
std::string composeByAddresses(const std::vector<FoamProcessor>& processors, FoamPiece& whole);

/// The treatment of the patches between processors in joinProcessors().
enum class FoamSeams
{
  Sewn, ///< their faces become internal faces
  Kept  ///< they stay patches
};

/// The new numbers of the entities of each processor.
struct FoamNumbers
{
  std::vector<std::vector<Index>> points, faces;
  std::vector<Index> firstCell; ///< of each processor
};

/**
 * @brief Joins the meshes of the processors into one mesh, with the cells of one processor after
 * the other.
 *
 * Patches of the same name become one. With sewn seams, the internal faces are in upper triangular
 * order; points on both sides of a seam are one point. Throws FileError if two sides of a seam do
 * not correspond.
 */
FoamNumbers joinProcessors(
  const std::vector<FoamProcessor>& processors, FoamSeams seams, FoamMesh& joined);

/// The cells of a piece with processor patches to its neighbors, and the numbers of its entities.
FoamPiece divideMesh(const FoamMesh& mesh, int piece, int pieces);

/// Adds the members of a zone to the zone of the same name, each once.
void addZone(std::vector<FoamZone>& zones, const std::string& name, std::vector<Index> members);
}
#endif
