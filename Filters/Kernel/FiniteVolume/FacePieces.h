// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacePieces.h
 * @brief A face mesh in pieces, on one or several ranks, that is measured as one mesh.
 *
 * Each piece gets copies of the cells across its border, to which its faces are coupled like the
 * faces of "processor" patches in OpenFOAM. Each piece thus measures its own cells and faces with
 * the same values as in the whole mesh.
 */
#ifndef tautline_FacePieces_h
#define tautline_FacePieces_h

#include "MeshChecks.h"
#include "tautline/Core/RankGroup.h"

namespace tautline
{
/// A piece of a mesh; the arrays are borrowed.
struct FacePiece
{
  FaceMesh* mesh = nullptr;
  const double* points = nullptr; ///< 3 coordinates per point of the mesh
  /// One id per point, the same for the same point in all pieces; or null in all pieces: points
  /// with the same coordinates are then identified.
  const Index* globalIds = nullptr;
  /// One id per given facet, in the order of the whole mesh within each patch; or null. They couple
  /// the faces of "cyclic" patches.
  const Index* facetIds = nullptr;
};

/// The extent of the points of all ranks. Collective.
TAUTLINE_KERNEL_EXPORT FaceExtent unite(RankGroup& group, const FaceExtent& own);

/**
 * @brief Creates the patches of one layer of cells, see markLayer(FaceMesh&, ...). Collective.
 * @param pieces without patches
 * @return the axis, or -1 if the mesh is not a layer perpendicular to exactly one axis
 */
TAUTLINE_KERNEL_EXPORT int markLayer(RankGroup& group, const std::vector<FacePiece>& pieces);

/**
 * @brief Adds the cells across the border of each piece. Collective.
 *
 * The border consists of the faces that a cell of another piece also lists, unless two facets are
 * given there (a baffle). They keep their patches and are counted in one piece only. Within a
 * piece, only faces of "processor" patches are coupled. Faces of "cyclic" patches are coupled as in
 * the whole mesh if the facets have ids in all pieces, otherwise within their piece. Patches of
 * type "processorCyclic" are coupled by name, face by face, as written by decomposePar.
 *
 * Throws Error if three or more cells share a face.
 *
 * @return per piece: the coordinates of the points added to its mesh; to measure the mesh, append
 * them to the coordinates of its own points
 */
TAUTLINE_KERNEL_EXPORT std::vector<std::vector<double>> joinPieces(
  RankGroup& group, const std::vector<FacePiece>& pieces);

/// Sets the directions and the extent of the whole mesh for the measures of the pieces. Collective.
TAUTLINE_KERNEL_EXPORT void joinMeasures(
  RankGroup& group, const std::vector<FaceMeasures*>& pieces);

/// The checks of the whole mesh, on all ranks, from the reports on its pieces. Collective.
TAUTLINE_KERNEL_EXPORT std::vector<MeshCheck> joinReports(
  RankGroup& group, const std::vector<MeshCheckReport*>& pieces);
}
#endif
