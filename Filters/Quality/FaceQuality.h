// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::FaceQuality
 * @brief Finite-volume metrics on one data set, for vtkElementQuality.
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
  /// @param input must outlive this object, and so must the adapter's own input
  FaceQuality(vtkDataSet* input, std::unique_ptr<FaceMeshAdapter> adapter,
    FaceConvention convention, int threads);

  /// Sets the validity of polyhedra and polygons, which Mesh::classifyCells() does not set.
  /// @return the assumptions on the mesh, as sentences for the user, or ""
  const std::string& classify(signed char* validity) const;

  /// Writes the values of a metric of MetricFamily::Faces, one per cell of the data set; 0 for
  /// cells of lower dimension. Keeps the values of faces for the output.
  void measure(Metric metric, double* values);

  /// Runs the checks of checkMesh; for a piece, on the cells and faces of the piece.
  MeshCheckReport& check();

  /**
   * @brief The faces, after measure() and check(), with cell arrays: `Face`, `Owner` and
   * `Neighbour` (cells of the data set, -1: none), `Patch` (-1: internal), `Failed` (1 << kind of
   * the checks that the face or one of its cells fails), `OwnerWeight`, and the metrics of faces.
   * For pieces, each face is in the output of one piece, except failed faces between two pieces,
   * which are in the output of each piece that detects the failure; these have no `Neighbour`.
   * @param all if false, only faces that fail a check or belong to a cell that does
   */
  vtkSmartPointer<vtkPolyData> faces(bool all) const;

  FaceMeasures& measures() { return this->Measures; }

private:
  std::vector<std::uint32_t> failures() const;

  vtkDataSet* Input;
  std::unique_ptr<FaceMeshAdapter> Adapter;
  FaceMeasures Measures;
  MeshCheckReport Report;
  bool Checked = false;
  std::vector<std::pair<Metric, std::vector<double>>> FaceValuesOf;
};

/**
 * @brief One object per piece for a mesh with polyhedra, or if some metrics are finite-volume
 * metrics; otherwise empty. Collective.
 * @param pieces their adapters get the plane of polygons, if there are any
 */
std::vector<std::unique_ptr<FaceQuality>> makeFaceQuality(RankGroup& group,
  const std::vector<FaceInput>& pieces, const std::vector<Metric>& metrics,
  FaceConvention convention, int threads);

/// Whether all metrics are element metrics, so that polyhedra are left out.
bool measuresElementsOnly(const std::vector<Metric>& metrics);

/// For a mesh in one piece; null if no such object is needed.
std::unique_ptr<FaceQuality> makeFaceQuality(const FaceInput& mesh,
  const std::vector<Metric>& metrics, FaceConvention convention, int threads);
}
#endif
