// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacePieces.h
 * @brief A mesh of faces in pieces, on ranks or on one, that is measured as one mesh.
 *
 * Each piece gets copies of the cells across its border, which its faces are coupled with as those
 * of "processor" patches are in OpenFOAM. So each piece measures its own cells and faces, with the
 * values that they have in the whole mesh.
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
  /// One id per point, the same for the same point; or null, in all pieces: then points with the
  /// same coordinates are one.
  const Index* globalIds = nullptr;
  /// One id per given facet, in the order of the whole mesh within each patch; or null. The faces
  /// of "cyclic" patches are coupled by them.
  const Index* facetIds = nullptr;
};

/// The extent of the points of all ranks. Collective.
TAUTLINE_KERNEL_EXPORT FaceExtent unite(RankGroup& group, const FaceExtent& own);

/**
 * @brief Makes the patches of one layer of cells, see markLayer(FaceMesh&, ...). Collective.
 * @param pieces without patches
 * @return the axis, or -1: the mesh is no layer across one axis only
 */
TAUTLINE_KERNEL_EXPORT int markLayer(RankGroup& group, const std::vector<FacePiece>& pieces);

/**
 * @brief Adds the cells across the border of each piece. Collective.
 *
 * The border has the faces that a cell of another piece lists, too, unless two facets are given
 * there (a baffle). They keep their patches and count in one piece only. Within a piece, only faces
 * of "processor" patches are coupled. Those of "cyclic" patches are coupled as in the whole mesh if
 * the facets have ids in all pieces, else within their piece. Patches of type "processorCyclic" are
 * coupled by their names, face by face, as decomposePar writes them.
 *
 * Throws Error where three or more cells share a face.
 *
 * @return per piece the coordinates of the points that its mesh got; the mesh is to be measured
 * with those of its own points followed by these
 */
TAUTLINE_KERNEL_EXPORT std::vector<std::vector<double>> joinPieces(
  RankGroup& group, const std::vector<FacePiece>& pieces);

/// Tells the measures of the pieces the directions and the extent of the whole mesh. Collective.
TAUTLINE_KERNEL_EXPORT void joinMeasures(
  RankGroup& group, const std::vector<FaceMeasures*>& pieces);

/// The checks of the whole mesh, on all ranks, from the reports on its pieces. Collective.
TAUTLINE_KERNEL_EXPORT std::vector<MeshCheck> joinReports(
  RankGroup& group, const std::vector<MeshCheckReport*>& pieces);
}
#endif
