// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkBoundaryMesher
 * @brief Base class of the meshers, which mesh the region inside a boundary.
 *
 * Abstract. The input is a vtkPointSet with the boundary. Output port 0 is a vtkUnstructuredGrid,
 * the mesh; output port 1 is a vtkPolyData, the subdivided boundary on the same points. Both
 * have the array `BoundaryMarker`. Both are empty after an error or an abort.
 *
 * Derived classes run the program tautline-mesher, see Filters/Meshing/README.md; without it they
 * report an error.
 *
 * @sa vtkTriangleMesher, vtkTetGenMesher
 */
#ifndef vtkBoundaryMesher_h
#define vtkBoundaryMesher_h

#include "TautlineMeshingModule.h" // for export macro
#include "vtkTautlineSetRange.h"   // for the setters
#include "vtkUnstructuredGridAlgorithm.h"

#include <vector> // for the sizes

class vtkPointSet;
class vtkPolyData;

class TAUTLINEMESHING_EXPORT vtkBoundaryMesher : public vtkUnstructuredGridAlgorithm
{
public:
  vtkTypeMacro(vtkBoundaryMesher, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the point array to process (index 0, one component, above 0, in the unit of the
   * coordinates) gives the edge length near each input point. The default is off.
   */
  vtkSetMacro(UseSizeArray, bool);
  vtkGetMacro(UseSizeArray, bool);
  vtkBooleanMacro(UseSizeArray, bool);
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
  vtkBoundaryMesher();
  ~vtkBoundaryMesher() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  /// Fills the outputs from an input with points. Throws tautline::Error.
  virtual void Generate(vtkPointSet* input, vtkUnstructuredGrid* output, vtkPolyData* boundary) = 0;

  /// The point array to process, checked. Throws tautline::Error.
  std::vector<double> TakeSizes(vtkPointSet* input);

  bool UseSizeArray = false;
  double TimeLimit = 600.0;

private:
  vtkBoundaryMesher(const vtkBoundaryMesher&) = delete;
  void operator=(const vtkBoundaryMesher&) = delete;
};

#endif
