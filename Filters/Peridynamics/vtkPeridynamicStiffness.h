// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPeridynamicStiffness
 * @brief Assembles the stiffness matrix of a nonlocal (peridynamic) model, and finds its condition
 * number, properties of its rows and the solution.
 *
 * Assembles the bond-based model of dissertation chapter 4 on a planar triangle mesh with an
 * interaction layer:
 *
 *     a(u, w) = s int w(x) int_{|x - y| < delta} (u(x) - u(y)) k(|x - y|) dy dx,
 *     k(r) = r^-p,  s = 1 / delta^(4-p)
 *
 * (4.6), or with another kernel, or the elastic model (4.4)-(4.5) with its tensor kernel, or the
 * linear ordinary state-based model, which allows any Poisson's ratio
 * (tautline/Peridynamics/Dilatation.h). The solution is given in the interaction layer, the cells
 * whose region is LayerValue. There are two discretizations of the integrals:
 * - EXACT: geometry and singularity of the inner integral are exact; convergent and symmetric.
 * - DISSERTATION: the rules of section 4.3. With Rules at TABLES it reproduces Tables 4.1 to 4.3.
 *
 * Extreme eigenvalues are computed by the Lanczos method, with error bounds and without a
 * factorization.
 *
 * @par Input:
 * Any vtkDataSet of triangles in a plane, all with the same orientation. vtkInteractionLayer adds
 * an interaction layer; vtkDomainSource's square has one. The data sets of composite data form one
 * mesh; the output is then a vtkUnstructuredGrid. A mesh in pieces is gathered.
 *
 * @par Input arrays (SetInputArrayToProcess):
 * - 0, region: cell array with one component; cells with the value LayerValue form the interaction
 *   layer.
 * - 1, source b: point or cell array, one component (elastic: two or three). None: UniformSource.
 * - 2, given g in the interaction layer: point array, or cell array for discontinuous bases. None:
 *   0.
 * - 3, given points: point array, not 0 where the continuous linear basis is given. None: the
 *   points of cells in the interaction layer.
 *
 * @par Output port 0 `Mesh`:
 * The input with arrays on the points (continuous linear basis) or cells (others; the discontinuous
 * linear one has a component per corner): `Unknown` (1 or 0), `Neighbors` (unknown functions
 * coupled with a row), `RowSum` (over the unknowns: the part of the diagonal that belongs to the
 * interaction layer), `Diagonal`; `SmallestMode` and `LargestMode`, eigenvectors of norm 1, with
 * ComputeSpectrum; `Solution` with Solve. Elastic vectors have three components per function, in
 * space. With Elastic and Solve, cells have `Dilatation` and `EnergyDensity` of the solution, 0 in
 * the interaction layer.
 *
 * @par Output port 1 `Spectrum`:
 * vtkTable with one row: `Condition` (0 if the matrix is not positive definite), `Smallest`,
 * `Largest`, `SmallestBound`, `LargestBound` (absolute error bounds), `Definite`, `Converged`,
 * `Iterations`, `Rows`, `Nonzeros`, `Asymmetry` (for the dissertation's discretization: relative
 * norm of the dropped part), `LayerDeficit`, `IntegratedPairs` (the total over several processes,
 * where pairs near the dividing planes count several times), `Memory` (bytes, estimated); for the
 * solution, 0 unless Solve: `SolverIterations`, `SolverResidual` (relative), `SolverConverged`,
 * `PreconditionedCondition` (a lower estimate from the iterations).
 *
 * @par Output port 2 `Sparsity`:
 * vtkImageData with `Entries` per pixel, as in Figure 4.2; empty unless SparsityPixels is above 0.
 *
 * @par Errors:
 * All input that tautline::assemblePeridynamics rejects, with the remedy: a missing or too thin
 * interaction layer, an exponent at the singular limit, inverted or degenerate triangles,
 * insufficient memory, or the time limit.
 *
 * @par Example:
 * @code
 * vtkNew<vtkDomainSource> square;
 * square->SetDomainByName("square");
 * vtkNew<vtkPeridynamicStiffness> stiffness;
 * stiffness->SetInputConnection(square->GetOutputPort());
 * stiffness->SetHorizon(0.2);
 * stiffness->Update();
 * std::cout << stiffness->GetCondition() << "\n"; // 9.28
 * @endcode
 *
 * @sa tautline::assemblePeridynamics (tautline/Peridynamics/Peridynamics.h), vtkInteractionLayer,
 * vtkHorizonNeighbors
 */

