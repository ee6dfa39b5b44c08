// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshWarp
 * @brief Deforms the interior of a mesh to follow a prescribed boundary motion.
 *
 * The boundary moves by a displacement array, to a second data set, by a transform of a part of it,
 * or as it does over the time steps of the input. The interior follows by anisotropic FEMWARP and
 * the optimization of shape and validity (HYBRID, dissertation section 4.9) or by one of the
 * methods this is compared with. The connectivity stays. An affine motion of the whole boundary
 * comes out exactly, except by JACOBIAN_STIFFENING, whose material is not uniform,
 * INVERSE_DISTANCE_ROTATIONS, which is exact for rigid motions, and HYBRID, which then restores the
 * shapes of the elements.
 *
 * Takes data sets with explicit points, or blocks of these (one after the other, each with its own
 * boundary): triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids. The elements
 * must be valid to begin with. A mesh reversed throughout is treated as its mirror image, and so is
 * a cell that lists its points in the opposite order of the others. Of a surface in space, a cell
 * that is folded over those around counts as inverted; it is untangled, but its shapes are not
 * optimized. Parts without a consistent orientation, image data (implicit points), polygons and
 * polyhedra are refused.
 *
 * @par Curved cells:
 * Corners move as those of linear cells by all methods. The nodes between them follow, see
 * tautline/Mesh/FollowingNodes.h, but nodes on the boundary have the motion that is given for them:
 * by the transform if all corners of their edge or face have it, by their values of the array, by
 * their places in the target or at the time step; without one they stay if these corners do. Where
 * the motion is not completed, they all follow. Validity is certified for the whole cell, before
 * and after; the other numbers refer to the corners. Cells that ElementType does not support
 * (orders above 6) are refused.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) where its boundary goes (TARGET): a data set, or for a mesh of blocks
 * one of the same blocks or one for all of them; 2 (optional) a vtkSelection of what moves
 * (MovedPart SELECTION); 3 (optional) a vtkSelection of points that stay, or cells whose points
 * stay.
 *
 * Arrays of the mesh (SetInputArrayToProcess), by index: 0 displacements (points, 3 components;
 * "Automatic", the default, is `Displacement` or the active vectors); 1 what moves (points or
 * cells, see MovedPart); 2 points that stay (not 0); 3 tensors (cells; 1, 3, 6 or 9 components); 4
 * regions (cells).
 *
 * @par Output port 0 `Mesh`:
 * The input with new points, the point array `Displacement` (from the mesh at rest), and the cell
 * arrays `TMP shape` (similarity to the element at rest (4.22), 0 is the same shape) and `Validity`
 * (see vtkElementQuality). Points in single precision stay so unless a valid element would not be
 * valid when rounded.
 *
 * @par Output port 1 `History`:
 * A vtkTable with a row per stage of the work: `Amount`, `Inverted`, `Worst shape`, `Mean shape`,
 * `Stage` (text), `N iterations`, `Time (s)`; of composite data sets also `Block`.
 *
 * @par Output port 2 `Statistics`:
 * A vtkTable with a row per data set: `Block` (composite data sets), `Elements`, `Boundary points`,
 * `Moved points`, `Largest displacement`, `Amount`, `Inverted after warp`, `Inverted`, `Impossible`
 * (elements no place of the interior makes valid), `Crossings` (pairs of boundary edges or
 * triangles that cross and did not), `Worst shape`, `Mean shape`, `Worst IMR before`, `Mean IMR
 * before`, `Worst IMR`, `Mean IMR` (inverse mean ratio; of the valid and the inverted elements, an
 * inverted one is the worst), `Cxx` ... `Cxz` (the coefficients), `Decoupled`, `Regularization`,
 * `Reused` (1: matrices of the run before), `Assemble (s)`, `Set-up (s)`, `Solve (s)`, `Improve
 * (s)`, `Total (s)`.
 *
 * @par Again and again:
 * Matrices and factorizations are kept as long as the mesh, the points that are given and the
 * options of the method are the same: animating Amount, or a target over time, computes them once.
 *
 * @par Several processes:
 * Each process works on its piece. The points are those of one process, to rounding or the
 * tolerance of the linear solver; where a method untangles or optimizes (HYBRID,
 * FEMWARP_UNTANGLING) the order is another than on one process, the elements are as valid, and the
 * points do not depend on the number of processes and the pieces. Not so where the moved boundary
 * itself inverts elements: how many stay inverted, and the points, may depend on both. Matrices are
 * not kept.
 *
 * Of a motion over time each process keeps its piece at the first time step and, with
 * PREVIOUS_STEP, its points at the time steps that others start from. Where the pieces have other
 * points or cells than at the first time step, the mesh is gathered from then on, and needs global
 * ids.
 *
 * A motion to a target gathers both on the first process. Their points correspond as on one
 * process, in the order of the global ids of mesh and target, which have to be those of one mesh;
 * without ids, what corresponds by its order is an error, unless all of both is on one process.
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
    TIME_STEPS =
      3 ///< where the boundary of the input is at each time; the interior is that of the first
  };
  ///@{
  /// How the boundary moves. The default is TRANSFORM.
  vtkTautlineSetRangeMacro(Motion, int, DISPLACEMENT, TIME_STEPS);
  vtkGetMacro(Motion, int);
  ///@}

  ///@{
  /**
   * How much of the motion, along its path: 0 is the input (bitwise), 1 all; above 1 it is
   * extrapolated. At least 0. The default is 1.
   */
  vtkTautlineSetRangeMacro(Amount, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Amount, double);
  ///@}

  ///@{
  /**
   * Give the way as time steps, from time 0, the mesh at rest, to time 1, the Amount, so that
   * ParaView's animation plays the motion; AnimationSteps is the number of steps, 1 to 100,000.
   * Without a request for a time, the output is that of time 1. Input or target with time steps of
   * their own keep these, and the Amount is that of all times. The defaults are off and 20.
   */
  vtkSetMacro(Animation, bool);
  vtkGetMacro(Animation, bool);
  vtkBooleanMacro(Animation, bool);
  vtkTautlineSetRangeMacro(AnimationSteps, int, 1, 100000);
  vtkGetMacro(AnimationSteps, int);
  ///@}

  enum Correspondences
  {
    AUTOMATIC_MATCH = 0, ///< the first below that fits; point ids if an array is named
    SAME_MESH = 1,       ///< as many points as the mesh, in the same order
    SAME_BOUNDARY = 2,   ///< points that move, in order; or as Extract Surface numbers them
    POINT_IDS = 3,       ///< SetTargetIds()
    CLOSEST_POINT = 4    ///< projection to the nearest point of the surface (curve)
  };
  ///@{
  /// Which point of the target corresponds to which point of the mesh. The default is
  /// AUTOMATIC_MATCH; the summary names it.
  vtkTautlineSetRangeMacro(Correspondence, int, AUTOMATIC_MATCH, CLOSEST_POINT);
  vtkGetMacro(Correspondence, int);
  ///@}

  ///@{
  /**
   * A point array of the target: values of the mesh's point array of the same name, or numbers of
   * the mesh's points. "" or "None", the default, is none.
   */
  void SetTargetIds(const char* name);
  const char* GetTargetIds() const { return this->TargetIds.c_str(); }
  ///@}

  enum MovedParts
  {
    AUTOMATIC_PART =
      0, ///< INNER_BOUNDARIES; for a target with a place for each point WHOLE_BOUNDARY
    WHOLE_BOUNDARY = 1,
    INNER_BOUNDARIES = 2, ///< all but the outer boundary; all if there is nothing else
    NUMBERED_PARTS = 3,   ///< AddPart(), numbered by size; 1 is the largest
    ARRAY_VALUES = 4,     ///< where the array at index 1 is not 0, or one of AddValue()
    SELECTION = 5         ///< points at port 2, or points of cells
  };
  ///@{
  /**
   * Which part of the boundary moves, by a transform or to a target; the rest of it stays. Of
   * values and selections the points on the boundary count. The default is AUTOMATIC_PART.
   */
  vtkTautlineSetRangeMacro(MovedPart, int, AUTOMATIC_PART, SELECTION);
  vtkGetMacro(MovedPart, int);
  ///@}

  ///@{
  /// Connected parts of the boundary, from 1, by the size of the box around them, the largest
  /// first.
  void AddPart(int number);
  void RemoveAllParts();
  ///@}

  ///@{
  /// Values of the array at index 1 that move; none: all but 0.
  void AddValue(double value);
  void RemoveAllValues();
  ///@}

  enum TransformKinds
  {
    MATRIX = 0,      ///< SetTransform(); turns and shifts along a screw
    TRANSLATION = 1, ///< SetTranslation()
    ROTATION = 2,    ///< SetAngle(), SetAxis(), centre; along an arc
    SCALING = 3,     ///< SetScaleFactors(), centre
    BENDING = 4      ///< SetAngle(), SetAxis(), SetDirection(), centre: see tautline::MotionKind
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
  /// Degrees; may go beyond a full turn. The default is 0.
  vtkSetMacro(Angle, double);
  vtkGetMacro(Angle, double);
  ///@}

  ///@{
  /// Of rotation and bending; the default is 0 0 1.
  vtkSetVector3Macro(Axis, double);
  vtkGetVector3Macro(Axis, double);
  ///@}

  ///@{
  /// Along x, y and z, above 0. The default is 1 1 1.
  vtkSetVector3Macro(ScaleFactors, double);
  vtkGetVector3Macro(ScaleFactors, double);
  ///@}

  ///@{
  /// Along the bar to bend, from the end that is held. The default is 1 0 0.
  vtkSetVector3Macro(Direction, double);
  vtkGetVector3Macro(Direction, double);
  ///@}

  ///@{
  /// Whether the centre is the middle of the box around the points that move, not Center. The
  /// default is on.
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
    PREVIOUS_STEP = 1 ///< each time step starts from the one before
  };
  ///@{
  /**
   * From which mesh a time step is warped, if the input or the target has several. Either way the
   * result at a time is the same in whatever order times are requested. The default is FIRST_STEP.
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
    AUTOMATIC = 12 ///< chooses by the motion; the summary states what and why
  };
  ///@{
  /// How the interior follows, see tautline::WarpMethod. The default is HYBRID.
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
   * Steps the motion is cut into: 0 (and 1 of SMALL_STEP_FEMWARP) is as many as are needed for no
   * element to invert, up to MaximumSteps. Steps of a transform follow its path. The defaults are 1
   * and 100.
   */
  vtkTautlineSetRangeMacro(Steps, int, 0, 10000);
  vtkGetMacro(Steps, int);
  vtkTautlineSetRangeMacro(MaximumSteps, int, 1, 10000);
  vtkGetMacro(MaximumSteps, int);
  ///@}

  ///@{
  /**
   * Choose the solver by the size of the mesh (on, the default), or take Solver and
   * Preconditioner: the numbers of tautline::KrylovMethod (0 conjugate gradients, ..., 4 direct)
   * and tautline::Preconditioner (0 Jacobi, 1 SSOR, 2 ILU, 3 BoomerAMG, ...); the defaults are 0
   * and 3.
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
  /// Of the residual, relative; 0 to 1. The default is 1e-10.
  vtkTautlineSetRangeMacro(Tolerance, double, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Of the elastic methods; -1 to 0.5 (exclusive). The default is 0.3.
  vtkSetMacro(PoissonRatio, double);
  vtkGetMacro(PoissonRatio, double);
  ///@}

  ///@{
  /**
   * JACOBIAN_STIFFENING: power of the element's size its stiffness falls by; at least 0, the
   * default is 1. ITERATIVE_STIFFENING: by what factor (above 1, default 2) inverted elements get
   * stiffer, how often at most (default 50).
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
   * RADIAL_BASIS: the radius of the functions (0, the default: chosen) and how well the boundary is
   * met, relative to the smallest height of the cells at each of its points (default 1e-2).
   */
  vtkTautlineSetRangeMacro(SupportRadius, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SupportRadius, double);
  vtkTautlineSetRangeMacro(FitTolerance, double, 0.0, 1.0);
  vtkGetMacro(FitTolerance, double);
  ///@}

  ///@{
  /**
   * HYBRID: whether to untangle before the optimization of shape, which then keeps every element
   * valid; else the objective (4.24), with this beta (relative to the mean element, at least 0) in
   * its untangling metric, the automatic optimizer and c; what this leaves inverted is
   * untangled afterwards. The defaults are on and 0.
   */
  vtkSetMacro(UntangleFirst, bool);
  vtkGetMacro(UntangleFirst, bool);
  vtkBooleanMacro(UntangleFirst, bool);
  vtkTautlineSetRangeMacro(UntanglingBeta, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(UntanglingBeta, double);
  ///@}

  ///@{
  /// HYBRID: maximum number of iterations of the optimization of shape. The default is 50.
  vtkTautlineSetRangeMacro(MaximumIterations, int, 0, 1000000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  /// The table of output port 2.
  vtkTable* GetStatistics();

  ///@{
  /// The result of the last execution, of all blocks together; the names are those of the
  /// statistics.
  vtkIdType GetInvertedAfterWarp() const { return this->InvertedAfterWarp; }
  vtkIdType GetInverted() const { return this->Inverted; }
  vtkIdType GetImpossible() const { return this->Impossible; }
  double GetWorstShape() const { return this->WorstShape; }
  /// How many blocks took up matrices of the run before.
  int GetReused() const { return this->Reused; }
  ///@}

  /// Includes that of the transform.
  vtkMTimeType GetMTime() override;

protected:
  vtkMeshWarp();
  ~vtkMeshWarp() override;

  /// A target is not reduced to a side: with one, a layer is a mesh of volumes.
  bool TreatsLayers() override { return this->PlanarLayers && this->Motion != TARGET; }

  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  /// The input, at first.
  bool KeepsBest() const override { return true; }
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  /// While time steps before the one requested are taken.
  bool ExecutesAgain() const override;
  tautline::GatheredRules GetGatheredRules() override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  /// Over time partitions are joined by global ids only: their places change.
  void ClearResult() override;

  tautline::WarpSettings GetSettings();
  tautline::WarpSession& GetSession() { return *this->Session; }

private:
  vtkMeshWarp(const vtkMeshWarp&) = delete;
  void operator=(const vtkMeshWarp&) = delete;

  void ClearNumbers();
  /// Whether the time of a request is a fraction of the way.
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

  std::unique_ptr<tautline::WarpSession> Session; ///< what is kept between executions
  vtkIdType InvertedAfterWarp = 0;
  vtkIdType Inverted = 0;
  vtkIdType Impossible = 0;
  double WorstShape = 0.0;
  int Reused = 0;
};

#endif
