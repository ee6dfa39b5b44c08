// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFieldTransfer
 * @brief Transfers point and cell arrays from one mesh to another, conservatively and within
 * bounds.
 *
 * The output is the target with fields of the source. With Method CONSERVATIVE
 *
 * - a cell gets the mean of the cells it overlaps, weighted by the area or volume in common;
 * - points get the L2 projection of the piecewise linear field, limited by flux-corrected transport
 *   so that each value stays within the range of the source elements that its elements overlap
 *   (tautline/Adaptation/FieldTransfer.h).
 *
 * The total (the integral over the elements) equals the total of the source to 1e-12, relative to
 * the integral of the absolute value. Arrays of integers (tags, regions, ids) and of strings are
 * never averaged: a cell gets the value of the cell that it overlaps most, a point the value of the
 * nearest point. With INTERPOLATE, a point gets the value interpolated at its position, a cell the
 * value of the source cell at its center; totals are not kept.
 *
 * Supports triangles, quadrilaterals, polygons, tetrahedra, hexahedra, wedges and pyramids, also
 * mixed. They are divided into simplices; inverted ones count with the absolute value of their area
 * or volume. The meshes are both planar, both surfaces or both volumes. On surfaces, the triangles
 * of the source are projected along the normal of the target triangle. Cells of lower dimension,
 * ghost cells, and elements without an area or volume do not count; they get the nearest value, as
 * do elements and points of the target that the source does not overlap.
 *
 * The blocks of composite data form one mesh, in the target as in the source.
 *
 * @par Where only one mesh has elements:
 * Where the boundaries differ, totals and bounds may contradict each other: a constant field on a
 * smaller mesh has a different total. With KeepTotal the totals are kept: the values next to such
 * places change, within their bounds if these suffice, otherwise all by the same amount. The
 * summary and the table then report the distance from the bounds. If one of the meshes covers less
 * than half of the other, the totals are not kept, and a warning is added. Without KeepTotal all
 * values are bounded.
 *
 * @par Input port 0 `Input`:
 * The target, whose points and cells the output has.
 *
 * @par Input port 1 `Source`:
 * The mesh with the fields.
 *
 * @par Output port 0 `Mesh`:
 * The target with the arrays of the source: averaged arrays in double precision, the others in
 * their own type. If no arrays are named, all are transferred, except ghost marks, global ids and
 * pedigree ids. Arrays with values that are not finite are left out with a warning.
 *
 * @par Output port 1 `Totals`:
 * A vtkTable with a row for each averaged component: Array, Data (point or cell), Component,
 * TotalBefore, TotalAfter, MinimumBefore, MaximumBefore, MinimumAfter, MaximumAfter, BeyondBounds
 * (largest distance of a value from the range of its source values).
 *
 * @par Errors:
 * The meshes do not overlap, differ in dimension, have no elements, or have polyhedra or cells of
 * higher order; a chosen array is missing; no array has finite values.
 *
 * @par Several processes:
 * The pieces of both meshes are gathered on the first process.
 *
 * @par Example:
 * @code
 * vtkNew<vtkFieldTransfer> transfer;
 * transfer->SetInputConnection(0, adapted->GetOutputPort());
 * transfer->SetInputConnection(1, solution->GetOutputPort());
 * transfer->AddPointArray("temperature");
 * transfer->Update();
 * std::cout << transfer->GetTotalError() << "\n" << transfer->GetSummary() << "\n";
 * @endcode
 *
 * @sa tautline::transferFields (tautline/Adaptation/FieldTransfer.h), vtkMeshMetric,
 * vtkMeshImprover
 */

#ifndef vtkFieldTransfer_h
#define vtkFieldTransfer_h

#include "TautlineAdaptationModule.h" // for export macro
#include "vtkTautlineSetRange.h"      // for the setters
#include "vtkTautlineTimedAlgorithm.h"

#include <string> // for the names of arrays
#include <vector> // for the names of arrays

