// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshWarp
 * @brief Deforms the interior of a mesh to follow a prescribed boundary motion.
 *
 * The boundary moves by a displacement array, to a second data set, by a transform of a part of it,
 * or with the time steps of the input. The interior follows by anisotropic FEMWARP and optimization
 * of shape and validity (HYBRID, dissertation section 4.9), or by one of the other methods. The
 * connectivity does not change. An affine motion of the whole boundary is reproduced exactly,
 * except by JACOBIAN_STIFFENING, whose material is not uniform, INVERSE_DISTANCE_ROTATIONS, which
 * is exact for rigid motions, and HYBRID, which then restores the shapes of the elements.
 *
 * Supports data sets with explicit points, or blocks of these (processed separately, each with its
 * own boundary), with triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids. The
 * elements must initially be valid. A mesh reversed throughout is treated as its mirror image, and
 * so is a cell that lists its points in the opposite order of the others. In a surface in space, a
 * cell that is folded over its neighbors counts as inverted; it is untangled, but shapes are not
 * optimized. Parts without a consistent orientation, image data (implicit points), polygons and
 * polyhedra are not supported.
 *
 * @par Curved cells:
 * All methods move the corners as in linear cells. The nodes between them follow, see
 * tautline/Mesh/FollowingNodes.h, except that nodes on the boundary use their given motion: the
 * transform if it applies to all corners of their edge or face, their array values, or their
 * positions in the target or at the time step; without one they stay if these corners stay. If the
 * motion is not completed, all nodes follow. Validity is certified for the whole cell, before and
 * after; the other numbers refer to the corners. Cells that ElementType does not support (orders
 * above 6) are rejected.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) the target of its boundary (TARGET): a data set, or for a mesh of blocks
 * the same blocks or one data set for all of them; 2 (optional) a vtkSelection of the moving part
 * (MovedPart SELECTION); 3 (optional) a vtkSelection of points that stay, or cells whose points
 * stay.
 *
 * Arrays of the mesh (SetInputArrayToProcess), by index: 0 displacements (points, 3 components;
 * "Automatic", the default, is `Displacement` or the active vectors); 1 the moving part (points or
 * cells, see MovedPart); 2 points that stay (where not 0); 3 tensors (cells; 1, 3, 6 or 9
 * components); 4 regions (cells).
 *
 * @par Output port 0 `Mesh`:
 * The input with new points, the point array `Displacement` (from the mesh at rest), and the cell
 * arrays `TMP shape` (shape relative to the element at rest (4.22); 0 means the same shape) and
 * `Validity` (see vtkElementQuality). Points in single precision stay so unless rounding would make
 * a valid element invalid.
 *
 * @par Output port 1 `History`:
 * A vtkTable with a row per stage: `Amount`, `Inverted`, `Worst shape`, `Mean shape`, `Stage`
 * (text), `N iterations`, `Time (s)`; of composite data sets also `Block`.
 *
 * @par Output port 2 `Statistics`:
 * A vtkTable with a row per data set: `Block` (composite data sets), `Elements`, `Boundary points`,
 * `Moved points`, `Largest displacement`, `Amount`, `Inverted after warp`, `Inverted`, `Impossible`
 * (elements that no position of the interior makes valid), `Crossings` (pairs of boundary edges or
 * triangles that newly cross), `Worst shape`, `Mean shape`, `Worst IMR before`, `Mean IMR before`,
 * `Worst IMR`, `Mean IMR` (inverse mean ratio, over the valid and inverted elements; an inverted
 * element is the worst), `Cxx` ... `Cxz` (the coefficients), `Decoupled`, `Regularization`,
 * `Reused` (1: matrices of the previous run), `Assemble (s)`, `Set-up (s)`, `Solve (s)`, `Improve
 * (s)`, `Total (s)`.
 *
 * @par Repeated executions:
 * Matrices and factorizations are kept as long as the mesh, the prescribed points and the options
 * of the method do not change: animating Amount, or a target over time, computes them once.
 *
 * @par Several processes:
 * Each process works on its piece. The points equal the serial result to rounding or the tolerance
 * of the linear solver. If a method untangles or optimizes (HYBRID, FEMWARP_UNTANGLING), the order
 * differs from one process: the elements are equally valid, and the points do not depend on the
 * number of processes or the pieces. If the moved boundary itself inverts elements, the number of
 * inverted elements and the points may depend on both. Matrices are not kept.
 *
 * For a motion over time, each process keeps its piece at the first time step and, with
 * PREVIOUS_STEP, its points at the time steps from which others start. If the points or cells of
 * the pieces change over time, the mesh is gathered from then on, which requires global ids.
 *
 * For a motion to a target, both are gathered on the first process. Their points correspond as on
 * one process, in the order of the global ids of mesh and target, which must be ids of the same
 * mesh; without ids, a correspondence by order is an error, unless both are entirely on one
 * process.
 *
 * With blocks, inclined planes, cells that list their points in opposite orders and coordinates of
 * extreme size, the first process has the whole mesh while it computes and sends the results to the
 * pieces; the summary states why. Ghost cells count as copies; on one process, their points stay.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMeshWarp> warp;
 * warp->SetInputConnection(reader->GetOutputPort());
 * warp->SetMotion(vtkMeshWarp::TRANSFORM);
 * warp->SetTransformKind(vtkMeshWarp::ROTATION);
 * warp->SetAngle(60); // the inner boundaries, about their middle
 * warp->Update();
 * std::cout << warp->GetSummary();
 * @endcode
 *
 * @sa vtkMeshUntangler, vtkMeshOptimizer, tautline/Deformation/Warp.h,
 * tautline/Deformation/PointMotion.h
 */

