// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceMesh.h
 * @brief A mesh of polyhedral cells in the face-based form of finite-volume programs: faces with an
 * owner and a neighbor.
 *
 * Internal faces come first, sorted by owner and then by neighbor (the neighbor has the larger
 * number); then boundary faces, patch by patch. The points of a face run counterclockwise as seen
 * from its neighbor, so that its area vector points out of its owner.
 */
#ifndef tautline_FaceMesh_h
#define tautline_FaceMesh_h

#include "tautline/Mesh/Mesh.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace tautline
{
/// A part of the boundary.
struct FacePatch
{
  std::string name;
  /// OpenFOAM's name: patch, wall, symmetry, empty, wedge, cyclic, processor, ...
  std::string type = "patch";
  Index first = 0; ///< its first face
  Index count = 0;
  /// For "cyclic": the coupled patch, face by face if the numbers of faces are equal.
  int partner = -1;

  bool isEmpty() const { return this->type == "empty"; }
  /// Whether its faces correspond one-to-one to the faces of another patch.
  bool isCyclic() const { return this->type == "cyclic" || this->type == "cyclicSlip"; }
  /// Whether its points have counterparts in another patch, mesh or process.
  bool isCoupled() const
  {
    return this->type.rfind("cyclic", 0) == 0 || this->type.rfind("mapped", 0) == 0 ||
      this->type.rfind("processor", 0) == 0 || this->type == "overset";
  }
  bool isWedge() const { return this->type == "wedge"; }
  /// Whether its faces are partly coupled: another patch has the same faces for the remaining part.
  bool isPartly() const { return this->type == "cyclicACMI"; }
};

/// The role of a face in a piece of a mesh, see joinPieces(). The values are bits.
enum FaceRole : unsigned char
{
  CountsElsewhere = 1,    ///< in another piece, as a face between two pieces or of a cell there
  PairComesElsewhere = 2, ///< of a cyclic pair whose first face is in another piece
  OnBorder = 4            ///< between two pieces, inside the whole mesh
};

/// Faces, and the cells on their sides.
struct FaceMesh
{
  Index points = 0, cells = 0;
  Index internalFaces = 0;
  Index strayFacets = 0;              ///< given facets that are not faces of a cell
  std::vector<Index> offsets = { 0 }; ///< of each face in `nodes`; one more than faces
  std::vector<Index> nodes;           ///< points of the faces
  std::vector<Index> owner;           ///< cell of each face
  std::vector<Index> neighbor;        ///< cell of each internal face
  std::vector<FacePatch> patches;     ///< they cover the boundary faces, in order
  std::vector<Index> partner;         ///< per boundary face: the coupled face, or -1
  std::vector<Index> cellOffsets;     ///< of each cell in `cellFaces`; one more than cells
  std::vector<Index> cellFaces;       ///< faces of the cells, in increasing order
  std::vector<Index> facet;           ///< per boundary face: the number of the given facet, or -1
  /// Per cell: nonzero if it belongs to another piece and is here for comparison only. Empty: none.
  std::vector<unsigned char> foreignCells;
  std::vector<unsigned char> roles; ///< per face: bits of FaceRole. Empty: none.

  Index faces() const { return static_cast<Index>(this->owner.size()); }
  Index size(Index face) const { return this->offsets[face + 1] - this->offsets[face]; }
  bool internal(Index face) const { return face < this->internalFaces; }
  /// The coupled face of a boundary face, or -1.
  Index coupled(Index face) const { return this->partner[face - this->internalFaces]; }
  /// Whether there are cells on both sides, possibly across a coupled patch.
  bool hasTwoCells(Index face) const { return this->internal(face) || this->coupled(face) >= 0; }
  bool has(Index face, FaceRole role) const
  {
    return !this->roles.empty() && (this->roles[face] & role) != 0;
  }
  /// Whether a cell belongs to this piece.
  bool ownsCell(Index cell) const
  {
    return this->foreignCells.empty() || !this->foreignCells[cell];
  }
  /// Whether a face is counted in this piece. Each face of a mesh is counted in exactly one piece.
  bool ownsFace(Index face) const { return !this->has(face, CountsElsewhere); }
  /// Whether a cell on one side of a face belongs to this piece.
  bool touches(Index face) const
  {
    return this->ownsCell(this->owner[face]) ||
      (this->internal(face) && this->ownsCell(this->neighbor[face]));
  }
  /// Whether the value of a face counts in the mean of a metric that compares two cells: internal
  /// faces and the first face of each coupled pair.
  bool countsOnce(Index face) const
  {
    return this->ownsFace(face) && this->hasTwoCells(face) &&
      (this->internal(face) || this->coupled(face) > face) && !this->has(face, PairComesElsewhere);
  }
};

/// The smallest box around points.
struct FaceExtent
{
  Vec3 low, high;
  FaceExtent()
  {
    this->low.fill(std::numeric_limits<double>::infinity());
    this->high.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const Vec3& p)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->low[c] = std::min(this->low[c], p[c]);
      this->high[c] = std::max(this->high[c], p[c]);
    }
  }
};

/// The faces of cells, each as a list of points that runs counterclockwise as seen from outside.
struct ListedFaces
{
  std::vector<Index> cellOffsets = { 0 }; ///< of each cell in `faceOffsets`
  std::vector<Index> faceOffsets = { 0 }; ///< of each listed face in `nodes`
  std::vector<Index> nodes;
};

/// Faces that are specified in addition to the cells, such as the faces of patches.
struct ListedFacets
{
  std::vector<Index> offsets = { 0 };
  std::vector<Index> nodes;
  std::vector<int> patch; ///< the patch of each; negative: none
};

/**
 * @brief Finds the faces of cells: two cells that list the same points share a face, unless two
 * facets are given there, which are then boundary faces (a baffle). Two facets of "processor"
 * patches do not form a baffle, because pieces were joined there. If one facet belongs to a patch
 * that isPartly() and the other does not, both are boundary faces.
 *
 * The boundary has the given facets, patch by patch, in their order, each starting from its first
 * point if it points out of its cell. Faces without a facet, if any, form the last patch,
 * "boundary". A single facet between two cells is not a boundary face.
 *
 * @param patches their names and types; `first` and `count` are set. Faces of "cyclic" patches are
 * not coupled if the partner has a different number of faces.
 *
 * Throws Error if three or more cells share a face, or if a cell lists a face twice.
 */
TAUTLINE_KERNEL_EXPORT FaceMesh findFaces(Index points, const ListedFaces& cells,
  const ListedFacets& facets, std::vector<FacePatch> patches, int threads = 0);

/// Whether a mesh is one layer of cells perpendicular to an axis: all points are in the two planes
/// that bound the extent, and each cell has one face in each. @param extent of the whole mesh
TAUTLINE_KERNEL_EXPORT bool isLayer(
  const FaceMesh& mesh, const double* points, const FaceExtent& extent, int axis);

/// Collects the faces in the two planes of a layer in an "empty" patch, the first one.
/// @param mesh without coupled patches, for which isLayer() is true
TAUTLINE_KERNEL_EXPORT void markLayer(
  FaceMesh& mesh, const double* points, const FaceExtent& extent, int axis);
}
#endif
