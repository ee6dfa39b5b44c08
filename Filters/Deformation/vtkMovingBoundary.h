// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMovingBoundary
 * @brief Shows the part of a mesh's boundary that vtkMeshWarp would move, without warping the mesh.
 *
 * Has the inputs and properties of vtkMeshWarp. The moving part does not depend on the Amount or on
 * the transform, which may not be chosen yet. For a motion over time it is the whole boundary.
 *
 * @par Output port 0:
 * A vtkPolyData at rest: the boundary edges (planar meshes) or faces (volumes) whose points all
 * move, and a vertex for each moving point that is in none of them; over all blocks. It is empty if
 * vtkMeshWarp would end with an error, for example because no array has been chosen yet: the
 * summary then has the message, and no error is reported.
 *
 * The other outputs are empty tables.
 *
 * @par Several processes:
 * Unlike in vtkMeshWarp, the mesh is gathered on the first process, which needs the memory for it
 * and has the output. The preview is one surface with each point once, also for blocks, and its
 * facets belong to exactly one cell of the whole mesh. The boundary that vtkMeshWarp finds in
 * pieces consists of point flags without facets, which would have to be joined into one surface.
 * The output is empty if the gathered mesh cannot be matched without global ids.
 *
 * @par Example:
 * @code
 * vtkNew<vtkMovingBoundary> boundary;
 * boundary->SetInputData(mesh);
 * boundary->SetMovedPart(vtkMeshWarp::INNER_BOUNDARIES);
 * boundary->Update();
 * double bounds[6];
 * vtkPolyData::SafeDownCast(boundary->GetOutputDataObject(0))->GetBounds(bounds);
 * @endcode
 *
 * @sa vtkMeshWarp
 */

#ifndef vtkMovingBoundary_h
#define vtkMovingBoundary_h

#include "TautlineDeformationModule.h" // for export macro

#include "vtkMeshWarp.h"

class TAUTLINEDEFORMATION_EXPORT vtkMovingBoundary : public vtkMeshWarp
{
public:
  static vtkMovingBoundary* New();
  vtkTypeMacro(vtkMovingBoundary, vtkMeshWarp);

protected:
  vtkMovingBoundary();
  ~vtkMovingBoundary() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  /// The boundary stays on the first process.
  tautline::GatheredRules GetGatheredRules() override;
  bool TakesPieces(vtkInformationVector**) override { return false; }
  /// No error: the summary has the message.
  int Fail(vtkInformationVector* outputVector, const std::string& message) override;

private:
  vtkMovingBoundary(const vtkMovingBoundary&) = delete;
  void operator=(const vtkMovingBoundary&) = delete;
};

#endif
