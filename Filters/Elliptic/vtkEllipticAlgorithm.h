// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkEllipticAlgorithm
 * @brief Base class of filters for elliptic partial differential equations; defines the boundary
 * value problem.
 *
 * Abstract. The boundary value problem of dissertation section 2.2, discretized by finite elements
 * of linear cells, or of quadratic triangles and tetrahedra, which may be curved, on the mesh at
 * input port 0. Input port 1 (optional) is a vtkSelection of points, or of cells whose points
 * count, where the solution is given.
 *
 * Coincident points on matching facets, for example on the seams of a mesh in pieces, are treated
 * as one point by default (MergeCoincidentPoints); the output has all points of the input, with
 * equal values at merged points. Each block of a multiblock data set is a separate mesh, unless
 * there is a seam between blocks; the partitions of a partitioned data set are one mesh. With
 * several MPI processes (pvserver, pvbatch) the parts of all processes are one mesh, which is
 * solved jointly; ghost cells are left out. Points on several processes are identified by their
 * global ids if the mesh has them, otherwise by equal coordinates. Tables are on process 0.
 *
 * Output port 0 is the mesh with point and cell data, port 1 a vtkTable. The following inputs are
 * rejected with an error: inverted and degenerate elements, duplicate cells, coincident facets that
 * cannot be merged, polygons, polyhedra, cells of higher order except quadratic triangles and
 * tetrahedra, a mixture of these and linear cells, cells without a consistent orientation, parts
 * without a point where the solution is given, and values and coefficients that are not finite.
 *
 * Arrays (SetInputArrayToProcess), by index: 0 fixed points (point or cell array), 1 source, 2
 * given values (point arrays), 3 tensors, 4 factors of the stiffness (cell arrays); "None" or not
 * set: none.
 *
 * Expressions can use the variables x, y, z and point arrays by name, as in ParaView's Calculator:
 * sin(x)*exp(-y), "my array"/2, if(x<0.5, 1, 2); vectors are written 2*iHat - x*jHat.
 *
 * @sa vtkEllipticSolver, vtkConditionEstimator, vtkSolverStudy, tautline/Elliptic/EllipticProblem.h
 */

#ifndef vtkEllipticAlgorithm_h
#define vtkEllipticAlgorithm_h

#include "TautlineEllipticModule.h" // for export macro
#include "vtkTautlineSetRange.h"    // for the setters
#include "vtkTautlineTimedAlgorithm.h"

#include <functional> // for Cancelled()
#include <memory>     // for systems that are kept
#include <string>     // for expressions
#include <vector>

namespace tautline
{
class EllipticInput;
class RankGroup;
class TableRows;
struct EllipticChoice;
struct LocalMesh;
}