#ifndef vtkPeridynamicStiffness_h
#define vtkPeridynamicStiffness_h

#include "TautlinePeridynamicsModule.h" // for export macro
#include "vtkTautlineSetRange.h"        // for the setters
#include "vtkTautlineTimedAlgorithm.h"

#include <memory> // for the group
#include <vector> // for KernelValues

class vtkDataArray;
class vtkDataSet;
class vtkImageData;
class vtkTable;

namespace tautline
{
class Assistants;
class HorizonInput;
class RankGroup;
struct PeridynamicOptions;
struct PeridynamicSystem;
struct SolveReport;
struct Spectrum;
}

class TAUTLINEPERIDYNAMICS_EXPORT vtkPeridynamicStiffness : public vtkTautlineTimedAlgorithm
{
public:
  static vtkPeridynamicStiffness* New();
  vtkTypeMacro(vtkPeridynamicStiffness, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether to treat points with the same coordinates on matching edges as one, for example on the
   * seams of a mesh in pieces. The default is on. See tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * The horizon delta, above 0, in the unit of the mesh. The default is 0.2.
   */
  vtkSetMacro(Horizon, double);
  vtkGetMacro(Horizon, double);
  ///@}

  /**
   * Shapes of the kernel k(r), 0 < r < delta.
   */
  enum Kernels
  {
    POWER = 0,    ///< r^-p
    CONSTANT = 1, ///< 1
    GAUSSIAN = 2, ///< exp(-(r / (GaussianWidth delta))^2)
    CONICAL = 3,  ///< 1 - r / delta
    TABLE = 4     ///< linear between the KernelValues, at equal distances from 0 to delta
  };

  ///@{
  /**
   * The shape of the kernel. The default is POWER (0).
   */
  vtkTautlineSetRangeMacro(Kernel, int, POWER, TABLE);
  vtkGetMacro(Kernel, int);
  ///@}

  ///@{
  /**
   * Exponent p of the power, from 0 to below 4 (continuous linear basis) or 3 (other bases); for
   * the elastic model, 6 or 5. The kernel is integrable below 2 (elastic: 4). The default is 1.
   */
  vtkSetMacro(Exponent, double);
  vtkGetMacro(Exponent, double);
  ///@}

  ///@{
  /**
   * Width of the Gaussian in horizons, above 0. The default is 0.5.
   */
  vtkSetMacro(GaussianWidth, double);
  vtkGetMacro(GaussianWidth, double);
  ///@}

  ///@{
  /**
   * Values of the tabulated kernel: at least two, not negative, the first at r = 0, the last at
   * delta.
   */
  void AddKernelValue(double value);
  void ClearKernelValues();
  ///@}

  enum Bases
  {
    PIECEWISE_CONSTANT = 0,
    PIECEWISE_LINEAR = 1,
    DISCONTINUOUS_LINEAR = 2
  };

  ///@{
  /**
   * The basis functions. The default is PIECEWISE_LINEAR (1).
   */
  vtkTautlineSetRangeMacro(Basis, int, PIECEWISE_CONSTANT, DISCONTINUOUS_LINEAR);
  vtkGetMacro(Basis, int);
  ///@}

  ///@{
  /**
   * The model: 0, the default, diffusion (4.6); 1, linearized elasticity with the tensor kernel of
   * (4.4).
   */
  vtkSetMacro(Elastic, bool);
  vtkGetMacro(Elastic, bool);
  vtkBooleanMacro(Elastic, bool);
  ///@}

  ///@{
  /**
   * The elastic model: 0, the default, bond-based; 1, linear ordinary state-based, which needs an
   * interaction layer of twice the horizon and the exact discretization.
   */
  vtkSetMacro(StateBased, bool);
  vtkGetMacro(StateBased, bool);
  vtkBooleanMacro(StateBased, bool);
  ///@}

  ///@{
  /**
   * Poisson's ratio of the state-based model, above -1 and below 0.5. With the default, 0.25, it
   * equals the bond-based model in plane strain.
   */
  vtkSetMacro(PoissonRatio, double);
  vtkGetMacro(PoissonRatio, double);
  ///@}

  ///@{
  /**
   * For the state-based model: 0, the default, plane strain; 1, plane stress, in which the
   * bond-based model has a Poisson's ratio of 1/3.
   */
  vtkSetMacro(PlaneStress, bool);
  vtkGetMacro(PlaneStress, bool);
  vtkBooleanMacro(PlaneStress, bool);
  ///@}

  ///@{
  /**
   * Whether to cut bonds that leave the mesh, for example across a hole or a crack: triangles do
   * not interact if the segment between their centroids leaves the mesh. Has no effect where the
   * interaction layer is wide enough. The default is true.
   */
  vtkSetMacro(CutBonds, bool);
  vtkGetMacro(CutBonds, bool);
  vtkBooleanMacro(CutBonds, bool);
  ///@}

  enum Discretizations
  {
    DISSERTATION = 0,
    EXACT = 1
  };

  ///@{
  /**
   * The discretization of the integrals. The default is EXACT (1).
   */
  vtkTautlineSetRangeMacro(Discretization, int, DISSERTATION, EXACT);
  vtkGetMacro(Discretization, int);
  ///@}

  /**
   * Numbers of points of the dissertation's outer and inner rules.
   */
  enum RuleSets
  {
    TABLES = 0,  ///< 3 and 1 (linear), 3 and 3 (constant), as used for its tables
    LITERAL = 1, ///< 1 and 3, as in its text
    ONE_ONE = 2,
    THREE_THREE = 3,
    THREE_ONE = 4
  };

  ///@{
  /**
   * The rules of the dissertation's discretization. The default is TABLES (0).
   */
  vtkTautlineSetRangeMacro(Rules, int, TABLES, THREE_ONE);
  vtkGetMacro(Rules, int);
  ///@}

  ///@{
  /**
   * Tolerance of the integral over each pair of triangles in the exact discretization, 1e-10 to
   * 0.1. The matrix has larger errors, relative to its largest entry: at most 3e-3, 5e-4 and 1e-4
   * for 1e-3, 1e-5 and 1e-7 if the horizon is 1.5 elements, and 7e-3, 8e-4 and 3e-4 if it is 0.3
   * elements, see tautline::PeridynamicOptions. The default is 1e-5.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Value of the region array in the interaction layer. The default is 2, as used by
   * vtkInteractionLayer and vtkDomainSource.
   */
  vtkSetMacro(LayerValue, double);
  vtkGetMacro(LayerValue, double);
  ///@}

  ///@{
  /**
   * Whether the solution is given in the interaction layer. Otherwise every function is unknown,
   * and constants are in the null space. The default is true.
   */
  vtkSetMacro(Constrained, bool);
  vtkGetMacro(Constrained, bool);
  vtkBooleanMacro(Constrained, bool);
  ///@}

  ///@{
  /**
   * Whether to accept an interaction layer narrower than the horizon; the region beyond the mesh
   * then does not count. The default is false.
   */
  vtkSetMacro(AllowThinLayer, bool);
  vtkGetMacro(AllowThinLayer, bool);
  vtkBooleanMacro(AllowThinLayer, bool);
  ///@}

  ///@{
  /**
   * Whether to find the extreme eigenvalues. The default is true.
   */
  vtkSetMacro(ComputeSpectrum, bool);
  vtkGetMacro(ComputeSpectrum, bool);
  vtkBooleanMacro(ComputeSpectrum, bool);
  ///@}

  ///@{
  /**
   * Relative tolerance of the eigenvalues, 1e-14 to 0.1. The default is 1e-8.
   */
  vtkTautlineSetRangeMacro(SpectrumTolerance, double, 1e-14, 0.1);
  vtkGetMacro(SpectrumTolerance, double);
  ///@}

  ///@{
  /**
   * Whether to solve a(u, w) = int b w with u = g in the interaction layer. The default is false.
   */
  vtkSetMacro(Solve, bool);
  vtkGetMacro(Solve, bool);
  vtkBooleanMacro(Solve, bool);
  ///@}

  /**
   * Preconditioners for the solution, see tautline/Peridynamics/PeridynamicSolve.h.
   */
  enum Preconditioners
  {
    JACOBI = 0,    ///< the diagonal
    LOCAL_AMG = 1, ///< with algebraic multigrid for the local limit
    TWO_LEVEL = 2  ///< with a coarse grid, solved exactly
  };

  ///@{
  /**
   * The preconditioner of the conjugate gradient method for the solution. Preconditioners other
   * than JACOBI need given values in the interaction layer. The default is JACOBI (0).
   */
  vtkTautlineSetRangeMacro(Preconditioner, int, JACOBI, TWO_LEVEL);
  vtkGetMacro(Preconditioner, int);
  ///@}

  ///@{
  /**
   * The source b if no array is given; for the elastic model its first component (the other is 0).
   * The default is 1.
   */
  vtkSetMacro(UniformSource, double);
  vtkGetMacro(UniformSource, double);
  ///@}

  ///@{
  /**
   * Largest number of rows of the picture of the sparsity pattern, up to 4096; 0 for none. The
   * default is 0.
   */
  vtkTautlineSetRangeMacro(SparsityPixels, int, 0, 4096);
  vtkGetMacro(SparsityPixels, int);
  ///@}

  ///@{
  /**
   * Memory limit of the matrix in MiB; 0, the default, stands for the free memory of the machine.
   */
  vtkTautlineSetRangeMacro(MemoryLimit, double, 0.0, 1e12);
  vtkGetMacro(MemoryLimit, double);
  ///@}

  ///@{
  /**
   * Results of the last execution: condition number (0: none, or not positive definite) and extreme
   * eigenvalues.
   */
  vtkGetMacro(Condition, double);
  vtkGetMacro(SmallestEigenvalue, double);
  vtkGetMacro(LargestEigenvalue, double);
  ///@}

  /**
   * Iterations of the last solution; 0 if there was none.
   */
  vtkGetMacro(SolverIterations, int);

  /// The mesh with the results.
  vtkDataSet* GetOutput();

protected:
  vtkPeridynamicStiffness();
  ~vtkPeridynamicStiffness() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  bool NeedsFinitePoints(int port) const override;
  tautline::GatheredRules GetGatheredRules() override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;

private:
  vtkPeridynamicStiffness(const vtkPeridynamicStiffness&) = delete;
  void operator=(const vtkPeridynamicStiffness&) = delete;

  /// The work of the other processes in step with the first, which is in RequestData().
  void Assist();

  tautline::PeridynamicOptions GetOptions();
  void Compute(tautline::Assistants& assistants, vtkDataSet* input, vtkDataSet* output,
    vtkTable* table, vtkImageData* picture);
  vtkDataArray* GetRegion(vtkDataSet* input);
  tautline::Spectrum FindSpectrum(const tautline::PeridynamicSystem& system);
  void Report(const tautline::PeridynamicSystem& system, const tautline::Spectrum* spectrum,
    const tautline::SolveReport& solved);
  tautline::SolveReport SolveSystem(const tautline::HorizonInput& input,
    const tautline::PeridynamicSystem& system, const std::vector<double>& given, vtkDataSet* data,
    vtkDataSet* output);
  bool ProceedWithin(double from, double to, double fraction);
  /// The best result has the eigenvalues and the solution found so far.
  bool KeepsBest() const override { return this->Assembled; }

  std::unique_ptr<tautline::RankGroup> Group; ///< for several processes, during an execution
  bool MergeCoincidentPoints = true;
  double Horizon = 0.2;
  int Kernel = POWER;
  double Exponent = 1.0;
  double GaussianWidth = 0.5;
  std::vector<double> KernelValues;
  int Basis = PIECEWISE_LINEAR;
  bool Elastic = false;
  bool StateBased = false;
  double PoissonRatio = 0.25;
  bool PlaneStress = false;
  bool CutBonds = true;
  int Discretization = EXACT;
  int Rules = TABLES;
  double Tolerance = 1e-5;
  double LayerValue = 2.0;
  bool Constrained = true;
  bool AllowThinLayer = false;
  bool ComputeSpectrum = true;
  double SpectrumTolerance = 1e-8;
  bool Solve = false;
  int Preconditioner = JACOBI;
  double UniformSource = 1.0;
  int SparsityPixels = 0;
  double MemoryLimit = 0.0;
  double Condition = 0.0;
  double SmallestEigenvalue = 0.0;
  double LargestEigenvalue = 0.0;
  int SolverIterations = 0;
  bool Assembled = false; ///< the matrix of this execution
};

#endif
