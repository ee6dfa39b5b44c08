// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::FaceQuality
 * @brief The metrics of finite volumes on one data set, for vtkElementQuality.
 */
#ifndef tautline_FaceQuality_h
#define tautline_FaceQuality_h

#include "FaceMeshAdapter.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkDataSet;
class vtkPolyData;

namespace tautline
{
class FaceQuality
{
public:
  /// @param adapter of the input, oriented; both must outlive it
  FaceQuality(
    vtkDataSet* input, const MeshAdapter& adapter, FaceConvention convention, int threads);

  /// Sets the validity of polyhedra and polygons, which Mesh::classifyCells() leaves.
  void classify(signed char* validity) const;

  /// Writes the values of a metric of MetricFamily::Faces, one per cell of the data set; 0 for
  /// those that are no cells of highest dimension. Keeps those of faces for the output.
  void measure(Metric metric, double* values);

  /// Makes the checks of checkMesh.
  const MeshCheckReport& check();

  /**
   * @brief The faces, after measure() and check(), with cell arrays: `Face`, `Owner` and
   * `Neighbour` (cells of the data set, -1: none), `Patch` (-1: internal), `Failed` (1 << kind of
   * the checks that the face or one of its cells fails), `OwnerWeight`, and the metrics of faces.
   * @param all false: only faces that fail a check, or are of a cell that does
   */
  vtkSmartPointer<vtkPolyData> faces(bool all) const;

  const FaceMeasures& measures() const { return this->Measures; }
  const std::string& notice() const { return this->Adapter.notice(); }

private:
  std::vector<std::uint32_t> failures() const;

  vtkDataSet* Input;
  FaceMeshAdapter Adapter;
  FaceMeasures Measures;
  MeshCheckReport Report;
  bool Checked = false;
  std::vector<std::pair<Metric, std::vector<double>>> FaceValuesOf;
};

/// For a mesh of which some metrics are those of finite volumes, or that has polyhedra; else null.
/// @param adapter gets the plane of polygons, where there are
std::unique_ptr<FaceQuality> makeFaceQuality(vtkDataSet* input, MeshAdapter& adapter,
  const std::vector<Metric>& metrics, FaceConvention convention, int threads);

/// Whether a mesh has cells that only metrics of finite volumes measure: polyhedra, and polygons
/// of a plane mesh.
bool hasPolyhedra(const Mesh& mesh);
}
#endif
