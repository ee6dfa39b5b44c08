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
  /// @param input must outlive it, and so must the adapter's own
  FaceQuality(vtkDataSet* input, std::unique_ptr<FaceMeshAdapter> adapter,
    FaceConvention convention, int threads);

  /// Sets the validity of polyhedra and polygons, which Mesh::classifyCells() leaves.
  /// @return what was assumed of the mesh, in sentences for the user, or ""
  const std::string& classify(signed char* validity) const;

  /// Writes the values of a metric of MetricFamily::Faces, one per cell of the data set; 0 for
  /// those that are no cells of highest dimension. Keeps those of faces for the output.
  void measure(Metric metric, double* values);

  /// Makes the checks of checkMesh, of a piece on what is of the piece.
  MeshCheckReport& check();

  /**
   * @brief The faces, after measure() and check(), with cell arrays: `Face`, `Owner` and
   * `Neighbour` (cells of the data set, -1: none), `Patch` (-1: internal), `Failed` (1 << kind of
   * the checks that the face or one of its cells fails), `OwnerWeight`, and the metrics of faces.
   * Of pieces, each face is in the output of one, but for failed ones between two pieces, which
   * each has that sees a fault; these have no `Neighbour`.
   * @param all false: only faces that fail a check, or are of a cell that does
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
 * @brief For a mesh of which some metrics are those of finite volumes, or that has polyhedra, that
 * of each piece; else empty. Collective.
 * @param pieces their adapters get the plane of polygons, where there are
 */
std::vector<std::unique_ptr<FaceQuality>> makeFaceQuality(RankGroup& group,
  const std::vector<FaceInput>& pieces, const std::vector<Metric>& metrics,
  FaceConvention convention, int threads);

/// Whether all metrics are those of elements, so that polyhedra are left out.
bool measuresElementsOnly(const std::vector<Metric>& metrics);

/// Of a mesh in one piece; null where there is none.
std::unique_ptr<FaceQuality> makeFaceQuality(const FaceInput& mesh,
  const std::vector<Metric>& metrics, FaceConvention convention, int threads);
}
#endif
