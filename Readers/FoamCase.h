// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamCase.h
 * @brief Locates and reads the mesh of an OpenFOAM case, whole or decomposed, or a piece of it.
 */
#ifndef tautline_FoamCase_h
#define tautline_FoamCase_h

#include "FoamMesh.h"

namespace tautline
{
/// The mesh of a case to read.
enum class FoamCaseType
{
  Automatic,     ///< constant/polyMesh if it exists, otherwise the processors
  Reconstructed, ///< constant/polyMesh
  Decomposed     ///< processor0, processor1, ...
};

struct FoamRequest
{
  /// A .foam or .OpenFOAM file in the case directory, its system/controlDict, the directory itself,
  /// or a directory polyMesh.
  std::string name;
  std::string region; ///< the mesh is in constant/<region>/polyMesh; empty: constant/polyMesh
  FoamCaseType type = FoamCaseType::Automatic;
  int piece = 0; ///< from 0
  int pieces = 1;
};

/// The location of the meshes of a case.
struct FoamLocation
{
  std::vector<std::string> folders; ///< absolute, one polyMesh or one per processor
  bool decomposed = false;
};

/// Throws FileError, with the missing paths, if there is no mesh.
TAUTLINEREADERS_EXPORT FoamLocation locateFoamCase(const FoamRequest& request);

/// The absolute case directory for a name, see FoamRequest; a directory polyMesh stands for itself.
/// Throws FileError if it does not exist.
TAUTLINEREADERS_EXPORT std::string foamCaseFolder(const std::string& name);

/// A directory polyMesh as a part of its case.
struct FoamMeshPath
{
  std::string folder;  ///< of the case
  std::string inside;  ///< the path from there: [processor3/]constant[/<region>]/polyMesh
  std::string ofTimes; ///< the directory with the time steps: the case, or a processor
  std::string region;
  bool constant = false; ///< whether it is in the directory `constant`
};
TAUTLINEREADERS_EXPORT FoamMeshPath splitFoamPath(const std::string& meshFolder);

/// The polyMesh directories of time steps with their own points, for a constant mesh.
TAUTLINEREADERS_EXPORT std::vector<std::string> movingFoamMeshes(const FoamMeshPath& path);

/// The data read from a case.
struct FoamPiece
{
  FoamMesh mesh;
  FoamCells cells;
  std::vector<std::string> folders; ///< directories polyMesh whose points the mesh has
  /// For each directory of a processor: the number in the mesh of each point in its file.
  std::vector<std::vector<Index>> pointNumbers;
  /// For one of several pieces: the numbers of its points, cells and faces in the whole mesh;
  /// otherwise empty. A face between two pieces is in both.
  std::vector<Index> pointIds, cellIds, faceIds;
  Index allCells = 0, allFaces = 0; ///< in the whole mesh
  std::vector<std::string> warnings;
};

/**
 * @brief Reads a case, or a piece of it.
 *
 * A single piece is the whole mesh. A decomposed case is joined: by decomposePar's lists
 * *ProcAddressing, in the order of the undecomposed mesh, or, without usable lists, along the
 * processor patches, whose faces correspond by their numbers, with the internal faces in upper
 * triangular order.
 *
 * If there are several pieces, a piece of a decomposed case consists of the processors piece, piece
 * + pieces, ..., one after another with their processor patches. A case that is not decomposed is
 * divided by recursive bisection, as by partOf(), and gets processor patches.
 *
 * Throws FileError.
 */
TAUTLINEREADERS_EXPORT FoamPiece readFoamCase(const FoamRequest& request);

/// The whole mesh in the directories found by locateFoamCase(). Throws FileError.
TAUTLINEREADERS_EXPORT FoamPiece readFoamFolders(const std::vector<std::string>& folders);
}
#endif
