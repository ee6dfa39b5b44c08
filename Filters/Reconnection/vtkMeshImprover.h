// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshImprover
 * @brief Improves the worst tetrahedra or triangles of a mesh by changing its connectivity and
 * moving points.
 *
 * Supports unstructured grids of linear tetrahedra, unstructured grids and poly data of linear
 * triangles, or blocks of these. Edges and faces are swapped, edges contracted, and points inserted
 * and moved around the worst elements, until every dihedral angle is between TargetAngle and 180
 * degrees minus TargetAngle, or every angle of a triangle is above it, or no operation helps. The
 * smallest angle and the worst inverse mean ratio of the output are never worse than in the input.
 * By default the boundary does not change: it keeps its points and its facets or edges.
 *
 * Triangles: planar meshes and surfaces in space. Edges on the border, between regions, under lines
 * beside the triangles and, on surfaces, sharp edges (FeatureAngle) stay; so do corners. Other
 * points of a surface stay on the smooth surface through the points of the input, and changed
 * triangles stay within SurfaceTolerance and SurfaceAngle of its facets. The area of a planar mesh
 * and of each region does not change.
 *
 * Other volume cells (or other 2D cells, in a mesh without volume cells), ghost cells and inverted
 * elements are an error (run vtkMeshUntangler first). Cells of lower dimension are left out with a
 * warning (but see ADAPT), and the entities that they mark are kept: lines mark edges between
 * triangles, triangles mark facets between tetrahedra. A mesh reversed throughout is treated as its
 * mirror image; in a mesh of mixed orientation, the cells in the opposite order are reordered like
 * the others. In contrast, vtkMeshOptimizer improves the average element and keeps the
 * connectivity.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) a vtkSelection of points or cells that stay. Points where the point
 * array at index 0 (SetInputArrayToProcess) is not 0 also stay. The cell array at index 1 has the
 * region of each cell: facets between regions are kept like the boundary. Without it, the regions
 * of ADAPT are defined by the tags of the cells: integer arrays with at most a quarter as many
 * values as there are cells.
 *
 * ADAPT also keeps the facets of triangles beside tetrahedra, and the edges of lines beside
 * triangles: they are divided together with the mesh, and the output has their parts, with their
 * data. An edge is kept if facets that differ in a tag array (integers, at most half as many values
 * as facets) meet there, or if a facet ends there.
 *
 * @par Output port 0 `Mesh`:
 * The new mesh. Points of the input keep their data; the data of new points are interpolated in the
 * input cell that contains them. The cell array `OriginalCellId` is the cell of the input, of the
 * same region, that contains the centroid, and cells have its data (or averages, see CellTransfer).
 * The cell arrays `min_angle` (the smallest angle in degrees, dihedral for tetrahedra) and `imr`
 * (the inverse mean ratio) refer to the output. Global ids of points and cells are left out,
 * because they would not be unique.
 *
 * @par Output port 1 `History`:
 * A vtkTable whose row i is pass i (0 is the input): `Smallest angle`, `Largest angle`,
 * `Worst imr`, `N elements`, `N below target`; accepted operations since the start:
 * `N edge removals`, `N face removals`, `N boundary swaps`, `N contractions`, `N insertions`,
 * `N moves`; `Time (s)`; for composite data sets also `Block`. Flips of edges between triangles
 * count as edge removals.
 *
 * @par Output port 2 `Remaining`:
 * A vtkTable of the elements that are still below the target, the worst first: `Cell` (id in the
 * output), `Smallest angle`, `imr`, `X`, `Y`, `Z` (the centroid), `Quality` (see Objective; for
 * triangles the sine of the smallest angle), `Quality bound` (the best quality that the facets, or
 * the angles between edges, on the boundary and between regions allow), `Reason`; for composite
 * data sets also `Block`.
 *
 * @par Several processes:
 * A mesh of at least GatherBelow tetrahedra that is not entirely on the first process is improved
 * in parts: planes divide it among the processes, each process improves its part up to the seams,
 * and then planes in other directions divide it again, so that only a few facets where the seams of
 * all Rounds meet are kept because of a seam (Kernel/Reconnection/ReconnectionRounds.h). The result
 * depends on the number of processes, but not on the initial division, except for the order of
 * points and cells. Ghost cells are left out as copies. A cell goes to the process of its original
 * cell; `OriginalCellId` numbers the cells of the pieces, one process after the other, and `Cell`
 * in Remaining numbers the cells of the output in the same way. Row i of History is round i. The
 * tables are on the first process. Coincident points are merged; with MergeCoincidentPoints off,
 * only points of different processes with the same global id are merged. Only point arrays of all
 * pieces with points are kept.
 *
 * In the following cases, the mesh is gathered on the first process and improved there, and the
 * summary states the reason: it has fewer tetrahedra; it consists of triangles or is composite
 * data; for a boundary ON_SURFACE, the objective METRIC, ThenBestShape, a CONSERVATIVE transfer,
 * and target lengths SIZE_ARRAY and LENGTH_OF_INPUT; cells have no volume, are inverted or list
 * their points in opposite orders; MergeCoincidentPoints is off and pieces have no global point
 * ids; the processes do not communicate by MPI.
 *
 * B. M. Klingner and J. R. Shewchuk, "Aggressive tetrahedral mesh improvement" (2007), see
 * tautline/Reconnection/Reconnection.h.
 *
 *     filter->SetInputData(mesh);
 *     filter->SetPreset(vtkMeshImprover::AGGRESSIVE);
 *     filter->Update();
 *     std::cout << filter->GetSummary();
 *
 * @sa vtkMeshOptimizer, vtkMeshUntangler, vtkElementQuality
 */

