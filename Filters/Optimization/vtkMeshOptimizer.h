// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshOptimizer
 * @brief Moves the points of a mesh to improve one or several quality metrics.
 *
 * Supports triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed, in
 * data sets with explicit points, or blocks of these (processed separately, each with its own
 * boundary). The connectivity does not change. A preset selects the objective; alternatively, all
 * details can be set: any number of objectives (a metric, aggregated over the elements by a
 * template, against a target), their scalarization, and the algorithm.
 *
 * The output is never worse than the input: the combined objective does not increase (except when
 * the worst element takes priority, see ImproveWorst), and no valid element becomes inverted unless
 * AllowInversion is on. An input with inverted elements is untangled first (UntangleFirst) if the
 * objectives cannot repair it. Points of a planar mesh stay in its plane; points of a surface stay
 * on it, or on the geometry. A mesh reversed throughout is treated as its mirror image, and so is a
 * cell that lists its points in the opposite order of the others. Parts without a consistent
 * orientation and image data (implicit points) are not supported.
 *
 * In meshes of quadratic and higher-order cells, in volumes or in a plane, all nodes move, and no
 * valid cell becomes invalid at any of its points in any step, see
 * tautline/Curved/OptimizeCurved.h. Objectives are then sums of metrics, as functions of the
 * Jacobian matrix, over quadrature samples; the optimizer is Newton's method; ON_SURFACE means the
 * original curved boundary, or the geometry. WORST_ELEMENT minimizes a p-mean after the sum.
 * Limits, regions, feature kinds and AllowInversion are not supported and cause an error. The
 * metrics in the output are measured at the corners.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) a reference mesh with the same cells, for targets of type REFERENCE and
 * the preset PRESERVE_SHAPE; 2 (optional) a vtkSelection of points or cells that stay; 3
 * (optional) the geometry: a surface of triangles or quadrilaterals (STL, a finer mesh) that points
 * slide on instead of the input's surface, with its corners, curves and patches matched to the
 * features of the mesh (KeepFeatures; for volume meshes ON_SURFACE). Points are placed on it first;
 * the guarantees then refer to the mesh after this step.
 *
 * Arrays of the mesh (SetInputArrayToProcess), by index: 0 target sizes, 1 metric tensors, 2 fixed
 * points (where not 0), 3 limits of the points' displacements, 4 weights of the elements (cells, at
 * least 0), 5 kinds of the points (0 patch, 1 curve, 2 corner, -1 as detected), 6 regions (cells).
 *
 * @par Finite volumes:
 * With the preset FINITE_VOLUMES the cells are volumes of any kind, including polyhedra, with faces
 * as in OpenFOAM; see vtkFoamMeshReader for patches. The table Statistics then has a row for each
 * check of checkMesh: `Metric` (its name), `Label`, and `Before` and `After` of `Offending`,
 * `Minimum` and `Maximum`; the mesh has non_orthogonality and face_skewness before and after; the
 * objective in the two rows of the history is the number of faces beyond the targets. There is no
 * animation, and the mesh is gathered on one process.
 *
 * @par Output port 0 `Mesh`:
 * The input with new points, the point array `Displacement` (new minus old), and cell arrays: for
 * each objective's metric and the metric of the worst element (see WorstMetric), the value after,
 * named by the metric ("imr"), and before ("imr_before"); `Validity` after (see vtkElementQuality).
 * Points in single precision stay so unless rounding would make a valid element, the objective or
 * the worst element of a valid input worse; the summary reports this. Values after refer to the
 * rounded points.
 *
 * @par Output port 1 `History`:
 * A vtkTable whose row i is iteration i (0 is the input): `Objective`; for each metric
 * `<metric> mean` and `<metric> worst` (of the valid elements), and with several objectives
 * `<metric> objective`; `Inverted` (with degenerate elements), `N gradient`, `N moving` (points),
 * `Time (s)`. For composite data sets, the rows of all blocks follow each other, distinguished by
 * the column `Block`.
 *
 * @par Output port 2 `Statistics`:
 * A vtkTable with a row per metric (and block): `Metric`, `Label`, and `Before` and `After` of:
 * `Minimum`, `Mean`, `Maximum`, `RMS`, `StandardDeviation`, `Worst`, `OutsideAcceptable`,
 * `Inverted`, `Degenerate`; over the elements of the statistics of vtkElementQuality.
 *
 * @par Several processes:
 * Each process may have pieces of the mesh. Volume meshes and planar meshes are optimized in place,
 * in the reproducible order, with weights and with targets by size and tensor. The following are
 * gathered on the first process, with the serial result in its own order and a sentence in the
 * summary: surfaces in space, inclined planes and blocks; boundaries that slide on curved surfaces
 * or on a geometry; regions, feature kinds and ShowFeatures; targets from a reference mesh
 * (PRESERVE_SHAPE); the templates P_MEAN and MAXIMUM; improvement of the worst element
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
   * The preset. All presets except CUSTOM determine objectives, scalarization, optimizer and
   * stopping criteria (except the time limit), see tautline::applyPreset(); the properties below
   * are for CUSTOM. With a free boundary, UNIFORM_SIZE compares the sizes with their mean in the
   * input (metric mu_size), so that the mesh does not shrink. FINITE_VOLUMES also supports
   * polyhedra; it moves points near faces that fail OpenFOAM's checkMesh or are beyond the targets
   * NonOrthogonality and Skewness, see tautline/Polyhedral/ImproveFaces.h. The default is
   * BEST_SHAPE.
   */
  vtkTautlineSetRangeMacro(Preset, int, CUSTOM, FINITE_VOLUMES);
  vtkGetMacro(Preset, int);
  ///@}

  ///@{
  /**
   * For the preset FINITE_VOLUMES: the target maxima of the non-orthogonality, in degrees from 1 to
   * 90, and of the skewness of faces. checkMesh warns above 70 degrees, and fails from 90 degrees
   * and above a skewness of 4. The defaults are 65 and 3.5.
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
   * @param objectiveTemplate one of Templates; DEFAULT_TEMPLATE is the dissertation's template for
   * the metric
   * @param weight above 0, for scalarizations with weights
   * @param target one of TargetTypes, as in vtkElementQuality: the ideal element, the element of
   * the mesh at port 1, the ideal shape with the size in the array at index 0, or with the metric
   * tensor in the array at index 1 (SetInputArrayToProcess; points or cells)
   */
  void AddObjective(
    int metric, int objectiveTemplate = DEFAULT_TEMPLATE, double weight = 1.0, int target = IDEAL);
  void AddObjectiveByName(const char* metric, int objectiveTemplate = DEFAULT_TEMPLATE,
    double weight = 1.0, int target = IDEAL);
  ///@}
  /// Removes all objectives. CUSTOM then minimizes the sum of squared inverse mean ratios.
  void RemoveAllObjectives();

  ///@{
  /// Sets the number of objectives; new ones are the sum of squared inverse mean ratios.
  void SetNumberOfObjectives(int count);
  int GetNumberOfObjectives() const { return this->Objectives; }
  ///@}

  ///@{
  /// The properties of individual objectives, for panels that set them separately; see
  /// AddObjective().
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
  /// The exponent p of the template P_MEAN (at least 1) and the parameter k of MAXIMUM (above 0).
  /// The default is 8.
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
  /// The combination of the corners of a cell in target metrics, as in vtkElementQuality. The
  /// default is MEAN.
  vtkTautlineSetRangeMacro(Combination, int, MEAN, POWER_MEAN);
  vtkGetMacro(Combination, int);
  ///@}

  ///@{
  /// The minimum area or volume that every element should have, for the untangling metric. The
  /// default is 0.
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
  /// The combination of several objectives into one, see tautline/Objectives/Scalarization.h. The
  /// default is EXPONENTIAL_SUM.
  vtkTautlineSetRangeMacro(Scalarization, int, EXPONENTIAL_SUM, RAO);
  vtkGetMacro(Scalarization, int);
  ///@}

  ///@{
  /// The parameter c of EXPONENTIAL_SUM, above 0; with 0, the default, it is chosen from the
  /// initial values.
  vtkSetMacro(C, double);
  vtkGetMacro(C, double);
  ///@}

  ///@{
  /**
   * Whether local algorithms combine the sums over the elements around the moving vertex instead of
   * the sums over the whole mesh, as Mesquite does by default. The objective of the whole mesh may
   * then increase. Available with EXPONENTIAL_SUM, OBJECTIVE_PRODUCT, EQUAL_SUM and WEIGHTED_SUM;
   * an error with other scalarizations and with global algorithms. The default is off.
   */
  vtkSetMacro(PatchScalarization, bool);
  vtkGetMacro(PatchScalarization, bool);
  vtkBooleanMacro(PatchScalarization, bool);
  ///@}

  ///@{
  /// The exponent p of EXPONENTIAL_WEIGHTED, above 0. The default is 1.
  vtkSetMacro(Exponent, double);
  vtkGetMacro(Exponent, double);
  ///@}

  ///@{
  /**
   * The fraction of its value by which an objective may increase while later objectives are
   * minimized (LEXICOGRAPHIC), at least 0. The default is 0.01.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * The best possible value of each objective, for WEIGHTED_MIN_MAX, EXPONENTIAL_WEIGHTED and RAO:
   * none (0 for all) or one for each objective.
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
   * The algorithm: local algorithms sweep over the points, global ones move all points at once.
   * AUTOMATIC, the default, uses LOCAL_NEWTON. If sweeps converge slowly, NEWTON_CONJUGATE_GRADIENT
   * starts from the input, or from its harmonic map if that is valid and better; if it stalls, or
   * holds points (on curved parts of the boundary of a volume or planar mesh, at limits), the two
   * alternate. If a sweep fails to reduce several objectives, LIMITED_MEMORY_BFGS continues.
   */
  vtkTautlineSetRangeMacro(Optimizer, int, AUTOMATIC, NEWTON_CONJUGATE_GRADIENT);
  vtkGetMacro(Optimizer, int);
  ///@}

  ///@{
  /// Maximum number of sweeps of local algorithms, or of iterations of global ones. The default is
  /// 300.
  vtkTautlineSetRangeMacro(MaximumIterations, int, 0, 1000000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /// Stop when the norm of the gradient has fallen by this factor; 0 means never. The default is
  /// 1e-6. Not used by NEWTON_CONJUGATE_GRADIENT.
  vtkTautlineSetRangeMacro(GradientNorm, double, 0.0, 1.0);
  vtkGetMacro(GradientNorm, double);
  ///@}

  ///@{
  /// Stop when an iteration reduces the objective by less than this fraction; 0 means never. The
  /// default is 1e-5.
  vtkTautlineSetRangeMacro(RelativeChange, double, 0.0, 1.0);
  vtkGetMacro(RelativeChange, double);
  ///@}

  ///@{
  /// "Inaccurate smoothing", section 3.4: stop when two decimals of all mean qualities no longer
  /// change. The default is off.
  vtkSetMacro(TwoDigits, bool);
  vtkGetMacro(TwoDigits, bool);
  vtkBooleanMacro(TwoDigits, bool);
  ///@}

  ///@{
  /**
   * Section 2.4: stop when this fraction of the possible reduction of the objective is reached, 0
   * to 1; 1, the default, means never. The possible reduction is the reduction to BestKnown, or an
   * estimate.
   */
  vtkTautlineSetRangeMacro(Reduction, double, 0.0, 1.0);
  vtkGetMacro(Reduction, double);
  ///@}

  ///@{
  /**
   * The objective of the completely smoothed mesh, for Reduction, in the unit of the objective; any
   * number, including 0, the optimum of untangling. It is used if UseBestKnown is on; if off, the
   * default, Reduction estimates it.
   */
  vtkSetMacro(UseBestKnown, bool);
  vtkGetMacro(UseBestKnown, bool);
  vtkBooleanMacro(UseBestKnown, bool);
  vtkSetMacro(BestKnown, double);
  vtkGetMacro(BestKnown, double);
  ///@}

  ///@{
  /// Stop when every element is valid. The default is off.
  vtkSetMacro(StopWhenValid, bool);
  vtkGetMacro(StopWhenValid, bool);
  vtkBooleanMacro(StopWhenValid, bool);
  ///@}

  ///@{
  /**
   * With the preset WORST_ELEMENT (or ImproveWorst), a surface in space or the boundary ON_SURFACE,
   * KeepFeatures and a SurfaceTolerance above 0: points of the surface near the worst elements,
   * including corners and points on curves, may leave the surface within this tolerance if sliding
   * no longer improves these elements. Points on interfaces, fixed points and points given as
   * corner or curve points (array at index 5) stay on it; with a Geometry or limits of the
   * displacement, all points do. The summary reports the number of points that left. The default is
   * on.
   */
  vtkSetMacro(LeaveSurface, bool);
  vtkGetMacro(LeaveSurface, bool);
  vtkBooleanMacro(LeaveSurface, bool);
  ///@}

  ///@{
  /**
   * The maximum displacement of a point, in the unit of the coordinates; 0 allows any distance. If
   * the point array at index 3 is chosen, it gives a limit for each point instead (negative: any
   * distance). The default is 0.
   */
  vtkTautlineSetRangeMacro(MaximumDisplacement, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumDisplacement, double);
  ///@}

  ///@{
  /// Project the points of a surface in space back to the input surface. The default is on.
  vtkSetMacro(ProjectToSurface, bool);
  vtkGetMacro(ProjectToSurface, bool);
  vtkBooleanMacro(ProjectToSurface, bool);
  ///@}

  ///@{
  /// Allow steps to invert valid elements if that reduces the objective. The default is off.
  vtkSetMacro(AllowInversion, bool);
  vtkGetMacro(AllowInversion, bool);
  vtkBooleanMacro(AllowInversion, bool);
  ///@}

  ///@{
  /**
   * Untangle an input with inverted elements first if no objective can repair it; if off, report an
   * error. The default is on.
   */
  vtkSetMacro(UntangleFirst, bool);
  vtkGetMacro(UntangleFirst, bool);
  vtkBooleanMacro(UntangleFirst, bool);
  ///@}

  ///@{
  /// Scale untangling objectives up at the start as in section 3.3.3. The default is on.
  vtkSetMacro(RescaleUntangling, bool);
  vtkGetMacro(RescaleUntangling, bool);
  vtkBooleanMacro(RescaleUntangling, bool);
  ///@}

  ///@{
  /**
   * Local algorithms skip points that moved by less than this fraction of their shortest edge; with
   * 0, none. The default is 1e-3.
   */
  vtkTautlineSetRangeMacro(Culling, double, 0.0, 1.0);
  vtkGetMacro(Culling, double);
  ///@}

  ///@{
  /// Number of steps in each patch of the local algorithms; reduced to 1 when a sweep has increased
  /// the objective. The default is 1.
  vtkTautlineSetRangeMacro(PatchIterations, int, 1, 1000);
  vtkGetMacro(PatchIterations, int);
  ///@}

  ///@{
  /// Relaxation factor of the Newton steps of LOCAL_NEWTON, from 1 to below 2. The default is 1.4.
  vtkTautlineSetRangeMacro(Relaxation, double, 1.0, 1.99);
  vtkGetMacro(Relaxation, double);
  ///@}

  ///@{
  /**
   * After the objective has converged, improve the worst element as long as the mean of the first
   * metric does not get worse by more than this fraction, or by five times this fraction if another
   * metric determines the worst element; 0, the default, means off.
   */
  vtkTautlineSetRangeMacro(ImproveWorst, double, 0.0, 1.0);
  vtkGetMacro(ImproveWorst, double);
  ///@}

  ///@{
  /**
   * The metric that determines the worst element, by its number (tautline::Metric), also for
   * presets: used by the preset WORST_ELEMENT and ImproveWorst, and for the guarantee that the
   * worst element does not get worse. -1, the default, stands for the scaled Jacobian if the worst
   * element is improved and the mesh has quadrilaterals, hexahedra or wedges, but no pyramids;
   * otherwise for the metric of the first objective.
   */
  void SetWorstMetric(int metric);
  vtkGetMacro(WorstMetric, int);
  /// Sets it by name, label or symbol; an unknown name is an error.
  void SetWorstMetricByName(const char* name);
  ///@}
  /// The metrics that were registered (vtkUserMetric, libraries): a line "number<tab>label" each.
  static std::string GetUserMetrics();

  ///@{
  /**
   * Whether the worst element of a valid input must not get worse. If off, single elements may be
   * sacrificed for a smaller objective. The default is on.
   */
  vtkSetMacro(HoldWorst, bool);
  vtkGetMacro(HoldWorst, bool);
  vtkBooleanMacro(HoldWorst, bool);
  ///@}

  ///@{
  /**
   * Whether a single process also uses the order of operations that does not depend on the
   * distribution of the mesh, which several processes use unless the mesh is gathered: the points
   * are then the same on any number of processes. The default is off.
   */
  vtkSetMacro(ReproducibleOrder, bool);
  vtkGetMacro(ReproducibleOrder, bool);
  vtkBooleanMacro(ReproducibleOrder, bool);
  ///@}

  ///@{
  /**
   * Provide the iterations as time steps: time t is the mesh after iteration t (untangling comes
   * first), so that ParaView's animation plays the optimization. Without a requested time, the
   * output is the result. The input is then used at its default time. The default is off.
   */
  vtkSetMacro(Animation, bool);
  vtkGetMacro(Animation, bool);
  vtkBooleanMacro(Animation, bool);
  ///@}

  ///@{
  /**
   * Memory for the points of the iterations in megabytes; when it is exceeded, every second
   * iteration is dropped, repeatedly. The default is 1000.
   */
  vtkTautlineSetRangeMacro(AnimationMemory, double, 1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(AnimationMemory, double);
  ///@}

  /// The table of output port 2.
  vtkTable* GetStatistics();

  ///@{
  /**
   * The results of the last execution. Numbers cover all blocks. The reason for stopping is for the
   * last block, as a sentence and as a number (enum StopReason of tautline/Core/Iteration.h, -1:
   * nothing done).
   */
  const char* GetReason() const { return this->Reason.c_str(); }
  int GetStopReason() const { return this->StopReason; }
  int GetIterations() const { return this->Iterations; }
  vtkIdType GetFreePoints() const { return this->FreePoints; }
  vtkIdType GetInvertedBefore() const { return this->InvertedBefore; }
  vtkIdType GetInvertedAfter() const { return this->InvertedAfter; }
  /// Largest distance between the surface and interfaces of the output, if points slide on them,
  /// and the surface and interfaces of the input, in both directions, or of the geometry. Measured
  /// like SurfaceTolerance.
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
  /// The first result is the input.
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
  bool HasRun(); ///< whether Runs belong to the inputs and settings
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
  /// Problems of the result, as sentences, with the most important one last.
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
  vtkTimeStamp RunTime;                                      ///< for Runs that can be shown again
  std::vector<vtkMTimeType> RunInputs;                       ///< the content of the inputs of Runs
  bool InputsChanged = true; ///< since the last execution, on any process
  int LastIteration = -1;    ///< the last one of any of Runs, on all processes; -1: none
  std::string Reason;
  int StopReason = -1;
  int Iterations = 0;
  vtkIdType FreePoints = 0;
  vtkIdType InvertedBefore = 0, InvertedAfter = 0;
  double SurfaceError = 0.0;
};

#endif
