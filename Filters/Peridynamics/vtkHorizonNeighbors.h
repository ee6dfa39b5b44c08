// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkHorizonNeighbors
 * @brief Draws the horizon of a point and the triangles that intersect it, by the cases of
 * dissertation Figure 4.4.
 *
 * The output shows the contributions to a row of a nonlocal matrix, and the parts that the
 * dissertation's approximation of cut triangles leaves out.
 *
 * @par Input:
 * Any vtkDataSet of triangles in a plane. The data sets of composite data form one mesh, whose
 * cells are numbered by `CellId`.
 *
 * @par Output port 0 `Triangles`:
 * vtkPolyData: the triangles that intersect the disc. Cell arrays: `Case` (int), 1 all three
 * corners inside, 2 two, 3 one, 0 none (an edge is cut, or the disc lies in the triangle; left out
 * in the dissertation); `CellId`; `Area` of the part in the disc; `ChordArea`, its approximation in
 * the dissertation; `Missed`, the difference.
 *
 * @par Output port 1 `Horizon`:
 * vtkPolyData: the circle, as a closed line of 256 segments.
 *
 * @par Output port 2 `Pieces`:
 * vtkPolyData: the one or two triangles that replace each triangle (Figure 4.5), with `Case` and
 * `CellId`.
 *
 * A center off the plane is projected to it.
 *
 * @par Several processes:
 * The pieces are gathered on the first process, which has the outputs. `CellId` numbers the cells
 * in the order of their global ids, if all pieces have them, otherwise by the global ids of their
 * points, or by the coordinates of the points, x first; a mesh on one process keeps its order.
 *
 * @sa tautline::intersectDisc (tautline/Peridynamics/Horizon.h), vtkPeridynamicStiffness
 */

#ifndef vtkHorizonNeighbors_h
#define vtkHorizonNeighbors_h

#include "TautlinePeridynamicsModule.h" // for export macro
#include "vtkPolyDataAlgorithm.h"

class TAUTLINEPERIDYNAMICS_EXPORT vtkHorizonNeighbors : public vtkPolyDataAlgorithm
{
public:
  static vtkHorizonNeighbors* New();
  vtkTypeMacro(vtkHorizonNeighbors, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The center of the horizon. The default is (0.5, 0.5, 0).
   */
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /**
   * The radius of the horizon, above 0. The default is 0.2.
   */
  vtkSetMacro(Horizon, double);
  vtkGetMacro(Horizon, double);
  ///@}

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkHorizonNeighbors();
  ~vtkHorizonNeighbors() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkHorizonNeighbors(const vtkHorizonNeighbors&) = delete;
  void operator=(const vtkHorizonNeighbors&) = delete;

  void CheckHorizon();

  double Center[3] = { 0.5, 0.5, 0.0 };
  double Horizon = 0.2;
};

#endif
