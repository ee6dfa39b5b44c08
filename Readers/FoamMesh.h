// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamMesh.h
 * @brief A mesh of OpenFOAM: points, faces between two cells or on a patch, and zones.
 *
 * The normal of a face (its points run counter-clockwise seen from its tip) points out of the
 * owner, to the neighbour or out of the mesh.
 */
#ifndef tautline_FoamMesh_h
#define tautline_FoamMesh_h

#include "MeshFile.h"

#include <optional>

namespace tautline
{
/// A part of the boundary: the faces from `start` on.
struct FoamPatch
{
  std::string name;
  std::string type; ///< patch, wall, cyclic, processor, empty, wedge, symmetry, ...
  Index start = 0;
  Index size = 0;
  std::string neighbor;       ///< name of the other patch of a cyclic one, or empty
  std::string whole;          ///< of a processorCyclic patch: the patch that it is a part of
  int processor = -1;         ///< of a processor patch: its processor
  int neighborProcessor = -1; ///< and the one on the other side
  std::string rest;           ///< of a cyclicACMI patch: the patch of the same faces, or empty

  bool ofProcessor() const { return this->neighborProcessor >= 0; }
  /// Whether its faces are internal faces of the whole mesh.
  bool betweenProcessors() const { return this->ofProcessor() && this->whole.empty(); }
};

/// A named set of cells or faces.
struct FoamZone
{
  std::string name;
  std::vector<Index> members;
};

/// The internal faces come first, then those of the patches, in their order.
struct TAUTLINEREADERS_EXPORT FoamMesh
{
  std::vector<double> points;
  std::vector<Index> faceOffsets = { 0 };
  std::vector<Index> facePoints;
  std::vector<Index> owner;    ///< of each face
  std::vector<Index> neighbor; ///< of each internal face
  Index cells = 0;
  std::vector<FoamPatch> patches;
  std::vector<FoamZone> cellZones;
  std::vector<FoamZone> faceZones;

  Index numberOfPoints() const { return static_cast<Index>(this->points.size() / 3); }
  Index numberOfFaces() const { return static_cast<Index>(this->owner.size()); }
  Index numberOfInternalFaces() const { return static_cast<Index>(this->neighbor.size()); }
};

/// The faces of each cell in ascending order: cell i has those from offsets[i] on.
struct FoamCellFaces
{
  std::vector<Index> offsets;
  std::vector<Index> faces;
};
TAUTLINEREADERS_EXPORT FoamCellFaces cellFacesOf(const FoamMesh& mesh);

/**
 * @brief The cells in VTK's form.
 *
 * Where a cyclicACMI patch and its nonOverlapPatch have the same face, the cell has it once.
 *
 * A cell is a tetrahedron, pyramid, wedge or hexahedron where its faces are those of VTK's cell,
 * oriented outwards; else a polyhedron, whose points are listed once each.
 */
struct FoamCells
{
  FoamCellFaces cellFaces;
  std::vector<unsigned char> types;
  std::vector<Index> offsets = { 0 };
  std::vector<Index> connectivity;
  /// Where the faces of each polyhedron begin in faceStreams, -1 for other cells; empty without
  /// polyhedra.
  std::vector<Index> faceStarts;
  /// Of each polyhedron its number of faces, then the number of points and the points of each as
  /// seen from outside, from the first point in the file on.
  std::vector<Index> faceStreams;
};

/// An error in the topology, at a face (an entry of `faces`) or at a face's owner.
struct FoamDefect
{
  std::string file; ///< faces, owner
  Index entry;
  std::string problem;
};

/// Throws FoamDefect for cells with fewer than four faces, two faces with the same points, or an
/// edge that an odd number of its faces have: it is open.
TAUTLINEREADERS_EXPORT FoamCells cellsOf(const FoamMesh& mesh);

/**
 * @brief Reads a directory `polyMesh`: points, faces, owner, neighbour, boundary, and the zones of
 * cells and faces if there are any.
 *
 * Throws FileError with file and line (in binary files: the byte) for what is missing, truncated or
 * inconsistent: faces with fewer than three or repeated points, owners that are not below the
 * neighbours, patches that do not cover the faces of the boundary, and FoamDefect.
 * @param cells if given, what cellsOf() finds
 */
TAUTLINEREADERS_EXPORT FoamMesh readFoamMesh(const std::string& folder, FoamCells* cells = nullptr);

/// The number of internal faces that checkMesh counts as not in upper triangular order: seen from
/// the lower cell, a later neighbor has an earlier face.
TAUTLINEREADERS_EXPORT Index facesOutOfOrder(const FoamMesh& mesh, const FoamCellFaces& cellFaces);
}
#endif
