// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshUntangler
 * @brief Makes the elements of a mesh valid by moving its points.
 *
 * Supports triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed, in
 * data sets with explicit points, or blocks of these. The connectivity does not change. Points of
 * the boundary slide only if elements are otherwise not valid (ON_SURFACE, the default of
 * Boundary). The output never has more inverted elements than the input. The report guarantees that
 * every element is valid, or lists the invalid elements with their positions and the reasons.
 *
 * A mesh reversed throughout is treated as its mirror image, and so is a cell that lists its points
 * in the opposite order of the others. Parts without a consistent orientation and image data
 * (implicit points) are not supported. For better elements run vtkMeshOptimizer afterwards.
 *
 * In a mesh with polyhedra, all cells are untangled as finite volumes: a cell is valid if its
 * volume and the pyramids over its faces are positive, see tautline/Polyhedral/ImproveFaces.h. The
 * boundary is fixed unless another Boundary is chosen. Method and Effort are then not used, and
 * with several processes the mesh is gathered on the first one.
 *
 * In meshes of quadratic and higher-order cells, in volumes or in a plane, all nodes move, and
 * cells are certified to be valid throughout, see tautline/Curved/UntangleCurved.h. Method and
 * Effort are then not used.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) a vtkSelection of points or cells that stay; 2 (optional) the geometry:
 * triangles or quadrilaterals, for planar meshes lines or cells in the plane, that the boundary
 * slides on (ON_SURFACE).
 *
 * Arrays of the mesh (SetInputArrayToProcess), by index: 0 fixed points (where not 0), 1 kinds of
 * the points (0 patch, 1 curve, 2 corner, -1 as detected), 2 regions (cells).
 *
 * @par Output port 0 `Mesh`:
 * The input with new points, the point array `Displacement` (new minus old) and the cell arrays
 * `Validity` (see vtkElementQuality) and `Obstacle` (signed char), the reason why an element is not
 * valid: 0 it is valid, 1 unknown (the iterations ended), 2 all its points are fixed, 3 the
 * surrounding fixed points leave no valid position, 4 a fixed point is NaN or infinite. Points in
 * single precision stay so unless rounding would make a valid element invalid.
 *
 * @par Output port 1 `History`:
 * A vtkTable whose row i is iteration i (0 is the input): `Objective` (the energy), `Inverted`
 * (with degenerate elements), `N gradient`, `N moving` (points), `Time (s)`; for composite data
 * sets also `Block`.
 *
 * @par Several processes:
 * Each process may have pieces of the mesh. Volume meshes and planar meshes are untangled in place,
 * in the reproducible order, with a fixed boundary instead of sliding ON_SURFACE. Surfaces in
 * space, inclined planes, blocks and remaining inverted elements are gathered on the first process;
 * the summary reports this and the reason.
 *
 * Dissertation section 3.3.3; Escobar et al. 2003 and Garanzha et al. 2021, see
 * tautline/Untangling/Untangle.h.
 *
 * @sa vtkMeshOptimizer, vtkElementQuality, vtkMeshPerturbation
 */

#ifndef vtkMeshUntangler_h
#define vtkMeshUntangler_h

#include "TautlineUntanglingModule.h" // for export macro
#include "vtkMeshBoundaryAlgorithm.h"
#include "vtkTautlineSetRange.h" // for the setters

#include <string> // for Reason

namespace tautline
{
class MovableMesh;
class TableRows;
struct InputBlock;
struct IterationState;
struct UntangleOptions;
struct UntangleResult;
}

class TAUTLINEUNTANGLING_EXPORT vtkMeshUntangler : public vtkMeshBoundaryAlgorithm
{
public:
  static vtkMeshUntangler* New();
  vtkTypeMacro(vtkMeshUntangler, vtkMeshBoundaryAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Methods
  {
    AUTOMATIC = 0,
    SIMULTANEOUS = 1
  };
  ///@{
  /**
   * The method: AUTOMATIC moves the points around inverted elements, then all points, as far as
   * Effort allows; SIMULTANEOUS is the simultaneous untangling and smoothing of Escobar et al.
   * 2003, which moves every point, for comparison. The default is AUTOMATIC.
   */
  vtkTautlineSetRangeMacro(Method, int, AUTOMATIC, SIMULTANEOUS);
  vtkGetMacro(Method, int);
  ///@}

  enum Efforts
  {
    LOCAL = 0,
    NORMAL = 1,
    THOROUGH = 2
  };
  ///@{
  /**
   * The effort of the automatic method: LOCAL moves only the points around inverted elements,
   * NORMAL then moves all points, THOROUGH does so for thousands of iterations and from several
   * starts. The default is NORMAL.
   */
  vtkTautlineSetRangeMacro(Effort, int, LOCAL, THOROUGH);
  vtkGetMacro(Effort, int);
  ///@}

  ///@{
  /// Whether only the nodes of curved cells between their corners move. The default is off.
  vtkSetMacro(MidNodesOnly, bool);
  vtkGetMacro(MidNodesOnly, bool);
  vtkBooleanMacro(MidNodesOnly, bool);
  ///@}

  ///@{
  /**
   * Whether, as a last resort, the nodes of curved cells that remain invalid move to their
   * positions in a straight cell, which may be off the surface. The default is off.
   */
  vtkSetMacro(Straighten, bool);
  vtkGetMacro(Straighten, bool);
  vtkBooleanMacro(Straighten, bool);
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
   * The results of the last execution; numbers cover all blocks. Inverted elements include
   * degenerate ones; elements with an Obstacle of 2 or 3 are infeasible (`Impossible`).
   */
  const char* GetReason() const { return this->Reason.c_str(); }
  vtkIdType GetInvertedBefore() const { return this->InvertedBefore; }
  vtkIdType GetInvertedAfter() const { return this->InvertedAfter; }
  vtkIdType GetImpossible() const { return this->Impossible; }
  ///@}

protected:
  vtkMeshUntangler();
  ~vtkMeshUntangler() override;

  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void ClearResult() override;
  tautline::GatheredRules GetGatheredRules() override;
  bool TakesPieces(vtkInformationVector** inputs) override;
  void ExchangeResult(tautline::ResultStream& stream) override;

private:
  vtkMeshUntangler(const vtkMeshUntangler&) = delete;
  void operator=(const vtkMeshUntangler&) = delete;

  void Untangle(
    const tautline::InputBlock& block, vtkDataObject* geometry, tautline::TableRows& history);
  void UntanglePolyhedra(
    const tautline::InputBlock& block, vtkDataObject* geometry, tautline::TableRows& history);
  void UntangleCurved(
    const tautline::InputBlock& block, vtkDataObject* geometry, tautline::TableRows& history);
  void Show(const tautline::InputBlock& block, const tautline::MovableMesh& mesh,
    tautline::UntangleResult& result, const std::string& more, tautline::TableRows& history);
  bool ShowState(const tautline::IterationState& state, int block);

  tautline::UntangleOptions GetOptions(int block);

  int Method = AUTOMATIC;
  int Effort = NORMAL;
  bool MidNodesOnly = false;
  bool Straighten = false;
  std::string Reason;
  vtkIdType InvertedBefore = 0;
  vtkIdType InvertedAfter = 0;
  vtkIdType Impossible = 0;
  vtkIdType NotValid = 0; ///< including NaN coordinates
};

#endif
