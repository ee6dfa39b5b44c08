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
 * The data set and the adapter must outlive it.
 */
#ifndef tautline_FaceMeshAdapter_h
#define tautline_FaceMeshAdapter_h

#include "TautlineCoreModule.h" // for export macro

#include "MeshAdapter.h"
#include "tautline/FiniteVolume/MeshChecks.h"

namespace tautline
{
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
  FaceMeshAdapter(vtkDataSet* input, const MeshAdapter& adapter, int threads = 0);

  const FaceMesh& mesh() const { return this->Faces; }
  /// Coordinates of the points of mesh(): the points of the data set, for a plane mesh followed by
  /// the points above them.
  const double* points() const
  {
    return this->Points.empty() ? this->View.points : this->Points.data();
  }
  /// The cell of the data set that each cell of mesh() is.
  const std::vector<Index>& cells() const { return this->Cells; }
  const MeshCheckFacts& facts() const { return this->Facts; }
  /// Whether a plane mesh was made one layer of prisms.
  bool extruded() const { return !this->Points.empty(); }
  /// What was assumed, in sentences for the user, or "".
  const std::string& notice() const { return this->Notice; }

private:
  void listVolumes(vtkDataSet* input, const MeshAdapter& adapter, int threads);
  void listPolygons(const Mesh& mesh);
  std::vector<FacePatch> listPatches(vtkDataSet* input);
  void listFacets(vtkDataSet* input, int patches);

  MeshView View;
  FaceMesh Faces;
  ListedFaces List;
  ListedFacets Facets;
  std::vector<Index> Cells;
  std::vector<double> Points;
  MeshCheckFacts Facts;
  std::string Notice;
};

/// The space of a mesh of 2D cells with its polygons, which Mesh leaves out of account.
TAUTLINECORE_EXPORT MeshSpace spaceWithPolygons(const Mesh& mesh);
}
#endif
