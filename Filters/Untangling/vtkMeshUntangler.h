// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshUntangler
 * @brief Makes the elements of a mesh valid by moving its points.
 *
 * Takes triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed, from
 * data sets with explicit points, or blocks of these. The connectivity stays. Points of the
 * boundary slide where elements are not valid without that (ON_SURFACE, the default of Boundary).
 * The output never has more inverted elements than the
 * input. Its report is a guarantee: that every element is valid, or which are not, where they are,
 * and why.
 *
 * A mesh reversed throughout is treated as its mirror image, and so is a cell that lists its points
 * in the opposite order of the others. Parts without a consistent orientation and image data
 * (implicit points) are refused. For better elements run vtkMeshOptimizer afterwards.
 *
 * A mesh with polyhedra is untangled as one of finite volumes, with its other cells: a cell is
 * valid if its volume and the pyramids over its faces are positive, see
 * tautline/Polyhedral/ImproveFaces.h. The boundary stays unless another Boundary is chosen. Method
 * and Effort are not used then, and of several processes the first one has the whole mesh.
 *
 * Of cells of quadratic and higher order, all nodes move, and the whole cell is certified to be
 * valid, see tautline/Curved/UntangleCurved.h. They are of volumes, or in a plane. Method and
 * Effort are not used then.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) a vtkSelection of points or cells that stay; 2 (optional) the geometry:
 * triangles or quadrilaterals, for planar meshes lines or cells in the plane, that the boundary
 * slides on (ON_SURFACE).
 *
 * Arrays of the mesh (SetInputArrayToProcess), by index: 0 fixed points (not 0), 1 kinds of the
 * points (0 patch, 1 curve, 2 corner, -1 as found), 2 regions (cells).
 *
 * @par Output port 0 `Mesh`:
 * The input with new points, the point array `Displacement` (new minus old) and the cell arrays
 * `Validity` (see vtkElementQuality) and `Obstacle` (signed char), why an element is not valid: 0
 * it is valid, 1 unknown (the iterations ended), 2 all its points are fixed, 3 the fixed points
 * around leave no place, 4 a fixed point is NaN or infinite. Points in single precision stay so
 * unless a valid element would not be valid when rounded.
 *
 * @par Output port 1 `History`:
 * A vtkTable whose row i is iteration i (0 is the input): `Objective` (the energy), `Inverted`
 * (with degenerate elements), `N gradient`, `N moving` (points), `Time (s)`; of composite data sets
 * also `Block`.
 *
 * @par Several processes:
 * Each may have pieces of the mesh. Volume meshes and planar ones are worked on where they are, in
 * the reproducible order, with a boundary that stays instead of sliding ON_SURFACE. Surfaces in
 * space, inclined planes, blocks and what is left inverted are gathered on the first process; the
 * summary names what was gathered and why.
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
   * The method: AUTOMATIC moves what is around inverted elements, then all points, as far as
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
   * The effort of the automatic method: LOCAL moves only what is around inverted elements, NORMAL
   * then all points, THOROUGH for thousands of iterations and from several starts. The default is
   * NORMAL.
   */
  vtkTautlineSetRangeMacro(Effort, int, LOCAL, THOROUGH);
  vtkGetMacro(Effort, int);
  ///@}

  ///@{
  /// Whether only the nodes of curved cells between their corners move. Off.
  vtkSetMacro(MidNodesOnly, bool);
  vtkGetMacro(MidNodesOnly, bool);
  vtkBooleanMacro(MidNodesOnly, bool);
  ///@}

  ///@{
  /**
   * Whether, as a last resort, the nodes of curved cells that remain invalid go to where they are
   * in a straight cell, which may leave the surface. Off.
   */
  vtkSetMacro(Straighten, bool);
  vtkGetMacro(Straighten, bool);
  vtkBooleanMacro(Straighten, bool);
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
   * The result of the last execution; numbers are of all blocks together. Inverted elements include
   * degenerate ones; infeasible (`Impossible`) are those with an Obstacle of 2 or 3.
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
  vtkIdType NotValid = 0; ///< with NaN coordinates too
};

#endif
