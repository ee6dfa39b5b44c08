// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshOptimizer
 * @brief Moves the points of a mesh so that one or several quality metrics improve.
 *
 * Takes triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed, from
 * data sets with explicit points, or blocks of these (one after the other, each with its own
 * boundary). The connectivity stays. What is minimized is chosen by a preset, or in full: any
 * number of objectives (a metric, aggregated over the elements by a template, against a target),
 * their scalarization, and the algorithm.
 *
 * The output is never worse than the input: the combined objective does not rise (but where the
 * worst element comes first, see ImproveWorst), and no valid element becomes inverted unless
 * AllowInversion. An input with inverted elements is untangled
 * first (UntangleFirst) where the objectives cannot repair it. Points of a planar mesh stay in its
 * plane, those of a surface stay on it, or on the geometry. A mesh reversed throughout is
 * treated as its mirror image, and so is a cell that lists its points in the opposite order of the
 * others. Parts without a consistent orientation and image data (implicit points) are refused.
 *
 * Of cells of quadratic and higher order, in volumes or in a plane, all nodes move, and no valid
 * cell becomes invalid anywhere in it at any step, see tautline/Curved/OptimizeCurved.h. Objectives
 * are then sums over the samples of a quadrature, of metrics that are functions of the Jacobian
 * matrix; the optimizer is Newton's method; ON_SURFACE means the curved boundary as it was, or the
 * geometry. WORST_ELEMENT minimizes a p-mean after the sum. Limits, regions, feature kinds and
 * AllowInversion are errors. The metrics in the output are measured at the corners.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) a reference mesh with the same cells, for targets of type REFERENCE and
 * the preset PRESERVE_SHAPE; 2 (optional) a vtkSelection of points or cells that stay; 3
 * (optional) the geometry: a surface of triangles or quadrilaterals (STL, a finer mesh) that points
 * slide on instead of that of the input, with its corners, curves and patches matched to those of
 * the mesh (KeepFeatures; for volume meshes ON_SURFACE). Points are placed on it first; no other
 * measure of the output is then worse than that of the mesh so placed.
 *
 * Arrays of the mesh (SetInputArrayToProcess), by index: 0 target sizes, 1 metric tensors, 2 fixed
 * points (not 0), 3 limits of the points' displacements, 4 weights of the elements (cells, at least
 * 0), 5 kinds of the points (0 patch, 1 curve, 2 corner, -1 as found), 6 regions (cells).
 *
 * @par Finite volumes:
 * With the preset FINITE_VOLUMES the cells are volumes of any kind, also polyhedra, and their faces
 * count as OpenFOAM has them; see vtkFoamMeshReader for patches. The table Statistics then has a
 * row for each check of checkMesh: `Metric` (its name), `Label`, and `Before` and `After` of
 * `Offending`, `Minimum` and `Maximum`; the mesh has non_orthogonality and face_skewness before and
 * after; the objective of the two rows of the history is the number of faces beyond the targets.
 * There is no animation, and the mesh is put together on one process.
 *
 * @par Output port 0 `Mesh`:
 * The input with new points, the point array `Displacement` (new minus old), and cell arrays: for
 * each objective's metric, and that of the worst element (see WorstMetric), its value after, named
 * by the metric ("imr"), and before ("imr_before"); `Validity` after (see vtkElementQuality).
 * Points in single precision stay so unless a valid element, the objective or the worst element of
 * a valid input would be worse by rounding; the summary reports it. Values after are as rounded.
 *
 * @par Output port 1 `History`:
 * A vtkTable whose row i is iteration i (0 is the input): `Objective`; for each metric
 * `<metric> mean` and `<metric> worst` (of the valid elements), and with several objectives
 * `<metric> objective`; `Inverted` (with degenerate elements), `N gradient`, `N moving` (points),
 * `Time (s)`. Of composite data sets the rows of each block follow each other, distinguished by the
 * column `Block`.
 *
 * @par Output port 2 `Statistics`:
 * A vtkTable with a row per metric (and block): `Metric`, `Label`, and `Before` and `After` of:
 * `Minimum`, `Mean`, `Maximum`, `RMS`, `StandardDeviation`, `Worst`, `OutsideAcceptable`,
 * `Inverted`, `Degenerate`; over the elements of the statistics of vtkElementQuality.
 *
 * @par Several processes:
 * Each may have pieces of the mesh. Volume meshes and planar ones are worked on where they are, in
 * the reproducible order, with weights and with targets by size and tensor. Gathered on the first
 * process, with the result of one process in its own order and a sentence in the summary, are
 * surfaces in space, inclined planes and blocks; boundaries that slide on curved surfaces or on a
 * geometry; regions, feature kinds and features that are shown; targets of a reference mesh
 * (PRESERVE_SHAPE); the templates P_MEAN and MAXIMUM; steps that improve the worst element
 * (WORST_ELEMENT); and any mesh with Animation.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMeshOptimizer> optimizer;
 * optimizer->SetInputConnection(reader->GetOutputPort());
 * optimizer->AddObjectiveByName("imr");
 * optimizer->AddObjectiveByName(
 *   "mu_size", vtkMeshOptimizer::DEFAULT_TEMPLATE, 1.0, vtkMeshOptimizer::SIZE);
 * optimizer->SetScalarization(vtkMeshOptimizer::OBJECTIVE_PRODUCT);
 * optimizer->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "size");
 * optimizer->Update();
 * std::cout << optimizer->GetSummary();
 * @endcode
 *
 * Dissertation chapter 3 and section 2.4.
 *
 * @sa vtkMeshUntangler, vtkElementQuality, vtkMeshComparison, tautline/Optimization/Optimize.h
 */

