// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshUntangler
 * @brief Makes the elements of a mesh valid by moving its points.
 *
 * Takes triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed, from
 * data sets with explicit points, or blocks of these. The connectivity stays, and so do the points
 * of the boundary unless FixBoundary is off. The output never has more inverted elements than the
 * input. Its report is a guarantee: that every element is valid, or which are not, where they are,
 * and why.
 *
 * A mesh reversed throughout is treated as its mirror image, and so is a cell that lists its points
 * in the opposite order of the others. Parts without a consistent orientation and image data
 * (implicit points) are refused. For better elements run vtkMeshOptimizer afterwards.
 *
 * Of cells of quadratic and higher order, all nodes move, and the whole cell is certified to be
 * valid, see tautline/Curved/UntangleCurved.h. They are of volumes, or in a plane. Method, Effort
 * and FixBoundary are not used then; see CurvedBoundary.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) a vtkSelection of points or cells that stay; 2 (optional) the geometry:
 * triangles or quadrilaterals that the boundary of curved cells slides on (ON_SURFACE).
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
 * the reproducible order. Surfaces in space, inclined planes, blocks and what is left inverted are
 * gathered on the first process; the summary names what was gathered and why.
 *
 * Dissertation section 3.3.3; Escobar et al. 2003 and Garanzha et al. 2021, see
 * tautline/Untangling/Untangle.h.
 *
 * @sa vtkMeshOptimizer, vtkElementQuality, vtkMeshPerturbation
 */

#ifndef vtkMeshUntangler_h
#define vtkMeshUntangler_h

#include "TautlineUntanglingModule.h" // for export macro
#include "vtkMeshMotionAlgorithm.h"
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

class TAUTLINEUNTANGLING_EXPORT vtkMeshUntangler : public vtkMeshMotionAlgorithm
{
public:
  static vtkMeshUntangler* New();
  vtkTypeMacro(vtkMeshUntangler, vtkMeshMotionAlgorithm);
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
  /**
   * Whether the points of the boundary stay. Points also stay where the point array at index 0
   * (SetInputArrayToProcess) is not 0, and where the selection at port 1 holds them or a cell of
   * theirs. On.
   */
  vtkSetMacro(FixBoundary, bool);
  vtkGetMacro(FixBoundary, bool);
  vtkBooleanMacro(FixBoundary, bool);
  ///@}

  ///@{
  /**
   * Free the points of the elements that are inverted or degenerate in the input, however they are
   * fixed, also on the boundary, which may change its shape there. A mesh on several processes is
   * gathered on the first one. Off.
   */
  vtkSetMacro(FreeInvalid, bool);
  vtkGetMacro(FreeInvalid, bool);
  vtkBooleanMacro(FreeInvalid, bool);
  ///@}

  enum CurvedBoundaries
  {
    FIXED = 0,
    SLIDING = 1,
    FREE = 2,
    ON_SURFACE = 3
  };
  ///@{
  /**
   * What the points of the boundary of a mesh with curved cells do, instead of FixBoundary. FIXED:
   * they stay. SLIDING: those within flat parts move in these, and along straight edges.
   * ON_SURFACE: they slide on the curved boundary as it was, or on the geometry at port 2, those on
   * feature edges along these; corners stay. FREE: they move as all others. The default is
   * ON_SURFACE: where two faces of an element are on the boundary, the determinant at their common
   * edge depends on points of the boundary alone.
   */
  vtkTautlineSetRangeMacro(CurvedBoundary, int, FIXED, ON_SURFACE);
  vtkGetMacro(CurvedBoundary, int);
  ///@}

  ///@{
  /**
   * The curved boundary has a feature edge where the normals of its facets differ by more than so
   * many degrees in the middle of the edge. The default is 40.
   */
  vtkTautlineSetRangeMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
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

  void Untangle(const tautline::InputBlock& block, tautline::TableRows& history);
  void UntangleCurved(
    const tautline::InputBlock& block, vtkDataObject* geometry, tautline::TableRows& history);
  void Show(const tautline::InputBlock& block, const tautline::MovableMesh& mesh,
    tautline::UntangleResult& result, const std::string& more, tautline::TableRows& history);
  bool ShowState(const tautline::IterationState& state, int block);

  tautline::UntangleOptions GetOptions(const unsigned char* fixed, int block);

  int Method = AUTOMATIC;
  int Effort = NORMAL;
  bool FixBoundary = true;
  bool FreeInvalid = false;
  int CurvedBoundary = ON_SURFACE;
  double FeatureAngle = 40.0;
  bool MidNodesOnly = false;
  bool Straighten = false;
  std::string Reason;
  vtkIdType InvertedBefore = 0;
  vtkIdType InvertedAfter = 0;
  vtkIdType Impossible = 0;
  vtkIdType NotValid = 0; ///< with NaN coordinates too
};

#endif
