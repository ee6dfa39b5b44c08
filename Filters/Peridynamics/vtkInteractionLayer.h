// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkInteractionLayer
 * @brief Adds an interaction layer of triangles around a planar mesh, for the volume constraint of
 * nonlocal models.
 *
 * In a nonlocal (peridynamic) problem the solution is prescribed not on the boundary but in a
 * region around the domain that is as wide as the horizon (dissertation section 4.2, Figure 4.3).
 * This filter adds this region: outside the mesh and in its holes, up to a distance of Width. The
 * interaction layer shares the edges and points of the boundary.
 *
 * @par Input:
 * Any vtkDataSet of triangles in a plane. Other cells, except vertices and lines, are not
 * supported. The data sets of composite data form one mesh.
 *
 * @par Output:
 * vtkUnstructuredGrid: the triangles of the input, in their order, then the triangles of the
 * interaction layer. Points of the input come first and keep their indices; cells use the merged
 * point with the smallest index. Point and cell data of the input are passed on, with zeros in the
 * interaction layer. The cell array `Reference` (int) is 1 in the domain and 2 in the interaction
 * layer, as required by vtkPeridynamicStiffness.
 *
 * @par Limitations:
 * Elements of the interaction layer have about equal size (ElementSize). If the boundary's edges
 * are much longer or shorter, elements next to it are flat, which does not affect the matrix in the
 * exact discretization.
 *
 * @par Several processes:
 * The mesh is gathered on the first process; each process gets back its piece, without ghost cells,
 * and the adjacent triangles of the layer.
 *
 * @par Example:
 * @code
 * vtkNew<vtkInteractionLayer> layer;
 * layer->SetInputConnection(reader->GetOutputPort());
 * layer->SetWidth(0.2);
 * vtkNew<vtkPeridynamicStiffness> stiffness;
 * stiffness->SetInputConnection(layer->GetOutputPort());
 * stiffness->SetHorizon(0.2);
 * @endcode
 *
 * @sa tautline::addInteractionLayer (tautline/Peridynamics/InteractionLayer.h),
 * vtkPeridynamicStiffness, vtkDomainSource
 */

#ifndef vtkInteractionLayer_h
#define vtkInteractionLayer_h

#include "TautlinePeridynamicsModule.h" // for export macro
#include "vtkTautlineSetRange.h"        // for the setters
#include "vtkUnstructuredGridAlgorithm.h"

class TAUTLINEPERIDYNAMICS_EXPORT vtkInteractionLayer : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkInteractionLayer* New();
  vtkTypeMacro(vtkInteractionLayer, vtkUnstructuredGridAlgorithm);
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
   * Minimum width of the interaction layer, above 0, in the unit of the mesh. The default is 0.2.
   */
  vtkSetMacro(Width, double);
  vtkGetMacro(Width, double);
  ///@}

  ///@{
  /**
   * Edge length of the interaction layer's triangles; 0, the default, stands for the mean length of
   * the boundary's edges.
   */
  vtkSetMacro(ElementSize, double);
  vtkGetMacro(ElementSize, double);
  ///@}

  ///@{
  /**
   * Number of threads; 0, the default, stands for all cores. The result does not depend on it.
   */
  vtkTautlineSetRangeMacro(Threads, int, 0, 1024);
  vtkGetMacro(Threads, int);
  ///@}

  ///@{
  /**
   * Time limit of an execution in seconds, at least 0; 0 means no limit. After it the execution
   * ends with an error. The default is 600.
   */
  vtkTautlineSetRangeMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

  /// Ends the execution on abort and at the time limit.
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkInteractionLayer();
  ~vtkInteractionLayer() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  double TimeLimit = 600.0;

private:
  vtkInteractionLayer(const vtkInteractionLayer&) = delete;
  void operator=(const vtkInteractionLayer&) = delete;

  double Width = 0.2;
  double ElementSize = 0.0;
  int Threads = 0;
  bool MergeCoincidentPoints = true;
};

#endif
