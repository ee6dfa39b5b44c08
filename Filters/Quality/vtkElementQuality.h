// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkElementQuality
 * @brief Measures the quality of every element of a mesh with any number of metrics.
 *
 * Supports triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed, in
 * any vtkDataSet or composite data set. Finite-volume metrics are also measured on polyhedra, and
 * on polygons of planar meshes, which count as one layer of prisms. For cells of higher order, up
 * to order 6, `Validity`, sizes and the metrics of T = A W^-1 with the ideal target hold for the
 * whole curved cell; lengths, angles and metrics with another target are measured at the corners
 * (see tautline/Quality/CurvedQuality.h). The filter detects whether the mesh is planar, a surface
 * or a volume, and its orientation: a mesh that is reversed throughout is reported and, by default,
 * measured as if it were not; mixed orientation is reported.
 *
 * @par Output port 0 `Mesh`:
 * The input with cell arrays: one per metric (double, named by the metric: "imr", "mean_ratio",
 * ...) and `Validity` (signed char): 1 valid, 0 degenerate, -1 inverted, -2 not measured (cell
 * type), -3 not finite (coordinates NaN, infinite, or beyond 1e100 while most cells are not).
 * Values are always finite. A metric is 0 on a degenerate element where it is singular, and on a
 * cell for which it is not defined. Inverted elements have negative values of signed metrics (see
 * MetricInfo::inverted); hexahedra and wedges that are folded between valid corners also count as
 * inverted, and have a negative "min_jacobian". If there are curved cells, the arrays
 * `MinimumPoint`, the point where the Jacobian determinant of a curved cell is smallest (for other
 * cells the center), and `MinimumCoordinates`, its parametric coordinates (for other cells 0), are
 * added. The first metric is the active cell scalar array; point arrays are passed on, none of them
 * active.
 *
 * Checks of solvers, if any are chosen, are cell arrays with their names.
 *
 * @par Output port 1 `Statistics`:
 * A vtkTable with a row per metric: `Metric`, `Label`, `Measured` (number of elements), `Minimum`,
 * `Maximum`, `Mean`, `RMS`, `StandardDeviation`, `Quantile01`, `05`, `25`, `50`, `75`, `95`, `99`,
 * `Worst`, `OutsideAcceptable`, `AcceptableLow`, `AcceptableHigh`, then the same in each row:
 * `Inverted`, `Degenerate`, `NotMeasured`, `NonFinite`, `Curved` (certified cells of higher order),
 * `MissedAtCorners` and `MissedAtIntegrationPoints` (curved cells that are invalid although the
 * determinant is positive at all corners, or at all integration points of solvers: 4 in a quadratic
 * tetrahedron, see tautline/Elements/ElementSamples.h); `WorstCells` (10 components: ids, worst
 * first, -1 where there are fewer) and `WorstPositions` (30 components: their centers, for curved
 * cells the points where the determinant is smallest). Statistics are over the measured elements:
 * the valid and inverted elements of the highest dimension in the data for which the metric is
 * defined; degenerate elements and ghost cells do not count. `Worst` is the value of an inverted
 * element if there is one, otherwise the maximum or minimum, by the direction of the metric. The
 * ten worst elements are inverted ones first, then degenerate ones, then the worst others.
 *
 * @par Output port 2 `Distribution`:
 * A vtkTable with HistogramBins rows; for each metric the columns `<metric> value` (middle of the
 * bin) and `<metric> count`, of the measured elements.
 *
 * @par Output port 3 `Angles`:
 * A vtkTable with the five bins of dissertation Table 2.7: `From`, `To` (degrees), `Count`,
 * `Percent` of the corner angles, or in volume meshes of the dihedral angles.
 *
 * @par Output port 4 `Worst`:
 * A vtkPolyData with a vertex at the center of each of the ten worst elements of each metric, or
 * for a curved element at the point where its determinant is smallest; point arrays `Metric`
 * (number), `Rank` (1 is the worst), `CellId`, `Value`, `Validity`, and its location: `Process`,
 * `Block` (as in the summary, 0 for a single mesh), `Partition` (from 1; 0 if the mesh has only one
 * on the process) and `Cell`, its index there. Useful for zooming to these elements.
 *
 * @par Output port 5 `Histogram`:
 * A vtkTable with HistogramBins + 2 rows; for each metric the columns `<metric> from`, `<metric>
 * to` and `<metric> count`. The first row counts the values below the acceptable range, the last
 * row the values above it, and the other rows are bins over it. Distribution covers the full range
 * and shows the extremes; this table shows the distribution of the other values.
 *
 * @par Output port 6 `Criteria`:
 * A vtkTable with a row for each of the criteria: `Metric`, `Label`, `Weight`, `Graded` (valid
 * elements with limits), `Passed`, `Warning`, `Failed`, `MeanPenalty`. Empty without criteria. With
 * criteria the mesh has the cell arrays `Grade` (0 passed, 1 warning, 2 failed, -1 none) and
 * `QualityIndex` (0 ideal, 1 worst).
 *
 * For composite data sets and on several MPI ranks the tables cover the whole data; on ranks above
 * 0 they are empty. Cell ids are then the global ids of the cells if the data have them, otherwise
 * they are numbered over blocks and ranks in order.
 *
 * @par Output port 7 `Bad`:
 * A vtkUnstructuredGrid, filled if ExtractBad is on: the elements of volume meshes that are
 * inverted or degenerate, failed by the criteria or, without criteria, outside the acceptable range
 * of a metric, with their arrays. Each process has its own elements. The elements of other meshes
 * are visible without it.
 *
 * @par Output port 8 `Faces`:
 * A vtkPolyData with the faces of a mesh if finite-volume metrics are measured, by default only
 * faces that fail a check: cell arrays `Face` (number in the order of OpenFOAM), `Owner` and
 * `Neighbour` (cells; -1: none), `Patch` (-1: internal), `Failed` (bits of the checks, see port 9),
 * `OwnerWeight` (OpenFOAM's `weights`), and one per metric of faces.
 *
 * @par Output port 9 `MeshChecks`:
 * A vtkTable with a row for each check of OpenFOAM's checkMesh, if finite-volume metrics are
 * measured: `Check`, `Label`, `Minimum`, `Maximum`, `Mean`, `Limit`, `Offending`, `Severe` (faces
 * above 70 degrees), `OnRequest` (1: only with -allTopology or -allGeometry), `Failed`, `Bit`. See
 * tautline/FiniteVolume/MeshChecks.h.
 *
 * @par Targets:
 * Metrics that are functions of T = A W^-1 use the target element W selected by TargetType: the
 * ideal element, the same element of a reference mesh (input port 1), or the ideal shape with a
 * size or a metric tensor given per cell or point.
 *
 * @par Example:
 * @code
 * vtkNew<vtkElementQuality> quality;
 * quality->SetInputConnection(reader->GetOutputPort());
 * quality->AddMetricByName("imr");
 * quality->AddMetricByName("mu_2");
 * quality->Update();
 * quality->GetStatistics()->Dump();
 * @endcode
 *
 * Dissertation sections 2.3, 3.2.1, 4.9.2 and Table 2.7.
 *
 * @sa vtkMeshComparison, vtkMetricField, vtkMeshPerturbation, tautline/Quality/Metrics.h
 */

#ifndef vtkElementQuality_h
#define vtkElementQuality_h

#include "TautlineQualityModule.h" // for export macro
#include "vtkMetricAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

#include <memory> // for curved cells
#include <string> // for Notice
#include <vector> // for lists of metrics

class vtkDataSet;
class vtkMultiProcessController;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace tautline
{
class BadElements;
class CriteriaGrader;
class CurvedQuality;
class FaceQuality;
class FaceTotals;
class PieceFaces;
class Mesh;
class MeshAdapter;
struct CurvedCellFacts;
struct OrientedPiece;
enum class FaceConvention;
class PieceOrientations;
class QualityTotals;
enum class Metric : int;
struct EvaluationOptions;
struct InputBlock;
struct Targets;
}

class TAUTLINEQUALITY_EXPORT vtkElementQuality : public vtkMetricAlgorithm
{
public:
  static vtkElementQuality* New();
  vtkTypeMacro(vtkElementQuality, vtkMetricAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Combinations
  {
    MEAN = 0,
    WORST = 1,
    POWER_MEAN = 2
  };
  ///@{
  /**
   * The combination of the corners of cells other than simplices, and of the sample points of a
   * curved cell, in target metrics: their mean, the worst, or the power mean with exponent Power
   * (negated if larger is better). If some corners or sample points are inverted, only these are
   * combined, except for untangling metrics. The worst imr, mean_ratio and condition_number of a
   * curved cell are certified. The default is MEAN.
   */
  vtkTautlineSetRangeMacro(Combination, int, MEAN, POWER_MEAN);
  vtkGetMacro(Combination, int);
  ///@}

  ///@{
  /// Exponent of POWER_MEAN, at least 1. The default is 2.
  vtkTautlineSetRangeMacro(Power, double, 1.0, 100.0);
  vtkGetMacro(Power, double);
  ///@}

  enum TargetTypes
  {
    IDEAL = 0,
    REFERENCE = 1,
    SIZE = 2,
    TENSOR = 3
  };
  ///@{
  /**
   * The target element, for target metrics. IDEAL: the ideal cell of each type with unit
   * edges. REFERENCE: the same cell of the mesh at input port 1. SIZE: the ideal shape with the
   * area or volume given by the array at index 0 (SetInputArrayToProcess; points or cells). TENSOR:
   * the ideal shape in the metric tensor given by the array at index 1 (6 components xx yy zz xy yz
   * xz, or 9; points or cells), in which the target edges have length 1. Values of point arrays are
   * averaged over each cell. The default is IDEAL.
   */
  vtkTautlineSetRangeMacro(TargetType, int, IDEAL, TENSOR);
  vtkGetMacro(TargetType, int);
  ///@}

  ///@{
  /**
   * Beta of the untangling metric: the minimum area or volume that every element should have, in
   * length^n. The default is 0 (not inverted).
   */
  vtkSetMacro(Beta, double);
  vtkGetMacro(Beta, double);
  ///@}

  ///@{
  /// Epsilon of mu_211 and mu_311, above 0. The default is 1e-4.
  vtkSetMacro(Epsilon, double);
  vtkGetMacro(Epsilon, double);
  ///@}

  enum ReversedMeshes
  {
    MEASURE_AS_GIVEN = 0,
    MEASURE_FLIPPED = 1,
    FLIP_OUTPUT = 2
  };
  ///@{
  /**
   * The treatment of a mesh whose cells all list their points in the opposite order.
   * MEASURE_AS_GIVEN: its elements count as inverted. MEASURE_FLIPPED: it is measured as if
   * flipped, and the output keeps the input's cells. FLIP_OUTPUT: the output's cells are also
   * flipped (unstructured grids and poly data of linear cells). The reversal is reported in each
   * case. The default is MEASURE_FLIPPED.
   */
  vtkTautlineSetRangeMacro(ReversedMesh, int, MEASURE_AS_GIVEN, FLIP_OUTPUT);
  vtkGetMacro(ReversedMesh, int);
  ///@}

  ///@{
  /// Number of rows of the table Distribution, and of bins of the table Histogram. The default is
  /// 32.
  vtkTautlineSetRangeMacro(HistogramBins, int, 1, 100000);
  vtkGetMacro(HistogramBins, int);
  ///@}

  ///@{
  /**
   * Whether to add the cell array JacobianBound: a certified lower bound of the smallest Jacobian
   * determinant in the cell, as in min_jacobian; for a cell of a surface in space, of the component
   * of its normal along the mean normal. 0 if it is not measured. The default is off.
   */
  vtkSetMacro(JacobianBounds, bool);
  vtkGetMacro(JacobianBounds, bool);
  vtkBooleanMacro(JacobianBounds, bool);
  ///@}

  ///@{
  /// Whether the output Bad is filled. The default is off.
  vtkSetMacro(ExtractBad, bool);
  vtkGetMacro(ExtractBad, bool);
  vtkBooleanMacro(ExtractBad, bool);
  ///@}

  ///@{
  /**
   * Quality criteria: the name of a preset (GetCriteriaPresets()), the name of a JSON file, or JSON
   * text, see tautline/Quality/Criteria.h. Their metrics are also measured. They are validated on
   * execution. The default is "", no criteria.
   */
  void SetCriteria(const char* criteria);
  const char* GetCriteria() const { return this->Criteria.c_str(); }
  ///@}
  /// The names of the presets, tab-separated; the JSON text of a preset ("" if it does not exist).
  static std::string GetCriteriaPresets();
  static std::string GetCriteriaPreset(const char* name);

  ///@{
  /**
   * Checks of solvers and preprocessors by their own definitions: names, separated by commas, or
   * "all"; see GetKnownCheck() and tautline/Quality/ElementChecks.h. Each gives a cell array with
   * its name, 0 if a cell has no value; the summary has its range. Unknown names are an error on
   * execution. The default is "", no checks.
   */
  void SetChecks(const char* checks);
  const char* GetChecks() const { return this->Checks.c_str(); }
  ///@}
  ///@{
  /**
   * The checks as text: check i as one line of tab-separated fields (name, label, formula, source,
   * note; empty if there is no such check).
   */
  static int GetNumberOfKnownChecks();
  static std::string GetKnownCheck(int i);
  ///@}

  ///@{
  /**
   * The verdict of the last execution by the criteria: "passed", "warning", "failed", "none" if no
   * element could be graded, or "" without criteria; and the quality index of the mesh, 0 (ideal)
   * to 1. With several processes, for the whole mesh.
   */
  const char* GetVerdict() const { return this->Verdict.c_str(); }
  double GetQualityIndex() const { return this->QualityIndex; }
  ///@}

  enum FaceConventions
  {
    BY_CRITERIA = 0,
    ESI = 1,
    FOUNDATION = 2
  };
  ///@{
  /**
   * The OpenFOAM variant whose face centers are used for finite-volume metrics: ESI (openfoam.com)
   * or FOUNDATION (openfoam.org); they differ only for warped faces, see
   * tautline/FiniteVolume/FaceGeometry.h. BY_CRITERIA: the variant of the criteria, or ESI. The
   * default is BY_CRITERIA.
   */
  vtkTautlineSetRangeMacro(FaceConvention, int, BY_CRITERIA, FOUNDATION);
  vtkGetMacro(FaceConvention, int);
  ///@}

  enum FaceOutputs
  {
    NO_FACES = 0,
    FAILED_FACES = 1,
    ALL_FACES = 2
  };
  ///@{
  /**
   * The faces in the output Faces if finite-volume metrics are measured: none, faces that fail a
   * check or belong to a cell that does, or all. The default is FAILED_FACES.
   */
  vtkTautlineSetRangeMacro(FaceOutput, int, NO_FACES, ALL_FACES);
  vtkGetMacro(FaceOutput, int);
  ///@}

  ///@{
  /**
   * The number of OpenFOAM's checkMesh checks that the mesh of the last execution fails: without
   * options, and with -allTopology and -allGeometry. -1 if no finite-volume metric was measured.
   */
  vtkGetMacro(FailedChecks, int);
  vtkGetMacro(FailedChecksOfAll, int);
  ///@}

  ///@{
  /// The processes that share the mesh. The default is the global controller.
  virtual void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController();
  ///@}

  ///@{
  /// The outputs other than the mesh.
  vtkTable* GetStatistics();
  vtkTable* GetDistribution();
  vtkTable* GetAngles();
  vtkTable* GetHistogram();
  vtkTable* GetCriteriaTable();
  vtkPolyData* GetWorst();
  vtkUnstructuredGrid* GetBad();
  vtkPolyData* GetFaces();
  vtkTable* GetMeshChecks();
  ///@}

  ///@{
  /**
   * The registry of metrics as text, for scripts and documentation: metric i as one line of
   * tab-separated fields (empty if there is no such metric), and the names of the fields. The
   * built-in metrics come first, followed by registered metrics.
   */
  static int GetNumberOfKnownMetrics();
  static int GetNumberOfBuiltInMetrics();
  static std::string GetKnownMetric(int i);
  static std::string GetKnownMetricFields();
  ///@}

  /// ParaView settings, as JSON text: the color maps of the metric arrays and of Validity.
  static std::string GetColorMapSettings();

  /// Remarks on the interpretation of the last mesh (orientation, cells left out), or "". With
  /// several processes, the first has the remarks on the whole mesh, the others "".
  const char* GetNotice() const { return this->Notice.c_str(); }
  /// Bytes allocated beyond input and output arrays at the peak of the last execution.
  double GetWorkingBytes() const { return this->WorkingBytes; }

protected:
  vtkElementQuality();
  ~vtkElementQuality() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  tautline::GatheredRules GetGatheredRules() override;
  void ClearResult() override;

private:
  vtkElementQuality(const vtkElementQuality&) = delete;
  void operator=(const vtkElementQuality&) = delete;

  void Together(const char* memoryRemedy, const std::function<void()>& work);
  void MeasureAll(vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  void Measure(const tautline::InputBlock& block, const tautline::PieceOrientations& pieces,
    const tautline::PieceFaces& pieceFaces, tautline::QualityTotals& totals,
    tautline::CriteriaGrader& grader, tautline::BadElements& bad, tautline::FaceTotals& faces);
  /// @param faces null for none @param alone whether they belong to a whole mesh, whose checks are
  /// added
  void CheckFaces(tautline::FaceQuality* faces, bool alone, tautline::FaceTotals& totals);
  tautline::FaceConvention ConventionOf(const tautline::CriteriaGrader& grader) const;
  /// @param piece the findings on the whole mesh; null to find them for this data set
  void SettleOrientation(tautline::MeshAdapter& adapter, const tautline::OrientedPiece* piece,
    signed char* validity, vtkDataSet* output);
  /// Certifies the curved cells of a block; adds remarks and results to the output.
  std::unique_ptr<tautline::CurvedQuality> CertifyCurved(
    vtkDataSet* input, const tautline::MeshAdapter& adapter, signed char* validity);
  void MeasureChecks(vtkDataSet* input, const tautline::MeshAdapter& adapter,
    const signed char* validity, const unsigned char* skip, tautline::QualityTotals& totals,
    vtkDataSet* output);
  /// Adds a remark on the metrics that hold for the whole curved cell.
  void AddCurvedNotice(const tautline::CurvedQuality& curved,
    const std::vector<tautline::Metric>& metrics, const tautline::EvaluationOptions& options);
  /// Adds the cell array JacobianBound.
  void AddBounds(vtkDataSet* input, const tautline::MeshAdapter& adapter, vtkDataSet* output);
  void AddToNotice(const std::string& sentences);
  tautline::Targets MakeTargets(
    vtkDataSet* input, vtkDataSet* reference, const tautline::MeshAdapter& adapter);

  int Combination = MEAN;
  double Power = 2.0;
  int TargetType = IDEAL;
  double Beta = 0.0;
  double Epsilon = 1e-4;
  int ReversedMesh = MEASURE_FLIPPED;
  int HistogramBins = 32;
  bool JacobianBounds = false;
  int FaceConvention = BY_CRITERIA, FaceOutput = FAILED_FACES;
  int FailedChecks = -1, FailedChecksOfAll = -1;
  bool ExtractBad = false;
  vtkMultiProcessController* Controller = nullptr;
  std::string Notice;
  std::string Criteria;
  std::string Checks;
  std::string Verdict;
  double QualityIndex = 0;
  double WorkingBytes = 0;
};

#endif
