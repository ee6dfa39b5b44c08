// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkHorizonNeighbors
 * @brief Draws the horizon of a point and the triangles that meet it, by the cases of dissertation
 * Figure 4.4.
 *
 * To show what a row of a nonlocal matrix is made of, and what the dissertation's approximation of
 * cut triangles leaves out.
 *
 * @par Input:
 * Any vtkDataSet of triangles in a plane. The data sets of composite data are one mesh, whose cells
 * `CellId` counts through.
 *
 * @par Output port 0 `Triangles`:
 * vtkPolyData: the triangles that meet the disc. Cell arrays: `Case` (int), 1 all three corners
 * inside, 2 two, 3 one, 0 none (an edge is cut, or the disc lies in the triangle: the dissertation
 * leaves these out); `CellId`; `Area` of the part in the disc; `ChordArea`, the same as the
 * dissertation approximates it; `Missed`, the difference.
 *
 * @par Output port 1 `Horizon`:
 * vtkPolyData: the circle, as a closed line of 256 segments.
 *
 * @par Output port 2 `Pieces`:
 * vtkPolyData: the one or two triangles that replace each (Figure 4.5), with `Case` and `CellId`.
 *
 * A centre off the plane is projected to it.
 *
 * @par Several processes:
 * The pieces are gathered on the first process, which has the outputs. `CellId` counts through the
 * cells in the order of their global ids, if all pieces have some; else in that of the global ids
 * of their points, or of the places of these, x first; a mesh that one process has keeps its order.
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
   * The point. The default is (0.5, 0.5, 0).
   */
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /**
   * The horizon, above 0. The default is 0.2.
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