#ifndef vtkMeshImprover_h
#define vtkMeshImprover_h

#include "TautlineReconnectionModule.h" // for export macro
#include "vtkTautlineSetRange.h"        // for the setters
#include "vtkTautlineTimedAlgorithm.h"

#include <memory> // for Pieces
#include <string> // for Reason
#include <vector> // for SetSize

class vtkDataArray;
class vtkDataSet;

namespace tautline
{
class RankGroup;
class MovableMesh;
class ReconnectableMesh;
class TableRows;
struct ImproverRemarks;
struct InputBlock;
struct ReconnectionOptions;
struct ReconnectionResult;
struct RemainingElement;
}

class TAUTLINERECONNECTION_EXPORT vtkMeshImprover : public vtkTautlineTimedAlgorithm
{
public:
  static vtkMeshImprover* New();
  vtkTypeMacro(vtkMeshImprover, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Presets
  {
    CUSTOM = 0,
    REMOVE_SLIVERS = 1,
    SWAP_ONLY = 2,
    SWAP_AND_SMOOTH = 3,
    AGGRESSIVE = 4,
    ADAPT = 5
  };
  ///@{
  /**
   * The operations and the target: REMOVE_SLIVERS applies every operation, but only around
   * tetrahedra with dihedral angles below 15 or above 165 degrees; SWAP_ONLY moves no points;
   * SWAP_AND_SMOOTH moves points, but inserts and removes none; AGGRESSIVE uses every operation
   * everywhere; CUSTOM uses the operations of the switches below. ADAPT gives the edges the target
   * lengths of SetSize(), which it needs: edges longer than sqrt(2) times the target are split,
   * edges shorter than 1 / sqrt(2) times it are contracted, points are moved and edges swapped in
   * turn; then the worst elements are improved in the metric. The number of elements changes as
   * required: SmallestCount, LargestCount, TargetAngle, Objective, EdgeFactor and ThenBestShape
   * have no effect. The default is REMOVE_SLIVERS.
   */
  vtkTautlineSetRangeMacro(Preset, int, CUSTOM, ADAPT);
  vtkGetMacro(Preset, int);
  ///@}

  ///@{
  /**
   * The operations of CUSTOM. Compound: operations that pay off only after the surrounding points
   * have moved. The defaults are on.
   */
  vtkSetMacro(Swap, bool);
  vtkGetMacro(Swap, bool);
  vtkBooleanMacro(Swap, bool);
  vtkSetMacro(Smooth, bool);
  vtkGetMacro(Smooth, bool);
  vtkBooleanMacro(Smooth, bool);
  vtkSetMacro(Contract, bool);
  vtkGetMacro(Contract, bool);
  vtkBooleanMacro(Contract, bool);
  vtkSetMacro(Insert, bool);
  vtkGetMacro(Insert, bool);
  vtkBooleanMacro(Insert, bool);
  vtkSetMacro(Compound, bool);
  vtkGetMacro(Compound, bool);
  vtkBooleanMacro(Compound, bool);
  ///@}

  ///@{
  /**
   * The target angle in degrees, 0 to 60: tetrahedra are improved while they have a dihedral angle
   * below it or above 180 degrees minus it, or an equally bad mean ratio. 0, the default, stands
   * for the angle of the preset: 15 for REMOVE_SLIVERS, 33.4 for the others (40 for triangles).
   */
  vtkTautlineSetRangeMacro(TargetAngle, double, 0.0, 60.0);
  vtkGetMacro(TargetAngle, double);
  ///@}

  enum Objectives
  {
    ANGLES_AND_SHAPE = 0,
    ANGLES = 1,
    SHAPE = 2,
    METRIC = 3,
    SUM = 4
  };
  ///@{
  /**
   * The quality of the worst tetrahedra to improve: ANGLES_AND_SHAPE, the default, is the smaller
   * of the sines of the dihedral angles and (mean ratio)^(3/2); ANGLES is the sines alone (larger
   * smallest angles, longer tetrahedra); SHAPE is (mean ratio)^(3/2) alone; METRIC is the metric of
   * SetMetric(), whose worst value never becomes worse; SUM is the sum of (inverse mean ratio - 1)
   * over all tetrahedra. Not supported for triangles.
   */
  vtkTautlineSetRangeMacro(Objective, int, ANGLES_AND_SHAPE, SUM);
  vtkGetMacro(Objective, int);
  ///@}

  ///@{
  /**
   * With METRIC: the number of a metric that has derivatives, is defined for tetrahedra, has a
   * direction (larger or smaller is better) and does not depend on the orientation in space. The
   * quality of a tetrahedron is then x / I for its value x and the ideal value I, or I / x if
   * smaller is better, or 1 / (1 + x) if I is 0; for metrics without an ideal value, x / (x + u) or
   * u / (x + u) with the mean u of the input. Tetrahedra are improved while their quality is below
   * the sine of TargetAngle. The default is 0, the inverse mean ratio. Other numbers and names are
   * an error.
   */
  void SetMetric(int metric);
  vtkGetMacro(Metric, int);
  /// Sets the metric by name, label, symbol or alias.
  void SetMetricByName(const char* name);
  ///@}

  /// Numbers and labels of the registered metrics, for menus.
  std::string GetUserMetrics();

  enum Boundaries
  {
    FIXED = 0,
    SLIDING = 1,
    ON_SURFACE = 3 ///< as in vtkMeshBoundaryAlgorithm, whose FREE is an error here
  };
  ///@{
  /**
   * FIXED, the default: the points and facets of the boundary and between regions stay. SLIDING:
   * points slide within flat parts of the boundary and along straight edges, and are contracted
   * there; edges between coplanar facets are swapped. The shape and the volumes do not change.
   * ON_SURFACE (tetrahedra only): the same on curved parts; facets stay within SurfaceTolerance and
   * SurfaceAngle of the input's boundary, which stays within 1.25 times this distance of them;
   * corners, sharp edges (FeatureAngle) and facets between regions stay, except sharp edges due to
   * noise and corners closer to each other than the tolerance. The shape and the volume change
   * within these bounds; the summary reports both. Parts of the boundary that are closer to each
   * other than the tolerance may overlap afterwards.
   */
  vtkTautlineSetRangeMacro(Boundary, int, FIXED, ON_SURFACE);
  vtkGetMacro(Boundary, int);
  ///@}

  ///@{
  /// With SLIDING: facets whose normals differ by at most this angle, 0 to 1 degrees, are coplanar.
  /// The default is 0.01.
  vtkTautlineSetRangeMacro(FlatAngle, double, 0.0, 1.0);
  vtkGetMacro(FlatAngle, double);
  ///@}

  ///@{
  /**
   * For surfaces in space, and for a boundary ON_SURFACE. FeatureAngle, 0 to 180 degrees: edges
   * between facets whose normals differ by more are kept. SurfaceAngle, 0 to 90 degrees, and
   * SurfaceTolerance, 0 to 1 times the diagonal of the mesh: the largest rotation and distance of
   * changed facets from the input. The defaults are 40, 20 and 0.005.
   */
  vtkTautlineSetRangeMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  vtkTautlineSetRangeMacro(SurfaceAngle, double, 0.0, 90.0);
  vtkGetMacro(SurfaceAngle, double);
  vtkTautlineSetRangeMacro(SurfaceTolerance, double, 0.0, 1.0);
  vtkGetMacro(SurfaceTolerance, double);
  ///@}

  ///@{
  /**
   * Whether a closed surface in space keeps its enclosed volume: at the end, points of its curved
   * parts move along their normals, all by the same distance. An error for open surfaces and planar
   * meshes; tetrahedra are not affected. The summary reports the volumes. The default is off.
   */
  vtkSetMacro(KeepVolume, bool);
  vtkGetMacro(KeepVolume, bool);
  vtkBooleanMacro(KeepVolume, bool);
  ///@}

  ///@{
  /**
   * The bounds on the number of elements, as multiples of the input's: 0 to 1 and at least 1. If
   * both are 1, no point is inserted or removed. The defaults are 0.9 and 1.1.
   */
  vtkTautlineSetRangeMacro(SmallestCount, double, 0.0, 1.0);
  vtkGetMacro(SmallestCount, double);
  vtkTautlineSetRangeMacro(LargestCount, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(LargestCount, double);
  ///@}

  enum Sizes
  {
    ANY_LENGTH = 0,
    EDGE_LENGTH = 1,
    SIZE_ARRAY = 2,
    LENGTH_OF_INPUT = 3
  };
  ///@{
  /**
   * The target length of edges: contraction creates no edge longer than EdgeFactor times the
   * target, insertion no edge shorter than the target divided by EdgeFactor. ANY_LENGTH, the
   * default: no target. EDGE_LENGTH: EdgeLength. SIZE_ARRAY: the point array at index 2
   * (SetInputArrayToProcess), lengths (one component) or metric tensors in which edges of the
   * target length have length 1 (six components in the order of VTK, or nine); with ANY_LENGTH,
   * ADAPT also uses this array, or the only one with six components if none is chosen.
   * LENGTH_OF_INPUT: the mean length of the edges at each point.
   */
  vtkTautlineSetRangeMacro(Size, int, ANY_LENGTH, LENGTH_OF_INPUT);
  vtkGetMacro(Size, int);
  ///@}

  enum SelectedRoles
  {
    STAYS = 0,
    CHANGES = 1
  };
  ///@{
  /**
   * The meaning of the selection at input port 1. STAYS, the default: the selected points and the
   * points of selected cells stay. CHANGES: only the selected cells may change. The cell array at
   * index 3 (SetInputArrayToProcess) has the same effect: cells with the value 0 are kept.
   */
  vtkTautlineSetRangeMacro(Selected, int, STAYS, CHANGES);
  vtkGetMacro(Selected, int);
  ///@}

  ///@{
  /// With EDGE_LENGTH: the target length, above 0. The default is 1.
  vtkTautlineSetRangeMacro(EdgeLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EdgeLength, double);
  ///@}

  ///@{
  /// The factor by which new edges may be longer or shorter than the target, above 1. The default
  /// is 2.
  vtkTautlineSetRangeMacro(EdgeFactor, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EdgeFactor, double);
  ///@}

  ///@{
  /**
   * Whether to move points at the end for the best average shape: the mean of the inverse mean
   * ratios is reduced, while the smallest dihedral angle and the worst inverse mean ratio do not
   * get worse. The default is off.
   */
  vtkSetMacro(ThenBestShape, bool);
  vtkGetMacro(ThenBestShape, bool);
  vtkBooleanMacro(ThenBestShape, bool);
  ///@}

  enum CellTransfers
  {
    COPY = 0,
    CONSERVATIVE = 1
  };
  ///@{
  /**
   * The transfer of cell data. COPY, the default: from the cell of the input that contains the
   * centroid. CONSERVATIVE: floating-point arrays are averaged over the cells of the input,
   * weighted by the volumes (areas) that the cell shares with them; this preserves constants and
   * the integral of each array over the mesh, up to changes of the volume (area) if the boundary or
   * surface changes. Other arrays are copied from the cell with the largest overlap. The cost is
   * about 20 microseconds per changed cell.
   */
  vtkTautlineSetRangeMacro(CellTransfer, int, COPY, CONSERVATIVE);
  vtkGetMacro(CellTransfer, int);
  ///@}

  ///@{
  /**
   * Whether to merge points with the same coordinates on matching facets, for example on the seams
   * of a mesh in pieces; if off, seams are treated as boundary. The default is on.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * For several processes. GatherBelow, at least 0: a mesh with fewer tetrahedra is gathered on the
   * first process, which reproduces the serial result. Rounds, 1 to 100: the maximum number of
   * times that the mesh is divided again. The defaults are 20,000 and 12.
   */
  vtkTautlineSetRangeMacro(GatherBelow, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(GatherBelow, vtkIdType);
  vtkTautlineSetRangeMacro(Rounds, int, 1, 100);
  vtkGetMacro(Rounds, int);
  ///@}

  /// The table of output port 1.
  vtkTable* GetHistory() { return this->GetOutputTable(HistoryPort); }

  /// The table of output port 2.
  vtkTable* GetRemainingTable() { return this->GetOutputTable(RemainingPort); }

  ///@{
  /**
   * The results of the last execution, over all blocks: the reason why the (last) run ended, the
   * numbers of elements, the smallest angles in degrees, the largest inverse mean ratios, and the
   * number of elements that remain below the target.
   */
  const char* GetReason() const { return this->Reason.c_str(); }
  vtkIdType GetElementsBefore() const { return this->ElementsBefore; }
  vtkIdType GetElementsAfter() const { return this->ElementsAfter; }
  double GetSmallestAngleBefore() const { return this->SmallestAngleBefore; }
  double GetSmallestAngleAfter() const { return this->SmallestAngleAfter; }
  double GetWorstBefore() const { return this->WorstBefore; }
  double GetWorstAfter() const { return this->WorstAfter; }
  vtkIdType GetRemaining() const { return this->Remaining; }
  ///@}

  ///@{
  /// With METRIC: the metric's worst values; otherwise 0.
  double GetWorstMetricBefore() const { return this->WorstMetricBefore; }
  double GetWorstMetricAfter() const { return this->WorstMetricAfter; }
  ///@}

  /**
   * The largest distance between the boundaries of the output and the input, in both directions,
   * measured at corners, midpoints of edges and centers of facets. 0 unless the boundary is
   * ON_SURFACE.
   */
  double GetBoundaryDistance() const { return this->BoundaryDistance; }

  ///@{
  /**
   * With ADAPT: the fraction of the edges, 0 to 1, whose lengths are from 1 / sqrt(2) to sqrt(2)
   * times the target; and the largest inverse mean ratio in the metric, at least 1. Otherwise 0.
   */
  double GetEdgesInRangeBefore() const { return this->EdgesInRangeBefore; }
  double GetEdgesInRangeAfter() const { return this->EdgesInRangeAfter; }
  double GetWorstInMetric() const { return this->WorstInMetric; }
  ///@}

protected:
  vtkMeshImprover();
  ~vtkMeshImprover() override;

  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  tautline::GatheredRules GetGatheredRules() override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  /// Without MergeCoincidentPoints only global ids join partitions.
  std::string FindSettingProblem() const override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;
  bool KeepsBest() const override { return true; }

private:
  vtkMeshImprover(const vtkMeshImprover&) = delete;
  void operator=(const vtkMeshImprover&) = delete;

  enum Ports
  {
    MeshPort = 0,
    SelectionPort = 1, // input
    HistoryPort = 1,   // output
    RemainingPort = 2  // output
  };

  bool IsArrayChosen(int index);
  vtkDataArray* FindSizeArray(vtkDataSet* input);
  void SetOptions(tautline::ReconnectionOptions& options) const;
  template <class Options>
  void PrepareOptions(Options& options, double block, double blocks);
  tautline::ReconnectionResult Run(const tautline::ReconnectableMesh& mesh,
    const tautline::InputBlock& block, int blocks, double& targetAngle);
  std::vector<double> SetSize(vtkDataSet* input, tautline::ReconnectionOptions& options);
  void CheckSeams(vtkDataObject* input);
  void Improve(const tautline::InputBlock& block, int blocks, tautline::TableRows& history,
    tautline::TableRows& remaining);
  void TakeResult(const tautline::ReconnectionResult& result, bool triangles);
  void Report(const tautline::ReconnectionResult& result,
    std::vector<tautline::RemainingElement> left, const tautline::ImproverRemarks& remarks,
    tautline::TableRows& history, tautline::TableRows& remaining);
  std::string FindReasonToGather(vtkDataObject* input);
  void ImproveOnRanks(vtkInformationVector** inputVector, vtkDataObject* output,
    tautline::TableRows& history, tautline::TableRows& remaining);

  /// For an execution in which each process works on its piece: the mesh, or the reason for an
  /// error.
  std::unique_ptr<tautline::RankGroup> Group;
  std::unique_ptr<tautline::MovableMesh> Pieces;
  std::string PieceError, LeftOut;
  std::string WhyGathered; ///< if several processes do not work on pieces; otherwise ""

  int Preset = REMOVE_SLIVERS;
  bool Swap = true;
  bool Smooth = true;
  bool Contract = true;
  bool Insert = true;
  bool Compound = true;
  double TargetAngle = 0.0;
  int Objective = ANGLES_AND_SHAPE;
  int Metric = 0;
  int Boundary = FIXED;
  double FlatAngle = 0.01;
  double SmallestCount = 0.9;
  double LargestCount = 1.1;
  double FeatureAngle = 40.0;
  double SurfaceAngle = 20.0;
  double SurfaceTolerance = 5e-3;
  bool KeepVolume = false;
  int Size = ANY_LENGTH;
  int Selected = STAYS;
  double EdgeLength = 1.0;
  double EdgeFactor = 2.0;
  bool ThenBestShape = false;
  int CellTransfer = COPY;
  bool MergeCoincidentPoints = true;
  vtkIdType GatherBelow = 20000;
  int Rounds = 12;

  std::string Reason;
  vtkIdType ElementsBefore = 0;
  vtkIdType ElementsAfter = 0;
  double SmallestAngleBefore = 0.0;
  double SmallestAngleAfter = 0.0;
  double WorstBefore = 0.0;
  double WorstAfter = 0.0;
  vtkIdType Remaining = 0;
  double BoundaryDistance = 0.0;
  double WorstMetricBefore = 0.0;
  double WorstMetricAfter = 0.0;
  double EdgesInRangeBefore = 0.0;
  double EdgesInRangeAfter = 0.0;
  double WorstInMetric = 0.0;
};

#endif
