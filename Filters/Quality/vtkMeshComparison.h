// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshComparison
 * @brief Compares two meshes of equal connectivity element by element.
 *
 * Compares a mesh before and after its points were moved, for example by perturbation, smoothing or
 * warping. For each chosen metric it shows where elements became better or worse and by how much,
 * and counts them.
 *
 * Validity comes first: an element that becomes valid is better, one that becomes degenerate or
 * inverted is worse. Between two valid elements (and two inverted ones, if the metric ranks these,
 * as untangling metrics do) the values are compared by the direction of the metric. They count as
 * equal if they differ by at most Tolerance times the larger magnitude; for unitless metrics with
 * ideal value 0, at least times 1. With a neutral metric (the size) no valid element becomes better
 * or worse.
 *
 * @par Inputs:
 * Port 0 `Input`: the mesh before; port 1 `Other`: the mesh after. Both may be any vtkDataSet with
 * the same number of points and the same cells with the same points, in the same order; or two
 * composite data sets of the same structure whose blocks are such pairs. Other meshes are rejected
 * with an error that names the first difference. If both meshes are reversed throughout, both are
 * treated as their mirror images.
 *
 * @par Output port 0:
 * The second mesh with its data, and these arrays. Cells: `<metric>_before`, `<metric>_after`,
 * `<metric>_difference` (after minus before) for each metric (double; `imr_before`, ...);
 * `Validity_before`, `Validity_after` and `Change` (signed char). `Change` is 1 if the element
 * became better in some metric and worse in none, -1 if worse in some and better in none, otherwise
 * 0. Points: `Displacement` (3 components, double), second minus first position.
 *
 * @par Output port 1 `Comparison`:
 * A vtkTable with a row per metric: `Metric` (its name); `Better`, `Worse`, `Equal`, numbers of
 * elements on which the metric is defined, ghost cells left out; `InvertedBefore`, `InvertedAfter`,
 * numbers of inverted elements; `MinimumBefore`, `MinimumAfter`, `MeanBefore`, `MeanAfter`,
 * `MaximumBefore`, `MaximumAfter` over the valid and inverted elements (0 if there are none);
 * `LargestDisplacement`. For composite data, over all blocks.
 *
 * @par Limitations:
 * Metrics use the ideal cell as their target and the mean over the corners of a cell.
 *
 * @par Several processes:
 * Both meshes are gathered on the first process, and the results go back to the pieces of the
 * second one; the table is on the first process. The meshes may be divided differently: their
 * points and cells are then matched by the global ids of the points (Generate Global Ids), or
 * otherwise by the order of the coordinates, if the points have not moved. Ghost cells do not
 * count.
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

class vtkDataSet;

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
  tautline::GatheredRules GetGatheredRules() override;

private:
  vtkMeshComparison(const vtkMeshComparison&) = delete;
  void operator=(const vtkMeshComparison&) = delete;

  struct Totals;
  void Compare(vtkDataSet* before, vtkDataSet* after, vtkDataSet* output, Totals& totals);
  void CompareBlocks(
    vtkDataObject* before, vtkDataObject* after, vtkDataObject* output, Totals& totals);
  void Tabulate(const Totals& totals, vtkDataObject* output);

  double Tolerance = 1e-6;
};

#endif
