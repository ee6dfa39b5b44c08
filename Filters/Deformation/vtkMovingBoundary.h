// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMovingBoundary
 * @brief Shows which part of a mesh's boundary vtkMeshWarp would move, without warping it.
 *
 * Takes the inputs and properties of vtkMeshWarp. What moves does not depend on the Amount, nor on
 * the transform, which may not have been chosen yet. Of a motion over time it is the whole
 * boundary.
 *
 * @par Output port 0:
 * A vtkPolyData at rest: the edges (planar meshes) or faces (volumes) of the boundary of which all
 * points move, and a vertex for each point that is in none of them. Of all blocks together. It is
 * empty where vtkMeshWarp would end with an error, for instance because no array has been chosen
 * yet: the summary has the message then, and no error is reported.
 *
 * The other outputs are empty tables.
 *
 * @par Several processes:
 * Unlike in vtkMeshWarp, the mesh is gathered on the first process, whose memory it has to fit
 * into, and which has the output. The preview is one surface with each point once, for blocks, too,
 * and its facets are those that one cell alone has in the whole mesh. The boundary that vtkMeshWarp
 * finds in pieces has flags of points, but no facets, and these would have to be made one surface
 * again. What a mesh that is put together cannot match without global ids leaves the output empty.
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