#ifndef vtkMeshOptimizer_h
#define vtkMeshOptimizer_h

#include "TautlineOptimizationModule.h" // for export macro
#include "vtkMeshBoundaryAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters
#include "vtkTimeStamp.h"        // for RunTime

#include <memory> // for Runs
#include <string> // for Reason
#include <vector> // for Rows, Runs

namespace tautline
{
class CurvedMotion;
class TableRows;
struct InputBlock;
struct ObjectiveRow;
struct OptimizeOptions;
struct OptimizerRun;
struct OptimizerSettings;
}

class TAUTLINEOPTIMIZATION_EXPORT vtkMeshOptimizer : public vtkMeshBoundaryAlgorithm
{
public:
  static vtkMeshOptimizer* New();
  vtkTypeMacro(vtkMeshOptimizer, vtkMeshBoundaryAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Presets
  {
    CUSTOM = 0,
    FAST_CLEAN_UP = 1,
    BEST_SHAPE = 2,
    UNIFORM_SIZE = 3,
    LOW_INTERPOLATION_ERROR = 4,
    UNTANGLE_THEN_IMPROVE = 5,
    PRESERVE_SHAPE = 6,
    WORST_ELEMENT = 7,
    FINITE_VOLUMES = 8
  };
  ///@{
  /**
   * A ready-made choice. All but CUSTOM determine objectives, scalarization, optimizer and
   * stopping criteria (but for the time limit), see tautline::applyPreset(); those below are for
   * CUSTOM. With a boundary that moves freely, UNIFORM_SIZE compares the sizes with their mean in
   * the input (metric mu_size), so that the mesh does not shrink. FINITE_VOLUMES takes polyhedra,
   * too, and moves points near faces that fail OpenFOAM's checkMesh or are beyond the targets
   * NonOrthogonality and Skewness, see tautline/Polyhedral/ImproveFaces.h. The default is
   * BEST_SHAPE.
   */
  vtkTautlineSetRangeMacro(Preset, int, CUSTOM, FINITE_VOLUMES);
  vtkGetMacro(Preset, int);
  ///@}

  ///@{
  /**
   * Of the preset FINITE_VOLUMES: the largest non-orthogonality, in degrees from 1 to 90, and
   * skewness of faces that is aimed at. checkMesh warns above 70 degrees, and fails from 90 degrees
   * on and above a skewness of 4. The defaults are 65 and 3.5.
   */
  vtkTautlineSetRangeMacro(NonOrthogonality, double, 1.0, 90.0);
  vtkGetMacro(NonOrthogonality, double);
  vtkTautlineSetRangeMacro(Skewness, double, 0.1, 1000.0);
  vtkGetMacro(Skewness, double);
  ///@}

  enum Templates
  {
    DEFAULT_TEMPLATE = -1,
    SUM_OF_SQUARES = 0,
    SUM_OF_SQUARED_RECIPROCALS = 1,
    SUM_OF_RECIPROCALS = 2,
    SUM = 3,
    P_MEAN = 4,
    MAXIMUM = 5
  };
  enum TargetTypes
  {
    IDEAL = 0,
    REFERENCE = 1,
    SIZE = 2,
    TENSOR = 3
  };
  ///@{
  /**
   * Adds an objective and chooses the preset CUSTOM.
   * @param metric by number (enum Metric of tautline/Quality/Metrics.h) or by name, label, symbol
   * or alias; an unknown one is an error and changes nothing
   * @param objectiveTemplate one of Templates; DEFAULT_TEMPLATE is that of the dissertation for the
   * metric
   * @param weight above 0, for the scalarizations that take weights
   * @param target one of TargetTypes, as in vtkElementQuality: the ideal element, that of the mesh
   * at port 1, the ideal shape in the size of the array at index 0 or in the metric tensor of the
   * array at index 1 (SetInputArrayToProcess; points or cells)
   */
  void AddObjective(
    int metric, int objectiveTemplate = DEFAULT_TEMPLATE, double weight = 1.0, int target = IDEAL);
  void AddObjectiveByName(const char* metric, int objectiveTemplate = DEFAULT_TEMPLATE,
    double weight = 1.0, int target = IDEAL);
  ///@}
  /// Without objectives, CUSTOM minimizes the sum of squared inverse mean ratios.
  void RemoveAllObjectives();

  ///@{
  /// How many of the objectives count; added ones are the sum of squared inverse mean ratios.
  void SetNumberOfObjectives(int count);
  int GetNumberOfObjectives() const { return this->Objectives; }
  ///@}

  ///@{
  /// The properties of one objective, for panels that set them one by one; see AddObjective().
  void SetMetric1(int metric);
  void SetMetric2(int metric);
  void SetMetric3(int metric);
  void SetMetric4(int metric);
  void SetTemplate1(int objectiveTemplate);
  void SetTemplate2(int objectiveTemplate);
  void SetTemplate3(int objectiveTemplate);
  void SetTemplate4(int objectiveTemplate);
  void SetWeight1(double weight);
  void SetWeight2(double weight);
  void SetWeight3(double weight);
  void SetWeight4(double weight);
  void SetTarget1(int target);
  void SetTarget2(int target);
  void SetTarget3(int target);
  void SetTarget4(int target);
  ///@}

  ///@{
  /// p of the template P_MEAN (at least 1) and k of MAXIMUM (above 0). The default is 8.
  vtkSetMacro(Power, double);
  vtkGetMacro(Power, double);
  ///@}

  enum Combinations
  {
    MEAN = 0,
    WORST = 1,
    POWER_MEAN = 2
  };
  ///@{
  /// How target metrics combine the corners of a cell, as in vtkElementQuality. The default is
  /// MEAN.
  vtkTautlineSetRangeMacro(Combination, int, MEAN, POWER_MEAN);
  vtkGetMacro(Combination, int);
  ///@}

  ///@{
  /// Area or volume every element should have at least, for the untangling metric. The default is
  /// 0.
  vtkSetMacro(Beta, double);
  vtkGetMacro(Beta, double);
  ///@}

  enum Scalarizations
  {
    EXPONENTIAL_SUM = 0,
    OBJECTIVE_PRODUCT = 1,
    EQUAL_SUM = 2,
    WEIGHTED_SUM = 3,
    WEIGHTED_MIN_MAX = 4,
    EXPONENTIAL_WEIGHTED = 5,
    LEXICOGRAPHIC = 6,
    RAO = 7
  };
  ///@{
  /// How several objectives become one, see tautline/Objectives/Scalarization.h. The default is
  /// EXPONENTIAL_SUM.
  vtkTautlineSetRangeMacro(Scalarization, int, EXPONENTIAL_SUM, RAO);
  vtkGetMacro(Scalarization, int);
  ///@}

  ///@{
  /// c of EXPONENTIAL_SUM, above 0; 0, the default, chooses it from the initial values.
  vtkSetMacro(C, double);
  vtkGetMacro(C, double);
  ///@}

  ///@{
  /**
   * Local algorithms combine the sums over the elements around the vertex that moves instead of the
   * sums over the whole mesh, as Mesquite does by default. The objective of the whole mesh may then
   * rise. With EXPONENTIAL_SUM, OBJECTIVE_PRODUCT, EQUAL_SUM and WEIGHTED_SUM; an error with the
   * other scalarizations and with global algorithms. Off by default.
   */
  vtkSetMacro(PatchScalarization, bool);
  vtkGetMacro(PatchScalarization, bool);
  vtkBooleanMacro(PatchScalarization, bool);
  ///@}

  ///@{
  /// p of EXPONENTIAL_WEIGHTED, above 0. The default is 1.
  vtkSetMacro(Exponent, double);
  vtkGetMacro(Exponent, double);
  ///@}

  ///@{
  /**
   * By what fraction of its value an objective may rise while those after it are minimized
   * (LEXICOGRAPHIC), at least 0. The default is 0.01.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * The value each objective would have at best, for WEIGHTED_MIN_MAX, EXPONENTIAL_WEIGHTED and
   * RAO: none (then they are 0) or one for each objective.
   */
  void AddUtopia(double value);
  void RemoveAllUtopias();
  ///@}

  enum Optimizers
  {
    AUTOMATIC = 0,
    LOCAL_NEWTON = 1,
    LOCAL_CONJUGATE_GRADIENT = 2,
    CONJUGATE_GRADIENT_FLETCHER_REEVES = 3,
    CONJUGATE_GRADIENT_POLAK_RIBIERE = 4,
    LIMITED_MEMORY_BFGS = 5,
    NEWTON_CONJUGATE_GRADIENT = 6
  };
  ///@{
  /**
   * The algorithm: local ones sweep over the points, others move all at once. AUTOMATIC, the
   * default, is LOCAL_NEWTON. Where sweeps converge slowly, NEWTON_CONJUGATE_GRADIENT starts from
   * the input, or from its harmonic map if that is valid and better; where it stops short, or holds
   * points (on curved parts of the boundary of a volume or planar mesh, at limits), both take
   * turns. Should a sweep fail to reduce several
   * objectives, LIMITED_MEMORY_BFGS continues.
   */
  vtkTautlineSetRangeMacro(Optimizer, int, AUTOMATIC, NEWTON_CONJUGATE_GRADIENT);
  vtkGetMacro(Optimizer, int);
  ///@}

  ///@{
  /// Sweeps of the local algorithms, iterations of the others. The default is 300.
  vtkTautlineSetRangeMacro(MaximumIterations, int, 0, 1000000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /// Stop when the gradient's norm has fallen by this factor; 0: never. The default is 1e-6. Not
  /// used by NEWTON_CONJUGATE_GRADIENT.
  vtkTautlineSetRangeMacro(GradientNorm, double, 0.0, 1.0);
  vtkGetMacro(GradientNorm, double);
  ///@}

  ///@{
  /// Stop when an iteration reduces the objective by less than this fraction; 0: never. The
  /// default is 1e-5.
  vtkTautlineSetRangeMacro(RelativeChange, double, 0.0, 1.0);
  vtkGetMacro(RelativeChange, double);
  ///@}

  ///@{
  /// "Inaccurate smoothing", section 3.4: stop when all mean qualities keep two decimals. Off.
  vtkSetMacro(TwoDigits, bool);
  vtkGetMacro(TwoDigits, bool);
  vtkBooleanMacro(TwoDigits, bool);
  ///@}

  ///@{
  /**
   * Section 2.4: stop when this fraction of the possible reduction of the objective is reached, 0
   * to 1; 1, the default: never. The possible reduction is that to BestKnown, or an estimate.
   */
  vtkTautlineSetRangeMacro(Reduction, double, 0.0, 1.0);
  vtkGetMacro(Reduction, double);
  ///@}

  ///@{
  /**
   * The objective of the completely smoothed mesh, for Reduction, in the unit of the objective; any
   * number, also 0, the optimum of untangling. It counts if UseBestKnown is on; off, the default:
   * it is not known and Reduction estimates it.
   */
  vtkSetMacro(UseBestKnown, bool);
  vtkGetMacro(UseBestKnown, bool);
  vtkBooleanMacro(UseBestKnown, bool);
  vtkSetMacro(BestKnown, double);
  vtkGetMacro(BestKnown, double);
  ///@}

  ///@{
  /// Stop when every element is valid. Off.
  vtkSetMacro(StopWhenValid, bool);
  vtkGetMacro(StopWhenValid, bool);
  vtkBooleanMacro(StopWhenValid, bool);
  ///@}

  ///@{
  /**
   * With the preset WORST_ELEMENT (or ImproveWorst), a surface in space or the boundary ON_SURFACE,
   * KeepFeatures and a SurfaceTolerance above 0: points of the surface near the worst elements,
   * corners and points of curves too, may leave the surface within that tolerance, where sliding
   * does not improve these elements any more. Points on interfaces, fixed points and those given as
   * corner or curve points (array at index 5) do not leave; with a Geometry or limits of the
   * displacement, none does. The summary says how many did. The default is on.
   */
  vtkSetMacro(LeaveSurface, bool);
  vtkGetMacro(LeaveSurface, bool);
  vtkBooleanMacro(LeaveSurface, bool);
  ///@}

  ///@{
  /**
   * How far a point may go from where it was, in the unit of the coordinates; 0: any distance.
   * Where the point array at index 3 is chosen, it gives a limit for each point instead (negative:
   * any distance). The default is 0.
   */
  vtkTautlineSetRangeMacro(MaximumDisplacement, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumDisplacement, double);
  ///@}

  ///@{
  /// Project the points of a surface in space back to the input surface. On.
  vtkSetMacro(ProjectToSurface, bool);
  vtkGetMacro(ProjectToSurface, bool);
  vtkBooleanMacro(ProjectToSurface, bool);
  ///@}

  ///@{
  /// Let steps invert elements that are valid, if that reduces the objective. Off.
  vtkSetMacro(AllowInversion, bool);
  vtkGetMacro(AllowInversion, bool);
  vtkBooleanMacro(AllowInversion, bool);
  ///@}

  ///@{
  /**
   * Untangle an input with inverted elements first, where no objective can repair it; off: report
   * an error. On.
   */
  vtkSetMacro(UntangleFirst, bool);
  vtkGetMacro(UntangleFirst, bool);
  vtkBooleanMacro(UntangleFirst, bool);
  ///@}

  ///@{
  /// Scale untangling objectives up at the start as section 3.3.3 does. On.
  vtkSetMacro(RescaleUntangling, bool);
  vtkGetMacro(RescaleUntangling, bool);
  vtkBooleanMacro(RescaleUntangling, bool);
  ///@}

  ///@{
  /**
   * Local algorithms leave out points that moved less than this fraction of their shortest edge; 0:
   * none. The default is 1e-3.
   */
  vtkTautlineSetRangeMacro(Culling, double, 0.0, 1.0);
  vtkGetMacro(Culling, double);
  ///@}

  ///@{
  /// Steps in each patch of the local algorithms; it becomes 1 when a sweep
  /// has raised the objective. The default is 1.
  vtkTautlineSetRangeMacro(PatchIterations, int, 1, 1000);
  vtkGetMacro(PatchIterations, int);
  ///@}

  ///@{
  /// A step of LOCAL_NEWTON is this times Newton's; from 1, below 2. The default is 1.4.
  vtkTautlineSetRangeMacro(Relaxation, double, 1.0, 1.99);
  vtkGetMacro(Relaxation, double);
  ///@}

  ///@{
  /**
   * After the objective has converged, improve the worst element as long as the mean of the first
   * metric does not get worse by more than this fraction, or five times as much where another
   * metric judges the worst element; 0, the default: off.
   */
  vtkTautlineSetRangeMacro(ImproveWorst, double, 0.0, 1.0);
  vtkGetMacro(ImproveWorst, double);
  ///@}

  ///@{
  /**
   * The metric that tells which element is the worst one, by its number (tautline::Metric), also
   * for the presets: of the preset WORST_ELEMENT and ImproveWorst, and of the promise that the
   * worst element does not get worse. -1, the default: where the worst element is improved, the
   * scaled Jacobian for meshes with quadrilaterals, hexahedra or wedges, but no pyramids; else the
   * metric of the first objective.
   */
  void SetWorstMetric(int metric);
  vtkGetMacro(WorstMetric, int);
  /// By name, label or symbol; unknown names are an error.
  void SetWorstMetricByName(const char* name);
  ///@}
  /// The metrics that were registered (vtkUserMetric, libraries): a line "number<tab>label" each.
  static std::string GetUserMetrics();

  ///@{
  /**
   * Whether the worst element of a valid input must not get worse. Off: a smaller objective may
   * cost single elements. The default is on.
   */
  vtkSetMacro(HoldWorst, bool);
  vtkGetMacro(HoldWorst, bool);
  vtkBooleanMacro(HoldWorst, bool);
  ///@}

  ///@{
  /**
   * Whether one process, too, works in the order that does not depend on how a mesh is spread over
   * processes, which several processes use unless the mesh is gathered: the points are then the
   * same on any number of them. Off.
   */
  vtkSetMacro(ReproducibleOrder, bool);
  vtkGetMacro(ReproducibleOrder, bool);
  vtkBooleanMacro(ReproducibleOrder, bool);
  ///@}

  ///@{
  /**
   * Give the iterations as time steps: time t is the mesh after iteration t (those of untangling
   * come first), so that ParaView's animation plays the optimization. Without a request for a time,
   * the output is the result. The time of the input is then its default one. Off.
   */
  vtkSetMacro(Animation, bool);
  vtkGetMacro(Animation, bool);
  vtkBooleanMacro(Animation, bool);
  ///@}

  ///@{
  /**
   * Megabytes for the points of the iterations; beyond that every second one is dropped,
   * repeatedly. The default is 1000.
   */
  vtkTautlineSetRangeMacro(AnimationMemory, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(AnimationMemory, double);
  ///@}

  /// The table of output port 2.
  vtkTable* GetStatistics();

  ///@{
  /**
   * The result of the last execution; numbers are of all blocks together, the reason is that of the
   * last: why it stopped as a sentence and as a number (enum StopReason of
   * tautline/Core/Iteration.h, -1: nothing done).
   */
  const char* GetReason() const { return this->Reason.c_str(); }
  int GetStopReason() const { return this->StopReason; }
  int GetIterations() const { return this->Iterations; }
  vtkIdType GetFreePoints() const { return this->FreePoints; }
  vtkIdType GetInvertedBefore() const { return this->InvertedBefore; }
  vtkIdType GetInvertedAfter() const { return this->InvertedAfter; }
  /// Largest distance between the surface and interfaces of the output, where points slide on them,
  /// and those of the input, both ways, or of the geometry. Measured as SurfaceTolerance is.
  double GetSurfaceError() const { return this->SurfaceError; }
  ///@}

protected:
  vtkMeshOptimizer();
  ~vtkMeshOptimizer() override;

  vtkTypeBool ProcessRequest(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  /// The input, at first.
  bool KeepsBest() const override { return true; }
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void ClearResult() override;
  tautline::GatheredRules GetGatheredRules() override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  std::string FindSettingProblem() const override;
  void ExchangeResult(tautline::ResultStream& stream) override;

private:
  vtkMeshOptimizer(const vtkMeshOptimizer&) = delete;
  void operator=(const vtkMeshOptimizer&) = delete;

  tautline::ObjectiveRow& RowAt(int index);
  template <class Value>
  void SetRowValue(Value& current, Value value);
  int EffectiveIterations();
  std::vector<double> TimeSteps();
  bool HasRun(); ///< whether Runs are those of the inputs and settings
  tautline::OptimizerSettings GetSettings();
  std::unique_ptr<tautline::CurvedMotion> MakeCurved(const tautline::InputBlock& block);
  void Observe(tautline::OptimizerRun& run, int block, vtkIdType coordinates,
    tautline::OptimizeOptions& options);
  void Optimize(const tautline::OptimizerSettings& settings, const tautline::InputBlock& block,
    tautline::OptimizerRun& run, bool done, double time, tautline::TableRows& history,
    tautline::TableRows& statistics);
  /// FINITE_VOLUMES measures the layer itself.
  bool TreatsLayers() override { return this->PlanarLayers && this->Preset != FINITE_VOLUMES; }
  void ImproveFaces(const tautline::OptimizerSettings& settings, const tautline::InputBlock& block,
    tautline::OptimizerRun& run, tautline::TableRows& history, tautline::TableRows& statistics);
  void Report();
  /// What is wrong with the result, in sentences; the most important one last.
  std::vector<std::string> ResultWarnings() const;

  std::vector<tautline::ObjectiveRow> Rows;
  int Objectives = 0;
  std::vector<double> Utopia;
  int Preset = BEST_SHAPE;
  double NonOrthogonality = 65.0, Skewness = 3.5;
  double Power = 8.0;
  int Combination = MEAN;
  double Beta = 0.0;
  int Scalarization = EXPONENTIAL_SUM;
  double C = 0.0;
  bool PatchScalarization = false;
  double Exponent = 1.0;
  double Tolerance = 0.01;
  int Optimizer = AUTOMATIC;
  int MaximumIterations = 300;
  double GradientNorm = 1e-6;
  double RelativeChange = 1e-5;
  bool TwoDigits = false;
  double Reduction = 1.0;
  bool UseBestKnown = false;
  double BestKnown = 0.0;
  bool StopWhenValid = false;
  bool LeaveSurface = true;
  double MaximumDisplacement = 0.0;
  bool ProjectToSurface = true;
  bool AllowInversion = false;
  bool UntangleFirst = true;
  bool RescaleUntangling = true;
  double Culling = 1e-3;
  int PatchIterations = 1;
  double Relaxation = 1.4;
  double ImproveWorst = 0.0;
  int WorstMetric = -1;
  bool HoldWorst = true;
  bool Animation = false;
  double AnimationMemory = 1000.0;

  std::vector<std::unique_ptr<tautline::OptimizerRun>> Runs; ///< per data set of the last execution
  vtkTimeStamp RunTime;                                      ///< of Runs that can be shown again
  std::vector<vtkMTimeType> RunInputs;                       ///< the content of the inputs of Runs
  bool InputsChanged = true; ///< since the execution before; on several processes, of any
  int LastIteration = -1;    ///< the last one of any of Runs, on all processes; -1: none
  std::string Reason;
  int StopReason = -1;
  int Iterations = 0;
  vtkIdType FreePoints = 0;
  vtkIdType InvertedBefore = 0, InvertedAfter = 0;
  double SurfaceError = 0.0;
};

#endif
