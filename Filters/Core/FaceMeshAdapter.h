// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::FaceMeshAdapter
 * @brief The faces of a vtkDataSet with owners and neighbors, as used in finite-volume programs.
 *
 * The cells have the highest dimension in the data set. In volume meshes, linear cells and
 * polyhedra count; 2D cells beside them are faces of patches according to the cell array `Patch`
 * and the field data `PatchNames`, `PatchTypes` and `NeighbourPatch`, as made by vtkFoamMeshReader,
 * or otherwise of a single patch. Two of them at one face make it a baffle.
 *
 * A planar mesh of triangles, quadrilaterals and polygons becomes one layer of prisms between two
 * "empty" patches. A mesh of one layer of cells without known patches gets such a patch, see
 * markLayer().
 *
 * ofPieces() measures the pieces of one mesh as a whole: each piece gets the cells across its
 * border.
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
  /// The names of the field data and the cell array that define the patches.
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
   * Throws Error if cells overlap or facets belong to no cell.
   */
  FaceMeshAdapter(vtkDataSet* input, MeshAdapter& adapter, int threads = 0);

  /// Finds and couples the faces of the pieces of one mesh, see joinPieces(). Ghost cells do not
  /// count. Collective. Throws as the constructor does.
  static std::vector<std::unique_ptr<FaceMeshAdapter>> ofPieces(
    RankGroup& group, const std::vector<FaceInput>& pieces, int threads = 0);

  const FaceMesh& mesh() const { return this->Faces; }
  /// Coordinates of the points of mesh(): the points of the data set, for a planar mesh followed by
  /// the points above them, for a piece by the points of cells across its border.
  const double* points() const
  {
    return this->Points.empty() ? this->View.points : this->Points.data();
  }
  /// The cell of the data set for each cell of mesh(), except for the cells across the border of a
  /// piece, which come last.
  const std::vector<Index>& cells() const { return this->Cells; }
  const MeshCheckFacts& facts() const { return this->Facts; }
  /// Whether a planar mesh was made one layer of prisms.
  bool extruded() const { return this->Extruded; }
  /// The assumptions made, as sentences for the user, or "".
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
  std::vector<Index> FacetIds; ///< global ids; empty if there are none
  std::vector<Index> Cells;
  std::vector<double> Points;
  bool Extruded = false;
  MeshCheckFacts Facts;
  std::string Notice;
};

/// Sets the space of a mesh of 2D cells in pieces to include its polygons, which Mesh does not take
/// into account. Collective.
TAUTLINECORE_EXPORT void setSpaceWithPolygons(
  RankGroup& group, const std::vector<FaceInput>& pieces);
}
#endif