#ifndef vtkMeshWarp_h
#define vtkMeshWarp_h

#include "TautlineDeformationModule.h" // for export macro
#include "vtkMeshMotionAlgorithm.h"
#include "vtkSmartPointer.h"     // for Transform
#include "vtkTautlineSetRange.h" // for the setters

#include <array>  // for RegionCoefficients
#include <memory> // for Session
#include <string> // for TargetIds
#include <vector> // for lists

class vtkLinearTransform;

namespace tautline
{
class WarpSession;
struct WarpSettings;
}

class TAUTLINEDEFORMATION_EXPORT vtkMeshWarp : public vtkMeshMotionAlgorithm
{
public:
  static vtkMeshWarp* New();
  vtkTypeMacro(vtkMeshWarp, vtkMeshMotionAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Motions
  {
    DISPLACEMENT = 0, ///< the array at index 0
    TARGET = 1,       ///< the data set at port 1
    TRANSFORM = 2,    ///< TransformKind, of MovedPart
    TIME_STEPS = 3    ///< the input's boundary at each time; the interior starts from the first
  };
  ///@{
  /// The motion of the boundary. The default is TRANSFORM.
  vtkTautlineSetRangeMacro(Motion, int, DISPLACEMENT, TIME_STEPS);
  vtkGetMacro(Motion, int);
  ///@}

  ///@{
  /**
   * The fraction of the motion, along its path: 0 gives the input (bitwise), 1 the whole motion,
   * and values above 1 extrapolate. At least 0. The default is 1.
   */
  vtkTautlineSetRangeMacro(Amount, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Amount, double);
  ///@}

  ///@{
  /**
   * Provide the path as time steps, from time 0, the mesh at rest, to time 1, the Amount, so that
   * ParaView's animation plays the motion; AnimationSteps is the number of steps, 1 to 100,000.
   * Without a requested time, the output is for time 1. An input or target with its own time steps
   * keeps them, and the Amount applies at all times. The defaults are off and 20.
   */
  vtkSetMacro(Animation, bool);
  vtkGetMacro(Animation, bool);
  vtkBooleanMacro(Animation, bool);
  vtkTautlineSetRangeMacro(AnimationSteps, int, 1, 100000);
  vtkGetMacro(AnimationSteps, int);
  ///@}

  enum Correspondences
  {
    AUTOMATIC_MATCH = 0, ///< the first one below that fits; point ids if an array is named
    SAME_MESH = 1,       ///< the points of the mesh, in the same order
    SAME_BOUNDARY = 2,   ///< moving points, in order; or numbered as by Extract Surface
    POINT_IDS = 3,       ///< SetTargetIds()
    CLOSEST_POINT = 4    ///< projection to the nearest point of the surface (curve)
  };
  ///@{
  /// The correspondence between points of the target and the mesh. The default is AUTOMATIC_MATCH;
  /// the summary names the choice.
  vtkTautlineSetRangeMacro(Correspondence, int, AUTOMATIC_MATCH, CLOSEST_POINT);
  vtkGetMacro(Correspondence, int);
  ///@}

  ///@{
  /**
   * A point array of the target: values of the mesh's point array of the same name, or indices of
   * the mesh's points. "" or "None", the default, means none.
   */
  void SetTargetIds(const char* name);
  const char* GetTargetIds() const { return this->TargetIds.c_str(); }
  ///@}

  enum MovedParts
  {
    AUTOMATIC_PART = 0, ///< INNER_BOUNDARIES; WHOLE_BOUNDARY for a target with all points
    WHOLE_BOUNDARY = 1,
    INNER_BOUNDARIES = 2, ///< all but the outer boundary; all if there is no other
    NUMBERED_PARTS = 3,   ///< AddPart(), numbered by size; 1 is the largest
    ARRAY_VALUES = 4,     ///< where the array at index 1 is not 0, or one of AddValue()
    SELECTION = 5         ///< points at port 2, or points of cells
  };
  ///@{
  /**
   * The part of the boundary that moves, by a transform or to a target; the rest of it stays. For
   * values and selections, only points on the boundary count. The default is AUTOMATIC_PART.
   */
  vtkTautlineSetRangeMacro(MovedPart, int, AUTOMATIC_PART, SELECTION);
  vtkGetMacro(MovedPart, int);
  ///@}

  ///@{
  /// Numbers of connected parts of the boundary, from 1, ordered by the size of their bounding box,
  /// the largest first.
  void AddPart(int number);
  void RemoveAllParts();
  ///@}

  ///@{
  /// Values of the array at index 1 that select moving points; if none are given, all except 0.
  void AddValue(double value);
  void RemoveAllValues();
  ///@}

  enum TransformKinds
  {
    MATRIX = 0,      ///< SetTransform(); along a screw motion
    TRANSLATION = 1, ///< SetTranslation()
    ROTATION = 2,    ///< SetAngle(), SetAxis(), center; along an arc
    SCALING = 3,     ///< SetScaleFactors(), center
    BENDING = 4      ///< SetAngle(), SetAxis(), SetDirection(), center: see tautline::MotionKind
  };
  ///@{
  /// The default is MATRIX.
  vtkTautlineSetRangeMacro(TransformKind, int, MATRIX, BENDING);
  vtkGetMacro(TransformKind, int);
  ///@}

  ///@{
  /// An affine transform without reflection; null, the default, is the identity.
  void SetTransform(vtkLinearTransform* transform);
  vtkLinearTransform* GetTransform();
  ///@}

  ///@{
  /// The default is 0 0 0.
  vtkSetVector3Macro(Translation, double);
  vtkGetVector3Macro(Translation, double);
  ///@}

  ///@{
  /// The angle in degrees; may exceed a full turn. The default is 0.
  vtkSetMacro(Angle, double);
  vtkGetMacro(Angle, double);
  ///@}

  ///@{
  /// The axis of rotation and bending; the default is 0 0 1.
  vtkSetVector3Macro(Axis, double);
  vtkGetVector3Macro(Axis, double);
  ///@}

  ///@{
  /// The factors along x, y and z, above 0. The default is 1 1 1.
  vtkSetVector3Macro(ScaleFactors, double);
  vtkGetVector3Macro(ScaleFactors, double);
  ///@}

  ///@{
  /// The direction along the bar to bend, from its fixed end. The default is 1 0 0.
  vtkSetVector3Macro(Direction, double);
  vtkGetVector3Macro(Direction, double);
  ///@}

  ///@{
  /// Whether the center is the middle of the bounding box of the moving points, instead of Center.
  /// The default is on.
  vtkSetMacro(OwnCenter, bool);
  vtkGetMacro(OwnCenter, bool);
  vtkBooleanMacro(OwnCenter, bool);
  ///@}

  ///@{
  /// The default is 0 0 0.
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  enum StartsFrom
  {
    FIRST_STEP = 0,   ///< the result at a time does not depend on other times
    PREVIOUS_STEP = 1 ///< each time step starts from the previous one
  };
  ///@{
  /**
   * The mesh from which a time step is warped, if the input or the target has several. Either way
   * the result at a time does not depend on the order in which times are requested. The default is
   * FIRST_STEP.
   */
  vtkTautlineSetRangeMacro(StartFrom, int, FIRST_STEP, PREVIOUS_STEP);
  vtkGetMacro(StartFrom, int);
  ///@}

  enum Methods
  {
    HYBRID = 0,
    FEMWARP = 1,
    ANISOTROPIC_FEMWARP = 2,
    SMALL_STEP_FEMWARP = 3,
    FEMWARP_UNTANGLING = 4,
    ITERATIVE_STIFFENING = 5,
    JACOBIAN_STIFFENING = 6,
    BIHARMONIC = 7,
    INVERSE_DISTANCE = 8,
    RADIAL_BASIS = 9,
    WEIGHTED_LAPLACIAN = 10,
    INVERSE_DISTANCE_ROTATIONS = 11,
    AUTOMATIC = 12 ///< chosen by the motion; the summary gives the reason
  };
  ///@{
  /// The method that moves the interior, see tautline::WarpMethod. The default is HYBRID.
  vtkTautlineSetRangeMacro(Method, int, HYBRID, AUTOMATIC);
  vtkGetMacro(Method, int);
  ///@}

  enum CoefficientChoices
  {
    DISPLACEMENT_SUMS = 0,    ///< (4.19), (4.21)
    PRINCIPAL_DIRECTIONS = 1, ///< the same along the principal directions of the motion
    MANUAL = 2,               ///< SetTensor()
    PER_CELL = 3,             ///< the array at index 3
    PER_REGION = 4,     ///< AddRegion() by the array at index 4, SetTensor() for all other regions
    LOCAL_GRADIENTS = 5 ///< a tensor per cell, from the displacements of a first solve
  };
  ///@{
  /// The coefficients of HYBRID and ANISOTROPIC_FEMWARP. The default is DISPLACEMENT_SUMS.
  vtkTautlineSetRangeMacro(Coefficients, int, DISPLACEMENT_SUMS, LOCAL_GRADIENTS);
  vtkGetMacro(Coefficients, int);
  ///@}

  ///@{
  /// xx yy zz xy yz xz, positive semidefinite; the default is the identity.
  vtkSetVector6Macro(Tensor, double);
  vtkGetVector6Macro(Tensor, double);
  ///@}

  ///@{
  /// alpha, beta and gamma (at least 0) of the cells where the array at index 4 is `region`.
  void AddRegion(double region, double alpha, double beta, double gamma);
  void RemoveAllRegions();
  ///@}

  ///@{
  /**
   * Number of steps of the motion: 0 (and 1 for SMALL_STEP_FEMWARP) means as many as needed so that
   * no element inverts, up to MaximumSteps. Steps of a transform follow its path. The defaults are
   * 1 and 100.
   */
  vtkTautlineSetRangeMacro(Steps, int, 0, 10000);
  vtkGetMacro(Steps, int);
  vtkTautlineSetRangeMacro(MaximumSteps, int, 1, 10000);
  vtkGetMacro(MaximumSteps, int);
  ///@}

  ///@{
  /**
   * Choose the solver by the size of the mesh (on, the default), or use Solver and Preconditioner:
   * the values of tautline::KrylovMethod (0 conjugate gradients, ..., 4 direct) and
   * tautline::Preconditioner (0 Jacobi, 1 SSOR, 2 ILU, 3 BoomerAMG, ...); the defaults are 0 and 3.
   */
  vtkSetMacro(AutomaticSolver, bool);
  vtkGetMacro(AutomaticSolver, bool);
  vtkBooleanMacro(AutomaticSolver, bool);
  vtkTautlineSetRangeMacro(Solver, int, 0, 4);
  vtkGetMacro(Solver, int);
  vtkTautlineSetRangeMacro(Preconditioner, int, 0, 6);
  vtkGetMacro(Preconditioner, int);
  ///@}

  ///@{
  /// Relative tolerance of the residual, 0 to 1. The default is 1e-10.
  vtkTautlineSetRangeMacro(Tolerance, double, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Poisson's ratio of the elastic methods, -1 to 0.5 (exclusive). The default is 0.3.
  vtkSetMacro(PoissonRatio, double);
  vtkGetMacro(PoissonRatio, double);
  ///@}

  ///@{
  /**
   * JACOBIAN_STIFFENING: the stiffness of an element is its size to the power of minus this number;
   * at least 0, the default is 1. ITERATIVE_STIFFENING: the factor (above 1, default 2) by which
   * inverted elements become stiffer, and the maximum number of times (default 50).
   */
  vtkTautlineSetRangeMacro(StiffeningPower, double, 0.0, 10.0);
  vtkGetMacro(StiffeningPower, double);
  vtkTautlineSetRangeMacro(StiffeningFactor, double, 1.0, 1e6);
  vtkGetMacro(StiffeningFactor, double);
  vtkTautlineSetRangeMacro(MaximumStiffenings, int, 0, 10000);
  vtkGetMacro(MaximumStiffenings, int);
  ///@}

  ///@{
  /// INVERSE_DISTANCE: the power of the distance, above 0 to 20. The default is 3.
  vtkSetMacro(DistancePower, double);
  vtkGetMacro(DistancePower, double);
  ///@}

  ///@{
  /**
   * RADIAL_BASIS: the radius of the functions (0, the default: automatic) and the tolerance at the
   * boundary, relative to the smallest height of the cells at each of its points (default 1e-2).
   */
  vtkTautlineSetRangeMacro(SupportRadius, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SupportRadius, double);
  vtkTautlineSetRangeMacro(FitTolerance, double, 0.0, 1.0);
  vtkGetMacro(FitTolerance, double);
  ///@}

  ///@{
  /**
   * HYBRID: whether to untangle before the optimization of shape, which then keeps every element
   * valid; otherwise uses the objective (4.24), with this beta (relative to the mean element, at
   * least 0) in its untangling metric, the automatic optimizer and c; remaining inverted elements
   * are untangled afterwards. The defaults are on and 0.
   */
  vtkSetMacro(UntangleFirst, bool);
  vtkGetMacro(UntangleFirst, bool);
  vtkBooleanMacro(UntangleFirst, bool);
  vtkTautlineSetRangeMacro(UntanglingBeta, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(UntanglingBeta, double);
  ///@}

  ///@{
  /// HYBRID: maximum number of iterations of the shape optimization. The default is 50.
  vtkTautlineSetRangeMacro(MaximumIterations, int, 0, 1000000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  /// The table of output port 2.
  vtkTable* GetStatistics();

  ///@{
  /// The results of the last execution, over all blocks; the names are as in the statistics.
  vtkIdType GetInvertedAfterWarp() const { return this->InvertedAfterWarp; }
  vtkIdType GetInverted() const { return this->Inverted; }
  vtkIdType GetImpossible() const { return this->Impossible; }
  double GetWorstShape() const { return this->WorstShape; }
  /// The number of blocks that reused matrices of the previous run.
  int GetReused() const { return this->Reused; }
  ///@}

  /// Includes the modification time of the transform.
  vtkMTimeType GetMTime() override;

protected:
  vtkMeshWarp();
  ~vtkMeshWarp() override;

  /// A target is not reduced to one side: if there is one, a layer is treated as a volume mesh.
  bool TreatsLayers() override { return this->PlanarLayers && this->Motion != TARGET; }

  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  /// The first result is the input.
  bool KeepsBest() const override { return true; }
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  /// True while time steps before the requested one are processed.
  bool ExecutesAgain() const override;
  tautline::GatheredRules GetGatheredRules() override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  /// Over time, partitions are joined only by global ids, because positions change.
  void ClearResult() override;

  tautline::WarpSettings GetSettings();
  tautline::WarpSession& GetSession() { return *this->Session; }

private:
  vtkMeshWarp(const vtkMeshWarp&) = delete;
  void operator=(const vtkMeshWarp&) = delete;

  void ClearNumbers();
  /// Whether the requested time is a fraction of the path.
  bool PlaysMotion(const std::vector<double>& times) const;

  int Motion = TRANSFORM;
  double Amount = 1.0;
  bool Animation = false;
  int AnimationSteps = 20;
  int Correspondence = AUTOMATIC_MATCH;
  std::string TargetIds;
  int MovedPart = AUTOMATIC_PART;
  std::vector<int> Parts;
  std::vector<double> Values;
  int TransformKind = MATRIX;
  vtkSmartPointer<vtkLinearTransform> Transform;
  double Translation[3] = { 0, 0, 0 };
  double Angle = 0.0;
  double Axis[3] = { 0, 0, 1 };
  double ScaleFactors[3] = { 1, 1, 1 };
  double Direction[3] = { 1, 0, 0 };
  bool OwnCenter = true;
  double Center[3] = { 0, 0, 0 };
  int StartFrom = FIRST_STEP;
  int Method = HYBRID;
  int Coefficients = DISPLACEMENT_SUMS;
  double Tensor[6] = { 1, 1, 1, 0, 0, 0 };
  std::vector<std::array<double, 4>> Regions; ///< value, alpha, beta, gamma
  int Steps = 1;
  int MaximumSteps = 100;
  bool AutomaticSolver = true;
  int Solver = 0;
  int Preconditioner = 3;
  double Tolerance = 1e-10;
  double PoissonRatio = 0.3;
  double StiffeningPower = 1.0;
  double StiffeningFactor = 2.0;
  int MaximumStiffenings = 50;
  double DistancePower = 3.0;
  double SupportRadius = 0.0;
  double FitTolerance = 1e-2;
  bool UntangleFirst = true;
  double UntanglingBeta = 0.0;
  int MaximumIterations = 50;

  std::unique_ptr<tautline::WarpSession> Session; ///< data kept between executions
  vtkIdType InvertedAfterWarp = 0;
  vtkIdType Inverted = 0;
  vtkIdType Impossible = 0;
  double WorstShape = 0.0;
  int Reused = 0;
};

#endif
