// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamCase.h
 * @brief The mesh of an OpenFOAM case: where it is, whole or decomposed, and pieces of it.
 */
#ifndef tautline_FoamCase_h
#define tautline_FoamCase_h

#include "FoamMesh.h"

namespace tautline
{
/// Which mesh of a case is read.
enum class FoamCaseType
{
  Automatic,     ///< constant/polyMesh if there is one, else the processors
  Reconstructed, ///< constant/polyMesh
  Decomposed     ///< processor0, processor1, ...
};

struct FoamRequest
{
  /// A .foam or .OpenFOAM file in the directory of the case, its system/controlDict, the directory
  /// itself, or a directory polyMesh.
  std::string name;
  std::string region; ///< the mesh is in constant/<region>/polyMesh; empty: constant/polyMesh
  FoamCaseType type = FoamCaseType::Automatic;
  int piece = 0; ///< from 0
  int pieces = 1;
};

/// Where the meshes of a case are.
struct FoamLocation
{
  std::vector<std::string> folders; ///< absolute, one polyMesh or that of each processor
  bool decomposed = false;
};

/// Throws FileError if there is no mesh, naming what was looked for.
TAUTLINEREADERS_EXPORT FoamLocation locateFoamCase(const FoamRequest& request);

/// The absolute directory of the case that a name stands for, see FoamRequest; a directory polyMesh
/// stands for itself. Throws FileError if there is no such file.
TAUTLINEREADERS_EXPORT std::string foamCaseFolder(const std::string& name);

/// A directory polyMesh as a part of its case.
struct FoamMeshPath
{
  std::string folder;  ///< of the case
  std::string inside;  ///< the path from there: [processor3/]constant[/<region>]/polyMesh
  std::string ofTimes; ///< the directory with those of the time steps: the case, or a processor
  std::string region;
  bool constant = false; ///< whether it is in the directory `constant`
};
TAUTLINEREADERS_EXPORT FoamMeshPath splitFoamPath(const std::string& meshFolder);

/// Directories polyMesh of time steps that have points of their own, beside a constant mesh.
TAUTLINEREADERS_EXPORT std::vector<std::string> movingFoamMeshes(const FoamMeshPath& path);

/// What is read of a case.
struct FoamPiece
{
  FoamMesh mesh;
  FoamCells cells;
  std::vector<std::string> folders; ///< directories polyMesh whose points the mesh has
  /// Of each directory of processors: the number in the mesh of each point in its file.
  std::vector<std::vector<Index>> pointNumbers;
  /// Of a piece of several: the numbers in the whole mesh of its points, cells and faces; else
  /// empty. A face between two pieces is in both.
  std::vector<Index> pointIds, cellIds, faceIds;
  Index allCells = 0, allFaces = 0; ///< in the whole mesh
  std::vector<std::string> warnings;
};

/**
 * @brief Reads a case, or a piece of it.
 *
 * One piece is the whole mesh. A decomposed case is put together: by the lists *ProcAddressing of
 * decomposePar, in the order of the mesh before it, or without usable ones along the processor
 * patches, whose faces correspond by their numbers, the internal faces in upper triangular order.
 *
 * Several pieces of a decomposed case are processors piece, piece + pieces, ..., one after another
 * with their processor patches. A case that is not decomposed is divided by recursive bisection, as
 * by partOf(), and gets processor patches.
 *
 * Throws FileError.
 */
TAUTLINEREADERS_EXPORT FoamPiece readFoamCase(const FoamRequest& request);

/// The whole mesh of directories that locateFoamCase() has found. Throws FileError.
TAUTLINEREADERS_EXPORT FoamPiece readFoamFolders(const std::vector<std::string>& folders);
}
#endif
