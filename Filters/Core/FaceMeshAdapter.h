// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::FaceMeshAdapter
 * @brief The faces of a vtkDataSet, with owners and neighbors, as finite-volume programs have them.
 *
 * Cells are those of highest dimension. Of volumes, linear cells and polyhedra count; 2D cells
 * beside them are faces of patches by the cell array `Patch` and the field data `PatchNames`,
 * `PatchTypes` and `NeighbourPatch`, as vtkFoamMeshReader makes them, or else of one patch. Two of
 * them at one face make a baffle of it.
 *
 * A plane mesh of triangles, quadrilaterals and polygons becomes one layer of prisms between two
 * "empty" patches. A mesh of one layer of cells, of which no patches are known, gets such a patch,
 * see markLayer().
 *
 * The pieces of one mesh are measured as one by ofPieces(): each gets the cells across its border.
 *
 * The data set and the adapter must outlive it.
 */
#ifndef tautline_FaceMeshAdapter_h
#define tautline_FaceMeshAdapter_h

#include "TautlineCoreModule.h" // for export macro

#include "MeshAdapter.h"
#include "tautline/FiniteVolume/FacePieces.h"

#include <memory>

namespace tautline
{
/// A mesh or a piece of one; both are borrowed.
struct FaceInput
{
  vtkDataSet* data;
  MeshAdapter* adapter; ///< of the data set, oriented
};

class TAUTLINECORE_EXPORT FaceMeshAdapter
{
public:
  /// The field data and the cell array that say which patches there are.
  static constexpr const char* PatchArray = "Patch";
  static constexpr const char* PatchNames = "PatchNames";
  static constexpr const char* PatchTypes = "PatchTypes";
  static constexpr const char* NeighborPatches = "NeighbourPatch";
  static constexpr const char* FacesOutOfOrder = "FacesOutOfOrder";
  static constexpr const char* FoamCase = "FoamCase";

  /**
   * @brief Finds the faces.
   * @param adapter of the same data set, oriented
   *
   * Throws Error where cells overlap, and where facets are of no cell.
   */
  FaceMeshAdapter(vtkDataSet* input, MeshAdapter& adapter, int threads = 0);

  /// Finds the faces of the pieces of one mesh, and couples them, see joinPieces(). Ghost cells do
  /// not count. Collective. Throws as the constructor does.
  static std::vector<std::unique_ptr<FaceMeshAdapter>> ofPieces(
    RankGroup& group, const std::vector<FaceInput>& pieces, int threads = 0);

  const FaceMesh& mesh() const { return this->Faces; }
  /// Coordinates of the points of mesh(): the points of the data set, for a plane mesh followed by
  /// the points above them, for a piece by the points of cells across its border.
  const double* points() const
  {
    return this->Points.empty() ? this->View.points : this->Points.data();
  }
  /// The cell of the data set that each cell of mesh() is, but for those across the border of a
  /// piece, which follow.
  const std::vector<Index>& cells() const { return this->Cells; }
  const MeshCheckFacts& facts() const { return this->Facts; }
  /// Whether a plane mesh was made one layer of prisms.
  bool extruded() const { return this->Extruded; }
  /// What was assumed, in sentences for the user, or "".
  const std::string& notice() const { return this->Notice; }

private:
  FaceMeshAdapter() = default;
  static void find(RankGroup& group, const std::vector<FaceInput>& pieces,
    const std::vector<FaceMeshAdapter*>& adapters, int threads);
  void list(vtkDataSet* input, const MeshAdapter& adapter, double height, int threads);
  void listVolumes(vtkDataSet* input, const MeshAdapter& adapter, int threads);
  void listPolygons(const Mesh& mesh, double height);
  std::vector<FacePatch> listPatches(vtkDataSet* input);
  void listFacets(vtkDataSet* input, int patches);

  MeshView View;
  FaceMesh Faces;
  ListedFaces List;
  ListedFacets Facets;
  std::vector<Index> FacetIds; ///< global ids; empty: there are none
  std::vector<Index> Cells;
  std::vector<double> Points;
  bool Extruded = false;
  MeshCheckFacts Facts;
  std::string Notice;
};

/// Gives the pieces of a mesh of 2D cells the space that they fill with their polygons, which Mesh
/// leaves out of account. Collective.
TAUTLINECORE_EXPORT void setSpaceWithPolygons(
  RankGroup& group, const std::vector<FaceInput>& pieces);
}
#endif
