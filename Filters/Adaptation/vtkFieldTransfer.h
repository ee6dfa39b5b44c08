// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFieldTransfer
 * @brief Transfers point and cell arrays from one mesh to another, conservative and bounded.
 *
 * The output is the target with fields of the source. With Method CONSERVATIVE
 *
 * - a cell has the mean of what it overlaps, weighted by the area or volume in common;
 * - points have the L2 projection of the piecewise linear field, limited by flux-corrected
 *   transport, so that each value is within the range of the elements that its own elements
 *   overlap (tautline/Adaptation/FieldTransfer.h).
 *
 * The total, which is the integral over the elements, equals the total of the source to 1e-12,
 * relative to the integral of the absolute value. Arrays of integers (tags, regions, ids) and of
 * strings are never averaged: a cell has the value of the cell that it overlaps most, a point the
 * value of the nearest point. With INTERPOLATE points have the value at their place, cells the
 * value of the cell at their center; totals are not kept.
 *
 * Takes triangles, quadrilaterals, polygons, tetrahedra, hexahedra, wedges and pyramids, also
 * mixed, which are divided into simplices; the area or volume of inverted ones is their absolute
 * value. Both meshes are planar, surfaces or volumes. Triangles of surfaces are seen along the
 * normal of the triangle of the target. Cells of lower dimension, ghost cells, and elements without
 * an area or volume do not count; they have the nearest value. So have elements and points of the
 * target that nothing of the source overlaps.
 *
 * The blocks of composite data are one mesh together, of the target as of the source.
 *
 * @par Where only one of the meshes has a place:
 * As at boundaries that differ, totals and bounds may contradict each other: a constant on a
 * smaller mesh has another total. With KeepTotal the totals are kept: the values next to such
 * places change, within their bounds if these suffice, otherwise all by the same amount. The
 * summary and the table state how far they are then beyond. If one of the meshes covers less than
 * half of the other, the totals are not kept, with a warning. Without KeepTotal all values are
 * bounded.
 *
 * @par Input port 0 `Input`:
 * The target: the output has its points and cells.
 *
 * @par Input port 1 `Source`:
 * The mesh with the fields.
 *
 * @par Output port 0 `Mesh`:
 * The target with the arrays of the source: in double precision, those that are not averaged in
 * their own type. Without a choice, all arrays are transferred. Ghost marks, global ids and
 * pedigree ids are not. Arrays with values that are not finite are left out with a warning.
 *
 * @par Output port 1 `Totals`:
 * A row for each component that is averaged: Array, Data (point or cell), Component, TotalBefore,
 * TotalAfter, MinimumBefore, MaximumBefore, MinimumAfter, MaximumAfter, BeyondBounds (how far a
 * value is outside of the values that it comes from).
 *
 * @par Errors:
 * Meshes that do not overlap or differ in their dimension, without elements, with polyhedra or
 * cells of higher order; arrays that are chosen and not there; no array whose values are finite.
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
  /// How values are computed, see above. The default is CONSERVATIVE.
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
   * What a cell array is within a cell of the source, with CONSERVATIVE. CONSTANT, the default: of
   * first order, bounded by the cells that are overlapped. LINEAR: a linear function by least
   * squares with the limiter of Barth and Jespersen, of second order away from extrema and the
   * boundary, bounded by these cells and the cells that share a point with them.
   */
  vtkTautlineSetRangeMacro(CellOrder, int, CONSTANT, LINEAR);
  vtkGetMacro(CellOrder, int);
  ///@}

  ///@{
  /// Whether the totals are kept where only one of the meshes has a place, see above; with
  /// CONSERVATIVE. The default is on.
  vtkSetMacro(KeepTotal, bool);
  vtkGetMacro(KeepTotal, bool);
  vtkBooleanMacro(KeepTotal, bool);
  ///@}

  ///@{
  /**
   * The names of the arrays of the source to transfer. If neither a point array nor a cell array is
   * named, the default, all are.
   */
  void AddPointArray(const char* name);
  void ClearPointArrays();
  void AddCellArray(const char* name);
  void ClearCellArrays();
  ///@}

  ///@{
  /// Whether an array of the target with the name of a transferred one is replaced; otherwise it
  /// stays, and the one of the source is not transferred. The default is on.
  vtkSetMacro(ReplaceArrays, bool);
  vtkGetMacro(ReplaceArrays, bool);
  vtkBooleanMacro(ReplaceArrays, bool);
  ///@}

  ///@{
  /**
   * Whether points of the target with the same coordinates on facets that match are treated as one,
   * as on the seams of a mesh in pieces; the output keeps them all. The default is on. See
   * tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Results of the last execution. TotalError: the largest difference of a total, over the integral
   * of the absolute value. LargestExcess: how far a value is beyond its bounds at most, over the
   * largest absolute value of the field. SourceCovered and TargetCovered: the part of each mesh
   * that the other one covers, 0 to 1; 0 with INTERPOLATE.
   */
  vtkGetMacro(TotalError, double);
  vtkGetMacro(LargestExcess, double);
  vtkGetMacro(SourceCovered, double);
  vtkGetMacro(TargetCovered, double);
  ///@}

  /// The output Totals.
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
