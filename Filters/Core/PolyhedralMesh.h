// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::PolyhedralMesh
 * @brief A data set of volumes whose points are moved to improve the measures of its faces.
 *
 * The constraints on the boundary are found on a tetrahedral mesh with the same boundary, which
 * joins each triangle of a face with the center of its cell.
 */
#ifndef tautline_PolyhedralMesh_h
#define tautline_PolyhedralMesh_h

#include "TautlineCoreModule.h" // for export macro

#include "BoundarySetup.h"
#include "FaceMeshAdapter.h"
#include "tautline/Polyhedral/ImproveFaces.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>

class vtkPointSet;
class vtkUnstructuredGrid;

namespace tautline
{
class TAUTLINECORE_EXPORT PolyhedralMesh
{
public:
  /// Throws Error for data sets that are not point sets, for planar meshes and surfaces, and as
  /// FaceMeshAdapter does.
  PolyhedralMesh(const InputBlock& block, int threads);
  ~PolyhedralMesh();

  /// Moves the points.
  ImproveFacesResult improve(const BoundaryProperties& boundary, ImproveFacesOptions options);

  /// Gives the output the points of a result, in double precision, the array `Displacement` and the
  /// cell array `Validity`, which is also returned.
  std::vector<signed char> move(vtkPointSet* output, const ImproveFacesResult& result) const;
  /// The cell arrays non_orthogonality and face_skewness, with and without the ending `_before`.
  void addMeasures(vtkPointSet* output, const ImproveFacesResult& result) const;

  /// The validity of each cell of the data set with the points of the input.
  std::vector<signed char> validity() const { return this->validityAt(this->Faces.points()); }
  const FaceMesh& faces() const { return this->Faces.mesh(); }
  /// Sentences on the features of the boundary, and remarks.
  const std::string& notice() const { return this->Notice; }

private:
  void makeSolid();
  std::vector<signed char> validityAt(const double* points) const;
  void addMeasures(vtkPointSet* output, const double* points, const char* ending) const;

  const InputBlock& Given;
  int Threads;
  MeshAdapter Adapter;
  FaceMeshAdapter Faces;
  vtkSmartPointer<vtkUnstructuredGrid> Solid, Selected;
  std::string Notice;
};

/// Whether a data object has polyhedra.
TAUTLINECORE_EXPORT bool hasPolyhedra(vtkDataObject* input);

/// Describes a result in sentences for the user.
TAUTLINECORE_EXPORT std::string summarize(const ImproveFacesResult& result);
}
#endif