class TAUTLINEELLIPTIC_EXPORT vtkEllipticAlgorithm : public vtkTautlineTimedAlgorithm
{
public:
  vtkTypeMacro(vtkEllipticAlgorithm, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The equations; values as in tautline::Pde.
  enum Equations
  {
    POISSON = 0,
    ELLIPTIC = 1,
    ELASTICITY = 2
  };
  ///@{
  /**
   * POISSON, -laplace u = f (the default); ELLIPTIC, -alpha u_xx - beta u_yy - gamma u_zz + a u =
   * f; ELASTICITY, -div(lambda (div u) I + 2 mu eps(u)) = f.
   */
  vtkTautlineSetRangeMacro(Equation, int, POISSON, ELASTICITY);
  vtkGetMacro(Equation, int);
  ///@}

  ///@{
  /**
   * Whether to treat points with the same coordinates on matching facets as one, and blocks with a
   * seam between them as one mesh; switch it off for cracks and contacts. The default is on. See
   * tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /// Coefficients of ELLIPTIC, at least 0. The default is 1 each; gamma applies to volumes. Array 3
  /// replaces them.
  vtkSetMacro(Alpha, double);
  vtkGetMacro(Alpha, double);
  vtkSetMacro(Beta, double);
  vtkGetMacro(Beta, double);
  vtkSetMacro(Gamma, double);
  vtkGetMacro(Gamma, double);
  ///@}

  ///@{
  /// The coefficient a of ELLIPTIC. The default is 1. If it is negative, the matrix may be
  /// indefinite: use MINRES or GMRES.
  vtkSetMacro(Reaction, double);
  vtkGetMacro(Reaction, double);
  ///@}

  ///@{
  /// Young's modulus E of ELASTICITY, above 0, in the unit of stress. The default is 1. Array 4 has
  /// factors of it.
  vtkSetMacro(YoungsModulus, double);
  vtkGetMacro(YoungsModulus, double);
  ///@}

  ///@{
  /// Poisson's ratio nu of ELASTICITY, between -1 and 0.5. The default is 0.3.
  vtkSetMacro(PoissonRatio, double);
  vtkGetMacro(PoissonRatio, double);
  ///@}

  /// The state of a planar body in the third direction.
  enum PlaneStates
  {
    PLANE_STRAIN = 0,
    PLANE_STRESS = 1
  };
  ///@{
  /// PLANE_STRAIN (the default), for a slice of a long body, or PLANE_STRESS, for a thin sheet.
  /// Planar meshes only.
  vtkTautlineSetRangeMacro(PlaneState, int, PLANE_STRAIN, PLANE_STRESS);
  vtkGetMacro(PlaneState, int);
  ///@}

  /// The ways to define a function.
  enum FunctionTypes
  {
    CONSTANT = 0,
    ARRAY = 1,
    EXPRESSION = 2
  };
  ///@{
  /// The type of f: CONSTANT (the default), ARRAY (array 1) or EXPRESSION.
  vtkTautlineSetRangeMacro(SourceType, int, CONSTANT, EXPRESSION);
  vtkGetMacro(SourceType, int);
  ///@}

  ///@{
  /// The constant f; the default is 1.
  vtkSetMacro(SourceValue, double);
  vtkGetMacro(SourceValue, double);
  ///@}

  ///@{
  /// The constant f for ELASTICITY, a force per volume; the default is (1, 0, 0).
  vtkSetVector3Macro(BodyForce, double);
  vtkGetVector3Macro(BodyForce, double);
  ///@}

  ///@{
  /// f as an expression; for ELASTICITY a vector, such as "-9.81*jHat + 0*iHat".
  vtkSetMacro(SourceExpression, std::string);
  vtkGetMacro(SourceExpression, std::string);
  ///@}

  /// The fixed points of the boundary, where the solution is given.
  enum FixedParts
  {
    WHOLE_BOUNDARY = 0,
    PART_OF_BOUNDARY = 1,
    ONLY_CHOSEN = 2
  };
  ///@{
  /**
   * WHOLE_BOUNDARY (the default), PART_OF_BOUNDARY, where FixedWhere is not 0, or ONLY_CHOSEN. In
   * any case, points are fixed where array 0 is not 0 (for a cell array, the points of such cells),
   * or if they are selected at input port 1. On the rest of the boundary the natural condition
   * holds: no flux, no traction.
   */
  vtkTautlineSetRangeMacro(FixedPart, int, WHOLE_BOUNDARY, ONLY_CHOSEN);
  vtkGetMacro(FixedPart, int);
  ///@}

  ///@{
  /// An expression that is nonzero on the fixed part of the boundary, such as "x < 0.01".
  vtkSetMacro(FixedWhere, std::string);
  vtkGetMacro(FixedWhere, std::string);
  ///@}

  ///@{
  /// The solution at fixed points: CONSTANT (the default), ARRAY (array 2) or EXPRESSION.
  vtkTautlineSetRangeMacro(GivenType, int, CONSTANT, EXPRESSION);
  vtkGetMacro(GivenType, int);
  ///@}

  ///@{
  /// The constant solution at fixed points; the default is 0.
  vtkSetMacro(GivenValue, double);
  vtkGetMacro(GivenValue, double);
  ///@}

  ///@{
  /// The constant displacement of fixed points; the default is (0, 0, 0).
  vtkSetVector3Macro(GivenDisplacement, double);
  vtkGetVector3Macro(GivenDisplacement, double);
  ///@}

  ///@{
  /// The solution at fixed points as an expression.
  vtkSetMacro(GivenExpression, std::string);
  vtkGetMacro(GivenExpression, std::string);
  ///@}

  ///@{
  /// Relaxation of SSOR, above 0 and below 2. The default is 1.
  vtkSetMacro(Omega, double);
  vtkGetMacro(Omega, double);
  ///@}

  enum Redistributions
  {
    NO_REDISTRIBUTION = 0, ///< each process works on the cells of its pieces
    KD_TREE = 1,           ///< boxes with about equal numbers of points; fast
    PT_SCOTCH = 2          ///< balanced parts with short borders; needs PETSc with PT-Scotch
  };

  ///@{
  /**
   * On a server with several processes: whether and how each mesh is redistributed among them, also
   * if all of it is on the first process, as after reading a serial file. This balances the work
   * and limits the communication. The result goes back to the pieces of the input, with the same
   * points and cells. RedistributeOn() selects the k-d tree. The default is NO_REDISTRIBUTION.
   */
  vtkTautlineSetRangeMacro(Redistribute, int, NO_REDISTRIBUTION, PT_SCOTCH);
  vtkGetMacro(Redistribute, int);
  vtkBooleanMacro(Redistribute, int);
  ///@}

  ///@{
  /**
   * Options of PETSc, such as "-pc_hypre_boomeramg_strong_threshold 0.5". They override other
   * properties. Only options that choose and tune methods and preconditioners are permitted;
   * options that read, write or display something, load code or need data from a program are
   * rejected with an error. The options of other users of PETSc in the process are neither read nor
   * changed.
   */
  vtkSetMacro(PETScOptions, std::string);
  vtkGetMacro(PETScOptions, std::string);
  ///@}

  /// Number of unknowns of the last system, over all processes and blocks.
  vtkIdType GetUnknowns() const { return this->Unknowns; }
  /// Time of the last assembly in seconds, over all blocks.
  double GetAssemblySeconds() const { return this->AssemblySeconds; }
  /// Number of systems assembled since this filter was created; all time steps shown share one
  /// system.
  int GetAssemblies() const { return this->Assemblies; }

protected:
  vtkEllipticAlgorithm();
  ~vtkEllipticAlgorithm() override;

  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void ClearResult() override;

  /// Clears the derived class's results of the last execution.
  virtual void Reset();
  /// Computes the result on a mesh. Collective. Throws tautline::Error.
  virtual void Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
    tautline::RankGroup& processes, tautline::TableRows& table) = 0;

