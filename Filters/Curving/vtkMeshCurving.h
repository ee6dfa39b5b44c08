// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshCurving
 * @brief Makes the cells of a mesh curved, of order 2 to 4, on a geometry or on the smooth surface
 * through their points; and linear again.
 *
 * Takes triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed and
 * beside lines and vertices, linear or curved, of planes, surfaces in space and volumes. Nodes of
 * order 2 to 4 are added on their edges and faces and inside; cells share those of common edges and
 * faces. Those on the boundary are placed
 *
 * - on a Geometry (port 1), if there is one;
 * - else on a smooth surface that is reconstructed from the facets, with cubic curves in place of
 *   edges (tautline/Boundary/SurfaceModel.h). Sharp edges (FeatureAngle) and borders become
 *   smooth curves of their own, corners stay;
 * - or in the middle of the straight edges, if Surface is STRAIGHT. This straightens curved cells,
 *   too.
 *
 * The nodes inside follow, by transfinite interpolation. Cells that are curved already keep their
 * shape if they get the same or a higher order; a lower order interpolates it at its nodes, order 1
 * keeps the corners. Every cell of the output is certified: its Jacobian determinant is positive
 * everywhere, or it is counted as invalid. Where the boundary bends much within a cell, cells may
 * be invalid: run Untangle Mesh on the output.
 *
 * Types of cells: VTK's quadratic cells with all nodes (22, 28, 24, 29, 32, 37) or, with
 * Serendipity, those without nodes on quadrilaterals and inside (23, 25, 26, 27) for order 2;
 * Lagrange cells (69 to 73) for orders 3 and 4. VTK has no pyramids of order 3 or 4: they are
 * refused.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) the geometry: a surface of triangles or quadrilaterals (STL, a finer
 * mesh); of a planar mesh the outline: lines, or cells in its plane. Its corners, curves and
 * patches are matched to the features of the mesh, as in vtkMeshOptimizer. The corners of the
 * boundary are placed on it, too.
 *
 * @par Input array 0 (optional, SetInputArrayToProcess):
 * A cell array with regions, between which boundaries are curved, too.
 *
 * @par Output:
 * An unstructured grid with points in double precision. The points of the input come first, in
 * their order, without nodes of curved cells; then the new ones, whose point data are interpolated
 * by the functions of the given cells. Global ids of points and flags of ghost points are dropped;
 * cell data and field data are kept. The cell array `Validity` is added (see vtkElementQuality).
 *
 * @par Several processes:
 * The pieces are gathered on the first process.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMeshCurving> curving;
 * curving->SetInputConnection(reader->GetOutputPort());
 * curving->SetOrder(2);
 * curving->SetInputConnection(1, stl->GetOutputPort());
 * curving->Update();
 * std::cout << curving->GetInvalidAfter() << " invalid\n" << curving->GetSummary() << "\n";
 * @endcode
 *
 * @sa tautline::curveMesh (tautline/Curving/CurveMesh.h), vtkMeshUntangler, vtkElementQuality
 */

#ifndef vtkMeshCurving_h
#define vtkMeshCurving_h

#include "TautlineCurvingModule.h" // for export macro
#include "vtkTautlineSetRange.h"   // for the setters
#include "vtkTautlineTimedAlgorithm.h"

#include <string> // for the notices

class vtkUnstructuredGrid;

namespace tautline
{
class MeshAdapter;
struct CurvingResult;
struct CurvingOptions;
struct InputBlock;
}

class TAUTLINECURVING_EXPORT vtkMeshCurving : public vtkTautlineTimedAlgorithm
{
public:
  static vtkMeshCurving* New();
  vtkTypeMacro(vtkMeshCurving, vtkTautlineTimedAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The order of the cells, 1 to 4. The default is 2.
  vtkTautlineSetRangeMacro(Order, int, 1, 4);
  vtkGetMacro(Order, int);
  ///@}

  ///@{
  /// Of order 2: no nodes on quadrilaterals and inside, as most solvers have it. The default is
  /// off.
  vtkSetMacro(Serendipity, bool);
  vtkGetMacro(Serendipity, bool);
  vtkBooleanMacro(Serendipity, bool);
  ///@}

  enum Surfaces
  {
    SMOOTH = 0,
    STRAIGHT = 1
  };
  ///@{
  /**
   * Where the nodes of the boundary are. SMOOTH, the default: on the smooth surface through the
   * points, or on the geometry; cells that are curved keep their shape. STRAIGHT: all edges are
   * straight.
   */
  vtkTautlineSetRangeMacro(Surface, int, SMOOTH, STRAIGHT);
  vtkGetMacro(Surface, int);
  ///@}

  ///@{
  /**
   * Edges at which the boundary bends by more than so many degrees are sharp, and so are points at
   * which a sharp edge does. The default is 40.
   */
  vtkTautlineSetRangeMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * Whether, if more cells are invalid than in the input, nodes around these move, corners too,
   * until all cells are valid; nodes of the boundary slide on the curved boundary, see
   * tautline/Curved/UntangleCurved.h. Not of surfaces in space. The default is on.
   */
  vtkSetMacro(Repair, bool);
  vtkGetMacro(Repair, bool);
  vtkBooleanMacro(Repair, bool);
  ///@}

  ///@{
  /**
   * Whether points with the same coordinates on facets that match are treated as one, as on the
   * seams of a mesh in pieces; the output keeps them all. The default is on. See
   * tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Results of the last execution, of all blocks: the nodes that were added; the invalid cells of
   * the input and of the output, certified; the largest distance, and the mean, of the nodes of the
   * boundary from where the cells of the input have them; the largest distance of the boundary from
   * the geometry before and after, 0 without one.
   */
  vtkGetMacro(AddedNodes, vtkIdType);
  vtkGetMacro(InvalidBefore, vtkIdType);
  vtkGetMacro(InvalidAfter, vtkIdType);
  vtkGetMacro(LargestOffset, double);
  vtkGetMacro(MeanOffset, double);
  vtkGetMacro(DistanceBefore, double);
  vtkGetMacro(DistanceAfter, double);
  ///@}

protected:
  vtkMeshCurving();
  ~vtkMeshCurving() override;

  int RequestDataObject(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  bool NeedsFinitePoints(int port) const override;
  tautline::GatheredRules GetGatheredRules() override;
  void ExchangeResult(tautline::ResultStream& stream) override;
  void ClearResult() override;

private:
  vtkMeshCurving(const vtkMeshCurving&) = delete;
  void operator=(const vtkMeshCurving&) = delete;

  void Curve(const tautline::InputBlock& block, vtkDataObject* geometry);
  void RepairResult(tautline::CurvingResult& curved, const tautline::MeshAdapter& adapter);
  tautline::CurvingResult Run(const tautline::InputBlock& block,
    const tautline::MeshAdapter& adapter, tautline::CurvingOptions& options,
    vtkIdType& invalidBefore);
  void Report(const tautline::InputBlock& block, const tautline::MeshAdapter& adapter,
    const tautline::CurvingResult& curved, vtkIdType invalidBefore);

  int Order = 2;
  bool Serendipity = false;
  int Surface = SMOOTH;
  double FeatureAngle = 40.0;
  bool Repair = true;
  bool MergeCoincidentPoints = true;

  vtkIdType AddedNodes = 0;
  vtkIdType InvalidBefore = 0;
  vtkIdType InvalidAfter = 0;
  vtkIdType RepairedNodes = 0;
  double LargestOffset = 0.0;
  double MeanOffset = 0.0;
  double DistanceBefore = 0.0;
  double DistanceAfter = 0.0;
};

#endif
