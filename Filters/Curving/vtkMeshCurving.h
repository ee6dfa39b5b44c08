// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshCurving
 * @brief Curves the cells of a mesh, with order 2 to 4, to a geometry or to the smooth surface
 * through their points; or makes them linear again.
 *
 * Supports triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids, also mixed and
 * beside lines and vertices, linear or curved, in planes, surfaces in space and volumes. Nodes of
 * order 2 to 4 are added on edges, on faces and inside; cells share the nodes of common edges and
 * faces. Nodes on the boundary are placed
 *
 * - on a Geometry (port 1), if there is one;
 * - otherwise on a smooth surface reconstructed from the facets, with cubic curves in place of
 *   edges (tautline/Boundary/SurfaceModel.h). Sharp edges (FeatureAngle) and borders become
 *   separate smooth curves; corners stay;
 * - or in the middle of the straight edges, if Surface is STRAIGHT. This also straightens curved
 *   cells.
 *
 * The interior nodes follow by transfinite interpolation. Cells that are already curved keep their
 * shape if they get the same or a higher order; a lower order interpolates it at its nodes, and
 * order 1 keeps the corners. Every cell of the output is certified: its Jacobian determinant is
 * positive everywhere, or it is counted as invalid. Cells may be invalid where the boundary bends
 * strongly within a cell: run Untangle Mesh on the output.
 *
 * Types of cells: VTK's quadratic cells with all nodes (22, 28, 24, 29, 32, 37) or, with
 * Serendipity, its quadratic cells without nodes on quadrilaterals and inside (23, 25, 26, 27) for
 * order 2; Lagrange cells (69 to 73) for orders 3 and 4. Pyramids of order 3 or 4 do not exist in
 * VTK and are not supported.
 *
 * @par Input ports:
 * 0 the mesh; 1 (optional) the geometry: a surface of triangles or quadrilaterals (STL, a finer
 * mesh); for a planar mesh the outline: lines, or cells in its plane. Its corners, curves and
 * patches are matched to the features of the mesh, as in vtkMeshOptimizer. The corners of the
 * boundary are also placed on it.
 *
 * @par Input array 0 (optional, SetInputArrayToProcess):
 * A cell array of regions, whose interfaces are also curved.
 *
 * @par Output:
 * An unstructured grid with points in double precision. The points of the input come first, in
 * their order, without nodes of curved cells; then the new points, whose point data are
 * interpolated with the shape functions of the input cells. Global ids of points and flags of ghost
 * points are dropped; cell data and field data are kept. The cell array `Validity` is added (see
 * vtkElementQuality).
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
  /// For order 2: omit nodes on quadrilaterals and inside, as most solvers expect. The default is
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
   * The position of the boundary nodes. SMOOTH, the default: on the smooth surface through the
   * points, or on the geometry; curved cells keep their shape. STRAIGHT: all edges are straight.
   */
  vtkTautlineSetRangeMacro(Surface, int, SMOOTH, STRAIGHT);
  vtkGetMacro(Surface, int);
  ///@}

  ///@{
  /**
   * Edges at which the boundary bends by more than this angle, in degrees, are sharp, and so are
   * points at which a sharp edge bends by more. The default is 40.
   */
  vtkTautlineSetRangeMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * Whether to move nodes around invalid cells, including corners, until all cells are valid, if
   * more cells are invalid than in the input; boundary nodes slide on the curved boundary, see
   * tautline/Curved/UntangleCurved.h. Not for surfaces in space. The default is on.
   */
  vtkSetMacro(Repair, bool);
  vtkGetMacro(Repair, bool);
  vtkBooleanMacro(Repair, bool);
  ///@}

  ///@{
  /**
   * Whether to treat points with the same coordinates on matching facets as one, for example on the
   * seams of a mesh in pieces; the output keeps them all. The default is on. See
   * tautline/Mesh/CoincidentPoints.h.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  ///@}

  ///@{
  /**
   * Results of the last execution, over all blocks: the number of added nodes; the numbers of
   * invalid cells in the input and the output, certified; the largest and the mean distance of the
   * boundary nodes from their positions in the input cells; the largest distance of the boundary
   * from the geometry before and after, 0 without a geometry.
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
