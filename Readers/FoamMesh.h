// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FoamMesh.h
 * @brief An OpenFOAM mesh: points, faces between two cells or on a patch, and zones.
 *
 * The normal of a face (its points run counterclockwise as seen from the tip of the normal) points
 * out of the owner, to the neighbor or out of the mesh.
 */
#ifndef tautline_FoamMesh_h
#define tautline_FoamMesh_h

#include "MeshFile.h"

#include <optional>

namespace tautline
{
/// A part of the boundary, with the faces starting at `start`.
struct FoamPatch
{
  std::string name;
  std::string type; ///< patch, wall, cyclic, processor, empty, wedge, symmetry, ...
  Index start = 0;
  Index size = 0;
  std::string neighbor;       ///< name of the partner of a cyclic patch, or empty
  std::string whole;          ///< for a processorCyclic patch: the patch to which it belongs
  int processor = -1;         ///< for a processor patch: its processor
  int neighborProcessor = -1; ///< and the one on the other side
  std::string rest;           ///< for a cyclicACMI patch: the patch of the same faces, or empty

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

/// The internal faces come first, then the faces of the patches in their order.
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

/// The faces of each cell in ascending order; the faces of cell i start at offsets[i].
struct FoamCellFaces
{
  std::vector<Index> offsets;
  std::vector<Index> faces;
};
TAUTLINEREADERS_EXPORT FoamCellFaces cellFacesOf(const FoamMesh& mesh);

/**
 * @brief The cells in VTK's format.
 *
 * Where a cyclicACMI patch and its nonOverlapPatch have the same face, the cell has it once.
 *
 * A cell is a tetrahedron, pyramid, wedge or hexahedron if its faces match VTK's cell and are
 * oriented outward; otherwise it is a polyhedron, whose points are listed once each.
 */
struct FoamCells
{
  FoamCellFaces cellFaces;
  std::vector<unsigned char> types;
  std::vector<Index> offsets = { 0 };
  std::vector<Index> connectivity;
  /// The start of the faces of each polyhedron in faceStreams, -1 for other cells; empty without
  /// polyhedra.
  std::vector<Index> faceStarts;
  /// For each polyhedron its number of faces, then for each face the number of points and the
  /// points as seen from outside, beginning with the first point in the file.
  std::vector<Index> faceStreams;
};

/// An error in the topology, at a face (an entry of `faces`) or at a face's owner.
struct FoamDefect
{
  std::string file; ///< faces, owner
  Index entry;
  std::string problem;
};

/// Throws FoamDefect for cells with fewer than four faces, with two faces with the same points, or
/// with an edge of an odd number of its faces (an open cell).
TAUTLINEREADERS_EXPORT FoamCells cellsOf(const FoamMesh& mesh);

/**
 * @brief Reads a directory `polyMesh`: `points`, `faces`, `owner`, `neighbour`, `boundary`, and the
 * zones of cells and faces if there are any.
 *
 * Throws FileError with file and line (in binary files: the byte) for missing, truncated or
 * inconsistent data: faces with fewer than three or repeated points, owners that are not below the
 * neighbors, patches that do not cover the faces of the boundary, and FoamDefect.
 * @param cells if given, set to the result of cellsOf()
 */
TAUTLINEREADERS_EXPORT FoamMesh readFoamMesh(const std::string& folder, FoamCells* cells = nullptr);

/// The number of internal faces that checkMesh counts as not in upper triangular order: for the
/// lower cell, a later neighbor has an earlier face.
TAUTLINEREADERS_EXPORT Index facesOutOfOrder(const FoamMesh& mesh, const FoamCellFaces& cellFaces);
}
#endif
