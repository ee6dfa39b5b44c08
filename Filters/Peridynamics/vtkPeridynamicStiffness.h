// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPeridynamicStiffness
 * @brief The stiffness matrix of a nonlocal (peridynamic) model: its condition number, its rows,
 * its solution.
 *
 * Assembles the bond-based model of dissertation chapter 4 on a planar triangle mesh with an
 * interaction layer:
 *
 *     a(u, w) = s int w(x) int_{|x - y| < delta} (u(x) - u(y)) k(|x - y|) dy dx,
 *     k(r) = r^-p,  s = 1 / delta^(4-p)
 *
 * (4.6), or with another kernel, or the elastic model (4.4)-(4.5) with its tensor kernel, or the
 * linear ordinary state-based model, which has any Poisson's ratio
 * (tautline/Peridynamics/Dilatation.h). The solution is given in the interaction layer, the cells
 * whose region is LayerValue. Two discretizations of the integrals:
 * - EXACT: geometry and singularity of the inner integral are exact; converges; symmetric.
 * - DISSERTATION: the rules of section 4.3. With Rules at TABLES it reproduces Tables 4.1 to 4.3.
 *
 * Extreme eigenvalues are by the Lanczos method, with error bounds; nothing is factorized.
 *
 * @par Input:
 * Any vtkDataSet of triangles in a plane, all of one orientation. vtkInteractionLayer adds an
 * interaction layer; vtkDomainSource's square has one. The data sets of composite data are one
 * mesh; the output is then a vtkUnstructuredGrid. A mesh in pieces is gathered.
 *
 * @par Input arrays (SetInputArrayToProcess):
 * - 0, region: cell array with one component; cells where it is LayerValue are the interaction
 *   layer.
 * - 1, source b: on points or cells, one component (elastic: two or three). None: UniformSource.
 * - 2, given g: in the interaction layer; on points, or with discontinuous bases on cells. None: 0.
 * - 3, given points: point array, not 0 where the continuous linear basis is given. None: the
 *   points of interaction layer cells.
 *
 * @par Output port 0 `Mesh`:
 * The input with arrays on the points (continuous linear basis) or cells (others; the discontinuous
 * linear one has a component per corner): `Unknown` (1 or 0), `Neighbors` (unknown functions a row
 * couples with), `RowSum` (of the unknown part: what of the diagonal goes to the interaction
 * layer), `Diagonal`; `SmallestMode` and `LargestMode`, eigenvectors of norm 1, if ComputeSpectrum;
 * `Solution` if Solve. Elastic vectors have three components per function, in space. If Elastic and
 * Solve, cells have `Dilatation` and `EnergyDensity` of the solution, 0 in the interaction layer.
 *
 * @par Output port 1 `Spectrum`:
 * vtkTable of one row: `Condition` (0 where the matrix is not positive definite), `Smallest`,
 * `Largest`, `SmallestBound`, `LargestBound` (absolute error bounds), `Definite`, `Converged`,
 * `Iterations`, `Rows`, `Nonzeros`, `Asymmetry` (of the dissertation's discretization: norm of the
 * part that is dropped, relative), `LayerDeficit`, `IntegratedPairs` (on several processes those
 * of all, pairs near the planes between them several times), `Memory` (bytes, estimated);
 * of the solution, 0 unless Solve: `SolverIterations`, `SolverResidual` (relative),
 * `SolverConverged`, `PreconditionedCondition` (estimated from the iterations, from below).
 *
 * @par Output port 2 `Sparsity`:
 * vtkImageData with `Entries` per pixel, as Figure 4.2; empty unless SparsityPixels is above 0.
 *
 * @par Errors:
 * Whatever tautline::assemblePeridynamics rejects, by name and with the remedy: no interaction
 * layer or too thin a one, an exponent at the singular limit, inverted or degenerate triangles, too
 * little memory, time over.
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
   * Whether points with the same coordinates on edges that match are treated as one, as on the
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
   * The kernel's shape. The default is POWER (0).
   */
  vtkTautlineSetRangeMacro(Kernel, int, POWER, TABLE);
  vtkGetMacro(Kernel, int);
  ///@}

  ///@{
  /**
   * Exponent p of the power, from 0 to below 4 (continuous linear basis) or 3 (others); elastic: 6
   * or 5. The kernel is integrable below 2 (4: elastic). The default is 1.
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
   * Values of the tabulated kernel: two or more, not negative, the first at r = 0, the last at
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
   * 0, the default: diffusion, (4.6). 1: linearized elasticity with the tensor kernel of (4.4).
   */
  vtkSetMacro(Elastic, bool);
  vtkGetMacro(Elastic, bool);
  vtkBooleanMacro(Elastic, bool);
  ///@}

  ///@{
  /**
   * Of the elastic model: 0, the default: bond-based. 1: linear, ordinary state-based; it needs an
   * interaction layer of twice the horizon and the exact discretization.
   */
  vtkSetMacro(StateBased, bool);
  vtkGetMacro(StateBased, bool);
  vtkBooleanMacro(StateBased, bool);
  ///@}

  ///@{
  /**
   * Poisson's ratio of the state-based model, above -1 and below 0.5. At the default, 0.25, it is
   * in plane strain the bond-based one.
   */
  vtkSetMacro(PoissonRatio, double);
  vtkGetMacro(PoissonRatio, double);
  ///@}

  ///@{
  /**
   * Of the state-based model: 0, the default: plane strain. 1: plane stress, in which the
   * bond-based model has a Poisson's ratio of 1/3.
   */
  vtkSetMacro(PlaneStress, bool);
  vtkGetMacro(PlaneStress, bool);
  vtkBooleanMacro(PlaneStress, bool);
  ///@}

  ///@{
  /**
   * Whether triangles do not interact where the mesh ends between them, as across a hole or a
   * crack: decided by the segment between their centroids. Has no effect where the
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
   * Points of the dissertation's rules: outer, inner.
   */
  enum RuleSets
  {
    TABLES = 0,  ///< 3 and 1 (linear), 3 and 3 (constant): what its tables were made with
    LITERAL = 1, ///< 1 and 3: those of its text
    ONE_ONE = 2,
    THREE_THREE = 3,
    THREE_ONE = 4
  };

  ///@{
  /**
   * The rules, in the dissertation's discretization. The default is TABLES (0).
   */
  vtkTautlineSetRangeMacro(Rules, int, TABLES, THREE_ONE);
  vtkGetMacro(Rules, int);
  ///@}

  ///@{
  /**
   * How far the integral over each pair of triangles is refined in exact discretization, 1e-10 to
   * 0.1. The matrix has larger errors, relative to its largest entry: at most 3e-3, 5e-4 and 1e-4
   * for 1e-3, 1e-5 and 1e-7 where the horizon is 1.5 elements, 7e-3, 8e-4 and 3e-4 where it is 0.3,
   * see tautline::PeridynamicOptions. The default is 1e-5.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Value of the region array in the interaction layer. The default is 2, as vtkInteractionLayer
   * and vtkDomainSource give it.
   */
  vtkSetMacro(LayerValue, double);
  vtkGetMacro(LayerValue, double);
  ///@}

  ///@{
  /**
   * Whether the solution is given in the interaction layer. If not, every function is unknown, and
   * constants are in the null space. The default is true.
   */
  vtkSetMacro(Constrained, bool);
  vtkGetMacro(Constrained, bool);
  vtkBooleanMacro(Constrained, bool);
  ///@}

  ///@{
  /**
   * Whether an interaction layer narrower than the horizon is accepted; what lies beyond the mesh
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
   * Relative error accepted of the eigenvalues, 1e-14 to 0.1. The default is 1e-8.
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
   * Preconditioners of the solution, see tautline/Peridynamics/PeridynamicSolve.h.
   */
  enum Preconditioners
  {
    JACOBI = 0,    ///< the diagonal
    LOCAL_AMG = 1, ///< with algebraic multigrid for the local limit
    TWO_LEVEL = 2  ///< with a coarse grid, solved exactly
  };

  ///@{
  /**
   * The preconditioner of the conjugate gradients that find the solution. Those other than JACOBI
   * need values that are given in the interaction layer. The default is JACOBI (0).
   */
  vtkTautlineSetRangeMacro(Preconditioner, int, JACOBI, TWO_LEVEL);
  vtkGetMacro(Preconditioner, int);
  ///@}

  ///@{
  /**
   * The source b where no array is given; elastic: of its first component, the other is 0. The
   * default is 1.
   */
  vtkSetMacro(UniformSource, double);
  vtkGetMacro(UniformSource, double);
  ///@}

  ///@{
  /**
   * Largest number of rows of the picture of the sparsity pattern, 0 for none, up to 4096. The
   * default is 0.
   */
  vtkTautlineSetRangeMacro(SparsityPixels, int, 0, 4096);
  vtkGetMacro(SparsityPixels, int);
  ///@}

  ///@{
  /**
   * Memory the matrix may take, in MiB; 0, the default, is what the machine has free.
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

  /// What the other processes do while the first one is in RequestData(), in step with it.
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
  /// The eigenvalues and the solution: those found so far.
  bool KeepsBest() const override { return this->Assembled; }

  std::unique_ptr<tautline::RankGroup> Group; ///< of several processes, in an execution
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