class TAUTLINEADAPTATION_EXPORT vtkFieldTransfer : public vtkTautlineTimedAlgorithm
{
public:
  static vtkFieldTransfer* New();
  vtkTypeMacro(vtkFieldTransfer, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Methods
  {
    CONSERVATIVE = 0,
    INTERPOLATE = 1
  };
  ///@{
  /// The method that computes the values, see above. The default is CONSERVATIVE.
  vtkTautlineSetRangeMacro(Method, int, CONSERVATIVE, INTERPOLATE);
  vtkGetMacro(Method, int);
  ///@}

  enum CellOrders
  {
    CONSTANT = 0,
    LINEAR = 1
  };
  ///@{
  /**
   * The reconstruction of a cell array within a source cell, with CONSERVATIVE. CONSTANT, the
   * default, is first order and bounded by the overlapped cells. LINEAR is a least-squares linear
   * function with the limiter of Barth and Jespersen; it is second order away from extrema and the
   * boundary, and bounded by these cells and the cells that share a point with them.
   */
  vtkTautlineSetRangeMacro(CellOrder, int, CONSTANT, LINEAR);
  vtkGetMacro(CellOrder, int);
  ///@}

  ///@{
  /// Whether to keep the totals where only one mesh has elements, see above; with CONSERVATIVE. The
  /// default is on.
  vtkSetMacro(KeepTotal, bool);
  vtkGetMacro(KeepTotal, bool);
  vtkBooleanMacro(KeepTotal, bool);
  ///@}

  ///@{
  /**
   * The names of the source arrays to transfer. By default no point or cell array is named, and all
   * are transferred.
   */
  void AddPointArray(const char* name);
  void ClearPointArrays();
  void AddCellArray(const char* name);
  void ClearCellArrays();
  ///@}

  ///@{
  /// Whether a transferred array replaces a target array of the same name; otherwise the source
  /// array is not transferred. The default is on.
  vtkSetMacro(ReplaceArrays, bool);
  vtkGetMacro(ReplaceArrays, bool);
  vtkBooleanMacro(ReplaceArrays, bool);
  ///@}

  ///@{
  /**
   * Whether to treat points of the target with the same coordinates on matching facets as one, for
   * example on the seams of a mesh in pieces; the output keeps them all. The default is on. See
   * tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Results of the last execution. TotalError: the largest difference of a total, over the integral
   * of the absolute value. LargestExcess: the largest distance of a value from its bounds, over the
   * largest absolute value of the field. SourceCovered and TargetCovered: the fraction of each mesh
   * that the other one covers, 0 to 1; 0 with INTERPOLATE.
   */
  vtkGetMacro(TotalError, double);
  vtkGetMacro(LargestExcess, double);
  vtkGetMacro(SourceCovered, double);
  vtkGetMacro(TargetCovered, double);
  ///@}

  /// The table of output port 1, Totals.
  vtkTable* GetTotals() { return this->GetOutputTable(1); }

protected:
  vtkFieldTransfer();
  ~vtkFieldTransfer() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  bool NeedsFinitePoints(int port) const override;
  tautline::GatheredRules GetGatheredRules() override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;

private:
  vtkFieldTransfer(const vtkFieldTransfer&) = delete;
  void operator=(const vtkFieldTransfer&) = delete;

  struct Meshes;
  struct Arrays;

  void Compute(vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  std::vector<std::string> NamesOf(const Meshes& meshes, int association) const;
  void ChooseArrays(const Meshes& meshes, Arrays& arrays);
  void AddArrays(const Meshes& meshes, const Arrays& arrays, int association);
  void Report(const Meshes& meshes, const Arrays& arrays);
  void DescribeCoverage(const Arrays& arrays);

  int Method = CONSERVATIVE;
  int CellOrder = CONSTANT;
  bool KeepTotal = true;
  std::vector<std::string> PointArrays, CellArrays;
  bool ReplaceArrays = true;
  bool MergeCoincidentPoints = true;

  double TotalError = 0.0;
  double LargestExcess = 0.0;
  double SourceCovered = 0.0;
  double TargetCovered = 0.0;
};

#endif
