// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshComparison
 * @brief What changed, element by element, between two meshes of equal connectivity.
 *
 * Compares a mesh before and after something moved its points: perturbation, smoothing, warping.
 * For each metric chosen it shows where elements became better or worse and by how much, and counts
 * them.
 *
 * Validity comes first: an element that becomes valid is better, one that becomes degenerate or
 * inverted is worse. Between two valid elements (and two inverted ones, where the metric orders
 * these, as untangling metrics do) the values are compared, by the direction of the metric. They
 * count as equal if they differ by no more than Tolerance times the larger magnitude; for metrics
 * without a unit whose ideal value is 0, times 1 if that is more. A neutral metric (the size) makes
 * no valid element better or worse.
 *
 * @par Inputs:
 * Port 0 `Input`: the mesh before; port 1 `Other`: the mesh after. Both any vtkDataSet with the
 * same number of points and the same cells with the same points, in the same order; or two
 * composite data sets of the same structure whose blocks are such pairs. Other meshes are refused,
 * and the first difference named. If both meshes are reversed throughout, both are treated as their
 * mirror images.
 *
 * @par Output port 0:
 * The second mesh with its data, and these arrays. Cells: `<metric>_before`, `<metric>_after`,
 * `<metric>_difference` (after minus before) for each metric (double; `imr_before`, ...);
 * `Validity_before`, `Validity_after` and `Change` (signed char). `Change` is 1 if the element
 * became better in some metric and worse in none, -1 if worse in some and better in none, else 0.
 * Points: `Displacement` (3 components, double), second minus first position.
 *
 * @par Output port 1 `Comparison`:
 * A vtkTable with a row per metric: `Metric` (its name); `Better`, `Worse`, `Equal`, numbers of
 * elements on which the metric is defined, ghost cells left out; `InvertedBefore`, `InvertedAfter`,
 * numbers of inverted elements; `MinimumBefore`, `MinimumAfter`, `MeanBefore`, `MeanAfter`,
 * `MaximumBefore`, `MaximumAfter` over the valid and the inverted elements (0 without any);
 * `LargestDisplacement`. For composite data, over all
 * blocks.
 *
 * @par Limitations:
 * Metrics take the ideal cell as their target and the mean over the corners of a cell.
 *
 * @par Several processes:
 * Each compares its pieces; the table and the summary are those of the whole mesh, the table on the
 * first process. The second mesh may be cut otherwise than the first: its points and cells are then
 * found by the global ids of the points (Generate Global Ids), which both need, and the points of
 * the first mesh go to the pieces of the second. Without ids only points that have not moved are
 * found; otherwise it is an error. Pieces with the same cells and other ids are matched by the ids
 * if these match throughout, else by the order of points and cells. That one id is at one place is
 * checked where points are found by ids; pieces with the same cells and the same ids need no match,
 * and points that several of them share are compared piece by piece. Ghost cells are compared and
 * do not count; other copies of cells are not cells of the mesh: where the first mesh is cut
 * otherwise, and where cells have global ids, they are an error. Without global ids of points
 * pieces with the same cells are taken for pieces that are cut alike. Where some cells list their
 * points in the opposite order of their neighbours, or connected parts are reversed and others are
 * not, with coordinates of extreme size, and where processes have different blocks, the first
 * process has both meshes while it computes; the summary states why.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMeshComparison> comparison;
 * comparison->SetInputConnection(0, reader->GetOutputPort());
 * comparison->SetInputConnection(1, perturbation->GetOutputPort());
 * comparison->AddMetricByName("imr");
 * comparison->Update();
 * comparison->GetOutputDataObject(1); // the table
 * @endcode
 *
 * @sa tautline::compareMetric (tautline/Quality/Compare.h), vtkElementQuality, vtkMeshPerturbation
 */

#ifndef vtkMeshComparison_h
#define vtkMeshComparison_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkMetricAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

#include <memory> // for Pieces

class vtkDataSet;

namespace tautline
{
class ComparisonPieces;
class RankGroup;
}

class TAUTLINEQUALITY_EXPORT vtkMeshComparison : public vtkMetricAlgorithm
{
public:
  static vtkMeshComparison* New();
  vtkTypeMacro(vtkMeshComparison, vtkMetricAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Relative difference up to which two values are equal, between 0 and 1. The default is 1e-6,
   * about the rounding of coordinates in single precision.
   */
  vtkTautlineSetRangeMacro(Tolerance, double, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

protected:
  vtkMeshComparison();
  ~vtkMeshComparison() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  tautline::GatheredResult GetGatheredResult() const override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  /// The output is the second mesh.
  int GetGatheredBase() const override { return 1; }

private:
  vtkMeshComparison(const vtkMeshComparison&) = delete;
  void operator=(const vtkMeshComparison&) = delete;

  struct Totals;
  struct Pair;
  void Compare(vtkDataSet* before, vtkDataSet* after, vtkDataSet* output, Totals& totals);
  void CompareBlocks(
    vtkDataObject* before, vtkDataObject* after, vtkDataObject* output, Totals& totals);
  void ComparePieces(tautline::ComparisonPieces& pieces, vtkDataObject* after,
    vtkDataObject* output, Totals& totals);
  void Measure(const Pair& pair, Totals& totals);
  void Tabulate(const Totals& totals, vtkDataObject* output);

  double Tolerance = 1e-6;

  // Of an execution on several processes:
  std::unique_ptr<tautline::RankGroup> Group;
  std::unique_ptr<tautline::ComparisonPieces> Pieces; ///< null: gathered
  std::string PieceError;                             ///< why there are no pieces, or ""
  std::string WhyGathered;                            ///< a sentence, or ""
};

#endif
