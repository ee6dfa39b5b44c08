// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::PolyhedralMesh
 * @brief A data set of volumes whose points move by the measures of its faces.
 *
 * What the boundary may do is found on a mesh of tetrahedra with the same boundary: each triangle
 * of a face with the center of its cell.
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
  /// Throws Error for data sets that are no point sets, for plane meshes and surfaces, and for what
  /// FaceMeshAdapter refuses.
  PolyhedralMesh(const InputBlock& block, int threads);
  ~PolyhedralMesh();

  /// Moves the points.
  ImproveFacesResult improve(const BoundaryProperties& boundary, ImproveFacesOptions options);

  /// Gives the output the points of a result, in double precision, the array `Displacement` and the
  /// cell array `Validity`, which it returns.
  std::vector<signed char> move(vtkPointSet* output, const ImproveFacesResult& result) const;
  /// The cell arrays non_orthogonality and face_skewness, with and without the ending `_before`.
  void addMeasures(vtkPointSet* output, const ImproveFacesResult& result) const;

  /// The Validity of each cell of the data set at the input's points.
  std::vector<signed char> validity() const { return this->validityAt(this->Faces.points()); }
  const FaceMesh& faces() const { return this->Faces.mesh(); }
  /// What the boundary has for features, and remarks, as sentences.
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

/// What a result is, in sentences for the user.
TAUTLINECORE_EXPORT std::string summarize(const ImproveFacesResult& result);
}
#endif