  /// Whether systems are kept for the next execution. The derived class calls ForgetSystems() if
  /// the input or a property has changed.
  virtual bool KeepsSystems() const { return false; }
  void ForgetSystems();

  /// Adds a paragraph to the summary that begins with the block's name.
  void Describe(const tautline::LocalMesh& mesh, const std::string& text);
  /// Makes RequestData() end with the summary as a warning, because a step failed.
  void Warn() { this->Failed = true; }
  /// Reports a fraction of the work on a mesh. @return false to stop
  bool Report(const tautline::LocalMesh& mesh, double fraction);
  /// For the kernel when it has no progress to report: reports the last fraction again. The
  /// function returns true to stop.
  std::function<bool()> Cancelled();

  double Omega = 1.0;
  std::string PETScOptions;
  bool MergeCoincidentPoints = true;
  int Equation = POISSON;

private:
  vtkEllipticAlgorithm(const vtkEllipticAlgorithm&) = delete;
  void operator=(const vtkEllipticAlgorithm&) = delete;

  struct KeptSystem;

  tautline::EllipticChoice GetChoice() const;
  const tautline::EllipticInput& Assembled(const tautline::LocalMesh& mesh,
    const tautline::EllipticChoice& choice, tautline::RankGroup& processes);

  std::vector<std::shared_ptr<KeptSystem>> Systems; ///< by the number of the mesh
  int Assemblies = 0;

  double Alpha = 1.0;
  double Beta = 1.0;
  double Gamma = 1.0;
  double Reaction = 1.0;
  double YoungsModulus = 1.0;
  double PoissonRatio = 0.3;
  int PlaneState = PLANE_STRAIN;
  int SourceType = CONSTANT;
  double SourceValue = 1.0;
  double BodyForce[3] = { 1.0, 0.0, 0.0 };
  std::string SourceExpression;
  int FixedPart = WHOLE_BOUNDARY;
  std::string FixedWhere;
  int GivenType = CONSTANT;
  double GivenValue = 0.0;
  double GivenDisplacement[3] = { 0.0, 0.0, 0.0 };
  std::string GivenExpression;
  int Redistribute = NO_REDISTRIBUTION;
  bool Failed = false;
  double Fraction = 0.0;
  vtkIdType Unknowns = 0;
  double AssemblySeconds = 0.0;
};

#endif
